//! Model files.

use configs::{Color, ConfigError, LoadOptions, Loaded, Model, ModelSource};

/// What comes of the model `bytes`: one that is accepted prints itself as one that is the same, one that
/// is refused says why.
///
/// # Panics
/// Where that does not hold.
pub fn outcome(bytes: &[u8]) -> String {
    let Ok(text) = std::str::from_utf8(bytes) else { return "no text".to_owned() };
    match load(text) {
        Ok(Loaded { model, warnings, .. }) => {
            let printed = model.resolved_toml();
            let again = load(printed)
                .unwrap_or_else(|error| panic!("what it prints is refused: {error}\n{printed}"));
            assert_eq!(again.model.resolved_toml(), printed, "it prints as another");
            assert_eq!(again.model.hash(), model.hash(), "its hash is another");
            format!("accepted with {} warnings", warnings.len())
        }
        Err(error) => {
            let said = error.render(Color::Off);
            assert!(!said.is_empty(), "refused without a word");
            said
        }
    }
}

fn load(text: &str) -> Result<Loaded, ConfigError> {
    // There are no tables of grains beside a text.
    let folder = std::env::temp_dir().join("plunge-fuzz-without-files");
    let source = ModelSource::Text { name: "model.toml".into(), text: text.to_owned(), folder };
    Model::load(source, &LoadOptions::default())
}
