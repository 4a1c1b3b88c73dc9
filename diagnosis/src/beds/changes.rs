//! Candidates that change what every bed of grains has: its contact law, and how it was prepared; one line of
//! [`CHANGES`] makes one.

use configs::{BedSource, Change, GrainKind, GrainModel, Material};
use contact_laws::restitution_key;
use engine::bed::{SizeDistribution, inflation_range};
use engine::contact::Partner;
use engine::grains::Space;
use resistive::Kind;

use super::bed_candidate::{Act, BedCandidate};
use super::variation::Variation;

/// Every one of them, in the order of the docs.
pub(super) const CHANGES: &[BedCandidate] = &[
    GRAIN_FRICTION,
    INTRUDER_FRICTION,
    WALL_FRICTION,
    RESTITUTION,
    PACKING,
    INFLATED,
    POLYDISPERSITY,
    GRAIN_DENSITY,
    GRAIN_STIFFNESS,
    TANGENTIAL_DAMPING,
    GRAIN_INERTIA,
];

const GRAIN_FRICTION: BedCandidate = BedCandidate {
    id: "grain-friction",
    kind: Kind::Physics,
    amplitude: "relative change of contact_law.friction during the impact",
    screen: 0.5,
    range: (-1.0, 4.0),
    separable_from: "from rolling-resistance: several angles",
    of_measurements: true,
    stated_by: None,
    act: Act::Change {
        lacks: |model| without(model, "friction"),
        change: |model, q| scaled(model, "friction", q),
    },
};

const INTRUDER_FRICTION: BedCandidate = BedCandidate {
    id: "intruder-friction",
    kind: Kind::Physics,
    amplitude: "relative change of contact_law.intruder_friction",
    screen: 0.5,
    range: (-1.0, 4.0),
    separable_from: "from grain-friction: spin, or oblique impacts",
    of_measurements: true,
    stated_by: None,
    act: Act::Change {
        lacks: |model| without(model, "intruder_friction"),
        change: |model, q| scaled(model, "intruder_friction", q),
    },
};

const WALL_FRICTION: BedCandidate = BedCandidate {
    id: "wall-friction",
    kind: Kind::Physics,
    amplitude: "relative change of contact_law.wall_friction during the impact",
    screen: 0.5,
    range: (-1.0, 4.0),
    separable_from: "from grain-friction: containers of two widths",
    of_measurements: true,
    stated_by: None,
    act: Act::Change {
        lacks: |model| without(model, "wall_friction"),
        change: |model, q| scaled(model, "wall_friction", q),
    },
};

const RESTITUTION: BedCandidate = BedCandidate {
    id: "restitution",
    kind: Kind::Physics,
    amplitude: "relative change of the damping of normal contacts, of −ln e of each pair",
    screen: 0.5,
    range: (-0.9, 4.0),
    separable_from: "from velocity-restitution: a wide range of speeds",
    of_measurements: true,
    stated_by: None,
    act: Act::Change {
        lacks: |model| match damping(model) {
            Some(_) => None,
            None => Some("the contact law has no damping to change"),
        },
        change: |model, q| match damping(model) {
            Some("restitution") => {
                let damped = |partner| {
                    let key = restitution_key(partner);
                    let e = model.medium.contact_law.params.get(key);
                    Change::ContactLaw(key, libm::pow(e, 1.0 + q))
                };
                let during = Partner::ALL.into_iter().map(damped).collect();
                Variation { before: Vec::new(), during }
            }
            Some(key) => scaled(model, key, q),
            None => Variation::default(),
        },
    },
};

const PACKING: BedCandidate = BedCandidate {
    id: "packing",
    kind: Kind::Preparation,
    amplitude: "share of bed.preparation_friction that is taken away: a denser bed",
    screen: 0.7,
    range: (-2.0, 1.0),
    separable_from: "from grain-friction: a bed that is weighed",
    of_measurements: false,
    stated_by: None,
    act: Act::Change {
        lacks: |model| match preparation_friction(model) {
            Some(friction) if friction > 0.0 => None,
            Some(_) => Some("the bed settles without friction, as dense as it can be"),
            None => Some("the bed is given, or settles under a law without friction"),
        },
        change: |model, q| {
            let friction = preparation_friction(model).unwrap_or(0.0) * (1.0 - q);
            Variation::before(Change::PreparationFriction(friction))
        },
    },
};

const INFLATED: BedCandidate = BedCandidate {
    id: "inflated",
    kind: Kind::Preparation,
    amplitude: "packing fraction gained by growing grains in place before they fall",
    screen: 0.28,
    range: (0.0, 0.3),
    separable_from: "from packing: a bed whose fabric is seen, or that is weighed",
    of_measurements: false,
    stated_by: None,
    act: Act::Change {
        lacks: |model| match &model.medium.bed.source {
            BedSource::Csv(_) => Some("the bed is given"),
            BedSource::Settle(settle) => {
                settle.inflated_to.is_some().then_some("the bed of the model is inflated already")
            }
        },
        change: |model, q| match q > 0.0 {
            true => {
                Variation::before(Change::InflatedTo(inflation_range(model.medium.space).0 + q))
            }
            false => Variation::default(),
        },
    },
};

const POLYDISPERSITY: BedCandidate = BedCandidate {
    id: "polydispersity",
    kind: Kind::Preparation,
    amplitude: "standard deviation of the logarithm of diameters",
    screen: 0.15,
    range: (0.0, 0.3),
    separable_from: "from packing: a bed that is weighed",
    of_measurements: false,
    stated_by: None,
    act: Act::Change {
        lacks: |model| match &model.medium.bed.source {
            BedSource::Csv(_) => Some("the bed is given"),
            BedSource::Settle(settle) => {
                let equal = |kind: &GrainKind| matches!(kind.sizes, SizeDistribution::Equal(_));
                let spread = !settle.grains.iter().all(equal);
                spread.then_some("the grains of the model have a spread of sizes already")
            }
        },
        change: |model, q| match q > 0.0 {
            true => Variation::before(Change::Grains(spread(model, q))),
            false => Variation::default(),
        },
    },
};

const GRAIN_DENSITY: BedCandidate = BedCandidate {
    id: "grain-density",
    kind: Kind::Physics,
    amplitude: "relative change of the mass of grains, which settle with it",
    screen: 0.5,
    range: (-0.5, 3.0),
    separable_from: "from grain-friction: a bed that is weighed, or bodies of several densities",
    of_measurements: true,
    stated_by: Some(|bed| bed.bulk_density.is_some()),
    act: Act::Change {
        lacks: |model| is_given(model).then_some("the bed is given, and so are its masses"),
        change: |_, q| Variation::before(Change::GrainMass(1.0 + q)),
    },
};

const GRAIN_STIFFNESS: BedCandidate = BedCandidate {
    id: "grain-stiffness",
    kind: Kind::Physics,
    amplitude: "relative change of the stiffness of contacts, in the bed too; restitution stays",
    screen: 0.5,
    range: (-0.9, 1.0),
    separable_from: "from restitution: hardly by depths and times",
    of_measurements: false,
    stated_by: None,
    act: Act::Change {
        lacks: |model| {
            is_given(model)
                .then_some("the bed is given, and was settled with the stiffness of the model")
        },
        change: |model, q| {
            let scaled = |(key, power): (&'static str, f64)| {
                let (_, value) =
                    model.medium.contact_law.params.iter().find(|(own, _)| *own == key)?;
                Some(Change::ContactLaw(key, value * libm::pow(1.0 + q, power)))
            };
            Variation {
                before: STIFFNESSES.into_iter().filter_map(scaled).collect(),
                during: Vec::new(),
            }
        },
    },
};

/// The numbers of contact laws that grow with the stiffness at the same restitution, and the power.
const STIFFNESSES: [(&str, f64); 8] = [
    ("normal_stiffness", 1.0),
    ("tangential_stiffness", 1.0),
    ("young_modulus", 1.0),
    ("wall_young_modulus", 1.0),
    ("intruder_young_modulus", 1.0),
    ("normal_damping_rate", 0.5),
    ("tangential_damping_rate", 0.5),
    // As long as a collision of Hertz spheres.
    ("viscous_time", -0.4),
];

const TANGENTIAL_DAMPING: BedCandidate = BedCandidate {
    id: "tangential-damping",
    kind: Kind::Physics,
    amplitude: "relative change of the damping of tangential contacts",
    screen: 1.0,
    range: (-1.0, 4.0),
    separable_from: "from restitution: hardly by depths and times",
    of_measurements: false,
    stated_by: None,
    act: Act::Change {
        lacks: |model| match tangential_damping(model) {
            Some(_) => None,
            None => Some("the contact law has no tangential damping to change"),
        },
        change: |model, q| match tangential_damping(model) {
            Some(key) => scaled(model, key, q),
            None => Variation::default(),
        },
    },
};

const GRAIN_INERTIA: BedCandidate = BedCandidate {
    id: "grain-inertia",
    kind: Kind::Physics,
    amplitude: "relative change of the moment of inertia of grains; - 0.2 has discs turn as spheres do",
    screen: 0.4,
    range: (-0.9, 1.0),
    separable_from: "from rolling-resistance: hardly by depths and times",
    of_measurements: false,
    stated_by: None,
    act: Act::Change {
        lacks: |model| {
            model
                .medium
                .grain_inertia
                .map(|_| "the model says what the moment of inertia of grains is")
        },
        change: |model, q| {
            let coefficient = model.medium.space.inertia_coefficient() * (1.0 + q);
            Variation::during(Change::GrainInertia(coefficient))
        },
    },
};

fn without(model: GrainModel<'_>, key: &str) -> Option<&'static str> {
    match model.medium.contact_law.params.iter().find(|(name, _)| *name == key) {
        Some((_, value)) if value > 0.0 => None,
        Some(_) => Some("it is zero in the model: give it a value to be changed"),
        None => Some("the contact law has no such number"),
    }
}

/// The number of the contact law that says how much a collision dissipates.
fn damping(model: GrainModel<'_>) -> Option<&'static str> {
    positive(model, &["normal_damping_rate", "restitution", "viscous_time"])
}

fn tangential_damping(model: GrainModel<'_>) -> Option<&'static str> {
    positive(model, &["tangential_damping_rate", "tangential_damping"])
}

/// The first of `keys` that the contact law has above zero.
fn positive(model: GrainModel<'_>, keys: &[&'static str]) -> Option<&'static str> {
    let params = &model.medium.contact_law.params;
    keys.iter().copied().find(|key| params.iter().any(|(name, value)| name == *key && value > 0.0))
}

fn is_given(model: GrainModel<'_>) -> bool {
    matches!(model.medium.bed.source, BedSource::Csv(_))
}

fn preparation_friction(model: GrainModel<'_>) -> Option<f64> {
    match &model.medium.bed.source {
        BedSource::Settle(settle) => settle.preparation_friction,
        BedSource::Csv(_) => None,
    }
}

/// The number `key` of the contact law times 1 + `q`, during the impact.
fn scaled(model: GrainModel<'_>, key: &'static str, q: f64) -> Variation {
    let value = model.medium.contact_law.params.get(key) * (1.0 + q);
    Variation::during(Change::ContactLaw(key, value.max(0.0)))
}

/// The grains of `model` with logarithms of diameters that scatter by `sigma`; mass and number stay.
fn spread(model: GrainModel<'_>, sigma: f64) -> Vec<GrainKind> {
    let BedSource::Settle(settle) = &model.medium.bed.source else { return Vec::new() };
    let space = model.medium.space;
    let moment = if space == Space::Planar { 2.0 } else { 3.0 };
    let kind = |kind: &GrainKind| {
        let density = kind.total_mass(space) / (kind.count as f64 * kind.content(space));
        // The mean of d^n of a lognormal is that of its median times exp(n² σ²/2).
        let diameter = libm::pow(kind.sizes.moment(moment as i32), 1.0 / moment);
        let median = diameter * libm::exp(-0.5 * moment * sigma * sigma);
        let sizes = SizeDistribution::lognormal(median, sigma);
        GrainKind { count: kind.count, sizes, material: Material::Density(density) }
    };
    settle.grains.iter().map(kind).collect()
}
