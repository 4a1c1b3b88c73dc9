//! Tables where a set or a model is expected, numbers that no set means, and folders that are files.

use std::fs;
use std::path::Path;

use crate::common::{Call, folder};

const DROPS: &str = "t (ms);y1 (cm);y2 (cm)\n0;18,41;18,40\n2;18,05;18,02\n4;17,66;17,61\n";

#[test]
fn every_command_says_what_a_table_is_and_what_to_type() {
    let here = folder();
    fs::write(here.path().join("drop.csv"), DROPS).expect("a table");
    let all: [&[&str]; 6] = [
        &["check", "drop.csv"],
        &["compare", "drop.csv"],
        &["diagnose", "drop.csv"],
        &["run", "drop.csv"],
        &["new", "measurements", "--from", "drop.csv"],
        &["new", "mine", "--from", "drop.csv"],
    ];
    for arguments in all {
        let message = Call::new(arguments).inside(here.path()).fails(2);
        for wanted in [
            "drop.csv is a table",
            "3 rows of 3 columns separated by semicolons, with decimal commas: t (ms), y1 (cm), y2 (cm)",
            "plunge import drop.csv -o my-drops --diameter 25.4mm --mass \"67 g\"",
        ] {
            assert!(message.contains(wanted), "{arguments:?}: {wanted}: {message}");
        }
    }
    assert_eq!(crate::common::names(here.path()), ["drop.csv"]);
}

#[test]
fn tables_of_tracking_programs_are_known_by_their_heads() {
    let here = folder();
    let tracker = "mass A\nt\tx\ty\n0.0\t1E-2\t0.2\n0.1\t1E-2\t0.19\n0.2\t1E-2\t0.17\n";
    fs::write(here.path().join("tracker.txt"), tracker).expect("a table");
    let message = Call::new(["check", "tracker.txt"]).inside(here.path()).fails(2);
    assert!(message.contains("that Tracker exported"), "{message}");
    let spots = "LABEL,ID,TRACK_ID,POSITION_X,POSITION_Y,POSITION_T\nLabel,Spot ID,Track ID,X,Y,T\n\
                 Label,Spot ID,Track ID,X,Y,T\n,,,(mm),(mm),(sec)\nID1,1,0,1.5,2.5,0\nID2,2,0,1.5,2.6,1\n";
    fs::write(here.path().join("spots.csv"), spots).expect("a table");
    let message = Call::new(["diagnose", "spots.csv"]).inside(here.path()).fails(2);
    assert!(message.contains("that TrackMate exported") && message.contains("2 rows"), "{message}");
    fs::write(here.path().join("drops.xlsx"), b"PK\x03\x04\x00\xff").expect("a file");
    let message = Call::new(["check", "drops.xlsx"]).inside(here.path()).fails(2);
    assert!(message.contains("plunge import drops.xlsx -o my-drops"), "{message}");
    // As a table of a set.
    Call::new(["new", "measurements"]).inside(here.path()).done();
    fs::write(here.path().join("measurements/trajectories.csv"), tracker).expect("a table");
    let message = Call::new(["check", "measurements"]).inside(here.path()).fails(2);
    assert!(message.contains("this is a table of Tracker"), "{message}");
}

#[test]
fn a_campaign_is_checked_by_its_own_command() {
    let campaign = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/campaign.toml");
    let message = Call::new(["check"]).arg(&campaign).fails(2);
    assert!(message.contains("is a campaign") && message.contains("--plan"), "{message}");
}

/// What `check` says of the template with `from` replaced by `to` in its measurement.toml.
fn told(from: &str, to: &str) -> String {
    let here = folder();
    Call::new(["new", "measurements"]).inside(here.path()).done();
    let path = here.path().join("measurements/measurement.toml");
    let text = fs::read_to_string(&path).expect("the template");
    assert!(text.contains(from), "{from}");
    fs::write(&path, text.replacen(from, to, 1)).expect("the template");
    Call::new(["check", "measurements"]).inside(here.path()).fails(2)
}

#[test]
fn sizes_and_masses_in_other_units_are_refused_with_the_number_to_write() {
    let millimetres = told("diameter = 0.0254", "diameter = 25.4");
    assert!(
        millimetres.contains("is the diameter in mm? then write diameter = 0.0254"),
        "{millimetres}"
    );
    let centimetres = told("diameter = 0.0254", "diameter = 2.54");
    assert!(
        centimetres.contains("is the diameter in cm? then write diameter = 0.0254"),
        "{centimetres}"
    );
    let grams = told("mass = 0.0667", "mass = 66.7");
    assert!(grams.contains("is the mass in g? then write mass = 0.0667"), "{grams}");
}

#[test]
fn an_out_that_is_no_folder_is_bad_input_under_the_name_that_was_given() {
    let here = folder();
    let set = Path::new(env!("CARGO_MANIFEST_DIR")).join("../validation/data/katsuragi-durian");
    fs::write(here.path().join("taken"), "mine").expect("a file");
    let long = "a".repeat(300);
    for command in ["compare", "diagnose"] {
        for out in ["taken", "taken/below", long.as_str()] {
            let call = Call::new([command, "--out", out]).arg(&set).inside(here.path());
            let message = call.fails(2);
            assert!(message.contains(out) && !message.contains("inputs.blake3"), "{message}");
        }
    }
    assert_eq!(fs::read_to_string(here.path().join("taken")).ok().as_deref(), Some("mine"));
    assert_eq!(crate::common::names(here.path()), ["taken"]);
}
