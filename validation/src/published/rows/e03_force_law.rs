//! E3: the force on the intruder at nine depths, separated into α v² + f y.

use crate::published::check::{Band, Check, Estimate, Known, SIGMAS, or_endless};
use crate::published::laboratory::Laboratory;
use crate::published::oblique::force::{Component, Separated, mean_readings, separate};
use crate::published::oblique::matrix::{self, Cell, READINGS};
use crate::published::oblique::own_depths;
use crate::published::oblique::tables::{ForceLaw, Published};
use crate::published::plot::{Panel, Plot, Points};
use crate::published::row::{Findings, PublishedError, Row};
use crate::published::rows::e02_depth_and_range::{DEPTHS, DEPTHS_AT};

pub(super) static ROW: Row = Row {
    id: "E3",
    title: "Force law α v² + f y from the forces at nine depths; no vertical one at 15°",
    source: "Wang, Ye & Zheng 2012, §3.5, eqs 8–9, Table 3, Figs 8–10",
    how: ["the impacts of E1", "the impacts of E1"],
    judge,
};

/// Share of the variance of the forces that a law has to explain to be one: more than half.
const EXPLAINED: f64 = 0.5;

/// Angle (deg) from which on the article claims a vertical law.
const FROM: f64 = 30.0;

/// Why coefficients of a law that goes as deep as the article's own impacts are not those of its Table 3.
const OWN_TABLES: &str = "the article's tables contradict each other: a law of this form that goes as deep as its Table 1 has 0.47 \
                          to 0.67 times the α and 1.8 to 2.2 times the f of its Table 3; depths that differ, which E2 \
                          judges, move both in inverse proportion";

/// Their scatter is not published; that of ours stands for it.
const REASON: &str = "two standard errors of the difference (Student's t): of ours by leaving out impacts, the published \
                      taken as large, since none is stated";

fn judge(laboratory: &Laboratory<'_>) -> Result<Findings, PublishedError> {
    let ran = matrix::run(laboratory, |angle| angle >= 15.0)?;
    let cells = &ran.cells;
    let mut findings = Findings::default();
    let mut panels = Vec::new();
    for angle in matrix::angles(cells) {
        for component in [Component::Horizontal, Component::Vertical] {
            if component == Component::Horizontal && angle >= 90.0 {
                continue;
            }
            let mut panel =
                Panel { title: format!("{angle} deg, {}", word(component)), ..Panel::default() };
            for (at, reading) in READINGS.iter().enumerate() {
                let own = matrix::of(cells, reading, angle);
                let Some(found) = separate(&own, component) else { continue };
                let title = format!("{angle}°, {}, {}", word(component), reading.name);
                findings.checks.push(separable(&title, (angle, component), &found));
                let published = own[0].published;
                let (law, known) = match component {
                    Component::Horizontal => (published.horizontal, None),
                    Component::Vertical => {
                        // What independent codes had of the depths is known at one angle.
                        let is_known = published.angle_deg.total_cmp(&DEPTHS_AT).is_eq();
                        let depths = if is_known { DEPTHS[at] } else { [1.0; 2] };
                        (published.vertical, known(published, depths))
                    }
                };
                if let Some(law) = law {
                    findings.checks.extend(coefficients(&title, law, &found, known));
                }
                panel.points.push(forces(at, &own, component, found.law()));
            }
            let forces = panel.points.iter().flat_map(|one| &one.places).map(|place| place.0);
            let most = forces.fold(0.0, f64::max);
            panel.curves.push((READINGS.len(), vec![(0.0, 0.0), (most, most)]));
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
    findings.notes.extend(ran.note());
    findings.notes.push(
        "Separable means: the additive law explains more than half of the variance of the forces between \
         depths and speeds, and both coefficients are positive, each by two standard errors of leaving out impacts."
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
    let sigmas = found.as_surely_as(SIGMAS);
    let surely = |above: bool| {
        let side = if above { -1.0 } else { 1.0 };
        let ends = [(found.explained, EXPLAINED), (found.drag, 0.0), (found.friction, 0.0)];
        ends.map(|(one, end)| one.value + side * or_endless(sigmas * one.error) > end)
    };
    let is_law = surely(true).into_iter().all(|surely| surely);
    let is_none = surely(false).into_iter().any(|possible| !possible);
    let claimed = component == Component::Horizontal || angle >= FROM;
    let ours = format!(
        "explains {} %; α = {} kg/m, f = {} N/m, correlation {:.2}",
        found.explained.times(100.0),
        found.drag,
        found.friction,
        found.correlation
    );
    Check::trend(
        format!("{title}: the force is separable"),
        (if claimed { "yes" } else { "no" }, ours),
        "more than half explained, α and f positive, each by two standard errors (Student's t); no law where one of them \
         is not by as much",
        if claimed { is_law } else { is_none },
    )
    .undecided_if(!is_law && !is_none)
}

/// How far α and f may be off by what the article's Table 1 says of them, for depths of between `depths` times
/// its own: a law `s` times as deep has both 1/s times as large.
fn known(published: &Published, depths: [f64; 2]) -> Option<[Known; 2]> {
    let (own, printed) = (own_depths::law(published)?, published.vertical?);
    let range = |ratio: f64| [ratio.min(1.0) / depths[1], ratio.max(1.0) / depths[0]];
    let ratios = [own.drag / printed.drag, own.friction / printed.friction];
    Some(ratios.map(|ratio| Known { ratio: range(ratio), cause: OWN_TABLES }))
}

/// Both coefficients beside those of Table 3.
fn coefficients(
    title: &str,
    law: ForceLaw,
    found: &Separated,
    known: Option<[Known; 2]>,
) -> [Check; 2] {
    let compare = |name: &str, published: f64, ours: Estimate, known: Option<&Known>| {
        let margin = found.as_surely_as(SIGMAS) * ours.error;
        let band = Band { half: (2.0_f64).sqrt() * margin, reason: REASON };
        Check::number(format!("{title}: {name}"), Estimate::new(published, 0.0), ours, band)
            .unless_known(known, (ours.value / published, margin / published))
    };
    let [drag, friction] = known.map_or([None, None], |known| known.map(Some));
    [
        compare("α (kg/m)", law.drag, found.drag, drag.as_ref()),
        compare("f (N/m)", law.friction, found.friction, friction.as_ref()),
    ]
}

/// The mean forces over the law.
fn forces(series: usize, cells: &[&Cell], component: Component, law: ForceLaw) -> Points {
    let readings = cells.iter().flat_map(|cell| mean_readings(cell, component));
    let place = |one: crate::published::oblique::force::Reading| {
        (law.drag * one.square + law.friction * one.depth, one.force, 0.0)
    };
    Points { series, places: readings.map(place).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::published::Verdict;
    use crate::published::oblique::tables::published;

    /// A law of twenty impacts that explains so much, with an error, and has an f of its own.
    fn found(explained: [f64; 2], friction: f64) -> Separated {
        let law = ForceLaw { drag: 0.27, friction };
        Separated {
            drag: Estimate::new(law.drag, 0.02),
            friction: Estimate::new(friction, 0.3),
            correlation: 0.0,
            explained: Estimate::new(explained[0], explained[1]),
            left_out: vec![law; 20],
        }
    }

    #[test]
    fn a_law_is_one_where_it_explains_the_forces_and_is_claimed_from_30_degrees_on() {
        let verdict =
            |angle, found: &Separated| separable("", (angle, Component::Vertical), found).verdict;
        let [law, none] = [found([0.8, 0.05], 4.5), found([0.2, 0.05], 4.5)];
        assert_eq!([verdict(90.0, &law), verdict(90.0, &none)], [Verdict::Pass, Verdict::Fail]);
        assert_eq!([verdict(15.0, &law), verdict(15.0, &none)], [Verdict::Fail, Verdict::Pass]);
        assert_eq!(verdict(15.0, &found([0.8, 0.05], -1.0)), Verdict::Pass);
        let vague = found([0.55, 0.1], 4.5);
        assert_eq!([15.0, 90.0].map(|angle| verdict(angle, &vague)), [Verdict::Undecided; 2]);
    }

    #[test]
    fn coefficients_between_both_laws_of_the_article_deviate_and_others_fail() {
        let published = published(90.0).expect("an angle of the tables");
        let law = published.vertical.expect("a law at 90 deg");
        let verdict = |friction: f64| {
            let known = known(published, [1.0, 1.0]);
            coefficients("", law, &found([0.8, 0.05], friction), known)[1].verdict
        };
        assert_eq!(verdict(law.friction), Verdict::Pass);
        assert_eq!(verdict(1.5 * law.friction), Verdict::Deviates);
        assert_eq!(verdict(0.5 * law.friction), Verdict::Fail);
    }
}
