//! Campaign files: many impacts as models, and what is varied in them.
//!
//! ```toml
//! [campaign]
//! name = "speeds-and-friction"
//! models = ["vertical-2d"]          # files beside this one, or shipped models
//! seeds = [1, 2, 3]                 # each in place of run.seed
//!
//! [set]                             # of every point
//! run.duration = "0.4 s"
//!
//! [product]                         # every value with every other
//! impact.speed = ["1 m/s", "2 m/s"]
//!
//! [[point]]                         # … with every one of these
//! contact_law.friction = 0.2
//!
//! [sample]                          # … with every one of these
//! method = "latin-hypercube"
//! count = 10
//! [sample.ranges]
//! intruder.mass = ["20 g", "40 g"]
//! ```

pub mod json_schema;
mod read;
mod settings;

use std::path::{Path, PathBuf};

use configs::reader::{FileKind, Reader};
use configs::{ConfigError, Diagnostic, ModelSource, Sources, Span, document};

pub use settings::{Axis, SampledRange, Scale, Setting};

/// Most points of a campaign.
pub const POINTS: usize = 1_000_000;

/// A campaign as its file has it.
#[derive(Clone, Debug)]
pub struct Campaign {
    /// Name of the campaign and of its folder: 1 to 64 of a–z, 0–9, `-` and `_`.
    pub name: String,
    /// The models; each is run at every point.
    pub models: Vec<CampaignModel>,
    /// Seeds in place of each model's own; none for that of the model alone.
    pub seeds: Vec<u64>,
    /// Whether logs of points stay once the points are done.
    pub keep_logs: bool,
    /// What is set in every point.
    pub fixed: Vec<Setting>,
    /// What is varied, every value with every other.
    pub product: Vec<Axis>,
    /// Settings one by one; none for no such list.
    pub listed: Vec<Vec<Setting>>,
    /// What is drawn, if anything is.
    pub sample: Option<Sample>,
    /// The file, for messages.
    pub sources: Sources,
}

/// A model of a campaign.
#[derive(Clone, Debug)]
pub struct CampaignModel {
    /// As the campaign names it.
    pub name: String,
    /// Its text.
    pub source: ModelSource,
    /// Where the campaign names it.
    pub span: Option<Span>,
}

/// Points that are drawn from ranges.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// How.
    pub method: SampleMethod,
    /// How many.
    pub count: usize,
    /// Equal seeds draw equal points.
    pub seed: u64,
    /// From what; not empty.
    pub ranges: Vec<SampledRange>,
}

/// How points are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SampleMethod {
    /// As many slices of every range as points, and a point in each.
    ///
    /// Source: M. D. McKay, R. J. Beckman and W. J. Conover, Technometrics **21**, 239 (1979).
    LatinHypercube,
    /// A Sobol sequence, scrambled; best with a power of 2 as the count.
    ///
    /// Source: S. Joe and F. Y. Kuo, SIAM J. Sci. Comput. **30**, 2635 (2008); A. B. Owen, in Monte Carlo and
    /// Quasi-Monte Carlo Methods, 299 (1995).
    Sobol,
}

impl SampleMethod {
    /// All of them, by the names that files give them.
    pub const ALL: [(&'static str, Self); 2] =
        [("latin-hypercube", Self::LatinHypercube), ("sobol", Self::Sobol)];

    /// Most points that it draws.
    #[must_use]
    pub(crate) fn most_points(self) -> usize {
        match self {
            Self::LatinHypercube => POINTS,
            // The generator has so many.
            Self::Sobol => 1 << 16,
        }
    }
}

impl Campaign {
    /// Reads the campaign in the file `path`; models may lie in its project, or below `allow_paths`.
    ///
    /// # Errors
    /// Everything that is wrong with it, at once. What its settings do to the models is not looked at.
    pub fn load(path: &Path, allow_paths: &[PathBuf]) -> Result<Self, ConfigError> {
        let (name, text, folder) = ModelSource::Path(path.to_owned()).open()?;
        let mut sources = Sources::default();
        let id = sources.add(name, text);
        let root = document::parse(&sources, id).map_err(|diagnostic| ConfigError::Invalid {
            diagnostics: vec![*diagnostic],
            sources: sources.clone(),
        })?;
        let reader = Reader::new(&sources, FileKind::Campaign);
        let campaign = read::campaign(reader.root(&root), &folder, allow_paths);
        let diagnostics = reader.into_diagnostics();
        match campaign {
            Some(campaign) if diagnostics.is_empty() => Ok(Self { sources, ..campaign }),
            _ => Err(ConfigError::Invalid { diagnostics, sources }),
        }
    }

    /// An error in a place of this file.
    pub fn error(&self, diagnostic: Diagnostic) -> ConfigError {
        ConfigError::Invalid { diagnostics: vec![diagnostic], sources: self.sources.clone() }
    }

    /// Points of one model and one seed.
    pub(crate) fn n_settings(&self) -> usize {
        let product = self.product.iter().map(|axis| axis.values.len());
        let sampled = self.sample.as_ref().map_or(1, |sample| sample.count);
        let others = [self.listed.len().max(1), sampled];
        product.chain(others).fold(1, usize::saturating_mul)
    }

    /// All points.
    pub fn n_points(&self) -> usize {
        let others = [self.models.len(), self.seeds.len().max(1)];
        others.into_iter().fold(self.n_settings(), usize::saturating_mul)
    }
}
