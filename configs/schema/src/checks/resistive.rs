//! What only a model of a resistive force is checked for.

use engine::grains::Space;
use engine::params::ParamSpec;
use engine::units::{Dimension, format_si, significant};
use resistive::{Expression, Needs};

use super::{Common, own_effects, seconds};
use crate::diagnostics::{Diagnostic, Span};
use crate::limits;
use crate::model::{AngleTable, Coefficient, ResistiveModel, degrees};
use crate::reader::interval;

pub(super) struct ResistiveChecks<'a> {
    pub(super) resistive: ResistiveModel<'a>,
    pub(super) common: Common<'a>,
}

impl ResistiveChecks<'_> {
    pub(super) fn all(&self) {
        self.derived_quantities();
        self.common.number_of_conditions();
        self.samples();
        self.fluid();
        self.effects();
        if !self.common.reader.failed() {
            self.coefficients();
            own_effects::check(&self.resistive, &self.common);
        }
    }

    fn derived_quantities(&self) {
        let Common { model, places, .. } = self.common;
        let mass = model.intruder.mass;
        if let Some(diameter) = self.common.intruder_diameter() {
            let inputs = [("diameter", places.intruder.diameter), ("mass", places.intruder.mass)];
            let inertia = 0.125 * mass * diameter * diameter;
            self.common.derived("the moment of inertia of the intruder", inertia, inputs);
        }
        let gravity = self.resistive.medium.gravity;
        if gravity > 0.0 {
            let inputs = [("mass", places.intruder.mass), ("gravity", places.gravity)];
            self.common.derived("the weight of the intruder", mass * gravity, inputs);
        }
        self.common.impact_energy();
    }

    fn samples(&self) {
        let Common { model, places, reader } = self.common;
        let interval = self.resistive.medium.log_interval;
        let samples = model.run.duration / interval;
        if samples > limits::STEPS {
            reader.report(
                Diagnostic::error(format!("the log would have {samples:.1e} samples"))
                    .at(places.duration, "this long")
                    .with(places.interval, format!("one every {}", seconds(interval)))
                    .help(format!("at most {:.0e} are accepted", limits::STEPS)),
            );
        }
    }

    /// Refuses a fluid in a plane, and one whose force on the intruder is not modelled.
    fn fluid(&self) {
        let Common { model, places, reader } = self.common;
        if self.resistive.medium.fluid.is_none() {
            return;
        }
        let (message, label, help) = if self.resistive.medium.space == Space::Planar {
            let help = "leave the fluid out, or take a bed of space: dimension = 3";
            ("a planar bed has no fluid", "the density of a fluid is that of a volume", help)
        } else if model.intruder.shape.slender {
            let help = "leave it out, or take an intruder of one piece: sphere, cylinder, hemisphere, cone";
            ("no link is modelled in a fluid", "its drag is that of a compact body", help)
        } else if model.impact.pushed_to.is_some() {
            let help = "leave it out: forces are counted from what the drive reads above the bed";
            ("a push is not modelled in a fluid", "at the speeds of drives it does little", help)
        } else {
            return;
        };
        reader.report(Diagnostic::error(message).at(places.fluid, label).help(help));
    }

    /// Effects that cannot act, for want of what the medium does not say.
    fn effects(&self) {
        let medium = self.resistive.medium;
        for effect in &medium.effects {
            let visible = effect.effect.visible();
            let lacks = |needs: Needs, given: bool| visible.contains(&needs) && !given;
            let missing = [
                ("packing", lacks(Needs::Packings, medium.packing.is_some())),
                ("bed_depth", lacks(Needs::BedDepth, medium.bed_depth.is_some())),
            ];
            for (key, _) in missing.into_iter().filter(|(_, lacks)| *lacks) {
                self.common.reader.report(
                    Diagnostic::warning(format!("`{}` does nothing here", effect.effect.name()))
                        .at(effect.span, format!("it depends on `{key}` of [medium]"))
                        .help(format!("give `{key}`")),
                );
            }
        }
    }

    /// Tables that an impact lies outside of, and expressions with values that are not allowed.
    fn coefficients(&self) {
        let angles = self.impact_angles();
        let coefficients = self.resistive.medium.resistance.iter();
        for ((spec, coefficient), span) in coefficients.zip(&self.common.places.coefficients) {
            match coefficient {
                Coefficient::Number(_) => {}
                Coefficient::Table(table) => self.covered(spec, table, *span, &angles),
                Coefficient::Expression(expression) => {
                    self.allowed(spec, expression, *span, &angles);
                }
            }
        }
    }

    /// The angles of the impacts, each with its place.
    fn impact_angles(&self) -> Vec<(f64, Option<Span>)> {
        let Common { model, places, .. } = self.common;
        match model.conditions.as_ref().and_then(|lists| lists.angle_rad.as_ref()) {
            Some(angles) => angles.iter().copied().zip(places.condition_angle.clone()).collect(),
            None => vec![(model.impact.angle_rad, places.angle)],
        }
    }

    fn covered(
        &self,
        spec: &ParamSpec,
        table: &AngleTable,
        span: Option<Span>,
        angles: &[(f64, Option<Span>)],
    ) {
        if let Some((angle, place)) = angles.iter().find(|(angle, _)| !table.covers(*angle)) {
            let value = significant(table.at(*angle), 6);
            self.common.reader.report(
                Diagnostic::warning(format!(
                    "an impact lies outside of the table of `{}`",
                    spec.key
                ))
                .at(*place, format!("{} deg", degrees(*angle)))
                .with(
                    span,
                    format!("its last value is taken: {}", format_si(value, spec.dimension)),
                ),
            );
        }
    }

    fn allowed(
        &self,
        spec: &ParamSpec,
        expression: &Expression,
        span: Option<Span>,
        angles: &[(f64, Option<Span>)],
    ) {
        let medium = self.resistive.medium;
        let bound = expression.clone().bind("density", medium.bulk_density);
        // A depth of the size of the intruder stands for those that it will come to.
        let size = self.common.intruder_diameter().unwrap_or(0.01);
        for (angle, place) in angles {
            for depth in [0.0, size, 10.0 * size] {
                let value = bound.eval(&[("angle", *angle), ("depth", depth)]);
                if spec.allowed.contains(value) {
                    continue;
                }
                let at_depth = match expression.uses("depth") {
                    true => format!(" and {} deep", format_si(depth, Dimension::LENGTH)),
                    false => String::new(),
                };
                self.common.reader.report(
                    Diagnostic::error(format!("`{}` is out of its range", spec.key))
                        .at(
                            span,
                            format!(
                                "gives {} at {} deg{at_depth}",
                                significant(value, 6),
                                degrees(*angle)
                            ),
                        )
                        .with(*place, "an impact of this model")
                        .help(format!("allowed: {}", interval(spec.allowed, spec.dimension))),
                );
                return;
            }
        }
    }
}
