//! In which way an assembly moves between two events, so that its equations are smooth there.

use super::assembly::PARTS;
use engine::math::Vec3;

/// The horizontal and the vertical component of a vector.
pub(super) const AXES: [usize; 2] = [0, 2];

/// How a component of the motion of a part is, where frictions hold it for itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sense {
    Positive,
    Held,
    Negative,
}

impl Sense {
    pub(super) fn sign(self) -> f64 {
        match self {
            Self::Positive => 1.0,
            Self::Held => 0.0,
            Self::Negative => -1.0,
        }
    }

    pub(super) fn of(velocity: f64) -> Self {
        if velocity > 0.0 {
            Self::Positive
        } else if velocity < 0.0 {
            Self::Negative
        } else {
            Self::Held
        }
    }
}

/// What is held fixed while the equations are integrated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Modes {
    /// Whether a part is below the surface.
    pub(super) in_bed: [bool; PARTS],
    /// The direction of a motion along a line.
    pub(super) straight: Option<Vec3>,
    /// Senses of the horizontal and the vertical component of each part.
    pub(super) sense: [[Sense; 2]; PARTS],
    /// Whether frictions act component by component.
    pub(super) gripping: bool,
    /// A compact body that passed through a speed of almost zero and was not held there.
    pub(super) creeping: bool,
}

/// By part, which components of its velocity are held.
pub(super) type Held = [[bool; 2]; PARTS];

impl Modes {
    /// Which components are held; above the surface nothing is.
    pub(super) fn held(&self) -> Held {
        std::array::from_fn(|part| {
            let gripped = self.gripping && self.in_bed[part];
            self.sense[part].map(|sense| gripped && sense == Sense::Held)
        })
    }
}
