//! Three grains in a row, hit on the middle one.

use std::fs;
use std::path::Path;

use configs::{LoadOptions, Loaded, Model, ModelSource};

use crate::program::{in_lammps, in_plunge};

const LINEAR: &str = "\
name = \"linear-spring-dashpot\"
normal_stiffness = \"3200 N/m\"
normal_damping_rate = \"1e4 1/s\"
tangential_damping_rate = \"8e3 1/s\"
friction = 0.28
";

const HERTZ: &str = "\
name = \"hertz-mindlin\"
young_modulus = \"50 MPa\"
poisson_ratio = 0.25
restitution = 0.5
friction = 0.3
";

/// Of 10 us each.
const STEPS: u64 = 200;

/// How far apart the velocities may be (m/s), of an impact at 1 m/s: damping of the half step and
/// sliding springs differ.
const APART: f64 = 0.02;

#[test]
fn among_discs_under_the_linear_law_the_intruder_moves_as_in_plunge() {
    let apart = apart("x_m,y_m,radius_m,mass_kg\n", "", "disc", LINEAR);
    assert!(apart < APART, "apart by {apart} m/s");
}

#[test]
fn among_spheres_of_hertz_and_mindlin_the_intruder_moves_as_in_plunge() {
    let depth = "depth = \"20 mm\"\n";
    let apart = apart("x_m,y_m,z_m,radius_m,mass_kg\n", depth, "sphere", HERTZ);
    assert!(apart < APART, "apart by {apart} m/s");
}

/// How far the velocities of the intruder are apart (m/s) after [`STEPS`], in LAMMPS and in plunge: an
/// oblique hit with spin, so that springs, damping and friction all act.
fn apart(columns: &str, depth: &str, shape: &str, law: &str) -> f64 {
    let folder = tempfile::tempdir().expect("a folder");
    let loaded = model(folder.path(), [columns, depth, shape, law]);
    let theirs = velocity_of(&in_lammps(folder.path(), &loaded, 1, STEPS));
    let ours = in_plunge(&loaded, STEPS).intruder().bodies()[0].velocity;
    let ours = [ours.x, ours.z];
    // It came down at 0.98 m/s: without a bed under it the comparison would be one of free falls.
    assert!(ours[1] > -0.7, "the bed has hardly slowed it: {ours:?}");
    libm::hypot(theirs[0] - ours[0], theirs[1] - ours[1])
}

/// Three grains in a row on the floor, hit on the middle one.
fn model(folder: &Path, [columns, depth, shape, law]: [&str; 4]) -> Loaded {
    let (dimension, y) = if depth.is_empty() { (2, "") } else { (3, "0.01,") };
    let rows = ["0.01", "0.02", "0.03"].map(|x| format!("{x},{y}0.005,0.005,0.001\n")).concat();
    fs::write(folder.join("grains.csv"), format!("{columns}{rows}")).expect("a table");
    let text = format!(
        "[run]\nname = \"three\"\nduration = \"10 ms\"\ntime_step = \"10 us\"\nseed = 1\n\n\
         [medium]\nkind = \"grains\"\ndimension = {dimension}\ngravity = \"9.81 m/s^2\"\n\n\
         [container]\nshape = \"box\"\nwidth = \"40 mm\"\n{depth}sides = \"wall\"\nbottom = \"wall\"\n\n\
         [bed]\nsource = \"csv\"\nfile = \"grains.csv\"\n\n[contact_law]\n{law}\n\
         [intruder]\nshape = \"{shape}\"\ndiameter = \"1 cm\"\nmass = \"10 g\"\n\n\
         [impact]\nspeed = \"1 m/s\"\nangle = \"80 deg\"\nspin = \"20 rad/s\"\n"
    );
    let source = ModelSource::Text { name: "three".into(), text, folder: folder.to_owned() };
    Model::load(source, &LoadOptions::default())
        .unwrap_or_else(|error| panic!("{}", error.render(configs::Color::Off)))
}

/// The velocity of the intruder (m/s), along x and upward, at the end of what LAMMPS `said`.
fn velocity_of(said: &str) -> [f64; 2] {
    let state = said.lines().rfind(|line| line.starts_with("intruder at the end")).expect(said);
    let state: Vec<f64> = state.split([',', ' ']).filter_map(|word| word.parse().ok()).collect();
    // Time, position and velocity; up is the last of their components.
    [state[state.len() / 2 + 1], state[state.len() - 1]]
}
