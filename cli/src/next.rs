//! What `plunge diagnose` says of the next experiment.

use comfy_table::Cell;
use diagnosis::next::Recommendation;
use diagnosis::verdict::{Diagnosis, Verdict};

use crate::text::{lines, table};

/// The recommendations that `diagnosis` carries, best first, as text; nothing where nothing is to be
/// told apart.
pub(crate) fn as_text(diagnosis: &Diagnosis, next: &[Recommendation]) -> String {
    let Some(best) = next.first() else {
        return match diagnosis.verdict {
            Verdict::NotSeparable => {
                "\nNEXT  no feasible condition can be predicted by the model.\n".to_owned()
            }
            _ => String::new(),
        };
    };
    let runs = best.repeats;
    let head = match best.is_enough() {
        true => format!("\nNEXT  measure one of these, {runs} runs:\n"),
        false => format!(
            "\nNEXT  no feasible condition separates {} with {runs} runs; best:\n",
            best.separates.join(" and ")
        ),
    };
    let header = [
        "speed (m/s)",
        "angle (deg)",
        "intruder",
        "diameter (m)",
        "mass (kg)",
        "spin (rad/s)",
        "packing",
        "bed (m)",
        "delta",
        "separated",
        "separates",
    ];
    let mut table = table(&header);
    let or_dash = |value: Option<f64>| value.map_or("-".to_owned(), |value| digits(value, 3));
    for one in next {
        let condition = &one.condition;
        table.add_row(
            [
                digits(condition.speed, 3),
                digits(condition.angle_deg, 3),
                condition.shape.clone(),
                digits(condition.diameter, 3),
                digits(condition.mass, 3),
                digits(condition.spin, 3),
                or_dash(condition.packing),
                or_dash(condition.bed_depth),
                format!("{:.1}", one.expected_delta),
                format!("{:.2}", one.probability_separated()),
                one.separates.join(", "),
            ]
            .map(Cell::new),
        );
    }
    head + &lines(&table)
}

/// `value` to so many significant digits, without zeros at its end.
fn digits(value: f64, n: usize) -> String {
    let rounded = format!("{value:.*e}", n - 1).parse().unwrap_or(value);
    format!("{rounded}")
}
