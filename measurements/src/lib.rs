//! Measurement sets: conditions, runs and instrument of one campaign, as `measurement.toml` with its
//! tables says them.
//!
//! [`MeasurementSet::load`] reads a set, [`MeasurementSet::write`] writes one.
//!
//! - `document` is `measurement.toml`: conditions, bodies, beds, what is known beforehand;
//! - `table` reads a table of any dialect, row by row;
//! - `curves` lists what is read along one axis and is no position, each kind in a file of its own;
//! - `load` puts document and tables together;
//! - `contact` sees fall, contact and rest in the frames of a run, on any scale, and strays among them;
//! - `checks` holds what the set states against its frames;
//! - `shipped` lists the sets that come with the program, `json_schema` describes `measurement.toml` to editors.

mod checks;
mod contact;
mod contradiction;
mod curves;
mod describe;
mod document;
pub mod json_schema;
mod keys;
mod load;
mod median;
mod reading;
mod shipped;
mod table;
mod write;

use engine::fluid::Fluid;

pub use checks::agreement::Agreement;
pub use contact::Contact;
pub use contact::braking::Tip;
pub use contact::definitions::{Held, Miss, Outcome, Scalar, hold};
pub use contact::departure::Departure;
pub use contact::fall::{Fall, reading_noise};
pub use contact::level::{Levels, levels, misfit_of_one_level};
pub use contact::strays::{Cleaned, stray_frames, without_strays};
pub use contact::zeros::{Offset, RunContact, Severity, SpeedRatio, Zero, Zeros};
pub use contradiction::{Contradiction, ContradictionKind};
pub use curves::curve::{Along, Axis, Curve};
pub use curves::curves;
pub use document::bodies::{POSSIBLE_DENSITY, USUAL_DENSITY};
pub use document::feasible::{Cost, Feasible};
pub use document::priors::ParameterPrior;
pub use document::sizes::SizeError;
pub use document::template::TEMPLATE;
pub use load::trajectories::MOST_READINGS;
pub use load::{Loaded, SetError};
pub use median::{deviation_of, median};
pub use reading::Reading;
pub use shipped::{SHIPPED_SETS, ShippedSet, find as find_shipped_set};
pub use write::WriteError;

/// Measurements of impacts under one or more conditions.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasurementSet {
    /// Its name, as in reports and folders.
    pub id: String,
    /// Where the numbers are from.
    pub source: Option<String>,
    /// What was measured.
    pub kind: Kind,
    /// What is known of the instrument.
    pub instrument: Instrument,
    /// What the intruder fell into; of several beds the first.
    pub bed: Bed,
    /// The beds of a set of several; empty in a set of one.
    pub beds: Vec<NamedBed>,
    /// The model that the set starts from: a shipped name, or a path beside the set.
    pub baseline: Option<String>,
    /// Stated relative errors, for where there are no repeats.
    pub stated: StatedError,
    /// When an intruder counts as stopped.
    pub stop: StopDefinition,
    /// Which depth and range a run gives.
    pub last: FinalDefinition,
    /// From where depths count.
    pub surface: SurfaceDefinition,
    /// What could be measured next.
    pub feasible: Feasible,
    /// What is known of coefficients of the model beforehand.
    pub priors: Vec<ParameterPrior>,
    /// In the order of the file.
    pub conditions: Vec<Condition>,
    /// By condition, and within it in an order that names and rows of the file do not decide.
    pub runs: Vec<Run>,
    /// Names of runs that are used as they are, however stray they look.
    pub keep: Vec<String>,
    /// What the reader assumed or left aside, in sentences for the report.
    pub notes: Vec<String>,
}

impl MeasurementSet {
    /// A set in one bed, of which no run is made yet; a body has stopped where it rests.
    pub fn new(id: impl Into<String>, kind: Kind, bed: Bed, conditions: Vec<Condition>) -> Self {
        Self {
            id: id.into(),
            source: None,
            kind,
            instrument: Instrument::default(),
            bed,
            beds: Vec::new(),
            baseline: None,
            stated: StatedError::default(),
            stop: StopDefinition::ComponentZero,
            last: FinalDefinition::Resting,
            surface: SurfaceDefinition::FirstContact,
            feasible: Feasible::default(),
            priors: Vec::new(),
            conditions,
            runs: Vec::new(),
            keep: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// The bed of `condition`.
    pub fn bed_of(&self, condition: &Condition) -> &Bed {
        let named = condition.bed.and_then(|at| self.beds.get(at));
        named.map_or(&self.bed, |named| &named.bed)
    }

    /// Gravity (m/s²) in the bed that `run` was made in.
    pub(crate) fn gravity_of(&self, run: &Run) -> f64 {
        self.bed_of(&self.conditions[run.condition]).gravity
    }

    /// Acceleration (m/s²) with which the body of `condition` falls at its speed at contact, just above the bed.
    pub fn fall_of(&self, condition: &Condition) -> f64 {
        let bed = self.bed_of(condition);
        let in_fluid = bed
            .stated
            .fluid
            .and_then(|fluid| document::bodies::fall(condition, bed.gravity, &fluid));
        in_fluid.unwrap_or(bed.gravity)
    }

    /// The set without the craters of its runs, and whether it had any: a force law says nothing of them.
    #[must_use]
    pub fn without_craters(mut self) -> (Self, bool) {
        let had = self.runs.iter().any(|run| run.crater != Crater::default());
        self.runs.iter_mut().for_each(|run| run.crater = Crater::default());
        (self, had)
    }

    /// Mean diameter (m) of the coarsest grains that are stated; 0 where none is.
    pub fn coarsest_grains(&self) -> f64 {
        self.all_beds().filter_map(|bed| bed.grain_diameter).fold(0.0, f64::max)
    }

    /// The one bed, or all of several.
    pub(crate) fn all_beds(&self) -> impl Iterator<Item = &Bed> {
        let one = self.beds.is_empty().then_some(&self.bed);
        one.into_iter().chain(self.beds.iter().map(|named| &named.bed))
    }
}

/// What was measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Positions over time.
    Trajectory,
    /// Stopping time, final depth and final range alone.
    Scalar,
    /// Force over depth of a body that is pushed at a stated speed.
    ForceDepth,
    /// Acceleration over time, as an accelerometer in the body reads it: 0 in free fall, gravity at rest.
    Acceleration,
    /// Downward velocity over time.
    Velocity,
    /// Angular velocity over time, positive when the body rolls forward.
    Spin,
}

/// What is known of the instrument.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Instrument {
    /// Frames per second (1/s).
    pub rate: Option<f64>,
    /// Root mean square of one reading of a position (m).
    pub position_sigma: Option<f64>,
    /// Root mean square of one reading of a force (N).
    pub force_sigma: Option<f64>,
    /// Root mean square of one reading of an acceleration (m/s²).
    pub acceleration_sigma: Option<f64>,
    /// Root mean square of one reading of a velocity (m/s).
    pub velocity_sigma: Option<f64>,
    /// Root mean square of one reading of an angular velocity (rad/s).
    pub spin_sigma: Option<f64>,
    /// Size of accelerations beyond which the accelerometer reads nothing (m/s²).
    pub acceleration_range: Option<f64>,
    /// How well the set impact speed is known, relative, per run.
    pub speed_sigma_rel: Option<f64>,
    /// How well the set angle of an oblique impact is known, per run (deg).
    pub angle_sigma_deg: Option<f64>,
    /// How well the level of the surface is known in one run (m).
    pub level_sigma: Option<f64>,
    /// How well the times are known that all runs share an error of (s): the zero of the clock.
    pub time_sigma: Option<f64>,
    /// How well the zero of depth is known that all runs share (m).
    pub zero_sigma: Option<f64>,
    /// How well the level of the surface is known (m) that all runs share, where the clock, depths and speed of each are
    /// read where its free fall comes to that level: all three are off together.
    pub surface_sigma: Option<f64>,
    /// Relative error that all impact speeds share.
    pub speed_bias_sigma_rel: Option<f64>,
    /// Error that the angles of all oblique impacts share (deg).
    pub angle_bias_sigma_deg: Option<f64>,
    /// Relative error of the scale of lengths.
    pub scale_sigma_rel: Option<f64>,
    /// Relative error of the mass of each body.
    pub mass_sigma_rel: Option<f64>,
    /// How well the apparatus is plumb (deg).
    pub tilt_sigma_deg: Option<f64>,
    /// By how much the resistance differs from one session to the next, relative.
    pub session_sigma_rel: Option<f64>,
}

impl Instrument {
    /// The same, where an unstated shared error is zero.
    #[must_use]
    pub fn with_stated_errors_alone(self) -> Self {
        let exact = |stated: Option<f64>| stated.or(Some(0.0));
        Self {
            time_sigma: exact(self.time_sigma),
            zero_sigma: exact(self.zero_sigma),
            surface_sigma: exact(self.surface_sigma),
            speed_bias_sigma_rel: exact(self.speed_bias_sigma_rel),
            angle_bias_sigma_deg: exact(self.angle_bias_sigma_deg),
            scale_sigma_rel: exact(self.scale_sigma_rel),
            mass_sigma_rel: exact(self.mass_sigma_rel),
            tilt_sigma_deg: exact(self.tilt_sigma_deg),
            session_sigma_rel: exact(self.session_sigma_rel),
            ..self
        }
    }

    /// The same without any error that runs share, as before runs of a simulation.
    #[must_use]
    pub fn without_shared_errors(self) -> Self {
        let none = Some(0.0);
        Self {
            time_sigma: none,
            zero_sigma: none,
            surface_sigma: none,
            speed_bias_sigma_rel: none,
            angle_bias_sigma_deg: none,
            scale_sigma_rel: none,
            mass_sigma_rel: none,
            tilt_sigma_deg: none,
            session_sigma_rel: none,
            ..self
        }
    }
}

/// Number of space dimensions of a bed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Geometry {
    /// Discs; densities are per area (kg/m²).
    Planar,
    /// Densities are per volume (kg/m³).
    Spatial,
}

/// What the intruder fell into.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bed {
    /// Discs or grains.
    pub geometry: Geometry,
    /// Bulk density (kg/m³, planar kg/m²).
    pub bulk_density: Option<f64>,
    /// Magnitude of gravity (m/s²).
    pub gravity: f64,
    /// Mean diameter of the grains (m).
    pub grain_diameter: Option<f64>,
    /// What else is known of how it lies.
    pub stated: StatedBed,
}

impl Bed {
    /// A bed of this bulk density (kg/m³, planar kg/m²) under `gravity` (m/s²), of which nothing else is known.
    pub fn new(geometry: Geometry, bulk_density: Option<f64>, gravity: f64) -> Self {
        let stated = StatedBed::default();
        Self { geometry, bulk_density, gravity, grain_diameter: None, stated }
    }
}

/// One of several beds.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedBed {
    /// By which conditions name it.
    pub name: String,
    /// What it is.
    pub bed: Bed,
}

/// What a set states of its bed, and how well: a model of grains is held against it, and prepared to it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StatedBed {
    /// The fluid in the bed and above it; `None` where it is air.
    pub fluid: Option<Fluid>,
    /// Area (volume) of the grains over base times mean height of the surface (–).
    pub packing_fraction: Option<f64>,
    /// Standard error of that.
    pub packing_fraction_sigma: Option<f64>,
    /// Mean height of the surface above the floor (m).
    pub surface_height: Option<f64>,
    /// Standard error of that (m).
    pub surface_height_sigma: Option<f64>,
    /// Standard error of the bulk density (kg/m³, planar kg/m²).
    pub bulk_density_sigma: Option<f64>,
    /// Standard error of the mean diameter of the grains (m).
    pub grain_diameter_sigma: Option<f64>,
    /// Mean number of contacts of a grain, which only simulated beds show (–).
    pub coordination: Option<f64>,
    /// Standard error of that.
    pub coordination_sigma: Option<f64>,
}

/// Stated relative errors (1 = 100 %).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StatedError {
    /// Of the stopping time.
    pub stop_time: Option<f64>,
    /// Of the final depth.
    pub final_z: Option<f64>,
    /// Of the final range.
    pub final_x: Option<f64>,
}

/// When an intruder counts as stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StopDefinition {
    /// The later of the first zeros of the velocity components.
    ComponentZero,
    /// When the speed first falls below 5 % of the impact speed.
    SpeedFivePercent,
}

/// Which depth and range a run gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FinalDefinition {
    /// The largest up to the stop.
    Deepest,
    /// Where the body rests.
    Resting,
}

/// From where depths count over coarse grains, whose highest ones a body meets above the mean surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SurfaceDefinition {
    /// From the lowest point of the body at its first contact, of each run.
    FirstContact,
    /// From the mean height of the surface.
    Mean,
}

/// Whether a condition may be fitted to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// For fitting and choosing.
    Fit,
    /// For judging alone.
    Holdout,
}

impl Role {
    /// As a set writes it.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Fit => "fit",
            Self::Holdout => "holdout",
        }
    }
}

/// One setting of the experiment.
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    /// Its name in the tables.
    pub id: String,
    /// Whether it may be fitted to.
    pub role: Role,
    /// Speed at first contact, or of the push (m/s).
    pub speed: f64,
    /// Angle of the velocity below the horizontal (deg): 90 is straight down.
    pub angle_deg: f64,
    /// Shape of the intruder, as in `plunge new --list`: sphere, disc, cylinder, …
    pub shape: String,
    /// Diameter (m).
    pub diameter: f64,
    /// Mass (kg); 0 where it is not stated, of a body that is pushed.
    pub mass: f64,
    /// Angular velocity (rad/s), positive when it rolls forward.
    pub spin: f64,
    /// Packing fraction of the bed.
    pub packing: Option<f64>,
    /// Depth of the bed (m).
    pub bed_depth: Option<f64>,
    /// Index of its bed in [`MeasurementSet::beds`]; none in a set of one bed.
    pub bed: Option<usize>,
    /// Length of a link (m).
    pub length: Option<f64>,
    /// Height of a cylinder or cone (m).
    pub height: Option<f64>,
    /// Diameter of a shaft behind a cylinder, hemisphere or cone, which follows it into the bed (m).
    pub shaft_diameter: Option<f64>,
    /// Full apex angle of a cone (deg).
    pub apex_deg: Option<f64>,
    /// Angle of a link's axis to the vertical (deg).
    pub link_angle_deg: Option<f64>,
}

impl Condition {
    /// A body, by its shape, diameter (m) and mass (kg), that falls straight down at `speed` (m/s) and is fitted to.
    pub fn straight_down(
        id: impl Into<String>,
        (shape, diameter, mass): (&str, f64, f64),
        speed: f64,
    ) -> Self {
        Self {
            id: id.into(),
            role: Role::Fit,
            speed,
            angle_deg: 90.0,
            shape: shape.to_owned(),
            diameter,
            mass,
            spin: 0.0,
            packing: None,
            bed_depth: None,
            bed: None,
            length: None,
            height: None,
            shaft_diameter: None,
            apex_deg: None,
            link_angle_deg: None,
        }
    }
}

/// One repeat of a condition.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Its name in the tables; nothing depends on it.
    pub name: String,
    /// Index of its condition in [`MeasurementSet::conditions`].
    pub condition: usize,
    /// Which repeat, as the table says.
    pub repeat: Option<i64>,
    /// Place in time among all runs, as the table says.
    pub order: Option<i64>,
    /// The day, pouring or levelling that it shares with other runs, as the table says.
    pub session: Option<String>,
    /// Stopping time (s).
    pub stop_time: Option<f64>,
    /// Final depth of the lowest point below the undisturbed surface (m).
    pub final_z: Option<f64>,
    /// Final horizontal distance from first contact (m).
    pub final_x: Option<f64>,
    /// What the impact left in the surface.
    pub crater: Crater,
    /// Frames in the order of time; empty for other kinds than trajectories.
    pub frames: Vec<Frame>,
    /// Readings of a [`Curve`], in the order of the file; empty for other kinds.
    pub samples: Vec<Sample>,
}

impl Run {
    /// A run under the condition of this index, of which nothing is measured yet.
    pub fn new(name: String, condition: usize) -> Self {
        Self {
            name,
            condition,
            repeat: None,
            order: None,
            session: None,
            stop_time: None,
            final_z: None,
            final_x: None,
            crater: Crater::default(),
            frames: Vec::new(),
            samples: Vec::new(),
        }
    }

    /// Whether anything was read along its way.
    pub fn has_readings(&self) -> bool {
        !self.frames.is_empty() || !self.samples.is_empty()
    }
}

/// A crater, when the bed lies still.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Crater {
    /// Depth of its lowest point below the undisturbed surface (m).
    pub depth: Option<f64>,
    /// Distance from rim to rim, at the highest points (m).
    pub rim_diameter: Option<f64>,
}

/// One reading of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Where along it (SI): a depth below the undisturbed surface, or a time since first contact.
    pub at: f64,
    /// What was read (SI): the force of the bed against the motion, an acceleration upward, a velocity downward, or an
    /// angular velocity forward.
    pub value: f64,
    /// Root mean square error of this reading (SI), where the table says it.
    pub sigma: Option<f64>,
}

/// One reading of a trajectory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Time since first contact (s); negative before.
    pub t: f64,
    /// Depth of the lowest point below the undisturbed surface (m); negative above.
    pub z: f64,
    /// Horizontal distance along the motion (m).
    pub x: f64,
    /// Root mean square error of this reading (m), where the table says it.
    pub sigma: Option<f64>,
}
