//! E14: which force leads in the impact of the chain, and what its links give to the bed.

use crate::published::check::Check;
use crate::published::laboratory::Laboratory;
use crate::published::links::{ANGLES, ChainCourse, SPEEDS, chain};
use crate::published::row::{Findings, PublishedError, Row};

pub(super) static ROW: Row = Row {
    id: "E14",
    title: "Chain: static force at the stop, later overtaking with speed, energies and their halves",
    source: "two-link manuscript, §4, Figs 4–8",
    how: ["six impacts of the chain on a resistive medium", "the same"],
    judge,
};

/// Dynamic force at the stop that still leaves the static one alone: a tenth of it.
const NEGLIGIBLE: f64 = 1.0 / 11.0;

/// "Approximately ten times", at most.
const RATIO: f64 = 10.0;

/// Halves of equal links: what the integration leaves.
const HALF: f64 = 1e-8;

fn judge(_: &Laboratory<'_>) -> Result<Findings, PublishedError> {
    let mut findings = Findings::default();
    for angles in ANGLES {
        let mut courses = Vec::new();
        for speed in SPEEDS {
            courses.push(chain(angles, speed)?);
        }
        let title = format!("{}° and {}°", angles[0], angles[1]);
        findings.checks.extend(forces(&title, &courses));
        findings.checks.extend(energies(&title, &courses));
        if (angles[0] + angles[1]).abs() < 1e-9 {
            findings.checks.push(halves(&title, &courses));
        }
    }
    findings.notes.push(
        "Sizes, mass, speeds, angles and η_d, η_h of the article are lost: those of docs/validation.md are \
         assumed, and trends alone are judged. Of the 81 sets of coefficients that may be assumed, 29 overtake later in \
         milliseconds, all as a share of the stopping time: an own study, which excuses nothing."
            .to_owned(),
    );
    Ok(findings)
}

fn forces(title: &str, courses: &[ChainCourse]) -> [Check; 3] {
    let links = || courses.iter().flat_map(|course| &course.links);
    let dynamic = links().map(|link| link.dynamic_at_stop).fold(0.0, f64::max);
    let later = |of: fn(&crate::published::links::LinkCourse) -> f64| {
        courses
            .windows(2)
            .all(|pair| (0..2).all(|link| of(&pair[0].links[link]) < of(&pair[1].links[link])))
    };
    let said = |factor: f64, of: fn(&crate::published::links::LinkCourse) -> f64| {
        let pair = |course: &ChainCourse| {
            format!("{:.1}, {:.1}", factor * of(&course.links[0]), factor * of(&course.links[1]))
        };
        courses.iter().map(pair).collect::<Vec<_>>().join("; ")
    };
    let decided = "both links, every step from speed to speed";
    [
        Check::trend(
            format!("{title}: force at the stop"),
            ("the static part", format!("dynamic share at most {dynamic:.3}")),
            "the dynamic force is below a tenth of the static one",
            dynamic < NEGLIGIBLE,
        ),
        Check::trend(
            format!("{title}: static force overtakes (ms after contact)"),
            ("later at higher speed", said(1e3, |link| link.overtaken)),
            decided,
            later(|link| link.overtaken),
        ),
        Check::trend(
            format!("{title}: static force overtakes (% of the stopping time)"),
            ("later at higher speed", said(100.0, |link| link.overtaken / link.time)),
            decided,
            later(|link| link.overtaken / link.time),
        ),
    ]
}

fn energies(title: &str, courses: &[ChainCourse]) -> [Check; 2] {
    let given = |course: &ChainCourse| course.links[0].given + course.links[1].given;
    let said: Vec<String> = courses.iter().map(|course| format!("{:.3}", given(course))).collect();
    let ratio = courses.iter().map(|course| course.ratio).fold(0.0, f64::max);
    [
        Check::trend(
            format!("{title}: energy given to the bed (J)"),
            ("rises with speed", said.join("; ")),
            "every step from speed to speed",
            courses.windows(2).all(|pair| given(&pair[0]) < given(&pair[1])),
        ),
        Check::trend(
            format!("{title}: kinetic over potential energy"),
            ("about ten at most", format!("{ratio:.1} at most")),
            "not more than ten",
            ratio <= RATIO,
        ),
    ]
}

fn halves(title: &str, courses: &[ChainCourse]) -> Check {
    let share = |course: &ChainCourse| {
        course.links[0].given / (course.links[0].given + course.links[1].given)
    };
    let off = courses.iter().map(|course| (share(course) - 0.5).abs()).fold(0.0, f64::max);
    Check::trend(
        format!("{title}: share of each link in the energy given"),
        ("about half", format!("half, to {off:.0e}")),
        "half to 1e-8: equal angles are mirror images",
        off < HALF,
    )
}
