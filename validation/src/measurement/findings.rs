//! What is found wrong or odd while a set is read.

use configs::{Diagnostic, Severity, Sources, Span};

use super::table::Row;

/// Most faults of one table that are listed.
const FAULTS: usize = 10;

/// Faults, warnings and notes, with the texts that they point into.
#[derive(Default)]
pub(super) struct Findings {
    pub(super) sources: Sources,
    pub(super) diagnostics: Vec<Diagnostic>,
    pub(super) notes: Vec<String>,
}

impl Findings {
    pub(super) fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    /// A warning stands among the notes too, for the report.
    pub(super) fn warn(&mut self, diagnostic: Diagnostic) {
        self.note(format!("{}.", sentence(&diagnostic.message)));
        self.diagnostics.push(diagnostic);
    }

    /// Takes note of a sentence, once.
    pub(super) fn note(&mut self, sentence: String) {
        if !self.notes.contains(&sentence) {
            self.notes.push(sentence);
        }
    }

    /// The place of a row, or of one of its cells, to be pointed at.
    pub(super) fn place(&mut self, row: &Row, cell: Option<usize>) -> Span {
        let source = self.sources.add_excerpt(&row.table, &row.text, row.line as usize);
        let range = cell.map_or(0..row.text.len(), |cell| row.range(cell));
        Span { source, start: range.start, end: range.end }
    }

    pub(super) fn errors(&self) -> usize {
        self.diagnostics.iter().filter(|one| one.severity == Severity::Error).count()
    }

    /// Whether as much is wrong as is worth listing.
    pub(super) fn full(&self) -> bool {
        self.errors() >= FAULTS
    }
}

/// A message as the beginning of a sentence.
fn sentence(message: &str) -> String {
    let mut letters = message.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

/// The numbers of lines in words, the first ten of them.
pub(super) fn lines_in_words(lines: &[u64]) -> String {
    let shown: Vec<String> = lines.iter().take(10).map(u64::to_string).collect();
    let more = if lines.len() > 10 { ", …" } else { "" };
    let noun = if lines.len() == 1 { "line" } else { "lines" };
    format!("{noun} {}{more}", shown.join(", "))
}
