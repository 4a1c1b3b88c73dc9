//! What is stated beside the tables, and tables that are not of one body from first to last, are held against the frames.

use std::fmt::Write as _;

use exchange::tracking::Set;

use crate::layouts::{of_folder, of_text};
use crate::refusals::{has, told};
use crate::world::{Camera, Drop, drop};

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
