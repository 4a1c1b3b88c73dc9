//! Runs in three dimensions, with layers, periods, a recessive wall, a joint and laws that remember
//! something: the same bytes on any number of threads, and after an end on the way.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use crate::common::{Call, assert_same_run, ended_on_the_way, folder};

/// What all models here have: Hertz contacts with cohesion, rolling and twisting, layers that absorb.
const BED: &str = r#"
[run]
name = "space"
duration = "3 ms"
time_step = "auto"
seed = 1
checkpoint_every = 40

[log]
flush_every = 40
fields_at = ["1 ms"]

[medium]
kind = "grains"
dimension = 3
gravity = "9.81 m/s^2"

[container]
shape = "box"
width = "49 mm"
depth = "49 mm"
sides = "SIDES"
bottom = "absorbing"

[bed]
source = "csv"
file = "grains.csv"

[contact_law]
name = "hertz-mindlin"
young_modulus = "5 MPa"
poisson_ratio = 0.25
restitution = 0.6
friction = 0.3

[[effect]]
name = "cohesion-jkr"
work_of_adhesion = "0.05 J/m^2"

[[effect]]
name = "rolling-resistance"
rolling_friction = 0.05

[[effect]]
name = "twisting-resistance"
twisting_friction = 0.05

[impact]
speed = "2 m/s"
angle = "60 deg"
"#;

/// A leaning body under its shaft.
const HEMISPHERE: &str = r#"
attitude = "20 deg"
spin = ["5 rad/s", "-3 rad/s", "2 rad/s"]

[intruder]
shape = "hemisphere"
diameter = "12 mm"
mass = "4 g"
recessive_wall = true
"#;

const CHAIN: &str = r#"
[intruder]
shape = "two-link-chain"
length = "14 mm"
diameter = "5 mm"
link_angle_1 = "20 deg"
link_angle_2 = "-25 deg"
mass = "4 g"
"#;

/// Writes the model and its bed: three layers and more of spheres, 12 by 12, that nearly touch.
fn model(folder: &Path, sides: &str, intruder: &str) -> PathBuf {
    let mut table = String::from("x_m,y_m,z_m,radius_m,mass_kg\n");
    for k in 0..12 * 12 * 5 {
        let (i, j, layer) = (k % 12, k / 12 % 12, k / 144);
        let [x, y, z] = [i, j, layer].map(|n| 0.00225 + 0.00404 * f64::from(n));
        // Rows of every other layer are shifted a little, so that they do not fall in columns.
        let shift = 0.0003 * f64::from(layer % 2);
        let _ = writeln!(table, "{},{y},{z},0.002,8e-5", x + shift);
    }
    fs::write(folder.join("grains.csv"), table).expect("the table");
    let path = folder.join("model.toml");
    fs::write(&path, BED.replace("SIDES", sides) + intruder).expect("the model");
    path
}

#[test]
fn a_run_in_space_is_the_same_bytes_on_1_2_3_and_8_threads() {
    for (sides, intruder) in [("absorbing", HEMISPHERE), ("periodic", CHAIN)] {
        let folder = folder();
        let model = model(folder.path(), sides, intruder);
        let run = |threads: &str| {
            let out = folder.path().join(threads);
            let ended = Call::run_model(&model, &out).arg("--threads").arg(threads).done();
            (ended, out)
        };
        let (first, one) = run("1");
        assert!(first.json()["bed"]["activity"]["largest_moving_share"].as_f64() > Some(0.0));
        for threads in ["2", "3", "8"] {
            let (ended, out) = run(threads);
            assert_eq!(ended.result(), first.result(), "{threads} threads, {sides}");
            assert_same_run(&out, &one);
        }
    }
}

#[test]
fn a_run_in_space_ended_on_the_way_is_resumed_to_the_same_bytes() {
    for (sides, intruder) in [("absorbing", HEMISPHERE), ("periodic", CHAIN)] {
        let folder = folder();
        let model = model(folder.path(), sides, intruder);
        let [whole, parts] = ["whole", "parts"].map(|name| folder.path().join(name));
        Call::run_model(&model, &whole).done();
        let run = || Call::run_model(&model, &parts);
        let ended = ended_on_the_way(run, &parts.join("checkpoint.prev"), &["TERM"]);
        assert_eq!(ended.code, Some(143));
        run().arg("--resume").done();
        assert_same_run(&parts, &whole);
    }
}
