//! The force that a named effect adds along the ways of the bodies.

use measurements::Condition;
use serde::Serialize;

use crate::fit::Fit;
use crate::fit::problem::FitProblem;
use crate::forward::observable::Observable;
use crate::forward::sensitivity::Point;
use crate::forward::{Moment, Request, Scatter};
use crate::rounding::six_digits;

/// Moments of each condition at which the force is asked for.
const MOMENTS: usize = 200;

/// What an effect adds to the force of the model that it is a part of, the other coefficients as fitted, in the
/// condition in which that is most.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AddedForce {
    /// How much that is.
    #[serde(flatten)]
    pub size: Size,
    /// Force of the model with the effect (N), at the same moment or in the same mean.
    #[serde(serialize_with = "six_digits")]
    pub of: f64,
    /// Name of the condition.
    pub condition: String,
    /// Depth of the lowest point at that moment (m); of a mean, the greatest.
    #[serde(serialize_with = "six_digits")]
    pub depth: f64,
    /// Speed at that moment (m/s); of a mean, that at contact.
    #[serde(serialize_with = "six_digits")]
    pub speed: f64,
}

impl AddedForce {
    /// Whether the effect removes more work than the whole force does. Such a fit makes two large forces cancel each other.
    pub(crate) fn is_cancelled(&self) -> bool {
        match self.size {
            Size::AtAMoment { share_of_work, .. } => share_of_work < -1.0,
            Size::OnTheWayDown { .. } => false,
        }
    }
}

/// The force of an effect.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Size {
    /// Of a force law, whose force is known at every moment.
    AtAMoment {
        /// Where it is greatest, against the motion (N); negative where the effect weakens the resistance.
        #[serde(serialize_with = "six_digits")]
        greatest: f64,
        /// Work of the effect over that of the model with it, in all conditions that were fitted to.
        #[serde(serialize_with = "six_digits")]
        share_of_work: f64,
    },
    /// Of a bed of grains, the mean vertical force from contact to the deepest point.
    ///
    /// m (g + w²/2d), with the vertical speed at contact w and the greatest depth d: what brings the body to rest over
    /// that way.
    OnTheWayDown {
        /// With the effect less without it (N).
        #[serde(serialize_with = "six_digits")]
        mean: f64,
    },
}

/// What each effect of `fit` adds. `None` of effects that are no force against the motion, where the model cannot be
/// integrated so far, and of beds of which no depth was measured.
pub(crate) fn added_forces(problem: &FitProblem<'_>, fit: &Fit) -> Vec<Option<AddedForce>> {
    let n_effects = fit.point.effects.len();
    if problem.forward.by_formulas().is_none() {
        return (0..n_effects).map(|place| mean_force(problem, fit, place)).collect();
    }
    let Some(passages) = passages(problem, fit) else { return vec![None; n_effects] };
    (0..n_effects).map(|place| greatest_force(problem, &passages, place)).collect()
}

/// What effect `place` of `fit` adds to the mean force on the way down.
fn mean_force(problem: &FitProblem<'_>, fit: &Fit, place: usize) -> Option<AddedForce> {
    let mut without = fit.point.clone();
    without.effects[place].1 = 0.0;
    let changes = problem.observed.fit.iter().filter_map(|&condition| {
        let with = way_down(problem, &fit.point, condition)?;
        let without = way_down(problem, &without, condition)?;
        Some((condition, with, with.1 - without.1))
    });
    let most = changes.max_by(|a, b| a.2.abs().total_cmp(&b.2.abs()));
    let (condition, (depth, of), mean) = most.filter(|(.., mean)| *mean != 0.0)?;
    let Condition { id, speed, .. } = &problem.set.conditions[condition];
    let size = Size::OnTheWayDown { mean };
    Some(AddedForce { size, of, condition: id.clone(), depth, speed: *speed })
}

/// The greatest depth (m) that the model at `point` predicts for a condition, and the mean force on the way there (N).
fn way_down(problem: &FitProblem<'_>, point: &Point, condition: usize) -> Option<(f64, f64)> {
    let body = &problem.set.conditions[condition];
    let fall = body.speed * libm::sin(body.angle_deg.to_radians());
    let kinds = problem.observed.conditions[condition].layout.kinds();
    let predicted = point.predict(problem.forward, condition).ok()?;
    let is_depth = |kind: Observable| matches!(kind, Observable::Depth | Observable::FinalDepth);
    let depths = kinds.into_iter().zip(predicted.iter()).filter(|(kind, _)| is_depth(*kind));
    let depth = depths.map(|(_, depth)| *depth).fold(0.0, f64::max);
    let gravity = problem.set.bed_of(body).gravity;
    (depth > 0.0).then(|| (depth, body.mass * (gravity + fall * fall / (2.0 * depth))))
}

/// What bodies go through in each condition, and what they would meet without each effect.
fn passages(problem: &FitProblem<'_>, fit: &Fit) -> Option<Vec<(usize, Vec<Moment>)>> {
    let by = problem.forward.by_formulas().filter(|_| !fit.point.effects.is_empty())?;
    let scatter = Scatter {
        coefficients: vec![0.0; problem.forward.n_scattering_coefficients()],
        ..Scatter::default()
    };
    let (parameters, effects) = (fit.point.parameters.as_slice(), fit.point.effects.as_slice());
    let without: Vec<Vec<(usize, f64)>> = (0..effects.len())
        .map(|place| {
            let mut others = effects.to_vec();
            others[place].1 = 0.0;
            others
        })
        .collect();
    let at = |effects| Request { parameters, effects, scatter: &scatter };
    let without: Vec<Request<'_>> = without.iter().map(|effects| at(effects)).collect();
    let of = |&condition: &usize| {
        let moments = by.passage(condition, &at(effects), &without, MOMENTS).ok()?;
        Some((condition, moments))
    };
    problem.observed.fit.iter().map(of).collect()
}

/// What effect `place` adds where that is most along `passages`.
fn greatest_force(
    problem: &FitProblem<'_>,
    passages: &[(usize, Vec<Moment>)],
    place: usize,
) -> Option<AddedForce> {
    let added = |moment: &Moment| moment.force - moment.others[place][0];
    let all = passages
        .iter()
        .flat_map(|(condition, moments)| moments.iter().map(move |moment| (*condition, moment)));
    let (condition, most) = all.max_by(|a, b| added(a.1).abs().total_cmp(&added(b.1).abs()))?;
    let works = passages.iter().flat_map(|(_, moments)| moments.windows(2)).map(|pair| {
        let (a, b) = (&pair[0], &pair[1]);
        let way = 0.5 * (a.speed + b.speed) * (b.time - a.time).max(0.0);
        [0.5 * (added(a) + added(b)) * way, 0.5 * (a.force + b.force) * way]
    });
    let [work, of_model] = works.fold([0.0; 2], |sum, one| [sum[0] + one[0], sum[1] + one[1]]);
    (added(most) != 0.0 && of_model != 0.0).then(|| AddedForce {
        size: Size::AtAMoment { greatest: added(most), share_of_work: work / of_model },
        of: most.force,
        condition: problem.set.conditions[condition].id.clone(),
        depth: most.depth,
        speed: most.speed,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_force_that_removes_more_work_than_is_left_is_cancelled() {
        let with = |share_of_work| AddedForce {
            size: Size::AtAMoment { greatest: -1.0, share_of_work },
            of: 1.0,
            condition: String::new(),
            depth: 0.01,
            speed: 1.0,
        };
        assert!(with(-1.1).is_cancelled());
        assert!(!with(-0.9).is_cancelled() && !with(3.0).is_cancelled());
        let of_a_bed = AddedForce { size: Size::OnTheWayDown { mean: -5.0 }, ..with(0.0) };
        assert!(!of_a_bed.is_cancelled(), "its work is not known");
    }
}
