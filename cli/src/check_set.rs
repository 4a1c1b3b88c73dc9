//! `plunge check SET`: what is understood of a measurement set.

use std::path::Path;

use configs::{Color, Sources, document, limits, paths};
use serde_json::{Value, json};
use validation::measurement::{Loaded, MeasurementSet, Role};

use crate::common::Common;
use crate::output::{self, CommandError, CommandResult, stderr_color};

/// The file of a set, in its folder.
const SET: &str = "measurement.toml";

/// Whether `path` is a folder with a measurement.toml, that file, or another with its main table.
pub(crate) fn is_set(path: &Path) -> bool {
    if path.is_dir() {
        return path.join(SET).is_file();
    }
    path.is_file() && (path.ends_with(SET) || has_main_table(path))
}

/// Whether the file at `path` has the table `[measurement]`; what cannot be read has none.
fn has_main_table(path: &Path) -> bool {
    let name = path.display().to_string();
    let bytes = paths::read_bounded(path, &name, limits::FILE_BYTES).ok();
    let Some(text) = bytes.and_then(|bytes| String::from_utf8(bytes).ok()) else {
        return false;
    };
    let mut sources = Sources::default();
    let id = sources.add(name, text);
    document::parse(&sources, id).is_ok_and(|root| root.has("measurement"))
}

pub(crate) fn run(path: &Path, common: &Common) -> CommandResult {
    if !common.sets.is_empty() {
        return Err(CommandError::bad_input(
            "--set changes models; a measurement set is what it is",
        ));
    }
    let loaded = MeasurementSet::load(path)?;
    if !common.quiet {
        output::to_stderr(&loaded.render_warnings(stderr_color()));
    }
    match common.json {
        true => output::json_to_stdout(&as_json(&loaded)),
        false => output::to_stdout(&loaded.describe()),
    }
}

fn as_json(loaded: &Loaded) -> Value {
    let set = &loaded.set;
    let with = |role: Role| set.conditions.iter().filter(|one| one.role == role).count();
    let warnings: Vec<String> =
        loaded.warnings.iter().map(|one| one.render(&loaded.sources, Color::Off)).collect();
    json!({
        "set": set.id,
        "valid": true,
        "conditions": set.conditions.len(),
        "runs": set.runs.len(),
        "fit": with(Role::Fit),
        "holdout": with(Role::Holdout),
        "notes": set.notes,
        "warnings": warnings,
    })
}
