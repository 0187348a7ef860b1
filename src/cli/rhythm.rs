//! When progress is shown, and the figures in it.

use std::time::Duration;

use super::human;
use super::pipeline::Progress;

/// When progress is shown.
#[derive(Debug)]
pub(super) struct Rhythm {
    /// No sooner than this after the last time.
    least: Duration,
    /// No later, even if no further tenth is done.
    most: Duration,
    last: Duration,
    last_tenth: u64,
}

impl Rhythm {
    /// At most this often.
    pub(super) fn every(pause: Duration) -> Self {
        Self { least: pause, most: pause, last: Duration::ZERO, last_tenth: 0 }
    }

    /// For people who read lines: every tenth, but not within a second, and at least every 30 seconds.
    pub(super) fn by_tenths() -> Self {
        Self { most: Duration::from_secs(30), ..Self::every(Duration::from_secs(1)) }
    }

    /// Whether to show progress now, `elapsed` after the start with this many tenths done; if so, takes note.
    pub(super) fn is_due(&mut self, elapsed: Duration, tenth: u64) -> bool {
        let since = elapsed.saturating_sub(self.last);
        let is_due = since >= self.most || (since >= self.least && tenth > self.last_tenth);
        if is_due {
            (self.last, self.last_tenth) = (elapsed, tenth);
        }
        is_due
    }
}

/// The share that is done.
pub(super) fn millionths(progress: &Progress) -> u64 {
    let share = u128::from(progress.pixels_done) * 1_000_000 / u128::from(progress.pixels_total.max(1));
    share.min(1_000_000) as u64
}

/// Rays a second and time left.
pub(super) fn speed(progress: &Progress, elapsed: Duration) -> String {
    let rate = human::ray_rate(progress.rays, elapsed);
    match time_left(progress, elapsed) {
        Some(left) => format!("{rate}, {} left", human::time(left)),
        None => rate,
    }
}

/// What is left if the rest goes as fast; nothing before the first pixel.
pub(super) fn time_left(progress: &Progress, elapsed: Duration) -> Option<Duration> {
    let left = progress.pixels_total.saturating_sub(progress.pixels_done) as f64;
    let seconds = elapsed.as_secs_f64() * left / progress.pixels_done as f64;
    Duration::try_from_secs_f64(seconds).ok()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    pub(in crate::cli) fn seconds(count: f64) -> Duration {
        Duration::from_secs_f64(count)
    }

    pub(in crate::cli) fn progress(pixels_done: u64, pixels_total: u64) -> Progress {
        Progress { pixels_done, pixels_total, rays: 2_000_000 }
    }

    #[test]
    fn lines_come_by_tenths_or_half_minutes() {
        let mut rhythm = Rhythm::by_tenths();
        assert!(!rhythm.is_due(seconds(0.5), 9), "too soon after the start");
        assert!(rhythm.is_due(seconds(2.0), 1));
        assert!(!rhythm.is_due(seconds(4.0), 1), "no further tenth");
        assert!(rhythm.is_due(seconds(32.0), 1), "half a minute later");
        assert!(rhythm.is_due(seconds(33.0), 2));
        let lines = (0..10_000).filter(|&i| rhythm.is_due(seconds(40.0 + i as f64 * 0.01), 2 + i / 1250));
        assert_eq!(lines.count(), 7, "one a tenth, as tenths follow within half a minute");
    }

    #[test]
    fn shares_and_times_survive_their_ends() {
        assert_eq!(millionths(&progress(0, 0)), 0);
        assert_eq!(millionths(&progress(5, 4)), 1_000_000);
        assert_eq!(millionths(&progress(u64::MAX / 2, u64::MAX)), 499_999);
        assert_eq!(time_left(&progress(0, 10), seconds(1.0)), None);
        assert_eq!(time_left(&progress(10, 10), seconds(1.0)), Some(Duration::ZERO));
        assert_eq!(time_left(&progress(1, 4), seconds(2.0)), Some(seconds(6.0)));
    }

    #[test]
    fn speed_says_rays_and_time_left() {
        assert_eq!(speed(&progress(1, 4), seconds(2.0)), "1.00 Mrays/s, 6.00 s left");
        assert_eq!(speed(&progress(0, 4), Duration::ZERO), "- Mrays/s");
    }
}
