//! All contacts of a bed: found, evaluated and summed block by block.
//!
//! A block owns the contacts of its grains: with grains behind them in memory, with walls and with
//! the intruder. A contact is evaluated once. Its force goes straight to the grains of the block; a
//! grain of another block finds it in this block's outbox, in a second pass. Nothing is locked, and
//! every sum has one order.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::body::Part;
use crate::contact::geometry::{Located, between_grains, with_surface};
use crate::contact::stage::Batch;
use crate::contact::table::ContactTable;
use crate::contact::{Contact, ContactStage, Response};
use crate::grains::{Grains, Load};
use crate::math::Vec3;
use crate::neighbours::CellGrid;
use crate::parallel::{BLOCK, block_of};
use crate::surface::{SurfacePoint, Wrench};

/// Contacts evaluated together.
const BATCH: usize = 128;

/// Marks a contact whose second grain lies in the same block.
const INSIDE: u32 = u32::MAX;

/// The contacts of a bed, by block of grains.
pub(crate) struct Contacts {
    stages: Vec<Box<dyn ContactStage>>,
    blocks: Vec<Block>,
}

/// The contacts of the grains of one block.
struct Block {
    first: usize,
    pairs: ContactTable,
    /// Per pair: where in the outbox the force on the second grain goes, or [`INSIDE`].
    outbox_slot: Vec<u32>,
    outbox: Vec<Load>,
    inbox: Vec<Delivery>,
    /// Per part of walls and intruder.
    surfaces: Vec<ContactTable>,
    tally: Tally,
    bench: Bench,
}

/// A force from another block's outbox.
struct Delivery {
    block: u32,
    slot: u32,
    /// Index of the grain within its block.
    grain: u32,
}

/// What one block adds to the sums of the bed.
#[derive(Default)]
struct Tally {
    /// Per stage and channel: energies [J] of contacts between grains and with the intruder.
    energy: Vec<f64>,
    /// The same for contacts with walls.
    wall_energy: Vec<f64>,
    /// Per part.
    wrenches: Vec<Wrench>,
    /// Largest overlap in units of the radius, and the grain that has it.
    overlap: (f64, u32),
}

/// Contacts waiting to be evaluated, in buffers that are kept.
#[derive(Default)]
struct Bench {
    contacts: Vec<Contact>,
    arms: Vec<[Vec3; 2]>,
    rows: Vec<u32>,
    responses: Vec<Response>,
    points: Vec<Vec3>,
    points_half: Vec<Vec3>,
    nearest: Vec<SurfacePoint>,
    nearest_half: Vec<SurfacePoint>,
    near_rows: Vec<u32>,
    keys: Vec<[u32; 2]>,
}

impl Bench {
    fn clear(&mut self) {
        self.contacts.clear();
        self.arms.clear();
        self.rows.clear();
    }

    fn push(&mut self, located: Located, row: usize) {
        self.contacts.push(located.contact);
        self.arms.push([located.arm_i, located.arm_j]);
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
        for (contact, &row) in self.contacts.iter().zip(&self.rows) {
            let row = row as usize;
            touching[row] = contact.overlap > 0.0;
            if !touching[row] {
                for (stage, rows) in stages.iter().zip(history.iter_mut()) {
                    let len = stage.history_len();
                    rows[row * len..(row + 1) * len].fill(0.0);
                }
            }
        }
    }

    fn located(&self, k: usize) -> Located {
        Located { contact: self.contacts[k], arm_i: self.arms[k][0], arm_j: self.arms[k][1] }
    }
}

/// The sums of a step over all contacts.
#[derive(Clone, Debug, Default)]
pub(crate) struct ContactSums {
    /// Per stage and channel [J]: held now, or lost in this step, at grains and intruder.
    pub(crate) energy: Vec<f64>,
    /// The same at walls.
    pub(crate) wall_energy: Vec<f64>,
    /// Per part.
    pub(crate) wrenches: Vec<Wrench>,
    /// Largest overlap in units of the radius, and the index of the grain that has it.
    pub(crate) overlap: (f64, u32),
}

impl Contacts {
    pub(crate) fn new(
        stages: Vec<Box<dyn ContactStage>>,
        n_grains: usize,
        n_parts: usize,
    ) -> Self {
        let history_len: Vec<usize> = stages.iter().map(|stage| stage.history_len()).collect();
        let n_channels = stages.iter().map(|stage| stage.channels().len()).sum();
        let blocks = (0..n_grains.div_ceil(BLOCK))
            .map(|block| Block {
                first: block * BLOCK,
                pairs: ContactTable::new(&history_len),
                outbox_slot: Vec::new(),
                outbox: Vec::new(),
                inbox: Vec::new(),
                surfaces: vec![ContactTable::new(&history_len); n_parts],
                tally: Tally {
                    energy: vec![0.0; n_channels],
                    wall_energy: vec![0.0; n_channels],
                    wrenches: vec![Wrench::default(); n_parts],
                    overlap: (0.0, 0),
                },
                bench: Bench::default(),
            })
            .collect();
        Self { stages, blocks }
    }

    pub(crate) fn stages(&self) -> &[Box<dyn ContactStage>] {
        &self.stages
    }

    /// Lists again which grains are nearer to each other than `margin` [m].
    pub(crate) fn list_pairs(&mut self, grains: &Grains, grid: &CellGrid, margin: f64) {
        self.blocks.par_iter_mut().for_each(|block| {
            let mut keys = std::mem::take(&mut block.bench.keys);
            keys.clear();
            for i in block.first..(block.first + BLOCK).min(grains.len()) {
                grid.pairs_of(grains, i, margin, &mut keys);
            }
            block.pairs.rekey(&mut keys);
            block.bench.keys = keys;
        });
        self.address_outboxes();
    }

    /// Lists again which grains are nearer to `part` than `margin` [m].
    pub(crate) fn list_surface(&mut self, grains: &Grains, part: (usize, &Part), margin: f64) {
        let (index, part) = part;
        self.blocks.par_iter_mut().for_each(|block| {
            let bench = &mut block.bench;
            let end = (block.first + BLOCK).min(grains.len());
            let here = block.first..end;
            bench.points.clear();
            bench.points.extend(
                grains.position[here.clone()].iter().map(|&x| part.placement.to_body(x)),
            );
            part.surface.closest_many(&bench.points, &mut bench.nearest);
            let mut keys = std::mem::take(&mut bench.keys);
            keys.clear();
            for (i, nearest) in here.zip(&bench.nearest) {
                if nearest.gap < grains.radius[i] + margin {
                    keys.push([i as u32, 0]);
                }
            }
            block.surfaces[index].rekey(&mut keys);
            bench.keys = keys;
        });
    }

    /// Gives every contact across blocks a place in its block's outbox and a line in the other's
    /// inbox.
    fn address_outboxes(&mut self) {
        for block in &mut self.blocks {
            block.inbox.clear();
        }
        for from in 0..self.blocks.len() {
            let block = &mut self.blocks[from];
            let mut slots = std::mem::take(&mut block.outbox_slot);
            slots.clear();
            let mut n_out = 0;
            for row in 0..self.blocks[from].pairs.keys().len() {
                let [_, j] = self.blocks[from].pairs.keys()[row];
                let to = block_of(j as usize);
                if to == from {
                    slots.push(INSIDE);
                    continue;
                }
                let grain = (j as usize - self.blocks[to].first) as u32;
                self.blocks[to].inbox.push(Delivery { block: from as u32, slot: n_out, grain });
                slots.push(n_out);
                n_out += 1;
            }
            let block = &mut self.blocks[from];
            block.outbox_slot = slots;
            block.outbox.clear();
            block.outbox.resize(n_out as usize, Load::ZERO);
        }
    }

    /// Finds what touches, lets the laws act, and sums forces within each block into `grains.load`
    /// (set anew); [`Contacts::deliver`] adds the rest.
    pub(crate) fn evaluate(
        &mut self,
        grains: &mut Grains,
        walls: &[Part],
        intruder: &[Part],
        dt: f64,
    ) {
        let mut load = std::mem::take(&mut grains.load);
        let (grains_now, stages) = (&*grains, &self.stages[..]);
        self.blocks.par_iter_mut().zip(load.par_chunks_mut(BLOCK)).for_each(|(block, load)| {
            load.fill(Load::ZERO);
            block.tally.clear();
            block.outbox.fill(Load::ZERO);
            block.sweep_pairs(grains_now, stages, load, dt);
            for (index, part) in walls.iter().chain(intruder).enumerate() {
                block.sweep_surface(grains_now, stages, load, (index, part), dt);
            }
        });
        grains.load = load;
    }

    /// Adds the forces that other blocks hold for the grains of `block`.
    pub(crate) fn deliver(&self, block: usize, load: &mut [Load]) {
        for delivery in &self.blocks[block].inbox {
            let sent = &self.blocks[delivery.block as usize].outbox[delivery.slot as usize];
            load[delivery.grain as usize].add(sent);
        }
    }

    /// Adds up the blocks, in order.
    pub(crate) fn sum(&self, sums: &mut ContactSums) {
        let n_channels = self.stages.iter().map(|stage| stage.channels().len()).sum();
        let n_parts = self.blocks.first().map_or(0, |block| block.surfaces.len());
        sums.energy.clear();
        sums.energy.resize(n_channels, 0.0);
        sums.wall_energy.clear();
        sums.wall_energy.resize(n_channels, 0.0);
        sums.wrenches.clear();
        sums.wrenches.resize(n_parts, Wrench::default());
        sums.overlap = (0.0, 0);
        for Block { tally, .. } in &self.blocks {
            for (sum, part) in sums.energy.iter_mut().zip(&tally.energy) {
                *sum += part;
            }
            for (sum, part) in sums.wall_energy.iter_mut().zip(&tally.wall_energy) {
                *sum += part;
            }
            for (sum, part) in sums.wrenches.iter_mut().zip(&tally.wrenches) {
                sum.add(part);
            }
            if tally.overlap.0 > sums.overlap.0 {
                sums.overlap = tally.overlap;
            }
        }
    }

    /// Contacts between grains that touch, and contacts of grains with each part.
    pub(crate) fn count(&self) -> (usize, Vec<usize>) {
        let pairs = self.blocks.iter().map(|block| block.pairs.n_touching()).sum();
        let n_parts = self.blocks.first().map_or(0, |block| block.surfaces.len());
        let surfaces = (0..n_parts)
            .map(|part| self.blocks.iter().map(|block| block.surfaces[part].n_touching()).sum())
            .collect();
        (pairs, surfaces)
    }

    /// All tables, for a checkpoint.
    pub(crate) fn save(&self) -> Vec<SavedBlock> {
        self.blocks
            .iter()
            .map(|block| SavedBlock {
                pairs: block.pairs.clone(),
                surfaces: block.surfaces.clone(),
            })
            .collect()
    }

    /// Takes back what [`Contacts::save`] gave; `false` if it does not fit.
    pub(crate) fn restore(&mut self, saved: Vec<SavedBlock>, n_grains: usize) -> bool {
        let history_len: Vec<usize> = self.stages.iter().map(|stage| stage.history_len()).collect();
        let fits = saved.len() == self.blocks.len()
            && saved.iter().zip(&self.blocks).all(|(saved, block)| {
                saved.surfaces.len() == block.surfaces.len()
                    && std::iter::once(&saved.pairs)
                        .chain(&saved.surfaces)
                        .all(|table| {
                            let own = block.first..(block.first + BLOCK).min(n_grains);
                            table.is_consistent(own, n_grains, &history_len)
                        })
            });
        if fits {
            for (block, saved) in self.blocks.iter_mut().zip(saved) {
                block.pairs = saved.pairs;
                block.surfaces = saved.surfaces;
            }
            self.address_outboxes();
        }
        fits
    }

    /// The histories of all touching contacts: what a bed keeps when it is stored.
    pub(crate) fn memories(&self) -> Vec<Memory> {
        let mut memories = Vec::new();
        for block in &self.blocks {
            let tables = std::iter::once((None, &block.pairs))
                .chain((0..).map(Some).zip(&block.surfaces));
            for (part, table) in tables {
                for (row, &key) in table.keys().iter().enumerate() {
                    if table.is_touching(row) {
                        let stages = 0..self.stages.len();
                        let history = stages.map(|stage| table.history(stage, row).to_vec());
                        memories.push(Memory { part, key, history: history.collect() });
                    }
                }
            }
        }
        memories
    }

    /// Gives listed contacts the histories of `memories`, which come from stages named `stages` and
    /// grains in the same order. A stage that is not among them starts from nothing.
    pub(crate) fn remember(&mut self, memories: &[Memory], stages: &[String]) {
        let sources: Vec<Option<usize>> = self
            .stages
            .iter()
            .map(|stage| stages.iter().position(|name| name == stage.name()))
            .collect();
        for memory in memories {
            let block = self.blocks.get_mut(block_of(memory.key[0] as usize));
            let table = block.and_then(|block| match memory.part {
                None => Some(&mut block.pairs),
                Some(part) => block.surfaces.get_mut(part),
            });
            let Some(table) = table else { continue };
            let Ok(row) = table.keys().binary_search(&memory.key) else { continue };
            for (stage, source) in sources.iter().enumerate() {
                let values = source.and_then(|source| memory.history.get(source));
                if let Some(values) = values.filter(|v| v.len() == table.history_len()[stage]) {
                    table.restore_row(stage, row, values);
                }
            }
        }
    }
}

/// The tables of one block, for a checkpoint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct SavedBlock {
    pairs: ContactTable,
    surfaces: Vec<ContactTable>,
}

/// What a touching contact remembers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Memory {
    /// The wall, or none for a contact between grains.
    part: Option<usize>,
    /// Its key in the table.
    key: [u32; 2],
    /// Per stage.
    history: Vec<Vec<f64>>,
}

impl Tally {
    fn clear(&mut self) {
        self.energy.fill(0.0);
        self.wall_energy.fill(0.0);
        self.wrenches.fill(Wrench::default());
        self.overlap = (0.0, 0);
    }

    fn note_overlap(&mut self, contact: &Contact, grain: usize) {
        let relative = 0.5 * contact.overlap / contact.radius_eff;
        if relative > self.overlap.0 {
            self.overlap = (relative, grain as u32);
        }
    }
}

impl Block {
    fn sweep_pairs(
        &mut self,
        grains: &Grains,
        stages: &[Box<dyn ContactStage>],
        load: &mut [Load],
        dt: f64,
    ) {
        let (keys, touching, history) = self.pairs.rows_mut();
        let mut row = 0;
        while row < keys.len() {
            self.bench.clear();
            while row < keys.len() && !self.bench.is_full() {
                let [i, j] = keys[row].map(|k| k as usize);
                let apart = grains.position[i] - grains.position[j];
                let reach = grains.radius[i] + grains.radius[j];
                if apart.norm_squared() < reach * reach || touching[row] {
                    self.bench.push(between_grains(grains, i, j, apart, dt), row);
                }
                row += 1;
            }
            self.bench.evaluate(stages, dt, touching, history, &mut self.tally.energy);
            for (k, response) in self.bench.responses.iter().enumerate() {
                let located = self.bench.located(k);
                let row = self.bench.rows[k] as usize;
                let [i, j] = keys[row].map(|k| k as usize);
                load[i - self.first].add(&located.load_on_i(response));
                let opposite = located.load_on_j(response);
                match self.outbox_slot[row] {
                    INSIDE => load[j - self.first].add(&opposite),
                    slot => self.outbox[slot as usize] = opposite,
                }
                self.tally.note_overlap(&located.contact, i);
            }
        }
    }

    fn sweep_surface(
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
        bench.points.extend(
            keys.iter().map(|&[i, _]| placement.to_body(grains.position[i as usize])),
        );
        part.surface.closest_many(&bench.points, &mut bench.nearest);
        bench.near_rows.clear();
        bench.points.clear();
        bench.points_half.clear();
        for (row, (&[i, _], nearest)) in keys.iter().zip(&bench.nearest).enumerate() {
            let i = i as usize;
            if nearest.gap < grains.radius[i] || touching[row] {
                bench.near_rows.push(row as u32);
                let half = grains.position[i] - grains.velocity[i] * (0.5 * dt);
                bench.points_half.push(placement.to_body_half(half));
            }
        }
        part.surface.closest_many(&bench.points_half, &mut bench.nearest_half);

        let is_wall = part.partner == crate::contact::Partner::Wall;
        let mut next = 0;
        while next < bench.near_rows.len() {
            bench.clear();
            while next < bench.near_rows.len() && !bench.is_full() {
                let row = bench.near_rows[next] as usize;
                let i = keys[row][0] as usize;
                let (now, half) = (bench.nearest[row], bench.nearest_half[next]);
                let located =
                    with_surface(grains, i, (placement, part.partner), &now, &half, dt);
                bench.push(located, row);
                next += 1;
            }
            let energy =
                if is_wall { &mut self.tally.wall_energy } else { &mut self.tally.energy };
            bench.evaluate(stages, dt, touching, history, energy);
            for (k, response) in bench.responses.iter().enumerate() {
                let located = bench.located(k);
                let i = keys[bench.rows[k] as usize][0] as usize;
                load[i - self.first].add(&located.load_on_i(response));
                if located.contact.overlap > 0.0 {
                    self.tally.wrenches[index].add(&located.wrench_on_part(response));
                }
                self.tally.note_overlap(&located.contact, i);
            }
        }
    }
}
