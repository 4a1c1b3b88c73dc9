//! First contact as the frames of a run show it: free fall before, departure from it after.
//!
//! Around first contact a path is `a + b t + c t²/2 − k (t − t₀)₊ᵖ`: free fall at `c ≈ g`, then a resistance that
//! grows with the depth. `p` follows from the shape of the tip (a sphere presents an area ∝ z, so that the
//! path departs with the third power of time), and is not known exactly. So the fit is made for all
//! `t₀` and several `p`, and what is said of the contact is the mean over these fits, each with the
//! weight of its misfit; its error holds the spread between them. Nothing of a model of the bed is needed.
//!
//! Of a path whose zeros are not known ([`crate::Departure`]) more is fitted to: `k` may change with time, and the contact
//! is then sought by the forces of a bed ([`crate::contact::braking`]).

pub(crate) mod braking;
pub(crate) mod definitions;
pub(crate) mod departure;
pub(crate) mod fall;
pub(crate) mod fits;
pub(crate) mod level;
pub(crate) mod smooth;
pub(crate) mod start;
pub(crate) mod stops;
pub(crate) mod stray_scalars;
pub(crate) mod strays;
pub(crate) mod surface;
pub(crate) mod zeros;

use crate::contact::braking::{Readings, Tip};
use crate::contact::fits::Fits;
use crate::contact::smooth::{blocks, median_step, slope, velocity_window};
use crate::contact::strays::but_strays;
use crate::reading::Reading;
use crate::{Condition, Frame, Run};

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
    /// When free fall at `gravity` (m/s²) passes `level` (m), and the downward velocity (m/s) there.
    pub fn crossing(&self, level: Reading, gravity: f64) -> (Reading, Reading) {
        let Self { time, at_time, falling, .. } = self;
        let (v, ahead) = (falling.value, level.value - at_time.value);
        let root = (v * v + 2.0 * gravity * ahead).max(0.0).sqrt();
        let later = 2.0 * ahead / (v + root).max(f64::MIN_POSITIVE);
        let se = libm::hypot(level.se, at_time.se) / v;
        let sinking =
            Reading { value: v + gravity * later, se: libm::hypot(falling.se, gravity * se) };
        (Reading { value: time.value + later, se }, sinking)
    }

    /// What a clock and a depth of this run alone would have to be counted from (s, m): the surface is taken
    /// to be right where a clock alone explains what is seen.
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
pub(crate) const FEWEST: usize = 5;

/// Most frames, or means of neighbouring ones, that are fitted to.
const MOST: usize = 48;

/// The same where the zeros are not known: more of the fall has to tell.
const MOST_OF_FALL: usize = 200;

/// How well the acceleration before contact is known, relative to gravity: guides and air take some of it.
pub(crate) const FREE: f64 = 0.3;

/// The same where they may take all of it, and more.
pub(crate) const SLOWED: f64 = 5.0;

/// Frames that the first velocity is taken over.
const EARLY: usize = 4;

/// The contact of `run` under `condition`, with the depth of free fall at the time `zero` (s) of the table. Known are the
/// gravity (m/s²) and its relative error before contact, and the error of a reading (m). `None` where the frames do not show
/// the contact, or the lowest point of the body does not fall freely.
pub(crate) fn read(
    run: &Run,
    condition: &Condition,
    (gravity, doubt, sigma): (f64, f64, f64),
    zero: f64,
) -> Option<Contact> {
    let power = power(condition)?;
    let frames = but_strays(&run.frames, sigma);
    let all = velocity_window(&frames, sigma, NEAR)?;
    if all.len() < FEWEST {
        return coarse(&frames, sigma, (condition, gravity, zero));
    }
    let known = (gravity, doubt, sigma);
    let tip = Tip::of(condition);
    let (fits, contact) = match tip.form.is_some_and(|form| form.soft_entry > 0.0) {
        // The section of a cone reaches its full size early, so that no power of time describes the path.
        true => fit_braked(all, known, (power, tip)),
        false => fit(all, known, power),
    };
    let [first, last] = fits.ends;
    let reaches_zero = first <= zero + 1.5 * contact.step && zero <= last;
    let is_whole = all[0].t <= frames[0].t;
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
pub(crate) fn fit(
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
pub(crate) fn fit_braked(
    all: &[Frame],
    (gravity, doubt, sigma): (f64, f64, f64),
    (power, tip): (f64, Tip),
) -> (Fits, Contact) {
    let (frames, sigma) = blocks(all, MOST_OF_FALL, sigma);
    let powers = Fits::of(&frames, (gravity, doubt, sigma), (power, true));
    let best = powers.all.iter().min_by(|a, b| a.misfit.total_cmp(&b.misfit));
    let scale = (powers.origin, powers.scale);
    let readings = Readings { frames: &frames, known: (gravity, doubt, sigma), scale };
    let path = |time: f64| best.map_or([0.0; 2], |best| powers.path(best, time));
    // The path of such a fit tells the forces better than a power does.
    let (_, path) = braking::fits(&readings, tip, path);
    let (braked, _) = braking::fits(&readings, tip, |time| path.at(time));
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
    // Of the two chords beside it, the one that the bed has braked less is nearer to free fall.
    let beside = [near.checked_sub(1).and_then(chord), chord(near)];
    let velocity = beside.into_iter().flatten().reduce(f64::max)?;
    let next = if beside[1] >= beside[0] { chord(near + 1) } else { beside[1] };
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
pub(crate) fn power(condition: &Condition) -> Option<f64> {
    let form = Tip::of(condition).form.filter(|form| condition.spin == 0.0 || form.is_round)?;
    Some(form.departure)
}
