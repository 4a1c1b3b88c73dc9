//! The parameters that laws on elastic constants have in common.

use engine::contact::Partner;
use engine::params::{Default, ParamSpec, ParamTable, Range};
use engine::units::Dimension;

const MODULUS: ParamSpec = ParamSpec {
    key: "young_modulus",
    dimension: Dimension::PRESSURE,
    default: Default::Required,
    allowed: Range::POSITIVE,
    plausible: Range::closed(1e5, 1e12),
    meaning: "E, Young's modulus of the grains",
};

const RATIO: ParamSpec = ParamSpec {
    key: "poisson_ratio",
    dimension: Dimension::NONE,
    default: Default::Required,
    allowed: Range::closed(0.0, 0.5),
    plausible: Range::closed(0.1, 0.49),
    meaning: "ν, Poisson's ratio of the grains",
};

const FRICTION: ParamSpec = ParamSpec {
    key: "friction",
    dimension: Dimension::NONE,
    default: Default::Required,
    allowed: Range::NOT_NEGATIVE,
    plausible: Range::closed(0.0, 1.5),
    meaning: "μ, Coulomb limit of the tangential force over F_n",
};

/// The parameters of a Hertz–Mindlin law that is damped by the parameter `damping`, with
/// `tangential_damping` as its factor along the contact plane.
pub(crate) const fn specs(damping: ParamSpec, tangential_damping: ParamSpec) -> [ParamSpec; 11] {
    [
        MODULUS,
        RATIO,
        damping,
        FRICTION,
        ParamSpec {
            key: "wall_friction",
            default: Default::SameAs("friction"),
            meaning: "μ between grains and walls",
            ..FRICTION
        },
        ParamSpec {
            key: "intruder_friction",
            default: Default::SameAs("friction"),
            meaning: "μ between grains and the intruder",
            ..FRICTION
        },
        ParamSpec {
            key: "wall_young_modulus",
            default: Default::SameAs("young_modulus"),
            meaning: "E of the walls",
            ..MODULUS
        },
        ParamSpec {
            key: "wall_poisson_ratio",
            default: Default::SameAs("poisson_ratio"),
            meaning: "ν of the walls",
            ..RATIO
        },
        ParamSpec {
            key: "intruder_young_modulus",
            default: Default::SameAs("young_modulus"),
            meaning: "E of the intruder",
            ..MODULUS
        },
        ParamSpec {
            key: "intruder_poisson_ratio",
            default: Default::SameAs("poisson_ratio"),
            meaning: "ν of the intruder",
            ..RATIO
        },
        tangential_damping,
    ]
}

/// The elastic constants of an effect on a law of this kind, which are that law's, with one more parameter
/// in front.
pub(crate) const fn specs_on_base(first: ParamSpec) -> [ParamSpec; 7] {
    [
        first,
        of_base(MODULUS, "young_modulus"),
        of_base(RATIO, "poisson_ratio"),
        ParamSpec { meaning: "E of the walls", ..of_base(MODULUS, "wall_young_modulus") },
        ParamSpec { meaning: "ν of the walls", ..of_base(RATIO, "wall_poisson_ratio") },
        ParamSpec { meaning: "E of the intruder", ..of_base(MODULUS, "intruder_young_modulus") },
        ParamSpec { meaning: "ν of the intruder", ..of_base(RATIO, "intruder_poisson_ratio") },
    ]
}

const fn of_base(spec: ParamSpec, key: &'static str) -> ParamSpec {
    ParamSpec { key, default: Default::FromBase(key), ..spec }
}

/// The factor on the viscous force in the contact plane.
pub(crate) const TANGENTIAL_DAMPING: ParamSpec = ParamSpec {
    key: "tangential_damping",
    dimension: Dimension::NONE,
    default: Default::Required,
    allowed: Range::NOT_NEGATIVE,
    plausible: Range::closed(0.0, 2.0),
    meaning: "",
};

/// μ with `partner`.
pub(crate) fn friction(params: &ParamTable, partner: Partner) -> f64 {
    params.get(match partner {
        Partner::Grain => "friction",
        Partner::Wall => "wall_friction",
        Partner::Intruder => "intruder_friction",
    })
}
