//! A bed of grains, in SI.

use std::f64::consts::{FRAC_PI_4, FRAC_PI_6};
use std::path::PathBuf;
use std::sync::Arc;

use contact_laws::{GrainForceEntry, LawEntry};
use engine::bed::{SizeDistribution, container_bytes};
use engine::boundary::{self, Base, Bottom, Sides};
use engine::grains::Space;
use engine::params::ParamTable;

use super::Model;
use crate::diagnostics::Span;
use crate::grains_csv::CsvGrain;

/// A bed of grains in a container, under a contact law.
#[derive(Clone, Debug, PartialEq)]
pub struct GrainMedium {
    /// Discs in a plane or spheres in space.
    pub space: Space,
    /// Magnitude of gravity, downward (m/s²).
    pub gravity: f64,
    /// Moment of inertia of a grain over m r² during the impact; that of discs or spheres where it is `None`.
    pub grain_inertia: Option<f64>,
    /// `[container]`.
    pub container: Container,
    /// `[bed]`.
    pub bed: Bed,
    /// `[contact_law]`.
    pub contact_law: LawChoice,
    /// `[[effect]]` on contacts, in the order of the file.
    pub effects: Vec<LawChoice>,
    /// `[[effect]]` on single grains, in the order of the file.
    pub grain_forces: Vec<GrainForceChoice>,
    /// Where impacts start, from `[impact]`.
    pub start: StartPositions,
    /// The steps of `[run]`.
    pub stepping: Stepping,
    /// What of `[log]` has to do with steps and grains.
    pub log: GrainLog,
}

impl GrainMedium {
    /// Moment of inertia of a grain over m r² during the impact.
    pub fn inertia_coefficient(&self) -> f64 {
        self.grain_inertia.unwrap_or(self.space.inertia_coefficient())
    }
}

/// Where impacts on a bed of grains start.
#[derive(Clone, Debug, PartialEq)]
pub struct StartPositions {
    /// Where the centre of the intruder starts (m), if the file says so.
    pub x: Option<f64>,
    /// The same along the depth (m) of a bed in space.
    pub y: Option<f64>,
    /// Where drawn positions lie (m).
    pub x_range: (f64, f64),
}

/// How finely a bed of grains is integrated.
#[derive(Clone, Debug, PartialEq)]
pub struct Stepping {
    /// The step before [`Stepping::time_step_factor`].
    pub time_step: TimeStep,
    /// Multiplies the step, fixed or automatic.
    pub time_step_factor: f64,
    /// Steps between checkpoints.
    pub checkpoint_every: u64,
}

/// The time step as the file states it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TimeStep {
    /// This long (s).
    Fixed(f64),
    /// A fraction of the shortest collision.
    Auto,
}

/// What goes into the log of a bed of grains.
#[derive(Clone, Debug, PartialEq)]
pub struct GrainLog {
    /// Steps between flushes.
    pub flush_every: u64,
    /// Whether grains are logged at all.
    pub grains: bool,
    /// When the fields of the bed and its crater are logged (s).
    pub fields_at: Vec<f64>,
}

/// The container: x from 0 to `width`, in three dimensions y from 0 to `depth`, and up from its bottom
/// at 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Container {
    /// What it is from above.
    pub shape: ContainerShape,
    /// Inner width, or diameter (m).
    pub width: f64,
    /// Inner depth, or diameter (m); 0 in a plane.
    pub depth: f64,
    /// What its sides are.
    pub sides: SidesKind,
    /// What its bottom is.
    pub bottom: BottomKind,
    /// Thickness of the layers that absorb (m), if the file says so.
    pub absorbing_thickness: Option<f64>,
    /// Rate of their drag at the wall (1/s), if the file says so.
    pub absorbing_rate: Option<f64>,
}

/// The shape of a container from above.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContainerShape {
    /// A rectangle.
    Box,
    /// A circle.
    Cylinder,
}

/// The sides of a container.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SidesKind {
    /// Walls.
    Wall,
    /// What leaves on one side comes in on the other.
    Periodic,
    /// Walls behind a layer that absorbs.
    Absorbing,
}

/// The bottom of a container.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BottomKind {
    /// A wall.
    Wall,
    /// A wall below a layer that absorbs.
    Absorbing,
}

impl Container {
    /// The same to the engine, with plain walls where layers absorb.
    pub(crate) fn without_layers(&self) -> boundary::Container {
        let sides = match self.sides {
            SidesKind::Periodic => Sides::Periodic,
            SidesKind::Wall | SidesKind::Absorbing => Sides::Wall,
        };
        boundary::Container { base: self.base(), sides, bottom: Bottom::Wall }
    }

    /// What it is from above, to the engine.
    pub fn base(&self) -> Base {
        match self.shape {
            ContainerShape::Box => Base::Rectangle { width: self.width, depth: self.depth },
            ContainerShape::Cylinder => Base::Circle { diameter: self.width },
        }
    }
}

/// The grains at the start of the impact.
#[derive(Clone, Debug, PartialEq)]
pub struct Bed {
    /// Where they come from.
    pub source: BedSource,
    /// Packing fraction that the preparation should come near to.
    pub target_packing_fraction: Option<f64>,
    /// Height that the preparation should come near to (m).
    pub target_height: Option<f64>,
}

/// Where the grains come from.
#[derive(Clone, Debug, PartialEq)]
pub enum BedSource {
    /// Poured in and left to settle.
    Settle(Settle),
    /// Positions from a file.
    Csv(CsvBed),
}

/// Grains poured in and left to settle.
#[derive(Clone, Debug, PartialEq)]
pub struct Settle {
    /// The kinds of grains.
    pub grains: Vec<GrainKind>,
    /// Packing fraction up to which grains grow in place before they fall; they rain where it is `None`.
    pub inflated_to: Option<f64>,
    /// Friction while settling, in place of the law's; `None` when the law has no friction at all.
    pub preparation_friction: Option<f64>,
    /// Rate (1/s) at which velocities and spins decay while settling, as in a viscous fluid.
    pub settling_drag: f64,
    /// Step while settling.
    pub preparation_time_step: TimeStep,
    /// Effects that act while settling (`[[bed.effect]]`).
    pub effects: Vec<LawChoice>,
}

/// Grains of one material, equal or of many sizes.
#[derive(Clone, Debug, PartialEq)]
pub struct GrainKind {
    /// How many.
    pub count: u64,
    /// Their diameters.
    pub sizes: SizeDistribution,
    /// What follows a mass from a diameter.
    pub material: Material,
}

/// What the mass of a grain follows from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Material {
    /// It is given, for grains of one size (kg).
    Mass(f64),
    /// Mass per volume (kg/m³), or per area of a plane (kg/m²).
    Density(f64),
}

impl GrainKind {
    /// The mass (kg) of a grain of `diameter` (m).
    pub fn mass(&self, space: Space, diameter: f64) -> f64 {
        match self.material {
            Material::Mass(mass) => mass,
            Material::Density(density) => density * space.grain_content(diameter),
        }
    }

    /// The mass of all of them (kg), expected where sizes are drawn.
    pub fn total_mass(&self, space: Space) -> f64 {
        let one = match self.material {
            Material::Mass(mass) => mass,
            Material::Density(density) => density * self.content(space),
        };
        self.count as f64 * one
    }

    /// The mean volume of one (m³), or area (m²) in a plane.
    pub fn content(&self, space: Space) -> f64 {
        match space {
            Space::Planar => FRAC_PI_4 * self.sizes.moment(2),
            Space::Spatial => FRAC_PI_6 * self.sizes.moment(3),
        }
    }
}

/// Grains at given positions.
#[derive(Clone, Debug, PartialEq)]
pub struct CsvBed {
    /// The file, as an absolute path without symbolic links.
    pub file: PathBuf,
    /// The file as the model names it, relative to the model.
    pub named: String,
    /// blake3 of its content, in hexadecimal.
    pub blake3: String,
    /// Its grains.
    pub grains: Arc<[CsvGrain]>,
}

/// A law or effect of the registry and its parameters.
#[derive(Clone)]
pub struct LawChoice {
    /// The registry's entry.
    pub entry: &'static LawEntry,
    /// All its parameters (SI).
    pub params: ParamTable,
    /// Where the file names it.
    pub span: Span,
}

impl PartialEq for LawChoice {
    fn eq(&self, other: &Self) -> bool {
        self.entry.name == other.entry.name && self.params == other.params
    }
}

impl std::fmt::Debug for LawChoice {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("LawChoice").field(&self.entry.name).field(&self.params).finish()
    }
}

/// A force on single grains, of the registry, and its parameters.
#[derive(Clone)]
pub struct GrainForceChoice {
    /// The registry's entry.
    pub entry: &'static GrainForceEntry,
    /// All its parameters (SI).
    pub params: ParamTable,
    /// Where the file names it.
    pub span: Span,
}

impl PartialEq for GrainForceChoice {
    fn eq(&self, other: &Self) -> bool {
        self.entry.name == other.entry.name && self.params == other.params
    }
}

impl std::fmt::Debug for GrainForceChoice {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("GrainForceChoice").field(&self.entry.name).field(&self.params).finish()
    }
}

/// A model whose medium is a bed of grains.
#[derive(Clone, Copy, Debug)]
pub struct GrainModel<'a> {
    /// The whole model.
    pub model: &'a Model,
    /// Its medium.
    pub medium: &'a GrainMedium,
}

impl<'a> GrainModel<'a> {
    /// Canonical text of everything that the prepared bed depends on, and of nothing else.
    pub fn bed_key_text(&self) -> &'a str {
        &self.model.bed_key
    }

    /// The largest diameter of a grain (m).
    pub fn largest_grain(&self) -> f64 {
        let largest = |diameters: &mut dyn Iterator<Item = f64>| diameters.fold(0.0, f64::max);
        match &self.medium.bed.source {
            BedSource::Settle(settle) => {
                let kinds = settle.grains.iter().filter(|kind| kind.count > 0);
                largest(&mut kinds.map(|kind| kind.sizes.largest()))
            }
            BedSource::Csv(csv) => largest(&mut csv.grains.iter().map(|grain| 2.0 * grain.radius)),
        }
    }

    /// The smallest diameter of a grain (m).
    pub(crate) fn smallest_grain(&self) -> f64 {
        match &self.medium.bed.source {
            BedSource::Settle(settle) => {
                let kinds = settle.grains.iter().filter(|kind| kind.count > 0);
                kinds.map(|kind| kind.sizes.smallest()).fold(f64::INFINITY, f64::min)
            }
            BedSource::Csv(csv) => {
                csv.grains.iter().map(|grain| 2.0 * grain.radius).fold(f64::INFINITY, f64::min)
            }
        }
    }

    /// The mean diameter of the grains (m).
    pub fn mean_grain(&self) -> f64 {
        let sum: f64 = match &self.medium.bed.source {
            BedSource::Settle(settle) => {
                settle.grains.iter().map(|kind| kind.count as f64 * kind.sizes.moment(1)).sum()
            }
            BedSource::Csv(csv) => csv.grains.iter().map(|grain| 2.0 * grain.radius).sum(),
        };
        sum / self.n_grains() as f64
    }

    /// Memory (byte) that the size of the container asks for, however few the grains are.
    pub fn container_bytes(&self) -> f64 {
        let container = self.medium.container.without_layers();
        let diameters = [self.largest_grain(), self.mean_grain()];
        container_bytes((self.medium.space, &container), diameters)
    }

    /// How wide (m) a container is of which the grains cover the floor once: a planar one, or a square.
    pub fn width_of_a_layer(&self) -> f64 {
        let n = self.n_grains() as f64;
        let across = match self.medium.space {
            Space::Planar => n,
            Space::Spatial => n.sqrt(),
        };
        across * self.mean_grain()
    }

    /// Number of grains in the bed.
    pub fn n_grains(&self) -> u64 {
        match &self.medium.bed.source {
            BedSource::Settle(settle) => settle.grains.iter().map(|kind| kind.count).sum(),
            BedSource::Csv(csv) => csv.grains.len() as u64,
        }
    }
}
