//! What a model of grains takes on this machine, and what to do where that is too much.

use configs::estimate::{Estimate, MEMORY_SHARE, available_memory_bytes};
use configs::{BedSource, GrainModel, SidesKind};
use engine::grains::Space;
use engine::parallel::with_threads;
use runner::campaign::pace::{Pace, PaceError, is_prepared};
use serde_json::{Value, json};

use crate::common::Common;
use crate::output::{self, CommandError};

/// Diameters of the intruder that a bed leaves between it and each wall: side walls act over about one
/// (Seguin, Bertho & Gondret, Phys. Rev. E 78, 010301, 2008), so that a twentieth of what they do is left.
/// The floor acts over less, and the height of a bed stays as it is.
const TO_THE_WALL: f64 = 3.0;

/// A bed is no smaller by so little that it would be worth another one.
const WORTH_IT: f64 = 0.9;

/// How much faster cores are here than in LAMMPS, at least (`docs/performance.md`).
const OVER_LAMMPS: f64 = 2.9;

/// What a model of grains takes.
pub(crate) struct GrainCost {
    estimate: Estimate,
    threads: usize,
    /// Whether paces were measured on this machine.
    measured: bool,
    /// One impact at most (s).
    impact: Option<f64>,
    /// The bed (s), if it is still to be prepared and that was measured.
    bed: Option<f64>,
    is_prepared: bool,
    smaller: Option<Smaller>,
    /// Grains that memory holds here.
    most_grains: Option<u64>,
}

/// A smaller bed whose walls are still far enough.
struct Smaller {
    /// Width and depth (m); one of them in a plane.
    sides: Vec<f64>,
    /// Grains over those of the model (–).
    share: f64,
}

impl GrainCost {
    /// Of `grains`, measured if `measure` asks for it.
    pub(crate) fn of(
        grains: GrainModel<'_>,
        common: &Common,
        measure: bool,
    ) -> Result<Self, CommandError> {
        let cache = common.cache_folder();
        let pace = match measure {
            true => with_threads(1, || Pace::of(grains, &cache))
                .map_err(|error| CommandError::Failed(error.into()))?
                .map_err(refused)?,
            false => Pace::kept(grains, &cache),
        };
        let cores = || std::thread::available_parallelism().map_or(1, usize::from);
        let threads = common.threads.map_or_else(cores, usize::from);
        let estimate = Estimate::of(grains);
        let n = estimate.n_grains;
        let is_prepared = match &grains.medium.bed.source {
            BedSource::Settle(_) => is_prepared(grains, &cache),
            BedSource::Csv(_) => true,
        };
        let per_grain = estimate.memory_bytes as f64 / n.max(1) as f64;
        Ok(Self {
            estimate,
            threads,
            measured: pace.is_some(),
            impact: pace
                .zip(estimate.steps)
                .map_or(estimate.run_time_s, |(pace, steps)| Some(pace.impact(n, steps, threads))),
            bed: pace.filter(|_| !is_prepared).map(|pace| pace.preparation(n, threads)),
            is_prepared,
            smaller: Smaller::than(grains),
            most_grains: available_memory_bytes()
                .map(|bytes| (MEMORY_SHARE * bytes as f64 / per_grain) as u64),
        })
    }

    /// Names and values, as shown.
    pub(crate) fn lines(&self) -> Vec<(&'static str, String)> {
        let mut lines =
            vec![("memory", format!("about {}", output::bytes(self.estimate.memory_bytes)))];
        let threads = self.threads;
        if let Some(time) = self.impact {
            let how = match self.measured {
                true => format!("on {threads} threads"),
                false => {
                    "by the pace of another machine; --measure takes that of this one".to_owned()
                }
            };
            lines
                .push(("run time", format!("about {} at most, per impact, {how}", duration(time))));
        }
        lines.push((
            "bed",
            match (self.is_prepared, self.bed) {
                (true, _) => "there already".to_owned(),
                (false, Some(time)) => format!("about {} on top, once", duration(time)),
                (false, None) => "to be prepared; --measure says how long".to_owned(),
            },
        ));
        if let Some(Smaller { sides, share }) = &self.smaller {
            let sides: Vec<String> = sides.iter().map(|side| format!("{side:.3} m")).collect();
            lines.push((
                "smaller",
                format!(
                    "{} wide, {:.0} % of the grains: {TO_THE_WALL} diameters from intruder to wall",
                    sides.join(" x "),
                    100.0 * share
                ),
            ));
        }
        if let Some(most) = self.most_grains {
            let most = most as f64 / 1e6;
            lines.push((
                "larger",
                format!(
                    "LAMMPS under MPI, from {most:.0} million grains (memory here) or {OVER_LAMMPS} times \
                     these cores on"
                ),
            ));
        }
        lines
    }

    /// The same as a JSON object.
    pub(crate) fn json(&self) -> Value {
        json!({
            "memory_bytes": self.estimate.memory_bytes,
            "run_time_s": self.impact,
            "bed_time_s": if self.is_prepared { Some(0.0) } else { self.bed },
            "measured": self.measured,
            "threads": self.threads,
            "smaller": self.smaller.as_ref().map(|smaller| json!({
                "sides_m": smaller.sides,
                "share": smaller.share,
            })),
            "most_grains": self.most_grains,
        })
    }
}

impl Smaller {
    /// Than that of `grains`, if it is larger than has to be for vertical impacts in its middle. What
    /// moves sideways goes as far as nobody knows beforehand.
    fn than(grains: GrainModel<'_>) -> Option<Self> {
        let GrainModel { model, medium } = grains;
        let vertical = |angle_deg: f64| (angle_deg - 90.0).abs() < 1e-9;
        let all_vertical = model.conditions().iter().all(|one| vertical(one.angle_deg()));
        let settles = matches!(medium.bed.source, BedSource::Settle(_));
        let aside = medium.start.x.is_some() || medium.start.y.is_some();
        if !all_vertical || !settles || aside || medium.container.sides != SidesKind::Wall {
            return None;
        }
        let intruder = (model.intruder.shape.build)(&model.intruder.params, medium.space);
        let diameter = 2.0 * intruder.surface.bounding_radius();
        let wanted = (1.0 + 2.0 * TO_THE_WALL) * diameter;
        let sides = match medium.space {
            Space::Planar => vec![medium.container.width],
            Space::Spatial => vec![medium.container.width, medium.container.depth],
        };
        let smaller: Vec<f64> = sides.iter().map(|side| side.min(wanted)).collect();
        let share = smaller.iter().zip(&sides).fold(1.0, |share, (new, old)| share * new / old);
        (share < WORTH_IT).then_some(Self { sides: smaller, share })
    }
}

fn refused(error: PaceError) -> CommandError {
    match error {
        PaceError::Build(error) => CommandError::bad_input(error),
        PaceError::Step(error) => CommandError::Failed(error.into()),
    }
}

/// A duration in the unit that one would say.
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 1.0 => "1 s".to_owned(),
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s if s < 172_800.0 => format!("{:.0} h", s / 3600.0),
        s => format!("{:.0} days", s / 86_400.0),
    }
}
