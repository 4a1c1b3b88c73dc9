//! From a model to a bed and a simulation.

use engine::bed::{GrainKind, Settling, SizeDistribution, fill, inflate, random};
use engine::boundary::{Bottom, Container, Sides};
use engine::grain_bed::{GrainBed, RestingBed};
use engine::grain_force::GrainForce;
use engine::grains::Grain;
use engine::math::Vec3;
use engine::simulation::{Settings, Simulation};
use engine::stage::ContactStage;
use rand::Rng;
use thiserror::Error;

use crate::absorbing;
use crate::model::{
    self, BedSource, BottomKind, Condition, GrainForceChoice, GrainModel, LawChoice, Settle,
    SidesKind, StartX,
};
use crate::stability;

/// Why a model that reads well cannot be built.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum BuildError {
    #[error("the law `{law}` has no collision time of its own: give the time step in seconds")]
    NoTimeStep { law: &'static str },
    #[error("{count} grains are more than the {} this version can number", u32::MAX)]
    TooManyGrains { count: u64 },
    #[error("a bed that settles needs gravity: give medium.gravity, or a bed from a table")]
    NoGravity,
    #[error("an intruder that starts at x = {x} m touches a side of the container, {width} m wide")]
    StartTouchesSide {
        /// (m).
        x: f64,
        /// (m).
        width: f64,
    },
    #[error(
        "an intruder that starts at x = {x} m, y = {y} m touches the container, {diameter} m across"
    )]
    StartTouchesCylinder {
        /// (m).
        x: f64,
        /// (m).
        y: f64,
        /// (m).
        diameter: f64,
    },
    #[error("an intruder that starts at y = {y} m touches the container, {depth} m deep")]
    StartTouchesFront {
        /// (m).
        y: f64,
        /// (m).
        depth: f64,
    },
}

impl GrainModel<'_> {
    /// The container.
    pub fn container(&self) -> Container {
        let of_file = &self.medium.container;
        let plain = of_file.without_layers();
        let layer = || absorbing::layer(*self);
        Container {
            sides: match of_file.sides {
                SidesKind::Absorbing => Sides::Absorbing(layer()),
                SidesKind::Wall | SidesKind::Periodic => plain.sides,
            },
            bottom: match of_file.bottom {
                BottomKind::Absorbing => Bottom::Absorbing(layer()),
                BottomKind::Wall => plain.bottom,
            },
            ..plain
        }
    }

    fn gravity(&self) -> Vec3 {
        Vec3::new(0.0, 0.0, -self.medium.gravity)
    }

    /// The step of a run (s).
    ///
    /// # Errors
    /// If it is automatic and the law does not decide it.
    pub fn time_step(&self) -> Result<f64, BuildError> {
        stability::time_step(*self)
            .ok_or(BuildError::NoTimeStep { law: self.medium.contact_law.entry.name })
    }

    /// The contact law and the effects.
    pub fn stages(&self) -> Vec<Box<dyn ContactStage>> {
        std::iter::once(&self.medium.contact_law)
            .chain(&self.medium.effects)
            .map(LawChoice::build)
            .collect()
    }

    /// The recipe of a bed that has to settle, at its start; none for a bed that is read.
    ///
    /// # Errors
    /// If there are too many grains, or no time step.
    pub fn settling(&self) -> Result<Option<Settling>, BuildError> {
        let BedSource::Settle(settle) = &self.medium.bed.source else { return Ok(None) };
        if self.medium.gravity <= 0.0 {
            return Err(BuildError::NoGravity);
        }
        if self.n_grains() > u64::from(u32::MAX) {
            return Err(BuildError::TooManyGrains { count: self.n_grains() });
        }
        let steps = stability::preparation_steps(*self)
            .ok_or(BuildError::NoTimeStep { law: self.medium.contact_law.entry.name })?;
        let mut rng = random(self.model.run.seed, "sizes");
        let kinds: Vec<GrainKind> =
            settle.grains.iter().flat_map(|kind| self.drawn(kind, &mut rng)).collect();
        // Layers that absorb would hold the falling grains up for seconds.
        let container = self.medium.container.without_layers();
        let space = self.medium.space;
        let (place, seed) = ((space, &container), self.model.run.seed);
        let grains = match settle.inflated_to {
            Some(fraction) => inflate(&kinds, place, fraction, seed),
            None => fill(&kinds, place, seed),
        };
        let stages = self.preparation_stages(settle);
        let settling =
            Settling::new(&grains, (space, container), self.gravity(), stages, steps.settling)
                .falling_by(steps.falling)
                .dragged_by(settle.settling_drag);
        Ok(Some(match self.medium.bed.target_packing_fraction {
            Some(target) => settling.tapped_to(target),
            None => settling,
        }))
    }

    /// The grains of `kind`: at once where all are equal, else one by one.
    fn drawn(&self, kind: &model::GrainKind, rng: &mut impl Rng) -> Vec<GrainKind> {
        let of = |count: usize, diameter: f64| GrainKind {
            count,
            radius: 0.5 * diameter,
            mass: kind.mass(self.medium.space, diameter),
        };
        let count = kind.count as usize;
        match &kind.sizes {
            SizeDistribution::Equal(diameter) => vec![of(count, *diameter)],
            sizes => (0..count).map(|_| of(1, sizes.draw(rng))).collect(),
        }
    }

    /// The laws while the bed settles: the contact law with the friction of the preparation between
    /// grains and at walls, and the effects of the bed, not those of the run.
    fn preparation_stages(&self, settle: &Settle) -> Vec<Box<dyn ContactStage>> {
        let mut law = self.medium.contact_law.clone();
        if let Some(friction) = settle.preparation_friction {
            for key in ["friction", "wall_friction"] {
                if law.entry.params.iter().any(|spec| spec.key == key) {
                    law.params.set(key, friction);
                }
            }
        }
        std::iter::once(&law).chain(&settle.effects).map(LawChoice::build).collect()
    }

    /// The bed that a table of grains describes; none for one that has to settle.
    pub fn read_bed(&self) -> Option<RestingBed> {
        let BedSource::Csv(csv) = &self.medium.bed.source else { return None };
        let grains: Vec<Grain> = (0..)
            .zip(csv.grains.iter())
            .map(|(id, grain)| Grain {
                position: Vec3::new(grain.x, grain.y, grain.z),
                velocity: Vec3::zeros(),
                spin: Vec3::zeros(),
                radius: grain.radius,
                mass: grain.mass,
                id,
            })
            .collect();
        Some(RestingBed::without_history(self.medium.space, grains))
    }

    /// `resting` in the container under the laws and the forces on grains of the run, ready for the intruder.
    pub fn bed(&self, resting: &RestingBed) -> GrainBed {
        let forces = self.medium.grain_forces.iter();
        GrainBed::new(resting, self.container(), self.gravity(), self.stages(), self.n_bodies())
            .with_forces(forces.map(GrainForceChoice::build))
            .with_grain_inertia(self.medium.inertia_coefficient())
    }

    /// The impact `condition` on the bed `resting`.
    ///
    /// # Errors
    /// If there is no time step, or the intruder would start inside a wall.
    pub fn simulation(
        &self,
        resting: &RestingBed,
        condition: &Condition,
    ) -> Result<Simulation, BuildError> {
        let bed = self.bed(resting);
        let intruder = self.launched_intruder(&bed, condition)?;
        let settings = Settings {
            dt: self.time_step()?,
            duration: self.model.time(condition),
            abort_above: self.model.energy.abort_above,
        };
        Ok(Simulation::new(bed, intruder, settings))
    }

    /// Where the centre of the intruder starts (m).
    pub fn start_x(&self, condition: &Condition) -> f64 {
        match condition.x {
            StartX::At(x) => x,
            StartX::Drawn => {
                use rand::RngExt;
                let (from, to) = self.medium.start.x_range;
                let purpose = format!("position {}", condition.position_index);
                from + (to - from) * random(self.model.run.seed, &purpose).random::<f64>()
            }
        }
    }
}

impl GrainForceChoice {
    pub(crate) fn build(&self) -> Box<dyn GrainForce> {
        (self.entry.build)(&self.params)
    }

    /// Whether it is that of a fluid, which acts on the intruder too.
    pub fn is_of_a_fluid(&self) -> bool {
        self.build().surrounding(1.0).displaced_mass > 0.0
    }
}

impl LawChoice {
    fn build(&self) -> Box<dyn ContactStage> {
        (self.entry.build)(&self.params)
    }
}
