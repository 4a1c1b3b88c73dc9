//! Random numbers that depend on what they are for, not on when they are drawn.

use rand::RngExt;
use rand_pcg::Pcg64;

/// What random numbers are for; each purpose has its own.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Purpose {
    /// Scores of effects under noise alone.
    Family = 1,
    /// Resampled deviations of runs.
    Resampling = 2,
    /// How far off a noise model is that was learned from few numbers.
    NoiseScale = 3,
    /// Signatures of what does nothing.
    Signature = 7,
    /// Runs in another order.
    Order = 4,
    /// Choices of held-out conditions.
    HeldOut = 5,
    /// Measurements that hypotheses expect.
    Prospect = 8,
    /// Sets that are simulated to see how often verdicts come true.
    Simulation = 6,
}

/// The random numbers of condition (or other thing) `index` for `purpose`.
pub(crate) fn stream(seed: u64, purpose: Purpose, index: usize) -> Pcg64 {
    Pcg64::new(u128::from(seed), ((purpose as u128) << 64) | index as u128)
}

/// A normal number with mean 0 and variance 1 (Box & Muller 1958, Ann. Math. Stat. 29, 610).
pub(crate) fn normal(random: &mut Pcg64) -> f64 {
    let radius = (-2.0 * libm::log(1.0 - random.random::<f64>())).sqrt();
    radius * libm::cos(std::f64::consts::TAU * random.random::<f64>())
}

/// A factor on a standard deviation that is known from `freedom` independent numbers only: it may be larger than it
/// seems. Draws follow Wilson & Hilferty 1931, Proc. Natl. Acad. Sci. 17, 684.
pub(crate) fn scale_of_noise(freedom: f64, random: &mut Pcg64) -> f64 {
    let spread = 2.0 / (9.0 * freedom);
    let mean_square = (1.0 - spread + normal(random) * spread.sqrt()).max(0.1).powi(3);
    1.0 / mean_square.sqrt()
}
