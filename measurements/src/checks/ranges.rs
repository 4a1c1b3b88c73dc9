//! Magnitudes that no laboratory has: a number beyond them is a mistake of its unit or of its typing, and no fit is
//! begun on it. Numbers that are merely odd are warned of elsewhere (`magnitudes`).

use configs::{Diagnostic, shorten};

use crate::document::conditions::ConditionPlaces;
use crate::table::findings::Findings;
use crate::{Condition, Frame, MeasurementSet, Run, Sample};

/// A kind of number with the sizes that it may have.
struct Kind {
    name: &'static str,
    unit: &'static str,
    /// Least size of a number that is not 0, and greatest size.
    sizes: [f64; 2],
}

const fn kind(name: &'static str, unit: &'static str, sizes: [f64; 2]) -> Kind {
    Kind { name, unit, sizes }
}

/// From a micrometre, which no camera resolves, to a kilometre.
const LENGTHS: [f64; 2] = [1e-6, 1e3];
const DEPTH: Kind = kind("final depth", "m", LENGTHS);
const RANGE: Kind = kind("final range", "m", LENGTHS);
const STOPPING_TIME: Kind = kind("stopping time", "s", [1e-6, 1e3]);
// A reading is a position less the zero of a camera: it may be as small as rounding leaves it.
const READING: Kind = kind("position", "m", [0.0, 1e3]);
/// Of a curve, whatever it reads.
const VALUE: Kind = kind("reading", "in SI units", [0.0, 1e12]);
const TIME: Kind = kind("time", "s", [0.0, 1e3]);
/// Faster than any gun shoots.
const SPEED: Kind = kind("speed", "m/s", [1e-6, 1e4]);
const DIAMETER: Kind = kind("diameter", "m", LENGTHS);
const MASS: Kind = kind("mass", "kg", [1e-12, 1e9]);
const SPIN: Kind = kind("spin", "rad/s", [0.0, 1e7]);
const CRATER: Kind = kind("size of a crater", "m", LENGTHS);
const SIZE: Kind = kind("size", "m", LENGTHS);
const BED_DEPTH: Kind = kind("depth of a bed", "m", [1e-6, 1e5]);
/// From the surface of a small asteroid to a fast centrifuge.
const GRAVITY: Kind = kind("gravity", "m/s^2", [1e-6, 1e5]);
const DENSITY: Kind = kind("bulk density", "kg/m^3 or kg/m^2", [1e-6, 1e6]);
const GRAIN: Kind = kind("diameter of grains", "m", [1e-9, 1e3]);
const READING_ERROR: Kind = kind("error of a position", "m", [1e-12, 10.0]);
const RATE: Kind = kind("rate of frames", "1/s", [1e-3, 1e10]);
/// Relative to the number: from more digits than anything is read to, to a factor of ten.
const SHARE: Kind = kind("relative error", "of the number", [1e-6, 10.0]);

impl Kind {
    fn refuses(&self, value: f64) -> bool {
        let [least, most] = self.sizes;
        let size = value.abs();
        size > most || size > 0.0 && size < least
    }

    fn error(&self, whose: &str, value: f64) -> Diagnostic {
        let Self { name, unit, sizes: [least, most] } = self;
        let from = if *least > 0.0 { format!("0, or {least:e}") } else { "0".to_owned() };
        Diagnostic::error(format!("{whose}: the {name} of {value:e} {unit} cannot be meant"))
            .help(format!("its size is {from} to {most:e} {unit}; compare it with the others, and with its unit"))
    }
}

/// Refuses what no laboratory has; the first number of each run, condition or table is told.
pub(crate) fn check(set: &MeasurementSet, places: &[ConditionPlaces], findings: &mut Findings) {
    if set.all_beds().any(|bed| bed.gravity == 0.0) {
        let message =
            "[bed]: without gravity a bed has no weight, and no friction that grows with depth";
        let help =
            "write the gravity at the bed in m/s^2, such as 9.81, or 1e-3 in a parabolic flight";
        findings.report(Diagnostic::error(message).help(help));
    }
    if let Some((kind, value)) = first_refused(of_set(set)) {
        findings.report(kind.error("the set", value));
    }
    for (condition, place) in set.conditions.iter().zip(places) {
        let refused = first_refused(of_condition(condition)).filter(|_| !findings.full());
        if let Some((kind, value)) = refused {
            let whose = format!("the condition `{}`", shorten(&condition.id));
            findings.report(kind.error(&whose, value).at(place.id, "this one"));
        }
    }
    for run in &set.runs {
        if findings.full() {
            break;
        }
        if let Some((kind, value)) = first_refused(of_run(run)) {
            let whose = format!("the run `{}`", shorten(&run.name));
            let place = places[run.condition].id;
            findings.report(kind.error(&whose, value).at(place, "measured under this condition"));
        }
    }
}

type Number = (&'static Kind, f64);

fn first_refused(mut numbers: impl Iterator<Item = Number>) -> Option<Number> {
    numbers.find(|(kind, value)| kind.refuses(*value))
}

fn of_set(set: &MeasurementSet) -> impl Iterator<Item = Number> {
    let (instrument, stated) = (&set.instrument, &set.stated);
    let numbers = [
        (&RATE, instrument.rate),
        (&READING_ERROR, instrument.position_sigma),
        (&VALUE, instrument.force_sigma),
        (&READING_ERROR, instrument.level_sigma),
        (&READING_ERROR, instrument.zero_sigma),
        (&READING_ERROR, instrument.surface_sigma),
        (&SHARE, instrument.speed_bias_sigma_rel),
        (&SHARE, instrument.scale_sigma_rel),
        (&SHARE, instrument.mass_sigma_rel),
        (&SHARE, instrument.session_sigma_rel),
        (&SHARE, instrument.speed_sigma_rel),
        (&SHARE, stated.stop_time),
        (&SHARE, stated.final_z),
        (&SHARE, stated.final_x),
    ];
    let of_beds = set.all_beds().flat_map(|bed| {
        [
            (&GRAVITY, Some(bed.gravity)),
            (&DENSITY, bed.bulk_density),
            (&GRAIN, bed.grain_diameter),
            (&SIZE, bed.stated.surface_height),
        ]
    });
    of_beds.chain(numbers).filter_map(|(kind, value)| Some((kind, value?)))
}

fn of_condition(condition: &Condition) -> impl Iterator<Item = Number> {
    let numbers = [
        (&SPEED, Some(condition.speed)),
        (&DIAMETER, Some(condition.diameter)),
        (&MASS, Some(condition.mass)),
        (&SPIN, Some(condition.spin)),
        (&BED_DEPTH, condition.bed_depth),
        (&SIZE, condition.length),
        (&SIZE, condition.height),
        (&SIZE, condition.shaft_diameter),
    ];
    numbers.into_iter().filter_map(|(kind, value)| Some((kind, value?)))
}

fn of_run(run: &Run) -> impl Iterator<Item = Number> {
    let scalars = [
        (&DEPTH, run.final_z),
        (&RANGE, run.final_x),
        (&STOPPING_TIME, run.stop_time),
        (&CRATER, run.crater.depth),
        (&CRATER, run.crater.rim_diameter),
    ];
    let scalars = scalars.into_iter().filter_map(|(kind, value)| Some((kind, value?)));
    let reading = |frame: &Frame| [(&TIME, frame.t), (&READING, frame.z), (&READING, frame.x)];
    let sample = |sample: &Sample| [(&READING, sample.at), (&VALUE, sample.value)];
    scalars.chain(run.frames.iter().flat_map(reading)).chain(run.samples.iter().flat_map(sample))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::TEMPLATE;

    /// What is refused of the template, changed.
    fn faults(change: impl Fn(&mut MeasurementSet)) -> Vec<String> {
        let folder = tempfile::tempdir().expect("a folder for the test");
        for (name, text) in TEMPLATE {
            std::fs::write(folder.path().join(name), text).expect("a file");
        }
        let mut set = MeasurementSet::load(folder.path()).expect("a set").set;
        change(&mut set);
        let mut findings = Findings::default();
        let places = vec![ConditionPlaces::default(); set.conditions.len()];
        check(&set, &places, &mut findings);
        findings.diagnostics.iter().map(|one| one.message.clone()).collect()
    }

    #[test]
    fn numbers_that_no_laboratory_has_are_refused_with_what_would_be_one() {
        assert!(faults(|_| ()).is_empty());
        for depth in [1e-10, 1e307, -1e4, 5e-324] {
            let found = faults(|set| set.runs[0].final_z = Some(depth));
            assert!(found.len() == 1 && found[0].contains("the run `"), "{depth}: {found:?}");
        }
        assert_eq!(faults(|set| set.runs[0].final_z = Some(0.0)).len(), 0, "nothing sank in");
        assert_eq!(faults(|set| set.runs[0].stop_time = Some(1e307)).len(), 1);
        assert_eq!(faults(|set| set.conditions[0].speed = 1e6).len(), 1);
        for gravity in [0.0, 1e10] {
            assert_eq!(faults(|set| set.bed.gravity = gravity).len(), 1, "{gravity}");
        }
        assert_eq!(faults(|set| set.stated.stop_time = Some(1e307)).len(), 1);
    }
}
