//! What the logs of all runs say of their model.

use std::collections::BTreeMap;

use configs::{Condition, Model};
use engine::record::LogAttachment;

use super::Task;
use super::model_file::model_text;

/// A force of this many weights of the intruder is drawn as long as the intruder is wide.
const WEIGHTS_PER_ARROW: f64 = 10.0;

/// Length of a drawn force (m/N) on an intruder `wide` (m) with `weight` (N); without a weight there is
/// nothing to measure it by, and none is drawn.
pub(super) fn arrow_m_per_newton(wide: f64, weight: f64) -> f64 {
    if weight > 0.0 { wide / (WEIGHTS_PER_ARROW * weight) } else { 0.0 }
}

/// The first event of a log.
pub(super) fn opening(model: &Model, condition: &Condition) -> String {
    let (speed, angle) = (condition.speed, condition.angle_deg());
    match model.launch(condition).pushed_to {
        Some(depth) => {
            format!("pushed at {speed} m/s, {angle} deg from the horizontal, to {depth} m")
        }
        None => format!("impact at {speed} m/s, {angle} deg from the horizontal"),
    }
}

/// The metadata that every log has.
pub(super) fn metadata(model: &Model, condition: &Condition) -> BTreeMap<String, String> {
    BTreeMap::from(
        [
            ("plunge_version", env!("CARGO_PKG_VERSION").to_owned()),
            ("name", model.run.name.clone()),
            ("model_hash", model.hash()),
            ("seed", model.run.seed.to_string()),
            ("speed_m_per_s", condition.speed.to_string()),
            ("angle_deg", condition.angle_deg().to_string()),
        ]
        .map(|(key, value)| (key.to_owned(), value)),
    )
}

/// The model as its author wrote it, and as it was understood.
pub(super) fn attachments(task: &Task<'_>) -> Vec<LogAttachment> {
    let texts =
        [("model.toml", task.original.to_owned()), ("model.resolved.toml", model_text(task.model))];
    texts
        .map(|(name, text)| LogAttachment {
            name: name.to_owned(),
            media_type: "application/toml".to_owned(),
            data: text.into_bytes(),
        })
        .into()
}
