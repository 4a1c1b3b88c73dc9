//! E5: the two regimes of the stopping time, and the characteristic speed and time at 90°.

use crate::published::check::{Band, Check, Estimate};
use crate::published::laboratory::Laboratory;
use crate::published::oblique::curves::{Form, series};
use crate::published::oblique::matrix::{self, Cell, READINGS, Reading};
use crate::published::regression::{self, Fitted};
use crate::published::row::{Findings, PublishedError, Row, Table};

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
    for reading in &READINGS {
        let slopes = slopes(cells, reading);
        for (angle, slope) in &slopes {
            table.rows.push(vec![
                reading.name.to_owned(),
                format!("{angle}"),
                format!("{:+.1}", 1e3 * slope.value),
                format!("{:.1}", 1e3 * slope.error),
            ]);
        }
        findings.checks.push(regimes(reading, &slopes));
        findings.checks.push(critical(reading, &slopes));
        findings.checks.extend(characteristic(reading, &matrix::of(cells, reading, 90.0)));
    }
    findings.tables.push(table);
    findings.notes.extend(ran.note());
    Ok(findings)
}

/// Slope of the stopping time over the speed (s²/m), by angle (deg).
fn slopes(cells: &[Cell], reading: &Reading) -> Vec<(f64, Estimate)> {
    let of = |angle: f64| {
        let points = series(&matrix::of(cells, reading, angle), |record| record.stopping_time);
        let fitted = Form::Line.fit(&points.speeds, &points.means, points.errors.as_deref())?;
        Some((angle, Estimate::new(fitted.coefficients[0], fitted.error(0))))
    };
    matrix::angles(cells).into_iter().filter_map(of).collect()
}

fn regimes(reading: &Reading, slopes: &[(f64, Estimate)]) -> Check {
    let below = slopes.iter().filter(|(angle, _)| *angle < CRITICAL);
    let above = slopes.iter().filter(|(angle, _)| *angle > CRITICAL);
    let rises = below.clone().all(|(_, slope)| slope.value > 0.0);
    let falls = above.clone().all(|(_, slope)| slope.value < 0.0);
    let said = |(angle, slope): &(f64, Estimate)| format!("{angle}°: {}", slope.times(1e3));
    let ours = slopes.iter().map(said).collect::<Vec<_>>().join("; ");
    Check::trend(
        format!("{}: slope of the stopping time (ms per m/s)", reading.name),
        ("rises with speed below 30°, falls above", ours),
        "the sign of the slope at each angle",
        rises && falls && below.count() > 0 && above.count() > 0,
    )
}

/// The angle at which the slope, taken as linear in the angle, passes zero.
fn critical(reading: &Reading, slopes: &[(f64, Estimate)]) -> Check {
    let what = format!("{}: critical angle (deg)", reading.name);
    let angles: Vec<f64> = slopes.iter().map(|(angle, _)| *angle).collect();
    let values: Vec<f64> = slopes.iter().map(|(_, slope)| slope.value).collect();
    let errors: Vec<f64> = slopes.iter().map(|(_, slope)| slope.error).collect();
    let columns = [angles.clone(), vec![1.0; angles.len()]];
    let crossing = regression::linear(&columns, &values, Some(&errors)).map(|line| zero(&line));
    let ours = crossing.unwrap_or(Estimate::new(f64::NAN, 0.0));
    Check::number(what, Estimate::new(CRITICAL, 0.0), ours, BETWEEN)
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
fn characteristic(reading: &Reading, cells: &[&Cell]) -> Vec<Check> {
    let points = series(cells, |record| record.stopping_time);
    let fitted = Form::Exponential.fit(&points.speeds, &points.means, points.errors.as_deref());
    let Some(fitted) = fitted else {
        let what = format!("90°, {}: characteristic time and speed", reading.name);
        return vec![Check::not_checkable(
            what,
            "0.16 s, 1 m/s",
            "fewer than four speeds are there",
        )];
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
    let sigmas = fitted.as_surely_as(2.0);
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
        ),
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
}
