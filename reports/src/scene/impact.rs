//! What the logs of a run tell of its impact, beside the grains of each frame.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use exchange::frames::{CraterPoint, Frame, Grain, each_frame};
use exchange::read::ReadError;
use exchange::run_files::RunFiles;
use thiserror::Error;

use super::{Forces, Quantity};

/// Why an impact cannot be seen.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum SceneError {
    #[error(transparent)]
    Read(#[from] ReadError),
    #[error(
        "{} is not there: this run logged no grains; run the model again with --set log.grains=true, and \
         --set log.frames_per_s=1000 for more pictures",
        path.display()
    )]
    NotRecorded { path: PathBuf },
    #[error("{} is a run in a resistive medium, which has no grains to be seen", path.display())]
    NoGrains { path: PathBuf },
    #[error("{} holds no frame of grains", path.display())]
    Empty { path: PathBuf },
}

/// What the logs of a run tell of its impact.
#[derive(Clone, Debug)]
pub struct Impact {
    pub(super) log: PathBuf,
    /// Times of the frames (s).
    pub times: Vec<f64>,
    /// Number of grains.
    pub grains: usize,
    /// Whether the bed is a plane.
    pub planar: bool,
    /// Where there are grains in the first frame: along x, y and z, from and to (m).
    pub extent: [[f64; 2]; 3],
    /// x and y of the first body in the first frame (m).
    pub axis: [f64; 2],
    /// Of the grains (m).
    pub mean_diameter: f64,
    /// The largest width of a body in the first frame (m).
    pub body_size: f64,
    /// The highest point of a body in the first frame (m).
    pub top: f64,
    /// What colours end at, by the index of a quantity.
    pub tops: [f64; 3],
    /// The forces of the ground.
    pub forces: Forces,
    /// The surface in the first and in the last frame.
    pub surfaces: [Vec<CraterPoint>; 2],
    /// Names of bodies, and their centres of mass in each frame (m).
    pub(super) paths: Vec<(String, Vec<[f64; 3]>)>,
    /// Where grains were in the first frame (m), by number.
    first: Vec<(u32, [f32; 3])>,
}

/// Colours of a quantity end where this share of the grains has less, in the frame where that is most.
const SHOWN_SHARE: f64 = 0.998;

impl Impact {
    /// Of `run`, a folder or a log, on whose bodies `forces` act.
    ///
    /// # Errors
    /// If it has no log of grains, or that cannot be read.
    pub fn read(run: &Path, forces: Forces) -> Result<Self, SceneError> {
        let log = RunFiles::so_far(run).grains;
        if !log.is_file() {
            return Err(SceneError::NotRecorded { path: log });
        }
        let mut scan = Scan::default();
        each_frame(&log, |frame| {
            scan.take(frame);
            ControlFlow::Continue(())
        })?;
        let Some(impact) = scan.impact else { return Err(SceneError::Empty { path: log }) };
        let at_end = scan.last.crater(impact.axis[0], impact.axis[1]);
        let [at_start, _] = impact.surfaces;
        Ok(Self { log, forces, surfaces: [at_start, at_end], ..impact })
    }

    /// What the colours of `quantity` end at (SI).
    pub(crate) fn top_of(&self, quantity: Quantity) -> f64 {
        self.tops[quantity.index()]
    }

    /// How far (m) a grain is from where it was in the first frame.
    pub fn displacement(&self, grain: &Grain) -> f64 {
        displacement(&self.first, grain)
    }

    /// The least and the greatest coordinate of any body along an axis (m).
    pub(super) fn reach(&self, axis: usize) -> [f64; 2] {
        let all = self.paths.iter().flat_map(|(_, path)| path).map(|place| place[axis]);
        all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
    }

    /// The frame nearest to `time` (s).
    pub fn frame_at(&self, time: f64) -> usize {
        let after = self.times.partition_point(|at| *at < time).min(self.times.len() - 1);
        match after.checked_sub(1) {
            Some(before) if time - self.times[before] < self.times[after] - time => before,
            _ => after,
        }
    }

    /// The frames at contact, at the greatest force and at the end. The second is the frame nearest to the
    /// greatest force, but not the first: that shows the bed before it has moved.
    pub fn moments(&self) -> [usize; 3] {
        let last = self.times.len() - 1;
        let greatest = self.forces.greatest().map_or(last / 2, |(time, _)| self.frame_at(time));
        [0, greatest.max(1).min(last), last]
    }

    /// As many of the frames as asked for, the first and the last among them, even in time.
    pub fn evenly(&self, n: usize) -> Vec<usize> {
        let (last, n) = (self.times.len() - 1, n.min(self.times.len()));
        match n {
            0 | 1 => vec![last],
            _ => (0..n).map(|at| (2 * at * last + n - 1) / (2 * (n - 1))).collect(),
        }
    }
}

/// An impact while its frames are read.
#[derive(Default)]
struct Scan {
    impact: Option<Impact>,
    last: Frame,
    /// Taken again for every frame.
    values: Vec<f64>,
}

impl Scan {
    fn take(&mut self, frame: &Frame) {
        let impact = self.impact.get_or_insert_with(|| begun(frame));
        impact.times.push(frame.time);
        for (name, path) in &mut impact.paths {
            let found = frame.bodies.iter().find(|body| body.name == *name);
            let place = found.map(|body| body.centre).or(path.last().copied());
            path.extend(place);
        }
        for quantity in Quantity::ALL {
            self.values.clear();
            self.values.extend(frame.grains.iter().map(|grain| match quantity {
                Quantity::Speed => f64::from(grain.speed),
                Quantity::Force => f64::from(grain.force),
                Quantity::Displacement => displacement(&impact.first, grain),
            }));
            let top = &mut impact.tops[quantity.index()];
            *top = top.max(quantile(&mut self.values, SHOWN_SHARE));
        }
        self.last.clone_from(frame);
    }
}

/// What the first frame tells.
fn begun(frame: &Frame) -> Impact {
    let n = frame.grains.len();
    let span = |axis: usize| {
        let reach = frame.grains.iter().map(|grain| {
            [grain.position[axis] - grain.radius, grain.position[axis] + grain.radius]
        });
        let [low, high] = reach.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], [a, b]| {
            [low.min(a), high.max(b)]
        });
        [f64::from(low), f64::from(high)]
    };
    let mut first: Vec<(u32, [f32; 3])> =
        frame.grains.iter().map(|grain| (grain.id, grain.position)).collect();
    first.sort_by_key(|(id, _)| *id);
    let radii: f64 = frame.grains.iter().map(|grain| f64::from(grain.radius)).sum();
    let centre = frame.bodies.first().map_or([0.0; 3], |body| body.centre);
    let corners = |axis: usize| {
        let all = frame.bodies.iter().flat_map(|body| &body.surface.corners);
        all.map(move |corner| corner[axis])
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
    };
    let [x, z] = [corners(0), corners(2)];
    Impact {
        log: PathBuf::new(),
        times: Vec::new(),
        grains: n,
        planar: frame.is_planar(),
        extent: [span(0), span(1), span(2)],
        axis: [centre[0], centre[1]],
        mean_diameter: 2.0 * radii / n.max(1) as f64,
        body_size: (x[1] - x[0]).max(0.0),
        top: z[1].max(0.0),
        tops: [0.0; 3],
        forces: Forces::default(),
        surfaces: [frame.crater(centre[0], centre[1]), Vec::new()],
        paths: frame.bodies.iter().map(|body| (body.name.clone(), Vec::new())).collect(),
        first,
    }
}

fn displacement(first: &[(u32, [f32; 3])], grain: &Grain) -> f64 {
    let Ok(at) = first.binary_search_by_key(&grain.id, |(id, _)| *id) else { return 0.0 };
    let from = first[at].1;
    let square = |axis: usize| f64::from(grain.position[axis] - from[axis]).powi(2);
    (square(0) + square(1) + square(2)).sqrt()
}

/// The value that this share of `values` does not exceed; 0 of none.
fn quantile(values: &mut [f64], share: f64) -> f64 {
    let Some(last) = values.len().checked_sub(1) else { return 0.0 };
    let at = (share * last as f64).round() as usize;
    *values.select_nth_unstable_by(at, f64::total_cmp).1
}
