//! The shapes that plunge drops into sand, each in a file of its own and one line of [`SHAPES`].

mod body;
mod chain;
mod cone;
mod cylinder;
mod equations;
mod hemisphere;
mod hinged_links;
mod link;
mod measured;
mod outline;
mod parry_surface;
mod registry;
mod rod;
mod shaft;
mod specs;
mod sphere;
mod two_link_chain;

pub use body::{Body, Drawing};
pub use hinged_links::HingedLinks;
pub use measured::{Measured, TipForm};
pub use registry::{AssemblyRequest, Launchable, ShapeEntry, UnderShaft};

/// Every shape, in the order of the docs.
pub static SHAPES: &[&ShapeEntry] = &[
    &sphere::DISC,
    &sphere::SPHERE,
    &cylinder::CYLINDER,
    &hemisphere::HEMISPHERE,
    &cone::CONE,
    &link::LINK,
    &two_link_chain::TWO_LINK_CHAIN,
];

/// The names of all shapes.
pub fn names() -> Vec<&'static str> {
    SHAPES.iter().map(|entry| entry.name).collect()
}

/// The shapes that may have a shaft, in words.
pub fn with_shafts() -> String {
    let names = SHAPES.iter().filter(|entry| entry.under_shaft.is_some()).map(|entry| entry.name);
    let names: Vec<&str> = names.collect();
    match names.split_last() {
        Some((last, [])) => format!("a {last}"),
        Some((last, others)) => format!("a {} or {last}", others.join(", ")),
        None => "no shape".to_owned(),
    }
}

/// The shape called `name`.
pub fn find(name: &str) -> Option<&'static ShapeEntry> {
    SHAPES.iter().find(|entry| entry.name == name).copied()
}
