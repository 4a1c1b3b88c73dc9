//! Where a model fails, as the relative change of its force that would mend it.
//!
//! In every condition the force is multiplied around six depths, and generalised least squares on the
//! residual says by how much; the noise model knows that the force scatters along the path, so the
//! standard errors do too. Aggregates share one factor among conditions or depths.

use nalgebra::{Cholesky, DMatrix, DVector};
use serde::Serialize;

use crate::bench::{Bench, BenchError, Fitted};
use crate::discovery::discoveries;
use crate::measurement::Condition;
use crate::rounding::six_digits;
use crate::sensitivity::{Direction, force_response};

/// Depths per condition.
const NODES: usize = 6;

/// Fewest numbers of a condition from which all depths are told apart.
const ENOUGH: usize = 2 * NODES;

/// Most groups that the values of a covariate are cut into.
const GROUPS: usize = 5;

/// Share of false marks that is tolerated.
const FALSE_DISCOVERIES: f64 = 0.05;

/// Information below this share of the largest counts as none.
const RIDGE: f64 = 1e-10;

/// A force error over a part of what was varied.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ForceError {
    /// What was varied: `speed`, `angle_deg`, `z`, …
    pub over: &'static str,
    /// Least value of the part (SI, angles in degrees).
    #[serde(serialize_with = "six_digits")]
    pub from: f64,
    /// Greatest value.
    #[serde(serialize_with = "six_digits")]
    pub to: f64,
    /// By how much the force is larger than the model has it (1 = 100 %).
    #[serde(serialize_with = "six_digits")]
    pub force_error: f64,
    /// Its standard error.
    #[serde(serialize_with = "six_digits")]
    pub se: f64,
}

/// A force error in one condition around one depth.
#[derive(Clone, Debug, PartialEq)]
pub struct ForceCell {
    /// Index of the condition in the set.
    pub condition: usize,
    /// Where the part of the path begins (m).
    pub from: f64,
    /// Where it ends (m).
    pub to: f64,
    /// By how much the force is larger than the model has it (1 = 100 %).
    pub force_error: f64,
    /// Its standard error.
    pub se: f64,
    /// Whether it is a discovery at a rate of 5 % false ones.
    pub significant: bool,
}

/// Where a fitted model fails.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ForceErrors {
    /// By condition and depth.
    pub cells: Vec<ForceCell>,
    /// By covariate, those parts that are discoveries at a rate of 5 % false ones.
    pub fails: Vec<ForceError>,
}

impl ForceErrors {
    /// Of `fitted`.
    ///
    /// # Errors
    /// If the model fails.
    pub fn of(bench: &Bench<'_>, fitted: &Fitted) -> Result<Self, BenchError> {
        let mut normals = Vec::with_capacity(fitted.weights.len());
        let mut start = 0;
        for (&condition, weight) in bench.observed.fit.iter().zip(&fitted.weights) {
            let observed = &bench.observed.conditions[condition];
            let rows = observed.mean.len();
            let path = (NODES, observed.reach);
            let response = force_response(
                &fitted.fit.point,
                bench.forward,
                condition,
                Direction::Along,
                path,
            )?;
            let response = weight.whiten_columns(&response);
            let residual = fitted.fit.residual.rows(start, rows);
            start += rows;
            normals.push(Normal {
                condition,
                reach: observed.reach,
                resolved: rows >= ENOUGH,
                information: response.tr_mul(&response),
                score: response.tr_mul(&residual),
            });
        }
        let mut cells: Vec<ForceCell> = normals.iter().flat_map(Normal::cells).collect();
        let found = discoveries(
            &cells.iter().map(|cell| p_value(cell.force_error, cell.se)).collect::<Vec<_>>(),
            FALSE_DISCOVERIES,
        );
        for (cell, found) in cells.iter_mut().zip(found) {
            cell.significant = found;
        }
        let mut fails = over_depth(&normals);
        for (name, of) in COVARIATES {
            fails.extend(over_conditions(&normals, name, |at| of(&bench.set.conditions[at])));
        }
        let found = discoveries(
            &fails.iter().map(|fail| p_value(fail.force_error, fail.se)).collect::<Vec<_>>(),
            FALSE_DISCOVERIES,
        );
        let mut found = found.iter();
        fails.retain(|_| found.next() == Some(&true));
        Ok(Self { cells, fails })
    }

    /// What the force error depends on, clearest first.
    #[must_use]
    pub fn depends_on(&self) -> Vec<&'static str> {
        let mut fails: Vec<&ForceError> = self.fails.iter().collect();
        let clarity = |fail: &ForceError| (fail.force_error / fail.se).abs();
        fails.sort_by(|a, b| clarity(b).total_cmp(&clarity(a)));
        let mut names = Vec::new();
        for fail in fails {
            if !names.contains(&fail.over) {
                names.push(fail.over);
            }
        }
        names
    }
}

pub(crate) type Covariate = (&'static str, fn(&Condition) -> Option<f64>);

/// What a condition has that a force error may depend on.
pub(crate) const COVARIATES: [Covariate; 7] = [
    ("speed", |condition| Some(condition.speed)),
    ("angle_deg", |condition| Some(condition.angle_deg)),
    ("diameter", |condition| Some(condition.diameter)),
    ("mass", |condition| Some(condition.mass)),
    ("spin", |condition| Some(condition.spin)),
    ("packing", |condition| condition.packing),
    ("bed_depth", |condition| condition.bed_depth),
];

/// Normal equations for the force factors of one condition.
struct Normal {
    condition: usize,
    reach: f64,
    /// Whether there are enough numbers to tell the depths apart.
    resolved: bool,
    information: DMatrix<f64>,
    score: DVector<f64>,
}

impl Normal {
    /// Depth of node `index` (m).
    fn depth(&self, index: usize) -> f64 {
        self.reach * index as f64 / (NODES - 1) as f64
    }

    fn cells(&self) -> Vec<ForceCell> {
        let groups = if self.resolved { NODES } else { 1 };
        let group = |node: usize| if self.resolved { node } else { 0 };
        let half = 0.5 * self.reach / (NODES - 1) as f64;
        let range = |index: usize| match self.resolved {
            true => {
                ((self.depth(index) - half).max(0.0), (self.depth(index) + half).min(self.reach))
            }
            false => (0.0, self.reach),
        };
        let solved = solve(std::slice::from_ref(self), groups, |_, node| Some(group(node)));
        let cell = |(index, (force_error, se)): (usize, (f64, f64))| {
            let (from, to) = range(index);
            let condition = self.condition;
            ForceCell { condition, from, to, force_error, se, significant: false }
        };
        solved.into_iter().enumerate().map(cell).collect()
    }
}

/// Generalised least squares of one factor per group, each with its standard error; `group` says to
/// which a node of a condition belongs.
fn solve(
    normals: &[Normal],
    groups: usize,
    group: impl Fn(&Normal, usize) -> Option<usize>,
) -> Vec<(f64, f64)> {
    let mut information = DMatrix::<f64>::zeros(groups, groups);
    let mut score = DVector::<f64>::zeros(groups);
    for normal in normals {
        for i in 0..NODES {
            let Some(row) = group(normal, i) else { continue };
            score[row] += normal.score[i];
            for j in 0..NODES {
                if let Some(column) = group(normal, j) {
                    information[(row, column)] += normal.information[(i, j)];
                }
            }
        }
    }
    let ridge = RIDGE * information.diagonal().max();
    let factor = Cholesky::new(information + DMatrix::identity(groups, groups) * ridge);
    factor.map_or_else(Vec::new, |factor| {
        let inverse = factor.inverse();
        let estimate = &inverse * score;
        (0..groups).map(|g| (estimate[g], inverse[(g, g)].sqrt())).collect()
    })
}

fn over_depth(normals: &[Normal]) -> Vec<ForceError> {
    let resolved: Vec<&Normal> = normals.iter().filter(|normal| normal.resolved).collect();
    if resolved.is_empty() || resolved.len() < normals.len() {
        return Vec::new();
    }
    let deepest = resolved.iter().fold(0.0_f64, |deepest, normal| deepest.max(normal.reach));
    let width = deepest / GROUPS as f64;
    let group = |normal: &Normal, node: usize| {
        Some(((normal.depth(node) / width).floor() as usize).min(GROUPS - 1))
    };
    let solved = solve(normals, GROUPS, group).into_iter().enumerate();
    solved
        .map(|(at, (force_error, se))| {
            let from = at as f64 * width;
            ForceError { over: "z", from, to: from + width, force_error, se }
        })
        .collect()
}

fn over_conditions(
    normals: &[Normal],
    over: &'static str,
    value: impl Fn(usize) -> Option<f64>,
) -> Vec<ForceError> {
    let mut values: Vec<f64> = normals.iter().filter_map(|n| value(n.condition)).collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    if values.len() < 2 {
        return Vec::new();
    }
    let groups = values.len().min(GROUPS);
    let group_of = |place: usize| place * groups / values.len();
    let group = |normal: &Normal, _: usize| {
        let value = value(normal.condition)?;
        values.iter().position(|other| *other >= value).map(group_of)
    };
    let bound = |index: usize, last: bool| {
        let mut inside = (0..values.len()).filter(|&place| group_of(place) == index);
        let place = if last { inside.next_back() } else { inside.next() };
        place.map_or(0.0, |place| values[place])
    };
    let solved = solve(normals, groups, group).into_iter().enumerate();
    solved
        .map(|(at, (force_error, se))| ForceError {
            over,
            from: bound(at, false),
            to: bound(at, true),
            force_error,
            se,
        })
        .collect()
}

/// Two-sided, of a normal number.
fn p_value(value: f64, se: f64) -> f64 {
    if se > 0.0 { libm::erfc((value / se).abs() / std::f64::consts::SQRT_2) } else { 1.0 }
}
