//! `model.toml` of an output folder, and the table of grains beside it.

use std::fs;
use std::path::Path;

use toml_edit::{DocumentMut, value};

use super::RunError;
use super::folder::OutputFolder;
use crate::load::{LoadOptions, ModelSource};
use crate::model::{BedSource, Condition, CsvBed, Model};

/// Name of the table of grains in an output folder.
const GRAINS: &str = "grains.csv";

/// `model.toml` of an output folder: the resolved model, its table of grains beside it.
pub(super) fn model_text(model: &Model) -> String {
    edited(model, |document| {
        if csv_of(model).is_some() {
            document["bed"]["file"] = value(GRAINS);
        }
    })
}

/// The table of grains of `model` as it was when the model was read; none if the bed settles.
///
/// It may lie in the output folder, so it is read before anything is written there.
pub(super) fn table_of(model: &Model) -> Result<Option<Vec<u8>>, RunError> {
    let Some(csv) = csv_of(model) else { return Ok(None) };
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

fn csv_of(model: &Model) -> Option<&CsvBed> {
    match &model.grains()?.medium.bed.source {
        BedSource::Csv(csv) => Some(csv),
        BedSource::Settle(_) => None,
    }
}

fn edited(model: &Model, edit: impl FnOnce(&mut DocumentMut)) -> String {
    let mut document: DocumentMut =
        model.resolved_toml().parse().expect("the resolved model is TOML");
    edit(&mut document);
    document.to_string()
}

impl Model {
    /// This model with the single impact `condition`; `folder` holds its table of grains, if it has
    /// one.
    pub(super) fn single(&self, condition: &Condition, folder: &Path) -> Result<Self, RunError> {
        let text = edited(self, |document| {
            document.remove("conditions");
            let impact = &mut document["impact"];
            impact["speed"] = value(format!("{} m/s", condition.speed));
            impact["angle"] = value(format!("{} rad", condition.angle_rad));
            if let Some(grains) = self.grains() {
                impact["x"] = value(format!("{} m", grains.start_x(condition)));
            }
            if csv_of(self).is_some() {
                document["bed"]["file"] = value(GRAINS);
            }
        });
        let source = ModelSource::Text {
            name: format!("one impact of {}", self.run.name),
            text,
            folder: folder.to_owned(),
        };
        Ok(Self::load(source, &LoadOptions::default())?.model)
    }
}
