//! The measurement set to start from.

/// Names and texts of the files of a commented set with invented numbers.
pub const TEMPLATE: [(&str, &str); 3] = [
    ("measurement.toml", include_str!("../../templates/measurement.toml")),
    ("runs.csv", include_str!("../../templates/runs.csv")),
    ("trajectories.csv", include_str!("../../templates/trajectories.csv")),
];

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::MeasurementSet;

    #[test]
    fn the_template_is_a_set_that_reads_without_a_warning() {
        let folder = tempfile::tempdir().expect("a folder");
        for (name, text) in TEMPLATE {
            fs::write(folder.path().join(name), text).expect("a file");
        }
        let loaded = MeasurementSet::load(folder.path()).expect("a set");
        assert!(loaded.warnings.is_empty(), "{}", loaded.describe());
        let set = &loaded.set;
        assert_eq!((set.conditions.len(), set.runs.len()), (4, 12));
        // What the camera counted upward in millimetres is depth in metres.
        let deepest = |run: &crate::Run| run.frames.last().map_or(0.0, |last| last.z);
        assert!(set.runs.iter().all(|run| (0.02..0.08).contains(&deepest(run))));
        assert!(set.runs.iter().all(|run| run.frames[0].t < 0.0), "readings before contact");
    }
}
