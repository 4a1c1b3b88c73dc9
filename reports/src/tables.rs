//! The tables of a comparison and of a diagnosis, for pages and terminals alike.

use diagnosis::forward::observable::Observable;
use diagnosis::observed::error_columns::{Column, columns, named};
use serde_json::{Map, Value};

use crate::numbers::{fixed, four_digits, list, probability, text, texts};

/// A table: numbers to the right, sentences to the left and over several lines.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Names of the columns.
    pub head: Vec<String>,
    /// Cells by row, as many as there are columns.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    pub(crate) fn new(head: &[&str]) -> Self {
        Self { head: head.iter().map(|&name| name.to_owned()).collect(), rows: Vec::new() }
    }

    /// Whether it has no rows.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }
}

/// Root mean square errors of the `models` of a comparison, where fitted and held out.
pub fn errors(models: &[Value]) -> Table {
    let columns = columns();
    let measured: Vec<&Column> = columns
        .iter()
        .filter(|one| models.iter().any(|model| !model["rms"]["fit"][one.key].is_null()))
        .collect();
    let mut head = vec!["model", ""];
    head.extend(measured.iter().map(|one| one.heading.as_str()));
    head.extend(["\u{3c7}\u{b2}/n", "p (lack of fit)"]);
    let mut table = Table::new(&head);
    for model in models {
        for (role, shown) in [("fit", "fitted"), ("holdout", "held out")] {
            let errors = &model["rms"][role];
            if errors.is_null() {
                continue;
            }
            let fit = role == "fit";
            let mut row = vec![if fit { text(&model["model"]) } else { String::new() }];
            row.push(shown.to_owned());
            let error =
                |one: &&Column| fixed(errors[one.key].as_f64().map(|error| one.scale * error), 3);
            row.extend(measured.iter().map(error));
            row.push(if fit { fixed(model["chi2_per_n"].as_f64(), 2) } else { String::new() });
            row.push(if fit { probability(model["p_lof"].as_f64()) } else { String::new() });
            table.rows.push(row);
        }
    }
    table
}

/// The refitted parameters of the `models` of a comparison; beds have none.
pub fn parameters(models: &[Value]) -> Table {
    let mut table = Table::new(&["model", "parameter", "value", "standard error", "unit"]);
    let none = Map::new();
    for model in models {
        let parameters = model["parameters"].as_object().unwrap_or(&none);
        for (at, (name, entry)) in parameters.iter().enumerate() {
            table.rows.push(vec![
                if at == 0 { text(&model["model"]) } else { String::new() },
                name.clone(),
                four_digits(&entry["value"]),
                four_digits(&entry["se"]),
                text(&entry["unit"]),
            ]);
        }
    }
    table
}

/// Where the force of the `models` of a comparison is wrong.
pub fn failures(models: &[Value]) -> Table {
    let mut table = Table::new(&["model", "over", "from", "to", "force error (%)", "se (%)"]);
    for model in models {
        for fail in list(&model["fails"]) {
            let force_error =
                fail["force_error"].as_f64().map(|share| format!("{:+.1}", 100.0 * share));
            table.rows.push(vec![
                text(&model["model"]),
                text(&fail["over"]),
                four_digits(&fail["from"]),
                four_digits(&fail["to"]),
                force_error.unwrap_or_default(),
                fixed(fail["se"].as_f64().map(|share| 100.0 * share), 1),
            ]);
        }
    }
    table
}

/// The effects that a diagnosis ranks, the best first.
pub fn ranking(diagnosis: &Value) -> Table {
    let head =
        ["effect", "q", "se", "fall of \u{3c7}\u{b2}", "behind", "ranked first if there", "limit"];
    let mut table = Table::new(&head);
    let mut best = None;
    for effect in list(&diagnosis["ranking"]).iter().filter(|one| one["status"] == "ranked") {
        let delta = effect["delta"].as_f64();
        best = best.or(delta);
        let (q, se) = amplitude(effect);
        table.rows.push(vec![
            in_unit(effect),
            q,
            se,
            fixed(delta, 1),
            fixed(best.zip(delta).map(|(best, delta)| best - delta), 1),
            fixed(effect["predicted_top1"].as_f64(), 2),
            four_digits(&effect["detection_limit"]),
        ]);
    }
    table
}

/// An amplitude and its standard error; one that is held at an end of its range has none.
pub(crate) fn amplitude(of: &Value) -> (String, String) {
    let (q, end) = (four_digits(&of["q"]), "end of the range".to_owned());
    match of["at_bound"].as_str() {
        Some("lower") => (format!("at most {q}"), end),
        Some("upper") => (format!("at least {q}"), end),
        _ => (q, four_digits(&of["se"])),
    }
}

/// The name of an effect, with the unit of its amplitude where that is no pure number.
fn in_unit(effect: &Value) -> String {
    match effect["unit"].as_str() {
        None | Some("1" | "") => text(&effect["id"]),
        Some(unit) => format!("{} ({unit})", text(&effect["id"])),
    }
}

/// What a condition to measure next has, its key and its column.
const NEXT: [(&str, &str); 9] = [
    ("speed_m_per_s", "speed (m/s)"),
    ("angle_deg", "angle (deg)"),
    ("shape", "intruder"),
    ("diameter_m", "diameter (m)"),
    ("mass_kg", "mass (kg)"),
    ("spin_rad_per_s", "spin (rad/s)"),
    ("packing", "packing"),
    ("bed", "bed"),
    ("bed_depth_m", "depth of bed (m)"),
];

/// The conditions to measure next. A condition that is chosen twice has one row with the sum of its runs. Columns without any
/// value are left out.
pub fn next(diagnosis: &Value) -> Table {
    let all = list(&diagnosis["next"]);
    let is_stated = |key: &str| {
        all.iter().any(|one| !one[key].is_null() && (key != "spin_rad_per_s" || one[key] != 0.0))
    };
    let shown: Vec<_> = NEXT.iter().filter(|(key, _)| is_stated(key)).collect();
    let has_cost = is_stated("cost");
    let mut head: Vec<&str> = shown.iter().map(|(_, name)| *name).collect();
    head.extend(["runs", "told with those above (bit)", "separates most"]);
    head.extend(has_cost.then_some("cost"));
    let mut rows: Vec<(Vec<String>, u64, f64, &Value)> = Vec::new();
    for one in all {
        let cell =
            |key: &str| one[key].as_str().map_or_else(|| four_digits(&one[key]), str::to_owned);
        let condition: Vec<String> = shown.iter().map(|(key, _)| cell(key)).collect();
        let (mut runs, mut cost) =
            (one["repeats"].as_u64().unwrap_or(0), one["cost"].as_f64().unwrap_or(0.0));
        // The row stands at the place of the last choice, so that its information is that of all rows down to it.
        if let Some(before) = rows.iter().position(|(row, ..)| *row == condition) {
            let (_, earlier, paid, _) = rows.remove(before);
            (runs, cost) = (runs + earlier, cost + paid);
        }
        rows.push((condition, runs, cost, one));
    }
    let mut table = Table::new(&head);
    for (mut row, runs, cost, one) in rows {
        row.push(runs.to_string());
        row.push(fixed(one["expected_bits"].as_f64(), 2));
        row.push(texts(&one["separates"]).join(" from "));
        row.extend(has_cost.then(|| plots::short(cost)));
        table.rows.push(row);
    }
    table
}

/// What an earlier diagnosis expected of new runs, and what came.
pub fn new_runs(after: &Value) -> Table {
    let mut head = vec!["condition".to_owned(), "runs".to_owned(), "measured".to_owned()];
    let hypotheses = list(&after["hypotheses"]);
    head.extend(hypotheses.iter().map(|one| format!("with {}", text(&one["id"]))));
    let mut table = Table { head, rows: Vec::new() };
    for one in list(&after["came"]) {
        let quantity = one["quantity"].as_str().and_then(Observable::of_key);
        let (axis, [place, ..]) = match quantity {
            Some(quantity) => (named(quantity), quantity.axes()),
            None => continue,
        };
        let at = one["at"].as_f64();
        let at = at.map(|at| format!(" at {:.1} {}", place.scale * at, place.unit));
        let scaled = |value: &Value| fixed(value.as_f64().map(|value| axis.scale * value), 2);
        let mut row = vec![
            text(&one["condition"]),
            four_digits(&one["runs"]),
            format!("{} {}{}", scaled(&one["measured"]), axis.unit, at.unwrap_or_default()),
        ];
        let expected = list(&one["expected"]).iter();
        row.extend(
            expected.map(|one| format!("{} \u{b1} {}", scaled(&one["value"]), scaled(&one["se"]))),
        );
        table.rows.push(row);
    }
    table
}

/// How new runs moved the probabilities of the hypotheses.
pub fn hypotheses(after: &Value) -> Table {
    let head =
        ["hypothesis", "probability before", "after", "\u{3c7}\u{b2} per datum of the new runs"];
    let mut table = Table::new(&head);
    for one in list(&after["hypotheses"]) {
        table.rows.push(vec![
            text(&one["id"]),
            fixed(one["before"].as_f64(), 3),
            fixed(one["after"].as_f64(), 3),
            fixed(one["chi2_per_number"].as_f64(), 2),
        ]);
    }
    table
}

/// Simulated sets by what was hidden in them and what was said.
pub fn calibration(calibration: &Value) -> Table {
    let head = [
        "truth",
        "sets",
        "named alone",
        "in a set",
        "something else named",
        "intervals hold",
        "nothing named",
    ];
    let mut table = Table::new(&head);
    for row in list(&calibration["rows"]) {
        let cell = |key: &str| row[key].as_u64().unwrap_or_default().to_string();
        let counts = ["sets", "alone", "among", "wrong", "covered"].map(cell);
        let unnamed = row["unnamed"].as_object().into_iter().flatten();
        let unnamed: Vec<String> =
            unnamed.map(|(verdict, sets)| format!("{verdict} {sets}")).collect();
        let cells = [text(&row["truth"])].into_iter().chain(counts);
        table.rows.push(cells.chain([unnamed.join(", ")]).collect());
    }
    table
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn a_condition_that_is_chosen_twice_is_one_row_with_all_its_runs() {
        let one = |speed: f64, bits: f64| {
            json!({
                "speed_m_per_s": speed, "angle_deg": 90.0, "shape": "sphere", "spin_rad_per_s": 0.0, "packing": null,
                "repeats": 4, "expected_bits": bits, "separates": ["lift", "janssen"], "cost": null
            })
        };
        let table = next(&json!({ "next": [one(1.0, 0.3), one(2.0, 0.5), one(1.0, 0.6)] }));
        assert_eq!(
            table.head,
            [
                "speed (m/s)",
                "angle (deg)",
                "intruder",
                "runs",
                "told with those above (bit)",
                "separates most"
            ]
        );
        assert_eq!(table.rows[0][3..5], ["4", "0.50"]);
        assert_eq!(table.rows[1], ["1", "90", "sphere", "8", "0.60", "lift from janssen"]);
    }

    #[test]
    fn new_runs_are_told_in_the_unit_of_what_was_measured() {
        let came = |quantity: &str, measured: f64, at: f64| {
            json!({
                "condition": "a", "runs": 3, "quantity": quantity, "at": at, "measured": measured,
                "expected": [{ "value": measured, "se": 0.1 * measured }]
            })
        };
        let after = json!({
            "hypotheses": [{ "id": "lift" }],
            "came": [came("velocity_m_s", 0.12, 0.044), came("force_N", 5.06, 0.05), came("z_m", 0.02, 0.01)]
        });
        let table = new_runs(&after);
        let measured: Vec<&str> = table.rows.iter().map(|row| row[2].as_str()).collect();
        assert_eq!(measured, ["0.12 m/s at 44.0 ms", "5.06 N at 50.0 mm", "20.00 mm at 10.0 ms"]);
        assert_eq!(table.rows[2][3], "20.00 \u{b1} 2.00");
    }

    #[test]
    fn an_amplitude_at_the_end_of_its_range_has_no_error() {
        let table = ranking(&json!({ "ranking": [
            { "id": "lift", "status": "ranked", "q": 0.02, "se": 0.005, "delta": 12.0, "unit": "1" },
            { "id": "rail-friction", "status": "ranked", "q": 0.0, "at_bound": "lower", "delta": 1.5, "unit": "N" },
            { "id": "magnus", "status": "not-testable" },
        ] }));
        assert_eq!(table.rows[0][..5], ["lift", "0.02", "0.005", "12.0", "0.0"]);
        assert_eq!(
            table.rows[1][..5],
            ["rail-friction (N)", "at most 0", "end of the range", "1.5", "10.5"]
        );
        assert_eq!(table.rows.len(), 2);
    }
}
