//! What base laws remember of their damping, for the ledger alone: its work over a step is the mean of its forces
//! at both ends times the way.

use engine::lanes::Vector;

engine::record! {
    /// Damping forces (N) at the end of the last step.
    pub(crate) struct Damped<R, const N: usize> {
        pub(crate) normal: R,
        pub(crate) tangential: Vector<R, N>,
    }
}
