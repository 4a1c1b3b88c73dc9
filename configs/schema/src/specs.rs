//! The numeric keys of the fixed tables, specified like the parameters of a law.

use std::f64::consts::{FRAC_PI_2, PI};

use engine::bed::inflation_range;
use engine::grains::Space;
use engine::params::{ParamSpec, Range};
use engine::units::Dimension;

const fn required(
    key: &'static str,
    dimension: Dimension,
    allowed: Range,
    plausible: Range,
    meaning: &'static str,
) -> ParamSpec {
    ParamSpec::required(key, dimension, meaning).allowed(allowed).plausible(plausible)
}

const POSITIVE: Range = Range::POSITIVE;
const NOT_NEGATIVE: Range = Range::NOT_NEGATIVE;
const ANY: Range = Range::closed(-f64::MAX, f64::MAX);
const NUMBER: Dimension = Dimension::NONE;
const LENGTH: Dimension = Dimension::LENGTH;

pub(crate) const DURATION: ParamSpec = required(
    "duration",
    Dimension::TIME,
    POSITIVE,
    Range::closed(1e-4, 100.0),
    "the longest simulated time",
);

pub(crate) const TIME_STEP: ParamSpec = required(
    "time_step",
    Dimension::TIME,
    POSITIVE,
    Range::closed(1e-9, 1e-3),
    "the time between two steps of an impact",
);

pub(crate) const PREPARATION_TIME_STEP: ParamSpec =
    TIME_STEP.named("preparation_time_step", "the time step while settling");

pub(crate) const TIME_STEP_FACTOR: ParamSpec = required(
    "time_step_factor",
    NUMBER,
    POSITIVE,
    Range::closed(1e-3, 10.0),
    "a factor on the time step",
)
.or(1.0);

pub(crate) const FRAMES_PER_S: ParamSpec = required(
    "frames_per_s",
    NUMBER,
    POSITIVE,
    Range::closed(1.0, 1e5),
    "the frames of all grains per simulated second",
)
.or(200.0);

pub(crate) const FIELDS_AT: ParamSpec = required(
    "fields_at",
    Dimension::TIME,
    NOT_NEGATIVE,
    Range::closed(0.0, 100.0),
    "when the velocity field and the crater are logged",
);

pub(crate) const ABORT_ABOVE: ParamSpec = required(
    "abort_above",
    NUMBER,
    POSITIVE,
    Range::closed(1e-9, 1.0),
    "the energy unaccounted for, over that of the impact, that ends a run",
)
.or(0.05);

pub(crate) const GRAVITY: ParamSpec = required(
    "gravity",
    Dimension::ACCELERATION,
    NOT_NEGATIVE,
    Range::closed(0.1, 300.0),
    "the magnitude of gravity, downward",
);

pub(crate) const GRAIN_INERTIA: ParamSpec = required(
    "grain_inertia",
    NUMBER,
    Range { min: 0.0, max: 1.0, includes_min: false },
    Range::closed(0.3, 0.7),
    "the moment of inertia of a grain during the impact, over m r²",
);

pub(crate) const WIDTH: ParamSpec =
    required("width", LENGTH, POSITIVE, Range::closed(1e-3, 100.0), "the inner width of the box");

pub(crate) const DEPTH: ParamSpec = WIDTH.named("depth", "the inner depth of the box, along y");

pub(crate) const CONTAINER_DIAMETER: ParamSpec =
    WIDTH.named("diameter", "the inner diameter of the cylinder");

pub(crate) const ABSORBING_THICKNESS: ParamSpec = required(
    "absorbing_thickness",
    LENGTH,
    POSITIVE,
    Range::closed(1e-4, 10.0),
    "the thickness of the layers that absorb",
);

pub(crate) const ABSORBING_RATE: ParamSpec = required(
    "absorbing_rate",
    Dimension::RATE,
    NOT_NEGATIVE,
    Range::closed(1.0, 1e7),
    "the rate of the drag at the wall of a layer that absorbs",
);

pub(crate) const PREPARATION_FRICTION: ParamSpec = required(
    "preparation_friction",
    NUMBER,
    NOT_NEGATIVE,
    Range::closed(0.0, 1.5),
    "the friction of grains while settling, in place of the law's",
);

pub(crate) const SETTLING_DRAG: ParamSpec = required(
    "settling_drag",
    Dimension::RATE,
    NOT_NEGATIVE,
    Range::closed(0.0, 200.0),
    "the rate at which velocities and spins of grains decay while they fall and settle",
);

pub(crate) fn inflated_to(space: Space) -> ParamSpec {
    let (min, max) = inflation_range(space);
    required(
        "inflated_to",
        NUMBER,
        Range { min, max, includes_min: false },
        Range::closed(min, max),
        "the packing fraction up to which grains grow in place before they fall",
    )
}

pub(crate) const TARGET_PACKING_FRACTION: ParamSpec = required(
    "target_packing_fraction",
    NUMBER,
    Range { min: 0.0, max: 1.0, includes_min: false },
    Range::closed(0.5, 0.92),
    "the packing fraction that the bed should come near to",
);

pub(crate) const TARGET_HEIGHT: ParamSpec = required(
    "target_height",
    LENGTH,
    POSITIVE,
    Range::closed(1e-3, 100.0),
    "the height that the bed should come near to",
);

pub(crate) const GRAIN_DIAMETER: ParamSpec =
    required("diameter", LENGTH, POSITIVE, Range::closed(1e-5, 0.1), "the diameter of one grain");

pub(crate) const GRAIN_DIAMETER_MIN: ParamSpec =
    GRAIN_DIAMETER.named("diameter_min", "the smallest diameter");

pub(crate) const GRAIN_DIAMETER_MAX: ParamSpec =
    GRAIN_DIAMETER.named("diameter_max", "the largest diameter");

pub(crate) const GRAIN_DIAMETER_MEDIAN: ParamSpec =
    GRAIN_DIAMETER.named("diameter_median", "the median diameter");

pub(crate) const GRAIN_DIAMETER_SIGMA: ParamSpec = required(
    "diameter_sigma",
    NUMBER,
    Range { min: 0.0, max: 3.0, includes_min: false },
    Range::closed(0.01, 1.0),
    "the standard deviation of the logarithm of the diameter",
);

pub(crate) const GRAIN_DIAMETERS: ParamSpec = GRAIN_DIAMETER.named("diameters", "the diameters");

pub(crate) const GRAIN_WEIGHTS: ParamSpec = required(
    "weights",
    NUMBER,
    Range::closed(0.0, 1e12),
    Range::closed(0.0, 1e12),
    "the share by number of each diameter, in any unit",
);

pub(crate) const GRAIN_MASS: ParamSpec =
    required("mass", Dimension::MASS, POSITIVE, Range::closed(1e-12, 1.0), "the mass of one grain");

pub(crate) const INTRUDER_MASS: ParamSpec = required(
    "mass",
    Dimension::MASS,
    POSITIVE,
    Range::closed(1e-6, 1e3),
    "the mass of the intruder",
);

pub(crate) const AREA_DENSITY: ParamSpec = required(
    "density",
    Dimension::AREA_DENSITY,
    POSITIVE,
    Range::closed(1e-2, 1e4),
    "mass per area of the plane",
);

pub(crate) const DENSITY: ParamSpec =
    required("density", Dimension::DENSITY, POSITIVE, Range::closed(10.0, 3e4), "mass per volume");

pub(crate) const BULK_DENSITY: ParamSpec = required(
    "bulk_density",
    Dimension::DENSITY,
    POSITIVE,
    Range::closed(10.0, 1e4),
    "the mass of the bed per volume, voids included",
);

pub(crate) const BULK_AREA_DENSITY: ParamSpec = required(
    "bulk_density",
    Dimension::AREA_DENSITY,
    POSITIVE,
    Range::closed(1e-2, 1e3),
    "the mass of the bed per area of the plane, voids included",
);

pub(crate) const PACKING: ParamSpec = required(
    "packing",
    NUMBER,
    Range { min: 0.0, max: 1.0, includes_min: false },
    Range::closed(0.4, 0.92),
    "the packing fraction of the bed",
);

pub(crate) const BED_DEPTH: ParamSpec =
    required("bed_depth", LENGTH, POSITIVE, Range::closed(1e-3, 100.0), "the depth of the bed");

pub(crate) const FLUID_DENSITY: ParamSpec = required(
    "fluid_density",
    Dimension::DENSITY,
    POSITIVE,
    Range::closed(0.1, 2e3),
    "the density of the fluid in the bed and above it",
);

pub(crate) const FLUID_VISCOSITY: ParamSpec = required(
    "fluid_viscosity",
    Dimension::VISCOSITY,
    POSITIVE,
    Range::closed(1e-6, 10.0),
    "the viscosity of the fluid in the bed and above it",
);

pub(crate) const LOG_INTERVAL: ParamSpec = required(
    "interval",
    Dimension::TIME,
    POSITIVE,
    Range::closed(1e-6, 0.1),
    "the time between two samples of the log",
)
.or(1e-4);

pub(crate) const SPEED: ParamSpec = required(
    "speed",
    Dimension::SPEED,
    NOT_NEGATIVE,
    Range::closed(0.0, 100.0),
    "the speed at first contact",
);

pub(crate) const ANGLE: ParamSpec = required(
    "angle",
    Dimension::ANGLE,
    Range { min: 0.0, max: FRAC_PI_2, includes_min: false },
    Range::closed(PI / 180.0, FRAC_PI_2),
    "the angle of the velocity below the horizontal; 90 deg is straight down",
);

pub(crate) const INTRUSION_SPEED: ParamSpec = ParamSpec {
    meaning: "the speed at which a drive pushes the intruder",
    allowed: POSITIVE,
    plausible: Range::closed(1e-4, 10.0),
    ..SPEED
};

pub(crate) const INTRUSION_ANGLE: ParamSpec = ParamSpec {
    meaning: "the angle of the way of the intruder below the horizontal; 90 deg is straight down",
    ..ANGLE
}
.or(FRAC_PI_2);

pub(crate) const INTRUSION_DEPTH: ParamSpec = required(
    "depth",
    LENGTH,
    POSITIVE,
    Range::closed(1e-4, 10.0),
    "the depth of the lowest point at which the drive stops",
);

pub(crate) const SPIN: ParamSpec = required(
    "spin",
    Dimension::SPIN,
    ANY,
    Range::closed(-1e4, 1e4),
    "the angular velocity at first contact, counter-clockwise positive",
)
.or(0.0);

/// One component of it.
pub(crate) const SPIN_VECTOR: ParamSpec =
    ParamSpec { meaning: "the angular velocity at first contact, a vector with z up", ..SPIN };

pub(crate) const ATTITUDE: ParamSpec = required(
    "attitude",
    Dimension::ANGLE,
    Range::closed(-PI, PI),
    Range::closed(-PI, PI),
    "the angle of the intruder's axis to the vertical; its top leans towards +x",
)
.or(0.0);

pub(crate) const X: ParamSpec = required(
    "x",
    LENGTH,
    POSITIVE,
    Range::POSITIVE,
    "where the intruder's centre starts, from the left side",
);

pub(crate) const Y: ParamSpec =
    X.named("y", "where the intruder's centre starts, from the front side");

pub(crate) const X_RANGE: ParamSpec = X.named("x_range", "where drawn positions lie");

pub(crate) const POSITION: ParamSpec =
    ParamSpec { key: "position", allowed: ANY, plausible: ANY, ..X };
