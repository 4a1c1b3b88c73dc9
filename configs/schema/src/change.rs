//! Changes of a model of grains that was read: typed, in SI, without a text in between.

use std::path::Path;

use crate::diagnostics::{Sources, Span};
use crate::document::{Node, Table, Value};
use crate::load::{ConfigError, Loaded, understood};
use crate::model::{BedSource, GrainKind, GrainModel, IMPACT, INTRUSION, Material, Model};
use crate::read::DataFolder;
use engine::bed::SizeDistribution;

/// A change of a model of grains; all numbers are SI.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// The seed of everything random.
    Seed(u64),
    /// Gravity (m/s²).
    Gravity(f64),
    /// Moment of inertia of grains over m r² during the impact (–).
    GrainInertia(f64),
    /// A parameter of the contact law; effects that were read keep what they took from it.
    ContactLaw(&'static str, f64),
    /// Friction while the bed settles (–).
    PreparationFriction(f64),
    /// Rate at which velocities and spins decay while the bed settles (1/s).
    SettlingDrag(f64),
    /// Packing fraction up to which grains grow in place before they fall (–).
    InflatedTo(f64),
    /// Packing fraction up to which a bed at rest is tapped (–).
    TargetPackingFraction(f64),
    /// One more effect while the bed settles, with those of its parameters that are no default.
    BedEffect(&'static str, Vec<(&'static str, f64)>),
    /// The grains of the bed.
    Grains(Vec<GrainKind>),
    /// The masses of the grains that settle, over what they are (–).
    GrainMass(f64),
    /// One more effect, with those of its parameters that are no default.
    Effect(&'static str, Vec<(&'static str, f64)>),
    /// The intruder: its shape, its sizes and its mass (kg). Sizes that are not given stay.
    Intruder {
        /// The name of the shape.
        shape: String,
        /// By the keys of the shape.
        sizes: Vec<(&'static str, f64)>,
        /// (kg).
        mass: f64,
    },
    /// The velocity at first contact.
    Velocity {
        /// (m/s).
        speed: f64,
        /// Below the horizontal (rad).
        angle_rad: f64,
    },
    /// How deep a drive pushes the intruder (m), in a model with `[intrusion]`.
    PushedTo(f64),
    /// The spin in the x–z plane (rad/s), counter-clockwise.
    Spin(f64),
    /// Where the centre of the intruder starts (m).
    X(f64),
}

impl GrainModel<'_> {
    /// The model with `changes`, in their order, read and checked anew; what it was read from is not looked at
    /// again.
    pub fn with(&self, changes: &[Change]) -> Result<Model, ConfigError> {
        let mut sources = Sources::default();
        let id = sources.add(format!("a change of {}", self.model.run.name), "");
        let mut root = self.model.lines.tree(id);
        for change in changes {
            let id = sources.add("a change", format!("{change:?}"));
            change.apply(&mut root, Span { source: id, start: 0, end: 0 });
        }
        let known = match &self.medium.bed.source {
            BedSource::Csv(csv) => Some(csv),
            BedSource::Settle(_) => None,
        };
        let data = DataFolder { folder: Path::new("."), allow_paths: &[], known };
        let loaded = understood(&root, (sources, Vec::new()), &data);
        loaded.map(|Loaded { model, .. }| model)
    }
}

impl Change {
    fn apply(&self, root: &mut Table, span: Span) {
        let number = |value: f64| Node { span, value: Value::Si(value) };
        let text = |value: &str| Node { span, value: Value::Text(value.to_owned()) };
        let start = if root.get(INTRUSION).is_some() { INTRUSION } else { IMPACT };
        let mut put = |table: &str, key: &str, node: Node| {
            if let Some(table) = root.below(table) {
                table.put(key, node);
            }
        };
        match self {
            Self::Seed(seed) => {
                put("run", "seed", Node { span, value: Value::Integer(*seed as i64) });
            }
            Self::Gravity(value) => put("medium", "gravity", number(*value)),
            Self::GrainInertia(value) => put("medium", "grain_inertia", number(*value)),
            Self::ContactLaw(key, value) => put("contact_law", key, number(*value)),
            Self::PreparationFriction(value) => put("bed", "preparation_friction", number(*value)),
            Self::SettlingDrag(value) => put("bed", "settling_drag", number(*value)),
            Self::InflatedTo(value) => put("bed", "inflated_to", number(*value)),
            Self::Grains(kinds) => {
                let kinds = kinds.iter().map(|kind| of_kind(kind, span)).collect();
                put("bed", "grains", Node { span, value: Value::Array(kinds) });
            }
            Self::GrainMass(factor) => {
                let kinds = root.below("bed").map(|bed| bed.tables("grains"));
                for kind in kinds.into_iter().flatten() {
                    ["mass", "density"].iter().for_each(|key| kind.multiply(key, *factor));
                }
            }
            Self::TargetPackingFraction(value) => {
                put("bed", "target_packing_fraction", number(*value));
            }
            Self::Effect(name, values) => {
                root.push("effect", of_effect(name, values, span));
            }
            Self::BedEffect(name, values) => {
                if let Some(bed) = root.below("bed") {
                    bed.push("effect", of_effect(name, values, span));
                }
            }
            Self::Intruder { shape, sizes, mass } => {
                put("intruder", "shape", text(shape));
                sizes.iter().for_each(|(key, value)| put("intruder", key, number(*value)));
                put("intruder", "mass", number(*mass));
            }
            Self::Velocity { speed, angle_rad } => {
                put(start, "speed", number(*speed));
                put(start, "angle", number(*angle_rad));
            }
            Self::PushedTo(depth) => put(INTRUSION, "depth", number(*depth)),
            Self::Spin(value) => put(start, "spin", number(*value)),
            Self::X(value) => put(start, "x", number(*value)),
        }
    }
}

/// The effect `name` with these parameters as a table.
fn of_effect(name: &str, values: &[(&str, f64)], span: Span) -> Node {
    let mut table = Table::empty(span);
    table.put("name", Node { span, value: Value::Text(name.to_owned()) });
    for (key, value) in values {
        table.put(key, Node { span, value: Value::Si(*value) });
    }
    Node { span, value: Value::Table(table) }
}

/// `kind` as a table of `[[bed.grains]]`.
fn of_kind(kind: &GrainKind, span: Span) -> Node {
    let mut table = Table::empty(span);
    table.put("count", Node { span, value: Value::Integer(kind.count as i64) });
    let number = |value: f64| Node { span, value: Value::Si(value) };
    let list = |values: &[f64]| Node {
        span,
        value: Value::Array(values.iter().map(|&value| number(value)).collect()),
    };
    let (distribution, sizes) = match &kind.sizes {
        SizeDistribution::Equal(diameter) => (None, vec![("diameter", number(*diameter))]),
        SizeDistribution::Uniform { min, max } => {
            (Some("uniform"), vec![("diameter_min", number(*min)), ("diameter_max", number(*max))])
        }
        SizeDistribution::Lognormal { median, sigma, min, max } => {
            let sizes = vec![
                ("diameter_median", number(*median)),
                ("diameter_sigma", number(*sigma)),
                ("diameter_min", number(*min)),
                ("diameter_max", number(*max)),
            ];
            (Some("lognormal"), sizes)
        }
        SizeDistribution::List { diameters, weights } => {
            (Some("list"), vec![("diameters", list(diameters)), ("weights", list(weights))])
        }
    };
    if let Some(name) = distribution {
        table.put("distribution", Node { span, value: Value::Text(name.to_owned()) });
    }
    sizes.into_iter().for_each(|(key, node)| table.put(key, node));
    match kind.material {
        Material::Mass(mass) => table.put("mass", number(mass)),
        Material::Density(density) => table.put("density", number(density)),
    }
    Node { span, value: Value::Table(table) }
}
