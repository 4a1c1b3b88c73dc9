//! Prepared beds are found again, if and only if they are the same.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common::{Call, Ended, assert_same_run, cache, folder, small_model};

const ROLLING: &str = r#"effect=[{ name = "rolling-resistance", rolling_friction = 0.05 }]"#;

fn bed(cache: &Path, settings: &[&str]) -> Ended {
    let call = Call::new(["bed", "--json", "--cache"]).arg(cache).arg(small_model());
    // Few grains settle soon.
    call.set(&["bed.grains.0.count=40", "bed.grains.1.count=8"]).set(settings).done()
}

fn run(cache: &Path, out: &Path) -> Ended {
    let call = Call::new(["run", "--json", "--cache"]).arg(cache).arg("--out").arg(out);
    call.arg(small_model()).set(&["bed.grains.0.count=40", "run.duration=2 ms"]).done()
}

#[test]
fn a_bed_is_prepared_once_and_both_runs_have_the_same_bytes() {
    let (beds, parent) = (folder(), folder());
    let (a, b) = (parent.path().join("a"), parent.path().join("b"));
    assert_eq!(run(beds.path(), &a).json()["bed"]["cache"], "miss");
    assert_eq!(run(beds.path(), &b).json()["bed"]["cache"], "hit");
    for name in ["run.mcap", "grains.mcap", "model.toml"] {
        let read = |folder: &Path| fs::read(folder.join(name)).expect("a file");
        assert!(read(&a) == read(&b), "{name}");
    }
}

#[test]
fn a_damaged_bed_is_prepared_again_with_a_warning() {
    let (beds, parent) = (folder(), folder());
    let out = parent.path().join("first");
    run(beds.path(), &out);
    let path = fs::read_dir(beds.path().join("beds")).expect("beds").next().expect("a bed");
    let path = path.expect("a bed").path();
    let whole = fs::read(&path).expect("the bed");
    for (name, damaged) in [("cut", &whole[..whole.len() / 2]), ("empty", b"")] {
        fs::write(&path, damaged).expect("the bed");
        let again = parent.path().join(name);
        let ended = run(beds.path(), &again);
        assert_eq!(ended.json()["bed"]["cache"], "miss");
        assert!(ended.stderr.contains("damaged") && ended.stderr.contains("prepared again"));
        assert!(fs::read(&path).expect("the bed") == whole);
        assert_same_run(&again, &out);
    }
    assert_eq!(fs::read_dir(beds.path().join("beds")).expect("beds").count(), 1, "one file a bed");
}

#[test]
fn what_the_bed_does_not_depend_on_keeps_it_and_what_it_depends_on_does_not() {
    let beds = folder();
    let said = |settings: &[&str]| bed(beds.path(), settings).json()["cache"].clone();
    assert_eq!(said(&[]), "miss");
    for same in [
        "impact.speed=2 m/s",
        "run.name=another",
        "run.time_step=5 us",
        "run.duration=1 s",
        "run.checkpoint_every=7",
        "log.frames_per_s=10",
        "intruder.mass=10 g",
        "energy.abort_above=1",
        "conditions.positions=2",
        ROLLING,
    ] {
        assert_eq!(said(&[same]), "hit", "{same}");
    }
    for other in [
        "bed.preparation_friction=0.1",
        "run.seed=2",
        "bed.grains.0.count=41",
        "bed.grains.0.mass=0.05 g",
        "container.width=9 cm",
        "contact_law.normal_stiffness=3000 N/m",
    ] {
        assert_eq!(said(&[other]), "miss", "{other}");
        assert_eq!(said(&[other]), "hit", "{other}");
    }
}

#[test]
fn runs_that_need_the_same_bed_at_the_same_time_prepare_it_once() {
    let (beds, parent) = (folder(), folder());
    let start = |name: &str| {
        let call = Call::new(["run", "--json", "--cache"]).arg(beds.path()).arg("--out");
        let call = call.arg(parent.path().join(name)).arg(small_model());
        call.set(&["run.duration=1 ms", "bed.grains.0.count=120"]).start()
    };
    let children = ["a", "b", "c"].map(start);
    let mut said: Vec<Value> = children
        .into_iter()
        .map(|child| {
            let ended = Ended::of(child);
            assert_eq!(ended.code, Some(0), "{}", ended.stderr);
            ended.json()["bed"]["cache"].clone()
        })
        .collect();
    said.sort_by_key(Value::to_string);
    assert_eq!(said, ["hit", "hit", "miss"]);
    assert_eq!(fs::read_dir(beds.path().join("beds")).expect("beds").count(), 1, "one file a bed");
}

#[test]
fn the_command_for_a_bed_says_what_it_is() {
    let json = Call::new(["bed", "--json", "--cache"]).arg(cache()).arg(small_model()).done();
    let json = json.json();
    assert_eq!((&json["grains"], &json["cache"]), (&300.into(), &"hit".into()));
    assert!(Path::new(json["path"].as_str().expect("a path")).is_file());
    for (key, from, to) in [
        ("packing_fraction", 0.75, 0.9),
        ("height_m", 0.05, 0.1),
        ("coordination", 2.5, 5.0),
        ("mean_diameter_m", 0.00456, 0.00635),
    ] {
        let value = json[key].as_f64().unwrap_or_else(|| panic!("{key}"));
        assert!((from..to).contains(&value), "{key} is {value}");
    }
    let text = Call::new(["bed", "--cache"]).arg(cache()).arg(small_model()).done().stdout;
    assert!(text.contains("300") && text.contains("packing fraction"), "{text}");
}
