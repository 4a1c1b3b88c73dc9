//! Tables and numbers of what is printed.

use comfy_table::presets::NOTHING;
use comfy_table::{CellAlignment, Table};
use serde_json::Value;

/// Where the errors come from, in words.
pub(crate) fn noise_words(noise: &Value) -> String {
    let percent = |key: &str| 100.0 * noise[key].as_f64().unwrap_or(0.0);
    match noise["source"].as_str() {
        Some("repeats") => format!(
            "from repeats: coefficients {:.1} %, force along the path {:.1} %, readings {}",
            percent("coefficient_sd"),
            percent("path_force_sd"),
            match noise["force_sigma_N"].as_f64() {
                Some(force) => format!("{force:.3} N"),
                None =>
                    format!("{:.2} mm", 1e3 * noise["position_sigma_m"].as_f64().unwrap_or(0.0)),
            }
        ),
        Some("stated") => "as stated by the set".to_owned(),
        _ => "not known".to_owned(),
    }
}

/// An empty table with right-aligned numbers behind the first column.
pub(crate) fn table(header: &[&str]) -> Table {
    let mut table = Table::new();
    table.load_preset(NOTHING).set_header(header);
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}

/// The lines of a table, indented, without trailing blanks.
pub(crate) fn lines(table: &Table) -> String {
    table.lines().map(|line| format!(" {}\n", line.trim_end())).collect()
}

/// A probability as one would write it.
pub(crate) fn probability(p: f64) -> String {
    match p {
        p if p < 1e-4 => "< 1e-4".to_owned(),
        p if p < 0.1 => format!("{p:.4}"),
        p => format!("{p:.2}"),
    }
}
