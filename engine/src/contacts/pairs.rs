//! The contacts between grains of one block, on their way to the laws and back.

use super::tally::Tally;
use crate::contact::table::{APART, ContactTable};
use crate::contact::{Contact, Response};
use crate::dimension::{Dimension, Frame, Quad, Quads};
use crate::grains::{Grains, Space};
use crate::lanes::{Lanes, MOST_LANES};

/// Two grains that overlap, or did a step ago.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Near {
    /// The grains.
    pub(crate) grains: [u32; 2],
    /// Whose load the second one has, counted in grains of the block and then of its halo.
    pub(crate) target: u32,
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
    pub(super) near: &'a [Near],
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

    /// The contacts of `near`, one in each lane.
    #[inline(always)]
    pub(super) fn meet<D: Dimension<N>, R: Lanes, const N: usize>(
        &mut self,
        near: &[Near],
    ) -> (Contact<R, N>, Side<R>) {
        let near = lanes_of::<R>(near);
        let mut records = near.map(|near| near.record);
        if records.contains(&APART) {
            records = near.map(|near| self.table.record(near.row as usize));
        }
        let targets = near.map(|near| [near.grains[0] - self.first, near.target]);
        let [i, j] = [0, 1].map(|side| near.map(|near| near.grains[side] as usize));
        let moves = self.grains.moves::<D, N>();
        let [place_i, place_j] = [i, j].map(|side| side.map(|grain| self.grains.place(grain)));
        let [moves_i, moves_j] = [i, j].map(|side| side.map(|grain| &moves[grain]));
        let (i, j) = ((&place_i, &moves_i), (&place_j, &moves_j));
        let (contact, frame) = D::between::<R>(i, j, &self.grains.period, self.dt);
        (contact, Side { frame, records, targets })
    }

    /// Adds what the laws answer to the loads, and forgets contacts that have opened.
    #[inline(always)]
    pub(super) fn settle<D: Dimension<N>, R: Lanes, const N: usize>(
        &mut self,
        near: &[Near],
        side: &Side<R>,
        contact: &Contact<R, N>,
        response: &Response<R, N>,
    ) {
        let loads = D::Load::each_mut(self.loads);
        D::scatter(&side.frame, response, &side.targets, loads);
        let grain = |lane: usize| near[lane].grains[0];
        self.tally.note_overlap(contact.overlap, side.frame.curvature, grain);
        let touching = R::bits(contact.overlaps() | response.holds);
        if touching.trailing_ones() < R::COUNT as u32 {
            for lane in (0..R::COUNT).filter(|lane| touching >> lane & 1 == 0) {
                self.table.open(near[lane].row as usize);
            }
        }
    }
}

/// One of `all` for each lane; lanes that there are not repeat the last.
#[inline(always)]
pub(super) fn lanes_of<R: Lanes>(all: &[Near]) -> [Near; MOST_LANES] {
    [0, 1, 2, 3].map(|lane: usize| all[lane.min(R::COUNT - 1)])
}
