//! Impact speeds that a set leaves out, read from the frames before contact.

use configs::{Diagnostic, shorten};

use super::conditions::ConditionPlaces;
use super::curve::Curve;
use super::findings::Findings;
use super::reading::Reading;
use super::{Kind, MeasurementSet, contact, zeros};

/// Gives the conditions without a stated speed the mean over their runs; where no run shows it, that is
/// reported.
pub(super) fn fill(set: &mut MeasurementSet, places: &[ConditionPlaces], findings: &mut Findings) {
    for (index, place) in places.iter().enumerate() {
        if place.speed.is_some() {
            continue;
        }
        let id = shorten(&set.conditions[index].id);
        let read = match set.kind.curve() {
            Some(curve) => shown(set, index, curve),
            None => read(set, index),
        };
        let speed = zeros::mean(read.iter().copied());
        if read.is_empty() {
            let why = match set.kind.curve() {
                Some(curve) => curve.lacks_speed,
                None if set.kind == Kind::Scalar => "a set of scalars has to state it",
                None => "no run has the frames before contact that would show it",
            };
            findings.report(
                Diagnostic::error(format!("the condition `{id}` lacks `speed`"))
                    .at(place.id, why)
                    .help("write speed = 2.0, the speed at first contact in m/s"),
            );
            continue;
        }
        let (n, noun) = (read.len(), if read.len() == 1 { "run" } else { "runs" });
        findings.note(format!(
            "The speed of `{id}` is {:.4} ± {:.4} m/s, from the readings before contact of {n} {noun}.",
            speed.value, speed.se
        ));
        set.conditions[index].speed = speed.value;
    }
}

/// The speeds at contact (m/s) that the curves of the runs of one condition show.
fn shown(set: &MeasurementSet, condition: usize, curve: &Curve) -> Vec<Reading> {
    let own = set.runs.iter().filter(|run| run.condition == condition);
    own.filter_map(|run| (curve.shown_speed)(set, &set.conditions[condition], run)).collect()
}

/// The speeds at contact (m/s) of the runs of one condition whose frames show it.
fn read(set: &MeasurementSet, condition: usize) -> Vec<Reading> {
    let of = super::Condition { speed: 0.0, ..set.conditions[condition].clone() };
    let own = set.runs.iter().filter(|run| run.condition == condition);
    let speed = |run: &super::Run| {
        let known = (set.fall_of(&of), contact::FREE, zeros::position(set, run));
        let contact = contact::read(run, &of, known, 0.0)?;
        // Without frames before the contact the bed has braked already.
        let is_seen = contact.first < contact.time.value - contact.step;
        let (z, x) = (contact.sinking, contact.forward);
        let (x, value) = match of.angle_deg >= 90.0 {
            true => (Reading { value: 0.0, se: 0.0 }, z.value),
            false => (x, libm::hypot(z.value, x.value)),
        };
        let se = libm::hypot(z.value * z.se, x.value * x.se) / value;
        (is_seen && value > 0.0).then_some(Reading { value, se })
    };
    own.filter_map(speed).collect()
}
