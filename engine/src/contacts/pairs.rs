//! The contacts between grains of one block, on their way to the laws and back.

use super::tally::Tally;
use crate::contact::table::{APART, Candidate, ContactTable};
use crate::contact::{Contact, Response};
use crate::dimension::{Components, Dimension, Frame, Quads};
use crate::grains::Grains;
use crate::lanes::{Lanes, MOST_LANES, Mask, per_lane};
use crate::space::Space;

/// The contacts of a block, and what they act on.
pub struct Pairs<'a> {
    pub(super) grains: &'a Grains,
    /// The first grain of the block.
    pub(super) first: u32,
    /// The rows of candidates that overlap, or did a step ago: rows of the table, no others.
    pub(super) near: &'a [u32],
    pub(super) table: &'a mut ContactTable,
    pub(super) loads: &'a mut [f64],
    pub(super) tally: &'a mut Tally,
    /// (s).
    pub(super) dt: f64,
}

/// What the engine keeps of contacts side by side while laws act.
#[derive(Clone, Copy)]
pub(super) struct Side<R: Lanes> {
    frame: Frame<R>,
    /// Where in the histories the record of each lane begins.
    pub(super) records: [u32; MOST_LANES],
    /// Whose loads the grains of each lane have.
    targets: [[u32; 2]; MOST_LANES],
}

impl Pairs<'_> {
    pub(super) fn space(&self) -> Space {
        self.grains.space
    }

    /// Has brought near what the contacts of `near` need.
    #[inline(always)]
    #[expect(unsafe_code, reason = "measured: see docs/performance.md")]
    pub(super) fn fetch<D: Dimension<N>, const N: usize>(&self, near: &[u32]) {
        let moves = self.grains.moves::<D, N>();
        for (k, &row) in near.iter().enumerate() {
            // SAFETY: see [`Pairs::near`].
            let Candidate { key, record, .. } = *unsafe { self.table.candidate_unchecked(row) };
            let fetched = &key[usize::from(k % D::FIRST_EVERY != 0)..];
            for &grain in fetched {
                // SAFETY: tables hold grains of the bed alone, and every grain has a motion.
                unsafe { moves.get_unchecked(grain as usize) }.fetch();
            }
            if k % D::RECORD_EVERY == 0 {
                self.table.fetch(record);
            }
        }
    }

    /// The contacts of `near`, one in each lane.
    #[inline(always)]
    #[expect(unsafe_code, reason = "measured: see docs/performance.md")]
    pub(super) fn meet<D: Dimension<N>, R: Lanes, const N: usize>(
        &mut self,
        near: &[u32],
    ) -> (Contact<R, N>, Side<R>) {
        let near = lanes_of::<R, _>(near);
        // SAFETY: see [`Pairs::near`].
        let candidates = per_lane(|lane| unsafe { *self.table.candidate_unchecked(near[lane]) });
        let mut records = per_lane(|lane| candidates[lane].record);
        if records.contains(&APART) {
            records = per_lane(|lane| self.table.record(near[lane] as usize));
        }
        let targets = per_lane(|lane| {
            let Candidate { key, target, .. } = candidates[lane];
            [key[0] - self.first, target]
        });
        let moves = self.grains.moves::<D, N>();
        let grain = |side: usize, lane: usize| candidates[lane].key[side] as usize;
        // SAFETY: tables hold grains of the bed alone, see [`Pairs::near`].
        let place = |side: usize| {
            per_lane(|lane| unsafe { self.grains.place_unchecked(grain(side, lane)) })
        };
        // SAFETY: as above; every grain that has a place has a motion.
        let motion =
            |side: usize| per_lane(|lane| unsafe { moves.get_unchecked(grain(side, lane)) });
        let (place_i, moves_i) = (place(0), motion(0));
        let (place_j, moves_j) = (place(1), motion(1));
        let (i, j) = ((&place_i, &moves_i), (&place_j, &moves_j));
        let (contact, frame) = D::between::<R>(i, j, &self.grains.period, self.dt);
        (contact, Side { frame, records, targets })
    }

    /// Adds what the laws answer to the loads, and forgets contacts that have opened.
    #[inline(always)]
    #[expect(unsafe_code, reason = "measured: see docs/performance.md")]
    pub(super) fn settle<D: Dimension<N>, R: Lanes, const N: usize>(
        &mut self,
        near: &[u32],
        side: &Side<R>,
        contact: &Contact<R, N>,
        response: &Response<R, N>,
    ) {
        let loads = D::Load::each_mut(self.loads);
        // SAFETY: targets count the grains of the block and its halo, whose loads these are.
        unsafe { D::scatter(&side.frame, response, &side.targets, loads) };
        let table = &*self.table;
        let grain = |lane: usize| table.candidates()[near[lane] as usize].key[0];
        self.tally.note_overlap(contact.overlap, side.frame.curvature, grain);
        let touching = (contact.overlaps() | response.holds).bits();
        if touching.trailing_ones() < R::COUNT as u32 {
            for lane in (0..R::COUNT).filter(|lane| touching >> lane & 1 == 0) {
                self.table.open(near[lane] as usize);
            }
        }
    }
}

/// One of `all` for each lane; lanes that there are not repeat the last.
#[inline(always)]
pub(super) fn lanes_of<R: Lanes, T: Copy>(all: &[T]) -> [T; MOST_LANES] {
    per_lane(|lane| all[lane.min(R::COUNT - 1)])
}
