//! Mass, centre and inertia of a clump, which are those of the body and not those of its balls.

use engine::grains::Space;
use engine::math::Vec3;
use engine::simulation::Simulation;

use super::data::{axes, centre_of_intruder, row};
use super::intruder::body;

/// The text of [`BODY`](super::BODY).
pub(super) fn text(simulation: &Simulation, space: Space) -> String {
    let body = body(simulation);
    let turned = |vector: Vec3| row(axes(space, vector));
    // The tensor along the axes of LAMMPS: entry ij is the i of what a unit spin about j has of
    // angular momentum.
    let along = |axis: Vec3| {
        let own = body.orientation.inverse_transform_vector(&axis);
        axes(space, body.orientation * body.inertia.component_mul(&own))
    };
    let [of_x, of_y, of_z] = match space {
        Space::Planar => [Vec3::x(), Vec3::z(), -Vec3::y()],
        Space::Spatial => [Vec3::x(), Vec3::y(), Vec3::z()],
    }
    .map(along);
    format!(
        "# of the intruder: mass, centre, Ixx Iyy Izz Ixy Ixz Iyz, velocity, angular momentum, images\n\
         1\n1 {:?} {} {} {} {} {} 0 0 0\n",
        body.mass,
        turned(centre_of_intruder(simulation)),
        row([of_x[0], of_y[1], of_z[2]]),
        row([of_x[1], of_x[2], of_y[2]]),
        turned(body.velocity),
        turned(body.angular_momentum),
    )
}
