//! What no single value can tell: values that contradict each other, and what follows from them.

use std::f64::consts::FRAC_PI_4;

use engine::units::{Dimension, format_si};

use crate::diagnostics::{Diagnostic, Span};
use crate::limits;
use crate::model::{BedSource, Model, StartX};
use crate::read::{BodyPlaces, Places};
use crate::reader::Reader;
use crate::stability;

/// Reports every contradiction in a model that reads well.
pub(crate) fn check(model: &Model, places: &Places, reader: &Reader<'_>) {
    let checks = Checks { model, places, reader };
    checks.sizes();
    checks.derived_quantities();
    checks.number_of_conditions();
    if !reader.failed() {
        checks.start_positions();
        checks.steps();
        checks.targets();
    }
}

struct Checks<'a> {
    model: &'a Model,
    places: &'a Places,
    reader: &'a Reader<'a>,
}

/// A length to six digits.
fn metres(value: f64) -> String {
    format_si(rounded(value, 5), Dimension::LENGTH)
}

/// A time to three digits, which is enough to act on.
fn seconds(value: f64) -> String {
    let (factor, unit) = match value {
        v if v < 1e-3 => (1e6, "us"),
        v if v < 1.0 => (1e3, "ms"),
        _ => (1.0, "s"),
    };
    format!("{} {unit}", rounded(value * factor, 2))
}

/// `value` with so many digits after the first.
fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.digits$e}").parse().unwrap_or(value)
}

impl Checks<'_> {
    fn intruder_diameter(&self) -> Option<f64> {
        let mut params = self.model.intruder.params.iter();
        params.find(|(key, _)| *key == "diameter").map(|(_, value)| value)
    }

    fn sizes(&self) {
        let width = self.model.container.width;
        let too_wide = |what: &str, diameter: f64, places: BodyPlaces| {
            if diameter >= width {
                self.reader.report(
                    Diagnostic::error(format!("the {what} does not fit into the box"))
                        .at(places.diameter, format!("{} wide", metres(diameter)))
                        .with(self.places.width, format!("the box is {} wide", metres(width))),
                );
            }
        };
        if let Some(diameter) = self.intruder_diameter() {
            too_wide("intruder", diameter, self.places.intruder);
        }
        if let BedSource::Settle(settle) = &self.model.bed.source {
            for (kind, places) in settle.grains.iter().zip(&self.places.grains) {
                too_wide("grain", kind.diameter, *places);
            }
        }
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

    fn derived_quantities(&self) {
        let model = self.model;
        let stiffness = model.contact_law.params.iter().find(|(key, _)| *key == "normal_stiffness");
        let mut bodies: Vec<(&str, f64, f64, BodyPlaces)> = Vec::new();
        if let BedSource::Settle(settle) = &model.bed.source {
            for (kind, places) in settle.grains.iter().zip(&self.places.grains) {
                bodies.push(("grain", kind.diameter, kind.mass, *places));
                let total = kind.count as f64 * kind.mass;
                if kind.count > 0 {
                    let inputs = [("mass", places.mass), ("count of grains", places.count)];
                    self.derived("the mass of all grains", total, inputs);
                }
            }
        }
        if let Some(diameter) = self.intruder_diameter() {
            bodies.push(("intruder", diameter, model.intruder.mass, self.places.intruder));
        }
        for (name, diameter, mass, places) in bodies {
            let inputs = [("diameter", places.diameter), ("mass", places.mass)];
            let inertia = 0.125 * mass * diameter * diameter;
            self.derived(&format!("the moment of inertia of the {name}"), inertia, inputs);
            self.derived(&format!("the mass of the {name}"), mass, inputs);
            if model.medium.gravity > 0.0 {
                let inputs = [("mass", places.mass), ("gravity", self.places.gravity)];
                let weight = mass * model.medium.gravity;
                self.derived(&format!("the weight of the {name}"), weight, inputs);
            }
            if let Some((_, stiffness)) = stiffness {
                let place = ("stiffness", self.places.normal_stiffness);
                let inputs = [place, ("mass", places.mass)];
                let rate = stiffness / mass;
                self.derived(&format!("the collision rate of the {name}"), rate, inputs);
                let inputs = [place, ("diameter", places.diameter)];
                let energy = stiffness * diameter * diameter;
                self.derived(&format!("the elastic energy of the {name}"), energy, inputs);
            }
        }
        self.impact_energy();
        if let Some(step) = stability::time_step(model) {
            let factor = ("factor", self.places.time_step_factor);
            self.derived("the time step", step, [("time step", self.places.time_step), factor]);
            let steps = model.run.duration / step;
            if steps.is_nan() || steps > limits::STEPS {
                self.reader.report(
                    Diagnostic::error(format!("the run would take {steps:.1e} steps"))
                        .at(self.places.duration, "this long")
                        .with(self.places.time_step, "in steps of this")
                        .help(format!("at most {:.0e} are accepted", limits::STEPS)),
                );
            }
            if step > model.run.duration {
                self.reader.report(
                    Diagnostic::error("the time step is longer than the run")
                        .at(self.places.time_step, seconds(step))
                        .with(self.places.duration, seconds(model.run.duration)),
                );
            }
        }
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

    fn start_positions(&self) {
        let width = self.model.container.width;
        let radius = self.intruder_diameter().map_or(0.0, |diameter| 0.5 * diameter);
        let inside = |x: f64| x >= radius && x <= width - radius;
        let outside = |x: f64, span: Option<Span>| {
            if !inside(x) {
                self.reader.report(
                    Diagnostic::error("the intruder would start outside of the box")
                        .at(span, format!("its centre at {}", metres(x)))
                        .with(self.places.width, format!("the box is {} wide", metres(width)))
                        .help(format!(
                            "with its radius, the centre may be from {} to {}",
                            metres(radius),
                            metres(width - radius)
                        )),
                );
            }
        };
        if let Some(x) = self.model.impact.x {
            outside(x, self.places.x);
        }
        let lists = self.model.conditions.as_ref();
        if let Some(x) = lists.and_then(|lists| lists.x.as_ref()) {
            for (x, span) in x.iter().zip(&self.places.condition_x) {
                outside(*x, *span);
            }
        }
        let draws = self.model.conditions().iter().any(|one| one.x == StartX::Drawn);
        if self.places.x_range.is_some() || draws {
            let (from, to) = self.model.impact.x_range;
            let span = self.places.x_range.or(self.places.positions);
            outside(from, span);
            if inside(from) {
                outside(to, span);
            }
        }
    }

    fn steps(&self) {
        let run = stability::time_step(self.model);
        let collision = stability::shortest_collision_time(self.model);
        self.step_against(run, collision, self.places.time_step, true);
        let grains = stability::grain_collision_time(self.model);
        if self.places.preparation_time_step.is_some() {
            let step = stability::preparation_time_step(self.model);
            self.step_against(step, grains, self.places.preparation_time_step, false);
            self.step_against_damping(step, self.places.preparation_time_step);
        }
        self.step_against_damping(run, self.places.time_step);
    }

    fn step_against_damping(&self, step: Option<f64>, span: Option<Span>) {
        let (Some(step), Some(relaxation)) = (step, stability::damping_time(self.model)) else {
            return;
        };
        let steps = relaxation / step;
        let message = format!("the damping of a contact acts within {steps:.1} steps");
        let diagnostic = if steps < stability::FEWEST_STEPS_PER_DAMPING_TIME {
            Diagnostic::error(message)
        } else if steps < stability::FEW_STEPS_PER_DAMPING_TIME {
            Diagnostic::warning(message)
        } else {
            return;
        };
        let advice = seconds(relaxation / stability::STEPS_PER_DAMPING_TIME);
        self.reader.report(
            diagnostic
                .at(span.or(self.places.time_step_factor), format!("a step of {}", seconds(step)))
                .help(format!(
                    "damping overshoots and the bed never comes to rest; write \"{advice}\" or \
                     less, or \"auto\""
                )),
        );
    }

    fn step_against(
        &self,
        step: Option<f64>,
        collision: Option<f64>,
        span: Option<Span>,
        is_run: bool,
    ) {
        let (Some(step), Some(collision)) = (step, collision) else {
            return;
        };
        let per_collision = collision / step;
        let message = format!("the shortest collision takes only {per_collision:.1} steps");
        let diagnostic = if per_collision < stability::FEWEST_STEPS_PER_COLLISION {
            Diagnostic::error(message)
        } else if per_collision < stability::FEW_STEPS_PER_COLLISION {
            Diagnostic::warning(message)
        } else {
            return;
        };
        let advice = seconds(collision / stability::STEPS_PER_COLLISION);
        let diagnostic = diagnostic
            .at(span.or(self.places.time_step_factor), format!("a step of {}", seconds(step)))
            .with(
                self.places.normal_stiffness,
                format!("with the lightest pair, a collision of {}", seconds(collision)),
            );
        let factor = self.places.time_step_factor.filter(|_| is_run && span.is_some());
        self.reader.report(
            diagnostic
                .with(factor, "multiplies the step")
                .help(format!("write \"{advice}\" or less, \"auto\", or a smaller stiffness")),
        );
    }

    fn targets(&self) {
        let BedSource::Settle(settle) = &self.model.bed.source else {
            return;
        };
        let bed = &self.model.bed;
        let (Some(fraction), Some(height)) = (bed.target_packing_fraction, bed.target_height)
        else {
            return;
        };
        let area: f64 = settle
            .grains
            .iter()
            .map(|kind| kind.count as f64 * FRAC_PI_4 * kind.diameter * kind.diameter)
            .sum();
        let implied = area / (self.model.container.width * height);
        if (implied / fraction - 1.0).abs() > 0.03 {
            self.reader.report(
                Diagnostic::warning("the two targets of the bed contradict each other")
                    .at(self.places.target_packing_fraction, "the packing fraction")
                    .with(
                        self.places.target_height,
                        format!("this height means a packing fraction of {implied:.3}"),
                    ),
            );
        }
    }
}
