//! Readings that are not of the body: stray frames, and runs in which the tracker follows something else.
//!
//! No model is used. A frame is compared with what the frames before it, after it and on both sides predict; a run, with
//! the median of the runs of its condition.

use crate::contact::stray_scalars;
use crate::median::{deviation_of, median};
use crate::{Frame, MeasurementSet, Run};

/// Fewest frames of a run that is searched for strays.
const FEWEST_FRAMES: usize = 12;

/// A reading is stray if it differs from every prediction by more than this many standard deviations.
const FAR: f64 = 10.0;

/// Largest share of stray frames in a run; with more, the path is not known and all frames are kept.
const SHARE: f64 = 0.2;

/// Readings on either side that say where one should be.
const REACH: usize = 6;

/// Readings at either end that are held against those on one side.
const ENDS: usize = 2;

/// Most passes over the readings.
const PASSES: usize = 5;

/// Longest gap, in median steps, across which an end is compared with the readings beside it.
const GAP: f64 = 2.5;

/// Readings this many standard deviations from a parabola are close to it.
const CLOSE: f64 = 4.0;

/// Fewest runs of a condition that have a median.
const FEWEST_RUNS: usize = 3;

/// A run is mistracked if its distance from the median, relative to the depth, exceeds the usual one by this factor.
const APART: f64 = 8.0;

/// What a set without its strays says, and what was left out of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Cleaned {
    /// The set without them.
    pub set: MeasurementSet,
    /// One sentence for each run, and for all frames of the set.
    pub notes: Vec<String>,
}

/// `set` without stray frames, runs that look mistracked and scalars that look mistyped, but for the runs that it says to keep; `error` is
/// the error of one reading of a position (m).
pub fn without_strays(set: &MeasurementSet, error: f64) -> Cleaned {
    let (mut notes, mut set) = (Vec::new(), set.clone());
    let (mut frames, mut of, mut first) = (0, 0, None);
    let mut jumps = vec![false; set.runs.len()];
    let keep = set.keep.clone();
    let is_kept = |run: &Run| keep.contains(&run.name);
    for (at, run) in set.runs.iter_mut().enumerate() {
        if is_kept(run) || run.frames.len() < FEWEST_FRAMES {
            continue;
        }
        let stray = stray_frames(&run.frames, error);
        let count = stray.iter().filter(|stray| **stray).count();
        if count > 0 {
            (frames, of) = (frames + count, of + 1);
            first = first.or_else(|| {
                let at = stray.iter().position(|stray| *stray)?;
                Some((run.name.clone(), run.frames[at].t))
            });
            let mut stray = stray.into_iter();
            run.frames.retain(|_| !stray.next().unwrap_or_default());
        }
        jumps[at] = [track(&run.frames, |frame| frame.z), track(&run.frames, |frame| frame.x)]
            .iter()
            .any(|track| jumps_in(track, error));
    }
    if let Some((name, time)) = first {
        let (frames_are, runs) = match (frames, of) {
            (1, _) => ("1 stray frame is".to_owned(), "1 run".to_owned()),
            (_, 1) => (format!("{frames} stray frames are"), "1 run".to_owned()),
            _ => (format!("{frames} stray frames are"), format!("{of} runs")),
        };
        notes.push(format!(
            "{frames_are} left out, of {runs}, the first in {name} at {time:.4} s: `keep = [\"{name}\"]` keeps those \
             of that run"
        ));
    }
    let apart = apart(&set, error);
    let mut left_out = Vec::new();
    for condition in 0..set.conditions.len() {
        let runs: Vec<usize> =
            (0..set.runs.len()).filter(|&run| set.runs[run].condition == condition).collect();
        let mistracked: Vec<usize> =
            runs.iter().copied().filter(|&run| jumps[run] || apart.contains(&run)).collect();
        // Where half of the runs look so, nobody knows which half is right.
        if 2 * mistracked.len() < runs.len() {
            left_out.extend(mistracked);
        }
    }
    left_out.retain(|&run| !is_kept(&set.runs[run]));
    for &run in &left_out {
        let name = &set.runs[run].name;
        let why = if jumps[run] { "its course jumps" } else { "it is far from its repeats" };
        notes.push(format!(
            "run {name} looks mistracked ({why}) and is left out: `keep = [\"{name}\"]` keeps it"
        ));
    }
    let mut at = 0..;
    set.runs.retain(|_| at.next().is_none_or(|at| !left_out.contains(&at)));
    notes.extend(stray_scalars::take_out(&mut set));
    Cleaned { set, notes }
}

/// Which of `frames` are stray, `error` being that of one reading of a position. None is in a path of few frames, nor where
/// so many look so that the path is not known.
pub fn stray_frames(frames: &[Frame], error: f64) -> Vec<bool> {
    let none = vec![false; frames.len()];
    if frames.len() < FEWEST_FRAMES {
        return none;
    }
    let tracks = [track(frames, |frame| frame.z), track(frames, |frame| frame.x)];
    let [down, along] = tracks.map(|track| stray_readings(&track, error));
    let stray: Vec<bool> = down.iter().zip(&along).map(|(down, along)| *down || *along).collect();
    let count = stray.iter().filter(|stray| **stray).count();
    if count as f64 <= SHARE * frames.len() as f64 { stray } else { none }
}

/// `frames` without those that are stray, likewise.
pub(crate) fn but_strays(frames: &[Frame], error: f64) -> Vec<Frame> {
    let stray = stray_frames(frames, error);
    frames.iter().zip(stray).filter(|(_, stray)| !stray).map(|(frame, _)| *frame).collect()
}

/// Times and one coordinate.
fn track(frames: &[Frame], of: fn(&Frame) -> f64) -> Vec<[f64; 2]> {
    frames.iter().map(|frame| [frame.t, of(frame)]).collect()
}

/// Which readings of one coordinate are stray. Where some are, the others are looked at again without them.
fn stray_readings(track: &[[f64; 2]], error: f64) -> Vec<bool> {
    let mut kept: Vec<usize> = (0..track.len()).collect();
    for pass in 0..PASSES {
        let there: Vec<[f64; 2]> = kept.iter().map(|&at| track[at]).collect();
        let stray = seen_at_once(&there, error, pass == 0);
        let before = kept.len();
        let mut stray = stray.into_iter();
        kept.retain(|_| !stray.next().unwrap_or_default());
        if kept.len() == before {
            break;
        }
    }
    let mut stray = vec![true; track.len()];
    kept.into_iter().for_each(|at| stray[at] = false);
    stray
}

/// Those that are far from what the readings around them say; `with_ends`, those at the ends too.
///
/// A stray reading spoils what its neighbours promise, so those around a suspect are held against the parabola that most of
/// the readings on either side share.
fn seen_at_once(track: &[[f64; 2]], error: f64, with_ends: bool) -> Vec<bool> {
    let n = track.len();
    let misses: Vec<f64> = (0..n).map(|at| least_miss(track, at)).collect();
    let noise = deviation_of(misses.iter().copied()).max(error);
    let mut suspects = vec![false; n];
    for at in (0..n).filter(|&at| misses[at] > 0.5 * FAR * noise) {
        suspects[around(at, n)].fill(true);
    }
    let gap = GAP * median(track.windows(2).map(|pair| pair[1][0] - pair[0][0])).unwrap_or(0.0);
    let is_stray = |(at, is_suspect): (usize, bool)| {
        let is_end = with_ends && n > REACH + ENDS && (at < ENDS || at + ENDS >= n);
        let is_end = is_end && {
            let beside = if at < ENDS { at + 1 } else { at - 1 };
            (track[beside][0] - track[at][0]).abs() <= gap
        };
        is_suspect && is_apart(track, (at, misses[at]), noise)
            || is_end && is_off_the_end(track, at, noise)
    };
    suspects.into_iter().enumerate().map(is_stray).collect()
}

/// Whether a reading at an end is far from what all readings on its other side say, and no braked body: one that is braked
/// lies between where it was and where it would have been.
fn is_off_the_end(track: &[[f64; 2]], at: usize, noise: f64) -> bool {
    let (places, beside) = match at < ENDS {
        true => (at + 1..at + 1 + REACH, at + 1),
        false => (at - REACH..at, at - 1),
    };
    let said = Consensus::of(&track[places], [track[at][0]; 3], CLOSE * noise);
    said.filter(|said| said.near == REACH).is_some_and(|said| {
        let ends = [said.promised, track[beside][1]];
        let [low, high] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        let z = track[at][1];
        (z - said.promised).abs() > FAR * noise && !(low..=high).contains(&z)
    })
}

/// The readings that tell of the one `at`, itself included.
fn around(at: usize, n: usize) -> std::ops::Range<usize> {
    at.saturating_sub(REACH)..(at + REACH + 1).min(n)
}

/// Whether the reading `at`, which misses what three neighbours promise by `miss` at least, is far from what both sides of it
/// say. Where both describe one course, that is enough; where a blow is between them, a body on its way is no stray reading.
fn is_apart(track: &[[f64; 2]], (at, miss): (usize, f64), noise: f64) -> bool {
    let there = around(at, track.len());
    let times = [at, at.saturating_sub(1), (at + 1).min(track.len() - 1)].map(|at| track[at][0]);
    let [left, right] = [there.start..at, at + 1..there.end]
        .map(|places| Consensus::of(&track[places], times, CLOSE * noise));
    let is_far = |one: &Consensus| (track[at][1] - one.promised).abs() > FAR * noise;
    match (left, right) {
        (None, None) => false,
        (Some(left), Some(right)) if left.is_one_with(&right, noise) => is_far(&left),
        (left, right) => {
            let are_far = left.iter().chain(&right).all(is_far);
            are_far && miss > FAR * noise && !is_on_the_way(track, at)
        }
    }
}

/// What most of a few readings say of another.
struct Consensus {
    promised: f64,
    /// The parabola at the times of the two readings beside that one.
    beside: [f64; 2],
    /// How many say so.
    near: usize,
    /// Whether that is all but one of them, or all.
    is_broad: bool,
}

impl Consensus {
    /// The parabola through three of `readings` that most of them are close to (Fischler & Bolles, Commun. ACM 24, 381
    /// (1981), with every triple), evaluated at `times`: of that other and of the two beside it; `None` where no more
    /// than half of them are.
    fn of(readings: &[[f64; 2]], times: [f64; 3], close: f64) -> Option<Self> {
        let n = readings.len();
        if n <= 3 {
            return None;
        }
        let triples = (0..n).flat_map(|a| (a + 1..n).map(move |b| (a, b)));
        let triples = triples.flat_map(|(a, b)| (b + 1..n).map(move |c| [a, b, c]));
        let judged = triples.filter_map(|three| {
            let off = |one: &[f64; 2]| Some((one[1] - parabola(readings, &three, one[0])?).abs());
            let off: Vec<f64> = readings.iter().map(off).collect::<Option<_>>()?;
            let near = off.iter().filter(|off| **off <= close).count();
            Some((near, off.iter().map(|off| off.min(close)).sum::<f64>(), three))
        });
        let (near, _, three) =
            judged.max_by(|a, b| a.0.cmp(&b.0).then_with(|| b.1.total_cmp(&a.1)))?;
        let [promised, before, after] = times.map(|t| parabola(readings, &three, t));
        let (promised, beside) = (promised?, [before?, after?]);
        let is_broad = near + 1 >= n && n + 1 >= REACH;
        (near > 3 && 2 * near > n).then_some(Self { promised, beside, near, is_broad })
    }

    /// Whether both describe one course. The fall and the rest of a body that stops hard cross in one point, so the
    /// readings beside it are compared too.
    fn is_one_with(&self, other: &Self, noise: f64) -> bool {
        let beside = self.beside.iter().zip(&other.beside);
        self.is_broad
            && other.is_broad
            && (self.promised - other.promised).abs() <= CLOSE * noise
            && beside.map(|(own, other)| (own - other).abs()).all(|apart| apart <= FAR * noise)
    }
}

/// Whether the reading `at` lies between those beside it: a body that is stopped within a frame or two looks so.
fn is_on_the_way(track: &[[f64; 2]], at: usize) -> bool {
    let (Some([_, before]), Some([_, after])) =
        (at.checked_sub(1).and_then(|before| track.get(before)), track.get(at + 1))
    else {
        return false;
    };
    (before.min(*after)..=before.max(*after)).contains(&track[at][1])
}

/// By how much the reading `at` misses the best of what its neighbours promise: parabolas through three on either
/// side, and a line between the two beside it.
fn least_miss(track: &[[f64; 2]], at: usize) -> f64 {
    let miss = |promised: f64| (track[at][1] - promised).abs();
    let from = |places: &[usize]| parabola(track, places, track[at][0]).map(miss);
    let left = at.checked_sub(3).and_then(|first| from(&[first, first + 1, first + 2]));
    let right = (at + 3 < track.len()).then(|| from(&[at + 1, at + 2, at + 3])).flatten();
    let middle = (at > 0 && at + 1 < track.len()).then(|| from(&[at - 1, at + 1])).flatten();
    let least = [left, right, middle].into_iter().flatten().fold(f64::INFINITY, f64::min);
    // The first and the last have a parabola alone, whose error is √20 of that of a reading.
    if middle.is_some() { least } else { least / 20.0_f64.sqrt() }
}

/// The polynomial through `places` at time `t` (Lagrange); none where two have one time.
fn parabola(track: &[[f64; 2]], places: &[usize], t: f64) -> Option<f64> {
    let sum: f64 = places
        .iter()
        .map(|&i| {
            let others = places.iter().filter(|&&j| j != i);
            let factor = others.map(|&j| (t - track[j][0]) / (track[i][0] - track[j][0]));
            track[i][1] * factor.product::<f64>()
        })
        .sum();
    sum.is_finite().then_some(sum)
}

/// Whether the course goes on elsewhere from one frame to the next: each side misses what the other promises, and by as
/// much one frame farther on, where a blow would miss by four times as much.
fn jumps_in(track: &[[f64; 2]], error: f64) -> bool {
    let n = track.len();
    if n < FEWEST_FRAMES {
        return false;
    }
    let miss = |places: [usize; 3], at: usize| {
        parabola(track, &places, track[at][0]).map_or(0.0, |promised| track[at][1] - promised)
    };
    let forward = |at: usize, to: usize| miss([at - 3, at - 2, at - 1], to);
    let backward = |at: usize, to: usize| miss([at + 1, at + 2, at + 3], to);
    let sizes: Vec<f64> = (3..n).map(|at| forward(at, at).abs()).collect();
    // A parabola through three readings misses the next by √20 of their error.
    let limit = FAR * deviation_of(sizes.iter().copied()).max(error * 20.0_f64.sqrt());
    let is_offset =
        |near: f64, far: f64| near.abs() > limit && (far - near).abs() < 0.5 * near.abs();
    (3..n - 4).any(|at| {
        is_offset(forward(at, at), forward(at, at + 1))
            && is_offset(backward(at - 1, at - 1), backward(at - 1, at - 2))
    })
}

/// The runs that are far from the middle of their condition.
fn apart(set: &MeasurementSet, error: f64) -> Vec<usize> {
    let mut distances = Vec::new();
    for condition in 0..set.conditions.len() {
        let runs: Vec<usize> = (0..set.runs.len())
            .filter(|&run| {
                set.runs[run].condition == condition && set.runs[run].frames.len() >= FEWEST_FRAMES
            })
            .collect();
        if runs.len() < FEWEST_RUNS {
            continue;
        }
        distances.extend(from_the_middle(set, &runs, error));
    }
    let sizes: Vec<f64> = distances.iter().map(|(_, size)| *size).collect();
    let limit = APART * deviation_of(sizes.iter().copied());
    distances.into_iter().filter(|(_, size)| *size > limit).map(|(run, _)| run).collect()
}

/// Root mean square distance of each of `runs` from their middle, over the depth that the middle reaches.
fn from_the_middle(set: &MeasurementSet, runs: &[usize], error: f64) -> Vec<(usize, f64)> {
    let tracks: Vec<Vec<[f64; 2]>> =
        runs.iter().map(|&run| track(&set.runs[run].frames, |frame| frame.z)).collect();
    let shortest = tracks.iter().min_by_key(|track| track.len());
    let times: Vec<f64> = shortest.map_or(Vec::new(), |one| one.iter().map(|[t, _]| *t).collect());
    let mut squares = vec![0.0; runs.len()];
    let (mut deepest, mut n) = (error, 0.0_f64);
    for t in times {
        let Some(depths) = tracks.iter().map(|one| between(one, t)).collect::<Option<Vec<f64>>>()
        else {
            continue;
        };
        let mut sorted = depths.clone();
        sorted.sort_by(f64::total_cmp);
        let middle = 0.5 * (sorted[(sorted.len() - 1) / 2] + sorted[sorted.len() / 2]);
        deepest = deepest.max(middle);
        n += 1.0;
        for (square, depth) in squares.iter_mut().zip(&depths) {
            *square += (depth - middle).powi(2);
        }
    }
    let size = |square: &f64| (square / n.max(1.0)).sqrt() / deepest;
    runs.iter().copied().zip(squares.iter().map(size)).collect()
}

/// The coordinate at time `t`, on a line between two readings; none outside of them.
fn between(track: &[[f64; 2]], t: f64) -> Option<f64> {
    let after = track.partition_point(|[time, _]| *time < t);
    let [late, z] = *track.get(after)?;
    if late <= t {
        return Some(z);
    }
    let [early, before] = *track.get(after.checked_sub(1)?)?;
    Some(before + (z - before) * (t - early) / (late - early))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Bed, Condition, Geometry, Kind, StopDefinition};

    const ERROR: f64 = 1e-4;

    /// 2 m/s, stopped within 40 ms by a constant deceleration; readings off by up to 0.1 mm.
    fn run(name: &str, factor: f64) -> Run {
        let frame = |k: i32| {
            let t = 1e-3 * f64::from(k);
            let inside = t.clamp(0.0, 0.04);
            let z = 2.0 * t.min(0.04) - if t > 0.0 { 25.0 * inside * inside } else { 0.0 };
            let off = 1e-4 * f64::from((7 * k).rem_euclid(5) - 2) / 2.0;
            Frame { t, z: factor * z + off, x: 0.0, sigma: None }
        };
        Run { frames: (-15..60).map(frame).collect(), ..Run::new(name.into(), 0) }
    }

    fn set(runs: Vec<Run>) -> MeasurementSet {
        MeasurementSet {
            stop: StopDefinition::SpeedFivePercent,
            runs,
            ..MeasurementSet::new(
                "test",
                Kind::Trajectory,
                Bed::new(Geometry::Spatial, None, 9.81),
                vec![Condition::straight_down("2 m/s", ("sphere", 0.02, 0.03), 2.0)],
            )
        }
    }

    fn repeats() -> Vec<Run> {
        [0.97, 0.99, 1.0, 1.01, 1.03]
            .iter()
            .enumerate()
            .map(|(at, factor)| run(&format!("r{at}"), *factor))
            .collect()
    }

    #[test]
    fn sound_runs_are_left_as_they_are() {
        let whole = set(repeats());
        assert_eq!(without_strays(&whole, ERROR), Cleaned { set: whole, notes: Vec::new() });
    }

    #[test]
    fn stray_frames_are_left_out_and_no_other() {
        let mut runs = repeats();
        for (at, off) in [(20, 5e-3), (21, -9e-3), (50, 4e-3)] {
            runs[1].frames[at].z += off;
        }
        let cleaned = without_strays(&set(runs), ERROR);
        let left: Vec<f64> = cleaned.set.runs[1].frames.iter().map(|frame| frame.t).collect();
        let sound = run("r1", 0.99).frames;
        let others = sound.iter().enumerate().filter(|(at, _)| ![20, 21, 50].contains(at));
        assert_eq!(left, others.map(|(_, frame)| frame.t).collect::<Vec<_>>());
        assert!(cleaned.notes[0].starts_with("3 stray frames are left out, of 1 run"));
    }

    #[test]
    fn one_reading_in_fifteen_may_be_stray() {
        let mut spoilt = run("r0", 1.0).frames;
        // Some beside each other, some two or three apart, some around contact.
        let off = [(3, 7e-3), (14, -6e-3), (16, 5e-3), (17, 8e-3), (40, 4e-3), (43, 4.2e-3)];
        off.iter().for_each(|&(at, by)| spoilt[at].z += by);
        let stray = stray_frames(&spoilt, ERROR);
        let found: Vec<usize> = (0..stray.len()).filter(|&at| stray[at]).collect();
        assert_eq!(found, off.map(|(at, _)| at));
    }

    #[test]
    fn a_run_that_jumps_or_is_far_from_its_repeats_is_named_unless_it_is_kept() {
        for (name, spoil) in [
            (
                "jumps",
                (|run| run.frames[40..].iter_mut().for_each(|f| f.z += 8e-3)) as fn(&mut Run),
            ),
            ("far", |run| run.frames.iter_mut().for_each(|f| f.z *= 1.6)),
        ] {
            let mut runs = repeats();
            spoil(&mut runs[3]);
            let mut spoilt = set(runs);
            let cleaned = without_strays(&spoilt, ERROR);
            let left: Vec<&str> = cleaned.set.runs.iter().map(|run| run.name.as_str()).collect();
            assert_eq!(left, ["r0", "r1", "r2", "r4"], "{name}");
            assert!(cleaned.notes[0].starts_with("run r3 looks mistracked"), "{:?}", cleaned.notes);
            spoilt.keep = vec!["r3".into()];
            assert_eq!(without_strays(&spoilt, ERROR).set.runs.len(), 5, "{name}");
        }
    }

    #[test]
    fn a_hard_blow_in_a_slow_clip_is_no_jump() {
        // 3 m/s, stopped within one and a half of the frames of a clip of 120 Hz.
        let frame = |k: i32| {
            let t = f64::from(k) / 120.0;
            let inside = t.clamp(0.0, 0.0125);
            let z = 3.0 * t.min(0.0125) - if t > 0.0 { 120.0 * inside * inside } else { 0.0 };
            Frame { t, z, x: 0.0, sigma: None }
        };
        let mut runs = repeats();
        for run in &mut runs[..2] {
            run.frames = (-10..30).map(frame).collect();
        }
        let cleaned = without_strays(&set(runs[..2].to_vec()), ERROR);
        assert_eq!(cleaned.notes, Vec::<String>::new());
    }

    #[test]
    fn a_body_that_brakes_within_a_few_frames_loses_none() {
        for (phase, braking) in
            (0..10).flat_map(|phase| [1.5, 2.0, 2.5, 3.0, 4.0, 5.0].map(|b| (phase, b)))
        {
            let tau = braking / 240.0;
            let frame = |k: i32| {
                let t = (f64::from(k) + 0.1 * f64::from(phase)) / 240.0;
                let inside = t.clamp(0.0, tau);
                let z = 3.0 * t.min(tau) - if t > 0.0 { 1.5 * inside * inside / tau } else { 0.0 };
                let off = 2e-4 * f64::from((7 * k).rem_euclid(5) - 2) / 2.0;
                Frame { t, z: z + off, x: 0.0, sigma: None }
            };
            let frames: Vec<Frame> = (-20..30).map(frame).collect();
            let stray = stray_frames(&frames, 2e-4);
            assert!(!stray.contains(&true), "{phase}, {braking}");
        }
    }

    #[test]
    fn where_half_of_the_runs_jump_none_is_left_out() {
        let mut runs = repeats();
        runs.truncate(2);
        runs[0].frames[40..].iter_mut().for_each(|frame| frame.z += 8e-3);
        assert_eq!(without_strays(&set(runs), ERROR).set.runs.len(), 2);
    }
}
