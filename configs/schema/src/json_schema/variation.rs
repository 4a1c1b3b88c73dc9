//! What readers ask of files, and of files that lack something, to see what is missed.

use std::iter::once;

use crate::diagnostics::Sources;
use crate::document::{self, Table, Value};
use crate::reader::{Asked, FileKind, Reader, TableReader};

/// What the reader `read` of files of one `kind` asks of `text`; nothing where it is no TOML. Then, if keys are left out
/// in turn, what it asks of the same text without each key at any depth, except below those that `is_whole` names: their
/// tables are read as a whole.
pub fn asked(
    (kind, read): (FileKind, &dyn Fn(TableReader<'_>)),
    text: &str,
    is_whole: Option<&dyn Fn(&str) -> bool>,
) -> Vec<Asked> {
    let mut sources = Sources::default();
    let id = sources.add("file.toml", text);
    let Ok(root) = document::parse(&sources, id) else { return Vec::new() };
    let less = is_whole.map_or(Vec::new(), |is_whole| without_each_key(&root, &is_whole));
    let ask = |root: Table| {
        let reader = Reader::noting(&sources, kind);
        read(reader.root(&root));
        reader.into_asked()
    };
    once(root).chain(less).map(ask).collect()
}

/// `root` without one key, once for every key at any depth, except below those that `is_whole` names.
fn without_each_key(root: &Table, is_whole: &impl Fn(&str) -> bool) -> Vec<Table> {
    let mut found = Vec::new();
    for at in 0..root.entries.len() {
        let mut less = root.clone();
        less.entries.remove(at);
        found.push(less);
        let entry = &root.entries[at];
        if is_whole(&entry.key) {
            continue;
        }
        match &entry.node.value {
            Value::Table(table) => {
                for below in without_each_key(table, is_whole) {
                    let mut less = root.clone();
                    less.entries[at].node.value = Value::Table(below);
                    found.push(less);
                }
            }
            Value::Array(nodes) => {
                for (index, node) in nodes.iter().enumerate() {
                    let Value::Table(table) = &node.value else { continue };
                    for below in without_each_key(table, is_whole) {
                        let mut less = root.clone();
                        if let Value::Array(nodes) = &mut less.entries[at].node.value {
                            nodes[index].value = Value::Table(below);
                        }
                        found.push(less);
                    }
                }
            }
            _ => {}
        }
    }
    found
}
