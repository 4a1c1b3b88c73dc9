//! One smooth stretch of an impact: an adaptive Runge–Kutta pair of order 8 with dense output of
//! order 7 (Dormand & Prince 1980; Hairer, Nørsett & Wanner, II.10).

use std::cell::Cell;

use differential_equations::interpolate::{Interpolation, cubic_hermite_interpolate};
use differential_equations::methods::{DormandPrince, ExplicitRungeKutta, Ordinary};
use differential_equations::ode::{ODE, OrdinaryNumericalMethod};
use differential_equations::status::Status;
use roots::{SimpleConvergency, find_root_brent};

use super::assembly::{COORDINATES, State};
use super::impact::Tolerance;
use super::modes::{Modes, accelerate};
use super::motion::System;

/// Coordinates and rates, as the library counts them.
type Flat = [f64; 2 * COORDINATES];

/// More steps than any impact takes: beyond, the equations are stiffer than this method.
const MOST_STEPS: usize = 200_000;

struct Equations<'a> {
    system: &'a System<'a>,
    modes: &'a Modes,
    /// The last state of a trial in which a force was not finite, though the state was.
    fault: Cell<Option<State>>,
}

impl ODE<f64, Flat> for Equations<'_> {
    fn diff(&self, time: f64, flat: &Flat, rates: &mut Flat) {
        let state = state(time, flat);
        let (acceleration, _) = accelerate(self.system, &state, self.modes);
        // Later stages of a trial begin where an earlier one had no value.
        let is_cause = flat.iter().all(|value| value.is_finite());
        if is_cause && acceleration.iter().any(|value| !value.is_finite()) {
            self.fault.set(Some(state));
        }
        rates[..COORDINATES].copy_from_slice(&state.rate);
        rates[COORDINATES..].copy_from_slice(&acceleration);
    }
}

fn state(time: f64, flat: &Flat) -> State {
    let mut state = State { time, ..State::default() };
    state.position.copy_from_slice(&flat[..COORDINATES]);
    state.rate.copy_from_slice(&flat[COORDINATES..]);
    state
}

impl From<State> for Flat {
    fn from(state: State) -> Self {
        let mut flat = [0.0; 2 * COORDINATES];
        flat[..COORDINATES].copy_from_slice(&state.position);
        flat[COORDINATES..].copy_from_slice(&state.rate);
        flat
    }
}

/// From when to when (s), forward or backward, and how long a step to try first; 0 to find one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plan {
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) first_step: f64,
}

/// An integration that is under way in one mode.
pub(super) struct Solver<'a> {
    method: ExplicitRungeKutta<Ordinary, DormandPrince, f64, Flat, 8, 12, 16>,
    equations: Equations<'a>,
    end: f64,
    /// Rates at both ends of the last step, once they were asked for.
    slopes: Option<[Flat; 2]>,
}

impl<'a> Solver<'a> {
    /// Starts as `plan` says.
    ///
    /// # Errors
    /// If the equations give no step to start with: the state in which they have no value, if there is one.
    pub(super) fn start(
        system: &'a System<'a>,
        modes: &'a Modes,
        plan: Plan,
        state: &State,
        tolerance: &Tolerance,
    ) -> Result<Self, Option<State>> {
        let mut method = ExplicitRungeKutta::dop853()
            .rtol(tolerance.relative)
            .atol(tolerance.absolute)
            .max_steps(MOST_STEPS)
            .h0(plan.first_step.min(plan.to - plan.from).max(0.0));
        let equations = Equations { system, modes, fault: Cell::default() };
        method
            .init(&equations, plan.from, plan.to, &(*state).into())
            .map_err(|_| equations.fault.get())?;
        method.set_status(Status::Solving);
        Ok(Self { method, equations, end: plan.to, slopes: None })
    }

    /// The state in which the equations have no value, where that is why no step is small enough.
    pub(super) fn fault(&self) -> Option<State> {
        self.equations.fault.get()
    }

    /// Takes a step; its start and end (s). Nothing if no step is small enough.
    pub(super) fn step(&mut self) -> Option<(f64, f64)> {
        self.slopes = None;
        // The last evaluation of a step is where the next one begins; it may lack a value, unnoticed.
        let here = self.method.t();
        let begins_here = |fault: &State| (fault.time - here).abs() <= f64::EPSILON * here.abs();
        self.equations.fault.set(self.equations.fault.get().filter(begins_here));
        loop {
            let left = self.end - self.method.t();
            if self.method.h().abs() > left.abs() {
                self.method.set_h(left);
            }
            self.method.step(&self.equations).ok()?;
            if !matches!(self.method.status(), Status::RejectedStep) {
                let finite = self.method.y().iter().all(|value| value.is_finite());
                return finite.then(|| (self.method.t_prev(), self.method.t()));
            }
        }
    }

    /// The state at `time` (s) within the last step.
    ///
    /// The order-7 polynomial is the cubic that fits the ends plus s²(1−s)² Q(s), and the library, as of
    /// 0.7.0, takes Q at 1−s. Its value at the mirrored time has the right Q, and the wrong cubic goes
    /// out with the difference.
    pub(super) fn at(&mut self, time: f64) -> State {
        let (from, to) = (self.method.t_prev(), self.method.t());
        if time - to == 0.0 {
            return state(to, self.method.y());
        }
        let time = time.clamp(from.min(to), from.max(to));
        let mirrored = (from + (to - time)).clamp(from.min(to), from.max(to));
        // Within the step, the library has no reason to refuse.
        let theirs = self.method.interpolate(mirrored).unwrap_or(*self.method.y());
        let [start, end] = *self.slopes.get_or_insert_with(|| {
            [(from, self.method.y_prev()), (to, self.method.y())].map(|(time, flat)| {
                let mut rates = [0.0; 2 * COORDINATES];
                self.equations.diff(time, flat, &mut rates);
                rates
            })
        });
        let (before, after) = (self.method.y_prev(), self.method.y());
        let cubic = |time| cubic_hermite_interpolate(from, to, before, after, &start, &end, time);
        let (here, there) = (cubic(time), cubic(mirrored));
        let flat = std::array::from_fn(|index| here[index] + theirs[index] - there[index]);
        state(time, &flat)
    }

    /// When `value` of the state comes to zero within the last step, given its values at both ends of
    /// an interval, the second of them negative.
    pub(super) fn root(
        &mut self,
        (from, start): (f64, f64),
        (to, end): (f64, f64),
        value: impl Fn(&State) -> f64,
    ) -> f64 {
        debug_assert!(start >= 0.0 && end < 0.0);
        let eps = 4.0 * f64::EPSILON * (1.0 + to.abs());
        let mut convergence = SimpleConvergency { eps, max_iter: 200 };
        let at = |time: f64| if time - from == 0.0 { start } else { value(&self.at(time)) };
        find_root_brent(from, to, at, &mut convergence).unwrap_or(to)
    }
}
