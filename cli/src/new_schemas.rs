//! `plunge new schemas`: JSON schemas in the current folder, by which editors complete and check TOML.

use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use anyhow::Context as _;
use runner::campaign::file::json_schema::campaign;
use serde_json::{Value, json};

use crate::output::{self, CommandError, CommandResult};
use crate::workbench::write_whole;

/// The name that asks for schemas, and the folder that they are written to.
pub(crate) const NAME: &str = "schemas";

/// The file about models.
pub(crate) const MODEL: &str = "model.json";
/// The file about measurement sets.
pub(crate) const SET: &str = "measurement.json";
/// The file about campaigns.
pub(crate) const CAMPAIGN: &str = "campaign.json";

/// Writes the schemas into a folder that must not exist yet; with `json` says so as an object, with `quiet`
/// not at all.
pub(crate) fn run(json: bool, quiet: bool) -> CommandResult {
    let folder = Path::new(NAME);
    match fs::create_dir(folder) {
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {
            return Err(CommandError::bad_input(format!(
                "{NAME} exists already; remove it, or start in another folder"
            )));
        }
        made => made.with_context(|| format!("cannot make {NAME}"))?,
    }
    let made: [(&str, Value); 3] = [
        (MODEL, configs::json_schema::model()),
        (SET, measurements::json_schema::set()),
        (CAMPAIGN, campaign()),
    ];
    for (name, schema) in &made {
        let text = serde_json::to_string_pretty(schema).context("cannot write a schema")?;
        write_whole(&folder.join(name), &format!("{text}\n"))?;
    }
    let names = made.map(|(name, _)| name);
    match (json, quiet) {
        (true, _) => output::json_to_stdout(&json!({ "folder": NAME, "files": names })),
        (false, true) => Ok(()),
        (false, false) => output::to_stdout(&format!(
            "{NAME}/ written: {}\n\
             What plunge new writes names them in its first line. An editor with a TOML language server completes\n\
             and checks keys, units and ranges by them: in VS Code, the extension Even Better TOML.\n",
            names.join(", ")
        )),
    }
}
