//! What a reader asks of a file: noted for who describes the format, such as a schema for editors.

use std::cell::RefCell;
use std::ops::RangeInclusive;

use engine::params::ParamSpec;
use engine::units::Dimension;

use crate::document::{Table, Value};

/// What may stand at a key.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// A number or quantity.
    Number(ParamSpec),
    /// A list of them, of this length or of any.
    Numbers(ParamSpec, Option<usize>),
    /// A number, a table over the impact angle or a formula.
    Coefficient(ParamSpec),
    /// A number in the unit of another key, or a string with a unit of its own.
    NumberInUnit(Dimension),
    /// A whole number from these.
    Integer(RangeInclusive<u64>),
    /// A whole number from these, or a list of whole numbers.
    Integers(RangeInclusive<u64>),
    /// True or false.
    Boolean,
    /// Any string.
    Text,
    /// A name used for files.
    Slug,
    /// A list of strings.
    Texts,
    /// One of these strings.
    Choice(Vec<&'static str>),
    /// A table whose keys are asked for.
    Table,
    /// A list of such tables.
    Tables,
    /// Such a table, or a list of them.
    TableOrTables,
    /// What the schema defines by this name.
    Defined(&'static str),
}

/// One question of a reader.
#[derive(Clone, Debug)]
pub struct Question {
    /// Which of the [`Seen`] tables it was asked of.
    pub of: usize,
    /// The key.
    pub key: &'static str,
    /// What may stand there.
    pub answer: Answer,
    /// One line of meaning, as messages have it; empty where they have none.
    pub meaning: String,
    /// What stands in where the file says nothing, as TOML.
    pub default: Option<String>,
}

/// One table of a file, whether it is there or not.
#[derive(Clone, Debug)]
pub struct Seen {
    /// Its name with those of the tables above; empty for the file itself.
    pub name: String,
    /// Whether the file has it.
    pub is_there: bool,
    /// The keys that it has.
    pub keys: Vec<String>,
    /// Those keys whose values are strings or whole numbers, with the values.
    pub words: Vec<(String, Word)>,
    /// The keys that were missed.
    pub missing: Vec<&'static str>,
    /// The keys that others can stand in for, so that missing one of them says little.
    pub replaceable: Vec<&'static str>,
}

/// A string or a whole number.
#[derive(Clone, Debug, PartialEq)]
pub enum Word {
    /// A string.
    Text(String),
    /// A whole number.
    Integer(i64),
}

/// All that was asked of one file.
#[derive(Clone, Debug, Default)]
pub struct Asked {
    /// The tables in the order of reading.
    pub tables: Vec<Seen>,
    /// The questions in the order of asking.
    pub questions: Vec<Question>,
}

/// Where a reader keeps notes of what it asks; those of files that are run keep none.
pub(super) type Notes = Option<RefCell<Asked>>;

impl Asked {
    pub(super) fn open(&mut self, name: &str, table: Option<&Table>) -> usize {
        let entries = table.map_or(&[][..], |table| table.entries.as_slice());
        let word = |value: &Value| match value {
            Value::Text(text) => Some(Word::Text(text.clone())),
            Value::Integer(number) => Some(Word::Integer(*number)),
            _ => None,
        };
        self.tables.push(Seen {
            name: if name == "the file" { String::new() } else { name.to_owned() },
            is_there: table.is_some(),
            keys: entries.iter().map(|entry| entry.key.clone()).collect(),
            words: entries
                .iter()
                .filter_map(|entry| Some((entry.key.clone(), word(&entry.node.value)?)))
                .collect(),
            missing: Vec::new(),
            replaceable: Vec::new(),
        });
        self.tables.len() - 1
    }
}
