//! From where depths count over coarse grains, as frames around first contact show it.

use crate::contact::zeros::POSITION;
use crate::{Kind, MeasurementSet, Run, SurfaceDefinition};

/// Least ratio of the variance of the depths at contact to that of readings and clock.
const CLEARLY: f64 = 2.5;

/// Least number of independent deviations that show a scatter.
const ENOUGH: usize = 6;

impl SurfaceDefinition {
    /// The definition that the frames of `set` show, over grains of the diameter `grain` (m).
    ///
    /// A body meets the highest grains first, and their heights scatter by less than a grain diameter. If depths count from the
    /// mean surface, the depths at first contact scatter likewise; if they count from first contact, they do not. In fine
    /// grains this scatter is below the error of a reading, and the result is `FirstContact`.
    pub fn shown_by(set: &MeasurementSet, grain: f64) -> Self {
        if set.kind != Kind::Trajectory {
            return Self::FirstContact;
        }
        let reading = set.instrument.position_sigma.unwrap_or(POSITION);
        let (mut found, mut expected, mut freedom) = (0.0, 0.0, 0);
        for (at, condition) in set.conditions.iter().enumerate() {
            let runs = set.runs.iter().filter(|run| run.condition == at);
            let contacts: Vec<Contact> = runs.filter_map(Contact::of).collect();
            let Some(own) = contacts.len().checked_sub(1).filter(|own| *own > 0) else { continue };
            let mean = contacts.iter().map(|one| one.depth).sum::<f64>() / contacts.len() as f64;
            found += contacts.iter().map(|one| (one.depth - mean).powi(2)).sum::<f64>();
            // A clock that begins with a frame is off by up to a frame, evenly.
            let frame = contacts.iter().map(|one| one.frame).fold(0.0, f64::max);
            let sinking = condition.speed * libm::sin(condition.angle_deg.to_radians());
            expected += own as f64 * (reading * reading + (sinking * frame).powi(2) / 12.0);
            freedom += own;
        }
        let is_of_grains = found < freedom as f64 * grain * grain;
        match freedom >= ENOUGH && found > CLEARLY * expected && is_of_grains {
            true => Self::Mean,
            false => Self::FirstContact,
        }
    }
}

/// A run at time zero.
struct Contact {
    /// Depth (m).
    depth: f64,
    /// Time between the frames around it (s).
    frame: f64,
}

impl Contact {
    /// Linear between the frames around time zero; none for a run that begins later or ends before.
    fn of(run: &Run) -> Option<Self> {
        let after = run.frames.iter().position(|frame| frame.t >= 0.0)?;
        let [before, after] = [run.frames.get(after.checked_sub(1)?)?, &run.frames[after]];
        let frame = after.t - before.t;
        let share = -before.t / frame;
        let depth = before.z + share * (after.z - before.z);
        (frame > 0.0 && depth.is_finite()).then_some(Self { depth, frame })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Bed, Condition, Frame, Geometry};

    /// Three conditions of five runs at 500 frames per second that meet the bed as deep as `depth` says (m).
    fn set(depth: impl Fn(usize) -> f64) -> MeasurementSet {
        let speeds = [0.5, 1.0, 1.5];
        let conditions = speeds.map(|speed| {
            Condition::straight_down(format!("v{speed}"), ("sphere", 0.02, 0.03), speed)
        });
        let bed = Bed::new(Geometry::Spatial, None, 9.81);
        let mut set = MeasurementSet::new("a", Kind::Trajectory, bed, conditions.to_vec());
        set.instrument.position_sigma = Some(1e-4);
        for number in 0..15 {
            let speed = speeds[number / 5];
            let frame = |at: i32| {
                let t = f64::from(at) / 500.0 - 1e-3;
                Frame { t, z: depth(number) + speed * t, x: 0.0, sigma: None }
            };
            let frames = (-5..5).map(frame).collect();
            set.runs.push(Run { frames, ..Run::new(format!("r{number}"), number / 5) });
        }
        set
    }

    #[test]
    fn heights_of_first_contact_that_scatter_by_less_than_a_grain_are_those_above_a_mean_surface() {
        let shown = |set: &MeasurementSet| SurfaceDefinition::shown_by(set, 5e-3);
        // By turns 0 to 4 mm above it.
        let uneven = set(|number| -1e-3 * (number % 5) as f64);
        assert_eq!(shown(&uneven), SurfaceDefinition::Mean);
        // A level of its own is one of all runs; a clock is off by less than a frame.
        let level = set(|number| -2e-3 + 2e-4 * (number % 2) as f64);
        assert_eq!(shown(&level), SurfaceDefinition::FirstContact);
        // Sand does not scatter by millimetres: levels do.
        let of_sand = SurfaceDefinition::shown_by(&uneven, 3e-4);
        assert_eq!(of_sand, SurfaceDefinition::FirstContact);
    }

    #[test]
    fn runs_from_first_contact_on_show_nothing() {
        let mut late = set(|number| -1e-3 * (number % 5) as f64);
        late.runs.iter_mut().for_each(|run| run.frames.retain(|frame| frame.t >= 0.0));
        assert_eq!(SurfaceDefinition::shown_by(&late, 5e-3), SurfaceDefinition::FirstContact);
    }
}
