//! A list of conditions: one folder each, one summary of all.

use std::fs;
use std::path::Path;
use std::thread::sleep;
use std::time::Instant;

use serde_json::Value;

use crate::common::{
    Call, Ended, assert_same_run, cache, folder, names, summary, wait_for, without_cost,
};
use crate::log::Log;

const LIST: [&str; 6] = [
    "run.duration=4 ms",
    "run.checkpoint_every=50",
    "conditions.speed=[\"1 m/s\", \"2 m/s\"]",
    "conditions.angle=[\"90 deg\", \"30 deg\"]",
    "conditions.positions=3",
    "impact.x_range=[\"3 cm\", \"7 cm\"]",
];

fn list(out: &Path) -> Call {
    Call::run(out).set(&LIST)
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn every_condition_has_its_folder_and_the_summary_has_their_mean_and_scatter() {
    let out = folder();
    let ended = list(out.path()).done();
    let top = summary(out.path());
    assert_eq!(ended.json(), top);
    let runs = top["runs"].as_array().expect("runs");
    let expected = [(1.0, 90.0), (1.0, 30.0), (2.0, 90.0), (2.0, 30.0)];
    for (index, run) in runs.iter().enumerate() {
        let sub = out.path().join(format!("{:03}", index + 1));
        let files =
            [".lock", "grains.mcap", "model.toml", "report.html", "run.mcap", "summary.json"];
        assert_eq!(names(&sub), files);
        assert_eq!(*run, summary(&sub));
        let (speed, angle) = expected[index / 3];
        assert_eq!(
            (&run["impact"]["speed_m_per_s"], &run["impact"]["angle_deg"]),
            (&Value::from(speed), &Value::from(angle))
        );
        assert_eq!(run["impact"]["position_index"], index % 3);
    }
    assert_eq!(runs.len(), 12);

    let groups = top["groups"].as_array().expect("groups");
    assert_eq!(groups.len(), 4);
    for (index, group) in groups.iter().enumerate() {
        assert_eq!((number(&group["speed_m_per_s"]), number(&group["angle_deg"])), expected[index]);
        assert_eq!(group["n"], 3);
        for (key, place) in [("depth_m", "stop"), ("range_m", "stop"), ("closure", "energy")] {
            let members = &runs[3 * index..3 * index + 3];
            let values: Vec<f64> = members.iter().map(|run| number(&run[place][key])).collect();
            let mean = values.iter().sum::<f64>() / 3.0;
            let square = |value: &f64| (value - mean).powi(2);
            let sd = (values.iter().map(square).sum::<f64>() / 2.0).sqrt();
            // A handful of roundings in a sum of three.
            let same = |a: f64, b: f64| (a - b).abs() <= 1e-14 * mean.abs();
            assert_eq!(group[key]["n"], 3);
            assert!(same(number(&group[key]["mean"]), mean), "{key}");
            assert!(same(number(&group[key]["sd"]), sd), "{key}");
        }
        // Nobody stopped within 4 ms, which is no number.
        assert_eq!(
            group["stopping_time_s"],
            serde_json::json!({ "n": 0, "mean": null, "sd": null })
        );
    }
}

#[test]
fn drawn_positions_lie_in_their_range_and_hang_on_the_seed_alone() {
    let parent = folder();
    let drawn = |name: &str, settings: &[&str]| -> Vec<f64> {
        let out = parent.path().join(name);
        let call = Call::run(&out).set(&LIST).set(&["run.duration=100 us"]).set(settings);
        let runs = call.done().json()["runs"].clone();
        let runs = runs.as_array().expect("runs").clone();
        runs.iter().map(|run| number(&run["impact"]["x_m"])).collect()
    };
    let first = drawn("first", &[]);
    assert!(first.iter().all(|x| (0.03..=0.07).contains(x)), "{first:?}");
    let bits: Vec<u64> = first.iter().map(|x| x.to_bits()).collect();
    assert!(bits[0] != bits[1] && bits[1] != bits[2] && bits[2] != bits[0]);
    // The same places under every speed and angle.
    assert!(first.chunks(3).all(|group| group == &first[..3]));
    // More positions leave the ones before where they were.
    let more = drawn("more", &["conditions.positions=4"]);
    assert_eq!(more[..3], first[..3]);
    assert_eq!(drawn("again", &[]), first);
    assert_ne!(drawn("other", &["run.seed=2"]), first);
}

#[test]
fn a_list_killed_in_the_middle_and_resumed_ends_at_the_same_bytes() {
    let (whole, parent) = (folder(), folder());
    cache();
    let start = Instant::now();
    list(whole.path()).done();
    let took = start.elapsed();
    let same = |out: &Path| {
        let read = |folder: &Path| without_cost(summary(folder)).to_string();
        assert_eq!(read(out), read(whole.path()));
        for index in 1..=12 {
            let sub = format!("{index:03}");
            assert_same_run(&out.join(&sub), &whole.path().join(&sub));
            assert_eq!(names(&out.join(&sub)), names(&whole.path().join(&sub)));
        }
        assert_eq!(names(out), names(whole.path()));
    };
    for part in 1..4 {
        let out = parent.path().join(part.to_string());
        for _ in 0..2 {
            let mut child = list(&out).arg("--resume").start();
            wait_for(&out.join("model.toml"));
            sleep(took.mul_f64(0.1 * f64::from(part)));
            child.kill().expect("it can be killed");
            let was_killed = Ended::of(child).code.is_none();
            if was_killed && !out.join("summary.json").exists() {
                assert!(list(&out).fails(2).contains("--resume"));
            }
        }
        list(&out).arg("--resume").done();
        same(&out);
    }
}

#[test]
fn the_model_of_one_condition_runs_again_to_the_same_log() {
    let (out, again) = (folder(), folder());
    list(out.path()).done();
    let sub = out.path().join("005");
    Call::run_model(&sub.join("model.toml"), again.path()).done();
    // Equal are the grains, the model, of run.mcap everything but the attachment `model.toml`, which is
    // the file as its author wrote it, and of the summary everything but the place in the list.
    let (first, second) =
        (Log::read(&sub.join("run.mcap")), Log::read(&again.path().join("run.mcap")));
    assert_eq!(first.metadata, second.metadata);
    assert_eq!(first.attachments["model.resolved.toml"], second.attachments["model.resolved.toml"]);
    assert!(first.messages == second.messages && !first.messages.is_empty());
    for name in ["grains.mcap", "model.toml"] {
        let read = |folder: &Path| fs::read(folder.join(name)).expect("a file");
        assert!(read(&sub) == read(again.path()), "{name}");
    }
    let (mut first, second) = (without_cost(summary(&sub)), without_cost(summary(again.path())));
    assert_eq!(
        (&first["impact"]["position_index"], &second["impact"]["position_index"]),
        (&1.into(), &0.into())
    );
    first["impact"]["position_index"] = 0.into();
    assert_eq!(first, second);
}

#[test]
fn a_finished_list_is_reported_as_it_is() {
    let out = folder();
    let first = list(out.path()).done();
    let second = list(out.path()).done();
    assert_eq!(first.stdout, second.stdout);
    let sub = out.path().join("003");
    fs::remove_dir_all(&sub).expect("a folder");
    // What is reported is the summary; who removed a part of it knows.
    assert_eq!(list(out.path()).done().stdout, first.stdout);
    assert!(!sub.exists());
}
