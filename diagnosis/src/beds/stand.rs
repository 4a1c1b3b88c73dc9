//! A model of grains before a measurement set: which impact stands for which condition and bed.

use std::path::PathBuf;
use std::sync::Arc;

use configs::{
    BedSource, ConfigError, GrainMedium, GrainModel, LoadOptions, Medium, Model, ModelSource,
};
use engine::bed::random;
use engine::grains::Space;
use measurements::{Condition, Geometry, MeasurementSet};
use rand::RngExt;
use runner::beds::Job;
use thiserror::Error;

use super::variation::Variation;

/// Most impacts on one bed, side by side.
const MOST_PLACES: usize = 4;

/// Most beds per draw of a condition: what settles is then no more work than what falls on it.
const MOST_BEDS: usize = 2;

/// Least distance of two of them, in diameters of the intruder: beyond it they move other grains.
const APART: f64 = 2.0;

/// Time behind the stop until an impact is over, and what repeats scatter by (s).
const BEHIND: f64 = 0.02;

/// Share of the duration of a run that an impact of unknown length is expected to take.
const EXPECTED: f64 = 0.5;

/// Why a model of grains cannot stand before a set.
#[derive(Debug, Error)]
pub enum StandError {
    /// It is of the other kind.
    #[error("`{model}` has no bed of grains")]
    NoGrains {
        /// Name of the model.
        model: String,
    },
    /// Discs before a set in space, or the other way round.
    #[error("`{model}` is a bed in {model_space}, and the set is one in {set_space}")]
    Geometry {
        /// Name of the model.
        model: String,
        /// `2d` or `3d`.
        model_space: &'static str,
        /// `2d` or `3d`.
        set_space: &'static str,
    },
    /// A condition, or a changed model, that is not a model.
    #[error("condition {condition}: {source}")]
    Config {
        /// Id of the condition.
        condition: String,
        /// What is wrong with it.
        source: ConfigError,
    },
}

/// One draw of the disorder of beds: a bed, and where on it the intruder lands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Draw {
    /// Seed of the bed.
    pub seed: u64,
    /// Which of the places of the bed, from 0.
    pub place: usize,
}

/// A model of grains before a set.
pub struct Stand<'a> {
    /// The model.
    pub model: &'a Model,
    medium: &'a GrainMedium,
    /// The set.
    pub set: &'a MeasurementSet,
    text: String,
    allow_paths: Vec<PathBuf>,
    n_effects: usize,
    n_places: usize,
    x_range: (f64, f64),
    /// Expected length of the impact of every condition (s).
    expected: Vec<f64>,
}

impl<'a> Stand<'a> {
    /// `model` before `set`. The set says what was dropped and how, and the strength of gravity.
    ///
    /// # Errors
    /// If the model is no bed of grains of the geometry of the set.
    pub fn new(model: &'a Model, set: &'a MeasurementSet) -> Result<Self, StandError> {
        let Medium::Grains(medium) = &model.medium else {
            return Err(StandError::NoGrains { model: model.run.name.clone() });
        };
        let of_set = match set.bed.geometry {
            Geometry::Planar => Space::Planar,
            Geometry::Spatial => Space::Spatial,
        };
        if of_set != medium.space {
            let model = model.run.name.clone();
            let name = |space: Space| if space == Space::Planar { "2d" } else { "3d" };
            let (model_space, set_space) = (name(medium.space), name(of_set));
            return Err(StandError::Geometry { model, model_space, set_space });
        }
        let allow_paths = match &medium.bed.source {
            BedSource::Csv(csv) => csv.file.parent().map(PathBuf::from).into_iter().collect(),
            BedSource::Settle(_) => Vec::new(),
        };
        let widest = set.conditions.iter().map(|one| one.diameter).fold(0.0, f64::max);
        let x_range = medium.start.x_range;
        let n_places = ((x_range.1 - x_range.0) / (APART * widest)).floor() as usize;
        Ok(Self {
            model,
            medium,
            set,
            text: model.resolved_toml().to_owned(),
            allow_paths,
            n_effects: medium.effects.len(),
            n_places: (1 + n_places).min(MOST_PLACES),
            x_range,
            expected: (0..set.conditions.len()).map(|at| expected(model, set, at)).collect(),
        })
    }

    /// The model, as what it is.
    #[must_use]
    pub fn grains(&self) -> GrainModel<'a> {
        GrainModel { model: self.model, medium: self.medium }
    }

    /// How many impacts fall on one bed, each on grains that the others leave alone.
    #[must_use]
    pub fn n_places(&self) -> usize {
        self.n_places
    }

    /// `n` draws for each of so many `conditions`, on the beds from number `first` on. Those of one
    /// condition are on beds of their own, each. Conditions share beds, not places, as long as there are any
    /// that are fresh: what falls on the same grains misses by the same.
    #[must_use]
    pub fn draws(&self, first: usize, n: usize, conditions: usize) -> Vec<Vec<Draw>> {
        let beds = self.n_beds(n, conditions);
        let draw = |at: usize| Draw {
            seed: self.model.run.seed + (first + at % beds) as u64,
            place: (at / beds) % self.n_places,
        };
        (0..conditions).map(|one| (one * n..(one + 1) * n).map(draw).collect()).collect()
    }

    /// How many beds `n` draws for each of so many `conditions` are on.
    #[must_use]
    pub fn n_beds(&self, n: usize, conditions: usize) -> usize {
        (n * conditions).div_ceil(self.n_places).clamp(n, MOST_BEDS * n)
    }

    /// The impact of condition `condition` of the set at `draw`, with `variation`.
    ///
    /// # Errors
    /// If that is no model.
    pub fn job(
        &self,
        condition: usize,
        draw: Draw,
        variation: &Variation,
    ) -> Result<Job, StandError> {
        let seed = format!("run.seed={}", draw.seed);
        let gravity = format!("medium.gravity=\"{:?} m/s^2\"", self.set.bed.gravity);
        let mut before = vec![seed, gravity];
        before.extend(variation.before.iter().cloned());
        let mut during = before.clone();
        during.extend(variation.during.iter().cloned());
        during.extend(self.added(variation));
        let of_condition = &self.set.conditions[condition];
        during.extend(sets_of(of_condition));
        during.push(format!("impact.x=\"{:?} m\"", self.x(draw)));
        let load = |sets| {
            self.load(sets)
                .map(Arc::new)
                .map_err(|source| StandError::Config { condition: of_condition.id.clone(), source })
        };
        Ok(Job { model: load(during)?, bed: load(before)?, expected: self.expected[condition] })
    }

    /// The impacts under `conditions`, each on its own of `draws`, with `variation`: condition after
    /// condition, draw after draw.
    ///
    /// # Errors
    /// If one is no model.
    pub fn jobs(
        &self,
        conditions: &[usize],
        draws: &[Vec<Draw>],
        variation: &Variation,
    ) -> Result<Vec<Job>, StandError> {
        let each = conditions.iter().zip(draws);
        let all = each.flat_map(|(&at, draws)| draws.iter().map(move |&draw| (at, draw)));
        all.map(|(at, draw)| self.job(at, draw, variation)).collect()
    }

    /// The model with `variation`, complete and in SI.
    ///
    /// # Errors
    /// If that is no model.
    pub fn proposal(&self, variation: &Variation) -> Result<String, ConfigError> {
        let mut sets = [&variation.before[..], &variation.during[..]].concat();
        sets.extend(self.added(variation));
        Ok(self.load(sets)?.resolved_toml().to_owned())
    }

    /// The assignments that add the effects of `variation`.
    fn added(&self, variation: &Variation) -> Vec<String> {
        let mut sets = Vec::new();
        for (at, (name, values)) in (self.n_effects..).zip(&variation.effects) {
            sets.push(format!("effect.{at}.name=\"{name}\""));
            sets.extend(values.iter().map(|(key, value)| format!("effect.{at}.{key}={value}")));
        }
        sets
    }

    /// The model with `sets`.
    fn load(&self, sets: Vec<String>) -> Result<Model, ConfigError> {
        let source = ModelSource::Text {
            name: format!("an impact of {}", self.model.run.name),
            text: self.text.clone(),
            folder: PathBuf::from("."),
        };
        let options = LoadOptions { sets, seed: None, allow_paths: self.allow_paths.clone() };
        Ok(Model::load(source, &options)?.model)
    }

    /// Where the intruder lands (m): somewhere in its part of the range, drawn with the seed.
    fn x(&self, draw: Draw) -> f64 {
        let (from, to) = self.x_range;
        let u = random(draw.seed, &format!("place {}", draw.place)).random::<f64>();
        // Parts are APART diameters wide at least; half of each is used, so that neighbours keep apart.
        let share = (draw.place as f64 + 0.25 + 0.5 * u) / self.n_places as f64;
        from + share * (to - from)
    }
}

/// What of a model the condition decides.
fn sets_of(condition: &Condition) -> Vec<String> {
    let mut sets = vec![
        format!("impact.speed=\"{:?} m/s\"", condition.speed),
        format!("impact.angle=\"{:?} deg\"", condition.angle_deg),
        format!("intruder.shape=\"{}\"", condition.shape),
        format!("intruder.diameter=\"{:?} m\"", condition.diameter),
        format!("intruder.mass=\"{:?} kg\"", condition.mass),
    ];
    if condition.spin != 0.0 {
        // The set counts rolling forward, the model counter-clockwise.
        sets.push(format!("impact.spin=\"{:?} rad/s\"", -condition.spin));
    }
    let sizes = [
        ("length", "m", condition.length),
        ("height", "m", condition.height),
        ("apex_angle", "deg", condition.apex_deg),
        ("link_angle", "deg", condition.link_angle_deg),
    ];
    let given = sizes.iter().filter_map(|(key, unit, size)| Some((key, unit, (*size)?)));
    sets.extend(given.map(|(key, unit, size)| format!("intruder.{key}=\"{size:?} {unit}\"")));
    sets
}

/// How long the impact of condition `condition` is expected to take (s).
fn expected(model: &Model, set: &MeasurementSet, condition: usize) -> f64 {
    let runs = set.runs.iter().filter(|run| run.condition == condition);
    let last = runs.filter_map(|run| {
        let frame = run.frames.last().map(|frame| frame.t);
        run.stop_time.or(frame)
    });
    let longest = last.fold(0.0, f64::max);
    let known = if longest > 0.0 { longest + BEHIND } else { EXPECTED * model.run.duration };
    known.min(model.run.duration)
}
