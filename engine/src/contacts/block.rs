//! The contacts of one block of grains: what the threads work on.

use crate::body::Part;
use crate::contact::geometry::{
    between_grains, loads_on_grain_and_part, loads_on_grains, with_surface,
};
use crate::contact::stage::Batch;
use crate::contact::table::ContactTable;
use crate::contact::{Contact, ContactStage, Partner, Response};
use crate::footprint::Footprint;
use crate::grains::{Grains, Load};
use crate::math::Vec3;
use crate::surface::{SurfacePoint, Wrench};

/// Contacts evaluated together.
pub(super) const BATCH: usize = 128;

/// Marks a contact whose second grain lies in the same block.
pub(super) const INSIDE: u32 = u32::MAX;

/// The contacts of the grains of one block.
pub(super) struct Block {
    pub(super) first: usize,
    pub(super) pairs: ContactTable,
    /// Per pair: where in the outbox the force on the second grain goes, or [`INSIDE`].
    pub(super) outbox_slot: Vec<u32>,
    pub(super) outbox: Vec<Load>,
    pub(super) inbox: Vec<Delivery>,
    /// Per part of walls and intruder.
    pub(super) surfaces: Vec<ContactTable>,
    pub(super) tally: Tally,
    pub(super) bench: Bench,
}

/// A force from another block's outbox.
pub(super) struct Delivery {
    pub(super) block: u32,
    pub(super) slot: u32,
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
    /// Per stage and channel: energies (J) of contacts between grains and with the intruder.
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

/// Contacts waiting to be evaluated, in buffers that are kept.
#[derive(Default)]
pub(super) struct Bench {
    contacts: Vec<Contact>,
    rows: Vec<u32>,
    responses: Vec<Response>,
    pub(super) points: Vec<Vec3>,
    points_half: Vec<Vec3>,
    pub(super) nearest: Vec<SurfacePoint>,
    nearest_half: Vec<SurfacePoint>,
    near_rows: Vec<u32>,
    pub(super) keys: Vec<[u32; 2]>,
}

impl Bench {
    pub(super) fn clear(&mut self) {
        self.contacts.clear();
        self.rows.clear();
    }

    #[inline(always)]
    fn push(&mut self, contact: Contact, row: usize) {
        self.contacts.push(contact);
        self.rows.push(row as u32);
    }

    fn is_full(&self) -> bool {
        self.contacts.len() == BATCH
    }

    /// Lets every law act on the waiting contacts; those that have opened lose their history.
    fn evaluate(
        &mut self,
        stages: &[Box<dyn ContactStage>],
        dt: f64,
        touching: &mut [bool],
        history: &mut [Vec<f64>],
        energy: &mut [f64],
    ) {
        self.responses.clear();
        self.responses.resize(self.contacts.len(), Response::default());
        let mut energy = energy;
        for (stage, history) in stages.iter().zip(history.iter_mut()) {
            let (own, rest) = energy.split_at_mut(stage.channels().len());
            energy = rest;
            let batch = Batch {
                contacts: &self.contacts,
                rows: &self.rows,
                responses: &mut self.responses,
            };
            stage.sweep(batch, dt, history, own);
        }
        let evaluated = self.contacts.iter().zip(&self.responses);
        for ((contact, response), &row) in evaluated.zip(&self.rows) {
            let row = row as usize;
            touching[row] = contact.overlap > 0.0 || response.holds;
            if !touching[row] {
                for (stage, rows) in stages.iter().zip(history.iter_mut()) {
                    let len = stage.history_len();
                    rows[row * len..(row + 1) * len].fill(0.0);
                }
            }
        }
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

    /// Takes note of a contact of `grain`; `curvature` (1/m) is that of the smaller grain.
    fn note_overlap(&mut self, contact: &Contact, grain: usize, curvature: f64) {
        let relative = contact.overlap * curvature;
        if relative > self.overlap.relative {
            self.overlap = Deepest { relative, overlap: contact.overlap, grain: grain as u32 };
        }
    }
}

impl Block {
    pub(super) fn sweep_pairs(
        &mut self,
        grains: &Grains,
        stages: &[Box<dyn ContactStage>],
        load: &mut [Load],
        dt: f64,
    ) {
        let (keys, touching, history) = self.pairs.rows_mut();
        // Without a branch: about half of the candidates touch, and which ones cannot be foreseen.
        let near = &mut self.bench.near_rows;
        near.resize(keys.len(), 0);
        let mut n_near = 0;
        for (row, (&[i, j], &touched)) in keys.iter().zip(&*touching).enumerate() {
            let (i, j) = (i as usize, j as usize);
            let reach = grains.radius[i] + grains.radius[j];
            let apart = grains.apart(i, j);
            near[n_near] = row as u32;
            n_near += usize::from((apart.norm_squared() < reach * reach) | touched);
        }
        let mut next = 0;
        while next < n_near {
            self.bench.clear();
            while next < n_near && !self.bench.is_full() {
                let row = self.bench.near_rows[next] as usize;
                let [i, j] = keys[row].map(|k| k as usize);
                self.bench.push(between_grains(grains, i, j, dt), row);
                next += 1;
            }
            self.bench.evaluate(stages, dt, touching, history, &mut self.tally.energy);
            let evaluated = self.bench.contacts.iter().zip(&self.bench.responses);
            for ((contact, response), &row) in evaluated.zip(&self.bench.rows) {
                let [i, j] = keys[row as usize].map(|k| k as usize);
                let (r_i, r_j) = (grains.radius[i], grains.radius[j]);
                let (on_i, on_j) = loads_on_grains(contact, response, r_i, r_j);
                load[i - self.first].add(&on_i);
                match self.outbox_slot[row as usize] {
                    INSIDE => load[j - self.first].add(&on_j),
                    slot => self.outbox[slot as usize] = on_j,
                }
                let curvature = grains.inverse_radius[i].max(grains.inverse_radius[j]);
                self.tally.note_overlap(contact, i, curvature);
            }
        }
    }

    pub(super) fn sweep_surface(
        &mut self,
        grains: &Grains,
        stages: &[Box<dyn ContactStage>],
        load: &mut [Load],
        part: (usize, &Part),
        dt: f64,
    ) {
        let (index, part) = part;
        let (keys, touching, history) = self.surfaces[index].rows_mut();
        if keys.is_empty() {
            return;
        }
        let placement = &part.placement;
        let bench = &mut self.bench;
        bench.points.clear();
        let image =
            |i: u32| grains.period.image_near(grains.position[i as usize], placement.position);
        bench.points.extend(keys.iter().map(|&[i, _]| placement.to_body(image(i))));
        part.surface.closest_many(&bench.points, &mut bench.nearest);
        bench.near_rows.clear();
        bench.points.clear();
        bench.points_half.clear();
        for (row, (&[index, _], nearest)) in keys.iter().zip(&bench.nearest).enumerate() {
            let i = index as usize;
            if nearest.gap < grains.radius[i] || touching[row] {
                bench.near_rows.push(row as u32);
                let half = image(index) - grains.velocity[i] * (0.5 * dt);
                bench.points_half.push(placement.to_body_half(half));
            }
        }
        part.surface.closest_many(&bench.points_half, &mut bench.nearest_half);

        let is_wall = part.partner == Partner::Wall;
        let mut next = 0;
        while next < bench.near_rows.len() {
            bench.clear();
            while next < bench.near_rows.len() && !bench.is_full() {
                let row = bench.near_rows[next] as usize;
                let i = keys[row][0];
                let grain = (i as usize, image(i));
                let (now, half) = (bench.nearest[row], bench.nearest_half[next]);
                let side = (placement, part.partner);
                bench.push(with_surface(grains, grain, side, &now, &half, dt), row);
                next += 1;
            }
            let energy = if is_wall { &mut self.tally.wall_energy } else { &mut self.tally.energy };
            bench.evaluate(stages, dt, touching, history, energy);
            let evaluated = bench.contacts.iter().zip(&bench.responses);
            for ((contact, response), &row) in evaluated.zip(&bench.rows) {
                let i = keys[row as usize][0] as usize;
                let apart = image(i as u32) - placement.position;
                let (on_grain, on_part) =
                    loads_on_grain_and_part(contact, response, grains.radius[i], apart);
                load[i - self.first].add(&on_grain);
                if contact.overlap > 0.0 || response.holds {
                    let felt = bench.nearest[row as usize].felt;
                    let wrenches = match felt {
                        true => &mut self.tally.wrenches,
                        false => &mut self.tally.unfelt,
                    };
                    wrenches[index].add(&on_part);
                    if felt && !is_wall && contact.overlap > 0.0 {
                        let radius = grains.radius[i];
                        self.tally.footprints[index].add_grain(
                            contact,
                            radius,
                            grains.space.grain_cross_section(radius),
                            placement.velocity_at(apart),
                        );
                    }
                }
                self.tally.note_overlap(contact, i, grains.inverse_radius[i]);
            }
        }
    }
}
