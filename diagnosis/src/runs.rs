//! How far two runs lie apart: along their paths, and at their stops.
//!
//! Differences are second less first. Paths are compared over the time that both cover, on the grid
//! of the one with fewer samples there: the other is interpolated linearly, which costs an eighth of
//! its acceleration times the square of its interval.

mod stop;

use serde::Serialize;
use thiserror::Error;

pub use stop::{Change, StopDifference};

/// The path of a body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Track {
    /// Its points, in the order of time.
    pub points: Vec<TrackPoint>,
}

/// A body at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrackPoint {
    /// Time since the start of the run (s).
    pub time: f64,
    /// What is compared at that time.
    pub values: Values,
}

/// One number of each kind that is compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Values {
    /// Depth of the lowest point, or a difference of depths (m).
    #[serde(rename = "z_m")]
    pub z: f64,
    /// Horizontal distance from the start along the motion, or a difference of them (m).
    #[serde(rename = "x_m")]
    pub x: f64,
    /// Magnitude of the velocity, or a difference of magnitudes (m/s).
    #[serde(rename = "speed_m_per_s")]
    pub speed: f64,
}

/// How far paths lie apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathDifference {
    /// The time that both runs cover.
    pub common: CommonTime,
    /// Root of the mean square over that time, and over the bodies if there are several.
    pub rms: Values,
    /// The differences that are largest in magnitude, with their signs.
    pub largest: Largest,
}

/// The time over which two runs are compared.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CommonTime {
    /// When the later of them starts (s).
    #[serde(rename = "from_s")]
    pub from: f64,
    /// When the earlier of them ends (s).
    #[serde(rename = "to_s")]
    pub to: f64,
    /// Times at which each body is compared.
    pub samples: usize,
}

/// The largest differences.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Largest {
    /// Each of them.
    #[serde(flatten)]
    pub values: Values,
    /// When each of them is reached first.
    pub at_s: LargestAt,
}

/// When the largest differences are reached.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct LargestAt {
    /// That of the depth (s).
    #[serde(rename = "z_m")]
    pub z: f64,
    /// That of the horizontal distance (s).
    #[serde(rename = "x_m")]
    pub x: f64,
    /// That of the speed (s).
    #[serde(rename = "speed_m_per_s")]
    pub speed: f64,
}

/// Why two runs cannot be compared.
#[derive(Clone, Debug, Error, PartialEq)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum RunsError {
    #[error("the first run has {} and the second {}", bodies(counts[0]), bodies(counts[1]))]
    Bodies { counts: [usize; 2] },
    #[error("the {} run has fewer than two samples of a body", ORDINALS[*run])]
    TooShort { run: usize },
    #[error("the samples of the {} run are not in the order of time", ORDINALS[*run])]
    Disorder { run: usize },
    #[error("the runs have no time in common: {} s to {} s, and {} s to {} s", spans[0][0], spans[0][1], spans[1][0], spans[1][1])]
    NoCommonTime { spans: [[f64; 2]; 2] },
}

const ORDINALS: [&str; 2] = ["first", "second"];

fn bodies(count: usize) -> String {
    if count == 1 { "1 body".to_owned() } else { format!("{count} bodies") }
}

impl PathDifference {
    /// How far each body of the second run is from that of the first with the same number.
    ///
    /// # Errors
    /// If there are not as many bodies in both runs, or no time that both cover.
    pub fn between(first: &[Track], second: &[Track]) -> Result<Self, RunsError> {
        let spans = [span(first, 0)?, span(second, 1)?];
        if first.len() != second.len() {
            return Err(RunsError::Bodies { counts: [first.len(), second.len()] });
        }
        let [from, to] = [spans[0][0].max(spans[1][0]), spans[0][1].min(spans[1][1])];
        if from >= to {
            return Err(RunsError::NoCommonTime { spans });
        }
        let grid = grid(&first[0], &second[0], [from, to]);
        let mut squares = Values::default();
        let mut largest = Largest::default();
        for (first, second) in first.iter().zip(second) {
            let (mut first, mut second) = (Cursor::of(first), Cursor::of(second));
            let mut before: Option<(f64, Values)> = None;
            for &time in &grid {
                let apart = second.at(time).minus(first.at(time));
                largest.see(time, apart);
                if let Some((earlier, then)) = before {
                    squares.add_segment(time - earlier, [then, apart]);
                }
                before = Some((time, apart));
            }
        }
        let mean = |square: f64| (square / (first.len() as f64 * (to - from))).sqrt();
        let rms = Values { z: mean(squares.z), x: mean(squares.x), speed: mean(squares.speed) };
        Ok(Self { common: CommonTime { from, to, samples: grid.len() }, rms, largest })
    }
}

/// Start and end of the time that all bodies of a run cover.
fn span(tracks: &[Track], run: usize) -> Result<[f64; 2], RunsError> {
    let mut span = [f64::NEG_INFINITY, f64::INFINITY];
    for Track { points } in tracks {
        let ([start, .., end], true) = (points.as_slice(), points.len() > 1) else {
            return Err(RunsError::TooShort { run });
        };
        if !points.is_sorted_by(|a, b| a.time <= b.time) {
            return Err(RunsError::Disorder { run });
        }
        span = [span[0].max(start.time), span[1].min(end.time)];
    }
    match tracks.is_empty() {
        true => Err(RunsError::TooShort { run }),
        false => Ok(span),
    }
}

/// The times of the track with fewer samples in the common time, with the ends of it.
fn grid(first: &Track, second: &Track, [from, to]: [f64; 2]) -> Vec<f64> {
    let inside = |track: &Track| -> Vec<f64> {
        let times = track.points.iter().map(|point| point.time);
        times.filter(|time| *time > from && *time < to).collect()
    };
    let (first, second) = (inside(first), inside(second));
    let mut grid = vec![from];
    grid.extend(if second.len() < first.len() { second } else { first });
    grid.push(to);
    grid
}

/// A track that is read at times that do not decrease.
struct Cursor<'a> {
    points: &'a [TrackPoint],
}

impl<'a> Cursor<'a> {
    fn of(track: &'a Track) -> Self {
        Self { points: &track.points }
    }

    /// The values at `time` (s), on the line between the samples around it.
    fn at(&mut self, time: f64) -> Values {
        while let [_, next, _, ..] = self.points
            && next.time <= time
        {
            self.points = &self.points[1..];
        }
        let [before, after] = [self.points[0], self.points[1]];
        let interval = after.time - before.time;
        let share = if interval > 0.0 { (time - before.time) / interval } else { 1.0 };
        // A sample itself, to the bit: of equal runs nothing may be left.
        match share {
            0.0 => before.values,
            1.0 => after.values,
            share => before.values.toward(after.values, share),
        }
    }
}

impl Values {
    fn minus(self, other: Self) -> Self {
        Self { z: self.z - other.z, x: self.x - other.x, speed: self.speed - other.speed }
    }

    fn toward(self, other: Self, share: f64) -> Self {
        let Self { z, x, speed } = other.minus(self);
        Self { z: self.z + share * z, x: self.x + share * x, speed: self.speed + share * speed }
    }

    /// Adds the integral over `time` (s) of the squares of values that go linearly between two.
    fn add_segment(&mut self, time: f64, [from, to]: [Self; 2]) {
        let integral = |from: f64, to: f64| time * (from * from + from * to + to * to) / 3.0;
        self.z += integral(from.z, to.z);
        self.x += integral(from.x, to.x);
        self.speed += integral(from.speed, to.speed);
    }
}

impl Largest {
    fn see(&mut self, time: f64, apart: Values) {
        let see = |value: &mut f64, at: &mut f64, now: f64| {
            if now.abs() > value.abs() {
                (*value, *at) = (now, time);
            }
        };
        see(&mut self.values.z, &mut self.at_s.z, apart.z);
        see(&mut self.values.x, &mut self.at_s.x, apart.x);
        see(&mut self.values.speed, &mut self.at_s.speed, apart.speed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A track with the values of `path` at `n` + 1 equal intervals of [0, `end`].
    fn track(end: f64, n: u32, path: impl Fn(f64) -> Values) -> Track {
        let time = |i: u32| end * f64::from(i) / f64::from(n);
        let points = (0..=n).map(|i| TrackPoint { time: time(i), values: path(time(i)) });
        Track { points: points.collect() }
    }

    fn fall(time: f64) -> Values {
        Values { z: 2.0 * time - 5.0 * time * time, x: 0.3 * time, speed: 2.0 - 10.0 * time }
    }

    #[test]
    fn a_run_is_at_no_distance_from_itself() {
        let run = [track(0.2, 77, fall), track(0.2, 77, |t| Values { z: 1.0 - t, ..fall(t) })];
        let apart = PathDifference::between(&run, &run).expect("runs");
        assert_eq!((apart.rms, apart.largest), (Values::default(), Largest::default()));
        assert_eq!(apart.common, CommonTime { from: 0.0, to: 0.2, samples: 78 });
    }

    #[test]
    fn a_linear_difference_gives_its_root_mean_square_and_its_end() {
        let other = |t: f64| Values { z: fall(t).z + 0.6 * t, x: fall(t).x - 0.01, ..fall(t) };
        let (first, second) = ([track(0.2, 100, fall)], [track(0.3, 150, other)]);
        let apart = PathDifference::between(&first, &second).expect("runs");
        // Round-off of values of 1; the mean square of a ramp is a third of that at its end.
        let tolerance = 1e-15;
        assert!((apart.rms.z - 0.12 / 3.0_f64.sqrt()).abs() < tolerance, "{apart:?}");
        assert!((apart.rms.x - 0.01).abs() < tolerance && apart.rms.speed < tolerance);
        let largest = apart.largest;
        assert!(
            (largest.values.z - 0.12).abs() < tolerance && (largest.at_s.z - 0.2).abs() < 1e-15
        );
        assert!((largest.values.x + 0.01).abs() < tolerance, "{largest:?}");
    }

    #[test]
    fn runs_on_different_grids_differ_by_what_interpolation_costs() {
        let (fine, coarse) = ([track(0.2, 2003, fall)], [track(0.17, 19, fall)]);
        for (first, second) in [(&fine, &coarse), (&coarse, &fine)] {
            let apart = PathDifference::between(first, second).expect("runs");
            assert_eq!(apart.common.samples, 20);
            // An eighth of 10 m/s² and the square of the finer interval.
            let bound = 10.0 / 8.0 * (0.2 / 2003.0_f64).powi(2);
            assert!(apart.largest.values.z.abs() < 1.001 * bound, "{apart:?}");
            assert!(apart.largest.values.speed.abs() < 1e-14, "a line is met to round-off");
        }
    }

    #[test]
    fn several_bodies_count_alike() {
        let shifted = |by: f64| track(0.1, 10, move |t| Values { z: fall(t).z + by, ..fall(t) });
        let (first, second) = ([shifted(0.0), shifted(0.0)], [shifted(0.0), shifted(-0.02)]);
        let apart = PathDifference::between(&first, &second).expect("runs");
        // Round-off of values of 1.
        assert!((apart.rms.z - 0.02 / 2.0_f64.sqrt()).abs() < 1e-15, "{apart:?}");
        assert!((apart.largest.values.z + 0.02).abs() < 1e-15, "{apart:?}");
    }

    #[test]
    fn what_has_nothing_in_common_is_refused() {
        let (run, empty) = ([track(0.2, 20, fall)], [Track::default()]);
        let between = |first: &[Track], second: &[Track]| {
            PathDifference::between(first, second).expect_err("no comparison")
        };
        assert_eq!(between(&run, &empty), RunsError::TooShort { run: 1 });
        assert_eq!(between(&[], &run), RunsError::TooShort { run: 0 });
        let pair = [run[0].clone(), run[0].clone()];
        assert_eq!(between(&pair, &run), RunsError::Bodies { counts: [2, 1] });
        let mut late = run.clone();
        late[0].points.iter_mut().for_each(|point| point.time += 0.2);
        assert!(matches!(between(&run, &late), RunsError::NoCommonTime { .. }));
        late[0].points.reverse();
        assert_eq!(between(&run, &late), RunsError::Disorder { run: 1 });
    }
}
