//! JSON schemas, by which editors complete and check TOML.

use anyhow::Context as _;
use runner::campaign::file::json_schema::campaign;

use crate::output::CommandError;

/// The folder that they are written to.
pub(super) const FOLDER: &str = "schemas";

/// The file about models.
pub(super) const MODEL: &str = "model.json";
/// The file about measurement sets.
pub(super) const SET: &str = "measurement.json";
/// The file about campaigns.
pub(super) const CAMPAIGN: &str = "campaign.json";

/// Names and texts of the files.
pub(super) fn files() -> Result<Vec<(&'static str, String)>, CommandError> {
    let made = [
        (MODEL, configs::json_schema::model()),
        (SET, measurements::json_schema::set()),
        (CAMPAIGN, campaign()),
    ];
    made.into_iter()
        .map(|(name, schema)| {
            let text = serde_json::to_string_pretty(&schema).context("cannot write a schema")?;
            Ok((name, format!("{text}\n")))
        })
        .collect()
}
