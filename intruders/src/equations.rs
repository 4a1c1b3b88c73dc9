//! Equations of motion of planar bodies in a few coordinates: inertia and forces at points of them.

use engine::math::{Mat4, Vec3, Vec4};
use resistive::assembly::COORDINATES;

/// How the coordinates move a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Point {
    /// Change of its x with each coordinate (1 or m).
    pub(crate) along_x: Vec4,
    /// The same of its z.
    pub(crate) along_z: Vec4,
    /// Its acceleration while the rates of the coordinates do not change (m/s²).
    pub(crate) bias: Vec3,
}

/// Mass matrix and generalised forces, by the principle of virtual power.
pub(crate) struct Equations {
    matrix: Mat4,
    right: Vec4,
}

impl Equations {
    /// Those of no bodies in the first `used` coordinates; the others stay at rest.
    pub(crate) fn new(used: usize) -> Self {
        let mut matrix = Mat4::zeros();
        for index in used..COORDINATES {
            matrix[(index, index)] = 1.0;
        }
        Self { matrix, right: Vec4::zeros() }
    }

    /// Adds a point of `mass` (kg).
    pub(crate) fn add_mass(&mut self, point: &Point, mass: f64) {
        for row in [&point.along_x, &point.along_z] {
            self.matrix += row * row.transpose() * mass;
        }
        self.add_force(point, -point.bias * mass);
    }

    /// Adds a moment of inertia (kg m²) to the angle `coordinate`.
    pub(crate) fn add_inertia(&mut self, coordinate: usize, inertia: f64) {
        self.matrix[(coordinate, coordinate)] += inertia;
    }

    /// Adds a force (N) at a point.
    pub(crate) fn add_force(&mut self, point: &Point, force: Vec3) {
        self.right += point.along_x * force.x + point.along_z * force.z;
    }

    /// Adds a couple (N m) on the angle `coordinate`.
    pub(crate) fn add_couple(&mut self, coordinate: usize, couple: f64) {
        self.right[coordinate] += couple;
    }

    /// What acts on the coordinates so far (N or N m).
    pub(crate) fn load(&self) -> Vec4 {
        self.right
    }

    /// Momenta of the coordinates (kg m/s or kg m²/s) that move at these `rates` (m/s or rad/s).
    pub(crate) fn momenta(&self, rates: &Vec4) -> Vec4 {
        self.matrix * rates
    }

    /// Rates of coordinates that have these `momenta`; NaN as in [`Equations::solve`].
    pub(crate) fn rates(&self, momenta: &Vec4) -> Vec4 {
        self.matrix.lu().solve(momenta).unwrap_or(Vec4::repeat(f64::NAN))
    }

    /// Accelerations of the coordinates; NaN where the mass matrix is singular, which a body with mass
    /// and inertia never has, so that an integration ends with an error.
    pub(crate) fn solve(&self) -> [f64; COORDINATES] {
        self.matrix.lu().solve(&self.right).map_or([f64::NAN; COORDINATES], Into::into)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_singular_mass_matrix_gives_no_number_and_no_panic() {
        let mut equations = Equations::new(2);
        equations.add_couple(0, 1.0);
        assert!(equations.solve().iter().all(|value| value.is_nan()));
    }

    #[test]
    fn a_force_on_a_point_accelerates_its_mass_and_nothing_else() {
        let point = Point { along_x: Vec4::x(), along_z: Vec4::y(), bias: Vec3::zeros() };
        let mut equations = Equations::new(2);
        equations.add_mass(&point, 2.0);
        equations.add_force(&point, Vec3::new(1.0, 0.0, -4.0));
        let expected = [0.5, -2.0, 0.0, 0.0];
        // Powers of two: exact.
        assert!(equations.solve().iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-16));
    }
}
