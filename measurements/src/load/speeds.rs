//! Impact speeds that a set leaves out, read from the frames before contact.

use configs::{Diagnostic, shorten};

use crate::contact;
use crate::contact::braking::Tip;
use crate::contact::departure::Departure;
use crate::contact::strays::but_strays;
use crate::contact::zeros;
use crate::contact::zeros::RunContact;
use crate::curves::curve::Curve;
use crate::document::conditions::ConditionPlaces;
use crate::reading::Reading;
use crate::table::findings::Findings;
use crate::{Condition, Contact, Kind, MeasurementSet, Run};

/// Gives the conditions without a stated speed the mean over their runs; where no run shows it, that is
/// reported.
pub(crate) fn fill(set: &mut MeasurementSet, places: &[ConditionPlaces], findings: &mut Findings) {
    let is_unstated = places.iter().any(|place| place.speed.is_none());
    let slowed = if is_unstated { zeros::slowed(set) } else { Vec::new() };
    let mut of_one_run: f64 = 0.0;
    for (index, place) in places.iter().enumerate() {
        if place.speed.is_some() {
            continue;
        }
        let id = shorten(&set.conditions[index].id);
        let read = match set.kind.curve() {
            Some(curve) => shown(set, index, curve),
            None => read(set, index, &slowed),
        };
        let speed = Reading::mean(read.iter().copied());
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
        of_one_run = of_one_run.max((n as f64).sqrt() * speed.se / speed.value);
    }
    if of_one_run > 0.0 && set.instrument.speed_sigma_rel.is_none() {
        findings.note(format!(
            "speed_sigma_rel is {of_one_run:.5}, the largest of these errors of one run."
        ));
        set.instrument.speed_sigma_rel = Some(of_one_run);
    }
}

/// The speeds at contact (m/s) that the curves of the runs of one condition show.
fn shown(set: &MeasurementSet, condition: usize, curve: &Curve) -> Vec<Reading> {
    let own = set.runs.iter().filter(|run| run.condition == condition);
    own.filter_map(|run| (curve.shown_speed)(set, &set.conditions[condition], run)).collect()
}

/// The speeds at contact (m/s) of the runs of one condition whose frames show it.
fn read(set: &MeasurementSet, condition: usize, slowed: &[RunContact]) -> Vec<Reading> {
    let own = (0..set.runs.len()).filter(|&run| set.runs[run].condition == condition);
    let speed = |run: usize| {
        let slowed = slowed.iter().find(|one| one.run == run).map(|one| &one.contact);
        of_run(set, &set.runs[run], slowed)
    };
    own.filter_map(speed).collect()
}

/// The speed at contact (m/s) of `run`, if its frames show it; the contact is where the path departs from free fall and
/// the set has its surface, by the errors of both. Of a body that is `slowed` before, it is where the set has it.
fn of_run(set: &MeasurementSet, run: &Run, slowed: Option<&Contact>) -> Option<Reading> {
    let condition = &set.conditions[run.condition];
    let of = Condition { speed: 0.0, ..condition.clone() };
    let (gravity, sigma) = (set.fall_of(&of), zeros::position(set, run));
    let tip = Tip::of(&of);
    let frames = but_strays(&run.frames, sigma);
    let departure = match (contact::power(&of), slowed) {
        (Some(_), None) => Departure::of_frames(&frames, tip, gravity, sigma),
        _ => None,
    };
    let (contact, sinking) = match (slowed, departure) {
        (Some(contact), _) => (*contact, contact.sinking),
        (None, Some(Departure { contact, .. })) => {
            let level = Reading { value: 0.0, se: zeros::level(set) };
            (contact, contact.crossing(contact.depth.beside(level), gravity).1)
        }
        (None, None) => {
            let contact = contact::read(run, &of, (gravity, contact::FREE, sigma), 0.0)?;
            (contact, contact.sinking)
        }
    };
    // Without frames before the contact the bed has braked already.
    let is_seen = contact.first < contact.time.value - contact.step;
    let forward = match of.angle_deg >= 90.0 {
        true => Reading { value: 0.0, se: 0.0 },
        false => contact.forward,
    };
    let value = libm::hypot(sinking.value, forward.value);
    let se = libm::hypot(sinking.value * sinking.se, forward.value * forward.se) / value;
    (is_seen && value > 0.0).then_some(Reading { value, se })
}
