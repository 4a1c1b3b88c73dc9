//! Factors of a force, as text and in words.

use resistive::formula::Formula;

/// Variables that factors use: depth of the lowest point, diameter, speed, impact speed, √(g D), impact angle; and a
/// millimetre.
const VARIABLES: [&str; 7] = ["z", "D", "v", "v_0", "V_s", "theta", MILLIMETRE];

/// The constant that lengths of the bed are written in.
pub(super) const MILLIMETRE: &str = "mm";

/// Half the width of a layer at half of its height, over its width in the formula.
const HALF_HEIGHT: f64 = 0.833;

/// Where a body is and how it moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct State {
    /// Depth of the lowest point (m).
    pub(super) depth: f64,
    /// (m/s)
    pub(super) speed: f64,
    /// At first contact (m/s).
    pub(super) impact_speed: f64,
    /// Impact angle below the horizontal (rad).
    pub(super) angle: f64,
    /// (m)
    pub(super) diameter: f64,
    /// (m/s²)
    pub(super) gravity: f64,
}

impl State {
    /// √(g D) (m/s).
    pub(super) fn own_speed(&self) -> f64 {
        (self.gravity * self.diameter).sqrt()
    }
}

/// What a length is a multiple of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Length {
    Diameters,
    Millimetres,
}

impl Length {
    /// The unit (m) for a body of `diameter` (m).
    pub(super) fn size(self, diameter: f64) -> f64 {
        match self {
            Self::Diameters => diameter,
            Self::Millimetres => 1e-3,
        }
    }

    /// Depth in this unit, as a formula writes it.
    fn depth(self) -> &'static str {
        match self {
            Self::Diameters => "z / D",
            Self::Millimetres => "z / mm",
        }
    }

    fn words(self, value: f64) -> String {
        match self {
            Self::Diameters => format!("{value:.2} diameters"),
            Self::Millimetres => format!("{value:.0} mm"),
        }
    }
}

/// What a force depends on. Powers are of depth over diameter; speeds are in √(g D).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Factor {
    DepthPower(f64),
    Layer { unit: Length, centre: f64, width: f64 },
    Below { unit: Length, depth: f64, width: f64 },
    Above { unit: Length, depth: f64, width: f64 },
    Fading { unit: Length, over: f64 },
    SpeedPower(f64),
    Saturating { at: f64 },
    Slow { below: f64 },
    ImpactSpeedPower(f64),
    LeftPower(f64),
    Slowed { to: f64, width: f64 },
    Sine,
    Cosine,
    SineOfTwice,
}

impl Factor {
    /// As a formula writes it.
    fn text(self) -> String {
        match self {
            Self::DepthPower(power) => powered("(z / D)", power),
            Self::Layer { unit, centre, width } => {
                format!("exp(0 - (({} - {}) / {})^2)", unit.depth(), short(centre), short(width))
            }
            Self::Below { unit, depth, width } => {
                let (over, depth, width) = (unit.depth(), short(depth), short(width));
                format!("(0.5 + 0.5 * tanh(({over} - {depth}) / {width}))")
            }
            Self::Above { unit, depth, width } => {
                let (over, depth, width) = (unit.depth(), short(depth), short(width));
                format!("(0.5 - 0.5 * tanh(({over} - {depth}) / {width}))")
            }
            Self::Fading { unit, over } => {
                format!("exp(0 - ({}) / {})", unit.depth(), short(over))
            }
            Self::SpeedPower(power) => powered("(v / V_s)", power),
            Self::Saturating { at } => format!("((v / V_s) / (v / V_s + {}))", short(at)),
            Self::Slow { below } => format!("(1 / (1 + ((v / V_s) / {})^2))", short(below)),
            Self::ImpactSpeedPower(power) => powered("(v_0 / V_s)", power),
            Self::LeftPower(power) => powered("(v / v_0)", power),
            Self::Slowed { to, width } => {
                format!("(0.5 - 0.5 * tanh((v / v_0 - {}) / {}))", short(to), short(width))
            }
            Self::Sine => "sin(theta)".to_owned(),
            Self::Cosine => "cos(theta)".to_owned(),
            Self::SineOfTwice => "sin(2 * theta)".to_owned(),
        }
    }

    /// As the end of a sentence that begins with "a force that".
    fn words(self) -> String {
        match self {
            Self::DepthPower(power) => format!("grows with {}", power_words("depth", power)),
            Self::Layer { unit, centre, width } => {
                let half = HALF_HEIGHT * width;
                let [from, to] = [(centre - half).max(0.0), centre + half];
                format!("acts in a layer from {} to {} deep", unit.words(from), unit.words(to))
            }
            Self::Below { unit, depth, .. } => format!("acts deeper than {}", unit.words(depth)),
            Self::Above { unit, depth, .. } => format!("acts down to {}", unit.words(depth)),
            Self::Fading { unit, over } => format!("fades with depth over {}", unit.words(over)),
            Self::SpeedPower(power) => format!("grows with {}", power_words("speed", power)),
            Self::Saturating { at } => {
                format!("grows with speed and saturates around {at:.2} sqrt(g D)")
            }
            Self::Slow { below } => format!("acts at speeds below {below:.2} sqrt(g D)"),
            Self::ImpactSpeedPower(power) => {
                format!("grows with {}", power_words("impact speed", power))
            }
            Self::LeftPower(power) => {
                format!("grows with {}", power_words("speed over impact speed", power))
            }
            Self::Slowed { to, .. } => format!("acts below {to:.2} of the impact speed"),
            Self::Sine => "is larger the steeper the impact is".to_owned(),
            Self::Cosine => "is larger the flatter the impact is".to_owned(),
            Self::SineOfTwice => "is largest in impacts at 45 degrees".to_owned(),
        }
    }

    /// Whether it vanishes at rest.
    fn needs_motion(self) -> bool {
        matches!(self, Self::SpeedPower(_) | Self::Saturating { .. } | Self::LeftPower(_))
    }

    /// Whether it differs between impacts at a place and a speed that they share.
    fn is_of_impact(self) -> bool {
        matches!(self, Self::ImpactSpeedPower(_) | Self::LeftPower(_) | Self::Slowed { .. })
    }

    /// The numbers of its form that are searched.
    fn numbers(self) -> Vec<f64> {
        match self {
            Self::Layer { centre: a, width: b, .. }
            | Self::Below { depth: a, width: b, .. }
            | Self::Above { depth: a, width: b, .. }
            | Self::Slowed { to: a, width: b } => vec![a, b],
            Self::Fading { over: a, .. } | Self::Saturating { at: a } | Self::Slow { below: a } => {
                vec![a]
            }
            Self::DepthPower(_)
            | Self::SpeedPower(_)
            | Self::ImpactSpeedPower(_)
            | Self::LeftPower(_)
            | Self::Sine
            | Self::Cosine
            | Self::SineOfTwice => Vec::new(),
        }
    }

    /// The greatest that each of them may be: no state is beyond a place that is deeper than all `states`.
    fn greatest(self, states: &[State]) -> Vec<f64> {
        let deepest = |unit: Length| {
            let depths = states.iter().map(|state| state.depth / unit.size(state.diameter));
            depths.fold(f64::MIN_POSITIVE, f64::max)
        };
        match self {
            Self::Layer { unit, .. } | Self::Below { unit, .. } | Self::Above { unit, .. } => {
                vec![deepest(unit), f64::INFINITY]
            }
            _ => vec![f64::INFINITY; self.numbers().len()],
        }
    }

    /// With other numbers, as many as [`Self::numbers`] gives.
    fn with(self, numbers: &[f64]) -> Self {
        match (self, numbers) {
            (Self::Layer { unit, .. }, &[centre, width]) => Self::Layer { unit, centre, width },
            (Self::Below { unit, .. }, &[depth, width]) => Self::Below { unit, depth, width },
            (Self::Above { unit, .. }, &[depth, width]) => Self::Above { unit, depth, width },
            (Self::Fading { unit, .. }, &[over]) => Self::Fading { unit, over },
            (Self::Saturating { .. }, &[at]) => Self::Saturating { at },
            (Self::Slow { .. }, &[below]) => Self::Slow { below },
            (Self::Slowed { .. }, &[to, width]) => Self::Slowed { to, width },
            (same, _) => same,
        }
    }
}

/// A product of factors.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Term(pub(super) Vec<Factor>);

impl Term {
    /// As a formula writes it.
    pub(super) fn text(&self) -> String {
        let factors: Vec<String> = self.0.iter().map(|factor| factor.text()).collect();
        factors.join(" * ")
    }

    /// As the end of a sentence that begins with "a force that".
    pub(super) fn words(&self) -> String {
        let factors: Vec<String> = self.0.iter().map(|factor| factor.words()).collect();
        factors.join(" and ")
    }

    /// Whether it vanishes at rest.
    pub(super) fn needs_motion(&self) -> bool {
        self.0.iter().any(|factor| factor.needs_motion())
    }

    /// Whether it differs between impacts at a place and a speed that they share.
    pub(super) fn is_of_impact(&self) -> bool {
        self.0.iter().any(|factor| factor.is_of_impact())
    }

    /// The numbers of its form that are searched.
    pub(super) fn numbers(&self) -> Vec<f64> {
        self.0.iter().flat_map(|factor| factor.numbers()).collect()
    }

    /// The greatest that each of them may be where there are only `states`.
    pub(super) fn greatest(&self, states: &[State]) -> Vec<f64> {
        self.0.iter().flat_map(|factor| factor.greatest(states)).collect()
    }

    /// With other numbers, as many as [`Self::numbers`] gives.
    pub(super) fn with(&self, numbers: &[f64]) -> Self {
        let mut left = numbers;
        let factors = self.0.iter().map(|factor| {
            let (own, others) = left.split_at(factor.numbers().len().min(left.len()));
            left = others;
            factor.with(own)
        });
        Self(factors.collect())
    }

    /// Its value in each state; `None` where it cannot be evaluated.
    pub(super) fn values(&self, states: &[State]) -> Option<Vec<f64>> {
        let formula = Formula::parse(&self.text(), &VARIABLES).ok()?;
        let value = |state: &State| {
            let of = |name: &String| match name.as_str() {
                "z" => state.depth,
                "D" => state.diameter,
                "v" => state.speed,
                "v_0" => state.impact_speed,
                "V_s" => state.own_speed(),
                "theta" => state.angle,
                _ => 1e-3,
            };
            formula.value(&formula.variables().iter().map(of).collect::<Vec<_>>())
        };
        let values: Vec<f64> = states.iter().map(value).collect();
        values.iter().all(|value| value.is_finite()).then_some(values)
    }
}

fn powered(base: &str, power: f64) -> String {
    match power {
        power if (power - 1.0).abs() < f64::EPSILON => base.to_owned(),
        power => format!("{base}^{power}"),
    }
}

fn power_words(what: &str, power: f64) -> String {
    match power {
        power if (power - 1.0).abs() < f64::EPSILON => what.to_owned(),
        power => format!("{what} to the power {power}"),
    }
}

/// Three significant digits, as a formula reads them.
pub(super) fn short(value: f64) -> String {
    let digits = 2 - libm::floor(libm::log10(value.abs().max(1e-9))) as i32;
    format!("{:.*}", usize::try_from(digits.clamp(0, 9)).unwrap_or(0), value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(depth: f64) -> State {
        State { depth, speed: 1.0, impact_speed: 2.0, angle: 1.0, diameter: 0.02, gravity: 9.81 }
    }

    #[test]
    fn lengths_of_the_bed_and_of_the_body_are_what_they_say() {
        let layer = |unit, centre, width| Term(vec![Factor::Layer { unit, centre, width }]);
        let states = [state(0.02), state(0.026)];
        let of_bed = layer(Length::Millimetres, 20.0, 6.0).values(&states).expect("values");
        let of_body = layer(Length::Diameters, 1.0, 0.3).values(&states).expect("values");
        for values in [of_bed, of_body] {
            assert!((values[0] - 1.0).abs() < 1e-12, "{values:?}");
            assert!((values[1] - libm::exp(-1.0)).abs() < 1e-12, "{values:?}");
        }
    }

    #[test]
    fn numbers_go_to_the_factors_that_have_them() {
        let unit = Length::Diameters;
        let term = Term(vec![
            Factor::DepthPower(2.0),
            Factor::Below { unit, depth: 1.0, width: 0.1 },
            Factor::Slow { below: 0.3 },
        ]);
        let other = term.with(&[2.0, 0.2, 0.5]);
        assert_eq!(other.numbers(), [2.0, 0.2, 0.5]);
        assert_eq!(term.with(&term.numbers()), term);
        assert_eq!(short(0.012_345), "0.0123");
        assert_eq!(short(123.4), "123");
    }
}
