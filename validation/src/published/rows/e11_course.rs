//! E11: the course of oblique impacts: regimes of the motion, paths, force peaks, and what governs the stop.

use runner::beds::Record;

use crate::published::check::{Band, Check, Estimate, SIGMAS, Verdict};
use crate::published::laboratory::Laboratory;
use crate::published::oblique::matrix::{self, Cell, READINGS, Reading};
use crate::published::plot::{Panel, Plot};
use crate::published::regression;
use crate::published::row::{Findings, PublishedError, Row};
use crate::three_shapes::mean_and_error;

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

/// Slowest impacts (m/s) in whose velocity the regimes are looked for: as fast as the one of Fig. 7.
const FAST: f64 = 2.0;

/// The article's scatter of depths and ranges between positions, as a share.
const SCATTER: f64 = 0.06;

const REASON: &str = "two standard errors (Student's t), by leaving out speeds and angles";

/// Why nothing is said of impacts that are not there.
const NONE: &str = "its impacts are not there";

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
        findings.checks.extend(regimes(reading, cells));
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
/// Table 1 it falls by more than the means over as many positions as there are differ by scatter. At 0.5 m/s from 75° to
/// 90°, that table has it rise.
fn displacement(reading: &Reading, cells: &[Cell], angles: &[f64]) -> Check {
    let speeds = matrix::of(cells, reading, angles[0]).into_iter().map(|cell| cell.speed);
    let common: Vec<Vec<&Cell>> = speeds
        .map(|speed| same_speed(cells, reading, speed))
        .filter(|row| row.len() == angles.len())
        .collect();
    let way = |cell: &&Cell| mean(cell, |one| libm::hypot(one.deepest, one.reached));
    let of_table = |cell: &Cell| {
        let range = cell.published.range.map_or(0.0, |line| line.at(cell.speed));
        libm::hypot(cell.published.depth.at(cell.speed), range)
    };
    let is_asked = |pair: &[&Cell]| {
        let variance: f64 = pair.iter().map(|cell| 1.0 / cell.records.len() as f64).sum();
        of_table(pair[1]) < (1.0 - SIGMAS * SCATTER * variance.sqrt()) * of_table(pair[0])
    };
    let falls = |row: &Vec<&Cell>| {
        row.windows(2).all(|pair| !is_asked(pair) || way(&pair[1]) < way(&pair[0]))
    };
    let shown = common.iter().map(|row| {
        let ways: Vec<String> = row.iter().map(|cell| format!("{:.0}", 1e3 * way(cell))).collect();
        format!("{} m/s: {}", row[0].speed, ways.join(", "))
    });
    let what = format!("{}: whole displacement (mm), from flat to steep", reading.name);
    let published = "falls with the angle";
    if common.is_empty() || angles.len() < 2 {
        return Check::unanswered(what, published, Verdict::NotRun, NONE);
    }
    Check::trend(
        what,
        (published, shown.collect::<Vec<_>>().join("; ")),
        "every step from angle to angle, at every common speed, by which Table 1 falls by more than two standard errors of \
         the difference, its scatter being 6 %",
        common.iter().all(falls),
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
    let what = format!("{}: largest force over the mass at {SPEED} m/s", reading.name);
    let published = "early and high at 45°, much lower and later at 5°";
    let of = |angle: f64| {
        let own = matrix::of(cells, reading, angle);
        let cell = own.into_iter().find(|cell| (cell.speed - SPEED).abs() < 1e-9)?;
        Some((mean(cell, |one| peak(one).0), mean(cell, |one| peak(one).1)))
    };
    let (Some(steep), Some(flat), true) = (of(STEEP), of(flattest), flattest < STEEP) else {
        return Check::unanswered(what, published, Verdict::NotRun, NONE);
    };
    let ours = format!(
        "{:.0} m/s² after {:.0} ms at {STEEP}°, {:.0} m/s² after {:.0} ms at {flattest}°",
        steep.1,
        1e3 * steep.0,
        flat.1,
        1e3 * flat.0
    );
    Check::trend(
        what,
        (published, ours),
        "lower and later at the flattest angle; over 8 ms",
        flat.1 < steep.1 && flat.0 > steep.0,
    )
}

/// The stopping time follows the vertical speed rather than the horizontal one: by the article's Table 2, the rank
/// correlations are −0.90 and 0.52 over its angles and the speeds of the full matrix, −0.80 and 0.57 over those of quick.
fn governed(reading: &Reading, cells: &[Cell]) -> Check {
    let own = cells.iter().filter(|cell| cell.reading == reading);
    let points: Vec<[f64; 3]> = own
        .map(|cell| {
            let time = mean(cell, |one| one.stopping_time.unwrap_or(one.end));
            let angle = cell.published.angle_deg.to_radians();
            [cell.speed * libm::sin(angle), cell.speed * libm::cos(angle), time]
        })
        .collect();
    let fit = |without: Option<usize>| {
        let kept: Vec<&[f64; 3]> = left(&points, without);
        let of = |at: usize| kept.iter().map(|one| one[at]).collect::<Vec<f64>>();
        let [vertical, horizontal] = [0, 1].map(|at| rank_correlation(&of(at), &of(2)));
        Some(vec![vertical.abs() - horizontal.abs(), vertical, horizontal])
    };
    let Some(found) = regression::leaving_out(points.len(), fit).filter(|_| points.len() > 2)
    else {
        let what = format!("{}: rank correlations of the stopping time", reading.name);
        return Check::unanswered(what, "governed by the vertical speed", Verdict::NotRun, NONE);
    };
    let what = format!(
        "{}: rank correlation of the stopping time with the vertical speed, {:.2}, and with the horizontal one, {:.2}: \
         the first is larger in magnitude by",
        reading.name, found[1].value, found[2].value
    );
    Check::positive(what, "governed by the vertical speed", found[0], band(found[0], points.len()))
}

/// Paths bend the less, the faster they enter.
fn straightness(reading: &Reading, cells: &[Cell]) -> Check {
    let oblique = |cell: &&Cell| cell.reading == reading && cell.published.angle_deg < 90.0;
    let points: Vec<[f64; 2]> = cells
        .iter()
        .filter(oblique)
        .map(|cell| {
            let vertical = cell.speed * libm::sin(cell.published.angle_deg.to_radians());
            [vertical, mean(cell, bend)]
        })
        .collect();
    let fit = |without: Option<usize>| {
        let kept: Vec<&[f64; 2]> = left(&points, without);
        let of = |at: usize| kept.iter().map(|one| one[at]).collect::<Vec<f64>>();
        Some(vec![-rank_correlation(&of(0), &of(1))])
    };
    let what = format!(
        "{}: rank correlation of the bend of a path with the vertical speed, its sign turned",
        reading.name
    );
    let published = "from curved to straight as the vertical speed passes 1.12 m/s";
    match regression::leaving_out(points.len(), fit).filter(|_| points.len() > 2) {
        Some(found) => Check::positive(what, published, found[0], band(found[0], points.len())),
        None => Check::unanswered(what, published, Verdict::NotRun, NONE),
    }
}

/// All of `points` but one.
fn left<T>(points: &[T], without: Option<usize>) -> Vec<&T> {
    let kept = points.iter().enumerate().filter(|(at, _)| Some(*at) != without);
    kept.map(|(_, one)| one).collect()
}

/// By what a number of so many points has to be positive.
fn band(of: Estimate, points: usize) -> Band {
    let half = regression::student(SIGMAS, points.saturating_sub(1)) * of.error;
    Band { half, reason: REASON }
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

/// Impact, penetration and collapse in the vertical velocity at 90°: it falls fastest at first, then less, and least in
/// the last third of the time, in the mean over impacts. Under a constant force it would fall alike throughout.
fn regimes(reading: &Reading, cells: &[Cell]) -> [Check; 2] {
    let own = matrix::of(cells, reading, 90.0);
    let fast = own.into_iter().filter(|cell| cell.speed >= FAST);
    let rates: Vec<[f64; 3]> =
        fast.flat_map(|cell| cell.records.iter().map(|one| rates(one, cell.speed))).collect();
    let falling = |regimes: &str, at: usize| {
        let falls: Vec<f64> = rates.iter().map(|one| one[at] - one[at + 1]).collect();
        let (mean, error) = mean_and_error(&falls);
        let what = format!(
            "90°, {}, from {FAST} m/s on: rate at which the velocity is lost, {regimes} (impact speeds per stopping time)",
            reading.name
        );
        let half = regression::student(SIGMAS, falls.len().saturating_sub(1)) * error;
        let reason = "two standard errors (Student's t) of the scatter of impacts";
        let published = "three regimes: impact, penetration, collapse";
        if falls.is_empty() {
            return Check::unanswered(what, published, Verdict::NotRun, NONE);
        }
        Check::positive(what, published, Estimate::new(mean, error), Band { half, reason })
    };
    [
        falling("impact (first twentieth) less penetration (until two thirds)", 0),
        falling("penetration less collapse (last third)", 1),
    ]
}

/// Impact speeds per stopping time that an impact at `speed` (m/s) loses in the first twentieth of its stopping time, from
/// then until two thirds of it, and from there on.
fn rates(record: &Record, speed: f64) -> [f64; 3] {
    let velocity = |share: f64| {
        let at = ((share * stop(record) as f64) as usize).max(1);
        (record.depth[at] - record.depth[at - 1]) / record.interval / speed
    };
    let ends = [0.05, 2.0 / 3.0, 1.0];
    let [first, second, third] = ends.map(velocity);
    [
        (1.0 - first) / ends[0],
        (first - second) / (ends[1] - ends[0]),
        (second - third) / (ends[2] - ends[1]),
    ]
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
    use crate::published::oblique::records::{cells, record, straight_down};
    use crate::published::oblique::tables::published;

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

    const SPEEDS: [f64; 4] = [1.0, 2.0, 3.0, 4.0];
    const ANGLES: [f64; 4] = [15.0, 30.0, 45.0, 60.0];

    /// Straight impacts at every angle that end at a range, a depth (m) and a time (s).
    fn ended(at: impl Fn(f64, f64) -> [f64; 3]) -> Vec<Cell> {
        let all = ANGLES.iter().flat_map(|&angle| {
            cells(angle, &SPEEDS, |speed| {
                let [range, depth, time] = at(angle, speed);
                record(time, vec![0.0, range], vec![0.0, depth])
            })
        });
        all.collect()
    }

    #[test]
    fn displacements_of_table_1_fall_with_the_angle_and_equal_ones_fail() {
        let verdict = |cells: &[Cell]| displacement(&READINGS[0], cells, &ANGLES).verdict;
        let as_published = ended(|angle, speed| {
            let one = published(angle).expect("an angle of the tables");
            [one.range.map_or(0.0, |line| line.at(speed)), one.depth.at(speed), 0.2]
        });
        assert_eq!(verdict(&as_published), Verdict::Pass);
        assert_eq!(verdict(&ended(|_, speed| [0.05 * speed, 0.1, 0.2])), Verdict::Fail);
    }

    #[test]
    fn times_that_follow_the_vertical_speed_pass_and_those_of_the_horizontal_one_fail() {
        let verdict = |of: fn(f64) -> f64| {
            let cells =
                ended(|angle, speed| [0.1, 0.1, 0.5 / (1.0 + speed * of(angle.to_radians()))]);
            governed(&READINGS[0], &cells).verdict
        };
        assert_eq!([verdict(libm::sin), verdict(libm::cos)], [Verdict::Pass, Verdict::Fail]);
    }

    #[test]
    fn paths_that_straighten_with_the_vertical_speed_pass_and_those_that_bend_more_fail() {
        let verdict = |sign: f64| {
            let bent = |angle: f64, speed: f64| {
                let side = 0.09 - sign * 0.01 * speed * libm::sin(angle.to_radians());
                record(0.1, vec![0.0, 0.1 - side, 0.1], vec![0.0, side, 0.1])
            };
            let all = ANGLES.iter().flat_map(|&angle| cells(angle, &SPEEDS, |v| bent(angle, v)));
            straightness(&READINGS[0], &all.collect::<Vec<_>>()).verdict
        };
        // The corner at (0.1 − side, side) lies off the chord x = y by what `side` is above 0.05.
        assert_eq!([verdict(1.0), verdict(-1.0)], [Verdict::Pass, Verdict::Fail]);
    }

    #[test]
    fn a_force_that_peaks_early_and_high_when_steep_passes_and_the_other_way_round_fails() {
        let early = |v: f64| straight_down(v, |y, v| 0.5 * v * v + 6.0 * y);
        let late = |v: f64| straight_down(v, |y, _| 0.5 + 8.0 * y);
        let verdict = |steep: fn(f64) -> Record, flat: fn(f64) -> Record| {
            let all = [cells(STEEP, &[SPEED], steep), cells(15.0, &[SPEED], flat)].concat();
            peaks(&READINGS[0], &all, 15.0).verdict
        };
        assert_eq!([verdict(early, late), verdict(late, early)], [Verdict::Pass, Verdict::Fail]);
    }

    #[test]
    fn a_velocity_lost_fast_then_slowly_has_its_regimes_and_one_lost_late_has_none() {
        let verdicts = |velocity: fn(f64) -> f64| {
            let cells = cells(90.0, &[2.0, 3.0, 4.0], |speed| {
                let mut depth = vec![0.0];
                for step in 0..400 {
                    let share = (f64::from(step) + 0.5) / 400.0;
                    depth.push(depth[depth.len() - 1] + speed * velocity(share) * 5e-4);
                }
                record(5e-4, vec![0.0; 401], depth)
            });
            regimes(&READINGS[0], &cells).map(|check| check.verdict)
        };
        assert_eq!(verdicts(|share| libm::exp(-5.0 * share)), [Verdict::Pass; 2]);
        assert_eq!(verdicts(|share| 1.0 - share * share), [Verdict::Fail; 2]);
    }
}
