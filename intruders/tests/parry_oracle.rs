//! The closed forms against the shapes of parry, whose axis is y and whose cones point up.

use engine::grains::Space;
use engine::math::Vec3;
use engine::params::ParamTable;
use intruders::Body;
use parry3d_f64::math::Vector;
use parry3d_f64::shape::{Capsule, Cone, Cylinder, Shape};

fn body(name: &str, params: &[(&'static str, f64)]) -> Body {
    let table: ParamTable = params.iter().copied().collect();
    let entry = intruders::find(name).expect("a registered shape");
    (entry.build)(&table, Space::Spatial)
}

/// Of a shape of parry: its reflection in the plane that exchanges −y and z, moved up by `shift`.
fn assert_same_distances(name: &str, body: &Body, oracle: &dyn Shape, shift: f64) {
    let size = body.surface.bounding_radius();
    for i in 0..4000_u32 {
        // Multiples of irrational steps fill the box evenly.
        let part = |step: f64| 2.0 * (f64::from(i) * step % 1.0) - 1.0;
        let scale = if i % 2 == 0 { 1.6 } else { 0.9 };
        let at = Vec3::new(part(0.754_877), part(0.569_840), part(0.438_579)) * (scale * size);
        let local = Vector::new(at.x, -(at.z - shift), at.y);
        let projected = oracle.project_local_point(local, false);
        let away = projected.point - local;
        let expected = if projected.is_inside { -away.length() } else { away.length() };
        let found = body.surface.closest(at);
        // parry's steps each round once, its cone in a segment of the size of the body.
        assert!((found.gap - expected).abs() < 1e-14, "{name} at {at:?}: {found:?} {expected}");
        let foot = at - found.normal * found.gap;
        let theirs = Vec3::new(projected.point.x, projected.point.z, shift - projected.point.y);
        assert!((foot - theirs).norm() < 1e-14, "{name} at {at:?}: {foot:?} {theirs:?}");
    }
}

#[test]
fn the_cylinder_is_that_of_parry() {
    for (diameter, height) in [(0.04, 0.05), (0.1, 0.01), (0.01, 0.2)] {
        let own = body("cylinder", &[("diameter", diameter), ("height", height)]);
        let oracle = Cylinder::new(0.5 * height, 0.5 * diameter);
        assert_same_distances("cylinder", &own, &oracle, 0.0);
    }
}

#[test]
fn the_cone_is_that_of_parry() {
    for apex_angle in [0.3, 1.2, 2.6] {
        let (diameter, height) = (0.04, 0.02 / libm::tan(0.5 * apex_angle));
        let own = body("cone", &[("diameter", diameter), ("apex_angle", apex_angle)]);
        // The centre of mass lies at three quarters of the height, the middle at half of it.
        let oracle = Cone::new(0.5 * height, 0.5 * diameter);
        assert_same_distances("cone", &own, &oracle, -0.25 * height);
    }
}

#[test]
fn the_link_is_the_capsule_of_parry() {
    for (length, diameter) in [(0.1, 0.01), (0.05, 0.04)] {
        let own = body("link", &[("length", length), ("diameter", diameter), ("link_angle", 0.0)]);
        let oracle = Capsule::new_y(0.5 * (length - diameter), 0.5 * diameter);
        assert_same_distances("link", &own, &oracle, 0.0);
    }
}
