//! A bed of grains in a container: the state, and the phases that [`crate::step`] puts in order.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::at_walls::ContactsAtWalls;
use crate::body::{Mechanism, Part};
use crate::boundary::{Absorber, Container};
use crate::contact::Partner;
use crate::contact::table::ContactTable;
use crate::contacts::stage::ContactStage;
use crate::contacts::{Contacts, Memory, SavedBlock, Tally};
use crate::dimension::{Dimension, Planar, Spatial, Stride};
use crate::error::StepError;
use crate::footprint::Footprint;
use crate::grain_force::{
    self, GrainForce, GrainForces, Surrounding, TakenByForces, sphere_radius,
};
use crate::grain_pass::{GrainPass, SumsOfGrains};
use crate::grains::{Grain, Grains};
use crate::ledger::{ChannelKind, Term, TermKind};
use crate::math::Vec3;
use crate::neighbours::{
    BlockFreshness, CellGrid, Freshness, close_margin, pair_margin, sort_in_space,
};
use crate::parallel::BLOCK;
use crate::recessive::RecessiveWork;
use crate::space::Space;
use crate::surface::Placement;

/// Gap up to which grains are listed as near the intruder, in mean grain diameters.
const INTRUDER_MARGIN: f64 = 0.4;

/// The way of an intruder in a step that is surely short enough, in radii of the smallest grain.
const SAFE_WAY: f64 = 0.1;

/// The account of a drive that moves the intruder.
const DRIVE: &str = "drive";

/// A bed of grains under gravity.
pub struct GrainBed {
    /// The grains.
    pub grains: Grains,
    /// (m/s²).
    pub gravity: Vec3,
    container: Container,
    absorber: Option<Absorber>,
    forces: GrainForces,
    /// What those of a fluid took from the intruder in the last step (J).
    taken_of_intruder: TakenByForces,
    walls: Vec<Part>,
    recessive: RecessiveWork,
    contacts: Contacts,
    at_walls: ContactsAtWalls,
    sums: Tally,
    sums_of_grains: Vec<SumsOfGrains>,
    grid: CellGrid,
    pair_lists: BlockFreshness,
    intruder_list: Freshness,
    /// Blocks that are listed again.
    marks: Vec<bool>,
    /// Greatest speed of a grain of each block in the drift that has begun (m/s).
    fastest: Vec<f64>,
    /// Radius of the smallest grain (m).
    smallest: f64,
}

/// Everything of a bed that changes during a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct SavedBed {
    grains: Grains,
    blocks: Vec<SavedBlock>,
    pair_lists: BlockFreshness,
    intruder_list: Freshness,
    fastest: Vec<f64>,
    recessive: RecessiveWork,
    at_walls: ContactTable,
}

/// A bed at rest as it is stored: grains in the order of memory, and what their contacts remember.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RestingBed {
    /// Discs or spheres.
    pub space: Space,
    /// The grains.
    pub grains: Vec<Grain>,
    /// Names of the stages whose histories are remembered.
    stages: Vec<String>,
    memories: Vec<Memory>,
}

impl RestingBed {
    /// A bed that nobody has touched yet: grains without contact histories, put in spatial order.
    pub fn without_history(space: Space, mut grains: Vec<Grain>) -> Self {
        sort_in_space(space, &mut grains);
        Self { space, grains, stages: Vec::new(), memories: Vec::new() }
    }
}

impl RestingBed {
    /// Whether it has `n` grains, all of them finite and of some size, for a bed read from a file.
    pub fn is_sound(&self, n: u64) -> bool {
        n > 0 && self.grains.len() as u64 == n && self.grains.iter().all(Grain::is_sound)
    }
}

impl GrainBed {
    /// The bed `resting` in `container`, under the laws `stages`, ready for an intruder of
    /// `n_intruder_parts` convex parts. The laws act in the order of their slots.
    ///
    /// # Panics
    /// If there are no grains.
    pub fn new(
        resting: &RestingBed,
        container: Container,
        gravity: Vec3,
        mut stages: Vec<Box<dyn ContactStage>>,
        n_intruder_parts: usize,
    ) -> Self {
        assert!(!resting.grains.is_empty(), "a bed has grains");
        stages.sort_by_key(|stage| stage.slot());
        let mut grains = Grains::new(resting.space, &resting.grains);
        grains.period = container.period(resting.space);
        grains.wrap();
        let walls: Vec<Part> = container
            .walls(resting.space)
            .into_iter()
            .map(|surface| Part { surface, placement: Placement::fixed(), partner: Partner::Wall })
            .collect();
        let mean_diameter = grains.mean_diameter();
        let n_parts = walls.len() + n_intruder_parts;
        let n_blocks = grains.len().div_ceil(BLOCK);
        let close = close_margin(resting.space).map(|margin| margin * mean_diameter);
        let contacts = Contacts::new(stages, (grains.space, grains.len()), n_parts, close);
        let mut bed = Self {
            gravity,
            absorber: container.absorber(resting.space),
            container,
            forces: GrainForces::new(),
            taken_of_intruder: TakenByForces::default(),
            recessive: RecessiveWork::new(n_intruder_parts),
            sums: contacts.no_sums(),
            at_walls: ContactsAtWalls::new(&contacts, grains.space, n_intruder_parts, walls.len()),
            contacts,
            sums_of_grains: vec![SumsOfGrains::default(); n_blocks],
            grid: CellGrid::default(),
            pair_lists: BlockFreshness::stale(pair_margin(resting.space) * mean_diameter, n_blocks),
            intruder_list: Freshness::stale(INTRUDER_MARGIN * mean_diameter),
            marks: Vec::new(),
            fastest: vec![0.0; n_blocks],
            smallest: grains.radii().fold(f64::INFINITY, f64::min),
            walls,
            grains,
        };
        bed.list_pairs_and_walls();
        bed.contacts.remember(&resting.memories, &resting.stages);
        bed
    }

    /// The same bed with `forces` on its single grains.
    ///
    /// # Panics
    /// If there are more than [`MOST_FORCES`](grain_force::MOST_FORCES).
    #[must_use]
    pub fn with_forces(self, forces: impl IntoIterator<Item = Box<dyn GrainForce>>) -> Self {
        Self { forces: forces.into_iter().collect(), ..self }
    }

    /// The same bed with grains whose moment of inertia is `coefficient` m r²: 0.4 in a plane for discs that turn
    /// as spheres do.
    #[must_use]
    pub fn with_grain_inertia(mut self, coefficient: f64) -> Self {
        self.grains.set_inertia(coefficient);
        self
    }

    /// The container.
    pub fn container(&self) -> &Container {
        &self.container
    }

    /// The image of `point` that lies between periodic sides.
    pub fn image_inside(&self, point: Vec3) -> Vec3 {
        self.grains.period.inside(point)
    }

    /// The laws, in the order in which they act.
    pub fn stages(&self) -> &[Box<dyn ContactStage>] {
        self.contacts.stages()
    }

    /// The bed as it stands, to be stored.
    pub fn resting(&self) -> RestingBed {
        RestingBed {
            space: self.grains.space,
            grains: self.grains.iter().collect(),
            stages: self.stages().iter().map(|stage| stage.name().to_owned()).collect(),
            memories: self.contacts.memories(),
        }
    }

    /// Mean number of contacts of a grain, walls counted, the intruder not.
    pub fn coordination(&self) -> f64 {
        let (pairs, surfaces) = self.contacts.count();
        let walls: usize = surfaces[..self.walls.len()].iter().sum();
        (2 * pairs + walls) as f64 / self.grains.len() as f64
    }

    /// Indices of the grains of every contact between grains that overlap, the smaller first,
    /// ascending.
    pub fn touching_pairs(&self) -> Vec<[usize; 2]> {
        self.contacts.touching_pairs()
    }

    /// The first two grains, by identity, that overlap by more than `limit` radii of the smaller one,
    /// and their overlap (m).
    pub fn pair_deeper_than(&self, limit: f64) -> Option<([u32; 2], f64)> {
        let (grains, id) = (&self.grains, &self.grains.id);
        self.contacts.listed_pairs().find_map(|[i, j]| {
            let radii = [i, j].map(|grain| grains.radius(grain));
            let overlap = radii[0] + radii[1] - grains.apart(i, j).norm();
            (overlap > limit * radii[0].min(radii[1])).then(|| {
                let (a, b) = (id[i].min(id[j]), id[i].max(id[j]));
                ([a, b], overlap)
            })
        })
    }

    /// Goes on in steps of `dt` (s).
    pub(crate) fn change_step(&mut self, dt: f64) {
        self.grains.change_step(dt);
        self.fastest = self.grains.fastest_by_block();
    }

    /// Adds `velocity` (m/s) to that of every grain.
    pub(crate) fn throw(&mut self, velocity: Vec3) {
        self.grains.throw(velocity);
        self.fastest = self.grains.fastest_by_block();
    }

    /// Leaves every grain the share `left` (–), at most 1, of its velocity and of its spin.
    pub(crate) fn slow_down(&mut self, left: f64) {
        // What was fastest bounds what is slower now.
        self.grains.slow_down(left);
    }

    /// Has laws book no energies from now on.
    pub(crate) fn book_nothing(&mut self) {
        self.contacts.book_nothing();
        self.at_walls.book_nothing();
    }

    /// Lists neighbours again where the lists may have become stale.
    pub(crate) fn refresh_neighbours(&mut self, intruder: &dyn Mechanism, dt: f64) {
        let displacements = self.fastest.iter().map(|fastest| fastest * dt);
        if self.pair_lists.spend(displacements) {
            self.list_pairs_and_walls();
        }
        let parts = intruder.parts();
        let fastest = self.fastest.iter().copied().fold(0.0, f64::max);
        let approach = parts
            .iter()
            .map(|part| part.placement.max_speed(part.surface.bounding_radius()))
            .fold(fastest, |approach, speed| approach.max(fastest + speed));
        if self.intruder_list.spend(approach * dt) {
            let largest = self.grains.radii().fold(0.0, f64::max);
            let reach = self.contacts.reach(Partner::Intruder, largest);
            let margin = self.intruder_list.margin() + reach;
            self.marks.clear();
            self.marks.resize(self.fastest.len(), true);
            for (k, part) in parts.iter().enumerate() {
                let index = self.walls.len() + k;
                self.contacts.list_surface(&self.grains, (index, part), margin, &self.marks);
            }
            self.intruder_list.renew();
        }
    }

    fn list_pairs_and_walls(&mut self) {
        let largest = self.grains.radii().fold(0.0, f64::max);
        let margin = self.pair_lists.margin() + self.contacts.reach(Partner::Grain, 0.5 * largest);
        let wall_margin = self.pair_lists.margin() + self.contacts.reach(Partner::Wall, largest);
        let reach = 2.0 * largest + margin;
        self.pair_lists.renew(&self.grains, reach, &mut self.marks);
        self.grid.fill(&self.grains, reach);
        self.contacts.list_pairs(&self.grains, &self.grid, margin, &self.marks);
        for (index, wall) in self.walls.iter().enumerate() {
            self.contacts.list_surface(&self.grains, (index, wall), wall_margin, &self.marks);
        }
    }

    /// Finds what touches and lets the laws act; forces that cross blocks are still to be gathered.
    pub(crate) fn evaluate_contacts(&mut self, intruder: &dyn Mechanism, dt: f64) {
        let parts = [&self.walls[..], intruder.parts()];
        self.contacts.evaluate(&self.grains, &self.fastest, parts, dt);
        self.contacts.sum(&mut self.sums);
        let who = (self.grains.space, &self.walls[..], intruder.parts());
        self.at_walls.evaluate(&self.contacts, who, dt, &mut self.sums);
        self.recessive.book(intruder.parts(), &self.sums.unfelt[self.walls.len()..], dt);
    }

    /// The fluid that the forces of this bed put around a body of `volume` (m³).
    pub fn fluid_around(&self, volume: f64) -> Surrounding {
        grain_force::surrounding(&self.forces, sphere_radius(volume))
    }

    /// Hands the load of the bed, of the fluid in it and of gravity to the intruder, at the end of a step of `dt` (s).
    pub(crate) fn load_intruder(&mut self, intruder: &mut dyn Mechanism, dt: f64) {
        let wrenches = &mut self.sums.wrenches[self.walls.len()..];
        self.taken_of_intruder =
            grain_force::immerse(intruder, wrenches, &self.forces, self.gravity, dt);
        intruder.load(wrenches, self.gravity);
    }

    /// Ends a step for each grain: adds the forces from other blocks and gravity, applies the second half of the kick, books
    /// the energy. Then it begins the next step with half a kick and the drift.
    pub(crate) fn kick_drift(&mut self, stride: &Stride) {
        match self.grains.space {
            Space::Planar => self.kick_drift_in::<Planar, 1>(stride),
            Space::Spatial => self.kick_drift_in::<Spatial, 3>(stride),
        }
        self.grains.set_ahead(stride.drift);
        for (fastest, sums) in self.fastest.iter_mut().zip(&self.sums_of_grains) {
            *fastest = sums.fastest_2.sqrt();
        }
    }

    fn kick_drift_in<D: Dimension<N>, const N: usize>(&mut self, stride: &Stride) {
        let contacts = &self.contacts;
        let pass = GrainPass {
            gravity: self.gravity,
            period: self.grains.period,
            absorber: self.absorber.as_ref(),
            forces: &self.forces,
            inertia_coefficient: self.grains.inertia_coefficient(),
            stride: *stride,
        };
        self.grains.par_blocks::<D, N>().zip(&mut self.sums_of_grains).for_each(|(block, sums)| {
            let loads = contacts.loads(block.block);
            *sums = pass.over::<D, N>(block, loads);
        });
    }

    fn has_recessive(&self, intruder: &dyn Mechanism) -> bool {
        intruder.parts().iter().any(|part| part.surface.is_recessive())
    }

    /// The terms of the ledger of this bed with `intruder`: motion, gravity, the channels of the laws,
    /// then those of the boundaries and of a drive.
    pub fn terms(&self, intruder: &dyn Mechanism) -> Vec<Term> {
        let kinetic = |name: &'static str| Term { name: name.into(), kind: TermKind::Kinetic };
        let potential = |name: &'static str| Term { name: name.into(), kind: TermKind::Potential };
        let mut terms = vec![
            kinetic("intruder-translation"),
            kinetic("intruder-rotation"),
            kinetic("grains-translation"),
            kinetic("grains-rotation"),
            potential("intruder"),
            potential("grains"),
        ];
        terms.extend(self.stages().iter().flat_map(|stage| stage.channels()).map(|channel| Term {
            name: channel.name.into(),
            kind: TermKind::Channel(channel.kind),
        }));
        let channel = |name: &'static str, kind: ChannelKind| Term {
            name: name.into(),
            kind: TermKind::Channel(kind),
        };
        terms.push(channel("walls", ChannelKind::Dissipated));
        if self.absorber.is_some() {
            terms.push(channel("absorbing-boundary", ChannelKind::Dissipated));
        }
        terms.extend(grain_force::terms(&self.forces));
        if self.has_recessive(intruder) {
            terms.push(channel("recessive-wall", ChannelKind::Input));
        }
        if intruder.drive_work().is_some() {
            terms.push(channel(DRIVE, ChannelKind::Input));
        }
        terms
    }

    /// What the ledger is to hold for each term of [`GrainBed::terms`] after this step.
    pub(crate) fn entries(&self, intruder: &dyn Mechanism, entries: &mut Vec<f64>) {
        let mut bodies = [0.0; 3];
        for body in intruder.bodies() {
            let [translation, rotation] = body.kinetic_energy();
            bodies[0] += translation;
            bodies[1] += rotation;
            let borne = self.fluid_around(body.volume).displaced_mass;
            bodies[2] -= (body.mass - borne) * self.gravity.dot(&body.position);
        }
        let grains =
            self.sums_of_grains.iter().fold(SumsOfGrains::default(), |sum, block| SumsOfGrains {
                translation: sum.translation + block.translation,
                rotation: sum.rotation + block.rotation,
                potential: sum.potential + block.potential,
                absorbed: sum.absorbed + block.absorbed,
                taken: std::array::from_fn(|k| sum.taken[k] + block.taken[k]),
                moving: sum.moving + block.moving,
                fastest_2: sum.fastest_2.max(block.fastest_2),
            });
        entries.clear();
        entries.extend([bodies[0], bodies[1], grains.translation, grains.rotation]);
        entries.extend([bodies[2], grains.potential]);
        let channels = self.contacts.stages().iter().flat_map(|stage| stage.channels());
        let mut walls = 0.0;
        for ((channel, &energy), &at_walls) in
            channels.zip(&self.sums.energy).zip(&self.sums.wall_energy)
        {
            // What springs at walls hold is elastic energy like any other; what walls dissipate has
            // an account of its own.
            if channel.kind == ChannelKind::Dissipated {
                walls += at_walls;
                entries.push(energy);
            } else {
                entries.push(energy + at_walls);
            }
        }
        entries.push(walls);
        if self.absorber.is_some() {
            entries.push(grains.absorbed);
        }
        let taken = grains.taken.iter().zip(&self.taken_of_intruder);
        entries.extend(taken.take(self.forces.len()).map(|(grains, intruder)| grains + intruder));
        if self.has_recessive(intruder) {
            entries.push(self.recessive.work());
        }
        entries.extend(intruder.drive_work());
    }

    /// What grains cover of each part of the intruder, as of the last step.
    pub fn footprints(&self) -> &[Footprint] {
        &self.sums.footprints[self.walls.len()..]
    }

    /// Share of the grains that move: whose kinetic energy would lift them by more than a hundredth of
    /// their diameter (–). It is γ of the three-shape manuscript, the share that takes part in dissipation.
    pub fn moving_share(&self) -> f64 {
        // Without weight nothing has to be lifted: then every grain with any energy moves.
        let moving: u32 = self.sums_of_grains.iter().map(|block| block.moving).sum();
        f64::from(moving) / self.grains.len() as f64
    }

    /// Kinetic energy of all grains (J).
    pub fn kinetic_energy(&self) -> f64 {
        self.sums_of_grains.iter().map(|block| block.translation + block.rotation).sum()
    }

    /// Mean energy (J) of what of a grain's motion comes to rest by itself: in a plane all of it, in space
    /// the translation. A sphere that spins about the normal of its only contact is stopped by nothing
    /// but a law of twisting.
    pub(crate) fn mean_restless_energy(&self) -> f64 {
        let restless = match self.grains.space {
            Space::Planar => self.kinetic_energy(),
            Space::Spatial => self.sums_of_grains.iter().map(|block| block.translation).sum(),
        };
        restless / self.grains.len() as f64
    }

    /// Whether each grain touches another or a wall, in the order of memory.
    pub fn lying(&self) -> Vec<bool> {
        self.contacts.lying(self.grains.len(), self.walls.len())
    }

    /// Whether the step can be trusted.
    pub(crate) fn check(&self, step: u64, dt: f64) -> Result<(), StepError> {
        let total: f64 =
            self.sums_of_grains.iter().map(|block| block.translation + block.potential).sum();
        if !total.is_finite() {
            return Err(StepError::NotFinite { step, what: "the energy of the grains", dt });
        }
        if self.sums.overlap.relative > 1.0 {
            let (overlap, grain) = self.largest_overlap();
            let radius = overlap / self.sums.overlap.relative;
            return Err(StepError::OverlapTooLarge { step, grain, overlap, radius, dt });
        }
        let in_wall = self.at_walls.deepest();
        if in_wall.relative > 1.0 {
            let wall = if in_wall.wall == 0 { "floor" } else { "side" };
            let (overlap, radius) = (in_wall.overlap, in_wall.overlap / in_wall.relative);
            return Err(StepError::IntruderInWall { step, wall, overlap, radius, dt });
        }
        Ok(())
    }

    /// Whether no point of the intruder may have gone past a grain unseen: farther in the step than the
    /// radius of the smallest.
    pub(crate) fn check_way(
        &self,
        intruder: &dyn Mechanism,
        step: u64,
        dt: f64,
    ) -> Result<(), StepError> {
        let speeds = intruder
            .parts()
            .iter()
            .map(|part| part.placement.max_speed(part.surface.bounding_radius()));
        let speed = speeds.fold(0.0, f64::max);
        if speed * dt <= self.smallest {
            return Ok(());
        }
        let radius = self.smallest;
        let suggested_dt = SAFE_WAY * radius / speed;
        Err(StepError::IntruderTooFast { step, speed, way: speed * dt, radius, dt, suggested_dt })
    }

    /// How many contacts the intruder has with walls.
    pub fn intruder_wall_contacts(&self) -> usize {
        self.at_walls.n_touching()
    }

    /// The largest overlap in units of the smaller radius (m), and the identity of a grain that has it.
    pub fn largest_overlap(&self) -> (f64, u32) {
        let deepest = self.sums.overlap;
        (deepest.overlap, self.grains.id[deepest.grain as usize])
    }

    pub(crate) fn save(&self) -> SavedBed {
        SavedBed {
            grains: self.grains.clone(),
            blocks: self.contacts.save(),
            pair_lists: self.pair_lists.clone(),
            intruder_list: self.intruder_list,
            fastest: self.fastest.clone(),
            recessive: self.recessive.clone(),
            at_walls: self.at_walls.save(),
        }
    }

    /// Takes back a saved state; `false` if it does not fit.
    pub(crate) fn restore(&mut self, saved: SavedBed) -> bool {
        let n = self.grains.len();
        let same_parts = saved.recessive.n_parts() == self.recessive.n_parts();
        if !same_parts
            || !saved.grains.is_consistent(n)
            || saved.pair_lists.n_blocks() != self.fastest.len()
            || saved.fastest.len() != self.fastest.len()
            || !self.at_walls.restore(saved.at_walls)
            || !self.contacts.restore(saved.blocks, (self.grains.space, n))
        {
            return false;
        }
        let period = self.grains.period;
        self.grains = saved.grains;
        self.grains.period = period;
        self.recessive = saved.recessive;
        self.pair_lists = saved.pair_lists;
        self.intruder_list = saved.intruder_list;
        self.fastest = saved.fastest;
        true
    }
}

#[cfg(test)]
mod tests;
