//! What a bed of grains takes on this machine, measured on a column of it.
//!
//! A column is as high as the bed, of the same grains under the same laws, and narrower: it falls, calms and
//! comes to rest in about as many steps, but of a few hundred grains. What was measured is kept beside the
//! prepared beds, so that a bed is looked at once.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use configs::{BedSource, BuildError, GrainMedium, GrainModel};
use engine::body::NoIntruder;
use engine::checkpoint::write_whole;
use engine::error::StepError;
use engine::grains::Space;
use engine::world::World;

use crate::run::{bed_file, bed_key, result_key};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Grains of a column: enough for an inside, few enough for some seconds.
const GRAINS: f64 = 500.0;

/// Diameters of the largest grain that a column is at least wide, in a plane and in space: walls hold up
/// what is narrower.
const NARROWEST: [f64; 2] = [8.0, 5.0];

/// Most grains of a column; a bed so high is not looked at.
const MOST: u64 = 5000;

/// How long a column may take.
const PATIENCE: Duration = Duration::from_secs(30);

/// Steps of a bed at rest whose time is taken.
const AT_REST: usize = 1000;

/// Share of the pace of a second and every further thread, in a bed that is large enough to be shared.
const OF_FURTHER_THREADS: f64 = 0.75;

/// Grains from which on a bed is shared among threads to any use.
const SHARED: u64 = 4000;

/// What a whole bed takes over a column of it, per grain: it is at rest some steps later, and does not fit
/// into the nearest cache (1.1 to 1.6 in five beds, `docs/campaigns.md`).
const WHOLE_OVER_COLUMN: f64 = 1.35;

/// Time for writing the five messages of a step (s): 0.6 million a second.
const LOG_PER_STEP: f64 = 5.0 / 0.6e6;

/// How fast a bed is prepared and stepped by one thread.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pace {
    /// Steps until the bed is at rest.
    pub settling_steps: u64,
    /// Grain-steps per second while it settles.
    pub settling_per_s: f64,
    /// Grain-steps per second of a bed at rest under the laws, effects and forces of the run.
    pub resting_per_s: f64,
}

/// Why the pace of a bed is not known.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum PaceError {
    #[error(transparent)]
    Build(#[from] BuildError),
    #[error(transparent)]
    Step(#[from] StepError),
}

impl Pace {
    /// Of the bed of `model`, as it was measured before with the cache in `folder`, else measured now; in
    /// a pool of one thread, since what it tells is the pace of one. `None` of a bed that is read from a table, and of a column
    /// that does not come to rest in half a minute.
    ///
    /// # Errors
    /// If the bed cannot be built, or a step of it not be trusted.
    pub fn of(model: GrainModel<'_>, folder: &Path) -> Result<Option<Self>, PaceError> {
        if let Some(kept) = Self::kept(model, folder) {
            return Ok(Some(kept));
        }
        let Some(medium) = column(model) else { return Ok(None) };
        let pace = Self::measure(GrainModel { model: model.model, medium: &medium })?;
        if let Some(pace) = pace {
            let _ = fs::create_dir_all(folder.join(FOLDER));
            // Without it the bed is looked at again, which is no error.
            let file = file_of(model, folder);
            let _ = write_whole(&file, format!("{:#}\n", serde_json::json!(pace)).as_bytes());
        }
        Ok(pace)
    }

    /// As it was measured before with the cache in `folder`, if it was.
    pub fn kept(model: GrainModel<'_>, folder: &Path) -> Option<Self> {
        let text = fs::read_to_string(file_of(model, folder)).ok()?;
        serde_json::from_str(&text).ok()
    }

    fn measure(column: GrainModel<'_>) -> Result<Option<Self>, PaceError> {
        let Some(mut settling) = column.settling()? else { return Ok(None) };
        let grains = column.n_grains() as f64;
        let per_s = |steps: usize, from: Instant| {
            grains * steps as f64 / from.elapsed().as_secs_f64().max(f64::MIN_POSITIVE)
        };
        let (start, mut steps) = (Instant::now(), 0);
        while !settling.is_at_rest() {
            settling.advance()?;
            steps += 1;
            if start.elapsed() > PATIENCE {
                return Ok(None);
            }
        }
        let settling_per_s = per_s(steps, start);
        let bed = column.bed(&settling.bed().resting());
        let mut world = World::new(bed, Box::new(NoIntruder), column.time_step()?);
        let start = Instant::now();
        for _ in 0..AT_REST {
            world.advance()?;
        }
        let resting_per_s = per_s(AT_REST, start);
        let settling_steps = steps as u64;
        Ok((steps > 0).then_some(Self { settling_steps, settling_per_s, resting_per_s }))
    }

    /// Time (s) for preparing a bed of so many `grains` on so many `threads`.
    pub fn preparation(&self, grains: u64, threads: usize) -> f64 {
        let work = self.settling_steps as f64 * grains as f64;
        WHOLE_OVER_COLUMN * work / (self.settling_per_s * speed_up(grains, threads))
    }

    /// Time (s) for so many `steps` of an impact on it, with its log.
    pub fn impact(&self, grains: u64, steps: u64, threads: usize) -> f64 {
        let per_step = grains as f64 / (self.resting_per_s * speed_up(grains, threads));
        steps as f64 * (per_step + LOG_PER_STEP)
    }
}

/// Whether the bed of `model` is prepared already, in the cache in `folder`.
pub fn is_prepared(model: GrainModel<'_>, folder: &Path) -> bool {
    bed_file(folder, &bed_key(model)).is_file()
}

/// How much faster `threads` are than one.
fn speed_up(grains: u64, threads: usize) -> f64 {
    match grains < SHARED {
        true => 1.0,
        false => 1.0 + OF_FURTHER_THREADS * (threads.max(1) - 1) as f64,
    }
}

/// In the cache.
const FOLDER: &str = "paces";

/// Of the bed and of what acts in it: beds settle without the effects of a run.
fn file_of(model: GrainModel<'_>, folder: &Path) -> PathBuf {
    let medium = model.medium;
    let laws = std::iter::once(&medium.contact_law).chain(&medium.effects);
    let laws = laws.map(|law| (law.entry.name, &law.params));
    let forces = medium.grain_forces.iter().map(|force| (force.entry.name, &force.params));
    let at_work: Vec<(&str, Vec<(&str, f64)>)> =
        laws.chain(forces).map(|(name, params)| (name, params.iter().collect())).collect();
    let key = result_key(&format!("{:?}\n{at_work:?}", bed_key(model)));
    let name = bed_file(folder, &key).file_stem().unwrap_or_default().to_owned();
    folder.join(FOLDER).join(name).with_extension("json")
}

/// A column of the bed of `model`; none of a bed that does not settle.
fn column(model: GrainModel<'_>) -> Option<GrainMedium> {
    let mut medium = model.medium.clone();
    let BedSource::Settle(settle) = &mut medium.bed.source else { return None };
    let (axes, diameters) = match medium.space {
        Space::Planar => (1, NARROWEST[0]),
        Space::Spatial => (2, NARROWEST[1]),
    };
    let narrowest = diameters * model.largest_grain();
    let wanted = (GRAINS / model.n_grains() as f64).min(1.0);
    let across = if axes == 1 { wanted } else { wanted.sqrt() };
    let narrowed = |length: f64| (across * length).max(narrowest).min(length);
    let container = &mut medium.container;
    let (width, depth) = (container.width, container.depth);
    container.width = narrowed(width);
    container.depth = if axes == 1 { depth } else { narrowed(depth) };
    let mut share = container.width / width;
    if axes == 2 {
        share *= container.depth / depth;
    }
    for kind in &mut settle.grains {
        kind.count = (share * kind.count as f64).round().max(1.0) as u64;
    }
    (GrainModel { model: model.model, medium: &medium }.n_grains() <= MOST).then_some(medium)
}

#[cfg(test)]
mod tests {
    use configs::{LoadOptions, Model, ModelSource};

    use super::*;

    fn model(name: &str) -> Model {
        let loaded =
            Model::load(ModelSource::from_argument(Path::new(name)), &LoadOptions::default());
        loaded.unwrap_or_else(|error| panic!("{}", error.render(configs::Color::Off))).model
    }

    #[test]
    fn a_column_is_as_high_as_its_bed() {
        let model = model("vertical-2d");
        let grains = model.grains().expect("a bed");
        let medium = column(grains).expect("it settles");
        let narrow = GrainModel { model: &model, medium: &medium }.n_grains() as f64;
        let of_width = medium.container.width / grains.medium.container.width;
        // Whole grains: one of each kind too many or too few is below a hundredth of five hundred.
        assert!((narrow / grains.n_grains() as f64 / of_width - 1.0).abs() < 0.01);
        // Of the 500 that were wanted it has more, since it would be too narrow.
        assert!((500.0..1000.0).contains(&narrow), "{narrow}");
    }

    #[test]
    fn a_bed_is_looked_at_once() {
        let model = model(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../configs/schema/tests/good/small-2d.toml"
        ));
        let grains = model.grains().expect("a bed");
        let folder = tempfile::tempdir().expect("a folder");
        assert_eq!(Pace::kept(grains, folder.path()), None);
        let pace = Pace::of(grains, folder.path()).expect("steps").expect("it comes to rest");
        assert!(
            pace.settling_steps > 1000 && pace.settling_per_s > 0.0 && pace.resting_per_s > 0.0
        );
        assert_eq!(Pace::kept(grains, folder.path()), Some(pace));
        // Measured again it would hardly be the same to the last bit.
        assert_eq!(Pace::of(grains, folder.path()).expect("kept"), Some(pace));
        let one = pace.impact(300, 5000, 1);
        assert!((pace.impact(300, 10_000, 1) / one - 2.0).abs() < 1e-12, "it goes with the steps");
    }
}
