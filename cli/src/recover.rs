//! `plunge recover`: saves what is readable of a damaged or unfinished log.

use std::path::PathBuf;

use anyhow::Context as _;
use exchange::recover::{Lost, RecoverError, Recovered, recover};
use serde_json::json;

use crate::BEGINS_AGAIN;
use crate::control::stopped;
use crate::output::{self, CommandError, CommandResult};
use crate::signals;

/// Exit code when a log was saved, but not all of it.
const SOMETHING_LOST: u8 = 3;

/// Arguments of `plunge recover`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// The damaged or unfinished log.
    input: PathBuf,
    /// The log to write; it must not exist yet.
    output: PathBuf,
    /// Print one JSON object to stdout.
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &Args) -> CommandResult {
    signals::will_be_asked_for();
    let recovered = recover(&args.input, &args.output, &signals::is_asked_to_stop);
    let Recovered { messages, chunks, lost, complete } = match recovered {
        Ok(recovered) => recovered,
        Err(RecoverError::Stopped) => return Err(stopped(BEGINS_AGAIN)),
        Err(
            error @ (RecoverError::NotMcap { .. }
            | RecoverError::OutputExists { .. }
            | RecoverError::Io { doing: "open" | "read", .. }),
        ) => return Err(CommandError::bad_input(error)),
        Err(error) => {
            return Err(Err::<(), _>(error).context("nothing was recovered").unwrap_err().into());
        }
    };
    if args.json {
        let lost: Vec<_> = lost
            .iter()
            .map(|Lost { offset, bytes, why }| json!({ "offset": offset, "bytes": bytes, "why": why }))
            .collect();
        output::json_to_stdout(
            &json!({ "messages": messages, "chunks": chunks, "complete": complete, "lost": lost }),
        )?;
    } else {
        let state = if complete { "a finished log" } else { "an unfinished log" };
        let to = args.output.display();
        output::to_stdout(&format!(
            "{messages} messages from {chunks} chunks of {state} -> {to}\n"
        ))?;
    }
    if lost.is_empty() {
        return Ok(());
    }
    let lines = lost
        .iter()
        .map(|Lost { offset, bytes, why }| format!("lost: {bytes} bytes at {offset}: {why}\n"));
    Err(CommandError::Partly { code: SOMETHING_LOST, message: lines.collect() })
}
