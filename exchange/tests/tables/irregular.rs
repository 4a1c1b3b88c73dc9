//! Tables that are irregular and yet readable, and irregular drops that are not.

use std::fmt::Write as _;

use crate::formats;
use crate::layouts::check;
use crate::refusals::{has, told};
use crate::world::Drop;

/// Rows of times (s) and heights (mm), made by `row`, below `head`.
fn table(head: &str, one: &Drop, row: impl Fn(usize, f64, f64) -> String) -> String {
    let mut text = format!("{head}\n");
    for (at, (t, z)) in one.readings.iter().enumerate() {
        let _ = writeln!(text, "{}", row(at, *t, 1e3 * z));
    }
    text
}

#[test]
fn names_marks_and_clocks_of_other_programs() {
    let drops = formats::two();
    let one = &drops[..1];
    let read = |name: &str, text: &str| check(name, text, &[], one, "one drop");
    let comma = |_: usize, t: f64, z: f64| format!("{t:.5},{z:.3}");
    // Nothing was tracked in the first frames.
    for mark in ["NaN", "", "-"] {
        let set = read(
            "a.csv",
            &table("t (s),z (mm)", &drops[0], |at, t, z| match at {
                0..3 => format!("{t:.5},{mark}"),
                _ => comma(at, t, z),
            }),
        );
        let told = "3 rows without a time or a position are left out";
        assert!(set.notes.iter().any(|note| note.contains(told)), "{:?}", set.notes);
    }
    // As numpy writes a header.
    read("a.txt", &table("# t z_mm", &drops[0], |_, t, z| format!("{t:.5e} {z:.5e}")));
    // Quantity over unit, as standards have it.
    read("a.csv", &table("t / ms,z / mm", &drops[0], |_, t, z| format!("{:.3},{z:.3}", 1e3 * t)));
    read("a.csv", &table("Zeit in s,Höhe in mm", &drops[0], comma));
    read("a.csv", &table("time,z (mm)", &drops[0], |_, t, z| format!("00:00:{t:08.5},{z:.3}")));
    // Text under the name of a spreadsheet.
    let tabs = table("t (s)\tz (mm)", &drops[0], |_, t, z| format!("{t:.5}\t{z:.3}"));
    read("Results.xls", &tabs);
}

#[test]
fn what_is_no_drop_is_left_out() {
    let drops = formats::two();
    let long = formats::long(&drops) + "Mean,10cm,,38.2,\n";
    let set = check("a.csv", &long, &[], &drops, "long");
    assert!(set.notes.iter().any(|note| note.contains("Mean: fewer than 8 readings")));
    // A ruler beside the ball.
    let points = formats::dltdv(&drops);
    let options =
        [("scale", "0.2mm/px"), ("rate", "650Hz"), ("column_z", "pt1_cam1_Y"), ("counts", "down")];
    check("a.csv", &points, &options, &drops[..1], "DLTdv");
    let options = [("scale", "0.2mm/px"), ("rate", "650Hz"), ("leave_out", "*pt2*")];
    check("a.csv", &points, &options, &drops[..1], "DLTdv");
    let message = told("a.csv", &points, &[("leave_out", "pt3_cam1")]);
    has(&message, &["--leave-out: no run is called `pt3_cam1`", "did you mean `pt"]);
    let twice = table("t (s),z (mm),z (mm)", &drops[0], |_, t, z| format!("{t:.5},{z:.3},{z:.3}"));
    has(&told("a.csv", &twice, &[("column_z", "z")]), &["2 columns are called `z`"]);
}

#[test]
fn scales_and_clocks_that_the_fall_belies() {
    let drops = formats::two();
    // Pixels of 0.87 mm that are called millimetres.
    let text = table("t (s),z (mm)", &drops[0], |_, t, z| format!("{t:.5},{:.3}", z / 0.87));
    let set = crate::layouts::of_text("a.csv", text.as_bytes(), &[]).expect("a set");
    let told_of = |part: &str| set.notes.iter().any(|note| note.contains(part));
    assert!(told_of("Warning: before contact the bodies fall at 11."), "{:?}", set.notes);
    // A clip of 1000 frames a second, played at 30.
    let slow = |one: &Drop| table("t,z", one, |_, t, z| format!("{:.5},{z:.3}", t * 1000.0 / 30.0));
    has(&told("a.csv", &slow(&drops[0]), &[]), &["is the clip played slowly? --rate"]);
    let stated = slow(&drops[0]).replace("t,z", "t (s),z (mm)");
    has(&told("a.csv", &stated, &[]), &["mm for m?", "--rate 1000Hz counts frames"]);
    let wrong = [("scale", "0.1mm/px"), ("rate", "650Hz")];
    let message = told("a.csv", &formats::dltdv(&drops), &wrong);
    has(&message, &["the length of a pixel times 2.0"]);
}

#[test]
fn several_drops_that_nothing_tells_apart_are_refused() {
    let drops = formats::two();
    let mut text = String::from("t (s),z (mm),Kugelfall\n");
    for (at, one) in drops.iter().enumerate() {
        for (t, z) in &one.readings {
            let _ = writeln!(text, "{:.5},{:.3},{at}", t + 2.0 * at as f64, 1e3 * z);
        }
    }
    let refused = told("a.csv", &text, &[]);
    has(&refused, &["it holds several drops, 2 at least", "--column run=NAME"]);
    let options = [("column_run", "Kugelfall")];
    let set = crate::layouts::of_text("a.csv", text.as_bytes(), &options).expect("two drops");
    assert_eq!(set.understood.len(), 2);
}

#[test]
fn means_beside_drops_are_no_drops() {
    let drops = formats::two();
    let mut text = String::from("t (s),a,b,Mittelwert\n");
    let pairs = drops[0].readings.iter().zip(&drops[1].readings);
    for ((t, a), (_, b)) in pairs {
        let _ = writeln!(text, "{t:.5},{:.3},{:.3},{:.3}", 1e3 * a, 1e3 * b, 500.0 * (a + b));
    }
    let set = crate::layouts::of_text("a.csv", text.as_bytes(), &[("length_unit", "mm")])
        .expect("two drops");
    assert_eq!(set.understood.len(), 2);
    let told = "mittelwert: no drop by its name, left out";
    assert!(set.notes.iter().any(|note| note.contains(told)), "{:?}", set.notes);
}

#[test]
fn readings_that_are_not_of_the_body_and_rows_out_of_order() {
    let drops = formats::two();
    let one = &drops[..1];
    let contact = (drops[0].contact * 650.0) as usize;
    // While it is held, in the fall, just before contact and in the bed.
    for stray in [40, contact - 20, contact - 2, contact + 8] {
        let text = table("t (s),z (mm)", &drops[0], |at, t, z| {
            format!("{t:.5},{:.3}", if at == stray { z + 14.0 } else { z })
        });
        let set = check("a.csv", &text, &[], one, "one drop");
        let told = format!("the reading on line {} is not of the body", stray + 2);
        assert!(set.notes.iter().any(|note| note.contains(&told)), "{told}: {:?}", set.notes);
    }
    let text = table("t (s),z (mm)", &drops[0], |_, t, z| format!("{t:.5},{z:.3}"));
    let rows: Vec<&str> = text.lines().skip(1).collect();
    let mut swapped = rows.clone();
    swapped.swap(100, 101);
    let reversed: Vec<&str> = rows.iter().rev().copied().collect();
    let shuffled: Vec<&str> = (0..rows.len()).map(|at| rows[at * 89 % rows.len()]).collect();
    for rows in [swapped, reversed, shuffled] {
        let text = format!("t (s),z (mm)\n{}\n", rows.join("\n"));
        let set = check("a.csv", &text, &[], one, "one drop");
        let told = "its rows are sorted by time";
        assert!(set.notes.iter().any(|note| note.contains(told)), "{:?}", set.notes);
    }
}

fn runs(set: &exchange::tracking::Set) -> Vec<&str> {
    set.understood.iter().map(|one| one.run.as_str()).collect()
}

#[test]
fn drops_below_each_other_and_beside_each_other() {
    let drops = formats::two();
    let titles = ["h 5 cm, a", "h 10 cm, a"];
    let rows = |one: &Drop| table("t (s),z (mm)", one, |_, t, z| format!("{t:.5},{z:.3}"));
    let below = |titled: bool| {
        let block = |(one, title): (&Drop, &str)| match titled {
            true => format!("{title}\n{}\n", rows(one)),
            false => rows(one),
        };
        drops.iter().zip(titles).map(block).collect::<String>()
    };
    let set = check("a.csv", &below(true), &[], &drops, "stacked, commas");
    assert_eq!(runs(&set), ["h 5 cm a", "h 10 cm a"]);
    let set = check("a.csv", &below(false), &[], &drops, "stacked, commas");
    assert_eq!(runs(&set), ["1", "2"]);

    let mut beside = String::from("low;;high;\nt (s);z (mm);t (s);z (mm)\n");
    let cell = |one: Option<&(f64, f64)>| {
        one.map_or(";".to_owned(), |(t, z)| format!("{t:.5};{:.3}", 1e3 * z))
    };
    let [a, b] = [0, 1].map(|at| &drops[at].readings);
    for at in 0..a.len().max(b.len()) {
        let _ = writeln!(beside, "{};{}", cell(a.get(at)), cell(b.get(at)));
    }
    let set = check("a.csv", &beside, &[], &drops, "pairs, semicolons");
    assert_eq!(runs(&set), ["low", "high"]);
}

#[test]
fn one_body_in_two_columns_is_asked_for() {
    let drops = formats::two();
    let text = table("t (s),z_raw (mm),z_filtered (mm)", &drops[0], |at, t, z| {
        format!("{t:.5},{z:.3},{:.3}", z + 0.01 * (at % 3) as f64)
    });
    let refused = told("a.csv", &text, &[]);
    has(&refused, &["move together", "--column z=\"z_raw (mm)\""]);
    check("a.csv", &text, &[("column_z", "z_raw (mm)")], &drops[..1], "one drop");
}

#[test]
fn signs_and_blanks_of_other_languages() {
    let drops = formats::two();
    let text = table("t (ms);z (um)", &drops[0], |_, t, z| {
        let (micro, sign) = ((1e3 * z).round().abs(), if z < 0.0 { "\u{2212}" } else { "" });
        let [thousands, rest] = [libm::floor(micro / 1e3), micro % 1e3];
        format!("{:.2};{sign}{thousands}\u{202f}{rest:03}", 1e3 * t).replace('.', ",")
    });
    check("a.csv", &text, &[], &drops[..1], "one drop, semicolons");
}

#[test]
fn a_clock_that_starts_again_is_told_with_what_it_lost() {
    let drops = formats::two();
    let step = drops[0].readings[1].0 - drops[0].readings[0].0;
    let wrap = 100.0 * step;
    let text = table("t (s),z (mm)", &drops[0], |at, t, z| {
        let t = if at >= 100 { t - wrap } else { t };
        format!("{t:.5},{z:.3}")
    });
    let refused = told("a.csv", &text, &[]);
    has(&refused, &["a.csv:102: the clock starts again", &format!("add {wrap:.4} to the times")]);
}

#[test]
fn what_is_no_reading_of_the_body_is_left_out() {
    let drops = formats::two();
    // A number for nothing, a mark that does not move, and sums below.
    for nothing in ["-999", "9999", "-1"] {
        let mut text = table("t (s),y1 (mm),y2 (mm)", &drops[0], |at, t, z| {
            let z = if at % 17 == 5 { nothing.to_owned() } else { format!("{:.3}", 300.0 + z) };
            format!("{t:.5},{z},{:.3}", 120.0 + 0.02 * (at % 5) as f64)
        });
        text.push_str("mean,210.2,120.0\nmax,420.0,120.1\n");
        let set = check("a.csv", &text, &[], &drops[..1], "wide, commas");
        assert_eq!(set.understood[0].run, "a");
        assert!(set.notes.iter().any(|note| note.contains("y2 (mm): it does not move")));
    }
}

#[test]
fn labels_beside_the_readings_tell_runs_apart() {
    let drops = formats::two();
    let mut text = String::from("body,height,rep,t_ms,z_mm\n");
    for (one, [height, rep]) in drops.iter().zip([["5", "1"], ["10", "1"]]) {
        for (t, z) in &one.readings {
            let _ = writeln!(text, "steel,{height},{rep},{:.3},{:.3}", 1e3 * t, 1e3 * z);
        }
    }
    let set = check("a.csv", &text, &[], &drops, "long, commas");
    assert_eq!(runs(&set), ["steel_5_1", "steel_10_1"]);
    // One drop with labels is one drop.
    let one = table("body,t (s),z (mm)", &drops[0], |_, t, z| format!("steel,{t:.5},{z:.3}"));
    check("a.csv", &one, &[], &drops[..1], "one drop");
}

#[test]
fn numbers_as_programs_write_them() {
    let drops = formats::two();
    let read = |text: &str, layout: &str| check("a.csv", text, &[], &drops[..1], layout);
    let quoted = |t: f64, z: f64| {
        format!("\"{t:.5}\",\"{z:.3}\"").replace('.', ",").replace("\",\"", "\u{1}")
    };
    let quoted = table("t (s),z (mm)", &drops[0], |_, t, z| quoted(t, z).replace('\u{1}', "\",\""));
    read(&quoted, "one drop, commas");
    read(&table("t (s)|z (mm)", &drops[0], |_, t, z| format!("{t:.5}|{z:.3}")), "one drop, bars");
    let fortran = |_: usize, t: f64, z: f64| format!("{t:.7e},{z:.5e}").replace('e', "D");
    read(&table("t (s),z (mm)", &drops[0], fortran), "one drop, commas");
    let spaced = |_: usize, t: f64, z: f64| format!("{t:.5}  {z:.3}");
    read(&table("% columns: t [s]  z [mm]", &drops[0], spaced), "one drop, blanks");
}

#[test]
fn a_slow_clip_whose_fall_fits_a_smaller_world_is_refused() {
    let drops = formats::two();
    // Taken at 960 frames a second, played at 30, in metres: the fall is that of mm and ms.
    let slow =
        table("t,y", &drops[0], |_, t, z| format!("{:.5},{:.6}", t * 960.0 / 30.0, 1e-3 * z));
    let refused = told("a.csv", &slow, &[]);
    has(&refused, &["nothing states the units of `t` and `y`", "mm into the bed", "--rate 1000Hz"]);
}

#[test]
fn a_body_that_leaves_the_bed_again_is_named() {
    let drops = formats::two();
    // From 40 ms behind contact on it rises to 15 mm above the surface.
    let flight = drops[0].contact + 0.04;
    let text = table("t (s),z (mm)", &drops[0], |_, t, z| {
        let up = t - flight;
        let rise =
            if (0.0..0.4).contains(&up) { 180.0 * (up / 0.4) * (1.0 - up / 0.4) } else { 0.0 };
        format!("{t:.5},{:.3}", z + rise)
    });
    let set = crate::layouts::of_text("a.csv", text.as_bytes(), &[]).expect("a set");
    let is_told = |part: &str| set.notes.iter().any(|note| note.contains(part));
    assert!(is_told("rises above the surface again in a ("), "{:?}", set.notes);
}

#[test]
fn a_spot_that_trembles_around_one_place_is_no_drop() {
    let drops = formats::two();
    let mut text = formats::trackmate(&drops);
    let mut noise = crate::world::Noise(3);
    for k in 0..40 {
        let [x, y] = [80.0, 140.0].map(|at| at + 4.0 * noise.normal());
        let t = f64::from(k) / 650.0;
        let _ = writeln!(text, "ID{k},{k},7,3.1,{x:.3},{y:.3},0.0,{t:.6},{k},5.0,1");
    }
    let set = check("a.csv", &text, &[("scale", "0.2mm/px")], &drops, "TrackMate");
    assert!(
        set.notes.iter().any(|note| note.contains("track7: it does not move")),
        "{:?}",
        set.notes
    );
}
