//! The parameters of a force law by their paths: what a fit may change.

use engine::params::{ParamSpec, Range};
use thiserror::Error;

use super::{Coefficient, ResistanceChoice, ResistiveMedium, degrees};

/// A number of a model that a fit may change.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeParameter {
    /// Its path: `resistance.drag`, `resistance.drag_x@45` for the node of a table at 45°,
    /// `effect.janssen.q`.
    pub path: String,
    /// Its SI unit; empty for a pure number.
    pub unit: String,
    /// Its SI value.
    pub value: f64,
    /// The values that are accepted at all (SI).
    pub allowed: Range,
    /// The values that one would expect (SI).
    pub plausible: Range,
}

/// Why a parameter cannot be set.
#[derive(Clone, Debug, Error, PartialEq)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum ParameterError {
    #[error("the model has no number `{path}`")]
    Unknown { path: String },
    #[error("`{path}` may not be {value}")]
    NotAllowed {
        path: String,
        /// (SI).
        value: f64,
    },
}

/// Where a number stands.
#[derive(Clone, Copy)]
enum Place {
    Coefficient(usize),
    Node(usize, usize),
    Effect(usize),
}

impl ResistiveMedium {
    /// The numbers that a fit may change, in the order of [`ResistiveMedium::free`].
    pub fn free_parameters(&self) -> Vec<FreeParameter> {
        let all = self.parameters();
        let find = |path: &String| all.iter().find(|one| one.path == *path).cloned();
        self.free.iter().filter_map(find).collect()
    }

    /// Every number of the law: the coefficients, node by node, and the amplitudes of the effects.
    pub fn parameters(&self) -> Vec<FreeParameter> {
        let coefficients = self.resistance.parameters().into_iter().map(|(_, one)| one);
        coefficients.chain(self.amplitudes().map(|(_, one)| one)).collect()
    }

    /// The same medium with some numbers changed, each given by its path and its SI value.
    ///
    /// # Errors
    /// If one does not exist, or may not have its value.
    pub fn with_parameters(&self, values: &[(&str, f64)]) -> Result<Self, ParameterError> {
        let mut known = self.resistance.parameters();
        known.extend(self.amplitudes());
        let mut changed = self.clone();
        for &(path, value) in values {
            let Some((place, parameter)) = known.iter().find(|(_, one)| one.path == path) else {
                return Err(ParameterError::Unknown { path: path.to_owned() });
            };
            if !parameter.allowed.contains(value) {
                return Err(ParameterError::NotAllowed { path: path.to_owned(), value });
            }
            changed.set(*place, value);
        }
        Ok(changed)
    }

    fn amplitudes(&self) -> impl Iterator<Item = (Place, FreeParameter)> {
        self.effects.iter().enumerate().map(|(index, effect)| {
            let path = format!("effect.{}.q", effect.effect.name());
            (Place::Effect(index), parameter(path, effect.effect.amplitude(), effect.q))
        })
    }

    fn set(&mut self, place: Place, value: f64) {
        match place {
            Place::Coefficient(index) => {
                self.resistance.coefficients[index] = Coefficient::Number(value);
            }
            Place::Node(index, node) => {
                if let Coefficient::Table(table) = &mut self.resistance.coefficients[index] {
                    table.values[node] = value;
                }
            }
            Place::Effect(index) => self.effects[index].q = value,
        }
    }
}

impl ResistanceChoice {
    /// The numbers among the coefficients; an expression is none.
    fn parameters(&self) -> Vec<(Place, FreeParameter)> {
        let mut all = Vec::new();
        for (index, (spec, coefficient)) in self.iter().enumerate() {
            let path = format!("resistance.{}", spec.key);
            match coefficient {
                Coefficient::Number(value) => {
                    all.push((Place::Coefficient(index), parameter(path, spec, *value)));
                }
                Coefficient::Table(table) => {
                    let nodes = table.angles_rad.iter().zip(&table.values).enumerate();
                    all.extend(nodes.map(|(node, (angle, value))| {
                        let path = format!("{path}@{}", degrees(*angle));
                        (Place::Node(index, node), parameter(path, spec, *value))
                    }));
                }
                Coefficient::Expression(_) => {}
            }
        }
        all
    }

    /// Paths of the numbers of one coefficient: itself, or the nodes of its table.
    pub(crate) fn paths_of(&self, key: &str) -> Vec<String> {
        let whole = format!("resistance.{key}");
        let node = format!("{whole}@");
        let belongs = |path: &String| *path == whole || path.starts_with(&node);
        self.parameters().into_iter().map(|(_, one)| one.path).filter(belongs).collect()
    }
}

fn parameter(path: String, spec: &ParamSpec, value: f64) -> FreeParameter {
    let ParamSpec { dimension, allowed, plausible, .. } = *spec;
    FreeParameter { path, unit: dimension.si_unit(), value, allowed, plausible }
}
