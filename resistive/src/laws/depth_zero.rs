//! A depth whose zero is not the surface.

use crate::ResistanceLaw;
use engine::params::Range;

use super::facts::{Facts, Kind};
use super::registry::{ResistanceEntry, Role, amplitude};

/// z → z + q (1 mm)   (m)
///
/// as it is read. A fault of the instrument: it changes no run, only what a measurement makes of it.
///
/// Source: level of the surface as it is set in a picture.
struct DepthZero {
    q: f64,
}

/// The registry's line.
pub(super) const ENTRY: ResistanceEntry = ResistanceEntry {
    name: "depth-zero",
    role: Role::Effect(Facts {
        kind: Kind::Apparatus,
        unit: "mm",
        visible: &[],
        separable_from: &[],
    }),
    summary: "A wrong zero of depth: changes no run, only its reading.",
    formula: "z -> z + q, as read, q in millimetres",
    signature: "all depths are off by the same length, in the flight too; ranges and stopping times are right",
    source: "level of the surface as it is set in a picture",
    params: &[amplitude(
        Range::closed(-20.0, 20.0),
        Range::closed(-2.0, 2.0),
        "offset of every depth that is read, in millimetres",
    )],
    forms: &[],
    variables: &[],
    accounts: &[],
    build: |given| Box::new(DepthZero { q: given.get("q") }),
};

impl ResistanceLaw for DepthZero {
    fn read(&self, depth: &mut f64, _: &mut f64) {
        *depth += self.q * 1e-3;
    }
}

#[cfg(test)]
mod tests {

    use super::*;

    #[test]
    fn every_depth_is_read_deeper_by_the_same_length() {
        let (mut depth, mut range) = (0.05, 0.02);
        DepthZero { q: 1.5 }.read(&mut depth, &mut range);
        assert!((depth - 0.0515).abs() < 1e-16 && (range - 0.02).abs() < 1e-16);
    }
}
