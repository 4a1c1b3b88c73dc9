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
fn compare(group: &str, at_least: usize) {
    let bless = std::env::var_os("BLESS").is_some();
    let mut wrong = String::new();
    let folders = folders(group);
    assert!(folders.len() >= at_least, "only {} sets in {group}", folders.len());
    for folder in folders {
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
    compare("bad-csv", 50);
}

#[test]
fn every_defect_of_a_measurement_toml_is_told_as_the_message_beside_it() {
    compare("bad-set", 20);
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

#[test]
fn a_set_that_is_not_there_is_told_by_its_name() {
    let told =
        |path: &str| MeasurementSet::load(Path::new(path)).expect_err("no set").render(Color::Off);
    assert_eq!(told("tests/data/none"), "error: `tests/data/none`: there is no such file\n\n");
    assert_eq!(
        told("tests/data"),
        "error: `tests/data/measurement.toml`: there is no such file\n\n"
    );
}

#[test]
fn a_set_describes_itself() {
    let loaded = MeasurementSet::load(Path::new("tests/data/bad-csv/renamed-columns"))
        .unwrap_or_else(|error| panic!("{error}"));
    let wanted = "\
sample: trajectories, 2 conditions (1 held out), 2 runs
three-dimensional bed, 1480 kg/m^3, grains of 0.0008 m, gravity 9.81 m/s^2
baseline two-term-vector

condition  role     speed (m/s)  angle (deg)  shape   diameter (m)  mass (kg)  runs  readings  measured
c01        fit      1            90           sphere  0.0254        0.0667     1     7         stop_time, final_z, z(t), x(t)
c02        holdout  2            30           sphere  0.0254        0.0667     1     7         stop_time, final_z, final_x, z(t), x(t)

runs.csv: run, condition, repeat, order, stop_time (s), final_z (m), final_x (m)
trajectories.csv: run = trial, t = time_ms (ms), z = height_mm (mm, turned round), x (m)
source: made up for this test
note: In trajectories.csv the column `note` is ignored.
";
    assert_eq!(loaded.describe(), wanted);
    let without = wanted.lines().filter(|line| !line.contains(".csv: "));
    assert_eq!(loaded.set.describe().lines().collect::<Vec<_>>(), without.collect::<Vec<_>>());
}

#[test]
fn the_template_of_the_documentation_loads_without_a_warning() {
    let page = fs::read_to_string("../docs/measurement-sets.md").expect("the page of the format");
    let blocks: Vec<&str> = page.split("```").skip(1).step_by(2).collect();
    let block = |kind: &str, nth: usize| {
        let text = blocks.iter().filter_map(|block| block.strip_prefix(kind)).nth(nth);
        text.expect("a block of the template").trim_start()
    };
    let folder = tempfile::tempdir().expect("a folder for the test");
    let files = [
        ("measurement.toml", block("toml", 0).to_owned()),
        ("runs.csv", block("csv", 0).to_owned()),
        ("trajectories.csv", block("csv", 1).to_owned()),
    ];
    for (name, text) in files {
        fs::write(folder.path().join(name), text).expect("a writable folder");
    }
    let loaded = MeasurementSet::load(folder.path()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(loaded.render_warnings(Color::Off), "");
    assert!(loaded.set.notes.is_empty(), "{:?}", loaded.set.notes);
    assert_eq!(loaded.set.runs.len(), 2);
    // The keys of the second block are those of the tables.
    let mut columns = block("toml", 0).to_owned() + block("toml", 1);
    columns += "\n";
    fs::write(folder.path().join("measurement.toml"), columns).expect("a writable folder");
    let told = MeasurementSet::load(folder.path()).expect_err("columns with other names");
    assert!(told.diagnostics.iter().all(|one| one.message.contains("is missing")), "{told}");
}
