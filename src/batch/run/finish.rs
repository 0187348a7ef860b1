//! From a unit's sums to its files.

use std::sync::Mutex;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::mpsc::Receiver;

use super::active::Active;
use super::panics::caught;
use super::queue::Waiting;
use super::work::Work;
use crate::batch::BatchError;
use crate::batch::compose::{files, film};
use crate::batch::plan::Split;

/// A unit whose files only need to be written.
pub(super) struct Finished {
    of: Waiting,
    nan_samples: u64,
    files: Vec<(String, Vec<u8>)>,
}

/// The files of a unit: those of its picture, or its sums if it is a part of one.
pub(super) fn encoded(work: &Work, active: &Active) -> Result<Finished, BatchError> {
    let part = active.take();
    let (nan_samples, picture) = (part.nan_samples, &work.plan.pictures[part.unit.picture]);
    let files = match work.plan.split {
        Split::Frames => {
            let film = film(picture.size, active.scene.settings.aovs, &[part]);
            files(picture, &active.scene, film)?
        }
        Split::Tiles | Split::Samples => {
            vec![(work.store.sums_path(active.of.unit), part.encode(work.store.plan()))]
        }
    };
    Ok(Finished { of: active.of, nan_samples, files })
}

/// One thread: writes what comes until nothing more can come.
pub(super) fn write_all(work: &Work, finished: &Mutex<Receiver<Finished>>) {
    loop {
        let next = finished.lock().expect("no thread panics while it waits for files").recv();
        let Ok(Finished { of: Waiting { unit, size_bytes }, nan_samples, files }) = next else { return };
        match caught(|| work.store.finish(unit, nan_samples, &files)) {
            Ok(()) => {
                let picture = &work.plan.pictures[work.plan.unit(unit).picture].name;
                tracing::info!(unit, picture, "unit done");
                work.counts.units.fetch_add(1, Relaxed);
                work.counts.nan_samples.fetch_add(nan_samples, Relaxed);
                work.options.watch.unit_done(unit, picture);
            }
            Err(error) => work.failed(unit, &error),
        }
        drop(files);
        work.queue.release(size_bytes);
    }
}
