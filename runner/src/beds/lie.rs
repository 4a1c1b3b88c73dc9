//! How a prepared bed lies.

use std::path::Path;

use configs::GrainModel;
use engine::bed::BedReport;

use crate::error::CampaignError;
use crate::run::{Control, prepare};

/// What a measurement of a bed at rest would show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lie {
    /// Area (volume) of the grains over base times mean height of the surface (–).
    pub packing_fraction: f64,
    /// Mean height of the surface (m).
    pub height: f64,
    /// Mass of the grains over base times mean height of the surface (kg/m³, planar kg/m²).
    pub bulk_density: f64,
    /// Mean diameter of a grain (m).
    pub mean_diameter: f64,
    /// Mean number of contacts of a grain (–).
    pub coordination: f64,
}

impl Lie {
    /// Of the bed of `model`, which is found or made in `cache`. Nothing if it was stopped.
    pub(super) fn of(
        model: GrainModel<'_>,
        cache: &Path,
        signals: &mut dyn Control,
    ) -> Result<Option<Self>, CampaignError> {
        let Some(prepared) = prepare(model, cache, signals)? else { return Ok(None) };
        let bed = model.bed(&prepared.resting);
        let BedReport { packing_fraction, height, mean_diameter, coordination, .. } =
            BedReport::of(&bed);
        let mass: f64 = bed.grains.mass.iter().sum();
        let base = bed.container().base_area(model.medium.space);
        let bulk_density = mass / (base * height);
        Ok(Some(Self { packing_fraction, height, bulk_density, mean_diameter, coordination }))
    }
}
