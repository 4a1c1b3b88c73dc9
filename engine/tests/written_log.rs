//! Writes a log for readers other than ours: `examples/read_log.py` takes it as it is.

use std::path::Path;

use engine::math::{Quat, Vec3};
use engine::record::{
    BodyFrame, BodyLoad, BodySample, EventLevel, GrainSample, LogSetup, LoggedBody, LoggedShape,
    RunLog, Stamp,
};

const LAST: u64 = 20_000;
const DT: f64 = 1e-5;
const MASS: f64 = 0.05;
const GRAVITY: f64 = 9.81;
const DRAG: f64 = 0.2;

/// A ball that falls through a viscous fluid, with a ledger that is summed up as an engine would.
///
/// Leaves `run.mcap` and `grains.mcap` in the folder `written-log` of the tests' scratch space and
/// prints the rate at which scalars were written.
#[test]
fn a_log_of_scalars_every_step_and_frames_is_written_for_other_readers() {
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join("written-log");
    std::fs::create_dir_all(&dir).unwrap();
    let mut log = RunLog::create(&dir, &setup()).unwrap();
    let start = std::time::Instant::now();
    let (mut speed, mut depth, mut lost) = (2.0, 0.0, 0.0);
    let total = |speed: f64, depth: f64, lost: f64| {
        [0.5 * MASS * speed * speed, -MASS * GRAVITY * depth, lost, 0.0]
    };
    let sum = |terms: [f64; 4]| terms[0] + terms[1] + terms[2] - terms[3];
    let initial = sum(total(speed, depth, lost));
    for step in 0..=LAST {
        let at = Stamp { step, time_s: step as f64 * DT };
        let terms = total(speed, depth, lost);
        let unaccounted = sum(terms) - initial;
        log.energy(at, &terms, unaccounted, (unaccounted / initial).abs()).unwrap();
        let sample = BodySample {
            position: Vec3::new(0.0, 0.0, 0.1 - depth),
            velocity: Vec3::new(0.0, 0.0, -speed),
            spin: Vec3::zeros(),
            depth_m: depth,
        };
        log.body_state(at, 0, &sample).unwrap();
        let load = BodyLoad {
            forces: &[Vec3::new(0.0, 0.0, DRAG * speed), Vec3::new(0.0, 0.0, -MASS * GRAVITY)],
            torques: &[Vec3::zeros(), Vec3::zeros()],
            contacts: 0,
            area: 0.0,
        };
        log.body_load(at, 0, &load).unwrap();
        if step.is_multiple_of(500) {
            let body =
                BodyFrame { state: sample, orientation: Quat::identity(), force: load.forces[0] };
            log.frame(at, &[body], &mut grains()).unwrap();
        }
        let middle = speed + 0.5 * DT * (GRAVITY - DRAG / MASS * speed);
        lost += DRAG * middle * middle * DT;
        depth += middle * DT;
        speed += DT * (GRAVITY - DRAG / MASS * middle);
    }
    log.event(Stamp { step: LAST, time_s: LAST as f64 * DT }, EventLevel::Info, "end").unwrap();
    let rate = 3.0 * LAST as f64 / start.elapsed().as_secs_f64();
    eprintln!("{rate:.0} messages/s");
    log.finish().unwrap();
    assert!(dir.join("run.mcap").exists() && dir.join("grains.mcap").exists());
}

fn grains() -> impl Iterator<Item = GrainSample> {
    (0..1000_u32).map(|id| GrainSample {
        position: Vec3::new(f64::from(id % 50) * 0.002 - 0.05, 0.0, f64::from(id / 50) * 0.002),
        radius: 0.001,
        velocity: Vec3::zeros(),
        force: 0.0,
        id,
    })
}

fn setup() -> LogSetup {
    LogSetup {
        flush_every: 1000,
        checkpoint_every: 10_000,
        grains: true,
        bed: None,
        surface_z_m: 0.1,
        bodies: vec![LoggedBody {
            name: "ball".to_owned(),
            shape: LoggedShape::Disc { radius: 0.02, thickness: 0.002 },
        }],
        container: Some((Vec3::new(-0.05, -0.001, 0.0), Vec3::new(0.05, 0.001, 0.2))),
        energy_terms: [
            "kinetic_intruder_J",
            "potential_gravity_J",
            "dissipated_drag_J",
            "input_drive_J",
        ]
        .map(str::to_owned)
        .to_vec(),
        force_origins: vec!["contact".to_owned(), "gravity".to_owned()],
        arrow_m_per_newton: 0.05,
        metadata: [("seed".to_owned(), "1".to_owned())].into(),
        attachments: Vec::new(),
    }
}
