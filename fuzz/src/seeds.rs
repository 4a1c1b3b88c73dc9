//! Inputs to start from: models, sets and formulas that ship, a short log, states of a small bed.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use configs::{LoadOptions, Model, ModelSource};
use engine::record::RUN_LOG;
use runner::run::{Control, Existing, Places, Progress, run};

use crate::{checkpoint, log, set};

/// The most bytes of the records of a log.
const MOST_RECORDS: usize = 20_000;

/// Inputs for the target `name`; `root` is the folder of the repository.
///
/// # Errors
/// If a file cannot be read, or there is no such target.
pub fn of(name: &str, root: &Path) -> Result<Vec<Vec<u8>>, Box<dyn Error>> {
    match name {
        "model" => models(root),
        "formula" => formulas(root),
        "set" => sets(root),
        "log" => logs(),
        "checkpoint" => states(),
        other => Err(format!("there is no target `{other}`").into()),
    }
}

fn models(root: &Path) -> Result<Vec<Vec<u8>>, Box<dyn Error>> {
    let mut inputs = Vec::new();
    let good = root.join("configs/schema/tests/good");
    for folder in [&root.join("configs"), &good] {
        let is_model = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "toml");
        for path in entries(folder)?.into_iter().filter(is_model) {
            inputs.push(fs::read(path)?);
        }
    }
    for case in fixtures::topics(&root.join("configs/schema/tests/bad"))?
        .iter()
        .flat_map(|topic| &topic.cases)
    {
        let base = fs::read_to_string(good.join(&case.base).with_extension("toml"))?;
        inputs.push(case.apply(&base)?.into_bytes());
    }
    Ok(inputs)
}

/// What stands between quotes in the models and looks like a formula.
fn formulas(root: &Path) -> Result<Vec<Vec<u8>>, Box<dyn Error>> {
    let mut inputs = Vec::new();
    for model in models(root)? {
        let text = String::from_utf8_lossy(&model);
        let quoted = text.split('"').skip(1).step_by(2);
        let looks = |one: &&str| one.contains(['*', '(', '^']) && !one.contains('\n');
        inputs.extend(quoted.filter(looks).map(|one| one.as_bytes().to_vec()));
    }
    inputs.sort();
    inputs.dedup();
    Ok(inputs)
}

fn sets(root: &Path) -> Result<Vec<Vec<u8>>, Box<dyn Error>> {
    let mut inputs = Vec::new();
    for folder in entries(&root.join("validation/data"))? {
        let part = |name: &str| fs::read(folder.join(name)).unwrap_or_default();
        let parts = ["measurement.toml", "runs.csv", "trajectories.csv"].map(part);
        inputs.push(parts.join(set::BETWEEN));
    }
    let written = measurements::TEMPLATE;
    inputs.push(written.map(|(_, text)| text.as_bytes()).join(set::BETWEEN));
    Ok(inputs)
}

/// The log of an impact of half a millisecond, as it is and as its records.
fn logs() -> Result<Vec<Vec<u8>>, Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let sets = vec!["run.duration=0.5 ms".to_owned()];
    let shipped = configs::find_shipped("two-term-vector").ok_or("it ships")?;
    let options = LoadOptions { sets, ..LoadOptions::default() };
    let loaded = Model::load(ModelSource::Shipped(shipped), &options)?;
    let out = folder.path().join("out");
    let places = Places { out, cache: folder.path().join("cache"), existing: Existing::Keep };
    run(&loaded.model, &loaded.original, &places, &mut Quiet)?;
    let whole = fs::read(places.out.join(RUN_LOG))?;
    let mut records = vec![log::RECORDS];
    records.extend(log::records_of(&whole, MOST_RECORDS));
    Ok(vec![whole, records])
}

fn states() -> Result<Vec<Vec<u8>>, Box<dyn Error>> {
    let mut inputs = vec![with(checkpoint::BED, postcard::to_stdvec(&checkpoint::bed())?)];
    for state in checkpoint::states(&[0, 1, 50, 200]) {
        inputs.push(with(checkpoint::STATE, postcard::to_stdvec(&state)?));
    }
    Ok(inputs)
}

fn with(kind: u8, mut payload: Vec<u8>) -> Vec<u8> {
    payload.insert(0, kind);
    payload
}

/// What is in `folder`, in the order of names.
fn entries(folder: &Path) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let mut paths = Vec::new();
    for entry in fs::read_dir(folder)? {
        paths.push(entry?.path());
    }
    paths.sort();
    Ok(paths)
}

/// Nobody watches.
struct Quiet;

impl Control for Quiet {
    fn progress(&mut self, _: &Progress) {}

    fn warn(&mut self, _: &str) {}

    fn wants_to_stop(&self) -> bool {
        false
    }
}
