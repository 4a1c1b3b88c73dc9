//! A medium that is a force law, in SI.

use std::sync::Arc;

use engine::fluid::Fluid;
use engine::params::{ParamSpec, ParamTable};
use intruders::AssemblyRequest;
use resistive::{Approach, Assembly, Driven, Impact, ResistanceLaw, Space, Surroundings};
use resistive::{Coefficients, Effect, Expression, OwnEffect, ResistanceEntry};

use super::{Condition, Intruder, Launch, Model};
use crate::diagnostics::Span;

/// A medium that resists by a law: a baseline and the effects added to it.
#[derive(Clone, Debug, PartialEq)]
pub struct ResistiveMedium {
    /// Planar or spatial.
    pub space: Space,
    /// Bulk density (kg/m³, planar kg/m²).
    pub bulk_density: f64,
    /// Magnitude of gravity, downward (m/s²).
    pub gravity: f64,
    /// Packing fraction, where it is known.
    pub packing: Option<f64>,
    /// Depth of the bed (m), where it is known.
    pub bed_depth: Option<f64>,
    /// The fluid in the bed and above it; `None` where it is air.
    pub fluid: Option<Fluid>,
    /// `[resistance]`.
    pub resistance: ResistanceChoice,
    /// `[[effect]]`, in the order of the file.
    pub effects: Vec<EffectChoice>,
    /// `[[candidate]]`: effects that are no part of the model and that a diagnosis tries.
    pub candidates: Vec<Arc<OwnEffect>>,
    /// Paths of the parameters that a fit may change, each node of a table by itself.
    pub free: Vec<String>,
    /// Time between two samples of the log (s).
    pub log_interval: f64,
}

/// The baseline and its coefficients.
#[derive(Clone)]
pub struct ResistanceChoice {
    /// The registry's entry.
    pub entry: &'static ResistanceEntry,
    /// One per parameter of the entry, in its order.
    pub coefficients: Vec<Coefficient>,
    /// Where the file names it.
    pub span: Span,
}

/// An effect and its amplitude.
#[derive(Clone, Debug)]
pub struct EffectChoice {
    /// The effect.
    pub effect: Effect,
    /// Amplitude, in the units that the effect defines (SI); 0 without the effect.
    pub q: f64,
    /// Where the file names it.
    pub span: Span,
}

/// A coefficient of the baseline, in SI.
#[derive(Clone, Debug)]
pub enum Coefficient {
    /// The same for every impact.
    Number(f64),
    /// A function of the impact angle, by its nodes.
    Table(AngleTable),
    /// A function of the entry's variables.
    Expression(Expression),
}

/// Values over the impact angle: linear between the nodes, constant outside.
#[derive(Clone, Debug, PartialEq)]
pub struct AngleTable {
    /// Impact angles below the horizontal (rad), rising.
    pub angles_rad: Vec<f64>,
    /// SI values, one per angle.
    pub values: Vec<f64>,
}

/// A model whose medium is a force law.
#[derive(Clone, Copy, Debug)]
pub struct ResistiveModel<'a> {
    /// The whole model.
    pub model: &'a Model,
    /// Its medium.
    pub medium: &'a ResistiveMedium,
}

impl ResistiveModel<'_> {
    /// The impact `condition`, ready to be integrated.
    pub fn impact(&self, condition: &Condition) -> Impact {
        self.medium.impact(&self.model.intruder, &self.model.launch(condition))
    }
}

impl ResistiveMedium {
    /// An impact of `intruder` on this medium, ready to be integrated; its lowest point starts at the
    /// surface, at x = 0.
    pub fn impact(&self, intruder: &Intruder, launch: &Launch) -> Impact {
        let launchable = (intruder.shape.assembly)(&AssemblyRequest {
            params: &intruder.params,
            space: self.space,
            mass: intruder.mass,
            velocity: launch.velocity(),
            spin: launch.spin.y,
        });
        let laws = self.laws_at(Approach { speed: launch.speed, angle: launch.angle_rad });
        let assembly: Box<dyn Assembly> = match launch.pushed_to {
            Some(_) => Box::new(Driven::new(launchable.assembly)),
            None => launchable.assembly,
        };
        Impact::new(assembly, laws, self.surroundings(), launchable.start)
    }

    /// What laws are told of the medium.
    pub fn surroundings(&self) -> Surroundings {
        let Self { bulk_density, gravity, packing, bed_depth, fluid, .. } = *self;
        Surroundings { bulk_density, gravity, packing, bed_depth, fluid }
    }

    /// The baseline for a body that comes as `approach` says, then the effects in their order.
    pub fn laws_at(&self, approach: Approach) -> Vec<Box<dyn ResistanceLaw>> {
        let mut laws = vec![(self.resistance.entry.build)(&self.coefficients_at(approach.angle))];
        let mut effects: Vec<&EffectChoice> = self.effects.iter().collect();
        effects.sort_by_key(|one| one.effect.rank());
        laws.extend(effects.iter().map(|one| one.effect.build(one.q, approach)));
        laws
    }

    /// The coefficients of the baseline for an impact at `angle_rad` below the horizontal.
    pub fn coefficients_at(&self, angle_rad: f64) -> Coefficients {
        let mut numbers = ParamTable::new();
        let mut functions = Vec::new();
        for (spec, coefficient) in self.resistance.iter() {
            match coefficient {
                Coefficient::Number(value) => numbers.set(spec.key, *value),
                Coefficient::Table(table) => numbers.set(spec.key, table.at(angle_rad)),
                Coefficient::Expression(expression) => {
                    let bound = expression
                        .clone()
                        .bind("density", self.bulk_density)
                        .bind("angle", angle_rad);
                    match bound.uses("depth") {
                        true => functions.push((spec.key, bound)),
                        false => numbers.set(spec.key, bound.eval(&[])),
                    }
                }
            }
        }
        functions.into_iter().fold(Coefficients::new(numbers), |all, (key, function)| {
            all.with_function(key, function)
        })
    }
}

impl ResistanceChoice {
    /// Parameters of the entry with their coefficients.
    pub fn iter(&self) -> impl Iterator<Item = (&'static ParamSpec, &Coefficient)> {
        self.entry.params.iter().zip(&self.coefficients)
    }
}

impl AngleTable {
    /// The value for an impact at `angle_rad`.
    pub fn at(&self, angle_rad: f64) -> f64 {
        let above = self.angles_rad.partition_point(|angle| *angle <= angle_rad);
        let last = self.values.len() - 1;
        if above == 0 || above > last {
            return self.values[above.min(last)];
        }
        let [from, to] = [self.angles_rad[above - 1], self.angles_rad[above]];
        let share = (angle_rad - from) / (to - from);
        (1.0 - share) * self.values[above - 1] + share * self.values[above]
    }

    /// Whether `angle_rad` lies between the first and the last node.
    pub fn covers(&self, angle_rad: f64) -> bool {
        self.angles_rad.first().is_some_and(|first| angle_rad >= *first)
            && self.angles_rad.last().is_some_and(|last| angle_rad <= *last)
    }
}

impl PartialEq for Coefficient {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Number(a), Self::Number(b)) => a.to_bits() == b.to_bits(),
            (Self::Table(a), Self::Table(b)) => a == b,
            (Self::Expression(a), Self::Expression(b)) => a.text() == b.text(),
            _ => false,
        }
    }
}

impl PartialEq for ResistanceChoice {
    fn eq(&self, other: &Self) -> bool {
        self.entry.name == other.entry.name && self.coefficients == other.coefficients
    }
}

impl std::fmt::Debug for ResistanceChoice {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("ResistanceChoice").field(&self.entry.name).field(&self.coefficients).finish()
    }
}

impl PartialEq for EffectChoice {
    fn eq(&self, other: &Self) -> bool {
        self.effect == other.effect && self.q.to_bits() == other.q.to_bits()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_linear_between_its_nodes_and_constant_outside() {
        let table = AngleTable { angles_rad: vec![0.2, 0.4, 1.0], values: vec![1.0, 3.0, 0.0] };
        for (angle, value) in
            [(0.1, 1.0), (0.2, 1.0), (0.3, 2.0), (0.4, 3.0), (0.7, 1.5), (1.0, 0.0), (1.5, 0.0)]
        {
            // Two roundings of numbers of order one.
            assert!((table.at(angle) - value).abs() < 1e-15 * 4.0, "{angle}");
        }
        assert!(table.covers(0.2) && table.covers(1.0));
        assert!(!table.covers(0.19) && !table.covers(1.01));
    }
}
