//! A bed or an impact that another process does for this one.

use std::path::Path;
use std::sync::Arc;

use engine::parallel::with_threads;
use serde::{Deserialize, Serialize};

use super::job::Job;
use crate::elsewhere::{ModelText, Task};
use crate::error::CampaignError;
use crate::hexadecimal;
use crate::workers::WorkerSignals;

/// One thing to be done, on one thread.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", tag = "task")]
pub enum BedTask {
    /// A bed is prepared.
    Bed {
        /// That it belongs to.
        model: ModelText,
    },
    /// An impact is run, and its record kept.
    Impact {
        /// Under which key, in hexadecimal.
        key: String,
        /// Of what.
        model: ModelText,
        /// On whose bed.
        bed: ModelText,
        /// How long it is expected to take, as simulated time (s).
        expected: f64,
        /// Whether it goes on until the bed lies still.
        settles: bool,
    },
}

impl BedTask {
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
            settles: job.settles,
        }
    }
}

impl Task for BedTask {
    fn run(&self, cache: &Path) -> Result<(), CampaignError> {
        with_threads(1, || match self {
            Self::Bed { model } => {
                let model = model.load()?;
                let job = Job { bed: Arc::clone(&model), model, expected: 0.0, settles: false };
                job.prepare_bed(cache, &mut WorkerSignals::unattended()).map(drop)
            }
            Self::Impact { key, model, bed, expected, settles } => {
                let (model, bed) = (model.load()?, bed.load()?);
                let job = Job { model, bed, expected: *expected, settles: *settles };
                impact(&job, key, cache)
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
    match job.kept_or_run((cache, &key), &mut WorkerSignals::unattended()) {
        Ok(Some(_)) => Ok(()),
        Ok(None) => Err(CampaignError::Interrupted),
        Err(why) if why.is_of_an_impact() => {
            eprintln!("the impact is left out: {why}");
            Ok(())
        }
        Err(other) => Err(other),
    }
}
