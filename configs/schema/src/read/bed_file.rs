//! The bed that a model takes from a data file.

use std::path::{Path, PathBuf};

use engine::grains::Space;

use crate::diagnostics::Diagnostic;
use crate::grains_csv::{self, Room};
use crate::model::{Container, CsvBed};
use crate::paths;
use crate::reader::TableReader;

/// Where the data files of a model may lie.
pub(crate) struct DataFolder<'a> {
    /// The folder of the model file.
    pub(crate) folder: &'a Path,
    /// Folders allowed besides.
    pub(crate) allow_paths: &'a [PathBuf],
    /// The table of grains that was read before; no file is looked at then.
    pub(crate) known: Option<&'a CsvBed>,
}

/// `file`, read whole and checked against the container.
pub(crate) fn csv_bed(
    table: &TableReader<'_>,
    (space, container): (Space, Option<&Container>),
    folder: &DataFolder<'_>,
) -> Option<CsvBed> {
    let mut settles = false;
    let of_preparation = [
        "inflated_to",
        "preparation_friction",
        "settling_drag",
        "preparation_time_step",
        "grains",
        "effect",
    ];
    for key in of_preparation {
        if table.has(key) {
            table.reader.report(
                Diagnostic::error(format!("`{key}` is for a bed that settles"))
                    .at(table.span_of(key), "this bed is read from a file")
                    .with(table.span_of("source"), "as this says")
                    .help("remove it, or write source = \"settle\""),
            );
            settles = true;
        }
    }
    let named = table.text("file", None, "grains.csv", "the table of grains")?;
    let expected = match table.has("file_blake3") {
        true => Some(table.raw_text("file_blake3", None, "", "the content of the file")?),
        false => None,
    };
    if let Some(known) = folder.known {
        table.note_text("file_blake3", &known.blake3);
        return (!settles).then(|| known.clone());
    }
    let fault = |message: String| {
        table.reader.report(Diagnostic::error(message).at(named.span, "this file").help(
            match space {
                Space::Planar => "columns: x_m, y_m, radius_m, and mass_kg or density_kg_per_m2",
                Space::Spatial => {
                    "columns: x_m, y_m, z_m, radius_m, and mass_kg or density_kg_per_m3"
                }
            },
        ));
    };
    let read = paths::resolve(&named.value, folder.folder, folder.allow_paths)
        .and_then(|file| paths::read_data(&file, &named.value).map(|bytes| (file, bytes)));
    let (file, bytes) = match read {
        Ok(read) => read,
        Err(error) => {
            table
                .reader
                .report(Diagnostic::error(error.to_string()).at(named.span, "cannot be read"));
            return None;
        }
    };
    let blake3 = blake3::hash(&bytes).to_hex().to_string();
    table.note_text("file_blake3", &blake3);
    if let Some(expected) = expected.filter(|expected| expected.value != blake3) {
        table.reader.report(
            Diagnostic::error("the table of grains is not the one this model was made with")
                .at(expected.span, "the expected content")
                .with(named.span, "has another content")
                .help(format!("to accept the file as it is now: file_blake3 = \"{blake3}\"")),
        );
        return None;
    }
    let container = container?.without_layers();
    match grains_csv::read(&bytes, Room { space, container }) {
        Ok(read) => {
            for warning in read.warnings {
                table.reader.report(Diagnostic::warning(warning).at(named.span, "in this file"));
            }
            let grains = read.grains.into();
            (!settles).then_some(CsvBed { file, named: named.value, blake3, grains })
        }
        Err(faults) => {
            for one in faults {
                fault(format!("{}: {one}", crate::diagnostics::shorten(&named.value)));
            }
            None
        }
    }
}
