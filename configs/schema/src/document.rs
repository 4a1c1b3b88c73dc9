//! A TOML text as a tree in which every key and value knows where it stands.

use toml_edit::{Document, Item, Value as TomlValue};

use crate::diagnostics::{Diagnostic, SourceId, Sources, Span, nearest, shorten};

/// A value and where it stands.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub(crate) span: Span,
    pub(crate) value: Value,
}

/// What a value is.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    Text(String),
    Integer(i64),
    Float(f64),
    Boolean(bool),
    Datetime,
    Array(Vec<Node>),
    Table(Table),
}

impl Value {
    /// What kind it is, with its article.
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Self::Text(_) => "a string",
            Self::Integer(_) | Self::Float(_) => "a number",
            Self::Boolean(_) => "a truth value",
            Self::Datetime => "a date",
            Self::Array(_) => "a list",
            Self::Table(_) => "a table",
        }
    }
}

/// Keys and values in the order of the text.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    /// `[run]`, or what stands for it in an inline table.
    pub(crate) header: Span,
    pub(crate) entries: Vec<Entry>,
}

/// One line of a table.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    pub(crate) key: String,
    pub(crate) key_span: Span,
    pub(crate) node: Node,
}

impl Table {
    pub(crate) fn get(&self, key: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.key == key)
    }
}

/// Reads a TOML text.
pub(crate) fn parse(sources: &Sources, id: SourceId) -> Result<Table, Box<Diagnostic>> {
    let text = sources.text(id);
    let document = Document::parse(text).map_err(|error| {
        let span = error.span().unwrap_or(0..0);
        Box::new(explain(
            error.message(),
            text,
            Span {
                source: id,
                start: span.start,
                end: span.end,
            },
        ))
    })?;
    let start = Span {
        source: id,
        start: 0,
        end: 0,
    };
    Ok(Converter { source: id }.table(document.as_table(), start))
}

/// The parser's message in the words of this program, and what to do about it.
fn explain(message: &str, text: &str, span: Span) -> Diagnostic {
    let message = message.trim_end().replace('\n', "; ");
    if message == "duplicate key" {
        let (first, is_table) = first_spelling(text, span);
        let diagnostic = match is_table {
            true => Diagnostic::error("this table stands twice").help("join the two into one"),
            false => Diagnostic::error("this key stands twice").help("keep one of the two lines"),
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
            true => content
                .strip_prefix('[')
                .is_some_and(|rest| rest.starts_with(&format!("{name}]"))),
            false => content
                .strip_prefix(name)
                .is_some_and(|rest| rest.trim_start().starts_with('=')),
        };
        if !is_table && content.starts_with('[') {
            first = None;
        } else if found && first.is_none() {
            let start = at + indent + usize::from(is_table);
            first = Some(Span {
                start,
                end: start + name.len(),
                ..again
            });
        }
        at += line.len();
    }
    (first, is_table)
}

struct Converter {
    source: SourceId,
}

impl Converter {
    fn span(&self, range: Option<std::ops::Range<usize>>, fallback: Span) -> Span {
        range.map_or(fallback, |range| Span {
            source: self.source,
            start: range.start,
            end: range.end,
        })
    }

    fn table(&self, table: &dyn toml_edit::TableLike, header: Span) -> Table {
        let mut entries = Vec::new();
        for (key, item) in table.iter() {
            let range = table.key(key).and_then(toml_edit::Key::span);
            let key_span = self.span(range, header);
            if let Some(node) = self.item(item, key_span) {
                entries.push(Entry {
                    key: key.to_owned(),
                    key_span,
                    node,
                });
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
                Some(Node {
                    span,
                    value: Value::Table(self.table(table, span)),
                })
            }
            Item::ArrayOfTables(tables) => {
                let nodes = tables
                    .iter()
                    .map(|table| {
                        let span = self.span(table.span(), key);
                        Node {
                            span,
                            value: Value::Table(self.table(table, span)),
                        }
                    })
                    .collect();
                Some(Node {
                    span: key,
                    value: Value::Array(nodes),
                })
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

/// Puts one `key.path=value` over what the file says.
pub(crate) fn apply_set(
    root: &mut Table,
    sources: &mut Sources,
    option: &str,
    assignment: &str,
) -> Result<(), Box<Diagnostic>> {
    let id = sources.add(option, assignment);
    let whole = Span {
        source: id,
        start: 0,
        end: assignment.len(),
    };
    let malformed = |message: String| {
        Box::new(
            Diagnostic::error(message)
                .at(whole, "")
                .help("write key.path=value, such as impact.speed=\"3 m/s\" or run.seed=2"),
        )
    };
    let Some((path, text)) = assignment.split_once('=') else {
        return Err(malformed("this assignment has no `=`".to_owned()));
    };
    let value_span = Span {
        source: id,
        start: path.len() + 1,
        end: assignment.len(),
    };
    let value = set_value(text, id, value_span);
    let keys: Vec<(&str, Span)> = path
        .split('.')
        .scan(0, |at, key| {
            let start = *at + key.len() - key.trim_start().len();
            let span = Span {
                source: id,
                start,
                end: start + key.trim().len(),
            };
            *at += key.len() + 1;
            Some((key.trim(), span))
        })
        .collect();
    if keys.len() > 8 || keys.iter().any(|(key, _)| key.is_empty()) {
        return Err(malformed("this assignment names no key".to_owned()));
    }
    put(
        root,
        &keys,
        Node {
            span: value_span,
            value,
        },
    )
}

/// The value of an assignment: TOML if it is TOML, else the text itself.
fn set_value(text: &str, id: SourceId, span: Span) -> Value {
    const PREFIX: &str = "v=";
    let plain = || Value::Text(text.to_owned());
    let Ok(document) = Document::parse(format!("{PREFIX}{text}")) else {
        return plain();
    };
    let mut table = Converter { source: id }.table(document.as_table(), span);
    match (table.entries.pop(), table.entries.is_empty()) {
        (Some(mut entry), true) if entry.key == "v" => {
            shift(&mut entry.node, PREFIX.len(), span.start);
            entry.node.value
        }
        _ => plain(),
    }
}

/// Moves spans from the text of the value alone to that of the whole assignment.
fn shift(node: &mut Node, prefix: usize, start: usize) {
    let moved = |span: Span| Span {
        start: (span.start + start).saturating_sub(prefix),
        end: (span.end + start).saturating_sub(prefix),
        ..span
    };
    node.span = moved(node.span);
    match &mut node.value {
        Value::Array(nodes) => nodes.iter_mut().for_each(|node| shift(node, prefix, start)),
        Value::Table(table) => {
            table.header = moved(table.header);
            for entry in &mut table.entries {
                entry.key_span = moved(entry.key_span);
                shift(&mut entry.node, prefix, start);
            }
        }
        _ => {}
    }
}

fn put(table: &mut Table, keys: &[(&str, Span)], node: Node) -> Result<(), Box<Diagnostic>> {
    let Some(((key, key_span), deeper)) = keys.split_first() else {
        return Ok(());
    };
    let at = match table.entries.iter().position(|entry| entry.key == *key) {
        Some(at) => at,
        None => {
            let indexed = deeper
                .first()
                .is_some_and(|(next, _)| next.parse::<usize>().is_ok());
            let value = match indexed {
                true => Value::Array(Vec::new()),
                false => Value::Table(Table {
                    header: *key_span,
                    entries: Vec::new(),
                }),
            };
            let empty = Node {
                span: *key_span,
                value,
            };
            table.entries.push(Entry {
                key: (*key).to_owned(),
                key_span: *key_span,
                node: empty,
            });
            table.entries.len() - 1
        }
    };
    let entry = &mut table.entries[at];
    if deeper.is_empty() {
        *entry = Entry {
            key: (*key).to_owned(),
            key_span: *key_span,
            node,
        };
        return Ok(());
    }
    match &mut entry.node.value {
        Value::Table(inner) => put(inner, deeper, node),
        Value::Array(nodes) => put_indexed(nodes, (key, *key_span), deeper, node),
        other => Err(Diagnostic::error(format!(
            "`{}` is {}, not a table",
            shorten(key),
            other.kind()
        ))
        .at(deeper[0].1, "there is nothing below it")
        .with(entry.node.span, "its value")
        .into()),
    }
}

/// `effect.0.rolling_friction=…`: the index may name an element, or the one after the last.
fn put_indexed(
    nodes: &mut Vec<Node>,
    (key, key_span): (&str, Span),
    keys: &[(&str, Span)],
    node: Node,
) -> Result<(), Box<Diagnostic>> {
    let (index_text, index_span) = keys[0];
    let key = shorten(key);
    let count = nodes.len();
    let Some(index) = index_text
        .parse::<usize>()
        .ok()
        .filter(|index| *index <= count)
    else {
        let names: Vec<&str> = nodes.iter().filter_map(element_name).collect();
        let help = match (nearest(index_text, names.iter().copied()), count) {
            (Some(name), _) => {
                let at = names.iter().position(|other| *other == name).unwrap_or(0);
                format!("`{name}` is number {at}: write {key}.{at}")
            }
            (None, 0) => format!("write {key}.0 to add the first"),
            (None, _) => format!(
                "write {key}.0 to {key}.{}, or {key}.{count} to add one",
                count - 1
            ),
        };
        return Err(
            Diagnostic::error(format!("`{key}` is a list of {count}, counted from 0"))
                .at(index_span, "no such element")
                .help(help)
                .into(),
        );
    };
    if index == count {
        let table = Table {
            header: key_span,
            entries: Vec::new(),
        };
        nodes.push(Node {
            span: key_span,
            value: Value::Table(table),
        });
    }
    match (&mut nodes[index].value, &keys[1..]) {
        (_, []) => {
            nodes[index] = node;
            Ok(())
        }
        (Value::Table(table), deeper) => put(table, deeper, node),
        (other, deeper) => Err(Diagnostic::error(format!(
            "`{key}.{index}` is {}, not a table",
            other.kind()
        ))
        .at(deeper[0].1, "there is nothing below it")
        .into()),
    }
}

fn element_name(node: &Node) -> Option<&str> {
    let Value::Table(table) = &node.value else {
        return None;
    };
    match &table.get("name")?.node.value {
        Value::Text(name) => Some(name),
        _ => None,
    }
}
