//! Which frictions hold an assembly: the modes that fit a state, and the accelerations under them.

use nalgebra::{SMatrix, SVector};

use super::assembly::{Assembly, COORDINATES, PARTS, PartLoad, State};
use super::modes::{AXES, Modes, Sense};
use super::motion::System;
use engine::math::Vec3;

/// Most components that friction can hold at once.
const HOLDS: usize = 2 * PARTS;

/// A holding force this much beyond its limit, in weights of the part, is within it but for round-off.
const ROUND_OFF: f64 = 1e-9;

/// Half the span of the difference that gives the acceleration of a body point (s).
const SPAN: f64 = 1e-6;

/// A component of a part that friction holds, and the force that does it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Hold {
    pub(super) part: usize,
    /// 0 horizontal, 1 vertical.
    pub(super) component: usize,
    /// (N).
    pub(super) force: f64,
}

/// The components that friction holds at one instant.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Holds {
    list: [Hold; HOLDS],
    n: usize,
}

impl Holds {
    pub(super) fn iter(&self) -> impl Iterator<Item = &Hold> {
        self.list[..self.n].iter()
    }

    fn push(&mut self, hold: Hold) {
        self.list[self.n] = hold;
        self.n += 1;
    }
}

impl Modes {
    /// The modes of `state`; `still` says which components do not move but for round-off.
    pub(super) fn at(
        system: &System<'_>,
        state: &State,
        in_bed: [bool; PARTS],
        still: [[bool; 2]; PARTS],
    ) -> Self {
        let n_parts = system.assembly.n_parts();
        let mut modes = Self {
            in_bed,
            straight: None,
            sense: [[Sense::Held; 2]; PARTS],
            gripping: false,
            creeping: false,
        };
        for (part, still) in still.iter().enumerate().take(n_parts) {
            let velocity = system.assembly.part(part, state).velocity;
            for (component, axis) in AXES.into_iter().enumerate() {
                if !still[component] {
                    modes.sense[part][component] = Sense::of(velocity[axis]);
                }
            }
        }
        modes.gripping = (0..n_parts)
            .any(|part| in_bed[part] && system.loaded(part, state, &modes).load.gripping);
        if modes.gripping {
            modes.release(system, state);
        } else if n_parts == 1 {
            modes.straight = modes.straight_line(system, state);
        }
        modes
    }

    /// Lets those held components go that friction cannot hold: the first combination of held,
    /// positive and negative in which every friction is within its limits and every component that is
    /// let go moves the way it was let go.
    fn release(&mut self, system: &System<'_>, state: &State) {
        let held: Vec<(usize, usize)> = (0..system.assembly.n_parts())
            .filter(|&part| self.in_bed[part])
            .flat_map(|part| [(part, 0), (part, 1)])
            .filter(|&(part, component)| self.sense[part][component] == Sense::Held)
            .collect();
        let choices = [Sense::Held, Sense::Positive, Sense::Negative];
        for combination in 0..choices.len().pow(held.len() as u32) {
            let mut trial = *self;
            let mut rest = combination;
            for &(part, component) in &held {
                trial.sense[part][component] = choices[rest % choices.len()];
                rest /= choices.len();
            }
            if trial.is_consistent(system, state, &held) {
                *self = trial;
                return;
            }
        }
    }

    fn is_consistent(&self, system: &System<'_>, state: &State, free: &[(usize, usize)]) -> bool {
        let (acceleration, holds) = accelerate(system, state, self);
        // Without the room for round-off that a component in hold has: one that has just used it up
        // must be let go.
        let within = holds.iter().all(|hold| self.reserve(system, state, hold) >= 0.0);
        within
            && free.iter().all(|&(part, component)| {
                let sense = self.sense[part][component];
                let rate = change(system.assembly, part, state, &acceleration)[AXES[component]];
                sense == Sense::Held || rate * sense.sign() > 0.0
            })
    }

    /// How far the force of `hold` is from the limits of its friction (N), with room for round-off;
    /// negative beyond.
    pub(super) fn slack(&self, system: &System<'_>, state: &State, hold: &Hold) -> f64 {
        let mass = system.assembly.part(hold.part, state).immersion.mass;
        self.reserve(system, state, hold) + ROUND_OFF * mass * system.bed.gravity
    }

    /// The same without that room.
    fn reserve(&self, system: &System<'_>, state: &State, hold: &Hold) -> f64 {
        let grip = system.loaded(hold.part, state, self).load.grip[hold.component];
        (grip.positive + hold.force).min(grip.negative - hold.force)
    }

    /// The line on which a single body moves as long as nothing pushes it off.
    fn straight_line(&self, system: &System<'_>, state: &State) -> Option<Vec3> {
        if system.laws.iter().any(|law| law.deflects()) {
            return None;
        }
        let part = system.assembly.part(0, state);
        let (centre, _) = system.assembly.placement(0, state);
        // A force on the centre turns nothing; a link that leans or spins leaves the line.
        let turns = system.assembly.ends_with_its_tips()
            && (centre.x - part.tip.x != 0.0 || part.spin != 0.0);
        let velocity = part.velocity;
        if turns || velocity.x != 0.0 {
            return None;
        }
        let sense = if velocity.z != 0.0 {
            velocity.z.signum()
        } else {
            let drive = drive(system, state, self);
            drive.z.signum()
        };
        Some(Vec3::new(0.0, 0.0, sense))
    }
}

/// Force on a compact body (N) that friction would have to balance to hold it.
pub(super) fn drive(system: &System<'_>, state: &State, modes: &Modes) -> Vec3 {
    let still = State { rate: [0.0; COORDINATES], ..*state };
    let calm = Modes { straight: None, ..*modes };
    let loaded = system.loaded(0, &still, &calm);
    let weight = loaded.part.immersion.mass * system.bed.gravity;
    loaded.load.dynamic - Vec3::new(0.0, 0.0, weight)
}

/// Whether friction holds a compact body that has come to rest: what the frictions of the components
/// leave of the drive has to lie within that of the direction.
pub(super) fn is_held(system: &System<'_>, state: &State, modes: &Modes) -> bool {
    let load = system.loaded(0, state, modes).load;
    let drive = drive(system, state, modes);
    let mut share = 0.0;
    for (grip, axis) in load.grip.iter().zip(AXES) {
        let left = (drive[axis] - grip.positive).max(-drive[axis] - grip.negative);
        if left > 0.0 {
            share += (left / load.friction[axis]).powi(2);
        }
    }
    share <= 1.0
}

/// Accelerations of the coordinates, and what holds the held components still.
#[inline]
pub(super) fn accelerate(
    system: &System<'_>,
    state: &State,
    modes: &Modes,
) -> ([f64; COORDINATES], Holds) {
    let mut loads = [PartLoad::default(); PARTS];
    system.on_parts(state, modes, &mut loads);
    let free = system.assembly.accelerate(state, &loads, system.bed.gravity);
    if modes.gripping {
        hold(system, state, modes, (loads, free))
    } else {
        (free, Holds::default())
    }
}

/// The same where frictions hold components: `loads` alone would accelerate the coordinates by `free`.
fn hold(
    system: &System<'_>,
    state: &State,
    modes: &Modes,
    (loads, free): ([PartLoad; PARTS], [f64; COORDINATES]),
) -> ([f64; COORDINATES], Holds) {
    let gravity = system.bed.gravity;
    let mut holds = Holds::default();
    for part in (0..system.assembly.n_parts()).filter(|&part| modes.in_bed[part]) {
        for component in 0..2 {
            if modes.sense[part][component] == Sense::Held {
                holds.push(Hold { part, component, force: 0.0 });
            }
        }
    }
    if holds.n == 0 {
        return (free, holds);
    }
    if system.assembly.moves_as_a_point() {
        let mut acceleration = free;
        for hold in holds.list.iter_mut().take(holds.n) {
            let mass = system.assembly.part(0, state).immersion.mass + loads[0].added_mass;
            hold.force = -mass * free[hold.component];
            acceleration[hold.component] = 0.0;
        }
        return (acceleration, holds);
    }
    // Unknown forces on the held components make their accelerations vanish: a small linear system.
    let mut matrix = SMatrix::<f64, HOLDS, HOLDS>::identity();
    let mut right = SVector::<f64, HOLDS>::zeros();
    let mut responses = [[0.0; COORDINATES]; HOLDS];
    for (column, hold) in holds.iter().enumerate() {
        let mut loads = loads;
        loads[hold.part].force[AXES[hold.component]] += 1.0;
        let pushed = system.assembly.accelerate(state, &loads, gravity);
        for (response, (with, without)) in
            responses[column].iter_mut().zip(pushed.into_iter().zip(free))
        {
            *response = with - without;
        }
    }
    let still = State { rate: [0.0; COORDINATES], ..*state };
    for (row, hold) in holds.iter().enumerate() {
        let axis = AXES[hold.component];
        right[row] = -change(system.assembly, hold.part, state, &free)[axis];
        for (column, response) in responses.iter().enumerate().take(holds.n) {
            matrix[(row, column)] = change(system.assembly, hold.part, &still, response)[axis];
        }
    }
    let Some(forces) = matrix.lu().solve(&right) else { return (free, holds) };
    let mut acceleration = free;
    for (index, hold) in holds.list.iter_mut().enumerate().take(holds.n) {
        hold.force = forces[index];
        for (total, response) in acceleration.iter_mut().zip(responses[index]) {
            *total += response * forces[index];
        }
    }
    (acceleration, holds)
}

/// Rate at which the velocity of the point of application of `part` changes (m/s²): the point moves
/// through the body as the body sinks, so this is more than the acceleration of a point of the body.
fn change(
    assembly: &dyn Assembly,
    part: usize,
    state: &State,
    acceleration: &[f64; COORDINATES],
) -> Vec3 {
    if assembly.moves_as_a_point() {
        return Vec3::new(acceleration[0], 0.0, acceleration[1]);
    }
    let at = |time: f64| {
        let mut moved = *state;
        for (index, acceleration) in acceleration.iter().enumerate() {
            moved.position[index] += time * state.rate[index];
            moved.rate[index] += time * acceleration;
        }
        assembly.part(part, &moved).velocity
    };
    (at(SPAN) - at(-SPAN)) / (2.0 * SPAN)
}
