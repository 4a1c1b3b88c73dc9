//! Checkpoints and prepared beds.

use std::fs;
use std::sync::LazyLock;

use configs::{GrainModel, LoadOptions, Loaded, Model, ModelSource};
use engine::checkpoint::{self, FORMAT};
use engine::grain_bed::RestingBed;
use engine::simulation::{Simulation, Snapshot};

/// An input that begins so is the payload of a prepared bed.
pub const BED: u8 = b'B';

/// An input that begins so is the payload of a checkpoint; any other is a whole file.
pub const STATE: u8 = b'S';

/// Steps that are asked of a state which was taken back.
const STEPS: usize = 3;

/// What inputs belong to.
const KEY: [u8; 32] = [7; 32];

const MODEL: &str = r#"
[run]
name = "three"
duration = "10 ms"
time_step = "10 us"
seed = 1
[medium]
kind = "grains"
dimension = 2
gravity = "9.81 m/s^2"
[container]
shape = "box"
width = "40 mm"
sides = "wall"
bottom = "wall"
[bed]
source = "csv"
file = "grains.csv"
[contact_law]
name = "linear-spring-dashpot"
normal_stiffness = "3200 N/m"
normal_damping_rate = "1e4 1/s"
friction = 0.28
[intruder]
shape = "disc"
diameter = "1 cm"
mass = "10 g"
[impact]
speed = "2 m/s"
angle = "80 deg"
"#;

const GRAINS: &str = "x_m,y_m,radius_m,mass_kg\n0.01,0.005,0.005,0.001\n0.02,0.005,0.005,0.001\n\
                      0.03,0.005,0.005,0.001\n";

static LOADED: LazyLock<Loaded> = LazyLock::new(|| {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("grains.csv"), GRAINS).expect("a temporary file");
    let folder = folder.path().to_owned();
    let source = ModelSource::Text { name: "three".into(), text: MODEL.into(), folder };
    Model::load(source, &LoadOptions::default()).expect("a model")
});

fn grains() -> GrainModel<'static> {
    LOADED.model.grains().expect("a bed of grains")
}

/// Its bed before anything has touched it.
///
/// # Panics
/// Never: the model is a constant.
pub fn bed() -> RestingBed {
    grains().read_bed().expect("a bed from a table")
}

/// An impact on `resting`, if there can be one.
fn impact(resting: &RestingBed) -> Option<Simulation> {
    grains().simulation(resting, &LOADED.model.conditions()[0]).ok()
}

/// The states of an impact on [`bed`] after so many steps each.
///
/// # Panics
/// Never: the model is a constant.
pub fn states(steps: &[u64]) -> Vec<Snapshot> {
    let mut simulation = impact(&bed()).expect("an impact");
    let mut advance_to = |step| {
        while simulation.clock().step < step {
            simulation.advance().expect("a step");
        }
        simulation.save()
    };
    steps.iter().map(|&step| advance_to(step)).collect()
}

/// What comes of the file `bytes`, or of a sound file with this payload: it is refused, or taken back and
/// stepped on.
///
/// # Panics
/// Where it is neither.
pub fn outcome(bytes: &[u8]) -> String {
    let Some((&kind, payload)) = bytes.split_first() else { return "nothing".to_owned() };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let here = folder.path().display().to_string();
    let path = folder.path().join("state");
    let file = match kind {
        BED | STATE => with_head(payload),
        _ => bytes.to_vec(),
    };
    fs::write(&path, file).expect("a temporary file");
    let said = match kind {
        BED => match checkpoint::load::<RestingBed>(&path, &KEY) {
            Ok(resting) if resting.is_sound(bed().grains.len() as u64) => step(impact(&resting)),
            Ok(_) => "a bed that is not sound".to_owned(),
            Err(error) => error.to_string(),
        },
        _ => match checkpoint::load::<Snapshot>(&path, &KEY) {
            Ok(snapshot) => {
                let simulation = impact(&bed());
                step(simulation.and_then(|mut one| one.restore(snapshot).then_some(one)))
            }
            Err(error) => error.to_string(),
        },
    };
    said.replace(&here, "")
}

/// `payload` in a file whose head and checksum are right.
fn with_head(payload: &[u8]) -> Vec<u8> {
    let mut file = b"plunge\0\x01".to_vec();
    file.extend_from_slice(&FORMAT.to_le_bytes());
    file.extend_from_slice(&KEY);
    file.extend_from_slice(blake3::hash(payload).as_bytes());
    file.extend_from_slice(payload);
    file
}

/// A few steps, each done or refused.
fn step(simulation: Option<Simulation>) -> String {
    let Some(mut simulation) = simulation else { return "of another run".to_owned() };
    for _ in 0..STEPS {
        if let Err(error) = simulation.advance() {
            return error.to_string();
        }
    }
    "stepped".to_owned()
}
