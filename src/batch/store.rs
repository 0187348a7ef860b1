//! Where the state of a batch lies: beside its pictures, every file written whole or not at all.
//!
//! The folder `NAME.octray` in the output folder holds the plan that the work was begun with, and a folder for each
//! thousand units with their records, sums and checkpoints.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::assets::hash;
use super::neighbours;
use super::part::Part;
use super::record::{Kept, Record};
use super::{BatchError, Plan};
use crate::output::{OutputError, write_atomically};

/// How the names of folders end that hold the state of a batch.
pub(super) const STATE_ENDING: &str = ".octray";

const ANEW: &str = "delete it, or begin anew with --force";

/// The state of a batch in an output folder.
pub struct Store {
    output: PathBuf,
    folder: PathBuf,
    plan: String,
}

impl Store {
    /// The state of `plan` in an output folder, which is made if need be.
    ///
    /// **Errors:** [`BatchError::Changed`] if the folder holds work of another plan by this name, or pictures of another job
    /// that would be replaced; unless `anew`: then they are.
    pub fn open(output: &Path, plan: &Plan, anew: bool) -> Result<Self, BatchError> {
        let store = Self::at(output, plan);
        if anew {
            store.forget()?;
        }
        store.make_folder(&store.folder)?;
        if !store.has_begun(plan)? {
            if !anew {
                neighbours::check(output, &store.folder, plan)?;
            }
            plan.write(&store.plan_path())?;
        }
        Ok(store)
    }

    /// The state of `plan` in an output folder, as it is: nothing is made.
    ///
    /// **Errors:** [`BatchError::Changed`] if the folder holds work of another plan.
    pub fn look(output: &Path, plan: &Plan) -> Result<Self, BatchError> {
        let store = Self::at(output, plan);
        store.has_begun(plan)?;
        Ok(store)
    }

    fn at(output: &Path, plan: &Plan) -> Self {
        let folder = output.join(format!("{}{STATE_ENDING}", plan.name));
        Self { output: output.to_owned(), folder, plan: plan.identity().to_owned() }
    }

    fn plan_path(&self) -> PathBuf {
        self.folder.join("plan.json")
    }

    /// Whether any work was begun here.
    pub fn is_begun(&self) -> bool {
        self.plan_path().exists()
    }

    /// Whether work was begun with this very plan.
    fn has_begun(&self, plan: &Plan) -> Result<bool, BatchError> {
        if !self.is_begun() {
            return Ok(false);
        }
        let begun = Plan::read(&self.plan_path())?;
        if begun.identity() == self.plan {
            return Ok(true);
        }
        let mut lines = vec![format!("{} was begun with another plan", self.folder.display())];
        lines.extend(plan.differences(&begun));
        lines.push("take another folder with -o, or begin anew with --force".into());
        Err(BatchError::Changed(lines))
    }

    fn forget(&self) -> Result<(), BatchError> {
        match fs::remove_dir_all(&self.folder) {
            Err(cause) if cause.kind() != ErrorKind::NotFound => Err(cannot_write(&self.folder, cause)),
            _ => Ok(()),
        }
    }

    /// The plan's identity.
    pub(super) fn plan(&self) -> &str {
        &self.plan
    }

    /// A path below the output folder.
    pub(super) fn resolve(&self, path: &str) -> PathBuf {
        self.output.join(path)
    }

    fn unit_path(&self, unit: u64, ending: &str) -> PathBuf {
        self.folder.join(format!("{:04}", unit / 1000)).join(format!("{unit:07}.{ending}"))
    }

    fn make_folder(&self, folder: &Path) -> Result<(), BatchError> {
        fs::create_dir_all(folder).map_err(|cause| cannot_write(folder, cause))
    }

    /// Writes a file below the output folder, making the folders on its way.
    pub(super) fn write(&self, path: &Path, bytes: &[u8]) -> Result<(), BatchError> {
        match (write_atomically(path, bytes), path.parent()) {
            (Err(error), Some(folder)) if error.is_not_found() => self.make_folder(folder)?,
            (outcome, _) => return Ok(outcome?),
        }
        Ok(write_atomically(path, bytes)?)
    }

    /// Writes the files of a unit, then the record that says so.
    pub(super) fn finish(
        &self,
        unit: u64,
        nan_samples: u64,
        files: &[(String, Vec<u8>)],
    ) -> Result<(), BatchError> {
        for (path, bytes) in files {
            self.write(&self.resolve(path), bytes)?;
        }
        let kept = files.iter().map(|(path, bytes)| Kept::of(path.clone(), bytes)).collect();
        let record = Record::new(&self.plan, unit, nan_samples, kept);
        self.write(&self.unit_path(unit, "json"), &record.to_bytes())?;
        // Only now: until the record stands, a checkpoint is worth something.
        let _ = fs::remove_file(self.unit_path(unit, "checkpoint"));
        Ok(())
    }

    /// The record of a unit if it is done and its files are there; emptied ones are not.
    ///
    /// **Errors:** a record that is damaged or foreign, and files that are not what it says.
    pub(super) fn record(&self, unit: u64) -> Result<Option<Record>, BatchError> {
        let path = self.unit_path(unit, "json");
        let Some(bytes) = read_if_there(&path)? else { return Ok(None) };
        let record = Record::parse(&bytes, &self.plan, unit)
            .map_err(|reason| BatchError::damaged(&path, format!("{reason}: {ANEW}")))?;
        for file in &record.files {
            let path = self.resolve(&file.path);
            match fs::metadata(&path) {
                Ok(found) if found.len() == file.size_bytes => {}
                // What a crash of the machine leaves of a file, and nobody's work.
                Ok(found) if found.len() == 0 => {
                    tracing::warn!(unit, file = %path.display(), "emptied since it was written: not done");
                    return Ok(None);
                }
                Ok(found) => {
                    let (size, was) = (found.len(), file.size_bytes);
                    let reason = format!("has {size} bytes, and {was} when it was written: {ANEW}");
                    return Err(BatchError::damaged(path, reason));
                }
                Err(cause) if cause.kind() == ErrorKind::NotFound => return Ok(None),
                Err(cause) => return Err(BatchError::read(path, cause)),
            }
        }
        Ok(Some(record))
    }

    /// The bytes of the files of a record, if they are what it says.
    pub(super) fn files(&self, record: &Record) -> Result<Vec<Vec<u8>>, BatchError> {
        let file = |kept: &Kept| {
            let path = self.resolve(&kept.path);
            let bytes = fs::read(&path).map_err(|cause| BatchError::read(&path, cause))?;
            match hash(&bytes) == kept.blake3 {
                true => Ok(bytes),
                false => Err(BatchError::damaged(path, format!("is not what was written: {ANEW}"))),
            }
        };
        record.files.iter().map(file).collect()
    }

    /// Path of a unit's sums below the output folder.
    pub(super) fn sums_path(&self, unit: u64) -> String {
        let path = self.unit_path(unit, "sums");
        let below = path.strip_prefix(&self.output).expect("the state lies in the output folder");
        below.to_string_lossy().into_owned()
    }

    /// Keeps what is done of a unit.
    pub(super) fn checkpoint(&self, part: &Part) -> Result<(), BatchError> {
        self.write(&self.unit_path(part.unit.number, "checkpoint"), &part.encode(&self.plan))
    }

    /// A unit with what its checkpoint holds.
    ///
    /// **Errors:** a checkpoint that is damaged or foreign.
    pub(super) fn resumed(&self, part: Part) -> Result<Part, BatchError> {
        let path = self.unit_path(part.unit.number, "checkpoint");
        match read_if_there(&path)? {
            None => Ok(part),
            Some(bytes) => part
                .decode(&bytes, &self.plan)
                .map_err(|reason| BatchError::damaged(path, format!("{reason}: {ANEW}"))),
        }
    }
}

fn cannot_write(path: &Path, cause: std::io::Error) -> BatchError {
    BatchError::Output(OutputError::Write { path: path.to_owned(), cause })
}

fn read_if_there(path: &Path) -> Result<Option<Vec<u8>>, BatchError> {
    match fs::read(path) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(cause) if cause.kind() == ErrorKind::NotFound => Ok(None),
        Err(cause) => Err(BatchError::read(path, cause)),
    }
}
