//! First contact of a path whose clock and depths count from anywhere.

use crate::Frame;
use crate::contact::braking::Tip;
use crate::contact::fall::Fall;
use crate::contact::fits::Fit;
use crate::contact::smooth::{fastest, velocity_window};
use crate::contact::{Contact, FEWEST, FREE, fit_braked};
use crate::reading::Reading;

/// Share of its greatest velocity above which the fall before contact is looked at.
const FALLING: f64 = 0.4;

/// The same behind it.
const BEHIND: f64 = 0.55;

/// First contact of a path whose zeros are not known.
#[derive(Clone, Debug, PartialEq)]
pub struct Departure {
    /// What its frames alone say.
    pub contact: Contact,
    /// Probability that the body is braked from the first frames on.
    pub is_braked_at_first: f64,
    /// All contacts that were tried.
    pub(crate) trials: Vec<Trial>,
}

/// A contact that was tried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Trial {
    /// How the path departs.
    pub(crate) form: usize,
    /// Depth (m) of free fall at the contact.
    pub(crate) depth: f64,
    /// Chi-squared.
    pub(crate) misfit: f64,
}

/// Frames behind the fastest that are fitted to at least, if the body has this share of its greatest velocity in them.
const BRAKED: usize = 5;
const STILL_FAST: f64 = 0.15;

/// Share of the time between two frames to which a frame has the time that it states: the shutter and the clock of a camera.
const PUNCTUAL: f64 = 0.005;

/// Number of frames that count as the first of a path.
const SOON: f64 = 2.0;

/// How well the acceleration before contact is known, relative to gravity, where the fall does not show that guides or air
/// take more of it; and the standard errors beyond which it does.
const KNOWN: f64 = 0.05;
const SHOWN: f64 = 2.0;

/// The same of the fall in `frames`.
fn doubt(frames: &[Frame], gravity: f64) -> f64 {
    let fall = Fall::of_frames(frames).filter(|fall| fall.acceleration.value.is_finite());
    let beyond = fall.map_or(FREE, |fall| {
        let Reading { value, se } = fall.acceleration;
        2.0 * ((value - gravity).abs() - SHOWN * se) / gravity
    });
    beyond.clamp(KNOWN, FREE)
}

impl Departure {
    /// First contact in `frames` of a body with this `tip` that does not spin: times in s on any clock,
    /// depths in m downward on any scale, readings good to `sigma` (m), under `gravity` (m/s²). `None` where they do not show
    /// it: fewer than five frames near contact, no fall before it, or a shape whose lowest point does not fall
    /// freely.
    pub fn of_frames(frames: &[Frame], tip: Tip, gravity: f64, sigma: f64) -> Option<Self> {
        let power = tip.form?.departure;
        let near = velocity_window(frames, sigma, BEHIND)?;
        // Nothing is known of the zeros: more of the fall has to tell.
        let (start, end) = (velocity_window(frames, sigma, FALLING)?[0].t, near[near.len() - 1].t);
        let from = frames.partition_point(|frame| frame.t < start);
        let to = frames.partition_point(|frame| frame.t <= end);
        // A slow camera sees a body that is soon braked in few frames.
        let (fastest, most) = fastest(frames, sigma)?;
        let moves =
            |pair: &&[Frame]| pair[1].z - pair[0].z > STILL_FAST * most * (pair[1].t - pair[0].t);
        let more = (fastest + BRAKED).saturating_sub(to);
        let to = to + frames[to - 1..].windows(2).take(more).take_while(moves).count();
        let all = Some(&frames[from..to]).filter(|all| all.len() >= FEWEST)?;
        let step = (all[all.len() - 1].t - all[0].t) / (all.len() - 1) as f64;
        let sigma = libm::hypot(sigma, PUNCTUAL * step * most);
        let (fits, contact) =
            fit_braked(all, (gravity, doubt(frames, gravity), sigma), (power, tip));
        let trial = |fit: &Fit| Trial {
            form: fit.form,
            depth: fits.free(fit, fit.contact).0,
            misfit: fit.misfit / fits.excess,
        };
        let soon = contact.first + SOON * contact.step;
        let at_first = |fit: &Fit| (f64::from(u8::from(fit.contact <= soon)), 0.0);
        let is_braked_at_first = fits.mean(at_first).value;
        Some(Self { contact, is_braked_at_first, trials: fits.all.iter().map(trial).collect() })
    }

    /// The same with depths counted from `level` (m).
    pub fn below(&self, level: f64) -> Self {
        let from = |depth: Reading| Reading { value: depth.value - level, ..depth };
        let contact = Contact {
            depth_at_zero: self.contact.depth_at_zero.map(from),
            depth: from(self.contact.depth),
            at_time: from(self.contact.at_time),
            ..self.contact
        };
        let trial = |trial: &Trial| Trial { depth: trial.depth - level, ..*trial };
        let is_braked_at_first = self.is_braked_at_first;
        Self { contact, is_braked_at_first, trials: self.trials.iter().map(trial).collect() }
    }
}
