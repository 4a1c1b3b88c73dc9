//! `plunge recover`: saves what is readable of a damaged or unfinished log.

use std::io::Write as _;
use std::path::Path;

use anyhow::Context as _;
use exchange::recover::{Lost, RecoverError, Recovered, recover};
use serde_json::json;

/// Exit status: everything was saved.
const DONE: u8 = 0;
/// Exit status: the input or the output cannot be used.
const BAD_INPUT: u8 = 2;
/// Exit status: a log was saved, but not all of it.
const SOMETHING_LOST: u8 = 3;

/// Recovers `input` into the new file `output` and returns the exit status.
///
/// The result goes to stdout (with `json` as one object), what was lost to stderr.
///
/// # Errors
/// The new log or the result could not be written.
pub(crate) fn run(input: &Path, output: &Path, json: bool) -> anyhow::Result<u8> {
    let recovered = match recover(input, output) {
        Ok(recovered) => recovered,
        Err(
            error @ (RecoverError::NotMcap { .. }
            | RecoverError::OutputExists { .. }
            | RecoverError::Io {
                doing: "open" | "read",
                ..
            }),
        ) => {
            writeln!(std::io::stderr(), "error: {error}")?;
            return Ok(BAD_INPUT);
        }
        Err(error) => return Err(error).context("nothing was recovered"),
    };
    let Recovered {
        messages,
        chunks,
        lost,
        complete,
    } = &recovered;
    let mut stdout = std::io::stdout();
    if json {
        let lost: Vec<_> = lost
            .iter()
            .map(|Lost { offset, bytes, why }| json!({ "offset": offset, "bytes": bytes, "why": why }))
            .collect();
        let result =
            json!({ "messages": messages, "chunks": chunks, "complete": complete, "lost": lost });
        writeln!(stdout, "{result}")?;
    } else {
        let state = if *complete {
            "a finished log"
        } else {
            "an unfinished log"
        };
        let to = output.display();
        writeln!(
            stdout,
            "{messages} messages from {chunks} chunks of {state} -> {to}"
        )?;
    }
    for Lost { offset, bytes, why } in lost {
        writeln!(std::io::stderr(), "lost: {bytes} bytes at {offset}: {why}")?;
    }
    Ok(if lost.is_empty() {
        DONE
    } else {
        SOMETHING_LOST
    })
}
