//! Plans: pictures cut into numbered units, and units into shards, once and for all.

mod differences;

use std::mem;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::assets::{Asset, Files, changes, hash};
use super::expand::pictures;
use super::job::Job;
use super::paths::relative;
use super::picture::Picture;
use super::source::{self, Source};
use super::threads::{default_threads, workers};
use super::unit::{Cut, Unit};
use super::{BatchError, Shard};
use crate::film::AovSet;
use crate::load::KeptMeshes;
use crate::output::write_atomically;

/// The first words of a plan, with the version of its format.
const FORMAT: &str = "octray plan 2";

/// More pixels than a scene may have.
const MOST_PIXELS: u64 = 1 << 28;

/// Most shards of a plan.
pub const MOST_SHARDS: u32 = 1_000_000;

/// What a unit is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Split {
    /// A whole picture.
    #[default]
    Frames,
    /// A tile of a picture.
    Tiles,
    /// Some samples of all pixels of a picture.
    Samples,
}

/// Everything that pictures and their bytes depend on, and how the work is cut.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    /// Format and version.
    pub format: String,
    /// Version of octray that made it.
    pub octray: String,
    /// Name of the job.
    pub name: String,
    /// The job's folder, as seen from the plan's.
    pub root: PathBuf,
    /// The scene file relative to `root`, or the name of a built-in scene.
    pub scene: String,
    /// BLAKE3 of the scene as text.
    pub scene_blake3: String,
    /// All files that the scenes need.
    pub assets: Vec<Asset>,
    /// Changes to the scene for all pictures, each `key=value`.
    pub sets: Vec<String>,
    /// What a unit is.
    pub split: Split,
    /// Number of shards: unit `u` is in shard `u % shards`.
    pub shards: u32,
    /// What it will cost.
    pub cost: Cost,
    /// The pictures.
    pub pictures: Vec<Picture>,
    /// BLAKE3 of everything above but `root`: what identifies the plan, and tells a damaged one.
    pub blake3: String,
}

/// An estimate of the work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cost {
    /// Pictures.
    pub pictures: u64,
    /// Units.
    pub units: u64,
    /// Camera samples; the greatest number stands for more.
    pub samples: u64,
}

impl Plan {
    /// The plan of a job, for a file in the folder `at`. A scene that is a bare mesh is kept in `meshes`.
    ///
    /// **Errors:** a scene that is not valid, naming the picture; assets that cannot be read; two pictures in one file.
    pub fn of(
        job: &Job,
        split: Split,
        shards: u32,
        at: &Path,
        meshes: &KeptMeshes,
    ) -> Result<Self, BatchError> {
        let source = Source::read(&job.scene, &job.folder, meshes)?;
        let mut files = Files::default();
        files.see(source.scene());
        let mut pictures = workers(default_threads())?.install(|| pictures(job, &source, &mut files))?;
        let mut units = 0;
        for picture in &mut pictures {
            picture.first_unit = units;
            picture.units = Cut::of(split, shards, picture).units();
            units += picture.units;
        }
        let samples = pictures.iter().map(Picture::samples).fold(0, u64::saturating_add);
        let mut plan = Self {
            format: FORMAT.into(),
            octray: env!("CARGO_PKG_VERSION").into(),
            name: job.name.clone(),
            root: relative(&job.folder, at).map_err(|cause| BatchError::read(at, cause))?,
            scene: job.scene.clone(),
            scene_blake3: hash(&source.bytes),
            assets: files.hashed(&job.folder)?,
            sets: job.common_sets(),
            split,
            shards,
            cost: Cost { pictures: pictures.len() as u64, units, samples },
            pictures,
            blake3: String::new(),
        };
        plan.blake3 = plan.seal();
        Ok(plan)
    }

    /// What `blake3` is to be.
    fn seal(&mut self) -> String {
        let (root, blake3) = (mem::take(&mut self.root), mem::take(&mut self.blake3));
        let seal = hash(&self.to_bytes());
        (self.root, self.blake3) = (root, blake3);
        seal
    }

    /// The plan in a file.
    ///
    /// **Errors:** it cannot be read, is no plan, or is one of another version.
    pub fn read(path: &Path) -> Result<Self, BatchError> {
        let bytes = std::fs::read(path).map_err(|cause| BatchError::read(path, cause))?;
        let mut plan: Self = serde_json::from_slice(&bytes)
            .map_err(|error| BatchError::damaged(path, no_plan(path, &error)))?;
        plan.check().map_err(|reason| BatchError::damaged(path, reason))?;
        Ok(plan)
    }

    fn check(&mut self) -> Result<(), String> {
        if self.format != FORMAT {
            return Err(format!("has the format `{}`, expected `{FORMAT}`: make the plan anew", self.format));
        }
        if self.octray != env!("CARGO_PKG_VERSION") {
            let (made, here) = (&self.octray, env!("CARGO_PKG_VERSION"));
            return Err(format!(
                "was made by octray {made} and this is {here}: pictures may differ, make the plan anew"
            ));
        }
        let seal = self.seal();
        if self.blake3 != seal {
            return Err("is damaged: its hash does not fit: make the plan anew".into());
        }
        if !(1..=MOST_SHARDS).contains(&self.shards) {
            return Err(format!("is damaged: {} shards", self.shards));
        }
        let mut units = 0;
        for picture in &self.pictures {
            let pixels = u64::from(picture.size[0]) * u64::from(picture.size[1]);
            let is_picture = (1..=MOST_PIXELS).contains(&pixels) && picture.spp > 0;
            if !is_picture || picture.first_unit != units || !picture.has_good_paths() {
                return Err(format!("is damaged: {} does not fit the others", picture.name));
            }
            if picture.units != Cut::of(self.split, self.shards, picture).units() {
                return Err(format!("is damaged: {} is not cut as the plan says", picture.name));
            }
            units += picture.units;
        }
        if units != self.cost.units {
            return Err("is damaged: its units do not add up".into());
        }
        Ok(())
    }

    /// The plan's bytes: the same for the same job.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = serde_json::to_vec_pretty(self).expect("a plan has only text and numbers");
        bytes.push(b'\n');
        bytes
    }

    /// Writes the plan in one step.
    ///
    /// **Errors:** what the system said.
    pub fn write(&self, path: &Path) -> Result<(), BatchError> {
        Ok(write_atomically(path, &self.to_bytes())?)
    }

    /// What identifies the plan, wherever it lies.
    pub fn identity(&self) -> &str {
        &self.blake3
    }

    /// Number of units.
    pub fn units(&self) -> u64 {
        self.cost.units
    }

    /// A unit by its number. **Panics** beyond the last.
    pub fn unit(&self, number: u64) -> Unit {
        let picture = self.pictures.partition_point(|p| p.first_unit <= number) - 1;
        let found = &self.pictures[picture];
        Cut::of(self.split, self.shards, found).unit(number, picture, number - found.first_unit)
    }

    /// About how many bytes a unit takes while it is in work.
    pub(super) fn size_bytes(&self, unit: u64) -> u64 {
        let unit = self.unit(unit);
        let files = &self.pictures[unit.picture].outputs;
        let aovs: AovSet = files.iter().flat_map(|file| &file.aovs).copied().collect();
        let channels: usize = aovs.iter().map(|aov| aov.channels().len()).sum();
        unit.size_bytes(self.split, channels as u64, files.len() as u64)
    }

    /// Units of a shard, or all.
    pub fn units_of(&self, shard: Option<Shard>) -> impl Iterator<Item = u64> + use<> {
        let (first, step) = shard.map_or((0, 1), |shard| (u64::from(shard.index), u64::from(self.shards)));
        (first..self.units()).step_by(step as usize)
    }

    /// Fails if the scene or an asset is not what it was; `folder` is that of the plan.
    pub fn check_sources(&self, folder: &Path) -> Result<(), BatchError> {
        let root = folder.join(&self.root);
        let mut changed = changes(&self.assets, &root);
        match source::bytes(&self.scene, &root) {
            Ok(bytes) if hash(&bytes) == self.scene_blake3 => {}
            Ok(_) => {
                changed.insert(0, format!("the scene {} has changed since the plan was made", self.scene))
            }
            Err(error) if changed.is_empty() => return Err(error),
            Err(error) => changed.insert(0, error.told()),
        }
        if changed.is_empty() { Ok(()) } else { Err(BatchError::Changed(changed)) }
    }
}

/// Why a file is no plan.
fn no_plan(path: &Path, error: &serde_json::Error) -> String {
    match Job::read(path) {
        Ok(_) => "is a job and no plan: `octray plan` makes one of it".into(),
        Err(_) => format!("is no whole plan: {error}"),
    }
}
