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
        (None, false) if by_repeat(members).is_some() => {
            "by the names of runs without the number of the repeat".to_owned()
        }
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
        None => by_repeat(members).unwrap_or_else(|| by_speed(members)),
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

/// Conditions by the names of runs, such as `h10` of `h10_r2`; `None` unless the names of conditions differ in one number only
/// and every condition has repeats.
fn by_repeat(members: &[Member<'_>]) -> Option<Vec<String>> {
    let stems: Vec<String> = members.iter().map(|one| stem(one.name)).collect::<Option<_>>()?;
    let parts: Vec<Vec<String>> = stems.iter().map(|stem| numbers_and_words(stem)).collect();
    let first = parts.first()?;
    let differs = |place: usize| parts.iter().any(|own| own.get(place) != first.get(place));
    let differing: Vec<usize> = (0..first.len()).filter(|place| differs(*place)).collect();
    let [only] = differing[..] else { return None };
    let is_number = |own: &Vec<String>| {
        own.len() == first.len() && own[only].starts_with(|c: char| c.is_ascii_digit())
    };
    let is_repeated = |stem: &String| stems.iter().filter(|other| *other == stem).count() > 1;
    // Where the speeds of a condition disagree, the number means something else.
    let agree = |(one, stem): (&Member<'_>, &String)| {
        let others = members.iter().zip(&stems).filter(|(_, other)| *other == stem);
        others.map(|(other, _)| other).all(|other| {
            let errors = ERRORS * libm::hypot(one.speed.se, other.speed.se);
            let allowed = (2.0 * ALIKE * one.speed.value).max(errors);
            (one.speed.value - other.speed.value).abs() <= allowed && one.body == other.body
        })
    };
    let is_told = parts.iter().all(is_number)
        && stems.iter().all(is_repeated)
        && members.iter().zip(&stems).all(agree);
    is_told.then_some(stems)
}

/// The part of a run's name before its repeat number, such as `h10` of `h10_r2`; `None` for a name without a repeat number.
fn stem(name: &str) -> Option<String> {
    const MARKS: [&str; 9] = ["repeat", "trial", "run", "rep", "take", "drop", "r", "t", "n"];
    const BETWEEN: [char; 5] = ['_', '-', ' ', '#', '.'];
    let without = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let bare = without.trim_end_matches(BETWEEN);
    let lower = bare.to_lowercase();
    let mark = MARKS.iter().find(|mark| {
        lower.strip_suffix(**mark).is_some_and(|rest| rest.is_empty() || rest.ends_with(BETWEEN))
    });
    let rest = &bare[..bare.len() - mark.map_or(0, |mark| mark.len())];
    let rest = rest.trim_end_matches(BETWEEN);
    let is_marked = mark.is_some() || bare.len() < without.len();
    (without.len() < name.len() && is_marked && !rest.is_empty()).then(|| rest.to_owned())
}

/// The runs of digits and of other characters in `text`.
fn numbers_and_words(text: &str) -> Vec<String> {
    let mut parts: Vec<String> = Vec::new();
    let mut was_digit = None;
    for one in text.chars() {
        let is_digit = one.is_ascii_digit();
        match parts.last_mut().filter(|_| was_digit == Some(is_digit)) {
            Some(part) => part.push(one),
            None => parts.push(one.to_string()),
        }
        was_digit = Some(is_digit);
    }
    parts
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_at_the_end_of_a_name_is_that_of_the_repeat() {
        for (name, found) in [
            ("h10_r2", Some("h10")),
            ("ball_h10 run 3", Some("ball_h10")),
            ("h10_3", Some("h10")),
            ("h10-trial-12", Some("h10")),
            ("h10", None),
            ("r2", None),
            ("left", None),
        ] {
            assert_eq!(stem(name).as_deref(), found, "{name}");
        }
        assert_eq!(numbers_and_words("a12b3"), ["a", "12", "b", "3"]);
    }
}
