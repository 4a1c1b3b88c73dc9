//! Which numbers of an impact are compared: a vector per condition, the same for runs and models.

use measurements::{Axis, Kind};

/// What the numbers of one condition are, in the order of its vectors: depth at each time, then
/// range at each time, then the readings of a curve, then the scalars.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layout {
    /// Times of the frames since first contact (s); negative before it.
    pub times: Vec<f64>,
    /// Whether the range at those times follows their depth.
    pub along_x: bool,
    /// Readings that are no positions; none of a set of trajectories or scalars.
    pub curve: Option<Curve>,
    /// Whether the stopping time is among the scalars.
    pub stop_time: bool,
    /// Whether the final depth is.
    pub final_z: bool,
    /// Whether the final range is.
    pub final_x: bool,
    /// Whether the depth of the crater is.
    pub crater_depth: bool,
    /// Whether the diameter of its rim is.
    pub rim_diameter: bool,
}

/// Readings of one kind, and where they are.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// What is read.
    pub observable: Observable,
    /// Where: of a force, the depth below the undisturbed surface as it is read (m); else the time since first contact (s).
    pub at: Vec<f64>,
}

/// A kind of number in a vector of observables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Observable {
    /// Depth of the lowest point at a time (m).
    Depth,
    /// Horizontal distance from first contact at a time (m).
    Range,
    /// Force of the bed against the motion at a depth (N).
    Force,
    /// Reading of an accelerometer at a time (m/s²).
    Acceleration,
    /// Downward velocity at a time (m/s).
    Velocity,
    /// Angular velocity at a time (rad/s).
    Spin,
    /// Stopping time (s).
    StopTime,
    /// Final depth (m).
    FinalDepth,
    /// Final horizontal distance (m).
    FinalRange,
    /// Depth of the crater when the bed lies still (m).
    CraterDepth,
    /// Distance from rim to rim (m).
    RimDiameter,
}

impl Layout {
    /// The kind of every entry.
    pub fn kinds(&self) -> Vec<Observable> {
        let frames = self.times.len();
        let mut kinds = vec![Observable::Depth; frames];
        if self.along_x {
            kinds.resize(2 * frames, Observable::Range);
        }
        if let Some(curve) = &self.curve {
            kinds.resize(kinds.len() + curve.at.len(), curve.observable);
        }
        kinds.extend(self.scalars());
        kinds
    }

    /// The kinds of its scalars, in their order.
    pub fn scalars(&self) -> impl Iterator<Item = Observable> + use<> {
        let all = [
            (self.stop_time, Observable::StopTime),
            (self.final_z, Observable::FinalDepth),
            (self.final_x, Observable::FinalRange),
            (self.crater_depth, Observable::CraterDepth),
            (self.rim_diameter, Observable::RimDiameter),
        ];
        all.into_iter().filter(|(there, _)| *there).map(|(_, kind)| kind)
    }

    /// How many sizes of craters are compared, which force laws have none of.
    pub fn craters(&self) -> usize {
        usize::from(self.crater_depth) + usize::from(self.rim_diameter)
    }

    /// The layout less the sizes of craters.
    pub fn without_craters(&self) -> Self {
        Self { crater_depth: false, rim_diameter: false, ..self.clone() }
    }

    /// The kind of every entry, with the time (s) or depth (m) of its reading.
    pub(crate) fn places(&self) -> Vec<(Observable, Option<f64>)> {
        let tracks = if self.along_x { 2 } else { 1 };
        let times = (0..tracks).flat_map(|_| &self.times);
        let curve = self.curve.iter().flat_map(|curve| &curve.at);
        let places = times.chain(curve).copied().map(Some).chain(std::iter::repeat(None));
        self.kinds().into_iter().zip(places).collect()
    }

    /// How many numbers a vector has.
    pub fn len(&self) -> usize {
        let frames = self.times.len() * (1 + usize::from(self.along_x));
        let curve = self.curve.as_ref().map_or(0, |curve| curve.at.len());
        frames + curve + self.scalars().count()
    }

    /// Whether nothing is compared.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

impl Observable {
    /// Every kind, in the order of a vector.
    pub const ALL: [Self; 11] = [
        Self::Depth,
        Self::Range,
        Self::Force,
        Self::Acceleration,
        Self::Velocity,
        Self::Spin,
        Self::StopTime,
        Self::FinalDepth,
        Self::FinalRange,
        Self::CraterDepth,
        Self::RimDiameter,
    ];

    /// Its key in JSON, with the unit.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Self::Depth => "z_m",
            Self::Range => "x_m",
            Self::Force => "force_N",
            Self::Acceleration => "acceleration_m_s2",
            Self::Velocity => "velocity_m_s",
            Self::Spin => "spin_rad_s",
            Self::StopTime => "stop_time_s",
            Self::FinalDepth => "final_z_m",
            Self::FinalRange => "final_x_m",
            Self::CraterDepth => "crater_depth_m",
            Self::RimDiameter => "rim_diameter_m",
        }
    }

    /// The one with this key.
    pub fn of_key(key: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|one| one.key() == key)
    }

    /// Whether it is a number of the whole impact rather than of a time.
    #[must_use]
    pub fn is_scalar(self) -> bool {
        matches!(
            self,
            Self::StopTime
                | Self::FinalDepth
                | Self::FinalRange
                | Self::CraterDepth
                | Self::RimDiameter
        )
    }

    /// Whether it is a place, whose errors are lengths.
    #[must_use]
    pub(crate) fn is_position(self) -> bool {
        matches!(self, Self::Depth | Self::Range | Self::FinalDepth | Self::FinalRange)
    }

    /// What its readings lie along, itself, and its change along the way, as they are drawn.
    #[must_use]
    pub fn axes(self) -> [Axis; 3] {
        let axis = |name, unit, scale| Axis { name, unit, scale };
        match self {
            Self::Force => {
                [axis("depth", "mm", 1e3), axis("force", "N", 1.0), axis("stiffness", "N/mm", 1e-3)]
            }
            Self::Acceleration => [
                axis("time", "ms", 1e3),
                axis("acceleration", "m/s²", 1.0),
                axis("change", "m/s² per ms", 1e-3),
            ],
            Self::Velocity => [
                axis("time", "ms", 1e3),
                axis("velocity", "m/s", 1.0),
                axis("acceleration", "m/s²", 1.0),
            ],
            Self::Spin => [
                axis("time", "ms", 1e3),
                axis("spin", "rad/s", 1.0),
                axis("change", "rad/s per ms", 1e-3),
            ],
            Self::StopTime => {
                [axis("time", "ms", 1e3), axis("time", "ms", 1e3), axis("change", "1", 1.0)]
            }
            Self::Depth
            | Self::Range
            | Self::FinalDepth
            | Self::FinalRange
            | Self::CraterDepth
            | Self::RimDiameter => {
                [axis("time", "ms", 1e3), axis("position", "mm", 1e3), axis("velocity", "m/s", 1.0)]
            }
        }
    }

    /// What of a curve of this kind of set is read; `None` for trajectories and scalars.
    pub fn of_curve(kind: Kind) -> Option<Self> {
        match kind {
            Kind::Trajectory | Kind::Scalar => None,
            Kind::ForceDepth => Some(Self::Force),
            Kind::Acceleration => Some(Self::Acceleration),
            Kind::Velocity => Some(Self::Velocity),
            Kind::Spin => Some(Self::Spin),
        }
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
            curve: Some(Curve { observable: Observable::Force, at: vec![0.01] }),
            stop_time: true,
            final_z: false,
            final_x: true,
            ..Layout::default()
        };
        use Observable::{Depth, FinalRange, Force, Range, StopTime};
        assert_eq!(layout.kinds(), [Depth, Depth, Range, Range, Force, StopTime, FinalRange]);
        assert_eq!(layout.len(), 7);
        assert!(Layout::default().is_empty());
    }
}
