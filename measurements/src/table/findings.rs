//! What is found wrong or odd while a set is read.

use configs::{Diagnostic, Severity, Sources, Span, nearest};

use crate::table::row::Row;

/// Most faults of one table that are listed.
const FAULTS: usize = 10;

/// Faults, warnings and notes, with the texts that they point into.
#[derive(Default)]
pub(crate) struct Findings {
    pub(crate) sources: Sources,
    pub(crate) diagnostics: Vec<Diagnostic>,
    pub(crate) notes: Vec<String>,
}

impl Findings {
    pub(crate) fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    /// A warning stands among the notes too, for the report.
    pub(crate) fn warn(&mut self, diagnostic: Diagnostic) {
        let help = diagnostic.help.as_ref().map_or(String::new(), |help| format!(": {help}"));
        self.note(format!("{}{help}.", sentence(&diagnostic.message)));
        self.diagnostics.push(diagnostic);
    }

    /// Takes note of a sentence, once.
    pub(crate) fn note(&mut self, sentence: String) {
        if !self.notes.contains(&sentence) {
            self.notes.push(sentence);
        }
    }

    /// The place of a row, or of one of its cells, to be pointed at.
    pub(crate) fn place(&mut self, row: &Row, cell: Option<usize>) -> Span {
        let source = self.sources.add_excerpt(&row.table, &row.text, row.line as usize);
        let range = cell.map_or(0..row.text.len(), |cell| row.range(cell));
        Span { source, start: range.start, end: range.end }
    }

    /// Gives a place to all that has none yet.
    pub(crate) fn point_at(&mut self, span: Option<Span>, label: &str) {
        let no_place = |one: &&mut Diagnostic| one.primary.is_none();
        for one in self.diagnostics.iter_mut().filter(no_place) {
            one.primary = span.map(|span| (span, label.to_owned()));
        }
    }

    pub(crate) fn errors(&self) -> usize {
        self.diagnostics.iter().filter(|one| one.severity == Severity::Error).count()
    }

    /// Whether as much is wrong as is worth listing.
    pub(crate) fn full(&self) -> bool {
        self.errors() >= FAULTS
    }
}

/// A message as the beginning of a sentence. A symbol that it begins with stays as it is.
fn sentence(message: &str) -> String {
    let mut letters = message.chars();
    if message.get(1..3) == Some(" =") {
        return message.to_owned();
    }
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

/// The name in `known` that `found` may stand for: `c2` for `c02`, or a near spelling.
pub(crate) fn nearest_name<'a>(
    found: &str,
    known: impl Iterator<Item = &'a str> + Clone,
) -> Option<&'a str> {
    let bare = |name: &str| {
        let kept = name.chars().filter(|c| c.is_alphanumeric() && *c != '0');
        kept.flat_map(char::to_lowercase).collect::<String>()
    };
    let wanted = bare(found);
    known
        .clone()
        .find(|name| !wanted.is_empty() && bare(name) == wanted)
        .or_else(|| nearest(found, known))
}

/// The numbers of lines in words, the first ten of them.
pub(crate) fn lines_in_words(lines: &[u64]) -> String {
    let shown: Vec<String> = lines.iter().take(10).map(u64::to_string).collect();
    let more = if lines.len() > 10 { ", …" } else { "" };
    let noun = if lines.len() == 1 { "line" } else { "lines" };
    format!("{noun} {}{more}", shown.join(", "))
}
