//! A panic at one unit is that unit's failure, and no end of the others.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::batch::BatchError;

/// What `work` gives; an error if it panics. What it shares with others must be as good as new then, or be given up.
pub(super) fn caught<T>(work: impl FnOnce() -> Result<T, BatchError>) -> Result<T, BatchError> {
    catch_unwind(AssertUnwindSafe(work))
        .unwrap_or_else(|payload| Err(BatchError::Panicked(text(&*payload).into())))
}

fn text(payload: &(dyn Any + Send)) -> &str {
    match payload.downcast_ref::<String>() {
        Some(text) => text,
        None => payload.downcast_ref::<&str>().copied().unwrap_or("no reason is known"),
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Failure, RunOptions, Watch, run};
    use crate::batch::{Job, Plan, Split, Store};
    use crate::load::KeptMeshes;
    use crate::wavefront::Progress;
    use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
    use std::time::Duration;

    /// Panics when so many tiles are done, as a fault in a kernel would.
    struct Faulty(AtomicU64);

    impl Watch for Faulty {
        fn begin(&self, _: u64, _: u64) {}
        fn progress(&self, _: Progress) {
            assert!(self.0.fetch_sub(1, Relaxed) != 3, "a fault of the kernel");
        }
        fn unit_done(&self, _: u64, _: &str) {}
        fn unit_failed(&self, _: &Failure) {}
    }

    const JOB: &str =
        "scene = \"seed\"\nsize = [70, 40]\nspp = 2\nframes = \"1-6\"\n[[output]]\npath = \"a.####.png\"\n";

    #[test]
    fn a_panic_is_the_failure_of_its_unit_and_the_others_are_done() {
        for (split, threads) in [(Split::Frames, 1), (Split::Frames, 3), (Split::Samples, 2)] {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("job.toml");
            std::fs::write(&path, JOB).unwrap();
            let meshes = KeptMeshes::keeping();
            let plan = Plan::of(&Job::read(&path).unwrap(), split, 1, folder.path(), &meshes).unwrap();
            let store = Store::open(folder.path(), &plan, false).unwrap();
            let rest = |watch: &Faulty| {
                let options = RunOptions {
                    shard: None,
                    threads,
                    checkpoint_every: Duration::ZERO,
                    max_memory_bytes: 1 << 30,
                    fail_fast: false,
                    stop: &AtomicBool::new(false),
                    meshes: &meshes,
                    watch,
                };
                run(&plan, folder.path(), &store, &options).unwrap()
            };
            let report = rest(&Faulty(AtomicU64::new(9)));
            assert_eq!((report.done, report.failures.len()), (5, 1), "{:?}", report.failures);
            assert!(report.failures[0].error.contains("a fault of the kernel"), "{:?}", report.failures);
            assert_eq!(rest(&Faulty(AtomicU64::new(1 << 40))).done, 1, "the next run does it");
        }
    }
}
