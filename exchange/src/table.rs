//! A table of results as Apache Parquet: columns of numbers, counts and texts, with gaps.

use std::io::Write;
use std::path::Path;

use parquet::basic::{ConvertedType, Repetition, Type as Physical};
use parquet::column::writer::ColumnWriter;
use parquet::data_type::ByteArray;
use parquet::errors::{ParquetError, Result as Written};
use parquet::schema::types::Type;

use runner::campaign::{Cells, TableColumn};

use crate::export::ExportError;
use crate::export::parquet::{failed, writer};
use crate::export::whole_file::WholeFile;

/// Writes `columns` into the file `path`, whole or not at all. The same columns give the same bytes.
pub fn write_parquet(path: &Path, columns: &[TableColumn]) -> Result<(), ExportError> {
    let file = WholeFile::create(path.to_owned())?;
    written(file, columns).map_err(|error| failed(path, error))?.finish().map(drop)
}

fn written<W: Write + Send>(file: W, columns: &[TableColumn]) -> Written<W> {
    let mut writer = writer(file, columns.iter().map(field))?;
    let mut group = writer.next_row_group()?;
    for column in columns {
        let Some(mut into) = group.next_column()? else { break };
        match (into.untyped(), &column.cells) {
            (ColumnWriter::DoubleColumnWriter(into), Cells::Numbers(cells)) => {
                let (values, levels) = split(cells, |value| *value);
                into.write_batch(&values, Some(&levels), None)?;
            }
            (ColumnWriter::Int64ColumnWriter(into), Cells::Counts(cells)) => {
                let (values, levels) = split(cells, |value| *value);
                into.write_batch(&values, Some(&levels), None)?;
            }
            (ColumnWriter::ByteArrayColumnWriter(into), Cells::Texts(cells)) => {
                let (values, levels) = split(cells, |text| ByteArray::from(text.as_str()));
                into.write_batch(&values, Some(&levels), None)?;
            }
            (ColumnWriter::BoolColumnWriter(into), Cells::Flags(cells)) => {
                let (values, levels) = split(cells, |value| *value);
                into.write_batch(&values, Some(&levels), None)?;
            }
            _ => return Err(ParquetError::General("a column of another type".to_owned())),
        }
        into.close()?;
    }
    group.close()?;
    writer.into_inner()
}

fn field(column: &TableColumn) -> Written<Type> {
    let physical = match &column.cells {
        Cells::Numbers(_) => Physical::DOUBLE,
        Cells::Counts(_) => Physical::INT64,
        Cells::Texts(_) => Physical::BYTE_ARRAY,
        Cells::Flags(_) => Physical::BOOLEAN,
    };
    let mut builder =
        Type::primitive_type_builder(&column.name, physical).with_repetition(Repetition::OPTIONAL);
    if physical == Physical::BYTE_ARRAY {
        builder = builder.with_converted_type(ConvertedType::UTF8);
    }
    builder.build()
}

/// The values that are there, and for every cell whether one is.
fn split<T, U>(cells: &[Option<T>], value: impl Fn(&T) -> U) -> (Vec<U>, Vec<i16>) {
    let levels = cells.iter().map(|cell| i16::from(cell.is_some())).collect();
    (cells.iter().flatten().map(value).collect(), levels)
}

#[cfg(test)]
mod tests {
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::Field;

    use super::*;

    #[test]
    fn every_kind_of_cell_is_read_back_and_gaps_stay_gaps() {
        let column = |name: &str, cells| TableColumn { name: name.to_owned(), cells };
        let columns = [
            column("depth_m", Cells::Numbers(vec![Some(0.1), None])),
            column("point", Cells::Counts(vec![Some(1), Some(2)])),
            column("status", Cells::Texts(vec![None, Some("failed".to_owned())])),
            column("stopped", Cells::Flags(vec![Some(true), None])),
        ];
        let folder = tempfile::tempdir().expect("a folder");
        let [first, again] = ["a.parquet", "b.parquet"].map(|name| folder.path().join(name));
        for path in [&first, &again] {
            write_parquet(path, &columns).expect("a table");
        }
        let read = |path| std::fs::read(path).expect("a table");
        assert!(read(&first) == read(&again), "the same bytes");
        let file = std::fs::File::open(&first).expect("a table");
        let reader = SerializedFileReader::new(file).expect("a table");
        let rows: Vec<Vec<(String, Field)>> = reader
            .get_row_iter(None)
            .expect("rows")
            .map(|row| {
                let row = row.expect("a row");
                row.get_column_iter().map(|(name, field)| (name.clone(), field.clone())).collect()
            })
            .collect();
        let named = |name: &str, field| (name.to_owned(), field);
        assert_eq!(
            rows,
            [
                vec![
                    named("depth_m", Field::Double(0.1)),
                    named("point", Field::Long(1)),
                    named("status", Field::Null),
                    named("stopped", Field::Bool(true)),
                ],
                vec![
                    named("depth_m", Field::Null),
                    named("point", Field::Long(2)),
                    named("status", Field::Str("failed".to_owned())),
                    named("stopped", Field::Null),
                ],
            ]
        );
    }
}
