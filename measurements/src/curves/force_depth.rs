//! Force over depth of a body that is pushed at a stated speed: plates, penetrometers, bevameters.

use engine::units::Dimension;

use crate::Kind;
use crate::curves::curve::{Along, Axis, Curve};
use crate::curves::pushes;
use crate::table::columns::{ColumnSpec, Content, column};

const fn columns(run: bool) -> [ColumnSpec; 4] {
    [
        column("run", Content::Name, run),
        column("z", Content::Quantity(Dimension::LENGTH), true),
        column("force", Content::Quantity(Dimension::FORCE), true),
        column("sigma_force", Content::Quantity(Dimension::FORCE), false),
    ]
}

static OF_MANY: [ColumnSpec; 4] = columns(true);
static OF_ONE: [ColumnSpec; 4] = columns(false);

/// The line of the kind.
pub(crate) static CURVE: Curve = Curve {
    kind: Kind::ForceDepth,
    word: "force-depth",
    plural: "forces over depth",
    function: "force(z)",
    along: Along::Depth,
    value: Axis { name: "force", unit: "N", scale: 1.0 },
    files: "forces",
    columns: [&OF_MANY, &OF_ONE],
    sigma_key: "force_sigma_N",
    sigma: |instrument| instrument.force_sigma,
    lacks_speed: "a set of forces over depth has to state it: the speed of the push",
    shown_speed: |_, _, _| None,
    check: pushes::check,
};
