//! How far a bed is from rest.

use crate::grain_bed::GrainBed;
use crate::grains::Grains;
use crate::space::Space;

/// Mean kinetic energy of a grain of a bed at rest, at most (m g d).
const REST_ENERGY: f64 = 1e-6;

/// Mean unbalanced force over mean contact force in a bed at rest, at most (–).
const REST_UNBALANCE: f64 = 1e-3;

/// Share of the grains that do not keep a bed from rest, those of the greatest energy or force: rattlers that bounce
/// in their cages, grains that still roll on the surface.
const RATTLERS: f64 = 0.01;

/// What the motion and the forces of a bed are measured by.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scales {
    /// Mean weight of a grain (N).
    pub(super) weight: f64,
    /// Mean diameter of a grain (m).
    pub(super) diameter: f64,
    /// Time (s) in which a grain falls through half its diameter.
    pub(super) fall_time: f64,
}

impl Scales {
    /// Those of `bed`.
    pub(super) fn of(bed: &GrainBed) -> Self {
        let grains = &bed.grains;
        let diameter = grains.mean_diameter();
        let gravity = bed.gravity.norm();
        Self {
            weight: grains.mass.iter().sum::<f64>() / grains.len() as f64 * gravity,
            diameter,
            fall_time: (diameter / gravity).sqrt(),
        }
    }

    /// Mean kinetic energy of a grain (m g d), of what comes to rest by itself
    /// ([`GrainBed::mean_restless_energy`]).
    pub(super) fn mean_energy(&self, bed: &GrainBed) -> f64 {
        bed.mean_restless_energy() / (self.weight * self.diameter)
    }

    /// How far `bed` is from rest (–): the mean kinetic energy of a grain over 10⁻⁶ m g d, or the mean
    /// unbalanced force over a thousandth of the mean contact force, whichever is more, each without the
    /// greatest hundredth. Below 1 it is at rest.
    pub(super) fn restlessness(&self, bed: &GrainBed) -> f64 {
        let energy = mean_of_calm(energies(&bed.grains)) / (self.weight * self.diameter);
        (energy / REST_ENERGY).max(self.unbalance(bed) / REST_UNBALANCE)
    }

    /// Mean force that is left on a grain, gravity included, but for the greatest hundredth, over the mean force
    /// of a contact (–).
    ///
    /// The mean contact force of a bed at rest follows from its weight, by the stress theorem
    /// p V = Σ f l / D over all contacts (Christoffersen, Mehrabadi & Nemat-Nasser, J. Appl. Mech. 48,
    /// 339 (1981)): with the mean pressure of N grains of weight w and mean height z̄,
    /// p V = N w z̄, and l = d in each of the Z N / 2 contacts, f = 2 D w z̄ / (Z d).
    fn unbalance(&self, bed: &GrainBed) -> f64 {
        let grains = &bed.grains;
        let n = grains.len() as f64;
        let dimensions = match grains.space {
            Space::Planar => 2.0,
            Space::Spatial => 3.0,
        };
        let left = mean_of_calm((0..grains.len()).map(|i| grains.force(i).norm()).collect());
        let height = grains.positions().map(|centre| centre.z).sum::<f64>() / n;
        // A bed that has hardly a contact is in flight, and far from balance whatever it is divided by.
        let coordination = bed.coordination().max(1.0);
        let contact = 2.0 * dimensions * self.weight * height / (coordination * self.diameter);
        left / contact
    }
}

/// Kinetic energy (J) of each grain, in space without spin.
fn energies(grains: &Grains) -> Vec<f64> {
    let energy = |i: usize| {
        let translation = grains.mass[i] * grains.velocity(i).norm_squared();
        let rotation = match grains.space {
            Space::Planar => grains.inertia(i) * grains.spin(i).norm_squared(),
            Space::Spatial => 0.0,
        };
        0.5 * (translation + rotation)
    };
    (0..grains.len()).map(energy).collect()
}

/// Sum of all `values` but the greatest hundredth, over the number of all.
fn mean_of_calm(mut values: Vec<f64>) -> f64 {
    let calm = values.len() - (RATTLERS * values.len() as f64) as usize;
    if calm < values.len() {
        values.select_nth_unstable_by(calm, f64::total_cmp);
    }
    values[..calm].iter().sum::<f64>() / values.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grains::Grain;
    use crate::math::Vec3;

    /// `n` discs of 1 g, of which the first have the given speeds (m/s).
    fn discs(n: u32, speeds: &[f64]) -> Grains {
        let disc = |id: u32| Grain {
            position: Vec3::new(f64::from(id), 0.0, 0.0),
            velocity: Vec3::x() * speeds.get(id as usize).copied().unwrap_or(0.0),
            spin: Vec3::zeros(),
            radius: 0.01,
            mass: 1e-3,
            id,
        };
        Grains::new(Space::Planar, &(0..n).map(disc).collect::<Vec<_>>())
    }

    #[test]
    fn two_grains_in_flight_among_two_hundred_leave_a_bed_calm_and_a_third_does_not() {
        assert_eq!(mean_of_calm(energies(&discs(200, &[3.0, 2.0]))).to_bits(), 0.0_f64.to_bits());
        // The third has ½ · 1 g · (1 m/s)², which is all that counts.
        let third = mean_of_calm(energies(&discs(200, &[3.0, 1.0, 2.0])));
        assert!((third * 200.0 / 0.5e-3 - 1.0).abs() < 1e-14, "{third}");
    }

    #[test]
    fn in_a_bed_of_less_than_a_hundred_grains_every_one_counts() {
        assert!(mean_of_calm(energies(&discs(99, &[1.0]))) > 0.0);
    }
}
