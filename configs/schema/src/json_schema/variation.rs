//! Files that lack something, to see what is missed.

use crate::document::{Table, Value};

/// `root` without one key, once for every key at any depth, except below those that `is_whole` names: their
/// tables are read as a whole.
pub fn without_each_key(root: &Table, is_whole: &impl Fn(&str) -> bool) -> Vec<Table> {
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
