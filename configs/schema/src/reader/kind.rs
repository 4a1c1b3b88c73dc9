//! What kinds of file there are.

/// What a file is, and so how it writes quantities.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// A model: quantities are strings with their unit.
    Model,
    /// A measurement set: quantities are bare SI numbers, or strings with their unit.
    MeasurementSet,
    /// A campaign: keys of models, with values as models write them.
    Campaign,
    /// An import: options of a command as strings.
    Import,
}

impl FileKind {
    /// What messages call it, with its article.
    pub(super) fn noun(self) -> &'static str {
        match self {
            Self::Model => "a model",
            Self::MeasurementSet => "a measurement set",
            Self::Campaign => "a campaign",
            Self::Import => "an import",
        }
    }
}
