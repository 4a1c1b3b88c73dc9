//! What is dropped, how, and how well it is seen.

use measurements::Kind;

use super::forces::Setting;
use super::imperfection::Imperfection;

/// Diameter (m) and mass (kg) of four spheres: two of steel, two of titanium.
const SPHERES: [[f64; 2]; 4] = [[0.0254, 0.0667], [0.0254, 0.035], [0.018, 0.024], [0.018, 0.0125]];

/// Speed (m/s), angle (deg), which sphere, spin (rad/s), packing fraction, depth of the bed (m).
type Line = (f64, f64, usize, f64, f64, f64);

/// Every effect of the list acts here, and none like another.
const FULL: [Line; 22] = [
    (0.6, 90.0, 0, 0.0, 0.585, 0.30),
    (1.2, 90.0, 1, 0.0, 0.60, 0.30),
    (2.0, 90.0, 2, 0.0, 0.585, 0.09),
    (3.0, 90.0, 0, 0.0, 0.60, 0.09),
    (3.5, 90.0, 3, 0.0, 0.57, 0.30),
    (1.6, 90.0, 0, 120.0, 0.60, 0.30),
    (0.8, 75.0, 0, 0.0, 0.615, 0.15),
    (1.8, 75.0, 1, -120.0, 0.60, 0.30),
    (2.8, 75.0, 2, 0.0, 0.57, 0.09),
    (0.6, 60.0, 2, 0.0, 0.60, 0.30),
    (1.4, 60.0, 0, 60.0, 0.585, 0.09),
    (2.4, 60.0, 3, 0.0, 0.615, 0.30),
    (3.4, 60.0, 1, 0.0, 0.60, 0.15),
    (1.0, 45.0, 1, 0.0, 0.57, 0.30),
    (2.0, 45.0, 0, -60.0, 0.60, 0.30),
    (3.2, 45.0, 2, 120.0, 0.585, 0.15),
    (1.5, 35.0, 3, 0.0, 0.60, 0.30),
    (3.5, 35.0, 0, 0.0, 0.615, 0.30),
    (2.2, 90.0, 1, 0.0, 0.585, 0.15),
    (1.2, 75.0, 0, 60.0, 0.60, 0.30),
    (3.0, 60.0, 0, 0.0, 0.57, 0.09),
    (2.6, 35.0, 2, -60.0, 0.60, 0.30),
];

/// How many of the last conditions are held out.
const HELD_OUT: usize = 4;

/// Conditions, instrument and bed of a campaign.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// What is dropped and how.
    pub settings: Vec<Setting>,
    /// How many of the last settings are held out.
    pub held_out: usize,
    /// Runs of each condition.
    pub repeats: usize,
    /// Positions over time, or scalars alone.
    pub kind: Kind,
    /// Root mean square error of one reading of a position (m).
    pub camera: f64,
    /// Deviation of the logarithm of each coefficient from bed to bed.
    pub coefficient_scatter: f64,
    /// Deviation of the resistance along the path, relative; sideways it is half of that.
    pub path_scatter: f64,
    /// What is not as the file says.
    pub imperfection: Imperfection,
}

impl Design {
    /// Two diameters, four masses, five angles, spins of both signs, four packings, three depths of
    /// the bed: 18 conditions and 4 held out, five runs each.
    pub fn full() -> Self {
        Self {
            settings: FULL.map(setting).to_vec(),
            held_out: HELD_OUT,
            repeats: 5,
            kind: Kind::Trajectory,
            camera: 1e-4,
            coefficient_scatter: 0.05,
            path_scatter: 0.12,
            imperfection: Imperfection::None,
        }
    }

    /// One sphere without spin, six speeds at three angles, one packing, one depth of the bed.
    pub fn one_intruder() -> Self {
        let fitted = [90.0, 60.0, 35.0].into_iter().flat_map(|angle| {
            [0.6, 1.2, 1.8, 2.4, 3.0, 3.5].map(|speed| (speed, angle, 0, 0.0, 0.59, 0.30))
        });
        let held_out = [(1.5, 90.0), (2.1, 60.0), (2.7, 35.0), (3.2, 90.0)];
        let held_out = held_out.map(|(speed, angle)| (speed, angle, 0, 0.0, 0.59, 0.30));
        Self { settings: fitted.chain(held_out).map(setting).collect(), ..Self::full() }
    }

    /// Everything straight down and without spin.
    pub fn vertical() -> Self {
        let mut design = Self::full();
        for setting in &mut design.settings {
            (setting.angle_deg, setting.spin) = (90.0, 0.0);
        }
        design
    }

    /// Stopping time, final depth and final range alone.
    pub fn scalars() -> Self {
        Self { kind: Kind::Scalar, ..Self::full() }
    }
}

fn setting((speed, angle_deg, sphere, spin, packing, bed_depth): Line) -> Setting {
    let [diameter, mass] = SPHERES[sphere];
    Setting { speed, angle_deg, mass, diameter, spin, packing, bed_depth }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_full_design_holds_what_tells_every_effect_from_its_confounders() {
        let design = Design::full();
        let fitted = &design.settings[..design.settings.len() - design.held_out];
        let distinct = |of: fn(&Setting) -> f64| {
            let mut values: Vec<f64> = fitted.iter().map(of).collect();
            values.sort_by(f64::total_cmp);
            values.dedup();
            values
        };
        assert_eq!(fitted.len(), 18);
        assert_eq!(distinct(|s| s.diameter).len(), 2);
        assert_eq!(distinct(|s| s.mass).len(), 4);
        assert_eq!(distinct(|s| s.angle_deg).len(), 5);
        assert_eq!(distinct(|s| s.packing).len(), 4);
        assert_eq!(distinct(|s| s.bed_depth).len(), 3);
        let speeds = distinct(|s| s.speed);
        assert!(speeds[speeds.len() - 1] > 3.0 * speeds[0]);
        let spins = distinct(|s| s.spin);
        assert!(spins[0] < 0.0 && spins[spins.len() - 1] > 0.0);
    }
}
