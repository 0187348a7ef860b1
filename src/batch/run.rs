//! Units that are not done to units that are: many pictures in one process.
//!
//! Small pictures are rendered side by side, a thread each; large ones by several threads, tile by tile. A thread that
//! finishes a picture encodes it while the others go on, and other threads write files.

mod active;
mod finish;
mod left;
mod panics;
mod queue;
mod work;

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::{Duration, Instant};

use super::scenes::Scenes;
use super::source::Source;
use super::{BatchError, Plan, Shard, Store};
use crate::load::KeptMeshes;
use crate::wavefront::Progress;
use left::{Left, left};
use work::Work;

/// How units are rendered; nothing here changes their bytes.
#[derive(Clone, Copy)]
pub struct RunOptions<'a> {
    /// Which units; nothing for all.
    pub shard: Option<Shard>,
    /// Worker threads, at least 1.
    pub threads: usize,
    /// How often what is done of a unit is kept.
    pub checkpoint_every: Duration,
    /// Most memory for units in work and for scenes that are kept for others; one unit is worked at even if it takes more.
    pub max_memory_bytes: u64,
    /// Start no further unit after one has failed.
    pub fail_fast: bool,
    /// Threads stop after their tile when this turns true.
    pub stop: &'a AtomicBool,
    /// Meshes that scenes share; may hold those that were loaded to make the plan.
    pub meshes: &'a KeptMeshes,
    /// Is told how it goes.
    pub watch: &'a dyn Watch,
}

/// Who is told how a run goes, from any thread.
pub trait Watch: Sync {
    /// Before the first unit: how many there are to do, and how many were done before.
    fn begin(&self, to_do: u64, done_before: u64);
    /// Some pixels more, each counted once a sample.
    fn progress(&self, progress: Progress);
    /// A unit is done and recorded.
    fn unit_done(&self, unit: u64, picture: &str);
    /// A unit has failed.
    fn unit_failed(&self, failure: &Failure);
}

/// A unit that could not be done.
#[derive(Clone, Debug)]
pub struct Failure {
    /// Its number.
    pub unit: u64,
    /// Its picture.
    pub picture: String,
    /// Why.
    pub error: String,
}

/// What a run did.
#[derive(Clone, Debug, Default)]
pub struct RunReport {
    /// Units done now.
    pub done: u64,
    /// Units that were done before.
    pub done_before: u64,
    /// Units that failed.
    pub failures: Vec<Failure>,
    /// Rays traced.
    pub rays: u64,
    /// Contributions left out because they were not numbers, in all units that are done, now or before.
    pub nan_samples: u64,
    /// Whether it was stopped before the end.
    pub stopped: bool,
    /// Wall time.
    pub time: Duration,
}

/// Renders the units of `plan` that are not done; `folder` is that of the plan.
///
/// **Errors:** a scene or asset that is not what it was, damaged or foreign records. Failures of units are in the report.
pub fn run(plan: &Plan, folder: &Path, store: &Store, options: &RunOptions) -> Result<RunReport, BatchError> {
    let begun = Instant::now();
    plan.check_sources(folder)?;
    let Left { to_do, done: done_before, nan_samples } = left(plan, store, options.shard)?;
    let source = Source::read(&plan.scene, &folder.join(&plan.root), options.meshes)?;
    let bounds = (options.threads, options.max_memory_bytes);
    let scenes = Scenes::new(&source, plan, &to_do, bounds, options.meshes)?;
    options.watch.begin(to_do.len() as u64, done_before);
    let counts = Work::new(plan, store, scenes, options, to_do).done();
    Ok(RunReport {
        done: counts.units.into_inner(),
        done_before,
        rays: counts.rays.into_inner(),
        nan_samples: nan_samples + counts.nan_samples.into_inner(),
        failures: counts.failures.into_inner().expect("no thread panics while it notes a failure"),
        stopped: options.stop.load(Relaxed),
        time: begun.elapsed(),
    })
}
