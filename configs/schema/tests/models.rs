//! Every good model loads and prints itself; every bad one is refused with the expected message.

use std::fs;
use std::path::{Path, PathBuf};

use configs::{Color, ConfigError, LoadOptions, Loaded, Model, ModelSource, SHIPPED};
use fixtures::Case;

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// The TOML files of a folder, sorted.
fn models_in(name: &str) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = fs::read_dir(folder(name))
        .expect("the folder is part of the repository")
        .map(|entry| entry.expect("a readable folder").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .collect();
    files.sort();
    files
}

/// A model file whose first lines may be `# --set key=value`.
fn load_file(path: &Path) -> Result<Loaded, String> {
    let text = fs::read_to_string(path).expect("a readable model");
    let sets =
        text.lines().map_while(|line| line.strip_prefix("# --set ")).map(str::to_owned).collect();
    let source = ModelSource::Text {
        name: path.file_name().expect("a file").to_string_lossy().into_owned(),
        text,
        folder: path.parent().expect("a folder").to_owned(),
    };
    let options = LoadOptions { sets, ..LoadOptions::default() };
    Model::load(source, &options).map_err(|error| error.render(Color::Off))
}

fn reload(text: &str, folder: &Path) -> Loaded {
    let source = ModelSource::Text {
        name: "model.toml".to_owned(),
        text: text.to_owned(),
        folder: folder.to_owned(),
    };
    Model::load(source, &LoadOptions::default())
        .unwrap_or_else(|error| panic!("{}\n{text}", error.render(Color::Off)))
}

#[test]
fn good_models_load_and_their_resolved_text_loads_to_the_same_model() {
    for path in models_in("tests/good").into_iter().chain(models_in("..")) {
        let loaded = load_file(&path).unwrap_or_else(|error| panic!("{error}"));
        let resolved = loaded.model.resolved_toml();
        let again = reload(resolved, path.parent().expect("a folder"));
        assert_eq!(again.model.resolved_toml(), resolved, "{}", path.display());
        assert_eq!(again.model, loaded.model, "{}", path.display());
        assert_eq!(again.model.hash(), loaded.model.hash());
    }
}

#[test]
fn shipped_models_are_the_files_in_configs_and_load_without_a_warning() {
    let files: Vec<String> = models_in("..")
        .iter()
        .map(|path| path.file_stem().expect("a name").to_string_lossy().into_owned())
        .collect();
    let mut shipped: Vec<&str> = SHIPPED.iter().map(|shipped| shipped.name).collect();
    shipped.sort_unstable();
    assert_eq!(files, shipped);
    for shipped in SHIPPED {
        let loaded = Model::load(ModelSource::Shipped(shipped), &LoadOptions::default())
            .unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(loaded.render_warnings(Color::Off), "");
        assert_eq!(loaded.model.run.name, shipped.name);
    }
}

/// The message about the bad model `case`.
fn refusal(case: &Case) -> Result<String, String> {
    let base = folder("tests/good").join(&case.base).with_extension("toml");
    let good = fs::read_to_string(&base).map_err(|error| format!("{}: {error}", base.display()))?;
    let source = ModelSource::Text {
        name: format!("{}.toml", case.name),
        text: case.apply(&good).map_err(|error| error.to_string())?,
        folder: folder("tests/bad"),
    };
    let options = LoadOptions { sets: case.set.clone(), ..LoadOptions::default() };
    match Model::load(source, &options) {
        Ok(_) => Err("the model is accepted".to_owned()),
        Err(ConfigError::Invalid { diagnostics, sources }) if !case.whole => {
            Ok(diagnostics.iter().map(|one| one.brief(&sources)).collect())
        }
        Err(error) => Ok(error.render(Color::Off)),
    }
}

/// `BLESS=1` in the environment rewrites the expected messages.
#[test]
fn bad_models_are_refused_with_the_expected_messages() {
    fixtures::check(&folder("tests/bad"), refusal).unwrap_or_else(|wrong| panic!("{wrong}"));
}

#[test]
fn a_string_of_5000_characters_is_refused_and_shown_in_part() {
    let minimal = fs::read_to_string(folder("tests/good/minimal.toml")).expect("a good model");
    let source = ModelSource::Text {
        name: "model.toml".to_owned(),
        text: minimal.replace("\"small\"", &format!("\"{}\"", "x".repeat(5000))),
        folder: folder("tests/good"),
    };
    let message = Model::load(source, &LoadOptions::default()).expect_err("too long").to_string();
    assert!(message.starts_with("error: `name` is 5000 bytes long\n --> model.toml:2:8\n"));
    assert!(message.contains("xxx...xxx") && message.contains("at most 4096"), "{message}");
    assert!(message.lines().all(|line| line.chars().count() < 200), "{message}");
}
