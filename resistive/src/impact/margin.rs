//! What can happen to an impact within a step, as quantities that stay positive until it does.

use super::super::assembly::PARTS;

/// What can happen between two steps, as indices of [`Margins`].
pub(super) const N_MARGINS: usize = STOPPING + 3;

/// What can happen to each part: it crosses the surface, a held velocity component turns, it stops to sink, it turns back.
pub(super) const PER_PART: usize = 5;
pub(super) const SURFACE: usize = 0;
pub(super) const COMPONENTS: usize = 1;
pub(super) const SINKING: usize = 3;
pub(super) const FORWARD: usize = 4;

/// What can happen to the whole: friction may hold it, it passes from speeding up to slowing, it is almost at rest.
pub(super) const STOPPING: usize = PER_PART * PARTS;
pub(super) const SLOWING: usize = STOPPING + 1;
pub(super) const SLOW: usize = STOPPING + 2;

/// By the indices above, the first [`PER_PART`] of the first part.
pub(super) type Margins = [f64; N_MARGINS];

/// What happened first in a step, and what else at the same time.
pub(super) struct Fired {
    pub(super) time: f64,
    pub(super) which: [bool; N_MARGINS],
}

/// The margins where a look at a step begins.
pub(super) struct Before {
    pub(super) margins: Margins,
    /// Whether something has just happened there.
    pub(super) fresh: bool,
}
