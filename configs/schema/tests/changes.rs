//! Typed changes of a model that was read, against the same changes in its text.

use std::f64::consts::PI;
use std::path::PathBuf;

use configs::{Change, LoadOptions, Model, ModelSource, SHIPPED};

/// Every shipped model of grains.
fn beds() -> impl Iterator<Item = Model> {
    let load = |shipped| Model::load(ModelSource::Shipped(shipped), &LoadOptions::default());
    let models = SHIPPED.iter().map(move |shipped| load(shipped).expect(shipped.name).model);
    models.filter(|model| model.grains().is_some())
}

/// The resolved text of `model` with `sets`, read again.
fn by_text(model: &Model, sets: &[&str]) -> Result<Model, String> {
    let source = ModelSource::Text {
        name: "a model".to_owned(),
        text: model.resolved_toml().to_owned(),
        folder: PathBuf::from("."),
    };
    let sets = sets.iter().map(|set| (*set).to_owned()).collect();
    let options = LoadOptions { sets, ..LoadOptions::default() };
    Model::load(source, &options).map(|loaded| loaded.model).map_err(|error| error.to_string())
}

fn by_change(model: &Model, changes: &[Change]) -> Model {
    model.grains().expect("a bed").with(changes).expect("a model")
}

/// Resolved text, hash and what the bed is kept under.
fn identity(model: &Model) -> [String; 3] {
    let bed = model.grains().expect("a bed").bed_key_text();
    [model.resolved_toml().to_owned(), model.hash(), bed.to_owned()]
}

#[test]
fn a_model_without_changes_is_itself() {
    for model in beds() {
        assert_eq!(by_change(&model, &[]), model);
    }
}

#[test]
fn a_change_is_the_same_to_the_last_bit_as_its_text() {
    let shape = |planar: bool| if planar { "disc" } else { "sphere" };
    for model in beds() {
        let medium = model.grains().expect("a bed").medium;
        let shape = shape(medium.space == engine::grains::Space::Planar);
        if model.intruder.recessive_wall || model.intruder.shape.name != shape {
            continue;
        }
        let changes = [
            Change::Seed(7),
            Change::Gravity(1.62),
            Change::ContactLaw("friction", 0.1 + 0.2),
            Change::PreparationFriction(0.07),
            Change::GrainInertia(0.35),
            Change::Effect("pore-air", vec![("drag_rate", 1.0 / 3.0)]),
            Change::Velocity { speed: 0.1 + 0.7, angle_rad: 30.0 * (PI / 180.0) },
            Change::Intruder {
                shape: shape.to_owned(),
                sizes: vec![("diameter", 0.041)],
                mass: 0.03,
            },
            Change::Spin(-2.5),
            Change::X(0.5 * medium.container.width),
        ];
        let x = format!("impact.x=\"{:?} m\"", 0.5 * medium.container.width);
        let at = medium.effects.len() + medium.grain_forces.len();
        let effect = [
            format!("effect.{at}.name=\"pore-air\""),
            format!("effect.{at}.drag_rate=\"{:?} 1/s\"", 1.0_f64 / 3.0),
        ];
        let sets = [
            "run.seed=7",
            "medium.gravity=\"1.62 m/s^2\"",
            "contact_law.friction=0.30000000000000004",
            "bed.preparation_friction=0.07",
            "medium.grain_inertia=0.35",
            &effect[0],
            &effect[1],
            "impact.speed=\"0.7999999999999999 m/s\"",
            "impact.angle=\"30 deg\"",
            "intruder.diameter=\"41 mm\"",
            "intruder.mass=\"30 g\"",
            "impact.spin=\"-2.5 rad/s\"",
            &x,
        ];
        let expected = by_text(&model, &sets).expect("a model");
        assert_eq!(identity(&by_change(&model, &changes)), identity(&expected));
    }
}

#[test]
fn grains_that_are_heavier_settle_with_their_mass_and_make_another_bed() {
    use configs::BedSource;
    for model in beds() {
        let mass = |model: &Model| {
            let medium = model.grains().expect("a bed").medium;
            match &medium.bed.source {
                BedSource::Settle(settle) => {
                    settle.grains.iter().map(|kind| kind.total_mass(medium.space)).sum::<f64>()
                }
                BedSource::Csv(csv) => csv.grains.iter().map(|grain| grain.mass).sum(),
            }
        };
        let heavier = by_change(&model, &[Change::GrainMass(1.25)]);
        let is_given =
            matches!(model.grains().expect("a bed").medium.bed.source, BedSource::Csv(_));
        let factor = if is_given { 1.0 } else { 1.25 };
        assert!(
            (mass(&heavier) / (factor * mass(&model)) - 1.0).abs() < 1e-12,
            "{}",
            model.run.name
        );
        assert_eq!(identity(&heavier)[2] == identity(&model)[2], is_given, "{}", model.run.name);
    }
}

#[test]
fn grains_of_every_distribution_are_those_of_their_text() {
    use configs::{GrainKind, Material};
    use engine::bed::SizeDistribution;
    let model = beds().find(|model| model.run.name == "vertical-2d").expect("it is shipped");
    let kind = |sizes| GrainKind { count: 90, sizes, material: Material::Density(20.0) };
    let equal = GrainKind {
        count: 10,
        sizes: SizeDistribution::Equal(5e-3),
        material: Material::Mass(5e-5),
    };
    let kinds = vec![
        equal,
        kind(SizeDistribution::Uniform { min: 4e-3, max: 6e-3 }),
        kind(SizeDistribution::lognormal(5e-3, 0.1)),
        kind(SizeDistribution::List { diameters: vec![4e-3, 5e-3], weights: vec![3.0, 1.0] }),
    ];
    let text = "bed.grains=[{ count = 10, diameter = \"5 mm\", mass = \"0.05 g\" }, \
        { count = 90, distribution = \"uniform\", diameter_min = \"4 mm\", diameter_max = \"6 mm\", \
          density = \"20 kg/m^2\" }, \
        { count = 90, distribution = \"lognormal\", diameter_median = \"5 mm\", diameter_sigma = 0.1, \
          density = \"20 kg/m^2\" }, \
        { count = 90, distribution = \"list\", diameters = [\"4 mm\", \"5 mm\"], weights = [3.0, 1.0], \
          density = \"20 kg/m^2\" }]";
    let expected = by_text(&model, &[text]).expect("a model");
    assert_eq!(identity(&by_change(&model, &[Change::Grains(kinds)])), identity(&expected));
}

#[test]
fn what_is_no_model_is_refused_with_the_words_for_a_file() {
    let model = beds().next().expect("one is shipped");
    let grains = model.grains().expect("a bed");
    let unknown = grains.with(&[Change::Effect("pore-water", Vec::new())]);
    let refused = unknown.expect_err("there is no such effect").to_string();
    assert!(refused.contains("there is no effect `pore-water`"), "{refused}");
    let twice = vec![Change::Effect("pore-air", vec![("drag_rate", 1.0)]); 2];
    let refused = grains.with(&twice).expect_err("it is there twice").to_string();
    assert!(refused.contains("the effect `pore-air` is given twice"), "{refused}");
    let range = grains.with(&[Change::Gravity(f64::NAN)]);
    assert!(range.expect_err("it is no number").to_string().contains("not a finite number"));
}
