//! Units to pictures, and to a list of what is missing.

use std::path::Path;

use rayon::prelude::*;

use super::compose::{files, film};
use super::faults::Faults;
use super::part::Part;
use super::picture::Picture;
use super::plan::Split;
use super::record::Record;
use super::source::Source;
use super::threads::{default_threads, workers};
use super::{BatchError, Plan, Store};
use crate::load::KeptMeshes;

/// Which units are done.
#[derive(Clone, Debug, Default)]
pub struct Status {
    /// Number of units.
    pub units: u64,
    /// Number of units that are done.
    pub done: u64,
    /// Contributions to them that were left out because they were not numbers.
    pub nan_samples: u64,
    /// Shards with units that are not done, ascending.
    pub shards_missing: Vec<u32>,
    /// Pictures with units that are not done: places in the plan.
    pub pictures_missing: Vec<usize>,
}

impl Status {
    /// Whether everything is done.
    pub fn is_complete(&self) -> bool {
        self.done == self.units
    }

    /// The missing shards as a scheduler wants them: `--array=4,7-9`; nothing if none is missing.
    pub fn array(&self) -> Option<String> {
        let mut runs: Vec<(u32, u32)> = Vec::new();
        for &shard in &self.shards_missing {
            match runs.last_mut().filter(|run| run.1 + 1 == shard) {
                Some(run) => run.1 = shard,
                None => runs.push((shard, shard)),
            }
        }
        let text = |&(a, b): &(u32, u32)| if a == b { a.to_string() } else { format!("{a}-{b}") };
        let list = runs.iter().map(text).collect::<Vec<_>>().join(",");
        (!list.is_empty()).then(|| format!("--array={list}"))
    }
}

/// Which units of a plan are done.
///
/// **Errors:** records that are damaged or foreign.
pub fn status(plan: &Plan, store: &Store) -> Result<Status, BatchError> {
    let mut status = Status { units: plan.units(), ..Status::default() };
    let mut faults = Faults::default();
    let mut shards = std::collections::BTreeSet::new();
    for (place, picture) in plan.pictures.iter().enumerate() {
        let before = status.done;
        for unit in picture.first_unit..picture.first_unit + picture.units {
            match faults.note(store.record(unit))?.flatten() {
                Some(record) => {
                    status.done += 1;
                    status.nan_samples += record.nan_samples;
                }
                None => drop(shards.insert((unit % u64::from(plan.shards)) as u32)),
            }
        }
        if status.done - before < picture.units {
            status.pictures_missing.push(place);
        }
    }
    status.shards_missing = shards.into_iter().collect();
    faults.told().map(|()| status)
}

/// Puts the units of all pictures together; with `partial` also of those that lack some. Gives the number of pictures
/// that are there afterwards. Pictures that are units themselves are checked, byte for byte, and stay where they are.
///
/// **Errors:** units that are not what was recorded, a changed scene.
pub fn merge(plan: &Plan, folder: &Path, store: &Store, partial: bool) -> Result<u64, BatchError> {
    plan.check_sources(folder)?;
    let source = Source::read(&plan.scene, &folder.join(&plan.root), &KeptMeshes::default())?;
    let there = |picture: &Picture| match plan.split {
        Split::Frames => whole(picture, store),
        Split::Tiles | Split::Samples => joined(plan, picture, store, &source, partial),
    };
    let count = |picture: &Picture| {
        let mut faults = Faults::default();
        faults.note(there(picture)).map(|there| (u64::from(there == Some(true)), faults))
    };
    let both = |(a, faults): (u64, Faults), (b, more)| Ok((a + b, faults.join(more)));
    let all = || plan.pictures.par_iter().map(count).try_reduce(Default::default, both);
    let (pictures, faults) = workers(default_threads())?.install(all)?;
    faults.told().map(|()| pictures)
}

/// Whether a picture that is one unit is there, as it was written.
fn whole(picture: &Picture, store: &Store) -> Result<bool, BatchError> {
    let Some(record) = store.record(picture.first_unit)? else { return Ok(false) };
    store.files(&record).map(|_| true)
}

/// Puts a picture together if its units are there; says whether it was.
fn joined(
    plan: &Plan,
    picture: &Picture,
    store: &Store,
    source: &Source,
    partial: bool,
) -> Result<bool, BatchError> {
    let records = records(picture, store, partial)?;
    if records.is_empty() {
        return Ok(false);
    }
    let sets: Vec<String> = plan.sets.iter().chain(&picture.sets).cloned().collect();
    let scene = source.view(&sets)?;
    let mut parts = Vec::new();
    for (unit, record) in records {
        let bytes = store.files(&record)?.pop().unwrap_or_default();
        let part = Part::new(plan.unit(unit), scene.settings.aovs).decode(&bytes, store.plan());
        let part =
            part.map_err(|reason| BatchError::damaged(store.resolve(&store.sums_path(unit)), reason))?;
        parts.push(part);
    }
    let film = film(picture.size, scene.settings.aovs, &parts);
    for (path, bytes) in files(picture, &scene, film)? {
        store.write(&store.resolve(&path), &bytes)?;
    }
    Ok(true)
}

/// The records of a picture's units: of all, or with `partial` of those that are done; else none.
fn records(picture: &Picture, store: &Store, partial: bool) -> Result<Vec<(u64, Record)>, BatchError> {
    let mut records = Vec::new();
    for unit in picture.first_unit..picture.first_unit + picture.units {
        match store.record(unit)? {
            Some(record) => records.push((unit, record)),
            None if partial => {}
            None => return Ok(Vec::new()),
        }
    }
    Ok(records)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_shards_read_like_slurm_wants_them() {
        let array = |shards_missing: &[u32]| {
            let shards_missing = shards_missing.to_vec();
            Status { units: 9, shards_missing, ..Status::default() }.array()
        };
        assert_eq!(array(&[4, 7, 8, 9]).as_deref(), Some("--array=4,7-9"));
        assert_eq!(array(&[0]).as_deref(), Some("--array=0"));
        assert_eq!(array(&[]), None);
    }
}
