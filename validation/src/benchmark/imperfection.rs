//! What laboratories have beside the effect that they look for: apparatus that is not as its file says.

use measurements::{Condition, MeasurementSet};

use super::chance::Chance;

/// One thing that is not as the file says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Imperfection {
    /// Nothing.
    None,
    /// Each clip is zero at the first frame that shows contact, up to one frame late.
    FirstFrame,
    /// The zero of depth is 3 mm off, up or down.
    Zero,
    /// All impact speeds are 3 % off.
    Speed,
    /// The mass of one body is 5 % off.
    Mass,
    /// All lengths are 2 % off.
    Scale,
    /// Conditions are measured on four days, on which resistances differ by 5 %; the file says which.
    Sessions,
    /// Every condition has its own pouring, and resistances of pourings differ by 5 %; the file does not say so.
    Pourings,
    /// One run is followed at another point from half-way on.
    Mistracked,
    /// One frame in fifty is somewhere within 20 mm.
    Strays,
    /// Readings have heavy tails: Student's t of three degrees of freedom.
    Tails,
}

impl Imperfection {
    /// Every one, the exact apparatus first.
    pub const ALL: [Self; 11] = [
        Self::None,
        Self::FirstFrame,
        Self::Zero,
        Self::Speed,
        Self::Mass,
        Self::Scale,
        Self::Sessions,
        Self::Pourings,
        Self::Mistracked,
        Self::Strays,
        Self::Tails,
    ];

    /// What it is, for tables.
    #[must_use]
    pub fn describe(self) -> &'static str {
        match self {
            Self::None => "exact",
            Self::FirstFrame => "clock at the first touching frame",
            Self::Zero => "zero of depth 3 mm off",
            Self::Speed => "speeds 3 % off",
            Self::Mass => "one mass 5 % off",
            Self::Scale => "scale 2 % off",
            Self::Sessions => "four days, 5 % apart",
            Self::Pourings => "every condition its own pouring, 5 % apart, unsaid",
            Self::Mistracked => "one mistracked run",
            Self::Strays => "2 % stray frames",
            Self::Tails => "heavy tails",
        }
    }

    /// Share of a frame by which contact is before the zero of a clip.
    pub(super) fn phase(self, chance: &mut Chance) -> f64 {
        match self {
            Self::FirstFrame => chance.between(0.0, 1.0),
            _ => 0.0,
        }
    }

    /// In which session condition `block` (in the order of the campaign) of `n` is measured; none where sessions are
    /// all alike.
    pub(super) fn session(self, block: usize, n: usize) -> Option<usize> {
        match self {
            Self::Sessions => Some(4 * block / n),
            Self::Pourings => Some(block),
            _ => None,
        }
    }

    /// Whether the file says which run is of which session.
    pub(super) fn is_session_said(self) -> bool {
        self == Self::Sessions
    }

    /// A standard number of one reading.
    pub(super) fn reading(self, chance: &mut Chance) -> f64 {
        let normal = chance.normal();
        match self {
            Self::Tails => {
                let square = (0..3).map(|_| chance.normal().powi(2)).sum::<f64>() / 3.0;
                // Of variance three; the file states the middle of the distribution.
                normal / square.sqrt()
            }
            _ => normal,
        }
    }

    /// Has `set` say what is not so, or show what was not there.
    pub(super) fn spoil(self, set: &mut MeasurementSet, chance: &mut Chance) {
        let sign = if chance.between(0.0, 1.0) < 0.5 { -1.0 } else { 1.0 };
        match self {
            Self::Zero => read_as(set, |[x, z]| [x, z + 3e-3 * sign]),
            Self::Scale => {
                read_as(set, |[x, z]| [x * (1.0 + 0.02 * sign), z * (1.0 + 0.02 * sign)])
            }
            Self::Speed => {
                for condition in &mut set.conditions {
                    condition.speed *= 1.0 + 0.03 * sign;
                }
            }
            Self::Mass => {
                let one = set.conditions[chance.below(set.conditions.len())].mass;
                let is_one = |condition: &&mut Condition| condition.mass.total_cmp(&one).is_eq();
                for condition in set.conditions.iter_mut().filter(is_one) {
                    condition.mass *= 1.0 + 0.05 * sign;
                }
            }
            Self::Mistracked => {
                let run = chance.below(set.runs.len());
                let jump = sign * chance.between(5e-3, 2e-2);
                let frames = &mut set.runs[run].frames;
                let half = frames.len() / 2;
                for frame in &mut frames[half..] {
                    frame.z += jump;
                }
                if let Some(z) = &mut set.runs[run].final_z {
                    *z += jump;
                }
            }
            Self::Strays => {
                for frame in set.runs.iter_mut().flat_map(|run| &mut run.frames) {
                    if chance.between(0.0, 1.0) < 0.02 {
                        frame.z += chance.between(-2e-2, 2e-2);
                        frame.x += chance.between(-2e-2, 2e-2);
                    }
                }
            }
            Self::None | Self::FirstFrame | Self::Sessions | Self::Pourings | Self::Tails => (),
        }
    }
}

fn read_as(set: &mut MeasurementSet, read: impl Fn([f64; 2]) -> [f64; 2]) {
    for run in &mut set.runs {
        for frame in &mut run.frames {
            [frame.x, frame.z] = read([frame.x, frame.z]);
        }
        let [x, z] = read([run.final_x.unwrap_or(0.0), run.final_z.unwrap_or(0.0)]);
        (run.final_x, run.final_z) = (run.final_x.map(|_| x), run.final_z.map(|_| z));
    }
}
