//! Readings along one axis that are no positions, such as a force over depth.

use crate::contradiction::Contradiction;
use crate::document::conditions::ConditionPlaces;
use crate::reading::Reading;
use crate::table::columns::{ColumnNames, ColumnSpec};
use crate::table::findings::Findings;
use crate::{Condition, Instrument, Kind, MeasurementSet, Run};

/// A kind of set whose runs are curves.
pub struct Curve {
    /// The kind.
    pub kind: Kind,
    /// As `measurement.toml` writes it.
    pub word: &'static str,
    /// Its runs in words.
    pub plural: &'static str,
    /// What of a condition was measured, as a function.
    pub function: &'static str,
    /// What the readings lie along.
    pub along: Along,
    /// What is read.
    pub value: Axis,
    /// Key of its tables below `[files]`.
    pub(crate) files: &'static str,
    /// Columns of a table with a column of runs, and of one of a single run.
    pub(crate) columns: [&'static [ColumnSpec; 4]; 2],
    /// Key of the error of one reading, with its unit.
    pub sigma_key: &'static str,
    /// What the set states of it.
    pub(crate) sigma: fn(&Instrument) -> Option<f64>,
    /// What is told of a condition whose speed at contact neither the set nor any reading shows.
    pub(crate) lacks_speed: &'static str,
    /// The speed at contact (m/s) that the readings of a run before it show.
    pub(crate) shown_speed: fn(&MeasurementSet, &Condition, &Run) -> Option<Reading>,
    /// Refuses what no such reading is; gives magnitudes that contradict each other.
    pub(crate) check: Check,
}

/// Checks of a set whose tables were read.
pub(crate) type Check = fn(&MeasurementSet, Written<'_>, &mut Findings) -> Vec<Contradiction>;

/// Where a set says what of its conditions, and what of the columns of its tables.
pub(crate) type Written<'a> = (&'a [ConditionPlaces], &'a ColumnNames);

/// What readings lie along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Along {
    /// The time since first contact (s).
    Time,
    /// The depth below the undisturbed surface (m).
    Depth,
}

impl Along {
    /// As it is drawn.
    #[must_use]
    pub fn axis(self) -> Axis {
        match self {
            Self::Time => Axis { name: "time", unit: "ms", scale: 1e3 },
            Self::Depth => Axis { name: "depth", unit: "mm", scale: 1e3 },
        }
    }
}

/// An axis of a drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// In words.
    pub name: &'static str,
    /// The unit of the drawing.
    pub unit: &'static str,
    /// How many of that unit are one of SI.
    pub scale: f64,
}

impl Axis {
    /// As it stands beside a drawing.
    pub fn label(&self) -> String {
        format!("{} ({})", self.name, self.unit)
    }
}

impl Curve {
    /// What `set` states of the error of one reading (SI).
    pub fn stated_sigma(&self, set: &MeasurementSet) -> Option<f64> {
        (self.sigma)(&set.instrument)
    }

    /// Whether `set` states the error of any reading.
    pub(crate) fn has_stated_errors(&self, set: &MeasurementSet) -> bool {
        let mut samples = set.runs.iter().flat_map(|run| &run.samples);
        self.stated_sigma(set).is_some() || samples.any(|sample| sample.sigma.is_some())
    }
}
