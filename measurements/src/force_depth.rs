//! Force over depth of a body that is pushed at a stated speed: plates, penetrometers, bevameters.

use engine::units::Dimension;

use super::Kind;
use super::columns::{ColumnSpec, Content, column};
use super::curve::{Axis, Curve};

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
pub(super) static CURVE: Curve = Curve {
    kind: Kind::ForceDepth,
    word: "force-depth",
    plural: "forces over depth",
    function: "force(z)",
    along: Axis { name: "depth", unit: "mm", scale: 1e3 },
    value: Axis { name: "force", unit: "N", scale: 1.0 },
    files: "forces",
    columns: [&OF_MANY, &OF_ONE],
    sigma_key: "force_sigma_N",
    sigma: |instrument| instrument.force_sigma,
};
