//! Drag in proportion to the speed.

use crate::{Account, Flow, Immersion, Load, Motion, ResistanceLaw, Surroundings};
use engine::ledger::{Channel, ChannelKind};
use engine::params::{ParamSpec, Range};

use super::facts::{Confounder, Facts, Kind, Needs};
use super::registry::{OtherForm, ResistanceEntry, Role, amplitude};

/// F = −q ρ A √(g D) (D/D₀)^(n − 1/2) (z/D₀)^p v in the bed, D₀ = 25 mm   (N)
///
/// With n = −1 it grows with the diameter. With p = 0 that is the drag of a viscous fluid: 3π η D v gives
/// q = 12 η/(ρ √(g D₀) D₀). With p = 1/2 it is the linear term of the friction μ(I) of grains of diameter d at the pressure
/// ρ g z and the shear rate v/D: μ′ I ρ g z A gives q = μ′ d/D₀.
///
/// Source: linear band between quasi-static and quadratic drag, Froude 1 to 5, in published simulations, with n = 1/2;
/// Stokes, Trans. Cambridge Phil. Soc. 9, 8 (1851), for 3π η D v; da Cruz, Emam, Prochnow, Roux & Chevoir, Phys. Rev. E 72,
/// 021309 (2005), for μ(I).
struct ViscousDrag {
    q: f64,
    size_exponent: f64,
    depth_exponent: f64,
}

/// D₀ (m).
const REFERENCE: f64 = 0.025;

const ACCOUNTS: &[Account] = &[Account {
    channel: Channel { name: "viscous-drag", kind: ChannelKind::Dissipated },
    flow: Flow::Dynamic,
}];

/// The registry's line.
pub(super) const ENTRY: ResistanceEntry = ResistanceEntry {
    name: "viscous-drag",
    role: Role::Effect(Facts {
        kind: Kind::Physics,
        unit: "1",
        visible: &[],
        separable_from: &[Confounder { effect: "yield-stress", any_of: &[Needs::Speeds] }],
    }),
    summary: "A drag in proportion to the speed.",
    formula: "F = -q rho A sqrt(g D) (D/25 mm)^(n - 1/2) (z/25 mm)^p v",
    signature: "depth falls by the same fraction at all speeds, stopping time hardly moves, soft landing",
    source: "term of the resistance law between the quasi-static and the quadratic regime",
    params: &[
        amplitude(
            Range::closed(0.0, 200.0),
            Range::closed(0.0, 10.0),
            "drag in units of rho A sqrt(g D) v",
        ),
        ParamSpec::number(
            "size_exponent",
            "power n of the diameter in the drag over the area: 1/2 for grains, -1 for a viscous fluid",
        )
        .or(0.5)
        .allowed(Range::closed(-2.0, 2.0))
        .plausible(Range::closed(-1.0, 0.5)),
        ParamSpec::number(
            "depth_exponent",
            "power p of the depth in the drag: 0 for a fluid, 1/2 for the friction of grains",
        )
        .or(0.0)
        .allowed(Range::closed(0.0, 2.0))
        .plausible(Range::closed(0.0, 0.5)),
    ],
    forms: &[
        OtherForm { values: &[("size_exponent", -1.0)], needs: &[Needs::Diameters] },
        OtherForm { values: &[("size_exponent", -1.0), ("depth_exponent", 0.5)], needs: &[] },
    ],
    variables: &[],
    accounts: ACCOUNTS,
    build: |given| {
        Box::new(ViscousDrag {
            q: given.get("q"),
            size_exponent: given.get("size_exponent"),
            depth_exponent: given.get("depth_exponent"),
        })
    },
};

impl ResistanceLaw for ViscousDrag {
    fn accounts(&self) -> &'static [Account] {
        ACCOUNTS
    }

    fn act(&self, at: &Immersion, motion: &Motion, bed: &Surroundings, load: &mut Load) {
        let size = libm::pow(at.diameter / REFERENCE, self.size_exponent - 0.5);
        let depth = libm::pow(at.depth.max(0.0) / REFERENCE, self.depth_exponent);
        let scale = (bed.gravity * at.diameter).sqrt() * size * depth;
        load.dynamic -= motion.velocity * (self.q * bed.bulk_density * at.loaded_area * scale);
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{SPHERE, sinking, surroundings};
    use super::*;

    const GRAINS: ViscousDrag = ViscousDrag { q: 0.5, size_exponent: 0.5, depth_exponent: 0.0 };

    #[test]
    fn the_force_is_linear_in_the_speed() {
        let bed = surroundings();
        let (mut slow, mut fast) = (Load::default(), Load::default());
        GRAINS.act(&SPHERE.at(0.02), &sinking(1.0), &bed, &mut slow);
        GRAINS.act(&SPHERE.at(0.02), &sinking(3.0), &bed, &mut fast);
        let scale = (9.8_f64 * 0.0254).sqrt();
        let expected = 0.5 * bed.bulk_density * SPHERE.frontal_area() * scale;
        assert!((slow.dynamic.z - expected).abs() < 1e-12);
        assert!((fast.dynamic.z - 3.0 * expected).abs() < 1e-12);
    }

    #[test]
    fn a_viscous_fluid_drags_in_proportion_to_the_diameter() {
        let bed = surroundings();
        let viscosity = 0.8;
        let scale = bed.bulk_density * (bed.gravity * REFERENCE).sqrt() * REFERENCE;
        let stokes =
            ViscousDrag { q: 12.0 * viscosity / scale, size_exponent: -1.0, depth_exponent: 0.0 };
        for diameter in [0.01, 0.03] {
            let area = std::f64::consts::PI * diameter * diameter / 4.0;
            let sphere = Immersion { diameter, loaded_area: area, ..SPHERE.at(0.02) };
            let mut load = Load::default();
            stokes.act(&sphere, &sinking(2.0), &bed, &mut load);
            let expected = 3.0 * std::f64::consts::PI * viscosity * diameter * 2.0;
            assert!((load.dynamic.z - expected).abs() < 1e-12 * expected);
        }
    }

    #[test]
    fn the_friction_of_grains_grows_with_the_inertial_number() {
        let bed = surroundings();
        let (grain, slope, speed) = (0.0005, 1.8, 1.5);
        let friction =
            ViscousDrag { q: slope * grain / REFERENCE, size_exponent: -1.0, depth_exponent: 0.5 };
        for depth in [0.015, 0.04] {
            let sphere = SPHERE.at(depth);
            let mut load = Load::default();
            friction.act(&sphere, &sinking(speed), &bed, &mut load);
            let pressure = bed.bulk_density * bed.gravity * sphere.depth;
            let shear_rate = speed / sphere.diameter;
            let inertial_number = shear_rate * grain / (pressure / bed.bulk_density).sqrt();
            let expected = slope * inertial_number * pressure * sphere.loaded_area;
            assert!((load.dynamic.z - expected).abs() < 1e-12 * expected);
        }
    }
}
