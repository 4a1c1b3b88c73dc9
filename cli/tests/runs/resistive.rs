//! Runs on a resistive medium: files, ledger, stops, links, conduct.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::common::{Call, Ended, folder, names, summary, without_cost};
use crate::log::Log;

const SHIPPED: [&str; 4] = ["two-term-vector", "two-term-components", "poncelet", "link"];

/// A cylinder under water, which moves with it from the start.
const UNDER_WATER: &str =
    concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/schema/tests/good/resistive-under-water.toml");

/// A chain of two equal links, one more inclined than the other.
const CHAIN: &str = r#"
[run]
name = "chain"
duration = "1 s"

[medium]
kind = "resistive-force"
bulk_density = "1550 kg/m^3"
gravity = "9.81 m/s^2"

[resistance]
name = "link"
drag = 3.0
horizontal = 5.0

[intruder]
shape = "two-link-chain"
length = "15 cm"
diameter = "6.35 mm"
density = "7850 kg/m^3"
link_angle_1 = "15 deg"
link_angle_2 = "-25 deg"

[impact]
speed = "2 m/s"
angle = "90 deg"
"#;

fn run(model: &str, out: &Path, settings: &[&str]) -> Ended {
    Call::new(["run", "--json", "--out"]).arg(out).arg(model).set(settings).done()
}

fn number(summary: &Value, key: &str) -> f64 {
    summary.pointer(key).and_then(Value::as_f64).unwrap_or_else(|| panic!("{key} in {summary}"))
}

fn chain(here: &Path) -> PathBuf {
    let path = here.join("chain.toml");
    fs::write(&path, CHAIN).expect("a writable folder");
    path
}

#[test]
fn every_shipped_model_and_one_under_water_stops_with_a_closed_ledger() {
    for model in SHIPPED.into_iter().chain([UNDER_WATER]) {
        let out = folder();
        let summary = run(model, out.path(), &[]).json();
        assert_eq!(summary["medium"], "resistive-force");
        assert_eq!(summary["stop"]["stopped"], true, "{model}");
        // What the solver's tolerance of 1e-10 leaves, and a factor of a hundred.
        assert!(number(&summary, "/energy/closure") < 1e-8, "{model}");
        let energy = &summary["energy"];
        let sum = |key: &str| -> f64 {
            let object = energy[key].as_object().expect("an object");
            object.values().map(|value| value.as_f64().expect("a number")).sum()
        };
        let (initial, found) =
            (number(&summary, "/energy/initial_J"), sum("final") + sum("dissipated_J"));
        // The ledger's own closure, and the round-off of a dozen terms.
        assert!((found / initial - 1.0).abs() < 1e-8, "{model}: {found} J of {initial} J");
        assert!(summary.get("bed").is_none() && summary.get("links").is_none());
        assert_eq!(
            names(out.path()),
            [".lock", "model.toml", "report.html", "run.mcap", "summary.json"]
        );
    }
}

#[test]
fn a_run_has_the_same_bytes_again_and_from_its_own_model_file() {
    for model in SHIPPED {
        let (first, second, third) = (folder(), folder(), folder());
        run(model, first.path(), &[]);
        run(model, second.path(), &["run.seed=1"]);
        let own = first.path().join("model.toml");
        run(own.to_str().expect("UTF-8"), third.path(), &[]);
        let read = |out: &Path, name: &str| fs::read(out.join(name)).expect("a result");
        assert!(read(first.path(), "run.mcap") == read(second.path(), "run.mcap"), "{model}");
        assert_eq!(read(first.path(), "model.toml"), read(third.path(), "model.toml"));
        let [a, b] = [first.path(), third.path()].map(|out| without_cost(summary(out)));
        assert_eq!(a, b, "{model}");
    }
}

#[test]
fn the_log_has_a_sample_every_interval_and_one_at_the_end() {
    let out = folder();
    let summary = run("two-term-vector", out.path(), &["log.interval=1 ms"]).json();
    let stop = number(&summary, "/stop/stopping_time_s");
    let log = Log::read(&out.path().join("run.mcap"));
    let samples = (stop / 1e-3).floor() as usize + 2;
    for topic in ["/energy/budget", "/intruder/intruder/state", "/intruder/intruder/load"] {
        assert_eq!(log.count(topic), samples, "{topic}");
    }
    assert!(log.says("/log", "impact at 2 m/s") && log.says("/log", "stopped after"));
    assert!(log.attachments.contains_key("model.toml"));
    let last = log.messages.iter().map(|message| message.2).max().expect("messages");
    // Log times are whole nanoseconds.
    assert!((last as f64 * 1e-9 - stop).abs() < 2e-9);
}

#[test]
fn the_force_at_the_stop_is_the_static_part_and_it_overtakes_later_at_higher_speed() {
    let mut before = 0.0;
    for speed in ["1 m/s", "2 m/s", "4 m/s"] {
        let out = folder();
        let set = format!("impact.speed={speed}");
        let summary = run("two-term-vector", out.path(), &[&set]).json();
        let (whole, friction) = (
            number(&summary, "/forces/force_at_stop_N"),
            number(&summary, "/forces/static_at_stop_N"),
        );
        // A two-thousandth before the stop, the sphere has as little of its speed, and drag its square.
        assert!((whole / friction - 1.0).abs() < 1e-4, "{whole} N, {friction} N");
        let overtakes = number(&summary, "/forces/static_overtakes_s");
        assert!(overtakes > before, "{overtakes} s at {speed}");
        assert!(overtakes < number(&summary, "/stop/stopping_time_s"));
        before = overtakes;
    }
}

#[test]
fn each_link_of_a_chain_has_its_own_clock_and_all_give_what_is_dissipated() {
    let here = folder();
    let out = here.path().join("out");
    let model = chain(here.path());
    let summary = run(model.to_str().expect("UTF-8"), &out, &[]).json();
    let links = summary["links"].as_array().expect("links");
    assert_eq!(links.len(), 2);
    // The link nearer to the vertical reaches deeper and touches first.
    assert!(number(&summary, "/links/0/contact_s").abs() < 1e-12);
    assert!(number(&summary, "/links/1/contact_s") > 1e-3);
    let given = number(&summary, "/links/0/given_J") + number(&summary, "/links/1/given_J");
    let dissipated = summary["energy"]["dissipated_J"].as_object().expect("channels");
    let lost: f64 = dissipated.values().map(|value| value.as_f64().expect("a number")).sum();
    // The same integrals, added in another order.
    assert!((given / lost - 1.0).abs() < 1e-12, "{given} J given, {lost} J lost");
    for share in ["kinetic_share", "given_share"] {
        let of = |link: usize| number(&summary, &format!("/links/{link}/{share}"));
        assert!(of(0) > 0.0 && of(1) > 0.0, "{share}");
    }
    assert!(
        (number(&summary, "/links/0/given_share") + number(&summary, "/links/1/given_share") - 1.0)
            .abs()
            < 1e-12
    );
    let log = Log::read(&out.join("run.mcap"));
    assert!(log.count("/intruder/intruder-1/state") > 10);
    assert_eq!(log.count("/intruder/intruder-1/state"), log.count("/intruder/intruder-2/state"));
}

#[test]
fn two_equal_links_give_half_each() {
    let here = folder();
    let out = here.path().join("out");
    let model = chain(here.path());
    let set = ["intruder.link_angle_1=20 deg", "intruder.link_angle_2=-20 deg"];
    let summary = run(model.to_str().expect("UTF-8"), &out, &set).json();
    // By symmetry, to what the solver leaves of it.
    assert!((number(&summary, "/links/0/given_share") - 0.5).abs() < 1e-8);
}

#[test]
fn a_list_of_conditions_gives_a_folder_each_and_is_reported_again_as_it_is() {
    let out = folder();
    let set =
        [r#"conditions.speed=["1 m/s", "2 m/s"]"#, r#"conditions.angle=["90 deg", "60 deg"]"#];
    let list = run("two-term-components", out.path(), &set).json();
    assert_eq!(list["medium"], "resistive-force");
    assert_eq!(list["runs"].as_array().expect("runs").len(), 4);
    let found = names(out.path());
    assert_eq!(
        found,
        [".lock", "001", "002", "003", "004", "model.toml", "report.html", "summary.json"]
    );
    assert_eq!(list["runs"][3]["impact"]["angle_deg"], 60.0);
    assert_eq!(run("two-term-components", out.path(), &set).json(), list);
}

#[test]
fn other_inputs_are_refused_and_an_unfinished_run_starts_again() {
    let (out, whole) = (folder(), folder());
    run("link", out.path(), &[]);
    run("link", whole.path(), &[]);
    let again = || Call::new(["run", "--json", "--out"]).arg(out.path()).arg("link");
    assert!(again().set(&["impact.speed=1 m/s"]).fails(2).contains("other inputs"));
    fs::remove_file(out.path().join("summary.json")).expect("a summary");
    fs::rename(out.path().join("run.mcap"), out.path().join("run.mcap.partial")).expect("a log");
    assert!(again().fails(2).contains("--resume"));
    again().arg("--resume").done();
    let read = |folder: &Path| fs::read(folder.join("run.mcap")).expect("a log");
    assert!(read(out.path()) == read(whole.path()));
    assert_eq!(
        names(out.path()),
        [".lock", "model.toml", "report.html", "run.mcap", "summary.json"]
    );
}

#[test]
fn a_resistive_medium_has_no_bed_to_prepare() {
    let message = Call::new(["bed", "two-term-vector"]).fails(2);
    assert!(message.contains("has no bed"), "{message}");
}

#[test]
fn a_body_let_go_at_the_surface_sinks_and_its_closure_counts_in_its_fall() {
    let out = folder();
    let summary = run("two-term-vector", out.path(), &["impact.speed=0 m/s"]).json();
    assert!(number(&summary, "/stop/depth_m") > 0.01, "{summary}");
    assert!(number(&summary, "/energy/closure") < 1e-8);
}

#[test]
fn what_is_said_of_forces_and_stops_does_not_hang_on_the_interval_of_the_log() {
    let [fine, coarse] = ["0.05 ms", "20 ms"].map(|interval| {
        let out = folder();
        run("two-term-vector", out.path(), &[&format!("log.interval={interval}")]).json()
    });
    assert_eq!(fine["forces"], coarse["forces"]);
    assert_eq!(fine["stop"], coarse["stop"]);
}

#[test]
fn a_sphere_that_comes_to_rest_spinning_keeps_its_energy_of_rotation() {
    let out = folder();
    let set = ["impact.angle=45 deg", "impact.spin=100 rad/s"];
    let summary = run("two-term-vector", out.path(), &set).json();
    assert_eq!(summary["stop"]["stopped"], true);
    assert!(number(&summary, "/energy/closure") < 1e-8, "{summary}");
}

#[test]
fn check_says_what_will_be_integrated() {
    let text = Call::new(["check", "two-term-components"]).done().stdout;
    for part in ["alpha_x", "disc, in 2 dimensions", "resistance.drag_x@45"] {
        assert!(text.contains(part), "{part}: {text}");
    }
}
