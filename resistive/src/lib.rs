//! Impacts on a medium that is a force law and no grains: an ordinary differential equation.
//!
//! A [`ResistanceLaw`] says what the medium does to an immersed part; laws add up. An [`Assembly`] is
//! what falls: one part, or several on a joint. [`impact`] integrates it to rest, with the surface,
//! reversals and rest found as events between steps. The frame is the world's: z up, the motion in
//! the x–z plane, depth counted downward from the undisturbed surface at z = 0.

pub mod assembly;
mod driven;
mod error;
mod felt;
mod fluid;
pub mod formula;
mod holding;
pub mod impact;
mod laws;
mod modes;
mod motion;
mod observe;
mod record;
pub mod silhouette;
mod solver;

use engine::fluid::Fluid;
use engine::ledger::Channel;
use engine::math::Vec3;

pub use assembly::{Assembly, Compact, Part, PartLoad, State};
pub use driven::Driven;
pub use error::ImpactError;
pub use felt::Accelerometer;
pub use impact::{Effort, Ending, Impact, PartStop};
pub use laws::{
    Acts, Approach, Coefficients, Confounder, Direction, Draft, Effect, Expression, Facts,
    ForceError, Kind, Needs, OtherForm, OwnEffect, OwnEffectError, OwnParameter, RESISTANCE_LAWS,
    ResistanceEntry, Role, STATE_VARIABLES, StateVariable, confounders, find_resistance,
};
pub use observe::{Observer, SolverStep, Trajectory};
pub use record::{PartSample, Recorder, Sample};
pub use silhouette::{Silhouette, Space};
pub use solver::Tolerance;

/// What laws are told of the medium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surroundings {
    /// Bulk density (kg/m³, planar kg/m²).
    pub bulk_density: f64,
    /// Magnitude of gravity (m/s²).
    pub gravity: f64,
    /// Packing fraction, where it is known.
    pub packing: Option<f64>,
    /// Depth of the bed (m), where it is known.
    pub bed_depth: Option<f64>,
    /// The fluid in the bed and above it; `None` where it is air.
    pub fluid: Option<Fluid>,
}

/// How far a part is in the medium, and what of it the medium feels.
///
/// The second half starts as the geometry says and is what laws may change before any force is found
/// ([`ResistanceLaw::expose`]).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Immersion {
    /// Depth of the lowest point below the undisturbed surface (m); negative above it.
    pub depth: f64,
    /// Diameter of the part (m).
    pub diameter: f64,
    /// Area that the whole part shows along its axis (m², planar m): πD²/4, or D.
    pub frontal_area: f64,
    /// The same of the immersed portion alone.
    pub immersed_area: f64,
    /// Area of the immersed part that faces the motion (m², planar m): of a compact body
    /// [`Self::frontal_area`], of a link what its direction of motion sees.
    pub reference_area: f64,
    /// Area of an end that faces the motion (m²), where the body is a link; else zero.
    pub end_area: f64,
    /// Immersed volume (m³, planar m²).
    pub volume: f64,
    /// Rate of the immersed volume with depth (m², planar m).
    pub section: f64,
    /// Rate at which the immersed volume grows now (m³/s, planar m²/s); of a body that turns, more or
    /// less than the section times its speed.
    pub volume_rate: f64,
    /// Volume of the body, immersed or not, without a shaft (m³, planar m²).
    pub body_volume: f64,
    /// Mass of the body (kg).
    pub mass: f64,

    /// Depth that friction feels (m).
    pub effective_depth: f64,
    /// Area that drag and friction act on (m², planar m).
    pub loaded_area: f64,
    /// Factor on drag.
    pub drag_factor: f64,
    /// Factor on friction.
    pub friction_factor: f64,
    /// Further factor on the horizontal component of drag.
    pub sideways_drag: f64,
    /// Further factor on the horizontal component of friction.
    pub sideways_friction: f64,
}

/// How a part moves: the velocity of its point of application.
///
/// Near a reversal the signs are held while a step is taken, so that forces stay smooth and the
/// reversal can be located: laws take speed, direction and sense from here and never from the velocity
/// again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// (m/s).
    pub velocity: Vec3,
    /// Component of the velocity along [`Self::direction`] (m/s).
    pub speed: f64,
    /// Unit vector of the motion; zero at rest.
    pub direction: Vec3,
    /// Sign of the horizontal and the vertical component: ±1, or 0 while it is held.
    pub sense: [f64; 2],
    /// Angular velocity about y (rad/s): positive when the body rolls towards +x.
    pub spin: f64,
    /// Since the start (s).
    pub time: f64,
}

impl Motion {
    /// The sense of the horizontal motion; it changes smoothly within 3° of a vertical path, where a force across the motion
    /// has no side to act to.
    pub fn leaning(&self) -> f64 {
        /// Sine of the angle from the vertical.
        const UPRIGHT: f64 = 0.05;
        let share = (self.direction.x / UPRIGHT).clamp(-1.0, 1.0);
        0.5 * share * (3.0 - share * share)
    }
}

/// What the medium does to one part.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load {
    /// Force that varies smoothly with the velocity (N).
    pub dynamic: Vec3,
    /// Limits of a friction against the direction of motion, along x, y and z (N): the force is
    /// −limit·direction component by component, and at rest anything within the limits.
    pub friction: Vec3,
    /// Limits of frictions that hold the horizontal and the vertical component each for itself.
    pub grip: [FrictionLimits; 2],
    /// Whether there are such frictions at all.
    pub gripping: bool,
    /// Torque about y at the point of application (N m).
    pub couple: f64,
    /// Mass of the medium that moves with the part (kg).
    pub added_mass: f64,
    /// Rate at which that mass grows (kg/s).
    pub growth: f64,
    /// The part of it that is set in motion by the part (kg/s): the force is −rate·velocity.
    pub recruitment: f64,
}

impl Load {
    /// Whether every number of it is finite.
    pub(crate) fn is_finite(&self) -> bool {
        let Self { dynamic, friction, grip, couple, added_mass, growth, recruitment, .. } = self;
        let grips = grip.iter().flat_map(|grip| [grip.positive, grip.negative]);
        dynamic
            .iter()
            .chain(friction.iter())
            .chain([couple, added_mass, growth, recruitment])
            .copied()
            .chain(grips)
            .all(f64::is_finite)
    }
}

/// Limits of a friction on one component (N), both positive.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrictionLimits {
    /// Against motion in the positive direction (up, or forward).
    pub positive: f64,
    /// Against motion in the negative direction.
    pub negative: f64,
}

/// What a law books, and where that energy goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Account {
    /// Its name and kind in the ledger.
    pub channel: Channel,
    /// What flows into it.
    pub flow: Flow,
}

/// Which part of a law's load does the work of an [`Account`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flow {
    /// Work against [`Load::dynamic`] and [`Load::couple`].
    Dynamic,
    /// Work against [`Load::friction`] and [`Load::grip`].
    Static,
    /// Kinetic energy of [`Load::added_mass`], held now.
    AddedMass,
    /// What is lost in setting it in motion: the work against [`Load::recruitment`], less what [`Load::growth`] holds.
    Recruitment,
}

/// A term of the force of the medium, or something that changes the terms.
pub trait ResistanceLaw: Send + Sync {
    /// What it books: at most one account per flow, none by default.
    fn accounts(&self) -> &'static [Account] {
        &[]
    }

    /// What its accounts are called in the ledger where that is not known in advance: a law that a model
    /// file defines. kebab-case, and unlike every other account.
    fn own_name(&self) -> Option<&str> {
        None
    }

    /// Changes what the terms of all laws see of a part that is in the medium.
    fn expose(&self, _at: &mut Immersion, _motion: &Motion, _bed: &Surroundings) {}

    /// Adds what it does to a part that is in the medium.
    fn act(&self, _at: &Immersion, _motion: &Motion, _bed: &Surroundings, _load: &mut Load) {}

    /// Adds what it does everywhere, in the medium and above.
    fn act_everywhere(&self, _at: &Immersion, _motion: &Motion, _: &Surroundings, _: &mut Load) {}

    /// Changes the sum of all terms, after them.
    fn modulate(&self, _at: &Immersion, _motion: &Motion, _load: &mut Load) {}

    /// Changes what is read of a position: the depth of the lowest point and the distance along the
    /// motion (m). A fault of the instrument; the motion itself knows nothing of it.
    fn read(&self, _depth: &mut f64, _range: &mut f64) {}

    /// Whether its friction holds each component of the motion by itself: a body then stops with the later of the two.
    fn holds_components(&self) -> bool {
        false
    }

    /// Whether a body that falls straight down can be pushed out of line by it.
    fn deflects(&self) -> bool {
        false
    }
}
