//! The contacts of one block of grains: what the threads work on.

use std::ops::Range;

use arrayvec::ArrayVec;

use super::buffers::ThreadBuffers;
use super::pairs::{Pairs, Side};
use super::tally::Tally;
use crate::body::Part;
use crate::contact::geometry::{loads_on_grain_and_part, with_surface};
use crate::contact::table::{APART, ContactTable, replace};
use crate::contact::{Contact, Partner, Response};
use crate::contacts::stage::{Batch, ContactStage, Histories, Sweep};
use crate::dimension::{Components, Dimension, Motion};
use crate::grains::Grains;
use crate::lanes::{Eight, Lanes, MOST_LANES, Mask, per_lane};
use crate::parallel::block_of;
use crate::prefetch::fetch;

/// Groups of as many contacts as there are lanes that are evaluated together.
const GROUPS: usize = 16;

/// How many candidates ahead the places of grains are fetched.
const ROWS_AHEAD: usize = 128;

/// The contacts of the grains of one block.
pub(super) struct Block {
    /// Its first grain.
    pub(super) first: usize,
    /// Its keys are grains of the bed: whoever lists or restores them sees to that.
    pub(super) pairs: ContactTable,
    /// The rows of `pairs` that touch or are close, ascending: no others can touch before grains have gone
    /// `close_left`.
    close: Vec<u32>,
    /// How far (m) two grains of `pairs` may still go towards each other; below zero `close` has to be made.
    close_left: f64,
    /// The blocks of the grains of the halo, ascending.
    pub(super) around: Vec<u32>,
    /// Grains of other blocks that are listed in pairs of this one, ascending.
    pub(super) halo: Vec<u32>,
    /// What contacts do to the grains of the block, then to those of the halo.
    pub(super) loads: Vec<f64>,
    pub(super) inbox: Vec<Delivery>,
    /// Per part of walls and intruder.
    pub(super) surfaces: Vec<ContactTable>,
    pub(super) tally: Tally,
}

/// Loads from the halo of another block.
pub(super) struct Delivery {
    pub(super) block: u32,
    /// Whose they are, counted as in [`Block::loads`].
    pub(super) from: u32,
    /// Index of the grain within its block.
    pub(super) grain: u32,
}

/// Groups of contacts on their way through the laws.
pub(crate) struct Evaluation<R: Lanes, const N: usize> {
    contacts: ArrayVec<Contact<R, N>, GROUPS>,
    pub(crate) responses: ArrayVec<Response<R, N>, GROUPS>,
    records: ArrayVec<[u32; MOST_LANES], GROUPS>,
}

impl<R: Lanes, const N: usize> Evaluation<R, N>
where
    dyn ContactStage: Sweep<R, N>,
{
    pub(crate) fn new() -> Self {
        Self { contacts: ArrayVec::new(), responses: ArrayVec::new(), records: ArrayVec::new() }
    }

    #[inline(always)]
    pub(crate) fn push(&mut self, contact: Contact<R, N>, records: [u32; MOST_LANES]) {
        self.contacts.push(contact);
        self.responses.push(Response::default());
        self.records.push(records);
    }

    /// Lets every law act; without an entry in `energy` none books.
    pub(crate) fn evaluate(
        &mut self,
        partner: Partner,
        stages: &[Box<dyn ContactStage>],
        dt: f64,
        table: &mut ContactTable,
        energy: &mut [f64],
    ) {
        let mut energy = (!energy.is_empty()).then_some(energy);
        let mut offset = 0;
        for (k, stage) in stages.iter().enumerate() {
            let split = energy.map(|energy| energy.split_at_mut(stage.channels().len()));
            let (own, rest) = split.unzip();
            energy = rest;
            let batch = Batch {
                partner,
                contacts: &self.contacts,
                records: &self.records,
                responses: &mut self.responses,
            };
            let len = table.history_len()[k];
            let histories = Histories { values: table.histories_mut(), offset };
            Sweep::<R, N>::sweep(&**stage, batch, dt, histories, own);
            offset += len;
        }
    }

    /// Lets every law act on at most [`GROUPS`] groups of contacts between grains.
    fn of_pairs<D: Dimension<N>>(
        pairs: &mut Pairs<'_>,
        stages: &[Box<dyn ContactStage>],
        near: &[u32],
    ) {
        let mut evaluation = Self::new();
        let mut sides = ArrayVec::<Side<R>, GROUPS>::new();
        for near in near.chunks_exact(R::COUNT) {
            let (contact, side) = pairs.meet::<D, R, N>(near);
            evaluation.push(contact, side.records);
            sides.push(side);
        }
        let Pairs { table, tally, dt, .. } = pairs;
        evaluation.evaluate(Partner::Grain, stages, *dt, table, &mut tally.energy);
        let answered = evaluation.contacts.iter().zip(&evaluation.responses);
        for ((near, side), (contact, response)) in
            near.chunks_exact(R::COUNT).zip(&sides).zip(answered)
        {
            pairs.settle::<D, R, N>(near, side, contact, response);
        }
    }
}

impl Block {
    /// The block that begins with grain `first`, of which nothing is listed yet, and so many parts.
    pub(super) fn new(
        first: usize,
        (pairs, surface): (ContactTable, ContactTable),
        tally: Tally,
        n_parts: usize,
    ) -> Self {
        Self {
            first,
            pairs,
            close: Vec::new(),
            close_left: -1.0,
            around: Vec::new(),
            halo: Vec::new(),
            loads: Vec::new(),
            inbox: Vec::new(),
            surfaces: vec![surface; n_parts],
            tally,
        }
    }

    /// Takes note that the rows of `pairs` are others now.
    pub(super) fn relisted(&mut self) {
        self.close.clear();
        self.close_left = -1.0;
    }

    /// Evaluates the contacts between grains: eight at a time, then what is left over one by one. For `gone` and `close`
    /// see [`Self::find_near`].
    pub(super) fn sweep_pairs<D: Dimension<N>, const N: usize>(
        &mut self,
        grains: &Grains,
        stages: &[Box<dyn ContactStage>],
        (gone, close): (impl Fn(usize) -> f64, Option<f64>),
        dt: f64,
        buffers: &mut ThreadBuffers,
    ) where
        dyn ContactStage: Sweep<f64, N> + Sweep<Eight, N>,
    {
        let n_near = self.find_near::<D, N>(grains, gone, close, &mut buffers.near);
        let near = &buffers.near[..n_near];
        self.pairs.make_room(n_near);
        let mut pairs = Pairs {
            grains,
            first: self.first as u32,
            near,
            table: &mut self.pairs,
            loads: &mut self.loads,
            tally: &mut self.tally,
            dt,
        };
        if let [stage] = stages {
            stage.sweep_pairs(pairs);
            return;
        }
        let (in_lanes, rest) = near.split_at(n_near - n_near % Eight::COUNT);
        for near in in_lanes.chunks(GROUPS * Eight::COUNT) {
            Evaluation::<Eight, N>::of_pairs::<D>(&mut pairs, stages, near);
        }
        Evaluation::<f64, N>::of_pairs::<D>(&mut pairs, stages, rest);
    }

    /// Writes the rows of candidates that overlap, or did a step ago, and returns how many. They are looked for among those
    /// nearer than `close` (m), if that is given; `gone` tells how far (m) the grains of a block have gone in the step, at
    /// most.
    fn find_near<D: Dimension<N>, const N: usize>(
        &mut self,
        grains: &Grains,
        gone: impl Fn(usize) -> f64,
        close: Option<f64>,
        near: &mut Vec<u32>,
    ) -> usize {
        let all = (self.pairs.candidates().len(), |row| row as u32);
        let Some(margin) = close else { return self.find::<D, N>(grains, all, 0.0, near) };
        let around = self.around.iter().map(|&block| gone(block as usize)).fold(0.0, f64::max);
        let own = gone(block_of(self.first));
        self.close_left -= own + own.max(around);
        // What is not a number is no less a reason to look.
        let is_good = self.close_left >= 0.0;
        if !is_good {
            let n_close = self.find::<D, N>(grains, all, margin, near);
            replace(&mut self.close, &near[..n_close]);
            self.close_left = margin;
        }
        let close = &self.close[..];
        self.find::<D, N>(grains, (close.len(), |k| close[k]), 0.0, near)
    }

    /// Writes those of so many rows whose grains are nearer to each other than `margin` (m), or touched a step ago, and
    /// returns how many.
    fn find<D: Dimension<N>, const N: usize>(
        &self,
        grains: &Grains,
        (n_rows, row): (usize, impl Fn(usize) -> u32 + Copy),
        margin: f64,
        near: &mut Vec<u32>,
    ) -> usize {
        let in_lanes = n_rows - n_rows % Eight::COUNT;
        if near.len() < n_rows {
            near.resize(n_rows, 0);
        }
        let found = self.find_in::<D, Eight, N>(grains, (0..in_lanes, row), margin, (near, 0));
        self.find_in::<D, f64, N>(grains, (in_lanes..n_rows, row), margin, (near, found))
    }

    /// Writes those of the rows behind the first of `near`, and returns how many it then has.
    #[inline(always)]
    #[expect(unsafe_code, reason = "measured: see docs/performance.md")]
    fn find_in<D: Dimension<N>, R: Lanes, const N: usize>(
        &self,
        grains: &Grains,
        (range, row): (Range<usize>, impl Fn(usize) -> u32),
        margin: f64,
        (near, mut found): (&mut [u32], usize),
    ) -> usize {
        // SAFETY: rows of the table, see [`Block::close`].
        let candidate = |row: u32| unsafe { self.pairs.candidate_unchecked(row) };
        let end = range.end;
        for k in range.step_by(R::COUNT) {
            let ahead = k + ROWS_AHEAD;
            if ahead + R::COUNT <= end {
                for k in ahead..ahead + R::COUNT {
                    fetch(grains.place(candidate(row(k)).key[1] as usize));
                }
            }
            let rows = per_lane(|lane| row(k + lane.min(R::COUNT - 1)));
            let of_lane = per_lane(|lane| candidate(rows[lane]));
            // SAFETY: tables hold grains of the bed alone, see [`Block::pairs`].
            let place = |side: usize| {
                per_lane(|lane| unsafe { grains.place_unchecked(of_lane[lane].key[side] as usize) })
            };
            let [i, j] = [place(0), place(1)];
            let is_near = D::are_near::<R>(&i, &j, &grains.period, margin).bits();
            let kept = is_near | R::differ(&per_lane(|lane| of_lane[lane].record), APART);
            // Without a branch: which ones are near cannot be foreseen.
            for (lane, &row) in rows.iter().enumerate().take(R::COUNT) {
                // SAFETY: not more are found than there are rows, for which there is room.
                *unsafe { near.get_unchecked_mut(found) } = row;
                found += (kept >> lane & 1) as usize;
            }
        }
        found
    }

    /// Evaluates the contacts of grains with a wall or a part of the intruder.
    pub(super) fn sweep_surface<D: Dimension<N>, const N: usize>(
        &mut self,
        grains: &Grains,
        stages: &[Box<dyn ContactStage>],
        part: (usize, &Part),
        dt: f64,
        buffers: &mut ThreadBuffers,
    ) where
        dyn ContactStage: Sweep<f64, N>,
    {
        let (index, part) = part;
        let table = &mut self.surfaces[index];
        if table.candidates().is_empty() {
            return;
        }
        let placement = &part.placement;
        let grain = |i: u32| {
            let motion = grains.motion_in::<D, N>(i as usize);
            let position = grains.period.image_near(motion.position, placement.position);
            Motion { position, ..motion }
        };
        buffers.points.clear();
        buffers.points.extend(table.keys().map(|[i, _]| placement.to_body(grain(i).position)));
        part.surface.closest_many(&buffers.points, &mut buffers.nearest);
        buffers.near_rows.clear();
        buffers.points_half.clear();
        for (row, ([i, _], nearest)) in table.keys().zip(&buffers.nearest).enumerate() {
            let grain = grain(i);
            if nearest.gap < grain.radius || table.is_touching(row) {
                buffers.near_rows.push(row as u32);
                let half = grain.position - grain.velocity * (0.5 * dt);
                buffers.points_half.push(placement.to_body_half(half));
            }
        }
        part.surface.closest_many(&buffers.points_half, &mut buffers.nearest_half);
        table.make_room(buffers.near_rows.len());

        let is_wall = part.partner == Partner::Wall;
        let halves = buffers.nearest_half.chunks(GROUPS);
        for (rows, halves) in buffers.near_rows.chunks(GROUPS).zip(halves) {
            let mut evaluation = Evaluation::<f64, N>::new();
            let mut contacts = ArrayVec::<(Contact, Motion), GROUPS>::new();
            for (&row, half) in rows.iter().zip(halves) {
                let grain = grain(table.candidates()[row as usize].key[0]);
                let now = &buffers.nearest[row as usize];
                let record = table.record(row as usize);
                let last = table.last_of_record(record);
                let before = (*last > 0.0).then_some(*last);
                let contact = with_surface(&grain, placement, (now, half), before, dt);
                *last = if contact.overlaps() { contact.inverse_radius_eff } else { 0.0 };
                evaluation.push(D::narrow(&contact), [record; MOST_LANES]);
                contacts.push((contact, grain));
            }
            let energy = if is_wall { &mut self.tally.wall_energy } else { &mut self.tally.energy };
            evaluation.evaluate(part.partner, stages, dt, table, energy);
            for (k, (contact, grain)) in contacts.iter().enumerate() {
                let row = rows[k] as usize;
                let response = D::widen(&evaluation.responses[k], contact.normal);
                let apart = grain.position - placement.position;
                let (on_grain, on_part) =
                    loads_on_grain_and_part(contact, &response, grain.radius, apart);
                let i = table.candidates()[row].key[0];
                let loads = D::Load::each_mut(&mut self.loads);
                loads[i as usize - self.first].add(&D::load(&on_grain));
                if !(evaluation.contacts[k].overlaps() | evaluation.responses[k].holds) {
                    table.open(row);
                } else {
                    let felt = buffers.nearest[row].felt;
                    let wrenches = match felt {
                        true => &mut self.tally.wrenches,
                        false => &mut self.tally.unfelt,
                    };
                    wrenches[index].add(&on_part);
                    if felt && !is_wall && contact.overlap > 0.0 {
                        self.tally.footprints[index].add_grain(
                            contact,
                            grain.radius,
                            grains.space.grain_cross_section(grain.radius),
                            placement.velocity_at(apart),
                        );
                    }
                }
                self.tally.note_overlap(contact.overlap, grain.inverse_radius, |_| i);
            }
        }
    }
}
