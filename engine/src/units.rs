//! Quantities with units: `"4.46 cm"` in a file, SI `f64` everywhere else.

/// The physical dimension of a quantity: powers of kilogram, metre and second, doubled so that
/// `N/m^1.5` has whole numbers, and a flag for plane angles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dimension {
    /// Twice the power of the kilogram.
    pub kilogram_2: i8,
    /// Twice the power of the metre.
    pub metre_2: i8,
    /// Twice the power of the second.
    pub second_2: i8,
    /// Twice the power of the radian.
    pub radian_2: i8,
}

impl Dimension {
    const fn of(kilogram: i8, metre: i8, second: i8, radian: i8) -> Self {
        Self {
            kilogram_2: 2 * kilogram,
            metre_2: 2 * metre,
            second_2: 2 * second,
            radian_2: 2 * radian,
        }
    }

    /// A pure number.
    pub const NONE: Self = Self::of(0, 0, 0, 0);
    /// Length [m].
    pub const LENGTH: Self = Self::of(0, 1, 0, 0);
    /// Mass [kg].
    pub const MASS: Self = Self::of(1, 0, 0, 0);
    /// Time [s].
    pub const TIME: Self = Self::of(0, 0, 1, 0);
    /// Rate [1/s].
    pub const RATE: Self = Self::of(0, 0, -1, 0);
    /// Speed [m/s].
    pub const SPEED: Self = Self::of(0, 1, -1, 0);
    /// Acceleration [m/s²].
    pub const ACCELERATION: Self = Self::of(0, 1, -2, 0);
    /// Plane angle [rad].
    pub const ANGLE: Self = Self::of(0, 0, 0, 1);
    /// Angular velocity [rad/s].
    pub const SPIN: Self = Self::of(0, 0, -1, 1);
    /// Spring stiffness [N/m].
    pub const STIFFNESS: Self = Self::of(1, 0, -2, 0);
    /// Mass density [kg/m³].
    pub const DENSITY: Self = Self::of(1, -3, 0, 0);
    /// Density of a planar medium [kg/m²].
    pub const AREA_DENSITY: Self = Self::of(1, -2, 0, 0);
}
