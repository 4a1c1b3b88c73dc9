//! What another process does for this one.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use configs::{BedSource, ConfigError, LoadOptions, Medium, Model, ModelSource};
use engine::parallel::with_threads;
use serde::{Deserialize, Serialize};

use crate::beds::campaign::CampaignError;
use crate::beds::job::{Heed, Job, hexadecimal};
use crate::three_shapes;

/// One thing to be done, on one thread.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", tag = "task")]
pub(crate) enum Task {
    /// A bed is prepared.
    Bed {
        /// That it belongs to.
        model: ModelText,
    },
    /// An impact is run, and its record kept.
    Impact {
        /// Under which key, in hexadecimal.
        key: String,
        model: ModelText,
        /// On whose bed.
        bed: ModelText,
        /// How long it is expected to take, as simulated time (s).
        expected: f64,
    },
    /// An impact of the study of three shapes is run, and its outcome kept.
    Shape {
        /// In which file.
        outcome: PathBuf,
        model: ModelText,
    },
}

/// A model, complete, as another process reads it.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct ModelText {
    toml: String,
    /// The folder of its table of grains.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    table: Option<PathBuf>,
}

impl ModelText {
    pub(crate) fn of(model: &Model) -> Self {
        let table = match &model.medium {
            Medium::Grains(medium) => match &medium.bed.source {
                BedSource::Csv(table) => table.file.parent().map(Path::to_owned),
                BedSource::Settle(_) => None,
            },
            Medium::Resistive(_) => None,
        };
        Self { toml: model.resolved_toml().to_owned(), table }
    }

    fn load(&self) -> Result<Arc<Model>, ConfigError> {
        let source = ModelSource::Text {
            name: "the model of a task".to_owned(),
            text: self.toml.clone(),
            folder: PathBuf::from("."),
        };
        let allow_paths = self.table.iter().cloned().collect();
        let options = LoadOptions { allow_paths, ..LoadOptions::default() };
        Ok(Arc::new(Model::load(source, &options)?.model))
    }
}

impl Task {
    /// The bed of `job`.
    pub(crate) fn bed(job: &Job) -> Self {
        Self::Bed { model: ModelText::of(&job.bed) }
    }

    /// `job`, whose record is kept under `key`.
    pub(crate) fn impact(job: &Job, key: &[u8; 32]) -> Self {
        Self::Impact {
            key: hexadecimal(key),
            model: ModelText::of(&job.model),
            bed: ModelText::of(&job.bed),
            expected: job.expected,
        }
    }

    /// Does it, unless it is done.
    pub(super) fn run(&self, cache: &Path) -> Result<(), CampaignError> {
        with_threads(1, || match self {
            Self::Bed { model } => {
                let model = model.load()?;
                let job = Job { bed: Arc::clone(&model), model, expected: 0.0 };
                job.prepare_bed(cache, &mut unattended()).map(drop)
            }
            Self::Impact { key, model, bed, expected } => {
                let job = Job { model: model.load()?, bed: bed.load()?, expected: *expected };
                impact(&job, key, cache)
            }
            Self::Shape { outcome, model } => {
                let kept = three_shapes::kept_or_run(&*model.load()?, outcome, cache);
                kept.map(drop).map_err(|error| Box::new(error).into())
            }
        })?
    }
}

/// Runs `job`, whose record was asked for under `asked`.
fn impact(job: &Job, asked: &str, cache: &Path) -> Result<(), CampaignError> {
    let key = job.key()?;
    if hexadecimal(&key) != asked {
        return Err(CampaignError::OtherProgram);
    }
    // Tasks that were handed over twice do it once.
    match job.kept_or_run((cache, &key), &mut unattended()) {
        Ok(Some(_)) => Ok(()),
        Ok(None) => Err(CampaignError::Interrupted),
        Err(CampaignError::Step(why)) => {
            eprintln!("the impact is left out: {why}");
            Ok(())
        }
        Err(other) => Err(other),
    }
}

fn unattended() -> Heed<'static> {
    Heed { stop: &|| false, warn: &|message| eprintln!("warning: {message}") }
}
