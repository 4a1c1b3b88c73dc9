//! One impact on a resistive medium, from first contact to rest.

mod events;
mod margin;

use engine::math::Vec3;
use serde::{Deserialize, Serialize};

use super::assembly::{Assembly, COORDINATES, PARTS, State};
use super::error::ImpactError;
use super::fluid;
use super::holding::{accelerate, is_held};
use super::modes::{AXES, Held, Modes};
use super::motion::System;
use super::observe::{Observer, SolverStep};
use super::solver::{Plan, Solver, Tolerance};
use super::{ResistanceLaw, Surroundings};
use margin::{
    Before, COMPONENTS, FORWARD, Fired, PER_PART, SINKING, SLOW, SLOWING, STOPPING, SURFACE,
};

/// Below this share of √(gD) a component of the velocity is what the integration has left of zero.
const STILL: f64 = 1e-6;

/// Changes of mode one after another at one time: a body of [`PARTS`] parts has some ten events at once, and then
/// moves on.
const MOST_AT_ONCE: usize = 100;

/// A tip this near to the surface touches it (m).
const TOUCH: f64 = 1e-12;

/// How much an integration may cost before it is given up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Steps that are tried, over the whole impact.
    pub steps: usize,
    /// Changes of mode.
    pub changes: usize,
}

impl Default for Effort {
    /// More than any impact takes: most need some twenty steps and fewer changes.
    fn default() -> Self {
        Self { steps: 200_000, changes: 10_000 }
    }
}

/// An assembly on its way into a medium.
pub struct Impact {
    assembly: Box<dyn Assembly>,
    laws: Vec<Box<dyn ResistanceLaw>>,
    bed: Surroundings,
    start: State,
    tolerance: Tolerance,
    effort: Effort,
}

/// When and where a part stopped, as the literature defines it ([`engine::stopping::Stopping`]).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PartStop {
    /// When its tip first touched the surface (s).
    pub contact: Option<f64>,
    /// When its tip first stopped sinking (s).
    pub vertical: Option<f64>,
    /// When the horizontal velocity of its tip first came to zero (s); 0 if it had none.
    pub horizontal: Option<f64>,
    /// Largest depth of the tip up to its stop (m).
    pub depth: f64,
    /// Horizontal distance from the start up to the horizontal stop (m).
    pub range: f64,
}

impl PartStop {
    /// The later of the two components (s).
    pub fn time(&self) -> Option<f64> {
        Some(self.horizontal?.max(self.vertical?))
    }
}

/// How an impact ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ending {
    /// When (s).
    pub time: f64,
    /// Whether the body is at rest, held by friction, or, of a chain, all tips have stopped.
    pub stopped: bool,
    /// The last state.
    pub state: State,
    /// By part.
    pub parts: [PartStop; PARTS],
    /// When the speed of the first part first fell below 5 % of the impact speed (s); of a body that
    /// is let go from rest, when it came to rest.
    pub slow: Option<f64>,
    /// Since when it has stayed below 5 % of its greatest speed (s).
    pub rest: Option<f64>,
    /// Steps of the solver.
    pub steps: u64,
}

/// How the motion goes on when something has happened.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Course {
    /// In the same modes: the step that was taken holds to its end.
    Same,
    /// In other modes or not at all.
    New,
}

/// Everything of a run that is not the state.
struct Progress {
    modes: Modes,
    parts: [PartStop; PARTS],
    /// Sign of the horizontal velocity of each tip at the start.
    forward: [f64; PARTS],
    first_x: [f64; PARTS],
    /// Speed of the first part at the start (m/s).
    start_speed: f64,
    top_speed: f64,
    slow: Option<f64>,
    rest: Option<f64>,
    /// Whether friction holds the body.
    held: bool,
    steps: u64,
    /// Steps that were tried, in stretches that are over.
    tried: usize,
}

impl Impact {
    /// `assembly` in the state `start`, in contact or above, on `bed` under `laws` and the fluid of the bed.
    pub fn new(
        assembly: Box<dyn Assembly>,
        mut laws: Vec<Box<dyn ResistanceLaw>>,
        bed: Surroundings,
        start: State,
    ) -> Self {
        laws.extend(
            bed.fluid.into_iter().flat_map(|fluid| fluid::around(fluid, &*assembly, &start)),
        );
        Self {
            assembly,
            laws,
            bed,
            start,
            tolerance: Tolerance::default(),
            effort: Effort::default(),
        }
    }

    /// The same, given up after another effort.
    #[must_use]
    pub fn with_effort(mut self, effort: Effort) -> Self {
        self.effort = effort;
        self
    }

    /// The same, integrated to another tolerance.
    #[must_use]
    pub fn with_tolerance(mut self, tolerance: Tolerance) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// What falls.
    pub fn assembly(&self) -> &dyn Assembly {
        &*self.assembly
    }

    /// The laws, in the order in which they act.
    pub fn laws(&self) -> &[Box<dyn ResistanceLaw>] {
        &self.laws
    }

    /// The laws, when no more is asked of the impact.
    #[must_use]
    pub fn into_laws(self) -> Vec<Box<dyn ResistanceLaw>> {
        self.laws
    }

    /// What it falls into.
    pub fn bed(&self) -> &Surroundings {
        &self.bed
    }

    /// The state at time 0.
    pub fn start(&self) -> &State {
        &self.start
    }

    pub(super) fn system(&self) -> System<'_> {
        System { assembly: &*self.assembly, laws: &self.laws, bed: self.bed }
    }

    /// Integrates to rest, or to `duration` (s); `observer` sees every stretch of it.
    ///
    /// # Errors
    /// If the equations have no solution that a solver can follow.
    pub fn run(&self, duration: f64, observer: &mut dyn Observer) -> Result<Ending, ImpactError> {
        let system = self.system();
        let (mut time, mut state) = (0.0, self.start);
        let mut progress = self.begin(&system);
        let mut hint = 0.0;
        let (mut last_time, mut at_once) = (-1.0, 0);
        for _ in 0..self.effort.changes {
            if time >= duration || self.is_over(&progress) {
                observer.end(time, &state);
                return Ok(self.ending(time, &state, progress));
            }
            at_once = if time > last_time { 0 } else { at_once + 1 };
            last_time = time;
            if at_once > MOST_AT_ONCE {
                break;
            }
            let modes = progress.modes;
            let broken = |fault| system.broken(fault, &modes, time);
            let plan = self.plan((time, duration), hint, progress.tried);
            let mut solver =
                Solver::start(&system, &modes, plan, &state, &self.tolerance).map_err(broken)?;
            let mut before =
                Before { margins: self.margins(&system, &state, &progress), fresh: true };
            let mut rest_of_step = None;
            loop {
                let (from, to) = match rest_of_step.take() {
                    Some(rest) => rest,
                    None => {
                        let Some((from, to)) = solver.step() else {
                            return Err(self.given_up(&system, &solver, &modes, time));
                        };
                        hint = to - from;
                        progress.steps += 1;
                        (from, to)
                    }
                };
                let (after, fired) =
                    self.look(&mut solver, &system, (from, to), &before, &progress);
                time = fired.as_ref().map_or(to, |fired| fired.time);
                state = solver.at(time);
                let mut solver_step = SolverStep {
                    from,
                    to: time,
                    solver: &mut solver,
                    system: &system,
                    modes: &modes,
                };
                observer.solver_step(&mut solver_step);
                progress.top_speed = progress.top_speed.max(self.speed(&state));
                before = Before { margins: after, fresh: false };
                if let Some(fired) = fired {
                    let course =
                        self.respond(&system, &mut time, &mut state, &mut progress, &fired);
                    if course == Course::New || self.is_over(&progress) || time <= from {
                        break;
                    }
                    let margins = self.margins(&system, &state, &progress);
                    before = Before { margins, fresh: true };
                    rest_of_step = (time < to).then_some((time, to));
                }
                if rest_of_step.is_none() && to >= duration {
                    break;
                }
            }
            progress.tried = solver.tried();
        }
        Err(ImpactError::Chatter { time })
    }

    /// From one time to another (s), by a first step of length `hint`, after `tried` steps.
    fn plan(&self, (from, to): (f64, f64), hint: f64, tried: usize) -> Plan {
        Plan { from, to, first_step: hint, tried, most: self.effort.steps }
    }

    /// Why `solver` takes no step after `time` (s).
    fn given_up(
        &self,
        system: &System<'_>,
        solver: &Solver<'_>,
        modes: &Modes,
        time: f64,
    ) -> ImpactError {
        match solver.tried() < self.effort.steps {
            true => system.broken(solver.fault(), modes, time),
            false => ImpactError::TooMuchWork { steps: solver.tried(), time },
        }
    }

    /// States at `times` (s), all before first contact and in falling order: the flight that led to it.
    ///
    /// # Errors
    /// As [`Self::run`].
    pub fn flight(&self, times: &[f64]) -> Result<Vec<State>, ImpactError> {
        let system = self.system();
        let Some(&last) = times.last() else { return Ok(Vec::new()) };
        let modes = Modes::at(&system, &self.start, [false; PARTS], [[false; 2]; PARTS]);
        let plan = self.plan((0.0, last), 0.0, 0);
        let mut solver = Solver::start(&system, &modes, plan, &self.start, &self.tolerance)
            .map_err(|fault| system.broken(fault, &modes, 0.0))?;
        let mut states = Vec::with_capacity(times.len());
        let mut reached = 0.0;
        for &time in times {
            while reached > time {
                let Some((_, to)) = solver.step() else {
                    return Err(self.given_up(&system, &solver, &modes, time));
                };
                reached = to;
            }
            states.push(solver.at(time));
        }
        Ok(states)
    }

    /// Force (N) of the medium on part `index` where it is and as it moves in `state`, without what holds a part that
    /// rests.
    pub fn force_in(&self, index: usize, state: &State) -> Vec3 {
        let loaded = self.system().loaded(index, state, &self.last_modes(state));
        loaded.load.on_part(&loaded.motion).force
    }

    /// The modes at the start.
    pub(super) fn first_modes(&self) -> Modes {
        self.begin(&self.system()).modes
    }

    /// The modes of a body that has come to `state`, where its impact ends.
    pub(super) fn last_modes(&self, state: &State) -> Modes {
        let (mut in_bed, mut still) = ([false; PARTS], [[true; 2]; PARTS]);
        for index in 0..self.assembly.n_parts() {
            let part = self.assembly.part(index, state);
            in_bed[index] = part.immersion.depth > 0.0;
            // Tips may stop while their links go on.
            let scale = (self.bed.gravity * part.immersion.diameter).sqrt();
            still[index] = AXES.map(|axis| part.velocity[axis].abs() < STILL * scale);
        }
        Modes::at(&self.system(), state, in_bed, still)
    }

    fn begin(&self, system: &System<'_>) -> Progress {
        let mut parts = [PartStop::default(); PARTS];
        let mut in_bed = [false; PARTS];
        let mut still = [[false; 2]; PARTS];
        let (mut first_x, mut forward) = ([0.0; PARTS], [0.0; PARTS]);
        for index in 0..self.assembly.n_parts() {
            let part = self.assembly.part(index, &self.start);
            // A body that touches the surface and moves on, or has nothing else to lie on, is in.
            in_bed[index] = part.immersion.depth > 0.0
                || part.immersion.depth >= -TOUCH && part.tip_velocity.z <= 0.0;
            still[index] = AXES.map(|axis| part.velocity[axis] == 0.0);
            first_x[index] = part.tip.x;
            forward[index] = part.tip_velocity.x.signum();
            parts[index].contact = in_bed[index].then_some(0.0);
            parts[index].horizontal = (part.tip_velocity.x == 0.0).then_some(0.0);
        }
        let speed = self.speed(&self.start);
        Progress {
            modes: Modes::at(system, &self.start, in_bed, still),
            parts,
            forward,
            first_x,
            start_speed: speed,
            top_speed: speed,
            slow: None,
            rest: None,
            held: false,
            steps: 0,
            tried: 0,
        }
    }

    fn speed(&self, state: &State) -> f64 {
        self.assembly.part(0, state).velocity.norm()
    }

    fn is_over(&self, progress: &Progress) -> bool {
        let n_parts = self.assembly.n_parts();
        let all_stopped = progress.parts[..n_parts].iter().all(|part| part.vertical.is_some());
        progress.held || self.assembly.ends_with_its_tips() && all_stopped
    }

    /// Takes note of what happened and changes the modes accordingly.
    fn respond(
        &self,
        system: &System<'_>,
        time: &mut f64,
        state: &mut State,
        progress: &mut Progress,
        fired: &Fired,
    ) -> Course {
        let (still, in_bed, changed) = self.note(*time, state, progress, fired);
        let stopping = fired.which[STOPPING];
        let creeping = progress.modes.creeping;
        if stopping && !creeping && is_held(system, state, &progress.modes) {
            self.come_to_rest(system, time, state, progress);
            return Course::New;
        }
        if !(changed || stopping) {
            return Course::Same;
        }
        self.change_modes(system, state, progress, (still, in_bed, stopping));
        if progress.held {
            if self.assembly.ends_with_its_tips() {
                state.rate = [0.0; COORDINATES];
            }
            self.close(*time, state, progress);
        }
        Course::New
    }

    /// Takes note of what happened to each part and to the whole: what is held then, what is in the bed, and whether
    /// either changed.
    fn note(
        &self,
        time: f64,
        state: &State,
        progress: &mut Progress,
        fired: &Fired,
    ) -> (Held, [bool; PARTS], bool) {
        let mut still = progress.modes.held();
        let mut in_bed = progress.modes.in_bed;
        let mut changed = false;
        for index in 0..self.assembly.n_parts() {
            let own = &fired.which[PER_PART * index..][..PER_PART];
            let part = self.assembly.part(index, state);
            let stop = &mut progress.parts[index];
            if own[SURFACE] {
                in_bed[index] = !in_bed[index];
                stop.contact = stop.contact.or(Some(time));
                changed = true;
            }
            if own[SINKING] {
                stop.vertical = Some(time);
                stop.depth = stop.depth.max(-part.tip.z);
            }
            if own[FORWARD] {
                stop.horizontal = Some(time);
                stop.range = (part.tip.x - progress.first_x[index]).abs();
            }
            for component in 0..2 {
                // Where a held component lets go, [`Modes::at`] finds that friction cannot hold it.
                if own[COMPONENTS + component] {
                    still[index][component] = true;
                    changed = true;
                }
            }
        }
        if fired.which[SLOWING] {
            progress.rest = match progress.rest {
                Some(_) => None,
                None => Some(time),
            };
        }
        if fired.which[SLOW] {
            progress.slow = Some(time);
        }
        (still, in_bed, changed)
    }

    /// Goes on in the modes that `still`, what is in the bed, and friction that may hold the whole leave.
    fn change_modes(
        &self,
        system: &System<'_>,
        state: &mut State,
        progress: &mut Progress,
        (mut still, in_bed, stopping): (Held, [bool; PARTS], bool),
    ) {
        let creeping = progress.modes.creeping;
        if stopping && progress.modes.straight.is_some() {
            still[0] = [true; 2];
        }
        if self.assembly.n_parts() == 1 && !self.assembly.ends_with_its_tips() {
            for (component, held) in still[0].iter().enumerate() {
                if *held {
                    state.rate[component] = 0.0;
                }
            }
        }
        let modes = Modes::at(system, state, in_bed, still);
        progress.modes =
            Modes { creeping: stopping && modes.straight.is_none() && !creeping, ..modes };
        let held = progress.modes.held();
        progress.held = if self.assembly.ends_with_its_tips() {
            // As many components as coordinates: then nothing can move.
            held.as_flattened().iter().filter(|held| **held).count() == COORDINATES
        } else {
            held[0] == [true; 2]
        };
    }

    /// Covers what is left of the way at constant deceleration.
    fn come_to_rest(
        &self,
        system: &System<'_>,
        time: &mut f64,
        state: &mut State,
        progress: &mut Progress,
    ) {
        let (acceleration, _) = accelerate(system, state, &progress.modes);
        let [vx, vz, ..] = state.rate;
        let speed = libm::hypot(vx, vz);
        let deceleration = -(acceleration[0] * vx + acceleration[1] * vz) / speed;
        if speed > 0.0 && deceleration > 0.0 {
            let left = speed / deceleration;
            *time += left;
            state.time = *time;
            for index in 0..COORDINATES {
                state.position[index] += 0.5 * left * state.rate[index];
            }
        }
        // A compact body may go on turning in its place: no friction acts on its spin.
        let n_held = if self.assembly.ends_with_its_tips() { COORDINATES } else { 2 };
        state.rate[..n_held].fill(0.0);
        progress.held = true;
        self.close(*time, state, progress);
    }

    /// What comes to its end with the body itself.
    fn close(&self, time: f64, state: &State, progress: &mut Progress) {
        for index in 0..self.assembly.n_parts() {
            let tip = self.assembly.part(index, state).tip;
            let stop = &mut progress.parts[index];
            stop.depth = stop.depth.max(if stop.time().is_none() { -tip.z } else { 0.0 });
            stop.vertical = stop.vertical.or(Some(time));
            if stop.horizontal.is_none() {
                stop.horizontal = Some(time);
                stop.range = (tip.x - progress.first_x[index]).abs();
            }
        }
        progress.rest = progress.rest.or(Some(time));
        progress.slow = progress.slow.or(Some(time));
    }

    fn ending(&self, time: f64, state: &State, mut progress: Progress) -> Ending {
        let stopped = self.is_over(&progress);
        for index in 0..self.assembly.n_parts() {
            let tip = self.assembly.part(index, state).tip;
            let stop = &mut progress.parts[index];
            if stop.vertical.is_none() {
                stop.depth = stop.depth.max(-tip.z);
            }
            if stop.horizontal.is_none() {
                stop.range = (tip.x - progress.first_x[index]).abs();
            }
        }
        Ending {
            time,
            stopped,
            state: *state,
            parts: progress.parts,
            slow: progress.slow,
            rest: progress.rest,
            steps: progress.steps,
        }
    }
}
