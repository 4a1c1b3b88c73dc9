//! What must hold for every registered shape.

use std::f64::consts::PI;

use engine::grains::Space;
use engine::math::Vec3;
use engine::params::{ParamDefault, ParamTable};
use engine::surface::Surface;
use intruders::{Body, Drawing, SHAPES, ShapeEntry};

struct Example {
    name: String,
    space: Space,
    body: Body,
    /// As the entry says (m³, planar m²).
    volume: f64,
    /// Whether it is a rod that has the mass of one with flat ends and the moments of a thin one.
    is_link: bool,
}

fn params(entry: &ShapeEntry) -> ParamTable {
    let mut params = ParamTable::new();
    for spec in entry.params {
        let middle = (spec.plausible.min * spec.plausible.max).sqrt();
        params.set(
            spec.key,
            match spec.default {
                ParamDefault::Required | ParamDefault::FromBase(_) => middle,
                ParamDefault::Value(value) => value,
                ParamDefault::SameAs(other) => params.get(other),
            },
        );
    }
    params
}

/// Every shape in every space it is a shape of, in the middle of its plausible sizes.
fn examples() -> impl Iterator<Item = Example> {
    SHAPES.iter().flat_map(|entry| {
        let spaces = [Space::Planar, Space::Spatial].into_iter();
        spaces.filter(|&space| entry.is_of(space)).map(|space| {
            let params = params(entry);
            Example {
                name: format!("{} {space:?}", entry.name),
                space,
                body: (entry.build)(&params, space),
                volume: (entry.volume)(&params, space),
                is_link: entry.name.contains("link"),
            }
        })
    })
}

/// Unit vectors spread evenly over the sphere, about 0.9° apart; in a plane, over the circle.
fn directions(space: Space) -> Vec<Vec3> {
    let n = 50_000;
    (0..n)
        .map(|k| match space {
            Space::Planar => {
                let turn = 2.0 * PI * (f64::from(k) + 0.5) / f64::from(n);
                Vec3::new(libm::cos(turn), 0.0, libm::sin(turn))
            }
            Space::Spatial => {
                let z = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(n);
                let ring = (1.0 - z * z).sqrt();
                let turn = f64::from(k) * PI * (3.0 - 5.0_f64.sqrt());
                Vec3::new(ring * libm::cos(turn), ring * libm::sin(turn), z)
            }
        })
        .collect()
}

/// Signed distance of `point` from a convex body: the farthest it lies outside of any of its tangent
/// planes.
fn by_tangents(surface: &dyn Surface, directions: &[Vec3], point: Vec3) -> f64 {
    directions
        .iter()
        .map(|direction| point.dot(direction) - surface.support(*direction))
        .fold(f64::NEG_INFINITY, f64::max)
}

/// Where the ray from the origin along `direction` leaves the body, by halving; inside is where the
/// gap is negative.
fn exit(surface: &dyn Surface, direction: Vec3) -> Vec3 {
    let (mut inside, mut outside) = (0.0, 2.0 * surface.bounding_radius());
    for _ in 0..60 {
        let middle = 0.5 * (inside + outside);
        if surface.closest(direction * middle).gap < 0.0 {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    direction * outside
}

/// Points inside, around and on every feature: a grid that holds the axis and the mid-plane, and the
/// surface itself.
fn queries(example: &Example, directions: &[Vec3]) -> Vec<Vec3> {
    let surface = &*example.body.surface;
    let size = surface.bounding_radius();
    let mut points = Vec::new();
    for i in -6..=6 {
        for k in -12..=12 {
            let y = if example.space == Space::Planar { 0.0 } else { 0.07 * size };
            points.push(Vec3::new(0.13 * size * f64::from(i), y, 0.12 * size * f64::from(k)));
        }
    }
    for direction in directions.iter().step_by(817) {
        let exit = exit(surface, *direction);
        points.extend([exit, exit * 0.999, exit * 1.001, exit * 0.7, exit * 1.5]);
    }
    points
}

#[test]
fn no_tangent_plane_is_farther_than_the_closest_point() {
    for example in examples() {
        let (surface, directions) = (&*example.body.surface, directions(example.space));
        let size = surface.bounding_radius();
        for at in queries(&example, &directions) {
            let gap = by_tangents(surface, &directions, at);
            // Round-off of a product and a sum.
            assert!(gap <= surface.closest(at).gap + 1e-14 * size, "{} at {at:?}", example.name);
        }
    }
}

#[test]
fn no_point_of_a_surface_is_nearer_than_the_closest() {
    for example in examples() {
        let (surface, directions) = (&*example.body.surface, directions(example.space));
        let size = surface.bounding_radius();
        let samples: Vec<Vec3> =
            directions.iter().step_by(5).map(|&direction| exit(surface, direction)).collect();
        // A rod ten times as long as thick: half the distance of two samples at its ends.
        let spacing = 0.07 * size;
        for at in queries(&example, &directions) {
            let found = surface.closest(at).gap.abs();
            let nearest = samples.iter().map(|sample| (sample - at).norm()).fold(9e9, f64::min);
            assert!(found <= nearest + 1e-12 * size, "{} at {at:?}", example.name);
            assert!(nearest - found < spacing, "{} at {at:?}", example.name);
        }
    }
}

#[test]
fn every_shape_has_unit_normals_that_lead_to_its_surface_and_stay_in_the_plane() {
    for example in examples() {
        let (surface, directions) = (&*example.body.surface, directions(example.space));
        let size = surface.bounding_radius();
        for at in queries(&example, &directions) {
            let found = surface.closest(at);
            // A root and two divisions.
            assert!((found.normal.norm() - 1.0).abs() < 1e-14, "{} at {at:?}", example.name);
            let foot = at - found.normal * found.gap;
            assert!(surface.closest(foot).gap.abs() < 1e-14 * size, "{} at {at:?}", example.name);
            // The body lies behind the tangent plane of the foot.
            let reach = surface.support(found.normal);
            let lever = foot.dot(&found.normal);
            assert!((lever - reach).abs() < 1e-13 * size, "{} at {at:?}", example.name);
            if example.space == Space::Planar {
                assert!(found.normal.y.abs() < f64::MIN_POSITIVE, "{} at {at:?}", example.name);
            }
        }
    }
}

#[test]
fn the_curvature_of_a_side_is_never_more_than_that_of_the_grain_that_touches_it() {
    for example in examples() {
        let (surface, directions) = (&*example.body.surface, directions(example.space));
        let Drawing::Revolved(sections) = &example.body.drawing else { continue };
        let dome = sections.iter().map(|(_, half)| *half).fold(0.0, f64::max);
        for at in queries(&example, &directions) {
            let found = surface.closest(at);
            let most = (1.0 / dome).max(1.0 / found.gap.abs());
            assert!(found.curvature >= 0.0 && found.curvature <= most, "{} {at:?}", example.name);
        }
    }
}

#[test]
fn every_shape_fits_its_bounding_radius_and_is_drawn_inside_of_it() {
    for example in examples() {
        let surface = &*example.body.surface;
        let size = surface.bounding_radius();
        let reach = directions(example.space)
            .iter()
            .map(|direction| surface.support(*direction))
            .fold(0.0, f64::max);
        // A direction 0.45° off the farthest corner misses 1 − cos of it.
        assert!(reach <= size * (1.0 + 1e-14) && reach > 0.999 * size, "{}", example.name);
        match &example.body.drawing {
            Drawing::Ball(radius) => {
                assert_eq!(radius.to_bits(), size.to_bits(), "{}", example.name)
            }
            Drawing::Revolved(sections) => {
                assert!(sections.is_sorted_by(|a, b| a.0 <= b.0), "{}", example.name);
                for &(z, half) in sections {
                    let gap = surface.closest(Vec3::new(half, 0.0, z)).gap;
                    assert!(gap.abs() < 1e-14 * size, "{} {z} {half}", example.name);
                }
            }
        }
    }
}

/// Volume, first moment along z and the moments of inertia of one unit of volume, by the midpoint rule
/// over slices, whose half width is found where the gap changes sign.
fn by_slices(example: &Example) -> (f64, f64, Vec3) {
    let surface = &*example.body.surface;
    let (top, bottom) = (surface.support(Vec3::z()), -surface.support(-Vec3::z()));
    let slices = 20_000;
    let thickness = (top - bottom) / f64::from(slices);
    let (mut volume, mut first, mut moments) = (0.0, 0.0, Vec3::zeros());
    for slice in 0..slices {
        let z = bottom + thickness * (f64::from(slice) + 0.5);
        let (mut inside, mut outside) = (0.0, 2.0 * surface.bounding_radius());
        for _ in 0..50 {
            let middle = 0.5 * (inside + outside);
            if surface.closest(Vec3::new(middle, 0.0, z)).gap < 0.0 {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        // Mean square of x and of y over the section.
        let (section, [x, y]) = match example.space {
            Space::Planar => (2.0 * inside, [inside * inside / 3.0, 0.0]),
            Space::Spatial => (PI * inside * inside, [inside * inside / 4.0; 2]),
        };
        let piece = section * thickness;
        volume += piece;
        first += piece * z;
        moments += Vec3::new(y + z * z, x + z * z, x + y) * piece;
    }
    (volume, first / volume, moments / volume)
}

#[test]
fn volume_centre_of_mass_and_moments_of_inertia_are_those_of_the_surface() {
    for example in examples() {
        let (volume, centre, moments) = by_slices(&example);
        let size = example.body.surface.bounding_radius();
        // The midpoint rule at the square root of a dome's pole: (1/20 000)^1.5.
        assert!(centre.abs() < 1e-6 * size, "{}", example.name);
        if example.is_link {
            continue;
        }
        assert!((example.volume / volume - 1.0).abs() < 1e-6, "{}", example.name);
        let stated = example.body.inertia_per_mass;
        // In a plane a sphere is a disc with the moments of a sphere.
        if example.name != "sphere Planar" {
            assert!((stated - moments).norm() < 1e-6 * size * size, "{}", example.name);
        }
    }
}

#[test]
fn a_shaft_keeps_grains_off_the_top_is_not_felt_and_changes_nothing_below_it() {
    for entry in SHAPES {
        for space in [Space::Planar, Space::Spatial].into_iter().filter(|&space| entry.is_of(space))
        {
            let Some(under_shaft) = entry.under_shaft else { continue };
            let params = params(entry);
            let plain = (entry.build)(&params, space).surface;
            let (size, length) = (plain.bounding_radius(), 3.0 * plain.bounding_radius());
            let shafted = under_shaft(&params, space, length);
            assert!(shafted.is_recessive() && !plain.is_recessive());
            let top = plain.support(Vec3::z());
            // How far the body reaches does not count its shaft; what grains may touch does.
            assert_eq!(shafted.support(Vec3::z()).to_bits(), top.to_bits(), "{}", entry.name);
            assert!(shafted.bounding_radius() >= top + length, "{}", entry.name);
            for direction in directions(space).iter().step_by(1009) {
                let at = direction * (1.3 * size);
                let (with, without) = (shafted.closest(at), plain.closest(at));
                assert!(without.felt);
                if at.z <= top {
                    assert_eq!(with, without, "{} at {at:?}", entry.name);
                } else {
                    let foot = at - with.normal * with.gap;
                    assert_eq!(with.felt, foot.z <= top * (1.0 + 1e-12), "{} {at:?}", entry.name);
                    assert!(with.gap <= without.gap + 1e-15, "{} at {at:?}", entry.name);
                }
            }
        }
    }
}

#[test]
fn every_registered_shape_touches_more_of_the_bed_the_deeper_it_is_and_never_more_than_it_has() {
    for entry in SHAPES {
        for space in [Space::Planar, Space::Spatial].into_iter().filter(|&space| entry.is_of(space))
        {
            let params = params(entry);
            let size = 2.0 * (entry.build)(&params, space).surface.bounding_radius();
            let area = |share: f64| (entry.contact_area)(&params, space, share * size);
            let areas: Vec<f64> = (0..=40).map(|k| area(0.05 * f64::from(k))).collect();
            assert!(areas.is_sorted() && areas[0] >= 0.0, "{} {space:?}: {areas:?}", entry.name);
            // No convex body has more surface than the ball (the circle) around it, and no prism or rod
            // more than the cylinder (the square) around that.
            let most = match space {
                Space::Planar => 4.0 * size,
                Space::Spatial => 1.5 * PI * size * size,
            };
            assert!(areas[40] > 0.0 && areas[40] <= most, "{} {space:?}", entry.name);
            assert_eq!(areas[39].to_bits(), areas[40].to_bits(), "{} is covered", entry.name);
        }
    }
}
