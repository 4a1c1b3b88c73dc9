//! Numbers and words that a set may leave out.

use configs::reader::TableReader;
use engine::params::ParamSpec;

/// A number that may be left out; what is wrong with it is reported.
pub(crate) fn optional(table: &TableReader<'_>, spec: &ParamSpec) -> Option<f64> {
    table.optional_number(spec).flatten().map(|found| found.value)
}

/// One of the `known` words that may be left out; what is wrong with it is reported.
pub(crate) fn optional_choice(
    table: &TableReader<'_>,
    key: &'static str,
    known: &[&'static str],
    meaning: &str,
) -> Option<&'static str> {
    table.has(key).then(|| table.choice(key, known, &[], meaning)).flatten()
}
