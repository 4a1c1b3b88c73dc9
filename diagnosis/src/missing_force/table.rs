//! The missing force along the paths of the bodies, as numbers and as a table.

use std::sync::Arc;

use measurements::MeasurementSet;
use nalgebra::{DMatrix, DVector};

use super::apart::Apart;
use super::found::{Found, MOMENTS};
use crate::fit::Fit;
use crate::fit::problem::{FitProblem, Fitted};
use crate::forward::observable::Observable;
use crate::forward::{Moment, NORMAL_95, Passages, PredictError, Request, Scatter, sense};
use crate::observed::ObservedCondition;

/// Share of a velocity along the surface from which on a force normal to the motion is given: none acts on a vertical fall.
const OBLIQUE: f64 = 0.1;

/// Logarithm by which a coefficient is moved to see what it does.
const MORE: f64 = 0.1;

/// The missing force at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Index of the condition.
    pub condition: usize,
    /// Time since contact (s).
    pub time: f64,
    /// Way forward along the surface (m).
    pub way: f64,
    /// Depth of the lowest point (m).
    pub depth: f64,
    /// Speed (m/s).
    pub speed: f64,
    /// Force that the model lacks, against the motion (N).
    pub force: f64,
    /// Its standard deviation (N).
    pub se: f64,
    /// Force of the model against the motion (N).
    pub model: f64,
    /// Force that the model lacks normal to the motion, out of the bed where the body sinks; none where it falls vertically, or none is told.
    pub sideways: Option<Component>,
    /// Both together along the surface, positive forward.
    pub horizontal: Component,
}

/// A component of the missing force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Component {
    /// (N)
    pub force: f64,
    /// Its standard deviation (N).
    pub se: f64,
}

impl Component {
    /// How clear of zero it is, in standard deviations.
    pub(super) fn clarity(&self) -> f64 {
        self.force.abs() / self.se.max(f64::MIN_POSITIVE)
    }

    /// Whether its 95 % interval leaves out zero.
    pub(super) fn is_clear(&self) -> bool {
        self.clarity() > NORMAL_95
    }
}

impl Reading {
    /// Against the motion, and normal to it.
    pub(crate) fn components(&self) -> [Option<Component>; 2] {
        [Some(Component { force: self.force, se: self.se }), self.sideways]
    }

    /// How clear of zero it is, in standard deviations.
    pub(super) fn clarity(&self) -> f64 {
        self.force.abs() / self.se.max(f64::MIN_POSITIVE)
    }

    /// Whether its 95 % interval leaves out zero.
    pub(super) fn is_clear(&self) -> bool {
        self.clarity() > NORMAL_95
    }
}

/// The force on the way of the model with the force that it lacks: what is missing in the fitted model, its own
/// parameters included. A force that parameters imitate is no less missing where the fit has put it into them. Coefficients
/// that differ between conditions by `scatter` (relative) may be a part of it: the band holds that.
pub(super) fn readings(
    problem: &FitProblem<'_>,
    by: &dyn Passages,
    (found, baseline): (&Found, &Fitted),
    scatter: f64,
) -> Result<Vec<Reading>, PredictError> {
    let fit = &found.fit;
    let n_coefficients = problem.forward.n_scattering_coefficients();
    let still =
        |field| Scatter { coefficients: vec![0.0; n_coefficients], field, ..Scatter::default() };
    let (alone, with) = (still(None), still(Some(Arc::new(found.field.clone()))));
    let more: Vec<Scatter> = (0..n_coefficients)
        .map(|index| {
            let mut one = still(None);
            one.coefficients[index] = MORE;
            one
        })
        .collect();
    let at = |parameters, scatter| Request { parameters, effects: &[], scatter };
    // The model as it is fitted; the one with the force, without it; and the latter with each parameter moved.
    let moved: Vec<(Vec<f64>, f64)> = fit.free().iter().map(|&index| moved(fit, index)).collect();
    let mut others = vec![at(&baseline.fit.point.parameters, &alone)];
    others.push(at(&fit.point.parameters, &alone));
    others.extend(moved.iter().map(|(parameters, _)| at(parameters, &alone)));
    others.extend(more.iter().map(|more| at(&fit.point.parameters, more)));
    let posterior = Posterior::of(found, &moved, scatter);
    let grid = &found.field.grid;
    let mut readings = Vec::new();
    for (fitted, &condition) in problem.observed.fit.iter().enumerate() {
        let body = &problem.set.conditions[condition];
        let [angle, diameter] = [body.angle_deg.to_radians(), body.diameter];
        let moments = by.passage(condition, &at(&fit.point.parameters, &with), &others, MOMENTS)?;
        // A model that lacks much may go far deeper than any body did.
        let deepest = deepest(&problem.observed.conditions[condition]);
        for one in moments.into_iter().filter(|one| one.depth <= deepest) {
            let state = [one.depth, one.speed, angle, diameter];
            let of_normal = grid.sideways_shares_at(state).collect();
            let shares = [grid.shares_at(state).to_vec(), of_normal];
            let along = |of: [f64; 2]| posterior.component(fitted, &one, &shares, of);
            let [x, z] = one.direction;
            let Component { force, se } = along([1.0, 0.0]);
            let sideways = (grid.is_sideways && x.abs() > OBLIQUE).then(|| along([0.0, 1.0]));
            let horizontal = along([-x, -z * sense(x)]);
            let [model, _] = one.others[0];
            let Moment { time, way, depth, speed, .. } = one;
            readings.push(Reading {
                condition,
                time,
                way,
                depth,
                speed,
                force,
                se,
                model,
                sideways,
                horizontal,
            });
        }
    }
    Ok(readings)
}

/// The greatest depth that was measured (m); infinite where no depth was.
fn deepest(observed: &ObservedCondition) -> f64 {
    let is_depth = |kind: &Observable| matches!(kind, Observable::Depth | Observable::FinalDepth);
    let kinds = observed.layout.kinds();
    let depths = kinds.iter().zip(observed.mean.iter()).filter(|(kind, _)| is_depth(kind));
    let deepest = depths.map(|(_, depth)| *depth).fold(f64::NEG_INFINITY, f64::max);
    if deepest > 0.0 { deepest } else { f64::INFINITY }
}

/// The posterior distribution of the missing force.
struct Posterior<'a> {
    found: &'a Found,
    apart: Option<Apart>,
    /// Step of each parameter in the derivatives.
    moved: Vec<f64>,
    /// Covariance of the parameters.
    covariance: DMatrix<f64>,
    /// Derivative of the fitted parameters by a force at a node.
    follow: DMatrix<f64>,
    /// Mean of the process less the force of the path, by node.
    step: DVector<f64>,
    /// Relative scatter of the coefficients between conditions.
    scatter: f64,
}

impl<'a> Posterior<'a> {
    fn of(found: &'a Found, moved: &[(Vec<f64>, f64)], scatter: f64) -> Self {
        let fit = &found.fit;
        let values = DVector::from_column_slice(&found.field.values);
        Self {
            found,
            apart: found.apart(),
            moved: moved.iter().map(|(_, by)| *by).collect(),
            covariance: fit.free_covariance() * found.misfit().max(1.0),
            follow: fit.free_covariance() * fit.jacobian.tr_mul(&found.response.whole()),
            step: found.response.at_nodes(&(&found.process.mean - values)),
            scatter,
        }
    }

    /// The missing force on the fitted condition `fitted` at `moment`, along the unit vector `of`, whose components are
    /// against the motion and normal to it. `shares` are the weights of the nodes for either.
    fn component(
        &self,
        fitted: usize,
        moment: &Moment,
        shares: &[Vec<(usize, f64)>; 2],
        of: [f64; 2],
    ) -> Component {
        let Self { found, moved, .. } = self;
        let projected = |forces: &[f64; 2]| of[0] * forces[0] + of[1] * forces[1];
        let [model, own] = [&moment.others[0], &moment.others[1]].map(projected);
        let (with_parameters, with_coefficients) = moment.others[2..].split_at(moved.len());
        let slopes =
            with_parameters.iter().zip(moved).map(|(there, by)| (projected(there) - own) / by);
        let slope = DVector::from_iterator(moved.len(), slopes);
        let mut weights = -self.follow.tr_mul(&slope);
        let mut force = own - model;
        let mut of_nodes = Vec::new();
        for (shares, of) in shares.iter().zip(of) {
            of_nodes.extend(shares.iter().map(|&(node, share)| (node, of * share)));
        }
        for &(node, share) in &of_nodes {
            force += moment.unit * share * found.field.values[node];
            if let Some(at) = found.response.nodes.iter().position(|one| *one == node) {
                weights[at] += moment.unit * share;
            }
        }
        // The mean of the process moves the parameters with it.
        force += weights.dot(&self.step);
        let scattered = with_coefficients
            .iter()
            .map(|there| (self.scatter * (projected(there) - own) / MORE).powi(2));
        let mut beside = slope.dot(&(&self.covariance * &slope)) + scattered.sum::<f64>();
        if let Some(apart) = &self.apart {
            let (mean, spread) = apart.force(fitted, (&of_nodes, moment.unit), &slope);
            force += mean;
            beside += spread;
        }
        Component { force, se: (found.process.variance(&weights) + beside).sqrt() }
    }
}

/// The parameters of `fit` with one of them moved a little, and by how much.
fn moved(fit: &Fit, index: usize) -> (Vec<f64>, f64) {
    /// Of a standard error, or of the value where that is less.
    const STEP: f64 = 0.1;
    let mut parameters = fit.point.parameters.clone();
    let value = parameters[index];
    let se = fit.standard_error(index).unwrap_or(STEP * value.abs());
    let by = if value == 0.0 { STEP * se } else { STEP * se.min(value.abs()) };
    let by = if by > 0.0 { by } else { STEP };
    parameters[index] += by;
    (parameters, by)
}

/// `readings` as CSV.
///
/// # Errors
/// If the table cannot be written.
pub fn table(set: &MeasurementSet, readings: &[Reading]) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record([
        "condition",
        "time_s",
        "depth_m",
        "speed_m_per_s",
        "missing_force_n",
        "standard_deviation_n",
        "model_force_n",
        "sideways_force_n",
        "sideways_standard_deviation_n",
        "horizontal_force_n",
        "horizontal_standard_deviation_n",
    ])?;
    for one in readings {
        let numbers = [one.time, one.depth, one.speed, one.force, one.se, one.model];
        let mut row = vec![set.conditions[one.condition].id.clone()];
        let in_six_digits = |number: f64| format!("{number:.6e}");
        row.extend(numbers.map(in_six_digits));
        let both = |one: Component| [one.force, one.se].map(in_six_digits);
        row.extend(one.sideways.map_or_else(Default::default, both));
        row.extend(both(one.horizontal));
        writer.write_record(row)?;
    }
    let bytes = writer.into_inner().map_err(|error| error.into_error())?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
