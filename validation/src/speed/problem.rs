//! What is stepped: beds at rest, each under an intruder that has just touched it.
//!
//! A problem is a folder with a model and the table of its grains, made from a bed in the cache. A table
//! holds no contact histories, so every program that reads it starts from the same state.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use configs::{LoadOptions, Model, ModelSource, find_shipped};
use engine::grains::{Grain, Space};
use runner::run::{Control, Progress, prepare};
use serde::Serialize;

use runner::CampaignError;

use super::SpeedError;
use super::trial::Span;

/// Of which a larger bed of spheres is made.
const SPHERES: &str = include_str!("../../speed/spheres.toml");

/// A steel sphere that hits a bed of softer spheres.
const STEEL: &str = include_str!("../../speed/steel.toml");

/// Width and depth of that bed of which larger ones are made (m).
const TILE: f64 = 0.1;

/// Mean diameter (m) of 25 000 grains below the steel sphere.
const STEEL_GRAIN: f64 = 3e-3;

/// One bed, intruder and law.
#[derive(Debug, PartialEq, Eq)]
pub struct Problem {
    /// How the command line calls it.
    pub name: &'static str,
    /// What it is, in a few words.
    pub about: &'static str,
    /// What is timed.
    pub span: Span,
    base: Base,
}

/// Where a bed comes from.
#[derive(Debug, PartialEq, Eq)]
enum Base {
    /// That of the shipped model `vertical-2d`.
    Discs,
    /// So many by so many tiles of spheres.
    Spheres(u32),
    /// So many spheres below a steel one, of the same volume whatever their number.
    Steel(u32),
}

/// Every problem, the smallest of its kind first.
pub static PROBLEMS: [Problem; 7] = [
    Problem {
        name: "2d-15k",
        about: "15 000 discs, linear law",
        span: Span { warm_up: 300, steps: 1000 },
        base: Base::Discs,
    },
    Problem {
        name: "3d-12k",
        about: "12 500 spheres, Hertz–Mindlin",
        span: Span { warm_up: 100, steps: 1200 },
        base: Base::Spheres(1),
    },
    Problem {
        name: "3d-50k",
        about: "50 000 spheres, Hertz–Mindlin",
        span: Span { warm_up: 100, steps: 300 },
        base: Base::Spheres(2),
    },
    Problem {
        name: "3d-200k",
        about: "200 000 spheres, Hertz–Mindlin",
        span: Span { warm_up: 50, steps: 100 },
        base: Base::Spheres(4),
    },
    Problem {
        name: "steel-25k",
        about: "25 000 spheres, steel sphere",
        span: Span { warm_up: 200, steps: 600 },
        base: Base::Steel(25_000),
    },
    Problem {
        name: "steel-50k",
        about: "50 000 spheres, steel sphere",
        span: Span { warm_up: 200, steps: 300 },
        base: Base::Steel(50_000),
    },
    Problem {
        name: "steel-100k",
        about: "100 000 spheres, steel sphere",
        span: Span { warm_up: 100, steps: 200 },
        base: Base::Steel(100_000),
    },
];

/// Those that are measured when none is named: beds that settle in a minute.
pub fn usual() -> impl Iterator<Item = &'static Problem> {
    PROBLEMS.iter().filter(|problem| match problem.base {
        Base::Steel(count) => count == 25_000,
        Base::Discs | Base::Spheres(_) => true,
    })
}

/// How long a bed took.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BedTime {
    /// Name of the model that it is of.
    pub bed: String,
    /// `"miss"`: settled now; `"hit"`: read from the cache.
    pub cache: &'static str,
    /// (s) of wall time.
    pub seconds: f64,
}

impl Problem {
    /// The problem called `name`.
    pub fn find(name: &str) -> Option<&'static Self> {
        PROBLEMS.iter().find(|problem| problem.name == name)
    }

    /// Writes the problem into a folder below `folder`, from its bed in `cache`, which is settled if it is not
    /// there; gives the path of the model, and how long the bed took.
    ///
    /// # Errors
    /// If the bed cannot be prepared, or a file not be written.
    pub fn write(&self, folder: &Path, cache: &Path) -> Result<(PathBuf, BedTime), SpeedError> {
        let folder = folder.join(self.name);
        fs::create_dir_all(&folder).map_err(SpeedError::file(&folder))?;
        let (text, tiles) = match self.base {
            Base::Discs => (find_shipped("vertical-2d").map_or("", |shipped| shipped.text), 1),
            Base::Spheres(tiles) => (SPHERES, tiles),
            Base::Steel(_) => (STEEL, 1),
        };
        let load = |sets: Vec<String>| {
            let (name, text) = (self.name.to_owned(), text.to_owned());
            let source = ModelSource::Text { name, text, folder: folder.clone() };
            Model::load(source, &LoadOptions { sets, ..LoadOptions::default() })
                .map_err(CampaignError::from)
        };
        let model = load(self.bed_sets())?.model;
        let grains = model.grains().ok_or_else(|| SpeedError::NoTable(folder.clone()))?;
        let clock = Instant::now();
        let bed = prepare(grains, cache, &mut Told::default()).map_err(CampaignError::from)?;
        let bed = bed.ok_or(SpeedError::Stopped)?;
        let seconds = clock.elapsed().as_secs_f64();
        let time = BedTime { bed: model.run.name.clone(), cache: bed.cache, seconds };

        let table = folder.join("grains.csv");
        fs::write(&table, csv(bed.resting.space, &tiled(&bed.resting.grains, tiles)))
            .map_err(SpeedError::file(&table))?;
        let model = load(self.sets(tiles))?.model;
        let path = folder.join("model.toml");
        fs::write(&path, model.resolved_toml()).map_err(SpeedError::file(&path))?;
        Ok((path, time))
    }

    /// What makes the bed of the model.
    fn bed_sets(&self) -> Vec<String> {
        let Base::Steel(count) = self.base else { return Vec::new() };
        let diameter = STEEL_GRAIN * libm::cbrt(25_000.0 / f64::from(count));
        vec![format!(
            "bed.grains=[{{ count = {count}, distribution = \"uniform\", diameter_min = \"{} m\", \
             diameter_max = \"{} m\", density = \"2500 kg/m^3\" }}]",
            0.95 * diameter,
            1.05 * diameter
        )]
    }

    /// What makes the problem of the model of its bed.
    fn sets(&self, tiles: u32) -> Vec<String> {
        let mut sets = vec![
            format!("run.name=\"speed-{}\"", self.name),
            "bed={ source = \"csv\", file = \"grains.csv\" }".to_owned(),
        ];
        if let Base::Spheres(_) = self.base {
            let width = f64::from(tiles) * TILE;
            sets.push(format!("container.width=\"{width} m\""));
            sets.push(format!("container.depth=\"{width} m\""));
        }
        sets
    }
}

/// `grains`, which lie between periodic sides, so many times in a row along x and along y.
fn tiled(grains: &[Grain], tiles: u32) -> Vec<Grain> {
    let places = (0..tiles).flat_map(|i| (0..tiles).map(move |j| (i, j)));
    let shifted = places.flat_map(|(i, j)| {
        grains.iter().map(move |grain| {
            let mut grain = *grain;
            grain.position.x += f64::from(i) * TILE;
            grain.position.y += f64::from(j) * TILE;
            grain
        })
    });
    shifted.collect()
}

/// The table of a model, with every digit.
fn csv(space: Space, grains: &[Grain]) -> String {
    let mut text = match space {
        Space::Planar => "x_m,y_m,radius_m,mass_kg\n".to_owned(),
        Space::Spatial => "x_m,y_m,z_m,radius_m,mass_kg\n".to_owned(),
    };
    for Grain { position, radius, mass, .. } in grains {
        let _ = match space {
            Space::Planar => write!(text, "{:?},", position.x),
            Space::Spatial => write!(text, "{:?},{:?},", position.x, position.y),
        };
        let _ = writeln!(text, "{:?},{radius:?},{mass:?}", position.z);
    }
    text
}

/// Says on stderr that a bed settles, as it may take a while.
#[derive(Default)]
struct Told {
    before: f64,
}

impl Control for Told {
    fn progress(&mut self, progress: &Progress) {
        if let Progress::Settling { time, restlessness, .. } = *progress
            && time - self.before >= 0.05
        {
            self.before = time;
            eprintln!(
                "  bed at {time:.2} s: {restlessness:.1e} times as restless as a bed at rest"
            );
        }
    }

    fn warn(&mut self, message: &str) {
        eprintln!("warning: {message}");
    }

    fn wants_to_stop(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use configs::BedSource;
    use engine::math::Vec3;

    use super::*;

    #[test]
    fn tiles_repeat_every_grain_at_the_width_of_a_tile() {
        let grain = Grain {
            position: Vec3::new(0.03, 0.04, 0.05),
            velocity: Vec3::zeros(),
            spin: Vec3::zeros(),
            radius: 0.0025,
            mass: 1e-4,
            id: 0,
        };
        let tiles = tiled(&[grain], 2);
        let text = csv(Space::Spatial, &tiles);
        assert_eq!(tiles.len(), 4);
        assert!(text.contains("\n0.13,0.04,0.05,0.0025,0.0001\n"), "{text}");
        assert_eq!(
            csv(Space::Planar, &[grain]),
            "x_m,y_m,radius_m,mass_kg\n0.03,0.05,0.0025,0.0001\n"
        );
    }

    #[test]
    fn a_bed_below_the_steel_sphere_has_one_volume_and_is_of_two_materials() {
        let grains_of = |name: &str| {
            let problem = Problem::find(name).expect("a problem");
            let (name, text, folder) = ("steel".into(), STEEL.into(), ".".into());
            let options = LoadOptions { sets: problem.bed_sets(), ..LoadOptions::default() };
            let source = ModelSource::Text { name, text, folder };
            Model::load(source, &options).unwrap_or_else(|error| {
                panic!("{}", error.render(configs::Color::Off));
            })
        };
        let volumes = [("steel-25k", 25_000), ("steel-100k", 100_000)].map(|(name, count)| {
            let model = grains_of(name).model;
            let grains = model.grains().expect("a bed");
            assert_eq!(grains.n_grains(), count);
            let law = &grains.medium.contact_law.params;
            for (key, value) in [
                ("restitution", 0.5),
                ("intruder_restitution", 0.4),
                ("wall_restitution", 0.4),
                ("friction", 0.3),
                ("intruder_friction", 0.2),
                ("intruder_young_modulus", 210e9),
            ] {
                assert_eq!(law.get(key).to_bits(), f64::to_bits(value), "{key}");
            }
            let BedSource::Settle(settle) = &grains.medium.bed.source else { panic!("settled") };
            settle.grains[0].count as f64 * settle.grains[0].sizes.moment(3)
        });
        assert!((volumes[1] / volumes[0] - 1.0).abs() < 1e-12, "{volumes:?}");
    }

    #[test]
    fn the_tile_is_as_wide_as_its_model_and_can_be_run() {
        let source =
            ModelSource::Text { name: "spheres".into(), text: SPHERES.into(), folder: ".".into() };
        let model = Model::load(source, &LoadOptions::default()).expect("a model").model;
        let grains = model.grains().expect("a bed");
        assert_eq!(grains.medium.container.width.to_bits(), TILE.to_bits());
        assert_eq!(grains.medium.container.depth.to_bits(), TILE.to_bits());
        assert_eq!(grains.n_grains(), 12_500);
    }
}
