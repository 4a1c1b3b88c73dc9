//! The bed before the physics: the measured bed is held against that of the model, and the model is prepared to it.
//!
//! What a set states of its bed decides how heavy the grains are and how densely they lie. A packing fraction that is not
//! stated is a parameter with a prior, as every fit has it.

use configs::{BedSource, Change, GrainModel};
use engine::grains::Space;
use measurements::{Geometry, MeasurementSet};
use runner::CampaignError;
use runner::beds::{Impacts, Lie};

use super::bed_model::BedModel;
use super::error::BedError;
use super::variation::Variation;
use crate::forward::Prior;
use crate::verdict::ApparatusError;

/// Standard deviations where a set states none.
pub mod defaults {
    /// Packing fraction that is not stated, around that of the model.
    pub const PACKING: f64 = 0.01;
    /// Packing fraction that is stated without an error.
    pub(crate) const STATED_PACKING: f64 = 0.005;
    /// Bulk density, relative.
    pub const DENSITY: f64 = 0.02;
    /// Height of the surface, and mean diameter of the grains, relative.
    pub const LENGTH: f64 = 0.01;
    /// Coordination number.
    pub const COORDINATION: f64 = 0.1;
}

/// A difference of so many standard errors is named; the model is prepared to a packing fraction from fewer on.
const NAMED: f64 = 4.0;
const WORTH_IT: f64 = 2.0;

/// Standard errors by which data may move a shared parameter from what is known of it, before it explains nothing by
/// itself: once in a hundred such fits, as [`ALPHA`](crate::diagnose::ALPHA) has it, they do so by chance.
const STRAINED: f64 = 2.576;

/// Share of its prior's standard deviation above which the standard error of a parameter says that data tell nothing of it.
const UNMOVED: f64 = 0.95;

/// Ratio of the densities of two beds beyond which one is in another unit.
const ABSURD: f64 = 5.0;

/// Beds of one preparation that are looked at.
const BEDS: usize = 3;

/// Beds are prepared until their packing fraction is this near to what is stated, or so often.
const NEAR: f64 = 0.001;
const TRIALS: usize = 5;

/// Drag while looser beds settle and while the loosest do, in √(g/d): under the latter grains sink by half their diameter in
/// the time in which they would fall through it.
const DRAG: (f64, f64) = (0.5, 1.5);

/// Preparation friction of looser beds, in that of the model, and in a model that settles without.
const ROUGHER: f64 = 3.0;
const ROUGH: f64 = 0.3;

/// What there is to do where a bed explains the measurements that the set does not describe.
pub(super) const UNTOLD: &str = "an effect may look like a bed of another packing fraction: state that of the bed as \
                                 `packing_fraction` under `[bed]` to tell them apart";

/// How a model is prepared to a set.
#[derive(Clone, Debug, Default)]
pub(super) struct Preparation {
    /// What changes in the model.
    pub(super) changes: Vec<Change>,
    /// By what the measured bed differs from that of the model as it was.
    pub(super) differences: Vec<ApparatusError>,
    /// The same in sentences, and what was done about it.
    pub(super) sentences: Vec<String>,
    /// What is known of the packing fraction of the measured bed less that of the prepared model.
    pub(super) packing: Option<Prior>,
    /// Whether that is assumed, since the set does not state it.
    pub(super) is_assumed: bool,
    /// Packing fraction of the prepared model less that of the model as it was.
    pub(super) moved: f64,
}

/// Mean and standard error of several beds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Known {
    pub(super) value: f64,
    pub(super) se: f64,
}

impl Known {
    pub(super) fn of(beds: &[Lie], number: fn(&Lie) -> f64) -> Self {
        let n = beds.len().max(1) as f64;
        let value = beds.iter().map(number).sum::<f64>() / n;
        let squares = beds.iter().map(|one| (number(one) - value).powi(2)).sum::<f64>();
        Self { value, se: (squares / (n * (n - 1.0).max(1.0))).sqrt() }
    }

    fn stated(value: Option<f64>, sigma: Option<f64>, otherwise: f64) -> Option<Self> {
        value.map(|value| Self { value, se: sigma.unwrap_or(otherwise) })
    }

    /// Itself less `other`.
    fn less(self, other: Self) -> Self {
        Self { value: self.value - other.value, se: libm::hypot(self.se, other.se) }
    }

    fn is_beyond(self, errors: f64) -> bool {
        self.value.abs() >= errors * self.se && self.value != 0.0
    }

    fn named(self, id: &str, unit: &str) -> ApparatusError {
        ApparatusError {
            id: id.to_owned(),
            of: None,
            value: self.value,
            se: Some(self.se),
            unit: unit.to_owned(),
            prior_sigma: None,
            named: self.is_beyond(NAMED),
        }
    }
}

impl Preparation {
    /// Of `bed_model` to its set; beds are prepared where the set says how its bed lies.
    pub(super) fn of(bed_model: &BedModel<'_>, place: &dyn Impacts) -> Result<Self, BedError> {
        let mut all = Self::default();
        let plain = lies(bed_model, place, &Variation::default())?;
        let Some(plain) = plain.filter(|beds| !beds.is_empty()) else { return Ok(all) };
        let packing = all.compare(bed_model, &plain)?;
        let is_given = matches!(bed_model.grains().medium.bed.source, BedSource::Csv(_));
        let Some(stated) = packing else {
            if is_given {
                all.sentences.push(
                    "the bed of the model is a table of grains, and the set states no packing fraction: that of the \
                     table is taken for it"
                        .to_owned(),
                );
            } else {
                all.packing = Some(Prior { mean: 0.0, sigma: defaults::PACKING });
                all.is_assumed = true;
                all.sentences.push(format!(
                    "the packing fraction of the bed is not stated: it is taken to be that of the model to {}",
                    defaults::PACKING
                ));
            }
            return Ok(all);
        };
        let own = Known::of(&plain, |one| one.packing_fraction);
        if is_given {
            return Ok(all);
        }
        let mut prepared = own;
        if stated.less(own).is_beyond(WORTH_IT) {
            let found = prepared_to(bed_model, place, (own, stated), &all.changes)?;
            if let Some((changes, lie)) = found {
                all.sentences.push(format!(
                    "the model is prepared to a packing fraction of {:.4} instead of {:.4}: {}",
                    lie.value,
                    own.value,
                    words(&changes)
                ));
                all.changes.extend(changes);
                prepared = lie;
            }
        }
        let left = stated.less(prepared);
        all.packing = Some(Prior { mean: left.value, sigma: left.se.max(1e-4) });
        all.moved = prepared.value - own.value;
        Ok(all)
    }

    /// Holds what the set states against the beds of the model, and makes grains as heavy as they are; the packing
    /// fraction of the measured bed, if it follows from what is stated.
    fn compare(
        &mut self,
        bed_model: &BedModel<'_>,
        beds: &[Lie],
    ) -> Result<Option<Known>, BedError> {
        let set = bed_model.set;
        let stated = &set.bed.stated;
        let own = Known::of(beds, |one| one.packing_fraction);
        let height = Known::of(beds, |one| one.height);
        let measured_height = stated.surface_height.and_then(|value| {
            let sigma = stated.surface_height_sigma;
            Known::stated(Some(value), sigma, defaults::LENGTH * value)
        });
        let packing = packing_of(set).or_else(|| {
            // As many grains as in the model, over the same base.
            measured_height.map(|measured| Known {
                value: own.value * height.value / measured.value,
                se: own.value * measured.se / measured.value,
            })
        });
        if let Some(packing) = packing {
            let difference = packing.less(own);
            let word = if difference.value < 0.0 { "looser" } else { "denser" };
            self.say(difference, ("packing", "1"), |d| {
                format!("{word} than that of the model by {:.4} ± {:.4}", d.value.abs(), d.se)
            });
        }
        if let Some(measured) = measured_height {
            let difference = measured.less(height);
            let word = if difference.value < 0.0 { "lower" } else { "higher" };
            self.say(difference, ("height", "m"), |d| {
                let [by, se] = [d.value.abs(), d.se].map(|length| 1e3 * length);
                format!("{word} than that of the model by {by:.2} ± {se:.2} mm")
            });
        }
        let coordination =
            Known::stated(stated.coordination, stated.coordination_sigma, defaults::COORDINATION);
        if let Some(measured) = coordination {
            let difference = measured.less(Known::of(beds, |one| one.coordination));
            self.say(difference, ("coordination", "1"), |d| {
                format!(
                    "of another coordination number than that of the model: {:+.2} ± {:.2}",
                    d.value, d.se
                )
            });
        }
        let diameter = set.bed.grain_diameter.and_then(|value| {
            Known::stated(Some(value), stated.grain_diameter_sigma, defaults::LENGTH * value)
        });
        if let Some(measured) = diameter {
            let difference = measured.less(Known::of(beds, |one| one.mean_diameter));
            self.say(difference, ("grain-diameter", "m"), |d| {
                let [by, se] = [d.value, d.se].map(|length| 1e3 * length);
                format!("of grains of another mean diameter than those of the model: {by:+.3} ± {se:.3} mm")
            });
        }
        self.weigh(bed_model, (packing, own), Known::of(beds, |one| one.bulk_density))?;
        Ok(packing)
    }

    /// Holds the bulk density of the set against that of the model, `own`.
    fn weigh(
        &mut self,
        bed_model: &BedModel<'_>,
        (packing, lie): (Option<Known>, Known),
        own: Known,
    ) -> Result<(), BedError> {
        let set = bed_model.set;
        let Some(value) = set.bed.bulk_density else {
            let assumed = "the bulk density of the bed is not stated: its grains are taken to be as heavy as those of the model";
            self.sentences.push(assumed.to_owned());
            return Ok(());
        };
        let sigma = set.bed.stated.bulk_density_sigma.unwrap_or(defaults::DENSITY * value);
        let unit = of_one_unit(value, own.value, set.bed.geometry)?;
        let difference = Known { value, se: sigma }.less(own);
        self.say(difference, ("bulk-density", unit), |d| {
            let word = if d.value < 0.0 { "lighter" } else { "heavier" };
            let [by, se] = [d.value.abs(), d.se].map(|density| 1e2 * density / own.value);
            format!("{word} than that of the model by {by:.1} ± {se:.1} %")
        });
        // What does not follow from the packing is the density of the grains.
        let denser =
            packing.map_or(Known { value: 1.0, se: defaults::PACKING / lie.value }, |one| Known {
                value: one.value / lie.value,
                se: one.se / lie.value,
            });
        let ratio = value / own.value / denser.value;
        let error = ratio * libm::hypot(difference.se / value, denser.se / denser.value);
        if (Known { value: ratio - 1.0, se: error }).is_beyond(NAMED) {
            self.sentences
                .push(format!("the grains of the model are made {ratio:.3} times as heavy"));
            if let BedSource::Settle(_) = &bed_model.grains().medium.bed.source {
                self.changes.push(Change::GrainMass(ratio));
            }
        }
        Ok(())
    }

    fn say(
        &mut self,
        difference: Known,
        (id, unit): (&str, &str),
        sentence: impl Fn(Known) -> String,
    ) {
        if difference.is_beyond(NAMED) {
            let errors = difference.value.abs() / difference.se;
            self.sentences
                .push(format!("the measured bed is {} ({errors:.0} σ)", sentence(difference)));
        }
        self.differences.push(difference.named(id, unit));
    }
}

/// The unit of a bulk density of `stated`, where the model's is `own` and both can be meant in it.
fn of_one_unit(stated: f64, own: f64, geometry: Geometry) -> Result<&'static str, BedError> {
    let unit = match geometry {
        Geometry::Planar => "kg/m^2",
        Geometry::Spatial => "kg/m^3",
    };
    match (1.0 / ABSURD..=ABSURD).contains(&(stated / own)) {
        true => Ok(unit),
        false => Err(BedError::Density { stated, own, unit }),
    }
}

/// The packing fraction that `set` states of its bed, or of every condition alike.
fn packing_of(set: &MeasurementSet) -> Option<Known> {
    let stated = &set.bed.stated;
    let of_conditions = || {
        let mut each = set.conditions.iter().map(|one| one.packing);
        let first = each.next()??;
        each.all(|one| one.is_some_and(|one| one.total_cmp(&first).is_eq())).then_some(first)
    };
    let value = stated.packing_fraction.or_else(of_conditions);
    Known::stated(value, stated.packing_fraction_sigma, defaults::STATED_PACKING)
}

/// How a few beds of the model with `variation` lie; `None` where that is no model.
fn lies(
    bed_model: &BedModel<'_>,
    place: &dyn Impacts,
    variation: &Variation,
) -> Result<Option<Vec<Lie>>, BedError> {
    let draws = bed_model.draws(0, BEDS, 1).concat();
    let jobs: Result<Vec<_>, _> =
        draws.iter().map(|&draw| bed_model.job(0, draw, variation)).collect();
    match jobs {
        Ok(jobs) => match place.lies(&jobs) {
            Ok(found) => Ok(Some(found)),
            // Grains that never come to rest are no bed.
            Err(CampaignError::Run(_)) => Ok(None),
            Err(other) => Err(other.into()),
        },
        Err(_) => Ok(None),
    }
}

/// Levels of denser and denser beds, the first of which comes to rest soon. Spheres without friction rattle fifteen times as
/// long as with a tenth of it, and their packing fraction is larger by 0.01; discs come to rest without friction too.
pub(super) fn dense(space: Space) -> &'static [f64] {
    match space {
        Space::Planar => &[-1.0],
        Space::Spatial => &[-0.9, -1.0],
    }
}

/// Changes that prepare `model` at `level`: -1 is the densest bed that settles, 0 the model as it is, 1 a bed with more friction
/// and a little drag, 2 the loosest, whose grains sink as in a viscous fluid. `None` for a model without preparation friction.
pub(super) fn at_level(model: GrainModel<'_>, level: f64) -> Option<Vec<Change>> {
    let BedSource::Settle(settle) = &model.medium.bed.source else { return None };
    let own = settle.preparation_friction?;
    if level <= 0.0 {
        return Some(vec![Change::PreparationFriction(own * (1.0 + level))]);
    }
    let rough = if own > 0.0 { ROUGHER * own } else { ROUGH };
    let (little, most) = DRAG;
    let drag = level.min(1.0) * little + (level - 1.0).max(0.0) * (most - little);
    let rate = drag * (model.medium.gravity / model.mean_grain()).sqrt();
    Some(vec![
        Change::PreparationFriction(own + (rough - own) * level.min(1.0)),
        Change::SettlingDrag(settle.settling_drag + rate),
    ])
}

/// The preparation with which the beds of the model come nearest to the packing fraction `stated`, and their packing
/// fraction, where that is nearer than `own`; `others` change too.
fn prepared_to(
    bed_model: &BedModel<'_>,
    place: &dyn Impacts,
    (own, stated): (Known, Known),
    others: &[Change],
) -> Result<Option<(Vec<Change>, Known)>, BedError> {
    let mut best: Option<(Vec<Change>, Known)> = None;
    let mut look = |changes: Vec<Change>| -> Result<Option<Known>, BedError> {
        let before = [others, &changes[..]].concat();
        let variation = Variation { before, during: Vec::new() };
        let Some(beds) = lies(bed_model, place, &variation)? else { return Ok(None) };
        let lie = Known::of(&beds, |one| one.packing_fraction);
        let off = |lie: Known| (lie.value - stated.value).abs();
        if best.as_ref().map_or(off(own), |(_, best)| off(*best)) > off(lie) {
            best = Some((changes, lie));
        }
        Ok(Some(lie))
    };
    let model = bed_model.grains();
    let is_looser = stated.value < own.value;
    let ends: &[f64] = if is_looser { &[1.0, 2.0] } else { dense(model.medium.space) };
    let (mut near, mut far) = ((0.0, own.value), None);
    for &level in ends {
        let Some(changes) = at_level(model, level) else { return Ok(None) };
        let Some(lie) = look(changes)? else { break };
        if (lie.value - stated.value) * (own.value - stated.value) <= 0.0 {
            far = Some((level, lie.value));
            break;
        }
        near = (level, lie.value);
    }
    let Some(mut far) = far else {
        if !is_looser && at_level(model, -1.0).is_some() {
            let tapped = Change::TargetPackingFraction(stated.value);
            look(at_level(model, -1.0).into_iter().flatten().chain([tapped]).collect())?;
        }
        return Ok(best);
    };
    for _ in 0..TRIALS {
        let level = near.0 + (far.0 - near.0) * (stated.value - near.1) / (far.1 - near.1);
        let Some(changes) = at_level(model, level) else { break };
        let Some(lie) = look(changes)? else { break };
        if (lie.value - stated.value).abs() <= NEAR {
            break;
        }
        match (lie.value - stated.value) * (near.1 - stated.value) > 0.0 {
            true => near = (level, lie.value),
            false => far = (level, lie.value),
        }
    }
    Ok(best)
}

/// What `changes` of the preparation are, for a report.
fn words(changes: &[Change]) -> String {
    let word = |change: &Change| match change {
        Change::PreparationFriction(friction) => format!("preparation friction {friction:.3}"),
        Change::TargetPackingFraction(_) => "taps".to_owned(),
        Change::SettlingDrag(rate) => format!("a drag of {rate:.1}/s while it settles"),
        other => format!("{other:?}"),
    };
    changes.iter().map(word).collect::<Vec<_>>().join(", ")
}

/// Whether `value` is farther from what is known beforehand than one may expect.
pub(super) fn is_far(prior: Prior, value: f64, se: f64) -> bool {
    // Prior and data agree in the posterior mean only as far as either weighs: its variance before the data are seen is
    // what the data take from that of the prior.
    let moved = se.min(UNMOVED * prior.sigma);
    (value - prior.mean).abs() > STRAINED * (prior.sigma.powi(2) - moved.powi(2)).sqrt()
}

/// The differences and what the fit finds of the packing as one list, named where they are beyond their errors. A packing
/// that contradicts what is known of it beforehand is not: then something else acts like it.
pub(super) fn listed(
    preparation: &Preparation,
    mut fitted: Vec<ApparatusError>,
) -> Vec<ApparatusError> {
    for one in &mut fitted {
        let is_possible = preparation
            .packing
            .is_none_or(|prior| !is_far(prior, one.value, one.se.unwrap_or(0.0)));
        one.value += preparation.moved;
        // Unlike an error of the apparatus, another bed is named however small the difference.
        let is_other = one.se.is_some_and(|se| Known { value: one.value, se }.is_beyond(NAMED));
        one.named = is_possible && is_other;
    }
    let others = preparation.differences.iter();
    let others = others.filter(|one| fitted.iter().all(|other| other.id != one.id)).cloned();
    let others: Vec<ApparatusError> = others.collect();
    fitted.extend(others);
    fitted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_packing_that_the_set_rules_out_is_not_named() {
        // Five standard errors from that of the model, in a bed that is weighed and in one that is not.
        let fitted = || Known { value: 0.0086, se: 0.0016 }.named("packing", "1");
        for (sigma, is_named) in [(0.0025, false), (defaults::PACKING, true)] {
            let packing = Some(Prior { mean: 0.0, sigma });
            let preparation = Preparation { packing, ..Preparation::default() };
            let [one] = &listed(&preparation, vec![fitted()])[..] else { panic!("one of one") };
            assert_eq!(one.named, is_named, "{sigma}");
        }
        // Where the model was prepared to another packing, that counts into the difference and not against it.
        let preparation = Preparation {
            packing: Some(Prior { mean: 0.0, sigma: 0.0025 }),
            moved: 0.02,
            ..Preparation::default()
        };
        let still = Known { value: 0.001, se: 0.0016 }.named("packing", "1");
        let [one] = &listed(&preparation, vec![still])[..] else { panic!("one of one") };
        assert!(one.named && (one.value - 0.021).abs() < 1e-12);
    }

    #[test]
    fn a_bulk_density_in_another_unit_is_refused() {
        // Discs of 4.8 mm that weigh what spheres weigh, per volume and per area of the plane.
        let (per_volume, per_area) = (1321.0, 5.1);
        let refused = of_one_unit(per_volume, per_area, Geometry::Planar).unwrap_err();
        assert!(refused.to_string().contains("kg/m^2"), "{refused}");
        assert!(of_one_unit(per_area, per_volume, Geometry::Spatial).is_err());
        for ratio in [0.4, 1.0, 2.5] {
            assert!(of_one_unit(ratio * per_area, per_area, Geometry::Planar).is_ok(), "{ratio}");
        }
    }
}
