//! The part of E10 that needs beds: trends of impacts beside walls, over a floor and without friction, on a small
//! planar bed.

use crate::beds::Record;
use crate::published::check::{Band, Check, Estimate};
use crate::published::laboratory::Laboratory;
use crate::published::planar::{self, Bed, DIAMETER, Fall};
use crate::published::regression;
use crate::published::row::PublishedError;
use crate::three_shapes::mean_and_error;

/// Speeds (m/s) of impacts with and without friction, and beside the sides.
const SPEEDS: [f64; 4] = [0.5, 1.0, 1.5, 2.0];

/// Between disc and side (m): well within the diameter that the effect is said to reach.
const GAP: f64 = 0.25 * DIAMETER;

/// Speed (m/s) over the floor: on a deep bed the disc stops half a diameter above that floor.
const OVER_FLOOR: f64 = 1.0;

/// Standard errors by which a difference counts.
const SIGMAS: f64 = 2.0;

const REASON: &str = "two standard errors (Student's t) of the scatter of impacts";

/// Strength of gravity (m/s²).
const GRAVITY: f64 = 9.81;

/// Impacts that ran, with what they were.
struct Ran(Vec<(Fall, Record)>);

/// The checks of those trends.
///
/// # Errors
/// If an impact cannot be run.
pub(super) fn checks(laboratory: &Laboratory<'_>) -> Result<Vec<Check>, PublishedError> {
    let mut falls = Vec::new();
    for bed in [Bed::Deep, Bed::Frictionless] {
        falls.extend(SPEEDS.iter().flat_map(|&speed| Fall::everywhere(bed, speed)));
    }
    falls.extend(SPEEDS.iter().flat_map(|&speed| Fall::beside(speed, GAP)));
    falls.extend(Fall::everywhere(Bed::Shallow, OVER_FLOOR));
    let records = planar::impacts(laboratory, &falls)?;
    let there = falls.into_iter().zip(records).filter_map(|(fall, one)| Some((fall, one?)));
    let ran = Ran(there.collect());
    Ok(vec![ran.beside_a_side(), ran.away_from_it(), ran.over_a_floor(), ran.without_friction()])
}

impl Ran {
    /// A `number` of the impacts at `speed` (m/s) in the middle of a bed.
    fn of(&self, bed: Bed, speed: f64, number: fn(&Record) -> f64) -> Vec<f64> {
        let here = Fall::everywhere(bed, speed);
        let own = self.0.iter().filter(|(fall, _)| here.contains(fall));
        own.map(|(_, record)| number(record)).collect()
    }

    /// Their depths (m).
    fn depths(&self, bed: Bed, speed: f64) -> Vec<f64> {
        self.of(bed, speed, |record| record.deepest)
    }

    fn beside(&self) -> impl Iterator<Item = &(Fall, Record)> {
        let near = |fall: &Fall| Fall::beside(fall.speed, GAP).contains(fall);
        self.0.iter().filter(move |(fall, _)| near(fall))
    }

    /// Depths over the mean one in the middle of a deep bed: of `falls`, and of those in the middle themselves.
    fn over_middle<'a>(&self, falls: impl Iterator<Item = &'a (Fall, Record)>) -> [Vec<f64>; 2] {
        let mut speeds: Vec<f64> = Vec::new();
        let mut ratios = Vec::new();
        for (fall, record) in falls {
            ratios.push(record.deepest / mean(&self.depths(Bed::Deep, fall.speed)));
            if !speeds.contains(&fall.speed) {
                speeds.push(fall.speed);
            }
        }
        let middle = |speed: &f64| {
            let own = self.depths(Bed::Deep, *speed);
            let of_mean = mean(&own);
            own.into_iter().map(move |depth| depth / of_mean).collect::<Vec<_>>()
        };
        [ratios, speeds.iter().flat_map(middle).collect()]
    }

    fn beside_a_side(&self) -> Check {
        let [near, middle] = self.over_middle(self.beside());
        less(
            "disc a quarter of its diameter from a side wall: what its depth lacks of that in the middle (%)",
            "less deep within a diameter (sphere; Seguin et al. 2008)",
            [&near, &middle],
        )
    }

    fn over_a_floor(&self) -> Check {
        let shallow = self.0.iter().filter(|(fall, _)| fall.bed == Bed::Shallow);
        let [near, middle] = self.over_middle(shallow);
        less(
            "disc over a floor three diameters down: what its depth lacks of that on a deep bed (%)",
            "less deep near the floor (sphere; Seguin et al. 2008)",
            [&near, &middle],
        )
    }

    /// How far impacts beside a side end away from it.
    fn away_from_it(&self) -> Check {
        let away: Vec<f64> = self
            .beside()
            .map(|(fall, record)| {
                let moved = record.range.last().copied().unwrap_or(f64::NAN);
                // The left side comes first, and away from it is to the right.
                let is_left = Fall::beside(fall.speed, GAP)[0].x.to_bits() == fall.x.to_bits();
                1e3 * if is_left { moved } else { -moved }
            })
            .collect();
        let (mean, error) = mean_and_error(&away);
        let half = regression::student(SIGMAS, away.len().saturating_sub(1)) * error;
        Check::positive(
            "disc a quarter of its diameter from a side wall: moved away from it (mm); its turning is not kept",
            "moves away from the wall, and turns (cylinder; Díaz-Melián et al. 2020)",
            Estimate::new(mean, error),
            Band { half, reason: REASON },
        )
    }

    /// Depth and stopping time over the speed without solid friction.
    fn without_friction(&self) -> Check {
        let time = |record: &Record| record.stopping_time.unwrap_or(f64::NAN);
        let depths = SPEEDS.map(|speed| mean(&self.depths(Bed::Frictionless, speed)));
        let times = SPEEDS.map(|speed| mean(&self.of(Bed::Frictionless, speed, time)));
        let [without, with] = [Bed::Frictionless, Bed::Deep].map(|bed| self.exponent(bed));
        let shown = |values: &[f64], digits: usize| {
            let each = values.iter().map(|value| format!("{:.digits$}", 1e3 * value));
            each.collect::<Vec<_>>().join(", ")
        };
        Check::trend(
            "discs without friction, 0.5 to 2 m/s: depth (mm) and stopping time (ms)",
            (
                "scale as with friction (disc; Seguin et al. 2009)",
                format!(
                    "{}; {}; depth as the {without:.2}th power of the fall, {with:.2}th with friction",
                    shown(&depths, 1),
                    shown(&times, 0)
                ),
            ),
            "the depth rises and the stopping time falls in every step from speed to speed",
            depths.windows(2).all(|pair| pair[0] < pair[1])
                && times.windows(2).all(|pair| pair[1] < pair[0]),
        )
    }

    /// The exponent of depth over the total fall distance.
    fn exponent(&self, bed: Bed) -> f64 {
        let depths = SPEEDS.map(|speed| mean(&self.depths(bed, speed)));
        let falls = SPEEDS.iter().zip(&depths).map(|(v, d)| v * v / (2.0 * GRAVITY) + d);
        let x: Vec<f64> = falls.map(libm::log).collect();
        let y: Vec<f64> = depths.iter().map(|depth| libm::log(*depth)).collect();
        regression::linear(&[x, vec![1.0; SPEEDS.len()]], &y, None)
            .map_or(f64::NAN, |fitted| fitted.coefficients[0])
    }
}

/// Whether the first of two groups lies below the second, whose scatter both share.
fn less(what: &str, published: &str, [near, middle]: [&[f64]; 2]) -> Check {
    let freedom = (near.len() + middle.len()).saturating_sub(2);
    let squares: f64 = [near, middle]
        .into_iter()
        .flat_map(|group| {
            let of_mean = mean(group);
            group.iter().map(move |one| (one - of_mean) * (one - of_mean))
        })
        .sum();
    let counts = 1.0 / near.len() as f64 + 1.0 / middle.len() as f64;
    let error = (squares / freedom as f64 * counts).sqrt();
    let lacking = Estimate::new(mean(middle) - mean(near), error).times(100.0);
    let half = regression::student(SIGMAS, freedom) * lacking.error;
    Check::positive(what, published, lacking, Band { half, reason: REASON })
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::published::Verdict;

    #[test]
    fn a_group_is_less_only_where_its_scatter_lets_it_be() {
        let verdict = |near: &[f64], middle: &[f64]| less("", "", [near, middle]).verdict;
        assert_eq!(verdict(&[0.8, 0.82], &[0.99, 1.0, 1.01]), Verdict::Pass);
        assert_eq!(verdict(&[0.6, 1.2], &[0.9, 1.0, 1.1]), Verdict::NotCheckable);
        assert_eq!(verdict(&[1.2, 1.22], &[0.99, 1.0, 1.01]), Verdict::Fail);
        assert_eq!(verdict(&[], &[1.0]), Verdict::Fail);
    }
}
