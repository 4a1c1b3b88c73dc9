//! What a bed of grains may lack, as a candidate of the simulation with one amplitude.

use std::f64::consts::FRAC_PI_6;

use configs::{BedSource, Change, GrainModel};
use contact_laws::{Candidate, MeanGrain};
use measurements::Bed;
use resistive::Kind;

use super::variation::Variation;

/// A candidate of the simulation.
#[derive(Clone, Copy)]
pub struct BedCandidate {
    /// kebab-case.
    pub id: &'static str,
    /// What it is part of.
    pub kind: Kind,
    /// What the amplitude is, for a report.
    pub amplitude: &'static str,
    /// Amplitude with which impacts are screened: about what one would look for.
    pub screen: f64,
    /// Least and greatest amplitude.
    pub range: (f64, f64),
    /// What it takes to tell it from its confounders.
    pub separable_from: &'static str,
    /// Whether measurements may have it; what only another simulation can have is a candidate where it is named.
    pub of_measurements: bool,
    /// Whether a set says of its bed how large it is; the model is prepared to that, and it is no candidate.
    pub(super) stated_by: Option<fn(&Bed) -> bool>,
    /// What it does to a model.
    pub(super) act: Act,
}

/// What a candidate does to a model.
#[derive(Clone, Copy)]
pub(super) enum Act {
    /// It adds the effect of its name.
    Effect(Candidate),
    /// It changes what the model has.
    Change {
        /// The reason why it is not a candidate for a model; `None` for a candidate.
        lacks: fn(GrainModel<'_>) -> Option<&'static str>,
        /// The model with it.
        change: fn(GrainModel<'_>, f64) -> Variation,
    },
}

impl BedCandidate {
    /// The candidate that adds the effect called `id`.
    pub(super) const fn of_effect(id: &'static str, candidate: Candidate) -> Self {
        Self {
            id,
            kind: Kind::Physics,
            amplitude: candidate.amplitude,
            screen: candidate.screen,
            range: candidate.range,
            separable_from: candidate.separable_from,
            of_measurements: true,
            stated_by: None,
            act: Act::Effect(candidate),
        }
    }

    /// Whether it changes what every bed has, and is no effect of a registry.
    pub fn is_change(&self) -> bool {
        matches!(self.act, Act::Change { .. })
    }

    /// The reason why it is not a candidate for `model`; `None` for a candidate.
    pub fn lacks(&self, model: GrainModel<'_>) -> Option<&'static str> {
        let medium = model.medium;
        match &self.act {
            Act::Effect(Candidate { needs, .. }) => {
                let law = medium.contact_law.entry.params;
                let unmet =
                    needs.iter().find_map(|one| one.unmet(medium.space, medium.gravity, law));
                self.is_in(model).or(unmet)
            }
            Act::Change { lacks, .. } => lacks(model),
        }
    }

    /// What it changes in `model` at the amplitude `q`; nothing at zero.
    pub fn change(&self, model: GrainModel<'_>, q: f64) -> Variation {
        match &self.act {
            _ if q == 0.0 => Variation::default(),
            Act::Effect(Candidate { params, .. }) => {
                Variation::during(Change::Effect(self.id, params(&mean_grain(model), q)))
            }
            Act::Change { change, .. } => change(model, q),
        }
    }

    /// Whether it and the candidate `other` differ before first contact alone.
    pub(super) fn is_alike_below(&self, other: &str) -> bool {
        match &self.act {
            Act::Effect(Candidate { alike_below, .. }) => alike_below.contains(&other),
            Act::Change { .. } => false,
        }
    }

    fn is_in(&self, model: GrainModel<'_>) -> Option<&'static str> {
        let mut laws = model.medium.effects.iter().map(|effect| effect.entry.name);
        let mut forces = model.medium.grain_forces.iter().map(|force| force.entry.name);
        let has = laws.any(|own| own == self.id) || forces.any(|own| own == self.id);
        has.then_some("the model has it")
    }
}

fn mean_grain(model: GrainModel<'_>) -> MeanGrain {
    let space = model.medium.space;
    let (n, diameter, mass) = match &model.medium.bed.source {
        BedSource::Settle(settle) => settle.grains.iter().fold((0.0, 0.0, 0.0), |sum, kind| {
            let count = kind.count as f64;
            let diameter = count * kind.sizes.moment(1);
            (sum.0 + count, sum.1 + diameter, sum.2 + kind.total_mass(space))
        }),
        BedSource::Csv(csv) => csv.grains.iter().fold((0.0, 0.0, 0.0), |sum, grain| {
            (sum.0 + 1.0, sum.1 + 2.0 * grain.radius, sum.2 + grain.mass)
        }),
    };
    let (diameter, mass) = (diameter / n, mass / n);
    let volume = FRAC_PI_6 * diameter * diameter * diameter;
    MeanGrain { radius: 0.5 * diameter, weight: mass * model.medium.gravity, volume }
}
