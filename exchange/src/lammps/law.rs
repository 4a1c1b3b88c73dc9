//! Contact laws in the words of LAMMPS.

use std::f64::consts::PI;

use configs::LawChoice;
use contact_laws::{damping_ratio, restitution_key};
use engine::contact::Partner;
use engine::params::ParamTable;

use super::atom_type::{GRAIN, INTRUDER};

/// The forces between grains, the intruder and walls.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Contacts {
    /// The commands `pair_style` and `pair_coeff`.
    pub(super) pair: Vec<String>,
    /// The model and its coefficients, as `fix wall/gran` takes them.
    pub(super) wall: String,
}

/// A contact law that LAMMPS has too.
pub(super) enum Law<'a> {
    Linear(&'a ParamTable),
    HertzMindlin {
        params: &'a ParamTable,
        /// The restitution that LAMMPS is told, by [`Partner::index`].
        told: [f64; 3],
    },
}

impl<'a> Law<'a> {
    /// `law` as LAMMPS knows it; else what it lacks.
    pub(super) fn of(law: &'a LawChoice) -> Result<Self, String> {
        match law.entry.name {
            "linear-spring-dashpot" => Ok(Self::Linear(&law.params)),
            "hertz-mindlin" => Self::hertz_mindlin(&law.params),
            other => Err(format!("the contact law {other} as plunge has it")),
        }
    }

    /// LAMMPS takes its damping ratio β from a restitution e by −ln e = πβ/√(1 − β²), which is that
    /// of a law that may attract: so it is told the e that has the β of plunge.
    fn hertz_mindlin(params: &'a ParamTable) -> Result<Self, String> {
        let mut told = [0.0; 3];
        for (partner, told) in Partner::ALL.into_iter().zip(&mut told) {
            let key = restitution_key(partner);
            let restitution = params.get(key);
            let ratio = damping_ratio(restitution);
            if ratio >= 1.0 {
                let what = format!("damping beyond critical (contact_law.{key} = {restitution:?})");
                return Err(what);
            }
            *told = libm::exp(-PI * ratio / (1.0 - ratio * ratio).sqrt());
        }
        Ok(Self::HertzMindlin { params, told })
    }

    /// Whether forces depend on the curvature of what touches.
    pub(super) fn knows_curvature(&self) -> bool {
        matches!(self, Self::HertzMindlin { .. })
    }

    /// The forces, with a factor on the springs of Hertz and Mindlin for each atom type of the
    /// intruder.
    pub(super) fn contacts(&self, stiffness: &[f64]) -> Contacts {
        match *self {
            Self::Linear(params) => linear(params, stiffness),
            Self::HertzMindlin { params, told } => hertz_mindlin(params, told, stiffness),
        }
    }
}

/// Forces of the style `granular`, whose words for each partner, with springs so much stiffer,
/// `terms` gives.
fn granular(stiffness: &[f64], terms: impl Fn(Partner, f64) -> String) -> Contacts {
    let mut pair = vec![
        "pair_style granular".to_owned(),
        format!("pair_coeff {GRAIN} {GRAIN} {}", terms(Partner::Grain, 1.0)),
    ];
    for (kind, factor) in (INTRUDER..).zip(stiffness) {
        let terms = terms(Partner::Intruder, *factor);
        pair.push(format!("pair_coeff {GRAIN} {kind} {terms}"));
    }
    // Two intruders never meet, but LAMMPS asks for every pair.
    let last = INTRUDER + stiffness.len() - 1;
    let kinds = if last == INTRUDER { INTRUDER.to_string() } else { format!("{INTRUDER}*{last}") };
    pair.push(format!("pair_coeff {kinds} {kinds} {}", terms(Partner::Intruder, 1.0)));
    Contacts { pair, wall: format!("granular {}", terms(Partner::Wall, 1.0)) }
}

fn friction(params: &ParamTable, partner: Partner) -> f64 {
    params.get(match partner {
        Partner::Grain => "friction",
        Partner::Wall => "wall_friction",
        Partner::Intruder => "intruder_friction",
    })
}

/// LAMMPS scales both damping rates with the reduced mass too, and lets damping attract.
fn linear(params: &ParamTable, stiffness: &[f64]) -> Contacts {
    let [k_n, k_t, rate_n, rate_t] = [
        "normal_stiffness",
        "tangential_stiffness",
        "normal_damping_rate",
        "tangential_damping_rate",
    ]
    .map(|key| params.get(key));
    let friction = |partner| friction(params, partner);
    let one_friction = friction(Partner::Grain).to_bits() == friction(Partner::Intruder).to_bits();
    if one_friction || rate_n <= 0.0 {
        // The older style is the faster one; the last number switches tangential damping on.
        let terms =
            |partner| format!("{k_n:?} {k_t:?} {rate_n:?} {rate_t:?} {:?} 1", friction(partner));
        let style = format!("pair_style gran/hooke/history {}", terms(Partner::Grain));
        let wall = format!("hooke/history {}", terms(Partner::Wall));
        return Contacts { pair: vec![style, "pair_coeff * *".to_owned()], wall };
    }
    granular(stiffness, |partner, _| {
        format!(
            "hooke {k_n:?} {rate_n:?} tangential linear_history {k_t:?} {:?} {:?} damping mass_velocity",
            rate_t / rate_n,
            friction(partner)
        )
    })
}

/// 1/E* = Σ (1 − ν²)/E and 1/G* = Σ 2 (2 − ν)(1 + ν)/E (1/Pa), over a grain and its partner.
fn elastic(params: &ParamTable, partner: Partner) -> [f64; 2] {
    let of = |modulus: &'static str, ratio: &'static str| {
        let (modulus, ratio) = (params.get(modulus), params.get(ratio));
        [(1.0 - ratio * ratio) / modulus, 2.0 * (2.0 - ratio) * (1.0 + ratio) / modulus]
    };
    let grain = of("young_modulus", "poisson_ratio");
    let other = match partner {
        Partner::Grain => grain,
        Partner::Wall => of("wall_young_modulus", "wall_poisson_ratio"),
        Partner::Intruder => of("intruder_young_modulus", "intruder_poisson_ratio"),
    };
    [1.0 / (grain[0] + other[0]), 1.0 / (grain[1] + other[1])]
}

/// `limit_damping` keeps the normal force from attracting. Both damp shear as c_t/c_n = √(k_t/S_n)
/// = 2 √(G*/E*).
fn hertz_mindlin(params: &ParamTable, told: [f64; 3], stiffness: &[f64]) -> Contacts {
    granular(stiffness, |partner, factor| {
        let [modulus, shear_modulus] = elastic(params, partner);
        format!(
            "hertz {k_n:?} {told:?} tangential mindlin {k_t:?} {shear:?} {friction:?} \
             damping coeff_restitution limit_damping",
            k_n = 4.0 / 3.0 * factor * modulus,
            told = told[partner.index()],
            k_t = 8.0 * factor * shear_modulus,
            shear = 2.0 * (shear_modulus / modulus).sqrt() * params.get("tangential_damping"),
            friction = friction(params, partner),
        )
    })
}
