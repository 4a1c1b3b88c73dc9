//! Impacts of a disc on a small planar bed, for trends that other groups published of discs and spheres.
//!
//! Grains and law are those of Wang, Ye & Zheng (2012) as printed; the disc is half as wide as theirs and as heavy
//! for its area, 4.6 mean grains across.

use std::path::PathBuf;
use std::sync::Arc;

use configs::{LoadOptions, Model, ModelSource, find_shipped};
use runner::beds::{Job, Record};

use super::laboratory::Laboratory;
use super::row::PublishedError;

/// Diameter of the disc (m).
pub const DIAMETER: f64 = 0.0223;

/// Width of the bed (m): 70 mean grains.
const WIDTH: f64 = 0.3395;

/// Places away from both sides, as shares of the width: 4.3 diameters of the disc and more from them.
pub const PLACES: [f64; 3] = [0.35, 0.5, 0.65];

/// What a disc falls on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bed {
    /// 3 000 grains, nine diameters of the disc deep.
    Deep,
    /// 1 040 grains, three diameters deep.
    Shallow,
    /// As deep, settled and hit without friction.
    Frictionless,
}

/// An impact straight down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fall {
    /// What it falls on.
    pub bed: Bed,
    /// (m/s).
    pub speed: f64,
    /// Distance of its axis from the left side (m).
    pub x: f64,
}

impl Fall {
    /// At `speed` (m/s) on every one of [`PLACES`] of a bed.
    pub fn everywhere(bed: Bed, speed: f64) -> [Self; 3] {
        PLACES.map(|share| Self { bed, speed, x: share * WIDTH })
    }

    /// At `speed` (m/s) on a deep bed, with `gap` (m) between the disc and the left, then the right side.
    pub fn beside(speed: f64, gap: f64) -> [Self; 2] {
        let x = 0.5 * DIAMETER + gap;
        [x, WIDTH - x].map(|x| Self { bed: Bed::Deep, speed, x })
    }

    fn job(&self) -> Result<Job, PublishedError> {
        let (counts, height) = match self.bed {
            Bed::Deep | Bed::Frictionless => ([2520, 480], 202),
            Bed::Shallow => ([874, 166], 70),
        };
        let mut sets = vec![
            format!("bed.grains.0.count={}", counts[0]),
            format!("bed.grains.1.count={}", counts[1]),
            format!("bed.target_height=\"{height} mm\""),
            format!("container.width=\"{WIDTH} m\""),
            format!("intruder.diameter=\"{DIAMETER} m\""),
            // A quarter of 32.2 g.
            "intruder.mass=\"8.05 g\"".to_owned(),
            format!("impact.speed=\"{:?} m/s\"", self.speed),
            format!("impact.x=\"{:?} m\"", self.x),
            "run.duration=\"1 s\"".to_owned(),
        ];
        if self.bed == Bed::Frictionless {
            let keys = ["bed.preparation_friction", "contact_law.friction"];
            sets.extend(keys.map(|key| format!("{key}=0.0")));
        }
        let source = find_shipped("vertical-2d").map(ModelSource::Shipped);
        let source = source.unwrap_or_else(|| ModelSource::Path(PathBuf::from("vertical-2d")));
        let options = LoadOptions { sets, ..LoadOptions::default() };
        let model = Arc::new(Model::load(source, &options)?.model);
        // A tenth of a second and more, at every speed.
        Ok(Job { bed: Arc::clone(&model), model, expected: 0.15, settles: false })
    }
}

/// What came of `falls`, in their order; none of one that did not run to its end, or is not there yet.
///
/// # Errors
/// If a bed or an impact cannot be run.
pub fn impacts(
    laboratory: &Laboratory<'_>,
    falls: &[Fall],
) -> Result<Vec<Option<Record>>, PublishedError> {
    let jobs = falls.iter().map(Fall::job).collect::<Result<Vec<_>, _>>()?;
    Ok(laboratory.impacts(&jobs)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drop_beside_a_side_leaves_the_gap_and_those_elsewhere_are_far_from_both() {
        let [left, right] = Fall::beside(1.0, 0.25 * DIAMETER);
        // Sums of a few rounded decimals.
        assert!((left.x - 0.75 * DIAMETER).abs() < 1e-15);
        assert!((WIDTH - right.x - 0.75 * DIAMETER).abs() < 1e-15);
        for fall in Fall::everywhere(Bed::Deep, 1.0) {
            let nearest = fall.x.min(WIDTH - fall.x);
            assert!(nearest > 4.3 * DIAMETER, "{fall:?}");
            fall.job().expect("a model");
        }
    }

    #[test]
    fn only_the_bed_without_friction_has_none() {
        for (bed, expected) in
            [(Bed::Deep, 0.28_f64), (Bed::Shallow, 0.28), (Bed::Frictionless, 0.0)]
        {
            let [fall, ..] = Fall::everywhere(bed, 1.0);
            let job = fall.job().expect("a model");
            let toml = job.model.resolved_toml();
            let frictions = toml.lines().filter_map(|line| line.split_once("friction = "));
            let frictions: Vec<f64> =
                frictions.filter_map(|(_, value)| value.trim().parse().ok()).collect();
            // Of the rain and of the contacts, at least.
            assert!(frictions.len() > 1, "{bed:?}: {frictions:?}");
            assert!(
                frictions.iter().all(|one| one.to_bits() == expected.to_bits()),
                "{bed:?}: {frictions:?}"
            );
        }
    }
}
