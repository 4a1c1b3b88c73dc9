//! `plunge new schemas` writes the schemas that are kept.
//!
//! `BLESS=1` in the environment writes the kept ones anew, as `cargo xtask schema` does.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const NAMES: [&str; 3] = ["model.json", "measurement.json", "campaign.json"];

fn plunge(folder: &Path, args: &[&str]) -> Result<String, String> {
    let out = Command::new(env!("CARGO_BIN_EXE_plunge")).args(args).current_dir(folder).output();
    let out = out.expect("plunge runs");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    match out.status.success() {
        true => Ok(text(&out.stdout)),
        false => Err(text(&out.stderr)),
    }
}

fn read(path: PathBuf) -> String {
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn schemas_that_are_kept_are_those_that_plunge_writes() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    plunge(folder.path(), &["new", "schemas", "--quiet"]).unwrap_or_else(|error| panic!("{error}"));
    let kept = Path::new(env!("CARGO_MANIFEST_DIR")).join("../configs/schemas");
    for name in NAMES {
        let made = read(folder.path().join("schemas").join(name));
        if std::env::var_os("BLESS").is_some_and(|bless| bless == "1") {
            fs::create_dir_all(&kept).expect("a folder for schemas");
            fs::write(kept.join(name), &made).expect("a schema");
        }
        assert!(
            made == read(kept.join(name)),
            "{name} is not as kept: `cargo xtask schema` writes it"
        );
    }
    let again = plunge(folder.path(), &["new", "schemas"]).expect_err("a second time");
    assert!(again.contains("schemas exists already"), "{again}");
}
