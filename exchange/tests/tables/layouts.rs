//! Every layout is known by itself and read to the drops that it was made of.

use std::fs;
use std::path::{Path, PathBuf};

use exchange::tracking::{Options, Set, import};
use measurements::MeasurementSet;

use crate::contact::ball;
use crate::formats;
use crate::world::Drop;

/// The set of the one table `text` in a file called `name`.
pub(crate) fn of_text(name: &str, text: &[u8], options: &[(&str, &str)]) -> Result<Set, String> {
    let here = tempfile::tempdir().expect("a folder");
    let path = here.path().join(name);
    fs::write(&path, text).expect("a table");
    of_files(&[path], options, &here.path().join("set"))
        .map_err(|error| error.replace(&format!("{}/", here.path().display()), ""))
}

/// The set of tables at these places in a folder.
pub(crate) fn of_folder(
    tables: &[(String, String)],
    options: &[(&str, &str)],
) -> Result<Set, String> {
    let here = tempfile::tempdir().expect("a folder");
    let write = |(name, text): &(String, String)| {
        let path = here.path().join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(&path, text).expect("a table");
        path
    };
    let paths: Vec<PathBuf> = tables.iter().map(write).collect();
    let shown = format!("{}/", here.path().display());
    let options: Vec<(&str, String)> =
        options.iter().map(|(key, value)| (*key, value.replace("HERE/", &shown))).collect();
    let options: Vec<(&str, &str)> =
        options.iter().map(|(key, value)| (*key, value.as_str())).collect();
    let drops: Vec<PathBuf> =
        paths.into_iter().filter(|path| !path.ends_with("bodies.csv")).collect();
    of_files(&drops, &options, &here.path().join("set")).map_err(|error| error.replace(&shown, ""))
}

fn of_files(paths: &[PathBuf], options: &[(&str, &str)], out: &Path) -> Result<Set, String> {
    let mut all: Options = ball();
    options.iter().for_each(|(key, value)| all.set(key, *value));
    let set = import(paths, &all, out).map_err(|error| error.to_string())?;
    set.write(out).map_err(|error| error.to_string())?;
    let loaded = MeasurementSet::load(out).map_err(|error| error.to_string())?;
    let said: Vec<&str> =
        loaded.contradictions.iter().map(|one| &*one.diagnostic.message).collect();
    assert!(said.is_empty(), "{said:?}");
    Ok(set)
}

/// Holds a set against the drops that its table was made of, whose first frame is at time 0 of the table.
fn holds(set: &Set, drops: &[Drop], layout: &str) {
    assert_eq!(set.understood.len(), drops.len(), "{set:?}");
    for (one, drop) in set.understood.iter().zip(drops) {
        assert!(one.layout.starts_with(layout), "{one:?}");
        let off = one.contact.value - drop.contact;
        assert!(off.abs() < 4.0 * one.contact.se && off.abs() < 3e-3, "{one:?}: {off}");
        let fast = one.speed.value - drop.speed;
        assert!(
            fast.abs() < 4.0 * one.speed.se && fast.abs() < 0.03 * drop.speed,
            "{one:?}: {fast}"
        );
    }
}

/// Reads a table, and gives what was understood.
pub(crate) fn check(
    name: &str,
    text: &str,
    options: &[(&str, &str)],
    drops: &[Drop],
    layout: &str,
) -> Set {
    let set =
        of_text(name, text.as_bytes(), options).unwrap_or_else(|error| panic!("{name}: {error}"));
    holds(&set, drops, layout);
    set
}

const SCALE: (&str, &str) = ("scale", "0.2mm/px");
const RATE: (&str, &str) = ("rate", "650Hz");

#[test]
fn tracker() {
    let drops = formats::two();
    let set = check("drop.txt", &formats::tracker(&drops[0]), &[], &drops[..1], "Tracker");
    assert_eq!(set.understood[0].axis, "y (m, by the fall), up");
    let set = check("two.txt", &formats::tracker_multi(&drops), &[], &drops, "Tracker");
    assert_eq!(set.understood[1].run, "mass B");
}

#[test]
fn trackmate() {
    let drops = formats::two();
    let set = check("spots.csv", &formats::trackmate(&drops), &[SCALE], &drops, "TrackMate");
    assert_eq!(set.understood[0].axis, "POSITION_Y (px), down");
    assert_eq!(set.understood[1].run, "track1");
}

#[test]
fn imagej() {
    let mut drops = formats::two();
    check("tracks.txt", &formats::mtrackj(&drops), &[], &drops, "ImageJ");
    // Slices count from 1.
    drops.iter_mut().for_each(|one| one.contact += 1.0 / 650.0);
    check("tracks.xls.txt", &formats::manual_tracking(&drops), &[SCALE, RATE], &drops, "ImageJ");
}

#[test]
fn dltdv() {
    let drops = formats::two();
    let set = check("xypts.csv", &formats::dltdv(&drops), &[SCALE, RATE], &drops, "DLTdv");
    assert_eq!(set.understood[0].run, "pt1_cam1");
}

#[test]
fn kinovea() {
    let drops = formats::two();
    let set = check("path.txt", &formats::kinovea(&drops), &[], &drops, "Kinovea");
    assert_eq!(set.understood[0].axis, "Y (cm, by the fall), up");
    assert_eq!(set.understood[1].run, "Ball 2");
}

#[test]
fn loggerpro() {
    let drops = formats::two();
    let set = check("motion.txt", &formats::loggerpro(&drops[1]), &[], &drops[1..], "LoggerPro");
    assert_eq!(set.understood[0].axis, "Position (cm), down");
    check("motion.csv", &formats::loggerpro_table(&drops), &[], &drops, "LoggerPro");
}

#[test]
fn labview() {
    let drops = formats::two();
    let set = check("a.lvm", &formats::labview(&drops[1]), &[], &drops[1..], "LabVIEW");
    assert_eq!(set.understood[0].axis, "height (mm), up");
}

#[test]
fn deeplabcut() {
    let drops = formats::two();
    check("ball.csv", &formats::deeplabcut(&drops[1]), &[SCALE, RATE], &drops[1..], "DeepLabCut");
}

#[test]
fn plain_tables() {
    let mut drops = formats::two();
    let set = check("all.csv", &formats::long(&drops), &[], &drops, "long, commas");
    assert_eq!(set.understood[0].condition, "10cm");
    check("wide.csv", &formats::wide(&drops), &[], &drops, "wide, semicolons");
    let set = check("bare.dat", &formats::bare(&drops[0]), &[], &drops[..1], "one drop, blanks");
    assert_eq!(set.understood[0].axis, "y (mm, by the fall), down");
    let unnamed = formats::bare(&drops[0]).replace("t y\n", "");
    check("unnamed.dat", &unnamed, &[], &drops[..1], "one drop, blanks");
    let of_three = |line: &str| line.split_once(' ').map(|(t, y)| format!("7 {y} {t}\n"));
    let text: String = unnamed.lines().filter_map(of_three).collect();
    let named = [("column_t", "3"), ("column_z", "2")];
    check("unnamed.dat", &text, &named, &drops[..1], "one drop, blanks");
    drops.iter_mut().for_each(|one| one.contact += 1000.0 / 650.0);
    check("points.csv", &formats::points(&drops), &[SCALE, RATE], &drops, "wide, commas");
}

#[test]
fn times_in_few_digits() {
    let drops = formats::two();
    let of = |drop: &Drop, t: &dyn Fn(f64) -> String| -> String {
        let row = |(at, z): &(f64, f64)| format!("{} {:.4}\n", t(*at), 500.0 - 1e3 * z);
        format!("t y\n{}", drop.readings.iter().map(row).collect::<String>())
    };
    // Frames of 650 Hz: times in ms are told apart, those in hundredths of a second repeat.
    for decimals in [3, 2] {
        let text = of(&drops[0], &|t| format!("{t:.decimals$}"));
        let set = check("rounded.dat", &text, &[], &drops[..1], "one drop, blanks");
        let notes = &set.notes;
        assert!(notes.iter().any(|note| note.contains("rounded to 0.0")), "{notes:?}");
    }
}

#[test]
fn spreadsheets() {
    let drops = formats::two();
    for name in ["drops.xlsx", "drops.ods"] {
        let path = Path::new("tests/tables/data").join(name);
        let here = tempfile::tempdir().expect("a folder");
        let set = of_files(&[path], &[], &here.path().join("set"));
        holds(&set.unwrap_or_else(|error| panic!("{name}: {error}")), &drops, "wide, cells");
    }
}
