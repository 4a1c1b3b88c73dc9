//! What data must contain to show an effect, and to tell it from the effects that look like it.

/// What a diagnosis has to know of an effect.
#[derive(Clone, Copy, Debug)]
pub struct Facts {
    /// What it is part of.
    pub kind: Kind,
    /// Unit of the amplitude: "1" where it is a pure number.
    pub unit: &'static str,
    /// What the data must contain for it to act at all.
    pub visible: &'static [Needs],
    /// The effects that look like it, and what tells them apart; a pair is listed with one of the two.
    pub separable_from: &'static [Confounder],
}

/// What an effect is part of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// What the medium does.
    Physics,
    /// How the medium was prepared.
    Preparation,
    /// What holds, moves or sees the intruder.
    Apparatus,
}

impl Kind {
    /// The reason why the diagnosis of a bed of grains does not look for an effect of a force law; `None` for a candidate.
    #[must_use]
    pub fn absent_from_beds(self) -> Option<&'static str> {
        match self {
            Self::Physics => Some("in a bed of grains, the grains do it or do not"),
            Self::Preparation => Some("a bed of grains is prepared itself"),
            Self::Apparatus => None,
        }
    }
}

/// An effect that does nearly the same to the observables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Confounder {
    /// Its name.
    pub effect: &'static str,
    /// Data tell the two apart only if they contain any of these.
    pub any_of: &'static [Needs],
}

/// Something that a measurement set may contain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Needs {
    /// Impacts that are not vertical.
    Oblique,
    /// Impacts at two angles that are not vertical.
    ObliqueAngles,
    /// Impacts that are vertical.
    Vertical,
    /// An intruder that spins.
    Spin,
    /// Spin in the sense of rolling forward, and against it.
    SpinBothWays,
    /// Two packing fractions.
    Packings,
    /// A known depth of the bed.
    BedDepth,
    /// Two depths of the bed.
    BedDepths,
    /// Impact speeds of which the largest is three times the smallest or more.
    Speeds,
    /// A run that ends two diameters deep or more.
    Depths,
    /// A condition whose runs end less than two diameters deep.
    Shallow,
    /// Two masses of the intruder.
    Masses,
    /// Two diameters of the intruder.
    Diameters,
    /// Intruders that are not similar: of two shapes, or of two slendernesses.
    Shapes,
    /// Frames before first contact.
    FramesBeforeImpact,
    /// Two conditions.
    Conditions,
}

impl Needs {
    /// What is needed, as a noun.
    #[must_use]
    pub fn describe(self) -> &'static str {
        match self {
            Self::Oblique => "oblique impacts",
            Self::ObliqueAngles => "two oblique angles",
            Self::Vertical => "vertical impacts",
            Self::Spin => "an intruder that spins",
            Self::SpinBothWays => "spin both ways",
            Self::Packings => "two packing fractions",
            Self::BedDepth => "a known depth of the bed",
            Self::BedDepths => "two depths of the bed",
            Self::Speeds => "impact speeds over a range of 3 or more",
            Self::Depths => "final depths of two diameters or more",
            Self::Shallow => "final depths below two diameters",
            Self::Masses => "two masses",
            Self::Diameters => "two diameters",
            Self::Shapes => "two shapes",
            Self::FramesBeforeImpact => "frames before impact",
            Self::Conditions => "two conditions",
        }
    }
}

impl Confounder {
    /// "yield-stress by two diameters or frames before impact".
    pub fn describe(&self) -> String {
        let needs: Vec<&str> = self.any_of.iter().map(|need| need.describe()).collect();
        format!("{} by {}", self.effect, needs.join(" or "))
    }
}

#[cfg(test)]
mod tests {
    use super::super::{RESISTANCE_LAWS, Role, confounders, find_resistance};
    use super::*;

    fn declared() -> Vec<(&'static str, Confounder)> {
        let of = |role| match role {
            Role::Effect(facts) => facts.separable_from,
            Role::Baseline => &[],
        };
        RESISTANCE_LAWS
            .iter()
            .flat_map(|entry| of(entry.role).iter().map(|confounder| (entry.name, *confounder)))
            .collect()
    }

    #[test]
    fn every_confounder_is_another_effect_and_some_data_tell_the_two_apart() {
        for (name, confounder) in declared() {
            let entry = find_resistance(confounder.effect).unwrap_or_else(|| {
                panic!(
                    "{name} lists the confounder {}, which is not a registered effect",
                    confounder.effect
                )
            });
            assert!(matches!(entry.role, Role::Effect(_)), "{name}: {}", confounder.effect);
            assert_ne!(name, confounder.effect);
            assert!(!confounder.any_of.is_empty(), "{name}: {}", confounder.effect);
        }
    }

    #[test]
    fn a_pair_of_confounders_is_declared_once_and_known_to_both() {
        let pairs = declared();
        for (index, (name, confounder)) in pairs.iter().enumerate() {
            let same = |(other, its): &&(&str, Confounder)| {
                (*other, its.effect) == (*name, confounder.effect)
                    || (*other, its.effect) == (confounder.effect, *name)
            };
            let again = pairs[..index].iter().find(same);
            assert!(again.is_none(), "{name} and {} are declared twice", confounder.effect);
            let back = confounders(confounder.effect).find(|back| back.effect == *name);
            assert_eq!(back.map(|back| back.any_of), Some(confounder.any_of));
            assert!(confounders(name).any(|there| there == *confounder));
        }
    }

    #[test]
    fn what_tells_confounders_apart_reads_as_a_sentence() {
        let confounder = Confounder {
            effect: "lift",
            any_of: &[Needs::ObliqueAngles, Needs::FramesBeforeImpact],
        };
        assert_eq!(confounder.describe(), "lift by two oblique angles or frames before impact");
    }
}
