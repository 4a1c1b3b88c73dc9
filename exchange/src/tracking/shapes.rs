//! Words for the shapes of bodies.

use intruders::{SHAPES, ShapeEntry};

/// Shapes of bodies whose paths show first contact.
fn tracked() -> impl Iterator<Item = &'static ShapeEntry> {
    SHAPES.iter().copied().filter(|entry| entry.measured.tip.is_some())
}

/// The shape that a word is for, as people write it in other languages too.
pub(super) fn shape_of(word: &str) -> Option<&'static ShapeEntry> {
    let lower = word.trim().to_lowercase();
    tracked().find(|entry| entry.name == lower || entry.measured.words.contains(&lower.as_str()))
}

/// The shapes, for messages.
pub(super) fn known() -> String {
    format!("known: {}", tracked().map(|entry| entry.name).collect::<Vec<_>>().join(", "))
}
