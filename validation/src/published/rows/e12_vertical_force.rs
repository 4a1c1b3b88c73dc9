//! E12: the force of vertical impacts over v² and depth, its coefficients and the plateau beside other scales.

use crate::published::check::{Check, Estimate};
use crate::published::laboratory::Laboratory;
use crate::published::oblique::curves::{Form, series};
use crate::published::oblique::force::{Component, mean_readings, separate};
use crate::published::oblique::matrix::{self, Cell, DIAMETER, GRAVITY, MASS, READINGS};
use crate::published::plot::{Panel, Plot, Points};
use crate::published::regression;
use crate::published::row::{Findings, PublishedError, Row, Table};

pub(super) static ROW: Row = Row {
    id: "E12",
    title: "90°: force against v² at three depths and against depth; scales of speed and time",
    source: "Wang, Ye & Zheng 2012, §3.4–3.5, Figs 6, 12, 13; Katsuragi & Durian 2007",
    how: ["the vertical impacts of E1", "the vertical impacts of E1"],
    judge,
};

/// Depths (m) of Fig. 12.
const DEPTHS: [f64; 3] = [0.055, 0.075, 0.085];

/// 1/d₁ (1/m) and k/m (1/s²) of a steel sphere of an inch in glass beads: Katsuragi & Durian 2007, with
/// d₁ = 0.087 m.
const OTHERS: [f64; 2] = [1.0 / 0.087, 1040.0];

/// The same order of magnitude: within a factor of ten either way.
const ORDER: f64 = 10.0;

/// Mass of a disc of the bed over its area (kg/m²): 0.049 g, 4.56 mm.
const GRAIN_DENSITY: f64 = 4.9e-5 / (std::f64::consts::FRAC_PI_4 * 0.00456 * 0.00456);

fn judge(laboratory: &Laboratory<'_>) -> Result<Findings, PublishedError> {
    let cells = matrix::cells(laboratory, |angle| angle >= 90.0)?;
    let mut findings = Findings::default();
    let mut panels: Vec<Panel> = DEPTHS
        .iter()
        .map(|depth| Panel { title: format!("{:.0} mm deep", 1e3 * depth), ..Panel::default() })
        .collect();
    let mut others = Table::new(
        "Force over mass: α/m (1/m) and f/m (1/s²), beside a steel sphere of an inch in glass beads.",
        &["reading", "α/m", "f/m", "α/m there", "f/m there"],
    );
    for (at, reading) in READINGS.iter().enumerate() {
        let own = matrix::of(&cells, reading, 90.0);
        for (depth, panel) in DEPTHS.iter().zip(&mut panels) {
            let (check, places) = over_square(reading.name, *depth, &own);
            findings.checks.push(check);
            panel.points.push(Points { series: at, places });
        }
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
                let ratio = ours.value / there;
                findings.checks.push(Check::trend(
                    format!(
                        "90°, {}: {name} is of the order of Katsuragi & Durian's",
                        reading.name
                    ),
                    ("the same order of magnitude", format!("{ours}: {ratio:.2} times theirs")),
                    "within a factor of ten",
                    (1.0 / ORDER..=ORDER).contains(&ratio),
                ));
            }
        }
        findings.checks.extend(plateau(reading.name, &own));
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
    Ok(findings)
}

/// Whether the force at `depth` (m) rises with v², and its places in the figure.
fn over_square(reading: &str, depth: f64, cells: &[&Cell]) -> (Check, Vec<(f64, f64, f64)>) {
    let readings = cells.iter().flat_map(|cell| mean_readings(cell, Component::Vertical));
    let here: Vec<_> = readings.filter(|one| (one.depth - depth).abs() < 1e-9).collect();
    let squares: Vec<f64> = here.iter().map(|one| one.square).collect();
    let forces: Vec<f64> = here.iter().map(|one| one.force / MASS).collect();
    let columns = [squares.clone(), vec![1.0; squares.len()]];
    let fitted = regression::linear(&columns, &forces, None);
    let [slope, level] = [0, 1].map(|at| {
        let of =
            |fitted: &regression::Fitted| Estimate::new(fitted.coefficients[at], fitted.error(at));
        fitted.as_ref().map_or(Estimate::new(f64::NAN, 0.0), of)
    });
    let check = Check::trend(
        format!("90°, {reading}, {:.0} mm deep: force over v² is a rising line", 1e3 * depth),
        (
            "a line with a positive slope and a positive force at rest",
            format!("slope {slope} 1/m, at rest {level} m/s²"),
        ),
        "both positive by two standard errors",
        slope.value > 2.0 * slope.error && level.value > 2.0 * level.error,
    );
    (check, squares.into_iter().zip(forces).map(|(v, f)| (v, f, 0.0)).collect())
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
fn plateau(reading: &str, cells: &[&Cell]) -> Option<Check> {
    let points = series(cells, |record| record.stopping_time);
    let fitted = Form::Exponential.fit(&points.speeds, &points.means, points.errors.as_deref())?;
    let ours = Estimate::new(fitted.coefficients[2], fitted.error(2));
    let [(_, shortest, _), _, (_, longest, _)] = forms();
    let margin = 2.0 * ours.error;
    Some(Check::trend(
        format!("90°, {reading}: plateau of the stopping time (s) among the forms of others"),
        ("0.16 s: above (2R/g)^½, below (2ρ_b R/(ρ_g g))^½", ours.to_string()),
        &format!("between {shortest:.3} and {longest:.3} s, by two standard errors of ours"),
        (shortest - margin..=longest + margin).contains(&ours.value),
    ))
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

    #[test]
    fn the_published_plateau_lies_between_the_forms_of_others() {
        let [(_, shortest, speed), _, (_, longest, _)] = forms();
        assert!(shortest < 0.16 && 0.16 < longest, "{shortest} {longest}");
        // "Slightly larger than (2gR)^½": the article's characteristic speed is about 1 m/s.
        assert!(speed.is_some_and(|speed| speed < 1.0), "{speed:?}");
    }
}
