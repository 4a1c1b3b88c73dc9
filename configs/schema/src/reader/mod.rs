//! Reads tables key by key: collects every error, and writes what it read into the resolved model.

mod coefficients;
mod kind;
mod lists;
mod noting;
mod numbers;
mod questions;
mod unknown;
mod words;

use std::cell::RefCell;

use crate::diagnostics::{Diagnostic, Severity, Sources, Span};
use crate::document::{Entry, Node, Table, Value};
use crate::limits;
use crate::resolved::{Resolved, Written};

pub use kind::FileKind;
pub use numbers::interval;
use questions::Notes;
pub use questions::{Answer, Asked, Question, Seen, Word};
use unknown::Unknown;

/// A value that was read, and where; a default stands nowhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found<T> {
    /// The value.
    pub value: T,
    /// Its place in the text.
    pub span: Option<Span>,
}

/// What all tables of one file share.
pub struct Reader<'a> {
    /// The texts that spans point into.
    pub sources: &'a Sources,
    kind: FileKind,
    diagnostics: RefCell<Vec<Diagnostic>>,
    resolved: RefCell<Resolved>,
    homes: RefCell<Vec<(String, Vec<&'static str>)>>,
    unknown: RefCell<Vec<Unknown>>,
    notes: Notes,
}

impl<'a> Reader<'a> {
    /// Nothing read yet.
    pub fn new(sources: &'a Sources, kind: FileKind) -> Self {
        Self {
            sources,
            kind,
            diagnostics: RefCell::default(),
            resolved: RefCell::default(),
            homes: RefCell::default(),
            unknown: RefCell::default(),
            notes: None,
        }
    }

    /// The same, which notes what it asks.
    pub(crate) fn noting(sources: &'a Sources, kind: FileKind) -> Self {
        Self { notes: Some(RefCell::default()), ..Self::new(sources, kind) }
    }

    /// What was asked, by a reader that notes it.
    #[must_use]
    pub(crate) fn into_asked(self) -> Asked {
        self.notes.map(RefCell::into_inner).unwrap_or_default()
    }

    /// Takes note of an error or a warning.
    pub fn report(&self, diagnostic: Diagnostic) {
        let mut all = self.diagnostics.borrow_mut();
        if all.len() < limits::DIAGNOSTICS {
            all.push(diagnostic);
        }
    }

    /// Whether there is an error among what was reported.
    pub fn failed(&self) -> bool {
        self.diagnostics.borrow().iter().any(|one| one.severity == Severity::Error)
            || !self.unknown.borrow().is_empty()
    }

    /// The root: only tables may stand there.
    pub fn root(&'a self, table: &'a Table) -> TableReader<'a> {
        TableReader::new(self, "the file", String::new(), Some(table))
    }

    /// Everything that was reported, with the unknown keys explained, in the order of the text.
    pub(crate) fn finish(self) -> (Vec<Diagnostic>, Resolved) {
        let homes = self.homes.into_inner();
        let mut diagnostics = self.diagnostics.into_inner();
        for unknown in self.unknown.into_inner().into_iter().take(limits::DIAGNOSTICS) {
            diagnostics.push(unknown.explain(self.kind, &homes));
        }
        diagnostics
            .sort_by_key(|one| one.primary.as_ref().map(|(span, _)| (span.source, span.start)));
        diagnostics.truncate(limits::DIAGNOSTICS);
        (diagnostics, self.resolved.into_inner())
    }

    /// Everything that was reported, in the order of the text.
    #[must_use]
    pub fn into_diagnostics(self) -> Vec<Diagnostic> {
        self.finish().0
    }
}

/// Reads one table.
pub struct TableReader<'a> {
    /// What it shares with the other tables of the file.
    pub reader: &'a Reader<'a>,
    name: String,
    table: Option<&'a Table>,
    section: usize,
    /// Its number among the notes of what is asked.
    noted: usize,
    asked: RefCell<Vec<&'static str>>,
    numbers: RefCell<Vec<(&'static str, Option<f64>)>>,
}

impl<'a> TableReader<'a> {
    fn new(reader: &'a Reader<'a>, name: &str, header: String, table: Option<&'a Table>) -> Self {
        let section = reader.resolved.borrow_mut().open(header);
        let noted = reader.notes.as_ref().map_or(0, |notes| notes.borrow_mut().open(name, table));
        Self {
            reader,
            name: name.to_owned(),
            table,
            section,
            noted,
            asked: RefCell::default(),
            numbers: RefCell::default(),
        }
    }

    /// The header of the table, when the file has it.
    pub fn header(&self) -> Option<Span> {
        self.table.map(|table| table.header)
    }

    /// Whether `key` is given; it counts as known from now on.
    pub fn has(&self, key: &'static str) -> bool {
        self.entry(key).is_some()
    }

    fn entry(&self, key: &'static str) -> Option<&'a Entry> {
        let mut asked = self.asked.borrow_mut();
        if !asked.contains(&key) {
            asked.push(key);
        }
        self.table.and_then(|table| table.get(key))
    }

    fn write(&self, key: &str, value: Written) {
        self.reader.resolved.borrow_mut().line(self.section, key, value);
    }

    /// Reports that a required key is missing, with an example of what to write.
    fn missing(&self, key: &'static str, example: &str, meaning: &str) {
        self.misses(key);
        let Some(header) = self.header() else { return };
        let diagnostic = Diagnostic::error(format!("[{}] lacks `{key}`: {meaning}", self.name));
        self.reader.report(
            diagnostic
                .at(header, format!("`{key}` is required here"))
                .help(format!("write {key} = {example}")),
        );
    }

    /// Reports a value of the wrong kind.
    fn wrong_kind(&self, entry: &Entry, wanted: &str, example: &str) {
        let found = entry.node.value.kind();
        self.reader.report(
            Diagnostic::error(format!("`{}` is {found}; expected {wanted}", entry.key))
                .at(entry.node.span, format!("expected {wanted}"))
                .help(format!("write {} = {example}", entry.key)),
        );
    }

    /// A table below this one. When it is required and missing, that is reported once, with
    /// `example` as what to write.
    pub fn table(&self, key: &'static str, example: Option<&str>) -> TableReader<'a> {
        self.asks(key, "", || Answer::Table);
        self.below(key, example)
    }

    /// The same without a note of it.
    fn below(&self, key: &'static str, example: Option<&str>) -> TableReader<'a> {
        let name = self.child(key);
        let table = match self.entry(key) {
            Some(Entry { node: Node { value: Value::Table(table), .. }, .. }) => Some(table),
            Some(entry) => {
                let wanted = match &entry.node.value {
                    Value::Array(_) => format!("write [{name}], in single brackets"),
                    _ => format!("write [{name}] and its keys below it"),
                };
                self.reader.report(
                    Diagnostic::error(format!("`{key}` is a table"))
                        .at(entry.key_span, format!("this is {}", entry.node.value.kind()))
                        .help(wanted),
                );
                None
            }
            None => {
                if let Some(example) = example {
                    self.misses(key);
                    let noun = self.reader.kind.noun();
                    self.reader.report(
                        Diagnostic::error(format!("the table [{name}] is missing"))
                            .help(format!("{noun} needs it:\n[{name}]\n{example}")),
                    );
                }
                None
            }
        };
        TableReader::new(self.reader, &name, format!("[{name}]"), table)
    }

    /// The elements of an array of tables below this one.
    pub fn tables(&self, key: &'static str, at_most: usize) -> Vec<TableReader<'a>> {
        self.asks(key, "", || Answer::Tables);
        self.list(key, at_most)
    }

    /// A table below this one, or the elements of an array of such tables.
    pub fn table_or_tables(&self, key: &'static str, at_most: usize) -> Vec<TableReader<'a>> {
        self.asks(key, "", || Answer::TableOrTables);
        match self.entry(key).map(|entry| &entry.node.value) {
            Some(Value::Array(_)) => self.list(key, at_most),
            _ => vec![self.below(key, None)],
        }
    }

    /// The elements of an array of tables without a note of it.
    fn list(&self, key: &'static str, at_most: usize) -> Vec<TableReader<'a>> {
        let name = self.child(key);
        let Some(entry) = self.entry(key) else {
            return Vec::new();
        };
        let Value::Array(nodes) = &entry.node.value else {
            self.reader.report(
                Diagnostic::error(format!("`{name}` is a list of tables"))
                    .at(entry.node.span, format!("this is {}", entry.node.value.kind()))
                    .help(format!("write [[{name}]], in double brackets")),
            );
            return Vec::new();
        };
        if nodes.len() > at_most {
            self.reader.report(
                Diagnostic::error(format!("{} times [[{name}]] is too many", nodes.len()))
                    .at(nodes[at_most].span, format!("at most {at_most} are accepted")),
            );
            return Vec::new();
        }
        let mut readers = Vec::new();
        for node in nodes {
            match &node.value {
                Value::Table(table) => readers.push(TableReader::new(
                    self.reader,
                    &name,
                    format!("[[{name}]]"),
                    Some(table),
                )),
                other => self.reader.report(
                    Diagnostic::error(format!("`{name}` is a list of tables"))
                        .at(node.span, format!("this is {}", other.kind()))
                        .help(format!("write [[{name}]] and its keys below it")),
                ),
            }
        }
        readers
    }

    fn child(&self, key: &str) -> String {
        match self.name.as_str() {
            "the file" => key.to_owned(),
            name => format!("{name}.{key}"),
        }
    }

    /// Where the value of `key` stands, if the file gives it.
    pub fn span_of(&self, key: &str) -> Option<Span> {
        self.table.and_then(|table| table.get(key)).map(|entry| entry.node.span)
    }

    /// The value of `key` as it stands in the file.
    pub fn node(&self, key: &'static str) -> Option<&'a Node> {
        self.entry(key).map(|entry| &entry.node)
    }

    /// The string at `key`, if it is one.
    pub(crate) fn peek_text(&self, key: &'static str) -> Option<&'a str> {
        match &self.node(key)?.value {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }

    /// Refuses the keys that nobody asked for.
    pub fn finish(self) {
        let asked = self.asked.into_inner();
        let mut unknown = self.reader.unknown.borrow_mut();
        for entry in self.table.into_iter().flat_map(|table| &table.entries) {
            if !asked.contains(&entry.key.as_str()) && unknown.len() < limits::DIAGNOSTICS {
                unknown.push(Unknown {
                    key: entry.key.clone(),
                    span: entry.key_span,
                    table: self.name.clone(),
                    allowed: asked.clone(),
                });
            }
        }
        let mut homes = self.reader.homes.borrow_mut();
        if !homes.iter().any(|(table, _)| *table == self.name) {
            homes.push((self.name, asked));
        }
    }
}
