//! Angular velocity over time, as a gyroscope in the body or marks on it show it.

use engine::units::Dimension;

use crate::contradiction::Contradiction;
use crate::curves::curve::{Along, Axis, Curve, Written};
use crate::curves::over_time;
use crate::table::columns::ColumnSpec;
use crate::table::findings::Findings;
use crate::{Kind, MeasurementSet, Run};

static OF_MANY: [ColumnSpec; 4] = over_time::columns("spin", "sigma_spin", Dimension::SPIN, true);
static OF_ONE: [ColumnSpec; 4] = over_time::columns("spin", "sigma_spin", Dimension::SPIN, false);

/// The line of the kind.
pub(crate) static CURVE: Curve = Curve {
    kind: Kind::Spin,
    word: "spin",
    plural: "spins over time",
    function: "spin(t)",
    along: Along::Time,
    value: Axis { name: "spin", unit: "rad/s", scale: 1.0 },
    files: "spins",
    columns: [&OF_MANY, &OF_ONE],
    sigma_key: "spin_sigma_rad_s",
    sigma: |instrument| instrument.spin_sigma,
    lacks_speed: "a set of spins has to state it",
    shown_speed: |_, _, _| None,
    check,
};

/// Speed of the surface of a body over what its impact can give it, beyond which a unit is wrong.
const MOST: f64 = 5.0;

fn check(
    set: &MeasurementSet,
    (places, _): Written<'_>,
    findings: &mut Findings,
) -> Vec<Contradiction> {
    over_time::check_times(set, places, findings);
    if findings.errors() > 0 {
        return Vec::new();
    }
    let ratio = |run: &Run| {
        let condition = &set.conditions[run.condition];
        // Of a slender body that turns about one of its ends, its length.
        let radius = condition.length.unwrap_or(0.5 * condition.diameter);
        let fastest = run.samples.iter().map(|one| one.value.abs()).fold(0.0, f64::max);
        let possible =
            condition.speed + radius * condition.spin.abs() + (set.gravity_of(run) * radius).sqrt();
        radius * fastest / possible
    };
    let told = |ratio| {
        format!("the surface of the body turns {ratio:.1} times as fast as its impact can make it")
    };
    let help = "are the spins in deg/s or rpm?";
    over_time::check_unit(set, places, (MOST, ratio), (told, help)).into_iter().collect()
}
