//! A model as the files of a run have it: with its table of grains beside it, and one impact of a list alone.

use std::path::Path;

use toml_edit::{DocumentMut, value};

use crate::load::{ConfigError, LoadOptions, ModelSource};
use crate::model::{BedSource, Condition, CsvBed, Model};

impl Model {
    /// The resolved model that reads its table of grains, if it has one, from the file `table`.
    pub fn toml_with_table(&self, table: &str) -> String {
        self.edited(|document| {
            if self.csv().is_some() {
                document["bed"]["file"] = value(table);
            }
        })
    }

    /// The table of grains that its bed is read from; none if the bed settles.
    pub fn csv(&self) -> Option<&CsvBed> {
        match &self.grains()?.medium.bed.source {
            BedSource::Csv(csv) => Some(csv),
            BedSource::Settle(_) => None,
        }
    }

    /// This model with the single impact `condition`; `folder` holds its table of grains, if it has
    /// one, as the file `table`.
    ///
    /// # Errors
    /// If the table cannot be read there.
    pub fn single(
        &self,
        condition: &Condition,
        folder: &Path,
        table: &str,
    ) -> Result<Self, ConfigError> {
        let text = self.edited(|document| {
            document.remove("conditions");
            let impact = &mut document[self.impact.table()];
            impact["speed"] = value(format!("{} m/s", condition.speed));
            impact["angle"] = value(format!("{} rad", condition.angle_rad));
            if let Some(grains) = self.grains() {
                impact["x"] = value(format!("{} m", grains.start_x(condition)));
            }
            if self.csv().is_some() {
                document["bed"]["file"] = value(table);
            }
        });
        let source = ModelSource::Text {
            name: format!("one impact of {}", self.run.name),
            text,
            folder: folder.to_owned(),
        };
        Ok(Self::load(source, &LoadOptions::default())?.model)
    }

    fn edited(&self, edit: impl FnOnce(&mut DocumentMut)) -> String {
        let mut document: DocumentMut =
            self.resolved_toml().parse().expect("the resolved model is TOML");
        edit(&mut document);
        document.to_string()
    }
}
