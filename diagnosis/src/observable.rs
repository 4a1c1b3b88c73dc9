//! Which numbers of an impact are compared: a vector per condition, the same for runs and models.

/// What the numbers of one condition are, in the order of its vectors: depth at each time, then
/// range at each time, then the scalars.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layout {
    /// Times of the frames since first contact (s); negative before it.
    pub times: Vec<f64>,
    /// Whether the range at those times follows their depth.
    pub along_x: bool,
    /// Whether the stopping time is among the scalars.
    pub stop_time: bool,
    /// Whether the final depth is.
    pub final_z: bool,
    /// Whether the final range is.
    pub final_x: bool,
}

/// A kind of number in a vector of observables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Observable {
    /// Depth of the lowest point at a time (m).
    Depth,
    /// Horizontal distance from first contact at a time (m).
    Range,
    /// Stopping time (s).
    StopTime,
    /// Final depth (m).
    FinalDepth,
    /// Final horizontal distance (m).
    FinalRange,
}

impl Layout {
    /// The kind of every entry.
    #[must_use]
    pub fn kinds(&self) -> Vec<Observable> {
        let frames = self.times.len();
        let mut kinds = vec![Observable::Depth; frames];
        if self.along_x {
            kinds.resize(2 * frames, Observable::Range);
        }
        let scalars = [
            (self.stop_time, Observable::StopTime),
            (self.final_z, Observable::FinalDepth),
            (self.final_x, Observable::FinalRange),
        ];
        kinds.extend(scalars.iter().filter(|(there, _)| *there).map(|(_, kind)| *kind));
        kinds
    }

    /// How many numbers a vector has.
    #[must_use]
    pub fn len(&self) -> usize {
        let frames = self.times.len() * (1 + usize::from(self.along_x));
        let scalars = [self.stop_time, self.final_z, self.final_x];
        frames + scalars.iter().filter(|&&there| there).count()
    }

    /// Whether nothing is compared.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

impl Observable {
    /// Every kind, in the order of a vector.
    pub const ALL: [Self; 5] =
        [Self::Depth, Self::Range, Self::StopTime, Self::FinalDepth, Self::FinalRange];

    /// Its key in JSON, with the unit.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Self::Depth => "z_m",
            Self::Range => "x_m",
            Self::StopTime => "stop_time_s",
            Self::FinalDepth => "final_z_m",
            Self::FinalRange => "final_x_m",
        }
    }

    /// Whether it is a number of the whole impact rather than of a time.
    #[must_use]
    pub fn is_scalar(self) -> bool {
        !matches!(self, Self::Depth | Self::Range)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_layout_has_as_many_kinds_as_numbers() {
        let layout = Layout {
            times: vec![0.0, 0.1],
            along_x: true,
            stop_time: true,
            final_z: false,
            final_x: true,
        };
        use Observable::{Depth, FinalRange, Range, StopTime};
        assert_eq!(layout.kinds(), [Depth, Depth, Range, Range, StopTime, FinalRange]);
        assert_eq!(layout.len(), 6);
        assert!(Layout::default().is_empty());
    }
}
