//! All contacts of a bed: found, evaluated and summed block by block.
//!
//! A block owns the contacts of its grains: with grains behind them in memory, with walls and with
//! the intruder. A contact is evaluated once. Its force is added to the loads that the block holds for
//! its own grains and for its halo, grains of other blocks that touch them; those are added up when the
//! grains are kicked. Nothing is locked, and every sum has one order.

mod block;
mod buffers;
mod pairs;
pub mod rebound;
pub mod stage;
mod tally;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::body::Part;
use crate::contact::Partner;
use crate::contact::table::{Candidate, ContactTable, replace, reserve};
use crate::contacts::stage::{ContactStage, Sweep};
use crate::dimension::{Components, Dimension, Planar, Spatial};
use crate::grains::Grains;
use crate::lanes::Eight;
use crate::math::Vec3;
use crate::neighbours::CellGrid;
use crate::parallel::{BLOCK, block_of};
use crate::space::Space;

pub(crate) use block::Evaluation;
use block::{Block, Delivery};
use buffers::{BuffersOfThreads, ThreadBuffers};
pub(crate) use tally::Tally;

/// The contacts of a bed, by block of grains.
pub(crate) struct Contacts {
    stages: Vec<Box<dyn ContactStage>>,
    blocks: Vec<Block>,
    buffers_of_threads: BuffersOfThreads,
    /// Gap (m) up to which pairs are looked at in every step, if not all are.
    close_margin: Option<f64>,
}

impl Contacts {
    pub(crate) fn new(
        stages: Vec<Box<dyn ContactStage>>,
        (space, n_grains): (Space, usize),
        n_parts: usize,
        close_margin: Option<f64>,
    ) -> Self {
        let [of_pair, of_surface] = record_lens(&stages, space);
        let n_channels = stages.iter().map(|stage| stage.channels().len()).sum();
        let blocks = (0..n_grains.div_ceil(BLOCK))
            .map(|block| {
                let tables = (ContactTable::new(&of_pair), ContactTable::new(&of_surface));
                Block::new(block * BLOCK, tables, Tally::new(n_channels, n_parts), n_parts)
            })
            .collect();
        Self { stages, blocks, buffers_of_threads: BuffersOfThreads::new(), close_margin }
    }

    pub(crate) fn stages(&self) -> &[Box<dyn ContactStage>] {
        &self.stages
    }

    /// Has laws book no energies from now on.
    pub(crate) fn book_nothing(&mut self) {
        for block in &mut self.blocks {
            block.tally.energy.clear();
            block.tally.wall_energy.clear();
        }
    }

    /// The widest gap (m) of a contact that a law still holds together, of bodies of radius `radius_eff`
    /// (m) or less.
    pub(crate) fn reach(&self, partner: Partner, radius_eff: f64) -> f64 {
        self.stages.iter().fold(0.0, |reach, stage| reach.max(stage.reach(partner, radius_eff)))
    }

    /// Lists again which grains are nearer to each other than `margin` (m), for the blocks with a mark.
    pub(crate) fn list_pairs(
        &mut self,
        grains: &Grains,
        grid: &CellGrid,
        margin: f64,
        marks: &[bool],
    ) {
        let buffers_of_threads = &self.buffers_of_threads;
        marked(&mut self.blocks, marks).for_each(|block| {
            let ThreadBuffers { keys, merger, neighbourhood, .. } = &mut *buffers_of_threads.own();
            keys.clear();
            let own = block.first..(block.first + BLOCK).min(grains.len());
            grid.pairs_of(grains, own, margin, neighbourhood, keys);
            block.pairs.rekey(keys, merger);
        });
        self.address_loads(grains.len(), marks);
    }

    /// Lists again which grains are nearer to `part` than `margin` (m), for the blocks with a mark.
    pub(crate) fn list_surface(
        &mut self,
        grains: &Grains,
        part: (usize, &Part),
        margin: f64,
        marks: &[bool],
    ) {
        let (index, part) = part;
        let buffers_of_threads = &self.buffers_of_threads;
        marked(&mut self.blocks, marks).for_each(|block| {
            let buffers = &mut *buffers_of_threads.own();
            let end = (block.first + BLOCK).min(grains.len());
            let here = block.first..end;
            let placement = &part.placement;
            let image = |x: Vec3| grains.period.image_near(x, placement.position);
            buffers.points.clear();
            let positions = here.clone().map(|i| grains.drifted(i));
            buffers.points.extend(positions.map(|x| placement.to_body(image(x))));
            part.surface.closest_many(&buffers.points, &mut buffers.nearest);
            buffers.keys.clear();
            for (i, nearest) in here.zip(&buffers.nearest) {
                if nearest.gap < grains.radius(i) + margin {
                    buffers.keys.push([i as u32, 0]);
                }
            }
            block.surfaces[index].rekey(&buffers.keys, &mut buffers.merger);
        });
    }

    /// Says for every pair whose load its second grain has, and for every grain of a halo where the
    /// block that owns it finds its load, after the blocks with a mark have been listed.
    fn address_loads(&mut self, n_grains: usize, marks: &[bool]) {
        let buffers_of_threads = &self.buffers_of_threads;
        marked(&mut self.blocks, marks).for_each(|block| {
            block.relisted();
            let own = block.first..(block.first + BLOCK).min(n_grains);
            let is_own = |j: u32| own.contains(&(j as usize));
            let ThreadBuffers { halo, .. } = &mut *buffers_of_threads.own();
            halo.clear();
            halo.extend(block.pairs.keys().map(|[_, j]| j).filter(|&j| !is_own(j)));
            halo.sort_unstable();
            halo.dedup();
            replace(&mut block.halo, halo);
            halo.iter_mut().for_each(|grain| *grain = block_of(*grain as usize) as u32);
            halo.dedup();
            replace(&mut block.around, halo);
            for Candidate { key: [_, j], target, .. } in block.pairs.candidates_mut() {
                *target = if is_own(*j) {
                    *j - own.start as u32
                } else {
                    (own.len() + block.halo.partition_point(|halo| halo < j)) as u32
                };
            }
        });
        let mut n_sent = vec![0; self.blocks.len()];
        for block in &self.blocks {
            block.halo.iter().for_each(|&grain| n_sent[block_of(grain as usize)] += 1);
        }
        for (block, n_sent) in self.blocks.iter_mut().zip(n_sent) {
            block.inbox.clear();
            reserve(&mut block.inbox, n_sent);
        }
        for from in 0..self.blocks.len() {
            let own = (self.blocks[from].first + BLOCK).min(n_grains) - self.blocks[from].first;
            for k in 0..self.blocks[from].halo.len() {
                let grain = self.blocks[from].halo[k] as usize;
                let to = block_of(grain);
                let grain = (grain - self.blocks[to].first) as u32;
                let delivery = Delivery { block: from as u32, from: (own + k) as u32, grain };
                self.blocks[to].inbox.push(delivery);
            }
        }
        // Stable: the loads of one grain stay in the order of the blocks that they come from.
        self.blocks.par_iter_mut().for_each(|block| block.inbox.sort_by_key(|sent| sent.grain));
    }

    /// Finds what touches, lets the laws act, and sums forces within each block; [`Contacts::loads`] puts
    /// them together.
    /// `fastest` has the greatest speed (m/s) of a grain of each block in the step, of `dt` (s).
    pub(crate) fn evaluate(
        &mut self,
        grains: &Grains,
        fastest: &[f64],
        parts: [&[Part]; 2],
        dt: f64,
    ) {
        match grains.space {
            Space::Planar => self.evaluate_in::<Planar, 1>(grains, fastest, parts, dt),
            Space::Spatial => self.evaluate_in::<Spatial, 3>(grains, fastest, parts, dt),
        }
    }

    fn evaluate_in<D: Dimension<N>, const N: usize>(
        &mut self,
        grains: &Grains,
        fastest: &[f64],
        parts: [&[Part]; 2],
        dt: f64,
    ) where
        dyn ContactStage: Sweep<f64, N> + Sweep<Eight, N>,
    {
        let (stages, buffers_of_threads) = (&self.stages[..], &self.buffers_of_threads);
        let close = self.close_margin;
        // Each block by itself: blocks differ, and half of them in one piece keeps a thread waiting.
        self.blocks.par_iter_mut().with_max_len(1).for_each(|block| {
            let buffers = &mut *buffers_of_threads.own();
            let own = (block.first + BLOCK).min(grains.len()) - block.first;
            let n_numbers = (own + block.halo.len()) * D::Load::LEN;
            reserve(&mut block.loads, n_numbers);
            block.loads.resize(n_numbers, 0.0);
            block.loads.fill(0.0);
            block.tally.clear();
            let gone = |block: usize| fastest[block] * dt;
            block.sweep_pairs::<D, N>(grains, stages, (gone, close), dt, buffers);
            for (index, part) in parts.into_iter().flatten().enumerate() {
                block.sweep_surface::<D, N>(grains, stages, (index, part), dt, buffers);
            }
        });
    }

    /// The loads that contacts make on the grains of `block`.
    pub(crate) fn loads(&self, block: usize) -> Loads<'_> {
        let Block { loads, inbox, .. } = &self.blocks[block];
        Loads { blocks: &self.blocks, own: loads, inbox: inbox.iter() }
    }

    /// Room for the sums over all blocks.
    pub(crate) fn no_sums(&self) -> Tally {
        let n_channels = self.stages.iter().map(|stage| stage.channels().len()).sum();
        Tally::new(n_channels, self.blocks.first().map_or(0, |block| block.surfaces.len()))
    }

    /// Adds up the blocks, in order.
    pub(crate) fn sum(&self, sums: &mut Tally) {
        sums.clear();
        for Block { tally, .. } in &self.blocks {
            sums.add(tally);
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

    /// Indices of the grains of every pair that is near enough to be listed, ascending.
    pub(crate) fn listed_pairs(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        self.blocks.iter().flat_map(|block| block.pairs.keys()).map(|key| key.map(|k| k as usize))
    }

    /// Indices of the grains of every contact between grains that touch, ascending.
    pub(crate) fn touching_pairs(&self) -> Vec<[usize; 2]> {
        let mut touching = Vec::new();
        for Block { pairs, .. } in &self.blocks {
            for (row, [i, j]) in pairs.keys().enumerate() {
                if pairs.is_touching(row) {
                    touching.push([i as usize, j as usize]);
                }
            }
        }
        touching
    }

    /// Whether each of `n_grains` grains touches another or one of the first `n_walls` parts.
    pub(crate) fn lying(&self, n_grains: usize, n_walls: usize) -> Vec<bool> {
        let mut lying = vec![false; n_grains];
        for [i, j] in self.touching_pairs() {
            (lying[i], lying[j]) = (true, true);
        }
        for table in self.blocks.iter().flat_map(|block| &block.surfaces[..n_walls]) {
            for (row, [i, _]) in table.keys().enumerate() {
                lying[i as usize] |= table.is_touching(row);
            }
        }
        lying
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
    pub(crate) fn restore(
        &mut self,
        saved: Vec<SavedBlock>,
        (space, n_grains): (Space, usize),
    ) -> bool {
        let [of_pair, of_surface] = record_lens(&self.stages, space);
        let fits = saved.len() == self.blocks.len()
            && saved.iter().zip(&self.blocks).all(|(saved, block)| {
                let own = || block.first..(block.first + BLOCK).min(n_grains);
                let surface_fits =
                    |table: &ContactTable| table.is_consistent(own(), n_grains, &of_surface);
                saved.surfaces.len() == block.surfaces.len()
                    && saved.pairs.is_consistent(own(), n_grains, &of_pair)
                    && saved.surfaces.iter().all(surface_fits)
            });
        if fits {
            for (block, saved) in self.blocks.iter_mut().zip(saved) {
                block.pairs = saved.pairs;
                block.surfaces = saved.surfaces;
            }
            self.address_loads(n_grains, &vec![true; self.blocks.len()]);
        }
        fits
    }

    /// The histories of all touching contacts: what a bed keeps when it is stored.
    pub(crate) fn memories(&self) -> Vec<Memory> {
        let mut memories = Vec::new();
        for block in &self.blocks {
            let tables =
                std::iter::once((None, &block.pairs)).chain((0..).map(Some).zip(&block.surfaces));
            for (part, table) in tables {
                for (row, key) in table.keys().enumerate() {
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
        let place = |memory: &Memory| (block_of(memory.key[0] as usize), memory.part);
        for of_table in memories.chunk_by(|one, next| place(one) == place(next)) {
            let (block, part) = place(&of_table[0]);
            let table = self.blocks.get_mut(block).and_then(|block| match part {
                None => Some(&mut block.pairs),
                Some(part) => block.surfaces.get_mut(part),
            });
            let Some(table) = table else { continue };
            table.make_room(of_table.len());
            for memory in of_table {
                let Some(row) = table.row_of(memory.key) else { continue };
                for (stage, source) in sources.iter().enumerate() {
                    let values = source.and_then(|source| memory.history.get(source));
                    if let Some(values) = values.filter(|v| v.len() == table.history_len()[stage]) {
                        table.restore_row(stage, row, values);
                    }
                }
            }
        }
    }
}

/// The blocks with a mark.
fn marked<'a>(
    blocks: &'a mut [Block],
    marks: &'a [bool],
) -> impl ParallelIterator<Item = &'a mut Block> {
    let marked = blocks.par_iter_mut().zip(marks).filter(|(_, mark)| **mark);
    marked.map(|(block, _)| block)
}

/// How many numbers each stage has in the record of two grains, and in that of a grain and a surface, which
/// ends with one more: its 1/R* at the end of the last step (1/m), zero if it did not overlap.
pub(crate) fn record_lens(stages: &[Box<dyn ContactStage>], space: Space) -> [Vec<usize>; 2] {
    let of_pair: Vec<usize> = stages.iter().map(|stage| stage.history_len(space)).collect();
    let of_surface = of_pair.iter().copied().chain([1]).collect();
    [of_pair, of_surface]
}

/// What contacts do to the grains of one block, grain by grain.
pub(crate) struct Loads<'a> {
    blocks: &'a [Block],
    own: &'a [f64],
    /// What is still to be handed out.
    inbox: std::slice::Iter<'a, Delivery>,
}

impl Loads<'_> {
    /// The load of grain `k` of the block; to be asked for one after the other.
    #[inline(always)]
    pub(crate) fn of<D: Dimension<N>, const N: usize>(&mut self, k: usize) -> D::Load {
        let mut load = D::Load::each(self.own)[k];
        while let Some(sent) = self.inbox.as_slice().first().filter(|sent| sent.grain == k as u32) {
            let loads = D::Load::each(&self.blocks[sent.block as usize].loads);
            load.add(&loads[sent.from as usize]);
            self.inbox.next();
        }
        load
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
