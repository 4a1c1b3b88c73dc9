//! How work is split over threads: by the data, never by the number of threads.
//!
//! The unit of work, of dispatch and of every sum is a block of `BLOCK` consecutive grains. Each
//! block adds up its own part in order, and the parts are added in block order on one thread, so the
//! same run has the same bits on any number of threads.

use crate::error::ThreadsError;

/// Grains per block.
pub(crate) const BLOCK: usize = 512;

/// The block of grain `i`.
#[inline]
pub(crate) fn block_of(i: usize) -> usize {
    i / BLOCK
}

/// Runs `work` on a pool of `n` threads (0: one per core).
///
/// # Errors
/// If the system does not give the threads.
pub fn with_threads<R: Send>(n: usize, work: impl FnOnce() -> R + Send) -> Result<R, ThreadsError> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(n)
        .build()
        .map_err(|source| ThreadsError { threads: n, source })?;
    Ok(pool.install(work))
}

/// How many threads the current pool has.
pub fn n_threads() -> usize {
    rayon::current_num_threads()
}
