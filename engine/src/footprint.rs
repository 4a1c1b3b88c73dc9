//! What the grains that touch an intruder cover of it, and the force that their collisions alone would
//! make.

use crate::contact::Contact;
use crate::math::Vec3;

/// The grains that touch one part of an intruder.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Footprint {
    /// Sum of the cross-sections π r² of the touching grains (m²); planar, of their diameters (m). What
    /// the bed covers of the surface, up to how densely grains lie on it.
    pub covered_area: f64,
    /// Force on the part if every touching grain were hit anew, once in the time in which the surface
    /// moves a grain's diameter, and took nothing back: m* v_n²/(2 r) along the normal (N). Times
    /// 1 + e, it is the collisional estimate.
    ///
    /// Source: the three-shape manuscript, eqs 8–10, with the contacts that there are in place of k dS/r²;
    /// v_n = v cos α, and only where the surface moves towards the grain.
    pub collisional_force: Vec3,
    /// Sum of the magnitudes of the same (N): what eq. 11 prints, which has one cos α less than the drag
    /// along the motion.
    pub collisional_magnitudes: f64,
}

impl Footprint {
    /// Adds a grain of `radius` (m) that covers `cross_section` (m², planar m); `velocity` (m/s) is that
    /// of the surface where it touches.
    pub(crate) fn add_grain(
        &mut self,
        contact: &Contact,
        radius: f64,
        cross_section: f64,
        velocity: Vec3,
    ) {
        self.covered_area += cross_section;
        let towards = velocity.dot(&contact.normal).max(0.0);
        let force = contact.mass_eff() * towards * towards / (2.0 * radius);
        self.collisional_force -= contact.normal * force;
        self.collisional_magnitudes += force;
    }

    /// Adds the footprint of other grains.
    pub(crate) fn add(&mut self, other: &Self) {
        self.covered_area += other.covered_area;
        self.collisional_force += other.collisional_force;
        self.collisional_magnitudes += other.collisional_magnitudes;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Grains evenly over a dome of radius R that moves straight down: the sums become the integrals
    /// ∫cos² dS = 2πR²/3 and ∫cos³ dS = πR²/2.
    #[test]
    fn a_dome_feels_the_integrals_of_the_estimate() {
        let (speed, radius) = (3.0, 1e-3);
        let (n_rings, n_around) = (400, 16);
        let mut footprint = Footprint::default();
        for ring in 0..n_rings {
            // Rings of equal area: equal steps of the cosine.
            let cos = (f64::from(ring) + 0.5) / f64::from(n_rings);
            let sin = (1.0 - cos * cos).sqrt();
            for k in 0..n_around {
                let (s, c) =
                    libm::sincos(2.0 * std::f64::consts::PI * f64::from(k) / f64::from(n_around));
                let normal = Vec3::new(sin * c, sin * s, -cos);
                let velocity = Vec3::new(0.0, 0.0, -speed);
                footprint.add_grain(&Contact::pressed(normal), radius, 1e-6, velocity);
            }
        }
        let n = f64::from(n_rings * n_around);
        let one = 1e-5 * speed * speed / (2.0 * radius);
        // The mean over the dome, whose area is 2πR². Midpoint rule: (1/400)² of a parabola.
        assert!((footprint.collisional_magnitudes / (n * one) - 1.0 / 3.0).abs() < 1e-5);
        let drag = footprint.collisional_force;
        assert!((drag.z / (n * one) - 1.0 / 4.0).abs() < 1e-5);
        assert!(drag.x.abs() + drag.y.abs() < 1e-10 * drag.z);
        assert!((footprint.covered_area / (n * 1e-6) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_surface_that_leaves_a_grain_behind_collides_with_nothing() {
        let mut footprint = Footprint::default();
        footprint.add_grain(&Contact::pressed(-Vec3::z()), 1e-3, 1e-6, Vec3::z());
        assert_eq!(footprint.collisional_force, Vec3::zeros());
        assert_eq!(footprint.collisional_magnitudes.to_bits(), 0.0_f64.to_bits());
    }
}
