//! The forces of the medium on the parts of an assembly, in a given mode of motion.

use super::assembly::{Assembly, PARTS, Part, PartLoad, State};
use super::error::ImpactError;
use super::modes::{AXES, Modes, Sense};
use super::{Immersion, Load, Motion, ResistanceLaw, Surroundings};
use engine::math::Vec3;

/// An assembly in a medium: everything that decides a force but the state.
pub(super) struct System<'a> {
    pub(super) assembly: &'a dyn Assembly,
    pub(super) laws: &'a [Box<dyn ResistanceLaw>],
    pub(super) bed: Surroundings,
}

/// A part with its motion and what the medium does to it.
#[derive(Clone, Copy)]
pub(super) struct Loaded {
    pub(super) part: Part,
    pub(super) motion: Motion,
    pub(super) load: Load,
}

impl Load {
    /// Force of the terms that vary smoothly with the velocity of `motion` (N).
    #[inline]
    pub(super) fn dynamic_force(&self, motion: &Motion) -> Vec3 {
        self.dynamic - motion.velocity * self.recruitment
    }

    /// Force of the frictions (N), without those that hold a component.
    #[inline]
    pub(super) fn sliding_force(&self, motion: &Motion) -> Vec3 {
        let mut force = -self.friction.component_mul(&motion.direction);
        for (axis, (grip, sense)) in [0, 2].into_iter().zip(self.grip.iter().zip(motion.sense)) {
            if sense > 0.0 {
                force[axis] -= grip.positive;
            } else if sense < 0.0 {
                force[axis] += grip.negative;
            }
        }
        force
    }

    /// Everything but the frictions that hold.
    #[inline]
    pub(super) fn on_part(&self, motion: &Motion) -> PartLoad {
        PartLoad {
            force: self.dynamic_force(motion) + self.sliding_force(motion),
            couple: self.couple,
            added_mass: self.added_mass,
        }
    }
}

impl System<'_> {
    /// Part `index` under all laws.
    #[inline]
    pub(super) fn loaded(&self, index: usize, state: &State, modes: &Modes) -> Loaded {
        self.visit(index, state, modes, |_, _, _| {})
    }

    /// The same; `each` is told what every law added, as the loads before and after it.
    #[inline]
    pub(super) fn visit(
        &self,
        index: usize,
        state: &State,
        modes: &Modes,
        mut each: impl FnMut(usize, &Load, &Load),
    ) -> Loaded {
        let mut part = self.assembly.part(index, state);
        let motion = motion(&part, index, modes, state.time);
        let mut load = Load::default();
        self.act((&mut part.immersion, &motion), index, modes, &mut load, &mut each);
        Loaded { part, motion, load }
    }

    /// Adds to `load` what all laws do to part `index`.
    #[inline]
    fn act(
        &self,
        (immersion, motion): (&mut Immersion, &Motion),
        index: usize,
        modes: &Modes,
        load: &mut Load,
        each: &mut impl FnMut(usize, &Load, &Load),
    ) {
        let inside = modes.in_bed[index];
        if inside {
            for law in self.laws {
                law.expose(immersion, motion, &self.bed);
            }
        }
        for (number, law) in self.laws.iter().enumerate() {
            let before = *load;
            if inside {
                law.act(immersion, motion, &self.bed, load);
            }
            law.act_everywhere(immersion, motion, &self.bed, load);
            each(number, &before, load);
        }
        if inside {
            for (number, law) in self.laws.iter().enumerate() {
                let before = *load;
                law.modulate(immersion, motion, load);
                each(number, &before, load);
            }
        }
        if modes.gripping {
            hold_along(load, modes.sense[index]);
        }
    }

    /// What all laws do to all parts, written to `loads`; nothing acts on parts that an assembly does not have.
    #[inline]
    pub(super) fn on_parts(&self, state: &State, modes: &Modes, loads: &mut [PartLoad; PARTS]) {
        for (index, on_part) in loads.iter_mut().enumerate().take(self.assembly.n_parts()) {
            // In the innermost loop of all, nothing of this size may be moved once it is made.
            let mut part = self.assembly.part(index, state);
            let motion = motion(&part, index, modes, state.time);
            let mut load = Load::default();
            self.act((&mut part.immersion, &motion), index, modes, &mut load, &mut |_, _, _| {});
            *on_part = load.on_part(&motion);
        }
    }

    /// Why there is no step after `time` (s): the law that has no value in the state `fault`, if it is
    /// one.
    pub(super) fn broken(&self, fault: Option<State>, modes: &Modes, time: f64) -> ImpactError {
        let Some(state) = fault else { return ImpactError::Stalled { time } };
        for index in 0..self.assembly.n_parts() {
            let mut culprit = None;
            let Loaded { part, .. } = self.visit(index, &state, modes, |number, _, after| {
                if culprit.is_none() && !after.is_finite() {
                    culprit = Some(number);
                }
            });
            if let Some(law) = culprit.map(|number| &self.laws[number]) {
                let account = law.accounts().first().map_or("", |account| account.channel.name);
                return ImpactError::NotFinite {
                    law: law.own_name().unwrap_or(account).to_owned(),
                    depth: part.immersion.depth,
                    speed: part.velocity.norm(),
                    time: state.time,
                };
            }
        }
        ImpactError::Stalled { time }
    }
}

/// A friction against the direction of motion, beside frictions that hold each component for itself:
/// where one component is held it acts on the other alone, and where both are it helps to hold both.
fn hold_along(load: &mut Load, senses: [Sense; 2]) {
    let held = senses.map(|sense| sense == Sense::Held);
    if held == [false; 2] {
        return;
    }
    let friction = std::mem::replace(&mut load.friction, Vec3::zeros());
    for (component, axis) in AXES.into_iter().enumerate() {
        if held == [true; 2] || !held[component] {
            load.grip[component].positive += friction[axis];
            load.grip[component].negative += friction[axis];
        }
    }
}

/// How a part moves at `time` (s), with the signs that `modes` hold.
#[inline]
fn motion(part: &Part, index: usize, modes: &Modes, time: f64) -> Motion {
    let velocity = part.velocity;
    let (speed, direction) = match modes.straight {
        Some(direction) => (velocity.dot(&direction), direction),
        None => {
            let speed = velocity.norm();
            (speed, if speed > 0.0 { velocity / speed } else { Vec3::zeros() })
        }
    };
    let sense = modes.sense[index].map(Sense::sign);
    Motion { velocity, speed, direction, sense, spin: part.spin, time }
}
