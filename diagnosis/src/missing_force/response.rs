//! How measurements answer to a small force around each node of depth, speed and angle, against the motion or normal to it.

use std::collections::BTreeSet;
use std::sync::Arc;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::term::State;
use super::with_field::WithField;
use crate::fit::Fit;
use crate::fit::problem::FitProblem;
use crate::forward::field::{Field, Grid};
use crate::forward::sensitivity::Point;
use crate::forward::{Forward, Moment, PredictError};
use crate::noise::weights::Weight;
use crate::projection::Basis;

/// Nodes over depth and over speed, and the most over angle and over diameter.
const DEPTHS: usize = 14;
const SPEEDS: usize = 6;
const ANGLES: usize = 6;
const DIAMETERS: usize = 3;

/// A force that is looked at is this share of what stops the bodies.
const STEP: f64 = 0.02;

/// A node that counts less than this on a path does nothing there.
const NEAR: f64 = 1e-3;

/// Angles (rad) and diameters (m) that differ by less are one.
const SAME: f64 = 1e-6;

/// The grid over what the conditions of the problem that are fitted to go through, with a force normal to the motion where
/// `is_sideways`.
pub(super) fn grid(problem: &FitProblem<'_>, is_sideways: bool) -> Grid {
    let conditions = || problem.observed.fit.iter().map(|&at| &problem.set.conditions[at]);
    let depth = problem.observed.fit.iter().map(|&at| problem.observed.conditions[at].reach);
    let depth = depth.fold(f64::MIN_POSITIVE, f64::max);
    let speed = conditions().map(|one| one.speed).fold(f64::MIN_POSITIVE, f64::max);
    let angles = distinct(conditions().map(|one| one.angle_deg.to_radians()), ANGLES);
    let diameters = distinct(conditions().map(|one| one.diameter), DIAMETERS);
    let axes = [spaced(0.0, depth, DEPTHS), spaced(0.0, speed, SPEEDS), angles, diameters];
    Grid { axes, is_sideways }
}

/// The distinct ones of `values`, or `most` of even distance where there are more.
fn distinct(values: impl Iterator<Item = f64>, most: usize) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.dedup_by(|a, b| (*a - *b).abs() < SAME);
    if values.len() > most {
        values = spaced(values[0], values[values.len() - 1], most);
    }
    values
}

fn spaced(from: f64, to: f64, n: usize) -> Vec<f64> {
    (0..n).map(|k| from + (to - from) * k as f64 / (n - 1) as f64).collect()
}

/// The answer of all that was fitted to, whitened, and what of it no parameter of the model imitates.
#[derive(Clone, Debug)]
pub(super) struct Response {
    /// By fitted condition.
    blocks: Vec<Block>,
    /// What parameters imitate.
    basis: Basis,
    /// What the model without any further force leaves over beside them, to first order.
    pub(super) residual: DVector<f64>,
    /// The nodes that some path comes near.
    pub(super) nodes: Vec<usize>,
    /// The answers beside the parameters, a column for each of these.
    pub(super) beside: DMatrix<f64>,
    rows: usize,
}

/// The answer of one condition.
#[derive(Clone, Debug)]
struct Block {
    /// The nodes that its path comes near, in rising order.
    nodes: Vec<usize>,
    /// Change of its whitened observables per ρ g A D at each of these.
    answers: DMatrix<f64>,
    /// The states at each of these of the force against the motion, which come first.
    states: Vec<State>,
}

impl Block {
    /// The answer to the force at `node`; `None` far from its path.
    fn column(&self, node: usize) -> Option<DVector<f64>> {
        let at = self.nodes.binary_search(&node).ok()?;
        Some(self.answers.column(at).into_owned())
    }

    /// The answer to a force of `values` at all nodes.
    fn change(&self, values: &DVector<f64>) -> DVector<f64> {
        let own = self.nodes.iter().map(|&node| values[node]);
        &self.answers * DVector::from_iterator(self.nodes.len(), own)
    }
}

impl Response {
    /// Around `fit`, which is of the model with the force of `field`; `passages` by condition that is fitted to.
    pub(super) fn of(
        problem: &FitProblem<'_>,
        (fit, weights): (&Fit, &[Weight]),
        field: &Field,
        passages: &[Vec<Moment>],
    ) -> Result<Self, PredictError> {
        let blocks: Vec<Block> = problem
            .observed
            .fit
            .par_iter()
            .zip(weights)
            .zip(passages)
            .map(|((&condition, weight), moments)| {
                let body = &problem.set.conditions[condition];
                let [angle, diameter] = [body.angle_deg.to_radians(), body.diameter];
                let nodes = near(&field.grid, moments, [angle, diameter]);
                let step = STEP * strength(moments);
                let columns =
                    columns(problem.forward, &fit.point, condition, (field, &nodes, step))?;
                let states = states(problem, &field.grid, (condition, &nodes));
                Ok(Block { nodes, answers: weight.whiten_columns(&columns), states })
            })
            .collect::<Result<_, PredictError>>()?;
        let basis = Basis::of(&fit.jacobian);
        let rows = fit.residual.len();
        let nodes: BTreeSet<usize> = blocks.iter().flat_map(|block| block.nodes.clone()).collect();
        let mut response = Self {
            blocks,
            basis,
            residual: DVector::zeros(rows),
            nodes: nodes.into_iter().collect(),
            beside: DMatrix::zeros(rows, 0),
            rows,
        };
        response.beside = response.rest_of(&response.whole());
        let there = response.change(&DVector::from_column_slice(&field.values));
        response.residual = response.basis.rest(&(&fit.residual + there));
        Ok(response)
    }

    /// What a force of these values would change beside the parameters; `values` at [`Self::states`], in units of ρ g A D.
    pub(super) fn of_values(&self, values: &[Vec<f64>]) -> DVector<f64> {
        let parts = self.blocks.iter().zip(values);
        let parts = parts.map(|(block, values)| {
            block.answers.columns(0, values.len()) * DVector::from_column_slice(values)
        });
        self.basis.rest(&self.placed(parts))
    }

    /// Change of the whitened observables by a force of these `values` at the nodes, parameters as they are.
    pub(super) fn change(&self, values: &DVector<f64>) -> DVector<f64> {
        self.placed(self.blocks.iter().map(|block| block.change(values)))
    }

    /// The answers with the parameters as they are, a column for each of [`Self::nodes`].
    pub(super) fn whole(&self) -> DMatrix<f64> {
        let mut columns = DMatrix::zeros(self.rows, self.nodes.len());
        let mut from = 0;
        for block in &self.blocks {
            for (at, answer) in block.nodes.iter().zip(block.answers.column_iter()) {
                if let Ok(place) = self.nodes.binary_search(at) {
                    columns.view_mut((from, place), (answer.len(), 1)).copy_from(&answer);
                }
            }
            from += block.answers.nrows();
        }
        columns
    }

    /// Every fitted condition with every node that its path comes near, in rising order.
    pub(super) fn by_condition(&self) -> Vec<(usize, usize)> {
        let mut places = Vec::new();
        for (at, block) in self.blocks.iter().enumerate() {
            let answers = block.nodes.iter().zip(block.answers.column_iter());
            let answers = answers.filter(|(_, answer)| answer.iter().any(|one| one.abs() > 0.0));
            places.extend(answers.map(|(&node, _)| (at, node)));
        }
        places
    }

    /// The answers to a force that only one condition meets, a column for each of `places`, parameters as they are.
    pub(super) fn of_places(&self, places: &[(usize, usize)]) -> DMatrix<f64> {
        let mut columns = DMatrix::zeros(self.rows, places.len());
        for (&(block, node), mut column) in places.iter().zip(columns.column_iter_mut()) {
            let from: usize = self.blocks[..block].iter().map(|one| one.answers.nrows()).sum();
            if let Some(answer) = self.blocks[block].column(node) {
                column.rows_mut(from, answer.len()).copy_from(&answer);
            }
        }
        columns
    }

    /// Each of `columns` beside the parameters.
    pub(super) fn rest_of(&self, columns: &DMatrix<f64>) -> DMatrix<f64> {
        let mut rest = columns.clone();
        for mut column in rest.column_iter_mut() {
            let own = self.basis.rest(&column.clone_owned());
            column.copy_from(&own);
        }
        rest
    }

    /// What a force with these `values` at all nodes leaves over beside the parameters.
    pub(super) fn left_by(&self, values: &DVector<f64>) -> DVector<f64> {
        &self.residual - &self.beside * self.at_nodes(values)
    }

    /// Those of `values` at all nodes that are at [`Self::nodes`].
    pub(super) fn at_nodes(&self, values: &DVector<f64>) -> DVector<f64> {
        DVector::from_iterator(self.nodes.len(), self.nodes.iter().map(|&node| values[node]))
    }

    /// The states at the nodes of the force against the motion that the path of each fitted condition comes near.
    pub(super) fn states(&self) -> impl Iterator<Item = &[State]> {
        self.blocks.iter().map(|block| &*block.states)
    }

    /// Blocks of all fitted conditions as one column; the rows below, of what is known beforehand, answer to no force.
    fn placed(&self, parts: impl Iterator<Item = DVector<f64>>) -> DVector<f64> {
        let mut column = DVector::zeros(self.rows);
        let mut at = 0;
        for part in parts {
            column.rows_mut(at, part.len()).copy_from(&part);
            at += part.len();
        }
        column
    }
}

/// Force of the model on the way, in units of ρ g A D.
fn strength(moments: &[Moment]) -> f64 {
    let mean = |of: fn(&Moment) -> f64| moments.iter().map(of).sum::<f64>() / moments.len() as f64;
    let (force, unit) = (mean(|one| one.force), mean(|one| one.unit));
    if force > 0.0 && unit > 0.0 { force / unit } else { 1.0 }
}

/// The nodes that count on a path, in rising order.
fn near(grid: &Grid, moments: &[Moment], [angle, diameter]: [f64; 2]) -> Vec<usize> {
    let places = moments.iter().map(|one| [one.depth, one.speed, angle, diameter]);
    let both =
        |place: [f64; 4]| grid.shares_at(place).into_iter().chain(grid.sideways_shares_at(place));
    let shares = places.flat_map(both);
    let near: BTreeSet<usize> =
        shares.filter(|(_, share)| *share > NEAR).map(|(node, _)| node).collect();
    near.into_iter().collect()
}

fn columns(
    forward: &dyn Forward,
    point: &Point,
    condition: usize,
    (field, nodes, step): (&Field, &[usize], f64),
) -> Result<DMatrix<f64>, PredictError> {
    let with = |values: Vec<f64>| {
        let field = Arc::new(Field { grid: field.grid.clone(), values });
        point.predict(&WithField { forward, field }, condition)
    };
    let mean = with(field.values.clone())?;
    let columns: Vec<DVector<f64>> = nodes
        .iter()
        .map(|&node| {
            let mut values = field.values.clone();
            values[node] += step;
            // A node with which it cannot be integrated is one that nothing is known of.
            with(values).map_or_else(|_| DVector::zeros(mean.len()), |there| (there - &mean) / step)
        })
        .collect();
    Ok(match columns.is_empty() {
        true => DMatrix::zeros(mean.len(), 0),
        false => DMatrix::from_columns(&columns),
    })
}

fn states(
    problem: &FitProblem<'_>,
    grid: &Grid,
    (condition, nodes): (usize, &[usize]),
) -> Vec<State> {
    let of = &problem.set.conditions[condition];
    let (gravity, impact_speed) = (problem.set.bed_of(of).gravity, of.speed);
    let against = nodes.iter().filter(|node| **node < grid.against());
    against
        .map(|&node| grid.node(node))
        .map(|[depth, speed, angle, diameter]| State {
            depth,
            speed,
            impact_speed,
            angle,
            diameter,
            gravity,
        })
        .collect()
}
