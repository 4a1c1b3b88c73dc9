//! Contacts of the intruder with the walls of the container.
//!
//! There it is what a grain is: under the law of the model with the parameters for walls. The contact of
//! a body with faces and edges is in the points of its [`Feature`]s. They are few, so one thread evaluates
//! them, one after the other.

use arrayvec::ArrayVec;

use crate::body::Part;
use crate::contact::Partner;
use crate::contact::geometry::{Touch, load_on_part, with_wall};
use crate::contact::table::{ContactTable, Merger};
use crate::contacts::stage::{ContactStage, Sweep};
use crate::contacts::{Contacts, Evaluation, Tally, record_lens};
use crate::dimension::{Dimension, Planar, Spatial};
use crate::feature::Feature;
use crate::lanes::MOST_LANES;
use crate::math::{Quat, Vec3};
use crate::space::Space;
use crate::surface::Surface;

/// Room for the points of one part: a cylinder has two rims of three.
const POINTS: usize = 8;

/// Rounds of the search for the foremost point at a curved wall; each comes nearer by the square of the ratio of the
/// radii. A flat wall needs one.
const ROUNDS: usize = 16;

/// How deep a part is in a wall.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct InWall {
    /// Overlap times the curvature of the part (–).
    pub(crate) relative: f64,
    /// (m).
    pub(crate) overlap: f64,
    /// Index of the wall.
    pub(crate) wall: usize,
}

/// The contacts of all parts of an intruder with all walls.
pub(crate) struct ContactsAtWalls {
    /// Keyed by point of a part, then by wall; every one of them is listed.
    table: ContactTable,
    n_walls: usize,
    /// Per stage and channel (J), as in a tally; empty if nothing is booked.
    energy: Vec<f64>,
    deepest: InWall,
}

impl ContactsAtWalls {
    /// None that touches yet.
    pub(crate) fn new(contacts: &Contacts, space: Space, n_parts: usize, n_walls: usize) -> Self {
        let [_, of_surface] = record_lens(contacts.stages(), space);
        let mut table = ContactTable::new(&of_surface);
        let points = 0..(n_parts * POINTS) as u32;
        let keys: Vec<[u32; 2]> =
            points.flat_map(|point| (0..n_walls as u32).map(move |wall| [point, wall])).collect();
        table.rekey(&keys, &mut Merger::default());
        let energy = contacts.no_sums().energy;
        Self { table, n_walls, energy, deepest: InWall::default() }
    }

    /// Has laws book no energies from now on.
    pub(crate) fn book_nothing(&mut self) {
        self.energy.clear();
    }

    /// The deepest of them in the last step.
    pub(crate) fn deepest(&self) -> InWall {
        self.deepest
    }

    /// How many of them touch.
    pub(crate) fn n_touching(&self) -> usize {
        self.table.n_touching()
    }

    /// What is to be kept of them.
    pub(crate) fn save(&self) -> ContactTable {
        self.table.clone()
    }

    /// Takes back what [`Self::save`] gave; `false` if it does not fit.
    pub(crate) fn restore(&mut self, table: ContactTable) -> bool {
        let n_points = self.table.keys().len() / self.n_walls.max(1);
        let fits = table.keys().eq(self.table.keys())
            && table.is_consistent(0..n_points, self.n_walls, self.table.history_len());
        if fits {
            self.table = table;
        }
        fits
    }

    /// Lets the laws of `contacts` act where `parts` touch `walls`, and adds to `sums` what comes of it; where nothing
    /// touches, no bit of them changes. `dt` (s) is the step.
    pub(crate) fn evaluate(
        &mut self,
        contacts: &Contacts,
        (space, walls, parts): (Space, &[Part], &[Part]),
        dt: f64,
        sums: &mut Tally,
    ) {
        match space {
            Space::Planar => self.evaluate_in::<Planar, 1>(contacts, walls, parts, dt, sums),
            Space::Spatial => self.evaluate_in::<Spatial, 3>(contacts, walls, parts, dt, sums),
        }
    }

    fn evaluate_in<D: Dimension<N>, const N: usize>(
        &mut self,
        contacts: &Contacts,
        walls: &[Part],
        parts: &[Part],
        dt: f64,
        sums: &mut Tally,
    ) where
        dyn ContactStage: Sweep<f64, N>,
    {
        self.deepest = InWall::default();
        let any_touches = self.table.n_touching() > 0;
        for (index, part) in parts.iter().enumerate() {
            for (wall, Part { surface, .. }) in walls.iter().enumerate() {
                let gap = surface.closest(part.placement.position).gap;
                if any_touches || gap < part.surface.bounding_radius() {
                    let at = At { part: (index, part), wall: (wall, &**surface), dt };
                    self.meet::<D, N>(contacts.stages(), &at, sums);
                }
            }
        }
    }

    /// One part at one wall.
    fn meet<D: Dimension<N>, const N: usize>(
        &mut self,
        stages: &[Box<dyn ContactStage>],
        at: &At<'_>,
        sums: &mut Tally,
    ) where
        dyn ContactStage: Sweep<f64, N>,
    {
        let ((index, part), (wall, surface)) = (at.part, at.wall);
        let (n_walls, placement) = (self.n_walls, &part.placement);
        let mut point = index * POINTS;
        for feature in part.surface.features() {
            let now = touches(feature, surface, (placement.position, placement.orientation));
            let first = point;
            point += feature.n_points();
            let rows = (first..point).map(|point| point * n_walls + wall);
            let touches_now =
                |(touch, row): (&Touch, usize)| touch.gap < 0.0 || self.table.is_touching(row);
            if !now.iter().zip(rows).any(touches_now) {
                continue;
            }
            let half = (placement.position_half, placement.orientation_half);
            let half = touches(feature, surface, half);
            for (k, touches) in now.iter().zip(&half).enumerate() {
                let row = (first + k) * n_walls + wall;
                if touches.0.gap < 0.0 || self.table.is_touching(row) {
                    self.act::<D, N>(stages, at, (row, feature.curvature(), touches), sums);
                }
            }
        }
        debug_assert!(point <= (index + 1) * POINTS, "more points than there is room for");
    }

    /// One point of a part at one wall.
    fn act<D: Dimension<N>, const N: usize>(
        &mut self,
        stages: &[Box<dyn ContactStage>],
        at: &At<'_>,
        (row, curvature, touches): (usize, f64, (&Touch, &Touch)),
        sums: &mut Tally,
    ) where
        dyn ContactStage: Sweep<f64, N>,
    {
        let ((index, part), (wall, _)) = (at.part, at.wall);
        let record = self.table.record(row);
        let last = self.table.last_of_record(record);
        let before = (*last > 0.0).then_some(*last);
        let contact = with_wall(&part.placement, touches, curvature, before, at.dt);
        *last = if contact.overlaps() { contact.inverse_radius_eff } else { 0.0 };
        let mut evaluation = Evaluation::<f64, N>::new();
        evaluation.push(D::narrow(&contact), [record; MOST_LANES]);
        self.energy.fill(0.0);
        evaluation.evaluate(Partner::Wall, stages, at.dt, &mut self.table, &mut self.energy);
        for (sum, part) in sums.wall_energy.iter_mut().zip(&self.energy) {
            *sum += part;
        }
        let response = &evaluation.responses[0];
        if !(contact.overlaps() | response.holds) {
            self.table.open(row);
            return;
        }
        let response = D::widen(response, contact.normal);
        let wrench = load_on_part(&part.placement, touches.0, &contact, &response);
        sums.wrenches[self.n_walls + index].add(&wrench);
        let relative = contact.overlap * curvature;
        if relative > self.deepest.relative {
            self.deepest = InWall { relative, overlap: contact.overlap, wall };
        }
    }
}

/// A part of the intruder at a wall, each with its index, in a step of `dt` (s).
struct At<'a> {
    part: (usize, &'a Part),
    wall: (usize, &'a dyn Surface),
    dt: f64,
}

/// Where `feature` of a body at a place and in an orientation meets `wall`.
fn touches(
    feature: &Feature,
    wall: &dyn Surface,
    (position, orientation): (Vec3, Quat),
) -> ArrayVec<Touch, 3> {
    let in_world = |point: Vec3| position + orientation * point;
    let normal_at = |point: Vec3| wall.closest(in_world(point)).normal;
    let into_wall = |normal: Vec3| orientation.inverse_transform_vector(&-normal);
    // Each round finds the foremost point towards where the wall is nearest to the last one; what a hollow wall
    // leaves free is convex, so this never goes back.
    let mut normal = normal_at(feature.middle());
    for _ in 0..ROUNDS {
        let next = normal_at(feature.foremost(into_wall(normal)));
        if next == normal {
            break;
        }
        normal = next;
    }
    let points = feature.points(into_wall(normal));
    points
        .into_iter()
        .map(|point| {
            let point = in_world(point);
            let nearest = wall.closest(point);
            Touch { point, normal: nearest.normal, gap: nearest.gap, curvature: nearest.curvature }
        })
        .collect()
}
