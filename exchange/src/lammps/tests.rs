use std::fs;

use configs::{LoadOptions, Loaded, Model, ModelSource};
use tempfile::TempDir;

use super::{
    BODY, DATA, DUMP, Deck, FACTS, INPUT, INTRUDER_TABLE, ImportError, LammpsError, import,
};

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

/// A model of three discs, or spheres, on the floor, and its folder.
fn model(dimension: usize, law: &str, sets: &[&str]) -> (TempDir, Loaded) {
    let folder = tempfile::tempdir().expect("a folder");
    let (table, depth, shape) = match dimension {
        2 => ("x_m,y_m,radius_m,mass_kg\n", "", "disc"),
        _ => ("x_m,y_m,z_m,radius_m,mass_kg\n", "depth = \"20 mm\"\n", "sphere"),
    };
    let mut table = table.to_owned();
    for x in ["0.01", "0.02", "0.03"] {
        let y = if dimension == 2 { "" } else { "0.01," };
        table.push_str(&format!("{x},{y}0.005,0.005,0.001\n"));
    }
    fs::write(folder.path().join("grains.csv"), table).expect("a table");
    let text = format!(
        "[run]\nname = \"three\"\nduration = \"10 ms\"\ntime_step = \"10 us\"\nseed = 1\n\n\
         [medium]\nkind = \"grains\"\ndimension = {dimension}\ngravity = \"9.81 m/s^2\"\n\n\
         [container]\nshape = \"box\"\nwidth = \"40 mm\"\n{depth}sides = \"wall\"\nbottom = \"wall\"\n\n\
         [bed]\nsource = \"csv\"\nfile = \"grains.csv\"\n\n[contact_law]\n{law}\n\
         [intruder]\nshape = \"{shape}\"\ndiameter = \"1 cm\"\nmass = \"10 g\"\n\n\
         [impact]\nspeed = \"2 m/s\"\nangle = \"90 deg\"\n"
    );
    let source = ModelSource::Text { name: "three".into(), text, folder: folder.path().to_owned() };
    let sets = sets.iter().map(|&set| set.to_owned()).collect();
    let options = LoadOptions { sets, ..LoadOptions::default() };
    let loaded = Model::load(source, &options).unwrap_or_else(|error| {
        panic!("{}", error.render(configs::Color::Off));
    });
    (folder, loaded)
}

fn deck(dimension: usize, law: &str, sets: &[&str]) -> Result<Deck, LammpsError> {
    let (_folder, loaded) = model(dimension, law, sets);
    let grains = loaded.model.grains().expect("a bed");
    Deck::of(grains, &grains.read_bed().expect("a table"))
}

fn written(dimension: usize, law: &str, sets: &[&str]) -> Deck {
    deck(dimension, law, sets).expect("a model that LAMMPS can express")
}

/// The lines of `text` after `header`, up to the next empty one.
fn section(text: &str, header: &str) -> Vec<String> {
    let lines = text.lines().skip_while(|line| *line != header).skip(2);
    lines.take_while(|line| !line.is_empty()).map(str::to_owned).collect()
}

/// The numbers of the first line of `text` with `start`.
fn numbers(text: &str, start: &str) -> Vec<f64> {
    let line = text.lines().find(|line| line.contains(start)).expect("a line");
    line.split_whitespace().filter_map(|word| word.parse().ok()).collect()
}

#[test]
fn a_planar_bed_stands_in_the_plane_of_lammps_with_its_masses_and_its_turns() {
    let Deck { data, input, .. } = written(2, LINEAR, &["impact.spin = \"3 rad/s\""]);
    assert!(data.contains("\n4 atoms\n2 atom types\n\n0.0 0.04 xlo xhi\n-0.01 "), "{data}");
    let atoms = section(&data, "Atoms # sphere");
    assert_eq!(atoms.len(), 4);
    let first = numbers(&data, "1 1 0.01 ");
    // Mass over the volume of a sphere, which LAMMPS multiplies with again.
    let density = 0.001 / (4.0 / 3.0 * std::f64::consts::PI * 1.25e-7);
    assert!((first[3] / density - 1.0).abs() < 1e-14, "{first:?}");
    assert_eq!(atoms[0].split(' ').skip(4).collect::<Vec<_>>(), ["0.01", "0.005", "0.0"]);
    // The intruder stands on the middle grain and comes straight down; what turns from x to z (up) turns
    // from x to y.
    let start = numbers(&data, "4 2 0.01 ");
    assert!((start[5] - 0.015).abs() < 1e-9, "{start:?}");
    assert_eq!(section(&data, "Velocities")[3], "4 0.0 -2.0 0.0 0.0 0.0 3.0");
    for line in [
        "boundary m fm p",
        "pair_style gran/hooke/history 3200.0 3200.0 10000.0 8000.0 0.28 1",
        "fix gravity all gravity 9.81 vector 0 -1 0",
        "fix sides grains wall/gran hooke/history 3200.0 3200.0 10000.0 8000.0 0.28 1 xplane 0 0.04",
        "fix motion_of_intruder intruder nve/sphere disc",
        "fix plane all enforce2d",
        "timestep 1e-5",
        "variable steps index 1000",
        "variable every index 10",
        "variable frame index 500",
        "variable wy equal -c_turn[3]",
    ] {
        assert!(input.lines().any(|found| found == line), "no line `{line}` in\n{input}");
    }
}

#[test]
fn an_intruder_with_a_friction_of_its_own_has_a_pair_of_its_own() {
    let Deck { input, .. } = written(2, LINEAR, &["contact_law.intruder_friction = 0.1"]);
    for line in [
        "pair_style granular",
        "pair_coeff 1 1 hooke 3200.0 10000.0 tangential linear_history 3200.0 0.8 0.28 \
         damping mass_velocity",
        "pair_coeff 1 2 hooke 3200.0 10000.0 tangential linear_history 3200.0 0.8 0.1 \
         damping mass_velocity",
    ] {
        assert!(input.lines().any(|found| found == line), "no line `{line}` in\n{input}");
    }
}

#[test]
fn a_bed_in_space_has_the_stiffness_and_damping_of_hertz_and_mindlin() {
    let periodic = [
        "container.sides = \"periodic\"",
        "container.width = \"60 mm\"",
        "container.depth = \"60 mm\"",
    ];
    let Deck { input, .. } = written(3, HERTZ, &periodic);
    assert!(input.contains("boundary p p fm\n") && !input.contains("fix sides"), "{input}");
    let found = numbers(&input, "pair_coeff 1 1 ");
    let [_, _, k_n, told, k_t, shear, friction] = found[..] else { panic!("{found:?}") };
    // Equal bodies: E* = E/(2 (1 − ν²)), G* = G/(2 (2 − ν)); β = 0.25526 for e = 1/2, within 2e-5.
    let modulus = 50e6 / (2.0 * (1.0 - 0.0625));
    let shear_modulus = 50e6 / 2.5 / (2.0 * 1.75);
    let close = |value: f64, expected: f64, by: f64| (value / expected - 1.0).abs() < by;
    assert!(close(k_n, 4.0 / 3.0 * modulus, 1e-14) && close(k_t, 8.0 * shear_modulus, 1e-14));
    assert!(close(shear, (8.0 * shear_modulus / (2.0 * modulus)).sqrt(), 1e-14));
    let log = libm::log(told);
    let ratio = -log / (std::f64::consts::PI.powi(2) + log * log).sqrt();
    assert!(close(ratio, 0.25526, 8e-5), "{ratio}");
    assert_eq!(friction.to_bits(), 0.3_f64.to_bits());
}

#[test]
fn an_intruder_of_another_material_has_its_modulus_its_restitution_and_its_friction() {
    let steel = [
        "contact_law.intruder_young_modulus = \"210 GPa\"",
        "contact_law.intruder_poisson_ratio = 0.2",
        "contact_law.intruder_restitution = 0.4",
        "contact_law.intruder_friction = 0.2",
    ];
    let Deck { input, .. } = written(3, HERTZ, &steel);
    let grains = numbers(&input, "pair_coeff 1 1 ");
    let pair = numbers(&input, "pair_coeff 1 2 ");
    let [_, _, k_n, told, k_t, _, friction] = pair[..] else { panic!("{pair:?}") };
    let modulus = 1.0 / (0.9375 / 50e6 + 0.96 / 210e9);
    let shear_modulus = 1.0 / (2.0 * 1.75 * 1.25 / 50e6 + 2.0 * 1.8 * 1.2 / 210e9);
    assert!((k_n / (4.0 / 3.0 * modulus) - 1.0).abs() < 1e-14);
    assert!((k_t / (8.0 * shear_modulus) - 1.0).abs() < 1e-14);
    assert_eq!(friction.to_bits(), 0.2_f64.to_bits());
    // A stronger damping: LAMMPS is told less.
    assert!(told < grains[3] - 0.1, "{told} {}", grains[3]);
    let message = deck(3, HERTZ, &["contact_law.intruder_restitution = 0.1"]);
    let message = message.expect_err("beyond critical").to_string();
    assert!(message.contains("contact_law.intruder_restitution = 0.1"), "{message}");
}

#[test]
fn what_lammps_cannot_express_is_refused_by_name_and_all_at_once() {
    let rolling =
        format!("{LINEAR}\n[[effect]]\nname = \"rolling-resistance\"\nrolling_friction = 0.05\n");
    let sets = ["container.sides = \"absorbing\"", "conditions.speed = [\"1 m/s\", \"2 m/s\"]"];
    let message = deck(2, &rolling, &sets).expect_err("much to refuse").to_string();
    for what in ["rolling-resistance", "absorbing sides", "a list of 2 impacts"] {
        assert!(message.contains(what), "`{what}` is not in: {message}");
    }
    let viscous = HERTZ.replace("hertz-mindlin", "hertz-mindlin-viscous");
    let viscous = viscous.replace("restitution = 0.5", "viscous_time = \"1 us\"");
    for (law, sets, what) in [
        (viscous.as_str(), &[][..], "hertz-mindlin-viscous"),
        (HERTZ, &["contact_law.restitution = 0.1"], "beyond critical"),
        (HERTZ, &["container.bottom = \"absorbing\""], "absorbing bottom"),
        (HERTZ, &["medium.grain_inertia = 0.5"], "a moment of inertia of 0.5 m r²"),
        (
            HERTZ,
            &[
                "intruder={ shape = \"two-link-chain\", length = \"2 cm\", diameter = \"5 mm\", mass = \"9 g\", \
               link_angle_1 = \"10 deg\", link_angle_2 = \"10 deg\" }",
            ],
            "bodies on a joint: an intruder that is a two-link-chain",
        ),
    ] {
        let message = deck(3, law, sets).expect_err(what).to_string();
        assert!(message.contains(what), "`{what}` is not in: {message}");
    }
}

#[test]
fn a_clump_has_the_mass_and_the_inertia_of_its_body_and_its_balls_do_not_meet() {
    let sets = [
        "intruder={ shape = \"cylinder\", diameter = \"1 cm\", height = \"6 mm\", mass = \"10 g\" }",
        "impact.attitude = \"90 deg\"",
        "impact.spin = \"3 rad/s\"",
    ];
    let Deck { input, data, body, .. } = written(3, HERTZ, &sets);
    for line in [
        "neigh_modify exclude group intruder intruder",
        "fix weight intruder gravity 9.81 vector 0 0 -1 disable",
        "fix motion_of_intruder intruder rigid single infile body.data gravity weight",
        "variable z equal f_motion_of_intruder[1][3]",
    ] {
        assert!(input.lines().any(|found| found.starts_with(line)), "no line `{line}` in\n{input}");
    }
    let body = body.expect("a body");
    let of_body = numbers(&body, "1 0.01 ");
    // On its side, so that its axis is that of x: m r²/2 about it, m (r²/4 + h²/12) about the
    // others.
    let (about, across) = (1e-2 * 1.25e-5, 1e-2 * (6.25e-6 + 3e-6));
    for (found, wanted) in of_body[5..11].iter().zip([about, across, across, 0.0, 0.0, 0.0]) {
        assert!((found - wanted).abs() < 1e-12 * across, "{body}");
    }
    // Velocity and angular momentum: what turns from x to z turns about minus y.
    assert!(
        (of_body[13] + 2.0).abs() < 1e-12 && (of_body[15] / across + 3.0).abs() < 1e-12,
        "{body}"
    );
    // Every ball has its share of the mass, whatever it is good for.
    let balls = section(&data, "Atoms # sphere").into_iter().skip(3);
    let masses = balls.map(|line| {
        let of_ball: Vec<f64> = line.split(' ').filter_map(|word| word.parse().ok()).collect();
        of_ball[3] * std::f64::consts::PI / 6.0 * of_ball[2] * of_ball[2] * of_ball[2]
    });
    assert!((masses.sum::<f64>() / 1e-2 - 1.0).abs() < 1e-12);
}

#[test]
fn springs_of_a_ball_on_a_flat_face_are_those_of_the_face() {
    let cylinder = "intruder={ shape = \"cylinder\", diameter = \"2 cm\", height = \"2 cm\", mass = \"10 g\" }";
    let sets = [cylinder, "container.width = \"60 mm\"", "container.depth = \"60 mm\""];
    let Deck { input, data, .. } = written(3, HERTZ, &sets);
    // The ball in the middle of the lower face: as large as a halving of four grains allows.
    let balls = section(&data, "Atoms # sphere");
    let lowest: Vec<f64> = balls[3].split(' ').filter_map(|word| word.parse().ok()).collect();
    let radius = 0.5 * lowest[2];
    let stiffness = numbers(&input, &format!("pair_coeff 1 {} ", lowest[1]))[2];
    let between_grains = numbers(&input, "pair_coeff 1 1 ")[2];
    // √R* of a grain of 5 mm on a plane over that on the ball; factors are powers of 1.05.
    let factor = ((1.0 / 0.005 + 1.0 / radius) * 0.005).sqrt();
    assert!((stiffness / between_grains / factor - 1.0).abs() < 0.025, "{factor}");
}

#[test]
fn all_files_are_written_into_a_new_folder() {
    let folder = tempfile::tempdir().expect("a folder");
    let into = folder.path().join("deep/er");
    let deck = written(2, LINEAR, &[]);
    deck.write(&into).expect("it can be written");
    let read = |name: &str| fs::read_to_string(into.join(name)).expect("a file");
    assert_eq!((read(INPUT), read(DATA), read(FACTS)), (deck.input, deck.data, deck.facts));
    assert!(deck.body.is_none() && !into.join(BODY).exists(), "a disc is no clump");
}

#[test]
fn a_stopped_import_leaves_no_log_and_the_same_call_makes_it() {
    const TABLE: &str = "step,time_s,x_m,z_m,vx_m_per_s,vz_m_per_s,fx_N,fz_N,\
        spin_y_rad_per_s,torque_y_N_m,kinetic_grains_translation_J,kinetic_grains_rotation_J,\
        potential_grains_J\n";
    let folder = tempfile::tempdir().expect("a folder");
    written(2, LINEAR, &[]).write(folder.path()).expect("it can be written");
    let row = |n: u32| format!("{n},{n}e-5,0.02,0.015,0,-2,0,-0.0981,0,0,0,0,1e-4\n");
    let table: String = (0..10).map(row).collect();
    fs::write(folder.path().join(INTRUDER_TABLE), format!("{TABLE}{table}")).expect("a table");
    fs::write(folder.path().join(DUMP), "").expect("a dump");
    let before = fs::read_dir(folder.path()).expect("the folder").count();
    let log = folder.path().join("run.mcap");
    let asked = std::cell::Cell::new(0);
    let stop = || {
        asked.set(asked.get() + 1);
        asked.get() > 3
    };
    let stopped = import(folder.path(), &log, &stop);
    assert!(matches!(stopped, Err(ImportError::Stopped)), "{stopped:?}");
    assert_eq!(fs::read_dir(folder.path()).expect("the folder").count(), before);
    let imported = import(folder.path(), &log, &|| false).expect("a run");
    assert_eq!((imported.samples, log.is_file()), (10, true));
}
