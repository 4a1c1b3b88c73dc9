//! What `plunge diagnose` says of the next experiment.

use diagnosis::next::Next;
use reports::tables;
use serde_json::Value;

use crate::text::shown;

/// `next`, which the JSON `object` of its diagnosis holds, as text.
pub(crate) fn as_text(next: &Next, object: &Value) -> String {
    let Next { open_bits, best, feasible } = next;
    let Some(last) = best.last() else {
        let most = feasible.iter().map(|one| one.expected_bits).fold(0.0, f64::max);
        return match feasible.is_empty() {
            true => "\nNEXT  no feasible condition can be predicted by the model.\n".to_owned(),
            false => format!(
                "\nNothing feasible would tell them apart: the best condition is expected to tell {most:.2} of {open_bits:.2} bit. Wider \
                 limits in `[feasible]`, another body or more runs of each condition may.\n"
            ),
        };
    };
    let table = tables::next(object);
    let what = if table.rows.len() == 1 { "this" } else { "these" };
    format!(
        "\nNEXT  measure {what}; expected to tell {:.2} of {open_bits:.2} bit:\n{}",
        last.expected_bits,
        shown(&table)
    )
}
