//! Which thread does what: opens a unit, or helps with one that is open.

use std::collections::VecDeque;
use std::sync::{Arc, Condvar, Mutex, MutexGuard};

use super::active::Active;

/// A unit with more tiles than this left is worth more threads even while other units wait.
const MANY_TILES: usize = 64;

/// What a thread is to do next.
pub(super) enum Task {
    /// Open this unit.
    Open(u64),
    /// Paint tiles of this one.
    Join(Arc<Active>),
}

/// Units that wait, and units that are open.
pub(super) struct Queue {
    state: Mutex<State>,
    changed: Condvar,
}

struct State {
    waiting: VecDeque<u64>,
    open: Vec<Arc<Active>>,
    /// Units that threads are opening: they may have tiles for others.
    opening: usize,
}

impl Queue {
    pub(super) fn new(units: Vec<u64>) -> Self {
        let state = State { waiting: units.into(), open: Vec::new(), opening: 0 };
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
                return None;
            }
            if let Some(task) = state.task() {
                return Some(task);
            }
            if state.opening == 0 {
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
        if let Some(unit) = self.waiting.pop_front() {
            self.opening += 1;
            return Some(Task::Open(unit));
        }
        let some = self.open.iter().find(|active| active.tiles_left() > 0);
        some.map(|active| Task::Join(Arc::clone(active)))
    }
}
