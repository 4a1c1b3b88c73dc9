//! The parameters that laws on elastic constants have in common.

use engine::contact::Partner;
use engine::params::{ParamDefault, ParamSpec, ParamTable, Range};
use engine::units::Dimension;

const MODULUS: ParamSpec =
    ParamSpec::required("young_modulus", Dimension::PRESSURE, "E, Young's modulus of the grains")
        .allowed(Range::POSITIVE)
        .usual(1e5, 1e12);

const RATIO: ParamSpec = ParamSpec::number("poisson_ratio", "ν, Poisson's ratio of the grains")
    .allowed(Range::closed(0.0, 0.5))
    .usual(0.1, 0.49);

const FRICTION: ParamSpec =
    ParamSpec::number("friction", "μ, Coulomb limit of the tangential force over F_n")
        .usual(0.0, 1.5);

/// The parameters of a Hertz–Mindlin law that is damped by the parameter `damping`, with
/// `tangential_damping` as its factor along the contact plane.
pub(crate) const fn specs(damping: ParamSpec, tangential_damping: ParamSpec) -> [ParamSpec; 11] {
    [
        MODULUS,
        RATIO,
        damping,
        FRICTION,
        FRICTION.named("wall_friction", "μ between grains and walls").same_as("friction"),
        FRICTION
            .named("intruder_friction", "μ between grains and the intruder")
            .same_as("friction"),
        MODULUS.named("wall_young_modulus", "E of the walls").same_as("young_modulus"),
        RATIO.named("wall_poisson_ratio", "ν of the walls").same_as("poisson_ratio"),
        MODULUS.named("intruder_young_modulus", "E of the intruder").same_as("young_modulus"),
        RATIO.named("intruder_poisson_ratio", "ν of the intruder").same_as("poisson_ratio"),
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

/// `specs` and two that one law adds.
pub(crate) const fn with_two_more(specs: [ParamSpec; 11], more: [ParamSpec; 2]) -> [ParamSpec; 13] {
    let [a, b, c, d, e, f, g, h, i, j, k] = specs;
    let [l, m] = more;
    [a, b, c, d, e, f, g, h, i, j, k, l, m]
}

const fn of_base(spec: ParamSpec, key: &'static str) -> ParamSpec {
    ParamSpec { key, default: ParamDefault::FromBase(key), ..spec }
}

/// The factor on the viscous force in the contact plane.
pub(crate) const TANGENTIAL_DAMPING: ParamSpec =
    ParamSpec::number("tangential_damping", "").usual(0.0, 2.0);

/// μ with `partner`.
pub(crate) fn friction(params: &ParamTable, partner: Partner) -> f64 {
    params.get(match partner {
        Partner::Grain => "friction",
        Partner::Wall => "wall_friction",
        Partner::Intruder => "intruder_friction",
    })
}
