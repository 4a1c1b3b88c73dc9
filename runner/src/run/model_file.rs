//! `model.toml` of an output folder, and the table of grains beside it.

use std::fs;

use configs::Model;

use super::error::RunError;
use super::folder::OutputFolder;

/// Name of the table of grains in an output folder.
pub(super) const GRAINS: &str = "grains.csv";

/// `model.toml` of an output folder: the resolved model, its table of grains beside it.
pub(super) fn model_text(model: &Model) -> String {
    model.toml_with_table(GRAINS)
}

/// The table of grains of `model` as it was when the model was read; none if the bed settles.
///
/// It may lie in the output folder, so it is read before anything is written there.
pub(super) fn table_of(model: &Model) -> Result<Option<Vec<u8>>, RunError> {
    let Some(csv) = model.csv() else { return Ok(None) };
    let table = fs::read(&csv.file).map_err(|source| RunError::io("read", &csv.file, source))?;
    match blake3::hash(&table).to_hex().as_str() == csv.blake3 {
        true => Ok(Some(table)),
        false => Err(RunError::TableChanged { path: csv.file.clone() }),
    }
}

/// Writes `model.toml`, and the table of grains that it reads.
pub(super) fn write_model(
    folder: &OutputFolder,
    model: &Model,
    table: Option<&[u8]>,
) -> Result<(), RunError> {
    // The model first: a folder with a table but no model would not be known as ours.
    folder.write("model.toml", model_text(model).as_bytes())?;
    table.map_or(Ok(()), |table| folder.write(GRAINS, table))
}
