//! Quantities with units: `"4.46 cm"` in a file, SI `f64` everywhere else.
//!
//! [`parse`] reads one, [`format_si`] writes it so that it reads back to the same bits.

use std::fmt;

mod parse;
mod pattern;

pub use parse::{UnitError, UnitFault, dimension_of, parse};
pub use pattern::pattern;

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
    /// Length (m).
    pub const LENGTH: Self = Self::of(0, 1, 0, 0);
    /// Volume (m³).
    pub const VOLUME: Self = Self::of(0, 3, 0, 0);
    /// Mass (kg).
    pub const MASS: Self = Self::of(1, 0, 0, 0);
    /// Time (s).
    pub const TIME: Self = Self::of(0, 0, 1, 0);
    /// Rate (1/s).
    pub const RATE: Self = Self::of(0, 0, -1, 0);
    /// Speed (m/s).
    pub const SPEED: Self = Self::of(0, 1, -1, 0);
    /// Acceleration (m/s²).
    pub const ACCELERATION: Self = Self::of(0, 1, -2, 0);
    /// Plane angle (rad).
    pub const ANGLE: Self = Self::of(0, 0, 0, 1);
    /// Angular velocity (rad/s).
    pub const SPIN: Self = Self::of(0, 0, -1, 1);
    /// Spring stiffness (N/m).
    pub const STIFFNESS: Self = Self::of(1, 0, -2, 0);
    /// Mass per length (kg/m).
    pub const MASS_PER_LENGTH: Self = Self::of(1, -1, 0, 0);
    /// Mass density (kg/m³).
    pub const DENSITY: Self = Self::of(1, -3, 0, 0);
    /// Density of a planar medium (kg/m²).
    pub const AREA_DENSITY: Self = Self::of(1, -2, 0, 0);
    /// Surface tension or work of adhesion (J/m²), the same as N/m.
    pub const SURFACE_ENERGY: Self = Self::STIFFNESS;
    /// Force (N).
    pub const FORCE: Self = Self::of(1, 1, -2, 0);
    /// Pressure or elastic modulus (Pa).
    pub const PRESSURE: Self = Self::of(1, -1, -2, 0);
    /// Dynamic viscosity (Pa s).
    pub const VISCOSITY: Self = Self::of(1, -1, -1, 0);
    /// Energy (J).
    pub const ENERGY: Self = Self::of(1, 2, -2, 0);

    /// The dimension with these powers of kilogram, metre and second, if they are halves of small whole
    /// numbers but for round-off.
    pub fn from_powers(powers: [f64; 3]) -> Option<Self> {
        let doubled = |power: f64| {
            let twice = (2.0 * power).round();
            let fits = (2.0 * power - twice).abs() < 1e-9 && twice.abs() <= f64::from(i8::MAX);
            fits.then_some(twice as i8)
        };
        let [kilogram, metre, second] = powers.map(doubled);
        Some(Self { kilogram_2: kilogram?, metre_2: metre?, second_2: second?, radian_2: 0 })
    }

    /// The same with angles as pure numbers.
    #[must_use]
    pub const fn without_angle(self) -> Self {
        Self { radian_2: 0, ..self }
    }

    /// What it is called, and its unit: `a speed (m/s)`.
    #[must_use]
    pub fn describe(self) -> String {
        match KINDS.iter().find(|kind| kind.dimension == self) {
            Some(kind) if self != Self::NONE => format!("{} ({})", kind.name, kind.si_unit()),
            _ => self.name(),
        }
    }

    /// What it is called, with its article, such as `a length`.
    #[must_use]
    pub fn name(self) -> String {
        KINDS.iter().find(|kind| kind.dimension == self).map_or_else(
            || format!("a quantity in {}", self.si_unit()),
            |kind| kind.name.to_owned(),
        )
    }

    /// The unit that [`format_si`] writes, such as `kg/m^3`; empty for a pure number.
    #[must_use]
    pub fn si_unit(self) -> String {
        if let Some(kind) = KINDS.iter().find(|kind| kind.dimension == self) {
            return kind.si_unit().to_owned();
        }
        let powers = [
            ("kg", self.kilogram_2),
            ("m", self.metre_2),
            ("s", self.second_2),
            ("rad", self.radian_2),
        ];
        let atoms: Vec<String> = powers
            .iter()
            .filter(|(_, twice)| *twice != 0)
            .map(|(atom, twice)| match twice {
                2 => (*atom).to_owned(),
                _ => format!("{atom}^{}", f64::from(*twice) / 2.0),
            })
            .collect();
        atoms.join("*")
    }

    /// How `number` may be written with this dimension: `"3 mm"`, `"3 cm"` or `"3 m"`.
    #[must_use]
    pub fn examples(self, number: &str) -> String {
        let own = [self.si_unit()];
        let units: Vec<&str> = match KINDS.iter().find(|kind| kind.dimension == self) {
            Some(kind) => kind.units.to_vec(),
            None => own.iter().map(String::as_str).collect(),
        };
        let quoted: Vec<String> = units
            .iter()
            .map(|unit| match unit.is_empty() {
                true => number.to_owned(),
                false => format!("\"{number} {unit}\""),
            })
            .collect();
        match quoted.split_last() {
            Some((last, [])) => last.clone(),
            Some((last, others)) => format!("{} or {last}", others.join(", ")),
            None => number.to_owned(),
        }
    }
}

/// A dimension that has a name, and the units that messages show for it.
struct Kind {
    dimension: Dimension,
    name: &'static str,
    /// In the order shown; the last is the SI unit.
    units: &'static [&'static str],
}

impl Kind {
    fn si_unit(&self) -> &'static str {
        self.units.last().copied().unwrap_or_default()
    }
}

const KINDS: &[Kind] = &[
    Kind { dimension: Dimension::NONE, name: "a pure number", units: &[""] },
    Kind { dimension: Dimension::LENGTH, name: "a length", units: &["mm", "cm", "m"] },
    Kind { dimension: Dimension::VOLUME, name: "a volume", units: &["mm^3", "m^3"] },
    Kind { dimension: Dimension::MASS, name: "a mass", units: &["g", "kg"] },
    Kind { dimension: Dimension::TIME, name: "a time", units: &["us", "ms", "s"] },
    Kind { dimension: Dimension::RATE, name: "a rate", units: &["1/s"] },
    Kind { dimension: Dimension::SPEED, name: "a speed", units: &["cm/s", "m/s"] },
    Kind { dimension: Dimension::ACCELERATION, name: "an acceleration", units: &["m/s^2"] },
    Kind { dimension: Dimension::ANGLE, name: "an angle", units: &["deg", "rad"] },
    Kind {
        dimension: Dimension::SPIN,
        name: "an angular velocity",
        units: &["rpm", "deg/s", "rad/s"],
    },
    Kind { dimension: Dimension::STIFFNESS, name: "a stiffness", units: &["N/mm", "N/m"] },
    Kind {
        dimension: Dimension::MASS_PER_LENGTH,
        name: "a mass per length",
        units: &["g/cm", "kg/m"],
    },
    Kind { dimension: Dimension::DENSITY, name: "a density", units: &["g/cm^3", "kg/m^3"] },
    Kind { dimension: Dimension::AREA_DENSITY, name: "a density per area", units: &["kg/m^2"] },
    Kind { dimension: Dimension::FORCE, name: "a force", units: &["mN", "N"] },
    Kind { dimension: Dimension::PRESSURE, name: "a pressure", units: &["kPa", "MPa", "Pa"] },
    Kind { dimension: Dimension::VISCOSITY, name: "a viscosity", units: &["mPa s", "Pa s"] },
    Kind { dimension: Dimension::ENERGY, name: "an energy", units: &["mJ", "J"] },
];

/// `value` with its SI unit, such as `0.0446 m`; [`parse`] gives the same bits back.
pub fn format_si(value: f64, dimension: Dimension) -> String {
    let digits = format!("{value:?}");
    let digits = digits.strip_suffix(".0").unwrap_or(&digits);
    match dimension.si_unit() {
        unit if unit.is_empty() => digits.to_owned(),
        unit => format!("{digits} {unit}"),
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.si_unit())
    }
}

/// `value` to so many significant digits; what is not finite stays as it is.
pub fn significant(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bits(text: &str, dimension: Dimension) -> u64 {
        parse(text, dimension).unwrap_or_else(|error| panic!("{error}")).to_bits()
    }

    #[test]
    fn decimal_units_are_exact() {
        assert_eq!(bits("4.46 cm", Dimension::LENGTH), 0.0446f64.to_bits());
        assert_eq!(bits("0.049 g", Dimension::MASS), 0.049e-3f64.to_bits());
        assert_eq!(bits("10 us", Dimension::TIME), 1e-5f64.to_bits());
        assert_eq!(bits("10µs", Dimension::TIME), 1e-5f64.to_bits());
        assert_eq!(bits("1e4 1/s", Dimension::RATE), 1e4f64.to_bits());
        assert_eq!(bits("2.7 g/cm^3", Dimension::DENSITY), 2700f64.to_bits());
        assert_eq!(bits("9.81 m/s²", Dimension::ACCELERATION), 9.81f64.to_bits());
        assert_eq!(bits("3.2 N/mm", Dimension::STIFFNESS), 3200f64.to_bits());
    }

    #[test]
    fn ninety_degrees_is_half_pi() {
        assert_eq!(bits("90 deg", Dimension::ANGLE), std::f64::consts::FRAC_PI_2.to_bits());
        assert_eq!(bits("180 °", Dimension::ANGLE), std::f64::consts::PI.to_bits());
    }

    #[test]
    fn inches_and_cubic_centimetres_are_units() {
        assert_eq!(bits("1 in", Dimension::LENGTH), 0.0254f64.to_bits());
        assert_eq!(bits("1 inch", Dimension::LENGTH), 0.0254f64.to_bits());
        assert_eq!(bits("1.52 g/cc", Dimension::DENSITY), 1520f64.to_bits());
    }

    #[test]
    fn a_unit_says_its_dimension() {
        assert_eq!(dimension_of("cm/s"), Some(Dimension::SPEED));
        assert_eq!(dimension_of("1"), Some(Dimension::NONE));
        assert_eq!(dimension_of("furlong"), None);
        assert_eq!(Dimension::from_powers([1.0, 1.0, -2.0]), Some(Dimension::FORCE));
        assert_eq!(Dimension::from_powers([0.0, 0.3, 0.0]), None);
        assert_eq!(Dimension::FORCE.describe(), "a force (N)");
        assert_eq!(Dimension::SPIN.without_angle(), Dimension::RATE);
    }

    #[test]
    fn half_powers_are_dimensions() {
        let wanted = Dimension { kilogram_2: 2, metre_2: -1, second_2: -4, radian_2: 0 };
        assert_eq!(bits("5 N/m^1.5", wanted), 5f64.to_bits());
        assert_eq!(bits(&format_si(5.0, wanted), wanted), 5f64.to_bits());
    }

    #[test]
    fn si_text_reads_back_to_the_same_bits() {
        let mut state = 1u64;
        for _ in 0..2000 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let value = f64::from_bits(state);
            if value.is_finite() {
                for kind in KINDS {
                    let text = format_si(value, kind.dimension);
                    assert_eq!(bits(&text, kind.dimension), value.to_bits(), "{text}");
                }
            }
        }
    }

    #[test]
    fn the_message_says_what_to_write() {
        let message = |text| parse(text, Dimension::LENGTH).expect_err("not a length").to_string();
        assert_eq!(
            message("3 kg"),
            "\"3 kg\" is a mass, expected a length; write \"3 mm\", \"3 cm\" or \"3 m\""
        );
        assert_eq!(
            message("25,4 mm"),
            "\"25,4 mm\" has a decimal comma, expected a length; write \"25.4 mm\", with a decimal point"
        );
        assert!(message("3 px").contains("scale of the camera"));
        assert!(message("3").starts_with("\"3\" has no unit"));
        assert!(message("3 mmm").starts_with("the unit `mmm` in"));
        assert!(message("nan m").contains("does not begin with a number"));
        assert!(message("1e999 m").contains("out of range"));
        assert!(message("1e-999 m").contains("out of range"));
        assert!(message("3 m/").contains("not known"));
        assert!(message("é").contains("does not begin"));
    }
}
