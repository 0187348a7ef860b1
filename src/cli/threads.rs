//! `--threads`: how many a verb takes.

use rayon::{ThreadPool, ThreadPoolBuilder};

use super::error::{CliError, Exit};
use crate::batch::default_threads;

/// So many are taken at their word, and of more only as many as there are processors: the others would look for work all the
/// time, and keep from it those that have some.
const TAKEN_AT_THEIR_WORD: usize = 64;

/// The number of threads that `--threads` means: for 0 one for each processor that this process may use.
pub(super) fn threads(asked: u16) -> usize {
    limited(usize::from(asked), default_threads())
}

/// So many threads that wait for work.
pub(super) fn pool(asked: u16) -> Result<ThreadPool, CliError> {
    let pool = ThreadPoolBuilder::new().num_threads(threads(asked)).build();
    pool.map_err(|error| CliError::new(Exit::Failed, "worker threads cannot be started").because(error))
}

fn limited(asked: usize, processors: usize) -> usize {
    match asked {
        0 => processors,
        asked => asked.min(processors.max(TAKEN_AT_THEIR_WORD)),
    }
}

#[cfg(test)]
mod tests {
    use super::limited;

    #[test]
    fn more_threads_than_a_few_and_than_processors_are_not_taken() {
        assert_eq!([0, 1, 64, 65, 4096].map(|asked| limited(asked, 2)), [2, 1, 64, 64, 64]);
        assert_eq!([0, 65, 128, 4096].map(|asked| limited(asked, 128)), [128, 65, 128, 128]);
    }
}
