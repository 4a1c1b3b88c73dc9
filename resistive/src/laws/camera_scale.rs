//! A camera whose scale is wrong.

use crate::ResistanceLaw;
use engine::params::Range;

use super::facts::{Confounder, Facts, Kind, Needs};
use super::registry::{ResistanceEntry, Role, amplitude};

/// z → (1 + q) z, x → (1 + q) x   (m)
///
/// as they are read. A fault of the instrument: it changes no run, only what a measurement makes of it.
///
/// Source: magnification of a camera.
struct CameraScale {
    q: f64,
}

/// The registry's line.
pub(super) const ENTRY: ResistanceEntry = ResistanceEntry {
    name: "camera-scale",
    role: Role::Effect(Facts {
        kind: Kind::Apparatus,
        unit: "1",
        visible: &[],
        separable_from: &[Confounder { effect: "depth-zero", any_of: &[Needs::Conditions] }],
    }),
    summary: "A wrong scale of the camera: changes no run, only its reading.",
    formula: "z -> (1+q) z, x -> (1+q) x, as read",
    signature: "all positions are off by the same fraction, in the flight too; stopping times are right",
    source: "magnification of a camera",
    params: &[amplitude(
        Range::closed(-0.25, 0.25),
        Range::closed(-0.05, 0.05),
        "relative error of every length that is read",
    )],
    forms: &[],
    variables: &[],
    accounts: &[],
    build: |given| Box::new(CameraScale { q: given.get("q") }),
};

impl ResistanceLaw for CameraScale {
    fn read(&self, depth: &mut f64, range: &mut f64) {
        *depth *= 1.0 + self.q;
        *range *= 1.0 + self.q;
    }
}

#[cfg(test)]
mod tests {

    use super::*;

    #[test]
    fn every_length_is_read_longer_by_the_same_fraction() {
        let (mut depth, mut range) = (0.05, -0.02);
        CameraScale { q: 0.1 }.read(&mut depth, &mut range);
        assert!((depth - 0.055).abs() < 1e-16 && (range + 0.022).abs() < 1e-16);
    }
}
