//! A bed of 4050 discs, the same in both programs, until chaos takes over.

use std::path::PathBuf;

use configs::{LoadOptions, Loaded, Model, ModelSource};
use exchange::lammps::{Imported, import};
use exchange::read::{Keep, read_run};
use tempfile::TempDir;

use crate::program::{in_lammps, in_plunge};

/// Of 10 us each: 10 ms.
const STEPS: u64 = 1000;

/// How far the intruder may be apart (m) up to 5 ms and up to 10 ms: where a contact slides, LAMMPS keeps the
/// viscous part of its force, and its arms reach to another point, which moves the intruder by 2.2e-5 m
/// and 8.2e-5 m in a third program (`validation/reference/crosscheck-2d`).
const APART: [f64; 2] = [5e-5, 2e-4];

/// How far the energies of the grains may be apart (–) up to 2 ms, of the largest of each. What slides differs
/// from the first collisions on, by a hundredth of the energies then and by a tenth at 7 ms, when grains have
/// parted; a moment of inertia of spheres in place of discs would be a fifth at once.
const ENERGY_APART: f64 = 0.02;

/// How far one and two ranks may be apart (m) after 10 ms: they add forces in another order, and what a bit
/// makes of that in 10 ms of a bed is below a hundredth of a micrometre.
const RANKS_APART: f64 = 1e-8;

/// Terms of the budget that both programs know of the grains.
const OF_GRAINS: [&str; 3] =
    ["kinetic_grains_translation_J", "kinetic_grains_rotation_J", "potential_grains_J"];

#[test]
fn an_imported_run_is_that_of_plunge_for_the_first_milliseconds() {
    let (_folder, loaded, imported) = imported(1);
    let log = read_run(&imported.files.log, Keep::StatesAndEnergy).expect("a log");
    let budget = log.energy.as_ref().expect("energies");
    let mut simulation = in_plunge(&loaded, 0);
    let mut apart = [0.0_f64; 2];
    let mut grains = Vec::new();
    for (index, state) in log.bodies[0].states.iter().enumerate() {
        while simulation.clock().time() < state.time - 1e-9 {
            simulation.advance().expect("a step");
        }
        let body = &simulation.intruder().bodies()[0];
        let up = body.position.z - simulation.surface() - state.position.z;
        apart[1] = apart[1].max(libm::hypot(body.position.x - state.position.x, up));
        if state.time < 5.05e-3 {
            apart[0] = apart[1];
        }
        if state.time < 2.05e-3 {
            grains.push(OF_GRAINS.map(|name| {
                let ours = simulation.ledger().value(name).expect(name);
                [ours, budget.term(name).expect(name)[index]]
            }));
        }
    }
    let states = &log.bodies[0].states;
    let (first, last) = (states[0], states[states.len() - 1]);
    assert!(last.velocity.norm() < 0.9 * first.velocity.norm(), "the bed has not slowed it");
    assert!(apart[0] < APART[0] && apart[1] < APART[1], "apart by {apart:?} m");
    for (term, name) in OF_GRAINS.iter().enumerate() {
        let since_start = |at: usize| {
            let [start, now] = [grains[0][term], grains[at][term]];
            [now[0] - start[0], now[1] - start[1]]
        };
        let all = (0..grains.len()).map(since_start);
        let (most, difference) = all.fold((0.0_f64, 0.0_f64), |(most, difference), [a, b]| {
            (most.max(a.abs()), difference.max((a - b).abs()))
        });
        assert!(difference < ENERGY_APART * most, "{name}: {difference:e} of {most:e} J");
    }
}

#[test]
fn two_ranks_write_what_one_writes() {
    let paths = [1, 2].map(|ranks| {
        let (_folder, _, imported) = imported(ranks);
        assert_eq!(imported.summary.cost.threads, Some(ranks));
        read_run(&imported.files.log, Keep::States).expect("a log").bodies.remove(0).states
    });
    let [one, two] = paths;
    assert_eq!(one.len(), two.len());
    let apart = one.iter().zip(&two).map(|(a, b)| (a.position - b.position).norm());
    let apart = apart.fold(0.0, f64::max);
    assert!(apart < RANKS_APART, "apart by {apart:e} m");
}

#[test]
fn what_lammps_does_not_tell_is_absent_and_not_zero() {
    let (_folder, loaded, imported) = imported(1);
    let log = read_run(&imported.files.log, Keep::StatesAndEnergy).expect("a log");
    let budget = log.energy.expect("energies");
    assert_eq!(budget.closing, None);
    let known = |name: &String| name.starts_with("kinetic_") || name.starts_with("potential_");
    assert!(budget.terms.len() == 6 && budget.terms.iter().all(known), "{:?}", budget.terms);
    let summary = std::fs::read_to_string(&imported.files.summary).expect("a summary");
    for name in ["closure", "unaccounted_J", "elastic_J"] {
        assert!(!summary.contains(name), "{name} in {summary}");
    }
    assert_eq!(imported.summary.model_hash, loaded.model.hash());
    assert_eq!((imported.samples, imported.frames), (101, 3), "every 0.1 ms, and every 5 ms");
    let csv = exchange::export::Format::Csv;
    let out = tempfile::tempdir().expect("a folder");
    exchange::export::export(&imported.files.log, csv, out.path(), &|| false).expect("tables");
    let load =
        std::fs::read_to_string(out.path().join("intruder_intruder_load.csv")).expect("a table");
    let columns = load.lines().next().expect("a header");
    assert!(columns.contains("contact_z_N") && !columns.contains("area"), "{columns}");
}

/// The impact in LAMMPS on so many ranks, brought in.
fn imported(ranks: usize) -> (TempDir, Loaded, Imported) {
    let folder = tempfile::tempdir().expect("a folder");
    let loaded = model();
    in_lammps(folder.path(), &loaded, ranks, STEPS);
    let imported =
        import(folder.path(), &folder.path().join("lmp.mcap"), &|| false).expect("a run");
    (folder, loaded, imported)
}

fn model() -> Loaded {
    let folder =
        PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../validation/reference/crosscheck-2d");
    let text = "\
[run]
name = \"crosscheck\"
duration = \"80 ms\"
time_step = \"10 us\"
seed = 1

[medium]
kind = \"grains\"
dimension = 2
gravity = \"9.81 m/s^2\"

[container]
shape = \"box\"
width = \"0.560175 m\"
sides = \"wall\"
bottom = \"wall\"

[bed]
source = \"csv\"
file = \"grains.csv\"

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
mass = \"14.6 g\"

[impact]
speed = \"2 m/s\"
angle = \"60 deg\"
x = \"28 cm\"
";
    let source = ModelSource::Text { name: "crosscheck".into(), text: text.into(), folder };
    Model::load(source, &LoadOptions::default())
        .unwrap_or_else(|error| panic!("{}", error.render(configs::Color::Off)))
}
