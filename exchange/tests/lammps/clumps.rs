//! Intruders that are rigid clumps in LAMMPS: they fall, turn and sink as the bodies that they
//! stand for.

use std::fs;
use std::path::Path;

use configs::{LoadOptions, Loaded, Model, ModelSource};
use engine::math::{Quat, Vec3};
use exchange::lammps::import;
use exchange::read::{BodyState, Keep, read_run};

use crate::program::{in_lammps, in_plunge};

const LINEAR: &str = "\
name = \"linear-spring-dashpot\"
normal_stiffness = \"1e6 N/m\"
normal_damping_rate = \"1e4 1/s\"
tangential_damping_rate = \"8e3 1/s\"
friction = 0.28
";

const HERTZ: &str = "\
name = \"hertz-mindlin\"
young_modulus = \"5 GPa\"
poisson_ratio = 0.25
restitution = 0.5
friction = 0.3
";

/// Every shape that is one body and no disc or sphere.
const SHAPES: [&str; 4] = [
    "shape = \"cylinder\"\ndiameter = \"10 mm\"\nheight = \"8 mm\"",
    "shape = \"hemisphere\"\ndiameter = \"10 mm\"",
    "shape = \"cone\"\ndiameter = \"10 mm\"\napex_angle = \"70 deg\"",
    "shape = \"link\"\nlength = \"16 mm\"\ndiameter = \"6 mm\"\nlink_angle = \"0 deg\"",
];

/// How far apart velocities may be (m/s) after a grain of a quarter of the mass has been hit at 1
/// m/s, which takes 0.3 m/s: balls have another slope than the body, by up to a seventh, and a
/// grain between several of them is damped by all, as if its restitution were half of what it is.
const APART: f64 = 0.08;

/// Grains far aside of the intruder, so that it meets nothing: in a deck of LAMMPS walls act on grains alone.
const ASIDE: [&str; 2] = ["0.015,{y}0.004,0.004", "0.03,{y}0.004,0.004"];

/// Of [`STEP`] each: 3 ms.
const STEPS: u64 = 1500;

/// The time step (s).
const STEP: f64 = 2e-6;

#[test]
fn a_clump_over_nothing_falls_by_gravity_and_tumbles_by_the_inertia_of_its_shape() {
    for (dimension, law, spin) in
        [(2, LINEAR, "\"-30 rad/s\""), (3, HERTZ, "[\"20 rad/s\", \"-300 rad/s\", \"100 rad/s\"]")]
    {
        for shape in SHAPES {
            let folder = tempfile::tempdir().expect("a folder");
            let loaded = model(folder.path(), dimension, law, shape, ASIDE, spin);
            let (theirs, ours) =
                (end_in_lammps(folder.path(), &loaded, 1), in_free_flight(&loaded));
            let time = STEPS as f64 * STEP;
            // 1 m/s at 80 degrees, and a parabola: the sums of both programs differ by round-off.
            let down = libm::sin(80.0_f64.to_radians()) + 9.81 * time;
            assert!((theirs.velocity.z + down).abs() < 1e-9, "{shape}: {}", theirs.velocity.z);
            assert!((theirs.position - ours.position).norm() < 1e-9, "{shape}");
            // Rotation is integrated to second order: 300 rad/s over 2 us is 6e-4, squared 4e-7.
            let apart = (theirs.spin - ours.spin).norm() / ours.spin.norm();
            assert!(
                apart < 4e-7,
                "{dimension} {shape}: spins {:?} and {:?}",
                theirs.spin,
                ours.spin
            );
            // How it is turned follows in an import from spins 0.1 ms apart: 0.03 rad, squared
            // 1e-3, of 1 cm.
            assert!((theirs.depth - ours.depth).abs() < 1e-5, "{dimension} {shape}");
        }
    }
}

#[test]
fn a_clump_hit_off_its_centre_is_slowed_and_turned_as_in_plunge() {
    for (dimension, law) in [(2, LINEAR), (3, HERTZ)] {
        for shape in SHAPES {
            let folder = tempfile::tempdir().expect("a folder");
            // A grain of 0.5 g in the air, under the intruder and aside of its middle.
            let grains = ["0.1035,{y}0.03,0.001", "0.03,{y}0.001,0.001"];
            let loaded = model(folder.path(), dimension, law, shape, grains, "\"0 rad/s\"");
            let [theirs, ours] = in_both(folder.path(), &loaded);
            let falling = Vec3::new(libm::cos(80.0_f64.to_radians()), 0.0, -1.0);
            assert!((ours.velocity - falling).norm() > 0.1, "{shape}: it has met nothing");
            let apart = (theirs.velocity - ours.velocity).norm();
            assert!(apart < APART, "{dimension} {shape}: apart by {apart} m/s");
            // By as much at the edge of a body of some 5 mm.
            let turning = 5e-3 * (theirs.spin - ours.spin).norm();
            assert!(turning < APART, "{dimension} {shape}: apart by {turning} m/s");
        }
    }
}

#[test]
fn a_clump_on_two_ranks_moves_as_on_one() {
    let grains = ["0.1035,{y}0.03,0.001", "0.03,{y}0.001,0.001"];
    let spin = "[\"20 rad/s\", \"-300 rad/s\", \"100 rad/s\"]";
    let ends = [1, 2].map(|ranks| {
        let folder = tempfile::tempdir().expect("a folder");
        let loaded = model(folder.path(), 3, HERTZ, SHAPES[1], grains, spin);
        end_in_lammps(folder.path(), &loaded, ranks)
    });
    let [one, two] = &ends;
    // Forces on balls are added in another order.
    assert!((one.velocity - two.velocity).norm() < 1e-9, "{:?} {:?}", one.velocity, two.velocity);
    assert!((one.spin - two.spin).norm() < 1e-6, "{:?} {:?}", one.spin, two.spin);
}

/// The intruder at the end of a run.
struct End {
    /// (m).
    position: Vec3,
    /// (m/s).
    velocity: Vec3,
    /// (rad/s).
    spin: Vec3,
    /// Of its lowest point (m).
    depth: f64,
}

/// The intruder after [`STEPS`], in LAMMPS and in plunge.
fn in_both(folder: &Path, loaded: &Loaded) -> [End; 2] {
    [end_in_lammps(folder, loaded, 1), end_in_plunge(loaded)]
}

fn end_in_lammps(folder: &Path, loaded: &Loaded, ranks: usize) -> End {
    in_lammps(folder, loaded, ranks, STEPS);
    let imported = import(folder, &folder.join("lmp.mcap"), &|| false).expect("a run");
    let log = read_run(&imported.files.log, Keep::States).expect("a log");
    let BodyState { depth, position, velocity, .. } = *log.bodies[0].states.last().expect("states");
    End { position, velocity, spin: last_spin(folder), depth }
}

fn end_in_plunge(loaded: &Loaded) -> End {
    let simulation = in_plunge(loaded, STEPS);
    let (body, surface) = (&simulation.intruder().bodies()[0], simulation.surface());
    let position = body.position - surface * Vec3::z();
    let depth = surface - body.lowest();
    End { position, velocity: body.velocity, spin: body.spin(), depth }
}

/// The intruder after as long, as a free symmetric top that nothing touches: its axis and its spin turn about the angular
/// momentum L at the rate L/I, with the moment of inertia I across the axis.
///
/// Source: Landau & Lifshitz, Mechanics, section 33.
fn in_free_flight(loaded: &Loaded) -> End {
    let grains = loaded.model.grains().expect("a bed");
    let resting = grains.read_bed().expect("a table");
    let simulation =
        grains.simulation(&resting, &loaded.model.conditions()[0]).expect("a simulation");
    let (body, surface) = (&simulation.intruder().bodies()[0], simulation.surface());
    let time = STEPS as f64 * STEP;
    let own = body.orientation.inverse_transform_vector(&body.spin());
    let momentum = body.orientation * body.inertia.component_mul(&own);
    let across = body.inertia.y;
    // A disc has no moment of inertia about its axis, and no spin about it either.
    let about_axis = if own.z.abs() > 0.0 { (1.0 - body.inertia.z / across) * own.z } else { 0.0 };
    let orientation = Quat::from_scaled_axis(momentum * (time / across))
        * body.orientation
        * Quat::from_scaled_axis(Vec3::z() * (about_axis * time));
    let turned = orientation.inverse_transform_vector(&momentum);
    let spin =
        orientation * turned.zip_map(&body.inertia, |l, i| if l.abs() > 0.0 { l / i } else { 0.0 });
    let position =
        body.position + body.velocity * time - Vec3::z() * (0.5 * 9.81 * time * time + surface);
    let lowest = body.surface().support(orientation.inverse_transform_vector(&-Vec3::z()));
    let velocity = body.velocity - Vec3::z() * (9.81 * time);
    End { position, velocity, spin, depth: lowest - position.z }
}

/// The spin (rad/s) in the last line of the table of the intruder; what turns in a plane turns
/// about y.
fn last_spin(folder: &Path) -> Vec3 {
    let table = fs::read_to_string(folder.join("intruder.csv")).expect("a table");
    let mut lines = table.lines().filter(|line| !line.is_empty());
    let names: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let numbers: Vec<f64> = (lines.next_back().expect("a line").split(','))
        .map(|number| number.trim().parse().expect("a number"))
        .collect();
    let spin = |axis| {
        let name = format!("spin_{axis}_rad_per_s");
        names.iter().position(|one| *one == name).map_or(0.0, |column| numbers[column])
    };
    Vec3::new(spin("x"), spin("y"), spin("z"))
}

/// Two `grains` (place and radius) and an intruder that comes down at 10 cm from the left, on the
/// first of them or to the floor.
fn model(
    folder: &Path,
    dimension: usize,
    law: &str,
    shape: &str,
    grains: [&str; 2],
    spin: &str,
) -> Loaded {
    let (y, depth) = if dimension == 2 { ("", "") } else { ("0.1,", "depth = \"20 cm\"\n") };
    let columns = if dimension == 2 { "x_m,y_m" } else { "x_m,y_m,z_m" };
    let rows = grains.map(|at| at.replace("{y}", y) + ",0.0005\n").concat();
    fs::write(folder.join("grains.csv"), format!("{columns},radius_m,mass_kg\n{rows}"))
        .expect("a table");
    let text = format!(
        "[run]\nname = \"clump\"\nduration = \"10 ms\"\ntime_step = \"2 us\"\nseed = 1\n\n\
         [medium]\nkind = \"grains\"\ndimension = {dimension}\ngravity = \"9.81 m/s^2\"\n\n\
         [container]\nshape = \"box\"\nwidth = \"20 cm\"\n{depth}sides = \"wall\"\nbottom = \"wall\"\n\n\
         [bed]\nsource = \"csv\"\nfile = \"grains.csv\"\n\n[contact_law]\n{law}\n\
         [intruder]\n{shape}\nmass = \"2 g\"\n\n\
         [impact]\nspeed = \"1 m/s\"\nangle = \"80 deg\"\nx = \"10 cm\"\nattitude = \"20 deg\"\nspin = {spin}\n"
    );
    let source = ModelSource::Text { name: "clump".into(), text, folder: folder.to_owned() };
    Model::load(source, &LoadOptions::default())
        .unwrap_or_else(|error| panic!("{}", error.render(configs::Color::Off)))
}
