//! Topics of scalars as tables: one row per message, one column per number.

use std::path::{Path, PathBuf};

use prost_reflect::{DynamicMessage, FieldDescriptor, Kind, MessageDescriptor, Value};

use super::{ExportError, Exported};
use crate::read::messages::{Receiver, Refusal, each_message};

/// A number in a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cell {
    /// A quantity, in the unit of its column.
    Number(f64),
    /// A count.
    Count(u64),
}

/// A column: its name, with its unit, and whether it counts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Column {
    pub(super) name: String,
    pub(super) counts: bool,
}

/// A table that is being written.
pub(super) trait Sink {
    /// One more row, a cell per column.
    fn row(&mut self, cells: &[Cell]) -> Result<(), ExportError>;
    /// Completes the file and says where it is.
    fn finish(self: Box<Self>) -> Result<PathBuf, ExportError>;
}

/// Opens the table called by the path without an ending, with these columns.
type Create = fn(PathBuf, &[Column]) -> Result<Box<dyn Sink>, ExportError>;

/// Writes every topic of scalars in the log at `path` into the folder `out`.
pub(super) fn export(path: &Path, out: &Path, create: Create) -> Result<Exported, ExportError> {
    let mut tables = Tables { out, create, sinks: Vec::new(), failed: None };
    let read = each_message(path, &mut tables);
    if let Some(error) = tables.failed {
        return Err(error);
    }
    let complete = read?;
    if tables.sinks.is_empty() {
        return Err(ExportError::Nothing { path: path.to_owned(), what: "topic of scalars" });
    }
    let files = tables.sinks.into_iter().map(|sink| sink.finish());
    Ok(Exported { files: files.collect::<Result<_, _>>()?, complete })
}

struct Tables<'a> {
    out: &'a Path,
    create: Create,
    sinks: Vec<Box<dyn Sink>>,
    failed: Option<ExportError>,
}

/// A topic that becomes the table `sink`.
struct Topic {
    sink: usize,
    message: MessageDescriptor,
    fields: Vec<Field>,
    row: Vec<Cell>,
}

/// Where a column is found in a message: a field, or a component of one.
struct Field {
    field: FieldDescriptor,
    component: Option<FieldDescriptor>,
}

impl Receiver for Tables<'_> {
    type Channel = Topic;

    fn introduce(
        &mut self,
        topic: &str,
        message: &MessageDescriptor,
    ) -> Result<Option<Topic>, String> {
        let Some((columns, fields)) = columns(message) else { return Ok(None) };
        let name = topic.trim_start_matches('/').replace('/', "_");
        match (self.create)(self.out.join(name), &columns) {
            Ok(sink) => self.sinks.push(sink),
            Err(error) => {
                self.failed = Some(error);
                return Err("its table cannot be written".to_owned());
            }
        }
        let (sink, message) = (self.sinks.len() - 1, message.clone());
        Ok(Some(Topic { sink, message, fields, row: Vec::with_capacity(columns.len()) }))
    }

    fn receive(&mut self, topic: &mut Topic, data: &[u8]) -> Result<(), Refusal> {
        let message = DynamicMessage::decode(topic.message.clone(), data)
            .map_err(|error| Refusal::Damaged(error.to_string()))?;
        topic.row.clear();
        topic.row.extend(topic.fields.iter().map(|field| field.of(&message)));
        self.sinks[topic.sink].row(&topic.row).map_err(|error| {
            self.failed = Some(error);
            Refusal::Stop
        })
    }
}

/// The columns of a message of ours that is made of numbers and vectors alone; `None` of others.
fn columns(message: &MessageDescriptor) -> Option<(Vec<Column>, Vec<Field>)> {
    if message.package_name() != "plunge" {
        return None;
    }
    let (mut columns, mut fields) = (Vec::new(), Vec::new());
    for field in message.fields() {
        if field.is_list() || field.is_map() {
            return None;
        }
        match field.kind() {
            Kind::Double | Kind::Uint64 | Kind::Uint32 => {
                let counts = field.kind() != Kind::Double;
                columns.push(Column { name: field.name().to_owned(), counts });
                fields.push(Field { field, component: None });
            }
            Kind::Message(vector) => {
                for component in vector.fields() {
                    if component.kind() != Kind::Double || component.is_list() {
                        return None;
                    }
                    let name = named(field.name(), component.name());
                    columns.push(Column { name, counts: false });
                    fields.push(Field { field: field.clone(), component: Some(component) });
                }
            }
            _ => return None,
        }
    }
    Some((columns, fields))
}

/// The name of a component of a vector, with its unit: those of other names are forces.
fn named(vector: &str, component: &str) -> String {
    let unit = match vector {
        "position" => "m",
        "velocity" => "m_per_s",
        "spin" => "rad_per_s",
        torque if torque.ends_with("_torque") => "N_m",
        _ => "N",
    };
    format!("{vector}_{component}_{unit}")
}

impl Field {
    /// The cell of `message`; 0 where it leaves the field out, as in proto3.
    fn of(&self, message: &DynamicMessage) -> Cell {
        let value = message.get_field(&self.field);
        match (&self.component, value.as_ref()) {
            (Some(component), Value::Message(vector)) => {
                Cell::Number(vector.get_field(component).as_f64().unwrap_or(0.0))
            }
            (_, Value::U64(count)) => Cell::Count(*count),
            (_, Value::U32(count)) => Cell::Count(u64::from(*count)),
            (_, value) => Cell::Number(value.as_f64().unwrap_or(0.0)),
        }
    }
}
