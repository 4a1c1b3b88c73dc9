//! Whether a measurement set contains what it takes to show an effect, or to tell it from another.

use std::f64::consts::FRAC_PI_2;

use resistive::Needs;

use measurements::{Condition, Kind, MeasurementSet, Role, Run};

/// Impact speeds whose largest is so many times the smallest show how a force depends on speed.
const SPEED_RANGE: f64 = 3.0;

/// A run that ends so many diameters deep shows how a force depends on depth.
const DEEP: f64 = 2.0;

/// What of `needs` the conditions of `set` that may be fitted to do not contain.
pub(super) fn missing(needs: &[Needs], set: &MeasurementSet) -> Vec<Needs> {
    needs.iter().copied().filter(|need| !contains(set, *need)).collect()
}

/// Whether the conditions of `set` that may be fitted to contain `need`.
pub(super) fn contains(set: &MeasurementSet, need: Needs) -> bool {
    let data = Data { set };
    match need {
        Needs::Oblique => data.any(|one| !is_vertical(one)),
        Needs::ObliqueAngles => {
            data.distinct(|one| (!is_vertical(one)).then_some(one.angle_deg)) > 1
        }
        Needs::Vertical => data.any(is_vertical),
        Needs::Spin => data.any(|one| one.spin != 0.0),
        Needs::SpinBothWays => data.any(|one| one.spin > 0.0) && data.any(|one| one.spin < 0.0),
        Needs::Packings => data.distinct(|one| one.packing) > 1,
        Needs::BedDepth => data.distinct(|one| one.bed_depth) > 0,
        Needs::BedDepths => data.distinct(|one| one.bed_depth) > 1,
        Needs::Speeds => data.speed_range() >= SPEED_RANGE,
        Needs::Depths => data.final_depths().any(|depth| depth >= DEEP),
        Needs::Shallow => data.final_depths().any(|depth| depth < DEEP),
        Needs::Masses => data.distinct(|one| Some(one.mass)) > 1,
        Needs::Diameters => data.distinct(|one| Some(one.diameter)) > 1,
        Needs::Shapes => {
            data.conditions().any(|one| data.conditions().any(|other| !is_similar(one, other)))
        }
        Needs::FramesBeforeImpact => data.runs().any(|(_, run)| {
            let frames = run.frames.iter().map(|frame| frame.t);
            let felt = run.samples.iter().filter(|_| set.kind != Kind::ForceDepth);
            frames.chain(felt.map(|sample| sample.at)).any(|time| time < 0.0)
        }),
        Needs::Conditions => data.conditions().count() > 1,
    }
}

/// Whether the intruders of `one` and `other` have one shape, if not one size.
fn is_similar(one: &Condition, other: &Condition) -> bool {
    // Far below what bodies are made to.
    const SAME: f64 = 1e-3;
    let slenderness = |of: &Condition| of.height.map_or(0.0, |height| height / of.diameter);
    one.shape == other.shape && (slenderness(one) - slenderness(other)).abs() <= SAME
}

/// The conditions of a set that may be fitted to.
struct Data<'a> {
    set: &'a MeasurementSet,
}

impl Data<'_> {
    fn conditions(&self) -> impl Iterator<Item = &Condition> {
        self.set.conditions.iter().filter(|one| one.role == Role::Fit)
    }

    /// The runs, each with its condition.
    fn runs(&self) -> impl Iterator<Item = (&Condition, &Run)> {
        self.set
            .runs
            .iter()
            .map(|run| (&self.set.conditions[run.condition], run))
            .filter(|(condition, _)| condition.role == Role::Fit)
    }

    fn any(&self, of: impl Fn(&Condition) -> bool) -> bool {
        self.conditions().any(of)
    }

    /// How many different values there are.
    fn distinct(&self, of: impl Fn(&Condition) -> Option<f64>) -> usize {
        let mut values: Vec<f64> = self.conditions().filter_map(of).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        values.len()
    }

    /// The largest impact speed over the smallest; 1 if there is one.
    fn speed_range(&self) -> f64 {
        let speeds = || self.conditions().map(|one| one.speed);
        let smallest = speeds().fold(f64::INFINITY, f64::min);
        speeds().fold(0.0, f64::max) / smallest
    }

    /// Where the runs end, in diameters: the final depth, or the deepest frame.
    fn final_depths(&self) -> impl Iterator<Item = f64> {
        self.runs().filter_map(|(condition, run)| {
            let of_forces = run.samples.iter().filter(|_| self.set.kind == Kind::ForceDepth);
            let depths = run.frames.iter().map(|frame| frame.z);
            let deepest = || depths.chain(of_forces.map(|sample| sample.at)).reduce(f64::max);
            Some(run.final_z.or_else(deepest)? / condition.diameter)
        })
    }
}

fn is_vertical(condition: &Condition) -> bool {
    condition.angle_deg.to_radians() >= FRAC_PI_2
}

#[cfg(test)]
mod tests {
    use super::*;
    use measurements::{Bed, FinalDefinition, Frame, Geometry};

    fn condition() -> Condition {
        Condition::straight_down("c", ("sphere", 0.02, 0.05), 1.0)
    }

    fn run(condition: usize, final_z: Option<f64>, frames: &[(f64, f64)]) -> Run {
        let frames = frames.iter().map(|&(t, z)| Frame { t, z, x: 0.0, sigma: None }).collect();
        let name = String::new();
        Run { final_z, frames, ..Run::new(name, condition) }
    }

    fn set(conditions: Vec<Condition>, runs: Vec<Run>) -> MeasurementSet {
        MeasurementSet {
            last: FinalDefinition::Deepest,
            runs,
            ..MeasurementSet::new(
                "s",
                Kind::Trajectory,
                Bed::new(Geometry::Spatial, None, 9.81),
                conditions,
            )
        }
    }

    /// Two conditions that differ as `change` says.
    fn pair(change: fn(&mut Condition)) -> MeasurementSet {
        let mut other = condition();
        change(&mut other);
        set(vec![condition(), other], Vec::new())
    }

    #[test]
    fn a_need_is_met_by_conditions_that_differ_in_it_and_by_no_others() {
        let alike = pair(|_| {});
        let met: [(Needs, MeasurementSet); 11] = [
            (Needs::Oblique, pair(|one| one.angle_deg = 60.0)),
            (Needs::Spin, pair(|one| one.spin = -5.0)),
            (Needs::Packings, {
                let mut both = pair(|one| one.packing = Some(0.6));
                both.conditions[0].packing = Some(0.58);
                both
            }),
            (Needs::BedDepth, pair(|one| one.bed_depth = Some(0.1))),
            (Needs::BedDepths, {
                let mut both = pair(|one| one.bed_depth = Some(0.2));
                both.conditions[0].bed_depth = Some(0.1);
                both
            }),
            (Needs::Speeds, pair(|one| one.speed = 3.0)),
            (Needs::Masses, pair(|one| one.mass = 0.06)),
            (Needs::Diameters, pair(|one| one.diameter = 0.03)),
            (Needs::Shapes, pair(|one| one.shape = "hemisphere".into())),
            (Needs::Shapes, pair(|one| one.height = Some(0.02))),
            (Needs::SpinBothWays, {
                let mut both = pair(|one| one.spin = -5.0);
                both.conditions[0].spin = 5.0;
                both
            }),
        ];
        for (need, differs) in met {
            assert!(contains(&differs, need), "{need:?}");
            assert!(!contains(&alike, need), "{need:?}");
        }
        assert!(!contains(&pair(|one| one.speed = 2.9), Needs::Speeds));
        assert!(!contains(&pair(|one| one.spin = 5.0), Needs::SpinBothWays));
    }

    #[test]
    fn one_oblique_angle_is_not_two_and_a_vertical_one_is_not_oblique() {
        let one = pair(|other| other.angle_deg = 60.0);
        assert!(contains(&one, Needs::Vertical) && !contains(&one, Needs::ObliqueAngles));
        let mut two = one;
        two.conditions[0].angle_deg = 30.0;
        assert!(contains(&two, Needs::ObliqueAngles) && !contains(&two, Needs::Vertical));
    }

    #[test]
    fn depths_are_those_of_the_runs_in_diameters() {
        let at = |depth| set(vec![condition()], vec![run(0, Some(depth), &[])]);
        assert!(contains(&at(0.04), Needs::Depths) && !contains(&at(0.04), Needs::Shallow));
        assert!(contains(&at(0.039), Needs::Shallow) && !contains(&at(0.039), Needs::Depths));
        let followed = run(0, None, &[(0.0, 0.0), (0.02, 0.041), (0.04, 0.04)]);
        assert!(contains(&set(vec![condition()], vec![followed]), Needs::Depths));
    }

    #[test]
    fn frames_before_impact_are_those_at_negative_times() {
        let with = |frames: &[(f64, f64)]| set(vec![condition()], vec![run(0, None, frames)]);
        assert!(!contains(&with(&[(0.0, 0.0), (0.01, 0.01)]), Needs::FramesBeforeImpact));
        assert!(contains(&with(&[(-0.01, -0.01), (0.0, 0.0)]), Needs::FramesBeforeImpact));
    }

    #[test]
    fn a_condition_that_is_held_out_shows_nothing() {
        let mut held_out = pair(|one| one.spin = 5.0);
        assert!(contains(&held_out, Needs::Conditions));
        held_out.conditions[1].role = Role::Holdout;
        for need in [Needs::Spin, Needs::Conditions] {
            assert!(!contains(&held_out, need), "{need:?}");
        }
    }
}
