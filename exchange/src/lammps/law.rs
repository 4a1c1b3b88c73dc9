//! Contact laws in the words of LAMMPS.

use std::f64::consts::PI;

use configs::LawChoice;
use configs::contact_laws::damping_ratio;
use configs::engine::contact::Partner;
use configs::engine::params::ParamTable;

use super::{GRAIN, INTRUDER};

/// The forces between grains, the intruder and walls.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Contacts {
    /// The commands `pair_style` and `pair_coeff`.
    pub(super) pair: Vec<String>,
    /// The model and its coefficients, as `fix wall/gran` takes them.
    pub(super) wall: String,
}

impl Contacts {
    /// `law` in the words of LAMMPS; else what it lacks.
    pub(super) fn of(law: &LawChoice) -> Result<Self, String> {
        match law.entry.name {
            "linear-spring-dashpot" => Ok(linear(&law.params)),
            "hertz-mindlin" => hertz_mindlin(&law.params),
            other => Err(format!("the contact law {other} as plunge has it")),
        }
    }

    /// Forces of the style `granular`, whose words for each partner `terms` gives.
    fn granular(terms: impl Fn(Partner) -> String) -> Self {
        let [grain, wall, intruder] = [Partner::Grain, Partner::Wall, Partner::Intruder].map(terms);
        // Two intruders never meet, but LAMMPS asks for every pair.
        let pair = [(GRAIN, GRAIN, grain), (GRAIN, INTRUDER, intruder.clone())]
            .into_iter()
            .chain([(INTRUDER, INTRUDER, intruder)])
            .map(|(one, other, terms)| format!("pair_coeff {one} {other} {terms}"));
        let style = std::iter::once("pair_style granular".to_owned());
        Self { pair: style.chain(pair).collect(), wall: format!("granular {wall}") }
    }
}

fn friction(params: &ParamTable, partner: Partner) -> f64 {
    params.get(match partner {
        Partner::Grain => "friction",
        Partner::Wall => "wall_friction",
        Partner::Intruder => "intruder_friction",
    })
}

/// LAMMPS scales both damping rates with the reduced mass too, and lets damping attract.
fn linear(params: &ParamTable) -> Contacts {
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
    Contacts::granular(|partner| {
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

/// `limit_damping` keeps the normal force from attracting. LAMMPS takes its damping ratio β from a restitution
/// e by −ln e = πβ/√(1 − β²), which is that of a law that may attract: so it is told the e that has the β
/// of plunge. Both damp shear as c_t/c_n = √(k_t/S_n) = 2 √(G*/E*).
fn hertz_mindlin(params: &ParamTable) -> Result<Contacts, String> {
    let restitution = params.get("restitution");
    let ratio = damping_ratio(restitution);
    if ratio >= 1.0 {
        return Err(format!("damping beyond critical (contact_law.restitution = {restitution:?})"));
    }
    let told = libm::exp(-PI * ratio / (1.0 - ratio * ratio).sqrt());
    Ok(Contacts::granular(|partner| {
        let [modulus, shear_modulus] = elastic(params, partner);
        format!(
            "hertz {k_n:?} {told:?} tangential mindlin {k_t:?} {shear:?} {friction:?} \
             damping coeff_restitution limit_damping",
            k_n = 4.0 / 3.0 * modulus,
            k_t = 8.0 * shear_modulus,
            shear = 2.0 * (shear_modulus / modulus).sqrt() * params.get("tangential_damping"),
            friction = friction(params, partner),
        )
    }))
}
