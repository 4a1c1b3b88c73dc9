//! Scalars of single runs that are mistyped: far from what the frames of the run show, or from the other runs of its condition.
//!
//! No model is used. All runs of a set read their scalars by the same rule, so the ratio of a scalar to what the frames show
//! is the same in all of them, but for scatter.

use crate::median::{deviation_of, median};
use crate::{Frame, MeasurementSet, Run};

/// Fewest runs that say what is usual.
const FEWEST: usize = 4;

/// A scalar is mistyped if its logarithm is this many times as far from the usual one as the usual deviation.
const APART: f64 = 10.0;

/// Share of runs that may be mistyped; where more look so, nobody knows what is usual.
const SHARE: f64 = 0.25;

/// Frames at the end of a path by which a body rests there, and the share of its greatest speed below which it does.
const AT_THE_END: usize = 6;
const AT_REST: f64 = 0.15;

/// A scalar of a run, and what its frames show instead.
struct Scalar {
    key: &'static str,
    unit: &'static str,
    value: fn(&Run) -> Option<f64>,
    take: fn(&mut Run) -> Option<f64>,
    seen: fn(&Run) -> Option<f64>,
    /// Smallest deviation of the logarithm that is no scatter.
    least: f64,
}

const SCALARS: [Scalar; 2] = [
    Scalar {
        key: "final_z",
        unit: "m",
        value: |run| run.final_z,
        take: |run| run.final_z.take(),
        seen: |run| Some(deepest(run)?.z),
        least: 0.5,
    },
    Scalar {
        key: "stop_time",
        unit: "s",
        value: |run| run.stop_time,
        take: |run| run.stop_time.take(),
        seen: |run| Some(deepest(run)?.t),
        least: 1.0,
    },
];

/// The deepest frame of a run that comes to rest in its frames.
fn deepest(run: &Run) -> Option<&Frame> {
    let speed = |pair: &[Frame]| (pair[1].z - pair[0].z) / (pair[1].t - pair[0].t);
    let fastest = run.frames.windows(2).map(speed).reduce(f64::max)?;
    let from = run.frames.len().checked_sub(AT_THE_END)?;
    let in_the_end = median(run.frames[from..].windows(2).map(speed))?;
    let rests = in_the_end < AT_REST * fastest;
    run.frames.iter().max_by(|a, b| a.z.total_cmp(&b.z)).filter(|_| rests)
}

/// Takes mistyped scalars out of `set`, but for the runs that it says to keep; one sentence for each.
pub(crate) fn take_out(set: &mut MeasurementSet) -> Vec<String> {
    SCALARS.iter().flat_map(|scalar| scalar.take_out(set)).collect()
}

impl Scalar {
    fn take_out(&self, set: &mut MeasurementSet) -> Vec<String> {
        let by_frames: Vec<Option<f64>> = set.runs.iter().map(self.seen).collect();
        let by_runs = self.by_condition(set);
        let expected = by_frames.iter().zip(&by_runs).map(|(frames, runs)| frames.or(*runs));
        let mistyped = self.mistyped(set, &expected.collect::<Vec<_>>());
        let mut notes = Vec::new();
        for at in mistyped {
            let run = &mut set.runs[at];
            let Some(value) = (self.take)(run) else { continue };
            let (key, unit, name) = (self.key, self.unit, &run.name);
            let shown = match (by_frames[at], by_runs[at]) {
                (Some(seen), _) => format!("where its frames show {seen:.4} {unit}"),
                (_, Some(usual)) => {
                    format!("where the runs of its condition have {usual:.4} {unit}")
                }
                _ => String::new(),
            };
            notes.push(format!(
                "the `{key}` of run {name} is {value:.4} {unit}, {shown}: it looks mistyped and is left out; \
                 `keep = [\"{name}\"]` keeps it"
            ));
        }
        notes
    }

    /// For each run, the median of the runs of its condition, three at least.
    fn by_condition(&self, set: &MeasurementSet) -> Vec<Option<f64>> {
        let median_of = |condition: usize| {
            let own = set.runs.iter().filter(|run| run.condition == condition);
            let own: Vec<f64> = own.filter_map(self.value).collect();
            (own.len() > 2).then(|| median(own)).flatten()
        };
        let medians: Vec<Option<f64>> = (0..set.conditions.len()).map(median_of).collect();
        set.runs.iter().map(|run| medians[run.condition]).collect()
    }

    /// The runs whose scalar is far from what is `expected`, by the ratio that is usual.
    fn mistyped(&self, set: &MeasurementSet, expected: &[Option<f64>]) -> Vec<usize> {
        let ratio = |(at, run): (usize, &Run)| {
            let value = (self.value)(run)?;
            let expected = expected[at].filter(|expected| *expected > 0.0)?;
            Some((at, libm::log((value / expected).max(f64::MIN_POSITIVE))))
        };
        let ratios: Vec<(usize, f64)> = set.runs.iter().enumerate().filter_map(ratio).collect();
        let Some(usual) = median(ratios.iter().map(|one| one.1)) else { return Vec::new() };
        let off = |one: &(usize, f64)| (one.1 - usual).abs();
        let scatter = deviation_of(ratios.iter().map(off));
        let limit = self.least.max(APART * scatter);
        let far = ratios.iter().filter(|one| off(one) > limit);
        let far: Vec<usize> = far.map(|one| one.0).collect();
        let is_told = ratios.len() >= FEWEST && far.len() as f64 <= SHARE * ratios.len() as f64;
        let is_kept = |at: &usize| set.keep.contains(&set.runs[*at].name);
        if is_told { far.into_iter().filter(|at| !is_kept(at)).collect() } else { Vec::new() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Bed, Condition, Geometry, Kind};

    /// Six bodies in three conditions that stop at `depth` after 40 ms; with frames, or without.
    fn set(with_frames: bool) -> MeasurementSet {
        let conditions = ["a", "b", "c"];
        let conditions =
            conditions.map(|id| Condition::straight_down(id, ("sphere", 0.02, 0.03), 2.0));
        let bed = Bed::new(Geometry::Spatial, None, 9.81);
        let mut set = MeasurementSet::new("test", Kind::Trajectory, bed, conditions.to_vec());
        for at in 0..9 {
            let depth = 0.03 + 0.01 * (at / 3) as f64 + 1e-3 * (at % 3) as f64;
            let mut run = Run::new(format!("r{at}"), at / 3);
            let frame = |k: i32| {
                let t = 1e-3 * f64::from(k);
                let left = (1.0 - t / 0.04).max(0.0);
                Frame { t, z: depth * (1.0 - left * left), x: 0.0, sigma: None }
            };
            run.frames = (0..60).map(frame).filter(|_| with_frames).collect();
            (run.final_z, run.stop_time) = (Some(0.98 * depth), Some(0.039));
            set.runs.push(run);
        }
        set
    }

    #[test]
    fn sound_scalars_are_left_as_they_are() {
        for with_frames in [true, false] {
            let mut sound = set(with_frames);
            assert_eq!(take_out(&mut sound), Vec::<String>::new());
            assert_eq!(sound, set(with_frames));
        }
    }

    #[test]
    fn a_mistyped_scalar_is_left_out_and_no_other() {
        for with_frames in [true, false] {
            for wrong in [0.0, 3.4e-3, 0.34] {
                let (sound, mut spoilt) = (set(with_frames), set(with_frames));
                spoilt.runs[4].final_z = Some(wrong);
                let notes = take_out(&mut spoilt);
                assert!(notes.len() == 1 && notes[0].contains("run r4"), "{wrong} {notes:?}");
                assert_eq!(spoilt.runs[4].final_z, None);
                spoilt.runs[4].final_z = sound.runs[4].final_z;
                assert_eq!(spoilt, sound);
                spoilt.runs[4].final_z = Some(wrong);
                spoilt.keep.push("r4".to_owned());
                assert_eq!(take_out(&mut spoilt), Vec::<String>::new());
            }
        }
    }

    #[test]
    fn a_path_that_ends_on_the_way_says_nothing_of_the_depth() {
        let mut cut = set(true);
        cut.runs[3].frames.truncate(12);
        assert_eq!(take_out(&mut cut), Vec::<String>::new());
    }
}
