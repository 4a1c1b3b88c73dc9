//! What a model file says, in SI, with every default filled in.

mod grains;
mod impact;
mod parameters;
mod resistive;

use crate::resolved::Resolved;

pub use grains::{
    Bed, BedSource, BottomKind, Container, ContainerShape, CsvBed, GrainForceChoice, GrainKind,
    GrainLog, GrainMedium, GrainModel, LawChoice, Material, Settle, SidesKind, StartPositions,
    Stepping, TimeStep,
};
pub use impact::{Condition, ConditionLists, Impact, Intruder, Launch, StartX};
pub(crate) use impact::{IMPACT, INTRUSION, degrees};
pub use parameters::{FreeParameter, ParameterError};
pub use resistive::{
    AngleTable, Coefficient, EffectChoice, ResistanceChoice, ResistiveMedium, ResistiveModel,
};

/// A model: what falls into what, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// `[run]`.
    pub run: RunSettings,
    /// `[log]`.
    pub log: LogSettings,
    /// `[energy]`.
    pub energy: EnergySettings,
    /// What the intruder falls into.
    pub medium: Medium,
    /// `[intruder]`.
    pub intruder: Intruder,
    /// `[impact]` or `[intrusion]`.
    pub impact: Impact,
    /// `[conditions]`; see [`Model::conditions`].
    pub conditions: Option<ConditionLists>,
    pub(crate) lines: Resolved,
    pub(crate) resolved: String,
    pub(crate) bed_key: String,
    pub(crate) hash: String,
}

/// How long, under which name and from which seed.
#[derive(Clone, Debug, PartialEq)]
pub struct RunSettings {
    /// Name of the run and of its folder: 1 to 64 of a–z, 0–9, `-` and `_`.
    pub name: String,
    /// Longest simulated time (s).
    pub duration: f64,
    /// Seed of everything random.
    pub seed: u64,
}

/// What goes into the log of any run.
#[derive(Clone, Debug, PartialEq)]
pub struct LogSettings {
    /// Frames per simulated second (1/s).
    pub frames_per_s: f64,
}

/// When an open energy budget ends a run.
#[derive(Clone, Debug, PartialEq)]
pub struct EnergySettings {
    /// Largest accepted closure, over the initial energy of the intruder.
    pub abort_above: f64,
}

/// What the intruder falls into.
#[derive(Clone, Debug, PartialEq)]
pub enum Medium {
    /// Grains in a container.
    Grains(Box<GrainMedium>),
    /// A force law.
    Resistive(Box<ResistiveMedium>),
}

impl Medium {
    /// The kind of medium, as in TOML and in summaries.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Grains(_) => "grains",
            Self::Resistive(_) => "resistive-force",
        }
    }
}

impl Model {
    /// The model with its bed of grains, if that is its medium.
    pub fn grains(&self) -> Option<GrainModel<'_>> {
        match &self.medium {
            Medium::Grains(medium) => Some(GrainModel { model: self, medium }),
            Medium::Resistive(_) => None,
        }
    }

    /// The model with its force law, if that is its medium.
    pub fn resistive(&self) -> Option<ResistiveModel<'_>> {
        match &self.medium {
            Medium::Grains(_) => None,
            Medium::Resistive(medium) => Some(ResistiveModel { model: self, medium }),
        }
    }

    /// The impacts of this model: the product of the lists in `[conditions]`, speed slowest, then
    /// angle, then position; without the table, the one of `[impact]`.
    ///
    /// A start position is taken from `conditions.x`, else drawn when `positions` is above 1, else
    /// `impact.x`, else the middle of the container. A resistive medium is the same everywhere, and
    /// its impacts start at 0.
    pub fn conditions(&self) -> Vec<Condition> {
        let lists = self.conditions.as_ref();
        let or_single = |list: Option<&Vec<f64>>, single: f64| match list {
            Some(values) => values.clone(),
            None => vec![single],
        };
        let speeds = or_single(lists.and_then(|lists| lists.speed.as_ref()), self.impact.speed);
        let angles =
            or_single(lists.and_then(|lists| lists.angle_rad.as_ref()), self.impact.angle_rad);
        let single = match &self.medium {
            Medium::Grains(medium) => medium.start.x.unwrap_or(medium.container.width / 2.0),
            Medium::Resistive(_) => 0.0,
        };
        let starts: Vec<StartX> = match lists {
            Some(ConditionLists { x: Some(x), .. }) => x.iter().copied().map(StartX::At).collect(),
            Some(ConditionLists { positions: Some(n), .. }) if *n > 1 => {
                (0..*n).map(|_| StartX::Drawn).collect()
            }
            _ => vec![StartX::At(single)],
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

    /// How long a run under `condition` lasts at most (s).
    pub fn time(&self, condition: &Condition) -> f64 {
        self.launch(condition).time(self.run.duration)
    }

    /// How long a run lasts at most, under any condition (s).
    pub fn longest(&self) -> f64 {
        self.conditions().iter().map(|condition| self.time(condition)).fold(0.0, f64::max)
    }

    /// How the intruder comes in at `condition`.
    pub fn launch(&self, condition: &Condition) -> Launch {
        let Condition { speed, angle_rad, .. } = *condition;
        let Impact { spin, attitude_rad, pushed_to, .. } = self.impact;
        Launch { speed, angle_rad, spin, attitude_rad, pushed_to }
    }

    /// The model as TOML with every value in SI and every default written out. It loads to the
    /// same model, and its own resolved text is itself.
    pub fn resolved_toml(&self) -> &str {
        &self.resolved
    }

    /// blake3 of [`Model::resolved_toml`], in hexadecimal; of a table of grains the content counts, and
    /// not where the file lies.
    pub fn hash(&self) -> String {
        self.hash.clone()
    }
}
