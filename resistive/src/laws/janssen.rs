//! Friction that saturates with depth, as pressure does in a silo.

use crate::{Immersion, Motion, ResistanceLaw, Surroundings};
use engine::params::Range;

use super::facts::{Confounder, Facts, Kind, Needs};
use super::registry::{ResistanceEntry, Role, amplitude};

/// z → λ (1 − e^(−z/λ)), q = D/λ   (m)
///
/// in every friction that grows with depth. λ is the depth at which walls carry the weight.
///
/// Source: Janssen, Z. Ver. Dt. Ing. 39, 1045 (1895); K 0.5–0.8 and wall friction 0.2–0.5 give λ of 1.2
/// to 5 box radii.
struct Janssen {
    q: f64,
}

/// The registry's line.
pub(super) const ENTRY: ResistanceEntry = ResistanceEntry {
    name: "janssen",
    role: Role::Effect(Facts {
        kind: Kind::Physics,
        unit: "1",
        visible: &[],
        separable_from: &[Confounder { effect: "depth-exponent", any_of: &[Needs::Depths] }],
    }),
    summary: "Friction that saturates with depth, as the pressure in a silo does.",
    formula: "z -> lambda (1 - exp(-z/lambda)), q = D/lambda",
    signature: "depth and stopping time grow, most at high speed",
    source: "Janssen, Z. Ver. Dt. Ing. 39, 1045 (1895)",
    params: &[amplitude(
        Range::closed(0.0, 20.0),
        Range::closed(0.0, 5.0),
        "intruder diameter over saturation depth lambda",
    )],
    forms: &[],
    variables: &[],
    accounts: &[],
    build: |given| Box::new(Janssen { q: given.get("q") }),
};

impl ResistanceLaw for Janssen {
    fn expose(&self, at: &mut Immersion, _: &Motion, _: &Surroundings) {
        // exp(x) − 1 keeps its digits as q goes to zero, where z must be left as it is.
        let rate = self.q / at.diameter;
        if rate != 0.0 {
            at.effective_depth = -libm::expm1(-rate * at.effective_depth) / rate;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{SPHERE, sinking, surroundings};
    use super::*;

    #[test]
    fn depth_saturates_at_lambda_and_is_itself_without_the_effect() {
        let mut deep = SPHERE.at(10.0);
        Janssen { q: 0.5 }.expose(&mut deep, &sinking(1.0), &surroundings());
        assert!((deep.effective_depth - 2.0 * 0.0254).abs() < 1e-12);
        for q in [0.0, 1e-12] {
            let mut at = SPHERE.at(0.02);
            Janssen { q }.expose(&mut at, &sinking(1.0), &surroundings());
            assert!((at.effective_depth - 0.02).abs() < 1e-13);
        }
    }
}
