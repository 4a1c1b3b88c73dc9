//! A table as cells.

use super::fault::Fault;

/// One row of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Row {
    /// Line of the text or row of the sheet, from 1.
    pub(super) line: u64,
    /// Without blanks around them.
    pub(super) cells: Vec<String>,
}

impl Row {
    /// The cell at `column`; empty where the row is shorter.
    pub(super) fn cell(&self, column: usize) -> &str {
        self.cells.get(column).map_or("", String::as_str)
    }

    /// Whether nothing stands in it.
    pub(super) fn is_blank(&self) -> bool {
        self.cells.iter().all(String::is_empty)
    }
}

/// A table, its blank rows left out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Sheet {
    /// What messages call it.
    pub(super) file: String,
    /// The name of the file without its ending, and the name of the sheet where there are several.
    pub(super) stem: String,
    /// How cells are told apart, in words.
    pub(super) separated: &'static str,
    /// Whether decimals stand behind a comma.
    pub(super) decimal_comma: bool,
    /// Rows with something in them.
    pub(super) rows: Vec<Row>,
    /// What was assumed to read it, in sentences.
    pub(super) notes: Vec<String>,
}

/// What stands in the cell of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Number {
    /// A finite number.
    Value(f64),
    /// Nothing, or a mark for it.
    Missing,
    /// Something else.
    Other,
}

impl Sheet {
    /// The number in `cell`.
    pub(super) fn number(&self, cell: &str) -> Number {
        number(cell, self.decimal_comma)
    }

    /// Whether `row` has at least so many numbers, and no fewer of them than words.
    pub(super) fn is_numeric(&self, row: &Row, least: usize) -> bool {
        let kinds = || row.cells.iter().map(|cell| self.number(cell));
        let numbers = kinds().filter(|kind| matches!(kind, Number::Value(_))).count();
        let words = kinds().filter(|kind| *kind == Number::Other).count();
        numbers >= least && numbers >= words
    }

    /// Whether a cell of `row` is neither a number nor a mark for a missing one.
    pub(super) fn has_words(&self, row: &Row) -> bool {
        row.cells.iter().any(|cell| self.number(cell) == Number::Other)
    }

    /// The same table with nothing in it.
    pub(super) fn without_rows(&self) -> Self {
        let (file, stem) = (self.file.clone(), self.stem.clone());
        Self { file, stem, rows: Vec::new(), notes: Vec::new(), ..*self }
    }

    /// A fault of the whole table.
    pub(super) fn fault(&self, what: impl Into<String>, right: impl Into<String>) -> Fault {
        Fault::new(&self.file, what, right)
    }
}

/// The number in `cell`, whose decimals stand behind a comma or a point.
pub(super) fn number(cell: &str, decimal_comma: bool) -> Number {
    let lower = cell.to_ascii_lowercase();
    let marks = ["", "nan", "-", "--", "n/a", "na", "#n/a", "none", "null", "#value!", "#div/0!"];
    if marks.contains(&lower.as_str()) {
        return Number::Missing;
    }
    let plain = ascii(cell);
    let cell = plain.as_deref().unwrap_or(cell);
    let cell = match decimal_comma {
        true => without_groups(cell, '.', ','),
        false => without_groups(cell, ',', '.'),
    };
    let text = match decimal_comma {
        true if cell.contains('.') => return Number::Other,
        true => cell.replace(',', "."),
        false => cell,
    };
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && text.contains(|c: char| c.is_ascii_digit()) => {
            Number::Value(value)
        }
        _ => clock(&text).or_else(|| of_fortran(&text)).map_or(Number::Other, Number::Value),
    }
}

/// A number as spreadsheets of other languages write it, with a minus sign for the hyphen and narrow blanks between groups, in
/// ASCII; `None` where `cell` is in ASCII.
fn ascii(cell: &str) -> Option<String> {
    const BLANKS: [char; 3] = ['\u{a0}', '\u{2009}', '\u{202f}'];
    let narrow = |cell: &str| cell.replace('\u{2212}', "-").replace(BLANKS, "");
    (!cell.is_ascii()).then(|| narrow(cell))
}

/// `cell` without the marks between groups of three digits, as in `1.234,5`; as it is where no decimals tell the `mark` from
/// that of decimals.
fn without_groups(cell: &str, mark: char, decimal: char) -> String {
    let is_grouped = || {
        let (whole, decimals) = cell.split_once(decimal)?;
        let (first, groups) = whole.trim_start_matches(['+', '-']).split_once(mark)?;
        let is_count = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
        let is_group = |part: &str| part.len() == 3 && is_count(part);
        let are_groups = groups.split(mark).all(is_group);
        Some(matches!(first.len(), 1..=3) && is_count(first) && are_groups && is_count(decimals))
    };
    match is_grouped() {
        Some(true) => cell.replace(mark, ""),
        _ => cell.to_owned(),
    }
}

/// A number whose exponent stands behind a `D`, as in `1.5D-02`.
fn of_fortran(text: &str) -> Option<f64> {
    let (digits, exponent) = text.split_once(['D', 'd'])?;
    let value: f64 = format!("{digits}e{exponent}").parse().ok()?;
    (value.is_finite() && digits.contains(|c: char| c.is_ascii_digit())).then_some(value)
}

/// Seconds of a time such as `0:12.3` or `00:00:12.300`, the latter behind a date `2024-05-03` or not.
fn clock(text: &str) -> Option<f64> {
    let text = text.split_once([' ', 'T']).map_or(text, |(date, time)| {
        let is_date = date.len() == 10 && date.split('-').all(|part| part.parse::<u32>().is_ok());
        if is_date { time.trim_end_matches('Z') } else { text }
    });
    let (rest, seconds) = text.rsplit_once(':')?;
    let is_count = |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
    let (whole, share) = seconds.split_once('.')?;
    let parts: Vec<&str> = rest.split(':').chain([whole]).collect();
    if parts.len() > 3 || !parts.iter().chain([&share]).all(|part| is_count(part)) {
        return None;
    }
    let higher =
        rest.split(':').try_fold(0.0, |sum, part| Some(60.0 * sum + part.parse::<f64>().ok()?))?;
    Some(60.0 * higher + seconds.parse::<f64>().ok()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_marks_and_words_are_told_apart() {
        assert_eq!(number("1.5e-2", false), Number::Value(0.015));
        assert_eq!(number("1,5E-2", true), Number::Value(0.015));
        for mark in ["", "NaN", "-", "#N/A", "None"] {
            assert_eq!(number(mark, false), Number::Missing, "{mark}");
        }
        for word in ["inf", "1,5", "12 mm", "infinity", "0:00:01"] {
            assert_eq!(number(word, false), Number::Other, "{word}");
        }
        assert_eq!(number("1.5", true), Number::Other);
        for (grouped, comma) in [("-1.234.567,25", true), ("-1,234,567.25", false)] {
            assert_eq!(number(grouped, comma), Number::Value(-1_234_567.25), "{grouped}");
        }
        for word in ["1.234", "12.34,5", "1234.567,5", ".234,5"] {
            assert_eq!(number(word, true), Number::Other, "{word}");
        }
        assert_eq!(number("\u{2212}1\u{202f}234,5", true), Number::Value(-1234.5));
        assert_eq!(number("00:01:12.5", false), Number::Value(72.5));
        assert_eq!(number("1:12,25", true), Number::Value(72.25));
        assert_eq!(number("1:2:3:4.5", false), Number::Other);
        for time in ["2024-05-03 14:22:31.25", "2024-05-03T14:22:31.25Z"] {
            assert_eq!(number(time, false), Number::Value(51_751.25), "{time}");
        }
        assert_eq!(number("3 14:22:31.25", false), Number::Other);
        assert_eq!(number("-1.5D-02", false), Number::Value(-0.015));
        assert_eq!(number("D1", false), Number::Other);
    }
}
