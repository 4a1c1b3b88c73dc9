//! Every defective set is refused, or understood, with the message beside it.

use std::fs;
use std::path::{Path, PathBuf};

use configs::Color;
use validation::measurement::MeasurementSet;

/// The folders in `tests/data/<group>`, sorted; relative, so that messages are the same everywhere.
fn folders(group: &str) -> Vec<PathBuf> {
    let mut folders: Vec<PathBuf> = fs::read_dir(Path::new("tests/data").join(group))
        .expect("the folder is part of the repository")
        .map(|entry| entry.expect("a readable folder").path())
        .filter(|path| path.is_dir())
        .collect();
    folders.sort();
    folders
}

/// What a user is told about the set in `folder`.
fn told(folder: &Path) -> String {
    match MeasurementSet::load(folder) {
        Err(error) => error.render(Color::Off),
        Ok(loaded) => {
            let mut text = String::from("accepted\n");
            for line in loaded.tables.iter().chain(&loaded.set.notes) {
                text.push_str(&format!("{line}\n"));
            }
            text + &loaded.render_warnings(Color::Off)
        }
    }
}

/// With `BLESS=1` in the environment the messages beside the sets are rewritten.
fn compare(group: &str) {
    let bless = std::env::var_os("BLESS").is_some();
    let mut wrong = String::new();
    for folder in folders(group) {
        let (told, beside) = (told(&folder), folder.join("expected.txt"));
        if bless {
            fs::write(&beside, &told).expect("a writable repository");
        }
        let expected = fs::read_to_string(&beside).unwrap_or_default();
        if told != expected {
            wrong.push_str(&format!("{}:\n{told}\nexpected:\n{expected}\n", folder.display()));
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn every_defect_of_a_table_is_told_as_the_message_beside_it() {
    compare("bad-csv");
}

#[test]
fn every_defect_of_a_measurement_toml_is_told_as_the_message_beside_it() {
    compare("bad-set");
}

#[test]
fn what_differs_in_form_alone_reads_to_the_same_set() {
    let load = |name: &str| {
        let folder = Path::new("tests/data/bad-csv").join(name);
        MeasurementSet::load(&folder).unwrap_or_else(|error| panic!("{error}")).set
    };
    let plain = load("no-last-line-end");
    for name in
        ["byte-order-mark", "line-ends-crlf", "line-ends-cr", "blank-lines-and-no-last-line-end"]
    {
        assert_eq!(load(name), plain, "{name}");
    }
    for name in ["semicolons", "tabs", "semicolons-and-decimal-commas"] {
        assert_eq!(load(name).runs, plain.runs, "{name}");
    }
}
