//! Tables as text, separated by commas.

use std::path::PathBuf;

use super::ExportError;
use super::tables::{Cell, Column, Sink};
use super::whole_file::WholeFile;

/// A table as text. A number reads back to the same bits.
pub(super) struct Csv(csv::Writer<WholeFile>);

impl Csv {
    pub(super) fn create(path: PathBuf, columns: &[Column]) -> Result<Box<dyn Sink>, ExportError> {
        let file = WholeFile::create(path.with_added_extension("csv"))?;
        let mut table = Self(csv::Writer::from_writer(file));
        let header = columns.iter().map(|column| &column.name);
        let written = table.0.write_record(header);
        table.checked(written)?;
        Ok(Box::new(table))
    }

    fn checked(&self, written: csv::Result<()>) -> Result<(), ExportError> {
        written.map_err(|error| self.0.get_ref().failed(std::io::Error::other(error)))
    }
}

impl Sink for Csv {
    fn row(&mut self, cells: &[Cell]) -> Result<(), ExportError> {
        let written = self.0.write_record(cells.iter().map(|cell| match cell {
            Cell::Number(number) => format!("{number:?}"),
            Cell::Count(count) => count.to_string(),
        }));
        self.checked(written)
    }

    fn finish(self: Box<Self>) -> Result<PathBuf, ExportError> {
        let path = self.0.get_ref().path().to_owned();
        match self.0.into_inner() {
            Ok(file) => file.finish(),
            Err(error) => Err(ExportError::Write { path, source: error.into_error() }),
        }
    }
}
