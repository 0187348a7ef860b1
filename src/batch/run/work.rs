//! The threads of a run: some render units, others write the files of those that are rendered.

use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::mpsc::{SyncSender, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard};

use super::active::Active;
use super::finish::{Finished, encoded, write_all};
use super::panics::caught;
use super::queue::{Queue, Task, Waiting};
use super::{Failure, RunOptions};
use crate::batch::scenes::Scenes;
use crate::batch::{BatchError, Plan, Store};
use crate::wavefront::{Progress, Scratch};

/// Threads that write files. Nearly all they do is wait for the disk, and many files can be on their way to it at once.
const WRITERS: usize = 8;

/// What the threads of a run share.
pub(super) struct Work<'a> {
    pub(super) plan: &'a Plan,
    pub(super) store: &'a Store,
    pub(super) scenes: Scenes<'a>,
    pub(super) options: &'a RunOptions<'a>,
    pub(super) queue: Queue,
    pub(super) counts: Counts,
    /// Camera samples of all units.
    total: u64,
}

/// What was done and what was not.
#[derive(Default)]
pub(super) struct Counts {
    pub(super) units: AtomicU64,
    samples: AtomicU64,
    pub(super) rays: AtomicU64,
    pub(super) nan_samples: AtomicU64,
    pub(super) failures: Mutex<Vec<Failure>>,
}

impl<'a> Work<'a> {
    /// These units to do.
    pub(super) fn new(
        plan: &'a Plan,
        store: &'a Store,
        scenes: Scenes<'a>,
        options: &'a RunOptions<'a>,
        to_do: Vec<u64>,
    ) -> Self {
        let total = to_do.iter().map(|&unit| plan.unit(unit).cost()).fold(0, u64::saturating_add);
        let waiting = to_do.into_iter().map(|unit| Waiting { unit, size_bytes: plan.size_bytes(unit) });
        let queue = Queue::new(waiting.collect(), options.max_memory_bytes);
        Self { plan, store, scenes, options, queue, counts: Counts::default(), total }
    }

    /// Runs all threads to the end, then keeps what is done of units that are not.
    pub(super) fn done(self) -> Counts {
        let (sender, receiver) = sync_channel::<Finished>(2 * self.options.threads);
        let receiver = Mutex::new(receiver);
        std::thread::scope(|scope| {
            for _ in 0..WRITERS {
                scope.spawn(|| write_all(&self, &receiver));
            }
            for _ in 0..self.options.threads {
                let (work, sender) = (&self, sender.clone());
                scope.spawn(move || work.render(&sender));
            }
            drop(sender);
        });
        for active in self.queue.left() {
            if let Err(error) = active.keep(self.store) {
                self.failed(active.of.unit, &error);
            }
        }
        self.counts
    }

    /// One thread: opens units, paints their tiles, until there is nothing to do.
    fn render(&self, finished: &SyncSender<Finished>) {
        let mut scratch = Scratch::default();
        while let Some(task) = self.queue.next(|| self.is_stopped()) {
            let active = match task {
                Task::Join(active) => Some(active),
                Task::Open(waiting) => self.opened(waiting),
            };
            let Some(active) = active else { continue };
            match caught(|| Ok(active.paint(self, &mut scratch))) {
                Ok(true) => self.hand_over(&active, finished),
                Ok(false) => {}
                Err(error) => {
                    scratch = Scratch::default();
                    self.give_up(&active, &error);
                }
            }
        }
    }

    /// A unit for all threads, unless it cannot be opened.
    fn opened(&self, waiting: Waiting) -> Option<Arc<Active>> {
        match caught(|| self.open(waiting)) {
            Ok(active) => Some(self.queue.opened(active)),
            Err(error) => {
                self.failed(waiting.unit, &error);
                self.queue.gave_up();
                self.queue.release(waiting.size_bytes);
                None
            }
        }
    }

    /// Encodes a unit whose tiles are done, and gives its files to those who write them.
    fn hand_over(&self, active: &Arc<Active>, finished: &SyncSender<Finished>) {
        self.queue.close(active);
        match caught(|| encoded(self, active)) {
            Ok(done) => finished.send(done).expect("writers outlive workers"),
            Err(error) => {
                self.failed(active.of.unit, &error);
                self.queue.release(active.of.size_bytes);
            }
        }
    }

    /// A unit whose sums are worth nothing; other threads may yet be at its tiles.
    fn give_up(&self, active: &Arc<Active>, error: &BatchError) {
        if active.spoil() {
            self.queue.close(active);
            self.failed(active.of.unit, error);
            self.queue.release(active.of.size_bytes);
        }
    }

    /// Whether no further tile is to be begun.
    pub(super) fn is_stopped(&self) -> bool {
        self.options.stop.load(Relaxed) || (self.options.fail_fast && !self.failures().is_empty())
    }

    /// Takes note of a unit that could not be done.
    pub(super) fn failed(&self, unit: u64, error: &BatchError) {
        let picture = self.plan.pictures[self.plan.unit(unit).picture].name.clone();
        let failure = Failure { unit, picture, error: error.told() };
        tracing::error!(unit, picture = failure.picture, error = failure.error, "unit failed");
        self.options.watch.unit_failed(&failure);
        self.failures().push(failure);
    }

    fn failures(&self) -> MutexGuard<'_, Vec<Failure>> {
        self.counts.failures.lock().expect("no thread panics while it notes a failure")
    }

    /// Counts camera samples and rays.
    pub(super) fn advance(&self, samples: u64, rays: u64) {
        let pixels_done = self.counts.samples.fetch_add(samples, Relaxed) + samples;
        let rays = self.counts.rays.fetch_add(rays, Relaxed) + rays;
        self.options.watch.progress(Progress { pixels_done, pixels_total: self.total, rays });
    }
}
