//! Clouds of points in a log: numbers of 32 bits side by side, by the names that each cloud carries.

use prost_reflect::{DynamicMessage, FieldDescriptor, MessageDescriptor, Value};

/// Bytes of a number.
const WIDTH: usize = 4;

/// The type of an unsigned number in Foxglove's schema; those of others are floats here.
const UINT32: usize = 5;

/// Reads messages `foxglove.PointCloud`.
#[derive(Clone, Debug)]
pub(crate) struct CloudReader {
    message: MessageDescriptor,
    timestamp: FieldDescriptor,
    stride: FieldDescriptor,
    fields: FieldDescriptor,
    data: FieldDescriptor,
}

/// One cloud.
#[derive(Clone, Debug)]
pub(crate) struct Cloud {
    /// Simulated time (s).
    pub(crate) time: f64,
    /// What every point has, in the order of the message.
    pub(crate) columns: Vec<CloudColumn>,
    stride: usize,
    data: Value,
}

/// A number that every point of a cloud has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct CloudColumn {
    pub(crate) name: String,
    /// Whether it is an identifier rather than a quantity.
    pub(crate) counts: bool,
    offset: usize,
}

impl CloudReader {
    /// A reader of messages of this kind.
    ///
    /// # Errors
    /// What the message lacks, in a sentence.
    pub(crate) fn of(message: &MessageDescriptor) -> Result<Self, String> {
        let field = |name: &str| {
            let found = message.get_field_by_name(name);
            found.ok_or_else(|| format!("{} has no field `{name}`", message.full_name()))
        };
        Ok(Self {
            timestamp: field("timestamp")?,
            stride: field("point_stride")?,
            fields: field("fields")?,
            data: field("data")?,
            message: message.clone(),
        })
    }

    /// The cloud that `data` encodes.
    pub(crate) fn read(&self, data: &[u8]) -> Result<Cloud, String> {
        let message =
            DynamicMessage::decode(self.message.clone(), data).map_err(|e| e.to_string())?;
        let stride = message.get_field(&self.stride).as_u32().unwrap_or(0) as usize;
        let fields = message.get_field(&self.fields);
        let column = |field: &Value| {
            let offset = number_of(field, "offset").unwrap_or(0);
            let counts = number_of(field, "type") == Some(UINT32);
            let name = text_of(field, "name").filter(|_| offset + WIDTH <= stride)?;
            Some(CloudColumn { name, counts, offset })
        };
        let columns: Vec<_> = fields.as_list().unwrap_or(&[]).iter().filter_map(column).collect();
        let data = message.get_field(&self.data).into_owned();
        if columns.is_empty() || data.as_bytes().is_none() {
            return Err("its points hold nothing".to_owned());
        }
        let time = seconds(message.get_field(&self.timestamp).as_ref());
        Ok(Cloud { time, columns, stride, data })
    }
}

impl Cloud {
    /// The column called `name`.
    ///
    /// # Errors
    /// That it is missing, in a sentence.
    pub(crate) fn column(&self, name: &str) -> Result<&CloudColumn, String> {
        let found = self.columns.iter().find(|column| column.name == name);
        found.ok_or_else(|| format!("its points have no `{name}`"))
    }

    /// The points, each as its bytes.
    pub(crate) fn points(&self) -> impl Iterator<Item = &[u8]> {
        let data = self.data.as_bytes().map_or(&[][..], |bytes| &bytes[..]);
        data.chunks_exact(self.stride)
    }
}

impl CloudColumn {
    /// The quantity in a point.
    pub(crate) fn quantity(&self, point: &[u8]) -> f32 {
        f32::from_le_bytes(self.word(point))
    }

    /// The identifier in a point.
    pub(crate) fn count(&self, point: &[u8]) -> u32 {
        u32::from_le_bytes(self.word(point))
    }

    fn word(&self, point: &[u8]) -> [u8; WIDTH] {
        std::array::from_fn(|byte| point[self.offset + byte])
    }
}

/// A timestamp of a log (s).
fn seconds(timestamp: &Value) -> f64 {
    let part = |name: &str| number_of(timestamp, name).unwrap_or(0) as f64;
    part("seconds") + 1e-9 * part("nanos")
}

fn number_of(message: &Value, field: &str) -> Option<usize> {
    match message.as_message()?.get_field_by_name(field)?.as_ref() {
        Value::U32(number) => Some(*number as usize),
        Value::I32(number) | Value::EnumNumber(number) => usize::try_from(*number).ok(),
        Value::I64(number) => usize::try_from(*number).ok(),
        _ => None,
    }
}

fn text_of(message: &Value, field: &str) -> Option<String> {
    message.as_message()?.get_field_by_name(field)?.as_str().map(str::to_owned)
}
