//! Colours of grains: sand at rest, the darker the more there is of a quantity.

use plots::sheet::Rgb;

/// What grains are coloured by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Speed.
    Speed,
    /// Magnitude of the sum of contact forces.
    Force,
    /// Distance from where the grain was in the first frame.
    Displacement,
}

impl Quantity {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Speed, Self::Force, Self::Displacement];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Speed => "speed",
            Self::Force => "force",
            Self::Displacement => "displacement",
        }
    }

    /// Its unit as it is shown.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Speed => "m/s",
            Self::Force => "mN",
            Self::Displacement => "mm",
        }
    }

    /// What SI values are multiplied with for that unit.
    #[must_use]
    pub fn factor(self) -> f64 {
        match self {
            Self::Speed => 1.0,
            Self::Force | Self::Displacement => 1e3,
        }
    }

    pub(super) fn index(self) -> usize {
        self as usize
    }
}

/// Colours at even steps, of falling lightness: told apart in print and by most colour-blind eyes.
const STOPS: [Rgb; 6] =
    [[222, 213, 194], [244, 190, 106], [236, 128, 66], [205, 66, 84], [138, 34, 106], [58, 15, 92]];

/// Steps of the ramp.
pub(crate) const STEPS: usize = 32;

/// The colour of `value` where `top` is the greatest. Steps go by the root of the share, so that slow motion
/// is told from rest.
pub(crate) fn ramp(value: f64, top: f64) -> Rgb {
    let share = if top > 0.0 { (value / top).clamp(0.0, 1.0).sqrt() } else { 0.0 };
    let step = (share * (STEPS - 1) as f64).round() / (STEPS - 1) as f64;
    let along = step * (STOPS.len() - 1) as f64;
    let from = (along.floor() as usize).min(STOPS.len() - 2);
    let part = along - from as f64;
    std::array::from_fn(|channel| {
        let [a, b] = [STOPS[from], STOPS[from + 1]].map(|stop| f64::from(stop[channel]));
        (a + part * (b - a)).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ramp_darkens_all_the_way_and_ends_at_its_top() {
        let light = |value: f64| {
            let [r, g, b] = ramp(value, 2.0).map(f64::from);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        let along: Vec<f64> = (0..=31).map(|at| 2.0 * (f64::from(at) / 31.0).powi(2)).collect();
        assert!(along.windows(2).all(|pair| light(pair[0]) > light(pair[1])));
        assert_eq!(ramp(0.0, 2.0), STOPS[0]);
        assert_eq!([2.0, 5.0].map(|value| ramp(value, 2.0)), [STOPS[5]; 2]);
        assert_eq!(ramp(1.0, 0.0), STOPS[0], "nothing moves");
    }
}
