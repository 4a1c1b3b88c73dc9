//! Tables as Apache Parquet.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use parquet::basic::{Compression, Repetition, Type as Physical, ZstdLevel};
use parquet::data_type::{DoubleType, Int64Type};
use parquet::errors::{ParquetError, Result as Written};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

use super::ExportError;
use super::tables::{Cell, Column, Sink};
use super::whole_file::WholeFile;

/// Rows that are held before they are written.
const ROWS: usize = 1 << 16;

/// A table whose rows are written by the group.
pub(super) struct Parquet {
    path: PathBuf,
    writer: SerializedFileWriter<WholeFile>,
    columns: Vec<Values>,
    rows: usize,
}

/// What a column holds before it is written.
enum Values {
    Numbers(Vec<f64>),
    Counts(Vec<i64>),
}

impl Parquet {
    pub(super) fn create(path: PathBuf, columns: &[Column]) -> Result<Box<dyn Sink>, ExportError> {
        let path = path.with_added_extension("parquet");
        let file = WholeFile::create(path.clone())?;
        let writer =
            writer(file, columns.iter().map(field)).map_err(|error| failed(&path, error))?;
        let empty = |column: &Column| match column.counts {
            true => Values::Counts(Vec::new()),
            false => Values::Numbers(Vec::new()),
        };
        Ok(Box::new(Self { path, writer, columns: columns.iter().map(empty).collect(), rows: 0 }))
    }

    fn write_group(&mut self) -> Written<()> {
        let mut group = self.writer.next_row_group()?;
        for values in &mut self.columns {
            let Some(mut column) = group.next_column()? else { break };
            match values {
                Values::Numbers(numbers) => {
                    column.typed::<DoubleType>().write_batch(numbers, None, None)?;
                    numbers.clear();
                }
                Values::Counts(counts) => {
                    column.typed::<Int64Type>().write_batch(counts, None, None)?;
                    counts.clear();
                }
            }
            column.close()?;
        }
        self.rows = 0;
        group.close().map(drop)
    }
}

fn field(column: &Column) -> Written<Type> {
    let physical = if column.counts { Physical::INT64 } else { Physical::DOUBLE };
    let builder = Type::primitive_type_builder(&column.name, physical);
    builder.with_repetition(Repetition::REQUIRED).build()
}

/// Writes columns that are described by `fields` to `file`.
pub(crate) fn writer<W: Write + Send>(
    file: W,
    fields: impl Iterator<Item = Written<Type>>,
) -> Written<SerializedFileWriter<W>> {
    let properties = WriterProperties::builder()
        .set_created_by(format!("plunge {}", env!("CARGO_PKG_VERSION")))
        .set_compression(Compression::ZSTD(ZstdLevel::default()))
        .build();
    let fields = fields.map(|field| field.map(Arc::new)).collect::<Written<_>>()?;
    let schema = Type::group_type_builder("schema").with_fields(fields).build()?;
    SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties))
}

pub(crate) fn failed(path: &Path, error: ParquetError) -> ExportError {
    ExportError::Write { path: path.to_owned(), source: std::io::Error::other(error) }
}

impl Sink for Parquet {
    fn row(&mut self, cells: &[Cell]) -> Result<(), ExportError> {
        for (values, cell) in self.columns.iter_mut().zip(cells) {
            match (values, *cell) {
                (Values::Numbers(numbers), Cell::Number(number)) => numbers.push(number),
                // Counts of steps and contacts stay far below 2^63.
                (Values::Counts(counts), Cell::Count(count)) => counts.push(count as i64),
                (Values::Numbers(numbers), Cell::Count(count)) => numbers.push(count as f64),
                (Values::Counts(counts), Cell::Number(number)) => counts.push(number as i64),
            }
        }
        self.rows += 1;
        if self.rows < ROWS {
            return Ok(());
        }
        self.write_group().map_err(|error| failed(&self.path, error))
    }

    fn finish(mut self: Box<Self>) -> Result<PathBuf, ExportError> {
        if self.rows > 0 {
            self.write_group().map_err(|error| failed(&self.path, error))?;
        }
        let Self { path, writer, .. } = *self;
        writer.into_inner().map_err(|error| failed(&path, error))?.finish()
    }
}
