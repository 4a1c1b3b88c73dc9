//! What was asked of one table, in one situation.

use super::answers::Leaf;
use crate::reader::{Seen, Word};

/// The keys that were asked for, with what may stand there.
#[derive(Clone, Debug, Default)]
pub(super) struct Facts {
    /// In the order in which they were first asked for.
    pub(super) keys: Vec<(&'static str, Vec<Leaf>)>,
    /// Keys that were there and keys that were missed, of every reading.
    readings: Vec<(Vec<String>, Vec<&'static str>)>,
}

impl Facts {
    /// Adds that `leaf` may stand at `key`.
    pub(super) fn add(&mut self, key: &'static str, leaf: Leaf) {
        match self.keys.iter_mut().find(|(known, _)| *known == key) {
            Some((_, leaves)) if leaves.contains(&leaf) => {}
            Some((_, leaves)) => leaves.push(leaf),
            None => self.keys.push((key, vec![leaf])),
        }
    }

    /// Adds which keys a table had, and which were missed.
    pub(super) fn add_reading(&mut self, seen: &Seen) {
        let is_firm = |key: &&'static str| !seen.replaceable.contains(key);
        let missing = seen.missing.iter().copied().filter(is_firm).collect();
        let reading = (seen.keys.clone(), missing);
        if seen.is_there && !self.readings.contains(&reading) {
            self.readings.push(reading);
        }
    }

    /// Takes in what is known from elsewhere.
    pub(super) fn merge(&mut self, other: &Self) {
        for (key, leaves) in &other.keys {
            leaves.iter().for_each(|leaf| self.add(key, leaf.clone()));
        }
        for reading in &other.readings {
            if !self.readings.contains(reading) {
                self.readings.push(reading.clone());
            }
        }
    }

    /// The leaves of `key`.
    pub(super) fn leaves(&self, key: &str) -> Option<&[Leaf]> {
        self.keys.iter().find(|(known, _)| *known == key).map(|(_, leaves)| leaves.as_slice())
    }

    /// The keys that were missed whenever they were not there.
    pub(super) fn required(&self) -> Vec<&'static str> {
        let mut required: Vec<&'static str> = Vec::new();
        for key in self.readings.iter().flat_map(|(_, missing)| missing) {
            let is_missed = |(there, missing): &(Vec<String>, Vec<&'static str>)| {
                missing.contains(key) || there.iter().any(|one| one == key)
            };
            if !required.contains(key) && self.readings.iter().all(is_missed) {
                required.push(key);
            }
        }
        required.sort_by_key(|key| self.keys.iter().position(|(known, _)| known == key));
        required
    }
}

/// What of a file decides which keys it takes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Situation {
    /// The table.
    pub(super) table: String,
    /// The word in it that decides on its other keys.
    pub(super) own: Option<Word>,
    /// The words of the file that decide on keys of every table.
    pub(super) of_file: Vec<Option<Word>>,
}
