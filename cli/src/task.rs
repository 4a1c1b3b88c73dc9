//! `plunge task`: one bed or impact of a command that was given `--on`.

use std::path::PathBuf;

use runner::beds::BedTask;
use runner::work;

use crate::output::{CommandError, CommandResult};

/// Arguments of `plunge task`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// The list of tasks.
    list: PathBuf,
    /// The folder of beds and impacts.
    cache: PathBuf,
    /// Which task, counted from 1.
    number: usize,
}

pub(crate) fn run(args: &Args) -> CommandResult {
    work::<BedTask>(&args.list, &args.cache, args.number)
        .map_err(|error| CommandError::Failed(error.into()))
}
