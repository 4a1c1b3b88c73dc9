//! A bed from a table of grains.

use std::fs::{self, OpenOptions};
use std::io::Write as _;
use std::path::{Path, PathBuf};

use crate::common::{
    Call, assert_same_run, ended_on_the_way, folder, names, small_model, without_cost,
};

/// Writes a model whose bed is a table of two rows of grains, and gives its path.
fn model_with_a_table(folder: &Path) -> PathBuf {
    let text = fs::read_to_string(small_model()).expect("the model");
    let (before, rest) = text.split_once("[bed]").expect("a bed");
    let (_, after) = rest.split_once("[contact_law]").expect("a law");
    let model = folder.join("model.toml");
    let bed = "[bed]\nsource = \"csv\"\nfile = \"table.csv\"\n\n[contact_law]";
    fs::write(&model, format!("{before}{bed}{after}")).expect("a model");
    let mut table = "x_m,y_m,radius_m,mass_kg\n".to_owned();
    for row in 0..3 {
        for column in 0..20 {
            let (x, y) = (0.0025 + 0.005 * f64::from(column), 0.0025 + 0.005 * f64::from(row));
            table.push_str(&format!("{x},{y},0.0025,4.9e-5\n"));
        }
    }
    fs::write(folder.join("table.csv"), table).expect("a table");
    model
}

const LIST: &str = "conditions.positions=2";

#[test]
fn a_bed_from_a_table_runs_and_its_folder_runs_again_under_the_same_hash_without_the_table() {
    let (project, parent) = (folder(), folder());
    let model = model_with_a_table(project.path());
    let out = parent.path().join("out");
    let first = Call::run_model(&model, &out).set(&["run.duration=5 ms"]).done().json();
    assert_eq!((&first["bed"]["cache"], &first["bed"]["grains"]), (&"file".into(), &60.into()));
    let table = project.path().join("table.csv");
    let read = |path: &Path| fs::read(path).expect("a table");
    assert!(read(&out.join("grains.csv")) == read(&table));
    fs::remove_file(table).expect("the table");
    let again = parent.path().join("again");
    let second = Call::run_model(&out.join("model.toml"), &again).done().json();
    // The hash once had the name of the table in it.
    assert_eq!(without_cost(second), without_cost(first));
    for name in ["grains.mcap", "model.toml", "grains.csv"] {
        assert!(read(&out.join(name)) == read(&again.join(name)), "{name}");
    }
}

#[test]
fn a_folder_with_its_table_runs_again_in_place() {
    let (project, parent) = (folder(), folder());
    let model = model_with_a_table(project.path());
    let (out, other) = (parent.path().join("out"), parent.path().join("other"));
    Call::run_model(&model, &out).done();
    let own = out.join("model.toml");
    Call::run_model(&own, &other).done();
    // To force its own model in its own folder once removed the table before it was read.
    Call::run_model(&own, &out).arg("--force").done();
    assert_same_run(&out, &other);
    // To resume there once emptied the table that was copied onto itself.
    let call = || Call::run_model(&own, &out).set(&["run.checkpoint_every=100"]);
    let ended = ended_on_the_way(call, &out.join("checkpoint"), &["KILL"]);
    assert_eq!(ended.code, None, "a signal ended it");
    call().arg("--resume").done();
    assert_eq!(fs::read(out.join("grains.csv")).ok(), fs::read(other.join("grains.csv")).ok());
}

#[test]
fn every_condition_of_a_list_has_the_table_beside_its_model() {
    let (project, parent) = (folder(), folder());
    let model = model_with_a_table(project.path());
    let (out, again) = (parent.path().join("out"), parent.path().join("again"));
    Call::run_model(&model, &out).set(&[LIST, "run.duration=1 ms"]).done();
    for sub in ["001", "002"] {
        assert!(names(&out.join(sub)).contains(&"grains.csv".to_owned()));
    }
    Call::run_model(&out.join("002/model.toml"), &again).done();
    let read = |path: &Path| fs::read(path.join("grains.mcap")).expect("a log");
    assert!(read(&again) == read(&out.join("002")));
}

#[test]
fn a_changed_table_is_other_inputs_and_refused_where_the_model_knows_its_hash() {
    let (project, parent) = (folder(), folder());
    let model = model_with_a_table(project.path());
    let out = parent.path().join("out");
    Call::run_model(&model, &out).set(&["run.duration=1 ms"]).done();
    let add = |path: &Path| {
        let mut file = OpenOptions::new().append(true).open(path).expect("a table");
        writeln!(file, "0.05,0.0175,0.0025,4.9e-5").expect("a line");
    };
    add(&project.path().join("table.csv"));
    let call = Call::run_model(&model, &out).set(&["run.duration=1 ms"]);
    assert!(call.fails(2).contains("other inputs"));
    add(&out.join("grains.csv"));
    let message = Call::run_model(&out.join("model.toml"), &parent.path().join("again")).fails(2);
    assert!(message.contains("grains.csv") && message.contains("model.toml"), "{message}");
}

#[test]
fn grains_of_a_table_that_lie_in_each_other_are_refused_with_their_lines() {
    let (project, out) = (folder(), folder());
    let model = model_with_a_table(project.path());
    let table = project.path().join("table.csv");
    let mut file = OpenOptions::new().append(true).open(table).expect("the table");
    writeln!(file, "0.0026,0.0025,0.0025,4.9e-5").expect("a row");
    let message = Call::run_model(&model, out.path()).fails(2);
    assert!(message.contains("lines 2 and 62 overlap by 4.90e-3 m"), "{message}");
}

#[test]
fn a_grain_at_the_end_of_the_world_costs_no_memory_and_no_panic() {
    let (project, out) = (folder(), folder());
    let model = model_with_a_table(project.path());
    let table = project.path().join("table.csv");
    let mut file = OpenOptions::new().append(true).open(table).expect("the table");
    writeln!(file, "0.05,1e300,0.0025,4.9e-5").expect("a row");
    let message = Call::run_model(&model, out.path()).fails(2);
    assert!(
        message.starts_with("error: table.csv: line 62: column y_m: the grain at 1e300 m"),
        "{message}"
    );
}
