//! What a model means: conditions, keys, limits, paths, and no panic whatever the text.

use std::fs;
use std::path::Path;

use configs::{
    BedSource, Color, Condition, LoadOptions, Loaded, Model, ModelSource, SHIPPED, StartX,
    find_shipped,
};
use engine::units::Dimension;
use proptest::prelude::*;

fn shipped(name: &str) -> ModelSource {
    ModelSource::Shipped(find_shipped(name).expect("a shipped model"))
}

fn with_sets(sets: &[&str]) -> Result<Loaded, String> {
    let sets = sets.iter().map(|set| (*set).to_owned()).collect();
    let options = LoadOptions { sets, ..LoadOptions::default() };
    Model::load(shipped("vertical-2d"), &options).map_err(|error| error.render(Color::Off))
}

fn good(sets: &[&str]) -> Model {
    with_sets(sets).unwrap_or_else(|error| panic!("{error}")).model
}

fn bed_key(model: &Model) -> &str {
    model.grains().expect("a bed of grains").bed_key_text()
}

fn refusal(sets: &[&str]) -> String {
    with_sets(sets).map(|loaded| loaded.model.run.name).expect_err("a refused model")
}

fn text(text: &str, folder: &Path) -> ModelSource {
    ModelSource::Text {
        name: "test.toml".to_owned(),
        text: text.to_owned(),
        folder: folder.to_owned(),
    }
}

#[test]
fn conditions_are_the_product_speed_slowest_then_angle_then_position() {
    let model = good(&[
        r#"conditions.speed=["1 m/s", "2 m/s"]"#,
        r#"conditions.angle=["90 deg", "45 deg"]"#,
        r#"conditions.x=["40 cm", "50 cm", "60 cm"]"#,
    ]);
    let conditions = model.conditions();
    assert_eq!(conditions.len(), 12);
    let at = |n: usize| {
        let Condition { speed, angle_rad, position_index, x } = conditions[n];
        (speed, angle_rad.to_degrees().round(), position_index, x)
    };
    assert_eq!(at(0), (1.0, 90.0, 0, StartX::At(0.4)));
    assert_eq!(at(1), (1.0, 90.0, 1, StartX::At(0.5)));
    assert_eq!(at(3), (1.0, 45.0, 0, StartX::At(0.4)));
    assert_eq!(at(6), (2.0, 90.0, 0, StartX::At(0.4)));
}

#[test]
fn one_position_is_the_middle_and_several_are_drawn() {
    let middle = StartX::At(1.0185 / 2.0);
    assert_eq!(good(&[]).conditions()[0].x, middle);
    assert_eq!(good(&["conditions.positions=1"]).conditions()[0].x, middle);
    let drawn = good(&["conditions.positions=6"]).conditions();
    assert_eq!(drawn.len(), 6);
    assert!(drawn.iter().all(|one| one.x == StartX::Drawn));
    assert_eq!(drawn[5].position_index, 5);
}

#[test]
fn the_bed_key_changes_with_the_bed_alone() {
    let base = good(&[]);
    let key = bed_key(&base);
    for unrelated in [
        "run.name=other",
        "run.time_step=5 us",
        "run.duration=1 s",
        "impact.speed=3 m/s",
        "intruder.mass=50 g",
        "contact_law.intruder_friction=0.1",
        "log.grains=false",
        "conditions.positions=6",
    ] {
        let model = good(&[unrelated]);
        assert_eq!(bed_key(&model), key, "{unrelated}");
        assert_ne!(model.hash(), base.hash(), "{unrelated}");
    }
    let rolling = Model::load(shipped("rolling-2d"), &LoadOptions::default());
    assert_eq!(bed_key(&rolling.expect("a shipped model").model), key);
    for related in [
        "run.seed=2",
        "medium.gravity=1.62 m/s^2",
        "container.width=1 m",
        "bed.grains.1.count=2401",
        "bed.inflated_to=0.8",
        "bed.preparation_friction=0.1",
        "contact_law.friction=0.3",
        "contact_law.normal_stiffness=4000 N/m",
    ] {
        assert_ne!(bed_key(&good(&[related])), key, "{related}");
    }
}

#[test]
fn the_last_set_and_the_seed_option_win() {
    assert_eq!(good(&["run.seed=5", "run.seed=6"]).run.seed, 6);
    let options =
        LoadOptions { sets: vec!["run.seed=5".to_owned()], seed: Some(7), ..Default::default() };
    let loaded = Model::load(shipped("vertical-2d"), &options).expect("a good model");
    assert_eq!(loaded.model.run.seed, 7);
    let options = LoadOptions { seed: Some(u64::MAX), ..LoadOptions::default() };
    let error = Model::load(shipped("vertical-2d"), &options).expect_err("too large a seed");
    assert!(error.to_string().contains("too large"), "{error}");
}

#[test]
fn equal_spellings_of_a_quantity_give_the_same_model() {
    let spelt = good(&["intruder.diameter=44.6 mm", "intruder.mass=0.0322 kg"]);
    assert_eq!(spelt.hash(), good(&[]).hash());
}

#[test]
fn grains_are_grown_as_far_as_the_model_says_and_rain_in_where_it_does_not() {
    let inflated = |model: &Model| match &model.grains().expect("a bed of grains").medium.bed.source
    {
        BedSource::Settle(settle) => settle.inflated_to,
        BedSource::Csv(_) => None,
    };
    assert_eq!(inflated(&good(&[])), None);
    assert_eq!(inflated(&good(&["bed.inflated_to=0.8"])), Some(0.8));
}

#[test]
fn grains_turn_as_the_model_says_and_their_bed_is_the_one_that_it_would_be_without() {
    let inertia = |model: &Model| model.grains().expect("a bed of grains").medium.grain_inertia;
    let (plain, other) = (good(&[]), good(&["medium.grain_inertia=0.4"]));
    assert_eq!((inertia(&plain), inertia(&other)), (None, Some(0.4)));
    assert_eq!(bed_key(&plain), bed_key(&other));
    assert_ne!(plain.hash(), other.hash());
    for impossible in ["0", "-0.4", "1.5"] {
        let message = refusal(&[&format!("medium.grain_inertia={impossible}")]);
        assert!(message.contains("grain_inertia"), "{message}");
    }
}

#[test]
fn preparation_friction_is_that_of_the_law_unless_given() {
    let friction = |model: &Model| match &model.grains().expect("a bed of grains").medium.bed.source
    {
        BedSource::Settle(settle) => settle.preparation_friction,
        BedSource::Csv(_) => None,
    };
    assert_eq!(friction(&good(&["bed.preparation_friction=0.1"])), Some(0.1));
    let text_without = SHIPPED[0].text.replace("preparation_friction = 0.28\n", "");
    let source = text(&text_without, Path::new("."));
    let model = Model::load(source, &LoadOptions::default()).expect("a good model").model;
    assert_eq!(friction(&model), Some(0.28));
}

#[test]
fn named_limits_refuse_what_is_too_large() {
    let many = format!("{}{}", SHIPPED[0].text, "\n[[effect]]\nname = \"x\"\n".repeat(1001));
    let load = |text_: &str| {
        let source = text(text_, Path::new("."));
        Model::load(source, &LoadOptions::default()).expect_err("a refused model").to_string()
    };
    assert!(load(&many).contains("1001 times [[effect]] is too many"), "{}", load(&many));
    let large = format!("{}#{}", SHIPPED[0].text, " ".repeat(10_000_000));
    assert!(load(&large).contains("at most 10000000 are read"));
    let unknown: String = (0..100_000).map(|n| format!("k{n} = 1\n")).collect();
    assert!(load(&unknown).contains("only the first are shown"));
    let deep = format!("a = {}1{}\n", "[".repeat(100_000), "]".repeat(100_000));
    assert!(load(&deep).contains("not TOML"));
}

#[test]
fn warnings_do_not_refuse() {
    let loaded = with_sets(&["impact.speed=200 m/s"]).expect("a model");
    assert!(loaded.render_warnings(Color::Off).contains("unusual value"));
    assert!(loaded.render_warnings(Color::On).contains("\u{1b}["));
}

#[test]
fn a_step_factor_counts_in_the_stability_check() {
    assert!(refusal(&["run.time_step_factor=4"]).contains("takes only 6.9 steps"));
    assert!(refusal(&[r#"run.time_step="auto""#, "run.time_step_factor=10"]).contains("3.1 steps"));
}

const CSV: &str = "x_m,y_m,radius_m,mass_kg\n0.5,0.00228,0.00228,4.9e-5\n";

fn csv_model() -> String {
    let text = SHIPPED[0].text;
    let from = text.find("[bed]").expect("a bed");
    let to = text.find("[contact_law]").expect("a law");
    format!("{}[bed]\nsource = \"csv\"\nfile = \"grains.csv\"\n\n{}", &text[..from], &text[to..])
}

#[cfg(unix)]
#[test]
fn data_files_are_regular_files_of_the_project() {
    let outside = tempfile::tempdir().expect("a folder");
    fs::write(outside.path().join("grains.csv"), CSV).expect("a file");
    let project = tempfile::tempdir().expect("a folder");
    let folder = project.path();
    let load = |allow_paths| {
        let options = LoadOptions { allow_paths, ..LoadOptions::default() };
        Model::load(text(&csv_model(), folder), &options)
    };
    let link = folder.join("grains.csv");
    std::os::unix::fs::symlink(outside.path().join("grains.csv"), &link).expect("a link");
    let error = load(Vec::new()).expect_err("a link that leads out").to_string();
    assert!(error.contains("lies outside of the model's project"), "{error}");
    let loaded = load(vec![outside.path().to_owned()]).expect("an allowed folder");
    assert_eq!(loaded.model.grains().expect("a bed of grains").n_grains(), 1);
    fs::remove_file(&link).expect("a link");
    std::os::unix::fs::symlink("/dev/zero", &link).expect("a link");
    let error = load(vec!["/dev".into()]).expect_err("a device").to_string();
    assert!(error.contains("is not a regular file"), "{error}");
    fs::remove_file(&link).expect("a link");
    fs::write(&link, CSV).expect("a file");
    let model = load(Vec::new()).expect("a file of the project").model;
    assert!(!bed_key(&model).contains("grains.csv"));
    let key = bed_key(&model).to_owned();
    fs::write(&link, CSV.replace("0.5,", "0.6,")).expect("a file");
    let changed = load(Vec::new()).expect("a file of the project").model;
    assert_ne!(bed_key(&changed), key, "the content is part of the key");
}

#[test]
fn a_model_argument_is_a_file_or_a_shipped_name() {
    for argument in ["vertical-2d", "vertical-2d.toml"] {
        assert!(matches!(ModelSource::from_argument(argument), ModelSource::Shipped(_)));
    }
    let missing = ModelSource::from_argument("vertikal-2d");
    let error = Model::load(missing, &LoadOptions::default()).expect_err("no such model");
    assert!(error.to_string().contains("did you mean `vertical-2d`?"), "{error}");
}

#[test]
fn every_shipped_length_reads_in_every_unit_of_length() {
    for (text, expected) in [("33.95 cm", 0.3395), ("339.5 mm", 0.3395), ("339500 um", 0.3395)] {
        let value = engine::units::parse(text, Dimension::LENGTH).expect("a length");
        assert_eq!(value.to_bits(), f64::to_bits(expected));
    }
}

/// A shipped model with some of its bytes replaced, removed or doubled.
fn mutated() -> impl Strategy<Value = String> {
    let edit = (any::<prop::sample::Index>(), 0usize..12, "[ -~\u{e9}\n\u{1b}\"\\[\\]=.#]{0,6}");
    (0..SHIPPED.len(), prop::collection::vec(edit, 1..8)).prop_map(|(which, edits)| {
        let mut text: Vec<char> = SHIPPED[which].text.chars().collect();
        for (at, removed, inserted) in edits {
            let from = at.index(text.len());
            let to = (from + removed).min(text.len());
            text.splice(from..to, inserted.chars());
        }
        text.into_iter().collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_mutated_model_is_refused_or_prints_itself(source in mutated()) {
        let folder = Path::new(".");
        match Model::load(text(&source, folder), &LoadOptions::default()) {
            Ok(loaded) => {
                let resolved = loaded.model.resolved_toml();
                let again = Model::load(text(resolved, folder), &LoadOptions::default());
                let again = again.map_err(|error| TestCaseError::fail(error.to_string()))?;
                prop_assert_eq!(again.model.resolved_toml(), resolved);
            }
            Err(error) => {
                let message = error.render(Color::Off);
                prop_assert!(message.contains("error"));
                let raw = message.chars().any(|c| c.is_control() && c != '\n');
                prop_assert!(!raw, "{:?}", message);
            }
        }
    }

    #[test]
    fn any_assignment_is_taken_or_explained(set in "[a-z.0-9=\"' \\[\\]{}\n\u{e9}-]{0,40}") {
        let _ = with_sets(&[&set]);
    }

    #[test]
    fn any_number_in_any_place_is_taken_or_explained(
        value in any::<f64>(),
        key in prop::sample::select(vec![
            "run.duration", "run.time_step", "container.width", "bed.grains.0.diameter",
            "bed.grains.0.mass", "contact_law.normal_stiffness", "intruder.diameter",
            "intruder.mass", "impact.speed", "impact.spin", "impact.x", "medium.gravity",
        ]),
        unit in prop::sample::select(vec![
            "s", "m", "kg", "N/m", "m/s", "rad/s", "m/s^2", "deg",
        ]),
    ) {
        let _ = with_sets(&[&format!("{key}={value:e} {unit}")]);
        let _ = with_sets(&[&format!("contact_law.friction={value:e}")]);
    }
}

#[test]
fn an_intruder_that_would_jump_over_grains_within_a_step_is_refused_with_a_step_that_would_do() {
    let message = refusal(&["impact.speed=1e4 m/s", "run.time_step=10 us"]);
    assert!(message.contains("the intruder moves 0.1 m in a step"), "{message}");
    assert!(message.contains("write a time step of \"22.8 ns\" or less"), "{message}");
    let listed = refusal(&[r#"conditions.speed=["1 m/s", "1e4 m/s"]"#, "run.time_step=10 us"]);
    assert!(listed.contains("10000 m/s"), "{listed}");
    // A thousandth of that is a tenth of a millimetre in a step.
    good(&["impact.speed=10 m/s", "run.time_step=10 us"]);
}

#[test]
fn a_container_that_no_memory_holds_is_refused_with_the_width_that_the_grains_cover() {
    for width in ["1e307 m", "1e12 m"] {
        let message = refusal(&[&format!("container.width={width}")]);
        assert!(message.contains("too large for cells of the size of its grains"), "{message}");
        assert!(message.contains("grains cover the floor of one that is"), "{message}");
    }
}
