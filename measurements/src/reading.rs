//! Numbers with their errors.

/// A number that was read, with its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// The number.
    pub value: f64,
    /// Its standard error, in the same unit.
    pub se: f64,
}

/// Standard errors beyond which two readings are not of one number.
const CONTRADICT: f64 = 4.0;

impl Reading {
    /// The mean of `readings`, with an error that their scatter shows too.
    pub fn mean(readings: impl Iterator<Item = Self> + Clone) -> Self {
        let n = readings.clone().count().max(1) as f64;
        let value = readings.clone().map(|one| one.value).sum::<f64>() / n;
        let scatter = readings.clone().map(|one| (one.value - value).powi(2)).sum::<f64>();
        let stated = readings.map(|one| one.se.powi(2)).sum::<f64>();
        let of_scatter = if n > 1.0 { scatter / (n * (n - 1.0)) } else { 0.0 };
        Self { value, se: of_scatter.max(stated / (n * n)).sqrt() }
    }

    /// The mean with `other`, by the errors of both; itself where they contradict each other.
    #[must_use]
    pub fn beside(self, other: Self) -> Self {
        let [own, others] = [self, other].map(|one| one.se.powi(-2));
        let sum = own + others;
        let apart = (self.value - other.value).abs() / libm::hypot(self.se, other.se);
        if !sum.is_finite() || sum <= 0.0 || apart > CONTRADICT {
            return self;
        }
        Self { value: (own * self.value + others * other.value) / sum, se: sum.sqrt().recip() }
    }
}
