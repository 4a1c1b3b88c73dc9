//! Model files: TOML with units in, SI numbers out, and errors that point at the text.
//!
//! [`Model::load`] reads a file (or a shipped model), applies `--set`, checks it and gives the
//! [`Model`], which also prints itself as a complete, re-runnable file ([`Model::resolved_toml`]).
//!
//! `document` is the TOML with its places, `reader` reads tables key by key, `read` knows the
//! tables of a model, `checks` compares values with each other, `diagnostics` shows what is wrong,
//! `json_schema` makes schemas for editors of what readers ask.

mod absorbing;
mod build;
mod change;
mod checks;
mod diagnostics;
pub mod document;
pub mod edit;
pub mod estimate;
pub mod grains_csv;
mod guess;
pub mod json_schema;
mod launching;
pub mod limits;
mod load;
mod model;
pub mod paths;
mod read;
pub mod reader;
mod resolved;
mod set;
mod shipped;
mod single;
mod specs;
pub mod stability;

pub use build::BuildError;
pub use change::Change;
pub use diagnostics::{
    Color, Diagnostic, Severity, SourceId, Sources, Span, nearest, printable, render_all, shorten,
};
pub use load::{ConfigError, LoadOptions, Loaded, ModelSource};
pub use model::{
    AngleTable, Bed, BedSource, BottomKind, Coefficient, Condition, ConditionLists, Container,
    ContainerShape, CsvBed, EffectChoice, EnergySettings, FreeParameter, GrainForceChoice,
    GrainKind, GrainLog, GrainMedium, GrainModel, Impact, Intruder, Launch, LawChoice, LogSettings,
    Material, Medium, Model, ParameterError, ResistanceChoice, ResistiveMedium, ResistiveModel,
    RunSettings, Settle, SidesKind, StartPositions, StartX, Stepping, TimeStep,
};
pub use paths::PathError;
pub use read::fluid;
pub use reader::interval as describe_range;
pub use resolved::quoted as toml_string;
pub use shipped::{SHIPPED, Shipped, find as find_shipped};
