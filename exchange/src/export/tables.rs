//! Topics of scalars as tables: one row per message, one column per number.

use std::path::{Path, PathBuf};

use prost_reflect::{DynamicMessage, FieldDescriptor, Kind, MessageDescriptor, Value};

use super::{ExportError, Exported};
use crate::Stop;
use crate::frames::cloud::{CloudColumn, CloudReader};
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

/// Writes every topic of scalars and every cloud of points in the log at `path` into a folder, with tables of
/// one kind.
pub(super) fn export(
    path: &Path,
    (out, create): (&Path, Create),
    stop: Stop<'_>,
) -> Result<Exported, ExportError> {
    let mut tables = Tables { out, create, stop, sinks: Vec::new(), failed: None };
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
    stop: Stop<'a>,
    sinks: Vec<Box<dyn Sink>>,
    failed: Option<ExportError>,
}

/// A topic that becomes a table.
enum Topic {
    Scalars(Scalars),
    Points(Points),
}

/// A message per row of the table `sink`.
struct Scalars {
    sink: usize,
    message: MessageDescriptor,
    fields: Vec<Field>,
    row: Vec<Cell>,
}

/// A point per row, behind the time of its cloud. What points have is known from the first cloud on.
struct Points {
    reader: CloudReader,
    name: String,
    table: Option<(usize, Vec<CloudColumn>)>,
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
        let name = topic.trim_start_matches('/').replace('/', "_");
        if message.full_name() == "foxglove.PointCloud" {
            let (reader, row) = (CloudReader::of(message)?, Vec::new());
            return Ok(Some(Topic::Points(Points { reader, name, table: None, row })));
        }
        let Some((columns, fields)) = columns(message) else { return Ok(None) };
        let Some(sink) = self.open(&name, &columns) else {
            return Err("its table cannot be written".to_owned());
        };
        let (message, row) = (message.clone(), Vec::with_capacity(columns.len()));
        Ok(Some(Topic::Scalars(Scalars { sink, message, fields, row })))
    }

    fn receive(&mut self, topic: &mut Topic, data: &[u8]) -> Result<(), Refusal> {
        if (self.stop)() {
            self.failed = Some(ExportError::Stopped);
            return Err(Refusal::Stop);
        }
        match topic {
            Topic::Scalars(scalars) => self.message(scalars, data),
            Topic::Points(points) => self.cloud(points, data),
        }
    }
}

impl Tables<'_> {
    /// The place of a new table; `None` if it cannot be written.
    fn open(&mut self, name: &str, columns: &[Column]) -> Option<usize> {
        match (self.create)(self.out.join(name), columns) {
            Ok(sink) => self.sinks.push(sink),
            Err(error) => {
                self.failed = Some(error);
                return None;
            }
        }
        Some(self.sinks.len() - 1)
    }

    fn message(&mut self, topic: &mut Scalars, data: &[u8]) -> Result<(), Refusal> {
        let message = DynamicMessage::decode(topic.message.clone(), data)
            .map_err(|error| Refusal::Damaged(error.to_string()))?;
        topic.row.clear();
        topic.row.extend(topic.fields.iter().map(|field| field.of(&message)));
        self.row(topic.sink, &topic.row)
    }

    fn cloud(&mut self, topic: &mut Points, data: &[u8]) -> Result<(), Refusal> {
        let cloud = topic.reader.read(data).map_err(Refusal::Damaged)?;
        if topic.table.is_none() {
            let time = Column { name: "time_s".to_owned(), counts: false };
            let columns: Vec<_> =
                std::iter::once(time).chain(cloud.columns.iter().map(of_points)).collect();
            let sink = self.open(&topic.name, &columns).ok_or(Refusal::Stop)?;
            topic.table = Some((sink, cloud.columns.clone()));
        }
        let Some((sink, columns)) = &topic.table else { return Ok(()) };
        if *columns != cloud.columns {
            return Err(Refusal::Damaged("its points change what they hold".to_owned()));
        }
        for point in cloud.points() {
            topic.row.clear();
            topic.row.push(Cell::Number(cloud.time));
            topic.row.extend(columns.iter().map(|column| match column.counts {
                true => Cell::Count(u64::from(column.count(point))),
                false => Cell::Number(f64::from(column.quantity(point))),
            }));
            self.row(*sink, &topic.row)?;
        }
        Ok(())
    }

    fn row(&mut self, sink: usize, cells: &[Cell]) -> Result<(), Refusal> {
        self.sinks[sink].row(cells).map_err(|error| {
            self.failed = Some(error);
            Refusal::Stop
        })
    }
}

/// A column of points, whose name says its unit.
fn of_points(column: &CloudColumn) -> Column {
    let unit = match column.name.as_str() {
        "x" | "y" | "z" | "radius" => "_m",
        "vx" | "vy" | "vz" | "speed" => "_m_per_s",
        "force" => "_N",
        _ => "",
    };
    Column { name: format!("{}{unit}", column.name), counts: column.counts }
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
