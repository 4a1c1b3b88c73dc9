//! The log's own messages: their descriptors and their encoding.
//!
//! A message is a list of fields; the descriptor numbers them 1, 2, 3 … and [`Fields`] writes them
//! in the same order, so a name lives in one place. Every field is written, zeros too: a viewer
//! then never has to guess a default.

use prost::Message as _;
use prost::encoding::{WireType, double, encode_key, encode_varint, uint32, uint64};
use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::{DescriptorProto, FieldDescriptorProto, FileDescriptorProto, FileDescriptorSet};

use crate::math::Vec3;

/// The closure that the energy terms obey, as text.
fn closure_identity(terms: &[String]) -> String {
    let mut sum = String::new();
    for term in terms {
        let input = term.starts_with("input_");
        match (sum.is_empty(), input) {
            (true, false) => {}
            (true, true) => sum.push('-'),
            (false, false) => sum.push_str(" + "),
            (false, true) => sum.push_str(" - "),
        }
        sum.push_str(term);
    }
    format!("{sum} = (its value at the first step) + unaccounted_J")
}

pub(super) fn snake_case(name: &str) -> String {
    name.replace('-', "_")
}

/// What a field holds.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum FieldKind {
    /// uint64
    Step,
    /// uint32
    Count,
    /// double
    Number,
    /// `plunge.Vector3`
    Vector,
}

/// A message of the log: full name and fields in order of their numbers.
pub(super) struct Layout {
    pub(super) name: &'static str,
    pub(super) fields: Vec<(String, FieldKind)>,
}

impl Layout {
    /// Starts with the two fields every message has, `step` and `time_s`.
    fn new(name: &'static str) -> Self {
        let fields =
            vec![("step".to_owned(), FieldKind::Step), ("time_s".to_owned(), FieldKind::Number)];
        Self { name, fields }
    }

    fn with(mut self, name: &str, kind: FieldKind) -> Self {
        self.fields.push((name.to_owned(), kind));
        self
    }

    /// `plunge.EnergyBudget`, one number per term.
    fn energy_budget(terms: &[String]) -> Self {
        Self::new("plunge.EnergyBudget")
            .with("unaccounted_J", FieldKind::Number)
            .with("closure", FieldKind::Number)
            .with_numbers(terms)
    }

    /// The same where not all terms are known, so that nothing can be missing of them.
    fn known_energies(terms: &[String]) -> Self {
        Self::new("plunge.EnergyBudget").with_numbers(terms)
    }

    fn with_numbers(self, names: &[String]) -> Self {
        names.iter().fold(self, |layout, name| layout.with(name, FieldKind::Number))
    }

    /// `plunge.IntruderState`.
    pub(super) fn intruder_state() -> Self {
        Self::new("plunge.IntruderState")
            .with("depth_m", FieldKind::Number)
            .with("speed_m_per_s", FieldKind::Number)
            .with("position", FieldKind::Vector)
            .with("velocity", FieldKind::Vector)
            .with("spin", FieldKind::Vector)
    }

    /// `plunge.IntruderLoad`, a force and a torque per origin.
    fn intruder_load(origins: &[String]) -> Self {
        Self::new("plunge.IntruderLoad")
            .with("contacts", FieldKind::Count)
            .with("area_m2", FieldKind::Number)
            .with_loads(origins)
    }

    /// The same where nothing is known of what touches.
    fn intruder_forces(origins: &[String]) -> Self {
        Self::new("plunge.IntruderLoad").with_loads(origins)
    }

    fn with_loads(self, origins: &[String]) -> Self {
        origins.iter().fold(self, |layout, origin| {
            let origin = snake_case(origin);
            layout
                .with(&origin, FieldKind::Vector)
                .with(&format!("{origin}_torque"), FieldKind::Vector)
        })
    }

    /// `plunge.CollisionalEstimate`, of the force of a bed of grains on a body.
    pub(super) fn estimate() -> Self {
        Self::new("plunge.CollisionalEstimate")
            .with("geometric_area_m2", FieldKind::Number)
            .with("magnitudes_N", FieldKind::Number)
            .with("force", FieldKind::Vector)
    }

    /// `plunge.BedActivity`.
    pub(super) fn bed_activity() -> Self {
        Self::new("plunge.BedActivity").with("moving_share", FieldKind::Number)
    }

    /// The first name that is used twice or is no protobuf identifier.
    pub(super) fn bad_name(&self) -> Option<&str> {
        let names = || self.fields.iter().map(|(name, _)| name.as_str());
        names().enumerate().find_map(|(i, name)| {
            let twice = names().take(i).any(|earlier| earlier == name);
            let starts = name.starts_with(|c: char| c.is_ascii_alphabetic());
            let rest = name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
            (twice || !starts || !rest).then_some(name)
        })
    }

    /// The serialized `FileDescriptorSet`, complete in itself.
    pub(super) fn descriptor_set(&self) -> Vec<u8> {
        let vector = file("plunge/Vector3.proto", "Vector3", &xyz(), &[]);
        let short = self.name.rsplit('.').next().unwrap_or(self.name);
        let path = format!("plunge/{short}.proto");
        let message = file(&path, short, &self.fields, &["plunge/Vector3.proto"]);
        FileDescriptorSet { file: vec![vector, message] }.encode_to_vec()
    }
}

/// The messages that say more of a run of the engine than of one of another program.
pub(super) struct Layouts {
    pub(super) budget: Layout,
    pub(super) load: Layout,
    /// What the terms of the budget add up to, where they are all there are.
    pub(super) closure_identity: Option<String>,
}

impl Layouts {
    /// Of a run of the engine with these energy terms and origins of force.
    pub(super) fn of(terms: &[String], origins: &[String]) -> Self {
        Self {
            budget: Layout::energy_budget(terms),
            load: Layout::intruder_load(origins),
            closure_identity: Some(closure_identity(terms)),
        }
    }

    /// Of a run of another program.
    pub(super) fn imported(terms: &[String], origins: &[String]) -> Self {
        Self {
            budget: Layout::known_energies(terms),
            load: Layout::intruder_forces(origins),
            closure_identity: None,
        }
    }
}

/// Writes the fields of one message in the order of its [`Layout`].
pub(super) struct Fields<'a> {
    buffer: &'a mut Vec<u8>,
    tag: u32,
}

impl<'a> Fields<'a> {
    /// Empties the buffer, keeping its memory, and writes the two common fields.
    pub(super) fn begin(buffer: &'a mut Vec<u8>, step: u64, time_s: f64) -> Self {
        buffer.clear();
        uint64::encode(1, &step, buffer);
        double::encode(2, &time_s, buffer);
        Self { buffer, tag: 2 }
    }

    pub(super) fn count(&mut self, value: u32) {
        self.tag += 1;
        uint32::encode(self.tag, &value, self.buffer);
    }

    pub(super) fn number(&mut self, value: f64) {
        self.tag += 1;
        double::encode(self.tag, &value, self.buffer);
    }

    pub(super) fn vector(&mut self, value: &Vec3) {
        /// Three doubles with their one-byte keys.
        const LENGTH: u64 = 3 * (1 + 8);
        self.tag += 1;
        encode_key(self.tag, WireType::LengthDelimited, self.buffer);
        encode_varint(LENGTH, self.buffer);
        double::encode(1, &value.x, self.buffer);
        double::encode(2, &value.y, self.buffer);
        double::encode(3, &value.z, self.buffer);
    }
}

fn xyz() -> Vec<(String, FieldKind)> {
    ["x", "y", "z"].map(|axis| (axis.to_owned(), FieldKind::Number)).to_vec()
}

fn file(
    path: &str,
    message: &str,
    fields: &[(String, FieldKind)],
    imports: &[&str],
) -> FileDescriptorProto {
    let needed = fields.iter().any(|(_, kind)| *kind == FieldKind::Vector);
    let dependency =
        if needed { imports.iter().map(|&import| import.to_owned()).collect() } else { vec![] };
    FileDescriptorProto {
        name: Some(path.to_owned()),
        package: Some("plunge".to_owned()),
        dependency,
        message_type: vec![DescriptorProto {
            name: Some(message.to_owned()),
            field: (1..)
                .zip(fields)
                .map(|(number, (name, kind))| field(number, name, *kind))
                .collect(),
            ..Default::default()
        }],
        syntax: Some("proto3".to_owned()),
        ..Default::default()
    }
}

fn field(number: i32, name: &str, kind: FieldKind) -> FieldDescriptorProto {
    let mut field = FieldDescriptorProto {
        name: Some(name.to_owned()),
        json_name: Some(name.to_owned()),
        number: Some(number),
        ..Default::default()
    };
    field.set_label(Label::Optional);
    field.set_type(match kind {
        FieldKind::Step => Type::Uint64,
        FieldKind::Count => Type::Uint32,
        FieldKind::Number => Type::Double,
        FieldKind::Vector => Type::Message,
    });
    if kind == FieldKind::Vector {
        field.type_name = Some(".plunge.Vector3".to_owned());
    }
    field
}
