//! `[feasible]`: which conditions the laboratory could measure next.

use configs::Diagnostic;
use configs::reader::{Found, TableReader};
use engine::params::ParamSpec;

use crate::keys;

/// Limits of the next experiment; what is empty is not limited by the set's author.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Feasible {
    /// Least and greatest impact speed (m/s).
    pub speed: Option<[f64; 2]>,
    /// Angles of the velocity below the horizontal (deg).
    pub angle_deg: Vec<f64>,
    /// Masses of intruders (kg).
    pub mass: Vec<f64>,
    /// Diameters of intruders (m).
    pub diameter: Vec<f64>,
    /// Angular velocities (rad/s), positive when it rolls forward.
    pub spin: Vec<f64>,
    /// Packing fractions of the bed.
    pub packing: Vec<f64>,
    /// Depths of the bed (m).
    pub bed_depth: Vec<f64>,
    /// What measuring costs, if that is to be weighed.
    pub cost: Option<Cost>,
}

/// What measuring costs, in any one unit, such as hours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// Of a run.
    pub run: f64,
    /// Of a condition, besides its runs.
    pub condition: f64,
    /// Of a body that is not there yet.
    pub body: f64,
    /// Of a bed in a packing or of a depth that has not been made yet.
    pub bed: f64,
}

impl Cost {
    /// Reads the table; faults are reported.
    fn read(table: TableReader<'_>) -> Option<Self> {
        let number = |spec: &ParamSpec| table.number(spec).map(|found| found.value);
        let cost =
            [keys::COST_OF_RUN, keys::COST_OF_CONDITION, keys::COST_OF_BODY, keys::COST_OF_BED]
                .map(|spec| number(&spec));
        table.finish();
        let [Some(run), Some(condition), Some(body), Some(bed)] = cost else { return None };
        Some(Self { run, condition, body, bed })
    }

    /// The values with their keys.
    pub(crate) fn entries(&self) -> [(&'static str, f64); 4] {
        [
            (keys::COST_OF_RUN.key, self.run),
            (keys::COST_OF_CONDITION.key, self.condition),
            (keys::COST_OF_BODY.key, self.body),
            (keys::COST_OF_BED.key, self.bed),
        ]
    }
}

impl Feasible {
    /// The lists with their keys, in the order of the format.
    pub(crate) fn lists(&self) -> [(&'static str, &[f64]); 6] {
        [
            (keys::ANGLE.key, &self.angle_deg),
            (keys::MASS.key, &self.mass),
            (keys::DIAMETER.key, &self.diameter),
            (keys::SPIN.key, &self.spin),
            (keys::PACKING.key, &self.packing),
            (keys::BED_DEPTH.key, &self.bed_depth),
        ]
    }

    /// Reads the table; faults are reported.
    pub(crate) fn read(table: TableReader<'_>) -> Self {
        let list = |spec: &ParamSpec| numbers(&table, spec).unwrap_or_default();
        let feasible = Self {
            speed: speed(&table),
            angle_deg: list(&keys::ANGLE),
            mass: list(&keys::MASS),
            diameter: list(&keys::DIAMETER),
            spin: list(&keys::SPIN),
            packing: list(&keys::PACKING),
            bed_depth: list(&keys::BED_DEPTH),
            cost: {
                let is_stated = table.has("cost");
                Cost::read(table.table("cost", None)).filter(|_| is_stated)
            },
        };
        table.finish();
        feasible
    }
}

fn numbers(table: &TableReader<'_>, spec: &ParamSpec) -> Option<Vec<f64>> {
    let found: Vec<Found<f64>> = table.numbers(spec)??;
    Some(found.into_iter().map(|one| one.value).collect())
}

/// Two speeds above zero, the smaller one first.
fn speed(table: &TableReader<'_>) -> Option<[f64; 2]> {
    let values = numbers(table, &keys::SPEED)?;
    match values[..] {
        [from, to] if 0.0 < from && from <= to => Some([from, to]),
        _ => {
            table.reader.report(
                Diagnostic::error("`speed` is not a range")
                    .at(table.span_of("speed"), "expected the least and the greatest speed")
                    .help("both above 0, the smaller one first: speed = [0.5, 3.0]"),
            );
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MeasurementSet, TEMPLATE};

    #[test]
    fn limits_survive_an_export_and_their_absence_does_too() {
        let template = tempfile::tempdir().expect("a folder for the test");
        for (name, text) in TEMPLATE {
            std::fs::write(template.path().join(name), text).expect("a file");
        }
        let mut set = MeasurementSet::load(template.path()).expect("a set").set;
        let some = Feasible {
            speed: Some([0.1, 0.3]),
            angle_deg: vec![90.0, 35.0],
            spin: vec![-100.0, 0.0],
            bed_depth: vec![0.3],
            cost: Some(Cost { run: 0.25, condition: 1.0, body: 8.0, bed: 0.5 }),
            ..Feasible::default()
        };
        for feasible in [some, Feasible::default()] {
            set.feasible = feasible;
            let folder = tempfile::tempdir().expect("a folder for the test");
            set.write(folder.path()).expect("a writable folder");
            let read = MeasurementSet::load(folder.path()).expect("what was written is a set");
            assert_eq!(read.set.feasible, set.feasible);
        }
    }
}
