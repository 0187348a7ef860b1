//! How far a render is, on standard error: a bar, lines, JSON objects or nothing; then how it ended, once.

mod events;
mod style;

use std::io::IsTerminal;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::sync::{Mutex, OnceLock};
use std::time::{Duration, Instant};

use serde_json::json;

use super::args::ProgressMode;
use super::error::CliError;
use super::pipeline::Progress;
use super::rhythm::{Rhythm, millionths, speed};
use super::stdio::say;
use super::summary::Ending;
use crate::batch::run::Failure;
use events::{failed_event, progress_event};
use style::{Style, style};

/// Tells the user how a render goes. All threads may call it.
pub(super) struct Reporter {
    style: Style,
    quiet: bool,
    begun: OnceLock<Instant>,
    rhythm: Mutex<Rhythm>,
    /// Share of the picture done, in millionths.
    done_millionths: AtomicU64,
    /// Units done and in all, where there is more than one picture.
    units: [AtomicU64; 2],
    ended: AtomicBool,
}

impl Reporter {
    /// A reporter for this mode; `auto` looks at standard error, and a bar needs a terminal.
    pub(super) fn new(mode: ProgressMode, quiet: bool) -> Self {
        let style = style(mode, quiet, std::io::stderr().is_terminal());
        Self {
            rhythm: Mutex::new(style.rhythm()),
            style,
            quiet,
            begun: OnceLock::new(),
            done_millionths: AtomicU64::new(0),
            units: Default::default(),
            ended: AtomicBool::new(false),
        }
    }

    /// Says something that is no error, unless the user wants quiet.
    pub(super) fn warn(&self, text: &str) {
        match self.style {
            _ if self.quiet => {}
            Style::Json => say(&json!({ "event": "warning", "message": text }).to_string()),
            _ => say(&format!("warning: {text}")),
        }
    }

    /// Says where and why the program panicked.
    pub(super) fn panicked(&self, text: &str) {
        match self.style {
            Style::Json => say(&json!({ "event": "warning", "message": text }).to_string()),
            _ => say(text),
        }
    }

    /// Starts the clock of the render.
    pub(super) fn begin(&self) {
        self.begun.get_or_init(Instant::now);
    }

    /// Says how many units there are to do.
    pub(super) fn count(&self, units: u64) {
        self.units[1].store(units, Relaxed);
    }

    /// One unit more is done.
    pub(super) fn counted(&self) {
        self.units[0].fetch_add(1, Relaxed);
    }

    /// A unit has failed, and others go on.
    pub(super) fn unit_failed(&self, failure: &Failure) {
        let Failure { unit, picture, error } = failure;
        match &self.style {
            Style::Json => {
                let event =
                    json!({ "event": "unit_failed", "unit": unit, "picture": picture, "error": error });
                say(&event.to_string());
            }
            Style::Bar(bar) => bar.suspend(|| say(&format!("failed: {picture}: {error}"))),
            _ => say(&format!("failed: {picture}: {error}")),
        }
    }

    /// Time since the render began.
    pub(super) fn elapsed(&self) -> Duration {
        self.begun.get().map_or(Duration::ZERO, Instant::elapsed)
    }

    /// The share of the picture that is done, in percent.
    pub(super) fn percent_done(&self) -> u64 {
        self.done_millionths.load(Relaxed) / 10_000
    }

    /// Takes note of progress and shows it when it is time to.
    pub(super) fn advance(&self, progress: &Progress) {
        let millionths = millionths(progress);
        self.done_millionths.fetch_max(millionths, Relaxed);
        // A thread that finds another one showing progress goes back to work.
        let Ok(mut rhythm) = self.rhythm.try_lock() else { return };
        let elapsed = self.elapsed();
        if rhythm.is_due(elapsed, millionths / 100_000) {
            self.show(progress, elapsed);
        }
    }

    /// Ends the render well: the summary, or the event `done`.
    pub(super) fn done(&self, summary: &dyn Ending) {
        if !self.end() {
            return;
        }
        match self.style {
            Style::Json => say(&summary.to_json().to_string()),
            _ if self.quiet => {}
            _ => say(&summary.to_string()),
        }
    }

    /// Ends the render badly; in JSON this tells the user and marks the error as told.
    pub(super) fn failed(&self, error: CliError) -> CliError {
        if !self.end() || !matches!(self.style, Style::Json) {
            return error;
        }
        say(&failed_event(&error).to_string());
        error.told()
    }

    /// Whether this is the first call; later ones are too late to say anything.
    fn end(&self) -> bool {
        if let Style::Bar(bar) = &self.style {
            bar.finish_and_clear();
        }
        !self.ended.swap(true, Relaxed)
    }

    fn show(&self, progress: &Progress, elapsed: Duration) {
        let [done, units] = self.units.each_ref().map(|count| count.load(Relaxed));
        let speed = match units {
            0 => speed(progress, elapsed),
            units => format!("{done} of {units} units, {}", speed(progress, elapsed)),
        };
        match &self.style {
            Style::Bar(bar) => {
                bar.set_length(progress.pixels_total);
                bar.set_message(speed);
                bar.set_position(progress.pixels_done);
            }
            Style::Plain => {
                say(&format!("{:>3} %, {speed}", millionths(progress) / 10_000));
            }
            Style::Json => {
                let mut event = progress_event(progress, elapsed);
                if units > 0 {
                    event["units_done"] = done.into();
                    event["units_total"] = units.into();
                }
                say(&event.to_string());
            }
            Style::Silent => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::rhythm::tests::progress;

    #[test]
    fn only_the_first_end_counts() {
        let reporter = Reporter::new(ProgressMode::None, true);
        assert!(reporter.end());
        assert!(!reporter.end());
    }

    #[test]
    fn progress_never_goes_back() {
        let reporter = Reporter::new(ProgressMode::None, true);
        reporter.begin();
        reporter.advance(&progress(3, 4));
        reporter.advance(&progress(2, 4));
        assert_eq!(reporter.percent_done(), 75);
    }
}
