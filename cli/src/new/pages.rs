//! The pages of `docs/`, which models, templates and messages point to.

/// Their names and texts.
pub(super) const PAGES: [(&str, &str); 17] = [
    ("beds.md", include_str!("../../../docs/beds.md")),
    ("beyond-the-list.md", include_str!("../../../docs/beyond-the-list.md")),
    ("campaigns.md", include_str!("../../../docs/campaigns.md")),
    ("diagnosis.md", include_str!("../../../docs/diagnosis.md")),
    ("energy-ledger.md", include_str!("../../../docs/energy-ledger.md")),
    ("grain-diagnosis.md", include_str!("../../../docs/grain-diagnosis.md")),
    ("measurement-sets.md", include_str!("../../../docs/measurement-sets.md")),
    ("missing-force.svg", include_str!("../../../docs/missing-force.svg")),
    ("output-files.md", include_str!("../../../docs/output-files.md")),
    ("performance.md", include_str!("../../../docs/performance.md")),
    ("promises.md", include_str!("../../../docs/promises.md")),
    ("real-drops.md", include_str!("../../../docs/real-drops.md")),
    ("s1-signatures.svg", include_str!("../../../docs/s1-signatures.svg")),
    ("s1-vertical-signatures.svg", include_str!("../../../docs/s1-vertical-signatures.svg")),
    ("tour.md", include_str!("../../../docs/tour.md")),
    ("user-effects.md", include_str!("../../../docs/user-effects.md")),
    ("validation.md", include_str!("../../../docs/validation.md")),
];

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::ffi::OsString;

    use super::*;

    #[test]
    fn every_page_and_its_figures_are_there() -> std::io::Result<()> {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs");
        let names = std::fs::read_dir(folder)?.map(|entry| Ok(entry?.file_name()));
        let names = names.collect::<std::io::Result<BTreeSet<OsString>>>()?;
        let is_text = |name: &OsString| {
            let name = name.to_string_lossy();
            name.ends_with(".md") || name.ends_with(".svg")
        };
        let wanted: BTreeSet<_> = names.into_iter().filter(is_text).collect();
        let written: BTreeSet<_> = PAGES.iter().map(|(name, _)| OsString::from(name)).collect();
        assert_eq!(written, wanted);
        Ok(())
    }
}
