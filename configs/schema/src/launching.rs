//! The intruder of a bed of grains, put where it just touches the bed.

use engine::body::{Mechanism, RigidBody};
use engine::grain_bed::GrainBed;
use engine::launch::height_in_touch;
use engine::math::{Quat, Vec3, turned_about_y};
use engine::surface::Surface;

use crate::build::BuildError;
use crate::model::{Condition, Container, ContainerShape, GrainModel, SidesKind};

/// Length of the shaft of a recessive wall, in the height of the bed: grains that are thrown up do not
/// come over its top.
const SHAFT: f64 = 2.0;

impl GrainModel<'_> {
    /// The intruder where `condition` has it start, above the resting `bed`.
    pub(crate) fn launched_intruder(
        &self,
        bed: &GrainBed,
        condition: &Condition,
    ) -> Result<Box<dyn Mechanism>, BuildError> {
        let (intruder, space) = (&self.model.intruder, self.medium.space);
        let shape = (intruder.shape.build)(&intruder.params, space);
        let launch = self.model.launch(condition);
        let (x, y) = (self.start_x(condition), self.start_y());
        let orientation = turned_about_y(self.attitude());
        self.check_sides(&*shape.surface, orientation, (x, y))?;
        let z = height_in_touch(&bed.grains, &*shape.surface, orientation, (x, y));

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
        body.launch(Vec3::new(x, y, z), orientation, launch.velocity(), launch.spin);
        Ok(Box::new(body))
    }

    /// Angle of the intruder's axis to the vertical at the start (rad): the attitude of the impact,
    /// and the angle that a link has of its own.
    pub(crate) fn attitude(&self) -> f64 {
        let mut params = self.model.intruder.params.iter();
        let own = params.find(|(key, _)| *key == "link_angle").map_or(0.0, |(_, angle)| angle);
        self.model.impact.attitude_rad + own
    }

    /// Where the centre of the intruder starts along the depth (m): in the middle, unless the file says
    /// otherwise.
    #[must_use]
    pub fn start_y(&self) -> f64 {
        self.medium.start.y.unwrap_or(0.5 * self.medium.container.depth)
    }

    /// Refuses an intruder that starts in a side of the container.
    fn check_sides(
        &self,
        surface: &dyn Surface,
        orientation: Quat,
        (x, y): (f64, f64),
    ) -> Result<(), BuildError> {
        let Container { shape, width, depth, sides, .. } = self.medium.container;
        // Through a periodic side the intruder may stand.
        let reach = |direction: Vec3| match sides {
            SidesKind::Periodic => 0.0,
            SidesKind::Wall | SidesKind::Absorbing => {
                surface.support(orientation.inverse_transform_vector(&direction))
            }
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
        if x < reach(-Vec3::x()) || x > width - reach(Vec3::x()) {
            return Err(BuildError::StartTouchesSide { x, width });
        }
        let is_planar = depth == 0.0;
        if !is_planar && (y < reach(-Vec3::y()) || y > depth - reach(Vec3::y())) {
            return Err(BuildError::StartTouchesFront { y, depth });
        }
        Ok(())
    }
}
