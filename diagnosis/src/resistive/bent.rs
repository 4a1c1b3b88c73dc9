//! An effect of another form than its formula: its strength changes with depth and with speed.

use crate::forward::Bend;
use engine::math::Vec3;
use resistive::{Account, Immersion, Load, Motion, ResistanceLaw, Surroundings};

/// A law whose contribution is multiplied by what depends on depth and speed.
pub(super) struct Bent {
    pub(super) law: Box<dyn ResistanceLaw>,
    /// The relative change: from the surface to [`Self::reach`] and from rest to [`Self::speed`].
    pub(super) by: Bend,
    /// (m).
    pub(super) reach: f64,
    /// (m/s).
    pub(super) speed: f64,
}

impl Bent {
    fn factor(&self, depth: f64, speed: f64) -> f64 {
        self.by.factor(depth / self.reach, speed.abs() / self.speed)
    }

    fn bend(&self, at: &Immersion, motion: &Motion, load: &mut Load, act: impl Fn(&mut Load)) {
        let before = *load;
        act(load);
        // Of its three ways to act a law has mostly one.
        if *load == before {
            return;
        }
        let factor = self.factor(at.depth, motion.speed);
        let scale = |before: f64, after: f64| before + factor * (after - before);
        let both = |before: Vec3, after: Vec3| before + (after - before) * factor;
        load.dynamic = both(before.dynamic, load.dynamic);
        load.friction = both(before.friction, load.friction);
        for (grip, before) in load.grip.iter_mut().zip(before.grip) {
            grip.positive = scale(before.positive, grip.positive);
            grip.negative = scale(before.negative, grip.negative);
        }
        load.couple = scale(before.couple, load.couple);
        let moving = load.added_mass - before.added_mass;
        load.added_mass = scale(before.added_mass, load.added_mass);
        load.growth = scale(before.growth, load.growth);
        load.recruitment = scale(before.recruitment, load.recruitment);
        // A mass that is larger deeper comes in on the way down, from rest.
        let growth = self.by.growth(at.depth / self.reach, motion.speed.abs() / self.speed);
        let more = moving * growth / self.reach * -motion.velocity.z;
        load.growth += more;
        load.recruitment += more;
    }
}

impl ResistanceLaw for Bent {
    fn accounts(&self) -> &'static [Account] {
        self.law.accounts()
    }

    fn expose(&self, at: &mut Immersion, motion: &Motion, bed: &Surroundings) {
        let before = *at;
        self.law.expose(at, motion, bed);
        if *at == before {
            return;
        }
        let factor = self.factor(at.depth, motion.speed);
        let scale = |before: f64, after: &mut f64| *after = before + factor * (*after - before);
        scale(before.effective_depth, &mut at.effective_depth);
        scale(before.loaded_area, &mut at.loaded_area);
        scale(before.drag_factor, &mut at.drag_factor);
        scale(before.friction_factor, &mut at.friction_factor);
        scale(before.sideways_drag, &mut at.sideways_drag);
        scale(before.sideways_friction, &mut at.sideways_friction);
    }

    fn act(&self, at: &Immersion, motion: &Motion, bed: &Surroundings, load: &mut Load) {
        self.bend(at, motion, load, |load| self.law.act(at, motion, bed, load));
    }

    fn act_everywhere(&self, at: &Immersion, motion: &Motion, bed: &Surroundings, load: &mut Load) {
        self.bend(at, motion, load, |load| self.law.act_everywhere(at, motion, bed, load));
    }

    fn modulate(&self, at: &Immersion, motion: &Motion, load: &mut Load) {
        self.bend(at, motion, load, |load| self.law.modulate(at, motion, load));
    }

    fn deflects(&self) -> bool {
        self.law.deflects()
    }

    fn read(&self, depth: &mut f64, range: &mut f64) {
        let before = (*depth, *range);
        self.law.read(depth, range);
        let factor = self.factor(before.0, 0.5 * self.speed);
        *depth = before.0 + factor * (*depth - before.0);
        *range = before.1 + factor * (*range - before.1);
    }
}
