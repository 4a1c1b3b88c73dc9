//! Sets of a sphere that falls into the bed of the rig, and their diagnosis.

use std::f64::consts::PI;

use configs::{LoadOptions, Model, ModelSource, find_shipped};
use diagnosis::bench::{Bench, DEFAULT_SEED};
use diagnosis::diagnose::diagnose;
use diagnosis::observed::Observed;
use diagnosis::resistive::ResistiveForward;
use diagnosis::verdict::Diagnosis;
use measurements::{
    Bed, Condition, Feasible, FinalDefinition, Geometry, Instrument, Kind, MeasurementSet, Role,
    StatedBed, StatedError, StopDefinition,
};
use rand::RngExt;
use rand_pcg::Pcg64;

use super::rig::{BED, DIAMETER, MASS};

/// Straight down at `speed` (m/s).
pub(crate) fn condition(speed: f64) -> Condition {
    Condition {
        id: format!("v{speed}"),
        role: Role::Fit,
        speed,
        angle_deg: 90.0,
        shape: "sphere".into(),
        diameter: DIAMETER,
        mass: MASS,
        spin: 0.0,
        packing: None,
        bed_depth: None,
        bed: None,
        length: None,
        height: None,
        shaft_diameter: None,
        apex_deg: None,
        link_angle_deg: None,
    }
}

/// A normal number (Box & Muller).
pub(crate) fn normal(random: &mut Pcg64) -> f64 {
    let [a, b] = [(); 2].map(|()| random.random::<f64>());
    (-2.0 * libm::log(1.0 - a)).sqrt() * libm::cos(2.0 * PI * b)
}

/// A set without runs.
pub(crate) fn of_spheres(
    id: &str,
    (kind, instrument): (Kind, Instrument),
    conditions: Vec<Condition>,
) -> MeasurementSet {
    MeasurementSet {
        id: id.into(),
        source: None,
        kind,
        instrument,
        bed: Bed {
            geometry: Geometry::Spatial,
            bulk_density: Some(BED.bulk_density),
            gravity: BED.gravity,
            grain_diameter: None,
            stated: StatedBed::default(),
        },
        beds: Vec::new(),
        baseline: None,
        stated: StatedError::default(),
        stop: StopDefinition::ComponentZero,
        last: FinalDefinition::Resting,
        feasible: Feasible::default(),
        priors: Vec::new(),
        conditions,
        runs: Vec::new(),
        keep: Vec::new(),
        notes: Vec::new(),
    }
}

/// What is said of `set` from the two-term law.
pub(crate) fn diagnosed(set: &MeasurementSet) -> Diagnosis {
    let observed = Observed::of(set);
    let shipped = find_shipped("two-term-vector").expect("a shipped model");
    let source = ModelSource::Text {
        name: "two-term-vector.toml".to_owned(),
        text: shipped.text.to_owned(),
        folder: ".".into(),
    };
    let model = Model::load(source, &LoadOptions::default()).expect("a model").model;
    let forward =
        ResistiveForward::new(&model, set, &observed.layouts()).expect("a model for spheres");
    diagnose(&Bench { set, observed: &observed, forward: &forward }, DEFAULT_SEED)
        .expect("spheres stop")
}
