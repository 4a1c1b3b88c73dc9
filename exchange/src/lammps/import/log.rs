//! The log of a run of LAMMPS.

use std::path::Path;

use engine::math::Vec3;
use engine::record::{BodyFrame, EventLevel, LogAttachment, LogSetup, LoggedBody, RunLog, Stamp};
use engine::stopping::Stopping;

use super::super::dump::Dump;
use super::super::facts::Facts;
use super::super::samples::Sample;
use super::error::ImportError;
use super::faller::{ENERGIES, Faller, Turned};
use crate::Stop;

/// Steps after which a chunk of the log ends.
const FLUSH_EVERY: u64 = 1000;

/// A force of this many weights of the intruder is drawn as long as the intruder is wide.
const WEIGHTS_PER_ARROW: f64 = 10.0;

/// Writes the logs of `path` and of the frames in `dump` into `folder`, and says how many frames
/// there are.
pub(super) fn write(
    facts: &Facts,
    faller: &Faller<'_>,
    path: &[Turned<'_>],
    mut dump: Dump,
    (folder, stop): (&Path, Stop<'_>),
) -> Result<usize, ImportError> {
    let mut log = RunLog::import(folder, &setup(facts, faller))?;
    let first = path[0];
    let (speed, angle) = (facts.impact.speed_m_per_s, facts.impact.angle_deg);
    let opening = format!("impact at {speed} m/s, {angle} deg from the horizontal");
    log.event(stamp(first.sample), EventLevel::Info, &opening)?;
    let mut stopping = Stopping::new(faller.followed(first));
    let (mut next, mut frames) = (dump.next()?, 0);
    for turned in path {
        if stop() {
            return Err(ImportError::Stopped);
        }
        let Turned { sample, orientation } = *turned;
        let at = stamp(sample);
        let state = faller.state(*turned);
        log.known_energies(at, &faller.energies(*turned))?;
        log.body_state(at, 0, &state)?;
        let (contact, weight) = (sample.force - facts.weight(), facts.weight());
        log.body_forces(at, 0, &[(contact, sample.torque), (weight, Vec3::zeros())])?;
        if let Some(frame) = next.take_if(|frame| frame.step <= sample.step) {
            if frame.step < sample.step {
                return Err(ImportError::Unpaired { step: frame.step });
            }
            let body = BodyFrame { state, orientation, force: contact };
            log.frame(at, &[body], &mut frame.grains.into_iter())?;
            frames += 1;
            next = dump.next()?;
        }
        let was_moving = stopping.stopping_time().is_none();
        stopping.observe(sample.time, faller.followed(*turned));
        if let (true, Some(time)) = (was_moving, stopping.stopping_time()) {
            let text = format!("stopped after {time:.6} s, {:.6} m deep", stopping.depth());
            log.event(at, EventLevel::Info, &text)?;
        }
    }
    log.finish()?;
    Ok(frames)
}

fn stamp(sample: &Sample) -> Stamp {
    Stamp { step: sample.step, time_s: sample.time }
}

fn setup(facts: &Facts, faller: &Faller<'_>) -> LogSetup {
    let radius = faller.radius();
    let weight = facts.weight().norm();
    let [width, depth] = facts.container_m;
    let metadata = [
        ("simulated_by", "LAMMPS".to_owned()),
        ("plunge_version", facts.plunge_version.clone()),
        ("name", facts.name.clone()),
        ("model_hash", facts.model_hash.clone()),
        ("seed", facts.seed.to_string()),
        ("speed_m_per_s", facts.impact.speed_m_per_s.to_string()),
        ("angle_deg", facts.impact.angle_deg.to_string()),
        ("dt_s", facts.time_step_s.to_string()),
        ("grains", facts.bed.grains.to_string()),
    ];
    LogSetup {
        flush_every: FLUSH_EVERY,
        checkpoint_every: u64::MAX,
        grains: true,
        bed: None,
        surface_z_m: facts.surface_m,
        bodies: vec![LoggedBody { name: facts.intruder.name.clone(), shape: faller.drawn.clone() }],
        container: Some((Vec3::zeros(), Vec3::new(width, depth, facts.surface_m + 2.0 * radius))),
        energy_terms: ENERGIES.map(str::to_owned).into(),
        force_origins: vec!["contact".to_owned(), "gravity".to_owned()],
        arrow_m_per_newton: match weight > 0.0 {
            true => 2.0 * radius / (WEIGHTS_PER_ARROW * weight),
            false => 0.0,
        },
        metadata: metadata.map(|(key, value)| (key.to_owned(), value)).into(),
        attachments: vec![LogAttachment {
            name: "model.resolved.toml".to_owned(),
            media_type: "application/toml".to_owned(),
            data: facts.model.clone().into_bytes(),
        }],
    }
}
