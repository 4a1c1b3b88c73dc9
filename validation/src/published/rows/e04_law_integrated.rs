//! E4: the law of E3, integrated, beside the impacts that it was separated from.

use configs::{LoadOptions, Medium, Model, ModelSource};
use resistive::Trajectory;
use runner::beds::Record;

use crate::published::check::{Band, Check, Estimate, SIGMAS, or_endless};
use crate::published::laboratory::Laboratory;
use crate::published::oblique::force::{Component, Separated, separate};
use crate::published::oblique::matrix::{self, Cell, DIAMETER, GRAVITY, MASS, READINGS};
use crate::published::oblique::tables::{ForceLaw, Published};
use crate::published::plot::{Panel, Plot, Points};
use crate::published::regression;
use crate::published::row::{Findings, PublishedError, Row};

pub(super) static ROW: Row = Row {
    id: "E4",
    title: "The separated force law, integrated, gives the trajectories",
    source: "Wang, Ye & Zheng 2012, §3.5, Fig. 11",
    how: ["the impacts of E1 at 45° and 90°", "the impacts of E1 from 30° on"],
    judge,
};

/// Angle (deg) from which on the article claims the law.
const FROM: f64 = 30.0;

/// Speeds (m/s) whose paths are drawn.
const DRAWN: [f64; 2] = [1.0, 4.0];

/// The law of both components; none along x at 90°.
struct Law {
    horizontal: ForceLaw,
    vertical: ForceLaw,
}

fn judge(laboratory: &Laboratory<'_>) -> Result<Findings, PublishedError> {
    let ran = matrix::run(laboratory, |angle| angle >= FROM)?;
    let cells = &ran.cells;
    let mut findings = Findings::default();
    let mut panels = Vec::new();
    for angle in matrix::angles(cells) {
        for (at, reading) in READINGS.iter().enumerate() {
            let own = matrix::of(cells, reading, angle);
            let Some(vertical) = separate(&own, Component::Vertical) else { continue };
            let horizontal = match angle < 90.0 {
                true => separate(&own, Component::Horizontal).map(|found| found.law()),
                false => Some(ForceLaw { drag: 0.0, friction: 0.0 }),
            };
            let Some(horizontal) = horizontal else { continue };
            let law = Law { horizontal, vertical: vertical.law() };
            let title = format!("{angle}°, {}", reading.name);
            findings.checks.push(compare(&title, (&law, &vertical), &own)?);
            if at == 0 {
                panels.push(draw(angle, &law, &own)?);
            }
        }
    }
    let names = vec!["impact".to_owned(), "its law, integrated".to_owned()];
    let plot = Plot { axes: ["time (s)", "depth (m)"], names, panels };
    findings.show(
        "e4-law-integrated.svg",
        "Depth over time of impacts at 1 and 4 m/s, as printed, and by the law separated from all speeds of \
         their angle.",
        plot.draw()?,
    );
    findings.notes.extend(ran.note());
    Ok(findings)
}

/// Mean deviation of the depths by the law, which was `found` in the impacts, from theirs, averaged over positions.
fn compare(
    title: &str,
    (law, found): (&Law, &Separated),
    cells: &[&Cell],
) -> Result<Check, PublishedError> {
    let ratios = depths_over(law, cells)?;
    let n = ratios.len() as f64;
    let mean = ratios.iter().sum::<f64>() / n;
    let average = 100.0 * ratios.iter().map(|ratio| (ratio - 1.0).abs()).sum::<f64>() / n;
    // What leaving out one impact after another makes of the mean ratio: the law is the same at every speed, and so is
    // its error.
    let mut moved = Vec::new();
    for vertical in &found.left_out {
        let law = Law { horizontal: law.horizontal, vertical: *vertical };
        moved.push(depths_over(&law, cells)?.iter().sum::<f64>() / n);
    }
    let m = moved.len() as f64;
    let center = moved.iter().sum::<f64>() / m;
    let squares: f64 = moved.iter().map(|one| (one - center) * (one - center)).sum();
    let error = ((m - 1.0) / m * squares).sqrt();
    let sigmas = found.as_surely_as(SIGMAS);
    let by_scatter = 100.0 * regression::deviation_by_scatter(&[error], sigmas);
    let band = Band { half: 6.0, reason: "the article's scatter of depths between positions" };
    let what = format!(
        "{title}: depth by the law, mean deviation from the impacts (%), {mean:.3} of theirs"
    );
    let ours = Estimate::new(average, 100.0 * error);
    let check = Check::deviation(what, "\"well consistent\"", ours, by_scatter, band);
    let at_source = 100.0 * at_source(cells)?;
    let cause = format!(
        "the depths by the article's own law differ by {at_source:.1} % in the mean from its own Table 1 at this angle and these \
         speeds"
    );
    Ok(check.listed(average - or_endless(by_scatter) <= at_source, &cause))
}

/// Depths by the law over the mean ones of the impacts, a number per cell.
fn depths_over(law: &Law, cells: &[&Cell]) -> Result<Vec<f64>, PublishedError> {
    let over = |cell: &&Cell| {
        let deepest = cell.records.iter().map(|record| record.deepest);
        let mean = deepest.sum::<f64>() / cell.records.len() as f64;
        Ok(integrate(law, cell, &[])?.1 / mean)
    };
    cells.iter().map(over).collect()
}

/// Mean absolute deviation, as a share, of the depths by the article's law (Table 3) from those of its impacts (Table 1), at
/// the speeds of `cells`: none where it has no law.
fn at_source(cells: &[&Cell]) -> Result<f64, PublishedError> {
    let still = ForceLaw { drag: 0.0, friction: 0.0 };
    let mut deviations = Vec::new();
    for cell in cells {
        let Published { horizontal, vertical, depth, .. } = *cell.published;
        let Some(vertical) = vertical else { continue };
        let law = Law { horizontal: horizontal.unwrap_or(still), vertical };
        let ratio = integrate(&law, cell, &[])?.1 / depth.at(cell.speed);
        deviations.push((ratio - 1.0).abs());
    }
    let n = deviations.len().max(1) as f64;
    Ok(deviations.iter().sum::<f64>() / n)
}

/// Depths (m) at `times` (s) and the largest one of the impact of `cell` under `law`.
fn integrate(law: &Law, cell: &Cell, times: &[f64]) -> Result<(Vec<f64>, f64), PublishedError> {
    let text = model_text(law, cell);
    let source = ModelSource::Text { name: "law of E3".to_owned(), text, folder: ".".into() };
    let model = Model::load(source, &LoadOptions::default())?.model;
    let Medium::Resistive(medium) = &model.medium else {
        return Err(PublishedError::Missing("two-term-components is no force law".to_owned()));
    };
    let impact = medium.impact(&model.intruder, &model.launch(&model.conditions()[0]));
    let mut path = Trajectory::at(times);
    let ending = impact.run(model.run.duration, &mut path)?;
    // The lowest point starts at the surface, at z = 0.
    let depths = path.states().iter().map(|state| -state.position[1]).collect();
    Ok((depths, ending.parts[0].depth))
}

/// The impact of `cell` under `law`; a coefficient that comes out negative pushes nothing.
fn model_text(law: &Law, cell: &Cell) -> String {
    let Law { horizontal, vertical } = law;
    format!(
        "[run]\nname = \"law-of-e3\"\nduration = \"2 s\"\n\
         [medium]\nkind = \"resistive-force\"\ndimension = 2\nbulk_density = \"2.4 kg/m^2\"\n\
         gravity = \"{GRAVITY} m/s^2\"\n\
         [resistance]\nname = \"two-term-components\"\ndrag_x = \"{:?} kg/m\"\n\
         friction_x = \"{:?} N/m\"\ndrag_z = \"{:?} kg/m\"\nfriction_z = \"{:?} N/m\"\n\
         [intruder]\nshape = \"disc\"\ndiameter = \"{DIAMETER} m\"\nmass = \"{MASS} kg\"\n\
         [impact]\nspeed = \"{:?} m/s\"\nangle = \"{:?} deg\"\n",
        horizontal.drag.max(0.0),
        horizontal.friction.max(0.0),
        vertical.drag.max(0.0),
        vertical.friction.max(0.0),
        cell.speed,
        cell.published.angle_deg,
    )
}

fn draw(angle: f64, law: &Law, cells: &[&Cell]) -> Result<Panel, PublishedError> {
    let mut panel = Panel { title: format!("{angle} deg, as printed"), ..Panel::default() };
    let drawn = |cell: &&&Cell| DRAWN.iter().any(|speed| (cell.speed - speed).abs() < 1e-9);
    for cell in cells.iter().filter(drawn) {
        let Some(record) = cell.records.first() else { continue };
        let times = times(record);
        let depths = record.path(&times).into_iter().map(|(depth, _)| depth);
        let places = times.iter().zip(depths).map(|(t, y)| (*t, y, 0.0)).collect();
        panel.points.push(Points { series: 0, places });
        let by_law = integrate(law, cell, &times)?.0;
        panel.curves.push((1, times.iter().copied().zip(by_law).collect()));
    }
    Ok(panel)
}

/// Forty times (s) from the start to the stop.
fn times(record: &Record) -> Vec<f64> {
    let stop = record.stopping_time.unwrap_or(record.end);
    (0..=40).map(|k| stop * f64::from(k) / 40.0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::published::Verdict;
    use crate::published::oblique::records::{cells, straight_down};
    use crate::published::oblique::tables::published;

    #[test]
    fn the_law_of_table_3_is_deeper_than_table_1_where_it_was_found_to_be_elsewhere() {
        // Depths by law and table of the same independent integration, at 45° and 0.5 and 4 m/s: 0.13302 over
        // 0.08161 and 0.19093 over 0.16243 m, each to half a digit and its first order.
        let published = published(45.0).expect("an angle of the tables");
        let cell = |speed| Cell { reading: &READINGS[0], published, speed, records: Vec::new() };
        let [slow, fast] = [cell(0.5), cell(4.0)];
        let off = |cells: &[&Cell]| at_source(cells).expect("impacts");
        let [high, low, both] = [off(&[&slow]), off(&[&fast]), off(&[&slow, &fast])];
        assert!((low - 0.1755).abs() < 1e-3 && (high - 0.6300).abs() < 1e-3, "{low} {high}");
        assert!((both - 0.5 * (low + high)).abs() < 1e-12, "the mean of both");
    }

    #[test]
    fn the_published_law_at_90_degrees_goes_as_deep_as_when_it_is_integrated_elsewhere() {
        let published = published(90.0).expect("an angle of the tables");
        let vertical = published.vertical.expect("a law at 90 deg");
        let law = Law { horizontal: ForceLaw { drag: 0.0, friction: 0.0 }, vertical };
        // By an explicit integration of first order in steps of 10 µs, to five digits: it is off by up to the
        // way of a step, 40 µm for the fastest, and half a digit.
        for (speed, depth) in [(1.0, 0.12041), (2.0, 0.14009), (3.0, 0.15830), (4.0, 0.17411)] {
            let cell = Cell { reading: &READINGS[0], published, speed, records: Vec::new() };
            let found = integrate(&law, &cell, &[]).expect("an impact").1;
            assert!((found - depth).abs() < 4.5e-5, "{speed} m/s: {found}");
        }
    }

    #[test]
    fn the_law_of_the_impacts_passes_and_a_law_of_others_fails() {
        let cells = cells(90.0, &[1.0, 2.0, 3.0, 4.0], |speed| {
            straight_down(speed, |y, v| 0.27 * v * v + 4.5 * y)
        });
        let own: Vec<&Cell> = cells.iter().collect();
        let found = separate(&own, Component::Vertical).expect("four speeds decide");
        let verdict = |factor: f64| {
            let still = ForceLaw { drag: 0.0, friction: 0.0 };
            let ForceLaw { drag, friction } = found.law();
            let vertical = ForceLaw { drag: factor * drag, friction: factor * friction };
            let law = Law { horizontal: still, vertical };
            compare("", (&law, &found), &own).expect("four impacts").verdict
        };
        assert_eq!(verdict(1.0), Verdict::Pass);
        // The article's own law differs from its Table 1 by 10 % in the mean of these speeds. A law half as strong goes about
        // twice as deep, one of 0.8 times the strength a fifth deeper.
        assert_eq!([0.5, 0.8].map(verdict), [Verdict::Fail; 2]);
        assert_eq!(verdict(0.92), Verdict::Deviates);
    }
}
