//! What `plunge diagnose` says of the next experiment.

use comfy_table::Cell;
use diagnosis::next::Next;
use reports::rounded;

use crate::text::{lines, table};

/// `next` as text.
pub(crate) fn as_text(next: &Next) -> String {
    let Next { open_bits, best, feasible } = next;
    let Some(last) = best.last() else {
        let most = feasible.iter().map(|one| one.expected_bits).fold(0.0, f64::max);
        return match feasible.is_empty() {
            true => "\nNEXT  no feasible condition can be predicted by the model.\n".to_owned(),
            false => format!(
                "\nNothing feasible would tell them apart: the best condition is expected to tell {most:.2} of {open_bits:.2} bit.\n"
            ),
        };
    };
    let runs = last.repeats;
    let head = match best.len() {
        1 => format!("\nNEXT  measure this, {runs} runs"),
        n => format!("\nNEXT  measure these {n}, {runs} runs each"),
    };
    let head =
        format!("{head}; expected to tell {:.2} of {open_bits:.2} bit:\n", last.expected_bits);
    let has_cost = best.iter().any(|one| one.cost.is_some());
    let header = [
        "speed (m/s)",
        "angle (deg)",
        "intruder",
        "diameter (m)",
        "mass (kg)",
        "spin (rad/s)",
        "packing",
        "bed",
        "depth of bed (m)",
        "told (bit)",
        "separates most",
    ];
    let cost = has_cost.then_some("cost");
    let mut table = table(&header.into_iter().chain(cost).collect::<Vec<_>>());
    let or_dash =
        |value: Option<f64>| value.map_or("-".to_owned(), |value| rounded(value, 3).to_string());
    for one in best {
        let condition = &one.condition;
        table.add_row(
            [
                rounded(condition.speed, 3).to_string(),
                rounded(condition.angle_deg, 3).to_string(),
                condition.shape.clone(),
                rounded(condition.diameter, 3).to_string(),
                rounded(condition.mass, 3).to_string(),
                rounded(condition.spin, 3).to_string(),
                or_dash(condition.packing),
                one.bed.clone().unwrap_or_else(|| "-".to_owned()),
                or_dash(condition.bed_depth),
                format!("{:.2}", one.expected_bits),
                one.separates.join(", "),
            ]
            .into_iter()
            .chain(has_cost.then(|| or_dash(one.cost)))
            .map(Cell::new),
        );
    }
    head + &lines(&table)
}
