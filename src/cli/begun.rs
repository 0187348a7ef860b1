//! When the program began.

use std::sync::OnceLock;
use std::time::{Duration, Instant};

static BEGUN: OnceLock<Instant> = OnceLock::new();

/// Starts the clock: to be called first of all. What the system did before, it does not tell.
pub fn begin() {
    BEGUN.get_or_init(Instant::now);
}

/// Time since then.
pub(super) fn elapsed() -> Duration {
    BEGUN.get_or_init(Instant::now).elapsed()
}
