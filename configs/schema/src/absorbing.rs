//! The layers that absorb, where a model does not say how thick and how strong they are.

use std::f64::consts::PI;

use engine::boundary::Layer;
use engine::contact::{Encounter, Partner};

use crate::guess::guessed_packing;
use crate::model::{BedSource, BottomKind, Container, GrainModel, SidesKind};

/// Thickness of a layer, in mean grain diameters.
const THICKNESS: f64 = 8.0;

/// Rounds in which the speed of a collision is found that loads a contact like the bed does. A round of
/// a Hertz contact leaves a fifth of the error.
const ROUNDS: usize = 30;

/// The layers of `model`; without damping where neither the model says how strong it is nor the law how
/// long a collision lasts, which the checks refuse.
pub(crate) fn layer(model: GrainModel<'_>) -> Layer {
    let container = &model.medium.container;
    let thickness =
        container.absorbing_thickness.unwrap_or_else(|| THICKNESS * MeanGrain::of(model).diameter);
    match container.absorbing_rate {
        Some(rate) => Layer { thickness, rate },
        None => Layer::for_waves(thickness, wave_speed(model).unwrap_or(0.0)),
    }
}

/// The drag of a layer at its wall (1/s), where `model` has any.
pub(crate) fn largest_rate(model: GrainModel<'_>) -> Option<f64> {
    let Container { sides, bottom, .. } = &model.medium.container;
    let absorbs = *sides == SidesKind::Absorbing || *bottom == BottomKind::Absorbing;
    absorbs.then(|| layer(model).rate).filter(|rate| *rate > 0.0)
}

/// Speed (m/s) of a long wave along a chain of mean grains, c = d √(k/m); `None` if the law does not say
/// how long a collision lasts.
///
/// The stiffness k is that of a collision, k = m* (π/T)². For a law whose stiffness depends on the load,
/// it is the collision whose greatest force v √(k m*) is the mean load of a contact at half the height of
/// the bed, m g h/(2 d): an estimate, good to some ten percent.
pub(crate) fn wave_speed(model: GrainModel<'_>) -> Option<f64> {
    let grain = MeanGrain::of(model);
    let law = &model.medium.contact_law;
    let stage = (law.entry.build)(&law.params);
    let mass_eff = 0.5 * grain.mass;
    let load = grain.mass * model.medium.gravity * (0.5 * grain.layers).max(1.0);
    let rate_at = |speed: f64| {
        let encounter = Encounter { mass_eff, radius_eff: 0.25 * grain.diameter, speed };
        stage.collision_time(Partner::Grain, &encounter).map(|time| PI / time)
    };
    let mut speed = 1e-2;
    for _ in 0..ROUNDS {
        let rate = rate_at(speed)?;
        if load > 0.0 {
            speed = load / (mass_eff * rate);
        }
    }
    let stiffness = mass_eff * rate_at(speed)?.powi(2);
    Some(grain.diameter * (stiffness / grain.mass).sqrt())
}

/// What the grains of a bed are on average.
struct MeanGrain {
    /// (m).
    diameter: f64,
    /// (kg).
    mass: f64,
    /// About how many lie above each other (–).
    layers: f64,
}

impl MeanGrain {
    fn of(model: GrainModel<'_>) -> Self {
        let space = model.medium.space;
        let n = model.n_grains() as f64;
        let (mass, content) = match &model.medium.bed.source {
            BedSource::Settle(settle) => settle.grains.iter().fold((0.0, 0.0), |sum, kind| {
                (sum.0 + kind.total_mass(space), sum.1 + kind.count as f64 * kind.content(space))
            }),
            BedSource::Csv(csv) => csv.grains.iter().fold((0.0, 0.0), |sum, grain| {
                (sum.0 + grain.mass, sum.1 + space.grain_content(2.0 * grain.radius))
            }),
        };
        let base = model.medium.container.without_layers().base_area(space);
        let diameter = model.mean_grain();
        let height = content / (guessed_packing(space) * base);
        Self { diameter, mass: mass / n, layers: height / diameter }
    }
}
