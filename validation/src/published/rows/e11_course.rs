//! E11: the course of oblique impacts: regimes of the motion, paths, force peaks, and what governs the stop.

use crate::beds::Record;
use crate::published::check::Check;
use crate::published::laboratory::Laboratory;
use crate::published::oblique::matrix::{self, Cell, READINGS, Reading};
use crate::published::plot::{Panel, Plot};
use crate::published::row::{Findings, PublishedError, Row};

pub(super) static ROW: Row = Row {
    id: "E11",
    title: "Course of oblique impacts: regimes, paths, force peaks, and the vertical speed that governs the stop",
    source: "Wang, Ye & Zheng 2012, §3.1–3.5, Figs 1–4, 7",
    how: [
        "the impacts of E1; 15° for the flattest angle; not the crater",
        "the impacts of E1; not the crater",
    ],
    judge,
};

/// Angle (deg) of the early and high force peak, and the speed (m/s) of Fig. 7.
const STEEP: f64 = 45.0;
const SPEED: f64 = 2.0;

/// The article's scatter of depths and ranges between positions, as a share.
const SCATTER: f64 = 0.06;

/// Time that a force is averaged over (s): a twentieth of the shortest impact.
const SMOOTH: f64 = 8e-3;

fn judge(laboratory: &Laboratory<'_>) -> Result<Findings, PublishedError> {
    let ran = matrix::run(laboratory, |_| true)?;
    let cells = &ran.cells;
    let angles = matrix::angles(cells);
    let mut findings = Findings::default();
    for reading in &READINGS {
        findings.checks.push(displacement(reading, cells, &angles));
        findings.checks.push(peaks(reading, cells, angles[0]));
        findings.checks.push(governed(reading, cells));
        findings.checks.push(straightness(reading, cells));
        findings.checks.push(regimes(reading, cells));
    }
    findings.show(
        "e11-paths.svg",
        "Paths until the stop, as printed, at every angle and speed.",
        paths(cells, &angles)?,
    );
    findings.notes.extend(ran.note());
    findings.notes.push(
        "The asymmetric crater and the velocity fields of Figs 2 and 3 are not judged here; a run with \
         log.fields_at writes both."
            .to_owned(),
    );
    Ok(findings)
}

fn mean(cell: &Cell, of: impl Fn(&Record) -> f64) -> f64 {
    cell.records.iter().map(of).sum::<f64>() / cell.records.len() as f64
}

fn same_speed<'a>(cells: &'a [Cell], reading: &Reading, speed: f64) -> Vec<&'a Cell> {
    let same = |cell: &&Cell| cell.reading == reading && (cell.speed - speed).abs() < 1e-9;
    cells.iter().filter(same).collect()
}

/// The whole displacement falls with the angle, at the speeds that every angle was run at: where by the article's own
/// Table 1 it falls by more than its positions scatter. At 0.5 m/s from 75° to 90°, that table has it rise.
fn displacement(reading: &Reading, cells: &[Cell], angles: &[f64]) -> Check {
    let speeds = matrix::of(cells, reading, angles[0]).into_iter().map(|cell| cell.speed);
    let common: Vec<Vec<&Cell>> = speeds
        .map(|speed| same_speed(cells, reading, speed))
        .filter(|row| row.len() == angles.len())
        .collect();
    let way = |cell: &&Cell| mean(cell, |one| libm::hypot(one.deepest, one.reached));
    let published = |cell: &Cell| {
        let range = cell.published.range.map_or(0.0, |line| line.at(cell.speed));
        libm::hypot(cell.published.depth.at(cell.speed), range)
    };
    let is_asked = |pair: &[&Cell]| published(pair[1]) < (1.0 - SCATTER) * published(pair[0]);
    let falls = |row: &Vec<&Cell>| {
        row.windows(2).all(|pair| !is_asked(pair) || way(&pair[1]) < way(&pair[0]))
    };
    let shown = common.iter().map(|row| {
        let ways: Vec<String> = row.iter().map(|cell| format!("{:.0}", 1e3 * way(cell))).collect();
        format!("{} m/s: {}", row[0].speed, ways.join(", "))
    });
    Check::trend(
        format!("{}: whole displacement (mm), from flat to steep", reading.name),
        ("falls with the angle", shown.collect::<Vec<_>>().join("; ")),
        "every step from angle to angle, at every common speed, by which Table 1 falls by more than 6 %",
        !common.is_empty() && common.iter().all(falls),
    )
}

/// Time of the largest force (s), over [`SMOOTH`], and that force over the mass (m/s²).
fn peak(record: &Record) -> (f64, f64) {
    let n = (SMOOTH / record.interval) as usize;
    let last = record.depth.len().saturating_sub(n + 1);
    let velocity = |path: &[f64], at: usize| (path[at + 1] - path[at]) / record.interval;
    let force = |at: usize| {
        let change = |path: &[f64]| (velocity(path, at + n - 1) - velocity(path, at)) / SMOOTH;
        libm::hypot(change(&record.depth), change(&record.range))
    };
    (0..last)
        .map(|at| (at as f64 * record.interval + 0.5 * SMOOTH, force(at)))
        .fold((0.0, 0.0), |best, one| if one.1 > best.1 { one } else { best })
}

/// The force peaks early and high at 45°, lower and later at the flattest angle.
fn peaks(reading: &Reading, cells: &[Cell], flattest: f64) -> Check {
    let of = |angle: f64| {
        let mut own = matrix::of(cells, reading, angle).into_iter();
        own.find(|cell| (cell.speed - SPEED).abs() < 1e-9).map_or((f64::NAN, f64::NAN), |cell| {
            (mean(cell, |one| peak(one).0), mean(cell, |one| peak(one).1))
        })
    };
    let (steep, flat) = (of(STEEP), of(flattest));
    let ours = format!(
        "{:.0} m/s² after {:.0} ms at {STEEP}°, {:.0} m/s² after {:.0} ms at {flattest}°",
        steep.1,
        1e3 * steep.0,
        flat.1,
        1e3 * flat.0
    );
    Check::trend(
        format!("{}: largest force over the mass at {SPEED} m/s", reading.name),
        ("early and high at 45°, much lower and later at 5°", ours),
        "lower and later at the flattest angle; over 8 ms",
        flat.1 < steep.1 && flat.0 > steep.0,
    )
}

/// The stopping time follows the vertical speed rather than the horizontal one.
fn governed(reading: &Reading, cells: &[Cell]) -> Check {
    let own: Vec<&Cell> = cells.iter().filter(|cell| cell.reading == reading).collect();
    let times: Vec<f64> =
        own.iter().map(|cell| mean(cell, |one| one.stopping_time.unwrap_or(one.end))).collect();
    let by = |of: fn(f64) -> f64| -> f64 {
        let speeds: Vec<f64> =
            own.iter().map(|cell| cell.speed * of(cell.published.angle_deg.to_radians())).collect();
        rank_correlation(&speeds, &times)
    };
    let (vertical, horizontal) = (by(libm::sin), by(libm::cos));
    Check::trend(
        format!(
            "{}: rank correlation of the stopping time with the speed's components",
            reading.name
        ),
        (
            "governed by the vertical speed",
            format!("{vertical:.2} vertical, {horizontal:.2} horizontal"),
        ),
        "larger in magnitude with the vertical speed",
        vertical.abs() > horizontal.abs(),
    )
}

/// Paths bend the less, the faster they enter.
fn straightness(reading: &Reading, cells: &[Cell]) -> Check {
    let oblique = |cell: &&Cell| cell.reading == reading && cell.published.angle_deg < 90.0;
    let own: Vec<&Cell> = cells.iter().filter(oblique).collect();
    let bends: Vec<f64> = own.iter().map(|cell| mean(cell, bend)).collect();
    let speeds: Vec<f64> = own
        .iter()
        .map(|cell| cell.speed * libm::sin(cell.published.angle_deg.to_radians()))
        .collect();
    let found = rank_correlation(&speeds, &bends);
    Check::trend(
        format!("{}: rank correlation of the bend of a path with the vertical speed", reading.name),
        ("from curved to straight as the vertical speed passes 1.12 m/s", format!("{found:.2}")),
        "negative by more than one half",
        found < -0.5,
    )
}

/// Largest distance of the path until the stop from its chord, over the chord.
fn bend(record: &Record) -> f64 {
    let n = stop(record);
    let (x, y) = (record.range[n], record.depth[n]);
    let chord = libm::hypot(x, y);
    let off = |at: usize| (record.range[at] * y - record.depth[at] * x).abs() / chord;
    (0..n).map(off).fold(0.0, f64::max) / chord
}

/// The last sample before the stop.
fn stop(record: &Record) -> usize {
    let time = record.stopping_time.unwrap_or(record.end);
    ((time / record.interval) as usize).min(record.depth.len() - 1)
}

/// Impact, penetration and collapse in the vertical velocity at 90°: it loses most at first, then less, and
/// little of it is left for the last third of the time.
fn regimes(reading: &Reading, cells: &[Cell]) -> Check {
    let own = matrix::of(cells, reading, 90.0);
    let fast: Vec<&Cell> = own.into_iter().filter(|cell| cell.speed >= 2.0).collect();
    let velocity = |record: &Record, share: f64| {
        let at = ((share * stop(record) as f64) as usize).max(1);
        (record.depth[at] - record.depth[at - 1]) / record.interval
    };
    let shares = |cell: &&Cell| {
        [0.05, 1.0 / 3.0, 2.0 / 3.0]
            .map(|share| mean(cell, |one| velocity(one, share) / cell.speed))
    };
    let all: Vec<[f64; 3]> = fast.iter().map(shares).collect();
    let holds = |[first, second, third]: &[f64; 3]| {
        // Per unit of time: a twentieth, then a third, then a third of the whole.
        let rates =
            [(1.0 - first) / 0.05, (first - second) / (1.0 / 3.0 - 0.05), (second - third) * 3.0];
        rates[0] > rates[1] && rates[1] > rates[2] && third.abs() < 0.25
    };
    let shown: Vec<String> = fast
        .iter()
        .zip(&all)
        .map(|(cell, [a, b, c])| format!("{} m/s: {a:.2}, {b:.2}, {c:.2}", cell.speed))
        .collect();
    Check::trend(
        format!(
            "90°, {}: velocity left after a twentieth, a third and two thirds of the stopping time",
            reading.name
        ),
        ("impact, penetration, collapse", shown.join("; ")),
        "it falls fastest at first, then less and less, and below a quarter for the last third; from 2 m/s on",
        !all.is_empty() && all.iter().all(holds),
    )
}

fn paths(cells: &[Cell], angles: &[f64]) -> Result<String, PublishedError> {
    let panel = |angle: &f64| {
        let own = matrix::of(cells, &READINGS[0], *angle);
        let curve = |cell: &&Cell| {
            let record = &cell.records[0];
            let places = (0..=stop(record)).step_by(4);
            (0, places.map(|at| (record.range[at], -record.depth[at])).collect())
        };
        Panel {
            title: format!("{angle} deg"),
            points: Vec::new(),
            curves: own.iter().map(curve).collect(),
        }
    };
    let plot = Plot {
        axes: ["distance (m)", "height of the lowest point (m)"],
        names: vec![READINGS[0].name.to_owned()],
        panels: angles.iter().map(panel).collect(),
    };
    Ok(plot.draw()?)
}

/// Spearman's correlation; ties keep their order.
fn rank_correlation(x: &[f64], y: &[f64]) -> f64 {
    let ranks = |values: &[f64]| {
        let mut order: Vec<usize> = (0..values.len()).collect();
        order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
        let mut ranks = vec![0.0; values.len()];
        for (rank, at) in order.into_iter().enumerate() {
            ranks[at] = rank as f64;
        }
        ranks
    };
    let (x, y) = (ranks(x), ranks(y));
    let n = x.len() as f64;
    let squares: f64 = x.iter().zip(&y).map(|(a, b)| (a - b) * (a - b)).sum();
    1.0 - 6.0 * squares / (n * (n * n - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::published::oblique::records::record;

    #[test]
    fn ranks_that_agree_correlate_by_one_and_reversed_ones_by_minus_one() {
        let x = [0.1, 5.0, 2.0, 3.0];
        // Exact: sums of small integers.
        assert!((rank_correlation(&x, &x.map(|x| x * x)) - 1.0).abs() < 1e-15);
        assert!((rank_correlation(&x, &x.map(|x| -x)) + 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_straight_path_has_no_bend_and_a_right_angle_has_half_its_chord() {
        let straight = record(1.0, vec![0.0, 1.0, 2.0], vec![0.0, 2.0, 4.0]);
        let corner = record(1.0, vec![0.0, 1.0, 1.0], vec![0.0, 0.0, 1.0]);
        assert!(bend(&straight) < 1e-15 && (bend(&corner) - 0.5).abs() < 1e-15, "rounding");
    }
}
