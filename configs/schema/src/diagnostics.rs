//! Messages that point into the text they are about, shown the way rustc shows its own.

use std::ops::Range;

use annotate_snippets::{
    AnnotationKind, Element, Group, Level, Origin, Renderer, Snippet, renderer::DecorStyle,
};

use crate::limits;

/// Which text a [`Span`] points into.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct SourceId(usize);

/// A stretch of bytes of one of the texts that were read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    /// The text.
    pub source: SourceId,
    /// First byte.
    pub start: usize,
    /// One past the last byte.
    pub end: usize,
}

/// The texts that were read: the file, each `--set`, `--seed`, lines of a table.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    texts: Vec<SourceText>,
}

#[derive(Clone, Debug)]
struct SourceText {
    name: String,
    text: String,
    first_line: usize,
}

impl Sources {
    /// Adds a text under the name that messages show for it.
    pub fn add(&mut self, name: impl Into<String>, text: impl Into<String>) -> SourceId {
        self.add_excerpt(name, text, 1)
    }

    /// Adds a part of a text that is too large to keep; it begins on line `first_line`.
    pub fn add_excerpt(
        &mut self,
        name: impl Into<String>,
        text: impl Into<String>,
        first_line: usize,
    ) -> SourceId {
        self.texts.push(SourceText { name: name.into(), text: text.into(), first_line });
        SourceId(self.texts.len() - 1)
    }

    /// The whole of a text.
    pub fn text(&self, source: SourceId) -> &str {
        &self.texts[source.0].text
    }

    /// The bytes `part` of the string `value` that stands at `span`; all of it where escapes move them.
    pub fn within(&self, span: Option<Span>, value: &str, part: Range<usize>) -> Option<Span> {
        let span = span?;
        let written = self.text(span.source).get(span.start..span.end).unwrap_or_default();
        let Some(offset) = written.find(value).filter(|_| !value.is_empty()) else {
            return Some(span);
        };
        let start = span.start + offset;
        Some(Span { start: start + part.start, end: start + part.end, ..span })
    }

    /// Line and column of the first character of `span`, counted from 1.
    fn position(&self, span: Span) -> (usize, usize) {
        let SourceText { text, first_line, .. } = &self.texts[span.source.0];
        let before = &text[..floor(text, span.start)];
        let line = before.rfind('\n').map_or(before, |at| &before[at + 1..]);
        (first_line + before.matches('\n').count(), 1 + line.chars().count())
    }

    /// What stands at `span`, shortened for use inside a message.
    pub fn quote(&self, span: Span) -> String {
        shorten(self.text(span.source).get(span.start..span.end).unwrap_or_default())
    }
}

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The input is refused.
    Error,
    /// The input is accepted; the reader should look twice.
    Warning,
}

/// Whether a rendered message carries terminal colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Color {
    /// With escape sequences.
    On,
    /// Plain text.
    Off,
}

/// One thing to say about the input.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// Error or warning.
    pub severity: Severity,
    /// The headline: what is wrong.
    pub message: String,
    /// Where, and a few words to stand beside it.
    pub primary: Option<(Span, String)>,
    /// Other places that have to do with it.
    pub secondary: Vec<(Span, String)>,
    /// What to write instead.
    pub help: Option<String>,
}

impl Diagnostic {
    /// An error without a place yet.
    pub fn error(message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Error,
            message: message.into(),
            primary: None,
            secondary: Vec::new(),
            help: None,
        }
    }

    /// A warning without a place yet.
    pub fn warning(message: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(message) }
    }

    /// Points at `span`; a value that came from a default has none.
    #[must_use]
    pub fn at(mut self, span: impl Into<Option<Span>>, label: impl Into<String>) -> Self {
        if let Some(span) = span.into() {
            match self.primary {
                None => self.primary = Some((span, label.into())),
                Some(_) => self.secondary.push((span, label.into())),
            }
        }
        self
    }

    /// Points at another place that has to do with it.
    #[must_use]
    pub fn with(self, span: impl Into<Option<Span>>, label: impl Into<String>) -> Self {
        self.at(span, label)
    }

    /// Says what to write instead.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// The message as shown to the user, with file, line, column and the lines it is about.
    pub fn render(&self, sources: &Sources, color: Color) -> String {
        let level = match self.severity {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
        };
        let mut group = Group::with_title(level.primary_title(printable(&self.message)));
        for element in self.snippets(sources) {
            group = group.element(element);
        }
        if let Some(help) = &self.help {
            group = group.element(Level::HELP.message(printable(help)));
        }
        let renderer = match color {
            Color::On => Renderer::styled(),
            Color::Off => Renderer::plain(),
        };
        let mut text = renderer.decor_style(DecorStyle::Ascii).render(&[group]);
        text.push('\n');
        text
    }

    /// The message without the lines that it is about: a headline, a line for each place with what
    /// stands there, the help. Places in the first text are given without its name.
    pub fn brief(&self, sources: &Sources) -> String {
        let level = match self.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        let mut text = format!("{level}: {}\n", self.message);
        let markers = std::iter::once("-->").chain(std::iter::repeat(":::"));
        for (marker, (span, label)) in markers.zip(self.primary.iter().chain(&self.secondary)) {
            let name = match span.source {
                SourceId(0) => String::new(),
                SourceId(id) => format!("{}:", sources.texts[id].name),
            };
            let (line, column) = sources.position(*span);
            let quote = sources.quote(*span);
            let place = format!("{marker} {name}{line}:{column} «{quote}» {label}");
            text.push_str(place.trim_end());
            text.push('\n');
        }
        if let Some(help) = &self.help {
            text.push_str(&format!("= help: {}\n", help.replace('\n', "\n  ")));
        }
        printable(&text)
    }

    /// One snippet per text that is pointed into, the primary one first.
    fn snippets<'a>(&'a self, sources: &'a Sources) -> Vec<Element<'a>> {
        let Some((primary, _)) = &self.primary else {
            let name = sources.texts.first().map(|text| Origin::path(printable(&text.name)));
            return name.map(Element::from).into_iter().collect();
        };
        let mut ids = vec![primary.source];
        for (span, _) in &self.secondary {
            if !ids.contains(&span.source) {
                ids.push(span.source);
            }
        }
        ids.into_iter().map(|id| self.snippet(sources, id).into()).collect()
    }

    fn snippet<'a>(
        &'a self,
        sources: &'a Sources,
        id: SourceId,
    ) -> Snippet<'a, annotate_snippets::Annotation<'a>> {
        let primary = self.primary.iter().map(|label| (AnnotationKind::Primary, label));
        let secondary = self.secondary.iter().map(|label| (AnnotationKind::Context, label));
        let labels: Vec<_> =
            primary.chain(secondary).filter(|(_, (span, _))| span.source == id).collect();
        let SourceText { name, text, first_line } = &sources.texts[id.0];
        let window = Window::around(text, labels.iter().map(|(_, (span, _))| *span));
        let annotations = labels.into_iter().map(|(kind, (span, label))| {
            let label = (!label.is_empty()).then(|| printable(label));
            kind.span(window.locate(*span)).label(label)
        });
        Snippet::source(window.text.clone())
            .path(printable(name))
            .line_start(first_line - 1 + window.first_line)
            .annotations(annotations)
    }
}

/// Messages one after another as shown to the user.
pub fn render_all(diagnostics: &[Diagnostic], sources: &Sources, color: Color) -> String {
    let mut text = String::new();
    for diagnostic in diagnostics {
        text.push_str(&diagnostic.render(sources, color));
        text.push('\n');
    }
    let errors = diagnostics.iter().filter(|one| one.severity == Severity::Error).count();
    if errors >= limits::DIAGNOSTICS {
        text.push_str("error: there may be more; only the first are shown\n");
    }
    text
}

/// The lines of a text that a message needs, so that a large file costs no more than a small one.
struct Window {
    text: String,
    start: usize,
    first_line: usize,
}

/// Longest stretch of input shown (byte); a span beyond it is cut off.
const LONGEST_WINDOW: usize = 20_000;

impl Window {
    fn around(text: &str, spans: impl Iterator<Item = Span>) -> Self {
        let (mut from, mut to) = (text.len(), 0);
        for span in spans {
            from = from.min(span.start);
            to = to.max(span.end);
        }
        let from = floor(text, from);
        let to = floor(text, to.max(from));
        let mut start = text[..from].rfind('\n').map_or(0, |at| at + 1);
        if from - start > LONGEST_WINDOW {
            start = floor(text, from - LONGEST_WINDOW / 2);
        }
        let end = text[to..].find('\n').map_or(text.len(), |at| to + at);
        let end = floor(text, end.min(from.saturating_add(LONGEST_WINDOW)));
        let first_line = 1 + text[..start].bytes().filter(|byte| *byte == b'\n').count();
        // As many bytes out as in: the spans stay where they are.
        let shown = text[start..end]
            .replace(|c| ('\u{80}'..='\u{9f}').contains(&c), "·")
            .replace('\r', " ");
        Self { text: shown, start, first_line }
    }

    fn locate(&self, span: Span) -> Range<usize> {
        let clamp = |at: usize| floor(&self.text, at.saturating_sub(self.start));
        clamp(span.start)..clamp(span.end)
    }
}

/// The last character boundary of `text` at or before `at`.
fn floor(text: &str, at: usize) -> usize {
    let mut at = at.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

/// `text` without anything that would move a terminal's cursor or colour it; line breaks stay.
pub fn printable(text: &str) -> String {
    let hidden = |c: char| {
        (c.is_control() && c != '\n')
            || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    text.replace(hidden, "\u{fffd}")
}

/// `text` on one line and of bounded length, for use inside a message.
pub fn shorten(text: &str) -> String {
    let line = text.replace(['\n', '\r'], " ");
    match line.char_indices().nth(60) {
        Some((cut, _)) => format!("{}…", &line[..cut]),
        None => line,
    }
}

/// The spelling in `known` nearest to `found`, if one is near.
pub fn nearest<'a>(found: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if found.len() > 80 {
        return None;
    }
    let found = found.to_lowercase();
    known
        .into_iter()
        .map(|name| (strsim::jaro_winkler(&found, &name.to_lowercase()), name))
        .filter(|(likeness, _)| *likeness > 0.8)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, name)| name)
}
