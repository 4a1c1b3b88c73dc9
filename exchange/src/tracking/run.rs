//! A drop that was read, and the set of all of them.

use measurements::{Frame, Reading};

use super::bodies::Body;
use super::surface::Touch;

/// What was understood of one run, in words for a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Understood {
    /// The file, without its folder.
    pub file: String,
    /// The layout.
    pub layout: String,
    /// Rows with numbers, and how many are kept.
    pub rows: [usize; 2],
    /// The unit of time.
    pub time: String,
    /// The axis that the body falls along: its name, unit and direction.
    pub axis: String,
    /// The run.
    pub run: String,
    /// Its condition.
    pub condition: String,
    /// Time of first contact on the clock of the table (s).
    pub contact: Reading,
    /// Speed at contact (m/s).
    pub speed: Reading,
}

/// A set that is not written yet.
#[derive(Clone, Debug, PartialEq)]
pub struct Set {
    /// One for each run.
    pub understood: Vec<Understood>,
    /// What holds for all of them, in sentences.
    pub notes: Vec<String>,
    /// Names and contents of the files.
    pub(super) files: Vec<(&'static str, String)>,
}

/// One drop.
pub(super) struct Run {
    pub(super) name: String,
    pub(super) file: String,
    pub(super) fields: Vec<(String, String)>,
    pub(super) labels: Vec<(String, String)>,
    pub(super) body: Body,
    pub(super) condition: String,
    pub(super) touch: Touch,
    pub(super) speed: Reading,
    /// (deg)
    pub(super) angle: f64,
    /// Error of one reading (m).
    pub(super) noise: f64,
    /// Time between frames (s).
    pub(super) step: f64,
    /// From contact and surface; ways too.
    pub(super) frames: Vec<Frame>,
}
