//! What the frames of a set say of the numbers that it states, as tables and JSON have it.

use crate::MeasurementSet;
use crate::contact::definitions::{self, Held, Outcome, Scalar};
use crate::contact::zeros::Zeros;
use crate::document::Document;

/// What the frames of a set say of its zeros, its speeds and its definitions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Agreement {
    /// Zero of depth and clock, speed at contact.
    pub zeros: Zeros,
    /// Stopping times, final depths and final ranges.
    pub held: Vec<Held>,
}

impl Agreement {
    /// Over grains of the diameter `grains` (m), where the set states none.
    pub(crate) fn of(set: &MeasurementSet, grains: f64, document: &Document) -> Self {
        let is_stated = document.definitions.map(|place| place.is_some());
        Self { zeros: Zeros::over_grains(set, grains), held: definitions::hold(set, is_stated) }
    }

    /// As lines for a terminal; empty where the set has no frames that say anything.
    pub fn describe(&self, set: &MeasurementSet) -> String {
        let mut text = self.describe_zeros(set);
        for held in &self.held {
            text.push_str(&describe_held(held));
        }
        text
    }

    fn describe_zeros(&self, set: &MeasurementSet) -> String {
        let contacts = &self.zeros.contacts;
        let depths: Vec<f64> = contacts
            .iter()
            .filter_map(|one| one.contact.depth_at_zero)
            .map(|depth| 1e3 * depth.value)
            .collect();
        if depths.is_empty() {
            return String::new();
        }
        let (least, most) = ends(&depths);
        let (n, all) = (depths.len(), set.runs.len());
        let mut text = format!(
            "zeros, as the frames around first contact show them ({n} of {all} runs)\n  \
             depth of free fall at t = 0: {least:.2} to {most:.2} mm (stated: 0)\n"
        );
        let seen = |one: &&crate::RunContact| one.contact.between.iter().all(|t| t.is_finite());
        let times: Vec<f64> =
            contacts.iter().filter(seen).map(|one| 1e3 * one.contact.time.value).collect();
        if !times.is_empty() {
            let (least, most) = ends(&times);
            text.push_str(&format!(
                "  departure from free fall: {least:.1} to {most:.1} ms (stated: 0; {} runs)\n",
                times.len()
            ));
        }
        let ratios: Vec<f64> = self.zeros.speeds.iter().map(|one| one.ratio.value).collect();
        if !ratios.is_empty() {
            let (least, most) = ends(&ratios);
            text.push_str(&format!(
                "  speed at contact over the stated one: {least:.3} to {most:.3}\n"
            ));
        }
        text
    }
}

fn ends(numbers: &[f64]) -> (f64, f64) {
    let fold = |of: fn(f64, f64) -> f64, start| numbers.iter().copied().fold(start, of);
    (fold(f64::min, f64::INFINITY), fold(f64::max, f64::NEG_INFINITY))
}

/// A number by its definitions: how far they miss it, and which it follows.
fn describe_held(held: &Held) -> String {
    let unit = held.scalar.unit();
    let mut text = format!(
        "{} against the trajectories ({} runs): {}\n  {:<17}{:>18}{:>12}\n",
        held.scalar.plural(),
        held.runs,
        held.outcome_in_words(),
        "definition",
        "off by",
        "limit"
    );
    for (index, miss) in held.misses.iter().enumerate() {
        let role = match (index, held.is_stated) {
            (0, true) => "stated",
            (0, false) => "assumed",
            _ => "",
        };
        let off = format!("{:+.2} ± {:.2} {unit}", 1e3 * miss.mean.value, 1e3 * miss.mean.se);
        let limit = format!("{:.2} {unit}", 1e3 * miss.limit);
        let line = format!("  {:<17}{off:>18}{limit:>12}  {role}", miss.definition);
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

impl Scalar {
    /// Its column in the table of runs.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Self::StopTime => "stop_time",
            Self::FinalDepth => "final_z",
            Self::FinalRange => "final_x",
        }
    }

    /// The key of its definition.
    #[must_use]
    pub(crate) fn definition_key(self) -> &'static str {
        match self {
            Self::StopTime => "stop_definition",
            Self::FinalDepth | Self::FinalRange => "final",
        }
    }

    /// What a thousandth of its SI unit is called.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::StopTime => "ms",
            Self::FinalDepth | Self::FinalRange => "mm",
        }
    }

    /// What messages call many of them.
    #[must_use]
    pub fn plural(self) -> &'static str {
        match self {
            Self::StopTime => "stopping times",
            Self::FinalDepth => "final depths",
            Self::FinalRange => "final ranges",
        }
    }
}

impl Held {
    /// What follows, as a clause.
    pub(crate) fn outcome_in_words(&self) -> String {
        let own = self.misses.first().map_or("", |miss| miss.definition);
        match self.outcome {
            Outcome::Follows => format!("they follow `{own}`"),
            Outcome::Untold => "they agree with every definition within the noise".to_owned(),
            Outcome::FollowsOther(other) => format!("they follow `{other}`, not `{own}`"),
            Outcome::FollowsNone => "they follow no definition".to_owned(),
            Outcome::Near => "they follow no definition exactly".to_owned(),
        }
    }

    /// What follows, as a word.
    pub fn outcome_key(&self) -> &'static str {
        match self.outcome {
            Outcome::Follows => "follows",
            Outcome::Untold => "not-told-apart",
            Outcome::FollowsOther(_) => "follows-another",
            Outcome::FollowsNone => "follows-none",
            Outcome::Near => "near",
        }
    }
}
