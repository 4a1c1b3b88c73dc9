//! What no single value can tell: values that contradict each other, and what follows from them.

mod grains;
mod own_effects;
mod resistive;

use engine::units::{Dimension, format_si, significant};

use crate::diagnostics::{Diagnostic, Span};
use crate::limits;
use crate::model::{GrainModel, Medium, Model, ResistiveModel};
use crate::read::Places;
use crate::reader::Reader;

/// Reports every contradiction in a model that reads well.
pub(crate) fn check(model: &Model, places: &Places, reader: &Reader<'_>) {
    let common = Common { model, places, reader };
    match &model.medium {
        Medium::Grains(medium) => {
            grains::GrainChecks { grains: GrainModel { model, medium }, common }.all();
        }
        Medium::Resistive(medium) => {
            resistive::ResistiveChecks { resistive: ResistiveModel { model, medium }, common }
                .all();
        }
    }
}

/// What models of any medium are checked for.
#[derive(Clone, Copy)]
struct Common<'a> {
    model: &'a Model,
    places: &'a Places,
    reader: &'a Reader<'a>,
}

/// A length to six digits.
fn metres(value: f64) -> String {
    format_si(significant(value, 6), Dimension::LENGTH)
}

/// A time to three digits, which is enough to act on.
fn seconds(value: f64) -> String {
    let (factor, unit) = match value {
        v if v < 1e-9 => return format!("{:e} s", significant(value, 3)),
        v if v < 1e-6 => (1e9, "ns"),
        v if v < 1e-3 => (1e6, "us"),
        v if v < 1.0 => (1e3, "ms"),
        _ => (1.0, "s"),
    };
    format!("{} {unit}", significant(value * factor, 3))
}

impl Common<'_> {
    fn intruder_diameter(&self) -> Option<f64> {
        let mut params = self.model.intruder.params.iter();
        params.find(|(key, _)| *key == "diameter").map(|(_, value)| value)
    }

    /// Refuses what overflows or underflows, naming the inputs it is made of.
    fn derived(&self, what: &str, value: f64, inputs: [(&str, Option<Span>); 2]) {
        if value.is_normal() {
            return;
        }
        let size = if value.abs() < 1.0 { "too small" } else { "too large" };
        let [(first, first_span), (second, second_span)] = inputs;
        self.reader.report(
            Diagnostic::error(format!("{what} is {size} to be represented: {value:e}"))
                .at(first_span, format!("from this {first}"))
                .with(second_span, format!("and this {second}")),
        );
    }

    fn impact_energy(&self) {
        let lists = self.model.conditions.as_ref();
        let listed = lists.and_then(|lists| lists.speed.as_ref());
        let single = [self.model.impact.speed];
        let speeds = listed.map_or(&single[..], Vec::as_slice);
        let spans = match listed {
            Some(_) => self.places.condition_speed.clone(),
            None => vec![self.places.speed],
        };
        for (speed, span) in speeds.iter().zip(spans).filter(|(speed, _)| **speed > 0.0) {
            let energy = 0.5 * self.model.intruder.mass * speed * speed;
            let inputs = [("speed", span), ("mass", self.places.intruder.mass)];
            self.derived("the energy of the impact", energy, inputs);
        }
    }

    fn number_of_conditions(&self) {
        let Some(lists) = &self.model.conditions else {
            return;
        };
        let length = |list: &Option<Vec<f64>>| list.as_ref().map_or(1, Vec::len);
        let starts = match lists.positions {
            Some(n) => usize::try_from(n).unwrap_or(usize::MAX),
            None => length(&lists.x),
        };
        let repeats = |list: &Option<Vec<f64>>| {
            let values = list.as_deref().unwrap_or_default();
            (1..values.len())
                .any(|k| values[..k].iter().any(|v| v.to_bits() == values[k].to_bits()))
        };
        let named = [("speed", &lists.speed), ("angle", &lists.angle_rad), ("x", &lists.x)];
        for (name, _) in named.into_iter().filter(|(_, list)| repeats(list)) {
            self.reader.report(
                Diagnostic::error(format!("`{name}` in [conditions] lists a value twice"))
                    .at(self.places.conditions, "in this table")
                    .help("the same impact again gives the same bytes: no scatter to average over"),
            );
        }
        let total =
            length(&lists.speed).saturating_mul(length(&lists.angle_rad)).saturating_mul(starts);
        if total > limits::CONDITIONS {
            self.reader.report(
                Diagnostic::error(format!("[conditions] asks for {total} impacts"))
                    .at(self.places.conditions, "the product of its lists")
                    .help(format!("at most {} are accepted in one model", limits::CONDITIONS)),
            );
        }
    }
}
