//! Tables and numbers of what is printed.

use std::borrow::Cow;

use comfy_table::presets::NOTHING;
use comfy_table::{CellAlignment, ContentArrangement, Table};
use measurements::curves;
use serde_json::Value;
use terminal_size::{Width, terminal_size_of};

/// Where the errors come from, in words.
pub(crate) fn noise_words(noise: &Value) -> String {
    let percent = |key: &str| 100.0 * noise[key].as_f64().unwrap_or(0.0);
    match (noise["source"].as_str(), noise["run_sd_rel"].is_number()) {
        (Some("repeats"), true) => format!(
            "from repeats: runs scatter by {:.1} %, readings by {}",
            percent("run_sd_rel"),
            reading(noise)
        ),
        (Some("repeats"), false) => format!(
            "from repeats: coefficients {:.1} %, force along the path {:.1} %, readings {}",
            percent("coefficient_sd"),
            percent("path_force_sd"),
            reading(noise)
        ),
        (Some("stated"), _) => "as stated by the set".to_owned(),
        _ => "not known".to_owned(),
    }
}

/// The error of a reading in its own unit.
fn reading(noise: &Value) -> String {
    let number = |key: &str| noise[key].as_f64();
    let mut of_curves = curves().filter_map(|curve| {
        let axis = curve.value;
        number(curve.sigma_key).map(|error| format!("{:.3} {}", axis.scale * error, axis.unit))
    });
    of_curves
        .next()
        .unwrap_or_else(|| format!("{:.2} mm", 1e3 * number("position_sigma_m").unwrap_or(0.0)))
}

/// An empty table with right-aligned numbers behind the first column, as wide as a terminal at most.
pub(crate) fn table(header: &[&str]) -> Table {
    let mut table = Table::new();
    table.load_preset(NOTHING).set_header(header);
    if let Some(width) = terminal_width() {
        table.set_content_arrangement(ContentArrangement::Dynamic);
        table.set_width(width.saturating_sub(INDENT));
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}

/// The lines of a table of a report.
pub(crate) fn shown(of_report: &reports::tables::Table) -> String {
    let head: Vec<&str> = of_report.head.iter().map(String::as_str).collect();
    let mut table = table(&head);
    table.add_rows(&of_report.rows);
    lines(&table)
}

/// Columns of the terminal that reads the results; none where a file or a pipe does.
fn terminal_width() -> Option<u16> {
    terminal_size_of(std::io::stdout()).map(|(Width(width), _)| width)
}

/// `text` with lines no wider than a terminal that reads it.
pub(crate) fn fitted(text: &str) -> Cow<'_, str> {
    match terminal_width() {
        Some(width) => Cow::Owned(fitted_to(text, width.into())),
        None => Cow::Borrowed(text),
    }
}

/// `text` with its wider lines broken between words; what continues a line is indented as that is.
fn fitted_to(text: &str, width: usize) -> String {
    let fitted = text.split_inclusive('\n').map(|line| {
        let (line, end) = match line.strip_suffix('\n') {
            Some(line) => (line, "\n"),
            None => (line, ""),
        };
        let indent = &line[..line.len() - line.trim_start().len()];
        // A name, a number with its sign and an address stay whole.
        let options = textwrap::Options::new(width)
            .subsequent_indent(indent)
            .break_words(false)
            .word_splitter(textwrap::WordSplitter::NoHyphenation);
        textwrap::fill(line, options) + end
    });
    fitted.collect()
}

/// What the lines of a table are indented by.
const INDENT: u16 = 1;

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wide_lines_are_broken_between_words_and_narrow_ones_stay() {
        let text =
            "VERDICT  none\n a  1.0   2.0\n  added mass of a cone in water, /a/path-that/is/long\n";
        let expected = "VERDICT  none\n a  1.0   2.0\n  added mass of\n  a cone in\n  water,\n  /a/path-that/is/long\n";
        assert_eq!(fitted_to(text, 16), expected);
        assert_eq!(fitted_to(text, 80), text);
    }
}
