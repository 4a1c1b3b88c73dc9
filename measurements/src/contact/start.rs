//! How a run begins.

use crate::Run;

/// The way of a run over a few readings around first contact.
pub(crate) struct Start {
    /// Forward (m).
    pub(crate) dx: f64,
    /// Down (m).
    pub(crate) dz: f64,
    /// Time (s).
    pub(crate) dt: f64,
}

impl Start {
    /// From the last reading before first contact, or the first of all, to the third after it.
    pub(crate) fn of(run: &Run) -> Option<Self> {
        let frames = &run.frames;
        let from = frames.iter().rposition(|frame| frame.t <= 0.0).unwrap_or(0);
        let to = (from + 3).min(frames.len().checked_sub(1)?);
        let (a, b) = (frames[from], frames[to]);
        (to > from).then_some(Self { dx: b.x - a.x, dz: b.z - a.z, dt: b.t - a.t })
    }
}
