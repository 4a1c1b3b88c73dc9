//! What readings of any kind over time have to be: of one body, and in order.

use configs::{Diagnostic, shorten};
use engine::units::Dimension;

use crate::contradiction::{Contradiction, ContradictionKind};
use crate::document::conditions::ConditionPlaces;
use crate::median;
use crate::table::columns::{ColumnSpec, Content, column};
use crate::table::findings::Findings;
use crate::{MeasurementSet, Run};

/// The columns of a table of what the column `value` holds, with its error in `sigma`; `run` is required or not.
pub(crate) const fn columns(
    value: &'static str,
    sigma: &'static str,
    dimension: Dimension,
    run: bool,
) -> [ColumnSpec; 4] {
    [
        column("run", Content::Name, run),
        column("t", Content::Quantity(Dimension::TIME), true),
        column(value, Content::Quantity(dimension), true),
        column(sigma, Content::Quantity(dimension), false),
    ]
}

/// Refuses impacts that are not straight down, and bodies of two parts; `what` was read, and `why` tells the reason.
pub(crate) fn check_vertical(
    set: &MeasurementSet,
    places: &[ConditionPlaces],
    (what, why): (&str, &str),
    findings: &mut Findings,
) {
    for (condition, place) in set.conditions.iter().zip(places) {
        let id = shorten(&condition.id);
        if condition.angle_deg < 90.0 || condition.shape_entry().is_some_and(|entry| entry.slender)
        {
            let message = format!("the {what} of `{id}` are not of a vertical impact of one body");
            findings.report(Diagnostic::error(message).at(place.angle, "expected 90").help(why));
        }
    }
}

/// Refuses times that do not rise.
pub(crate) fn check_times(
    set: &MeasurementSet,
    places: &[ConditionPlaces],
    findings: &mut Findings,
) {
    for run in &set.runs {
        if !findings.full() && run.samples.windows(2).any(|pair| pair[0].at >= pair[1].at) {
            let name = shorten(&run.name);
            findings.report(
                Diagnostic::error(format!("the time does not go on in the run `{name}`"))
                    .at(places[run.condition].id, "measured under this condition")
                    .help("the times of a run rise from row to row"),
            );
        }
    }
}

/// Names a unit with which the `ratio` of what a run reads to what it can read is above `most`; the middle run decides.
/// `told` says the ratio in words, and `help` which unit may be wrong.
pub(crate) fn check_unit(
    set: &MeasurementSet,
    places: &[ConditionPlaces],
    (most, ratio): (f64, impl Fn(&Run) -> f64),
    (told, help): (impl Fn(f64) -> String, &str),
) -> Option<Contradiction> {
    let (middle, run) = median::of_runs(set, |run| Some(ratio(run)))?;
    let condition = set.runs[run].condition;
    (middle > most).then(|| Contradiction {
        kind: ContradictionKind::Speeds,
        diagnostic: Diagnostic::error(told(middle))
            .at(places[condition].speed, "the stated speed")
            .help(format!("{help} [columns] gives the units of a table")),
    })
}

/// Names a clock that does not begin at first contact. `contact` says when a run shows it, and whether that is far from
/// t = 0; `told` says of a run and a time what is seen then.
pub(crate) fn check_clock(
    set: &MeasurementSet,
    places: &[ConditionPlaces],
    contact: impl Fn(&Run) -> Option<(f64, bool)>,
    told: impl Fn(&str, f64) -> String,
) -> Option<Contradiction> {
    let seen: Vec<_> = set.runs.iter().filter_map(|run| Some((contact(run)?, run))).collect();
    let off: Vec<_> = seen.iter().filter(|((_, is_off), _)| *is_off).collect();
    let ((at, _), run) = off.first().filter(|_| 2 * off.len() > seen.len())?;
    Some(Contradiction {
        kind: ContradictionKind::Zeros,
        diagnostic: Diagnostic::error(format!(
            "t = 0 is not first contact in {} of {} runs: {}",
            off.len(),
            set.runs.len(),
            told(&shorten(&run.name), *at)
        ))
        .at(places[run.condition].id, "measured under this condition")
        .help("write the time of first contact into a column `t_zero` of the table of runs"),
    })
}
