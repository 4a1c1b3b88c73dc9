//! What is stated beside the tables, and tables that are not of one body from first to last, are held against the frames.

use std::fmt::Write as _;

use exchange::tracking::Set;

use crate::layouts::{of_folder, of_text};
use crate::refusals::{has, told};
use crate::world::{Camera, Drop, Noise, drop};

fn one(height: f64, seed: u64) -> Drop {
    drop(height, Camera { seed, ..Camera::USUAL })
}

fn table(one: &Drop, z: impl Fn(usize, f64) -> f64) -> String {
    let mut text = String::from("t (s),z (mm)\n");
    for (at, (t, height)) in one.readings.iter().enumerate() {
        let _ = writeln!(text, "{t:.5},{:.3}", 1e3 * z(at, *height));
    }
    text
}

fn read(text: &str, options: &[(&str, &str)]) -> Set {
    of_text("a.csv", text.as_bytes(), options).unwrap_or_else(|error| panic!("{error}"))
}

fn warns(set: &Set, part: &str) -> bool {
    set.notes.iter().any(|note| note.starts_with("Warning: ") && note.contains(part))
}

#[test]
fn two_bodies_whose_rows_take_turns_are_refused() {
    let [a, b] = [one(0.1, 1), one(0.2, 2)];
    for apart in [0.0, 0.0006] {
        let mut text = String::from("t (s),z (mm)\n");
        for (one, other) in a.readings.iter().zip(&b.readings) {
            let _ = writeln!(text, "{:.4},{:.3}", one.0, 1e3 * one.1);
            let _ = writeln!(text, "{:.4},{:.3}", other.0 + apart, 1e3 * other.1);
        }
        has(
            &told("a.csv", &text, &[]),
            &["a has 2 positions per time", "a column that labels the bodies", "--leave-out \"a\""],
        );
    }
}

#[test]
fn a_path_that_freezes_while_the_body_moves_has_no_final_depth() {
    let drop = one(0.2, 3);
    let contact = (drop.contact * 650.0) as usize;
    let frozen =
        |from: usize| table(&drop, |at, z| if at < from { z } else { drop.readings[from].1 });
    let set = read(&frozen(contact + 14), &[]);
    assert!(warns(&set, "the tracker loses the body of a at"), "{:?}", set.notes);
    has(&told("a.csv", &frozen(contact + 2), &[]), &["never braked", "the tracker loses the body"]);
    assert!(!warns(&read(&table(&drop, |_, z| z), &[]), "the tracker"));
}

#[test]
fn a_height_of_release_that_the_frames_belie_is_told_with_both_speeds() {
    let text = table(&one(0.3, 4), |_, z| z);
    let surface = ("surface", "0 mm");
    let set = read(&text, &[("drop_height", "28cm"), surface]);
    assert!(warns(&set, "m/s by its frames, and from 0.28 m it would at 2.344"), "{:?}", set.notes);
    assert!(!warns(&read(&text, &[("drop_height", "30cm"), surface]), "by its frames"));
}

#[test]
fn tables_of_bodies_as_people_write_them() {
    let text = table(&one(0.1, 5), |_, z| z);
    let by = |bodies: &str| {
        let tables = [
            ("steel_h10_1.csv".to_owned(), text.clone()),
            ("bodies.csv".to_owned(), bodies.to_owned()),
        ];
        of_folder(&tables, &[("bodies", "HERE/bodies.csv")])
    };
    for bodies in [
        "Kugel;Ø (mm);Gewicht (g)\nSteel;25,4;67,0\n",
        "Ball,D_mm,m_g,shape\nSteel,25.4,67,ball\n",
        "Corps;Diamètre (mm);Masse (g)\nSTEEL;25,4;67,0\n",
    ] {
        by(bodies).unwrap_or_else(|error| panic!("{bodies}: {error}"));
    }
    let twice = "body,diameter (mm),mass (g)\nwax,40,67\nSteel,25.4,67\nsteel,30,67\n";
    let error = by(twice).expect_err("two steels");
    has(
        &error,
        &["bodies.csv:4: the body `steel` is listed on line 3 and again, with other values"],
    );
}

#[test]
fn sizes_that_no_body_has_are_told_in_the_words_of_the_command() {
    let text = table(&one(0.1, 6), |_, z| z);
    for (option, wanted) in [
        (("diameter", "25.4cm"), "a sphere of 25.4cm and 67 g has a density of 7.809e0 kg/m^3"),
        (("diameter", "25.4cm"), "looks like cm for mm: 25.40 mm and"),
        (("diameter", "12.7mm"), "the diameter looks like a radius"),
        (("mass", "67kg"), "the mass looks like kg for g"),
    ] {
        has(&told("a.csv", &text, &[option]), &["--diameter: a sphere of", wanted]);
    }
}

#[test]
fn axes_and_units_that_the_fall_contradicts() {
    let drop = one(0.2, 7);
    let along_x = |head: &str| {
        let mut text = format!("{head}\n");
        for (at, (t, z)) in drop.readings.iter().enumerate() {
            let _ = writeln!(text, "{t:.5},{:.3},{:.3}", 1e3 * z, 80.0 + 0.1 * (at % 5) as f64);
        }
        text
    };
    let sideways = along_x("t (s),x (mm),y (mm)");
    has(
        &told("a.csv", &sideways, &[]),
        &["the body falls along `x (mm)`, and not along `y (mm)`", "--column z=\"x (mm)\""],
    );
    read(&sideways, &[("column_z", "x")]);
    let set = read(&along_x("t (s),z (mm),y (mm)"), &[]);
    let note = "`y (mm)` does not move, `z (mm)` is taken for the vertical position";
    assert!(set.notes.iter().any(|one| one.contains(note)), "{:?}", set.notes);
    let upward = table(&drop, |_, z| z);
    has(
        &told("a.csv", &upward, &[("counts", "down")]),
        &["--down is stated, and the fall says that `z (mm)` counts up", "write --up"],
    );
    let seconds = upward.replace("t (s)", "t (ms)");
    has(&told("a.csv", &seconds, &[]), &["right with times in s: --time-unit s says so"]);
    let mut results = String::from(" \tX\tY\tSlice\n");
    for (at, (_, z)) in drop.readings.iter().enumerate() {
        let _ = writeln!(results, "{}\t5.1\t{:.3}\t{}", at + 1, 400.0 - 1e3 * z, at + 1);
    }
    let rate = ("rate", "650Hz");
    has(&told("a.txt", &results, &[rate]), &["that of mm", "write --length-unit mm"]);
    read(&results, &[rate, ("length_unit", "mm")]);
}

#[test]
fn times_that_are_numbers_of_frames_are_called_so() {
    let head =
        "LABEL,ID,TRACK_ID,POSITION_X,POSITION_Y,POSITION_T,FRAME\n,,,(pixel),(pixel),(sec),\n";
    let mut text = head.to_owned();
    for (at, (_, z)) in one(0.2, 8).readings.iter().enumerate() {
        let _ = writeln!(text, "s{at},{at},0,5.1,{:.2},{at},{at}", 2000.0 - 5e3 * z);
    }
    has(&told("a.csv", &text, &[]), &["`POSITION_T` counts frames", "write --rate"]);
    read(&text, &[("rate", "650Hz"), ("scale", "0.2mm/px")]);
}

#[test]
fn stamps_that_scatter_around_even_rows_become_even() {
    let drop = drop(0.3, Camera { rate: 240.0, seed: 9, ..Camera::USUAL });
    let mut noise = Noise(4);
    let mut text = String::from("t (s),z (mm)\n");
    for (t, z) in &drop.readings {
        let _ = writeln!(text, "{:.4},{:.3}", t + 4e-4 * noise.normal(), 1e3 * z);
    }
    let set = read(&text, &[]);
    let speed = set.understood[0].speed;
    assert!((speed.value - drop.speed).abs() < 3.0 * speed.se && speed.se < 0.02 * drop.speed);
    assert!(set.notes.iter().any(|note| note.contains("its rows are evenly spaced")));
    assert!(!warns(&set, "before contact the bodies fall at"), "{:?}", set.notes);
}
