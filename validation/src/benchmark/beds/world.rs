//! Small beds in which something is hidden, and the measurements that are made on them.

use configs::{ConfigError, LoadOptions, Model, ModelSource};
use engine::bed::random;
use engine::grains::Space;
use measurements::{
    Bed, Condition, FinalDefinition, Frame, Geometry, Instrument, Kind, MeasurementSet, Role, Run,
    StatedBed, StopDefinition,
};
use runner::beds::{Impacts, Lie, Record};

use super::super::chance::normal;
use diagnosis::beds::observables::{at, depth_at_contact};
use diagnosis::beds::{BedError, BedModel, Variation};

/// The analyst's model of the bed.
pub(super) const MODEL: &str = include_str!("model.toml");

/// The analyst's model of a small bed.
pub(super) const SMALL: &str = include_str!("small.toml");

/// The analyst's model of a bed of spheres.
pub(super) const SPHERES: &str = include_str!("spheres.toml");

/// How well a bed is weighed and its packing is known: the packing fraction, and the bulk density, relative.
const PACKING_SIGMA: f64 = 0.003;
const DENSITY_SIGMA: f64 = 0.01;

/// Seeds of the beds that are measured: none of a diagnosis.
pub(super) const SEEDS: usize = 1_000_000;

/// Frames of the camera per second (1/s).
const RATE: f64 = 500.0;

/// Root mean square of one reading of a position (m).
const CAMERA: f64 = 1e-4;

/// Speeds (m/s) that are fitted to, and those that are held out.
const SPEEDS: ([f64; 3], [f64; 2]) = ([0.5, 1.0, 1.5], [0.75, 1.25]);

/// Frames before contact that a camera takes: a constant force is seen in them, and no grain.
const FLIGHT: usize = 10;

/// Frames behind the stop that it still takes.
const STILL: usize = 5;

/// The model of `text`, which is one of the above.
pub(super) fn load(text: String) -> Result<Model, ConfigError> {
    let source =
        ModelSource::Text { name: "the bed of the benchmark".to_owned(), text, folder: ".".into() };
    Ok(Model::load(source, &LoadOptions::default())?.model)
}

/// The campaign before anything is measured.
pub fn campaign(model: &Model) -> MeasurementSet {
    let (fit, held_out) = SPEEDS;
    let fit = fit.map(|speed| condition(model, speed, Role::Fit));
    let held_out = held_out.map(|speed| condition(model, speed, Role::Holdout));
    let (geometry, grain_diameter) = match model.grains().map(|grains| grains.medium.space) {
        Some(Space::Spatial) => (Geometry::Spatial, 4e-3),
        _ => (Geometry::Planar, 4.8e-3),
    };
    MeasurementSet {
        source: Some("impacts on small beds in which something is hidden".to_owned()),
        instrument: Instrument {
            rate: Some(RATE),
            position_sigma: Some(CAMERA),
            speed_sigma_rel: None,
            level_sigma: None,
            ..Instrument::default()
        },
        stop: StopDefinition::SpeedFivePercent,
        last: FinalDefinition::Deepest,
        ..MeasurementSet::new(
            "beds-benchmark",
            Kind::Trajectory,
            Bed { grain_diameter: Some(grain_diameter), ..Bed::new(geometry, None, 9.81) },
            fit.into_iter().chain(held_out).collect(),
        )
    }
}

fn condition(model: &Model, speed: f64, role: Role) -> Condition {
    Condition {
        role,
        ..Condition::straight_down(
            format!("v{speed}"),
            (model.intruder.shape.name, model.intruder.params.get("diameter"), model.intruder.mass),
            speed,
        )
    }
}

/// `repeats` runs under every condition of the set of `bed_model`, whose model is changed by `hidden`; the
/// beds and the noise of the camera follow from `seed`.
pub fn measure(
    bed_model: &BedModel<'_>,
    hidden: &Variation,
    (repeats, seed): (usize, u64),
    place: &dyn Impacts,
) -> Result<MeasurementSet, BedError> {
    let conditions: Vec<usize> = (0..bed_model.set.conditions.len()).collect();
    let draws = bed_model.draws(SEEDS * (1 + seed as usize), repeats, conditions.len());
    let records = place.run(&bed_model.jobs(&conditions, &draws, hidden)?)?;
    let mut set = bed_model.set.clone();
    for (number, record) in records.iter().enumerate() {
        let condition = number / repeats;
        if let Some(record) = record {
            let seen = seen(record, (condition, bed_model.set), (number, seed), Errors::default());
            set.runs.push(seen);
        }
    }
    Ok(set)
}

/// What one would say of the bed of the set of `bed_model` who looks at three beds with `hidden`, with errors of his own.
///
/// # Errors
/// If the beds cannot be prepared.
pub(super) fn weighed(
    bed_model: &BedModel<'_>,
    hidden: &Variation,
    seed: u64,
    place: &dyn Impacts,
) -> Result<Bed, BedError> {
    let draws = bed_model.draws(SEEDS * (1 + seed as usize), 3, 1);
    let lies = place.lies(&bed_model.jobs(&[0], &draws, hidden)?)?;
    Ok(stated(&lies, bed_model.set.bed, seed))
}

/// What one would say of `bed` who looks at beds that lie so, with errors of his own.
pub(super) fn stated(lies: &[Lie], bed: Bed, seed: u64) -> Bed {
    let mean =
        |number: fn(&Lie) -> f64| lies.iter().map(number).sum::<f64>() / lies.len().max(1) as f64;
    let mut random = random(seed, "weighing");
    let packing = mean(|one| one.packing_fraction) + PACKING_SIGMA * normal(&mut random);
    let density = mean(|one| one.bulk_density) * (1.0 + DENSITY_SIGMA * normal(&mut random));
    let stated = StatedBed {
        packing_fraction: Some(packing),
        packing_fraction_sigma: Some(PACKING_SIGMA),
        bulk_density_sigma: Some(DENSITY_SIGMA * density),
        ..StatedBed::default()
    };
    Bed { bulk_density: Some(density), stated, ..bed }
}

/// What a laboratory is wrong about.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Errors {
    /// Depth (m) of what a set calls the surface.
    pub(super) level: f64,
    /// Time (s) of what a run calls first contact.
    pub(super) clock: f64,
}

/// A run as a camera sees it.
pub(super) fn seen(
    record: &Record,
    (condition, set): (usize, &MeasurementSet),
    (number, seed): (usize, u64),
    errors: Errors,
) -> Run {
    let mut random = random(seed, &format!("camera {number}"));
    let end = record.stopping_time.unwrap_or(record.end);
    let frames = FLIGHT + (end * RATE).ceil() as usize + STILL;
    let times: Vec<f64> = (0..frames).map(|frame| (frame as f64 - FLIGHT as f64) / RATE).collect();
    let of_set = &set.conditions[condition];
    let path = times.iter().map(|&time| {
        let (z, x) = at(record, time + errors.clock, of_set, set);
        (z - errors.level, x)
    });
    let deepest = depth_at_contact(record, set) + record.deepest - errors.level
        + CAMERA * normal(&mut random);
    let seen = times.iter().zip(path).map(|(&t, (z, x))| Frame {
        t,
        z: z + CAMERA * normal(&mut random),
        x: x + CAMERA * normal(&mut random),
        sigma: None,
    });
    Run {
        order: Some(number as i64),
        final_z: Some(deepest),
        frames: seen.collect(),
        ..Run::new(format!("r{number:03}"), condition)
    }
}
