//! A model of grains before a measurement set: which impact stands for which condition and bed.

use std::sync::Arc;

use configs::{Change, ConfigError, GrainForceChoice, GrainMedium, GrainModel, Medium, Model};
use engine::bed::random;
use engine::fluid::Fluid;
use engine::grains::Space;
use measurements::{Along, Condition, Crater, Geometry, Kind, MeasurementSet, Run};
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
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum BedModelError {
    #[error("`{model}` has no bed of grains")]
    NoGrains { model: String },
    #[error(
        "the set has {beds} beds, and `{model}` is one; make a set of the conditions of each, with a model of each"
    )]
    SeveralBeds { model: String, beds: usize },
    #[error("`{model}` is a bed of grains; {what} are compared with resistive models alone")]
    OverTime { model: String, what: &'static str },
    #[error("the set holds {set_holds}, and `{model}` has [{table}]; it needs [{wanted}]")]
    Start { model: String, set_holds: &'static str, table: &'static str, wanted: &'static str },
    #[error(
        "condition {condition}: a push of {depth} m takes {wanted:.3} s, and `{model}` runs for {duration} s; write a longer \
         [run] duration, or a faster [intrusion] speed"
    )]
    Short {
        condition: String,
        /// How deep it goes (m).
        depth: f64,
        wanted: f64,
        model: String,
        duration: f64,
    },
    #[error("`{model}` is a bed in {model_space}, and the set is one in {set_space}")]
    Geometry { model: String, model_space: &'static str, set_space: &'static str },
    #[error("condition {condition}: {source}")]
    Config { condition: String, source: ConfigError },
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
pub struct BedModel<'a> {
    /// The model.
    pub model: &'a Model,
    medium: &'a GrainMedium,
    /// The set.
    pub set: &'a MeasurementSet,
    n_places: usize,
    x_range: (f64, f64),
    /// Expected length of the impact of every condition (s).
    expected: Vec<f64>,
    /// How deep every condition is pushed (m), where it is.
    depths: Vec<Option<f64>>,
}

impl<'a> BedModel<'a> {
    /// `model` before `set`. The set says what was dropped and how, and the strength of gravity.
    ///
    /// # Errors
    /// If the model is no bed of grains of the geometry of the set.
    pub fn new(model: &'a Model, set: &'a MeasurementSet) -> Result<Self, BedModelError> {
        let Medium::Grains(medium) = &model.medium else {
            return Err(BedModelError::NoGrains { model: model.run.name.clone() });
        };
        if set.beds.len() > 1 {
            let (model, beds) = (model.run.name.clone(), set.beds.len());
            return Err(BedModelError::SeveralBeds { model, beds });
        }
        let (set_holds, wanted) = match set.kind.curve() {
            Some(curve) if curve.along == Along::Time => {
                let (model, what) = (model.run.name.clone(), curve.plural);
                return Err(BedModelError::OverTime { model, what });
            }
            Some(_) => ("pushes", "intrusion"),
            None => ("impacts", "impact"),
        };
        let table = model.impact.table();
        if table != wanted {
            let model = model.run.name.clone();
            return Err(BedModelError::Start { model, set_holds, table, wanted });
        }
        let of_set = match set.bed.geometry {
            Geometry::Planar => Space::Planar,
            Geometry::Spatial => Space::Spatial,
        };
        if of_set != medium.space {
            let model = model.run.name.clone();
            let name = |space: Space| if space == Space::Planar { "2d" } else { "3d" };
            let (model_space, set_space) = (name(medium.space), name(of_set));
            return Err(BedModelError::Geometry { model, model_space, set_space });
        }
        let widest = set.conditions.iter().map(|one| one.diameter).fold(0.0, f64::max);
        let x_range = medium.start.x_range;
        let n_places = ((x_range.1 - x_range.0) / (APART * widest)).floor() as usize;
        let mut bed_model = Self {
            model,
            medium,
            set,
            n_places: (1 + n_places).min(MOST_PLACES),
            x_range,
            expected: Vec::new(),
            depths: (0..set.conditions.len()).map(|at| depth_of_push(set, at)).collect(),
        };
        bed_model.expected = (0..set.conditions.len()).map(|at| bed_model.expected(at)).collect();
        let duration = model.run.duration;
        let pushes = bed_model.depths.iter().zip(&bed_model.expected).zip(&set.conditions);
        for ((depth, &wanted), condition) in pushes {
            if let Some(depth) = depth.filter(|_| wanted > duration) {
                let (condition, model) = (condition.id.clone(), model.run.name.clone());
                return Err(BedModelError::Short { condition, depth, wanted, model, duration });
            }
        }
        Ok(bed_model)
    }

    /// The speed of the body under `condition` (m/s); of a push, the one of the model where that is faster. Grains forget
    /// a slow speed, and a push of minutes would take days.
    fn speed(&self, condition: &Condition) -> f64 {
        match self.set.kind {
            Kind::ForceDepth => condition.speed.max(self.model.impact.speed),
            _ => condition.speed,
        }
    }

    /// How long the impact or the push of condition `at` is expected to take (s).
    fn expected(&self, at: usize) -> f64 {
        let Some(depth) = self.depths[at] else { return expected(self.model, self.set, at) };
        let condition = &self.set.conditions[at];
        let sinking = self.speed(condition) * libm::sin(condition.angle_deg.to_radians());
        depth / sinking
    }

    /// The model, as what it is.
    pub fn grains(&self) -> GrainModel<'a> {
        GrainModel { model: self.model, medium: self.medium }
    }

    /// `n` draws for each of so many `conditions`, on the beds from number `first` on. Those of one
    /// condition are on beds of their own, each. Conditions share beds, not places, as long as there are any
    /// that are fresh: what falls on the same grains misses by the same.
    pub fn draws(&self, first: usize, n: usize, conditions: usize) -> Vec<Vec<Draw>> {
        let beds = self.n_beds(n, conditions);
        let draw = |at: usize| Draw {
            seed: self.model.run.seed + (first + at % beds) as u64,
            place: (at / beds) % self.n_places,
        };
        (0..conditions).map(|one| (one * n..(one + 1) * n).map(draw).collect()).collect()
    }

    /// How many beds `n` draws for each of so many `conditions` are on.
    pub(crate) fn n_beds(&self, n: usize, conditions: usize) -> usize {
        (n * conditions).div_ceil(self.n_places).clamp(n, MOST_BEDS * n)
    }

    /// The fluid of the set, for a model that states none of its own.
    fn fluid(&self) -> Option<Change> {
        let mut own = self.medium.grain_forces.iter();
        if own.any(GrainForceChoice::is_of_a_fluid) {
            return None;
        }
        let Fluid { density, viscosity } = self.set.bed.stated.fluid?;
        let values = vec![("density", density), ("viscosity", viscosity)];
        Some(Change::Effect("fluid", values))
    }

    /// The impact of condition `condition` of the set at `draw`, with `variation`.
    pub fn job(
        &self,
        condition: usize,
        draw: Draw,
        variation: &Variation,
    ) -> Result<Job, BedModelError> {
        let mut before = vec![Change::Seed(draw.seed), Change::Gravity(self.set.bed.gravity)];
        before.extend(variation.before.iter().cloned());
        let mut during = before.clone();
        during.extend(variation.during.iter().cloned());
        let of_condition = &self.set.conditions[condition];
        during.extend(self.fluid());
        during.extend(self.changes_of(of_condition));
        during.extend(self.depths[condition].map(Change::PushedTo));
        during.push(Change::X(self.x(draw)));
        let with = |changes: &[Change]| {
            self.grains().with(changes).map(Arc::new).map_err(|source| BedModelError::Config {
                condition: of_condition.id.clone(),
                source,
            })
        };
        let of_set = |run: &Run| run.condition == condition && run.crater != Crater::default();
        Ok(Job {
            model: with(&during)?,
            bed: with(&before)?,
            expected: self.expected[condition],
            settles: self.set.runs.iter().any(of_set),
        })
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
    ) -> Result<Vec<Job>, BedModelError> {
        let each = conditions.iter().zip(draws);
        let all = each.flat_map(|(&at, draws)| draws.iter().map(move |&draw| (at, draw)));
        all.map(|(at, draw)| self.job(at, draw, variation)).collect()
    }

    /// The model with `changes`.
    pub(super) fn prepared(&self, changes: &[Change]) -> Result<Model, BedModelError> {
        let condition =
            || self.set.conditions.first().map_or_else(String::new, |one| one.id.clone());
        let with = self.grains().with(changes);
        with.map_err(|source| BedModelError::Config { condition: condition(), source })
    }

    /// The model with `variation`, complete and in SI.
    pub fn proposal(&self, variation: &Variation) -> Result<String, ConfigError> {
        let changes = [&variation.before[..], &variation.during[..]].concat();
        Ok(self.grains().with(&changes)?.resolved_toml().to_owned())
    }

    /// What of a model the condition decides.
    fn changes_of(&self, condition: &Condition) -> Vec<Change> {
        let model = self.model;
        let (speed, angle_rad) = (self.speed(condition), condition.angle_deg.to_radians());
        let sizes = [
            ("diameter", Some(condition.diameter)),
            ("length", condition.length),
            ("height", condition.height),
            // The wall above the body stands for its rod: both keep grains off its top, and neither is felt.
            ("shaft_diameter", condition.shaft_diameter.filter(|_| !model.intruder.recessive_wall)),
            ("apex_angle", condition.apex_deg.map(f64::to_radians)),
            ("link_angle", condition.link_angle_deg.map(f64::to_radians)),
        ];
        let sizes = sizes.into_iter().filter_map(|(key, size)| Some((key, size?))).collect();
        let shape = condition.shape.clone();
        // A push may leave the mass out: the drive carries the body.
        let mass = if condition.mass > 0.0 { condition.mass } else { model.intruder.mass };
        let mut changes =
            vec![Change::Velocity { speed, angle_rad }, Change::Intruder { shape, sizes, mass }];
        if condition.spin != 0.0 {
            // The set counts rolling forward, the model counter-clockwise.
            changes.push(Change::Spin(-condition.spin));
        }
        changes
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

/// How deep (m) the pushes of condition `condition` of `set` are to go: as deep as one was measured.
fn depth_of_push(set: &MeasurementSet, condition: usize) -> Option<f64> {
    let runs = set.runs.iter().filter(|run| run.condition == condition);
    let deepest = runs.flat_map(|run| &run.samples).map(|sample| sample.at).fold(0.0, f64::max);
    (set.kind == Kind::ForceDepth && deepest > 0.0).then_some(deepest)
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

#[cfg(test)]
mod tests {
    use configs::{LoadOptions, ModelSource, find_shipped};
    use measurements::NamedBed;

    use super::*;
    use crate::test_sets::{condition, set};

    #[test]
    fn the_fluid_of_a_set_acts_on_impacts_and_not_while_beds_settle() {
        let shipped = ModelSource::Shipped(find_shipped("sphere-3d").unwrap());
        let model = Model::load(shipped, &LoadOptions::default()).unwrap().model;
        let mut set = set(Kind::Scalar, vec![condition(1.0, 90.0)], Vec::new());
        let fluid = Fluid { density: 998.0, viscosity: 1e-3 };
        let draw = Draw { seed: 1, place: 0 };
        let fluids = |set: &MeasurementSet| {
            let bed_model = BedModel::new(&model, set).unwrap();
            let job = bed_model.job(0, draw, &Variation::default()).unwrap();
            [&job.model, &job.bed].map(|model| {
                let Medium::Grains(medium) = &model.medium else { panic!("no grains") };
                medium.grain_forces.iter().filter(|force| force.is_of_a_fluid()).count()
            })
        };
        assert_eq!(fluids(&set), [0, 0]);
        set.bed.stated.fluid = Some(fluid);
        assert_eq!(fluids(&set), [1, 0]);
    }

    #[test]
    fn a_model_of_one_bed_takes_no_set_of_two() {
        let shipped = ModelSource::Shipped(find_shipped("vertical-2d").unwrap());
        let model = Model::load(shipped, &LoadOptions::default()).unwrap().model;
        let mut set = set(Kind::Scalar, vec![condition(1.0, 90.0)], Vec::new());
        set.bed.geometry = Geometry::Planar;
        let named = |name: &str| NamedBed { name: name.to_owned(), bed: set.bed };
        let [one, other] = ["loose", "dense"].map(named);
        set.beds = vec![one];
        assert!(BedModel::new(&model, &set).is_ok());
        set.beds.push(other);
        let refused = BedModel::new(&model, &set).err();
        assert!(matches!(refused, Some(BedModelError::SeveralBeds { beds: 2, .. })), "{refused:?}");
    }
}
