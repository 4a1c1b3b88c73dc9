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

/// What a condition has that a force error may depend on.
pub(crate) const OF_CONDITIONS: [OfCondition; 7] = [
    (covariate("speed", "impact speed", "m/s"), |condition| Some(condition.speed)),
    (covariate("angle_deg", "angle from the horizontal", "deg"), |condition| {
        Some(condition.angle_deg)
    }),
    (covariate("diameter", "diameter", "m"), |condition| Some(condition.diameter)),
    (covariate("mass", "mass", "kg"), |condition| Some(condition.mass)),
    (covariate("spin", "spin", "rad/s"), |condition| Some(condition.spin)),
    (covariate("packing", "packing fraction", "1"), |condition| condition.packing),
    (covariate("bed_depth", "depth of the bed", "m"), |condition| condition.bed_depth),
];

const fn covariate(name: &'static str, heading: &'static str, unit: &'static str) -> Covariate {
    Covariate { name, heading, unit }
}

/// The covariate called `name`.
#[must_use]
pub fn named(name: &str) -> Option<Covariate> {
    let of_conditions = OF_CONDITIONS.map(|(covariate, _)| covariate);
    let mut all = of_conditions.into_iter().chain([DEPTH, ORDER, PREVIOUS_RUN]);
    all.find(|covariate| covariate.name == name)
}
