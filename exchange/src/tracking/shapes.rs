//! Words for the shapes of bodies.

/// The shape that a word is for, as people write it in other languages too.
pub(super) fn shape_of(word: &str) -> Option<&'static str> {
    const SHAPES: [(&str, &[&str]); 5] = [
        ("sphere", &["ball", "kugel", "sphère", "bille", "esfera", "spherical", "bead"]),
        ("disc", &["disk", "scheibe", "disque", "disco"]),
        ("cylinder", &["zylinder", "cylindre", "cilindro"]),
        ("hemisphere", &["halbkugel", "hémisphère"]),
        ("cone", &["kegel", "cône", "cono"]),
    ];
    let lower = word.trim().to_lowercase();
    let is_it =
        |(shape, others): &&(&str, &[&str])| *shape == lower || others.contains(&lower.as_str());
    SHAPES.iter().find(is_it).map(|(shape, _)| *shape)
}

/// The shapes, for messages.
pub(super) const SHAPES_KNOWN: &str = "known: sphere, disc, cylinder, hemisphere, cone";
