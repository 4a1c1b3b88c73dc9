//! A bed of a few hundred discs, and sets that are measured on it.

use configs::{LoadOptions, Model, ModelSource};
use measurements::{
    Bed, Condition, FinalDefinition, Geometry, Instrument, Kind, MeasurementSet, Role,
    StopDefinition,
};

/// 360 discs of two sizes, twelve wide and fourteen deep, and a disc of four of them.
const MODEL: &str = r#"
[run]
name = "small"
duration = "0.12 s"
time_step = "20 us"
seed = 1
[medium]
kind = "grains"
dimension = 2
gravity = "9.81 m/s^2"
[container]
shape = "box"
width = "12 cm"
sides = "periodic"
bottom = "wall"
[bed]
source = "settle"
preparation_friction = 0.3
[[bed.grains]]
count = 260
diameter = "4.5 mm"
mass = "0.049 g"
[[bed.grains]]
count = 100
diameter = "5.5 mm"
mass = "0.073 g"
[contact_law]
name = "linear-spring-dashpot"
normal_stiffness = "800 N/m"
normal_damping_rate = "3e3 1/s"
tangential_damping_rate = "1e3 1/s"
friction = 0.3
[intruder]
shape = "disc"
diameter = "2 cm"
mass = "3 g"
[impact]
speed = "1 m/s"
angle = "90 deg"
x_range = ["1 mm", "12 cm"]
"#;

/// The model, changed by `sets`.
pub(crate) fn model(sets: &[&str]) -> Model {
    load(MODEL.into(), sets)
}

/// The model, whose disc is pushed 2 cm down.
pub(crate) fn pushed() -> Model {
    let text = MODEL.replace(
        "[impact]\nspeed = \"1 m/s\"",
        "[intrusion]\nspeed = \"20 cm/s\"\ndepth = \"2 cm\"",
    );
    load(text, &[])
}

fn load(text: String, sets: &[&str]) -> Model {
    let source = ModelSource::Text { name: "small".into(), text, folder: ".".into() };
    let sets = sets.iter().map(|set| (*set).to_owned()).collect();
    let options = LoadOptions { sets, ..LoadOptions::default() };
    Model::load(source, &options).expect("the model is sound").model
}

/// A vertical impact of the disc of the model.
pub(crate) fn condition(speed: f64, role: Role) -> Condition {
    Condition {
        role,
        ..Condition::straight_down(format!("{speed} m/s"), ("disc", 0.02, 3e-3), speed)
    }
}

/// A set under these conditions that nobody has measured yet.
pub(crate) fn empty_set(conditions: Vec<Condition>) -> MeasurementSet {
    MeasurementSet {
        instrument: Instrument {
            rate: Some(1000.0),
            position_sigma: Some(1e-4),
            speed_sigma_rel: None,
            level_sigma: None,
            ..Instrument::default()
        },
        stop: StopDefinition::SpeedFivePercent,
        last: FinalDefinition::Deepest,
        ..MeasurementSet::new(
            "small",
            Kind::Scalar,
            Bed { grain_diameter: Some(0.0048), ..Bed::new(Geometry::Planar, Some(2.4), 9.81) },
            conditions,
        )
    }
}
