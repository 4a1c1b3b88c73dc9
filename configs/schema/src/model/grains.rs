//! A bed of grains, in SI.

use std::path::PathBuf;
use std::sync::Arc;

use contact_laws::LawEntry;
use engine::grains::Space;
use engine::params::ParamTable;

use super::Model;
use crate::diagnostics::Span;
use crate::grains_csv::CsvGrain;

/// A bed of grains in a container, under a contact law.
#[derive(Clone, Debug, PartialEq)]
pub struct GrainMedium {
    /// Discs in a plane or spheres in space.
    pub space: Space,
    /// Magnitude of gravity, downward (m/s²).
    pub gravity: f64,
    /// `[container]`.
    pub container: Container,
    /// `[bed]`.
    pub bed: Bed,
    /// `[contact_law]`.
    pub contact_law: LawChoice,
    /// `[[effect]]`, in the order of the file.
    pub effects: Vec<LawChoice>,
    /// Where impacts start, from `[impact]`.
    pub start: StartPositions,
    /// The steps of `[run]`.
    pub stepping: Stepping,
    /// What of `[log]` has to do with steps and grains.
    pub log: GrainLog,
}

/// Where impacts on a bed of grains start.
#[derive(Clone, Debug, PartialEq)]
pub struct StartPositions {
    /// Where the centre of the intruder starts (m), if the file says so.
    pub x: Option<f64>,
    /// The same along the depth (m) of a bed in space.
    pub y: Option<f64>,
    /// Where drawn positions lie (m).
    pub x_range: (f64, f64),
}

/// How finely a bed of grains is integrated.
#[derive(Clone, Debug, PartialEq)]
pub struct Stepping {
    /// The step before [`Stepping::time_step_factor`].
    pub time_step: TimeStep,
    /// Multiplies the step, fixed or automatic.
    pub time_step_factor: f64,
    /// Steps between checkpoints.
    pub checkpoint_every: u64,
}

/// The time step as the file states it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TimeStep {
    /// This long (s).
    Fixed(f64),
    /// A fraction of the shortest collision.
    Auto,
}

/// What goes into the log of a bed of grains.
#[derive(Clone, Debug, PartialEq)]
pub struct GrainLog {
    /// Steps between flushes.
    pub flush_every: u64,
    /// Whether grains are logged at all.
    pub grains: bool,
    /// When the fields of the bed and its crater are logged (s).
    pub fields_at: Vec<f64>,
}

/// The box: x from 0 to `width`, in three dimensions y from 0 to `depth`, and up from its bottom at 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Container {
    /// Inner width (m).
    pub width: f64,
    /// Inner depth (m); 0 in a plane.
    pub depth: f64,
}

/// The grains at the start of the impact.
#[derive(Clone, Debug, PartialEq)]
pub struct Bed {
    /// Where they come from.
    pub source: BedSource,
    /// Packing fraction that the preparation should come near to.
    pub target_packing_fraction: Option<f64>,
    /// Height that the preparation should come near to (m).
    pub target_height: Option<f64>,
}

/// Where the grains come from.
#[derive(Clone, Debug, PartialEq)]
pub enum BedSource {
    /// Poured in and left to settle.
    Settle(Settle),
    /// Positions from a file.
    Csv(CsvBed),
}

/// Grains poured in and left to settle.
#[derive(Clone, Debug, PartialEq)]
pub struct Settle {
    /// The kinds of grains.
    pub grains: Vec<GrainKind>,
    /// Friction while settling, in place of the law's; `None` when the law has no friction at all.
    pub preparation_friction: Option<f64>,
    /// Step while settling.
    pub preparation_time_step: TimeStep,
    /// Effects that act while settling (`[[bed.effect]]`).
    pub effects: Vec<LawChoice>,
}

/// Equal grains.
#[derive(Clone, Debug, PartialEq)]
pub struct GrainKind {
    /// How many.
    pub count: u64,
    /// Diameter (m).
    pub diameter: f64,
    /// Mass of one (kg).
    pub mass: f64,
}

/// Grains at given positions.
#[derive(Clone, Debug, PartialEq)]
pub struct CsvBed {
    /// The file, as an absolute path without symbolic links.
    pub file: PathBuf,
    /// The file as the model names it, relative to the model.
    pub named: String,
    /// blake3 of its content, in hexadecimal.
    pub blake3: String,
    /// Its grains.
    pub grains: Arc<[CsvGrain]>,
}

/// A law or effect of the registry and its parameters.
#[derive(Clone)]
pub struct LawChoice {
    /// The registry's entry.
    pub entry: &'static LawEntry,
    /// All its parameters (SI).
    pub params: ParamTable,
    /// Where the file names it.
    pub span: Span,
}

impl PartialEq for LawChoice {
    fn eq(&self, other: &Self) -> bool {
        self.entry.name == other.entry.name && self.params == other.params
    }
}

impl std::fmt::Debug for LawChoice {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("LawChoice").field(&self.entry.name).field(&self.params).finish()
    }
}

/// A model whose medium is a bed of grains.
#[derive(Clone, Copy, Debug)]
pub struct GrainModel<'a> {
    /// The whole model.
    pub model: &'a Model,
    /// Its medium.
    pub medium: &'a GrainMedium,
}

impl<'a> GrainModel<'a> {
    /// Canonical text of everything that the prepared bed depends on, and of nothing else.
    #[must_use]
    pub fn bed_key_text(&self) -> &'a str {
        &self.model.bed_key
    }

    /// Number of grains in the bed.
    #[must_use]
    pub fn n_grains(&self) -> u64 {
        match &self.medium.bed.source {
            BedSource::Settle(settle) => settle.grains.iter().map(|kind| kind.count).sum(),
            BedSource::Csv(csv) => csv.grains.len() as u64,
        }
    }
}
