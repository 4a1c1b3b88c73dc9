//! The schema of a model takes what is a model, refuses wrong units and kinds, and knows every key that is read.

use std::fs;
use std::path::{Path, PathBuf};

use configs::json_schema::{self, read_model};
use configs::{LoadOptions, Model, ModelSource, SHIPPED};
use engine::units;
use fixtures::{Case, Schema};
use serde_json::{Value, json};

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

fn schema() -> (Value, Schema) {
    let value = json_schema::model();
    let schema = Schema::new(&value).unwrap_or_else(|error| panic!("{error}"));
    (value, schema)
}

fn good() -> Vec<(String, String)> {
    let files = fs::read_dir(folder("tests/good")).expect("good models");
    let files = files.map(|entry| entry.expect("a readable folder").path());
    let models = files.filter(|path| path.extension().is_some_and(|kind| kind == "toml"));
    let read = |path: PathBuf| {
        (path.display().to_string(), fs::read_to_string(path).expect("a good model"))
    };
    models.map(read).collect()
}

/// The bad models of `topic`, as texts.
fn bad(topic: &str) -> Vec<(Case, String)> {
    let topics = fixtures::topics(&folder("tests/bad")).unwrap_or_else(|error| panic!("{error}"));
    let cases = topics.into_iter().filter(|one| one.name().ends_with(topic));
    let text = |case: Case| {
        let base = folder("tests/good").join(&case.base).with_extension("toml");
        let base = fs::read_to_string(base).unwrap_or_default();
        case.apply(&base).ok().map(|text| (case, text))
    };
    cases.flat_map(|one| one.cases.into_iter().filter_map(text).collect::<Vec<_>>()).collect()
}

#[test]
fn models_that_ship_and_good_ones_fit_as_they_are_and_written_out() {
    let (_, schema) = schema();
    let shipped = SHIPPED.iter().map(|one| (one.name.to_owned(), one.text.to_owned()));
    for (name, text) in shipped.chain(good()) {
        let source = ModelSource::Text {
            name: name.clone(),
            text: text.clone(),
            folder: folder("tests/good"),
        };
        let resolved = Model::load(source, &LoadOptions::default());
        let resolved = resolved.map(|loaded| loaded.model.resolved_toml().to_owned());
        for text in [Some(text), resolved.ok()].into_iter().flatten() {
            let faults = schema.faults(&text).unwrap_or_else(|error| panic!("{name}: {error}"));
            assert!(faults.is_empty(), "{name}: {faults:#?}\n{text}");
        }
    }
}

#[test]
fn wrong_units_kinds_and_keys_do_not_fit() {
    let (_, schema) = schema();
    let mut n = 0;
    for topic in ["/quantities.toml", "/keys.toml"] {
        // An intrusion may stand in for the impact.
        for (case, text) in bad(topic).into_iter().filter(|(case, _)| case.name != "missing-table")
        {
            let faults = schema.faults(&text).unwrap_or_default();
            assert!(!faults.is_empty(), "{topic}: {} fits\n{text}", case.name);
            n += 1;
        }
    }
    assert!(n > 10, "{n}");
}

#[test]
fn ranges_of_numbers_without_a_unit_do_not_fit_where_they_are_passed() {
    let (_, schema) = schema();
    let minimal = fs::read_to_string(folder("tests/good/minimal.toml")).expect("a good model");
    let friction = minimal.replace("friction = 0.28", "friction = -0.1");
    assert_ne!(minimal, friction);
    let faults = schema.faults(&friction).expect("TOML");
    assert!(faults.iter().any(|fault| fault.starts_with("/contact_law/friction: ")), "{faults:?}");
}

#[test]
fn what_belongs_to_another_law_or_medium_does_not_fit() {
    let (_, schema) = schema();
    let minimal = fs::read_to_string(folder("tests/good/minimal.toml")).expect("a good model");
    let with = |header: &str, line: &str| minimal.replace(header, &format!("{header}\n{line}"));
    for (text, place) in [
        (with("[contact_law]", "youngs_modulus = \"1 MPa\""), "/contact_law"),
        (with("[medium]", "bulk_density = \"1500 kg/m^3\""), "/medium"),
        (with("[intruder]", "apex = \"60 deg\""), "/intruder"),
    ] {
        let faults = schema.faults(&text).expect("TOML");
        assert!(faults.iter().any(|fault| fault.starts_with(place)), "{place}: {faults:?}");
    }
}

/// The schema of the table `name`.
fn table<'a>(schema: &'a Value, name: &str) -> Option<&'a Value> {
    let mut keys = name.split('.').filter(|key| !key.is_empty());
    keys.try_fold(schema, |table, key| {
        let found = table.get("properties")?.get(key)?;
        Some(found.get("items").filter(|_| found["type"] == "array").unwrap_or(found))
    })
}

#[test]
fn every_key_that_a_model_can_have_is_in_the_schema() {
    let (schema, _) = schema();
    let bad = bad("").into_iter().map(|(case, text)| (case.name, text));
    let mut n = 0;
    for (name, text) in good().into_iter().chain(bad) {
        let asked = read_model(&text, &folder("tests/good"));
        for question in &asked.questions {
            let seen = &asked.tables[question.of];
            // A coefficient that is a table is a value with keys of its own.
            let within = seen.name.strip_prefix("resistance.");
            let keys = match within {
                Some(key) => &schema["properties"]["resistance"]["properties"][key],
                None => table(&schema, &seen.name).unwrap_or(&Value::Null),
            };
            let is_there = match within {
                Some(_) => keys.to_string().contains(&format!("\"{}\"", question.key)),
                None => keys["properties"].get(question.key).is_some(),
            };
            assert!(is_there, "{name}: [{}] {}", seen.name, question.key);
            n += 1;
        }
    }
    assert!(n > 5000, "{n}");
}

#[test]
fn a_key_is_described_as_its_message_describes_it() {
    let (schema, _) = schema();
    let duration = &schema["properties"]["run"]["properties"]["duration"];
    assert_eq!(
        duration["description"],
        "the longest simulated time; allowed: above 0 s; usual: 0.0001 s to 100 s"
    );
    assert_eq!(schema["properties"]["energy"]["properties"]["abort_above"]["default"], json!(0.05));
    let required = &schema["properties"]["run"]["required"];
    assert_eq!(*required, json!(["name", "duration"]));
}

#[test]
fn patterns_of_quantities_take_what_is_read_and_refuse_other_dimensions() {
    use units::Dimension as D;
    let dimensions = [
        D::LENGTH,
        D::VOLUME,
        D::MASS,
        D::TIME,
        D::RATE,
        D::SPEED,
        D::ACCELERATION,
        D::ANGLE,
        D::SPIN,
        D::STIFFNESS,
        D::MASS_PER_LENGTH,
        D::DENSITY,
        D::AREA_DENSITY,
        D::FORCE,
        D::PRESSURE,
        D::ENERGY,
    ];
    let texts = [
        "3 m",
        "3m",
        " 3 mm ",
        "1e-3 km",
        "10µs",
        "4.46 cm",
        "1 in",
        "2 t",
        "-3.5e2 g",
        "90 deg",
        "90°",
        "1 rpm",
        "1 rad/s",
        "1e4 1/s",
        "2 kHz",
        "2 s^-1",
        "9.81 m/s²",
        "9.81 m / s^2",
        "1 gn",
        "1 cm/s",
        "1 m·s^-1",
        "1 m s^-1",
        "3.2 N/mm",
        "1 J/m^2",
        "2.7 g/cm^3",
        "1 g/cc",
        "1500 kg/m³",
        "20 kg/m^2",
        "5 kPa",
        "5 N/m^2",
        "1 N*m",
        "1 kg/m",
        "1 mm^3",
        "3 kg m/s^2",
        "5 N s/m",
        "3",
        "m",
        "3 mmm",
        "3,5 m",
        "3 px",
        "",
        "x m",
        "3 m/",
        "3 m/s/",
    ];
    for dimension in dimensions {
        let pattern = json!({ "properties": { "v": { "type": "string", "pattern": units::pattern(dimension) } } });
        let schema = Schema::new(&pattern).unwrap_or_else(|error| panic!("{error}"));
        for text in texts {
            let fits = schema.faults(&format!("v = {text:?}")).expect("TOML").is_empty();
            let is_read = units::parse(text, dimension).is_ok();
            // Of three factors and more, the dimension is not looked at.
            let is_long = ["3 kg m/s^2", "5 N s/m"].contains(&text);
            assert!(
                fits == is_read || (is_long && fits),
                "{text:?} as {}: {fits}",
                dimension.name()
            );
        }
    }
}
