//! E2: depth and range over the impact speed.

use crate::published::check::{Band, Check, Estimate, Known, SIGMAS};
use crate::published::laboratory::Laboratory;
use crate::published::oblique::curves::{Curve, Form, Quantity, Series, series};
use crate::published::oblique::matrix::{self, Cell, READINGS};
use crate::published::oblique::tables::Line;
use crate::published::regression;
use crate::published::row::{Findings, PublishedError, Row};

pub(super) static ROW: Row = Row {
    id: "E2",
    title: "Depth and range are linear in the impact speed",
    source: "Wang, Ye & Zheng 2012, eqs 5–6, Table 1",
    how: [
        "15°, 45° and 90° at 4 to 7 speeds, one position each, on 7 500 and 10 000 discs",
        "7 angles × 8 speeds × 6 positions on 15 000 discs",
    ],
    judge,
};

const PRINTED: &str = "the law as printed goes too deep and too far in independent codes too: equation 2 \
                       names a rolling moment without a coefficient, and the printed packing and height contradict each other";
const ROLLING: &str = "one coefficient of rolling is fitted to the depths at 90°: slow impacts stay too shallow, ranges too long";

/// The article's own scatter of depths between positions.
const GOAL: Band = Band { half: 6.0, reason: "the article's scatter between positions" };

/// Standard errors of a curvature that no line has.
const CURVATURE: f64 = 3.0;

/// Depths over the published ones that independent codes had at [`DEPTHS_AT`], from 1 to 4 m/s, by reading. The runs of
/// these codes are not in this repository.
pub(super) const DEPTHS: [[f64; 2]; 2] = [[1.0, 1.2], [0.86, 1.02]];

/// Angle (deg) of these depths.
pub(super) const DEPTHS_AT: f64 = 90.0;

pub(super) const DEPTH: Quantity = Quantity {
    name: "depth",
    axis: "depth (m)",
    of: |record| Some(record.deepest),
    published: |one| Some(curve(&["λ_y1 (s)", "λ_y2 (m)"], one.depth)),
    goal: GOAL,
    stated_scatter: Some(0.06),
    known: [Known { ratio: DEPTHS[0], cause: PRINTED }, Known { ratio: DEPTHS[1], cause: ROLLING }],
    known_at: DEPTHS_AT,
};

const RANGE: Quantity = Quantity {
    name: "range",
    axis: "range (m)",
    // Straight down there is none.
    of: |record| (record.reached > 0.0).then_some(record.reached),
    published: |one| Some(curve(&["λ_x1 (s)", "λ_x2 (m)"], one.range?)),
    goal: GOAL,
    stated_scatter: Some(0.06),
    // As independent codes had them, from 1 to 4 m/s.
    known: [
        Known { ratio: [1.06, 1.22], cause: PRINTED },
        Known { ratio: [1.06, 1.19], cause: ROLLING },
    ],
    known_at: 45.0,
};

fn curve(names: &'static [&'static str], line: Line) -> Curve {
    Curve { form: Form::Line, names, values: vec![line.slope, line.intercept] }
}

fn judge(laboratory: &Laboratory<'_>) -> Result<Findings, PublishedError> {
    let ran = matrix::run(laboratory, |_| true)?;
    let cells = &ran.cells;
    let mut findings = DEPTH.judge(cells, "e2-depth.svg")?;
    let range = RANGE.judge(cells, "e2-range.svg")?;
    findings.checks.extend(range.checks);
    findings.tables.extend(range.tables);
    findings.figures.extend(range.figures);
    for quantity in [&DEPTH, &RANGE] {
        for reading in &READINGS {
            for angle in matrix::angles(cells) {
                let own = matrix::of(cells, reading, angle);
                findings.checks.extend(linearity(quantity, reading.name, angle, &own));
            }
        }
    }
    findings.notes.extend(ran.note());
    Ok(findings)
}

/// How far our means lie from a line of their own: nothing with fewer than four points. Two rules can judge it, and both are
/// said. The verdict is by the departure, since the article claims a line within the scatter that it states, and enough
/// impacts tell any curve from a line; whether a square of the speed improves the line is said beside it.
fn linearity(quantity: &Quantity, reading: &str, angle: f64, cells: &[&Cell]) -> Option<Check> {
    let points = series(cells, quantity.of);
    let Series { speeds, means, errors, .. } = &points;
    if speeds.len() < 4 {
        return None;
    }
    let line = Form::Line.fit(speeds, means, errors.as_deref())?;
    let squares = speeds.iter().map(|v| v * v).collect();
    let columns = [squares, speeds.clone(), vec![1.0; speeds.len()]];
    let curved = regression::linear(&columns, means, errors.as_deref())?;
    let curvature = curved.coefficients[0] / curved.error(0);
    let n = means.len() as f64;
    let on_line = speeds.iter().map(|v| Form::Line.at(&line.coefficients, *v));
    let off = on_line.zip(means).map(|(line, mean)| (mean / line - 1.0).abs()).sum::<f64>() / n;
    // Single impacts scatter by what a parabola leaves over.
    let error = |at: usize| errors.as_ref().map_or(curved.residual, |errors| errors[at]);
    let shares: Vec<f64> = means.iter().zip(0..).map(|(y, at)| error(at) / y.abs()).collect();
    let of_mean = shares.iter().sum::<f64>() / n / n.sqrt();
    let sigmas = points.as_surely_as(&curved, SIGMAS);
    let most = points.as_surely_as(&curved, CURVATURE);
    Some(Check::deviation(
        format!(
            "{angle}°, {reading}: {}, mean departure of our means from a line of their own (%); by its curvature, \
             {curvature:+.1} standard errors from zero, it is {} line",
            quantity.name,
            if curvature.abs() < most { "a" } else { "no" }
        ),
        "linear",
        Estimate::new(100.0 * off, 100.0 * of_mean),
        100.0 * regression::deviation_by_scatter(&shares, sigmas),
        Band {
            reason: "the article's scatter between positions: what is nearer to a line is one to it",
            ..GOAL
        },
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::published::Verdict;
    use crate::published::oblique::records::{cells, record};

    #[test]
    fn depths_within_the_scatter_of_a_line_are_linear_and_those_on_a_parabola_are_not() {
        let check = |square: f64| {
            let depth = |v: f64| 0.07 + 0.03 * v + square * v * v;
            let cells = cells(90.0, &[0.5, 1.0, 1.5, 2.0, 3.0, 4.0], |v| {
                // A few per mille to either side.
                let off = if (1.2..=2.5).contains(&v) { -2e-4 } else { 2e-4 };
                record(0.1, vec![0.0; 2], vec![0.0, depth(v) + off])
            });
            let own: Vec<&Cell> = cells.iter().collect();
            linearity(&DEPTH, "", 90.0, &own).expect("six speeds")
        };
        // The second is up to 1.5 % off, by many standard errors: a line by its departure, and none by its curvature.
        let checks = [0.0, 1e-3, 0.01].map(check);
        let verdicts = checks.each_ref().map(|check| check.verdict);
        assert_eq!(verdicts, [Verdict::Pass, Verdict::Pass, Verdict::Fail]);
        let lines = checks.map(|check| check.what.ends_with("it is a line"));
        assert_eq!(lines, [true, false, false]);
    }
}
