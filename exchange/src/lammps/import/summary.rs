//! What a run of LAMMPS came to.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use engine::stopping::Stopping;
use runner::run::{CostSummary, EnergySummary, FinalEnergy, StopSummary, Summary};

use super::super::facts::Facts;
use super::faller::{Faller, Turned};

/// What LAMMPS calls its output unless told otherwise.
const LAMMPS_LOG: &str = "log.lammps";

/// Of the run along `path`, without what LAMMPS does not tell; what it cost is in the output of
/// LAMMPS, if that is in `folder`.
pub(super) fn of(
    facts: &Facts,
    faller: &Faller<'_>,
    path: &[Turned<'_>],
    folder: &Path,
) -> Summary {
    let (first, last) = (path[0], path[path.len() - 1]);
    let output = fs::read_to_string(folder.join(LAMMPS_LOG)).unwrap_or_default();
    Summary {
        name: facts.name.clone(),
        version: facts.plunge_version.clone(),
        model_hash: facts.model_hash.clone(),
        medium: "grains".to_owned(),
        impact: facts.impact.clone(),
        stop: stop(faller, path),
        energy: energy(facts, [first, last].map(|at| faller.energies(at))),
        bed: Some(facts.bed.clone()),
        forces: None,
        intrusion: None,
        links: Vec::new(),
        cost: cost(facts, last.sample.step, &output),
    }
}

/// Until the impact is over by the rules of plunge, however long LAMMPS went on.
fn stop(faller: &Faller<'_>, path: &[Turned<'_>]) -> StopSummary {
    let mut stopping = Stopping::new(faller.followed(path[0]));
    for at in &path[1..] {
        if stopping.is_over() {
            break;
        }
        stopping.observe(at.sample.time, faller.followed(*at));
    }
    StopSummary {
        stopped: stopping.stopping_time().is_some(),
        stopping_time_s: stopping.stopping_time(),
        stopping_time_z_s: stopping.vertical_time(),
        stopping_time_x_s: stopping.horizontal_time(),
        rest_time_s: stopping.rest_time(),
        depth_m: stopping.depth(),
        range_m: stopping.range(),
    }
}

fn energy(facts: &Facts, [start, end]: [[f64; 6]; 2]) -> EnergySummary {
    let [_, _, grains_translation, grains_rotation, _, grains_height] =
        std::array::from_fn::<f64, 6, _>(|term| end[term] - start[term]);
    EnergySummary {
        initial: facts.impact_energy,
        at_end: FinalEnergy {
            intruder: end[0] + end[1] + end[4] - start[4],
            grains: grains_translation + grains_rotation + grains_height,
            elastic: None,
        },
        dissipated: BTreeMap::new(),
        input: BTreeMap::new(),
        released: Some(start[4] - end[4]),
        unaccounted: None,
        closure: None,
    }
}

/// From lines like `Loop time of 1.5 on 2 procs for 100 steps with 601 atoms`, one for every `run`.
fn cost(facts: &Facts, steps: u64, output: &str) -> CostSummary {
    let loops = output.lines().filter_map(|line| line.strip_prefix("Loop time of "));
    let runs: Vec<(f64, f64)> = loops
        .filter_map(|line| {
            let mut numbers = line.split_whitespace().filter_map(|word| word.parse().ok());
            Some((numbers.next()?, numbers.next()?))
        })
        .collect();
    let wall = (!runs.is_empty()).then(|| runs.iter().fold(0.0, |sum, (wall, _)| sum + wall));
    let grain_steps = steps as f64 * facts.bed.grains as f64;
    CostSummary {
        steps,
        dt_s: Some(facts.time_step_s),
        threads: runs.last().map(|(_, processes)| *processes as usize),
        wall_s: wall,
        grain_steps_per_s: wall.filter(|wall| *wall > 0.0).map(|wall| grain_steps / wall),
    }
}
