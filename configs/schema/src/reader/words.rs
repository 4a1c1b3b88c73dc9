//! Strings, names, choices, whole numbers and truth values.

use super::{Answer, Found, TableReader};
use crate::diagnostics::{Diagnostic, nearest, shorten};
use crate::document::{Node, Value};
use crate::limits;
use crate::resolved::{Written, quoted};

impl TableReader<'_> {
    /// A whole number; `default` stands in when the file does not give it.
    pub fn integer(
        &self,
        key: &'static str,
        default: Option<u64>,
        allowed: std::ops::RangeInclusive<u64>,
        meaning: &str,
    ) -> Option<Found<u64>> {
        let integers = || Answer::Integer(allowed.clone());
        self.asks_or(key, meaning, integers, || default.map(|value| value.to_string()));
        let found = match self.entry(key) {
            None => match default {
                Some(value) => Found { value, span: None },
                None => {
                    self.missing(key, "1000", meaning);
                    return None;
                }
            },
            Some(entry) => {
                let Value::Integer(value) = entry.node.value else {
                    self.reader.report(
                        Diagnostic::error(format!("`{key}` is not a whole number"))
                            .at(entry.node.span, "expected a whole number")
                            .help(format!("`{key}` is {meaning}")),
                    );
                    return None;
                };
                match u64::try_from(value).ok().filter(|value| allowed.contains(value)) {
                    Some(value) => Found { value, span: Some(entry.node.span) },
                    None => {
                        let (from, to) = (allowed.start(), allowed.end());
                        self.reader.report(
                            Diagnostic::error(format!("`{key}` is out of its range"))
                                .at(entry.node.span, format!("allowed: {from} to {to}"))
                                .help(format!("`{key}` is {meaning}")),
                        );
                        return None;
                    }
                }
            }
        };
        self.write(key, Written::Integer(found.value));
        Some(found)
    }

    /// `true` or `false`.
    pub fn boolean(&self, key: &'static str, default: bool) -> Option<bool> {
        self.asks_or(key, "", || Answer::Boolean, || Some(default.to_string()));
        let value = match self.entry(key) {
            None => default,
            Some(entry) => match entry.node.value {
                Value::Boolean(value) => value,
                _ => {
                    self.wrong_kind(entry, "true or false", "true");
                    return None;
                }
            },
        };
        self.write(key, Written::Boolean(value));
        Some(value)
    }

    /// A string, without writing it to the resolved model.
    pub(crate) fn raw_text(
        &self,
        key: &'static str,
        default: Option<&str>,
        example: &str,
        meaning: &str,
    ) -> Option<Found<String>> {
        self.asks_text(key, default, meaning, || Answer::Text);
        self.plain_text(key, default, example, meaning)
    }

    fn asks_text(
        &self,
        key: &'static str,
        default: Option<&str>,
        meaning: &str,
        answer: impl FnOnce() -> Answer,
    ) {
        self.asks_or(key, meaning, answer, || default.filter(|text| !text.is_empty()).map(quoted));
    }

    /// A string without a note of it, which is not written to the resolved model.
    fn plain_text(
        &self,
        key: &'static str,
        default: Option<&str>,
        example: &str,
        meaning: &str,
    ) -> Option<Found<String>> {
        match self.entry(key) {
            None => match default {
                Some(text) => Some(Found { value: text.to_owned(), span: None }),
                None => {
                    self.missing(key, &quoted(example), meaning);
                    None
                }
            },
            Some(entry) => match &entry.node.value {
                Value::Text(text) if text.len() <= limits::STRING_BYTES => {
                    Some(Found { value: text.clone(), span: Some(entry.node.span) })
                }
                Value::Text(text) => {
                    self.reader.report(
                        Diagnostic::error(format!("`{key}` is {} bytes long", text.len()))
                            .at(entry.node.span, format!("at most {}", limits::STRING_BYTES)),
                    );
                    None
                }
                _ => {
                    self.wrong_kind(entry, "a string", &quoted(example));
                    None
                }
            },
        }
    }

    /// A string.
    pub fn text(
        &self,
        key: &'static str,
        default: Option<&str>,
        example: &str,
        meaning: &str,
    ) -> Option<Found<String>> {
        self.asks_text(key, default, meaning, || Answer::Text);
        self.written_text(key, default, example, meaning)
    }

    /// A string that a list of those in `known` explains; who asks refuses others.
    pub(crate) fn name(
        &self,
        key: &'static str,
        known: &[&'static str],
        meaning: &str,
    ) -> Option<Found<String>> {
        self.asks_text(key, None, meaning, || Answer::Choice(known.to_vec()));
        self.written_text(key, None, known.first().copied().unwrap_or_default(), meaning)
    }

    /// A string without a note of it.
    fn written_text(
        &self,
        key: &'static str,
        default: Option<&str>,
        example: &str,
        meaning: &str,
    ) -> Option<Found<String>> {
        let found = self.plain_text(key, default, example, meaning)?;
        self.write(key, Written::Text(found.value.clone()));
        Some(found)
    }

    /// A list of strings; `None` when the file does not give it or it is something else, which is
    /// reported.
    pub fn texts(&self, key: &'static str) -> Option<Vec<String>> {
        self.asks(key, "", || Answer::Texts);
        let entry = self.entry(key)?;
        let text = |node: &Node| match &node.value {
            Value::Text(text) if text.len() <= limits::STRING_BYTES => Some(text.clone()),
            _ => None,
        };
        let found = match &entry.node.value {
            Value::Array(nodes) => nodes.iter().map(text).collect(),
            _ => None,
        };
        if found.is_none() {
            self.wrong_kind(entry, "a list of strings", "[\"…\"]");
        }
        found
    }

    /// A name used for files: lower-case letters, digits, `-` and `_`.
    pub fn slug(
        &self,
        key: &'static str,
        default: Option<&str>,
        meaning: &str,
    ) -> Option<Found<String>> {
        self.asks_text(key, default, meaning, || Answer::Slug);
        let found = self.written_text(key, default, "my-run", meaning)?;
        let fits = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-' || c == '_';
        if (1..=64).contains(&found.value.len()) && found.value.chars().all(fits) {
            return Some(found);
        }
        let mut proposal: String = found
            .value
            .to_lowercase()
            .chars()
            .map(|c| if fits(c) { c } else { '-' })
            .take(64)
            .collect();
        proposal = proposal.trim_matches('-').to_owned();
        if proposal.is_empty() {
            proposal = "my-run".to_owned();
        }
        self.reader.report(
            Diagnostic::error(format!("`{key}` is not usable as a name"))
                .at(found.span, "expected 1 to 64 of a-z, 0-9, - and _")
                .help(format!("write {key} = {}", quoted(&proposal))),
        );
        None
    }

    /// One of the names in `known`; those in `later` are named as coming.
    pub fn choice(
        &self,
        key: &'static str,
        known: &[&'static str],
        later: &[&str],
        meaning: &str,
    ) -> Option<&'static str> {
        let found = self.name(key, known, meaning)?;
        if let Some(name) = known.iter().find(|name| **name == found.value) {
            return Some(name);
        }
        let shown = shorten(&found.value);
        let list = known.iter().map(|name| quoted(name)).collect::<Vec<_>>().join(", ");
        let diagnostic = match later.contains(&found.value.as_str()) {
            true => Diagnostic::error(format!("{key} = \"{shown}\" comes with a later version"))
                .at(found.span, "not available yet"),
            false => {
                let label = match nearest(&found.value, known.iter().chain(later).copied()) {
                    Some(near) => format!("did you mean \"{near}\"?"),
                    None => "not known".to_owned(),
                };
                Diagnostic::error(format!("\"{shown}\" is not a `{key}` of [{}]", self.name))
                    .at(found.span, label)
            }
        };
        self.reader.report(diagnostic.help(format!("available now: {list}")));
        None
    }

    /// Writes TOML that was derived from what was read.
    pub(crate) fn note_toml(&self, key: &str, value: String) {
        self.write(key, Written::Toml(value));
    }

    /// Writes a string that was derived from what was read.
    pub(crate) fn note_text(&self, key: &str, value: &str) {
        self.write(key, Written::Text(value.to_owned()));
    }
}
