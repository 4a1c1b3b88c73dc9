//! The contacts between grains of one block, on their way to the laws and back.

use super::tally::Tally;
use crate::contact::table::{APART, ContactTable};
use crate::contact::{Contact, Response};
use crate::dimension::{Dimension, Frame, Quad, Quads};
use crate::grains::{Grains, Space};
use crate::lanes::{Lanes, MOST_LANES, Mask, per_lane};

/// Two grains that overlap, or did a step ago.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Near {
    /// The grains.
    pub(crate) grains: [u32; 2],
    /// Where the contact stands in the table.
    pub(crate) row: u32,
    /// Where its record begins, or [`APART`].
    pub(crate) record: u32,
}

/// All of them in a block, and what they act on.
pub struct Pairs<'a> {
    pub(super) grains: &'a Grains,
    /// The first grain of the block.
    pub(super) first: u32,
    /// Of listed pairs alone: grains of the bed, and rows of the table.
    pub(super) near: &'a [Near],
    /// Per row of the table: whose load the second grain has, an index to the loads of the block.
    pub(super) targets: &'a [u32],
    pub(super) table: &'a mut ContactTable,
    pub(super) loads: &'a mut [Quad],
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
    pub(super) fn fetch<D: Dimension<N>, const N: usize>(&self, near: &[Near]) {
        let moves = self.grains.moves::<D, N>();
        for near in near {
            for grain in near.grains {
                if let Some(motion) = moves.get(grain as usize) {
                    motion.fetch();
                }
            }
            self.table.fetch(near.record);
        }
    }

    /// The contacts of `near`, one in each lane.
    #[inline(always)]
    #[expect(unsafe_code, reason = "measured: see docs/performance.md")]
    pub(super) fn meet<D: Dimension<N>, R: Lanes, const N: usize>(
        &mut self,
        near: &[Near],
    ) -> (Contact<R, N>, Side<R>) {
        let near = lanes_of::<R, _>(near);
        let mut records = per_lane(|lane| near[lane].record);
        if records.contains(&APART) {
            records = per_lane(|lane| self.table.record(near[lane].row as usize));
        }
        let targets = per_lane(|lane| {
            let Near { grains, row, .. } = near[lane];
            [grains[0] - self.first, self.targets[row as usize]]
        });
        let moves = self.grains.moves::<D, N>();
        let grain = |side: usize, lane: usize| near[lane].grains[side] as usize;
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
        near: &[Near],
        side: &Side<R>,
        contact: &Contact<R, N>,
        response: &Response<R, N>,
    ) {
        let loads = D::Load::each_mut(self.loads);
        // SAFETY: targets count the grains of the block and its halo, whose loads these are.
        unsafe { D::scatter(&side.frame, response, &side.targets, loads) };
        let grain = |lane: usize| near[lane].grains[0];
        self.tally.note_overlap(contact.overlap, side.frame.curvature, grain);
        let touching = (contact.overlaps() | response.holds).bits();
        if touching.trailing_ones() < R::COUNT as u32 {
            for lane in (0..R::COUNT).filter(|lane| touching >> lane & 1 == 0) {
                self.table.open(near[lane].row as usize);
            }
        }
    }
}

/// One of `all` for each lane; lanes that there are not repeat the last.
#[inline(always)]
pub(super) fn lanes_of<R: Lanes, T: Copy>(all: &[T]) -> [T; MOST_LANES] {
    per_lane(|lane| all[lane.min(R::COUNT - 1)])
}
