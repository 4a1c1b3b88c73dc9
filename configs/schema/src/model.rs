//! What a model file says, in SI, with every default filled in.

use std::path::PathBuf;
use std::sync::Arc;

use contact_laws::LawEntry;
use engine::params::ParamTable;
use intruders::ShapeEntry;

use crate::diagnostics::Span;
use crate::grains_csv::CsvGrain;

/// A model: what is simulated, on what, and with which laws.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// `[run]`.
    pub run: RunSettings,
    /// `[log]`.
    pub log: LogSettings,
    /// `[energy]`.
    pub energy: EnergySettings,
    /// `[medium]`.
    pub medium: Medium,
    /// `[container]`.
    pub container: Container,
    /// `[bed]`.
    pub bed: Bed,
    /// `[contact_law]`.
    pub contact_law: LawChoice,
    /// `[[effect]]`, in the order of the file.
    pub effects: Vec<LawChoice>,
    /// `[intruder]`.
    pub intruder: Intruder,
    /// `[impact]`.
    pub impact: Impact,
    /// `[conditions]`; see [`Model::conditions`].
    pub conditions: Option<ConditionLists>,
    pub(crate) resolved: String,
    pub(crate) bed_key: String,
    pub(crate) hash: String,
}

/// How long, how finely and from which seed.
#[derive(Clone, Debug, PartialEq)]
pub struct RunSettings {
    /// Name of the run and of its folder: 1 to 64 of a–z, 0–9, `-` and `_`.
    pub name: String,
    /// Longest simulated time (s).
    pub duration: f64,
    /// The step before [`RunSettings::time_step_factor`].
    pub time_step: TimeStep,
    /// Multiplies the step, fixed or automatic.
    pub time_step_factor: f64,
    /// Seed of everything random.
    pub seed: u64,
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

/// What goes into the log, and how often.
#[derive(Clone, Debug, PartialEq)]
pub struct LogSettings {
    /// Steps between flushes.
    pub flush_every: u64,
    /// Frames of all grains per simulated second (1/s).
    pub frames_per_s: f64,
    /// Whether grains are logged at all.
    pub grains: bool,
}

/// When an open energy budget ends a run.
#[derive(Clone, Debug, PartialEq)]
pub struct EnergySettings {
    /// Largest accepted closure, over the initial energy of the intruder.
    pub abort_above: f64,
}

/// What the intruder falls into.
#[derive(Clone, Debug, PartialEq)]
pub struct Medium {
    /// Number of space dimensions: 2.
    pub dimension: u8,
    /// Magnitude of gravity, downward (m/s²).
    pub gravity: f64,
}

/// The box: x from 0 to `width`, y up from its bottom at 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Container {
    /// Inner width (m).
    pub width: f64,
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

/// The body that hits the bed.
#[derive(Clone)]
pub struct Intruder {
    /// Its name in logs and reports.
    pub name: String,
    /// The registry's entry.
    pub shape: &'static ShapeEntry,
    /// All parameters of the shape (SI).
    pub params: ParamTable,
    /// Mass (kg).
    pub mass: f64,
}

impl PartialEq for Intruder {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
            && self.shape.name == other.shape.name
            && self.params == other.params
            && self.mass.to_bits() == other.mass.to_bits()
    }
}

impl std::fmt::Debug for Intruder {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Intruder")
            .field("name", &self.name)
            .field("shape", &self.shape.name)
            .field("params", &self.params)
            .field("mass", &self.mass)
            .finish()
    }
}

/// How the intruder meets the surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Impact {
    /// Speed at first contact (m/s).
    pub speed: f64,
    /// Angle of the velocity below the horizontal (rad): π/2 is straight down.
    pub angle_rad: f64,
    /// Angular velocity, counter-clockwise positive (rad/s).
    pub spin: f64,
    /// Where the centre starts (m), if the file says so.
    pub x: Option<f64>,
    /// Where drawn positions lie (m).
    pub x_range: (f64, f64),
}

/// The lists of `[conditions]`; one that is not given is the single value of `[impact]`.
#[derive(Clone, Debug, PartialEq)]
pub struct ConditionLists {
    /// Speeds (m/s).
    pub speed: Option<Vec<f64>>,
    /// Angles (rad).
    pub angle_rad: Option<Vec<f64>>,
    /// Start positions (m).
    pub x: Option<Vec<f64>>,
    /// Number of drawn start positions.
    pub positions: Option<u64>,
}

/// One impact of a model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condition {
    /// Speed at first contact (m/s).
    pub speed: f64,
    /// Angle below the horizontal (rad).
    pub angle_rad: f64,
    /// Counts the start positions of one speed and angle, from 0.
    pub position_index: usize,
    /// Where the centre starts.
    pub x: StartX,
}

impl Condition {
    /// Angle below the horizontal (deg), to 1e-9: what a file says as 30 deg is 30 here, and not the
    /// 29.999999999999996 that comes back from radians.
    #[must_use]
    pub fn angle_deg(&self) -> f64 {
        (self.angle_rad.to_degrees() * 1e9).round() / 1e9
    }
}

/// Where an intruder starts along x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StartX {
    /// Here (m).
    At(f64),
    /// Drawn in [`Impact::x_range`], from the seed and [`Condition::position_index`].
    Drawn,
}

impl Model {
    /// The impacts of this model: the product of the lists in `[conditions]`, speed slowest, then
    /// angle, then position; without the table, the one of `[impact]`.
    ///
    /// A start position is taken from `conditions.x`, else drawn when `positions` is above 1, else
    /// `impact.x`, else the middle of the container.
    #[must_use]
    pub fn conditions(&self) -> Vec<Condition> {
        let lists = self.conditions.as_ref();
        let or_single = |list: Option<&Vec<f64>>, single: f64| match list {
            Some(values) => values.clone(),
            None => vec![single],
        };
        let speeds = or_single(lists.and_then(|lists| lists.speed.as_ref()), self.impact.speed);
        let angles =
            or_single(lists.and_then(|lists| lists.angle_rad.as_ref()), self.impact.angle_rad);
        let middle = self.impact.x.unwrap_or(self.container.width / 2.0);
        let starts: Vec<StartX> = match lists {
            Some(ConditionLists { x: Some(x), .. }) => x.iter().copied().map(StartX::At).collect(),
            Some(ConditionLists { positions: Some(n), .. }) if *n > 1 => {
                (0..*n).map(|_| StartX::Drawn).collect()
            }
            _ => vec![StartX::At(middle)],
        };
        let mut conditions = Vec::new();
        for &speed in &speeds {
            for &angle_rad in &angles {
                for (position_index, &x) in starts.iter().enumerate() {
                    conditions.push(Condition { speed, angle_rad, position_index, x });
                }
            }
        }
        conditions
    }

    /// The model as TOML with every value in SI and every default written out. It loads to the
    /// same model, and its own resolved text is itself.
    #[must_use]
    pub fn resolved_toml(&self) -> &str {
        &self.resolved
    }

    /// blake3 of [`Model::resolved_toml`], in hexadecimal; of a table of grains the content counts, and
    /// not where the file lies.
    #[must_use]
    pub fn hash(&self) -> String {
        self.hash.clone()
    }

    /// Canonical text of everything that the prepared bed depends on, and of nothing else.
    #[must_use]
    pub fn bed_key_text(&self) -> &str {
        &self.bed_key
    }

    /// Number of grains in the bed.
    #[must_use]
    pub fn n_grains(&self) -> u64 {
        match &self.bed.source {
            BedSource::Settle(settle) => settle.grains.iter().map(|kind| kind.count).sum(),
            BedSource::Csv(csv) => csv.grains.len() as u64,
        }
    }
}
