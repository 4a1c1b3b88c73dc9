//! The measurement sets that come with the program.

/// A set that comes with the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShippedSet {
    /// Its name on the command line, and of its folder.
    pub name: &'static str,
    /// One line about it.
    pub summary: &'static str,
    /// Names and texts of its files.
    pub files: &'static [(&'static str, &'static str)],
}

/// The set in the folder `$name` of `validation/data`, with these tables.
macro_rules! set {
    ($name:literal, $summary:literal, $($table:literal),+) => {
        ShippedSet {
            name: $name,
            summary: $summary,
            files: &[
                file!($name, "measurement.toml"),
                $(file!($name, $table)),+
            ],
        }
    };
}

macro_rules! file {
    ($set:literal, $name:literal) => {
        ($name, include_str!(concat!("../../validation/data/", $set, "/", $name)))
    };
}

/// All of them; a line here makes one known.
pub static SHIPPED_SETS: &[ShippedSet] = &[
    set!(
        "s1-tables-vertical",
        "A disc straight down: published depths and stopping times.",
        "runs.csv"
    ),
    set!("s1-tables", "The same at seven angles, with ranges.", "runs.csv"),
    set!("katsuragi-durian", "A sphere into beads: a published force law.", "runs.csv"),
    set!("free-link", "A rod dropped end first: stopping times.", "runs.csv"),
    set!("real-balls", "29 drops of five balls into powder.", "runs.csv"),
    set!(
        "real-penetrometer",
        "Eight drops of a penetrometer into the sea bed.",
        "runs.csv",
        "trajectories.csv"
    ),
    set!(
        "real-plates-silt",
        "30 pushes of two plates into silt: forces over depth.",
        "runs.csv",
        "forces.csv"
    ),
    set!("real-plates-simulant", "The same into a lunar simulant.", "runs.csv", "forces.csv"),
    set!(
        "real-water-cones",
        "53 drops of cones into water: paths.",
        "runs.csv",
        "trajectories.csv"
    ),
    set!(
        "real-water-cones-acceleration",
        "The same as an accelerometer reads them.",
        "runs.csv",
        "accelerations.csv"
    ),
];

/// The one called `name`.
pub fn find(name: &str) -> Option<&'static ShippedSet> {
    SHIPPED_SETS.iter().find(|set| set.name == name)
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;

    use super::*;

    #[test]
    fn every_set_of_the_repository_ships_with_all_its_files() {
        let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../validation/data");
        let names = |folder: &Path| {
            let entries = fs::read_dir(folder).expect("a folder");
            let mut names: Vec<String> = entries
                .map(|entry| entry.expect("an entry").file_name().display().to_string())
                .collect();
            names.sort();
            names
        };
        let mut shipped: Vec<&str> = SHIPPED_SETS.iter().map(|set| set.name).collect();
        shipped.sort_unstable();
        assert_eq!(names(&data), shipped);
        for set in SHIPPED_SETS {
            let mut files: Vec<&str> = set.files.iter().map(|(name, _)| *name).collect();
            files.sort_unstable();
            assert_eq!(names(&data.join(set.name)), files, "{}", set.name);
            assert_eq!(find(set.name), Some(set));
        }
    }
}
