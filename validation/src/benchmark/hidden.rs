//! What can be hidden in the world: effects of the list, mostly in another form than the list has them,
//! and effects that no list has.

/// Something that nature does beyond the two-term law.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(usize)]
pub enum Hidden {
    /// Drag that grows with a power of the speed near one.
    ViscousDrag,
    /// Cohesion.
    YieldStress,
    /// Friction that saturates with depth.
    Janssen,
    /// Friction with another power of depth.
    DepthExponent,
    /// The floor of a shallow bed.
    BottomWall,
    /// Weight of the displaced bed.
    Buoyancy,
    /// Grains that move along.
    AddedMass,
    /// Force across the path of a spinning sphere, from drag.
    Magnus,
    /// More drag sideways than down.
    AnisotropicDrag,
    /// More friction sideways than down.
    AnisotropicFriction,
    /// Friction that grows with speed.
    RateFriction,
    /// Friction of a guide.
    RailFriction,
    /// Drag of the air.
    AirDrag,
    /// Friction that grows with packing.
    Packing,
    /// Force across the path of a spinning sphere, from friction.
    SpinFriction,
    /// Force out of the bed.
    Lift,
    /// Only the immersed part is loaded.
    Immersion,
    /// Drag that grows with depth.
    DepthDrag,
    /// Gravity that leans.
    Tilt,
    /// A camera whose scale is off.
    CameraScale,
    /// A surface taken where it is not.
    DepthZero,
    /// In no list: a layer with more friction.
    Layer,
    /// In no list: friction that goes up and down with depth.
    Periodic,
    /// In no list: drag with the cube of the speed.
    CubicDrag,
    /// In no list: resistance that fades after contact.
    DecayingPressure,
    /// In no list: a force that comes on at low speed.
    LateForce,
    /// In no list: beds that become stiffer in the course of the campaign.
    Drift,
    /// In no list: a drag that saturates with speed.
    SaturatingDrag,
    /// In no list: friction that depends on the impact angle alone.
    AngleFriction,
    /// In no list: friction that grows with the time since contact.
    Ageing,
    /// In no list: friction on the way along the surface, whatever the depth.
    Furrow,
    /// In no list: friction that jumps at a depth which the diameter sets.
    Step,
    /// In no list: a force that remembers the greatest speed.
    Memory,
}

/// How many there are.
pub(super) const COUNT: usize = Hidden::Memory as usize + 1;

/// Amplitudes by `Hidden as usize`; 0 for what is not there.
pub(super) type Amplitudes = [f64; COUNT];

/// What stands about a hidden effect in the tables, and where its amplitude is looked for.
#[derive(Clone, Copy, Debug)]
pub struct Form {
    /// Which.
    pub hidden: Hidden,
    /// Name in the list of candidates, or of its own.
    pub id: &'static str,
    /// Its law in the world.
    pub law: &'static str,
    /// How that stands to the candidate of the same name.
    pub kinship: Kinship,
    /// Signs that the amplitude may have.
    pub(super) signs: &'static [f64],
    /// A small amplitude, where the search starts.
    pub(super) small: f64,
    /// The greatest: beyond what a laboratory could overlook, and what a candidate may have.
    pub(super) most: f64,
}

/// How a law of the world stands to the list of candidates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kinship {
    /// The formula of the candidate: amplitudes can be compared.
    Same,
    /// The same kind, another formula.
    Other,
    /// In no list.
    Unlisted,
}

const UP: &[f64] = &[1.0];
const DOWN: &[f64] = &[-1.0];
const BOTH: &[f64] = &[1.0, -1.0];

use Kinship::{Other, Same, Unlisted};

/// Every hidden effect, in the order of [`Hidden`].
pub static FORMS: [Form; COUNT] = [
    form(Hidden::ViscousDrag, ("viscous-drag", Other), "q ρ A V_s v (V_s/v)^0.1", (UP, 0.1, 100.0)),
    form(Hidden::YieldStress, ("yield-stress", Same), "q ρ g A D", (UP, 0.1, 200.0)),
    form(Hidden::Janssen, ("janssen", Other), "z → z/(1 + q z/D)", (UP, 0.01, 5.0)),
    form(Hidden::DepthExponent, ("depth-exponent", Same), "z → D (z/D)^(1+q)", (DOWN, 0.02, 0.9)),
    form(
        Hidden::BottomWall,
        ("bottom-wall", Other),
        "q ρ g A D (D/(H−z))², H the depth of the bed",
        (UP, 0.1, 500.0),
    ),
    form(Hidden::Buoyancy, ("buoyancy", Same), "q ρ g V(z), upward", (UP, 0.1, 100.0)),
    form(
        Hidden::AddedMass,
        ("added-mass", Other),
        "m_a = 1.5 q ρ V u²/(1+u²), u = z/D: grains ahead of the sphere, beyond its own volume V",
        (UP, 0.05, 20.0),
    ),
    form(Hidden::Magnus, ("magnus", Same), "q ρ A R ω×v", (BOTH, 0.1, 50.0)),
    form(Hidden::AnisotropicDrag, ("anisotropic-drag", Same), "q C_d ρ A v v_x", (BOTH, 0.05, 5.0)),
    form(
        Hidden::AnisotropicFriction,
        ("anisotropic-friction", Same),
        "q C_f ρ g A z v_x/v",
        (BOTH, 0.05, 5.0),
    ),
    form(
        Hidden::RateFriction,
        ("rate-friction", Other),
        "friction × (1 + q ln(1 + v/0.3 m/s))",
        (UP, 0.02, 20.0),
    ),
    form(Hidden::RailFriction, ("rail-friction", Same), "q newtons, everywhere", (UP, 0.01, 5.0)),
    form(
        Hidden::AirDrag,
        ("air-drag", Same),
        "½ ρ_air q A v², ρ_air = 1.2 kg/m³, everywhere",
        (UP, 10.0, 1000.0),
    ),
    form(Hidden::Packing, ("packing", Other), "friction × exp(q (φ − 0.59))", (UP, 1.0, 60.0)),
    form(Hidden::SpinFriction, ("spin-friction", Same), "q ρ g A z (R/V_s) ω×v̂", (BOTH, 0.1, 50.0)),
    form(
        Hidden::Lift,
        ("lift", Other),
        "q ρ A v² z/(z + D/4), normal to v, fading at steep paths as tanh(5 v_x/v)",
        (UP, 0.02, 10.0),
    ),
    form(
        Hidden::Immersion,
        ("immersion", Other),
        "A → A (1 − q exp(−(2.5 z/D)^1.5)): smoother than the cap, and saturating deeper",
        (UP, 0.05, 1.0),
    ),
    form(Hidden::DepthDrag, ("depth-drag", Other), "C_d (1 + q (1 − e^(−z/D)))", (UP, 0.05, 20.0)),
    form(
        Hidden::Tilt,
        ("tilt", Same),
        "gravity leans by q in the plane of motion",
        (BOTH, 5e-3, 0.5),
    ),
    form(Hidden::CameraScale, ("camera-scale", Same), "(1 + q) × positions", (BOTH, 5e-3, 0.5)),
    form(Hidden::DepthZero, ("depth-zero", Same), "z + q mm", (BOTH, 0.2, 20.0)),
    form(
        Hidden::Layer,
        ("layer", Unlisted),
        "friction × (1 + q exp(−((z − 20 mm)/6 mm)²))",
        (UP, 0.05, 50.0),
    ),
    form(
        Hidden::Periodic,
        ("periodic", Unlisted),
        "friction × (1 + q sin²(π z/12 mm))",
        (UP, 0.05, 50.0),
    ),
    form(Hidden::CubicDrag, ("cubic-drag", Unlisted), "q ρ A v³/V_s", (UP, 0.01, 10.0)),
    form(
        Hidden::DecayingPressure,
        ("decaying-pressure", Unlisted),
        "resistance × (1 + q e^(−t/20 ms))",
        (UP, 0.02, 20.0),
    ),
    form(
        Hidden::LateForce,
        ("late-force", Unlisted),
        "q ρ g A D where v is below 30 % of the impact speed",
        (UP, 0.1, 500.0),
    ),
    form(
        Hidden::Drift,
        ("drift", Unlisted),
        "friction × (1 + q × share of the campaign that is over)",
        (UP, 0.02, 5.0),
    ),
    form(
        Hidden::SaturatingDrag,
        ("saturating-drag", Unlisted),
        "q ρ g A D tanh(v/0.4 m/s)",
        (UP, 0.1, 500.0),
    ),
    form(
        Hidden::AngleFriction,
        ("angle-friction", Unlisted),
        "friction × (1 + q sin²(2 θ)), θ the impact angle",
        (UP, 0.02, 20.0),
    ),
    form(Hidden::Ageing, ("ageing", Unlisted), "friction × (1 + q t/50 ms)", (UP, 0.02, 50.0)),
    form(Hidden::Furrow, ("furrow", Unlisted), "q ρ g A x, x the way forward", (UP, 0.1, 500.0)),
    form(
        Hidden::Step,
        ("step", Unlisted),
        "friction × (1 + q) deeper than 0.8 D",
        (UP, 0.02, 50.0),
    ),
    form(
        Hidden::Memory,
        ("memory", Unlisted),
        "q ρ A V_s v₀, v₀ the impact speed",
        (UP, 0.02, 50.0),
    ),
];

const fn form(
    hidden: Hidden,
    (id, kinship): (&'static str, Kinship),
    law: &'static str,
    (signs, small, most): (&'static [f64], f64, f64),
) -> Form {
    Form { hidden, id, law, kinship, signs, small, most }
}

impl Hidden {
    /// What is known of it.
    #[must_use]
    pub fn form(self) -> &'static Form {
        &FORMS[self as usize]
    }

    /// Name in the list of candidates, or of its own.
    #[must_use]
    pub fn id(self) -> &'static str {
        self.form().id
    }

    /// Whether it is an error of the apparatus, which a diagnosis looks for beside every effect.
    #[must_use]
    pub fn is_of_apparatus(self) -> bool {
        matches!(self, Self::Tilt | Self::CameraScale | Self::DepthZero)
    }

    /// Whether the list has it.
    #[must_use]
    pub fn is_listed(self) -> bool {
        self.form().kinship != Unlisted
    }

    /// Whether nothing but a spinning sphere shows it.
    #[must_use]
    pub fn needs_spin(self) -> bool {
        matches!(self, Self::Magnus | Self::SpinFriction)
    }

    /// Whether nothing but an oblique impact shows it.
    #[must_use]
    pub fn needs_oblique(self) -> bool {
        matches!(self, Self::AnisotropicDrag | Self::AnisotropicFriction | Self::Lift)
    }

    /// Whether it is drawn with the seeds of the release alone, so that nothing is fitted to it.
    #[must_use]
    pub fn is_for_release(self) -> bool {
        matches!(self, Self::Furrow | Self::Step | Self::Memory)
    }

    /// Those that the list has.
    pub fn listed() -> impl Iterator<Item = Self> {
        FORMS.iter().map(|form| form.hidden).filter(|hidden| hidden.is_listed())
    }

    /// Those that no list has.
    pub fn unlisted() -> impl Iterator<Item = Self> {
        FORMS.iter().map(|form| form.hidden).filter(|hidden| !hidden.is_listed())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_effect_finds_its_own_form() {
        for (place, form) in FORMS.iter().enumerate() {
            assert_eq!(form.hidden as usize, place);
            assert_eq!(form.hidden.form().id, form.id);
        }
        assert_eq!((Hidden::listed().count(), Hidden::unlisted().count()), (21, 12));
    }

    #[test]
    fn at_least_seven_listed_effects_have_another_form_than_their_candidate() {
        assert!(FORMS.iter().filter(|form| form.kinship == Other).count() >= 7);
    }
}
