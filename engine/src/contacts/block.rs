//! The contacts of one block of grains: what the threads work on.

use std::ops::Range;

use arrayvec::ArrayVec;

use crate::body::Part;
use crate::contact::geometry::{loads_on_grain_and_part, with_surface};
use crate::contact::stage::{Batch, Histories, Sweep};
use crate::contact::table::{APART, ContactTable};
use crate::contact::{Contact, ContactStage, Partner, Response};
use crate::dimension::{Dimension, Frame, Motion, Quad};
use crate::footprint::Footprint;
use crate::grains::Grains;
use crate::lanes::{Four, Lanes, MOST_LANES, SimdBool};
use crate::math::Vec3;
use crate::surface::{SurfacePoint, Wrench};

/// Groups of as many contacts as there are lanes that are evaluated together.
const GROUPS: usize = 16;

/// The contacts of the grains of one block.
pub(super) struct Block {
    /// Its first grain.
    pub(super) first: usize,
    pub(super) pairs: ContactTable,
    /// Per pair: whose load the second grain has, counted in grains of the block and then of the halo.
    pub(super) targets: Vec<u32>,
    /// Grains of other blocks that are listed in pairs of this one, ascending.
    pub(super) halo: Vec<u32>,
    /// What contacts do to the grains of the block, then to those of the halo.
    pub(super) loads: Vec<Quad>,
    pub(super) inbox: Vec<Delivery>,
    /// Per part of walls and intruder.
    pub(super) surfaces: Vec<ContactTable>,
    pub(super) tally: Tally,
    pub(super) bench: Bench,
}

/// Loads from the halo of another block.
pub(super) struct Delivery {
    pub(super) block: u32,
    /// Whose they are, counted as in [`Block::loads`].
    pub(super) from: u32,
    /// Index of the grain within its block.
    pub(super) grain: u32,
}

/// The largest overlap in units of the smaller radius.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Deepest {
    pub(crate) relative: f64,
    /// (m).
    pub(crate) overlap: f64,
    /// Index of the grain.
    pub(crate) grain: u32,
}

/// What one block adds to the sums of the bed.
#[derive(Default)]
pub(super) struct Tally {
    /// Per stage and channel: energies (J) of contacts between grains and with the intruder; empty if
    /// nothing is booked.
    pub(super) energy: Vec<f64>,
    /// The same for contacts with walls.
    pub(super) wall_energy: Vec<f64>,
    /// Per part.
    pub(super) wrenches: Vec<Wrench>,
    /// Per part: what grains do to it that its body does not feel.
    pub(super) unfelt: Vec<Wrench>,
    /// Per part; empty for walls.
    pub(super) footprints: Vec<Footprint>,
    pub(super) overlap: Deepest,
}

/// Buffers that are kept from step to step.
#[derive(Default)]
pub(super) struct Bench {
    pub(super) points: Vec<Vec3>,
    points_half: Vec<Vec3>,
    pub(super) nearest: Vec<SurfacePoint>,
    nearest_half: Vec<SurfacePoint>,
    near_rows: Vec<u32>,
    pub(super) keys: Vec<[u32; 2]>,
}

/// Groups of contacts on their way through the laws.
struct Evaluation<R: Lanes, const N: usize> {
    contacts: ArrayVec<Contact<R, N>, GROUPS>,
    responses: ArrayVec<Response<R, N>, GROUPS>,
    records: ArrayVec<[u32; MOST_LANES], GROUPS>,
}

impl<R: Lanes, const N: usize> Evaluation<R, N>
where
    dyn ContactStage: Sweep<R, N>,
{
    fn new() -> Self {
        Self { contacts: ArrayVec::new(), responses: ArrayVec::new(), records: ArrayVec::new() }
    }

    #[inline(always)]
    fn push(&mut self, contact: Contact<R, N>, records: [u32; MOST_LANES]) {
        self.contacts.push(contact);
        self.responses.push(Response::default());
        self.records.push(records);
    }

    /// Lets every law act; without an entry in `energy` none books.
    fn evaluate(
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

    /// Whether each lane of the group still touches, as bits.
    #[inline(always)]
    fn touching(&self, group: usize) -> u64 {
        (self.contacts[group].overlaps() | self.responses[group].holds).bitmask()
    }
}

impl Tally {
    pub(super) fn clear(&mut self) {
        self.energy.fill(0.0);
        self.wall_energy.fill(0.0);
        self.wrenches.fill(Wrench::default());
        self.unfelt.fill(Wrench::default());
        self.footprints.fill(Footprint::default());
        self.overlap = Deepest::default();
    }

    /// Takes note of contacts of `grains`; `curvature` (1/m) is that of the smaller grain.
    #[inline(always)]
    fn note_overlap<R: Lanes>(&mut self, overlap: R, curvature: R, grain: impl Fn(usize) -> u32) {
        let relative = overlap * curvature;
        if relative.simd_gt(R::splat(self.overlap.relative)).any() {
            for lane in 0..R::COUNT {
                let (relative, overlap) = (relative.lane(lane), overlap.lane(lane));
                if relative > self.overlap.relative {
                    self.overlap = Deepest { relative, overlap, grain: grain(lane) };
                }
            }
        }
    }
}

impl Block {
    /// Evaluates the contacts between grains: four at a time, then what is left over one by one.
    pub(super) fn sweep_pairs<D: Dimension<N>, const N: usize>(
        &mut self,
        grains: &Grains,
        stages: &[Box<dyn ContactStage>],
        dt: f64,
    ) where
        dyn ContactStage: Sweep<f64, N> + Sweep<Four, N>,
    {
        self.find_near::<D, N>(grains);
        let near = std::mem::take(&mut self.bench.near_rows);
        let in_lanes = near.len() - near.len() % Four::COUNT;
        for rows in near[..in_lanes].chunks(GROUPS * Four::COUNT) {
            self.sweep_rows::<D, Four, N>(grains, stages, rows, dt);
        }
        if in_lanes < near.len() {
            self.sweep_rows::<D, f64, N>(grains, stages, &near[in_lanes..], dt);
        }
        self.bench.near_rows = near;
    }

    /// Which candidates overlap, or did a step ago.
    fn find_near<D: Dimension<N>, const N: usize>(&mut self, grains: &Grains) {
        let mut near = std::mem::take(&mut self.bench.near_rows);
        let n_rows = self.pairs.keys().len();
        let in_lanes = n_rows - n_rows % Four::COUNT;
        near.resize(n_rows, 0);
        let found = self.find_near_in::<D, Four, N>(grains, 0..in_lanes, (&mut near, 0));
        let found = self.find_near_in::<D, f64, N>(grains, in_lanes..n_rows, (&mut near, found));
        near.truncate(found);
        self.bench.near_rows = near;
    }

    /// Writes those of `rows` behind the first of `near`, and returns how many it then has.
    #[inline(always)]
    fn find_near_in<D: Dimension<N>, R: Lanes, const N: usize>(
        &self,
        grains: &Grains,
        rows: Range<usize>,
        (near, mut found): (&mut [u32], usize),
    ) -> usize {
        let keys = self.pairs.keys()[rows.clone()].chunks_exact(R::COUNT);
        let records = self.pairs.records()[rows.clone()].chunks_exact(R::COUNT);
        for (row, (keys, records)) in rows.step_by(R::COUNT).zip(keys.zip(records)) {
            let keys = [0, 1, 2, 3].map(|lane: usize| keys[lane.min(R::COUNT - 1)]);
            let [i, j] = [0, 1].map(|side| keys.map(|key| grains.place(key[side] as usize)));
            let touch = D::touch::<R>(&i, &j, &grains.period).bitmask();
            // Without a branch: about half of the candidates touch, and which ones cannot be foreseen.
            for (lane, &record) in records.iter().enumerate() {
                near[found] = (row + lane) as u32;
                found += usize::from((touch >> lane & 1 == 1) | (record != APART));
            }
        }
        found
    }

    fn sweep_rows<D: Dimension<N>, R: Lanes, const N: usize>(
        &mut self,
        grains: &Grains,
        stages: &[Box<dyn ContactStage>],
        rows: &[u32],
        dt: f64,
    ) where
        dyn ContactStage: Sweep<R, N>,
    {
        let mut evaluation = Evaluation::<R, N>::new();
        let mut frames = ArrayVec::<(Frame<R>, [[u32; 2]; MOST_LANES]), GROUPS>::new();
        for group in rows.chunks_exact(R::COUNT) {
            let lanes = [0, 1, 2, 3].map(|lane: usize| group[lane.min(R::COUNT - 1)] as usize);
            let keys = lanes.map(|row| self.pairs.keys()[row]);
            let places = [0, 1].map(|side| keys.map(|key| grains.place(key[side] as usize)));
            let moves = [0, 1].map(|side| keys.map(|key| grains.moves::<D, N>(key[side] as usize)));
            let (i, j) = ((&places[0], &moves[0]), (&places[1], &moves[1]));
            let (contact, frame) = D::between::<R>(i, j, &grains.period, dt);
            evaluation.push(contact, lanes.map(|row| self.pairs.record(row)));
            let first = self.first as u32;
            let targets = [0, 1, 2, 3].map(|k| [keys[k][0] - first, self.targets[lanes[k]]]);
            frames.push((frame, targets));
        }
        let energy = &mut self.tally.energy;
        evaluation.evaluate(Partner::Grain, stages, dt, &mut self.pairs, energy);
        for (group, (frame, targets)) in frames.iter().enumerate() {
            let response = &evaluation.responses[group];
            D::scatter(frame, response, targets, &mut self.loads);
            let first = self.first as u32;
            let overlap = evaluation.contacts[group].overlap;
            let grain = |lane: usize| targets[lane][0] + first;
            self.tally.note_overlap(overlap, frame.curvature, grain);
            let touching = evaluation.touching(group);
            if touching.trailing_ones() < R::COUNT as u32 {
                for lane in (0..R::COUNT).filter(|lane| touching >> lane & 1 == 0) {
                    self.pairs.open(rows[group * R::COUNT + lane] as usize);
                }
            }
        }
    }

    /// Evaluates the contacts of grains with a wall or a part of the intruder.
    pub(super) fn sweep_surface<D: Dimension<N>, const N: usize>(
        &mut self,
        grains: &Grains,
        stages: &[Box<dyn ContactStage>],
        part: (usize, &Part),
        dt: f64,
    ) where
        dyn ContactStage: Sweep<f64, N>,
    {
        let (index, part) = part;
        let table = &mut self.surfaces[index];
        if table.keys().is_empty() {
            return;
        }
        let placement = &part.placement;
        let bench = &mut self.bench;
        let grain = |i: u32| {
            let motion = grains.motion_in::<D, N>(i as usize);
            let position = grains.period.image_near(motion.position, placement.position);
            Motion { position, ..motion }
        };
        bench.points.clear();
        bench
            .points
            .extend(table.keys().iter().map(|&[i, _]| placement.to_body(grain(i).position)));
        part.surface.closest_many(&bench.points, &mut bench.nearest);
        bench.near_rows.clear();
        bench.points_half.clear();
        for (row, (&[i, _], nearest)) in table.keys().iter().zip(&bench.nearest).enumerate() {
            let grain = grain(i);
            if nearest.gap < grain.radius || table.is_touching(row) {
                bench.near_rows.push(row as u32);
                let half = grain.position - grain.velocity * (0.5 * dt);
                bench.points_half.push(placement.to_body_half(half));
            }
        }
        part.surface.closest_many(&bench.points_half, &mut bench.nearest_half);

        let is_wall = part.partner == Partner::Wall;
        let halves = bench.nearest_half.chunks(GROUPS);
        for (rows, halves) in bench.near_rows.chunks(GROUPS).zip(halves) {
            let mut evaluation = Evaluation::<f64, N>::new();
            let mut contacts = ArrayVec::<(Contact, Motion), GROUPS>::new();
            for (&row, half) in rows.iter().zip(halves) {
                let grain = grain(table.keys()[row as usize][0]);
                let now = &bench.nearest[row as usize];
                let contact = with_surface(&grain, placement, now, half, dt);
                let record = table.record(row as usize);
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
                let i = table.keys()[row][0];
                let at = (i as usize - self.first) * D::LOAD;
                D::add_load(&on_grain, &mut self.loads[at..at + D::LOAD]);
                if evaluation.touching(k) == 0 {
                    table.open(row);
                } else {
                    let felt = bench.nearest[row].felt;
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
