//! What no table holds, as the user says it.

use std::collections::BTreeMap;

/// Options of an import by their keys, each as it was typed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Options(BTreeMap<&'static str, String>);

impl Options {
    /// The keys, with what they mean: those of `import.toml`, and with `-` for `_` the flags of the command.
    pub const KEYS: [(&'static str, &'static str); 27] = [
        ("id", "the name of the set"),
        ("shape", "the shape of the body"),
        ("diameter", "the diameter of the body"),
        ("mass", "the mass of the body"),
        ("height", "the height of a cylinder or cone"),
        ("apex", "the full apex angle of a cone"),
        ("shaft_diameter", "the diameter of a shaft behind a cylinder, hemisphere or cone"),
        ("bodies", "a table of bodies"),
        ("surface", "the level of the surface on the axis of the table"),
        ("tracked", "the point of the body that was tracked"),
        ("counts", "the way that the axis counts"),
        ("scale", "the length of a pixel"),
        ("rate", "the frames per second"),
        ("length_unit", "the unit of positions"),
        ("time_unit", "the unit of times"),
        ("trust_units", "whether a fall at another acceleration than gravity is taken as it is"),
        ("gravity", "gravity"),
        ("drop_height", "the height of release above the surface"),
        ("condition", "the pattern of names that says which runs belong together"),
        ("leave_out", "runs that are left out"),
        ("column_t", "the column of times"),
        ("column_z", "the column of vertical positions"),
        ("column_x", "the column of horizontal positions"),
        ("column_run", "the column of runs"),
        ("bed_depth", "the depth of the bed"),
        ("bulk_density", "the bulk density of the bed"),
        ("grain_diameter", "the mean diameter of the grains"),
    ];

    /// Sets an option; an unknown key is ignored.
    pub fn set(&mut self, key: &str, value: impl Into<String>) {
        if let Some((known, _)) = Self::KEYS.iter().find(|(known, _)| *known == key) {
            self.0.insert(known, value.into());
        }
    }

    /// Takes over every option of `other`.
    pub fn take(&mut self, other: Self) {
        self.0.extend(other.0);
    }

    /// The option as it was typed.
    pub fn get(&self, key: &str) -> Option<&str> {
        self.0.get(key).map(String::as_str)
    }

    /// Those that are set, in the order of [`Options::KEYS`].
    pub(super) fn given(&self) -> impl Iterator<Item = (&'static str, &str)> {
        Self::KEYS.iter().filter_map(|(key, _)| Some((*key, self.get(key)?)))
    }
}

/// How the option `key` is written on a command line.
pub(super) fn flag(key: &str) -> String {
    match key.strip_prefix("column_") {
        Some(column) => format!("--column {column}="),
        None if key == "counts" => "--up or --down".to_owned(),
        None => format!("--{}", key.replace('_', "-")),
    }
}
