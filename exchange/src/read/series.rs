//! What is kept of a log.

use engine::math::Vec3;

/// A body over the time of its run.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyStates {
    /// Its name in the topics of the log.
    pub name: String,
    /// Its states, in the order of the log.
    pub states: Vec<BodyState>,
}

/// The state of a body at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    /// Simulated time since the start of the run (s).
    pub time: f64,
    /// Depth of the lowest point below the undisturbed surface, positive downward (m).
    pub depth: f64,
    /// Centre of mass; z points up from the undisturbed surface (m).
    pub position: Vec3,
    /// Velocity of the centre of mass (m/s).
    pub velocity: Vec3,
}

/// The force of the ground on a body over the time of its run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BodyLoads {
    /// Its name in the topics of the log.
    pub name: String,
    /// Simulated time since the start of the run (s).
    pub time: Vec<f64>,
    /// The sum of everything that acts on it but its weight, at each time (N).
    pub force: Vec<Vec3>,
}

/// The energy budget over the time of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct EnergyBudgets {
    /// Names of the terms, as in `dissipated_sliding_J`, in the order of the log.
    pub terms: Vec<String>,
    /// Simulated time since the start of the run (s).
    pub time: Vec<f64>,
    /// For each term, its value at each time (J).
    pub values: Vec<Vec<f64>>,
    /// How well they close; none of an imported run, whose terms are not all there are.
    pub closing: Option<Closing>,
}

/// How well a budget closes over the time of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Closing {
    /// Energy that no term accounts for, at each time (J).
    pub unaccounted: Vec<f64>,
    /// The largest of it so far over the initial energy of the intruder, at each time (–).
    pub closure: Vec<f64>,
}

impl EnergyBudgets {
    /// The values of the term `name` (J); `None` if the log has no such term.
    pub fn term(&self, name: &str) -> Option<&[f64]> {
        let at = self.terms.iter().position(|term| term == name)?;
        Some(&self.values[at])
    }
}
