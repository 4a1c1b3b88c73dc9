//! The files: tables, numbers and pictures.

use measurements::MeasurementSet;
use plots::PictureError;
use thiserror::Error;

use super::{WhereItFails, json, tables};
use crate::missing_force::{MissingForce, table};
use crate::picture;

/// Names of all files that there may be.
pub const FILES: [&str; 12] = [
    "force_errors.csv",
    "residuals.csv",
    "signatures.csv",
    "where_it_fails.json",
    "map-speed-angle.svg",
    "map-depth.svg",
    "residuals.svg",
    "covariates.svg",
    "errors.svg",
    "revisions.svg",
    "trajectories.svg",
    "signatures.svg",
];

/// The picture of a missing force.
pub const MISSING_FORCE: &str = "missing_force.svg";

/// What keeps a table or picture from being written.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum FilesError {
    #[error("cannot write a table: {0}")]
    Table(#[from] csv::Error),
    #[error("cannot write numbers: {0}")]
    Json(#[from] serde_json::Error),
    #[error(transparent)]
    Picture(#[from] PictureError),
}

/// Names and texts of the files of `force`: along the paths as a table, and its picture.
pub fn files_of(
    force: &MissingForce,
    set: &MeasurementSet,
) -> Result<Vec<(String, String)>, FilesError> {
    let picture = picture::missing_force(set, &force.readings)?;
    Ok(vec![
        (force.file.to_owned(), table(set, &force.readings)?),
        (MISSING_FORCE.to_owned(), picture),
    ])
}

impl WhereItFails<'_> {
    /// Names and texts of the files; without those that the set cannot have.
    pub fn files(&self) -> Result<Vec<(String, String)>, FilesError> {
        if self.models.is_empty() {
            return Ok(Vec::new());
        }
        let texts = [
            Some(tables::force_errors(self)?),
            Some(tables::residuals(self)?),
            tables::signatures(self)?,
            Some(json::text(self)?),
            picture::speed_angle(self)?,
            picture::depth(self)?,
            picture::residuals(self)?,
            picture::covariates(self)?,
            picture::errors(self)?,
            picture::revisions(self)?,
            picture::trajectories(self)?,
            picture::signatures(self)?,
        ];
        let named = FILES.iter().zip(texts);
        Ok(named.filter_map(|(name, text)| Some(((*name).to_owned(), text?))).collect())
    }
}
