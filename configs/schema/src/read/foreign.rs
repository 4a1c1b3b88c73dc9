//! Tables and keys that belong to the other kind of medium.

use crate::diagnostics::{Diagnostic, Span};
use crate::reader::TableReader;

/// Refuses what belongs to another kind of medium, by its own name and not as something unknown.
pub(super) struct Foreign {
    /// The kind that it belongs to.
    pub(super) home: &'static str,
    /// The kind of this model, and where the file says so.
    pub(super) here: (&'static str, Option<Span>),
}

impl Foreign {
    /// Refuses `keys` of `table`, whose name is `name`.
    pub(super) fn keys(&self, table: &TableReader<'_>, name: &str, keys: &[&'static str]) {
        for &key in keys.iter().filter(|key| table.span_of(key).is_some()) {
            self.refuse(
                &format!("`{key}` of [{name}]"),
                table.node(key).map(|node| node.span),
                table,
            );
        }
    }

    /// Refuses `tables` of the file.
    pub(super) fn tables(&self, root: &TableReader<'_>, tables: &[&'static str]) {
        for &key in tables.iter().filter(|key| root.span_of(key).is_some()) {
            self.refuse(&format!("[{key}]"), root.node(key).map(|node| node.span), root);
        }
    }

    fn refuse(&self, what: &str, at: Option<Span>, table: &TableReader<'_>) {
        let (here, kind) = self.here;
        table.reader.report(
            Diagnostic::error(format!("{what} belongs to a medium of the kind \"{}\"", self.home))
                .at(at, "not in this model")
                .with(kind, format!("its medium is of the kind \"{here}\"")),
        );
    }
}
