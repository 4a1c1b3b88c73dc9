//! What may differ between conditions, depths or runs, and an error may hang on.

use measurements::Condition;

/// Depth, whose values lie along a path.
pub(crate) const DEPTH: Covariate = Covariate { name: "z", heading: "depth", unit: "m" };

/// Place of a run in time among all runs.
pub(crate) const ORDER: Covariate =
    Covariate { name: "order", heading: "order of the runs", unit: "1" };

/// The force error of the run before, under the same condition.
pub(crate) const PREVIOUS_RUN: Covariate =
    Covariate { name: "previous_run", heading: "force error of the previous run", unit: "1" };

/// A quantity that an error may depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Covariate {
    /// As in tables and files: `speed`, `angle_deg`, `z`, …
    pub name: &'static str,
    /// In words.
    pub heading: &'static str,
    /// Unit of its values; 1 where it has none.
    pub unit: &'static str,
}

/// A covariate and what a condition has of it.
pub(crate) type OfCondition = (Covariate, fn(&Condition) -> Option<f64>);

/// Every number of a condition, which a force error may depend on where it differs.
pub(crate) const OF_CONDITIONS: [OfCondition; 12] = [
    (covariate("speed", "impact speed", "m/s"), |condition| Some(condition.speed)),
    (covariate("angle_deg", "angle from the horizontal", "deg"), |condition| {
        Some(condition.angle_deg)
    }),
    (covariate("diameter", "diameter", "m"), |condition| Some(condition.diameter)),
    (covariate("mass", "mass", "kg"), |condition| Some(condition.mass)),
    (covariate("spin", "spin", "rad/s"), |condition| Some(condition.spin)),
    (covariate("packing", "packing fraction", "1"), |condition| condition.packing),
    (covariate("bed_depth", "depth of the bed", "m"), |condition| condition.bed_depth),
    (covariate("height", "height", "m"), |condition| condition.height),
    (covariate("shaft_diameter", "diameter of the shaft", "m"), |condition| {
        condition.shaft_diameter
    }),
    (covariate("apex_deg", "apex angle", "deg"), |condition| condition.apex_deg),
    (covariate("length", "length", "m"), |condition| condition.length),
    (covariate("link_angle_deg", "angle of the link to the vertical", "deg"), |condition| {
        condition.link_angle_deg
    }),
];

const fn covariate(name: &'static str, heading: &'static str, unit: &'static str) -> Covariate {
    Covariate { name, heading, unit }
}

/// The covariate called `name`.
pub fn named(name: &str) -> Option<Covariate> {
    let of_conditions = OF_CONDITIONS.map(|(covariate, _)| covariate);
    let mut all = of_conditions.into_iter().chain([DEPTH, ORDER, PREVIOUS_RUN]);
    all.find(|covariate| covariate.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_sets::condition;

    #[test]
    fn every_number_of_a_condition_is_looked_at() {
        let set = condition(1.0, 2.0);
        let all = Condition {
            diameter: 3.0,
            mass: 4.0,
            spin: 5.0,
            packing: Some(6.0),
            bed_depth: Some(7.0),
            length: Some(8.0),
            height: Some(9.0),
            shaft_diameter: Some(12.0),
            apex_deg: Some(10.0),
            link_angle_deg: Some(11.0),
            ..set
        };
        // A field more does not compile here until it is looked at, or said why not.
        let Condition {
            id: _,
            role: _,
            shape: _,
            // A bed is a name, which no trend follows.
            bed: _,
            speed,
            angle_deg,
            diameter,
            mass,
            spin,
            packing,
            bed_depth,
            length,
            height,
            shaft_diameter,
            apex_deg,
            link_angle_deg,
        } = all.clone();
        let seen: Vec<Option<f64>> = OF_CONDITIONS.iter().map(|(_, of)| of(&all)).collect();
        let numbers = [speed, angle_deg, diameter, mass, spin].map(Some);
        let optional =
            [packing, bed_depth, length, height, shaft_diameter, apex_deg, link_angle_deg];
        for number in numbers.into_iter().chain(optional) {
            assert!(number.is_some() && seen.contains(&number), "{number:?} in {seen:?}");
        }
        assert_eq!(named("apex_deg").map(|one| one.unit), Some("deg"));
    }
}
