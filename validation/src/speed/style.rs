//! Another pair style of LAMMPS for the bed of a deck: the general style beside the linear one, and the fast
//! style of Hertz's law beside the general one.

use configs::GrainModel;
use contact_laws::damping_ratio;
use engine::params::ParamTable;
use engine::simulation::Simulation;

/// How LAMMPS computes the forces between grains and with the intruder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Style {
    /// As LAMMPS calls it.
    pub name: String,
    /// Whether its forces are those of the model; else they are of the same class.
    pub is_same_law: bool,
    /// The deck.
    pub input: String,
}

impl Style {
    /// That of the deck `input`, which is of the law of the model.
    pub(super) fn of_deck(input: &str) -> Self {
        let named = input.lines().find_map(|line| line.strip_prefix("pair_style "));
        let name = named.and_then(|rest| rest.split_whitespace().next()).unwrap_or("none");
        Self { name: name.to_owned(), is_same_law: true, input: input.to_owned() }
    }

    /// The other one that LAMMPS has, if there is one; `simulation` is the model on its bed at first contact.
    pub(super) fn other(&self, model: GrainModel<'_>, simulation: &Simulation) -> Option<Self> {
        let law = &model.medium.contact_law;
        let (name, is_same_law, pair) = match (self.name.as_str(), law.entry.name) {
            ("gran/hooke/history", "linear-spring-dashpot") => {
                ("granular", true, general_linear(&law.params)?)
            }
            ("granular", "hertz-mindlin") => {
                let grains = &simulation.bed().grains;
                let radius = 0.5 * grains.mean_diameter();
                let mass = grains.mass.iter().sum::<f64>() / grains.len() as f64;
                let speed = simulation.intruder().bodies()[0].velocity.norm();
                ("gran/hertz/history", false, fast_hertz(&law.params, radius, mass, speed))
            }
            _ => return None,
        };
        Some(Self { name: name.to_owned(), is_same_law, input: with_pair(&self.input, &pair) })
    }
}

/// `input` with other forces between pairs; those at walls stay.
fn with_pair(input: &str, pair: &str) -> String {
    let mut text = String::new();
    for line in input.lines() {
        if line.starts_with("pair_style ") {
            text.push_str(pair);
        } else if !line.starts_with("pair_coeff ") {
            text.push_str(line);
            text.push('\n');
        }
    }
    text
}

/// The linear law in the words of the general style, which has the tangential damping as a share of the
/// normal one.
fn general_linear(params: &ParamTable) -> Option<String> {
    let [k_n, k_t, rate_n, rate_t, friction] = [
        "normal_stiffness",
        "tangential_stiffness",
        "normal_damping_rate",
        "tangential_damping_rate",
        "friction",
    ]
    .map(|key| params.get(key));
    (rate_n > 0.0).then(|| {
        format!(
            "pair_style granular\npair_coeff * * hooke {k_n:?} {rate_n:?} tangential linear_history {k_t:?} \
             {:?} {friction:?} damping mass_velocity\n",
            rate_t / rate_n
        )
    })
}

/// Hertz and Mindlin in the fast style, for one material and one friction: those of the grains. Its damping
/// goes with m* a and not with √(S_n m*): the two agree for two mean grains of `radius` (m) and `mass` (kg)
/// at the largest overlap of a collision with `speed` (m/s).
fn fast_hertz(params: &ParamTable, radius: f64, mass: f64, speed: f64) -> String {
    let (young, poisson) = (params.get("young_modulus"), params.get("poisson_ratio"));
    let modulus = 0.5 * young / (1.0 - poisson * poisson);
    let shear_modulus = 0.25 * young / ((2.0 - poisson) * (1.0 + poisson));
    let (mass_eff, radius_eff) = (0.5 * mass, 0.5 * radius);
    let swing = 15.0 / 16.0 * mass_eff * speed * speed / (modulus * radius_eff.sqrt());
    let contact_radius = (radius_eff * libm::pow(swing, 0.4)).sqrt();
    let ratio = 2.0 * (5.0_f64 / 6.0).sqrt() * damping_ratio(params.get("restitution"));
    let rate_n = ratio * (2.0 * modulus / (mass_eff * contact_radius)).sqrt();
    let rate_t = 2.0 * (shear_modulus / modulus).sqrt() * params.get("tangential_damping") * rate_n;
    format!(
        "pair_style gran/hertz/history {:?} {:?} {rate_n:?} {rate_t:?} {:?} 1 limit_damping\npair_coeff * *\n",
        4.0 / 3.0 * modulus,
        8.0 * shear_modulus,
        params.get("friction"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const INPUT: &str = "units si\npair_style granular\npair_coeff 1 1 hertz 1\npair_coeff 1 2 hertz 1\n\
                         fix sides grains wall/gran granular hertz 1\n";

    fn table(values: &[(&'static str, f64)]) -> ParamTable {
        let params: ParamTable = values.iter().copied().collect();
        params
    }

    #[test]
    fn the_forces_of_pairs_are_replaced_and_those_at_walls_stay() {
        let style = Style::of_deck(INPUT);
        assert!(style.name == "granular" && style.is_same_law);
        let other = with_pair(INPUT, "pair_style gran/hooke/history 1\npair_coeff * *\n");
        let lines: Vec<&str> = other.lines().collect();
        assert_eq!(lines[1..3], ["pair_style gran/hooke/history 1", "pair_coeff * *"]);
        assert_eq!((lines.len(), lines[3]), (4, "fix sides grains wall/gran granular hertz 1"));
    }

    #[test]
    fn the_general_style_has_the_numbers_of_the_linear_law() {
        let params = table(&[
            ("normal_stiffness", 3200.0),
            ("tangential_stiffness", 1600.0),
            ("normal_damping_rate", 1e4),
            ("tangential_damping_rate", 8e3),
            ("friction", 0.28),
        ]);
        let expected = "pair_style granular\npair_coeff * * hooke 3200.0 10000.0 tangential linear_history \
                        1600.0 0.8 0.28 damping mass_velocity\n";
        assert_eq!(general_linear(&params).as_deref(), Some(expected));
    }

    #[test]
    fn the_fast_style_has_the_springs_and_at_the_largest_overlap_the_damping_of_the_law() {
        let params = table(&[
            ("young_modulus", 1e9),
            ("poisson_ratio", 0.2),
            ("restitution", 0.5),
            ("friction", 0.3),
            ("tangential_damping", 1.0),
        ]);
        let (radius, mass, speed) = (1e-3, 1e-5, 2.0);
        let text = fast_hertz(&params, radius, mass, speed);
        let numbers: Vec<f64> =
            text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        let [k_n, k_t, rate_n, rate_t, friction, _] = numbers[..] else { panic!("{text}") };
        let close = |value: f64, expected: f64, by: f64| (value / expected - 1.0).abs() < by;
        // Equal bodies: 4/3 E* = 2/3 E/(1 − ν²), 8 G* = 4 G/(2 − ν).
        assert!(close(k_n, 2.0 / 3.0 * 1e9 / 0.96, 1e-14));
        assert!(close(k_t, 4.0 * 1e9 / 2.4 / 1.8, 1e-14) && close(friction, 0.3, 1e-14));
        // With c_n = m* γ_n a against 2 √(5/6) β √(2 E* a m*), β = 0.25526 within 2e-5 for e = 1/2.
        let modulus: f64 = 1e9 / 1.92;
        let overlap = libm::pow(15.0 / 16.0 * 5e-6 * 4.0 / (modulus * 5e-4_f64.sqrt()), 0.4);
        let a = (5e-4 * overlap).sqrt();
        let damping = 2.0 * (5.0_f64 / 6.0).sqrt() * 0.25526 * (2.0 * modulus * a * 5e-6).sqrt();
        assert!(close(5e-6 * rate_n * a, damping, 8e-5), "{rate_n}");
        assert!(close(rate_t / rate_n, (k_t / (1.5 * k_n)).sqrt(), 1e-14));
    }
}
