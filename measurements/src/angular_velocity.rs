//! Angular velocity over time, as a gyroscope in the body or marks on it show it.

use configs::Diagnostic;
use engine::units::Dimension;

use super::columns::{ColumnSpec, Content, column};
use super::conditions::ConditionPlaces;
use super::contradiction::{Contradiction, ContradictionKind};
use super::curve::{Along, Axis, Curve};
use super::findings::Findings;
use super::{Kind, MeasurementSet, Run, over_time};

const fn columns(run: bool) -> [ColumnSpec; 4] {
    [
        column("run", Content::Name, run),
        column("t", Content::Quantity(Dimension::TIME), true),
        column("spin", Content::Quantity(Dimension::SPIN), true),
        column("sigma_spin", Content::Quantity(Dimension::SPIN), false),
    ]
}

static OF_MANY: [ColumnSpec; 4] = columns(true);
static OF_ONE: [ColumnSpec; 4] = columns(false);

/// The line of the kind.
pub(super) static CURVE: Curve = Curve {
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
    places: &[ConditionPlaces],
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
    let mut ratios: Vec<(f64, usize)> =
        set.runs.iter().map(|run| (ratio(run), run.condition)).collect();
    ratios.sort_by(|a, b| a.0.total_cmp(&b.0));
    let middle = ratios.get(ratios.len() / 2).filter(|(ratio, _)| *ratio > MOST);
    let named = middle.map(|&(ratio, condition)| {
        let message = format!(
            "the surface of the body turns {ratio:.1} times as fast as its impact can make it"
        );
        let diagnostic = Diagnostic::error(message)
            .at(places[condition].speed, "the stated speed")
            .help("are the spins in deg/s or rpm? [columns] gives the units of a table");
        Contradiction { kind: ContradictionKind::Speeds, diagnostic }
    });
    named.into_iter().collect()
}
