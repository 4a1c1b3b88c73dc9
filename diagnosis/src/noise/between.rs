//! How much conditions differ from each other by more than their repeats show.

/// The scatter of coefficients between conditions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Between {
    /// Standard deviation of the logarithm of each coefficient.
    pub sd: f64,
    /// Fall of twice the negative logarithm of the likelihood by it.
    pub gain: f64,
    /// Standard deviation of what is known of it beforehand; zero where it was not looked for.
    pub sigma: f64,
}
