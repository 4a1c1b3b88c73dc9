//! The schema of a campaign takes the one that ships, refuses wrong units and kinds, and knows every key that is
//! read.

use std::fs;
use std::path::Path;

use fixtures::Schema;
use runner::campaign::file::json_schema::{campaign, read_campaign};

const CAMPAIGN: &str = r#"
[campaign]
name = "all"
models = ["vertical-2d", "oblique-2d"]
seeds = 3
keep_logs = true

[set]
run.duration = "0.4 s"
effect.0 = { name = "rolling-resistance", rolling_friction = 0.05 }

[product]
impact.speed = ["1 m/s", "2 m/s"]
contact_law.friction = [0.1, 0.2]

[[point]]
contact_law.friction = 0.2

[sample]
method = "latin-hypercube"
count = 10
seed = 4
[sample.ranges]
intruder.mass = ["20 g", "40 g"]
intruder.diameter = { from = "1 mm", to = "1 m", scale = "logarithmic" }
"#;

fn faults(text: &str) -> Vec<String> {
    let schema = Schema::new(&campaign()).unwrap_or_else(|error| panic!("{error}"));
    schema.faults(text).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn campaigns_that_ship_and_one_with_everything_fit() {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/campaign.toml");
    let shipped = fs::read_to_string(shipped).expect("a campaign");
    for text in [shipped.as_str(), CAMPAIGN] {
        assert_eq!(faults(text), Vec::<String>::new(), "{text}");
    }
}

#[test]
fn wrong_units_kinds_and_keys_do_not_fit() {
    for (right, wrong, place) in [
        ("\"0.4 s\"", "\"0.4 m\"", "/set/run/duration"),
        ("[\"1 m/s\", \"2 m/s\"]", "[\"1 m/s\", \"2 kg\"]", "/product/impact/speed"),
        ("[\"1 m/s\", \"2 m/s\"]", "\"1 m/s\"", "/product/impact/speed"),
        ("impact.speed", "impact.velocity", "/product/impact"),
        ("[\"20 g\", \"40 g\"]", "[\"20 g\", \"40 mm\"]", "/sample/ranges/intruder/mass"),
        ("scale = \"logarithmic\"", "scale = \"log\"", "/sample/ranges/intruder/diameter"),
        ("seeds = 3", "seeds = \"3\"", "/campaign/seeds"),
        ("models =", "model =", "/campaign"),
    ] {
        let text = CAMPAIGN.replacen(right, wrong, 1);
        assert_ne!(text, CAMPAIGN, "{right}");
        let faults = faults(&text);
        assert!(faults.iter().any(|fault| fault.starts_with(place)), "{wrong}: {faults:#?}");
    }
}

#[test]
fn every_key_of_a_campaign_is_in_the_schema() {
    let schema = campaign();
    let asked = read_campaign(CAMPAIGN);
    assert!(asked.questions.len() > 10, "{}", asked.questions.len());
    for question in &asked.questions {
        let table = match asked.tables[question.of].name.as_str() {
            "" => &schema,
            name => &schema["properties"][name],
        };
        assert!(table["properties"].get(question.key).is_some(), "{}", question.key);
    }
}
