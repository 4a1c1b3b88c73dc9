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
