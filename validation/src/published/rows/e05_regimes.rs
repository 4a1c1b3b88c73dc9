//! E5: the two regimes of the stopping time, and the characteristic speed and time at 90°.

use std::cmp::Ordering;

use crate::published::check::{Band, Check, Estimate, Known, SIGMAS};
use crate::published::laboratory::Laboratory;
use crate::published::oblique::curves::{Form, series};
use crate::published::oblique::matrix::{self, Cell, READINGS, Reading};
use crate::published::regression::{self, Fitted};
use crate::published::row::{Findings, PublishedError, Row, Table};
use crate::published::rows::e01_stopping_time::KNOWN;

pub(super) static ROW: Row = Row {
    id: "E5",
    title: "Two regimes of the stopping time, parted near 30°; 1 m/s and 0.16 s at 90°",
    source: "Wang, Ye & Zheng 2012, §3.4",
    how: ["the impacts of E1", "the impacts of E1"],
    judge,
};

/// Published (deg), and half the distance of the neighbouring angles of the tables, 15° and 45°.
const CRITICAL: f64 = 30.0;
const BETWEEN: Band = Band {
    half: 15.0,
    reason: "the article has no angle between 15° and 45° but 30° itself, and no fit there",
};

const REASON: &str = "two standard errors (Student's t)";

/// Published approximately: speed (m/s) and time (s) from which the stopping time is its plateau.
const SPEED: f64 = 1.0;
const TIME: f64 = 0.16;

/// Excess over the plateau at [`SPEED`], as a share, by the published curve at 90°:
/// 0.16083 exp(−1.42537) / 0.1591.
const EXCESS: f64 = 0.243;

/// "Approximately": half of the last digit that is given, of 1 m/s and of 0.16 s.
const ROUNDING: [f64; 2] = [0.5, 0.005];

fn judge(laboratory: &Laboratory<'_>) -> Result<Findings, PublishedError> {
    let ran = matrix::run(laboratory, |_| true)?;
    let cells = &ran.cells;
    let mut findings = Findings::default();
    let mut table = Table::new(
        "Slope of the stopping time over the impact speed (ms per m/s), a line through all speeds.",
        &["reading", "angle (deg)", "slope", "standard error"],
    );
    for (at, reading) in READINGS.iter().enumerate() {
        let slopes = slopes(cells, reading);
        for Slope { angle, slope, .. } in &slopes {
            table.rows.push(vec![
                reading.name.to_owned(),
                format!("{angle}"),
                format!("{:+.1}", 1e3 * slope.value),
                format!("{:.1}", 1e3 * slope.error),
            ]);
        }
        findings.checks.extend(slopes.iter().filter_map(|one| regime(reading, one)));
        findings.checks.extend(critical(reading, &slopes));
        findings.checks.push(over_angle(reading, cells));
        let known = &KNOWN[at];
        findings.checks.extend(characteristic(reading, &matrix::of(cells, reading, 90.0), known));
    }
    findings.tables.push(table);
    findings.notes.extend(ran.note());
    Ok(findings)
}

/// Slope of the stopping time over the speed at an angle.
struct Slope {
    /// (deg).
    angle: f64,
    /// (s²/m).
    slope: Estimate,
    /// How many of its standard errors hold it as surely as two of a known scatter.
    sigmas: f64,
}

fn slopes(cells: &[Cell], reading: &Reading) -> Vec<Slope> {
    let of = |angle: f64| {
        let points = series(&matrix::of(cells, reading, angle), |record| record.stopping_time);
        let fitted = Form::Line.fit(&points.speeds, &points.means, points.errors.as_deref())?;
        let slope = Estimate::new(fitted.coefficients[0], fitted.error(0));
        let sigmas = points.as_surely_as(&fitted, SIGMAS);
        Some(Slope { angle, slope, sigmas })
    };
    matrix::angles(cells).into_iter().filter_map(of).collect()
}

/// The sign of the slope below and above the critical angle; nothing is said at it.
fn regime(reading: &Reading, Slope { angle, slope, sigmas }: &Slope) -> Option<Check> {
    let (word, sign) = match angle.total_cmp(&CRITICAL) {
        Ordering::Less => ("rises", 1e3),
        Ordering::Greater => ("falls", -1e3),
        Ordering::Equal => return None,
    };
    let ours = slope.times(sign);
    let band = Band { half: sigmas * ours.error, reason: REASON };
    let what =
        format!("{angle}°, {}: the stopping time {word} with speed (ms per m/s)", reading.name);
    Some(Check::positive(what, word, ours, band))
}

/// The angle at which the slope passes zero, by a line through those from 15° to 45°: with the article's own curves, 29°.
fn critical(reading: &Reading, slopes: &[Slope]) -> Option<Check> {
    let near: Vec<&Slope> =
        slopes.iter().filter(|one| (one.angle - CRITICAL).abs() <= BETWEEN.half).collect();
    let of = |number: fn(&Slope) -> f64| near.iter().map(|one| number(one)).collect::<Vec<f64>>();
    let errors = of(|one| one.slope.error);
    let columns = [of(|one| one.angle), vec![1.0; near.len()]];
    let line = regression::linear(&columns, &of(|one| one.slope.value), Some(&errors))?;
    let ours = zero(&line);
    let sigmas = of(|one| one.sigmas).into_iter().fold(SIGMAS, f64::max);
    let what = format!("{}: critical angle (deg)", reading.name);
    let check = Check::number(what, Estimate::new(CRITICAL, 0.0), ours, BETWEEN);
    // Where the slopes are as good as alike they cross zero nowhere.
    let is_flat = line.coefficients[0].abs() <= sigmas * line.error(0);
    Some(check.undecided_if(is_flat || sigmas * ours.error > BETWEEN.half))
}

/// At a given speed the stopping time falls with the angle.
fn over_angle(reading: &Reading, cells: &[Cell]) -> Check {
    let own: Vec<&Cell> = cells.iter().filter(|cell| cell.reading == reading).collect();
    let impacts: Vec<(f64, f64, f64)> = own
        .iter()
        .flat_map(|cell| cell.records.iter().map(move |record| (cell, record)))
        .filter_map(|(cell, record)| {
            Some((cell.speed, cell.published.angle_deg, record.stopping_time?))
        })
        .collect();
    let fit = |without: Option<usize>| {
        let kept: Vec<_> = (impacts.iter().enumerate())
            .filter(|(at, _)| Some(*at) != without)
            .map(|(_, one)| *one)
            .collect();
        // Both as they differ from their means at the speed.
        let (mut across, mut square) = (0.0, 0.0);
        for &(speed, angle, time) in &kept {
            let same = || kept.iter().filter(move |one| (one.0 - speed).abs() < 1e-9);
            let n = same().count() as f64;
            let off = angle - same().map(|one| one.1).sum::<f64>() / n;
            across += off * (time - same().map(|one| one.2).sum::<f64>() / n);
            square += off * off;
        }
        (square > 0.0).then(|| vec![-1e3 * across / square])
    };
    let what =
        format!("{}: fall of the stopping time with the angle (ms per degree)", reading.name);
    let published = "falls with the angle at a given speed";
    let Some(found) = regression::leaving_out(impacts.len(), fit) else {
        return Check::undecided(what, published, "one angle at every speed");
    };
    let sigmas = regression::student(SIGMAS, impacts.len().saturating_sub(1));
    Check::positive(
        what,
        published,
        found[0],
        Band { half: sigmas * found[0].error, reason: REASON },
    )
}

/// Where a line of slope a and intercept b is zero: −b/a, with the error of both.
fn zero(line: &Fitted) -> Estimate {
    let [a, b] = [line.coefficients[0], line.coefficients[1]];
    let at = -b / a;
    let (va, vb, vab) = (line.covariance[(0, 0)], line.covariance[(1, 1)], line.covariance[(0, 1)]);
    let variance = (at * at * va + vb + 2.0 * at * vab) / (a * a);
    Estimate::new(at, variance.max(0.0).sqrt())
}

/// The plateau of the stopping time at 90°, and the speed at which it is reached as in the article.
fn characteristic(reading: &Reading, cells: &[&Cell], known: &Known) -> Vec<Check> {
    let points = series(cells, |record| record.stopping_time);
    let fitted = Form::Exponential.fit(&points.speeds, &points.means, points.errors.as_deref());
    let Some(fitted) = fitted else {
        let what = format!("90°, {}: characteristic time and speed", reading.name);
        return vec![Check::undecided(what, "0.16 s, 1 m/s", "fewer than four speeds are there")];
    };
    let [amplitude, rate, plateau] = [0, 1, 2].map(|at| fitted.coefficients[at]);
    let speed = libm::log(amplitude / (EXCESS * plateau)) / rate;
    // By the derivatives of that logarithm over the three coefficients.
    let by = [1.0 / (amplitude * rate), -speed / rate, -1.0 / (plateau * rate)];
    let variance: f64 = (0..3)
        .flat_map(|i| (0..3).map(move |j| (i, j)))
        .map(|(i, j)| by[i] * fitted.covariance[(i, j)] * by[j])
        .sum();
    let reason = "the rounding of what is given, and two standard errors of ours (Student's t)";
    let sigmas = points.as_surely_as(&fitted, SIGMAS);
    let band =
        |rounding: f64, error: f64| Band { half: libm::hypot(rounding, sigmas * error), reason };
    let (time, speed) =
        (Estimate::new(plateau, fitted.error(2)), Estimate::new(speed, variance.max(0.0).sqrt()));
    vec![
        Check::number(
            format!("90°, {}: characteristic time, the plateau (s)", reading.name),
            Estimate::new(TIME, ROUNDING[1]),
            time,
            band(ROUNDING[1], time.error),
        )
        .unless_known(Some(known), (time.value / TIME, sigmas * time.error / TIME)),
        Check::number(
            format!(
                "90°, {}: characteristic speed, at {EXCESS} above the plateau (m/s)",
                reading.name
            ),
            Estimate::new(SPEED, ROUNDING[0]),
            speed,
            band(ROUNDING[0], speed.error),
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::published::Verdict;
    use crate::published::oblique::records::{cells, record};
    use crate::published::oblique::tables::{PUBLISHED, published};

    #[test]
    fn the_published_curve_at_90_degrees_has_the_published_speed_and_time() {
        let excess = 0.16083 * libm::exp(-1.42537 * SPEED) / 0.1591;
        // Three digits are written.
        assert!((excess - EXCESS).abs() < 5e-4);
        assert!((0.1591 - TIME).abs() < ROUNDING[1]);
    }

    #[test]
    fn a_line_is_zero_where_it_crosses_and_its_error_grows_with_that_of_the_points() {
        let angles = vec![15.0, 45.0, 90.0];
        let values: Vec<f64> = angles.iter().map(|angle| 0.01 * (30.0 - angle)).collect();
        let columns = [angles, vec![1.0; 3]];
        let at = |error: f64| {
            zero(&regression::linear(&columns, &values, Some(&[error; 3])).expect("a line"))
        };
        assert!((at(0.01).value - 30.0).abs() < 1e-9, "rounding");
        assert!((at(0.02).error / at(0.01).error - 2.0).abs() < 1e-9, "linear in the errors");
    }

    /// Impacts at every angle with a published time, two positions each, whose times are `of` the angle and the speed, and
    /// 2 % to either side.
    fn impacts(of: impl Fn(f64, f64) -> f64) -> Vec<Cell> {
        let speeds = [0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0];
        let angles = PUBLISHED.iter().filter(|one| one.stopping_time.is_some());
        let cells = angles.flat_map(|one| {
            let at = |time: f64| record(time, vec![0.0; 2], vec![0.0; 2]);
            let mut cells = cells(one.angle_deg, &speeds, |v| at(0.98 * of(one.angle_deg, v)));
            for cell in &mut cells {
                cell.records.push(at(1.02 * of(one.angle_deg, cell.speed)));
            }
            cells
        });
        cells.collect()
    }

    fn published_time(angle: f64, speed: f64) -> f64 {
        let time = published(angle).and_then(|one| one.stopping_time);
        time.expect("a time at this angle").at(speed)
    }

    fn verdicts(cells: &[Cell]) -> Vec<Verdict> {
        let slopes = slopes(cells, &READINGS[0]);
        let mut checks: Vec<Check> =
            slopes.iter().filter_map(|one| regime(&READINGS[0], one)).collect();
        checks.extend(critical(&READINGS[0], &slopes));
        checks.push(over_angle(&READINGS[0], cells));
        let vertical = matrix::of(cells, &READINGS[0], 90.0);
        checks.extend(characteristic(&READINGS[0], &vertical, &KNOWN[0]));
        checks.iter().map(|check| check.verdict).collect()
    }

    #[test]
    fn the_published_times_have_the_published_regimes_and_critical_angle() {
        let found = verdicts(&impacts(published_time));
        // Six angles, the critical one, the fall over the angle, time and speed of the plateau.
        assert_eq!(found, vec![Verdict::Pass; 10]);
    }

    #[test]
    fn times_that_do_not_turn_fail_and_longer_ones_at_90_degrees_deviate_as_listed() {
        let mirrored = impacts(|angle, speed| published_time(angle, 4.5 - speed));
        assert_eq!(verdicts(&mirrored)[..6], [Verdict::Fail; 6]);
        let longer_when_steep = impacts(|angle, speed| 0.2 + 2e-3 * angle + 0.01 * speed);
        assert_eq!(verdicts(&longer_when_steep)[7], Verdict::Fail);
        let parted_at_60 = impacts(|angle, speed| 0.4 + 1e-3 * (60.0 - angle) * speed);
        assert_eq!(verdicts(&parted_at_60)[6], Verdict::Fail);
        let plateau = |factor: f64| {
            verdicts(&impacts(|angle, speed| factor * published_time(angle, speed)))[8]
        };
        assert_eq!([1.2, 1.5].map(plateau), [Verdict::Deviates, Verdict::Fail]);
    }
}
