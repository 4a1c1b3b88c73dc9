//! The intruder of a bed of grains, put where it just touches the bed.

use std::sync::Arc;

use engine::body::{Mechanism, RigidBody};
use engine::driven::Driven;
use engine::grain_bed::GrainBed;
use engine::grains::Space;
use engine::launch::height_in_touch;
use engine::math::{Quat, Vec3, turned_about_y};
use engine::surface::Surface;
use intruders::HingedLinks;

use crate::build::BuildError;
use crate::model::{Condition, Container, ContainerShape, GrainModel, SidesKind};

/// Length of the shaft of a recessive wall, in the height of the bed: grains that are thrown up do not
/// come over its top.
const SHAFT: f64 = 2.0;

/// One body of an intruder as it enters.
struct Entrant {
    surface: Arc<dyn Surface>,
    orientation: Quat,
    /// From the point that the position of the intruder says, to its centre of mass (m).
    offset: Vec3,
}

impl Entrant {
    /// How far it reaches along `direction` from the point that the position says (m).
    fn reach(&self, direction: Vec3) -> f64 {
        let own = self.orientation.inverse_transform_vector(&direction);
        self.surface.support(own) + self.offset.dot(&direction)
    }
}

impl GrainModel<'_> {
    /// The intruder where `condition` has it start, above the resting `bed`.
    pub(crate) fn launched_intruder(
        &self,
        bed: &GrainBed,
        condition: &Condition,
    ) -> Result<Box<dyn Mechanism>, BuildError> {
        let launch = self.model.launch(condition);
        let (x, y) = (self.start_x(condition), self.start_y());
        let entrants = self.entrants();
        self.check_sides(&entrants, (x, y))?;
        let heights = entrants.iter().map(|Entrant { surface, orientation, offset }| {
            let above = (x + offset.x, y + offset.y);
            height_in_touch(&bed.grains, &**surface, *orientation, above) - offset.z
        });
        let start = Vec3::new(x, y, heights.fold(f64::NEG_INFINITY, f64::max));

        if let Some(mut links) = self.links() {
            links.launch(start, launch.velocity(), launch.spin.y);
            return Ok(Box::new(links));
        }
        let (intruder, space) = (&self.model.intruder, self.medium.space);
        let shape = (intruder.shape.build)(&intruder.params, space);
        let surface = match intruder.shape.under_shaft.filter(|_| intruder.recessive_wall) {
            Some(under_shaft) => {
                let tops = bed.grains.iter().map(|grain| grain.position.z + grain.radius);
                let height = tops.fold(2.0 * shape.surface.bounding_radius(), f64::max);
                under_shaft(&intruder.params, space, SHAFT * height)
            }
            None => shape.surface,
        };
        let inertia = shape.inertia_per_mass * intruder.mass;
        let mut body = RigidBody::new(&intruder.name, surface, intruder.mass, inertia);
        if space == Space::Spatial {
            body.volume = (intruder.shape.volume)(&intruder.params, space);
            body.added_mass = bed.fluid_around(body.volume).added_mass;
        }
        body.launch(start, turned_about_y(self.attitude()), launch.velocity(), launch.spin);
        Ok(match launch.pushed_to {
            Some(_) => Box::new(Driven::new(body)),
            None => Box::new(body),
        })
    }

    /// How many bodies the intruder is made of.
    pub(crate) fn n_bodies(&self) -> usize {
        self.links().map_or(1, |links| links.bodies().len())
    }

    /// The links of a chain, with the joint at the origin; none for an intruder that is one body.
    fn links(&self) -> Option<HingedLinks> {
        let intruder = &self.model.intruder;
        let links = intruder.shape.links?;
        let mut links = links(&intruder.params, self.medium.space, intruder.mass);
        links.lean(self.model.impact.attitude_rad);
        Some(links)
    }

    /// Every body of the intruder as it enters, without the shaft of a recessive wall. The position of
    /// a chain is that of its joint, of other intruders that of the centre of mass.
    fn entrants(&self) -> Vec<Entrant> {
        let intruder = &self.model.intruder;
        let surface = (intruder.shape.build)(&intruder.params, self.medium.space).surface;
        match self.links() {
            Some(links) => {
                let entrant = |body: &RigidBody| Entrant {
                    surface: surface.clone(),
                    orientation: body.orientation,
                    offset: body.position,
                };
                links.bodies().iter().map(entrant).collect()
            }
            None => vec![Entrant {
                surface,
                orientation: turned_about_y(self.attitude()),
                offset: Vec3::zeros(),
            }],
        }
    }

    /// Angle of the axis of an intruder of one body to the vertical at the start (rad): the attitude of
    /// the impact, and the angle that a link has of its own.
    fn attitude(&self) -> f64 {
        let mut params = self.model.intruder.params.iter();
        let own = params.find(|(key, _)| *key == "link_angle").map_or(0.0, |(_, angle)| angle);
        self.model.impact.attitude_rad + own
    }

    /// How far the intruder reaches to a side at the start (m).
    pub(crate) fn half_width(&self) -> f64 {
        let entrants = self.entrants();
        reach(&entrants, Vec3::x()).max(reach(&entrants, -Vec3::x()))
    }

    /// How wide the intruder is at most, however it turns (m).
    pub(crate) fn extent(&self) -> f64 {
        let reach = |one: &Entrant| one.offset.norm() + one.surface.bounding_radius();
        2.0 * self.entrants().iter().map(reach).fold(0.0, f64::max)
    }

    /// Where the intruder starts along the depth (m): in the middle, unless the file says otherwise.
    pub(crate) fn start_y(&self) -> f64 {
        self.medium.start.y.unwrap_or(0.5 * self.medium.container.depth)
    }

    /// Refuses an intruder that starts in a side of the container.
    fn check_sides(&self, entrants: &[Entrant], (x, y): (f64, f64)) -> Result<(), BuildError> {
        let Container { shape, width, depth, sides, .. } = self.medium.container;
        // Through a periodic side the intruder may stand.
        let reach = |direction: Vec3| match sides {
            SidesKind::Periodic => 0.0,
            SidesKind::Wall | SidesKind::Absorbing => reach(entrants, direction),
        };
        if shape == ContainerShape::Cylinder {
            let axis = Vec3::new(0.5 * width, 0.5 * width, 0.0);
            let from_axis = Vec3::new(x, y, 0.0) - axis;
            let outward = from_axis.try_normalize(0.0).unwrap_or_else(Vec3::x);
            // A body that is not round may reach farther aside of this direction, by less than its own
            // size squared over the diameter.
            if from_axis.norm() + reach(outward) > 0.5 * width {
                return Err(BuildError::StartTouchesCylinder { x, y, diameter: width });
            }
            return Ok(());
        }
        let is_inside =
            |at: f64, size: f64, axis: Vec3| at >= reach(-axis) && at <= size - reach(axis);
        if !is_inside(x, width, Vec3::x()) {
            return Err(BuildError::StartTouchesSide { x, width });
        }
        let is_planar = depth == 0.0;
        if !is_planar && !is_inside(y, depth, Vec3::y()) {
            return Err(BuildError::StartTouchesFront { y, depth });
        }
        Ok(())
    }
}

fn reach(entrants: &[Entrant], direction: Vec3) -> f64 {
    entrants.iter().map(|entrant| entrant.reach(direction)).fold(f64::NEG_INFINITY, f64::max)
}
