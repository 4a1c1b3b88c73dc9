//! What the diagnosis of a bed of grains has to know of an effect.

use engine::grains::Space;
use engine::params::ParamSpec;

/// Whether the diagnosis of a bed looks for an effect that the model does not have.
#[derive(Clone, Copy)]
pub enum Candidacy {
    /// It is.
    Candidate(Candidate),
    /// It is not, for this reason.
    None(&'static str),
}

/// An effect that a bed of grains may lack, with one amplitude that is 0 where it is absent.
#[derive(Clone, Copy)]
pub struct Candidate {
    /// What the amplitude is, for a report.
    pub amplitude: &'static str,
    /// Amplitude with which impacts are screened: about what one would look for.
    pub screen: f64,
    /// Least and greatest amplitude that is searched.
    pub range: (f64, f64),
    /// What it takes to tell it from the candidates that look like it.
    pub separable_from: &'static str,
    /// Candidates that do the same below the surface and differ before first contact alone; a pair is listed with
    /// one of the two.
    pub alike_below: &'static [&'static str],
    /// What a model must have for it to act.
    pub needs: &'static [Need],
    /// The parameters (SI) at an amplitude, in a bed of such grains; the others have their defaults.
    pub params: fn(&MeanGrain, f64) -> Vec<(&'static str, f64)>,
}

/// The mean grain of a bed: what amplitudes in weights count in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanGrain {
    /// (m).
    pub radius: f64,
    /// (N).
    pub weight: f64,
    /// (m³), of a sphere of that radius.
    pub volume: f64,
}

/// What an effect needs to act.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Need {
    /// Grains in a plane; with the reason why spheres do not have the effect.
    Discs(&'static str),
    /// Grains in space; with the reason why discs do not have it.
    Spheres(&'static str),
    /// Gravity: the amplitude is in weights.
    Gravity,
    /// A contact law with elastic constants.
    HertzLaw,
    /// A contact law that has not got this parameter already.
    LawWithout(&'static str),
}

impl Need {
    /// Why it is not met by a bed of this space and gravity (m/s²) under a contact law with these parameters.
    #[must_use]
    pub fn unmet(
        self,
        space: Space,
        gravity: f64,
        contact_law: &[ParamSpec],
    ) -> Option<&'static str> {
        let has = |key: &str| contact_law.iter().any(|spec| spec.key == key);
        match self {
            Self::Discs(why) => (space == Space::Spatial).then_some(why),
            Self::Spheres(why) => (space == Space::Planar).then_some(why),
            Self::Gravity => {
                (gravity <= 0.0).then_some("its amplitude is in weights, and there is no gravity")
            }
            Self::HertzLaw => (!has("young_modulus"))
                .then_some("it acts on a Hertz law, and the contact law has no elastic constants"),
            Self::LawWithout(key) => has(key).then_some("the contact law has it"),
        }
    }
}
