//! Faults of many files, told together but not without end.

use super::BatchError;

/// Most damaged or changed files that are named.
pub(super) const MOST_NAMED: usize = 10;

/// The first lines, and how many there are more.
pub(crate) fn first_lines(most: usize, lines: impl Iterator<Item = String>) -> Vec<String> {
    let mut lines = lines.fuse();
    let mut first: Vec<String> = lines.by_ref().take(most).collect();
    let more = lines.count();
    if more > 0 {
        first.push(format!("and {more} more"));
    }
    first
}

/// Damaged files, of which one is not to hide the others.
#[derive(Default)]
pub(super) struct Faults(Vec<BatchError>);

impl Faults {
    /// What an outcome holds, unless it says that a file is damaged: that is noted.
    ///
    /// **Errors:** all others.
    pub(super) fn note<T>(&mut self, outcome: Result<T, BatchError>) -> Result<Option<T>, BatchError> {
        match outcome {
            Err(fault @ BatchError::Damaged { .. }) => {
                self.0.push(fault);
                Ok(None)
            }
            outcome => outcome.map(Some),
        }
    }

    /// All of both.
    pub(super) fn join(mut self, later: Self) -> Self {
        self.0.extend(later.0);
        self
    }

    /// **Errors:** what was noted.
    pub(super) fn told(mut self) -> Result<(), BatchError> {
        match self.0.len() {
            0 => Ok(()),
            1 => Err(self.0.remove(0)),
            _ => Err(BatchError::ManyDamaged(first_lines(MOST_NAMED, self.0.iter().map(BatchError::told)))),
        }
    }
}
