//! The flags that commands about a model share.

use std::num::NonZeroU16;
use std::path::PathBuf;

use clap::Args;
use configs::{LoadOptions, Loaded, Model, ModelSource};

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
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Threads to use; they never change a result.
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<NonZeroU16>,
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
    pub(crate) fn load(&self, model: &std::path::Path) -> Result<Loaded, CommandError> {
        let options = LoadOptions {
            sets: self.sets.clone(),
            seed: self.seed,
            allow_paths: self.allow_paths.clone(),
        };
        let loaded = Model::load(ModelSource::from_argument(model), &options)?;
        if !self.quiet {
            output::show_warnings(&loaded);
        }
        Ok(loaded)
    }
}
