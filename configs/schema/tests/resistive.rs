//! What models of a resistive force mean: coefficients, free parameters, impacts, edits.

use std::path::PathBuf;

use configs::edit::{AddedEffect, Addition, add_effects};
use configs::{
    Color, LoadOptions, Model, ModelSource, ParameterError, ResistiveMedium, find_shipped,
};
use resistive::{RESISTANCE_LAWS, Role};

fn load(text: &str, sets: &[&str]) -> Result<configs::Loaded, String> {
    let source = ModelSource::Text {
        name: "test.toml".to_owned(),
        text: text.to_owned(),
        folder: PathBuf::from("."),
    };
    let sets = sets.iter().map(|set| (*set).to_owned()).collect();
    let options = LoadOptions { sets, ..LoadOptions::default() };
    Model::load(source, &options).map_err(|error| error.render(Color::Off))
}

fn good(name: &str, sets: &[&str]) -> Model {
    let shipped = find_shipped(name).expect("a shipped model");
    load(shipped.text, sets).unwrap_or_else(|error| panic!("{error}")).model
}

fn medium(model: &Model) -> &ResistiveMedium {
    model.resistive().expect("a resistive medium").medium
}

fn paths(medium: &ResistiveMedium) -> Vec<String> {
    medium.free_parameters().into_iter().map(|one| one.path).collect()
}

#[test]
fn a_table_gives_its_nodes_between_them_and_the_nearest_outside() {
    let model = good("two-term-components", &[]);
    let at = |degrees: f64| medium(&model).coefficients_at(degrees.to_radians()).get("drag_x");
    // The round-off of degrees moves the share of a node by some 1e-16.
    assert!((at(45.0) - 0.16064).abs() < 1e-15);
    assert!((at(37.5) - 0.5 * (0.10083 + 0.16064)).abs() < 1e-15);
    assert!((at(90.0) - 0.41568).abs() < 1e-15);
    assert!((at(5.0) - 0.07803).abs() < 1e-15);
}

#[test]
fn an_impact_outside_of_a_table_is_a_warning_that_says_which_value_is_taken() {
    let shipped = find_shipped("two-term-components").expect("a shipped model");
    let loaded = load(shipped.text, &["impact.angle=15 deg"]).unwrap_or_else(|e| panic!("{e}"));
    let warnings = loaded.render_warnings(Color::Off);
    assert!(warnings.contains("outside of the table of `drag_z`"), "{warnings}");
    assert!(warnings.contains("0.18763 kg/m"), "{warnings}");
    assert!(!warnings.contains("drag_x"), "{warnings}");
}

#[test]
fn an_expression_sees_density_and_angle_of_the_impact() {
    let model = good(
        "two-term-vector",
        &[
            r#"resistance.drag={ expression = "density / 1000 + sin(angle)" }"#,
            r#"fit.free=["resistance.friction"]"#,
        ],
    );
    let drag = medium(&model).coefficients_at(0.5).get("drag");
    // Two roundings of numbers of order one.
    assert!((drag - (1.52 + libm::sin(0.5))).abs() < 1e-15);
    assert_eq!(paths(medium(&model)), ["resistance.friction"]);
}

#[test]
fn every_node_of_a_table_is_free_by_itself_and_optional_coefficients_are_not() {
    let components = good("two-term-components", &[]);
    let free = paths(medium(&components));
    assert_eq!(free.len(), 20);
    assert_eq!(free[..2], ["resistance.drag_x@15", "resistance.drag_x@30"]);
    assert_eq!(free[19], "resistance.friction_z@90");
    let minimal = include_str!("good/resistive-minimal.toml");
    let link = minimal
        .replace("two-term-vector", "link")
        .replace("friction = 9.5", "horizontal = 5.0")
        .replace("shape = \"sphere\"", "shape = \"link\"\nlength = \"10 cm\"");
    let link = load(&link, &[]).unwrap_or_else(|error| panic!("{error}")).model;
    assert_eq!(paths(medium(&link)), ["resistance.drag", "resistance.horizontal"]);
}

#[test]
fn numbers_are_set_by_their_paths_within_what_is_allowed() {
    let model = good("two-term-components", &[]);
    let medium = medium(&model);
    let changed = medium
        .with_parameters(&[("resistance.drag_x@45", 0.25), ("resistance.friction_z@90", 5.0)])
        .expect("two numbers of the model");
    let value = |path: &str| {
        let all = changed.free_parameters();
        let found = all.iter().find(|one| one.path == path);
        found.map_or(f64::NAN, |one| one.value)
    };
    assert_eq!(value("resistance.drag_x@45").to_bits(), 0.25_f64.to_bits());
    assert_eq!(value("resistance.drag_x@30").to_bits(), 0.10083_f64.to_bits());
    let drag = changed.coefficients_at(45_f64.to_radians()).get("drag_x");
    assert!((drag - 0.25).abs() < 1e-15);
    let unknown = medium.with_parameters(&[("resistance.drag", 1.0)]);
    assert_eq!(unknown, Err(ParameterError::Unknown { path: "resistance.drag".to_owned() }));
    let negative = medium.with_parameters(&[("resistance.drag_x@45", -1.0)]);
    assert!(matches!(negative, Err(ParameterError::NotAllowed { .. })));
}

#[test]
fn laws_act_in_the_order_of_the_registry_whatever_the_order_of_the_file() {
    let text = include_str!("good/resistive-minimal.toml");
    let [first, second] = [["janssen", "added-mass"], ["added-mass", "janssen"]].map(|names| {
        let effects = names.map(|name| format!("\n[[effect]]\nname = \"{name}\"\nq = 0.3\n"));
        let model = load(&format!("{text}{}", effects.concat()), &[]);
        model.unwrap_or_else(|error| panic!("{error}")).model
    });
    let depth = |model: &Model| {
        let resistive = model.resistive().expect("a resistive medium");
        let impact = resistive.impact(&model.conditions()[0]);
        impact.run(1.0, &mut ()).expect("an impact").parts[0].depth
    };
    assert_eq!(depth(&first).to_bits(), depth(&second).to_bits());
    let plain = load(text, &[]).unwrap_or_else(|error| panic!("{error}")).model;
    assert!((depth(&first) / depth(&plain) - 1.0).abs() > 1e-3, "the effects do something");
}

#[test]
fn straight_down_is_exactly_down_and_spin_is_counter_clockwise() {
    let model = good("two-term-vector", &["impact.angle=90 deg", "impact.spin=3 rad/s"]);
    let launch = model.launch(&model.conditions()[0]);
    let down = [0.0, -0.0, -launch.speed];
    assert_eq!(launch.velocity().as_slice(), down);
    // Counter-clockwise in the x–z plane is a rotation about −y.
    assert_eq!(launch.spin.as_slice(), [0.0, -3.0, 0.0]);
}

#[test]
fn an_effect_added_to_the_text_of_a_model_is_in_the_model() {
    let addition = |name: &str, key: &str, value: &str| Addition {
        effects: vec![AddedEffect {
            name: name.to_owned(),
            values: vec![(key.to_owned(), value.to_owned())],
        }],
        ..Addition::default()
    };
    let text = find_shipped("two-term-vector").expect("a shipped model").text;
    let edited = add_effects(text, &addition("janssen", "q", "0.4")).expect("an effect");
    let model = load(&edited, &[]).unwrap_or_else(|error| panic!("{error}")).model;
    assert_eq!(medium(&model).effects[0].effect.name(), "janssen");
    assert!(paths(medium(&model)).contains(&"effect.janssen.q".to_owned()));
    let kept = edited.replace("\n[[effect]]\nname = \"janssen\"\nq = 0.4\n", "");
    assert_eq!(kept.replace(", \"effect.janssen.q\"]", "]"), text, "all else is as it was");

    let text = find_shipped("vertical-2d").expect("a shipped model").text;
    let rolling = addition("rolling-resistance", "rolling_friction", "0.05");
    let edited = add_effects(text, &rolling).expect("an effect");
    let model = load(&edited, &[]).unwrap_or_else(|error| panic!("{error}")).model;
    let grains = model.grains().expect("a bed of grains").medium;
    assert!((grains.effects[0].params.get("rolling_friction") - 0.05).abs() < 1e-15);
    let added = "\n[[effect]]\nname = \"rolling-resistance\"\nrolling_friction = 0.05\n";
    assert_eq!(edited.replace(added, ""), text, "all else is as it was");
}

#[test]
fn every_effect_can_be_written_in_a_model_and_added_to_one() {
    let text = find_shipped("two-term-vector").expect("a shipped model").text;
    for entry in RESISTANCE_LAWS.iter().filter(|law| matches!(law.role, Role::Effect(_))) {
        let name = entry.name.to_owned();
        let q = entry.params[0].plausible.max.to_string();
        let effects = vec![AddedEffect { name, values: vec![("q".to_owned(), q)] }];
        let added = add_effects(text, &Addition { effects, ..Addition::default() });
        let added = added.unwrap_or_else(|error| panic!("{}: {error}", entry.name));
        let model = load(&added, &[]).unwrap_or_else(|error| panic!("{error}")).model;
        let effect = &medium(&model).effects[0];
        assert_eq!(effect.effect.name(), entry.name);
        assert_eq!(effect.q.to_bits(), entry.params[0].plausible.max.to_bits(), "{}", entry.name);
    }
}

#[test]
fn a_fitted_node_of_a_shipped_table_changes_in_its_place_alone() {
    let text = find_shipped("two-term-components").expect("a shipped model").text;
    let fitted = vec![("resistance.drag_x@45".to_owned(), 0.2)];
    let edited = add_effects(text, &Addition { fitted, ..Addition::default() }).expect("a number");
    assert_eq!(edited, text.replace("0.16064 kg/m", "0.2 kg/m"));
    let model = load(&edited, &[]).unwrap_or_else(|error| panic!("{error}")).model;
    let drag = medium(&model).coefficients_at(45_f64.to_radians()).get("drag_x");
    assert!((drag - 0.2).abs() < 1e-15);
}
