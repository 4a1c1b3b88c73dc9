//! What a formula of a force may use of the state, the body and the bed.

use crate::{Immersion, Motion, Space, Surroundings};
use engine::units::Dimension;

use super::super::approach::Approach;
use super::super::facts::Needs;

/// Something that the force of a user-defined effect may depend on.
pub struct StateVariable {
    /// As it is written.
    pub name: &'static str,
    /// Another spelling; empty if there is none.
    pub alias: &'static str,
    /// What it is, and where it is measured.
    pub meaning: &'static str,
    /// Its dimension in a spatial medium and in a planar one.
    dimensions: [Dimension; 2],
    /// What data must contain to show an effect that depends on it.
    pub(super) needs: Option<Needs>,
    pub(super) value: fn(&Seen<'_>) -> f64,
}

impl StateVariable {
    /// Its dimension; angles count as pure numbers.
    pub fn dimension(&self, space: Space) -> Dimension {
        match space {
            Space::Spatial => self.dimensions[0],
            Space::Planar => self.dimensions[1],
        }
    }
}

/// What a law is told, at which speed (m/s), and in which impact.
#[derive(Clone, Copy)]
pub(super) struct Seen<'a> {
    pub(super) at: &'a Immersion,
    pub(super) motion: &'a Motion,
    pub(super) bed: &'a Surroundings,
    pub(super) speed: f64,
    pub(super) approach: Approach,
}

const AREA: Dimension = Dimension { metre_2: 4, ..Dimension::NONE };
const VOLUME: Dimension = Dimension { metre_2: 6, ..Dimension::NONE };

const fn variable(
    [name, alias]: [&'static str; 2],
    dimension: Dimension,
    meaning: &'static str,
    value: fn(&Seen<'_>) -> f64,
) -> StateVariable {
    StateVariable { name, alias, meaning, dimensions: [dimension; 2], needs: None, value }
}

/// Every variable, in the order of the docs.
pub static STATE_VARIABLES: &[StateVariable] = &[
    variable(
        ["z", ""],
        Dimension::LENGTH,
        "depth of the lowest point (m); negative above the surface",
        |seen| seen.at.depth,
    ),
    variable(["v", ""], Dimension::SPEED, "speed (m/s)", |seen| seen.speed),
    StateVariable {
        needs: Some(Needs::Oblique),
        ..variable(["v_x", ""], Dimension::SPEED, "forward velocity (m/s)", |seen| {
            seen.motion.velocity.x
        })
    },
    variable(["v_z", ""], Dimension::SPEED, "downward velocity (m/s)", |seen| {
        -seen.motion.velocity.z
    }),
    StateVariable {
        needs: Some(Needs::Spin),
        ..variable(
            ["omega", "ω"],
            Dimension::RATE,
            "spin, positive where the body rolls forward (1/s)",
            |seen| seen.motion.spin,
        )
    },
    variable(
        ["t", ""],
        Dimension::TIME,
        "time since the start, which is first contact (s)",
        |seen| seen.motion.time,
    ),
    variable(["D", ""], Dimension::LENGTH, "diameter (m)", |seen| seen.at.diameter),
    variable(["m", ""], Dimension::MASS, "mass of the body (kg)", |seen| seen.at.mass),
    StateVariable {
        dimensions: [AREA, Dimension::LENGTH],
        ..variable(
            ["A", ""],
            AREA,
            "area that drag and friction act on: the frontal one, unless another effect changes it \
             (m^2, planar m)",
            |seen| seen.at.loaded_area,
        )
    },
    StateVariable {
        dimensions: [AREA, Dimension::LENGTH],
        ..variable(
            ["A_im", ""],
            AREA,
            "frontal area of the immersed portion (m^2, planar m)",
            |seen| seen.at.immersed_area,
        )
    },
    StateVariable {
        dimensions: [VOLUME, AREA],
        ..variable(["V", ""], VOLUME, "immersed volume (m^3, planar m^2)", |seen| seen.at.volume)
    },
    StateVariable {
        dimensions: [Dimension::DENSITY, Dimension::AREA_DENSITY],
        ..variable(
            ["rho", "ρ"],
            Dimension::DENSITY,
            "bulk density of the bed (kg/m^3, planar kg/m^2)",
            |seen| seen.bed.bulk_density,
        )
    },
    variable(["g", ""], Dimension::ACCELERATION, "gravity (m/s^2)", |seen| seen.bed.gravity),
    StateVariable {
        needs: Some(Needs::Packings),
        ..variable(["phi", "φ"], Dimension::NONE, "packing fraction of the bed", |seen| {
            seen.bed.packing.unwrap_or(f64::NAN)
        })
    },
    StateVariable {
        needs: Some(Needs::BedDepth),
        ..variable(["H", ""], Dimension::LENGTH, "depth of the bed (m)", |seen| {
            seen.bed.bed_depth.unwrap_or(f64::NAN)
        })
    },
    variable(["v_0", ""], Dimension::SPEED, "impact speed (m/s)", |seen| seen.approach.speed),
    variable(["V_s", ""], Dimension::SPEED, "sqrt(g D) (m/s)", |seen| {
        (seen.bed.gravity * seen.at.diameter).sqrt()
    }),
    StateVariable {
        needs: Some(Needs::Oblique),
        ..variable(
            ["theta", "θ"],
            Dimension::NONE,
            "impact angle below the horizontal (rad)",
            |seen| seen.approach.angle,
        )
    },
];

/// The variable written `name`.
pub(super) fn find(name: &str) -> Option<&'static StateVariable> {
    STATE_VARIABLES
        .iter()
        .find(|variable| variable.name == name || !name.is_empty() && variable.alias == name)
}
