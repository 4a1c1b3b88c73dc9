//! Readings that are not of the body: stray frames, and runs in which something else is followed.
//!
//! Nothing here knows a model. A frame is held against what the frames to its left, to its right and on both sides
//! promise for it; a run, against the middle of the runs of its condition.

use crate::{Frame, MeasurementSet, Run};

/// Fewest frames of a run in which strays are looked for: a few have no course.
const FEWEST_FRAMES: usize = 12;

/// A reading that misses every promise by more than so many times the usual miss is stray.
const FAR: f64 = 10.0;

/// Most of the frames of a run that may be stray; of more, the course is not known.
const SHARE: f64 = 0.1;

/// Fewest runs of a condition that have a middle.
const FEWEST_RUNS: usize = 3;

/// A run that is farther from the middle than so many times the usual distance, over the depth, is of something else.
const APART: f64 = 8.0;

/// From a standard deviation to the median of a size.
const MEDIAN: f64 = 0.6745;

/// What a set without its strays says, and what was left out of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Cleaned {
    /// The set without them.
    pub set: MeasurementSet,
    /// One sentence for each run, and for all frames of the set.
    pub notes: Vec<String>,
}

/// `set` without stray frames and without runs that look mistracked, but for the runs that it says to keep; `error` is
/// the error of one reading of a position (m).
#[must_use]
pub fn without_strays(set: &MeasurementSet, error: f64) -> Cleaned {
    let (mut notes, mut set) = (Vec::new(), set.clone());
    let (mut frames, mut of) = (0, 0);
    let mut jumps = vec![false; set.runs.len()];
    let keep = set.keep.clone();
    let is_kept = |run: &Run| keep.contains(&run.name);
    for (at, run) in set.runs.iter_mut().enumerate() {
        if is_kept(run) || run.frames.len() < FEWEST_FRAMES {
            continue;
        }
        let tracks = [track(&run.frames, |frame| frame.z), track(&run.frames, |frame| frame.x)];
        let found = tracks.map(|track| Found::of(&track, error));
        let stray: Vec<bool> =
            (0..run.frames.len()).map(|i| found.iter().any(|one| one.stray[i])).collect();
        let count = stray.iter().filter(|stray| **stray).count();
        if count as f64 <= SHARE * run.frames.len() as f64 {
            (frames, of) = (frames + count, of + usize::from(count > 0));
            let mut stray = stray.into_iter();
            run.frames.retain(|_| !stray.next().unwrap_or_default());
        }
        jumps[at] = [track(&run.frames, |frame| frame.z), track(&run.frames, |frame| frame.x)]
            .iter()
            .any(|track| jumps_in(track, error));
    }
    if frames > 0 {
        let (frames_are, runs) = match (frames, of) {
            (1, _) => ("1 stray frame is".to_owned(), "1 run".to_owned()),
            (_, 1) => (format!("{frames} stray frames are"), "1 run".to_owned()),
            _ => (format!("{frames} stray frames are"), format!("{of} runs")),
        };
        notes.push(format!(
            "{frames_are} left out, of {runs}: `keep = [\"run\"]` keeps those of a run"
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
    Cleaned { set, notes }
}

/// Times and one coordinate.
fn track(frames: &[Frame], of: fn(&Frame) -> f64) -> Vec<[f64; 2]> {
    frames.iter().map(|frame| [frame.t, of(frame)]).collect()
}

/// The stray frames of one coordinate.
struct Found {
    stray: Vec<bool>,
}

impl Found {
    fn of(track: &[[f64; 2]], error: f64) -> Self {
        let misses: Vec<f64> = (0..track.len()).map(|at| least_miss(track, at)).collect();
        let limit = FAR * usual(&misses).max(error);
        Self { stray: misses.iter().map(|miss| *miss > limit).collect() }
    }
}

/// The standard deviation of which `sizes` are, by their median.
fn usual(sizes: &[f64]) -> f64 {
    let mut sorted: Vec<f64> = sizes.iter().copied().filter(|size| size.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(0.0) / MEDIAN
}

/// By how much the reading `at` misses the best of what its neighbours promise: parabolas through three on either
/// side, and a line between the two beside it.
fn least_miss(track: &[[f64; 2]], at: usize) -> f64 {
    let miss = |promised: f64| (track[at][1] - promised).abs();
    let from = |places: &[usize]| parabola(track, places, track[at][0]).map(miss);
    let left = at.checked_sub(3).and_then(|first| from(&[first, first + 1, first + 2]));
    let right = (at + 3 < track.len()).then(|| from(&[at + 1, at + 2, at + 3])).flatten();
    let middle = (at > 0 && at + 1 < track.len()).then(|| from(&[at - 1, at + 1])).flatten();
    [left, right, middle].into_iter().flatten().fold(f64::INFINITY, f64::min)
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

/// Whether the course goes on elsewhere from one frame to the next: each side misses what the other promises, and
/// keeps to its own.
fn jumps_in(track: &[[f64; 2]], error: f64) -> bool {
    let n = track.len();
    if n < FEWEST_FRAMES {
        return false;
    }
    let miss = |places: [usize; 3], at: usize| {
        parabola(track, &places, track[at][0])
            .map_or(0.0, |promised| (track[at][1] - promised).abs())
    };
    let forward: Vec<f64> = (3..n).map(|at| miss([at - 3, at - 2, at - 1], at)).collect();
    let backward: Vec<f64> = (0..n - 3).map(|at| miss([at + 1, at + 2, at + 3], at)).collect();
    // A parabola through three readings misses the next by √20 of their error.
    let limit = FAR * usual(&forward).max(error * 20.0_f64.sqrt());
    (3..n - 3).any(|at| forward[at - 3] > limit && backward[at - 1] > limit)
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
    let limit = APART * usual(&sizes);
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
    if late == t {
        return Some(z);
    }
    let [early, before] = *track.get(after.checked_sub(1)?)?;
    Some(before + (z - before) * (t - early) / (late - early))
}
