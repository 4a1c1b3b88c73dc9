//! Impacts on many beds, in both programs: chaos has taken over long before an intruder is at rest, so that
//! single depths differ, and their means do not.

use std::fmt;
use std::path::Path;
use std::thread;

use configs::{LoadOptions, Loaded, Model, ModelSource};
use engine::simulation::Simulation;
use exchange::lammps::{Deck, import};
use exchange::read::{Keep, read_run};
use runner::run::{Control, Progress, prepare};

use crate::program::lammps;

/// By how much mean depths may differ (–).
const APART: f64 = 0.03;

/// What the standard error of that may be at most (–), for it to say something.
const ERROR: f64 = 0.015;

/// A speed below this share of that of the impact is rest: grains still shake the intruder.
const AT_REST: f64 = 0.1;

/// Impacts of one model.
struct Ensemble {
    model: &'static str,
    /// Beds, each drawn by a seed of its own.
    beds: u64,
    /// Where the intruder comes down on each of them.
    places: &'static [&'static str],
}

/// The largest depths (m) in plunge and in LAMMPS, of every impact on every bed.
struct Depths(Vec<Vec<[f64; 2]>>);

#[test]
fn mean_depths_of_a_disc_over_ten_beds_agree() {
    let places = &["7.4 cm", "7.8 cm", "8.2 cm"];
    agree(&Ensemble { model: include_str!("disc.toml"), beds: 10, places });
}

#[test]
fn mean_depths_of_a_hemisphere_and_of_its_clump_agree() {
    let places = &["14 mm", "16 mm", "18 mm"];
    agree(&Ensemble { model: include_str!("hemisphere.toml"), beds: 4, places });
}

fn agree(ensemble: &Ensemble) {
    let depths = ensemble.depths();
    eprintln!("{depths}");
    let (apart, error) = depths.apart();
    assert!(error < ERROR, "too few impacts to tell: {depths}");
    assert!(apart.abs() < APART, "{depths}");
}

impl Ensemble {
    /// Beds are dealt out to two threads.
    fn depths(&self) -> Depths {
        let dealt = |first: u64| (first..=self.beds).step_by(2).map(|seed| self.on_bed(seed));
        Depths(thread::scope(|scope| {
            let threads = [1, 2].map(|first| scope.spawn(move || dealt(first).collect::<Vec<_>>()));
            threads.into_iter().flat_map(|one| one.join().expect("impacts")).collect()
        }))
    }

    fn on_bed(&self, seed: u64) -> Vec<[f64; 2]> {
        let folder = tempfile::tempdir().expect("a folder");
        self.places.iter().map(|place| self.depths_of(seed, place, folder.path())).collect()
    }

    /// The largest depths (m) in plunge and in LAMMPS; the bed of `seed` is kept in `folder`.
    fn depths_of(&self, seed: u64, place: &str, folder: &Path) -> [f64; 2] {
        let loaded = self.load(seed, place);
        let grains = loaded.model.grains().expect("a bed");
        let bed = prepare(grains, folder, &mut Unattended).expect("a bed").expect("to its end");
        let condition = loaded.model.conditions()[0];
        let mut simulation = grains.simulation(&bed.resting, &condition).expect("a simulation");
        let last = simulation.last_step();
        let ours = to_the_end(&mut simulation);
        Deck::of(grains, &bed.resting).expect("a deck").write(folder).expect("it can be written");
        lammps(folder, 1, last);
        let imported = import(folder, &folder.join("run.mcap"), &|| false).expect("a run");
        let log = read_run(&imported.files.log, Keep::States).expect("a log");
        let states = &log.bodies[0].states;
        let theirs = states.iter().map(|state| state.depth).fold(0.0, f64::max);
        let speeds = [
            simulation.intruder().bodies()[0].velocity.norm(),
            states[states.len() - 1].velocity.norm(),
        ];
        let slow = |speed: f64| speed < AT_REST * condition.speed;
        assert!(speeds.into_iter().all(slow), "still at {speeds:?} m/s on bed {seed}");
        [ours, theirs]
    }

    fn load(&self, seed: u64, place: &str) -> Loaded {
        let (text, folder) = (self.model.to_owned(), std::env::temp_dir());
        let source = ModelSource::Text { name: "ensemble".into(), text, folder };
        let sets = vec![format!("impact.x=\"{place}\"")];
        let options = LoadOptions { seed: Some(seed), sets, ..LoadOptions::default() };
        Model::load(source, &options)
            .unwrap_or_else(|error| panic!("{}", error.render(configs::Color::Off)))
    }
}

/// The largest depth (m) of the intruder until the last step.
fn to_the_end(simulation: &mut Simulation) -> f64 {
    let mut deepest = 0.0_f64;
    for _ in 0..simulation.last_step() {
        simulation.advance().expect("a step");
        deepest = deepest.max(simulation.surface() - simulation.intruder().bodies()[0].lowest());
    }
    deepest
}

impl Depths {
    /// Mean over the impacts on each bed, of what `of` makes of an impact.
    fn by_bed(&self, of: impl Fn(&[f64; 2]) -> f64) -> Vec<f64> {
        let on_bed = |bed: &Vec<[f64; 2]>| bed.iter().map(&of).sum::<f64>() / bed.len() as f64;
        self.0.iter().map(on_bed).collect()
    }

    /// By how much LAMMPS has the intruder deeper in the mean, over the depth in plunge, and its standard
    /// error, from bed to bed.
    fn apart(&self) -> (f64, f64) {
        let (depth, _) = mean_and_scatter(&self.by_bed(|[ours, _]| *ours));
        let (apart, scatter) = mean_and_scatter(&self.by_bed(|[ours, theirs]| theirs - ours));
        (apart / depth, scatter / (self.0.len() as f64).sqrt() / depth)
    }
}

impl fmt::Display for Depths {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (program, name) in ["plunge", "LAMMPS"].into_iter().enumerate() {
            let (mean, scatter) = mean_and_scatter(&self.by_bed(|depths| depths[program]));
            write!(f, "{name} {:.3} mm, from bed to bed {:.3} mm; ", 1e3 * mean, 1e3 * scatter)?;
        }
        let (apart, error) = self.apart();
        write!(f, "apart by {:.2} %, standard error {:.2} %", 100.0 * apart, 100.0 * error)
    }
}

fn mean_and_scatter(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares = values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>();
    (mean, (squares / (n - 1.0)).sqrt())
}

/// Nobody looks on.
struct Unattended;

impl Control for Unattended {
    fn progress(&mut self, _: &Progress) {}

    fn warn(&mut self, _: &str) {}

    fn wants_to_stop(&self) -> bool {
        false
    }
}
