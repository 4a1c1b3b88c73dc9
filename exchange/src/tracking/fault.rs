//! What keeps a table from becoming a set: where, what is wrong, and what would be right.

use std::fmt;
use std::io;
use std::path::PathBuf;

use thiserror::Error;

/// One thing that is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The file, or the option.
    pub place: String,
    /// The line of a text or the row of a sheet, from 1.
    pub line: Option<u64>,
    /// What is wrong.
    pub what: String,
    /// What would be right.
    pub right: String,
}

impl Fault {
    pub(super) fn new(place: &str, what: impl Into<String>, right: impl Into<String>) -> Self {
        Self { place: place.to_owned(), line: None, what: what.into(), right: right.into() }
    }

    pub(super) fn at(self, line: u64) -> Self {
        Self { line: Some(line), ..self }
    }

    /// What is wrong and right, without numbers and what is quoted: the same in several files.
    fn kind(&self) -> String {
        let text = format!("{}\n{}", self.what, self.right);
        let outside = text.split('"').step_by(2);
        outside.flat_map(str::chars).filter(|c| !c.is_ascii_digit() && *c != '.').collect()
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.place)?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        write!(f, ": {}\n  {}", self.what, self.right)
    }
}

/// Why there is no set.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum TrackingError {
    #[error("{}", listed(.0))]
    Input(Vec<Fault>),
    #[error("cannot write {}: {source}", path.display())]
    Write { path: PathBuf, source: io::Error },
    #[error("{0}")]
    ImportFile(String),
}

impl From<Fault> for TrackingError {
    fn from(fault: Fault) -> Self {
        Self::Input(vec![fault])
    }
}

impl From<Vec<Fault>> for TrackingError {
    fn from(faults: Vec<Fault>) -> Self {
        Self::Input(faults)
    }
}

/// Most faults that are listed.
const MOST: usize = 10;

/// Faults as lines; one that several files have is listed once.
fn listed(faults: &[Fault]) -> String {
    let mut kinds: Vec<(&Fault, usize)> = Vec::new();
    for fault in faults {
        let is_same = |(first, _): &&mut (&Fault, usize)| {
            first.place != fault.place && first.kind() == fault.kind()
        };
        match kinds.iter_mut().find(is_same) {
            Some((_, others)) => *others += 1,
            None => kinds.push((fault, 0)),
        }
    }
    let one = |(fault, others): &(&Fault, usize)| match others {
        0 => fault.to_string(),
        1 => format!("{fault}\n  one more file has this"),
        n => format!("{fault}\n  {n} more files have this"),
    };
    let mut lines: Vec<String> = kinds.iter().take(MOST).map(one).collect();
    if kinds.len() > MOST {
        lines.push(format!("and {} more", kinds.len() - MOST));
    }
    lines.join("\n")
}
