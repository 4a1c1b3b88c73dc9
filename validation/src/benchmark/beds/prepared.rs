//! Beds that are prepared otherwise than those of the model that is diagnosed.

use configs::{BedSource, Change, GrainKind, GrainModel, Material};
use diagnosis::beds::Variation;
use engine::bed::SizeDistribution;

/// How the measured bed was prepared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Prepared {
    /// As that of the model.
    Alike,
    /// With 2.2 times its friction.
    Rough,
    /// With 0.3 times its friction.
    Smooth,
    /// With three times the damping of contacts while it settles: a viscous rain.
    Damped,
    /// Grains hardly roll while it settles.
    Unrolling,
    /// Tapped until it is denser by 0.01.
    Tapped,
    /// Of grains with a spread of sizes, of the same mean mass.
    Spread,
}

/// Factors on the preparation friction, and on the damping.
pub(super) const ROUGH: f64 = 2.2;
pub(super) const SMOOTH: f64 = 0.3;
pub(super) const DAMPED: f64 = 3.0;

/// Rolling friction while it settles.
pub(super) const UNROLLING: f64 = 0.12;

/// Packing fraction that taps are to reach: that of the beds of the model is 0.83.
const TAPPED: f64 = 0.845;

/// Half of the width of the spread of diameters, relative.
pub(super) const SPREAD: f64 = 0.15;

impl Prepared {
    /// Every one.
    pub const ALL: [Self; 7] = [
        Self::Alike,
        Self::Rough,
        Self::Smooth,
        Self::Damped,
        Self::Unrolling,
        Self::Tapped,
        Self::Spread,
    ];

    /// What it is called.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Alike => "bed alike",
            Self::Rough => "rougher bed",
            Self::Smooth => "smoother bed",
            Self::Damped => "damped rain",
            Self::Unrolling => "grains that hardly roll while settling",
            Self::Tapped => "tapped bed",
            Self::Spread => "spread of sizes",
        }
    }

    /// The change of `model` that prepares it so; nothing of it acts during the impact.
    pub(super) fn variation(self, model: GrainModel<'_>) -> Variation {
        let BedSource::Settle(settle) = &model.medium.bed.source else {
            return Variation::default();
        };
        let friction = settle.preparation_friction.unwrap_or(0.0);
        match self {
            Self::Alike => Variation::default(),
            Self::Rough => Variation::before(Change::PreparationFriction(ROUGH * friction)),
            Self::Smooth => Variation::before(Change::PreparationFriction(SMOOTH * friction)),
            Self::Damped => {
                let damping = |factor: f64| {
                    ["normal_damping_rate", "tangential_damping_rate"].map(|key| {
                        let own = model.medium.contact_law.params.get(key);
                        Change::ContactLaw(key, factor * own)
                    })
                };
                Variation { before: damping(DAMPED).to_vec(), during: damping(1.0).to_vec() }
            }
            Self::Unrolling => {
                let rolling = vec![("rolling_friction", UNROLLING)];
                Variation::before(Change::BedEffect("rolling-resistance", rolling))
            }
            Self::Tapped => Variation::before(Change::TargetPackingFraction(TAPPED)),
            Self::Spread => {
                Variation::before(Change::Grains(settle.grains.iter().map(spread).collect()))
            }
        }
    }
}

/// `kind` with diameters that are spread evenly around its own, of the same mass per area.
fn spread(kind: &GrainKind) -> GrainKind {
    let diameter = kind.sizes.moment(1);
    let density = match kind.material {
        Material::Density(density) => density,
        Material::Mass(mass) => mass / (std::f64::consts::FRAC_PI_4 * diameter * diameter),
    };
    // The mean square of a uniform spread is larger by a third of the square of its half width.
    let diameter = diameter / (1.0 + SPREAD * SPREAD / 3.0).sqrt();
    let sizes = SizeDistribution::Uniform {
        min: (1.0 - SPREAD) * diameter,
        max: (1.0 + SPREAD) * diameter,
    };
    GrainKind { count: kind.count, sizes, material: Material::Density(density) }
}
