//! One smooth stretch of an impact: an adaptive Runge–Kutta pair of order 8 with dense output of
//! order 7 (Dormand & Prince 1980; Hairer, Nørsett & Wanner, II.5 and II.10).
//!
//! Written out for eight numbers and no heap: an impact is some twenty steps, thousands of impacts make
//! a diagnosis, and the slopes that only dense output needs are found when it is asked for.

mod root;
mod tableau;

use std::cell::Cell;

use super::assembly::{COORDINATES, State};
use super::holding::accelerate;
use super::modes::Modes;
use super::motion::System;
use root::root;
use tableau::{DENSE, DENSE_STAGES, END, ERROR, LOW_ORDER_STEP, Row, SLOPES, STAGES, STEP};

/// Numbers of a state: coordinates, then rates.
const NUMBERS: usize = 2 * COORDINATES;

type Flat = [f64; NUMBERS];

/// Shortest step that may be tried after one that failed (s).
const SHORTEST: f64 = 1e-18;

/// What is kept of the step that the errors allow, so that the next one seldom fails.
const SAFETY: f64 = 0.9;

/// An error below this says nothing of how errors grow from step to step.
const LEAST_ERROR: f64 = 1e-2;

/// Least and greatest ratio of a step to the one before.
const RATIOS: (f64, f64) = (1.0 / 3.0, 6.0);

/// Greatest ratio of the second step to the first, whose length comes from two slopes alone.
const SECOND_RATIO: f64 = 100.0;

fn state(time: f64, [a, b, c, d, e, f, g, h]: &Flat) -> State {
    State { position: [*a, *b, *c, *d], rate: [*e, *f, *g, *h], time }
}

fn flat([a, b, c, d]: [f64; COORDINATES], [e, f, g, h]: [f64; COORDINATES]) -> Flat {
    [a, b, c, d, e, f, g, h]
}

/// Errors that a step may make, as the solver weighs them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Relative to each coordinate and rate.
    pub relative: f64,
    /// Absolute (m, m/s, rad, rad/s).
    pub absolute: f64,
}

impl Default for Tolerance {
    /// Errors of a whole impact stay near 1e-10 of its depth.
    fn default() -> Self {
        Self { relative: 1e-11, absolute: 1e-13 }
    }
}

/// From when to when (s), forward or backward, how long a step to try first, 0 to find one, and how many steps
/// were tried before and may be tried in all.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plan {
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) first_step: f64,
    pub(super) tried: usize,
    pub(super) most: usize,
}

/// An integration that is under way in one mode.
pub(super) struct Solver<'a> {
    system: &'a System<'a>,
    modes: &'a Modes,
    tolerance: Tolerance,
    end: f64,
    /// Length of the next step, negative backward (s).
    next: f64,
    /// Steps that were tried, and that may be.
    tried: usize,
    most: usize,
    /// Length (s) and error of the last step.
    accepted: Option<(f64, f64)>,
    /// Start and end of the last step (s), and the numbers there.
    times: (f64, f64),
    before: Flat,
    after: Flat,
    /// Slopes of the last step, by stage.
    slopes: [Flat; SLOPES],
    /// What dense output adds to the cubic over the last step, once it was asked for.
    beyond_cubic: Option<[Flat; 4]>,
    /// The last state of a trial in which a force was not finite, though the state was.
    fault: Cell<Option<State>>,
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
        let numbers = flat(state.position, state.rate);
        let mut solver = Self {
            system,
            modes,
            tolerance: *tolerance,
            end: plan.to,
            next: plan.first_step,
            tried: plan.tried,
            most: plan.most,
            accepted: None,
            times: (plan.from, plan.from),
            before: numbers,
            after: numbers,
            slopes: [[0.0; NUMBERS]; SLOPES],
            beyond_cubic: None,
            fault: Cell::default(),
        };
        solver.slopes[END] = solver.slope(plan.from, &numbers);
        if solver.next == 0.0 {
            solver.next = solver.first_step().copysign(plan.to - plan.from);
        }
        match solver.next.is_finite() && solver.next != 0.0 {
            true => Ok(solver),
            false => Err(solver.fault.get()),
        }
    }

    /// The state in which the equations have no value, where that is why no step is small enough.
    pub(super) fn fault(&self) -> Option<State> {
        self.fault.get()
    }

    /// Steps that were tried so far, those before it began among them.
    pub(super) fn tried(&self) -> usize {
        self.tried
    }

    /// Takes a step; its start and end (s). Nothing if no step is small enough.
    pub(super) fn step(&mut self) -> Option<(f64, f64)> {
        self.beyond_cubic = None;
        let from = self.times.1;
        // The last evaluation of a step is where the next one begins; it may lack a value, unnoticed.
        let begins_here = |fault: &State| (fault.time - from).abs() <= f64::EPSILON * from.abs();
        self.fault.set(self.fault.get().filter(begins_here));
        self.before = self.after;
        self.slopes[0] = self.slopes[END];
        let mut largest_ratio = if self.accepted.is_some() { RATIOS.1 } else { SECOND_RATIO };
        while self.tried < self.most {
            self.tried += 1;
            let left = self.end - from;
            let last = self.next.abs() >= left.abs();
            let step = if last { left } else { self.next };
            for (stage, row) in STAGES.iter().enumerate() {
                self.slopes[stage + 1] = self.slope_at((from, row), step);
            }
            let taken = self.combined(STEP);
            let tried = self.displaced(&taken, step);
            let error = self.error(&taken, &tried, step);
            let ratio = self.ratio(step, error);
            self.next = step * ratio.max(RATIOS.0).min(largest_ratio);
            if error <= 1.0 {
                self.times = (from, if last { self.end } else { from + step });
                self.after = tried;
                self.accepted = Some((step, error.max(LEAST_ERROR)));
                self.slopes[END] = self.slope(self.times.1, &tried);
                return self.after.iter().all(|number| number.is_finite()).then_some(self.times);
            }
            if self.next.abs() < SHORTEST {
                return None;
            }
            // A step that follows a failure is not lengthened at once.
            largest_ratio = 1.0;
        }
        None
    }

    /// The state at `time` (s) within the last step.
    pub(super) fn at(&mut self, time: f64) -> State {
        if time - self.times.1 == 0.0 {
            return state(self.times.1, &self.after);
        }
        let beyond = match self.beyond_cubic {
            Some(known) => known,
            None => {
                let found = self.finish_dense_output();
                self.beyond_cubic = Some(found);
                found
            }
        };
        self.interpolate(time, &beyond)
    }

    /// The same to order 3, at no cost: enough to see a sign by.
    pub(super) fn near(&self, time: f64) -> State {
        self.interpolate(time, &[[0.0; NUMBERS]; 4])
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
        root((from, start), (to, end), eps, |time| value(&self.at(time)))
    }

    fn slope(&self, time: f64, numbers: &Flat) -> Flat {
        let state = state(time, numbers);
        let (acceleration, _) = accelerate(self.system, &state, self.modes);
        // Later stages of a trial begin where an earlier one had no value.
        let is_cause = numbers.iter().all(|value| value.is_finite());
        if is_cause && acceleration.iter().any(|value| !value.is_finite()) {
            self.fault.set(Some(state));
        }
        flat(state.rate, acceleration)
    }

    /// The slope at a stage of a step of length `step` (s), whose weights also sum to its time.
    fn slope_at(&self, (from, row): (f64, Row), step: f64) -> Flat {
        let share: f64 = row.iter().map(|(_, weight)| weight).sum();
        self.slope(from + share * step, &self.displaced(&self.combined(row), step))
    }

    /// Ratio of the next step to one of length `step` (s) with this error. On the way to rest errors grow
    /// from step to step, so their trend counts too where it asks for less (Gustafsson 1994).
    fn ratio(&self, step: f64, error: f64) -> f64 {
        // The error is of order 8 in the step.
        let eighth_root = |value: f64| value.sqrt().sqrt().sqrt();
        let ratio = SAFETY / eighth_root(error);
        match self.accepted {
            Some((before, error_before)) if error <= 1.0 => {
                let trend = step / before * eighth_root(error_before / error);
                ratio.min(ratio * trend)
            }
            _ => ratio,
        }
    }

    fn displaced(&self, slope: &Flat, step: f64) -> Flat {
        std::array::from_fn(|index| self.before[index] + step * slope[index])
    }

    fn combined(&self, row: Row) -> Flat {
        let mut sum = [0.0; NUMBERS];
        for &(stage, weight) in row {
            for (sum, slope) in sum.iter_mut().zip(&self.slopes[stage]) {
                *sum += weight * slope;
            }
        }
        sum
    }

    /// Error of a step (s) along the slope `taken` to `tried`; 1 is just tolerated.
    fn error(&self, taken: &Flat, tried: &Flat, step: f64) -> f64 {
        let (fifth, low) = (self.combined(ERROR), self.combined(LOW_ORDER_STEP));
        let (mut squares_5, mut squares_3) = (0.0, 0.0);
        for index in 0..NUMBERS {
            let scale = self.scale(self.before[index].abs().max(tried[index].abs()));
            squares_5 += (fifth[index] / scale).powi(2);
            squares_3 += ((taken[index] - low[index]) / scale).powi(2);
        }
        let both = squares_5 + 0.01 * squares_3;
        let both = if both > 0.0 { both } else { 1.0 };
        step.abs() * squares_5 / (both * NUMBERS as f64).sqrt()
    }

    fn scale(&self, size: f64) -> f64 {
        self.tolerance.absolute + self.tolerance.relative * size
    }

    fn norm(&self, numbers: &Flat) -> f64 {
        let weighed = |index: usize| numbers[index] / self.scale(self.after[index].abs());
        (0..NUMBERS).map(|index| weighed(index).powi(2)).sum::<f64>().sqrt()
    }

    /// Length of a first step (s), by the first two derivatives (Hairer, Nørsett & Wanner, II.4).
    fn first_step(&self) -> f64 {
        let direction = (self.end - self.times.0).signum();
        let slope = self.slopes[END];
        let (size, first) = (self.norm(&self.after), self.norm(&slope));
        let short = if size <= 1e-5 || first <= 1e-5 { 1e-6 } else { 0.01 * size / first };
        let moved = std::array::from_fn(|i| self.after[i] + direction * short * slope[i]);
        let there = self.slope(self.times.0 + direction * short, &moved);
        let second = self.norm(&std::array::from_fn(|i| there[i] - slope[i])) / short;
        let steepest = first.max(second);
        let allowed = if steepest <= 1e-15 {
            (1e-3 * short).max(1e-6)
        } else {
            (0.01 / steepest).sqrt().sqrt().sqrt()
        };
        (100.0 * short).min(allowed)
    }

    fn finish_dense_output(&mut self) -> [Flat; 4] {
        let step = self.times.1 - self.times.0;
        for (stage, row) in DENSE_STAGES.iter().enumerate() {
            self.slopes[END + 1 + stage] = self.slope_at((self.times.0, row), step);
        }
        DENSE.map(|row| self.combined(row).map(|slope| step * slope))
    }

    /// The cubic through both ends of the last step, with `beyond` it.
    fn interpolate(&self, time: f64, beyond: &[Flat; 4]) -> State {
        let step = self.times.1 - self.times.0;
        let s = ((time - self.times.0) / step).clamp(0.0, 1.0);
        let r = 1.0 - s;
        let [b0, b1, b2, b3] = beyond;
        let number = |i: usize| {
            let rise = self.after[i] - self.before[i];
            let start = step * self.slopes[0][i] - rise;
            let end = rise - step * self.slopes[END][i] - start;
            let rest = b0[i] + s * (b1[i] + r * (b2[i] + s * b3[i]));
            self.before[i] + s * (rise + r * (start + s * (end + r * rest)))
        };
        state(time, &std::array::from_fn(number))
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use crate::{Compact, Impact, Silhouette, Surroundings};
    use engine::math::Vec3;

    /// A body of which no force asks the shape.
    struct Shapeless;

    impl Silhouette for Shapeless {
        fn diameter(&self) -> f64 {
            0.02
        }
        fn height(&self) -> f64 {
            0.02
        }
        fn frontal_area(&self) -> f64 {
            0.0
        }
        fn immersed_area(&self, _: f64) -> f64 {
            0.0
        }
        fn section(&self, _: f64) -> f64 {
            0.0
        }
        fn volume(&self, _: f64) -> f64 {
            0.0
        }
        fn contact_area(&self, _: f64) -> f64 {
            0.0
        }
    }

    #[test]
    fn backward_in_time_a_flight_is_a_parabola_between_steps_too() {
        let body = Compact::new(Arc::new(Shapeless), 0.01, 0.1, 1e-5);
        let gravity = 9.81;
        let bed = Surroundings {
            bulk_density: 1500.0,
            gravity,
            packing: None,
            bed_depth: None,
            fluid: None,
        };
        let start = Compact::at_surface(Vec3::new(1.5, 0.0, -2.0), 0.0);
        let impact = Impact::new(Box::new(body), Vec::new(), bed, start);
        let times = [-1e-4, -1.1e-3, -3.7e-3, -9.2e-3, -0.04];
        let states = impact.flight(&times).expect("nothing stops it");
        for (time, state) in times.into_iter().zip(states) {
            let z = -2.0 * time - 0.5 * gravity * time * time;
            let [found_x, found_z, ..] = state.position;
            // Polynomials of order 2 are exact but for round-off.
            assert!((found_x - 1.5 * time).abs() < 1e-14 && (found_z - z).abs() < 1e-14, "{time}");
        }
    }
}
