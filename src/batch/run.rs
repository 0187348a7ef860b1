//! Units that are not done to units that are: many pictures in one process.
//!
//! Small pictures are rendered side by side, a thread each; large ones by several threads, tile by tile. A thread that
//! finishes a picture encodes it while the others go on, and other threads write files.

mod active;
mod finish;
mod left;
mod queue;

use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::time::{Duration, Instant};

use super::scenes::Scenes;
use super::source::Source;
use super::{BatchError, Plan, Shard, Store};
use crate::load::KeptMeshes;
use crate::wavefront::{Progress, Scratch};
use finish::{Finished, write_all};
use left::{Left, left};
use queue::{Queue, Task, Waiting};

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
    let scenes = Scenes::new(&source, &plan.sets, options.threads, options.max_memory_bytes, options.meshes)?;
    options.watch.begin(to_do.len() as u64, done_before);
    let total = to_do.iter().map(|&unit| plan.unit(unit).cost()).fold(0, u64::saturating_add);
    let waiting = to_do.into_iter().map(|unit| Waiting { unit, size_bytes: plan.size_bytes(unit) });
    let queue = Queue::new(waiting.collect(), options.max_memory_bytes);
    let work = Work { plan, store, scenes, options, total, counts: Counts::default(), queue };
    work.all();
    let counts = work.counts;
    Ok(RunReport {
        done: counts.units.into_inner(),
        done_before,
        failures: counts.failures.into_inner().expect("no thread panics while it notes a failure"),
        rays: counts.rays.into_inner(),
        nan_samples: nan_samples + counts.nan_samples.into_inner(),
        stopped: options.stop.load(Relaxed),
        time: begun.elapsed(),
    })
}

/// What the threads of a run share.
struct Work<'a> {
    plan: &'a Plan,
    store: &'a Store,
    scenes: Scenes<'a>,
    options: &'a RunOptions<'a>,
    /// Camera samples of all units.
    total: u64,
    counts: Counts,
    queue: Queue,
}

#[derive(Default)]
struct Counts {
    units: AtomicU64,
    samples: AtomicU64,
    rays: AtomicU64,
    nan_samples: AtomicU64,
    failures: Mutex<Vec<Failure>>,
}

impl Work<'_> {
    /// Runs all threads to the end, then keeps what is done of units that are not.
    fn all(&self) {
        let (sender, receiver) = std::sync::mpsc::sync_channel::<Finished>(2 * self.options.threads);
        let receiver = Mutex::new(receiver);
        std::thread::scope(|scope| {
            for _ in 0..WRITERS {
                scope.spawn(|| write_all(self, &receiver));
            }
            for _ in 0..self.options.threads {
                let sender = sender.clone();
                scope.spawn(move || self.work(&sender));
            }
            drop(sender);
        });
        for active in self.queue.left() {
            if let Err(error) = active.keep(self.store) {
                self.failed(active.of.unit, &error);
            }
        }
    }

    /// One thread: opens units, paints their tiles, until there is nothing to do.
    fn work(&self, finished: &std::sync::mpsc::SyncSender<Finished>) {
        let mut scratch = Scratch::default();
        while let Some(task) = self.queue.next(|| self.is_stopped()) {
            let active = match task {
                Task::Join(active) => active,
                Task::Open(waiting) => match self.open(waiting) {
                    Ok(active) => self.queue.opened(active),
                    Err(error) => {
                        self.failed(waiting.unit, &error);
                        self.queue.gave_up();
                        self.queue.release(waiting.size_bytes);
                        continue;
                    }
                },
            };
            if active.paint(self, &mut scratch) {
                self.queue.close(&active);
                match finish::encoded(self, &active) {
                    Ok(done) => finished.send(done).expect("writers outlive workers"),
                    Err(error) => {
                        self.failed(active.of.unit, &error);
                        self.queue.release(active.of.size_bytes);
                    }
                }
            }
        }
    }

    fn is_stopped(&self) -> bool {
        let failed =
            || !self.counts.failures.lock().expect("no thread panics while it notes a failure").is_empty();
        self.options.stop.load(Relaxed) || (self.options.fail_fast && failed())
    }

    fn failed(&self, unit: u64, error: &BatchError) {
        let picture = self.plan.pictures[self.plan.unit(unit).picture].name.clone();
        let failure = Failure { unit, picture, error: error.told() };
        tracing::error!(unit, picture = failure.picture, error = failure.error, "unit failed");
        self.options.watch.unit_failed(&failure);
        self.counts.failures.lock().expect("no thread panics while it notes a failure").push(failure);
    }

    /// Counts camera samples and rays.
    fn advance(&self, samples: u64, rays: u64) {
        let pixels_done = self.counts.samples.fetch_add(samples, Relaxed) + samples;
        let rays = self.counts.rays.fetch_add(rays, Relaxed) + rays;
        self.options.watch.progress(Progress { pixels_done, pixels_total: self.total, rays });
    }
}

/// Threads that write files. Nearly all they do is wait for the disk, and many files can be on their way to it at once.
const WRITERS: usize = 8;
