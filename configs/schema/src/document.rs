//! A TOML text as a tree in which every key and value knows where it stands.

use toml_edit::{Document, Item, Value as TomlValue};

use crate::diagnostics::{Diagnostic, SourceId, Sources, Span, shorten};

/// A value and where it stands.
#[derive(Clone, Debug)]
pub struct Node {
    /// Its place in the text.
    pub span: Span,
    /// What it is.
    pub value: Value,
}

/// What a value is.
#[derive(Clone, Debug)]
pub enum Value {
    /// A string.
    Text(String),
    /// A whole number.
    Integer(i64),
    /// Any other number.
    Float(f64),
    /// A quantity in SI, of a model that was read already.
    Si(f64),
    /// True or false.
    Boolean(bool),
    /// A date or a time, which no key takes.
    Datetime,
    /// A list.
    Array(Vec<Node>),
    /// A table.
    Table(Table),
}

impl Value {
    /// What kind it is, with its article.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Text(_) => "a string",
            Self::Integer(_) | Self::Float(_) | Self::Si(_) => "a number",
            Self::Boolean(_) => "a truth value",
            Self::Datetime => "a date",
            Self::Array(_) => "a list",
            Self::Table(_) => "a table",
        }
    }
}

/// Keys and values in the order of the text.
#[derive(Clone, Debug)]
pub struct Table {
    /// `[run]`, or what stands for it in an inline table.
    pub(crate) header: Span,
    /// Its lines.
    pub entries: Vec<Entry>,
}

/// One line of a table.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Left of the equals sign.
    pub key: String,
    pub(crate) key_span: Span,
    /// Right of it.
    pub node: Node,
}

impl Table {
    /// Whether there is anything called `key` in it.
    pub fn has(&self, key: &str) -> bool {
        self.get(key).is_some()
    }

    /// A table without lines, whose header stands at `header`.
    pub(crate) fn empty(header: Span) -> Self {
        Self { header, entries: Vec::new() }
    }

    /// Puts `node` at `key`, over what is there.
    pub(crate) fn put(&mut self, key: &str, node: Node) {
        match self.entries.iter_mut().find(|entry| entry.key == key) {
            Some(entry) => entry.node = node,
            None => self.entries.push(Entry { key: key.to_owned(), key_span: node.span, node }),
        }
    }

    /// The table at `key`, made where nothing is; `None` where something else is.
    pub(crate) fn below(&mut self, key: &str) -> Option<&mut Self> {
        if !self.has(key) {
            let empty = Self::empty(self.header);
            self.put(key, Node { span: self.header, value: Value::Table(empty) });
        }
        match &mut self.entries.iter_mut().find(|entry| entry.key == key)?.node.value {
            Value::Table(table) => Some(table),
            _ => None,
        }
    }

    /// Adds `node` to the list at `key`.
    pub(crate) fn push(&mut self, key: &str, node: Node) {
        match self.entries.iter_mut().find(|entry| entry.key == key).map(|one| &mut one.node.value)
        {
            Some(Value::Array(nodes)) => nodes.push(node),
            _ => self.put(key, Node { span: node.span, value: Value::Array(vec![node]) }),
        }
    }

    /// Multiplies the number at `key`, if there is one in SI.
    pub(crate) fn multiply(&mut self, key: &str, factor: f64) {
        let entry = self.entries.iter_mut().find(|entry| entry.key == key);
        if let Some(Value::Si(value)) = entry.map(|entry| &mut entry.node.value) {
            *value *= factor;
        }
    }

    /// The tables of the list at `key`.
    pub(crate) fn tables(&mut self, key: &str) -> impl Iterator<Item = &mut Self> {
        let list = self.entries.iter_mut().find(|entry| entry.key == key);
        let nodes = match list.map(|entry| &mut entry.node.value) {
            Some(Value::Array(nodes)) => nodes.as_mut_slice(),
            _ => &mut [],
        };
        nodes.iter_mut().filter_map(|node| match &mut node.value {
            Value::Table(table) => Some(table),
            _ => None,
        })
    }

    /// The line of `key`.
    pub fn get(&self, key: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.key == key)
    }
}

/// Reads a TOML text.
///
/// # Errors
/// When it is not TOML, with the place.
pub fn parse(sources: &Sources, id: SourceId) -> Result<Table, Box<Diagnostic>> {
    let text = sources.text(id);
    let document = Document::parse(text).map_err(|error| {
        let span = error.span().unwrap_or(0..0);
        Box::new(explain(
            error.message(),
            text,
            Span { source: id, start: span.start, end: span.end },
        ))
    })?;
    let start = Span { source: id, start: 0, end: 0 };
    Ok(Converter { source: id }.table(document.as_table(), start))
}

/// The parser's message in the words of this program, and what to do about it.
fn explain(message: &str, text: &str, span: Span) -> Diagnostic {
    let message = message.trim_end().replace('\n', "; ");
    if message == "duplicate key" {
        let (first, is_table) = first_spelling(text, span);
        let diagnostic = match is_table {
            true => Diagnostic::error("this table is listed twice").help("join the two into one"),
            false => {
                Diagnostic::error("this key is listed twice").help("keep one of the two lines")
            }
        };
        return diagnostic.at(span, "again here").with(first, "first here");
    }
    let diagnostic =
        Diagnostic::error(format!("this is not TOML: {}", shorten(&message))).at(span, "");
    if message.contains("string values must be quoted") {
        diagnostic.help("write names and quantities in quotes: \"wall\", \"4.46 cm\"")
    } else if message.contains("overflow") {
        diagnostic.help(format!("whole numbers go up to {}", i64::MAX))
    } else {
        diagnostic
    }
}

/// Where the key or table of a duplicate stands first, and whether it is a table.
fn first_spelling(text: &str, again: Span) -> (Option<Span>, bool) {
    let name = text.get(again.start..again.end).unwrap_or_default();
    let before = text.get(..again.start).unwrap_or_default();
    let is_table = before.ends_with('[');
    let mut first = None;
    let mut at = 0;
    for line in before.split_inclusive('\n') {
        let indent = line.len() - line.trim_start().len();
        let content = line.trim();
        let found = match is_table {
            true => {
                content.strip_prefix('[').is_some_and(|rest| rest.starts_with(&format!("{name}]")))
            }
            false => {
                content.strip_prefix(name).is_some_and(|rest| rest.trim_start().starts_with('='))
            }
        };
        if !is_table && content.starts_with('[') {
            first = None;
        } else if found && first.is_none() {
            let start = at + indent + usize::from(is_table);
            first = Some(Span { start, end: start + name.len(), ..again });
        }
        at += line.len();
    }
    (first, is_table)
}

/// Turns what the TOML library read into [`Node`]s.
pub(crate) struct Converter {
    pub(crate) source: SourceId,
}

impl Converter {
    fn span(&self, range: Option<std::ops::Range<usize>>, fallback: Span) -> Span {
        range.map_or(fallback, |range| Span {
            source: self.source,
            start: range.start,
            end: range.end,
        })
    }

    pub(crate) fn table(&self, table: &dyn toml_edit::TableLike, header: Span) -> Table {
        let mut entries = Vec::new();
        for (key, item) in table.iter() {
            let range = table.key(key).and_then(toml_edit::Key::span);
            let key_span = self.span(range, header);
            if let Some(node) = self.item(item, key_span) {
                entries.push(Entry { key: key.to_owned(), key_span, node });
            }
        }
        Table { header, entries }
    }

    fn item(&self, item: &Item, key: Span) -> Option<Node> {
        match item {
            Item::None => None,
            Item::Value(value) => Some(self.value(value, key)),
            Item::Table(table) => {
                let span = self.span(table.span().filter(|range| !range.is_empty()), key);
                Some(Node { span, value: Value::Table(self.table(table, span)) })
            }
            Item::ArrayOfTables(tables) => {
                let nodes = tables
                    .iter()
                    .map(|table| {
                        let span = self.span(table.span(), key);
                        Node { span, value: Value::Table(self.table(table, span)) }
                    })
                    .collect();
                Some(Node { span: key, value: Value::Array(nodes) })
            }
        }
    }

    fn value(&self, value: &TomlValue, key: Span) -> Node {
        let span = self.span(value.span(), key);
        let value = match value {
            TomlValue::String(text) => Value::Text(text.value().clone()),
            TomlValue::Integer(number) => Value::Integer(*number.value()),
            TomlValue::Float(number) => Value::Float(*number.value()),
            TomlValue::Boolean(truth) => Value::Boolean(*truth.value()),
            TomlValue::Datetime(_) => Value::Datetime,
            TomlValue::Array(array) => {
                Value::Array(array.iter().map(|value| self.value(value, span)).collect())
            }
            TomlValue::InlineTable(table) => Value::Table(self.table(table, span)),
        };
        Node { span, value }
    }
}
