//! Models of what was not measured.

use measurements::MeasurementSet;

use crate::forward::Forward;
use crate::forward::observable::Layout;

/// Makes models for conditions that were not measured.
pub trait Designs: Sync {
    /// The model before `set`; `layouts` say what to predict, one per condition. `None` if the model
    /// has nothing to say about one of them.
    fn forward(&self, set: &MeasurementSet, layouts: &[Layout]) -> Option<Box<dyn Forward>>;
}
