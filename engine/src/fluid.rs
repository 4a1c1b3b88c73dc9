//! A fluid at rest, as a body in it feels it.

/// A fluid that fills the space around grains and bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fluid {
    /// (kg/m³).
    pub density: f64,
    /// Dynamic viscosity (Pa s).
    pub viscosity: f64,
}

impl Fluid {
    /// Drag over velocity (kg/s) on a body of `diameter` (m) and frontal `area` (m²) at `speed` (m/s), far from others:
    ///
    /// F = ½ ρ A (0.63 √v + 4.8 √(η/(ρ D)))² v
    ///
    /// which is ½ ρ C_D A v² with C_D = (0.63 + 4.8/√Re)²: of a sphere within 15 % of the standard curve up to Re = 100,
    /// 30 % above it at 1000 and 15 % at 10 000.
    ///
    /// Source: Dallavalle, Micromeritics (1948).
    pub fn resistance(&self, diameter: f64, area: f64, speed: f64) -> f64 {
        let viscous = 4.8 * (self.viscosity / (self.density * diameter)).sqrt();
        let root = 0.63 * speed.abs().sqrt() + viscous;
        0.5 * self.density * area * root * root
    }

    /// Mass of the fluid that moves with a body of `diameter` (m) and `volume` (m³) along its axis (kg): that of the
    /// spheroid of the same diameter and volume. A sphere has half of the mass that it displaces, a thin disc 8/3 ρ R³.
    pub fn added_mass(&self, diameter: f64, volume: f64) -> f64 {
        let sphere = std::f64::consts::PI / 6.0 * diameter * diameter * diameter;
        self.density * volume * added_mass_of_spheroid(volume / sphere)
    }
}

/// Added mass of a spheroid that moves along its axis, over the mass that it displaces; it is `slenderness` times as long
/// as wide.
///
/// Source: Lamb, Hydrodynamics (1932), §114 and §373.
pub fn added_mass_of_spheroid(slenderness: f64) -> f64 {
    let alpha = alpha(1.0 - 1.0 / (slenderness * slenderness));
    alpha / (2.0 - alpha)
}

/// Lamb's α₀ of a spheroid of half-length a and radius b along its axis, with t = 1 − b²/a²: 2/3 of a sphere, 2 of a disc,
/// 0 of a needle.
fn alpha(t: f64) -> f64 {
    // Where the closed forms lose digits: a geometric series, of which ten terms leave 1e-14.
    const NEAR_A_SPHERE: f64 = 0.03;
    let root = t.abs().sqrt();
    let sum = if t.abs() < NEAR_A_SPHERE {
        (0..10).rev().fold(0.0, |sum, n| 1.0 / f64::from(2 * n + 3) + t * sum)
    } else if t > 0.0 {
        (libm::atanh(root) - root) / (root * t)
    } else {
        (root - libm::atan(root)) / (root * -t)
    };
    2.0 * (1.0 - t) * sum
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    const WATER: Fluid = Fluid { density: 998.0, viscosity: 1.002e-3 };

    /// Added mass over displaced mass of a spheroid so many times as long as wide.
    fn coefficient(slenderness: f64) -> f64 {
        let diameter: f64 = 0.02;
        let volume = PI / 6.0 * diameter * diameter * diameter * slenderness;
        WATER.added_mass(diameter, volume) / (WATER.density * volume)
    }

    #[test]
    fn added_masses_of_spheroids_are_those_of_lamb() {
        // Lamb, Hydrodynamics (1932), p. 155: k₁ of prolate ellipsoids.
        for (slenderness, listed) in [
            (1.0, 0.5),
            (1.5, 0.305),
            (2.0, 0.209),
            (2.99, 0.122),
            (3.99, 0.082),
            (6.01, 0.045),
            (9.97, 0.021),
        ] {
            // Slendernesses are rounded to two decimals: 0.005 of one is 0.0013 at 1.5.
            assert!((coefficient(slenderness) - listed).abs() < 1.5e-3, "{slenderness}");
        }
    }

    #[test]
    fn a_thin_disc_moves_eight_thirds_of_its_radius_cubed() {
        let diameter: f64 = 0.02;
        let thin = 1e-6 * PI / 6.0 * diameter * diameter * diameter;
        let disc = 8.0 / 3.0 * WATER.density * 1e-6;
        assert!((WATER.added_mass(diameter, thin) / disc - 1.0).abs() < 1e-5);
    }

    #[test]
    fn the_series_meets_the_closed_forms() {
        for t in [0.03_f64, -0.03] {
            let within = alpha(t * (1.0 - 1e-9));
            let beyond = alpha(t * (1.0 + 1e-9));
            assert!((within - beyond).abs() < 1e-9, "{t}: {within} {beyond}");
        }
    }
}
