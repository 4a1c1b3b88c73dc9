//! Changed files against every reader. `cargo test` tries a few; `cargo xtask fuzz` goes on for minutes, and `cargo
//! bolero test -p fuzz --test readers` is led by what is covered.

use std::path::Path;

use bolero::produce;
use fuzz::edit::{Choice, Edit, edited};
use fuzz::{TARGETS, Target, seeds};

/// Changed inputs that `cargo test` tries of each kind.
const INPUTS: usize = 200;

fn target(name: &str) -> (Target, Vec<Vec<u8>>) {
    let target = TARGETS.into_iter().find(|target| target.name == name).expect("a target");
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let seeds = seeds::of(name, &root).expect("files that ship");
    assert!(!seeds.is_empty(), "{name}");
    (target, seeds)
}

/// What ships as inputs of that name, and each with one to four edits. A macro: bolero finds a test by its place.
macro_rules! try_changed {
    ($name:expr) => {
        let (target, seeds) = target($name);
        seeds.iter().for_each(|seed| drop((target.outcome)(seed)));
        let edits = produce::<Vec<Edit>>().with().len(1_usize..=4);
        let changes = (produce::<Choice>(), produce::<Choice>(), edits);
        bolero::check!().with_iterations(INPUTS).with_generator(changes).for_each(
            |(one, other, edits)| {
                let changed = edited(one.of::<Vec<u8>>(&seeds), other.of::<Vec<u8>>(&seeds), edits);
                drop((target.outcome)(&changed));
            },
        );
    };
}

#[test]
fn no_changed_model_breaks_its_reader() {
    try_changed!("model");
}

#[test]
fn no_changed_formula_breaks_its_reader() {
    try_changed!("formula");
}

#[test]
fn no_changed_set_breaks_its_reader() {
    try_changed!("set");
}

#[test]
fn no_changed_log_breaks_its_reader() {
    try_changed!("log");
}

#[test]
fn no_changed_checkpoint_breaks_its_reader() {
    try_changed!("checkpoint");
}
