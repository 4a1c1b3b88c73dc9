//! Acceleration over time, as an accelerometer in the body reads it.

use engine::units::Dimension;

use crate::Kind;
use crate::curves::accelerometers;
use crate::curves::curve::{Along, Axis, Curve};
use crate::curves::over_time;
use crate::table::columns::ColumnSpec;

static OF_MANY: [ColumnSpec; 4] =
    over_time::columns("acceleration", "sigma_acceleration", Dimension::ACCELERATION, true);
static OF_ONE: [ColumnSpec; 4] =
    over_time::columns("acceleration", "sigma_acceleration", Dimension::ACCELERATION, false);

/// The line of the kind.
pub(crate) static CURVE: Curve = Curve {
    kind: Kind::Acceleration,
    word: "acceleration",
    plural: "accelerations over time",
    function: "a(t)",
    along: Along::Time,
    value: Axis { name: "acceleration", unit: "m/s²", scale: 1.0 },
    files: "accelerations",
    columns: [&OF_MANY, &OF_ONE],
    sigma_key: "acceleration_sigma_m_s2",
    sigma: |instrument| instrument.acceleration_sigma,
    lacks_speed: "a set of accelerations has to state it",
    shown_speed: |_, _, _| None,
    check: accelerometers::check,
};
