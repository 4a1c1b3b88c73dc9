//! Room to work in: buffers that are kept from step to step, one set for each thread.

use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::contact::table::Merger;
use crate::math::Vec3;
use crate::neighbours::Neighbourhood;
use crate::surface::SurfacePoint;

/// The buffers of all threads. What is in them is of no use to the next who takes them.
pub(super) struct BuffersOfThreads(Vec<Mutex<ThreadBuffers>>);

impl BuffersOfThreads {
    /// For the threads of the current pool; those of a larger one would wait for each other.
    pub(super) fn new() -> Self {
        Self((0..rayon::current_num_threads()).map(|_| Mutex::default()).collect())
    }

    /// Those of this thread.
    pub(super) fn own(&self) -> MutexGuard<'_, ThreadBuffers> {
        let thread = rayon::current_thread_index().unwrap_or(0) % self.0.len();
        self.0[thread].lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The buffers of one thread.
#[derive(Default)]
pub(super) struct ThreadBuffers {
    pub(super) points: Vec<Vec3>,
    pub(super) points_half: Vec<Vec3>,
    pub(super) nearest: Vec<SurfacePoint>,
    pub(super) nearest_half: Vec<SurfacePoint>,
    /// At least as long as there are candidates; how many of them are near is known anew in each step.
    pub(super) near: Vec<u32>,
    pub(super) near_rows: Vec<u32>,
    pub(super) keys: Vec<[u32; 2]>,
    pub(super) neighbourhood: Neighbourhood,
    pub(super) halo: Vec<u32>,
    pub(super) merger: Merger,
}
