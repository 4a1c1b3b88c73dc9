//! First contact as the frames of a run show it: free fall before, departure from it after.
//!
//! Around first contact a path is `a + b t + c t²/2 − k (t − t₀)₊ᵖ`: free fall at `c ≈ g`, then a resistance that
//! grows with the depth. `p` follows from the shape of the tip (a sphere presents an area ∝ z, so that the
//! path departs with the third power of time), and is not known exactly. So the fit is made for all
//! `t₀` and several `p`, and what is said of the contact is the mean over these fits, each with the
//! weight of its misfit; its error holds the spread between them. Nothing of a model of the bed is needed.
//!
//! Of a path whose zeros are not known ([`super::Departure`]) more is fitted to: `k` may change with time, and the contact
//! is then sought by the forces of a bed ([`super::braking`]).

use nalgebra::{Matrix5, Vector5};

use super::braking::{self, Body, Readings};
use super::reading::Reading;
use super::smooth::{blocks, median_step, slope, velocity_window};
use super::{Condition, Frame, Run};

/// What the frames of a run say of its first contact, on the clock and the scale of the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// When the path departs from free fall (s).
    pub time: Reading,
    /// The earliest and the latest time (s) of contact that fit; infinite where the frames before or behind
    /// it are missing.
    pub between: [f64; 2],
    /// Depth (m) that free fall has at time zero, where the frames reach that far.
    pub depth_at_zero: Option<Reading>,
    /// Depth (m) that free fall has where the path departs from it, with the error of `time` in it.
    pub depth: Reading,
    /// Depth (m) that free fall has at just the value of `time`.
    pub at_time: Reading,
    /// Downward velocity (m/s) of free fall there.
    pub falling: Reading,
    /// Downward acceleration (m/s²) before it.
    pub acceleration: Reading,
    /// Downward velocity (m/s) at `time`.
    pub sinking: Reading,
    /// Forward velocity (m/s) at `time`.
    pub forward: Reading,
    /// Time of the first frame near the contact (s).
    pub first: f64,
    /// Time from frame to frame (s).
    pub step: f64,
}

impl Contact {
    /// What a clock and a depth of this run alone would have to be counted from (s, m): the surface is taken
    /// to be right where a clock alone explains what is seen.
    #[must_use]
    pub fn own_zeros(&self) -> (f64, f64) {
        let [earliest, latest] = self.between;
        let clock = self.depth_at_zero.map(|depth| -depth.value / self.sinking.value);
        match clock.filter(|t| (earliest - self.step..=latest + self.step).contains(t)) {
            Some(time) => (time, 0.0),
            None => (self.time.value, self.depth.value),
        }
    }
}

/// Share of its greatest velocity above which a path is near its contact.
const NEAR: f64 = 0.7;

/// Fewest frames near the contact that a path can be read from.
pub(super) const FEWEST: usize = 5;

/// Most frames, or means of neighbouring ones, that are fitted to.
const MOST: usize = 48;

/// The same where the zeros are not known: more of the fall has to tell.
const MOST_OF_FALL: usize = 200;

/// Places of the contact that are tried between two frames.
pub(super) const BETWEEN_FRAMES: usize = 4;

/// How well the acceleration before contact is known, relative to gravity: guides and air take some of it.
pub(super) const FREE: f64 = 0.3;

/// The same where they may take all of it, and more.
pub(super) const SLOWED: f64 = 5.0;

/// Frames that the first velocity is taken over.
const EARLY: usize = 4;

/// Squared distance, in standard errors, up to which a fit is possible.
const POSSIBLE: f64 = 16.0;

/// The contact of `run` under `condition`, with an acceleration before it that is gravity to `doubt` (relative), readings
/// that are good to `sigma` (m), and the depth of free fall at the time `zero` (s) of the table; `None` where the frames do not show it, or the lowest point
/// of the intruder is no mass that falls freely.
#[must_use]
pub(super) fn read(
    run: &Run,
    condition: &Condition,
    (gravity, doubt, sigma): (f64, f64, f64),
    zero: f64,
) -> Option<Contact> {
    let power = power(condition)?;
    let all = velocity_window(&run.frames, sigma, NEAR)?;
    if all.len() < FEWEST {
        return coarse(&run.frames, sigma, (condition, gravity, zero));
    }
    let (fits, contact) = fit(all, (gravity, doubt, sigma), power);
    let [first, last] = fits.ends;
    let reaches_zero = first <= zero + 1.5 * contact.step && zero <= last;
    let is_whole = all[0].t <= run.frames[0].t;
    let depth_at_zero = match reaches_zero {
        true => Some(fits.mean(|fit| fits.free(fit, zero))),
        false if is_whole => back_to_zero(all, condition, gravity, zero),
        false => None,
    };
    // A body that is slowed has its speed where the table says that contact is.
    let sinking = match doubt > FREE && reaches_zero {
        true => fits.mean(|fit| fits.whole_velocity(fit, zero)),
        false => contact.sinking,
    };
    Some(Contact { depth_at_zero, sinking, ..contact })
}

/// The fits to the frames `all` near contact, and what they say of it.
pub(super) fn fit(
    all: &[Frame],
    (gravity, doubt, sigma): (f64, f64, f64),
    power: f64,
) -> (Fits, Contact) {
    let (frames, sigma) = blocks(all, MOST, sigma);
    let fits = Fits::of(&frames, (gravity, doubt, sigma), (power, false));
    let contact = seen(&fits, all, (&frames, sigma));
    (fits, contact)
}

/// The fits to the frames `all` near contact of a path whose zeros are not known, and what they say of it.
pub(super) fn fit_braked(
    all: &[Frame],
    (gravity, doubt, sigma): (f64, f64, f64),
    (power, body): (f64, Body<'_>),
) -> (Fits, Contact) {
    let (frames, sigma) = blocks(all, MOST_OF_FALL, sigma);
    let powers = Fits::of(&frames, (gravity, doubt, sigma), (power, true));
    let best = powers.all.iter().min_by(|a, b| a.misfit.total_cmp(&b.misfit));
    let scale = (powers.origin, powers.scale);
    let readings = Readings { frames: &frames, known: (gravity, doubt, sigma), scale };
    let path = |time: f64| best.map_or([0.0; 2], |best| powers.path(best, time));
    // The path of such a fit tells the forces better than a power does.
    let (_, path) = braking::fits(&readings, body, path);
    let (braked, _) = braking::fits(&readings, body, |time| path.at(time));
    let fits = Fits::new(braked, scale, &frames);
    let contact = seen(&fits, all, (&frames, sigma));
    (fits, contact)
}

/// What `fits` to means of `all` frames, with their error, say of the contact.
fn seen(fits: &Fits, all: &[Frame], (frames, sigma): (&[Frame], f64)) -> Contact {
    let step = (all[all.len() - 1].t - all[0].t) / (all.len() - 1) as f64;
    let time = fits.mean(|fit| (fit.contact, 0.0));
    // Behind the contact the bed brakes the forward motion too.
    let before = frames.iter().filter(|frame| frame.t <= time.value + step).count();
    let before = &frames[..before.clamp(3, frames.len())];
    let forward = slope(before.iter().map(|frame| (frame.t, frame.x)), sigma);
    Contact {
        time,
        between: fits.between(),
        depth_at_zero: None,
        depth: fits.mean(|fit| fits.free(fit, fit.contact)),
        at_time: fits.mean(|fit| fits.free(fit, time.value)),
        falling: fits.mean(|fit| fits.velocity(fit, time.value)),
        acceleration: fits.mean(|fit| fits.acceleration(fit)),
        sinking: fits.mean(|fit| fits.velocity(fit, fit.contact)),
        forward,
        first: all[0].t,
        step,
    }
}

/// Of few frames: the depth at `zero` alone, on the chord beside it.
fn coarse(
    frames: &[Frame],
    sigma: f64,
    (condition, gravity, zero): (&Condition, f64, f64),
) -> Option<Contact> {
    let distance = |frame: &Frame| (frame.t - zero).abs();
    let near =
        (0..frames.len()).min_by(|a, b| distance(&frames[*a]).total_cmp(&distance(&frames[*b])))?;
    let chord = |from: usize| {
        let [a, b] = [frames.get(from)?, frames.get(from + 1)?];
        Some((b.z - a.z) / (b.t - a.t))
    };
    let at = frames[near];
    let (velocity, next) = (chord(near).or_else(|| chord(near.checked_sub(1)?))?, chord(near + 1));
    let step = median_step(frames)?;
    let change = next.map_or(velocity, |next| velocity - next).abs();
    let depth = match distance(&at) <= 1.5 * step {
        true => Reading {
            value: at.z - velocity * (at.t - zero),
            se: libm::hypot(1.5 * sigma, change * distance(&at)),
        },
        false => back_to_zero(frames, condition, gravity, zero)?,
    };
    let unknown = Reading { value: zero, se: f64::INFINITY };
    (velocity > 0.0).then_some(Contact {
        time: unknown,
        between: [f64::NEG_INFINITY, f64::INFINITY],
        depth_at_zero: Some(depth),
        depth,
        at_time: depth,
        falling: Reading { value: velocity, se: change },
        acceleration: Reading { value: gravity, se: f64::INFINITY },
        sinking: Reading { value: velocity, se: change },
        forward: unknown,
        first: frames[0].t,
        step,
    })
}

/// Depth (m) at time zero of a run whose first frame comes later: the velocity in between lies between the
/// stated one and that of the first frames.
fn back_to_zero(
    frames: &[Frame],
    condition: &Condition,
    gravity: f64,
    zero: f64,
) -> Option<Reading> {
    let (first, since) = (frames[0], frames[0].t - zero);
    if since <= 0.0 {
        return None;
    }
    let early = slope(frames.iter().take(EARLY).map(|frame| (frame.t, frame.z)), 0.0).value;
    let stated = condition.speed * libm::sin(condition.angle_deg.to_radians());
    let gained = gravity * since;
    let (least, most) = (early.min(stated), early.max(stated) + 0.5 * gained);
    let value = first.z - 0.5 * (least + most) * since;
    // Half of what the velocities differ by is the farthest that the mean of them can be off.
    Some(Reading { value, se: (0.25 * (most - least) + 0.02 * stated) * since })
}

/// The power of time with which a path departs from free fall; `None` where its lowest point does not
/// fall like a mass.
fn power(condition: &Condition) -> Option<f64> {
    let round = matches!(condition.shape.as_str(), "sphere" | "disc");
    power_of(&condition.shape).filter(|_| condition.spin == 0.0 || round)
}

/// The same of a shape that does not spin.
pub(super) fn power_of(shape: &str) -> Option<f64> {
    match shape {
        "sphere" | "hemisphere" => Some(3.0),
        "disc" => Some(2.5),
        "cylinder" => Some(2.0),
        "cone" => Some(4.0),
        _ => None,
    }
}

/// The power that follows from the shape, and those beside it.
fn powers(power: f64) -> [f64; 3] {
    [(power - 1.0).max(2.0), power, power + 1.0]
}

/// All fits of one run.
pub(super) struct Fits {
    /// The time (s) that fits count from, and its scale.
    origin: f64,
    scale: f64,
    /// Of time, by form.
    powers: [f64; 3],
    pub(super) all: Vec<Fit>,
    /// Ends of the frames (s).
    ends: [f64; 2],
    /// How much larger than stated the squares of the residuals are in the best fit, at least 1.
    pub(super) excess: f64,
}

/// The path for one contact and one power.
pub(super) struct Fit {
    pub(super) contact: f64,
    /// Which power, or which other form, the departure has.
    pub(super) form: usize,
    /// Chi-squared.
    pub(super) misfit: f64,
    /// a, b, c, k in units of the scale of time, and what k changes by with time; k is 0 of a departure by forces.
    pub(super) numbers: Vector5<f64>,
    pub(super) covariance: Matrix5<f64>,
}

impl Fits {
    fn of(
        frames: &[Frame],
        (gravity, doubt, sigma): (f64, f64, f64),
        (power, bends): (f64, bool),
    ) -> Self {
        let (first, last) = (frames[0].t, frames[frames.len() - 1].t);
        let (origin, scale) = (0.5 * (first + last), 0.5 * (last - first));
        let places = BETWEEN_FRAMES * (frames.len() - 1);
        let place = |k: usize| first + (last - first) * k as f64 / places as f64;
        let mut all = Vec::new();
        let powers = powers(power);
        for form in 0..powers.len() {
            for contact in (0..=places).map(place) {
                all.extend(Fit::of(
                    frames,
                    (origin, scale),
                    (gravity, doubt, sigma),
                    (contact, form, powers[form], bends),
                ));
            }
        }
        Self { powers, ..Self::new(all, (origin, scale), frames) }
    }

    pub(super) fn new(all: Vec<Fit>, (origin, scale): (f64, f64), frames: &[Frame]) -> Self {
        let ends = [frames[0].t, frames[frames.len() - 1].t];
        let best = all.iter().fold(f64::INFINITY, |best, fit| best.min(fit.misfit));
        // One row more than frames, the acceleration, and five numbers less.
        let freedom = (frames.len() as f64 - 4.0).max(1.0);
        // Few degrees of freedom leave the residuals, and so the errors, uncertain themselves.
        let excess = (best / freedom).max(1.0) * (1.0 + 4.0 / freedom);
        Self { origin, scale, powers: [1.0; 3], all, ends, excess }
    }

    /// Weighted mean of a number with a variance over all fits.
    fn mean(&self, of: impl Fn(&Fit) -> (f64, f64)) -> Reading {
        let best = self.all.iter().fold(f64::INFINITY, |best, fit| best.min(fit.misfit));
        let (mut sum, mut first, mut second) = (0.0, 0.0, 0.0);
        for fit in &self.all {
            let weight = libm::exp(-0.5 * (fit.misfit - best) / self.excess);
            let (value, variance) = of(fit);
            sum += weight;
            first += weight * value;
            second += weight * (value * value + self.excess * variance);
        }
        let value = first / sum;
        Reading { value, se: (second / sum - value * value).max(0.0).sqrt() }
    }

    /// The earliest and latest contact that fit nearly as well as the best of their power.
    fn between(&self) -> [f64; 2] {
        let mut between = [f64::INFINITY, f64::NEG_INFINITY];
        for form in 0..self.powers.len() {
            let own = || self.all.iter().filter(|fit| fit.form == form);
            let best = own().fold(f64::INFINITY, |best, fit| best.min(fit.misfit));
            for fit in own().filter(|fit| fit.misfit <= best + POSSIBLE * self.excess) {
                between = [between[0].min(fit.contact), between[1].max(fit.contact)];
            }
        }
        // Sums of steps end beside the last frame.
        let [first, last] = self.ends;
        let near = 1e-6 * (last - first);
        [
            if between[0] <= first + near { f64::NEG_INFINITY } else { between[0] },
            if between[1] >= last - near { f64::INFINITY } else { between[1] },
        ]
    }

    /// Depth (m) of free fall at `time`, and its variance.
    pub(super) fn free(&self, fit: &Fit, time: f64) -> (f64, f64) {
        let t = (time - self.origin) / self.scale;
        fit.along(Vector5::new(1.0, t, 0.5 * t * t, 0.0, 0.0))
    }

    /// Velocity (m/s) of free fall at `time`, and its variance.
    fn velocity(&self, fit: &Fit, time: f64) -> (f64, f64) {
        let t = (time - self.origin) / self.scale;
        fit.along(Vector5::new(0.0, 1.0, t, 0.0, 0.0) / self.scale)
    }

    /// Velocity (m/s) at `time`, the departure from free fall included, and its variance.
    fn whole_velocity(&self, fit: &Fit, time: f64) -> (f64, f64) {
        let t = (time - self.origin) / self.scale;
        let since = ((time - fit.contact) / self.scale).max(0.0);
        let power = self.powers[fit.form];
        let departure = power * libm::pow(since, power - 1.0);
        fit.along(Vector5::new(0.0, 1.0, t, -departure, 0.0) / self.scale)
    }

    /// Depth (m) and velocity (m/s) at `time` (s), the departure from free fall included.
    fn path(&self, fit: &Fit, time: f64) -> [f64; 2] {
        let t = (time - self.origin) / self.scale;
        let since = ((time - fit.contact) / self.scale).max(0.0);
        let power = self.powers[fit.form];
        let slower = libm::pow(since, power - 1.0);
        let at = Vector5::new(1.0, t, 0.5 * t * t, -slower * since, slower * since * since);
        let bend = (power + 1.0) * slower * since;
        let along = Vector5::new(0.0, 1.0, t, -power * slower, bend) / self.scale;
        [at.dot(&fit.numbers), along.dot(&fit.numbers)]
    }

    /// Acceleration (m/s²) before the contact, and its variance.
    fn acceleration(&self, fit: &Fit) -> (f64, f64) {
        fit.along(Vector5::new(0.0, 0.0, 1.0, 0.0, 0.0) / (self.scale * self.scale))
    }
}

impl Fit {
    fn of(
        frames: &[Frame],
        (origin, scale): (f64, f64),
        (gravity, doubt, sigma): (f64, f64, f64),
        (contact, form, power, bends): (f64, usize, f64, bool),
    ) -> Option<Self> {
        let (mut normal, mut right, mut square) = (Matrix5::zeros(), Vector5::zeros(), 0.0);
        let mut add = |row: Vector5<f64>, value: f64, weight: f64| {
            normal += row * row.transpose() * weight;
            right += row * (value * weight);
            square += weight * value * value;
        };
        for frame in frames {
            let t = (frame.t - origin) / scale;
            let since = ((frame.t - contact) / scale).max(0.0);
            let departure = libm::pow(since, power);
            let bend = if bends { departure * since } else { 0.0 };
            let row = Vector5::new(1.0, t, 0.5 * t * t, -departure, bend);
            add(row, frame.z, 1.0 / (sigma * sigma));
        }
        let acceleration = gravity * scale * scale;
        let doubt = doubt * gravity.max(1.0) * scale * scale;
        add(Vector5::new(0.0, 0.0, 1.0, 0.0, 0.0), acceleration, 1.0 / (doubt * doubt));
        // Without a frame behind the contact nothing is known of what bends the path: it is 0.
        normal[(4, 4)] += if bends { 1e-12 * normal[(0, 0)] } else { 1.0 };
        let solve = |normal: Matrix5<f64>| {
            let covariance = normal.cholesky()?.inverse();
            let numbers = covariance * right;
            Some((numbers, covariance, (square - numbers.dot(&right)).max(0.0)))
        };
        // Without a frame behind the contact nothing is known of k: it is 0, as good as exactly.
        let mut held = normal;
        held[(3, 3)] += 1e12 * normal[(0, 0)];
        let free = solve(normal).filter(|(numbers, ..)| numbers[3] > 0.0);
        let (numbers, covariance, misfit) = match free {
            Some(found) => found,
            None => solve(held)?,
        };
        Some(Self { contact, form, misfit, numbers, covariance })
    }

    /// A combination of the numbers, and its variance.
    fn along(&self, row: Vector5<f64>) -> (f64, f64) {
        (row.dot(&self.numbers), row.dot(&(self.covariance * row)))
    }
}
