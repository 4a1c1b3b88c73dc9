//! Tables and options that are wrong get a message with file, line, what is wrong, and what would be right.

use crate::formats;
use crate::layouts::of_text;

/// What is said of a table.
pub(crate) fn told(name: &str, text: &str, options: &[(&str, &str)]) -> String {
    match of_text(name, text.as_bytes(), options) {
        Ok(set) => panic!("{name} was read: {:?}", set.understood),
        Err(message) => message,
    }
}

/// Holds a message against its parts.
pub(crate) fn has(message: &str, parts: &[&str]) {
    for part in parts {
        assert!(message.contains(part), "{part:?} is not in\n{message}");
    }
}

const SCALE: (&str, &str) = ("scale", "0.2mm/px");
const RATE: (&str, &str) = ("rate", "650Hz");

#[test]
fn programs() {
    let drops = formats::two();
    let text = formats::tracker(&drops[0]).replace("t\tx\ty\n", "");
    has(&told("a.txt", &text, &[]), &["a.txt:2: the line of names `t x y` is missing", "t, x, y"]);
    let text = formats::tracker(&drops[0]).replace("t\tx\ty\n", "t\tx\tv\n");
    has(&told("a.txt", &text, &[]), &["the table has no column y", "found: t, x, v"]);
    let text = formats::trackmate(&drops).replace(",0,3.1,", ",,3.1,").replace(",1,3.1,", ",,3.1,");
    has(
        &told("a.csv", &text, &[SCALE]),
        &["a.csv: no spot belongs to a track", "export all spots"],
    );
    let text = formats::manual_tracking(&drops).replace("\tY\t", "\tYY\t");
    has(&told("a.txt", &text, &[SCALE, RATE]), &["a.txt:1: the table has no column Y", "centroid"]);
    let text = formats::mtrackj(&drops).replace("y [mm]", "y [furlong]");
    has(
        &told("a.txt", &text, &[]),
        &["`furlong` is not the unit of a length (column `y [furlong]`)", "--length-unit"],
    );
    let text = formats::dltdv(&drops).replace("pt2_cam1_Y", "pt2_cam1_Q");
    has(&told("a.csv", &text, &[SCALE, RATE]), &["a.csv:1: the column `pt2_cam1_Y` is missing"]);
    let text = formats::kinovea(&drops).replacen("3,200 ", "3,2x0 ", 1);
    has(
        &told("a.txt", &text, &[]),
        &["a.txt:5: \"3,2x0\" is not a number", "a row is a time, x and y"],
    );
    let text = formats::loggerpro(&drops[0]).replace("Position", "Potential");
    has(
        &told("a.txt", &text, &[]),
        &["a.txt:4: no column of positions is found", "--column z=NAME"],
    );
    let text = formats::loggerpro_table(&drops).replace("Run 2: Position (m)", "Run 2: Force (N)");
    has(&told("a.csv", &text, &[]), &["a.csv:1: the run `Run 2` has no column of positions"]);
    let text = formats::labview(&drops[0]).replace("***End_of_Header***", "***End***");
    has(&told("a.lvm", &text, &[]), &["a.lvm:1: its header does not end", "***End_of_Header***"]);
    let text = formats::deeplabcut(&drops[0]).replace("bodyparts,", "parts,");
    has(
        &told("a.csv", &text, &[SCALE, RATE]),
        &["a.csv:1: the rows `bodyparts` and `coords` are missing"],
    );
}

#[test]
fn plain_tables() {
    let drops = formats::two();
    let pushed = "Time (s),Displacement (mm),Load (N)\n0,0,1\n1,2,3\n2,4,6\n";
    has(
        &told("a.csv", pushed, &[]),
        &["a.csv: `Load (N)` is a force or a pressure", "plunge new real-plates-simulant"],
    );
    has(&told("a.trk", "<object>\n", &[]), &["it is a file of Tracker, and no table", "export"]);
    let text = formats::long(&drops).replace("a1,10cm,50", "a1,10cm,x50");
    has(&told("a.csv", &text, &[]), &["a.csv:", "in the column `time [ms]` is not a number"]);
    let text = formats::wide(&drops).replace(';', ",");
    has(&told("a.csv", &text, &[]), &["cells stand below 3 names", "semicolons or tabs"]);
    let of_three = |line: &str| format!("1 {line}\n");
    let text: String = formats::bare(&drops[0]).lines().skip(1).map(of_three).collect();
    has(&told("a.dat", &text, &[]), &["no column of times", "--column t=NAME; found: 1, 2, 3"]);
    let text = formats::bare(&drops[0]).replace("t y\n", "t (s) az (m/s²)\n");
    has(&told("a.dat", &text, &[]), &["`az (m/s²)` is an acceleration", "plunge new"]);
    let text = text.replace("az (m/s²)", "velocity (m/s)");
    for asked in [&[][..], &[("length_unit", "m")]] {
        has(
            &told("a.dat", &text, asked),
            &["`velocity (m/s)` is a velocity", "kind = \"velocity\""],
        );
    }
    has(&told("a.dat", "t,y,u\n0,,1\n1,,2\n", &[]), &["no row has a time and a position"]);
    let text = formats::bare(&drops[0]).replace("t y\n", "t q\n");
    let message = told("a.dat", &text, &[("column_z", "p")]);
    has(&message, &["no column is called `p`", "found: t, q"]);
    let twice =
        format!("{}{}", formats::bare(&drops[0]), formats::bare(&drops[1]).replace("t y\n", ""));
    has(&told("a.dat", &twice, &[]), &["a.dat:587: the time runs back", "need a column `run`"]);
    has(&told("a.csv", "t,y\n0,1\n1,2\n", &[]), &["2 readings are too few"]);
    has(&told("a.csv", "\n\n", &[]), &["a.csv: it is empty"]);
    has(&told("a.xlsx", "t,y\n0,1\n1,2\n", &[]), &["a.xlsx: this cannot be read as a spreadsheet"]);
    let message = told("a.csv", "one\ntwo\nthree\n", &[]);
    has(&message, &["a.csv: no row of numbers is found"]);
}

#[test]
fn units_and_scales() {
    let drops = formats::two();
    let pixels = formats::points(&drops);
    has(
        &told("a.csv", &pixels, &[SCALE]),
        &["`frame` counts frames", "write --rate", "the fall before contact is that of 6"],
    );
    has(
        &told("a.csv", &pixels, &[RATE]),
        &["`y1 (px)` is in pixels", "write --scale 0.2", "mm/px"],
    );
    has(
        &told("a.csv", &pixels, &[RATE, ("scale", "0.02mm/px")]),
        &["accelerates at 0.9", "not at 9.81"],
    );
    let wrong = formats::wide(&drops).replace("ms;cm;cm", "ms;m;m");
    has(
        &told("a.csv", &wrong, &[]),
        &["by its units the fall before contact accelerates at 9", "--length-unit"],
    );
    let slow = formats::wide(&drops).replace("ms;cm;cm", "ms;mm;mm");
    has(&told("a.csv", &slow, &[]), &["accelerates at 0.9"]);
    has(
        &told("a.csv", &pixels, &[("scale", "0.2")]),
        &["--scale: \"0.2\" is not a length per pixel", "0.21mm/px"],
    );
    has(
        &told("a.csv", &pixels, &[("rate", "650")]),
        &["--rate: \"650\" is not a frame rate", "650Hz"],
    );
    has(
        &told("a.csv", &pixels, &[("diameter", "25,4 mm")]),
        &["--diameter: \"25,4 mm\" has a decimal comma", "25.4 mm"],
    );
    has(&told("a.csv", &pixels, &[("mass", "3 mm")]), &["--mass: \"3 mm\" is a length"]);
    has(
        &told("a.csv", &pixels, &[("shape", "cube")]),
        &["--shape: \"cube\" is not known", "sphere"],
    );
}

#[test]
fn surfaces_names_and_paths() {
    let drops = formats::two();
    let wide = formats::wide(&drops);
    let message = told("a.csv", &wide, &[("surface", "17.13 cm")]);
    has(
        &message,
        &["--surface: the runs are braked 12.", "mm above the stated surface", "--tracked centre"],
    );
    let message = told("a.csv", &wide, &[("condition", "{body}_{repeat}")]);
    has(&message, &["the name `drop 1` does not fit {body}_{repeat}"]);
    let message = told("a.csv", &wide, &[("condition", "{a}{b}")]);
    has(&message, &["--condition: \"{a}{b}\": nothing stands before {b}"]);
    let message = told("a.csv", &wide, &[("drop_height", "{height} cm")]);
    has(&message, &["--drop-height: {height} has no value"]);
    let message = told("a.csv", &wide, &[("drop_height", "90 cm")]);
    has(&message, &["meets the bed at 1.", "at 4.202"]);
    // Only what comes behind contact, and only what comes before it.
    let (t, late): (f64, String) = (drops[0].contact, formats::bare(&drops[0]));
    let rows = |keep: &dyn Fn(f64) -> bool| -> String {
        let is_kept = |line: &&str| {
            line.split(' ').next().and_then(|t| t.parse().ok()).is_none_or(|t: f64| keep(t))
        };
        late.lines().filter(is_kept).map(|line| format!("{line}\n")).collect()
    };
    let units = [("length_unit", "mm"), ("time_unit", "s")];
    let message = told("a.dat", &rows(&|now| now > t + 0.004), &units);
    has(&message, &["a.dat: the run a: no free fall is seen", "--leave-out a"]);
    let message = told("a.dat", &rows(&|now| now < t - 0.004), &units);
    has(&message, &["a.dat: the run a: the body is never braked"]);
}

#[test]
fn a_column_of_runs_that_is_not_there_is_told() {
    let drops = formats::two();
    let asked = [("column_run", "NAME")];
    for text in [formats::wide(&drops), formats::bare(&drops[0])] {
        has(&told("a.csv", &text, &asked), &["no column is called `NAME`"]);
    }
}

#[test]
fn what_no_table_holds_is_asked_for() {
    let here = tempfile::tempdir().expect("a folder");
    let path = here.path().join("a.csv");
    std::fs::write(&path, formats::wide(&formats::two())).expect("a table");
    let options = exchange::tracking::Options::default();
    let error = exchange::tracking::import(&[path], &options, here.path()).expect_err("no body");
    has(
        &error.to_string(),
        &["no table says the diameter of the body", "write --diameter 25.4mm", "--bodies"],
    );
    let text = formats::wide(&formats::two());
    has(
        &told("a.csv", &text, &[("shape", "cone")]),
        &["no table says the apex of the body", "write --apex 60deg"],
    );
}

#[test]
fn whatever_stands_in_a_table_the_answer_is_a_set_or_a_message() {
    let drops = formats::two();
    let texts = [
        ("a.txt", formats::tracker(&drops[0])),
        ("a.txt", formats::tracker_multi(&drops)),
        ("a.csv", formats::trackmate(&drops)),
        ("a.txt", formats::manual_tracking(&drops)),
        ("a.csv", formats::dltdv(&drops)),
        ("a.txt", formats::kinovea(&drops)),
        ("a.txt", formats::loggerpro(&drops[0])),
        ("a.csv", formats::loggerpro_table(&drops)),
        ("a.lvm", formats::labview(&drops[0])),
        ("a.csv", formats::deeplabcut(&drops[0])),
        ("a.csv", formats::long(&drops)),
        ("a.csv", formats::wide(&drops)),
    ];
    let here = tempfile::tempdir().expect("a folder");
    let mut options = crate::contact::ball();
    [SCALE, RATE].into_iter().for_each(|(key, value)| options.set(key, value));
    let mut noise = crate::world::Noise(5);
    for (name, text) in &texts {
        let bytes = text.as_bytes();
        let at =
            |noise: &mut crate::world::Noise, most: usize| (noise.uniform() * most as f64) as usize;
        for round in 0..12 {
            let mut changed = bytes.to_vec();
            match round % 4 {
                // The head alone, a hole, a few other bytes, lines in another order.
                0 => changed.truncate(at(&mut noise, 700)),
                1 => {
                    let from = at(&mut noise, 400);
                    changed.drain(from..from + at(&mut noise, 200));
                }
                2 => {
                    for _ in 0..6 {
                        let (place, byte) = (at(&mut noise, 500), at(&mut noise, 256));
                        changed[place] = byte as u8;
                    }
                }
                _ => {
                    let mut lines: Vec<&[u8]> = bytes.split(|byte| *byte == b'\n').collect();
                    let (a, b) = (at(&mut noise, 6), at(&mut noise, lines.len()));
                    lines.swap(a, b);
                    changed = lines.join(&b'\n');
                }
            }
            // A set or a message: nothing ends the program.
            let path = here.path().join(name);
            std::fs::write(&path, &changed).expect("a table");
            let _ = exchange::tracking::import(&[path], &options, here.path());
        }
    }
}
