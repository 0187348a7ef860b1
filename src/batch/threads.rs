//! How many threads this process should use.

use super::BatchError;
use crate::wavefront::RenderError;

/// The processors that this process may use: by affinity, control group and `SLURM_CPUS_PER_TASK`, whichever is least.
pub fn default_threads() -> usize {
    let allowed = std::thread::available_parallelism().map_or(1, usize::from);
    limited(allowed, std::env::var("SLURM_CPUS_PER_TASK").ok().as_deref())
}

/// A pool of so many.
pub(super) fn workers(threads: usize) -> Result<rayon::ThreadPool, BatchError> {
    let workers = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    Ok(workers.map_err(RenderError::from)?)
}

fn limited(allowed: usize, slurm: Option<&str>) -> usize {
    match slurm.and_then(|text| text.parse().ok()) {
        Some(given) if given > 0 => allowed.min(given),
        _ => allowed,
    }
}

#[cfg(test)]
mod tests {
    use super::limited;

    #[test]
    fn the_least_counts() {
        assert_eq!(limited(8, Some("2")), 2);
        assert_eq!(limited(2, Some("8")), 2);
        for nonsense in [None, Some(""), Some("0"), Some("many")] {
            assert_eq!(limited(3, nonsense), 3);
        }
    }
}
