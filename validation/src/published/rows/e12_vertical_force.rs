//! E12: the force of vertical impacts over v² and depth, its coefficients and the plateau beside other scales.

use runner::beds::Record;

use crate::published::check::{Band, Check, Estimate, Known, SIGMAS};
use crate::published::laboratory::Laboratory;
use crate::published::oblique::curves::{Form, series};
use crate::published::oblique::force::{Component, Reading, mean_readings, readings, separate};
use crate::published::oblique::matrix::{self, Cell, DIAMETER, GRAVITY, MASS, READINGS};
use crate::published::plot::{Panel, Plot, Points};
use crate::published::regression;
use crate::published::row::{Findings, PublishedError, Row, Table};
use crate::published::rows::e01_stopping_time::KNOWN;
use crate::three_shapes::mean_and_error;

pub(super) static ROW: Row = Row {
    id: "E12",
    title: "90°: force against v² at three depths and against depth; scales of speed and time",
    source: "Wang, Ye & Zheng 2012, §3.4–3.5, Figs 6, 12, 13; Katsuragi & Durian 2007; Krizou & Clark 2019",
    how: ["the vertical impacts of E1", "the vertical impacts of E1"],
    judge,
};

/// Depths (m) of Fig. 12.
const DEPTHS: [f64; 3] = [0.055, 0.075, 0.085];

/// 1/d₁ (1/m) and k/m (1/s²) of a steel sphere of an inch in glass beads: Katsuragi & Durian 2007, with
/// d₁ = 0.087 m.
const OTHERS: [f64; 2] = [1.0 / 0.087, 1040.0];

/// The published plateau (s).
const PLATEAU: f64 = 0.16;

/// How long after contact a force is early (s): about what the disc takes for its own diameter.
const EARLY: f64 = 0.01;

/// The same order of magnitude: within a factor of ten either way.
const ORDER: f64 = 10.0;

/// Mass of a disc of the bed over its area (kg/m²): 0.049 g, 4.56 mm.
const GRAIN_DENSITY: f64 = 4.9e-5 / (std::f64::consts::FRAC_PI_4 * 0.00456 * 0.00456);

fn judge(laboratory: &Laboratory<'_>) -> Result<Findings, PublishedError> {
    let ran = matrix::run(laboratory, |angle| angle >= 90.0)?;
    let cells = &ran.cells;
    let mut findings = Findings::default();
    let mut panels: Vec<Panel> = DEPTHS
        .iter()
        .map(|depth| Panel { title: format!("{:.0} mm deep", 1e3 * depth), ..Panel::default() })
        .collect();
    let mut others = Table::new(
        "Force over mass: α/m (1/m) and f/m (1/s²), beside a steel sphere of an inch in glass beads.",
        &["reading", "α/m", "f/m", "α/m there", "f/m there"],
    );
    for (number, reading) in READINGS.iter().enumerate() {
        let own = matrix::of(cells, reading, 90.0);
        for (depth, panel) in DEPTHS.iter().zip(&mut panels) {
            panel.points.push(Points { series: number, places: places(*depth, &own) });
        }
        findings.checks.extend(over_square(reading.name, &own));
        if let Some(found) = separate(&own, Component::Vertical) {
            let [drag, friction] = [found.drag, found.friction].map(|one| one.times(1.0 / MASS));
            others.rows.push(vec![
                reading.name.to_owned(),
                drag.to_string(),
                friction.to_string(),
                format!("{:.1}", OTHERS[0]),
                format!("{:.0}", OTHERS[1]),
            ]);
            for (name, ours, there) in
                [("α/m (1/m)", drag, OTHERS[0]), ("f/m (1/s²)", friction, OTHERS[1])]
            {
                let title = format!("90°, {}: {name}", reading.name);
                let margin = found.as_surely_as(SIGMAS) * ours.error;
                findings.checks.push(of_the_order(title, (ours, margin), there));
            }
        }
        findings.checks.extend(early_peak(reading.name, &own));
        findings.checks.push(plateau(reading.name, &own, &KNOWN[number]));
    }
    findings.tables.push(others);
    findings.tables.push(scales());
    let names = READINGS.iter().map(|one| one.name.to_owned()).collect();
    let plot =
        Plot { axes: ["v² (m²/s²)", "force of the bed over mass (m/s²)"], names, panels };
    findings.show(
        "e12-force-over-square.svg",
        "Force of the bed over the mass of the disc against the square of its velocity, at three depths.",
        plot.draw()?,
    );
    findings.notes.extend(ran.note());
    Ok(findings)
}

/// Whether a number of ours, known within a margin, is of the order of one `there`.
fn of_the_order(title: String, (ours, margin): (Estimate, f64), there: f64) -> Check {
    let ratio = ours.value / there;
    let is_of_it = |value: f64| (1.0 / ORDER..=ORDER).contains(&(value / there));
    let reached = ours.value + margin >= there / ORDER && ours.value - margin <= ORDER * there;
    Check::trend(
        format!("{title} is of the order of Katsuragi & Durian's"),
        ("the same order of magnitude", format!("{ours}: {ratio:.2} times theirs")),
        "within a factor of ten, by two standard errors (Student's t)",
        is_of_it(ours.value),
    )
    .undecided_if(!is_of_it(ours.value) && reached)
}

/// Whether the force rises with v² at the three depths by one slope, from a force at rest that rises with depth.
fn over_square(reading: &str, cells: &[&Cell]) -> [Check; 3] {
    let impacts: Vec<Vec<Reading>> = cells
        .iter()
        .flat_map(|cell| &cell.records)
        .map(|record| readings(record, Component::Vertical))
        .map(|all| all.into_iter().flatten().filter(|one| at(one).is_some()).collect())
        .collect();
    let fit = |without: Option<usize>| {
        let kept = impacts.iter().enumerate().filter(|(number, _)| Some(*number) != without);
        let all: Vec<&Reading> = kept.flat_map(|(_, own)| own).collect();
        let level = |depth: usize| all.iter().map(move |one| f64::from(at(one) == Some(depth)));
        let squares = all.iter().map(|one| one.square).collect();
        let columns = [vec![squares], (0..DEPTHS.len()).map(|d| level(d).collect()).collect()];
        let forces: Vec<f64> = all.iter().map(|one| one.force / MASS).collect();
        let fitted = regression::linear(&columns.concat(), &forces, None)?;
        let [slope, first, second, third] = fitted.coefficients[..] else { return None };
        Some(vec![slope, first, second, third, third - first])
    };
    let found = regression::leaving_out(impacts.len(), fit);
    let found = found.unwrap_or_else(|| vec![Estimate::new(f64::NAN, 0.0); 5]);
    let sigmas = regression::student(SIGMAS, impacts.len().saturating_sub(1));
    let title = format!("90°, {reading}, force over mass at 55, 75, 85 mm");
    let positive = |what: &str, published: &str, ours: Estimate| {
        let reason = "two standard errors (Student's t), by leaving out impacts";
        let band = Band { half: sigmas * ours.error, reason };
        Check::positive(format!("{title}: {what}"), published, ours, band)
    };
    let least = |a: Estimate, b: &Estimate| if b.value < a.value { *b } else { a };
    [
        positive("slope over v² (1/m), one for all", "a rising line (Fig. 12)", found[0]),
        positive(
            "at rest, the least of the three (m/s²)",
            "positive (Fig. 12)",
            found[2..4].iter().fold(found[1], least),
        ),
        positive("at rest, 85 mm less 55 mm (m/s²)", "rises with depth (Fig. 13)", found[4]),
    ]
}

/// Which of the depths a reading is at.
fn at(reading: &Reading) -> Option<usize> {
    DEPTHS.iter().position(|depth| (depth - reading.depth).abs() < 1e-9)
}

/// v² and force over mass at `depth` (m), averaged over positions.
fn places(depth: f64, cells: &[&Cell]) -> Vec<(f64, f64, f64)> {
    let readings = cells.iter().flat_map(|cell| mean_readings(cell, Component::Vertical));
    let here = readings.filter(|one| (one.depth - depth).abs() < 1e-9);
    here.map(|one| (one.square, one.force / MASS, 0.0)).collect()
}

/// The largest early force of the fastest impacts over that of the law which all impacts give.
fn early_peak(reading: &str, cells: &[&Cell]) -> Option<Check> {
    let law = separate(cells, Component::Vertical)?.law();
    let fastest = cells.iter().max_by(|a, b| a.speed.total_cmp(&b.speed))?;
    let ratio = |record: &Record| {
        let (depth, dt) = (&record.depth, record.interval);
        let force = |at: usize| {
            let acceleration = (depth[at + 1] - 2.0 * depth[at] + depth[at - 1]) / (dt * dt);
            let velocity = (depth[at + 1] - depth[at - 1]) / (2.0 * dt);
            let by_law = law.drag * velocity * velocity + law.friction * depth[at];
            (MASS * (GRAVITY - acceleration), by_law)
        };
        let last = ((EARLY / dt) as usize).min(depth.len().saturating_sub(2));
        let largest = (1..=last).map(force).max_by(|a, b| a.0.total_cmp(&b.0));
        largest.map_or(f64::NAN, |(force, by_law)| force / by_law)
    };
    let ratios: Vec<f64> = fastest.records.iter().map(ratio).collect();
    let (mean, error) = mean_and_error(&ratios);
    Some(Check::trend(
        format!(
            "90°, {reading}, {} m/s: largest force of the first 10 ms over the law there",
            fastest.speed
        ),
        (
            "early peaks beyond a law α v² + f y (Krizou & Clark 2019)",
            Estimate::new(mean, error).to_string(),
        ),
        "more than one in every impact; forces over 0.5 ms",
        ratios.iter().all(|ratio| *ratio > 1.0),
    ))
}

/// Times (s) and speeds (m/s) that other articles have for the plateau: their forms with this disc.
fn forms() -> [(&'static str, f64, Option<f64>); 3] {
    let radius = 0.5 * DIAMETER;
    let ratio = MASS / (std::f64::consts::PI * radius * radius) / GRAIN_DENSITY;
    let (time, speed) = ((2.0 * radius / GRAVITY).sqrt(), (2.0 * GRAVITY * radius).sqrt());
    [
        ("(2R/g)^½, (2gR)^½", time, Some(speed)),
        ("(ρ_b/ρ_g)^¼ (2R/g)^½", ratio.sqrt().sqrt() * time, None),
        ("(2ρ_b R/(ρ_g g))^½, (2ρ_b g R/ρ_g)^½", ratio.sqrt() * time, Some(ratio.sqrt() * speed)),
    ]
}

/// Where the plateau of the stopping time lies among those forms.
fn plateau(reading: &str, cells: &[&Cell], known: &Known) -> Check {
    let what =
        format!("90°, {reading}: plateau of the stopping time (s) among the forms of others");
    let published = "0.16 s: above (2R/g)^½, below (2ρ_b R/(ρ_g g))^½";
    let points = series(cells, |record| record.stopping_time);
    let fitted = Form::Exponential.fit(&points.speeds, &points.means, points.errors.as_deref());
    let Some(fitted) = fitted else {
        return Check::undecided(what, published, "fewer than four speeds are there");
    };
    let ours = Estimate::new(fitted.coefficients[2], fitted.error(2));
    let [(_, shortest, _), _, (_, longest, _)] = forms();
    let margin = points.as_surely_as(&fitted, SIGMAS) * ours.error;
    Check::trend(
        what,
        (published, ours.to_string()),
        &format!(
            "between {shortest:.3} and {longest:.3} s, by two standard errors of ours (Student's t)"
        ),
        (shortest - margin..=longest + margin).contains(&ours.value),
    )
    .unless_known(Some(known), (ours.value / PLATEAU, margin / PLATEAU))
}

fn scales() -> Table {
    let mut table = Table::new(
        "Scales of the plateau, for this disc; published: about 0.16 s from about 1 m/s on.",
        &["form", "time (s)", "speed (m/s)"],
    );
    table.rows = forms()
        .map(|(form, time, speed)| {
            let speed = speed.map_or("–".to_owned(), |speed| format!("{speed:.2}"));
            vec![form.to_owned(), format!("{time:.3}"), speed]
        })
        .to_vec();
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::published::Verdict;
    use crate::published::oblique::records::{cells, record, straight_down};

    #[test]
    fn the_published_plateau_lies_between_the_forms_of_others() {
        let [(_, shortest, speed), _, (_, longest, _)] = forms();
        assert!(shortest < 0.16 && 0.16 < longest, "{shortest} {longest}");
        // "Slightly larger than (2gR)^½": the article's characteristic speed is about 1 m/s.
        assert!(speed.is_some_and(|speed| speed < 1.0), "{speed:?}");
    }

    const SPEEDS: [f64; 4] = [1.0, 2.0, 3.0, 4.0];

    fn of_force(force: impl Fn(f64, f64) -> f64) -> Vec<Cell> {
        cells(90.0, &SPEEDS, |speed| straight_down(speed, &force))
    }

    #[test]
    fn a_force_that_rises_with_the_square_and_the_depth_passes_and_others_fail() {
        let verdicts = |force: fn(f64, f64) -> f64| {
            let cells = of_force(force);
            over_square("", &cells.iter().collect::<Vec<_>>()).map(|check| check.verdict)
        };
        assert_eq!(verdicts(|y, v| 0.27 * v * v + 4.5 * y), [Verdict::Pass; 3]);
        assert_eq!(verdicts(|y, v| 8.0 * y - 0.01 * v * v)[0], Verdict::Fail);
        // Against this force the disc goes on at a speed of its own.
        assert_eq!(verdicts(|_, v| v * v - 0.3)[1], Verdict::Fail);
        assert_eq!(verdicts(|y, v| 0.27 * v * v + 0.7 - 2.0 * y)[2], Verdict::Fail);
    }

    #[test]
    fn a_number_a_hundredth_of_theirs_fails_unless_its_error_reaches_a_tenth() {
        let verdict = |value: f64, margin: f64| {
            of_the_order(String::new(), (Estimate::new(value, 0.0), margin), 1040.0).verdict
        };
        assert_eq!(verdict(150.0, 10.0), Verdict::Pass);
        assert_eq!(verdict(98.0, 80.0), Verdict::Undecided);
        assert_eq!(verdict(10.0, 5.0), Verdict::Fail);
    }

    #[test]
    fn an_early_peak_beyond_the_law_passes_and_a_soft_start_fails() {
        let verdict = |early: f64| {
            let cells = of_force(|y, v| {
                let factor = if y < 0.01 { early } else { 1.0 };
                factor * (0.27 * v * v + 4.5 * y)
            });
            early_peak("", &cells.iter().collect::<Vec<_>>()).expect("four speeds").verdict
        };
        assert_eq!([verdict(2.0), verdict(0.3)], [Verdict::Pass, Verdict::Fail]);
    }

    #[test]
    fn a_plateau_beyond_the_forms_deviates_as_listed_or_fails() {
        let speeds = [0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0];
        let verdict = |factor: f64| {
            let time = |v: f64| factor * (0.16083 * libm::exp(-1.42537 * v) + 0.1591);
            let cells = cells(90.0, &speeds, |v| record(time(v), vec![0.0; 2], vec![0.0; 2]));
            plateau("", &cells.iter().collect::<Vec<_>>(), &KNOWN[0]).verdict
        };
        assert_eq!(
            [1.0, 1.25, 1.6].map(verdict),
            [Verdict::Pass, Verdict::Deviates, Verdict::Fail]
        );
    }
}
