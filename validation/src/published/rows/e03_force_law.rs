//! E3: the force on the intruder at nine depths, separated into α v² + f y.

use crate::published::check::{Band, Check, Estimate, Known};
use crate::published::laboratory::Laboratory;
use crate::published::oblique::force::{Component, Separated, mean_readings, separate};
use crate::published::oblique::matrix::{self, Cell, READINGS};
use crate::published::oblique::tables::ForceLaw;
use crate::published::plot::{Panel, Plot, Points};
use crate::published::row::{Findings, PublishedError, Row};

pub(super) static ROW: Row = Row {
    id: "E3",
    title: "Force law α v² + f y from the forces at nine depths; no vertical one at 15°",
    source: "Wang, Ye & Zheng 2012, §3.5, eqs 8–9, Table 3, Figs 8–10",
    how: ["the impacts of E1", "the impacts of E1"],
    judge,
};

/// Share of the variance of the forces that a law has to explain to be one: more than half.
const EXPLAINED: f64 = 0.5;

/// Standard errors by which both coefficients have to be positive.
const SIGMAS: f64 = 2.0;

/// Angle (deg) from which on the article claims a vertical law.
const FROM: f64 = 30.0;

/// The article's own tables disagree: at 90° its law goes 0.92 to 1.24 times as deep as its Table 1 between 1
/// and 4 m/s, at 45° 1.18 to 1.49 times.
const KNOWN: Known = Known {
    ratio: [0.5, 1.5],
    cause: "the article's law contradicts its own depths by up to a half (1.18 to 1.49 at 45°, 0.92 to 1.24 at \
            90°), and α and f trade off",
};

/// Their scatter is not published; that of ours stands for it.
const REASON: &str = "two standard errors of the difference: of ours by leaving out impacts, the published taken as large";

fn judge(laboratory: &Laboratory<'_>) -> Result<Findings, PublishedError> {
    let cells = matrix::cells(laboratory, |angle| angle >= 15.0)?;
    let mut findings = Findings::default();
    let mut panels = Vec::new();
    for angle in matrix::angles(&cells) {
        for component in [Component::Horizontal, Component::Vertical] {
            if component == Component::Horizontal && angle >= 90.0 {
                continue;
            }
            let mut panel =
                Panel { title: format!("{angle} deg, {}", word(component)), ..Panel::default() };
            for (at, reading) in READINGS.iter().enumerate() {
                let own = matrix::of(&cells, reading, angle);
                let Some(found) = separate(&own, component) else { continue };
                let title = format!("{angle}°, {}, {}", word(component), reading.name);
                findings.checks.push(separable(&title, (angle, component), &found));
                let published = own[0].published;
                let law = match component {
                    Component::Horizontal => published.horizontal,
                    Component::Vertical => published.vertical,
                };
                if let Some(law) = law {
                    findings.checks.extend(coefficients(&title, law, &found));
                }
                panel.points.push(forces(at, &own, component, found.law()));
            }
            panel.curves.push((READINGS.len(), vec![(0.0, 0.0), (1.0, 1.0)]));
            panels.push(panel);
        }
    }
    let mut names: Vec<String> = READINGS.iter().map(|one| one.name.to_owned()).collect();
    names.push("the law".to_owned());
    let plot = Plot { axes: ["α v² + f y (N)", "force of the bed (N)"], names, panels };
    findings.show(
        "e3-force-law.svg",
        "Forces at nine depths and all speeds, averaged over positions, over the law that is fitted to them.",
        plot.draw()?,
    );
    findings.notes.push(
        "Separable means: the additive law explains more than half of the variance of the forces between \
         depths and speeds, and both coefficients are positive by two standard errors."
            .to_owned(),
    );
    Ok(findings)
}

fn word(component: Component) -> &'static str {
    match component {
        Component::Horizontal => "horizontal",
        Component::Vertical => "vertical",
    }
}

/// Whether there is a law, where the article claims one, or none where it claims none.
fn separable(title: &str, (angle, component): (f64, Component), found: &Separated) -> Check {
    let positive = |one: Estimate| one.value > SIGMAS * one.error;
    let is_law = found.r_squared > EXPLAINED && positive(found.drag) && positive(found.friction);
    let claimed = component == Component::Horizontal || angle >= FROM;
    let ours = format!(
        "explains {:.0} %; α = {} kg/m, f = {} N/m, correlation {:.2}",
        100.0 * found.r_squared,
        found.drag,
        found.friction,
        found.correlation
    );
    Check::trend(
        format!("{title}: the force is separable"),
        (if claimed { "yes" } else { "no" }, ours),
        "more than half explained, α and f positive by two standard errors",
        is_law == claimed,
    )
}

/// Both coefficients beside those of Table 3.
fn coefficients(title: &str, law: ForceLaw, found: &Separated) -> [Check; 2] {
    let one = |name: &str, published: f64, ours: Estimate| {
        let half = SIGMAS * (2.0_f64).sqrt() * ours.error;
        let published = Estimate::new(published, 0.0);
        let band = Band { half, reason: REASON };
        Check::number(format!("{title}: {name}"), published, ours, band)
            .unless_known(Some(&KNOWN), ours.value / published.value)
    };
    [one("α (kg/m)", law.drag, found.drag), one("f (N/m)", law.friction, found.friction)]
}

/// The mean forces over the law.
fn forces(series: usize, cells: &[&Cell], component: Component, law: ForceLaw) -> Points {
    let readings = cells.iter().flat_map(|cell| mean_readings(cell, component));
    let place = |one: crate::published::oblique::force::Reading| {
        (law.drag * one.square + law.friction * one.depth, one.force, 0.0)
    };
    Points { series, places: readings.map(place).collect() }
}
