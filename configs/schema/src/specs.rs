//! The numeric keys of the fixed tables, specified like the parameters of a law.

use std::f64::consts::{FRAC_PI_2, PI};

use engine::bed::inflation_range;
use engine::grains::Space;
use engine::params::{Default, ParamSpec, Range};
use engine::units::Dimension;

const fn required(
    key: &'static str,
    dimension: Dimension,
    allowed: Range,
    plausible: Range,
    meaning: &'static str,
) -> ParamSpec {
    ParamSpec { key, dimension, default: Default::Required, allowed, plausible, meaning }
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

pub(crate) const TIME_STEP: ParamSpec =
    required("time_step", Dimension::TIME, POSITIVE, Range::closed(1e-9, 1e-3), "the time step");

pub(crate) const PREPARATION_TIME_STEP: ParamSpec = ParamSpec {
    key: "preparation_time_step",
    meaning: "the time step while settling",
    ..TIME_STEP
};

pub(crate) const TIME_STEP_FACTOR: ParamSpec = ParamSpec {
    default: Default::Value(1.0),
    ..required(
        "time_step_factor",
        NUMBER,
        POSITIVE,
        Range::closed(1e-3, 10.0),
        "a factor on the time step",
    )
};

pub(crate) const FRAMES_PER_S: ParamSpec = ParamSpec {
    default: Default::Value(200.0),
    ..required(
        "frames_per_s",
        NUMBER,
        POSITIVE,
        Range::closed(1.0, 1e5),
        "the frames of all grains per simulated second",
    )
};

pub(crate) const FIELDS_AT: ParamSpec = required(
    "fields_at",
    Dimension::TIME,
    NOT_NEGATIVE,
    Range::closed(0.0, 100.0),
    "when the velocity field and the crater are logged",
);

pub(crate) const ABORT_ABOVE: ParamSpec = ParamSpec {
    default: Default::Value(0.05),
    ..required(
        "abort_above",
        NUMBER,
        POSITIVE,
        Range::closed(1e-9, 1.0),
        "the energy unaccounted for, over that of the impact, that ends a run",
    )
};

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

pub(crate) const DEPTH: ParamSpec =
    ParamSpec { key: "depth", meaning: "the inner depth of the box, along y", ..WIDTH };

pub(crate) const CONTAINER_DIAMETER: ParamSpec =
    ParamSpec { key: "diameter", meaning: "the inner diameter of the cylinder", ..WIDTH };

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
    ParamSpec { key: "diameter_min", meaning: "the smallest diameter", ..GRAIN_DIAMETER };

pub(crate) const GRAIN_DIAMETER_MAX: ParamSpec =
    ParamSpec { key: "diameter_max", meaning: "the largest diameter", ..GRAIN_DIAMETER };

pub(crate) const GRAIN_DIAMETER_MEDIAN: ParamSpec =
    ParamSpec { key: "diameter_median", meaning: "the median diameter", ..GRAIN_DIAMETER };

pub(crate) const GRAIN_DIAMETER_SIGMA: ParamSpec = required(
    "diameter_sigma",
    NUMBER,
    Range { min: 0.0, max: 3.0, includes_min: false },
    Range::closed(0.01, 1.0),
    "the standard deviation of the logarithm of the diameter",
);

pub(crate) const GRAIN_DIAMETERS: ParamSpec =
    ParamSpec { key: "diameters", meaning: "the diameters", ..GRAIN_DIAMETER };

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

pub(crate) const LOG_INTERVAL: ParamSpec = ParamSpec {
    default: Default::Value(1e-4),
    ..required(
        "interval",
        Dimension::TIME,
        POSITIVE,
        Range::closed(1e-6, 0.1),
        "the time between two samples of the log",
    )
};

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

pub(crate) const SPIN: ParamSpec = ParamSpec {
    default: Default::Value(0.0),
    ..required(
        "spin",
        Dimension::SPIN,
        ANY,
        Range::closed(-1e4, 1e4),
        "the angular velocity at first contact, counter-clockwise positive",
    )
};

/// One component of it.
pub(crate) const SPIN_VECTOR: ParamSpec =
    ParamSpec { meaning: "the angular velocity at first contact, a vector with z up", ..SPIN };

pub(crate) const ATTITUDE: ParamSpec = ParamSpec {
    default: Default::Value(0.0),
    ..required(
        "attitude",
        Dimension::ANGLE,
        Range::closed(-PI, PI),
        Range::closed(-PI, PI),
        "the angle of the intruder's axis to the vertical; its top leans towards +x",
    )
};

pub(crate) const X: ParamSpec = required(
    "x",
    LENGTH,
    POSITIVE,
    Range::POSITIVE,
    "where the intruder's centre starts, from the left side",
);

pub(crate) const Y: ParamSpec =
    ParamSpec { key: "y", meaning: "where the intruder's centre starts, from the front side", ..X };

pub(crate) const X_RANGE: ParamSpec =
    ParamSpec { key: "x_range", meaning: "where drawn positions lie", ..X };

pub(crate) const POSITION: ParamSpec =
    ParamSpec { key: "position", allowed: ANY, plausible: ANY, ..X };
