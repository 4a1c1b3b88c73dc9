//! E9: the free link against its measured stopping times, and the two-link chain against what is stated of it.

use configs::{LoadOptions, Model, ModelSource, find_shipped};
use diagnosis::compare::{Revision, compare};
use diagnosis::forward::{Forward, Request, Scatter};
use diagnosis::observed::Observed;
use diagnosis::resistive::ResistiveForward;
use measurements::MeasurementSet;

use crate::published::check::{Band, Check, Estimate};
use crate::published::laboratory::Laboratory;
use crate::published::links::{ANGLES, LinkCourse, SPEEDS, chain};
use crate::published::plot::{Panel, Plot, Points};
use crate::published::row::{Findings, PublishedError, Row, Table};

pub(super) static ROW: Row = Row {
    id: "E9",
    title: "Free link: measured stopping times; two-link chain: deeper and sooner at rest with speed",
    source: "Marghitu & Lee 2013, Table 1; two-link manuscript, Tables 2, 5",
    how: ["nine impacts fitted, six of the chain, on a resistive medium", "the same"],
    judge,
};

/// One printed digit, 1 ms, over the shortest stopping time, 13 ms: the only error that can be read.
const BAND: Band = Band {
    half: 7.7,
    reason: "the last printed digit over the shortest time; no other error could be read",
};

/// Seed of what is drawn to test the fit; the deviations do not depend on it.
const SEED: u64 = 1;

fn judge(laboratory: &Laboratory<'_>) -> Result<Findings, PublishedError> {
    let mut findings = Findings::default();
    free_link(laboratory, &mut findings)?;
    for angles in ANGLES {
        findings.checks.extend(chain_over_speed(angles)?);
    }
    findings.checks.push(Check::not_published(
        "two-link chain: error of the model against the measured table",
        "Tables 2 and 5",
        "the tables are lost, with the sizes, speeds and angles",
    ));
    Ok(findings)
}

/// A stopping time of the free link.
struct Time {
    /// To the vertical (deg).
    inclination: f64,
    /// (m/s).
    speed: f64,
    /// (s).
    measured: f64,
    /// By the fitted law (s).
    by_law: f64,
}

impl Time {
    fn is_as_inclined(&self, other: &Self) -> bool {
        (self.inclination - other.inclination).abs() < 1e-9
    }
}

/// The nine stopping times: fitted, then compared one by one.
fn free_link(laboratory: &Laboratory<'_>, findings: &mut Findings) -> Result<(), PublishedError> {
    let missing = |why: String| PublishedError::Missing(why);
    let folder = laboratory.sets.join("free-link");
    let mut set = MeasurementSet::load(&folder).map_err(|error| missing(error.to_string()))?.set;
    // How wrong the law is counts as it is.
    set.instrument = set.instrument.without_shared_errors();
    let source = find_shipped("link").map(ModelSource::Shipped);
    let source = source.ok_or_else(|| missing("the model `link` ships no more".to_owned()))?;
    let model = Model::load(source, &LoadOptions::default())?.model;
    let observed = Observed::of(&set);
    let forward = ResistiveForward::new(&model, &set, &observed.layouts())
        .map_err(|error| missing(error.to_string()))?;
    let revision = Revision { name: "link", forward: &forward };
    let comparison = compare(&set, &observed, &[revision], SEED)?;
    let point = &comparison.models[0].fitted.fit.point;
    let mut table = Table::new(
        "Stopping times (ms) of the free link: measured, by the fitted law, and the difference (%). The middle \
         speed of each inclination was not fitted to.",
        &["inclination (deg)", "speed (m/s)", "measured", "by the law", "difference"],
    );
    let mut times: Vec<Time> = Vec::new();
    let mut off = Vec::new();
    for (at, condition) in set.conditions.iter().enumerate() {
        let request =
            Request { parameters: &point.parameters, effects: &[], scatter: &Scatter::default() };
        let predicted =
            forward.predict(at, &request).map_err(|error| missing(error.to_string()))?;
        let measured = observed.conditions[at].mean[0];
        let inclination = condition.link_angle_deg.unwrap_or(0.0);
        let difference = 100.0 * (predicted[0] / measured - 1.0);
        table.rows.push(vec![
            format!("{inclination}"),
            format!("{}", condition.speed),
            format!("{:.0}", 1e3 * measured),
            format!("{:.1}", 1e3 * predicted[0]),
            format!("{difference:+.1}"),
        ]);
        times.push(Time { inclination, speed: condition.speed, measured, by_law: predicted[0] });
        off.push(difference.abs());
    }
    findings.tables.push(table);
    findings.show(
        "e9-free-link.svg",
        "Stopping times of the free link as measured, under the fitted law.",
        draw(&times)?,
    );
    let mean = off.iter().sum::<f64>() / off.len() as f64;
    findings.checks.push(Check::at_most(
        "free link: mean deviation of nine stopping times (%)",
        "0",
        Estimate::new(mean, 0.0),
        BAND,
    ));
    let pairs = || times.windows(2).filter(|pair| pair[0].is_as_inclined(&pair[1]));
    findings.checks.push(Check::trend(
        "free link: stopping time over the speed",
        (
            "falls at 0°, 32° and 55°",
            format!(
                "falls in {} of {} steps",
                pairs().filter(|p| p[1].by_law < p[0].by_law).count(),
                pairs().count()
            ),
        ),
        "every step from speed to speed",
        pairs().all(|pair| pair[1].by_law < pair[0].by_law),
    ));
    // The three speeds of each inclination are similar, one by one.
    let of = |inclination: usize, speed: usize| times[3 * inclination + speed].by_law;
    let steps: Vec<bool> = (0..2)
        .flat_map(|q| (0..3).map(move |v| (q, v)))
        .map(|(q, v)| of(q + 1, v) < of(q, v))
        .collect();
    findings.checks.push(Check::trend(
        "free link: stopping time over the inclination",
        (
            "falls as the link is more inclined",
            format!("falls in {} of {} steps", steps.iter().filter(|s| **s).count(), steps.len()),
        ),
        "every step from inclination to inclination at similar speeds",
        steps.iter().all(|falls| *falls),
    ));
    Ok(())
}

/// Measured stopping times (points) and those by the law (lines), a colour per inclination.
fn draw(times: &[Time]) -> Result<String, PublishedError> {
    let (mut panel, mut names) = (Panel::default(), Vec::new());
    for (series, own) in times.chunk_by(Time::is_as_inclined).enumerate() {
        names.push(format!("{}° to the vertical", own[0].inclination));
        // Half of the last printed digit, 1 ms.
        let places = own.iter().map(|one| (one.speed, 1e3 * one.measured, 0.5)).collect();
        panel.points.push(Points { series, places });
        let curve = own.iter().map(|one| (one.speed, 1e3 * one.by_law)).collect();
        panel.curves.push((series, curve));
    }
    let axes = ["impact speed (m/s)", "stopping time (ms)"];
    Ok(Plot { axes, names, panels: vec![panel] }.draw()?)
}

/// Depth and stopping time of both links over the speed.
fn chain_over_speed(angles: [f64; 2]) -> Result<[Check; 2], PublishedError> {
    let courses = SPEEDS.map(|speed| chain(angles, speed));
    let mut links: Vec<[LinkCourse; 2]> = Vec::new();
    for course in courses {
        links.push(course?.links);
    }
    let said = |of: fn(&LinkCourse) -> f64| {
        let pair = |links: &[LinkCourse; 2]| {
            format!("{:.1}, {:.1}", 1e3 * of(&links[0]), 1e3 * of(&links[1]))
        };
        links.iter().map(pair).collect::<Vec<_>>().join("; ")
    };
    let rises = |of: fn(&LinkCourse) -> f64| {
        links.windows(2).all(|pair| (0..2).all(|link| of(&pair[0][link]) < of(&pair[1][link])))
    };
    let title = format!("two-link chain at {}° and {}°", angles[0], angles[1]);
    let decided = "both links, every step from speed to speed";
    Ok([
        Check::trend(
            format!("{title}: depth (mm) at 1.5, 2 and 2.5 m/s"),
            ("grows with speed for both links", said(|link| link.depth)),
            decided,
            rises(|link| link.depth),
        ),
        Check::trend(
            format!("{title}: stopping time (ms) at 1.5, 2 and 2.5 m/s"),
            ("falls with speed for both links", said(|link| link.time)),
            decided,
            rises(|link| -link.time),
        ),
    ])
}
