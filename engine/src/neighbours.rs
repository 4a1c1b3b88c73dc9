//! Which grains are near each other: a cell grid, rebuilt when grains have moved far enough.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::boundary::Period;
use crate::dimension::{Dimension, Planar, Quad, Spatial};
use crate::grains::{Grain, Grains};
use crate::lanes::{Eight, MOST_LANES, Mask, per_lane};
use crate::math::Vec3;
use crate::parallel::BLOCK;
use crate::space::Space;

/// Gap up to which grains are listed as neighbours, in mean grain diameters: the wider, the rarer lists are made. In a
/// plane that is worth the memory.
pub(crate) const fn pair_margin(space: Space) -> f64 {
    match space {
        Space::Planar => 0.5,
        Space::Spatial => 0.25,
    }
}

/// Gap up to which neighbours are looked at in every step, in mean grain diameters, if not all are: a second list pays where
/// the first is long.
pub(crate) const fn close_margin(space: Space) -> Option<f64> {
    match space {
        Space::Planar => Some(0.03),
        Space::Spatial => None,
    }
}

/// Counts down to the next rebuild of a neighbour list: the list holds everything nearer than
/// `margin`, so it is good until the relative displacement of any two bodies may exceed that.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Freshness {
    margin: f64,
    left: f64,
}

impl Freshness {
    /// A list that is stale from the start; `margin` (m).
    pub(crate) fn stale(margin: f64) -> Self {
        Self { margin, left: -1.0 }
    }

    /// The gap (m) up to which the list has to hold pairs.
    pub(crate) fn margin(&self) -> f64 {
        self.margin
    }

    /// Takes note of a relative displacement (m); returns whether the list has to be rebuilt now.
    pub(crate) fn spend(&mut self, displacement: f64) -> bool {
        self.left -= displacement;
        self.left < 0.0
    }

    /// The list has just been rebuilt.
    pub(crate) fn renew(&mut self) {
        self.left = self.margin;
    }
}

/// The same for lists that blocks of grains have of their neighbours, each with a count of its own: where
/// grains lie still nothing is listed again for the sake of a few that fly.
///
/// A block whose grains may have gone half of `margin` is listed again, and so are all blocks that may
/// hold a neighbour of its grains. Two grains that are in no list were further apart than `margin` when
/// one of their blocks was last listed for its own sake, or when it was listed as the other's neighbour; each has gone
/// less than half of that since.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct BlockFreshness {
    margin: f64,
    /// How far the grains of each block may still go (m).
    left: Vec<f64>,
}

impl BlockFreshness {
    /// Lists that are stale from the start; `margin` (m).
    pub(crate) fn stale(margin: f64, n_blocks: usize) -> Self {
        Self { margin, left: vec![-1.0; n_blocks] }
    }

    /// The gap (m) up to which the lists have to hold pairs.
    pub(crate) fn margin(&self) -> f64 {
        self.margin
    }

    /// How many blocks there are.
    pub(crate) fn n_blocks(&self) -> usize {
        self.left.len()
    }

    /// Takes note of the greatest displacement (m) of a grain of each block; returns whether some lists
    /// have to be made again now.
    pub(crate) fn spend(&mut self, displacements: impl Iterator<Item = f64>) -> bool {
        let mut is_stale = false;
        for (left, displacement) in self.left.iter_mut().zip(displacements) {
            *left -= displacement;
            is_stale |= *left < 0.0;
        }
        is_stale
    }

    /// Marks the blocks that are about to be listed: those that have spent more than half, so that it is not
    /// done for one after the other, and what is nearer than `reach` (m) to them, centre to centre.
    pub(crate) fn renew(&mut self, grains: &Grains, reach: f64, marks: &mut Vec<bool>) {
        let whole = 0.5 * self.margin;
        let is_spent = |left: &f64| *left < 0.5 * whole;
        let n_spent = self.left.iter().filter(|left| is_spent(left)).count();
        marks.clear();
        if 4 * n_spent > self.left.len() {
            marks.resize(self.left.len(), true);
            self.left.fill(whole);
            return;
        }
        marks.resize(self.left.len(), false);
        let extents: Vec<Extent> =
            (0..self.left.len()).map(|block| Extent::of_block(grains, block)).collect();
        for (spent, left) in extents.iter().zip(&mut self.left).filter(|(_, left)| is_spent(left)) {
            for (mark, extent) in marks.iter_mut().zip(&extents) {
                *mark |= extent.is_near(spent, reach, &grains.period);
            }
            *left = whole;
        }
    }
}

/// The smallest box that holds the centres of some grains (m).
#[derive(Clone, Copy, Debug)]
struct Extent {
    centre: Vec3,
    half: Vec3,
}

impl Extent {
    /// Around the grains of a block.
    fn of_block(grains: &Grains, block: usize) -> Self {
        let first = grains.drifted(block * BLOCK);
        let others = block * BLOCK + 1..((block + 1) * BLOCK).min(grains.len());
        let (low, high) = others
            .map(|i| grains.drifted(i))
            .fold((first, first), |(low, high), x| (low.inf(&x), high.sup(&x)));
        Self { centre: 0.5 * (low + high), half: 0.5 * (high - low) }
    }

    /// Whether a point of one box may be nearer than `reach` (m) to one of the other, or to an image of it.
    fn is_near(&self, other: &Self, reach: f64, period: &Period) -> bool {
        let apart = period.shortest(self.centre - other.centre).abs() - self.half - other.half;
        apart.max() < reach
    }
}

/// The cells along one axis.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct CellAxis {
    from: f64,
    inverse_width: f64,
    /// How many.
    pub(crate) n: usize,
    wraps: bool,
}

impl CellAxis {
    /// Cells of `width` (m) or a little less than twice that from `from` over `length` (m); they tile an
    /// axis that repeats after just that length.
    pub(crate) fn new(from: f64, length: f64, width: f64, period: Option<f64>) -> Self {
        match period {
            Some(period) => {
                let n = ((period / width) as usize).max(1);
                Self { from: 0.0, inverse_width: n as f64 / period, n, wraps: true }
            }
            None => {
                let n = ((length / width) as usize).saturating_add(1);
                Self { from, inverse_width: 1.0 / width, n, wraps: false }
            }
        }
    }

    /// The cell of the coordinate `at` (m).
    pub(crate) fn cell(&self, at: f64) -> usize {
        (((at - self.from) * self.inverse_width) as usize).min(self.n - 1)
    }

    /// The cells next to `cell` and itself, each once, in at most two runs.
    pub(crate) fn around(&self, cell: usize) -> [Range<usize>; 2] {
        let last = self.n - 1;
        match self.wraps {
            // Fewer than three are all next to each other.
            true if self.n < 3 => [0..self.n, 0..0],
            true if cell == 0 => [0..2, last..self.n],
            true if cell == last => [last - 1..self.n, 0..1],
            _ => [cell.saturating_sub(1)..(cell + 2).min(self.n), 0..0],
        }
    }
}

/// Grains sorted into square (cubic) cells as wide as the reach of the largest grain, or a little wider
/// where they tile a side that repeats.
#[derive(Clone, Debug, Default)]
pub(crate) struct CellGrid {
    axes: [CellAxis; 3],
    /// Where the grains of each cell begin in `members`.
    starts: Vec<u32>,
    members: Vec<u32>,
}

impl CellGrid {
    /// Sorts the grains into cells of at least `reach` (m), the largest distance of centres that
    /// counts as near.
    pub(crate) fn fill(&mut self, grains: &Grains, reach: f64) {
        let positions = || (0..grains.len()).map(|i| grains.drifted(i));
        let mut low = grains.drifted(0);
        let mut high = low;
        for position in positions() {
            low = low.inf(&position);
            high = high.sup(&position);
        }
        let extent = high - low;
        // A grain thrown far out must not cost memory: wider cells are slower, never wrong.
        let mut width = reach;
        loop {
            let axis = |axis: usize| {
                CellAxis::new(low[axis], extent[axis], width, grains.period.length(axis))
            };
            let y = match grains.space {
                Space::Planar => CellAxis::new(0.0, 0.0, width, None),
                Space::Spatial => axis(1),
            };
            self.axes = [axis(0), y, axis(2)];
            let product = self.axes.iter().try_fold(1_usize, |all, axis| all.checked_mul(axis.n));
            if product.is_some_and(|product| product <= 4 * grains.len() + 64) {
                break;
            }
            width *= 1.5;
        }

        let axes = self.axes;
        let n = axes.map(|axis| axis.n);
        let cell_of = |position: Vec3| {
            let [x, y, z] = cell(&axes, position);
            (z * n[1] + y) * n[0] + x
        };
        // Two places behind its cell, a count becomes the place that is filled next, and so in the
        // end the start of the cell after.
        let n_cells = n.iter().product::<usize>();
        self.starts.clear();
        self.starts.resize(n_cells + 2, 0);
        for cell in positions().map(cell_of) {
            self.starts[cell + 2] += 1;
        }
        for cell in 2..n_cells + 2 {
            self.starts[cell] += self.starts[cell - 1];
        }
        self.members.clear();
        self.members.resize(grains.len(), 0);
        for (grain, cell) in positions().map(cell_of).enumerate() {
            let next = &mut self.starts[cell + 1];
            self.members[*next as usize] = grain as u32;
            *next += 1;
        }
    }

    /// How many cells there are along each axis.
    #[cfg(test)]
    pub(crate) fn cells(&self) -> [usize; 3] {
        self.axes.map(|axis| axis.n)
    }

    /// Appends to `keys` every pair (i, j) of the grains `own` with j > i whose gap is below `margin` (m), in
    /// ascending order.
    pub(crate) fn pairs_of(
        &self,
        grains: &Grains,
        own: Range<usize>,
        margin: f64,
        neighbourhood: &mut Neighbourhood,
        keys: &mut Vec<[u32; 2]>,
    ) {
        match grains.space {
            Space::Planar => self.pairs_in::<Planar, 1>(grains, own, margin, neighbourhood, keys),
            Space::Spatial => self.pairs_in::<Spatial, 3>(grains, own, margin, neighbourhood, keys),
        }
    }

    fn pairs_in<D: Dimension<N>, const N: usize>(
        &self,
        grains: &Grains,
        own: Range<usize>,
        margin: f64,
        neighbourhood: &mut Neighbourhood,
        keys: &mut Vec<[u32; 2]>,
    ) {
        let (first, mut gathered) = (own.start as u32, None);
        for i in own {
            // Grains that follow each other in memory often share a cell.
            let cell = cell(&self.axes, D::position(grains.place(i)));
            if gathered != Some(cell) {
                self.gather(grains, cell, first, neighbourhood);
                gathered = Some(cell);
            }
            let from = keys.len();
            let here = [grains.place(i); MOST_LANES];
            let i = i as u32;
            let Neighbourhood { members, places } = &*neighbourhood;
            for (members, places) in members.chunks(MOST_LANES).zip(places.chunks(MOST_LANES)) {
                let n = members.len();
                let there = per_lane(|lane| &places[lane.min(n - 1)]);
                let near = D::are_near::<Eight>(&here, &there, &grains.period, margin);
                let mut near = near.bits() & ((1 << n) - 1);
                while near != 0 {
                    let j = members[near.trailing_zeros() as usize];
                    near &= near - 1;
                    // Without a branch: every other j is below i, nobody knows which.
                    keys.push([i, j]);
                    keys.truncate(keys.len() - usize::from(j <= i));
                }
            }
            keys[from..].sort_unstable();
        }
    }

    /// Puts side by side what lies in `cell` and in those next to it, from grain `first` on.
    fn gather(
        &self,
        grains: &Grains,
        cell: [usize; 3],
        first: u32,
        neighbourhood: &mut Neighbourhood,
    ) {
        let Neighbourhood { members, places } = neighbourhood;
        members.clear();
        let [n_x, n_y, _] = self.axes.map(|axis| axis.n);
        let around = |axis: usize| self.axes[axis].around(cell[axis]);
        for z in around(2).into_iter().flatten() {
            for y in around(1).into_iter().flatten() {
                let row = (z * n_y + y) * n_x;
                for xs in around(0) {
                    let [from, to] = [xs.start, xs.end].map(|x| self.starts[row + x] as usize);
                    members
                        .extend(self.members[from..to].iter().filter(|member| **member >= first));
                }
            }
        }
        places.clear();
        places.extend(members.iter().map(|&member| *grains.place(member as usize)));
    }
}

/// The cell of `position` (m) along each of `axes`.
fn cell(axes: &[CellAxis; 3], position: Vec3) -> [usize; 3] {
    [0, 1, 2].map(|axis| axes[axis].cell(position[axis]))
}

/// The grains that lie in a cell and in those next to it.
#[derive(Debug, Default)]
pub(crate) struct Neighbourhood {
    members: Vec<u32>,
    /// Where they are, side by side.
    places: Vec<Quad>,
}

/// Puts neighbours in space near each other in memory: by cell along a Morton curve, then by identity.
pub(crate) fn sort_in_space(space: Space, grains: &mut [Grain]) {
    let low =
        grains.iter().fold(Vec3::repeat(f64::INFINITY), |low, grain| low.inf(&grain.position));
    let width = 2.0 * grains.iter().fold(0.0, |largest: f64, grain| largest.max(grain.radius));
    let axes: &[usize] = match space {
        Space::Planar => &[0, 2],
        Space::Spatial => &[0, 1, 2],
    };
    let curve = |grain: &Grain| {
        let offset = (grain.position - low) / width;
        axes.iter().enumerate().fold(0, |key, (shift, &axis)| {
            key | interleave(offset[axis] as u32, axes.len()) << shift
        })
    };
    grains.sort_by_cached_key(|grain| (curve(grain), grain.id));
}

/// The low 20 bits of `coordinate`, `stride` places apart.
fn interleave(coordinate: u32, stride: usize) -> u64 {
    (0..20).fold(0, |key, bit| key | u64::from(coordinate >> bit & 1) << (bit * stride))
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::bed::random;
    use crate::grains::Grain;

    const MARGIN: f64 = 1e-3;

    /// Grains anywhere in a cube of a tenth of a metre, the largest `ratio` times the smallest.
    fn scattered(space: Space, ratio: f64, seed: u64) -> Grains {
        let mut rng = random(seed, "scattered");
        let list: Vec<Grain> = (0..400)
            .map(|id| {
                let mut number = || rng.random::<f64>();
                let place = Vec3::new(number(), number(), number()) * 0.1;
                let is_large = number() < 0.05;
                let small = 0.01 / ratio;
                Grain {
                    position: match space {
                        Space::Planar => Vec3::new(place.x, 0.0, place.z),
                        Space::Spatial => place,
                    },
                    velocity: Vec3::zeros(),
                    spin: Vec3::zeros(),
                    radius: if is_large { 0.01 } else { small * (0.5 + 0.5 * number()) },
                    mass: 1.0,
                    id,
                }
            })
            .collect();
        Grains::new(space, &list)
    }

    fn all_pairs(grains: &Grains) -> Vec<[u32; 2]> {
        let near = |i: usize, j: usize| {
            let reach = grains.radius(i) + grains.radius(j) + MARGIN;
            (grains.position(i) - grains.position(j)).norm_squared() < reach * reach
        };
        let n = grains.len();
        let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
        pairs.filter(|&(i, j)| near(i, j)).map(|(i, j)| [i as u32, j as u32]).collect()
    }

    #[test]
    fn the_grid_lists_the_pairs_that_a_look_at_all_pairs_lists() {
        for space in [Space::Planar, Space::Spatial] {
            for (seed, ratio) in [(1, 1.0), (2, 10.0), (3, 100.0)] {
                let grains = scattered(space, ratio, seed);
                let mut grid = CellGrid::default();
                grid.fill(&grains, 0.02 + MARGIN);
                let mut found = Vec::new();
                let mut neighbourhood = Neighbourhood::default();
                grid.pairs_of(&grains, 0..grains.len(), MARGIN, &mut neighbourhood, &mut found);
                assert!(found.len() > 20, "{} pairs are few", found.len());
                assert!(found == all_pairs(&grains), "{space:?}, ratio {ratio}");
            }
        }
    }
}
