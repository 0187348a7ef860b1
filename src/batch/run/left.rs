//! What is left to do of a plan.

use crate::batch::faults::Faults;
use crate::batch::{BatchError, Plan, Shard, Store};

/// The units that are not done, and what is known of those that are.
#[derive(Default)]
pub(super) struct Left {
    pub(super) to_do: Vec<u64>,
    /// How many are done.
    pub(super) done: u64,
    /// Contributions to those that were left out because they were not numbers.
    pub(super) nan_samples: u64,
}

/// What is left of a shard, or of all.
///
/// **Errors:** records that are damaged or foreign.
pub(super) fn left(plan: &Plan, store: &Store, shard: Option<Shard>) -> Result<Left, BatchError> {
    let (mut left, mut faults) = (Left::default(), Faults::default());
    for unit in plan.units_of(shard) {
        match faults.note(store.record(unit))?.flatten() {
            Some(record) => {
                left.done += 1;
                left.nan_samples += record.nan_samples;
            }
            None => left.to_do.push(unit),
        }
    }
    faults.told().map(|()| left)
}
