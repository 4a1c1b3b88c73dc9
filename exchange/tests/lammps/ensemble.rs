//! Ten small beds, on which chaos has taken over long before the intruder stops: depths agree in the mean.

use configs::run::{Control, Progress, prepare};
use configs::{LoadOptions, Loaded, Model, ModelSource};
use exchange::lammps::{Deck, import};

use crate::program::lammps;

/// By how much the mean depths may differ (–). A single depth scatters by some per cent from chaos alone.
const APART: f64 = 0.03;

#[test]
fn mean_depths_over_ten_beds_agree() {
    let depths: Vec<[f64; 2]> = (1..=10).map(depths).collect();
    let [ours, theirs] =
        [0, 1].map(|program| depths.iter().map(|both| both[program]).fold(0.0, |sum, d| sum + d));
    assert!(ours > 10.0 * 0.01, "the discs are in their beds: {depths:?}");
    let apart = (theirs / ours - 1.0).abs();
    assert!(apart < APART, "apart by {apart:.4}: {depths:?}");
}

/// The depths (m) on the bed of `seed`, in plunge and in LAMMPS.
fn depths(seed: u64) -> [f64; 2] {
    let folder = tempfile::tempdir().expect("a folder");
    let loaded = model(seed);
    let grains = loaded.model.grains().expect("a bed");
    let prepared = prepare(grains, folder.path(), &mut Unattended).expect("a bed");
    let resting = prepared.expect("nobody stops it").resting;
    let mut simulation =
        grains.simulation(&resting, &loaded.model.conditions()[0]).expect("a simulation");
    while !simulation.is_over() {
        simulation.advance().expect("a step");
    }
    let stopping = simulation.courses()[0].stopping();
    assert!(stopping.stopping_time().is_some(), "it has stopped");
    let deck = Deck::of(grains, &resting).expect("a deck");
    deck.write(folder.path()).expect("it can be written");
    lammps(folder.path(), 1, simulation.last_step());
    let imported = import(folder.path(), &folder.path().join("run.mcap")).expect("a run");
    assert!(imported.summary.stop.stopped, "it has stopped in LAMMPS too");
    [stopping.depth(), imported.summary.stop.depth_m]
}

fn model(seed: u64) -> Loaded {
    let text = "\
[run]
name = \"ensemble\"
duration = \"0.15 s\"
time_step = \"10 us\"

[medium]
kind = \"grains\"
dimension = 2
gravity = \"9.81 m/s^2\"

[container]
shape = \"box\"
width = \"16 cm\"
sides = \"wall\"
bottom = \"wall\"

[bed]
source = \"settle\"
preparation_friction = 0.28

[[bed.grains]]
count = 420
diameter = \"4.56 mm\"
mass = \"0.049 g\"

[[bed.grains]]
count = 80
diameter = \"6.35 mm\"
mass = \"0.097 g\"

[contact_law]
name = \"linear-spring-dashpot\"
normal_stiffness = \"3200 N/m\"
tangential_stiffness = \"3200 N/m\"
normal_damping_rate = \"1e4 1/s\"
tangential_damping_rate = \"8e3 1/s\"
friction = 0.28

[intruder]
shape = \"disc\"
diameter = \"3 cm\"
mass = \"8 g\"

[impact]
speed = \"1 m/s\"
angle = \"90 deg\"
";
    let folder = std::env::temp_dir();
    let source = ModelSource::Text { name: "ensemble".into(), text: text.into(), folder };
    let options = LoadOptions { seed: Some(seed), ..LoadOptions::default() };
    Model::load(source, &options)
        .unwrap_or_else(|error| panic!("{}", error.render(configs::Color::Off)))
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
