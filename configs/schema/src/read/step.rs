//! Time steps.

use engine::params::ParamSpec;

use crate::model::TimeStep;
use crate::reader::{Answer, TableReader};

/// A fixed step or `"auto"`.
pub(super) fn time_step(
    table: &TableReader<'_>,
    spec: &ParamSpec,
    default: Option<&str>,
) -> Option<TimeStep> {
    table.asks(spec.key, spec.meaning, || Answer::Number(*spec));
    table.asks(spec.key, spec.meaning, || Answer::Choice(vec!["auto"]));
    let auto = match table.has(spec.key) {
        true => table.peek_text(spec.key) == Some("auto"),
        false => default == Some("auto"),
    };
    if auto {
        table.note_text(spec.key, "auto");
        return Some(TimeStep::Auto);
    }
    table.number(spec).map(|found| TimeStep::Fixed(found.value))
}
