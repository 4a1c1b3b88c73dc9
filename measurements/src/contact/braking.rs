//! First contact of a path by what a bed takes from its fall.
//!
//! From contact on the body is braked by `s k₁ v² + k₂ z + s k₃` per unit mass: a drag that is not negative, a resistance
//! that grows with depth, and friction. The share `s` of the body that meets the bed is that of its section at the depth
//! `z`, of which `k₂ z` may be a part too, or the whole at once: beds and their models lie at these ends and in between. A power of time is not enough: it goes
//! on to grow where the section does not.

use nalgebra::{Matrix5, Matrix6, Vector5, Vector6};

use intruders::TipForm;

use crate::contact::fits::{BETWEEN_FRAMES, Fit};
use crate::{Condition, Frame};

/// How often contacts are added beside the best, and the chi-squared that two neighbours may differ by.
const REFINED: usize = 12;
const RESOLVED: f64 = 1.0;

/// Steps between two readings that forces are integrated in.
const STEPS: usize = 3;

/// Weight that holds a force at zero, and one by which no number is undetermined, in units of what readings tell.
const HELD: f64 = 1e9;
const LOOSE: f64 = 1e-9;

/// Forces that are held at zero, by their place among the numbers: drag, what grows with depth, and friction.
const WITHOUT: [&[usize]; 7] = [&[], &[5], &[4], &[3], &[4, 5], &[3, 5], &[3, 4]];

/// Shares of the body that meet the bed, of drag, of what grows with depth and of friction, by its section in the surface
/// and by how fast its volume immerses: grains that it sets in motion brake it while that grows.
const EXPOSURES: [fn(f64, f64) -> [f64; 3]; 4] = [
    |_, _| [1.0, 1.0, 1.0],
    |section, _| [section, 1.0, section],
    |section, _| [section, section, section],
    |_, entering| [1.0 + entering, 1.0, 1.0],
];

/// The part of a body that meets the bed first.
#[derive(Clone, Copy, Debug)]
pub struct Tip {
    /// What its shape is there; `None` where its lowest point does not fall as its mass does.
    pub(crate) form: Option<&'static TipForm>,
    /// (m)
    diameter: f64,
    /// Full apex angle of a cone (rad).
    apex: f64,
}

impl Tip {
    /// Of a body of this `shape` and `diameter` (m), with this full apex angle (deg), 90 where it is not stated.
    pub fn new(shape: &str, diameter: f64, apex_deg: Option<f64>) -> Self {
        let form = intruders::find(shape).and_then(|entry| entry.measured.tip.as_ref());
        Self { form, diameter, apex: apex_deg.unwrap_or(90.0).to_radians() }
    }

    /// Of the body of `condition`.
    pub(crate) fn of(condition: &Condition) -> Self {
        Self::new(&condition.shape, condition.diameter, condition.apex_deg)
    }

    /// Section in the surface over the largest, `depth` (m) below first contact.
    fn section(self, depth: f64) -> f64 {
        self.form.map_or(1.0, |form| (form.section)((depth / self.diameter).max(0.0), self.apex))
    }

    /// Immersed volume by depth over the largest section, `depth` (m) below first contact; nothing of a body that is
    /// below the surface as a whole.
    fn entering(self, depth: f64) -> f64 {
        self.form.map_or(1.0, |form| (form.entering)((depth / self.diameter).max(0.0), self.apex))
    }
}

/// The readings that are fitted to.
pub(crate) struct Readings<'a> {
    pub(crate) frames: &'a [Frame],
    /// Acceleration of the fall (m/s²), its relative error, and the error of a reading (m).
    pub(crate) known: (f64, f64, f64),
    /// The time (s) that fits count from, and its scale.
    pub(crate) scale: (f64, f64),
}

/// A path between readings.
pub(crate) struct Path {
    /// Times (s), depths (m) and velocities (m/s).
    readings: Vec<[f64; 3]>,
}

impl Path {
    /// Depth (m) and velocity (m/s) at `time` (s), by the cubic between the readings around it.
    pub(crate) fn at(&self, time: f64) -> [f64; 2] {
        let all = &self.readings;
        if all.len() < 2 {
            return [0.0; 2];
        }
        let behind = all.partition_point(|one| one[0] <= time).clamp(1, all.len() - 1);
        let [[t0, z0, v0], [t1, z1, v1]] = [all[behind - 1], all[behind]];
        let step = t1 - t0;
        let s = (time - t0) / step;
        let [mean, bend] = [(z1 - z0) / step, v0 + v1 - 2.0 * (z1 - z0) / step];
        let curve = 3.0 * mean - 2.0 * v0 - v1;
        [z0 + step * s * (v0 + s * (curve + s * bend)), v0 + s * (2.0 * curve + 3.0 * s * bend)]
    }
}

/// Fits for all contacts and exposures, and the path of the best. `path` is the depth (m) and the velocity (m/s) at a time
/// (s), near enough to know forces by.
pub(crate) fn fits(
    readings: &Readings<'_>,
    tip: Tip,
    path: impl Fn(f64) -> [f64; 2],
) -> (Vec<Fit>, Path) {
    let frames = readings.frames;
    let (first, last) = (frames[0].t, frames[frames.len() - 1].t);
    let places = BETWEEN_FRAMES * (frames.len() - 1);
    let step = (last - first) / places as f64;
    let mut fits: Vec<Fit> = Vec::with_capacity(EXPOSURES.len() * (places + 1));
    let mut best = (f64::INFINITY, Path { readings: Vec::new() });
    for (form, exposure) in EXPOSURES.iter().enumerate() {
        let mut fit_at = |contact: f64| {
            let [level, _] = path(contact);
            let forces = |time: f64| {
                let [z, v] = path(time);
                let [fast, deep, share] = exposure(tip.section(z - level), tip.entering(z - level));
                [fast * v * v, deep * (z - level).max(0.0), share]
            };
            let braked = braked(readings, contact, forces);
            let behind = frames.iter().filter(|frame| frame.t > contact);
            let there: Vec<[f64; 3]> = behind.map(|frame| forces(frame.t)).collect();
            let (fit, strengths) = solved(readings, (contact, form), (&braked, &there))?;
            if fit.misfit < best.0 {
                best = (fit.misfit, readings.path(&fit, &braked, strengths));
            }
            Some(fit)
        };
        let grid = (0..=places).map(|k| first + step * k as f64);
        let mut own: Vec<Fit> = grid.filter_map(&mut fit_at).collect();
        refine(&mut own, step, fit_at);
        fits.append(&mut own);
    }
    (fits, best.1)
}

/// Adds contacts beside the best of `fits`, which are in order and a `step` (s) apart, until those beside it fit about as
/// well: exact readings tell a contact far better than they are apart.
fn refine(fits: &mut Vec<Fit>, step: f64, mut fit_at: impl FnMut(f64) -> Option<Fit>) {
    for _ in 0..REFINED {
        let misfit = |at: &usize| fits[*at].misfit;
        let best = (0..fits.len()).min_by(|a, b| misfit(a).total_cmp(&misfit(b)));
        let Some(best) = best else { return };
        let beside = [best.checked_sub(1), (best + 1 < fits.len()).then_some(best + 1)];
        let is_resolved = |at: usize| fits[at].misfit < fits[best].misfit + RESOLVED;
        if beside.iter().flatten().all(|&at| is_resolved(at)) {
            break;
        }
        let between = |at: usize| 0.5 * (fits[at].contact + fits[best].contact);
        let more: Vec<Fit> =
            beside.into_iter().flatten().map(between).filter_map(&mut fit_at).collect();
        fits.extend(more);
        fits.sort_by(|a, b| a.contact.total_cmp(&b.contact));
    }
    // A mean over contacts goes by their distances.
    let contacts: Vec<f64> = fits.iter().map(|fit| fit.contact).collect();
    for (at, fit) in fits.iter_mut().enumerate() {
        let before = at.checked_sub(1).map_or(step, |before| contacts[at] - contacts[before]);
        let behind = contacts.get(at + 1).map_or(step, |behind| behind - contacts[at]);
        fit.share = 0.5 * (before + behind) / step;
    }
}

/// By how much each of three forces of size one has braked the body at a reading: its way, in units of the scale of time
/// squared, and its speed, in units of the scale.
#[derive(Clone, Copy)]
struct Braked {
    way: [f64; 3],
    speed: [f64; 3],
}

impl Readings<'_> {
    /// The path of `fit`, with forces of these `strengths`.
    fn path(&self, fit: &Fit, braked: &[Braked], strengths: [f64; 3]) -> Path {
        let (origin, scale) = self.scale;
        let [a, b, c] = [0, 1, 2].map(|k| fit.numbers[k]);
        let sum = |of: &[f64; 3]| of.iter().zip(strengths).map(|(one, k)| one * k).sum::<f64>();
        let reading = |(frame, by): (&Frame, &Braked)| {
            let t = (frame.t - origin) / scale;
            let depth = a + t * (b + 0.5 * c * t) - sum(&by.way);
            [frame.t, depth, (b + c * t - sum(&by.speed)) / scale]
        };
        Path { readings: self.frames.iter().zip(braked).map(reading).collect() }
    }
}

/// What three `forces` of size one, at a time (s), do from `contact` on.
fn braked(readings: &Readings<'_>, contact: f64, forces: impl Fn(f64) -> [f64; 3]) -> Vec<Braked> {
    let (mut way, mut speed, mut now) = ([0.0; 3], [0.0; 3], contact);
    let mut all = Vec::with_capacity(readings.frames.len());
    for frame in readings.frames {
        if frame.t > now {
            let time = (frame.t - now) / STEPS as f64;
            let step = time / readings.scale.1;
            for _ in 0..STEPS {
                let at = forces(now + 0.5 * time);
                for k in 0..3 {
                    way[k] += step * (speed[k] + 0.5 * step * at[k]);
                    speed[k] += step * at[k];
                }
                now += time;
            }
        }
        all.push(Braked { way, speed });
    }
    all
}

/// The fit with forces that brake the body as `braked` says and are `forces` at the readings behind contact, and how
/// strong they are.
fn solved(
    readings: &Readings<'_>,
    (contact, form): (f64, usize),
    (braked, forces): (&[Braked], &[[f64; 3]]),
) -> Option<(Fit, [f64; 3])> {
    let Readings { frames, known: (gravity, doubt, sigma), scale: (origin, scale) } = *readings;
    // Depths from anywhere would drown what the readings tell.
    let middle = frames[frames.len() / 2].z;
    let reading = |(frame, Braked { way: [drag, depth, friction], .. }): (&Frame, &Braked)| {
        let t = (frame.t - origin) / scale;
        let row = Vector6::new(1.0, t, 0.5 * t * t, -drag, -depth, -friction);
        (row / sigma, (frame.z - middle) / sigma)
    };
    let mut rows: Vec<(Vector6<f64>, f64)> = frames.iter().zip(braked).map(reading).collect();
    let [known, doubt] = [gravity, doubt * gravity.max(1.0)].map(|of| of * scale * scale);
    rows.push((Vector6::new(0.0, 0.0, 1.0 / doubt, 0.0, 0.0, 0.0), known / doubt));
    let normal: Matrix6<f64> = rows.iter().map(|(row, _)| row * row.transpose()).sum();
    let right: Vector6<f64> = rows.iter().map(|(row, value)| row * *value).sum();
    // In units of what each tells, numbers are of one size.
    let unit = normal.diagonal().map(|own| if own > 0.0 { own.sqrt().recip() } else { 1.0 });
    let units = Matrix6::from_diagonal(&unit);
    let scaled = units * normal * units + Matrix6::from_diagonal_element(LOOSE);
    let solve = |held: &[usize]| {
        let mut scaled = scaled;
        held.iter().for_each(|&force| scaled[(force, force)] += HELD);
        let covariance = units * scaled.cholesky()?.inverse() * units;
        let mut numbers: Vector6<f64> = covariance * right;
        held.iter().for_each(|&force| numbers[force] = 0.0);
        let misfit: f64 = rows.iter().map(|(row, value)| (row.dot(&numbers) - value).powi(2)).sum();
        Some((numbers, covariance, misfit))
    };
    // A bed never pushes a body on.
    let brakes = |numbers: &Vector6<f64>| {
        numbers[3] >= 0.0
            && forces
                .iter()
                .all(|force| (0..3).map(|k| numbers[3 + k] * force[k]).sum::<f64>() >= 0.0)
    };
    let tried = WITHOUT.iter().filter_map(|held| solve(held)).filter(|one| brakes(&one.0));
    let (numbers, covariance, misfit) = match tried.min_by(|a, b| a.2.total_cmp(&b.2)) {
        Some(found) => found,
        None => solve(&[3, 4, 5])?,
    };
    let (mut own, mut spread) = (Vector5::zeros(), Matrix5::zeros());
    own.fixed_rows_mut::<3>(0).copy_from(&numbers.fixed_rows::<3>(0));
    own[0] += middle;
    spread.fixed_view_mut::<3, 3>(0, 0).copy_from(&covariance.fixed_view::<3, 3>(0, 0));
    let fit = Fit { contact, form, share: 1.0, misfit, numbers: own, covariance: spread };
    Some((fit, [numbers[3], numbers[4], numbers[5]]))
}
