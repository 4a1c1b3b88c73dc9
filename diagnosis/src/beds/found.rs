//! A diagnosis of a bed of grains as it is written down, with the models that it proposes.

use configs::Change;
use measurements::MeasurementSet;
use serde_json::{Value, json};

use super::bed_model::{BedModel, Draw};
use super::confirmation::Confirmation;
use super::emulator::BedForward;
use super::located::Located;
use super::plan::Plan;
use super::variation::Variation;
use crate::diagnose::seek_missing_force;
use crate::fit::fitted_parameters::parameters;
use crate::fit::problem::{FitError, FitProblem};
use crate::forward::sensitivity::Point;
use crate::observed::Observed;
use crate::rounding::rounded;
use crate::verdict::{Diagnosis, Verdict};

/// A diagnosis of a bed of grains.
pub struct BedDiagnosis {
    /// What it says.
    pub diagnosis: Diagnosis,
    /// The model that it was made with.
    pub forward: BedForward,
    /// The conditions that were fitted to, and none else.
    pub observed: Observed,
    /// What was confirmed with fresh beds; none where nothing was named, or nothing is held out.
    pub confirmation: Option<Confirmation>,
    /// Correlation of depths of two runs on one draw; none where no pair was run.
    pub correlation: Option<f64>,
    /// What is run in all.
    pub plan: Plan,
    /// Impacts of this diagnosis, those that were kept counted.
    pub impacts: usize,
    /// How the model was prepared to what the set states of its bed.
    pub(super) changes: Vec<Change>,
}

/// The model with the candidates of `point` at their amplitudes.
pub(super) fn change_at(
    bed_model: &BedModel<'_>,
    forward: &BedForward,
    point: &Point,
) -> Variation {
    let parameters = forward.free().iter().copied().zip(point.parameters.iter().copied());
    let effects = point.effects.iter().filter_map(|&(at, q)| Some((forward.bed_candidate(at)?, q)));
    parameters.chain(effects).fold(Variation::default(), |all, (at, q)| {
        all.and(forward.screened()[at].bed_candidate.change(bed_model.grains(), q))
    })
}

impl BedDiagnosis {
    /// Seeks the force that the model lacks in `set`, unless it is known: between the means of its runs and what was
    /// measured, along the path of a body.
    ///
    /// # Errors
    /// If the force law that stands in for the bed fails.
    pub fn seek_missing_force(&mut self, set: &MeasurementSet) -> Result<(), FitError> {
        let problem = FitProblem { set, observed: &self.observed, forward: &self.forward };
        seek_missing_force(&problem, &mut self.diagnosis)
    }

    /// The diagnosis as one JSON object, with what was learned of the beds.
    pub fn to_json(&self, bed_model: &BedModel<'_>) -> serde_json::Result<Value> {
        let mut object = self.diagnosis.to_json()?;
        object["bed"] = json!({
            "scatter": self.forward.scatter(bed_model.set),
            "correlation_on_one_draw": self.correlation.map(rounded),
            "force_law": self.located(bed_model),
            "seeds": self.seeds(bed_model),
        });
        object["ledger"] = self.confirmation.as_ref().map_or(Value::Null, Confirmation::ledger);
        object["cost"] = json!({ "impacts": self.impacts, "plan": self.plan.to_json(bed_model) });
        Ok(object)
    }

    /// The model with the candidates of each effect that is worth adding, as a name and a model file; what the
    /// apparatus does is no part of a bed.
    ///
    /// # Errors
    /// If a change does not give a valid model.
    pub fn proposals(
        &self,
        bed_model: &BedModel<'_>,
    ) -> Result<Vec<(String, String)>, configs::ConfigError> {
        let named = &self.diagnosis;
        let points: Vec<Point> = match named.verdict {
            Verdict::Supported | Verdict::Pair => {
                named.proposed.iter().map(|fitted| fitted.fit.point.clone()).collect()
            }
            Verdict::NotSeparable => named
                .ranking
                .iter()
                .filter(|effect| named.not_separable.contains(&effect.id))
                .filter_map(|effect| effect.point.clone())
                .collect(),
            _ => Vec::new(),
        };
        let mut proposals = Vec::new();
        let prepared = bed_model.grains().with(&self.changes)?;
        let Ok(bed_model) = &BedModel::new(&prepared, bed_model.set) else { return Ok(proposals) };
        if !self.changes.is_empty() {
            let text = bed_model.proposal(&Variation::default())?;
            proposals.push(("model+preparation.toml".to_owned(), text));
        }
        for point in points {
            let ids = self.forward.of_the_bed(&point.effects);
            if !ids.is_empty() {
                let text = bed_model.proposal(&change_at(bed_model, &self.forward, &point))?;
                proposals.push((format!("model+{}.toml", ids.join("+")), text));
            }
        }
        Ok(proposals)
    }

    /// The terms of the force law that comes nearest to the runs of the model, and those by which measurements differ
    /// from them, whatever it is by.
    fn located(&self, bed_model: &BedModel<'_>) -> Value {
        let baseline = self.forward.baseline();
        let law = &baseline.stand_in.forward;
        let of_the_model = parameters(law, &baseline.fitted.fit);
        let problem =
            FitProblem { set: bed_model.set, observed: &self.observed, forward: &self.forward };
        let as_it_is = self.diagnosis.baseline.as_ref();
        let located = as_it_is
            .and_then(|fitted| Located::of(&problem, &self.forward, fitted).ok().flatten())
            .map(|located| located.to_json(&of_the_model));
        let mut object = located.unwrap_or_else(|| json!({}));
        object["of_the_model"] = Value::Object(of_the_model);
        object
    }

    fn seeds(&self, bed_model: &BedModel<'_>) -> Value {
        let draws = self.plan.draws(bed_model);
        let of = |draws: &[Vec<Draw>]| {
            let mut seeds: Vec<u64> = draws.iter().flatten().map(|draw| draw.seed).collect();
            seeds.sort_unstable();
            seeds.dedup();
            seeds
        };
        json!({ "baseline": of(&draws.fit), "confirmation": of(&draws.confirm) })
    }
}
