//! Measurement sets.

use std::fs;

use configs::Color;
use measurements::MeasurementSet;

/// What stands between the three files of an input.
pub const BETWEEN: &[u8] = b"\n=====\n";

/// What comes of the set `bytes`, its `measurement.toml` and two tables with [`BETWEEN`] between them: one
/// that is accepted is written as one that reads back the same, one that is refused says why.
///
/// # Panics
/// Where that does not hold.
pub fn outcome(bytes: &[u8]) -> String {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut rest = bytes;
    for name in ["measurement.toml", "runs.csv", "trajectories.csv"] {
        let end = rest.windows(BETWEEN.len()).position(|window| window == BETWEEN);
        let (file, after) = match end {
            Some(end) => (&rest[..end], &rest[end + BETWEEN.len()..]),
            None => (rest, &[][..]),
        };
        fs::write(folder.path().join(name), file).expect("a temporary file");
        rest = after;
    }
    let here = folder.path().display().to_string();
    match MeasurementSet::load(folder.path()) {
        Ok(loaded) => {
            let again = folder.path().join("again");
            loaded.set.write(&again).expect("a set that was read can be written");
            let read = MeasurementSet::load(&again)
                .unwrap_or_else(|error| panic!("what it writes is refused: {error}"));
            assert_eq!(read.set.runs, loaded.set.runs);
            assert_eq!(read.set.conditions, loaded.set.conditions);
            loaded.describe()
        }
        Err(error) => {
            let said = error.render(Color::Off);
            assert!(!said.is_empty(), "refused without a word");
            said.replace(&here, "")
        }
    }
}
