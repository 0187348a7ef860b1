//! Clocks, and what several runs say together.

use std::time::Instant;

use serde::{Deserialize, Serialize};

/// What several runs gave: the middle, and how far they spread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// Half of the runs gave no more.
    pub median: f64,
    /// The least.
    pub min: f64,
    /// The most.
    pub max: f64,
}

impl Spread {
    /// Of at least one value.
    pub fn of(values: &[f64]) -> Self {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let (half, last) = (sorted.len() / 2, sorted.len() - 1);
        let median = if last % 2 == 0 { sorted[half] } else { 0.5 * (sorted[half - 1] + sorted[half]) };
        Self { median, min: sorted[0], max: sorted[last] }
    }
    /// The larger distance from the median to either end, as a share of the median.
    pub fn noise(&self) -> f64 {
        (self.max - self.median).max(self.median - self.min) / self.median
    }
}

/// Seconds that `work` takes: CPU time of this thread, which others on the machine do not count into, or wall time where
/// several threads work or the system has no such clock.
pub(super) fn seconds(threads: usize, work: impl FnOnce()) -> f64 {
    timed(threads, work).1
}

/// What `work` gives, and the seconds that it takes, as in [`seconds`].
pub(in crate::measure) fn timed<R>(threads: usize, work: impl FnOnce() -> R) -> (R, f64) {
    let (wall, cpu) = (Instant::now(), thread_seconds());
    let result = work();
    let seconds = match (threads, cpu, thread_seconds()) {
        (1, Some(before), Some(after)) => after - before,
        _ => wall.elapsed().as_secs_f64(),
    };
    (result, seconds)
}

#[cfg(unix)]
fn thread_seconds() -> Option<f64> {
    let now = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Some(now.tv_sec as f64 + now.tv_nsec as f64 * 1e-9)
}

#[cfg(not(unix))]
fn thread_seconds() -> Option<f64> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_stands_in_the_middle() {
        assert_eq!(Spread::of(&[3.0, 1.0, 2.0]), Spread { median: 2.0, min: 1.0, max: 3.0 });
        assert_eq!(Spread::of(&[4.0, 1.0, 2.0, 3.0]).median, 2.5);
        assert_eq!(Spread::of(&[7.0]), Spread { median: 7.0, min: 7.0, max: 7.0 });
        assert_eq!(Spread::of(&[4.0, 1.0, 5.0]).noise(), 0.75);
    }

    #[test]
    fn sleeping_costs_wall_time_alone() {
        let nap = || std::thread::sleep(std::time::Duration::from_millis(20));
        assert!(seconds(2, nap) >= 0.02);
        if cfg!(unix) {
            assert!(seconds(1, nap) < 0.02);
        }
    }
}
