//! What one can see of an impact while it is integrated.

use super::assembly::State;
use super::modes::Modes;
use super::motion::System;
use super::solver::Solver;

/// Watches an impact.
pub trait Observer {
    /// A stretch of smooth motion was integrated.
    fn solver_step(&mut self, solver_step: &mut SolverStep<'_, '_>);

    /// The impact is over; the body stays in `state`.
    fn end(&mut self, time: f64, state: &State);
}

/// A step of the solver, or the part of it up to an event.
pub struct SolverStep<'a, 'b> {
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) solver: &'a mut Solver<'b>,
    pub(super) system: &'a System<'b>,
    pub(super) modes: &'a Modes,
}

impl SolverStep<'_, '_> {
    /// Where it begins (s).
    pub fn from(&self) -> f64 {
        self.from
    }

    /// Where it ends (s).
    pub fn to(&self) -> f64 {
        self.to
    }

    /// The state at `time` (s) within it.
    pub fn state(&mut self, time: f64) -> State {
        self.solver.at(time)
    }
}

/// States at given times.
pub struct Trajectory<'a> {
    times: &'a [f64],
    states: Vec<State>,
}

impl<'a> Trajectory<'a> {
    /// Will hold the states at `times` (s), in rising order and none before the start; after the end
    /// the body rests.
    pub fn at(times: &'a [f64]) -> Self {
        Self { times, states: Vec::with_capacity(times.len()) }
    }

    /// One state per time.
    pub fn states(&self) -> &[State] {
        &self.states
    }
}

impl Observer for Trajectory<'_> {
    fn solver_step(&mut self, solver_step: &mut SolverStep<'_, '_>) {
        while let Some(&time) = self.times.get(self.states.len()).filter(|&&t| t <= solver_step.to)
        {
            self.states.push(solver_step.state(time));
        }
    }

    fn end(&mut self, _: f64, state: &State) {
        self.states.resize(self.times.len(), *state);
    }
}

/// Sees nothing: for runs of which only the end counts.
impl Observer for () {
    fn solver_step(&mut self, _: &mut SolverStep<'_, '_>) {}
    fn end(&mut self, _: f64, _: &State) {}
}
