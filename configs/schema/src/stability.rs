//! How fast contacts can change, and the time step that follows from it.

use engine::contact::{Encounter, Partner};
use engine::grain_force::MovingGrain;
use engine::math::Vec3;
use engine::stage::ContactStage;

use crate::absorbing;
use crate::guess::guessed_packing;
use crate::model::{BedSource, GrainModel, LawChoice, TimeStep};

/// Steps per shortest collision when `time_step = "auto"`.
pub(crate) const STEPS_PER_COLLISION: f64 = 30.0;
/// Steps per shortest relaxation by damping when `time_step = "auto"`. Half as many and a bed of
/// many contacts per grain never comes to rest: each contact's damping overshoots.
pub(crate) const STEPS_PER_DAMPING_TIME: f64 = 4.0;
/// Steps per shortest surface wave when `time_step = "auto"`, a fifth of the Rayleigh time as is usual.
pub(crate) const STEPS_PER_WAVE: f64 = 5.0;
/// Fewer steps per relaxation than this are refused.
pub(crate) const FEWEST_STEPS_PER_DAMPING_TIME: f64 = 1.0;
/// Fewer steps per relaxation than this are accepted with a warning.
pub(crate) const FEW_STEPS_PER_DAMPING_TIME: f64 = 3.0;
/// Fewer steps per collision than this are refused.
pub(crate) const FEWEST_STEPS_PER_COLLISION: f64 = 10.0;
/// Fewer steps per collision than this are accepted with a warning.
pub(crate) const FEW_STEPS_PER_COLLISION: f64 = 20.0;

/// Automatic step of falling grains over that of a run: half as many steps per collision and per
/// relaxation still bring them down to the same packing.
const FALLING_STEP: f64 = 2.0;

/// Slowest approach (m/s) that a step is chosen for: without it nothing that starts at rest in no
/// gravity would have a collision time.
const SLOWEST_APPROACH: f64 = 1e-3;

/// How long (s) the quickest things last that a step has to resolve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Times {
    /// The shortest collision, without damping; `None` if no law decides it.
    pub collision: Option<f64>,
    /// The shortest relaxation by damping, if there is damping.
    pub damping: Option<f64>,
    /// The shortest surface wave through a grain, if the grains have elastic constants.
    pub wave: Option<f64>,
}

/// What decides an automatic step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decisive {
    /// The shortest collision.
    Collision,
    /// The shortest relaxation by damping.
    Damping,
    /// The shortest surface wave.
    Wave,
}

impl Decisive {
    /// What it is, as a reader is told.
    #[must_use]
    pub fn describe(self) -> &'static str {
        match self {
            Self::Collision => "the shortest collision",
            Self::Damping => "the damping of a contact",
            Self::Wave => "the Rayleigh wave",
        }
    }
}

impl Times {
    /// The automatic step (s) and what decides it; `None` without a collision time.
    pub fn step(&self) -> Option<(f64, Decisive)> {
        let collision = (self.collision? / STEPS_PER_COLLISION, Decisive::Collision);
        let damping = self.damping.map(|time| (time / STEPS_PER_DAMPING_TIME, Decisive::Damping));
        let wave = self.wave.map(|time| (time / STEPS_PER_WAVE, Decisive::Wave));
        let others = damping.into_iter().chain(wave);
        Some(others.fold(collision, |least, one| if one.0 < least.0 { one } else { least }))
    }
}

/// The lightest grain, which of grains of one material is the quickest to collide.
#[derive(Clone, Copy)]
struct Lightest {
    radius: f64,
    mass: f64,
}

impl Lightest {
    fn of(model: GrainModel<'_>) -> Self {
        let lighter = |one: Self, other: Self| if other.mass < one.mass { other } else { one };
        let none = Self { radius: 0.0, mass: f64::INFINITY };
        match &model.medium.bed.source {
            BedSource::Settle(settle) => settle
                .grains
                .iter()
                .filter(|kind| kind.count > 0)
                .map(|kind| {
                    let diameter = kind.sizes.smallest();
                    let mass = kind.mass(model.medium.space, diameter);
                    Self { radius: 0.5 * diameter, mass }
                })
                .fold(none, lighter),
            BedSource::Csv(csv) => csv
                .grains
                .iter()
                .map(|grain| Self { radius: grain.radius, mass: grain.mass })
                .fold(none, lighter),
        }
    }

    /// kg/m³ of the sphere of this radius.
    fn density(self) -> f64 {
        0.75 * self.mass / (std::f64::consts::PI * self.radius.powi(3))
    }
}

/// How fast (m/s) a grain hits the bottom that falls through the height of the bed.
fn fall_speed(model: GrainModel<'_>) -> f64 {
    let bed = &model.medium.bed;
    let height = bed.target_height.unwrap_or_else(|| match &bed.source {
        BedSource::Settle(settle) => {
            let space = model.medium.space;
            let contents = settle.grains.iter().map(|kind| kind.count as f64 * kind.content(space));
            let base = model.medium.container.without_layers().base_area(space);
            contents.sum::<f64>() / (guessed_packing(space) * base)
        }
        BedSource::Csv(csv) => {
            csv.grains.iter().fold(0.0, |height: f64, grain| height.max(grain.z + grain.radius))
        }
    });
    (2.0 * model.medium.gravity * height).sqrt().max(SLOWEST_APPROACH)
}

/// Laws, and the quickest encounters that happen under them.
struct Scene {
    stages: Vec<Box<dyn ContactStage>>,
    lightest: Lightest,
    encounters: Vec<(Partner, Encounter)>,
}

impl Scene {
    fn new<'a>(
        model: GrainModel<'a>,
        effects: impl IntoIterator<Item = &'a LawChoice>,
        speed: f64,
    ) -> Self {
        let lightest = Lightest::of(model);
        let Lightest { radius, mass } = lightest;
        let pair = Encounter { mass_eff: 0.5 * mass, radius_eff: 0.5 * radius, speed };
        let wall = Encounter { mass_eff: mass, radius_eff: radius, speed };
        let laws = std::iter::once(&model.medium.contact_law).chain(effects);
        Self {
            stages: laws.map(|law| (law.entry.build)(&law.params)).collect(),
            lightest,
            encounters: vec![(Partner::Grain, pair), (Partner::Wall, wall)],
        }
    }

    fn of_run(model: GrainModel<'_>) -> Self {
        let impacts = model.model.conditions();
        let speed = impacts.iter().fold(fall_speed(model), |speed, one| speed.max(one.speed));
        let mut scene = Self::new(model, &model.medium.effects, speed);
        let Lightest { radius, mass } = scene.lightest;
        // Written so that a tiny mass cannot underflow in a product. Against a face of the intruder the
        // contact is as stiff as it gets.
        let mass_eff = mass / (1.0 + mass / model.model.intruder.mass);
        let encounter = Encounter { mass_eff, radius_eff: radius, speed };
        scene.encounters.push((Partner::Intruder, encounter));
        scene
    }

    fn of_preparation(model: GrainModel<'_>, speed: f64) -> Self {
        let effects: &[LawChoice] = match &model.medium.bed.source {
            BedSource::Settle(settle) => &settle.effects,
            BedSource::Csv(_) => &[],
        };
        Self::new(model, effects, speed)
    }

    fn times(&self) -> Times {
        let Lightest { radius, .. } = self.lightest;
        let density = self.lightest.density();
        Times {
            collision: self.least(|stage, partner, met| stage.collision_time(partner, met)),
            damping: self.least(|stage, partner, met| stage.damping_time(partner, met)),
            wave: self.least(|stage, _, _| stage.wave_time(Partner::Grain, radius, density)),
        }
    }

    fn least(
        &self,
        time: impl Fn(&dyn ContactStage, Partner, &Encounter) -> Option<f64>,
    ) -> Option<f64> {
        let each = self.stages.iter().flat_map(|stage| {
            self.encounters.iter().filter_map(|(partner, met)| time(&**stage, *partner, met))
        });
        each.reduce(f64::min)
    }
}

/// The times of the run, the intruder's collisions included.
///
/// Collisions are as fast as the fastest impact, or as a fall through the height of the bed. The drag of a
/// layer that absorbs is damping too; in a corner that of three layers adds up, which a step that is a
/// quarter of one layer's time still bears. So are forces that brake single grains.
pub fn times(model: GrainModel<'_>) -> Times {
    let scene = Scene::of_run(model);
    let mut times = scene.times();
    let layers = absorbing::largest_rate(model).map(|rate| 1.0 / rate);
    let Lightest { radius, mass } = scene.lightest;
    let velocity = Vec3::x() * scene.encounters[0].1.speed;
    let weight = mass * model.medium.gravity;
    let fastest = MovingGrain { velocity, spin: Vec3::zeros(), radius, mass, weight };
    let forces = model.medium.grain_forces.iter().map(|choice| choice.build());
    let forces =
        forces.map(|force| force.relaxation_time(&fastest)).filter(|time| time.is_finite());
    times.damping = layers.into_iter().chain(forces).chain(times.damping).reduce(f64::min);
    times
}

/// The times while the bed settles: the grains fall through about its height.
pub(crate) fn preparation_times(model: GrainModel<'_>) -> Times {
    Scene::of_preparation(model, fall_speed(model)).times()
}

/// The step of the run, its factor included (s); `None` when it is automatic and the law has no
/// collision time.
pub fn time_step(model: GrainModel<'_>) -> Option<f64> {
    let step = match model.medium.stepping.time_step {
        TimeStep::Fixed(step) => step,
        TimeStep::Auto => times(model).step()?.0,
    };
    Some(step * model.medium.stepping.time_step_factor)
}

/// The steps of a preparation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PreparationSteps {
    /// While the grains fall (s).
    pub falling: f64,
    /// From then on (s).
    pub settling: f64,
}

/// The steps while the bed is prepared; `None` as for [`time_step`], and for a bed from a file.
///
/// A given step holds from the start to the end. An automatic one is, until the grains have fallen,
/// twice that of a run in which everything is as fast as the fall; then that of a run at the speed
/// √(g d), which no grain exceeds that drops by half its diameter: contacts under a Hertz law
/// are the slower the less they are compressed.
pub(crate) fn preparation_steps(model: GrainModel<'_>) -> Option<PreparationSteps> {
    let BedSource::Settle(settle) = &model.medium.bed.source else {
        return None;
    };
    if let TimeStep::Fixed(step) = settle.preparation_time_step {
        return Some(PreparationSteps { falling: step, settling: step });
    }
    let falling = FALLING_STEP * preparation_times(model).step()?.0;
    let slow = (model.medium.gravity * model.largest_grain()).sqrt().max(SLOWEST_APPROACH);
    let settling = Scene::of_preparation(model, slow.min(fall_speed(model))).times().step()?.0;
    Some(PreparationSteps { falling: falling.max(settling), settling })
}
