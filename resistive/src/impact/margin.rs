//! What can happen to an impact within a step, as quantities that stay positive until it does.

use super::super::assembly::PARTS;

/// What can happen between two steps, as indices of [`Margins`].
pub(super) const N_MARGINS: usize = 5 * PARTS + 3;
pub(super) const SURFACE: usize = 0;
pub(super) const COMPONENTS: usize = 1;
pub(super) const SINKING: usize = 3;
pub(super) const FORWARD: usize = 4;
pub(super) const STOPPING: usize = 5 * PARTS;
pub(super) const SLOWING: usize = STOPPING + 1;
pub(super) const SLOW: usize = STOPPING + 2;

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
