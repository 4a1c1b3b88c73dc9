//! Every shape, lowered onto grains, comes to rest on them within round-off: with faces, edges, flanks
//! and tips first.

use engine::grains::{Grain, Grains, Space};
use engine::launch::height_in_touch;
use engine::math::{Vec3, turned_about_y};
use engine::params::ParamTable;
use engine::surface::Surface;

/// Grains on a bumpy bed; in a plane, a row of them.
fn bumps(space: Space) -> Grains {
    let across: i32 = if space == Space::Planar { 0 } else { 12 };
    let grains: Vec<Grain> = (-20..=20_i32)
        .flat_map(|i| (-across..=across).map(move |j| (i, j)))
        .map(|(i, j)| {
            // Steps of irrational numbers: no two grains alike.
            let bump = (0.618_034 * f64::from(i * i + 7 * j)).rem_euclid(1.0);
            let radius = 2e-3 * (1.0 + 0.5 * bump);
            // Far above the floor, which the tip of a leaning cone finds beside the grains.
            let height = 1.0 + 3e-3 * (0.732_051 * f64::from(i + 3 * j)).rem_euclid(1.0);
            Grain {
                position: Vec3::new(5e-3 * f64::from(i), 5e-3 * f64::from(j), height),
                velocity: Vec3::zeros(),
                spin: Vec3::zeros(),
                radius,
                mass: 1e-4,
                id: 0,
            }
        })
        .collect();
    Grains::new(space, &grains)
}

fn least_gap(grains: &Grains, surface: &dyn Surface, attitude: f64, at: Vec3) -> f64 {
    let orientation = turned_about_y(attitude);
    grains
        .iter()
        .map(|grain| {
            let local = orientation.inverse_transform_vector(&(grain.position - at));
            surface.closest(local).gap - grain.radius
        })
        .fold(f64::INFINITY, f64::min)
}

#[test]
fn every_shape_just_touches_the_highest_grain_in_its_way_at_every_attitude() {
    let shapes: [(&str, &[(&'static str, f64)]); 6] = [
        ("sphere", &[("diameter", 0.03)]),
        ("cylinder", &[("diameter", 0.03), ("height", 0.02)]),
        ("hemisphere", &[("diameter", 0.03)]),
        ("cone", &[("diameter", 0.03), ("apex_angle", 1.0)]),
        // Sharper than any that is dropped.
        ("cone", &[("diameter", 0.01), ("apex_angle", 0.02)]),
        ("link", &[("length", 0.04), ("diameter", 6e-3), ("link_angle", 0.0)]),
    ];
    for space in [Space::Planar, Space::Spatial] {
        let grains = bumps(space);
        for (name, given) in shapes {
            let entry = intruders::find(name).expect("a registered shape");
            let params: ParamTable = given.iter().copied().collect();
            let surface = (entry.build)(&params, space).surface;
            for step in -6..=6 {
                let (attitude, x) = (0.26 * f64::from(step), 1.3e-3 * f64::from(step));
                let z = height_in_touch(&grains, &*surface, turned_about_y(attitude), (x, 0.0));
                let gap = least_gap(&grains, &*surface, attitude, Vec3::new(x, 0.0, z));
                // Within the touch of 1e-12 m, and not beyond it by more than round-off.
                let touches = (-1e-14..1e-12).contains(&gap);
                assert!(touches, "{name} {given:?} at {attitude}: {gap:e} m in {space:?}");
                for higher in [1e-9, 1e-4, 1e-2] {
                    let at = Vec3::new(x, 0.0, z + higher);
                    assert!(least_gap(&grains, &*surface, attitude, at) > 0.0, "{name} {attitude}");
                }
            }
        }
    }
}
