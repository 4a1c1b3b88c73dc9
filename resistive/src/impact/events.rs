//! What can happen to an impact within a step, and when.

use super::super::holding::accelerate;
use super::super::modes::{AXES, Modes};
use super::super::motion::System;
use super::super::solver::Solver;
use super::margin::{
    Before, COMPONENTS, FORWARD, Fired, Margins, N_MARGINS, PER_PART, SINKING, SLOW, SLOWING,
    STOPPING, SURFACE,
};
use super::{Impact, Progress, State};
use engine::math::Vec3;
use engine::stopping::REST_SPEED;

/// A body on a curved path whose speed falls below a share of √(gD) is asked whether friction holds it; what is left of
/// its way is covered at constant deceleration. That way goes with the square of the speed, so this is the square of the
/// share over the relative tolerance: some 1e-10 m are left at a tolerance of 1e-11.
const ALMOST_REST: f64 = 1e3;

/// Events this near to each other are one (s).
const SIMULTANEOUS: f64 = 1e-12;

/// How often a step is halved to see what happens right after its start: down to 1e-12 of it.
const HALVINGS: usize = 40;

impl Impact {
    /// Quantities that stay positive until something happens; infinite where it cannot.
    pub(super) fn margins(
        &self,
        system: &System<'_>,
        state: &State,
        progress: &Progress,
    ) -> Margins {
        let mut margins = [f64::INFINITY; N_MARGINS];
        let modes = &progress.modes;
        let first = self.assembly.part(0, state);
        let speed = speed_along(&first.velocity, modes);
        for index in 0..self.assembly.n_parts() {
            let part = if index == 0 { first } else { self.assembly.part(index, state) };
            let (own, stop) =
                (&mut margins[PER_PART * index..][..PER_PART], &progress.parts[index]);
            let depth = part.immersion.depth;
            own[SURFACE] = if modes.in_bed[index] { depth } else { -depth };
            if stop.contact.is_some() && stop.vertical.is_none() {
                own[SINKING] = -part.tip_velocity.z;
            }
            if stop.horizontal.is_none() {
                own[FORWARD] = part.tip_velocity.x * progress.forward[index];
            }
            if modes.gripping && modes.in_bed[index] {
                for (component, axis) in AXES.into_iter().enumerate() {
                    let sense = modes.sense[index][component].sign();
                    own[COMPONENTS + component] = part.velocity[axis] * sense;
                }
            }
        }
        if modes.gripping {
            let (_, holds) = accelerate(system, state, modes);
            for hold in holds.iter() {
                let slot = 5 * hold.part + COMPONENTS + hold.component;
                margins[slot] = modes.slack(system, state, hold);
            }
        }
        if self.assembly.moves_as_a_point() && modes.held()[0] == [false; 2] {
            margins[STOPPING] = match modes.straight {
                Some(direction) => first.velocity.dot(&direction),
                None => {
                    let scale = (self.bed.gravity * first.immersion.diameter).sqrt();
                    let share = (ALMOST_REST * self.tolerance.relative).sqrt();
                    let above = speed - share * scale;
                    if modes.creeping { -above } else { above }
                }
            };
        }
        let above = speed - REST_SPEED * progress.top_speed;
        margins[SLOWING] = if progress.rest.is_some() { -above } else { above };
        if progress.slow.is_none() {
            margins[SLOW] = speed - REST_SPEED * progress.start_speed;
        }
        margins
    }

    /// The margins at the end of a part of the last step of `solver`, and the first thing that happens
    /// in it.
    pub(super) fn look(
        &self,
        solver: &mut Solver<'_>,
        system: &System<'_>,
        (from, to): (f64, f64),
        before: &Before,
        progress: &Progress,
    ) -> (Margins, Option<Fired>) {
        let middle = 0.5 * (from + to);
        let after = self.margins(system, &solver.at(to), progress);
        let near_halfway = self.margins(system, &solver.near(middle), progress);
        if after.iter().chain(&near_halfway).all(|margin| *margin >= 0.0) {
            return (after, None);
        }
        let halfway = self.margins(system, &solver.at(middle), progress);
        let mut roots = [f64::INFINITY; N_MARGINS];
        for which in 0..N_MARGINS {
            let start = before.margins[which];
            // Round-off may leave a margin below zero where a stretch begins; it has not been crossed.
            let start = if before.fresh { start.max(0.0) } else { start };
            let value = |state: &State| self.margins(system, state, progress)[which];
            if start >= 0.0 && halfway[which] < 0.0 {
                let begin = above_zero(solver, (from, start), middle, value);
                roots[which] = solver.root(begin, (middle, halfway[which]), value);
            } else if halfway[which] >= 0.0 && after[which] < 0.0 {
                roots[which] = solver.root((middle, halfway[which]), (to, after[which]), value);
            }
        }
        let time = roots.iter().copied().fold(f64::INFINITY, f64::min);
        let fired = time
            .is_finite()
            .then(|| Fired { time, which: roots.map(|root| root <= time + SIMULTANEOUS) });
        (after, fired)
    }
}

/// The first time between `from` and `to` at which a margin is above zero, found by halving, and the margin at that time;
/// `from` and `start` if the margin is nowhere above zero. The margin of a released component is zero at `from`, and can
/// return to zero long before the step ends. That return is the next event.
fn above_zero(
    solver: &mut Solver<'_>,
    (from, start): (f64, f64),
    to: f64,
    value: impl Fn(&State) -> f64,
) -> (f64, f64) {
    let mut time = to;
    for _ in 0..HALVINGS {
        if start > 0.0 {
            break;
        }
        time = from + 0.5 * (time - from);
        let margin = value(&solver.at(time));
        if margin > 0.0 {
            return (time, margin);
        }
    }
    (from, start)
}

/// The speed of the first part, negative beyond a reversal: along a line, or along the component
/// that is not held, it passes through zero.
fn speed_along(velocity: &Vec3, modes: &Modes) -> f64 {
    match (modes.straight, modes.held()[0]) {
        (Some(direction), _) => velocity.dot(&direction),
        (None, [true, false]) => velocity.z * modes.sense[0][1].sign(),
        (None, [false, true]) => velocity.x * modes.sense[0][0].sign(),
        (None, _) => velocity.norm(),
    }
}
