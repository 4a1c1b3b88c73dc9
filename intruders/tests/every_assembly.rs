//! What must hold for every registered shape in a resistive medium.

use engine::grains::Space;
use engine::math::Vec3;
use engine::params::{ParamDefault, ParamTable};
use intruders::{AssemblyRequest, Launchable, SHAPES, ShapeEntry};
use resistive::{Immersion, State};

/// A shape of middling size, or leaning, with the volume that its entry states.
struct Example {
    name: String,
    volume: f64,
    launchable: Launchable,
}

/// A value inside of the plausible range.
fn middle(spec: &engine::params::ParamSpec, params: &ParamTable) -> f64 {
    let range = spec.plausible;
    match spec.default {
        ParamDefault::SameAs(other) => params.get(other),
        _ if range.min < 0.0 => 0.3 * range.max,
        _ => (range.min * range.max).sqrt(),
    }
}

fn example(entry: &'static ShapeEntry, space: Space) -> Example {
    let mut params = ParamTable::new();
    for spec in entry.params {
        let value = middle(spec, &params);
        params.set(spec.key, value);
    }
    let request = AssemblyRequest {
        params: &params,
        space,
        mass: 0.1,
        velocity: Vec3::new(0.0, 0.0, -1.0),
        spin: 0.0,
    };
    Example {
        name: format!("{} {space:?}", entry.name),
        volume: (entry.volume)(&params, space),
        launchable: (entry.assembly)(&request),
    }
}

fn examples() -> Vec<Example> {
    let spaces = [Space::Planar, Space::Spatial].into_iter();
    let all = spaces.flat_map(|space| SHAPES.iter().map(move |entry| (entry, space)));
    let known = all.filter(|(entry, space)| entry.is_of_resistance(*space));
    known.map(|(entry, space)| example(entry, space)).collect()
}

impl Example {
    /// All parts with the whole body `depth` (m) lower than at first contact.
    fn at(&self, depth: f64) -> Vec<Immersion> {
        let Launchable { assembly, start } = &self.launchable;
        let mut state: State = *start;
        state.position[1] -= depth;
        (0..assembly.n_parts()).map(|part| assembly.part(part, &state).immersion).collect()
    }

    /// Depth at which all of it is below the surface (m), to a relative 1e-3.
    fn covered(&self) -> f64 {
        let total = |depth| self.at(depth).iter().map(|part| part.volume).sum::<f64>();
        let mut depth = 1e-4;
        while total(depth) < self.volume * (1.0 - 1e-9) && depth < 100.0 {
            depth *= 1.001;
        }
        depth
    }
}

#[test]
fn every_shape_starts_with_its_lowest_point_at_the_surface() {
    for example in examples() {
        let parts = example.at(0.0);
        let lowest = parts.iter().map(|part| part.depth).fold(f64::NEG_INFINITY, f64::max);
        // Exact: a body that starts a rounding above the surface would have to fall to it first.
        assert!(lowest.abs() < 1e-15, "{}", example.name);
    }
}

#[test]
fn the_immersed_volume_grows_with_depth_as_the_section_says() {
    for example in examples() {
        let covered = example.covered();
        for k in 1..40 {
            let depth = covered * (0.03 * f64::from(k) + 0.004);
            let step = 1e-5 * covered;
            let (before, here, after) =
                (example.at(depth - step), example.at(depth), example.at(depth + step));
            for (part, at) in here.iter().enumerate() {
                let rate = (after[part].volume - before[part].volume) / (2.0 * step);
                // The second-order error of the difference: (step/covered)² of a smooth volume, but
                // its first order across the edge where the body is covered.
                let edge = (before[part].section - after[part].section).abs();
                let allowed = 1e-6 * at.frontal_area + edge;
                assert!(
                    (rate - at.section).abs() <= allowed,
                    "{} at {depth}: {rate} and {}",
                    example.name,
                    at.section
                );
            }
        }
    }
}

#[test]
fn a_covered_body_has_displaced_its_volume_and_shows_its_frontal_area() {
    for example in examples() {
        let parts = example.at(50.0);
        let volume: f64 = parts.iter().map(|part| part.volume).sum();
        // The same closed form on two ways: round-off.
        assert!((volume / example.volume - 1.0).abs() < 1e-12, "{}", example.name);
        for at in parts {
            assert!((at.immersed_area / at.frontal_area - 1.0).abs() < 1e-12, "{}", example.name);
            assert!(at.section.abs() < 1e-15, "{}: nothing is left to immerse", example.name);
        }
    }
}

#[test]
fn the_immersed_area_never_falls_and_stays_within_the_frontal_area() {
    for example in examples() {
        let covered = example.covered();
        let mut last = vec![0.0; example.at(0.0).len()];
        for k in 1..200 {
            for (last, at) in last.iter_mut().zip(example.at(covered * 0.007 * f64::from(k))) {
                let most = at.frontal_area * (1.0 + 1e-12);
                assert!(*last <= at.immersed_area && at.immersed_area <= most, "{}", example.name);
                *last = at.immersed_area;
            }
        }
    }
}

#[test]
fn at_first_contact_the_section_is_that_of_the_lowest_point() {
    for example in examples() {
        let covered = example.covered();
        for at in example.at(1e-9 * covered).iter().filter(|at| at.depth >= 0.0) {
            let blunt = ["cylinder", "link", "two-link-chain"];
            let is_blunt = blunt.iter().any(|name| example.name.starts_with(name));
            // A blunt body shows its face at once; of a round or a pointed one, the part 1e-9 down
            // is at most √(8e-9) of it wide, that of a disc.
            if is_blunt {
                assert!(at.section >= at.frontal_area, "{}", example.name);
            } else {
                assert!(at.section < 1e-4 * at.frontal_area, "{}", example.name);
            }
        }
    }
}

#[test]
fn centre_of_mass_and_moment_of_inertia_are_those_of_the_sections() {
    let compact = ["disc Planar", "cylinder", "hemisphere", "cone", "sphere Spatial"];
    for example in examples() {
        if !compact.iter().any(|name| example.name.starts_with(name)) {
            continue;
        }
        let (height, n) = (example.covered(), 20_000);
        let slice = height / f64::from(n);
        let (mut volume, mut first, mut second) = (0.0, 0.0, 0.0);
        for k in 0..n {
            let z = (f64::from(k) + 0.5) * slice;
            let area = example.at(z)[0].section;
            let across = if example.name.ends_with("Planar") {
                area * area / 12.0
            } else {
                area / (4.0 * std::f64::consts::PI)
            };
            volume += area * slice;
            first += z * area * slice;
            second += (z * z + across) * area * slice;
        }
        let centre = first / volume;
        let Launchable { assembly, start } = &example.launchable;
        let (above, mass) = assembly.weight_at(0, start);
        let turning = State { rate: [0.0, 0.0, 1.0, 0.0], ..*start };
        let inertia = 2.0 * assembly.kinetic_energy(0, &turning)[1] / mass;
        // `covered` is up to 1e-3 too large, where the last slice is empty; the midpoint rule on a
        // vertical tangent loses about n^-1.5 and on a jump 1/n.
        assert!((above / centre - 1.0).abs() < 2e-4, "{}: {above} {centre}", example.name);
        let expected = second / volume - centre * centre;
        assert!((inertia / expected - 1.0).abs() < 5e-4, "{}: {inertia} {expected}", example.name);
    }
}
