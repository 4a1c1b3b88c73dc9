//! One tracked body as its table has it.

use measurements::median;

use super::units::Unit;

/// A column of numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Measure {
    /// Its name in the table.
    pub(super) name: String,
    pub(super) unit: Unit,
}

/// One reading, in the units of the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sample {
    pub(super) line: u64,
    pub(super) t: f64,
    pub(super) z: f64,
    pub(super) x: f64,
}

/// The readings of one run.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Track {
    /// The table that it is from, and that without its ending.
    pub(super) file: String,
    pub(super) stem: String,
    /// What the table calls it; none where the table is of one run.
    pub(super) name: Option<String>,
    /// The same where several columns do, with what each says of conditions, parted by `/`.
    pub(super) called: Option<String>,
    /// The layout, in words.
    pub(super) layout: String,
    pub(super) time: Measure,
    pub(super) vertical: Measure,
    pub(super) forward: Option<Measure>,
    /// Columns that say the same in all rows of the run, such as `condition`, with their values.
    pub(super) labels: Vec<(String, String)>,
    /// In the order of the table.
    pub(super) samples: Vec<Sample>,
    /// Rows without a number.
    pub(super) holes: usize,
    /// What was assumed, in sentences.
    pub(super) notes: Vec<String>,
}

impl Track {
    /// The positions of both tracks in the rows that have both.
    pub(super) fn beside<'a>(&'a self, other: &'a Self) -> impl Iterator<Item = [f64; 2]> {
        self.samples.iter().filter_map(|own| {
            let at = other.samples.binary_search_by_key(&own.line, |one| one.line).ok()?;
            Some([own.z, other.samples[at].z])
        })
    }
}

/// Standard deviation of `values`.
pub(super) fn deviation(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (values.iter().map(|one| (one - mean).powi(2)).sum::<f64>() / n).sqrt()
}

/// Share of the way of the farthest track up to which one stands still.
pub(super) const STILL: f64 = 0.05;

/// The same of a track whose way is at most so many of its steps: it trembles around one place.
const TREMBLING: f64 = 0.2;
const NOISE: f64 = 8.0;

/// Removes tracks of one table that hardly move beside the others, such as fixed marks on the picture.
pub(super) fn without_still(mut tracks: Vec<Track>) -> Vec<Track> {
    let way = |track: &Track| {
        let ends =
            track.samples.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], one| {
                [low.min(one.z), high.max(one.z)]
            });
        ends[1] - ends[0]
    };
    let farthest = tracks.iter().map(way).fold(0.0, f64::max);
    let step = |track: &Track| {
        let steps = track.samples.windows(2).map(|pair| (pair[1].z - pair[0].z).abs());
        median(steps).unwrap_or(0.0)
    };
    let is_noise = |track: &Track| way(track) < NOISE * step(track);
    let is_still = |track: &Track| {
        let share = if is_noise(track) { TREMBLING } else { STILL };
        way(track) < share * farthest
    };
    if tracks.iter().all(is_still) {
        return tracks;
    }
    // Tracks of one column have names.
    let is_one_column = tracks.iter().all(|one| one.vertical.name == tracks[0].vertical.name);
    let name = |one: &Track| match &one.name {
        Some(name) if is_one_column => name.clone(),
        _ => one.vertical.name.clone(),
    };
    let still: Vec<String> = tracks.iter().filter(|one| is_still(one)).map(name).collect();
    tracks.retain(|track| !is_still(track));
    if let (Some(first), false) = (tracks.first_mut(), still.is_empty()) {
        first.notes.push(format!("{}: it does not move, left out", still.join(", ")));
    }
    tracks
}
