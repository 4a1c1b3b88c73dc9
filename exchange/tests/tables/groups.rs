//! Which runs belong together where no pattern says it.

use std::fmt::Write as _;

use exchange::tracking::{Options, Set, import};

use crate::layouts::of_folder;
use crate::refusals::has;
use crate::world::{Camera, Drop, Meets, drop_onto};

/// A drop from `height` (m) onto a bed that is so many times as hard, as a table.
fn table(height: f64, hard: f64, seed: u64) -> String {
    let one = drop_onto(hard, Meets::Whole, height, Camera { seed, ..Camera::USUAL });
    let mut text = String::from("t (s),z (mm)\n");
    rows(&one, "", &mut text);
    text
}

/// The rows of a drop behind a `head`.
fn rows(one: &Drop, head: &str, text: &mut String) {
    for (t, z) in &one.readings {
        let _ = writeln!(text, "{head}{t:.5},{:.3}", 1e3 * z);
    }
}

/// The conditions of a set in the order of its runs.
fn conditions(set: &Set) -> Vec<&str> {
    set.understood.iter().map(|one| one.condition.as_str()).collect()
}

fn says(set: &Set, part: &str) -> bool {
    set.notes.iter().any(|note| note.contains(part))
}

#[test]
fn words_and_heights_in_names_and_folders_part_conditions_of_one_speed() {
    for (names, wanted) in [
        (["loose/drop1", "loose/drop2", "dense/drop1", "dense/drop2"], ["loose", "dense"]),
        (["h10cm (1)", "h10cm (2)", "h10.5cm (1)", "h10.5cm (2)"], ["h10cm", "h10.5cm"]),
        (["phi58_h10_1", "phi58_h10_2", "phi62_h10_1", "phi62_h10_2"], ["phi58_h10", "phi62_h10"]),
        (["r1_steel", "r2_steel", "r1_wax", "r2_wax"], ["steel", "wax"]),
    ] {
        let file = |(at, name): (usize, &&str)| (format!("{name}.csv"), table(0.1, 1.0, at as u64));
        let tables: Vec<(String, String)> = names.iter().enumerate().map(file).collect();
        let set = of_folder(&tables, &[]).unwrap_or_else(|error| panic!("{names:?}: {error}"));
        assert_eq!(conditions(&set), [wanted[0], wanted[0], wanted[1], wanted[1]]);
        assert!(says(&set, "Conditions: by the names of runs without the number of the repeat"));
    }
}

#[test]
fn names_that_number_the_drops_leave_conditions_to_speeds_and_depths_are_held_against_them() {
    let of = |hard: f64| {
        let file = |(at, height): (usize, f64)| {
            (
                format!("drop{}.csv", at + 1),
                table(height, if at % 2 == 0 { 1.0 } else { hard }, at as u64),
            )
        };
        let tables: Vec<(String, String)> =
            [0.05, 0.05, 0.2, 0.2].into_iter().enumerate().map(file).collect();
        of_folder(&tables, &[]).unwrap_or_else(|error| panic!("{error}"))
    };
    let set = of(1.0);
    let found = conditions(&set);
    assert!(
        found[0] == found[1] && found[2] == found[3] && found[0].starts_with("v0.9"),
        "{found:?}"
    );
    assert!(
        says(&set, "Conditions: by speed at contact.")
            && !says(&set, "put together by speed alone")
    );
    let set = of(2.0);
    assert!(says(&set, "(drop1, drop2) are put together by speed alone"), "{:?}", set.notes);
    assert!(says(&set, "final depths scatter by "));
}

#[test]
fn runs_of_one_name_that_differ_in_speed_are_parted() {
    let file = |(at, name, height): (usize, &str, f64)| {
        (format!("{name}.csv"), table(height, 1.0, at as u64))
    };
    let tables =
        [(0, "wet_1", 0.05), (1, "wet_2", 0.2), (2, "dry_1", 0.05), (3, "dry_2", 0.05)].map(file);
    let set = of_folder(&tables, &[]).unwrap_or_else(|error| panic!("{error}"));
    let found = conditions(&set);
    assert!(found[0].starts_with("wet_v0.9") && found[1].starts_with("wet_v1.9"), "{found:?}");
    assert_eq!(found[2..], ["dry", "dry"]);
    assert!(says(&set, "runs of one name by speed at contact"), "{:?}", set.notes);
}

/// Two trials of each of two bodies or heights, whose rows are sorted by time or not.
fn trials(head: &str, values: [&str; 2], is_sorted: bool) -> String {
    let mut text = String::new();
    for (at, value) in (0_u32..).zip(values) {
        for trial in 1..3 {
            let hold = 0.2 + 0.01 * f64::from(at);
            let camera = Camera { seed: 10 * u64::from(at) + trial, hold, ..Camera::USUAL };
            let one = drop_onto(1.0, Meets::Whole, 0.1, camera);
            rows(&one, &format!("{value},{trial},"), &mut text);
        }
    }
    let mut lines: Vec<&str> = text.lines().collect();
    if is_sorted {
        lines.sort_by_key(|line| line.split(',').nth(2).map(str::to_owned));
    }
    format!("{head},t (s),z (mm)\n{}\n", lines.join("\n"))
}

#[test]
fn numbers_of_trials_begin_again_for_each_body_and_height() {
    let bodies = "Körper;Durchmesser (mm);Masse (g)\nsteel;25,4;67\nwax;25,4;60\n";
    let by_bodies: &[(&str, &str)] = &[("bodies", "HERE/bodies.csv")];
    for (head, values, options, wanted) in [
        ("body,trial", ["steel", "wax"], by_bodies, ["steel", "wax"]),
        ("height_cm,Versuch", ["10", "11"], &[], ["height10cm", "height11cm"]),
    ] {
        for is_sorted in [false, true] {
            let tables = [
                ("long.csv".to_owned(), trials(head, values, is_sorted)),
                ("bodies.csv".to_owned(), bodies.to_owned()),
            ];
            let set = of_folder(&tables, options).unwrap_or_else(|error| panic!("{head}: {error}"));
            let mut found = conditions(&set);
            found.sort_unstable();
            assert_eq!(found, [wanted[0], wanted[0], wanted[1], wanted[1]]);
        }
    }
}

#[test]
fn a_folder_or_a_word_that_is_called_like_a_body_says_the_body() {
    let bodies =
        "body,diameter (mm),mass (g)\nsteel,25.4,67\nwax,25.4,60\nbig wax,30,70\n1,25.4,50\n";
    let told: &[(&str, &str)] = &[("bodies", "HERE/bodies.csv")];
    let by_pattern = &[told[0], ("condition", "{body}/h{height}_{repeat}")];
    for (names, options) in [
        (["steel/h10_1", "wax/h10_1"], told),
        (["wax_h10_1", "big_wax_h10_1"], told),
        (["Steel_h10_1", "h10_wax_1"], told),
        (["steel/h10_1", "wax/h10_1"], by_pattern),
    ] {
        let file = |(name, at): (&&str, u64)| (format!("{name}.csv"), table(0.1, 1.0, at));
        let mut tables: Vec<(String, String)> = names.iter().zip(0..).map(file).collect();
        tables.push(("bodies.csv".to_owned(), bodies.to_owned()));
        let set = of_folder(&tables, options).unwrap_or_else(|error| panic!("{names:?}: {error}"));
        assert_eq!(set.understood.len(), 2);
        assert_ne!(set.understood[0].condition, set.understood[1].condition);
    }
    let here = tempfile::tempdir().expect("a folder");
    let [drop, all] = ["h10_1.csv", "bodies.csv"].map(|name| here.path().join(name));
    std::fs::write(&drop, table(0.1, 1.0, 1)).expect("a table");
    std::fs::write(&all, bodies).expect("a table");
    let mut options = Options::default();
    options.set("bodies", all.display().to_string());
    let error = import(&[drop], &options, &here.path().join("set")).expect_err("no body");
    has(
        &error.to_string(),
        &["no name, folder or column `body` says which of steel, wax, big wax, 1 it is"],
    );
}

#[test]
fn versions_that_number_repeats_are_asked_for() {
    let name = |at: usize| format!("fall{}_v{}.csv", ["low", "high"][at / 2], at % 2);
    let tables: Vec<(String, String)> =
        (0..4).map(|at| (name(at), table([0.05, 0.2][at / 2], 1.0, at as u64))).collect();
    let set = of_folder(&tables, &[]).unwrap_or_else(|error| panic!("{error}"));
    assert!(
        says(&set, "have a condition each, and by their speeds 2 conditions"),
        "{:?}",
        set.notes
    );
    let of = [("condition", "{condition}_v{repeat}")];
    let set = of_folder(&tables, &of).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(conditions(&set), ["falllow", "falllow", "fallhigh", "fallhigh"]);
    assert!(!says(&set, "have a condition each"));
}

#[test]
fn an_option_that_a_column_contradicts_is_told_and_decimal_commas_of_columns_are_read() {
    let one = drop_onto(1.0, Meets::Whole, 0.1, Camera::USUAL);
    let mut text = String::from("Durchmesser [mm];Masse [g];t [s];z [mm]\n");
    for (t, z) in &one.readings {
        let _ = writeln!(text, "{}", format!("20.5;11.5;{t:.5};{:.3}", 1e3 * z).replace('.', ","));
    }
    let tables = [("a.csv".to_owned(), text)];
    let set = of_folder(&tables, &[]).unwrap_or_else(|error| panic!("{error}"));
    assert!(
        says(&set, "--diameter 25.4 mm is taken for all runs, though a column has 20.5 mm for a"),
        "{:?}",
        set.notes
    );
}

#[test]
fn conditions_without_names_part_where_gaps_of_speed_are_wide() {
    // Speeds that are 5 % apart, and repeats within 1 %.
    let heights = [0.2, 0.2, 0.2, 0.221, 0.221, 0.221, 0.244, 0.244, 0.244];
    let file =
        |(at, height): (usize, f64)| (format!("drop{at}.csv"), table(height, 1.0, at as u64));
    let tables: Vec<(String, String)> = heights.into_iter().enumerate().map(file).collect();
    let set = of_folder(&tables, &[]).unwrap_or_else(|error| panic!("{error}"));
    let found = conditions(&set);
    let each: Vec<&str> = found.iter().step_by(3).copied().collect();
    assert!(found.iter().enumerate().all(|(at, one)| *one == each[at / 3]), "{found:?}");
    assert!(each[0] != each[1] && each[1] != each[2], "{found:?}");
}
