//! Which runs belong together: by a column, by a pattern of names, or by their speeds.

use measurements::Reading;

use super::bodies::Body;
use super::fault::Fault;
use super::names::Pattern;

/// Share of a speed by which those of one condition may differ, at least.
const ALIKE: f64 = 0.05;

/// Times their errors that speeds of one condition may differ by.
const ERRORS: f64 = 4.0;

/// Share of the median speed of a condition that is said by name, and times its error, beyond which a run is of another.
const OTHER: (f64, f64) = (0.25, 6.0);

/// What tells the condition of a run.
pub(super) struct Member<'a> {
    pub(super) name: &'a str,
    pub(super) labels: &'a [(String, String)],
    pub(super) body: &'a Body,
    /// At contact (m/s).
    pub(super) speed: Reading,
    /// (deg)
    pub(super) angle: f64,
}

/// How runs were put together, in words.
pub(super) fn manner(members: &[Member<'_>], pattern: Option<&Pattern>) -> String {
    match (pattern, members.iter().all(|one| of_column(one).is_some())) {
        (Some(pattern), _) => format!("by names, {}", pattern.text()),
        (None, true) => "by the column `condition`".to_owned(),
        (None, false) => "by speed at contact".to_owned(),
    }
}

/// The condition of each run.
///
/// # Errors
/// If runs of one condition have different bodies, or speeds that are far apart.
pub(super) fn group(
    members: &[Member<'_>],
    pattern: Option<&Pattern>,
) -> Result<Vec<String>, Fault> {
    let ids = match pattern {
        Some(pattern) => members.iter().map(|one| pattern.condition(one.labels)).collect(),
        None if members.iter().all(|one| of_column(one).is_some()) => {
            members.iter().filter_map(of_column).collect()
        }
        None => by_speed(members),
    };
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
    refuse_other_speeds(members, &ids)?;
    Ok(ids)
}

/// Refuses a condition in which a run meets the bed much faster or slower than most do.
fn refuse_other_speeds(members: &[Member<'_>], ids: &[String]) -> Result<(), Fault> {
    for (at, id) in ids.iter().enumerate() {
        let own = || members.iter().zip(ids).filter(|(_, other)| *other == id).map(|(one, _)| one);
        let mut speeds: Vec<f64> = own().map(|one| one.speed.value).collect();
        speeds.sort_by(f64::total_cmp);
        let (middle, speed) = (speeds[speeds.len() / 2], members[at].speed);
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

/// Runs of one body whose speeds are alike.
fn by_speed(members: &[Member<'_>]) -> Vec<String> {
    let mut order: Vec<usize> = (0..members.len()).collect();
    let speed = |at: usize| members[at].speed.value;
    order.sort_by(|a, b| speed(*a).total_cmp(&speed(*b)).then(a.cmp(b)));
    // The members of a group, the slowest first.
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for at in order {
        let fits = |group: &&mut Vec<usize>| {
            let (first, own) = (&members[group[0]], &members[at]);
            let allowed =
                (ALIKE * first.speed.value).max(ERRORS * libm::hypot(first.speed.se, own.speed.se));
            first.body == own.body
                && (first.angle - own.angle).abs() < 3.0
                && own.speed.value - first.speed.value <= allowed
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
