//! Reads tables key by key: collects every error, and writes what it read into the resolved model.

use std::cell::RefCell;

use engine::params::{Default as ParamDefault, ParamSpec, ParamTable, Range};
use engine::units::{self, Dimension};

use crate::diagnostics::{Diagnostic, Severity, Sources, Span, nearest, shorten};
use crate::document::{Entry, Node, Table, Value};
use crate::limits;
use crate::resolved::{Resolved, quoted};

/// A value that was read, and where; a default stands nowhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Found<T> {
    pub(crate) value: T,
    pub(crate) span: Option<Span>,
}

/// What all tables of one file share.
pub(crate) struct Reader<'a> {
    pub(crate) sources: &'a Sources,
    diagnostics: RefCell<Vec<Diagnostic>>,
    resolved: RefCell<Resolved>,
    homes: RefCell<Vec<(String, Vec<&'static str>)>>,
    unknown: RefCell<Vec<Unknown>>,
}

struct Unknown {
    key: String,
    span: Span,
    table: String,
    allowed: Vec<&'static str>,
}

impl<'a> Reader<'a> {
    pub(crate) fn new(sources: &'a Sources) -> Self {
        Self {
            sources,
            diagnostics: RefCell::default(),
            resolved: RefCell::default(),
            homes: RefCell::default(),
            unknown: RefCell::default(),
        }
    }

    /// Takes note of an error or a warning.
    pub(crate) fn report(&self, diagnostic: Diagnostic) {
        let mut all = self.diagnostics.borrow_mut();
        if all.len() < limits::DIAGNOSTICS {
            all.push(diagnostic);
        }
    }

    pub(crate) fn failed(&self) -> bool {
        self.diagnostics
            .borrow()
            .iter()
            .any(|one| one.severity == Severity::Error)
            || !self.unknown.borrow().is_empty()
    }

    /// The root: only tables may stand there.
    pub(crate) fn root(&'a self, table: &'a Table) -> TableReader<'a> {
        TableReader::new(self, "the file", String::new(), Some(table))
    }

    /// Everything that was reported, with the unknown keys explained, in the order of the text.
    pub(crate) fn finish(self) -> (Vec<Diagnostic>, Resolved) {
        let homes = self.homes.into_inner();
        let mut diagnostics = self.diagnostics.into_inner();
        for unknown in self
            .unknown
            .into_inner()
            .into_iter()
            .take(limits::DIAGNOSTICS)
        {
            diagnostics.push(unknown.explain(&homes));
        }
        diagnostics.sort_by_key(|one| {
            one.primary
                .as_ref()
                .map(|(span, _)| (span.source, span.start))
        });
        diagnostics.truncate(limits::DIAGNOSTICS);
        (diagnostics, self.resolved.into_inner())
    }
}

impl Unknown {
    fn explain(&self, homes: &[(String, Vec<&'static str>)]) -> Diagnostic {
        let key = shorten(&self.key);
        let place = match self.table.as_str() {
            "the file" => "a model file".to_owned(),
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
        let mut laws: Vec<String> = contact_laws::LAWS
            .iter()
            .filter(|law| law.params.iter().any(|spec| spec.key == self.key))
            .map(|law| format!("the law `{}`", law.name))
            .collect();
        laws.extend(
            intruders::SHAPES
                .iter()
                .filter(|shape| shape.params.iter().any(|spec| spec.key == self.key))
                .map(|shape| format!("the shape `{}`", shape.name)),
        );
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
}

/// Reads one table.
pub(crate) struct TableReader<'a> {
    pub(crate) reader: &'a Reader<'a>,
    name: String,
    table: Option<&'a Table>,
    section: usize,
    asked: RefCell<Vec<&'static str>>,
    numbers: RefCell<Vec<(&'static str, Option<f64>)>>,
}

impl<'a> TableReader<'a> {
    fn new(reader: &'a Reader<'a>, name: &str, header: String, table: Option<&'a Table>) -> Self {
        let section = reader.resolved.borrow_mut().open(header);
        Self {
            reader,
            name: name.to_owned(),
            table,
            section,
            asked: RefCell::default(),
            numbers: RefCell::default(),
        }
    }

    /// The header of the table, when the file has it.
    pub(crate) fn header(&self) -> Option<Span> {
        self.table.map(|table| table.header)
    }

    /// Whether `key` is given; it counts as known from now on.
    pub(crate) fn has(&self, key: &'static str) -> bool {
        self.entry(key).is_some()
    }

    fn entry(&self, key: &'static str) -> Option<&'a Entry> {
        let mut asked = self.asked.borrow_mut();
        if !asked.contains(&key) {
            asked.push(key);
        }
        self.table.and_then(|table| table.get(key))
    }

    fn write(&self, key: &str, value: String) {
        self.reader
            .resolved
            .borrow_mut()
            .line(self.section, key, value);
    }

    fn write_number(&self, key: &str, value: f64, dimension: Dimension) {
        self.write(key, number_toml(value, dimension));
    }

    /// Reports that a required key is missing, with an example of what to write.
    fn missing(&self, key: &str, example: &str, meaning: &str) {
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
            Diagnostic::error(format!("`{}` is {found}; {wanted} is wanted", entry.key))
                .at(entry.node.span, format!("{wanted} is wanted"))
                .help(format!("write {} = {example}", entry.key)),
        );
    }

    /// A table below this one. When it is required and missing, that is reported once, with
    /// `example` as what to write.
    pub(crate) fn table(&self, key: &'static str, example: Option<&str>) -> TableReader<'a> {
        let name = self.child(key);
        let table = match self.entry(key) {
            Some(Entry {
                node:
                    Node {
                        value: Value::Table(table),
                        ..
                    },
                ..
            }) => Some(table),
            Some(entry) => {
                let wanted = match &entry.node.value {
                    Value::Array(_) => format!("write [{name}], in single brackets"),
                    _ => format!("write [{name}] and its keys below it"),
                };
                self.reader.report(
                    Diagnostic::error(format!("`{key}` is a table"))
                        .at(
                            entry.key_span,
                            format!("this is {}", entry.node.value.kind()),
                        )
                        .help(wanted),
                );
                None
            }
            None => {
                if let Some(example) = example {
                    self.reader.report(
                        Diagnostic::error(format!("the table [{name}] is missing"))
                            .help(format!("a model needs it:\n[{name}]\n{example}")),
                    );
                }
                None
            }
        };
        TableReader::new(self.reader, &name, format!("[{name}]"), table)
    }

    /// The elements of an array of tables below this one.
    pub(crate) fn tables(&self, key: &'static str, at_most: usize) -> Vec<TableReader<'a>> {
        let name = self.child(key);
        let Some(entry) = self.entry(key) else {
            return Vec::new();
        };
        let Value::Array(nodes) = &entry.node.value else {
            self.reader.report(
                Diagnostic::error(format!("`{name}` is a list of tables"))
                    .at(
                        entry.node.span,
                        format!("this is {}", entry.node.value.kind()),
                    )
                    .help(format!("write [[{name}]], in double brackets")),
            );
            return Vec::new();
        };
        if nodes.len() > at_most {
            self.reader.report(
                Diagnostic::error(format!("{} times [[{name}]] is too many", nodes.len())).at(
                    nodes[at_most].span,
                    format!("at most {at_most} are accepted"),
                ),
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

    /// A number or quantity as its specification says.
    pub(crate) fn number(&self, spec: &ParamSpec) -> Option<Found<f64>> {
        let found = match self.entry(spec.key) {
            Some(entry) => self.number_at(&entry.node, spec),
            None => match spec.default {
                ParamDefault::Required => {
                    self.missing(spec.key, &example(spec), spec.meaning);
                    None
                }
                ParamDefault::Value(value) => Some(Found { value, span: None }),
                ParamDefault::SameAs(other) => {
                    let numbers = self.numbers.borrow();
                    let value = numbers.iter().find(|(key, _)| *key == other);
                    value
                        .and_then(|(_, value)| *value)
                        .map(|value| Found { value, span: None })
                }
            },
        };
        self.numbers
            .borrow_mut()
            .push((spec.key, found.map(|found| found.value)));
        if let Some(found) = found {
            self.write_number(spec.key, found.value, spec.dimension);
        }
        found
    }

    /// A number that may be left out; the outer `None` is an error that was reported.
    pub(crate) fn optional_number(&self, spec: &ParamSpec) -> Option<Option<Found<f64>>> {
        match self.has(spec.key) {
            true => self.number(spec).map(Some),
            false => Some(None),
        }
    }

    /// All parameters of a registry entry.
    pub(crate) fn params(&self, specs: &'static [ParamSpec]) -> Option<ParamTable> {
        let mut table = ParamTable::new();
        let mut complete = true;
        for spec in specs {
            match self.number(spec) {
                Some(found) => table.set(spec.key, found.value),
                None => complete = false,
            }
        }
        complete.then_some(table)
    }

    /// Where the value of `key` stands, if the file gives it.
    pub(crate) fn span_of(&self, key: &str) -> Option<Span> {
        self.table
            .and_then(|table| table.get(key))
            .map(|entry| entry.node.span)
    }

    /// A list of quantities, each as its specification says.
    pub(crate) fn numbers(&self, spec: &ParamSpec) -> Option<Option<Vec<Found<f64>>>> {
        let Some(entry) = self.entry(spec.key) else {
            return Some(None);
        };
        let Value::Array(nodes) = &entry.node.value else {
            let item = match &entry.node.value {
                Value::Text(text) => quoted(&shorten(text)),
                _ => example(spec),
            };
            self.wrong_kind(entry, "a list", &format!("[{item}]"));
            return None;
        };
        if nodes.is_empty() || nodes.len() > limits::CONDITIONS {
            self.reader.report(
                Diagnostic::error(format!("`{}` has {} values", spec.key, nodes.len())).at(
                    entry.node.span,
                    format!("from 1 to {} are wanted", limits::CONDITIONS),
                ),
            );
            return None;
        }
        let read: Vec<_> = nodes
            .iter()
            .map(|node| self.number_at(node, spec))
            .collect();
        let values: Option<Vec<Found<f64>>> = read.into_iter().collect();
        let values = values?;
        let items: Vec<String> = values
            .iter()
            .map(|found| number_toml(found.value, spec.dimension))
            .collect();
        self.write(spec.key, format!("[{}]", items.join(", ")));
        Some(Some(values))
    }

    pub(crate) fn number_at(&self, node: &Node, spec: &ParamSpec) -> Option<Found<f64>> {
        let value = match (spec.dimension == Dimension::NONE, &node.value) {
            (true, Value::Float(value)) => *value,
            (true, Value::Integer(value)) => *value as f64,
            (false, Value::Text(text)) => match units::parse(text, spec.dimension) {
                Ok(value) => value,
                Err(error) => {
                    self.reader.report(
                        Diagnostic::error(format!("`{}`: {}", spec.key, error.reason()))
                            .at(node.span, format!("{} is wanted", spec.dimension.name()))
                            .help(self.unit_help(spec, &error)),
                    );
                    return None;
                }
            },
            (true, Value::Text(text)) => {
                let bare = text.trim().parse::<f64>().is_ok_and(f64::is_finite);
                let example = if bare {
                    text.trim().to_owned()
                } else {
                    example(spec)
                };
                self.reader.report(
                    Diagnostic::error(format!("`{}` is a string; it is a pure number", spec.key))
                        .at(
                            node.span,
                            "a bare number is wanted, without unit and quotes",
                        )
                        .help(format!("write {} = {example}", spec.key)),
                );
                return None;
            }
            (false, Value::Float(_) | Value::Integer(_)) => {
                let number = self.reader.sources.quote(node.span);
                let finite = !number.is_empty() && !number.contains(['n', 'N']);
                let shown = if finite { number.as_str() } else { "3" };
                self.reader.report(
                    Diagnostic::error(format!("`{}` has no unit", spec.key))
                        .at(node.span, format!("{} is wanted", spec.dimension.name()))
                        .help(format!(
                            "write it in quotes, with its unit: {}",
                            spec.dimension.examples(shown)
                        )),
                );
                return None;
            }
            (_, other) => {
                let wanted = spec.dimension.name();
                self.reader.report(
                    Diagnostic::error(format!(
                        "`{}` is {}; {wanted} is wanted",
                        spec.key,
                        other.kind()
                    ))
                    .at(node.span, format!("{wanted} is wanted"))
                    .help(format!("write {} = {}", spec.key, example(spec))),
                );
                return None;
            }
        };
        self.in_range(value, node.span, spec)
    }

    fn unit_help(&self, spec: &ParamSpec, error: &units::UnitError) -> String {
        let planar = spec.dimension == Dimension::AREA_DENSITY
            && error.fault == units::UnitFault::Dimension(Dimension::DENSITY);
        match planar {
            true => format!(
                "{}\na planar medium has a density per area: density × thickness",
                error.advice()
            ),
            false => error.advice(),
        }
    }

    fn in_range(&self, value: f64, span: Span, spec: &ParamSpec) -> Option<Found<f64>> {
        if !value.is_finite() || !spec.allowed.contains(value) {
            let what = match value.is_finite() {
                true => format!("`{}` is out of its range", spec.key),
                false => format!("`{}` is not a finite number", spec.key),
            };
            self.reader.report(
                Diagnostic::error(what)
                    .at(
                        span,
                        format!("allowed: {}", interval(spec.allowed, spec.dimension)),
                    )
                    .help(format!("`{}` is {}", spec.key, spec.meaning)),
            );
            return None;
        }
        if !spec.plausible.contains(value) {
            let usual = interval(spec.plausible, spec.dimension);
            self.reader.report(
                Diagnostic::warning(format!("`{}` has an unusual value", spec.key))
                    .at(span, format!("usual: {usual}"))
                    .help(format!("`{}` is {}", spec.key, spec.meaning)),
            );
        }
        Some(Found {
            value,
            span: Some(span),
        })
    }

    /// A whole number; `default` stands in when the file does not give it.
    pub(crate) fn integer(
        &self,
        key: &'static str,
        default: Option<u64>,
        allowed: std::ops::RangeInclusive<u64>,
        meaning: &str,
    ) -> Option<Found<u64>> {
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
                            .at(entry.node.span, "a whole number is wanted")
                            .help(format!("`{key}` is {meaning}")),
                    );
                    return None;
                };
                match u64::try_from(value)
                    .ok()
                    .filter(|value| allowed.contains(value))
                {
                    Some(value) => Found {
                        value,
                        span: Some(entry.node.span),
                    },
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
        self.write(key, found.value.to_string());
        Some(found)
    }

    /// `true` or `false`.
    pub(crate) fn boolean(&self, key: &'static str, default: bool) -> Option<bool> {
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
        self.write(key, value.to_string());
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
        match self.entry(key) {
            None => match default {
                Some(text) => Some(Found {
                    value: text.to_owned(),
                    span: None,
                }),
                None => {
                    self.missing(key, &quoted(example), meaning);
                    None
                }
            },
            Some(entry) => match &entry.node.value {
                Value::Text(text) if text.len() <= limits::STRING_BYTES => Some(Found {
                    value: text.clone(),
                    span: Some(entry.node.span),
                }),
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
    pub(crate) fn text(
        &self,
        key: &'static str,
        default: Option<&str>,
        example: &str,
        meaning: &str,
    ) -> Option<Found<String>> {
        let found = self.raw_text(key, default, example, meaning)?;
        self.write(key, quoted(&found.value));
        Some(found)
    }

    /// A name used for files: lower-case letters, digits, `-` and `_`.
    pub(crate) fn slug(
        &self,
        key: &'static str,
        default: Option<&str>,
        meaning: &str,
    ) -> Option<Found<String>> {
        let found = self.text(key, default, "my-run", meaning)?;
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
                .at(found.span, "1 to 64 of a-z, 0-9, - and _ are wanted")
                .help(format!("write {key} = {}", quoted(&proposal))),
        );
        None
    }

    /// One of the names in `known`; those in `later` are named as coming.
    pub(crate) fn choice(
        &self,
        key: &'static str,
        known: &[&'static str],
        later: &[&str],
        meaning: &str,
    ) -> Option<&'static str> {
        let found = self.text(
            key,
            None,
            known.first().copied().unwrap_or_default(),
            meaning,
        )?;
        if let Some(name) = known.iter().find(|name| **name == found.value) {
            return Some(name);
        }
        let shown = shorten(&found.value);
        let list = known
            .iter()
            .map(|name| quoted(name))
            .collect::<Vec<_>>()
            .join(", ");
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
        self.reader
            .report(diagnostic.help(format!("available now: {list}")));
        None
    }

    /// A number that is not written to the resolved model; something derived from it is.
    pub(crate) fn quiet_number(&self, spec: &ParamSpec) -> Option<Found<f64>> {
        self.entry(spec.key)
            .and_then(|entry| self.number_at(&entry.node, spec))
    }

    /// The value of `key` as it stands in the file.
    pub(crate) fn node(&self, key: &'static str) -> Option<&'a Node> {
        self.entry(key).map(|entry| &entry.node)
    }

    /// The string at `key`, if it is one.
    pub(crate) fn peek_text(&self, key: &'static str) -> Option<&'a str> {
        match &self.node(key)?.value {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }

    /// Writes a pair of numbers.
    pub(crate) fn note_pair(&self, spec: &ParamSpec, (from, to): (f64, f64)) {
        let [from, to] = [from, to].map(|value| number_toml(value, spec.dimension));
        self.write(spec.key, format!("[{from}, {to}]"));
    }

    /// Writes a line that was derived from what was read.
    pub(crate) fn note(&self, spec: &ParamSpec, value: f64) {
        self.write_number(spec.key, value, spec.dimension);
    }

    /// Writes a string that was derived from what was read.
    pub(crate) fn note_text(&self, key: &str, value: &str) {
        self.write(key, quoted(value));
    }

    /// Refuses the keys that nobody asked for.
    pub(crate) fn finish(self) {
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

/// A number or quantity as TOML.
fn number_toml(value: f64, dimension: Dimension) -> String {
    match dimension == Dimension::NONE {
        true => format!("{value:?}"),
        false => quoted(&units::format_si(value, dimension)),
    }
}

/// Something plausible to write for a parameter.
fn example(spec: &ParamSpec) -> String {
    let Range { min, max, .. } = spec.plausible;
    let middle = match min > 0.0 && max.is_finite() {
        true => (min * max).sqrt(),
        false if max < f64::MAX => max / 5.0,
        false => 1.0,
    };
    let middle = match spec.default {
        ParamDefault::Value(value) => value,
        _ => format!("{middle:.0e}").parse().unwrap_or(middle),
    };
    match spec.dimension {
        Dimension::NONE => format!("{middle:?}"),
        Dimension::ANGLE => "\"45 deg\"".to_owned(),
        dimension => quoted(&units::format_si(middle, dimension)),
    }
}

/// An interval of SI values in words: `above 0 m`, `0 to 1.5`; angles in degrees.
#[must_use]
pub fn interval(range: Range, dimension: Dimension) -> String {
    let show = |value: f64| match dimension {
        Dimension::ANGLE => format!("{} deg", (value.to_degrees() * 1e6).round() / 1e6),
        _ => units::format_si(value, dimension),
    };
    let Range {
        min,
        max,
        includes_min,
    } = range;
    match (includes_min, max < f64::MAX) {
        (true, true) => format!("{} to {}", show(min), show(max)),
        (false, true) => format!("above {}, up to {}", show(min), show(max)),
        (true, false) => format!("{} or more", show(min)),
        (false, false) => format!("above {}", show(min)),
    }
}
