//! The numeric keys of `measurement.toml`, specified like the parameters of a law.

use engine::params::{ParamSpec, Range};
use engine::units::Dimension;

const fn key(
    key: &'static str,
    dimension: Dimension,
    allowed: Range,
    plausible: (f64, f64),
    meaning: &'static str,
) -> ParamSpec {
    let plausible = Range::closed(plausible.0, plausible.1);
    ParamSpec::required(key, dimension, meaning).allowed(allowed).plausible(plausible)
}

const POSITIVE: Range = Range::POSITIVE;
const NOT_NEGATIVE: Range = Range::NOT_NEGATIVE;
const ANY: Range = Range::closed(-f64::MAX, f64::MAX);
const NUMBER: Dimension = Dimension::NONE;
const LENGTH: Dimension = Dimension::LENGTH;

pub(crate) const SCHEMA: ParamSpec =
    key("schema", NUMBER, Range::closed(1.0, 1.0), (1.0, 1.0), "the version of the format");

pub(crate) const RATE: ParamSpec =
    key("rate_hz", Dimension::RATE, POSITIVE, (1.0, 1e7), "the number of frames per second");
pub(crate) const POSITION_SIGMA: ParamSpec = key(
    "position_sigma_m",
    LENGTH,
    NOT_NEGATIVE,
    (0.0, 0.01),
    "the root mean square error of one reading of a position",
);
pub(crate) const FORCE_SIGMA: ParamSpec = key(
    "force_sigma_N",
    Dimension::FORCE,
    NOT_NEGATIVE,
    (0.0, 1e4),
    "the root mean square error of one reading of a force",
);
pub(crate) const ACCELERATION_SIGMA: ParamSpec = key(
    "acceleration_sigma_m_s2",
    Dimension::ACCELERATION,
    NOT_NEGATIVE,
    (0.0, 1e3),
    "the root mean square error of one reading of an acceleration",
);
pub(crate) const VELOCITY_SIGMA: ParamSpec = key(
    "velocity_sigma_m_s",
    Dimension::SPEED,
    NOT_NEGATIVE,
    (0.0, 10.0),
    "the root mean square error of one reading of a velocity",
);
pub(crate) const SPIN_SIGMA: ParamSpec = key(
    "spin_sigma_rad_s",
    Dimension::SPIN,
    NOT_NEGATIVE,
    (0.0, 1e3),
    "the root mean square error of one reading of a spin",
);
pub(crate) const ACCELERATION_RANGE: ParamSpec = key(
    "acceleration_range_m_s2",
    Dimension::ACCELERATION,
    POSITIVE,
    (1.0, 1e6),
    "the size of accelerations beyond which the accelerometer reads nothing",
);
pub(crate) const SPEED_SIGMA: ParamSpec = key(
    "speed_sigma_rel",
    NUMBER,
    NOT_NEGATIVE,
    (0.0, 0.5),
    "the relative error of the set impact speed",
);
pub(crate) const ANGLE_SIGMA: ParamSpec = key(
    "angle_sigma_deg",
    NUMBER,
    NOT_NEGATIVE,
    (0.0, 30.0),
    "the error of the set impact angle, in degrees",
);
pub(crate) const LEVEL_SIGMA: ParamSpec = key(
    "level_sigma_m",
    LENGTH,
    NOT_NEGATIVE,
    (0.0, 0.01),
    "the error of the level of the surface",
);

pub(crate) const TIME_SIGMA: ParamSpec = key(
    "time_sigma_s",
    Dimension::TIME,
    NOT_NEGATIVE,
    (0.0, 0.1),
    "the error of the zero of the clock, which all runs share",
);
pub(crate) const ZERO_SIGMA: ParamSpec = key(
    "zero_sigma_m",
    LENGTH,
    NOT_NEGATIVE,
    (0.0, 0.05),
    "the error of the zero of depth, which all runs share",
);
pub(crate) const SURFACE_SIGMA: ParamSpec = key(
    "surface_sigma_m",
    LENGTH,
    NOT_NEGATIVE,
    (0.0, 0.05),
    "the error of the level of the surface, which all runs share, where clocks, depths and speeds are read where free fall comes to that level",
);
pub(crate) const SPEED_BIAS_SIGMA: ParamSpec = key(
    "speed_bias_sigma_rel",
    NUMBER,
    NOT_NEGATIVE,
    (0.0, 0.5),
    "the relative error that all impact speeds share",
);
pub(crate) const ANGLE_BIAS_SIGMA: ParamSpec = key(
    "angle_bias_sigma_deg",
    NUMBER,
    NOT_NEGATIVE,
    (0.0, 30.0),
    "the error that all angles of oblique impacts share, in degrees",
);
pub(crate) const SCALE_SIGMA: ParamSpec = key(
    "scale_sigma_rel",
    NUMBER,
    NOT_NEGATIVE,
    (0.0, 0.5),
    "the relative error of the scale of lengths",
);
pub(crate) const MASS_SIGMA: ParamSpec = key(
    "mass_sigma_rel",
    NUMBER,
    NOT_NEGATIVE,
    (0.0, 0.5),
    "the relative error of the mass of each body",
);
pub(crate) const TILT_SIGMA: ParamSpec = key(
    "tilt_sigma_deg",
    NUMBER,
    NOT_NEGATIVE,
    (0.0, 30.0),
    "how well the apparatus is plumb, in degrees",
);
pub(crate) const SESSION_SIGMA: ParamSpec = key(
    "session_sigma_rel",
    NUMBER,
    NOT_NEGATIVE,
    (0.0, 0.5),
    "the relative difference of the resistance between sessions",
);

/// A planar bed has a density per area; its unit is told by the geometry.
pub(crate) const BULK_DENSITY: ParamSpec =
    key("bulk_density", Dimension::DENSITY, POSITIVE, (0.1, 2e4), "the bulk density of the bed");
pub(crate) const AREA_DENSITY: ParamSpec =
    ParamSpec { dimension: Dimension::AREA_DENSITY, ..BULK_DENSITY };
pub(crate) const GRAVITY: ParamSpec = key(
    "gravity",
    Dimension::ACCELERATION,
    NOT_NEGATIVE,
    (0.0, 100.0),
    "the acceleration by gravity",
)
.or(9.81);
pub(crate) const GRAIN_DIAMETER: ParamSpec =
    key("grain_diameter", LENGTH, POSITIVE, (1e-6, 0.1), "the mean diameter of the grains");

pub(crate) const PACKING_FRACTION: ParamSpec = PACKING.named(
    "packing_fraction",
    "the area (volume) of the grains over the base times the mean height of the surface",
);
pub(crate) const PACKING_FRACTION_SIGMA: ParamSpec = key(
    "packing_fraction_sigma",
    NUMBER,
    NOT_NEGATIVE,
    (0.0, 0.1),
    "the standard error of the packing fraction",
);
pub(crate) const SURFACE_HEIGHT: ParamSpec = key(
    "surface_height",
    LENGTH,
    POSITIVE,
    (1e-3, 100.0),
    "the mean height of the surface above the floor",
);
pub(crate) const SURFACE_HEIGHT_SIGMA: ParamSpec = key(
    "surface_height_sigma",
    LENGTH,
    NOT_NEGATIVE,
    (0.0, 1.0),
    "the standard error of the height of the surface",
);
pub(crate) const BULK_DENSITY_SIGMA: ParamSpec = key(
    "bulk_density_sigma",
    Dimension::DENSITY,
    NOT_NEGATIVE,
    (0.0, 1e3),
    "the standard error of the bulk density",
);
pub(crate) const AREA_DENSITY_SIGMA: ParamSpec =
    ParamSpec { dimension: Dimension::AREA_DENSITY, ..BULK_DENSITY_SIGMA };
pub(crate) const GRAIN_DIAMETER_SIGMA: ParamSpec = key(
    "grain_diameter_sigma",
    LENGTH,
    NOT_NEGATIVE,
    (0.0, 0.01),
    "the standard error of the mean diameter of the grains",
);
pub(crate) const COORDINATION: ParamSpec = key(
    "coordination",
    NUMBER,
    NOT_NEGATIVE,
    (0.0, 20.0),
    "the mean number of contacts of a grain, which simulated beds show",
);
pub(crate) const COORDINATION_SIGMA: ParamSpec = key(
    "coordination_sigma",
    NUMBER,
    NOT_NEGATIVE,
    (0.0, 1.0),
    "the standard error of the coordination number",
);

pub(crate) const STOP_TIME_ERROR: ParamSpec =
    key("stop_time_rel", NUMBER, NOT_NEGATIVE, (0.0, 1.0), "the relative error of a stopping time");
pub(crate) const FINAL_Z_ERROR: ParamSpec =
    key("final_z_rel", NUMBER, NOT_NEGATIVE, (0.0, 1.0), "the relative error of a final depth");
pub(crate) const FINAL_X_ERROR: ParamSpec =
    key("final_x_rel", NUMBER, NOT_NEGATIVE, (0.0, 1.0), "the relative error of a final range");

pub(crate) const SPEED: ParamSpec =
    key("speed", Dimension::SPEED, NOT_NEGATIVE, (0.0, 500.0), "the speed at first contact");
pub(crate) const ANGLE: ParamSpec = key(
    "angle_deg",
    NUMBER,
    Range { min: 0.0, max: 90.0, includes_min: false },
    (0.0, 90.0),
    "the angle of the velocity below the horizontal in degrees; 90 is straight down",
);
pub(crate) const DIAMETER: ParamSpec =
    key("diameter", LENGTH, POSITIVE, (1e-4, 10.0), "the diameter of the intruder");
pub(crate) const MASS: ParamSpec =
    key("mass", Dimension::MASS, POSITIVE, (1e-7, 1e5), "the mass of the intruder");
pub(crate) const SPIN: ParamSpec =
    key("spin", Dimension::SPIN, ANY, (-1e4, 1e4), "the spin, positive when it rolls forward")
        .or(0.0);
pub(crate) const PACKING: ParamSpec = key(
    "packing",
    NUMBER,
    Range { min: 0.0, max: 1.0, includes_min: false },
    (0.1, 0.95),
    "the packing fraction of the bed",
);
pub(crate) const BED_DEPTH: ParamSpec =
    key("bed_depth", LENGTH, POSITIVE, (1e-3, 100.0), "the depth of the bed");
pub(crate) const LENGTH_OF_LINK: ParamSpec =
    key("length", LENGTH, POSITIVE, (1e-3, 10.0), "the length of a link");
pub(crate) const HEIGHT: ParamSpec =
    key("height", LENGTH, POSITIVE, (1e-4, 10.0), "the height of a cylinder or cone");
pub(crate) const SHAFT_DIAMETER: ParamSpec = key(
    "shaft_diameter",
    LENGTH,
    POSITIVE,
    (1e-4, 10.0),
    "the diameter of a shaft behind a cylinder, hemisphere or cone, which follows it into the bed",
);
pub(crate) const APEX: ParamSpec = key(
    "apex_deg",
    NUMBER,
    Range { min: 0.0, max: 180.0, includes_min: false },
    (1.0, 180.0),
    "the full apex angle of a cone in degrees",
);
pub(crate) const LINK_ANGLE: ParamSpec = key(
    "link_angle_deg",
    NUMBER,
    Range::closed(-90.0, 90.0),
    (-90.0, 90.0),
    "the angle of a link's axis to the vertical in degrees",
);

pub(crate) const COST_OF_RUN: ParamSpec =
    key("run", NUMBER, POSITIVE, (1e-3, 1e4), "the cost of one run").or(1.0);
pub(crate) const COST_OF_CONDITION: ParamSpec =
    key("condition", NUMBER, NOT_NEGATIVE, (0.0, 1e4), "the cost of a further condition").or(0.0);
pub(crate) const COST_OF_BODY: ParamSpec =
    key("body", NUMBER, NOT_NEGATIVE, (0.0, 1e4), "the cost of a body that the set has not")
        .or(0.0);
pub(crate) const COST_OF_BED: ParamSpec = key(
    "bed",
    NUMBER,
    NOT_NEGATIVE,
    (0.0, 1e4),
    "the cost of a packing or depth of the bed that the set has not",
)
.or(0.0);

/// +1 or -1: whether a column counts the other way.
pub(crate) const SIGN: ParamSpec =
    key("sign", NUMBER, Range::closed(-1.0, 1.0), (-1.0, 1.0), "1, or -1 to turn a column round")
        .or(1.0);
