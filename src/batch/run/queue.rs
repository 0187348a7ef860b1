//! Which thread does what: opens a unit, or helps with one that is open.

use std::collections::VecDeque;
use std::sync::{Arc, Condvar, Mutex, MutexGuard};

use super::active::Active;

/// A unit with more tiles than this left is worth more threads even while other units wait.
const MANY_TILES: usize = 64;

/// What a thread is to do next.
pub(super) enum Task {
    /// Open this unit.
    Open(Waiting),
    /// Paint tiles of this one.
    Join(Arc<Active>),
}

/// A unit that waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Waiting {
    pub(super) unit: u64,
    /// Memory that it takes from being opened until its files are written.
    pub(super) size_bytes: u64,
}

/// Units that wait, and units that are open.
pub(super) struct Queue {
    state: Mutex<State>,
    changed: Condvar,
}

struct State {
    waiting: VecDeque<Waiting>,
    open: Vec<Arc<Active>>,
    /// Memory of all units in work, and the most it may be while there is more than one.
    bytes: u64,
    max_bytes: u64,
    /// Units that threads are opening: they may have tiles for others.
    opening: usize,
}

impl Queue {
    pub(super) fn new(units: Vec<Waiting>, max_bytes: u64) -> Self {
        let state = State { waiting: units.into(), open: Vec::new(), bytes: 0, max_bytes, opening: 0 };
        Self { state: Mutex::new(state), changed: Condvar::new() }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().expect("no thread panics while it looks for work")
    }

    /// The next task; waits while others may yet have one. Nothing when all is taken, or when `stopped` says so.
    pub(super) fn next(&self, stopped: impl Fn() -> bool) -> Option<Task> {
        let mut state = self.state();
        loop {
            if stopped() {
                // Others may wait for what will not come.
                self.changed.notify_all();
                return None;
            }
            if let Some(task) = state.task() {
                return Some(task);
            }
            if state.opening == 0 && state.waiting.is_empty() {
                return None;
            }
            state = self.changed.wait(state).expect("no thread panics while it looks for work");
        }
    }

    /// A unit is open.
    pub(super) fn opened(&self, active: Active) -> Arc<Active> {
        let active = Arc::new(active);
        let mut state = self.state();
        state.opening -= 1;
        state.open.push(Arc::clone(&active));
        self.changed.notify_all();
        active
    }

    /// A unit could not be opened.
    pub(super) fn gave_up(&self) {
        self.state().opening -= 1;
        self.changed.notify_all();
    }

    /// A unit in work needs its memory no more.
    pub(super) fn release(&self, size_bytes: u64) {
        self.state().bytes -= size_bytes;
        self.changed.notify_all();
    }

    /// Memory of all units in work.
    pub(super) fn bytes(&self) -> u64 {
        self.state().bytes
    }

    /// All tiles of a unit are done.
    pub(super) fn close(&self, active: &Arc<Active>) {
        self.state().open.retain(|open| !Arc::ptr_eq(open, active));
    }

    /// Units that are still open.
    pub(super) fn left(&self) -> Vec<Arc<Active>> {
        self.state().open.clone()
    }
}

impl State {
    fn task(&mut self) -> Option<Task> {
        if let Some(large) = self.open.iter().find(|active| active.tiles_left() > MANY_TILES) {
            return Some(Task::Join(Arc::clone(large)));
        }
        if let Some(waiting) = self.next_that_fits() {
            self.opening += 1;
            self.bytes += waiting.size_bytes;
            return Some(Task::Open(waiting));
        }
        let some = self.open.iter().find(|active| active.tiles_left() > 0);
        some.map(|active| Task::Join(Arc::clone(active)))
    }

    /// The next unit, if there is memory for it or nothing else is in work.
    fn next_that_fits(&mut self) -> Option<Waiting> {
        let next = self.waiting.front()?;
        let fits = self.bytes == 0 || self.bytes.saturating_add(next.size_bytes) <= self.max_bytes;
        if fits { self.waiting.pop_front() } else { None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn queue(max_bytes: u64) -> Queue {
        Queue::new((0..3).map(|unit| Waiting { unit, size_bytes: 10 }).collect(), max_bytes)
    }

    fn opened(queue: &Queue) -> Option<u64> {
        let task = queue.state().task();
        task.map(|task| match task {
            Task::Open(waiting) => waiting.unit,
            Task::Join(_) => panic!("nothing is open"),
        })
    }

    #[test]
    fn units_wait_until_there_is_memory() {
        let queue = queue(20);
        assert_eq!([opened(&queue), opened(&queue), opened(&queue)], [Some(0), Some(1), None]);
        queue.release(10);
        assert_eq!((opened(&queue), queue.bytes()), (Some(2), 20));
    }

    #[test]
    fn one_unit_is_worked_at_however_large_it_is() {
        let queue = queue(0);
        assert_eq!([opened(&queue), opened(&queue)], [Some(0), None]);
        queue.release(10);
        assert_eq!(opened(&queue), Some(1));
    }

    #[test]
    fn nobody_waits_for_ever_when_the_work_is_stopped() {
        let queue = queue(0);
        assert_eq!(opened(&queue), Some(0));
        let stopped = std::sync::atomic::AtomicBool::new(false);
        let is_stopped = || stopped.load(std::sync::atomic::Ordering::Relaxed);
        std::thread::scope(|scope| {
            let waits = scope.spawn(|| queue.next(is_stopped).is_none());
            stopped.store(true, std::sync::atomic::Ordering::Relaxed);
            while !waits.is_finished() {
                assert!(queue.next(is_stopped).is_none());
                std::thread::yield_now();
            }
            assert!(waits.join().unwrap());
        });
    }
}
