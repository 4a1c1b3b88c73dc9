//! Everything that `plunge new --list` lists can be written into an empty folder, names its schema and fits it, and
//! works there.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use fixtures::Schema;
use serde_json::Value;

fn plunge(folder: &Path, args: &[&str]) -> Result<String, String> {
    let out = Command::new(env!("CARGO_BIN_EXE_plunge"))
        .args(args)
        .current_dir(folder)
        .env_remove("PLUNGE_CACHE")
        .output()
        .expect("plunge runs");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    match out.status.success() {
        true => Ok(text(&out.stdout)),
        false => Err(text(&out.stderr)),
    }
}

fn done(folder: &Path, args: &[&str]) -> String {
    plunge(folder, args).unwrap_or_else(|error| panic!("{args:?}: {error}"))
}

/// The names of everything, by group.
fn listed(folder: &Path) -> BTreeMap<String, Vec<String>> {
    let list: Value =
        serde_json::from_str(&done(folder, &["new", "--list", "--json"])).expect("JSON");
    let names = |group: &Value| {
        let items = group.as_array().expect("a list").iter();
        items.map(|item| item["name"].as_str().expect("a name").to_owned()).collect()
    };
    list.as_object()
        .expect("groups")
        .iter()
        .map(|(key, group)| (key.clone(), names(group)))
        .collect()
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The files below `folder`, and their texts.
fn files(folder: &Path) -> BTreeMap<PathBuf, String> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        match path.is_dir() {
            true => found.extend(files(&path)),
            false => _ = found.insert(path.clone(), read(&path)),
        }
    }
    found
}

#[test]
fn everything_that_is_listed_is_written_once_and_nothing_is_written_over() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let groups = listed(folder.path());
    assert_eq!(groups.keys().collect::<Vec<_>>(), ["models", "sets", "starters", "tools"]);
    let names: Vec<&String> = groups.values().flatten().collect();
    for name in &names {
        let said = done(folder.path(), &["new", name]);
        assert!(said.contains(" written"), "{name}: {said}");
    }
    let written = files(folder.path());
    for name in &names {
        let again = plunge(folder.path(), &["new", name]).expect_err("a second time");
        assert!(again.contains("exists already"), "{name}: {again}");
    }
    assert_eq!(files(folder.path()), written);
    let text = done(folder.path(), &["new", "--list"]);
    assert!(names.iter().all(|name| text.contains(&format!("  {name} "))), "{text}");
}

#[test]
fn every_toml_file_names_its_schema_and_fits_it() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    listed(folder.path())
        .values()
        .flatten()
        .for_each(|name| _ = done(folder.path(), &["new", name]));
    done(folder.path(), &["new", "my-drop", "--from", "rolling-2d"]);
    let mut n = 0;
    for (path, text) in files(folder.path()) {
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let named = text.lines().next().and_then(|line| line.strip_prefix("#:schema "));
        let named = named.unwrap_or_else(|| panic!("{}: {text}", path.display()));
        let schema = read(&path.parent().expect("a folder").join(named));
        let schema = Schema::new(&serde_json::from_str(&schema).expect("JSON"));
        let faults = schema.unwrap_or_else(|error| panic!("{error}")).faults(&text);
        assert_eq!(faults, Ok(Vec::new()), "{}", path.display());
        n += 1;
    }
    assert!(n > 28, "{n}");
}

#[test]
fn sets_campaign_and_effect_work_where_they_are_written() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let groups = listed(folder.path());
    for name in groups["sets"].iter().chain(&groups["starters"]) {
        done(folder.path(), &["new", name, "--quiet"]);
    }
    for name in &groups["sets"] {
        let said = done(folder.path(), &["check", name]);
        assert!(said.contains("conditions"), "{name}: {said}");
    }
    assert!(done(folder.path(), &["sweep", "campaign.toml", "--plan"]).contains("64"));
    done(folder.path(), &["check", "effect.toml", "--quiet"]);
    let depth = |args: &[&str]| -> f64 {
        let said: Value = serde_json::from_str(&done(folder.path(), args)).expect("JSON");
        let summary = said.to_string();
        let at = summary.find("\"depth_m\":").unwrap_or_else(|| panic!("{summary}")) + 10;
        let end = summary[at..].find([',', '}']).expect("an end") + at;
        summary[at..end].parse().expect("a depth")
    };
    let with = depth(&["run", "effect.toml", "--json"]);
    let without = depth(&[
        "run",
        "effect.toml",
        "--json",
        "--set",
        "effect.0.parameters.q.value=0",
        "--out",
        "without",
    ]);
    assert!(with < without, "{with} {without}");
    let ranked = read_candidate(folder.path());
    let said = done(folder.path(), &["effects", "--model", &ranked]);
    assert!(said.contains("late-drag"), "{said}");
}

#[test]
fn changes_of_a_bed_are_described_as_its_candidates() {
    let folder = tempfile::tempdir().expect("a folder");
    let here = folder.path();
    let all = done(here, &["effects"]);
    assert!(all.contains("intruder-friction"), "{all}");
    let one = done(here, &["effects", "grain-friction"]);
    assert!(one.contains("-1 to 4, screened at 0.5"), "{one}");
    let both = done(here, &["effects", "packing"]);
    assert!(both.contains("bed.preparation_friction") && both.contains("parameters"), "{both}");
}

/// The model with the effect as a candidate.
fn read_candidate(folder: &Path) -> String {
    let text = read(&folder.join("effect.toml"));
    let text = text
        .replace("[[effect]] ", "[[candidate]]")
        .replace("[effect.parameters.q]", "[candidate.parameters.q]");
    fs::write(folder.join("candidate.toml"), text.replace("value = 0.2\n", "")).expect("a model");
    "candidate.toml".to_owned()
}

#[test]
fn a_model_may_have_the_name_of_something_else() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    done(folder.path(), &["new", "campaign", "--from", "poncelet"]);
    assert!(read(&folder.path().join("campaign.toml")).contains("name = \"campaign\"\nduration"));
}
