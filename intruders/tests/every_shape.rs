//! What must hold for every registered shape.

use std::f64::consts::PI;

use engine::grains::Space;
use engine::math::Vec3;
use engine::params::{Default, ParamTable};
use engine::surface::Surface;
use intruders::{Body, SHAPES, ShapeEntry};

/// Every shape in every space it is a shape of, in the middle of its plausible sizes.
fn every_body() -> impl Iterator<Item = (&'static ShapeEntry, Space, Body)> {
    SHAPES.iter().flat_map(|entry| {
        let spaces = [(entry.planar, Space::Planar), (entry.spatial, Space::Spatial)];
        spaces.into_iter().filter(|(is_there, _)| *is_there).filter_map(|(_, space)| {
            let mut params = ParamTable::new();
            for spec in entry.params {
                let middle = (spec.plausible.min * spec.plausible.max).sqrt();
                params.set(
                    spec.key,
                    match spec.default {
                        Default::Required | Default::FromBase(_) => middle,
                        Default::Value(value) => value,
                        Default::SameAs(other) => params.get(other),
                    },
                );
            }
            Some((*entry, space, entry.build?(&params, space)))
        })
    })
}

/// Unit vectors spread evenly over the sphere, about 0.9° apart.
fn directions() -> Vec<Vec3> {
    let n = 50_000;
    (0..n)
        .map(|k| {
            let z = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(n);
            let (ring, turn) = ((1.0 - z * z).sqrt(), f64::from(k) * PI * (3.0 - 5.0_f64.sqrt()));
            Vec3::new(ring * libm::cos(turn), ring * libm::sin(turn), z)
        })
        .collect()
}

/// Signed distance of `point` from a convex body: the farthest it lies outside of any of its tangent
/// planes.
fn by_brute_force(surface: &dyn Surface, directions: &[Vec3], point: Vec3) -> f64 {
    directions
        .iter()
        .map(|direction| point.dot(direction) - surface.support(*direction))
        .fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn every_registered_shape_has_the_closest_point_that_brute_force_finds() {
    let directions = directions();
    for (entry, _, body) in every_body() {
        let surface = &*body.surface;
        let size = surface.bounding_radius();
        for k in 0..60 {
            let at = directions[k * 817] * (size * (0.1 + 0.05 * k as f64));
            let nearest = surface.closest(at);
            let gap = by_brute_force(surface, &directions, at);
            // A direction half a degree off loses ½ (0.008)² of the lever.
            let allowed = 1e-4 * (at.norm() + size);
            assert!((nearest.gap - gap).abs() < allowed, "{} at {at:?}", entry.name);
            assert!((nearest.normal.norm() - 1.0).abs() < 1e-12, "{} at {at:?}", entry.name);
            let foot = at - nearest.normal * nearest.gap;
            assert!(surface.closest(foot).gap.abs() < 1e-12 * size, "{} at {at:?}", entry.name);
        }
    }
}

#[test]
fn every_registered_shape_fits_its_bounding_radius_and_has_moments_of_inertia_of_its_size() {
    for (entry, space, body) in every_body() {
        let size = body.surface.bounding_radius();
        for direction in directions().iter().step_by(97) {
            assert!(body.surface.support(*direction) <= size * (1.0 + 1e-12), "{}", entry.name);
        }
        let most = size * size;
        assert!(
            body.inertia_per_mass.iter().all(|&moment| moment > 0.0 && moment <= most),
            "{} {space:?}",
            entry.name
        );
        assert!(body.volume > 0.0 && !entry.summary.is_empty(), "{}", entry.name);
    }
}
