//! Claims about the log as a whole, on a small made-up run.

mod content;
mod restart;

use std::fs;
use std::path::Path;

use tempfile::TempDir;

use super::*;
use crate::math::{Quat, Vec3};

/// Steps between frames of the made-up run.
const FRAME_EVERY: u64 = 7;

/// An empty folder, removed when dropped.
fn empty_folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// The logs in `folder`.
fn files(folder: &TempDir) -> [Vec<u8>; 2] {
    [RUN_LOG, GRAIN_LOG].map(|name| fs::read(folder.path().join(name)).unwrap())
}

fn setup() -> LogSetup {
    let energy_terms = [
        "kinetic_intruder_J",
        "potential_gravity_J",
        "elastic_normal_elastic_J",
        "dissipated_sliding_J",
        "input_drive_J",
    ]
    .map(str::to_owned)
    .to_vec();
    LogSetup {
        flush_every: 20,
        checkpoint_every: 60,
        grains: true,
        bed: Some(BedChannels::ScalarsAndFields),
        surface_z_m: 0.3,
        bodies: vec![
            LoggedBody { name: "ball".to_owned(), shape: LoggedShape::Sphere { radius: 0.02 } },
            LoggedBody {
                name: "rear".to_owned(),
                shape: LoggedShape::Mesh {
                    vertices: vec![Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()],
                    triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
                },
            },
        ],
        container: Some((Vec3::new(-0.2, -0.2, 0.0), Vec3::new(0.2, 0.2, 0.5))),
        energy_terms,
        force_origins: vec!["contact".to_owned(), "gravity".to_owned()],
        arrow_m_per_newton: 0.01,
        metadata: [("seed".to_owned(), "7".to_owned())].into(),
        attachments: vec![LogAttachment {
            name: "model.toml".to_owned(),
            media_type: "application/toml".to_owned(),
            data: b"name = \"made-up\"\n".to_vec(),
        }],
    }
}

fn stamp(step: u64) -> Stamp {
    Stamp { step, time_s: step as f64 * 1e-5 }
}

/// Writes every message of one step of the made-up run.
fn write_step(log: &mut RunLog, step: u64, n_grains: u32) -> Result<(), RecordError> {
    let at = stamp(step);
    let x = libm::sin(step as f64 * 0.1);
    log.energy(at, &[x * x, 1.0, 0.5 * x, 2.0, 0.25], 1e-9 * x, 1e-9)?;
    let sample = BodySample {
        position: Vec3::new(x, 0.0, 0.3 - 0.01 * x),
        velocity: Vec3::new(0.0, 3.0, -4.0),
        spin: Vec3::new(0.0, x, 0.0),
        depth_m: 0.01 * x,
    };
    for body in 0..2 {
        log.body_state(at, body, &sample)?;
        let load = BodyLoad {
            forces: &[Vec3::new(x, 0.0, 1.0), Vec3::new(0.0, 0.0, -9.81)],
            torques: &[Vec3::new(0.0, 0.1 * x, 0.0), Vec3::zeros()],
            contacts: step as u32 % 5,
            area: 0.25 * x,
        };
        log.body_load(at, body, &load)?;
        let estimate =
            BodyEstimate { geometric_area: 0.5, force: Vec3::new(0.0, 0.0, x), magnitudes: 2.0 };
        log.body_estimate(at, body, &estimate)?;
    }
    log.bed_activity(at, 0.125)?;
    if step.is_multiple_of(FRAME_EVERY) {
        let body = BodyFrame {
            state: sample,
            orientation: Quat::identity(),
            force: Vec3::new(0.0, 0.0, 9.81),
        };
        let mut grains = (0..n_grains).map(|id| GrainSample {
            position: Vec3::new(f64::from(id) * 1e-3, 0.0, 0.3 + x * f64::from(id % 7)),
            radius: 1e-3,
            velocity: Vec3::new(x, -2.0, 2.0 * x),
            force: f64::from(id),
            id,
        });
        log.frame(at, &[body; 2], &mut grains)?;
    }
    if step == 8 {
        let field = FieldPoint {
            position: Vec3::new(0.1, 0.2, 0.4),
            packing_fraction: 0.5,
            velocity: Vec3::new(3.0, 0.0, -4.0),
            temperature: 0.25,
        };
        let crater = CraterPoint { position: Vec3::new(0.1, 0.0, 0.2), distance: 0.05 };
        log.bed_fields(at, &[field; 2], &[crater])?;
    }
    if step.is_multiple_of(50) {
        log.event(at, EventLevel::Info, &format!("step {step}"))?;
    }
    Ok(())
}

/// The run from `first` to `last`, completed.
fn write_rest(mut log: RunLog, first: u64, last: u64, n_grains: u32) {
    for step in first..=last {
        write_step(&mut log, step, n_grains).unwrap();
    }
    log.finish().unwrap();
}
