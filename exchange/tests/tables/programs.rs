//! Headers, titles and comments that programs and people write around the readings of drops.

use std::fmt::Write as _;

use crate::formats;
use crate::layouts::{check, of_text};
use crate::refusals::{has, told};
use crate::world::Drop;

/// Rows of times (s) and heights (mm) with `between` them.
fn rows(one: &Drop, between: &str) -> String {
    let row = |(t, z): &(f64, f64)| format!("{t:.5}{between}{:.3}\n", 1e3 * z);
    one.readings.iter().map(row).collect()
}

#[test]
fn drops_below_each_other_with_titles_of_two_lines() {
    let drops = formats::two();
    for (titles, between, wanted) in [
        (["Drop 1,\nh (cm),5", "Drop 2,\nh (cm),10"], ",", ["Drop 1 h5cm", "Drop 2 h10cm"]),
        (["Drop 1\nh = 5 cm", "Drop 2\nh = 10 cm"], ";", ["Drop 1 h = 5 cm", "Drop 2 h = 10 cm"]),
        (["Drop 1", "Drop 2"], "\t", ["Drop 1", "Drop 2"]),
    ] {
        let mut text = String::new();
        for (one, title) in drops.iter().zip(titles) {
            let _ = write!(text, "{title}\nt (s){between}z (mm)\n{}\n", rows(one, between));
        }
        let set = check("a.csv", &text, &[], &drops, "stacked");
        let runs: Vec<&str> = set.understood.iter().map(|one| one.run.as_str()).collect();
        assert_eq!(runs, wanted);
    }
}

#[test]
fn a_comment_and_the_names_again_amid_the_readings() {
    let drops = formats::two();
    let mut lines = rows(&drops[0], ",").lines().map(str::to_owned).collect::<Vec<_>>();
    lines.insert(120, "# paused".to_owned());
    lines.insert(60, "t (s),z (mm)".to_owned());
    let text = format!("# camera: a\nt (s),z (mm)\n{}\n", lines.join("\n"));
    let set = check("a.csv", &text, &[], &drops[..1], "stacked");
    assert_eq!((set.understood[0].run.as_str(), set.understood[0].rows[0]), ("a", lines.len() - 2));
}

#[test]
fn takes_of_optitrack_and_waves_of_igor() {
    let drops = formats::two();
    let mut take = String::from(
        "Format Version,1.23,Take Name,drop,Length Units,Millimeters\n\n,,Marker,Marker,Marker\n,,ball,ball,ball\n\
         ,,\"1\",\"1\",\"1\"\n,,Position,Position,Position\nFrame,Time (Seconds),X,Y,Z\n",
    );
    for (at, (t, z)) in drops[0].readings.iter().enumerate() {
        let _ = writeln!(take, "{at},{t:.6},5.07,{:.4},299.97", 1e3 * z);
    }
    check("a.csv", &take, &[], &drops[..1], "OptiTrack");
    let mut waves = String::from("IGOR\r");
    for one in &drops {
        let _ = write!(waves, "WAVES/D time_s, z_mm\rBEGIN\r");
        one.readings.iter().for_each(|(t, z)| {
            let _ = write!(waves, "\t{t:.5}\t{:.4}\r", 1e3 * z);
        });
        waves.push_str("END\r");
    }
    check("a.itx", &waves, &[], &drops, "Igor");
}

#[test]
fn a_column_of_forces_beside_a_fall_is_no_push() {
    let drops = formats::two();
    let mut text = String::from("Displacement (mm),Load (N),Time (sec)\n(mm),(N),(sec)\n");
    for (t, z) in &drops[0].readings {
        let _ = writeln!(text, "{:.3},0.01,{t:.5}", -1e3 * z);
    }
    check("a.csv", &text, &[], &drops[..1], "one drop");
    let mut pushed = String::from("Displacement (mm),Load (N),Time (sec)\n");
    (0..200).for_each(|k| {
        let _ = writeln!(
            pushed,
            "{:.2},{:.2},{:.2}",
            0.1 * f64::from(k),
            0.3 * f64::from(k),
            0.05 * f64::from(k)
        );
    });
    has(&told("a.csv", &pushed, &[]), &["the body is pushed, not dropped"]);
}

#[test]
fn data_from_contact_on_are_sent_to_a_set_by_hand() {
    let drop = &formats::two()[0];
    let late = |line: &&str| {
        line.split(',').next().and_then(|t| t.parse().ok()).is_none_or(|t: f64| t > drop.contact)
    };
    let text = rows(drop, ",");
    let text: String = text.lines().filter(late).map(|line| format!("{line}\n")).collect();
    let message = told("a.csv", &format!("t (s),z (mm)\n{text}"), &[]);
    has(&message, &["no free fall is seen", "written by hand: `plunge new --list`"]);
    assert!(of_text("a.csv", rows(drop, ",").as_bytes(), &[("length_unit", "mm")]).is_ok());
}
