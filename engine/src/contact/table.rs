//! Which grain may touch which partner, and what each contact remembers.

use std::ops::Range;

use serde::{Deserialize, Serialize};

/// Candidate contacts sorted by key, with the history of those that touch.
///
/// A rebuild of the neighbour list joins the old keys with the new ones by merging the two sorted
/// lists, so a history moves with its contact and no order depends on anything but the keys.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactTable {
    keys: Vec<[u32; 2]>,
    touching: Vec<bool>,
    /// Per stage, `history_len` values per row.
    history: Vec<Vec<f64>>,
    history_len: Vec<usize>,
    #[serde(skip)]
    spare: Spare,
}

#[derive(Clone, Debug, Default)]
struct Spare {
    touching: Vec<bool>,
    history: Vec<f64>,
}

impl PartialEq for Spare {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl ContactTable {
    /// An empty table whose stages remember `history_len` values per contact each.
    #[must_use]
    pub fn new(history_len: &[usize]) -> Self {
        Self {
            history: vec![Vec::new(); history_len.len()],
            history_len: history_len.to_vec(),
            ..Self::default()
        }
    }

    /// The candidates: (grain i, partner j), ascending.
    #[must_use]
    pub fn keys(&self) -> &[[u32; 2]] {
        &self.keys
    }

    /// Whether the contact of `row` was touching when last evaluated.
    #[must_use]
    pub fn is_touching(&self, row: usize) -> bool {
        self.touching[row]
    }

    /// All rows: keys, whether each touches, and the history of each stage.
    pub(crate) fn rows_mut(&mut self) -> (&[[u32; 2]], &mut [bool], &mut [Vec<f64>]) {
        (&self.keys, &mut self.touching, &mut self.history)
    }

    /// How many contacts touch.
    #[must_use]
    pub fn n_touching(&self) -> usize {
        self.touching.iter().filter(|&&touching| touching).count()
    }

    /// Length of one row of each stage's history.
    #[must_use]
    pub fn history_len(&self) -> &[usize] {
        &self.history_len
    }

    /// The history of `row` under `stage`.
    #[must_use]
    pub fn history(&self, stage: usize, row: usize) -> &[f64] {
        let len = self.history_len[stage];
        &self.history[stage][row * len..(row + 1) * len]
    }

    /// Marks `row` as touching with the given history of `stage`.
    pub(crate) fn restore_row(&mut self, stage: usize, row: usize, values: &[f64]) {
        let len = self.history_len[stage];
        self.touching[row] = true;
        self.history[stage][row * len..(row + 1) * len].copy_from_slice(values);
    }

    /// Replaces the candidates by `keys` (ascending); a contact in both lists keeps its history.
    /// The old keys are handed back in `keys`, to be reused as a buffer.
    pub(crate) fn rekey(&mut self, keys: &mut Vec<[u32; 2]>) {
        debug_assert!(keys.is_sorted());
        std::mem::swap(&mut self.keys, keys);
        let old = &keys[..];
        let spare = &mut self.spare;
        spare.touching.clear();
        spare.touching.resize(self.keys.len(), false);
        join(old, &self.keys, |from, to| spare.touching[to] = self.touching[from]);
        for (rows, &len) in self.history.iter_mut().zip(&self.history_len) {
            spare.history.clear();
            spare.history.resize(self.keys.len() * len, 0.0);
            join(old, &self.keys, |from, to| {
                if self.touching[from] {
                    spare.history[to * len..(to + 1) * len]
                        .copy_from_slice(&rows[from * len..(from + 1) * len]);
                }
            });
            std::mem::swap(rows, &mut spare.history);
        }
        std::mem::swap(&mut self.touching, &mut spare.touching);
    }

    /// Whether the parts fit together, for a table that was read from a file: contacts of the grains
    /// `own` with partners below `n_grains`.
    #[must_use]
    pub(crate) fn is_consistent(
        &self,
        own: Range<usize>,
        n_grains: usize,
        history_len: &[usize],
    ) -> bool {
        self.history_len == history_len
            && self.touching.len() == self.keys.len()
            && self.keys.is_sorted()
            && self
                .keys
                .iter()
                .all(|&[i, j]| own.contains(&(i as usize)) && (j as usize) < n_grains)
            && self.history.len() == history_len.len()
            && self.history.iter().zip(history_len).all(|(rows, len)| {
                rows.len() == self.keys.len() * len && rows.iter().all(|value| value.is_finite())
            })
    }
}

/// Calls `both(from, to)` for each key that stands in both ascending lists.
fn join(old: &[[u32; 2]], new: &[[u32; 2]], mut both: impl FnMut(usize, usize)) {
    let mut from = 0;
    for (to, key) in new.iter().enumerate() {
        while from < old.len() && old[from] < *key {
            from += 1;
        }
        if from < old.len() && old[from] == *key {
            both(from, to);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_contact_keeps_its_history_when_others_come_and_go() {
        let mut table = ContactTable::new(&[2]);
        table.rekey(&mut vec![[0, 3], [1, 2], [4, 7]]);
        table.restore_row(0, 1, &[5.0, 6.0]);
        table.rekey(&mut vec![[0, 1], [1, 2], [1, 9]]);
        assert!(table.is_touching(1) && !table.is_touching(0) && !table.is_touching(2));
        assert_eq!(table.history(0, 1), [5.0, 6.0]);
        assert_eq!(table.history(0, 0), [0.0, 0.0]);
        assert_eq!(table.n_touching(), 1);
    }
}
