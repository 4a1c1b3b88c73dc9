//! The flags that commands about a model share.

use std::path::{Path, PathBuf};

use clap::Args;
use configs::estimate::{Estimate, MEMORY_SHARE, available_memory_bytes};
use configs::{GrainModel, LoadOptions, Loaded, Model};
use engine::parallel::with_threads;
use runner::run::{PreparedBed, prepare};
use runner::schedulers::{Scheduler, SchedulerError};

use crate::control::Terminal;
use crate::host;
use crate::output::{self, CommandError};

/// The flags that commands about a model share.
#[derive(Args, Clone, Debug)]
pub(crate) struct Common {
    /// Change a key of the model; the value is TOML if it parses as TOML, else a string.
    #[arg(long = "set", value_name = "KEY.PATH=VALUE")]
    pub(crate) sets: Vec<String>,
    /// The seed, in place of the model's.
    #[arg(long)]
    pub(crate) seed: Option<u64>,
    /// The folder to write to.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Threads to use, 1 to 256; they never change a result.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    pub(crate) threads: Option<u16>,
    /// Print one JSON object to stdout.
    #[arg(long)]
    pub(crate) json: bool,
    /// No progress and no warnings.
    #[arg(long)]
    pub(crate) quiet: bool,
    /// Go on where a check would refuse: other inputs in the folder, too little memory.
    #[arg(long)]
    pub(crate) force: bool,
    /// Continue an unfinished run.
    #[arg(long)]
    pub(crate) resume: bool,
    /// The folder of prepared beds and finished impacts.
    #[arg(long, value_name = "DIR")]
    pub(crate) cache: Option<PathBuf>,
    /// Let the model read data files below this folder too.
    #[arg(long = "allow-path", value_name = "DIR")]
    pub(crate) allow_paths: Vec<PathBuf>,
}

impl Common {
    /// Loads the model that an argument names, and shows its warnings.
    ///
    /// # Errors
    /// Bad input, with everything that is wrong with it.
    pub(crate) fn load(&self, model: &Path) -> Result<Loaded, CommandError> {
        let options = LoadOptions {
            sets: self.sets.clone(),
            seed: self.seed,
            allow_paths: self.allow_paths.clone(),
        };
        let loaded = Model::load(host::model_source(model), &options)?;
        if !self.quiet {
            output::show_warnings(&loaded);
        }
        Ok(loaded)
    }

    /// Refuses a model that does not fit into memory, unless `--force`.
    ///
    /// # Errors
    /// If it needs more than the share that a run may take.
    pub(crate) fn refuse_too_large(&self, model: &Model) -> Result<(), CommandError> {
        self.refuse_too_large_beside(model, 1)
    }

    /// The same of a model of which `n` run at a time.
    pub(crate) fn refuse_too_large_beside(
        &self,
        model: &Model,
        n: u64,
    ) -> Result<(), CommandError> {
        let (Some(available), Some(grains)) = (available_memory_bytes(), model.grains()) else {
            return Ok(());
        };
        let estimate = Estimate::of(grains);
        let all_bytes = n.saturating_mul(estimate.memory_bytes);
        if self.force || all_bytes as f64 <= MEMORY_SHARE * available as f64 {
            return Ok(());
        }
        let [needed, free] = [all_bytes, available].map(output::bytes);
        if estimate.container_bytes as f64 > MEMORY_SHARE * available as f64 {
            return Err(CommandError::bad_input(format!(
                "cells of the size of the grains over a container {} m wide need about {needed}, and {free} are \
                 free; its {} grains cover the floor of one that is {:.3} m wide; --force goes on all the same",
                grains.medium.container.width,
                estimate.n_grains,
                grains.width_of_a_layer()
            )));
        }
        let beside = if n > 1 { format!(", {n} times side by side,") } else { String::new() };
        Err(CommandError::bad_input(format!(
            "{} grains{beside} need about {needed}, and {free} are free; --force goes on all the same",
            estimate.n_grains
        )))
    }

    /// The folder of prepared beds: `--cache`, else `$PLUNGE_CACHE`, else `runs/.cache`.
    pub(crate) fn cache_folder(&self) -> PathBuf {
        runner::cache_folder(self.cache.as_deref())
    }

    /// The bed of a model, from the cache or settled now.
    ///
    /// # Errors
    /// If it does not fit into memory, cannot be prepared, or was stopped.
    pub(crate) fn prepared(
        &self,
        grains: GrainModel<'_>,
        terminal: &mut Terminal,
    ) -> Result<PreparedBed, CommandError> {
        self.refuse_too_large(grains.model)?;
        let cache = self.cache_folder();
        let prepared = self.on_threads(|| prepare(grains, &cache, terminal))?;
        terminal.clear();
        prepared?.ok_or_else(|| terminal.interrupted("the same command goes on from here"))
    }

    /// Runs `work` on the threads that `--threads` asks for, else on one per core.
    ///
    /// # Errors
    /// If the system does not give them.
    pub(crate) fn on_threads<R: Send>(
        &self,
        work: impl FnOnce() -> R + Send,
    ) -> Result<R, CommandError> {
        let threads = self.threads.map_or(0, usize::from);
        with_threads(threads, work).map_err(|error| CommandError::Failed(error.into()))
    }
}

/// Where impacts are run.
#[derive(clap::ValueEnum, Clone, Copy, Debug)]
pub(crate) enum On {
    /// On the cores of this machine.
    Local,
    /// By SLURM, as job arrays.
    Slurm,
    /// By a running HyperQueue.
    Hyperqueue,
}

impl On {
    /// Who runs them, if not this machine.
    pub(crate) fn scheduler(self) -> Option<Scheduler> {
        match self {
            Self::Local => None,
            Self::Slurm => Some(Scheduler::Slurm),
            Self::Hyperqueue => Some(Scheduler::HyperQueue),
        }
    }
}

/// A scheduler that is not there is bad input; one that refuses has failed.
pub(crate) fn of_scheduler(error: SchedulerError) -> CommandError {
    match error {
        SchedulerError::Refused { .. } | SchedulerError::Script { .. } => {
            CommandError::Failed(error.into())
        }
        error => CommandError::bad_input(error),
    }
}
