//! Running a plan, and telling how it goes.

use std::path::Path;
use std::sync::Arc;

use super::WorkArgs;
use super::report::Summary;
use crate::batch::run::{Failure, RunOptions, RunReport, Watch, run};
use crate::batch::{Plan, Shard, Store, first_lines};
use crate::cli::error::{CliError, Exit};
use crate::cli::log::Log;
use crate::cli::pipeline::Progress;
use crate::cli::progress::Reporter;
use crate::cli::signals::Interrupt;
use crate::cli::simd;
use crate::cli::threads::threads;
use crate::load::KeptMeshes;

/// Does `work` with somebody to tell the user, and tells how it ended.
pub(super) fn with_reporter(
    args: &WorkArgs,
    work: impl FnOnce(&Reporter, &Interrupt) -> Result<Summary, CliError>,
) -> Result<(), CliError> {
    let reporter = Arc::new(Reporter::new(args.progress, args.quiet));
    tell_panics(&reporter);
    let told = Log::begin(args.log.as_deref()).and_then(|log| {
        let outcome = listen(&reporter).and_then(|interrupt| work(&reporter, &interrupt));
        log.judged(outcome)
    });
    match told {
        Ok(summary) => {
            reporter.done(&summary);
            Ok(())
        }
        Err(error) => Err(reporter.failed(error)),
    }
}

/// A panic ends no batch: it is said where it was, in the way of all that is said.
fn tell_panics(reporter: &Arc<Reporter>) {
    let told = Arc::clone(reporter);
    std::panic::set_hook(Box::new(move |panic| {
        tracing::error!("{panic}");
        told.panicked(&panic.to_string());
    }));
}

/// Until there is work to keep, a signal ends the program.
fn listen(reporter: &Arc<Reporter>) -> Result<Interrupt, CliError> {
    if let Some(advice) = simd::advice(simd::BUILT_FOR, simd::offered()) {
        reporter.warn(&advice);
    }
    let told = Arc::clone(reporter);
    Interrupt::install_patient(move || {
        told.failed(CliError::new(Exit::Stopped, "stopped at once: what was kept before is there"))
    })
}

/// A plan to be run.
pub(super) struct Batch<'a> {
    pub(super) plan: &'a Plan,
    /// The plan's.
    pub(super) folder: &'a Path,
    pub(super) output: &'a Path,
    pub(super) shard: Option<Shard>,
    pub(super) work: &'a WorkArgs,
    /// Those that making the plan has loaded, if it was made here.
    pub(super) meshes: &'a KeptMeshes,
}

impl Batch<'_> {
    /// Renders what is not done.
    pub(super) fn run(&self, reporter: &Reporter, interrupt: &Interrupt) -> Result<Summary, CliError> {
        let store = Store::open(self.output, self.plan, self.work.force)?;
        interrupt.defer(true);
        let threads = threads(self.work.threads);
        let options = RunOptions {
            shard: self.shard,
            threads,
            checkpoint_every: self.work.checkpoint_every,
            max_memory_bytes: self.work.max_memory,
            fail_fast: self.work.fail_fast,
            stop: interrupt.flag(),
            meshes: self.meshes,
            watch: &Told(reporter),
        };
        tracing::info!(name = self.plan.name, units = self.plan.units(), threads, "run");
        let report = run(self.plan, self.folder, &store, &options)?;
        interrupt.defer(false);
        self.judged(report, threads)
    }

    fn judged(&self, report: RunReport, threads: usize) -> Result<Summary, CliError> {
        let units = self.plan.units_of(self.shard).count() as u64;
        let done = report.done + report.done_before;
        tracing::info!(done, units, failed = report.failures.len(), stopped = report.stopped, "end");
        if report.stopped && done < units {
            let what =
                format!("stopped: {done} of {units} units are done; the same command goes on from there");
            return Err(CliError::new(Exit::Stopped, what));
        }
        if !report.failures.is_empty() {
            return Err(CliError::new(Exit::Failed, failed(&report.failures, units)));
        }
        let output = self.output.display().to_string();
        Ok(Summary { name: self.plan.name.clone(), report, threads, output })
    }
}

/// Most failures that the last message repeats: each was told when it happened.
const MOST_LISTED: usize = 20;

fn failed(failures: &[Failure], units: u64) -> String {
    let line = |failure: &Failure| format!("{}: {}", failure.picture, failure.error);
    let lines = first_lines(MOST_LISTED, failures.iter().map(line)).join("\n  ");
    format!("{} of {units} units failed:\n  {lines}", failures.len())
}

/// A reporter as a batch sees it.
struct Told<'a>(&'a Reporter);

impl Watch for Told<'_> {
    fn begin(&self, to_do: u64, _done_before: u64) {
        self.0.begin();
        self.0.count(to_do);
    }

    fn progress(&self, progress: Progress) {
        self.0.advance(&progress);
    }

    fn unit_done(&self, _unit: u64, _picture: &str) {
        self.0.counted();
    }

    fn unit_failed(&self, failure: &Failure) {
        self.0.unit_failed(failure);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lists_of_failures_end() {
        let failure = |unit| Failure { unit, picture: format!("frame {unit}"), error: "no".into() };
        let text = failed(&(0..23).map(failure).collect::<Vec<_>>(), 40);
        assert!(
            text.starts_with("23 of 40 units failed:\n  frame 0: no\n") && text.ends_with("and 3 more"),
            "{text}"
        );
        assert!(!failed(&[failure(1)], 2).contains("more"));
    }
}
