//! Which grain may touch which partner, and what each contact remembers.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::prefetch::fetch;

/// Marks a candidate that remembers nothing, because it does not touch.
pub(crate) const APART: u32 = u32::MAX;

/// A grain and a partner that it may touch. One line of memory holds four: what the search for contacts and
/// their evaluation want to know of them lies together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Candidate {
    /// The grain i and the partner j.
    pub(crate) key: [u32; 2],
    /// Where its record begins, or [`APART`].
    pub(crate) record: u32,
    /// Whose load the partner has, if it is a grain: counted in grains of the block, then of its halo. It
    /// follows from the keys, and is not stored.
    #[serde(skip)]
    pub(crate) target: u32,
}

/// Candidate contacts sorted by key, with the history of those that touch.
///
/// About half of the candidates touch; only they have a record in the histories. A rebuild of the
/// neighbour list joins the old keys with the new ones by merging the two sorted lists, and puts the records
/// in their order, in which they are read. No order depends on anything but the keys.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactTable {
    candidates: Vec<Candidate>,
    histories: Vec<f64>,
    /// Records that nobody uses.
    free: Vec<u32>,
    /// Numbers of each stage in a record.
    history_len: Vec<usize>,
}

/// Room to merge two lists of candidates in.
#[derive(Debug, Default)]
pub struct Merger {
    candidates: Vec<Candidate>,
    histories: Vec<f64>,
}

impl ContactTable {
    /// An empty table whose stages remember `history_len` values per contact each.
    pub fn new(history_len: &[usize]) -> Self {
        Self { history_len: history_len.to_vec(), ..Self::default() }
    }

    /// The candidates: (grain i, partner j), ascending.
    pub fn keys(&self) -> impl ExactSizeIterator<Item = [u32; 2]> + '_ {
        self.candidates.iter().map(|candidate| candidate.key)
    }

    /// The same, with what else is known of them.
    pub(crate) fn candidates(&self) -> &[Candidate] {
        &self.candidates
    }

    /// The same, for whoever says whose loads the partners have.
    pub(crate) fn candidates_mut(&mut self) -> &mut [Candidate] {
        &mut self.candidates
    }

    /// One of [`Self::candidates`], without a look at whether there is such a row.
    ///
    /// # Safety
    /// `row` is below their number.
    #[inline(always)]
    #[expect(unsafe_code, reason = "measured: see docs/performance.md")]
    pub(crate) unsafe fn candidate_unchecked(&self, row: u32) -> &Candidate {
        debug_assert!((row as usize) < self.candidates.len());
        // SAFETY: the caller's.
        unsafe { self.candidates.get_unchecked(row as usize) }
    }

    /// The row of the candidate with this key.
    pub(crate) fn row_of(&self, key: [u32; 2]) -> Option<usize> {
        self.candidates.binary_search_by_key(&key, |candidate| candidate.key).ok()
    }

    /// Whether the contact of `row` was touching when last evaluated.
    pub(crate) fn is_touching(&self, row: usize) -> bool {
        self.candidates[row].record != APART
    }

    /// How many contacts touch.
    pub(crate) fn n_touching(&self) -> usize {
        self.candidates.iter().filter(|candidate| candidate.record != APART).count()
    }

    /// Length of one row of each stage's history.
    pub fn history_len(&self) -> &[usize] {
        &self.history_len
    }

    /// The history of `row` under `stage`; nothing if it does not touch.
    pub fn history(&self, stage: usize, row: usize) -> &[f64] {
        if !self.is_touching(row) {
            return &[];
        }
        let from = self.candidates[row].record as usize + self.offset(stage);
        &self.histories[from..][..self.history_len[stage]]
    }

    /// Where in a record the numbers of `stage` begin.
    fn offset(&self, stage: usize) -> usize {
        self.history_len[..stage].iter().sum()
    }

    /// All histories, record after record.
    pub(crate) fn histories_mut(&mut self) -> &mut [f64] {
        &mut self.histories
    }

    /// Has the record that begins at `record`, if there is one, brought near.
    #[inline(always)]
    pub(crate) fn fetch(&self, record: u32) {
        if let Some(first) = self.histories.get(record as usize) {
            fetch(first);
        }
    }

    /// Takes memory for `n` records at once, and hardly more: twice as much each time, as vectors do, would cost a
    /// large bed more than its contacts.
    pub(crate) fn make_room(&mut self, n: usize) {
        let len = self.history_len.iter().sum::<usize>().max(1);
        reserve(&mut self.histories, n * len);
    }

    /// The last number of the record that begins at `record`.
    pub(crate) fn last_of_record(&mut self, record: u32) -> &mut f64 {
        let len = self.history_len.iter().sum::<usize>();
        &mut self.histories[record as usize + len - 1]
    }

    /// Where the record of `row` begins; a new one, all zero, if it has none.
    #[inline]
    pub(crate) fn record(&mut self, row: usize) -> u32 {
        let record = self.candidates[row].record;
        if record != APART {
            return record;
        }
        let len = self.history_len.iter().sum::<usize>();
        let record = self.free.pop().unwrap_or_else(|| {
            let end = self.histories.len();
            // A law without memory needs records that differ all the same.
            self.histories.resize(end + len.max(1), 0.0);
            end as u32
        });
        self.candidates[row].record = record;
        record
    }

    /// The contact of `row` has opened: its record is forgotten.
    pub(crate) fn open(&mut self, row: usize) {
        let record = std::mem::replace(&mut self.candidates[row].record, APART);
        if record != APART {
            let len = self.history_len.iter().sum::<usize>();
            self.histories[record as usize..][..len].fill(0.0);
            self.free.push(record);
        }
    }

    /// Marks `row` as touching with the given history of `stage`.
    pub(crate) fn restore_row(&mut self, stage: usize, row: usize, values: &[f64]) {
        let from = self.record(row) as usize + self.offset(stage);
        self.histories[from..][..values.len()].copy_from_slice(values);
    }

    /// Replaces the candidates by `keys` (ascending); a contact in both lists keeps its history.
    pub(crate) fn rekey(&mut self, keys: &[[u32; 2]], merger: &mut Merger) {
        debug_assert!(keys.is_sorted());
        let Merger { candidates, histories } = merger;
        candidates.clear();
        candidates.extend(keys.iter().map(|&key| Candidate { key, record: APART, target: 0 }));
        let mut to = 0;
        for old in &self.candidates {
            while to < keys.len() && keys[to] < old.key {
                to += 1;
            }
            if to < keys.len() && keys[to] == old.key {
                candidates[to].record = old.record;
            }
        }
        histories.clear();
        let len = self.history_len.iter().sum::<usize>().max(1);
        for Candidate { record, .. } in candidates.iter_mut().filter(|new| new.record != APART) {
            let from = std::mem::replace(record, histories.len() as u32) as usize;
            histories.extend_from_slice(&self.histories[from..from + len]);
        }
        replace(&mut self.candidates, candidates);
        replace(&mut self.histories, histories);
        self.free.clear();
    }

    /// Whether the parts fit together, for a table that was read from a file: contacts of the grains
    /// `own` with partners below `n_grains`.
    pub(crate) fn is_consistent(
        &self,
        own: Range<usize>,
        n_grains: usize,
        history_len: &[usize],
    ) -> bool {
        let len = history_len.iter().sum::<usize>().max(1);
        let fits = |&record: &u32| {
            (record as usize).is_multiple_of(len) && record as usize + len <= self.histories.len()
        };
        let records = self.candidates.iter().map(|candidate| candidate.record);
        let touching = records.filter(|&record| record != APART);
        let mut used: Vec<u32> = touching.chain(self.free.iter().copied()).collect();
        used.sort_unstable();
        self.history_len == history_len
            && self.keys().is_sorted()
            && self.keys().all(|[i, j]| own.contains(&(i as usize)) && (j as usize) < n_grains)
            && used.iter().all(fits)
            && used.windows(2).all(|pair| pair[0] < pair[1])
            && self.histories.iter().all(|value| value.is_finite())
    }
}

/// Makes `list` a copy of `with`, and takes hardly more memory than that needs.
pub(crate) fn replace<T: Copy>(list: &mut Vec<T>, with: &[T]) {
    list.clear();
    reserve(list, with.len());
    list.extend_from_slice(with);
}

/// Takes memory for `n` entries of `list`, and hardly more.
pub(crate) fn reserve<T>(list: &mut Vec<T>, n: usize) {
    if n > list.capacity() {
        list.reserve_exact(n + n / 64 - list.len());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_contact_keeps_its_history_when_others_come_and_go() {
        let mut table = ContactTable::new(&[1, 2]);
        table.rekey(&[[0, 3], [1, 2], [4, 7]], &mut Merger::default());
        table.restore_row(1, 1, &[5.0, 6.0]);
        table.restore_row(0, 2, &[7.0]);
        table.rekey(&[[0, 1], [1, 2], [1, 9]], &mut Merger::default());
        assert!(table.is_touching(1) && !table.is_touching(0) && !table.is_touching(2));
        assert_eq!(table.history(1, 1), [5.0, 6.0]);
        assert_eq!(table.history(0, 1), [0.0]);
        assert_eq!(table.n_touching(), 1);
    }

    #[test]
    fn a_contact_that_touches_anew_remembers_nothing() {
        let mut table = ContactTable::new(&[2]);
        table.rekey(&[[0, 3], [1, 2]], &mut Merger::default());
        table.restore_row(0, 0, &[5.0, 6.0]);
        table.open(0);
        let record = table.record(1) as usize;
        assert_eq!(table.histories_mut()[record..record + 2], [0.0, 0.0]);
        assert!(table.is_consistent(0..2, 4, &[2]));
    }
}
