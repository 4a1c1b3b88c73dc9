//! One row of a table and its cells.

use std::ops::Range;

/// One row, in place of the one before.
#[derive(Default)]
pub(crate) struct Row {
    /// Name of the table, for messages.
    pub(crate) table: String,
    /// From 1.
    pub(crate) line: u64,
    /// As it stands in the file.
    pub(crate) text: String,
    /// What separates its cells.
    pub(crate) delimiter: u8,
    /// The cells without quotes, one after the other, and where each ends.
    fields: Vec<u8>,
    ends: Vec<usize>,
    /// The number of cells.
    pub(crate) width: usize,
}

impl Row {
    /// An empty row of the table that messages call `table`.
    pub(crate) fn of(table: &str, delimiter: u8) -> Self {
        Self { table: table.to_owned(), delimiter, ..Self::default() }
    }

    /// The cell at `column`, without blanks around it.
    pub(crate) fn cell(&self, column: usize) -> &str {
        let start = if column == 0 { 0 } else { self.ends[column - 1] };
        std::str::from_utf8(&self.fields[start..self.ends[column]]).unwrap_or_default().trim()
    }

    /// All cells.
    pub(crate) fn cells(&self) -> impl Iterator<Item = &str> {
        (0..self.width).map(|column| self.cell(column))
    }

    /// Where the cell at `column` stands in the text.
    pub(crate) fn range(&self, column: usize) -> Range<usize> {
        self.scan(column).0
    }

    /// Where the cell at `column` or the last cell stands, and whether it is an open quote. A quote
    /// begins a quoted cell at the beginning of a cell alone.
    fn scan(&self, column: usize) -> (Range<usize>, bool) {
        let (mut start, mut at, mut has_quotes, mut quoted) = (0, 0, false, false);
        for (index, byte) in self.text.bytes().enumerate() {
            if byte == b'"' && (has_quotes || index == start) {
                has_quotes = true;
                quoted = !quoted;
            } else if byte == self.delimiter && !quoted {
                if at == column {
                    return (start..index, false);
                }
                (at, start, has_quotes) = (at + 1, index + 1, false);
            }
        }
        (start..self.text.len(), quoted)
    }

    /// Takes the text apart; `false` when a quote stays open.
    pub(crate) fn split(&mut self, parser: &mut csv_core::Reader) -> bool {
        // No text has more cells than bytes, nor longer ones.
        self.fields.resize(self.text.len() + 1, 0);
        self.ends.resize(self.text.len() + 2, 0);
        parser.reset();
        let (_, _, written, ended) =
            parser.read_record(self.text.as_bytes(), &mut self.fields, &mut self.ends);
        let (_, _, _, last) =
            parser.read_record(&[], &mut self.fields[written..], &mut self.ends[ended..]);
        self.width = ended + last;
        !self.scan(usize::MAX).1
    }
}

/// The last part of a path, for a note.
pub(crate) fn file_name(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_place_of_a_cell_is_that_of_its_text_with_its_quotes() {
        let mut row = Row::of("", b',');
        row.text = "a,\"b, \"\"c\"\"\",,5\" ball, d ".to_owned();
        assert!(row.split(&mut csv_core::Reader::new()));
        assert_eq!(row.cells().collect::<Vec<_>>(), ["a", "b, \"c\"", "", "5\" ball", "d"]);
        let places: Vec<&str> = (0..row.width).map(|at| &row.text[row.range(at)]).collect();
        assert_eq!(places, ["a", "\"b, \"\"c\"\"\"", "", "5\" ball", " d "]);
    }

    #[test]
    fn an_open_quote_is_seen() {
        let mut row = Row::of("", b',');
        row.text = "a,\"b,c".to_owned();
        assert!(!row.split(&mut csv_core::Reader::new()));
    }
}
