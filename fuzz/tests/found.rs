//! What ships gets behind the checks of form, and what was found once breaks no reader again.

use std::fs;
use std::path::Path;

use fuzz::{TARGETS, Target, seeds};

fn here() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn seeds_of(target: &Target) -> Vec<Vec<u8>> {
    seeds::of(target.name, &here().join("..")).expect("files that ship")
}

#[test]
fn inputs_to_start_from_reach_behind_the_checks_of_form() {
    let accepted = |name: &str, what: &str| {
        let target = TARGETS.iter().find(|target| target.name == name).expect("a target");
        let reaches = |seed: &Vec<u8>| (target.outcome)(seed).contains(what);
        assert!(seeds_of(target).iter().any(reaches), "{name}: none is `{what}`");
    };
    accepted("model", "accepted with 0 warnings");
    accepted("formula", "a formula of");
    accepted("set", "conditions");
    accepted("log", "1 bodies");
    accepted("checkpoint", "stepped");
}

#[test]
fn what_was_found_once_breaks_no_reader_again() {
    for target in &TARGETS {
        let folder = here().join("found").join(target.name);
        let files =
            fs::read_dir(&folder).unwrap_or_else(|why| panic!("{}: {why}", folder.display()));
        let inputs: Vec<Vec<u8>> =
            files.map(|file| fs::read(file.expect("a file").path()).expect("a file")).collect();
        assert!(!inputs.is_empty(), "{} is empty", folder.display());
        inputs.iter().for_each(|input| drop((target.outcome)(input)));
    }
}
