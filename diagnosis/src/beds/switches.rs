//! What a bed of grains may lack, each as a switch of the simulation with one amplitude; one line of
//! [`SWITCHES`] makes an effect a candidate.

use std::f64::consts::{FRAC_PI_6, PI, TAU};

use configs::{BedSource, GrainModel};
use engine::bed::inflation_range;
use engine::grains::Space;

use super::variation::Variation;

/// A candidate of the simulation.
#[derive(Clone, Copy)]
pub struct Switch {
    /// kebab-case.
    pub id: &'static str,
    /// What the amplitude is, for a report.
    pub amplitude: &'static str,
    /// Amplitude with which impacts are screened: about what one would look for.
    pub screen: f64,
    /// Least and greatest amplitude.
    pub range: (f64, f64),
    /// What it takes to tell it from its twins.
    pub separable_from: &'static str,
    /// Whether measurements may have it; what only another simulation can have is a candidate where it is named.
    pub of_measurements: bool,
    /// Why it is no candidate for a model, if it is none.
    lacks: fn(GrainModel<'_>) -> Option<&'static str>,
    /// The model with it.
    change: fn(GrainModel<'_>, f64) -> Variation,
}

/// Every candidate, in the order of the docs.
pub static SWITCHES: &[Switch] = &[
    ROLLING_RESISTANCE,
    TWISTING_RESISTANCE,
    COHESION_DMT,
    CAPILLARY_BRIDGE,
    GRAIN_FRICTION,
    INTRUDER_FRICTION,
    WALL_FRICTION,
    RESTITUTION,
    VELOCITY_RESTITUTION,
    PORE_AIR,
    SIDE_WALL,
    PACKING,
    INFLATED,
    POLYDISPERSITY,
    GRAIN_INERTIA,
];

/// Candidates of force laws that act on an intruder in a bed of grains as well, or on how it is seen; the
/// others are what grains do.
pub(super) const OF_THE_APPARATUS: [&str; 5] =
    ["rail-friction", "air-drag", "tilt", "camera-scale", "depth-zero"];

/// Volume of a bridge, in that of a grain: a bed that is wet by about a per cent.
const WET: f64 = 0.01;

const ROLLING_RESISTANCE: Switch = Switch {
    id: "rolling-resistance",
    amplitude: "rolling_friction",
    screen: 0.1,
    range: (0.0, 0.5),
    separable_from: "from grain-friction: several angles, or bed and impact by different friction",
    of_measurements: true,
    lacks: |model| has(model, "rolling-resistance"),
    change: |_, q| effect("rolling-resistance", &[("rolling_friction", number(q))]),
};

const TWISTING_RESISTANCE: Switch = Switch {
    id: "twisting-resistance",
    amplitude: "twisting_friction",
    screen: 0.1,
    range: (0.0, 1.0),
    separable_from: "from rolling-resistance: hardly by depths and times",
    of_measurements: true,
    lacks: |model| match model.medium.space {
        Space::Planar => Some("discs in a plane do not twist against each other"),
        Space::Spatial => has(model, "twisting-resistance"),
    },
    change: |_, q| effect("twisting-resistance", &[("twisting_friction", number(q))]),
};

const COHESION_DMT: Switch = Switch {
    id: "cohesion-dmt",
    amplitude: "pull-off over the weight of a mean grain",
    screen: 5.0,
    range: (0.0, 100.0),
    separable_from: "from capillary-bridge: grains that are pulled apart; from friction: slow impacts",
    of_measurements: true,
    lacks: |model| has(model, "cohesion-dmt").or_else(|| weightless(model)),
    change: |model, q| {
        let MeanGrain { radius, weight, .. } = MeanGrain::of(model);
        // Two equal grains have R* = r/2 and part at 2π W R*.
        let work = q * weight / (PI * radius);
        effect("cohesion-dmt", &[("work_of_adhesion", quantity(work, "J/m^2"))])
    },
};

const CAPILLARY_BRIDGE: Switch = Switch {
    id: "capillary-bridge",
    amplitude: "pull of a bridge over the weight of a mean grain",
    screen: 5.0,
    range: (0.0, 100.0),
    separable_from: "from cohesion-dmt: grains that are pulled apart; from friction: slow impacts",
    of_measurements: true,
    lacks: |model| has(model, "capillary-bridge").or_else(|| weightless(model)),
    change: |model, q| {
        let MeanGrain { radius, weight, volume } = MeanGrain::of(model);
        let values = [
            ("surface_tension", quantity(q * weight / (TAU * radius), "N/m")),
            ("liquid_volume", quantity(WET * volume, "m^3")),
        ];
        effect("capillary-bridge", &values)
    },
};

const GRAIN_FRICTION: Switch = Switch {
    id: "grain-friction",
    amplitude: "relative change of contact_law.friction during the impact",
    screen: 0.5,
    range: (-1.0, 4.0),
    separable_from: "from rolling-resistance: several angles",
    of_measurements: true,
    lacks: |model| without(model, "friction"),
    change: |model, q| scaled(model, "friction", q),
};

const INTRUDER_FRICTION: Switch = Switch {
    id: "intruder-friction",
    amplitude: "relative change of contact_law.intruder_friction",
    screen: 0.5,
    range: (-1.0, 4.0),
    separable_from: "from grain-friction: spin, or oblique impacts",
    of_measurements: true,
    lacks: |model| without(model, "intruder_friction"),
    change: |model, q| scaled(model, "intruder_friction", q),
};

const WALL_FRICTION: Switch = Switch {
    id: "wall-friction",
    amplitude: "relative change of contact_law.wall_friction during the impact",
    screen: 0.5,
    range: (-1.0, 4.0),
    separable_from: "from grain-friction: containers of two widths",
    of_measurements: true,
    lacks: |model| without(model, "wall_friction"),
    change: |model, q| scaled(model, "wall_friction", q),
};

const RESTITUTION: Switch = Switch {
    id: "restitution",
    amplitude: "relative change of the damping of normal contacts, of −ln e",
    screen: 0.5,
    range: (-0.9, 4.0),
    separable_from: "from velocity-restitution: a wide range of speeds",
    of_measurements: true,
    lacks: |model| match damping(model) {
        Some(_) => None,
        None => Some("the contact law has no damping to change"),
    },
    change: |model, q| match damping(model) {
        Some("restitution") => {
            let e = model.medium.contact_law.params.get("restitution");
            during("contact_law.restitution", number(libm::pow(e, 1.0 + q)))
        }
        Some(key) => scaled(model, key, q),
        None => Variation::default(),
    },
};

const VELOCITY_RESTITUTION: Switch = Switch {
    id: "velocity-restitution",
    amplitude: "viscous_time (us)",
    screen: 5.0,
    range: (0.0, 100.0),
    separable_from: "from restitution: a wide range of speeds",
    of_measurements: true,
    lacks: |model| {
        let elastic = model.medium.contact_law.params.iter().any(|(key, _)| key == "young_modulus");
        let law = model.medium.contact_law.entry.name;
        match (elastic, law) {
            (false, _) => Some("it acts on a Hertz law, and the contact law is none"),
            (true, "hertz-mindlin-viscous") => Some("the contact law has it"),
            (true, _) => has(model, "velocity-restitution"),
        }
    },
    change: |_, q| effect("velocity-restitution", &[("viscous_time", quantity(q, "us"))]),
};

const PORE_AIR: Switch = Switch {
    id: "pore-air",
    amplitude: "drag_rate (1/s)",
    screen: 5.0,
    range: (0.0, 200.0),
    separable_from: "from restitution: a wide range of speeds; from air-drag: flight before contact",
    of_measurements: true,
    lacks: |model| has(model, "pore-air"),
    change: |_, q| effect("pore-air", &[("drag_rate", quantity(q, "1/s"))]),
};

const SIDE_WALL: Switch = Switch {
    id: "side-wall",
    amplitude: "plate_friction",
    screen: 0.1,
    range: (0.0, 1.0),
    separable_from: "from grain-friction: slow impacts, or plates of another roughness",
    of_measurements: true,
    lacks: |model| match model.medium.space {
        Space::Spatial => Some("spheres are not held between two plates"),
        Space::Planar => has(model, "side-wall").or_else(|| weightless(model)),
    },
    change: |_, q| effect("side-wall", &[("plate_friction", number(q))]),
};

const PACKING: Switch = Switch {
    id: "packing",
    amplitude: "share of bed.preparation_friction that is taken away: a denser bed",
    screen: 0.7,
    range: (-2.0, 1.0),
    separable_from: "from grain-friction: a bed that is weighed",
    of_measurements: true,
    lacks: |model| match preparation_friction(model) {
        Some(friction) if friction > 0.0 => None,
        Some(_) => Some("the bed settles without friction, as dense as it can be"),
        None => Some("the bed is given, or settles under a law without friction"),
    },
    change: |model, q| {
        let friction = preparation_friction(model).unwrap_or(0.0) * (1.0 - q);
        before("bed.preparation_friction", number(friction))
    },
};

const INFLATED: Switch = Switch {
    id: "inflated",
    amplitude: "packing fraction gained by growing grains in place before they fall",
    screen: 0.28,
    range: (0.0, 0.3),
    separable_from: "from packing: a bed whose fabric is seen, or that is weighed",
    of_measurements: false,
    lacks: |model| match &model.medium.bed.source {
        BedSource::Csv(_) => Some("the bed is given"),
        BedSource::Settle(settle) => {
            settle.inflated_to.is_some().then_some("the bed of the model is inflated already")
        }
    },
    change: |model, q| match q > 0.0 {
        true => before("bed.inflated_to", number(inflation_range(model.medium.space).0 + q)),
        false => Variation::default(),
    },
};

const POLYDISPERSITY: Switch = Switch {
    id: "polydispersity",
    amplitude: "standard deviation of the logarithm of diameters",
    screen: 0.15,
    range: (0.0, 0.3),
    separable_from: "from packing: a bed that is weighed",
    of_measurements: true,
    lacks: |model| match &model.medium.bed.source {
        BedSource::Csv(_) => Some("the bed is given"),
        BedSource::Settle(settle) => {
            let equal = |kind: &configs::GrainKind| {
                matches!(kind.sizes, engine::bed::SizeDistribution::Equal(_))
            };
            let spread = !settle.grains.iter().all(equal);
            spread.then_some("the grains of the model have a spread of sizes already")
        }
    },
    change: |model, q| match q > 0.0 {
        true => before("bed.grains", spread(model, q)),
        false => Variation::default(),
    },
};

const GRAIN_INERTIA: Switch = Switch {
    id: "grain-inertia",
    amplitude: "relative change of the moment of inertia of grains; - 0.2 has discs turn as spheres do",
    screen: 0.4,
    range: (-0.9, 1.0),
    separable_from: "from rolling-resistance: hardly by depths and times",
    of_measurements: false,
    lacks: |model| {
        model.medium.grain_inertia.map(|_| "the model says what the moment of inertia of grains is")
    },
    change: |model, q| {
        during("medium.grain_inertia", number(model.medium.space.inertia_coefficient() * (1.0 + q)))
    },
};

impl Switch {
    /// Why it is no candidate for `model`, if it is none.
    #[must_use]
    pub fn lacks(&self, model: GrainModel<'_>) -> Option<&'static str> {
        (self.lacks)(model)
    }

    /// What it changes in `model` at the amplitude `q`; nothing at zero.
    #[must_use]
    pub fn change(&self, model: GrainModel<'_>, q: f64) -> Variation {
        if q == 0.0 { Variation::default() } else { (self.change)(model, q) }
    }
}

fn has(model: GrainModel<'_>, name: &str) -> Option<&'static str> {
    let mut laws = model.medium.effects.iter().map(|effect| effect.entry.name);
    let mut forces = model.medium.grain_forces.iter().map(|force| force.entry.name);
    let has = laws.any(|own| own == name) || forces.any(|own| own == name);
    has.then_some("the model has it")
}

fn without(model: GrainModel<'_>, key: &str) -> Option<&'static str> {
    match model.medium.contact_law.params.iter().find(|(name, _)| *name == key) {
        Some((_, value)) if value > 0.0 => None,
        Some(_) => Some("it is zero in the model: give it a value to be changed"),
        None => Some("the contact law has no such number"),
    }
}

fn weightless(model: GrainModel<'_>) -> Option<&'static str> {
    (model.medium.gravity <= 0.0).then_some("its amplitude is in weights, and there is no gravity")
}

/// The number of the contact law that says how much a collision dissipates.
fn damping(model: GrainModel<'_>) -> Option<&'static str> {
    let params = &model.medium.contact_law.params;
    ["normal_damping_rate", "restitution", "viscous_time"]
        .into_iter()
        .find(|key| params.iter().any(|(name, value)| name == *key && value > 0.0))
}

fn preparation_friction(model: GrainModel<'_>) -> Option<f64> {
    match &model.medium.bed.source {
        BedSource::Settle(settle) => settle.preparation_friction,
        BedSource::Csv(_) => None,
    }
}

fn effect(name: &str, values: &[(&str, String)]) -> Variation {
    let values = values.iter().map(|(key, value)| ((*key).to_owned(), value.clone()));
    Variation { effects: vec![(name.to_owned(), values.collect())], ..Variation::default() }
}

fn during(path: &str, value: String) -> Variation {
    Variation { during: vec![format!("{path}={value}")], ..Variation::default() }
}

fn before(path: &str, value: String) -> Variation {
    Variation { before: vec![format!("{path}={value}")], ..Variation::default() }
}

/// The number `key` of the contact law times 1 + `q`, in the unit of its spec.
fn scaled(model: GrainModel<'_>, key: &str, q: f64) -> Variation {
    let law = &model.medium.contact_law;
    let value = (law.params.get(key) * (1.0 + q)).max(0.0);
    let spec = law.entry.params.iter().find(|spec| spec.key == key);
    let text = spec.map_or_else(
        || number(value),
        |spec| match spec.dimension == engine::units::Dimension::NONE {
            true => number(value),
            false => format!("\"{}\"", engine::units::format_si(value, spec.dimension)),
        },
    );
    during(&format!("contact_law.{key}"), text)
}

fn number(value: f64) -> String {
    format!("{value:?}")
}

fn quantity(value: f64, unit: &str) -> String {
    format!("\"{value:?} {unit}\"")
}

/// The grains of `model` with logarithms of diameters that scatter by `sigma`; mass and number stay.
fn spread(model: GrainModel<'_>, sigma: f64) -> String {
    let BedSource::Settle(settle) = &model.medium.bed.source else { return String::new() };
    let space = model.medium.space;
    let unit = if space == Space::Planar { "kg/m^2" } else { "kg/m^3" };
    let kinds = settle.grains.iter().map(|kind| {
        let density = kind.total_mass(space) / (kind.count as f64 * kind.content(space));
        let moment = if space == Space::Planar { 2.0 } else { 3.0 };
        // The mean of d^n of a lognormal is that of its median times exp(n² σ²/2).
        let diameter = libm::pow(kind.sizes.moment(moment as i32), 1.0 / moment);
        let median = diameter * libm::exp(-0.5 * moment * sigma * sigma);
        format!(
            "{{ count = {}, distribution = \"lognormal\", diameter_median = \"{median:?} m\", \
             diameter_sigma = {sigma:?}, density = \"{density:?} {unit}\" }}",
            kind.count
        )
    });
    format!("[{}]", kinds.collect::<Vec<_>>().join(", "))
}

/// The mean grain of a bed.
struct MeanGrain {
    /// (m).
    radius: f64,
    /// (N).
    weight: f64,
    /// (m³), of a sphere of that radius.
    volume: f64,
}

impl MeanGrain {
    fn of(model: GrainModel<'_>) -> Self {
        let space = model.medium.space;
        let (n, diameter, mass) = match &model.medium.bed.source {
            BedSource::Settle(settle) => settle.grains.iter().fold((0.0, 0.0, 0.0), |sum, kind| {
                let count = kind.count as f64;
                let diameter = count * kind.sizes.moment(1);
                (sum.0 + count, sum.1 + diameter, sum.2 + kind.total_mass(space))
            }),
            BedSource::Csv(csv) => csv.grains.iter().fold((0.0, 0.0, 0.0), |sum, grain| {
                (sum.0 + 1.0, sum.1 + 2.0 * grain.radius, sum.2 + grain.mass)
            }),
        };
        let (diameter, mass) = (diameter / n, mass / n);
        let volume = FRAC_PI_6 * diameter * diameter * diameter;
        Self { radius: 0.5 * diameter, weight: mass * model.medium.gravity, volume }
    }
}
