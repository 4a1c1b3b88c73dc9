//! What contacts add up to in a step: those of one block, or all of a bed.

use crate::footprint::Footprint;
use crate::lanes::{Lanes, Mask};
use crate::surface::Wrench;

/// The largest overlap in units of the smaller radius.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Deepest {
    pub(crate) relative: f64,
    /// (m).
    pub(crate) overlap: f64,
    /// Index of the grain.
    pub(crate) grain: u32,
}

/// Sums over contacts.
#[derive(Debug)]
pub(crate) struct Tally {
    /// Per stage and channel: energies (J) of contacts between grains and with the intruder, held now or
    /// lost in this step; empty if nothing is booked.
    pub(crate) energy: Vec<f64>,
    /// The same for contacts with walls.
    pub(crate) wall_energy: Vec<f64>,
    /// Per part.
    pub(crate) wrenches: Vec<Wrench>,
    /// Per part: what grains do to it that its body does not feel.
    pub(crate) unfelt: Vec<Wrench>,
    /// Per part; empty for walls.
    pub(crate) footprints: Vec<Footprint>,
    pub(crate) overlap: Deepest,
}

impl Tally {
    pub(super) fn new(n_channels: usize, n_parts: usize) -> Self {
        Self {
            energy: vec![0.0; n_channels],
            wall_energy: vec![0.0; n_channels],
            wrenches: vec![Wrench::default(); n_parts],
            unfelt: vec![Wrench::default(); n_parts],
            footprints: vec![Footprint::default(); n_parts],
            overlap: Deepest::default(),
        }
    }

    pub(super) fn clear(&mut self) {
        self.energy.fill(0.0);
        self.wall_energy.fill(0.0);
        self.wrenches.fill(Wrench::default());
        self.unfelt.fill(Wrench::default());
        self.footprints.fill(Footprint::default());
        self.overlap = Deepest::default();
    }

    /// Adds those of `other`.
    pub(super) fn add(&mut self, other: &Self) {
        let energies =
            [(&mut self.energy, &other.energy), (&mut self.wall_energy, &other.wall_energy)];
        for (sums, parts) in energies {
            for (sum, part) in sums.iter_mut().zip(parts) {
                *sum += part;
            }
        }
        let wrenches = [(&mut self.wrenches, &other.wrenches), (&mut self.unfelt, &other.unfelt)];
        for (sums, parts) in wrenches {
            for (sum, part) in sums.iter_mut().zip(parts) {
                sum.add(part);
            }
        }
        for (sum, part) in self.footprints.iter_mut().zip(&other.footprints) {
            sum.add(part);
        }
        if other.overlap.relative > self.overlap.relative {
            self.overlap = other.overlap;
        }
    }

    /// Takes note of contacts of `grains`; `curvature` (1/m) is that of the smaller grain.
    #[inline(always)]
    pub(super) fn note_overlap<R: Lanes>(
        &mut self,
        overlap: R,
        curvature: R,
        grain: impl Fn(usize) -> u32,
    ) {
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
