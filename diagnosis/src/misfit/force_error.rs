//! Where a model fails, as the relative change of its force that would mend it.
//!
//! In every condition the force is multiplied around six depths, and generalised least squares on the
//! residual says by how much; the noise model knows that the force scatters along the path, so the
//! standard errors do too. Aggregates share one factor among conditions or depths, trends let it
//! change linearly. The residual is that of the fitted model, whose parameters have taken up what they
//! can: the errors are of what is left, and their standard errors rather too large than too small.

mod chronology;
mod groups;
mod normal;
mod part;
mod trend;

pub use self::part::{ForceCell, ForceError, Group};
pub use self::trend::Trend;

use self::chronology::Chronology;
use self::normal::Normal;
use self::part::p_value;
use crate::fit::problem::{FitError, FitProblem, Fitted};
use crate::misfit::covariate::OF_CONDITIONS;
use crate::misfit::discovery::discoveries;

/// Share of false marks that is tolerated.
const FALSE_DISCOVERIES: f64 = 0.05;

/// Where a fitted model fails, in the conditions that it was fitted to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ForceErrors {
    /// By condition and depth.
    pub cells: Vec<ForceCell>,
    /// By condition, over the whole path.
    pub means: Vec<ForceCell>,
    /// By part of each covariate that was varied.
    pub groups: Vec<Group>,
    /// Over each covariate that was varied.
    pub trends: Vec<Trend>,
}

impl ForceErrors {
    /// Of `fitted`; orders of runs are drawn with `seed`.
    pub fn of(problem: &FitProblem<'_>, fitted: &Fitted, seed: u64) -> Result<Self, FitError> {
        let normals = Normal::all(problem, fitted)?;
        let chronology = Chronology::of(problem, fitted, &normals, seed);
        let mut errors = groups::over_depth(&normals);
        let mut trends: Vec<Trend> = trend::over_depth(&normals).into_iter().collect();
        for (over, of) in OF_CONDITIONS {
            let value = |at: usize| of(&problem.set.conditions[at]);
            errors.extend(groups::over_conditions(&normals, over, value));
            trends.extend(trend::over_conditions(&normals, over, value));
        }
        trends.extend(chronology.trends);
        let found = believed(trends.iter().map(|trend| trend.p));
        trends.iter_mut().zip(found).for_each(|(trend, found)| trend.significant = found);
        let mut groups = marked(errors);
        groups.extend(marked(chronology.groups));
        Ok(Self {
            cells: marked_cells(normals.iter().flat_map(groups::cells).collect()),
            means: marked_cells(normals.iter().filter_map(groups::mean).collect()),
            groups,
            trends,
        })
    }

    /// Those parts of covariates of conditions and depths that are discoveries.
    pub fn fails(&self) -> Vec<ForceError> {
        let of_runs = crate::misfit::covariate::ORDER.name;
        let fails = self.groups.iter().filter(|group| group.significant);
        fails.map(|group| group.error.clone()).filter(|error| error.over != of_runs).collect()
    }

    /// What the force error depends on, clearest first; then what [`ForceErrors::drifts`] says.
    pub fn depends_on(&self) -> Vec<&'static str> {
        let mut fails = self.fails();
        let clarity = |fail: &ForceError| (fail.force_error / fail.se).abs();
        fails.sort_by(|a, b| clarity(b).total_cmp(&clarity(a)));
        let mut names = Vec::new();
        for fail in fails {
            if !names.contains(&fail.over) {
                names.push(fail.over);
            }
        }
        names.extend(self.drifts());
        names
    }

    /// `order` where the force drifts from run to run, `previous_run` where a run resembles the one
    /// before it under the same condition; each at 1 % over both.
    pub fn drifts(&self) -> Vec<&'static str> {
        chronology::beyond_chance(&self.trends)
    }
}

fn marked(errors: Vec<ForceError>) -> Vec<Group> {
    let found = believed(errors.iter().map(|error| p_value(error.force_error, error.se)));
    let pairs = errors.into_iter().zip(found);
    pairs.map(|(error, significant)| Group { error, significant }).collect()
}

fn marked_cells(mut cells: Vec<ForceCell>) -> Vec<ForceCell> {
    let found = believed(cells.iter().map(|cell| p_value(cell.force_error, cell.se)));
    cells.iter_mut().zip(found).for_each(|(cell, found)| cell.significant = found);
    cells
}

fn believed(p: impl Iterator<Item = f64>) -> Vec<bool> {
    discoveries(&p.collect::<Vec<_>>(), FALSE_DISCOVERIES)
}
