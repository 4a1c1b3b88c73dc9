//! `plunge export`: a run, or an impact on a bed, as files of other programs.

mod log;
mod model;

use std::path::PathBuf;

use clap::ValueEnum;
use clap::builder::PossibleValue;
use exchange::export::Format;

use crate::common::Common;
use crate::output::CommandResult;

/// Arguments of `plunge export`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// The folder of a run, or one of its logs; for `lammps` a model.
    source: PathBuf,
    /// The format. Without --out, a run is written into a folder of its own, called like the format.
    #[arg(long, value_name = "FORMAT")]
    to: To,
    #[command(flatten)]
    common: Common,
}

/// A format as an argument.
#[derive(Clone, Copy, Debug)]
enum To {
    /// Files of a run.
    Log(Format),
    /// An input script and a data file of LAMMPS, of a model.
    Lammps,
}

impl ValueEnum for To {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [To; Format::ALL.len() + 1] = {
            let mut all = [To::Lammps; Format::ALL.len() + 1];
            let mut at = 0;
            while at < Format::ALL.len() {
                all[at] = To::Log(Format::ALL[at]);
                at += 1;
            }
            all
        };
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let named = |format: &Format| PossibleValue::new(format.name()).help(format.purpose());
        Some(match self {
            Self::Log(format @ Format::Vtp) => named(format).alias("vtk"),
            Self::Log(format @ Format::ExtendedXyz) => named(format).alias("xyz"),
            Self::Log(format) => named(format),
            Self::Lammps => PossibleValue::new("lammps").help("an input script and its data file"),
        })
    }
}

pub(crate) fn run(args: &Args) -> CommandResult {
    match args.to {
        To::Log(format) => log::write(&args.source, format, &args.common),
        To::Lammps => model::write(&args.source, &args.common),
    }
}
