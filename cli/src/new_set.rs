//! `plunge new measurements`: a commented measurement set in the current folder.

use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use anyhow::Context as _;
use configs::json_schema::header;
use measurements::TEMPLATE;
use serde_json::json;

use crate::new_schemas::{self, SET};
use crate::output::{self, CommandError, CommandResult};
use crate::workbench::write_whole;

/// The name that asks for a set, and the folder that it is written to.
pub(crate) const NAME: &str = "measurements";

/// Writes the set into a folder that must not exist yet; with `json` says so as an object, with `quiet`
/// not at all.
pub(crate) fn run(json: bool, quiet: bool) -> CommandResult {
    let folder = Path::new(NAME);
    match fs::create_dir(folder) {
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {
            return Err(CommandError::bad_input(format!(
                "{NAME} exists already; rename it, or start in another folder"
            )));
        }
        made => made.with_context(|| format!("cannot make {NAME}"))?,
    }
    for (name, text) in TEMPLATE {
        let schema = match name.ends_with(".toml") {
            true => header(&format!("../{}/{SET}", new_schemas::NAME)),
            false => String::new(),
        };
        write_whole(&folder.join(name), &format!("{schema}{text}"))?;
    }
    match (json, quiet) {
        (true, _) => output::json_to_stdout(&json!({
            "folder": NAME,
            "files": TEMPLATE.map(|(name, _)| name),
        })),
        (false, true) => Ok(()),
        (false, false) => output::to_stdout(&format!(
            "{NAME}/ written, with invented numbers: {}\n\
             plunge check {NAME} --out seen   shows and draws what is understood\n\
             plunge compare {NAME}            holds its baseline against it\n",
            TEMPLATE.map(|(name, _)| name).join(", ")
        )),
    }
}
