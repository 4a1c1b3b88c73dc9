//! The part of E10 that needs beds: trends of impacts beside walls, over a floor and without friction, on a small
//! planar bed.

use runner::beds::Record;

use crate::published::check::{Band, Check, Estimate, SIGMAS, Verdict};
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

const REASON: &str = "two standard errors (Student's t) of the scatter of impacts";

/// Why nothing is said of impacts that are not there.
const NONE: &str = "its impacts are not there";

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
    let mut checks = vec![ran.beside_a_side(), ran.away_from_it(), ran.over_a_floor()];
    checks.extend(ran.without_friction());
    Ok(checks)
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
        let what = "disc a quarter of its diameter from a side wall: moved away from it (mm); its turning is not kept";
        let published = "moves away from the wall, and turns (cylinder; Díaz-Melián et al. 2020)";
        if away.is_empty() {
            return Check::unanswered(what, published, Verdict::NotRun, NONE);
        }
        let (mean, error) = mean_and_error(&away);
        let half = regression::student(SIGMAS, away.len().saturating_sub(1)) * error;
        Check::positive(what, published, Estimate::new(mean, error), Band { half, reason: REASON })
    }

    /// Depth and stopping time over the speed without solid friction: they scale as with it.
    fn without_friction(&self) -> Vec<Check> {
        let [without, with] = [Bed::Frictionless, Bed::Deep].map(|bed| self.falls(bed));
        let published = "scale as with friction (disc; Seguin et al. 2009)";
        let title = "discs without friction, 0.5 to 2 m/s";
        if without.len() < 3 || with.len() < 3 {
            return vec![Check::unanswered(title, published, Verdict::NotRun, NONE)];
        }
        let [deep, friction] = [&without, &with].map(|points| exponent(points));
        let off =
            Estimate::new(deep.value - friction.value, libm::hypot(deep.error, friction.error));
        // The scatter of both beds counts.
        let freedom = (without.len() + with.len()).saturating_sub(4);
        let half = regression::student(SIGMAS, freedom) * off.error;
        let same = Check::number(
            format!("{title}: power of the fall that the depth goes with"),
            friction,
            deep,
            Band {
                half,
                reason: "of the difference to that with friction, two standard errors (Student's t)",
            },
        );
        let deepens =
            positive(format!("{title}: that power"), "deeper with speed", deep, without.len());
        let shortens = slope(&without, |fall| fall.speed, |fall| 1e3 * fall.time).times(-1.0);
        let what = format!("{title}: fall of the stopping time with speed (ms per m/s)");
        vec![same, deepens, positive(what, published, shortens, without.len())]
    }

    /// The impacts in the middle of a bed, at all speeds.
    fn falls(&self, bed: Bed) -> Vec<Fallen> {
        let here = SPEEDS.map(|speed| Fall::everywhere(bed, speed)).concat();
        let own = self.0.iter().filter(|(fall, _)| here.contains(fall));
        let fallen = own.filter_map(|(fall, record)| {
            Some(Fallen { speed: fall.speed, depth: record.deepest, time: record.stopping_time? })
        });
        fallen.collect()
    }
}

/// How an impact ended.
struct Fallen {
    /// Of the impact (m/s).
    speed: f64,
    /// (m).
    depth: f64,
    /// (s).
    time: f64,
}

/// Exponent of depth over the total fall distance.
fn exponent(points: &[Fallen]) -> Estimate {
    let fall = |one: &Fallen| one.speed * one.speed / (2.0 * GRAVITY) + one.depth;
    slope(points, |one| libm::log(fall(one)), |one| libm::log(one.depth))
}

/// Slope of a line through `points`, with the error that they leave over.
fn slope(points: &[Fallen], x: impl Fn(&Fallen) -> f64, y: impl Fn(&Fallen) -> f64) -> Estimate {
    let columns = [points.iter().map(x).collect(), vec![1.0; points.len()]];
    let y: Vec<f64> = points.iter().map(y).collect();
    let fitted = regression::linear(&columns, &y, None);
    fitted.map_or(Estimate::new(f64::NAN, 0.0), |fitted| {
        Estimate::new(fitted.coefficients[0], fitted.error(0))
    })
}

/// A slope of a line through `n` impacts that the source has positive.
fn positive(what: String, published: &str, ours: Estimate, n: usize) -> Check {
    let half = regression::student(SIGMAS, n.saturating_sub(2)) * ours.error;
    Check::positive(what, published, ours, Band { half, reason: REASON })
}

/// Whether the first of two groups lies below the second, whose scatter both share.
fn less(what: &str, published: &str, [near, middle]: [&[f64]; 2]) -> Check {
    if near.is_empty() || middle.is_empty() {
        return Check::unanswered(what, published, Verdict::NotRun, NONE);
    }
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
    use crate::published::oblique::records::record;

    /// A record of each fall that goes as deep and takes as long as told of its speed.
    fn ran(depth: impl Fn(f64) -> f64, time: impl Fn(f64) -> f64) -> Ran {
        let beds = [Bed::Deep, Bed::Frictionless];
        let falls = beds.map(|bed| SPEEDS.map(|speed| Fall::everywhere(bed, speed)).concat());
        let record = |(at, fall): (usize, &Fall)| {
            // A scatter of 2 % from place to place.
            let share = 0.98 + 0.02 * (at % 3) as f64;
            let ended = record(1e-3, vec![0.0; 2], vec![0.0, share * depth(fall.speed)]);
            (*fall, Record { stopping_time: Some(share * time(fall.speed)), ..ended })
        };
        Ran(falls.iter().flat_map(|own| own.iter().enumerate().map(record)).collect())
    }

    #[test]
    fn without_friction_a_trend_passes_or_fails_by_its_slope_and_not_by_single_impacts() {
        let verdicts = |depth: fn(f64) -> f64, time: fn(f64) -> f64| {
            let checks = ran(depth, time).without_friction();
            checks.iter().map(|check| check.verdict).collect::<Vec<_>>()
        };
        let deeper = |v: f64| 0.05 * libm::cbrt(v * v);
        assert_eq!(verdicts(deeper, |v| 0.3 - 0.05 * v), [Verdict::Pass; 3]);
        assert_eq!(verdicts(deeper, |v| 0.2 + 0.05 * v)[2], Verdict::Fail);
        assert_eq!(verdicts(|v| 0.05 - 0.01 * v, |v| 0.3 - 0.05 * v)[1], Verdict::Fail);
        // 311, 315, 224 and 254 ms fall by their slope, though not from each speed to the next.
        let uneven = |v: f64| match v {
            v if v < 0.75 => 0.311,
            v if v < 1.25 => 0.315,
            v if v < 1.75 => 0.224,
            _ => 0.254,
        };
        assert_eq!(verdicts(deeper, uneven)[2], Verdict::Pass);
    }

    #[test]
    fn a_group_is_less_only_where_its_scatter_lets_it_be() {
        let verdict = |near: &[f64], middle: &[f64]| less("", "", [near, middle]).verdict;
        assert_eq!(verdict(&[0.8, 0.82], &[0.99, 1.0, 1.01]), Verdict::Pass);
        assert_eq!(verdict(&[0.6, 1.2], &[0.9, 1.0, 1.1]), Verdict::Undecided);
        assert_eq!(verdict(&[1.2, 1.22], &[0.99, 1.0, 1.01]), Verdict::Fail);
        assert_eq!(verdict(&[], &[1.0]), Verdict::NotRun);
    }
}
