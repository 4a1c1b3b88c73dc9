//! Lists of strings.

use super::{Answer, Found, TableReader};
use crate::document::Value;
use crate::resolved::{Written, quoted};

impl TableReader<'_> {
    /// A list of strings, if it is given, without writing it to the resolved model; the outer `None` is
    /// an error that was reported.
    pub fn raw_texts(
        &self,
        key: &'static str,
        example: &str,
    ) -> Option<Option<Vec<Found<String>>>> {
        self.asks(key, "", || Answer::Texts);
        let Some(entry) = self.entry(key) else {
            return Some(None);
        };
        let texts = match &entry.node.value {
            Value::Array(nodes) => nodes
                .iter()
                .map(|node| match &node.value {
                    Value::Text(text) => Some(Found { value: text.clone(), span: Some(node.span) }),
                    _ => None,
                })
                .collect::<Option<Vec<_>>>(),
            _ => None,
        };
        if texts.is_none() {
            self.wrong_kind(entry, "a list of strings", &format!("[{}]", quoted(example)));
        }
        texts.map(Some)
    }

    /// Writes a list of strings that was derived from what was read.
    pub(crate) fn note_texts(&self, key: &str, values: &[String]) {
        let items: Vec<String> = values.iter().map(|value| quoted(value)).collect();
        self.write(key, Written::Toml(format!("[{}]", items.join(", "))));
    }
}
