//! Tables of which a few are not like the others: another scale, an axis turned round, exchanged names, another size of body.

use std::fmt::Write as _;

use exchange::tracking::Set;

use crate::layouts::of_folder;
use crate::world::{Camera, drop};

/// Height of a drop (m), its scale against the others, the sign of its axis, and the level of its tracked point (m).
#[derive(Clone, Copy)]
struct Table {
    height: f64,
    scale: f64,
    sign: f64,
    level: f64,
}

const HEIGHTS: [f64; 4] = [0.05, 0.1, 0.2, 0.4];

/// Three drops from each height, by names that say it in cm; `change` makes one of them odd.
fn tables(change: impl Fn(&str, &mut Table)) -> Vec<(String, String)> {
    let mut all = Vec::new();
    for (at, height) in HEIGHTS.into_iter().enumerate() {
        for repeat in 0..3 {
            let name = format!("h{:02.0}_{repeat}", 1e2 * height);
            let mut table = Table { height, scale: 1.0, sign: 1.0, level: 0.0 };
            change(&name, &mut table);
            let camera = Camera { seed: 10 * at as u64 + repeat, ..Camera::USUAL };
            let mut text = String::from("t (s),z (mm)\n");
            for (t, z) in drop(table.height, camera).readings {
                let z = table.sign * table.scale * (z + table.level);
                let _ = writeln!(text, "{t:.5},{:.3}", 1e3 * z);
            }
            all.push((format!("{name}.csv"), text));
        }
    }
    all
}

fn warned(set: &Set, part: &str) -> Option<String> {
    set.notes.iter().find(|note| note.contains(part)).cloned()
}

fn imported(change: impl Fn(&str, &mut Table)) -> Set {
    of_folder(&tables(change), &[]).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn tables_that_are_alike_bring_no_warning() {
    let set = imported(|_, _| {});
    for part in ["Warning", "fall otherwise", "axis counts", "heights in their names"] {
        assert_eq!(warned(&set, part), None);
    }
}

#[test]
fn runs_of_another_scale_are_named_though_most_are_right() {
    let set = imported(|name, table| {
        if name == "h20_1" {
            table.scale = 1.1;
        }
    });
    let warning = warned(&set, "fall otherwise than at 9.81").expect("a warning");
    assert!(warning.contains("h20_1 (10.") && !warning.contains("h20_0"), "{warning}");
}

#[test]
fn an_axis_that_counts_the_other_way_is_named() {
    let set = imported(|name, table| {
        if name == "h10_2" {
            table.sign = -1.0;
        }
    });
    let warning = warned(&set, "the axis counts").expect("a warning");
    assert!(warning.contains("downward in h10_2, and upward in the others"), "{warning}");
}

#[test]
fn exchanged_names_are_seen_by_the_speeds() {
    let set = imported(|name, table| {
        if name.starts_with("h05") {
            table.height = 0.4;
        } else if name.starts_with("h40") {
            table.height = 0.05;
        }
    });
    let warning = warned(&set, "heights in their names").expect("a warning");
    assert!(warning.contains("h05_0 (from 40)") && warning.contains("h40_0 (from 5)"), "{warning}");
}

#[test]
fn bodies_of_several_sizes_have_one_surface_if_their_centres_were_tracked() {
    // Centres of balls of 25.4 and 12.7 mm touch 6.35 mm apart.
    let files: Vec<(String, String)> = tables(|name, table| {
        table.level = if name.ends_with('0') { 0.00635 } else { 0.0127 };
    })
    .into_iter()
    .map(|(name, text)| {
        let body = if name.ends_with("0.csv") { "small" } else { "large" };
        (format!("{body}_{name}"), text)
    })
    .chain([(
        "bodies.csv".to_owned(),
        "body,diameter (mm),mass (g)\nsmall,12.7,24\nlarge,25.4,67\n".to_owned(),
    )])
    .collect();
    let with = |options: &[(&str, &str)]| {
        let mut all = vec![("bodies", "HERE/bodies.csv")];
        all.extend(options);
        of_folder(&files, &all).unwrap_or_else(|error| panic!("{error}"))
    };
    let found = with(&[]);
    assert!(warned(&found, "if the centre was tracked, which is assumed").is_some());
    let level = |set: &Set| warned(set, "Surface:").expect("a level");
    assert!(level(&found).contains("one level for all runs"));
    assert_eq!(level(&found), level(&with(&[("tracked", "centre")])));
    assert!(level(&with(&[("tracked", "lowest")])).contains("a level for each run"));
}

#[test]
fn heights_that_all_names_state_judge_the_scale() {
    // Speeds are a fifth too large, and heights of fall go with their squares.
    let set = imported(|_, table| table.scale = 1.2);
    let told =
        warned(&set, "by their names the bodies fall from 5, 10, 20, 40").expect("a warning");
    assert!(told.contains("Lengths 0.8") && told.contains(" m. Are the scale"), "{told}");
}

#[test]
fn a_fall_that_no_guide_explains_is_refused_whatever_single_runs_say() {
    let error =
        of_folder(&tables(|_, table| table.scale = 10.0), &[]).expect_err("ten times as long");
    assert!(error.contains("by its units the fall before contact accelerates at 9"), "{error}");
}

#[test]
fn a_mass_in_a_name_is_held_against_the_stated_one() {
    let all: Vec<(String, String)> = tables(|_, _| {})
        .into_iter()
        .map(|(name, text)| (name.replace("h40", "33g_h40"), text))
        .collect();
    let set = of_folder(&all, &[]).unwrap_or_else(|error| panic!("{error}"));
    assert!(warned(&set, "has 33g in its name").is_some_and(|told| told.contains("--bodies")));
}
