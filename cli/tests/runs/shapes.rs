//! Intruders that lean, turn and are linked: what a run says of them.

use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::common::{Call, assert_same_run, ended_on_the_way, folder};
use crate::log::Log;

fn model(name: &str) -> PathBuf {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("../configs/schema/tests/good");
    tests.join(name).with_extension("toml")
}

fn number(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap_or_else(|| panic!("`{key}` in {value}"))
}

#[test]
fn both_links_of_a_chain_are_logged_and_give_the_bed_what_they_lose() {
    let out = folder();
    let summary = Call::run_model(&model("small-chain-2d"), out.path()).done().json();
    let links = summary["links"].as_array().expect("links");
    let sum = |key: &str| links.iter().map(|link| number(link, key)).sum::<f64>();
    let lost = sum("kinetic_lost_J") + sum("potential_lost_J");
    // The trapezoid of force over way and of torque over turn, to second order in a step of a
    // thirtieth of a collision; what is unaccounted for is of the same size.
    assert!((sum("given_J") / lost - 1.0).abs() < 2e-3, "{summary}");
    assert!((sum("given_share") - 1.0).abs() < 1e-12);

    let stop = &summary["stop"];
    let first = links.iter().map(|link| number(link, "contact_s")).fold(f64::INFINITY, f64::min);
    let last = links
        .iter()
        .map(|link| number(link, "contact_s") + number(link, "stopping_time_s"))
        .fold(0.0, f64::max);
    assert!(first < 1e-4, "the deeper tip just touches at the start: {first}");
    // Two subtractions.
    assert!((number(stop, "stopping_time_s") - (last - first)).abs() < 1e-15);
    let deepest = links.iter().map(|link| number(link, "depth_m")).fold(0.0, f64::max);
    assert_eq!(number(stop, "depth_m").to_bits(), deepest.to_bits());

    let log = Log::read(&out.path().join("run.mcap"));
    let steps = summary["cost"]["steps"].as_u64().expect("steps") as usize;
    for name in ["front", "rear"] {
        assert_eq!(log.count(&format!("/intruder/{name}/state")), steps + 1);
        assert_eq!(log.count(&format!("/intruder/{name}/load")), steps + 1);
        assert!(log.says("/log", &format!("{name} stopped after")), "{name}");
    }
}

#[test]
fn a_chain_interrupted_and_resumed_ends_at_the_same_bytes() {
    let parent = folder();
    let run = |name: &str| {
        let settings = ["run.duration=60 ms", "run.checkpoint_every=200", "log.flush_every=100"];
        Call::run_model(&model("small-chain-2d"), &parent.path().join(name)).set(&settings)
    };
    run("whole").done();
    let (whole, cut) = (parent.path().join("whole"), parent.path().join("cut"));
    let ended = ended_on_the_way(|| run("cut"), &cut.join("checkpoint.prev"), &["KILL"]);
    assert_eq!(ended.code, None, "a signal ended it");
    run("cut").arg("--resume").done();
    assert_same_run(&cut, &whole);
}

#[test]
fn a_leaning_body_in_space_closes_its_budget_and_turns_as_it_is_launched() {
    let out = folder();
    let summary = Call::run_model(&model("leaning-cone-3d"), out.path()).done().json();
    // As discs do at the default step.
    assert!(number(&summary["energy"], "closure") < 1e-3, "{summary}");
    assert!(number(&summary["stop"], "depth_m") > 0.0);
    let initial = number(&summary["energy"], "initial_J");
    assert!(initial > 0.0);
}
