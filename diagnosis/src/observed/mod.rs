//! What a measurement set says about the observables: the vectors of its runs, condition by condition.

pub(crate) mod curves;
pub mod error_columns;
pub(crate) mod reading_error;
pub(crate) mod resampling;
pub(crate) mod series;

use std::cmp::Ordering;

use measurements::{Cleaned, Condition, Frame, Kind, MeasurementSet, Role, Run, without_strays};
use nalgebra::DVector;

use crate::forward::apparatus::too_many;
use crate::forward::observable::{Curve, Layout, Observable};
use crate::observed::curves::CommonCurve;
use crate::observed::reading_error::{LEAST, UNSTATED, position_error, reading, stated};
use crate::observed::resampling::{depth_and_range, seen_grid, stopped_at};
use crate::observed::series::{evenly, stated_sigma};

/// How many independent numbers the frames of one run hold of the scatter of runs: two coefficients, the impact speed
/// and the slowest changes along the path.
const OF_A_RUN: usize = 4;

/// Most frames of the penetration that are compared; neighbours in time tell the same.
pub(crate) const PENETRATION_FRAMES: usize = 24;

/// Most frames before first contact that are compared: they carry speed and friction of a guide.
const FLIGHT_FRAMES: usize = 6;

/// Share of the time to the stop whose frames are compared where the resting point is measured too:
/// later, some runs have stopped and others not, and a prediction has a kink in every parameter.
pub(crate) const BEFORE_STOP: f64 = 0.9;

/// The observables of all conditions, in the order of the set.
#[derive(Clone, Debug, PartialEq)]
pub struct Observed {
    /// One entry per condition of the set; one without usable runs has an empty layout.
    pub conditions: Vec<ObservedCondition>,
    /// Indices of the conditions that may be fitted to and have something to fit to.
    pub fit: Vec<usize>,
    /// Indices of the conditions that judge alone.
    pub holdout: Vec<usize>,
    /// What was left aside, in sentences for the report.
    pub notes: Vec<String>,
}

/// The observables of one condition.
#[derive(Clone, Debug, PartialEq)]
pub struct ObservedCondition {
    /// Its name in the set.
    pub id: String,
    /// What the numbers are.
    pub layout: Layout,
    /// One vector per run, in an order that their values alone decide.
    pub runs: Vec<DVector<f64>>,
    /// Place in time of each run among all runs, where the set says it.
    pub order: Vec<Option<i64>>,
    /// Mean over the runs.
    pub mean: DVector<f64>,
    /// Standard deviation of one reading of each number (in its own unit).
    pub reading: DVector<f64>,
    /// Stated relative error of each number (1 = 100 %).
    pub stated: Vec<Option<f64>>,
    /// Greatest mean depth (m): how far the path goes that forces scatter along.
    pub reach: f64,
}

impl Observed {
    /// The observables of `set`.
    ///
    /// Trajectories are brought to common times (interpolated where the frames of runs differ) and
    /// thinned; the analysed part ends when the speed of the mean run first falls below 5 % of the
    /// impact speed (a tenth earlier, where the resting point is measured), so the creep of shallow
    /// slow shots is left out. Scalars count where every run
    /// of the condition has them. Stray frames and mistracked runs are left out ([`without_strays`]).
    pub fn of(set: &MeasurementSet) -> Self {
        let Cleaned { set, mut notes } = without_strays(set, position_error(&set.instrument));
        let set = &set;
        let conditions: Vec<_> = (0..set.conditions.len())
            .map(|index| ObservedCondition::of(set, index, &mut notes))
            .collect();
        let with_role = |role: Role| {
            let usable = conditions.iter().zip(&set.conditions).enumerate();
            usable
                .filter(|(_, (observed, condition))| {
                    condition.role == role && !observed.layout.is_empty()
                })
                .map(|(index, _)| index)
                .collect::<Vec<_>>()
        };
        let (fit, holdout) = (with_role(Role::Fit), with_role(Role::Holdout));
        notes.extend(note_readings(set));
        notes.extend(too_many(set));
        let mut observed = Self { conditions, fit, holdout, notes };
        let assumed = set.kind.has_readings()
            && set.states_errors()
            && !observed.has_repeats()
            && !observed.has_stated_errors();
        if assumed {
            observed.notes.push(
                "nothing was repeated: it is assumed that from run to run coefficients scatter by \
                 5 % and the force along the path by 12 %"
                    .to_owned(),
            );
        }
        observed
    }

    /// With at most so many `frames` of every condition, evenly spaced, first and last among them.
    pub fn thinned(&self, frames: usize) -> Self {
        let conditions = self.conditions.iter().map(|condition| condition.thinned(frames));
        Self { conditions: conditions.collect(), ..self.clone() }
    }

    /// Whether any condition that may be fitted to was repeated.
    pub(crate) fn has_repeats(&self) -> bool {
        self.contrasts() > 0
    }

    /// How many independent deviations from the means of conditions the repeats give.
    pub(crate) fn contrasts(&self) -> usize {
        self.fit.iter().map(|&index| self.conditions[index].runs.len() - 1).sum()
    }

    /// From how many independent numbers the scatter of runs is known: the frames of one run are no more than
    /// four of them. Infinite where nothing is learned from repeats.
    pub fn freedom(&self) -> f64 {
        let of = |&index: &usize| {
            let condition = &self.conditions[index];
            (condition.runs.len() - 1) * condition.mean.len().min(OF_A_RUN)
        };
        match self.fit.iter().map(of).sum::<usize>() {
            0 => f64::INFINITY,
            freedom => freedom as f64,
        }
    }

    /// Whether every number of every condition to fit has a stated error.
    pub fn has_stated_errors(&self) -> bool {
        !self.fit.is_empty()
            && self.fit.iter().all(|&c| self.conditions[c].stated.iter().all(Option::is_some))
    }

    /// The layouts, in the order of the conditions: what a model is asked to predict.
    pub fn layouts(&self) -> Vec<Layout> {
        self.conditions.iter().map(|condition| condition.layout.clone()).collect()
    }
}

/// The numbers of a run, and its place in the order of measurement.
type Numbered = (DVector<f64>, Option<i64>);

fn by_numbers((a, first): &Numbered, (b, second): &Numbered) -> Ordering {
    let mut pairs = a.iter().zip(b.iter()).map(|(a, b)| a.total_cmp(b));
    let of_numbers = pairs.find(|order| order.is_ne());
    of_numbers.unwrap_or(a.len().cmp(&b.len())).then(first.cmp(second))
}

/// Whether the `runs` of a condition are trajectories; then those without one are left out, which is noted.
fn keep_tracked(runs: &mut Vec<&Run>, (kind, id): (Kind, &str), notes: &mut Vec<String>) -> bool {
    let has_frames = |run: &&Run| run.frames.len() > 2;
    let tracked = kind == Kind::Trajectory && runs.iter().any(has_frames);
    if tracked {
        let all = runs.len();
        runs.retain(has_frames);
        if runs.len() < all {
            let missing = all - runs.len();
            notes.push(format!(
                "condition {id}: {missing} of {all} runs have no trajectory and are left out"
            ));
        }
    } else if runs.iter().any(|run| !run.frames.is_empty()) {
        notes.push(format!(
            "condition {id}: no run has more than two readings, and none of them is used"
        ));
    }
    tracked
}

impl ObservedCondition {
    /// Standard deviation over the runs of the number at `at`; that of its reading, where there is one run.
    pub(crate) fn scatter(&self, at: usize) -> f64 {
        let runs = self.runs.len();
        if runs < 2 {
            return self.reading[at];
        }
        let squares = self.runs.iter().map(|run| (run[at] - self.mean[at]).powi(2));
        (squares.sum::<f64>() / (runs - 1) as f64).sqrt()
    }

    fn of(set: &MeasurementSet, index: usize, notes: &mut Vec<String>) -> Self {
        let condition = &set.conditions[index];
        let mut runs: Vec<&Run> = set.runs.iter().filter(|run| run.condition == index).collect();
        let observable = Observable::of_curve(set.kind);
        let tracked = keep_tracked(&mut runs, (set.kind, &condition.id), notes);
        let common = |of: fn(&Run) -> Option<f64>| {
            !runs.is_empty()
                && runs.iter().all(|run| of(run).is_some())
                && runs.iter().any(|run| of(run) != Some(0.0))
        };
        let share = if common(|run| run.final_z) { BEFORE_STOP } else { 1.0 };
        let frames = match tracked {
            true => frames_of(&runs, condition, share),
            false => CommonFrames::default(),
        };
        let common_curve =
            observable.map(|_| CommonCurve::of(set, condition, &runs)).unwrap_or_default();
        // Beside numbers with a stated error, one that has neither that nor repeats has no weight.
        let unrepeated = set.runs.len() <= set.conditions.len();
        let only_stated = set.kind == Kind::Scalar && unrepeated && set.states_errors();
        let mut weighed = |there: bool, kind: Observable| {
            let kept = there && (!only_stated || stated(&set.stated, kind).is_some());
            if there && !kept {
                let (id, key) = (&condition.id, kind.key());
                notes.push(format!("condition {id}: {key} has no stated error and is left out"));
            }
            kept
        };
        let layout = Layout {
            along_x: frames.range.iter().flatten().any(|x| *x != 0.0),
            times: frames.times,
            curve: observable.map(|observable| Curve { observable, at: common_curve.at }),
            stop_time: weighed(common(|run| run.stop_time), Observable::StopTime),
            final_z: weighed(common(|run| run.final_z), Observable::FinalDepth),
            final_x: weighed(common(|run| run.final_x), Observable::FinalRange),
            crater_depth: weighed(common(|run| run.crater.depth), Observable::CraterDepth),
            rim_diameter: weighed(common(|run| run.crater.rim_diameter), Observable::RimDiameter),
        };
        let mut numbered: Vec<Numbered> = (0..runs.len())
            .map(|at| {
                let readings = [&frames.depth, &frames.range, &common_curve.values];
                let numbers = vector(&layout, runs[at], readings.map(|all| all.get(at)));
                (numbers, runs[at].order)
            })
            .collect();
        numbered.sort_by(by_numbers);
        let (mut vectors, mut order): (Vec<_>, Vec<_>) = numbered.into_iter().unzip();
        if layout.is_empty() {
            vectors.clear();
            order.clear();
            notes.push(format!("condition {} has nothing to compare", condition.id));
        }
        let mean = mean(&vectors, layout.len());
        let kinds = layout.kinds();
        Self {
            id: condition.id.clone(),
            reading: reading(set, &layout, condition, [&frames.sigma, &common_curve.sigma]),
            stated: kinds.iter().map(|kind| stated(&set.stated, *kind)).collect(),
            reach: reach(set, &layout, &mean, condition),
            layout,
            runs: vectors,
            order,
            mean,
        }
    }

    fn thinned(&self, frames: usize) -> Self {
        let all = self.layout.times.len();
        let times = evenly(all, frames);
        let tracks = if self.layout.along_x { 2 * all } else { all };
        let of_frames = (0..tracks)
            .step_by(all.max(1))
            .flat_map(|track| times.iter().map(move |time| track + time));
        let of_curve = self.layout.curve.as_ref().map_or(0, |curve| curve.at.len());
        let places = evenly(of_curve, frames);
        let kept: Vec<usize> = of_frames
            .chain(places.iter().map(|place| tracks + place))
            .chain(tracks + of_curve..self.layout.len())
            .collect();
        let pick = |numbers: &DVector<f64>| numbers.select_rows(&kept);
        Self {
            id: self.id.clone(),
            layout: Layout {
                times: times.iter().map(|&time| self.layout.times[time]).collect(),
                curve: self.layout.curve.as_ref().map(|curve| Curve {
                    at: places.iter().map(|&place| curve.at[place]).collect(),
                    ..*curve
                }),
                ..self.layout.clone()
            },
            runs: self.runs.iter().map(pick).collect(),
            order: self.order.clone(),
            mean: pick(&self.mean),
            reading: pick(&self.reading),
            stated: kept.iter().map(|&row| self.stated[row]).collect(),
            reach: self.reach,
        }
    }

    /// The numbers of run `run` less the mean of the condition.
    pub fn deviation(&self, run: usize) -> DVector<f64> {
        &self.runs[run] - &self.mean
    }
}

/// What the errors of readings count as, where that is not what the set states.
fn note_readings(set: &MeasurementSet) -> Option<String> {
    if let Some(curve) = set.kind.curve() {
        return curves::note_readings(set, curve);
    }
    if set.kind != Kind::Trajectory {
        return None;
    }
    let frames = || set.runs.iter().flat_map(|run| &run.frames);
    let stated = || frames().filter_map(|frame| frame.sigma).chain(set.instrument.position_sigma);
    if set.instrument.position_sigma.is_none() && frames().any(|frame| frame.sigma.is_none()) {
        return Some(format!(
            "readings without a stated error count as known to {} mm",
            1e3 * UNSTATED
        ));
    }
    stated().any(|sigma| sigma < LEAST).then(|| {
        format!(
            "stated errors of readings below {} µm count as {0} µm: predictions are no better",
            1e6 * LEAST
        )
    })
}

/// Readings of all runs of a condition at the same times.
#[derive(Default)]
struct CommonFrames {
    times: Vec<f64>,
    /// Per run, per time (m).
    depth: Vec<Vec<f64>>,
    range: Vec<Vec<f64>>,
    /// Stated standard deviation per time (m).
    sigma: Vec<Option<f64>>,
}

/// Frames of `runs` up to `share` of the time to the stop.
fn frames_of(runs: &[&Run], condition: &Condition, share: f64) -> CommonFrames {
    let tracks: Vec<&[Frame]> = runs.iter().map(|run| run.frames.as_slice()).collect();
    let grid = seen_grid(&tracks);
    let readings: Vec<_> = tracks.iter().map(|track| depth_and_range(track, &grid)).collect();
    let at = |time: usize, part: fn(&(f64, f64)) -> f64| {
        readings.iter().map(|run| part(&run[time])).sum::<f64>() / readings.len() as f64
    };
    let mean: Vec<(f64, f64)> =
        (0..grid.len()).map(|time| (at(time, |r| r.0), at(time, |r| r.1))).collect();
    let flight = grid.iter().take_while(|t| **t < 0.0).count();
    let stop = stopped_at(&grid, &mean, condition.speed);
    let end = flight + (share * stop.saturating_sub(flight) as f64).ceil() as usize;
    let in_bed = evenly(end.saturating_sub(flight), PENETRATION_FRAMES);
    let kept: Vec<usize> = evenly(flight, FLIGHT_FRAMES)
        .into_iter()
        .chain(in_bed.into_iter().map(|at| flight + at))
        .collect();
    let sigma = |&time: &usize| {
        let stated = tracks.iter().map(|track| track.iter().map(|frame| (frame.t, frame.sigma)));
        stated_sigma(stated, grid[time])
    };
    let part = |of: fn(&(f64, f64)) -> f64| {
        readings.iter().map(|run| kept.iter().map(|&time| of(&run[time])).collect()).collect()
    };
    CommonFrames {
        times: kept.iter().map(|&time| grid[time]).collect(),
        depth: part(|r| r.0),
        range: part(|r| r.1),
        sigma: kept.iter().map(sigma).collect(),
    }
}

/// The numbers of a run: depth and range over time, and what its curve reads.
fn vector(
    layout: &Layout,
    run: &Run,
    [depth, range, curve]: [Option<&Vec<f64>>; 3],
) -> DVector<f64> {
    let mut numbers: Vec<f64> = depth.cloned().unwrap_or_default();
    if layout.along_x {
        numbers.extend(range.into_iter().flatten());
    }
    numbers.extend(curve.into_iter().flatten());
    numbers.extend(layout.scalars().filter_map(|kind| match kind {
        Observable::StopTime => run.stop_time,
        Observable::FinalDepth => run.final_z,
        Observable::FinalRange => run.final_x,
        Observable::CraterDepth => run.crater.depth,
        Observable::RimDiameter => run.crater.rim_diameter,
        _ => None,
    }));
    DVector::from_vec(numbers)
}

fn mean(vectors: &[DVector<f64>], len: usize) -> DVector<f64> {
    let sum = vectors.iter().fold(DVector::zeros(len), |sum, vector| sum + vector);
    sum / vectors.len().max(1) as f64
}

/// Greatest depth (m) among the numbers `mean`, or of forces; a diameter where none is measured.
pub(crate) fn reach(
    set: &MeasurementSet,
    layout: &Layout,
    mean: &DVector<f64>,
    condition: &Condition,
) -> f64 {
    if let Some(curve) = &layout.curve {
        let known = (condition.speed, set.bed_of(condition).gravity);
        if let Some(way) = curves::way(set.kind, &curve.at, mean.as_slice(), known) {
            return way;
        }
    }
    let kinds = layout.kinds();
    let depths = kinds.iter().zip(mean.iter());
    let depths = depths
        .filter(|(kind, _)| matches!(kind, Observable::Depth | Observable::FinalDepth))
        .map(|(_, z)| *z);
    let forces = layout.curve.iter().filter(|curve| curve.observable == Observable::Force);
    let deepest =
        depths.chain(forces.flat_map(|curve| curve.at.iter().copied())).fold(0.0_f64, f64::max);
    if deepest > 0.0 { deepest } else { condition.diameter }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_sets::{condition, scalar_run, set, trajectory_run};

    #[test]
    fn creep_behind_the_stop_is_left_out_and_the_flight_is_kept() {
        // 1 m/s that decays at 20 /s: 5 % is reached after 0.15 s.
        let fall = |t: f64| if t < 0.0 { t } else { (1.0 - libm::exp(-20.0 * t)) / 20.0 };
        let runs = [1.0, 1.02].map(|scale| trajectory_run(0, |t| (scale * fall(t), 0.0)));
        let observed =
            Observed::of(&set(Kind::Trajectory, vec![condition(1.0, 90.0)], runs.into()));
        let times = &observed.conditions[0].layout.times;
        assert_eq!(times.iter().filter(|t| **t < 0.0).count(), FLIGHT_FRAMES);
        assert_eq!(times.len(), FLIGHT_FRAMES + PENETRATION_FRAMES);
        // One smoothing window of seven frames at 500 Hz wide.
        assert!((times[times.len() - 1] - 0.15).abs() < 0.008, "{times:?}");
        assert!(!observed.conditions[0].layout.along_x);
    }

    #[test]
    fn a_thinned_condition_has_the_same_numbers_at_the_times_it_keeps() {
        let mut run = trajectory_run(0, |t| (t - t * t, 0.5 * t));
        run.final_z = Some(0.04);
        let set = set(Kind::Trajectory, vec![condition(1.0, 60.0)], vec![run.clone(), run]);
        let whole = Observed::of(&set);
        let (all, few) = (&whole.conditions[0], &whole.thinned(5).conditions[0]);
        let n = all.layout.times.len();
        assert_eq!((few.layout.times.len(), few.mean.len(), few.stated.len()), (5, 11, 11));
        assert_eq!(few.layout.times[0].to_bits(), all.layout.times[0].to_bits());
        assert_eq!(few.layout.times[4].to_bits(), all.layout.times[n - 1].to_bits());
        for (at, time) in few.layout.times.iter().enumerate() {
            let before =
                all.layout.times.iter().position(|one| one.to_bits() == time.to_bits()).unwrap();
            assert_eq!(few.mean[at].to_bits(), all.mean[before].to_bits());
            assert_eq!(few.runs[1][5 + at].to_bits(), all.runs[1][n + before].to_bits());
        }
        assert!((few.mean[10] - 0.04).abs() < 1e-15);
        assert_eq!(*all, whole.thinned(n).conditions[0]);
    }

    #[test]
    fn runs_with_other_frames_are_interpolated_to_common_times() {
        let mut shifted = trajectory_run(0, |t| (t, 0.5 * t));
        for frame in &mut shifted.frames {
            *frame =
                Frame { t: frame.t + 0.0007, z: frame.z + 0.0007, x: frame.x + 0.00035, ..*frame };
        }
        let runs = vec![shifted, trajectory_run(0, |t| (t, 0.5 * t))];
        let observed = Observed::of(&set(Kind::Trajectory, vec![condition(1.0, 60.0)], runs));
        let condition = &observed.conditions[0];
        // A straight line is interpolated without error.
        assert!((&condition.runs[0] - &condition.runs[1]).amax() < 1e-14);
    }

    #[test]
    fn runs_of_one_or_two_readings_have_no_frames_and_a_note() {
        for readings in [1, 2] {
            let mut runs = [0, 1].map(|_| trajectory_run(0, |t| (t, 0.0)));
            for run in &mut runs {
                run.frames.truncate(readings);
                run.stop_time = Some(0.1);
            }
            let set = set(Kind::Trajectory, vec![condition(1.0, 90.0)], runs.into());
            let observed = Observed::of(&set);
            assert_eq!(observed.conditions[0].layout.kinds(), [Observable::StopTime]);
            assert_eq!(observed.notes.len(), 1, "{:?}", observed.notes);
        }
    }

    #[test]
    fn a_scalar_counts_where_every_run_has_it() {
        let runs = vec![
            scalar_run(0, [Some(0.1), Some(0.05), None]),
            scalar_run(0, [Some(0.11), None, None]),
            scalar_run(1, [Some(0.1), Some(0.05), Some(0.02)]),
        ];
        let conditions = vec![condition(1.0, 90.0), condition(1.0, 45.0)];
        let observed = Observed::of(&set(Kind::Scalar, conditions, runs));
        use Observable::{FinalDepth, FinalRange, StopTime};
        assert_eq!(observed.conditions[0].layout.kinds(), [StopTime]);
        assert_eq!(observed.conditions[1].layout.kinds(), [StopTime, FinalDepth, FinalRange]);
    }

    #[test]
    fn without_repeats_scalars_without_a_stated_error_are_left_out_with_a_note() {
        let runs = vec![scalar_run(0, [Some(0.1), Some(0.05), None])];
        let mut set = set(Kind::Scalar, vec![condition(1.0, 90.0)], runs);
        set.stated.final_z = Some(0.06);
        let observed = Observed::of(&set);
        assert_eq!(observed.conditions[0].layout.kinds(), [Observable::FinalDepth]);
        assert!(observed.has_stated_errors() && observed.notes.len() == 1);
    }

    #[test]
    fn the_order_of_runs_changes_nothing() {
        let mut runs = vec![
            scalar_run(0, [Some(0.1), Some(0.05), None]),
            scalar_run(0, [Some(0.1), Some(0.04), None]),
            scalar_run(0, [Some(0.09), Some(0.05), None]),
        ];
        let of = |runs: &[Run]| {
            Observed::of(&set(Kind::Scalar, vec![condition(1.0, 90.0)], runs.to_vec()))
        };
        let before = of(&runs);
        runs.reverse();
        assert_eq!(before, of(&runs));
    }
}
