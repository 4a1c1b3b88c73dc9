//! The schema of a measurement set takes every set that ships, refuses wrong units and kinds, and knows every key
//! that is read.

use std::fs;
use std::path::{Path, PathBuf};

use fixtures::Schema;
use measurements::json_schema::{self, read_set};
use measurements::{MeasurementSet, TEMPLATE};
use serde_json::Value;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn schema() -> (Value, Schema) {
    let value = json_schema::set();
    let schema = Schema::new(&value).unwrap_or_else(|error| panic!("{error}"));
    (value, schema)
}

/// The sets that ship, those of tests, and the template.
fn sets() -> Vec<(PathBuf, String)> {
    let folders = ["validation/data", "measurements/tests/data/good", "examples"];
    let within = |folder: &str| fs::read_dir(root().join(folder)).into_iter().flatten();
    let files = folders.into_iter().flat_map(within);
    let files = files.map(|entry| entry.expect("a folder").path().join("measurement.toml"));
    let read = |path: PathBuf| fs::read_to_string(&path).ok().map(|text| (path, text));
    let mut sets: Vec<_> = files.filter_map(read).collect();
    sets.push((PathBuf::from("the template"), TEMPLATE[0].1.to_owned()));
    sets
}

#[test]
fn sets_that_ship_and_good_ones_fit_as_they_are_and_written_out() {
    let (_, schema) = schema();
    let sets = sets();
    assert!(sets.len() > 8, "{}", sets.len());
    for (path, text) in sets {
        let faults = schema.faults(&text).unwrap_or_else(|error| panic!("{error}"));
        assert!(faults.is_empty(), "{}: {faults:#?}", path.display());
        let Some(Ok(loaded)) = path.parent().map(MeasurementSet::load) else { continue };
        let folder = tempfile::tempdir().expect("a folder for the test");
        loaded.set.write(folder.path()).expect("a writable folder");
        let text = fs::read_to_string(folder.path().join("measurement.toml")).expect("a set");
        let faults = schema.faults(&text).unwrap_or_else(|error| panic!("{error}"));
        assert!(faults.is_empty(), "{}, written: {faults:#?}\n{text}", path.display());
    }
}

#[test]
fn wrong_units_kinds_and_keys_do_not_fit() {
    let (_, schema) = schema();
    let template = TEMPLATE[0].1;
    for (right, wrong, place) in [
        ("grain_diameter = 8e-4", "grain_diameter = \"8e-4 kg\"", "/bed/grain_diameter"),
        ("grain_diameter = 8e-4", "grain_diameter = -1", "/bed/grain_diameter"),
        ("speed = 1.0", "speed = \"1 mm\"", "/condition/0/speed"),
        ("rate_hz = 200", "rate = 200", "/instrument"),
        ("kind = \"trajectory\"", "kind = \"trajectories\"", "/measurement/kind"),
        ("unit = \"ms\"", "units = \"ms\"", "/columns/t"),
    ] {
        let text = template.replacen(right, wrong, 1);
        assert_ne!(text, template, "{right}");
        let faults = schema.faults(&text).expect("TOML");
        assert!(faults.iter().any(|fault| fault.starts_with(place)), "{wrong}: {faults:#?}");
    }
    let quantity = template.replacen("grain_diameter = 8e-4", "grain_diameter = \"0.8 mm\"", 1);
    assert_eq!(schema.faults(&quantity), Ok(Vec::new()));
}

#[test]
fn every_key_that_a_set_can_have_is_in_the_schema() {
    let (schema, _) = schema();
    let bad = fixtures::topics(&root().join("measurements/tests/data/bad"));
    let good = root().join("measurements/tests/data/good");
    let bad = bad.unwrap_or_else(|error| panic!("{error}")).into_iter().flat_map(|one| one.cases);
    let bad = bad.filter_map(|case| {
        let base = good.join(&case.base).join("measurement.toml");
        let text = case.apply(&fs::read_to_string(base).ok()?).ok()?;
        Some((PathBuf::from(case.name), text))
    });
    let mut n = 0;
    for (path, text) in sets().into_iter().chain(bad) {
        let asked = read_set(&text);
        for question in &asked.questions {
            let name = &asked.tables[question.of].name;
            let keys = name.split('.').filter(|key| !key.is_empty());
            let table = keys.fold(&schema, |table, key| {
                let found = &table["properties"][key];
                found.get("items").or_else(|| found.get("else")).unwrap_or(found)
            });
            let is_there = table["properties"].get(question.key).is_some();
            assert!(is_there, "{}: [{name}] {}", path.display(), question.key);
            n += 1;
        }
    }
    assert!(n > 1000, "{n}");
}
