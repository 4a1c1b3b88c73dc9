//! Numbers that a set may leave out.

use configs::reader::TableReader;
use engine::params::ParamSpec;

/// A number that may be left out; what is wrong with it is reported.
pub(super) fn optional(table: &TableReader<'_>, spec: &ParamSpec) -> Option<f64> {
    table.optional_number(spec).flatten().map(|found| found.value)
}
