//! Keys that nobody asked for, and where they may belong.

use super::kind::FileKind;
use crate::diagnostics::{Diagnostic, Span, nearest, shorten};

/// A key that nobody asked for.
pub(super) struct Unknown {
    pub(super) key: String,
    pub(super) span: Span,
    pub(super) table: String,
    pub(super) allowed: Vec<&'static str>,
}

impl Unknown {
    /// What to say about it, given the keys of every table.
    pub(super) fn explain(
        &self,
        kind: FileKind,
        homes: &[(String, Vec<&'static str>)],
    ) -> Diagnostic {
        let key = shorten(&self.key);
        let place = match self.table.as_str() {
            "the file" => format!("{} file", kind.noun()),
            table => format!("[{table}]"),
        };
        let diagnostic = Diagnostic::error(format!("`{key}` is not a key of {place}"));
        let mut help = String::new();
        let label = match nearest(&self.key, self.allowed.iter().copied()) {
            Some(near) => format!("did you mean `{near}`?"),
            None => "unknown key".to_owned(),
        };
        let exact: Vec<String> = homes
            .iter()
            .filter(|(table, keys)| *table != self.table && keys.contains(&self.key.as_str()))
            .map(|(table, _)| match table.as_str() {
                "the file" => "the top of the file, as a table of its own".to_owned(),
                table => format!("[{table}]"),
            })
            .collect();
        let laws = match kind {
            FileKind::Model => self.laws(),
            FileKind::MeasurementSet | FileKind::Campaign | FileKind::Import => Vec::new(),
        };
        match (exact.as_slice(), laws.as_slice()) {
            ([], []) => {}
            ([], laws) => help.push_str(&format!("`{key}` belongs to {}\n", laws.join(" and "))),
            (tables, _) => help.push_str(&format!("`{key}` belongs to {}\n", tables.join(" or "))),
        }
        help.push_str(&match self.allowed.as_slice() {
            [] => format!("{place} takes no keys"),
            allowed => format!("keys of {place}: {}", allowed.join(", ")),
        });
        let label = match exact.is_empty() && laws.is_empty() {
            true => label,
            false => "this key belongs elsewhere".to_owned(),
        };
        diagnostic.at(self.span, label).help(help)
    }

    /// The laws and shapes that have this key.
    fn laws(&self) -> Vec<String> {
        let laws = contact_laws::LAWS
            .iter()
            .filter(|law| law.params.iter().any(|spec| spec.key == self.key))
            .map(|law| format!("the law `{}`", law.name));
        let forces = contact_laws::GRAIN_FORCES
            .iter()
            .filter(|force| force.params.iter().any(|spec| spec.key == self.key))
            .map(|force| format!("the effect `{}`", force.name));
        let shapes = intruders::SHAPES
            .iter()
            .filter(|shape| shape.params.iter().any(|spec| spec.key == self.key))
            .map(|shape| format!("the shape `{}`", shape.name));
        laws.chain(forces).chain(shapes).collect()
    }
}
