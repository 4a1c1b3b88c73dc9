//! Which runs belong together: by a column, by a pattern of names, by what names say, or by their speeds.

use measurements::{Reading, median};

use super::bodies::Body;
use super::called;
use super::fault::Fault;
use super::names::Pattern;
use super::run::Run;
use super::track::deviation;

/// Share of a speed by which those of one condition may differ, at least.
const ALIKE: f64 = 0.05;

/// Times their errors that speeds of one condition may differ by.
const ERRORS: f64 = 4.0;

/// Degrees by which the angles of those of one condition may differ.
const ANGLE: f64 = 3.0;

/// Share of the median speed of a condition that is said by name, and times its error, beyond which a run is of another.
const OTHER: (f64, f64) = (0.25, 6.0);

/// What tells the condition of a run.
pub(super) struct Member<'a> {
    pub(super) name: &'a str,
    /// Its name with what else tells it apart: folders, files and columns.
    pub(super) called: &'a str,
    pub(super) labels: &'a [(String, String)],
    pub(super) body: &'a Body,
    /// At contact (m/s).
    pub(super) speed: Reading,
    /// (deg)
    pub(super) angle: f64,
}

/// Which runs belong together.
pub(super) struct Grouping {
    /// The condition of each run.
    pub(super) ids: Vec<String>,
    /// How they were put together, in words.
    pub(super) manner: String,
    /// Whether the condition of a run follows from its speed alone.
    pub(super) is_by_speed: Vec<bool>,
}

/// The conditions of runs.
///
/// # Errors
/// If runs of one condition have different bodies, or speeds that are far apart.
pub(super) fn group(members: &[Member<'_>], pattern: Option<&Pattern>) -> Result<Grouping, Fault> {
    let of = |ids: Vec<String>, manner: String, by_speed: bool| Grouping {
        is_by_speed: vec![by_speed; ids.len()],
        ids,
        manner,
    };
    let columns: Vec<String> = members.iter().filter_map(of_column).collect();
    let grouping = match pattern {
        Some(pattern) => of(
            members.iter().map(|one| pattern.condition(one.labels)).collect(),
            format!("by names, {}", pattern.text()),
            false,
        ),
        None if columns.len() == members.len() => {
            of(columns, "by the column `condition`".to_owned(), false)
        }
        None => by_names(members).unwrap_or_else(|| {
            let ids = by_speed(&members.iter().collect::<Vec<_>>());
            of(ids, "by speed at contact".to_owned(), true)
        }),
    };
    let ids = &grouping.ids;
    for (at, id) in ids.iter().enumerate() {
        let first = ids.iter().position(|other| other == id).unwrap_or(at);
        if members[first].body != members[at].body {
            let what = format!(
                "{} and {} are of one condition, `{id}`, and of different bodies",
                members[first].name, members[at].name
            );
            return Err(Fault::new(
                "--condition",
                what,
                "name the body in the pattern too: {body}_…",
            ));
        }
    }
    refuse_other_speeds(members, ids)?;
    Ok(grouping)
}

/// Refuses a condition in which a run meets the bed much faster or slower than most do.
fn refuse_other_speeds(members: &[Member<'_>], ids: &[String]) -> Result<(), Fault> {
    for (at, id) in ids.iter().enumerate() {
        let own = || members.iter().zip(ids).filter(|(_, other)| *other == id).map(|(one, _)| one);
        let speed = members[at].speed;
        let middle = median(own().map(|one| one.speed.value)).unwrap_or(speed.value);
        if (speed.value - middle).abs() <= (OTHER.0 * middle).max(OTHER.1 * speed.se) {
            continue;
        }
        let others = own().filter(|one| one.name != members[at].name);
        let others: Vec<String> =
            others.map(|one| format!("{} at {:.2}", one.name, one.speed.value)).collect();
        let what = format!(
            "the run {} meets the bed at {:.2} m/s, and others of its condition `{id}` do otherwise: {}",
            members[at].name,
            speed.value,
            others.join(", ")
        );
        let right = "is a file misnamed? name in the pattern what differs, or leave the run out";
        return Err(Fault::new("--condition", what, right));
    }
    Ok(())
}

fn of_column(member: &Member<'_>) -> Option<String> {
    member.labels.iter().find(|(name, _)| name == "condition").map(|(_, value)| value.clone())
}

/// Conditions by the names of runs without the number of the repeat. Runs of one name that differ in speed or body are separated
/// by these. `None` if all names give the same condition.
fn by_names(members: &[Member<'_>]) -> Option<Grouping> {
    let called: Vec<&str> = members.iter().map(|one| one.called).collect();
    let keys = called::keys(&called, |own| agree(members, own));
    let groups = called::groups(&keys);
    if groups.len() < 2 {
        return None;
    }
    let (mut ids, mut is_by_speed) = (keys.clone(), vec![false; members.len()]);
    let mut is_parted = false;
    for (key, own) in groups {
        let is_named = !key.is_empty() && agree(members, &own);
        let parts = by_speed(&own.iter().map(|at| &members[*at]).collect::<Vec<_>>());
        is_parted |= !is_named;
        for (at, part) in own.into_iter().zip(parts) {
            is_by_speed[at] = !is_named;
            ids[at] = match (is_named, key.as_str()) {
                (true, _) => key.clone(),
                (false, "") => part,
                (false, _) => format!("{key}_{part}"),
            };
        }
    }
    let within = if is_parted { "; runs of one name by speed at contact" } else { "" };
    let manner = format!("by the names of runs without the number of the repeat{within}");
    Some(Grouping { ids, manner, is_by_speed })
}

/// Whether the runs `own` have one body and one speed.
fn agree(members: &[Member<'_>], own: &[usize]) -> bool {
    let own = || own.iter().map(|at| &members[*at]);
    own().all(|one| {
        own().all(|other| {
            let errors = ERRORS * libm::hypot(one.speed.se, other.speed.se);
            let allowed = (2.0 * ALIKE * one.speed.value).max(errors);
            (one.speed.value - other.speed.value).abs() <= allowed
                && (one.angle - other.angle).abs() < 2.0 * ANGLE
                && one.body == other.body
        })
    })
}

/// Runs of one body whose speeds are alike.
fn by_speed(members: &[&Member<'_>]) -> Vec<String> {
    let mut order: Vec<usize> = (0..members.len()).collect();
    let speed = |at: usize| members[at].speed.value;
    order.sort_by(|a, b| speed(*a).total_cmp(&speed(*b)).then(a.cmp(b)));
    let apart = apart(&order.iter().map(|&at| speed(at)).collect::<Vec<_>>());
    // The members of a group, the slowest first.
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for at in order {
        let fits = |group: &&mut Vec<usize>| {
            let (first, own) = (members[group[0]], members[at]);
            let fastest = group[group.len() - 1];
            let allowed =
                (ALIKE * first.speed.value).max(ERRORS * libm::hypot(first.speed.se, own.speed.se));
            first.body == own.body
                && (first.angle - own.angle).abs() < ANGLE
                && own.speed.value - first.speed.value <= allowed
                && own.speed.value / speed(fastest) - 1.0 < apart
        };
        match groups.iter_mut().find(fits) {
            Some(group) => group.push(at),
            None => groups.push(vec![at]),
        }
    }
    let several = members.iter().any(|one| one.body != members[0].body);
    let name = |group: &Vec<usize>| {
        let mean = group.iter().map(|at| speed(*at)).sum::<f64>() / group.len() as f64;
        let body = &members[group[0]].body;
        let body = match several {
            true => format!("{}-{:.4}mm-{:.4}g-", body.shape, 1e3 * body.diameter, 1e3 * body.mass),
            false => String::new(),
        };
        let angle = members[group[0]].angle;
        let angle = if angle < 90.0 { format!("-{angle:.0}deg") } else { String::new() };
        format!("{body}v{mean:.2}{angle}")
    };
    let mut names: Vec<String> = Vec::new();
    for group in &groups {
        let name = name(group);
        let same = names.iter().filter(|other| other.starts_with(&name)).count();
        names.push(if same == 0 { name } else { format!("{name}-{}", same + 1) });
    }
    let of = |at: usize| groups.iter().position(|group| group.contains(&at)).unwrap_or_default();
    (0..members.len()).map(|at| names[of(at)].clone()).collect()
}

/// Share of a speed from which neighbours among `speeds`, the slowest first, are of two conditions: gaps of repeats are many, and
/// all others are several times as wide. Infinite where gaps say nothing.
fn apart(speeds: &[f64]) -> f64 {
    /// Times the widest gap within conditions that the narrowest between them is wide, and its least share of the speed.
    const WIDER: f64 = 4.0;
    const LEAST: f64 = 0.025;
    let mut gaps: Vec<f64> = speeds.windows(2).map(|pair| pair[1] / pair[0] - 1.0).collect();
    gaps.sort_by(f64::total_cmp);
    // At least half of the gaps are within conditions of two repeats or more.
    let jump = (gaps.len().div_ceil(2)..gaps.len())
        .find(|&at| gaps[at] >= LEAST && gaps[at] > WIDER * gaps[at - 1]);
    jump.map_or(f64::INFINITY, |at| gaps[at])
}

/// A warning if by their names no two runs are repeats, though some of one body are as fast.
pub(super) fn of_no_repeats(members: &[Member<'_>], grouping: &Grouping) -> Option<String> {
    /// Fewest runs that are a series.
    const SERIES: usize = 4;
    let is_alone = called::groups(&grouping.ids).len() == members.len();
    let mut alike = by_speed(&members.iter().collect::<Vec<_>>());
    alike.sort();
    alike.dedup();
    (members.len() >= SERIES && is_alone && alike.len() < members.len()).then(|| {
        format!(
            "Warning: by their names the {} runs have a condition each, and by their speeds {} conditions: if some are repeats, say \
             where the number of the repeat stands, as in --condition \"{{condition}}_v{{repeat}}\".",
            members.len(),
            alike.len()
        )
    })
}

/// A warning if runs that are grouped by speed alone end at depths that are far apart.
pub(super) fn of_other_depths(runs: &[Run], grouping: &Grouping) -> Option<String> {
    /// Relative standard deviation of the final depths, which repeats rarely exceed.
    const FAR: f64 = 0.12;
    /// Scatter below this many errors of a reading is not significant.
    const CLEAR: f64 = 5.0;
    called::groups(&grouping.ids).into_iter().find_map(|(id, own)| {
        let own: Vec<&Run> =
            own.into_iter().filter(|at| grouping.is_by_speed[*at]).map(|at| &runs[at]).collect();
        let depths: Vec<f64> = own.iter().filter_map(|run| run.frames.last()).map(|last| last.z).collect();
        let noise = own.iter().map(|run| run.noise).fold(0.0, f64::max);
        let mean = depths.iter().sum::<f64>() / depths.len() as f64;
        let scatter = deviation(&depths);
        (own.len() > 1 && scatter > (FAR * mean).max(CLEAR * noise)).then(|| {
            let names: Vec<&str> = own.iter().map(|run| run.name.as_str()).collect();
            format!(
                "Warning: the runs of `{id}` ({}) are put together by speed alone, whatever their names say, and their final depths \
                 scatter by {:.0} %. If they differ in more than speed, say it: --condition \"{{bed}}_{{repeat}}\", or a column `condition`.",
                configs::shorten(&names.join(", ")),
                1e2 * scatter / mean
            )
        })
    })
}
