//! `plunge export`: what the files hold is what the log says; outside readers open them in `.ci/run`.

use std::fs;
use std::path::Path;

use crate::common::{Call, folder, names, summary};
use crate::log::Log;

const FORMATS: [(&str, &str); 5] = [
    ("csv", "energy_budget.csv"),
    ("parquet", "energy_budget.parquet"),
    ("vtp", "grains.pvd"),
    ("lammps-dump", "grains.dump"),
    ("extxyz", "grains.xyz"),
];

fn export(run: &Path, format: &str) -> Call {
    Call::new(["export", "--json", "--to", format]).arg(run)
}

/// The rows of a table, cell by cell.
fn rows(path: &Path) -> Vec<Vec<String>> {
    let text = fs::read_to_string(path).expect("a table");
    text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

#[test]
fn every_format_is_written_whole_and_twice_with_the_same_bytes() {
    let out = folder();
    Call::run(out.path()).done();
    for (format, file) in FORMATS {
        let found = export(out.path(), format).done().json();
        let listed = found["files"].as_array().expect("files").len();
        let folder = out.path().join(format);
        let first = names(&folder);
        assert_eq!(first.len(), listed, "{format}: nothing but what is listed");
        assert!(first.contains(&file.to_owned()), "{first:?}");
        let message = export(out.path(), format).fails(2);
        assert!(message.contains("--force"), "{message}");
        let other = out.path().join("again");
        export(out.path(), format).arg("--out").arg(&other).arg("--force").done();
        for name in first {
            let [a, b] = [&folder, &other].map(|one| fs::read(one.join(&name)).expect("a file"));
            assert!(a == b, "{format}: {name} differs");
        }
    }
}

#[test]
fn a_table_has_a_row_per_message_and_the_unit_of_every_column() {
    let out = folder();
    Call::run(out.path()).done();
    export(out.path(), "csv").done();
    let folder = out.path().join("csv");
    let tables = [
        "bed_activity.csv",
        "energy_budget.csv",
        "intruder_intruder_estimate.csv",
        "intruder_intruder_load.csv",
        "intruder_intruder_state.csv",
    ];
    assert_eq!(names(&folder), tables);
    let log = Log::read(&out.path().join("run.mcap"));
    let states = rows(&folder.join("intruder_intruder_state.csv"));
    assert_eq!(states.len() - 1, log.count("/intruder/intruder/state"));
    assert_eq!(
        states[0].join(","),
        "step,time_s,depth_m,speed_m_per_s,position_x_m,position_y_m,position_z_m,\
         velocity_x_m_per_s,velocity_y_m_per_s,velocity_z_m_per_s,spin_x_rad_per_s,\
         spin_y_rad_per_s,spin_z_rad_per_s"
    );
    let loads = rows(&folder.join("intruder_intruder_load.csv"));
    assert_eq!(
        loads[0][4..8].join(","),
        "contact_x_N,contact_y_N,contact_z_N,contact_torque_x_N_m"
    );

    // The last row of the ledger is what the summary says of the end, to the last bit.
    let energies = rows(&folder.join("energy_budget.csv"));
    let last = energies.last().expect("rows");
    let value = |name: &str| {
        let column = energies[0].iter().position(|one| one == name).expect("a column");
        last[column].parse::<f64>().expect("a number")
    };
    let energy = &summary(out.path())["energy"];
    let sliding = energy["dissipated_J"]["sliding"].as_f64().expect("an energy");
    assert_eq!(value("dissipated_sliding_J").to_bits(), sliding.to_bits());
    let closure = energy["closure"].as_f64().expect("a closure");
    assert_eq!(value("closure").to_bits(), closure.to_bits());
}

#[test]
fn frames_hold_every_grain_and_the_disc_at_their_time() {
    let out = folder();
    Call::run(out.path()).done();
    let n = summary(out.path())["bed"]["grains"].as_u64().expect("a number") as usize;
    let frames = Log::read(&out.path().join("grains.mcap")).count("/grains");
    export(out.path(), "extxyz").done();
    let text = fs::read_to_string(out.path().join("extxyz/grains.xyz")).expect("a file");
    let lines: Vec<&str> = text.lines().collect();
    let of_frame = n + 3;
    assert_eq!(lines.len(), frames * of_frame);
    assert_eq!(lines[0], (n + 1).to_string());
    // Two hundred frames per second; a frame is at the step nearest to its time.
    assert!(lines[of_frame + 1].contains(" Time=0.005 "), "{}", lines[of_frame + 1]);

    // The disc is the last of every frame, where the table of its states has it.
    export(out.path(), "csv").done();
    let states = rows(&out.path().join("csv/intruder_intruder_state.csv"));
    let at = states.iter().find(|row| row[1] == "0.005").expect("a state every step");
    let disc: Vec<&str> = lines[2 * of_frame - 1].split(' ').collect();
    assert_eq!(disc[..3], [&n.to_string(), "Fe", "1"]);
    // position and velocity; the table's velocity begins at its eighth column
    for (cell, column) in [(3, 4), (5, 6), (7, 7), (9, 9), (10, 3)] {
        let expected: f64 = at[column].parse().expect("a number");
        let found = disc[cell].parse::<f32>().expect("a number");
        assert_eq!(found.to_bits(), (expected as f32).to_bits(), "{cell}");
    }
    let grains = lines[of_frame + 2..2 * of_frame - 1].iter();
    assert!(grains.clone().all(|line| line.split(' ').nth(1) == Some("Si")));
    for line in grains {
        let cells: Vec<f32> = line.split(' ').filter_map(|cell| cell.parse().ok()).collect();
        let [x, y, z, speed] = [6, 7, 8, 9].map(|at| cells[at]);
        // Two roundings of single numbers, and a square root.
        assert!(((x * x + y * y + z * z).sqrt() - speed).abs() <= 4e-7 * speed, "{line}");
    }
    export(out.path(), "vtp").done();
    let files = names(&out.path().join("vtp"));
    assert_eq!(files.len(), 2 * (frames + 1), "grains and bodies of every frame, and two indices");
}

#[test]
fn beads_of_a_body_that_is_not_round_move_as_one() {
    let out = folder();
    let model = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../configs/schema/tests/good/small-chain-2d.toml");
    Call::run_model(&model, out.path()).set(&["run.duration=60 ms"]).done();
    export(out.path(), "lammps-dump").done();
    let text = fs::read_to_string(out.path().join("lammps-dump/grains.dump")).expect("a file");
    let last = text.rsplit("speed force\n").next().expect("a frame");
    let particles: Vec<Vec<f64>> = last
        .lines()
        .map(|line| line.split(' ').map(|cell| cell.parse().expect("a number")).collect())
        .collect();
    for kind in [2.0, 3.0] {
        let beads: Vec<_> =
            particles.iter().filter(|cells| (cells[1] - kind).abs() < 0.5).collect();
        assert_eq!(beads.len(), 1000, "type {kind}");
        let apart = |other: usize, at: usize| -> [f64; 3] {
            std::array::from_fn(|axis| beads[other][at + axis] - beads[0][at + axis])
        };
        for other in 1..beads.len() {
            let (way, motion) = (apart(other, 3), apart(other, 6));
            let along: f64 = way.iter().zip(motion).map(|(x, v)| x * v).sum();
            // A rigid body keeps its distances; single numbers round way (m) and speed (m/s).
            assert!(along.abs() < 1e-8, "{along}");
        }
    }
    assert_eq!(particles.iter().filter(|cells| cells[1] < 1.5).count(), 300);
}

#[test]
fn the_log_of_grains_is_a_table_of_them() {
    let out = folder();
    Call::run(out.path()).done();
    let log = out.path().join("grains.mcap");
    export(&log, "csv").done();
    let (folder, log) = (out.path().join("csv"), Log::read(&log));
    assert_eq!(names(&folder), ["grains.csv", "intruder_intruder_state.csv"]);
    let grains = rows(&folder.join("grains.csv"));
    let n = summary(out.path())["bed"]["grains"].as_u64().expect("a number") as usize;
    assert_eq!(grains.len() - 1, n * log.count("/grains"));
    assert_eq!(
        grains[0].join(","),
        "time_s,x_m,y_m,z_m,radius_m,vx_m_per_s,vy_m_per_s,vz_m_per_s,speed_m_per_s,force_N,id"
    );
    assert_eq!(grains[n + 1][0], "0.005", "the second frame");
    let states = rows(&folder.join("intruder_intruder_state.csv"));
    assert_eq!(states.len() - 1, log.count("/grains"), "a state per frame");
}

#[test]
fn what_a_log_does_not_have_is_told() {
    let out = folder();
    Call::new(["run", "--json", "--out"]).arg(out.path()).arg("two-term-vector").done();
    let message = export(out.path(), "vtp").fails(2);
    assert!(message.contains("grains.mcap"), "{message}");
    let message = export(&out.path().join("run.mcap"), "extxyz").arg("--force").fails(2);
    assert!(message.contains("has no frame of grains"), "{message}");
    let message = export(&out.path().join("none"), "csv").fails(2);
    assert!(message.contains("neither a log nor a folder"), "{message}");
    assert!(export(out.path(), "xls").fails(2).contains("lammps-dump"), "the formats are listed");
}

#[test]
fn completions_and_manual_pages_know_every_command() {
    let script = Call::new(["completions", "bash"]).done().stdout;
    let out = folder();
    Call::new(["man"]).arg(out.path()).done();
    let pages = names(out.path());
    for command in ["run", "sweep", "compare", "diagnose", "export", "report"] {
        assert!(script.contains(command), "{command}");
        assert!(pages.contains(&format!("plunge-{command}.1")), "{pages:?}");
    }
    let page = fs::read_to_string(out.path().join("plunge-export.1")).expect("a page");
    assert!(page.contains("lammps\\-dump") && page.contains("\\-\\-force"), "{page}");
}
