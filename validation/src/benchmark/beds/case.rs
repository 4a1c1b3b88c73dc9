//! Beds in which something is hidden, and what a diagnosis made of them.

use std::path::Path;

use configs::{ConfigError, Model};
use diagnosis::beds::{BaselineError, BedError, BedModel, Plan, Wish, diagnose_bed, unaffordable};
use diagnosis::observed::Observed;
use diagnosis::verdict::{Diagnosis, Verdict};
use measurements::MeasurementSet;
use runner::beds::Impacts;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::hidden::Hidden;
use super::lammps::{LEVEL, World};
use super::prepared::Prepared;
use super::world::{MODEL, SMALL, SPHERES, campaign, load, measure, stated, weighed};
use crate::speed::SpeedError;
use crate::speed::lammps::Lammps;

/// Runs of every condition, in worlds of plunge and of LAMMPS.
const REPEATS: usize = 10;
const FEW: usize = 5;

/// A candidate that a bed hides which is not weighed.
const GRAIN_DENSITY: &str = "grain-density";

/// Beds of LAMMPS that are weighed.
const WEIGHED: usize = 3;

/// The grains of a bed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grains {
    /// 900 discs.
    Discs,
    /// 450 discs.
    FewDiscs,
    /// 1 000 spheres.
    Spheres,
}

/// One bed to be diagnosed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// What is hidden in it.
    pub hidden: Hidden,
    /// How it was prepared.
    pub prepared: Prepared,
    /// Whether its set states its packing fraction and its bulk density.
    pub is_weighed: bool,
    /// Which bed it is.
    pub bed: Grains,
    /// Whether LAMMPS rains and hits it.
    pub is_by_lammps: bool,
    /// Which draw of beds, camera and resampling.
    pub seed: u64,
}

/// Why a case ends without an outcome.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum CaseError {
    #[error(transparent)]
    Bed(#[from] BedError),
    #[error(transparent)]
    Lammps(#[from] SpeedError),
    #[error("{0}: there is no such world of LAMMPS")]
    NoWorld(String),
}

/// What came of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// What was hidden.
    pub hidden: String,
    /// Which draw.
    pub seed: u64,
    /// The verdict, as in a report.
    pub verdict: String,
    /// What is named, or not told from what would be.
    pub named: Vec<String>,
    /// The packing fraction of the bed less that of the model, as the diagnosis finds it, its standard error, and whether
    /// it is named; none where the model has no such parameter.
    #[serde(default)]
    pub packing: Option<(f64, f64, bool)>,
    /// What else the diagnosis says.
    #[serde(default)]
    pub hint: String,
    /// Whether the answer is right: the effect alone or in a set of at most three; *nothing detected*, *below noise*, or
    /// what the preparation or the apparatus explains, where nothing is hidden; nothing named where what is hidden is not
    /// listed.
    pub right: bool,
    /// Whether what is named is wrong: another effect, a set without the one that is hidden, or a pair, which claims two.
    pub wrong: bool,
    /// Predicted probability that the truth, were it as strong as fitted, is ranked first.
    pub predicted: Option<f64>,
    /// Whether it was.
    pub first: bool,
    /// Error on held-out conditions: before, after, and the floor of the means (m).
    pub held_out: Option<[f64; 3]>,
    /// Impacts of the diagnosis.
    pub impacts: usize,
    /// Time (s), which depends on what is kept and on the machine.
    pub seconds: f64,
}

/// The shortest list that has one of everything: every preparation with nothing hidden, then two effects and one that is
/// not listed; small beds.
pub fn quick() -> Vec<Case> {
    let nothing = Prepared::ALL.iter().enumerate().map(|(at, &prepared)| Case {
        prepared,
        is_weighed: at % 2 == 1,
        ..Case::small(Hidden::Nothing, 0)
    });
    let effects = [
        Case {
            is_weighed: true,
            ..Case::small(Hidden::BedCandidate("rolling-resistance", 0.17), 0)
        },
        Case {
            prepared: Prepared::Rough,
            is_weighed: true,
            ..Case::small(Hidden::BedCandidate("grain-friction", 0.8), 0)
        },
        Case::small(Hidden::BedCandidate(GRAIN_DENSITY, 0.4), 0),
        Case { is_weighed: true, ..Case::small(Hidden::Unlisted, 0) },
    ];
    nothing.chain(effects).collect()
}

/// Small beds, prepared in every way, of which the set says how they lie or does not, with nothing hidden and with two
/// effects at amplitudes that no screening uses; `draws` of each.
pub fn prepared(draws: u64) -> Vec<Case> {
    let hidden = [
        Hidden::Nothing,
        Hidden::BedCandidate("rolling-resistance", 0.17),
        Hidden::BedCandidate("grain-friction", 0.8),
    ];
    let ways = Prepared::ALL.map(|prepared| (prepared, &[false, true][..]));
    crossed((10_000, draws), &hidden, &ways, Case::small)
}

/// Small beds that LAMMPS rains in every way that it can, of which the set says how they lie or does not, with nothing
/// hidden, with two effects, and with one that is not listed; `draws` of each.
pub fn by_lammps(draws: u64) -> Vec<Case> {
    let hidden = [
        Hidden::Nothing,
        Hidden::BedCandidate("rolling-resistance", 0.25),
        Hidden::BedCandidate("grain-friction", 1.5),
        Hidden::Unlisted,
    ];
    let ways = Prepared::ALL.into_iter().filter(|one| *one != Prepared::Tapped);
    let ways: Vec<_> = ways.map(|prepared| (prepared, &[false, true][..])).collect();
    let case = |hidden, seed| Case { is_by_lammps: true, ..Case::small(hidden, seed) };
    let mut cases = crossed((20_000, draws), &hidden, &ways, case);
    // The model is prepared to a bed that is weighed.
    let alone: Vec<_> = ways.iter().map(|&(prepared, _)| (prepared, &[false][..])).collect();
    cases.extend(crossed(
        (25_000, draws),
        &[Hidden::BedCandidate(GRAIN_DENSITY, 0.4)],
        &alone,
        case,
    ));
    cases
}

/// Beds of spheres, prepared like those of the model, rougher and smoother, the latter two weighed, with nothing hidden, with
/// two effects and with one that is not listed; `draws` of each.
pub fn of_spheres(draws: u64) -> Vec<Case> {
    let hidden = [
        Hidden::Nothing,
        Hidden::BedCandidate("rolling-resistance", 0.17),
        Hidden::BedCandidate("grain-friction", 0.8),
        Hidden::Unlisted,
    ];
    let ways: [(_, &[bool]); 3] =
        [(Prepared::Alike, &[false]), (Prepared::Rough, &[true]), (Prepared::Smooth, &[true])];
    let case = |hidden, seed| Case { bed: Grains::Spheres, ..Case::alike(hidden, seed) };
    crossed((30_000, draws), &hidden, &ways, case)
}

/// Everything of `hidden` in beds of every way, weighed or not as it lists: `draws` of each, with seeds from `first` on.
fn crossed(
    (first, draws): (u64, u64),
    hidden: &[Hidden],
    ways: &[(Prepared, &[bool])],
    case: impl Fn(Hidden, u64) -> Case,
) -> Vec<Case> {
    let mut cases = Vec::new();
    for (row, &hidden) in hidden.iter().enumerate() {
        for draw in 0..draws {
            for (at, &(prepared, weighed)) in ways.iter().enumerate() {
                let seed = first + 1000 * row as u64 + 100 * at as u64 + draw;
                for &is_weighed in weighed {
                    cases.push(Case { prepared, is_weighed, ..case(hidden, seed) });
                }
            }
        }
    }
    cases
}

/// Six candidates at two strengths, nothing, and what is not listed; `draws` of each.
pub fn all(draws: u64) -> Vec<Case> {
    use Hidden::{BedCandidate, Nothing, Unlisted};
    let hidden = [
        BedCandidate("rolling-resistance", 0.1),
        BedCandidate("rolling-resistance", 0.3),
        BedCandidate("cohesion-dmt", 5.0),
        BedCandidate("cohesion-dmt", 15.0),
        BedCandidate("grain-friction", 1.0),
        BedCandidate("grain-friction", 2.5),
        Nothing,
        Nothing,
        Nothing,
        Unlisted,
        Unlisted,
        BedCandidate("pore-air", 5.0),
        BedCandidate("pore-air", 15.0),
        BedCandidate("side-wall", 0.1),
        BedCandidate("side-wall", 0.3),
        BedCandidate(GRAIN_DENSITY, 0.4),
        BedCandidate(GRAIN_DENSITY, -0.25),
    ];
    let each = hidden.iter().enumerate();
    // Repeated entries of the list are other draws too.
    let seeds = |at: usize| (0..draws).map(move |draw| 100 * at as u64 + draw);
    each.flat_map(|(at, &hidden)| seeds(at).map(move |seed| Case::alike(hidden, seed))).collect()
}

impl Case {
    /// A bed of nine hundred discs, prepared as that of the model.
    pub fn alike(hidden: Hidden, seed: u64) -> Self {
        let prepared = Prepared::Alike;
        Self { hidden, prepared, is_weighed: false, bed: Grains::Discs, is_by_lammps: false, seed }
    }

    /// A small bed, prepared as that of the model.
    pub fn small(hidden: Hidden, seed: u64) -> Self {
        Self { bed: Grains::FewDiscs, ..Self::alike(hidden, seed) }
    }

    /// What it is called.
    pub fn name(&self) -> String {
        let mut name = self.hidden.name();
        if self.bed != Grains::Discs {
            let said = if self.is_weighed { "weighed" } else { "not weighed" };
            name.push_str(&format!("; {}, {said}", self.prepared.name()));
        }
        if self.bed == Grains::Spheres {
            name.push_str("; spheres");
        }
        if self.is_by_lammps {
            name.push_str("; by LAMMPS");
        }
        name
    }

    /// Measures and diagnoses it, with impacts as `wish` says; `lammps` runs its inputs in a folder of its own.
    pub fn run(
        &self,
        place: &dyn Impacts,
        wish: &Wish,
        lammps: Option<(&Lammps, &Path)>,
    ) -> Result<Outcome, CaseError> {
        let start = std::time::Instant::now();
        let (model, set) = self.measured(place, lammps)?;
        let observed = Observed::of(&set);
        let bed_model = BedModel::new(&model, &set).map_err(BedError::from)?;
        let plan = Plan::new(&bed_model, &observed, place, wish)?;
        let (diagnosis, impacts) = match plan.fits() {
            false => (unaffordable(&plan), 0),
            true => {
                let found = diagnose_bed(&bed_model, &observed, place, plan, self.seed + 1)?;
                (found.diagnosis, found.impacts)
            }
        };
        Ok(self.judged(&diagnosis, impacts, start.elapsed().as_secs_f64()))
    }

    /// The model of the analyst as a file, with beds of seeds of its own.
    pub fn model_text(&self) -> String {
        let text = match self.bed {
            Grains::Discs => MODEL,
            Grains::FewDiscs => SMALL,
            Grains::Spheres => SPHERES,
        };
        text.replace("seed = 1\n", &format!("seed = {}\n", 1 + 1000 * self.seed))
    }

    /// The model of the analyst.
    pub fn model(&self) -> Result<Model, ConfigError> {
        load(self.model_text())
    }

    /// The model of the analyst, and what is measured.
    pub fn measured(
        &self,
        place: &dyn Impacts,
        lammps: Option<(&Lammps, &Path)>,
    ) -> Result<(Model, MeasurementSet), CaseError> {
        let model = self.model().map_err(|why| BedError::from(BaselineError::from(why)))?;
        let empty = campaign(&model);
        let bed_model = BedModel::new(&model, &empty).map_err(BedError::from)?;
        let set = match lammps.filter(|_| self.is_by_lammps) {
            Some(lammps) => self.of_lammps(lammps, &bed_model)?,
            None if self.is_by_lammps => return Err(CaseError::NoWorld(self.name())),
            None => self.of_plunge(&bed_model, place)?,
        };
        Ok((model, set))
    }

    fn of_plunge(
        &self,
        world: &BedModel<'_>,
        place: &dyn Impacts,
    ) -> Result<MeasurementSet, BedError> {
        let variation = self.prepared.variation(world.grains()).and(self.hidden.variation(world));
        let mut set = measure(world, &variation, (REPEATS, self.seed), place)?;
        if self.is_weighed {
            set.bed = weighed(world, &variation, self.seed, place)?;
        }
        Ok(set)
    }

    fn of_lammps(
        &self,
        (lammps, folder): (&Lammps, &Path),
        bed_model: &BedModel<'_>,
    ) -> Result<MeasurementSet, CaseError> {
        let world = World::of(bed_model.grains(), self.hidden, self.prepared)
            .ok_or_else(|| CaseError::NoWorld(self.name()))?;
        let (mut set, lies) = world.measure(lammps, bed_model.set, (FEW, self.seed), folder)?;
        set.instrument.level_sigma = Some(LEVEL);
        if self.is_weighed {
            set.bed = stated(&lies[..WEIGHED.min(lies.len())], set.bed, self.seed);
        }
        Ok(set)
    }

    fn judged(&self, diagnosis: &Diagnosis, impacts: usize, seconds: f64) -> Outcome {
        let named: Vec<String> = match diagnosis.verdict {
            Verdict::NotSeparable => diagnosis.not_separable.clone(),
            _ => diagnosis.effects.clone(),
        };
        let truth = match self.hidden {
            Hidden::BedCandidate(id, _) => Some(id),
            Hidden::Nothing | Hidden::Unlisted => None,
        };
        let [right, wrong] = self.hidden.scored(diagnosis.verdict, &named);
        let leader = diagnosis.ranking.first();
        let own = diagnosis.ranking.iter().find(|effect| Some(effect.id.as_str()) == truth);
        let held_out = diagnosis.holdout.as_ref();
        Outcome {
            hidden: self.name(),
            seed: self.seed,
            packing: diagnosis
                .preparation
                .iter()
                .find(|one| one.id == "packing")
                .and_then(|one| Some((one.value, one.se?, one.named))),
            hint: [&diagnosis.unexplained.hint, &diagnosis.warnings.join("; ")]
                .map(|s| s.as_str())
                .join("; "),
            verdict: serde_json::to_value(diagnosis.verdict)
                .ok()
                .and_then(|value| Some(value.as_str()?.to_owned()))
                .unwrap_or_default(),
            right,
            wrong,
            predicted: own.and_then(|effect| effect.predicted_top1),
            first: truth.is_some() && leader.map(|effect| effect.id.as_str()) == truth,
            held_out: held_out
                .and_then(|errors| Some([errors.before?, errors.after?, errors.noise_floor?])),
            named,
            impacts,
            seconds,
        }
    }
}
