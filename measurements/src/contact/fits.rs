//! Free fall and a departure from it, fitted to the frames around a contact.

use nalgebra::{Matrix5, Vector5};

use crate::Frame;
use crate::reading::Reading;

/// Places of the contact that are tried between two frames.
pub(crate) const BETWEEN_FRAMES: usize = 4;

/// Squared distance, in standard errors, up to which a fit is possible.
const POSSIBLE: f64 = 16.0;

/// The power that follows from the shape, and those beside it.
fn powers(power: f64) -> [f64; 3] {
    [(power - 1.0).max(2.0), power, power + 1.0]
}

/// All fits of one run.
pub(crate) struct Fits {
    /// The time (s) that fits count from, and its scale.
    pub(crate) origin: f64,
    pub(crate) scale: f64,
    /// Of time, by form.
    powers: [f64; 3],
    pub(crate) all: Vec<Fit>,
    /// Ends of the frames (s).
    pub(crate) ends: [f64; 2],
    /// How much larger than stated the squares of the residuals are in the best fit, at least 1.
    pub(crate) excess: f64,
}

/// The path for one contact and one power.
pub(crate) struct Fit {
    pub(crate) contact: f64,
    /// Which power, or which other form, the departure has.
    pub(crate) form: usize,
    /// Time that it stands for in a mean, over that of the others of its form where contacts are equally far apart.
    pub(crate) share: f64,
    /// Chi-squared.
    pub(crate) misfit: f64,
    /// a, b, c, k in units of the scale of time, and what k changes by with time; k is 0 of a departure by forces.
    pub(crate) numbers: Vector5<f64>,
    pub(crate) covariance: Matrix5<f64>,
}

impl Fits {
    pub(crate) fn of(
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
        for (form, &power) in powers.iter().enumerate() {
            for contact in (0..=places).map(place) {
                all.extend(Fit::of(
                    frames,
                    (origin, scale),
                    (gravity, doubt, sigma),
                    (contact, form, power, bends),
                ));
            }
        }
        Self { powers, ..Self::new(all, (origin, scale), frames) }
    }

    pub(crate) fn new(all: Vec<Fit>, (origin, scale): (f64, f64), frames: &[Frame]) -> Self {
        let ends = [frames[0].t, frames[frames.len() - 1].t];
        let best = all.iter().fold(f64::INFINITY, |best, fit| best.min(fit.misfit));
        // One row more than frames, the acceleration, and five numbers less.
        let freedom = (frames.len() as f64 - 4.0).max(1.0);
        // Few degrees of freedom leave the residuals, and so the errors, uncertain themselves.
        let excess = (best / freedom).max(1.0) * (1.0 + 4.0 / freedom);
        Self { origin, scale, powers: [1.0; 3], all, ends, excess }
    }

    /// Weighted mean of a number with a variance over all fits.
    pub(crate) fn mean(&self, of: impl Fn(&Fit) -> (f64, f64)) -> Reading {
        let best = self.all.iter().fold(f64::INFINITY, |best, fit| best.min(fit.misfit));
        let (mut sum, mut first, mut second) = (0.0, 0.0, 0.0);
        for fit in &self.all {
            let weight = fit.share * libm::exp(-0.5 * (fit.misfit - best) / self.excess);
            let (value, variance) = of(fit);
            sum += weight;
            first += weight * value;
            second += weight * (value * value + self.excess * variance);
        }
        let value = first / sum;
        Reading { value, se: (second / sum - value * value).max(0.0).sqrt() }
    }

    /// The earliest and latest contact that fit nearly as well as the best of their power.
    pub(crate) fn between(&self) -> [f64; 2] {
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
    pub(crate) fn free(&self, fit: &Fit, time: f64) -> (f64, f64) {
        let t = (time - self.origin) / self.scale;
        fit.along(Vector5::new(1.0, t, 0.5 * t * t, 0.0, 0.0))
    }

    /// Velocity (m/s) of free fall at `time`, and its variance.
    pub(crate) fn velocity(&self, fit: &Fit, time: f64) -> (f64, f64) {
        let t = (time - self.origin) / self.scale;
        fit.along(Vector5::new(0.0, 1.0, t, 0.0, 0.0) / self.scale)
    }

    /// Velocity (m/s) at `time`, the departure from free fall included, and its variance.
    pub(crate) fn whole_velocity(&self, fit: &Fit, time: f64) -> (f64, f64) {
        let t = (time - self.origin) / self.scale;
        let since = ((time - fit.contact) / self.scale).max(0.0);
        let power = self.powers[fit.form];
        let departure = power * libm::pow(since, power - 1.0);
        fit.along(Vector5::new(0.0, 1.0, t, -departure, 0.0) / self.scale)
    }

    /// Depth (m) and velocity (m/s) at `time` (s), the departure from free fall included.
    pub(crate) fn path(&self, fit: &Fit, time: f64) -> [f64; 2] {
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
    pub(crate) fn acceleration(&self, fit: &Fit) -> (f64, f64) {
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
        Some(Self { contact, form, share: 1.0, misfit, numbers, covariance })
    }

    /// A combination of the numbers, and its variance.
    fn along(&self, row: Vector5<f64>) -> (f64, f64) {
        (row.dot(&self.numbers), row.dot(&(self.covariance * row)))
    }
}
