//! `--set key.path=value`: puts one value over what the file says.

use toml_edit::Document;

use crate::diagnostics::{Diagnostic, SourceId, Sources, Span, nearest, shorten};
use crate::document::{Converter, Entry, Node, Table, Value};

/// Puts one `key.path=value` over what the file says.
pub(crate) fn apply_set(
    root: &mut Table,
    sources: &mut Sources,
    option: &str,
    assignment: &str,
) -> Result<(), Box<Diagnostic>> {
    let id = sources.add(option, assignment);
    let whole = Span { source: id, start: 0, end: assignment.len() };
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
    let value_span = Span { source: id, start: path.len() + 1, end: assignment.len() };
    let value = set_value(text, id, value_span);
    let keys: Vec<(&str, Span)> = path
        .split('.')
        .scan(0, |at, key| {
            let start = *at + key.len() - key.trim_start().len();
            let span = Span { source: id, start, end: start + key.trim().len() };
            *at += key.len() + 1;
            Some((key.trim(), span))
        })
        .collect();
    if keys.len() > 8 || keys.iter().any(|(key, _)| key.is_empty()) {
        return Err(malformed("this assignment names no key".to_owned()));
    }
    put(root, &keys, Node { span: value_span, value })
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
            let indexed = deeper.first().is_some_and(|(next, _)| next.parse::<usize>().is_ok());
            let value = match indexed {
                true => Value::Array(Vec::new()),
                false => Value::Table(Table { header: *key_span, entries: Vec::new() }),
            };
            let empty = Node { span: *key_span, value };
            table.entries.push(Entry { key: (*key).to_owned(), key_span: *key_span, node: empty });
            table.entries.len() - 1
        }
    };
    let entry = &mut table.entries[at];
    if deeper.is_empty() {
        *entry = Entry { key: (*key).to_owned(), key_span: *key_span, node };
        return Ok(());
    }
    match &mut entry.node.value {
        Value::Table(inner) => put(inner, deeper, node),
        Value::Array(nodes) => put_indexed(nodes, (key, *key_span), deeper, node),
        other => {
            Err(Diagnostic::error(format!("`{}` is {}, not a table", shorten(key), other.kind()))
                .at(deeper[0].1, "there is nothing below it")
                .with(entry.node.span, "its value")
                .into())
        }
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
    let Some(index) = index_text.parse::<usize>().ok().filter(|index| *index <= count) else {
        let names: Vec<&str> = nodes.iter().filter_map(element_name).collect();
        let help = match (nearest(index_text, names.iter().copied()), count) {
            (Some(name), _) => {
                let at = names.iter().position(|other| *other == name).unwrap_or(0);
                format!("`{name}` is number {at}: write {key}.{at}")
            }
            (None, 0) => format!("write {key}.0 to add the first"),
            (None, _) => {
                format!("write {key}.0 to {key}.{}, or {key}.{count} to add one", count - 1)
            }
        };
        return Err(Diagnostic::error(format!("`{key}` is a list of {count}, counted from 0"))
            .at(index_span, "no such element")
            .help(help)
            .into());
    };
    if index == count {
        let table = Table { header: key_span, entries: Vec::new() };
        nodes.push(Node { span: key_span, value: Value::Table(table) });
    }
    match (&mut nodes[index].value, &keys[1..]) {
        (_, []) => {
            nodes[index] = node;
            Ok(())
        }
        (Value::Table(table), deeper) => put(table, deeper, node),
        (other, deeper) => {
            Err(Diagnostic::error(format!("`{key}.{index}` is {}, not a table", other.kind()))
                .at(deeper[0].1, "there is nothing below it")
                .into())
        }
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
