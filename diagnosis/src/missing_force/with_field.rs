//! A model with a force that it lacks.

use std::sync::Arc;

use crate::forward::field::Field;
use crate::forward::{Candidate, Forward, Parameter, PredictError, Request, Scatter};

/// The model of `forward` on whose bodies the force of `field` acts too.
pub(super) struct WithField<'a> {
    pub(super) forward: &'a dyn Forward,
    pub(super) field: Arc<Field>,
}

impl Forward for WithField<'_> {
    fn parameters(&self) -> &[Parameter] {
        self.forward.parameters()
    }

    fn candidates(&self) -> &[Candidate] {
        self.forward.candidates()
    }

    fn n_scattering_coefficients(&self) -> usize {
        self.forward.n_scattering_coefficients()
    }

    fn within(&self) -> Option<&dyn Forward> {
        Some(self.forward)
    }

    fn predict(&self, condition: usize, at: &Request<'_>) -> Result<Vec<f64>, PredictError> {
        let scatter = Scatter { field: Some(Arc::clone(&self.field)), ..at.scatter.clone() };
        self.forward.predict(condition, &Request { scatter: &scatter, ..*at })
    }
}
