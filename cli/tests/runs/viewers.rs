//! The shipped layouts of viewers name what is in a log, and leave nothing of its ledger out.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use mcap::read::MessageStream;
use prost_reflect::{DescriptorPool, Kind, MessageDescriptor};
use serde_json::{Map, Value};

use crate::common::{Call, folder};
use crate::log::Log;

/// Panels that draw curves.
const PLOT: &str = "Plot!";

fn layout(name: &str) -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../viewers").join(name);
    serde_json::from_str(&fs::read_to_string(path).expect("a layout")).expect("JSON")
}

/// The message of every topic in the logs of the run in `out`.
fn topics(out: &Path) -> BTreeMap<String, MessageDescriptor> {
    let mut topics = BTreeMap::new();
    for name in ["run.mcap", "grains.mcap"] {
        let Ok(bytes) = fs::read(out.join(name)) else { continue };
        for message in MessageStream::new(&bytes).expect("a log") {
            let channel = message.expect("a message").channel;
            topics.entry(channel.topic.clone()).or_insert_with(|| {
                let schema = channel.schema.as_ref().expect("a schema");
                let pool = DescriptorPool::decode(&*schema.data).expect("a descriptor");
                pool.get_message_by_name(&schema.name).expect("its message")
            });
        }
    }
    topics
}

/// The configuration of every panel, by its identifier.
fn panels(layout: &Value) -> &Map<String, Value> {
    layout["configById"].as_object().expect("panels")
}

/// The paths of all curves.
fn curves(layout: &Value) -> Vec<String> {
    let plots = panels(layout).iter().filter(|(id, _)| id.starts_with(PLOT));
    let paths = plots.flat_map(|(_, plot)| plot["paths"].as_array().expect("paths"));
    paths.map(|path| path["value"].as_str().expect("a path").to_owned()).collect()
}

/// Whether `field`, dots and all, leads to a number in `message`.
fn is_number(message: &MessageDescriptor, field: &str) -> bool {
    let (first, rest) = field.split_once('.').unwrap_or((field, ""));
    match message.get_field_by_name(first).map(|field| field.kind()) {
        Some(Kind::Message(inner)) => is_number(&inner, rest),
        Some(Kind::Double | Kind::Uint32 | Kind::Uint64) => rest.is_empty(),
        _ => false,
    }
}

/// Identifiers in the tree of panels.
fn shown(tree: &Value, into: &mut BTreeSet<String>) {
    match tree {
        Value::String(id) => drop(into.insert(id.clone())),
        tree => [&tree["first"], &tree["second"]].iter().for_each(|part| shown(part, into)),
    }
}

/// Asserts that the layout `name` fits the run in `out`.
fn assert_fits(name: &str, out: &Path) {
    let layout = layout(name);
    let topics = topics(out);
    let mut in_tree = BTreeSet::new();
    shown(&layout["layout"], &mut in_tree);
    let configured: BTreeSet<String> = panels(&layout).keys().cloned().collect();
    assert_eq!(in_tree, configured, "{name}: panels in the tree, and those that are described");

    for path in curves(&layout) {
        let (topic, field) = path.split_once('.').expect("a topic and a field");
        let message = topics.get(topic).unwrap_or_else(|| panic!("{name}: no topic {topic}"));
        assert!(is_number(message, field), "{name}: {topic} has no number {field}");
    }
    for (topic, seen) in panels(&layout)["3D!impact"]["topics"].as_object().expect("topics") {
        let message = topics.get(topic).unwrap_or_else(|| panic!("{name}: no topic {topic}"));
        let drawn = ["foxglove.PointCloud", "foxglove.SceneUpdate"];
        assert!(drawn.contains(&message.full_name()) && seen["visible"] == true, "{topic}");
        if let Some(field) = seen["colorField"].as_str() {
            let log = Log::read(&out.join("grains.mcap"));
            assert!(log.says(topic, field), "{topic} has no field {field}");
        }
    }
    let events = &panels(&layout)["RosOut!events"]["topicToRender"];
    assert_eq!(topics[events.as_str().expect("a topic")].full_name(), "foxglove.Log");

    // Heights are shown by the depth; everything else of the ledger is a curve.
    let budget = &topics["/energy/budget"];
    let terms: BTreeSet<String> = budget
        .fields()
        .map(|field| field.name().to_owned())
        .filter(|name| name.ends_with("_J") && !name.starts_with("potential_"))
        .collect();
    let drawn: BTreeSet<String> = curves(&layout)
        .iter()
        .filter_map(|path| path.strip_prefix("/energy/budget.").map(str::to_owned))
        .collect();
    assert_eq!(drawn, terms, "{name}");
}

#[test]
fn the_layout_for_beds_of_grains_fits_the_log_of_one() {
    let out = folder();
    Call::run(out.path()).done();
    assert_fits("foxglove_grains.json", out.path());
}

#[test]
fn the_layout_for_resistive_media_fits_the_log_of_an_impact_on_one() {
    let out = folder();
    Call::new(["run", "--json", "--out"]).arg(out.path()).arg("two-term-vector").done();
    assert_fits("foxglove_resistive.json", out.path());
}
