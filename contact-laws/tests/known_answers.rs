//! Laws in motions whose forces and energies are known in closed form.

use std::f64::consts::{PI, TAU};

use contact_laws::{ActsOn, LAWS, LawEntry};
use engine::contact::{Contact, Partner, Response};
use engine::grains::Space;
use engine::lanes::MOST_LANES;
use engine::math::Vec3;
use engine::params::{ParamDefault, ParamTable};
use engine::stage::{Batch, ContactStage, Histories};

/// (kg).
const MASS: f64 = 1e-4;

/// 1/I_r (1/(kg m²)).
const ROLLING_MOBILITY: f64 = 1e9;

/// The law called `name`, with the first of `given` for each key, else its default, else some value of the right size.
fn law(name: &str, given: &[(&str, f64)]) -> Box<dyn ContactStage> {
    let entry = contact_laws::find(name).expect("it is registered");
    (entry.build)(&params(entry, given))
}

fn params(entry: &LawEntry, given: &[(&str, f64)]) -> ParamTable {
    let mut table = ParamTable::new();
    for spec in entry.params {
        let value = given.iter().find(|(key, _)| *key == spec.key).map(|(_, value)| *value);
        let value = value.unwrap_or_else(|| match spec.default {
            ParamDefault::Value(value) => value,
            ParamDefault::SameAs(key) => table.get(key),
            ParamDefault::FromBase(_) | ParamDefault::Required => {
                (spec.plausible.min.max(0.1) * spec.plausible.max).sqrt()
            }
        });
        table.set(spec.key, value);
    }
    table
}

/// One contact between steps: what its law remembers and has booked (J).
struct Touching {
    law: Box<dyn ContactStage>,
    partner: Partner,
    history: Vec<f64>,
    /// By channel: what is held, or was lost so far.
    energy: Vec<f64>,
}

impl Touching {
    fn new(law: Box<dyn ContactStage>, partner: Partner) -> Self {
        let history = vec![0.0; law.history_len(Space::Spatial)];
        let energy = vec![0.0; law.channels().len()];
        Self { law, partner, history, energy }
    }

    /// What the law answers to `contact` after a step of `dt` (s) and an answer of `response` by the laws before it.
    fn step(&mut self, contact: &Contact, dt: f64, mut response: Response) -> Response {
        let batch = Batch {
            partner: self.partner,
            contacts: std::slice::from_ref(contact),
            records: &[[0; MOST_LANES]],
            responses: std::slice::from_mut(&mut response),
        };
        let mut booked = vec![0.0; self.energy.len()];
        let histories = Histories { values: &mut self.history, offset: 0 };
        self.law.sweep(batch, dt, histories, Some(&mut booked));
        for ((channel, sum), step) in self.law.channels().iter().zip(&mut self.energy).zip(booked) {
            let is_held = channel.kind == engine::ledger::ChannelKind::Stored;
            *sum = if is_held { step } else { *sum + step };
        }
        response
    }

    /// (J) of the first channel called `name`.
    fn of(&self, name: &str) -> f64 {
        let at = self.law.channels().iter().position(|channel| channel.name == name);
        self.energy[at.expect("the law has the channel")]
    }
}

/// A contact with an overlap (m) that stays, and this slip (m/s) along x at the end of a step of `dt` (s), in which it was
/// `slip_step` (m).
fn sheared(overlap: f64, slip_velocity: f64, slip_step: f64) -> Contact {
    Contact {
        normal: Vec3::z(),
        overlap,
        overlap_rate: 0.0,
        overlap_step: 0.0,
        slip_velocity: Vec3::x() * slip_velocity,
        slip_step: Vec3::x() * slip_step,
        relative_spin: Vec3::zeros(),
        relative_turn: Vec3::zeros(),
        inverse_radius_eff: 1e3,
        inverse_radius_eff_before: 1e3,
        inverse_mass_eff: 1.0 / MASS,
        rolling_mobility: ROLLING_MOBILITY,
    }
}

#[test]
fn a_slip_that_begins_in_the_spring_splits_into_damping_and_sliding_as_the_formulas_say() {
    // N = 0.1 N, limit 50 mN; at 1 m/s the dashpot takes 20 mN, so the spring slides from 30 µm on.
    let (stiffness, rate, friction) = (1000.0, 200.0, 0.5);
    let law = law(
        "linear-spring-dashpot",
        &[
            ("normal_stiffness", stiffness),
            ("tangential_stiffness", stiffness),
            ("normal_damping_rate", 0.0),
            ("tangential_damping_rate", rate),
            ("friction", friction),
        ],
    );
    let mut touching = Touching::new(law, Partner::Grain);
    let (overlap, speed, steps, way) = (1e-4, 1.0, 100_000, 1e-4);
    let (limit, viscous) = (friction * stiffness * overlap, MASS * rate * speed);
    let dt = way / speed / f64::from(steps);
    let (mut force, mut work) = (0.0, 0.0);
    for _ in 0..steps {
        let contact = sheared(overlap, speed, speed * dt);
        let next = touching.step(&contact, dt, Response::default()).tangential_force.x;
        work -= 0.5 * (force + next) * speed * dt;
        force = next;
    }
    let (sticks, slides) = ((limit - viscous) / stiffness, limit / stiffness);
    let damping = viscous * sticks;
    // Where it begins to slide the dashpot lets go, and the spring takes over its part of the limit.
    let taken_over = 0.5 * stiffness * (slides * slides - sticks * sticks);
    let sliding = limit * (way - sticks) - taken_over;
    // Each event falls into one step of a hundred thousandth of the way.
    let near = |value: f64, exact: f64| (value - exact).abs() < 1e-4 * work;
    assert!(near(touching.of("tangential-damping"), damping), "{:?} {damping:e}", touching.energy);
    assert!(near(touching.of("sliding"), sliding), "{:?} {sliding:e}", touching.energy);
    assert!(near(touching.of("tangential"), 0.5 * stiffness * slides * slides));
    assert!(near(work, damping + sliding + touching.of("tangential")), "{work:e}");
}

/// The base laws.
fn base_laws() -> impl Iterator<Item = &'static LawEntry> {
    LAWS.iter().copied().filter(|entry| entry.acts_on == ActsOn::ContactBase)
}

#[test]
fn a_contact_that_shakes_without_sliding_loses_to_its_dashpot_alone() {
    for entry in base_laws() {
        // No limit that it could reach.
        let law = law(entry.name, &[("friction", 1e6), ("tangential_damping_rate", 50.0)]);
        let mut touching = Touching::new(law, Partner::Grain);
        let (amplitude, steps) = (1e-8, 20_000);
        // A swing in a millisecond, and then the same again from where it has settled.
        let dt = 1e-3 / f64::from(steps);
        let (mut force, mut work, mut before) = (0.0, 0.0, 0.0);
        let mut most = 0.0_f64;
        for step in 1..=steps {
            let angle = |step: f64| TAU * step / f64::from(steps);
            let at = amplitude * libm::sin(angle(f64::from(step)));
            let speed = amplitude * TAU / 1e-3 * libm::cos(angle(f64::from(step)));
            let contact = sheared(1e-5, speed, at - before);
            let next = touching.step(&contact, dt, Response::default()).tangential_force.x;
            work -= 0.5 * (force + next) * (at - before);
            (force, before) = (next, at);
            most = most.max(next.abs());
        }
        let damping = touching.of("tangential-damping");
        // The spring is back where it was, to round-off of what it held meanwhile; one law has no dashpot there.
        let round_off = 1e-9 * most * amplitude;
        assert!(touching.of("sliding").abs() <= round_off, "{}", entry.name);
        let error = (damping - work).abs();
        assert!(error <= 1e-6 * work.abs() + round_off, "{}: {damping:e} {work:e}", entry.name);
        if entry.name == "linear-spring-dashpot" {
            // ∮ c v dx = π c ω A²; trapezia of a smooth cycle.
            let exact = PI * MASS * 50.0 * (TAU / 1e-3) * amplitude * amplitude;
            assert!((damping / exact - 1.0).abs() < 1e-3, "{damping:e} {exact:e}");
        }
    }
}

#[test]
fn each_kind_of_partner_slides_under_its_own_friction() {
    let frictions = [("friction", 0.2), ("wall_friction", 0.5), ("intruder_friction", 0.9)];
    for entry in base_laws() {
        for (partner, (_, friction)) in Partner::ALL.into_iter().zip(frictions) {
            let mut touching = Touching::new(law(entry.name, &frictions), partner);
            // Ten overlaps in one step: whatever the law, it slides.
            let contact = sheared(1e-5, 0.1, 1e-4);
            let answer = touching.step(&contact, 1e-3, Response::default());
            let ratio = -answer.tangential_force.x / answer.normal_force;
            // One product and one quotient.
            assert!((ratio / friction - 1.0).abs() < 1e-12, "{}: {ratio} {friction}", entry.name);
        }
    }
}

#[test]
fn a_rolling_spring_swings_with_the_damping_ratio_that_it_is_given() {
    for ratio in [0.0, 0.1, 0.3] {
        let law = law(
            "rolling-resistance",
            &[("rolling_friction", 0.1), ("rolling_damping_ratio", ratio)],
        );
        let mut touching = Touching::new(law, Partner::Grain);
        // μ_r R* = 0.1 mm.
        let (normal_stiffness, lever) = (3200.0, 1e-4);
        let natural = (2.25 * normal_stiffness * lever * lever * ROLLING_MOBILITY).sqrt();
        let dt = TAU / natural / 20_000.0;
        // Far below the limit: 2.25 k_n (μ_r R*)² θ against μ_r R* F_n.
        let (mut angle, mut spin, mut couple) = (0.0_f64, 1e-6 * natural, 0.0);
        let start = 0.5 * spin * spin / ROLLING_MOBILITY;
        let (mut most, mut least) = (0.0_f64, 0.0_f64);
        for _ in 0..20_000 {
            let half = spin + 0.5 * dt * couple * ROLLING_MOBILITY;
            angle += half * dt;
            let now = half + 0.5 * dt * couple * ROLLING_MOBILITY;
            let contact = Contact {
                relative_spin: Vec3::y() * now,
                relative_turn: Vec3::y() * (half * dt),
                ..sheared(1e-4, 0.0, 0.0)
            };
            let pressed = Response { normal_force: 0.32, normal_stiffness, ..Response::default() };
            couple = touching.step(&contact, dt, pressed).couple.y;
            spin = half + 0.5 * dt * couple * ROLLING_MOBILITY;
            (most, least) = (most.max(angle), least.min(angle));
        }
        // Two turning points that follow each other.
        let exact = libm::exp(-PI * ratio / (1.0 - ratio * ratio).sqrt());
        // Second order in the step, and a maximum found among steps: 1e-7.
        assert!((-least / most - exact).abs() < 1e-5, "{} {exact}", -least / most);
        let [held, lost] = [touching.energy[0], touching.energy[1]];
        let kinetic = 0.5 * spin * spin / ROLLING_MOBILITY;
        assert!(((held + lost + kinetic) / start - 1.0).abs() < 1e-5);
        assert_eq!(lost > 0.5 * start, ratio > 0.05, "{lost:e} of {start:e}");
    }
}

/// Grains of 1 GPa, a steel intruder, and a restitution and a friction for each pair.
const GRAINS_AND_STEEL: [(&str, f64); 7] = [
    ("young_modulus", 1e9),
    ("poisson_ratio", 0.2),
    ("friction", 0.3),
    ("restitution", 0.5),
    ("intruder_young_modulus", 210e9),
    ("intruder_friction", 0.2),
    ("intruder_restitution", 0.4),
];

/// What came of a head-on collision.
struct Collision {
    /// (m).
    largest_overlap: f64,
    /// (s).
    duration: f64,
    /// Speed after over speed before (–).
    rebound: f64,
    /// What was lost over what was booked as lost, less one (–).
    unaccounted: f64,
}

/// A grain of radius 2 mm and density 2500 kg/m³ meets `partner` of `radius` (m) and `mass` (kg) at 5 m/s.
fn head_on(given: &[(&str, f64)], partner: Partner, radius: f64, mass: f64, dt: f64) -> Collision {
    let inverse_radius_eff = 1.0 / 2e-3 + 1.0 / radius;
    let inverse_mass_eff = 1.0 / (2500.0 * 4.0 / 3.0 * PI * 8e-9) + 1.0 / mass;
    let mut touching = Touching::new(law("hertz-mindlin", given), partner);
    let (mut overlap, mut rate, mut force) = (0.0, 5.0, 0.0);
    let (mut largest_overlap, mut steps) = (0.0_f64, 0);
    loop {
        let half = rate - 0.5 * dt * force * inverse_mass_eff;
        let foretold = half - 0.5 * dt * force * inverse_mass_eff;
        let before = overlap;
        overlap += half * dt;
        let contact = Contact {
            overlap_rate: foretold,
            overlap_step: half * dt,
            inverse_radius_eff,
            inverse_radius_eff_before: inverse_radius_eff,
            inverse_mass_eff,
            ..sheared(overlap, 0.0, 0.0)
        };
        force = touching.step(&contact, dt, Response::default()).normal_force;
        rate = half - 0.5 * dt * force * inverse_mass_eff;
        largest_overlap = largest_overlap.max(overlap);
        steps += 1;
        if overlap <= 0.0 {
            let start = 0.5 * 25.0 / inverse_mass_eff;
            let lost = start - 0.5 * rate * rate / inverse_mass_eff;
            return Collision {
                largest_overlap,
                duration: dt * (f64::from(steps) - overlap / (overlap - before)),
                rebound: -rate / 5.0,
                unaccounted: (lost - touching.of("normal-damping")) / start,
            };
        }
    }
}

#[test]
fn a_grain_meets_steel_as_hertz_says_of_two_materials_and_rebounds_with_the_restitution_of_the_pair()
 {
    // Steel of 1 cm in radius; two grains.
    let steel = 7200.0 * 4.0 / 3.0 * PI * 1e-6;
    let grain = 2500.0 * 4.0 / 3.0 * PI * 8e-9;
    let of_steel = 1.0 / (0.96 / 1e9 + 0.96 / 210e9);
    for (partner, radius, mass, modulus, restitution) in [
        (Partner::Intruder, 1e-2, steel, of_steel, 0.4),
        (Partner::Grain, 2e-3, grain, 1e9 / 1.92, 0.5),
    ] {
        let (mass_eff, radius_eff): (f64, f64) =
            (grain * mass / (grain + mass), 2e-3 * radius / (2e-3 + radius));
        // Johnson, Contact Mechanics (1985), section 11.4.
        let swing = 15.0 / 16.0 * mass_eff * 25.0 / (modulus * radius_eff.sqrt());
        let overlap = libm::pow(swing, 0.4);
        let duration = 2.943_275 * overlap / 5.0;
        let dt = duration / 2000.0;
        let undamped = [("restitution", 1.0), ("intruder_restitution", 1.0)];
        let elastic = [&undamped, &GRAINS_AND_STEEL[..]].concat();
        let collision = head_on(&elastic, partner, radius, mass, dt);
        // Second order in a step of 1/2000.
        assert!((collision.largest_overlap / overlap - 1.0).abs() < 1e-5, "{partner:?}");
        assert!((collision.duration / duration - 1.0).abs() < 1e-4, "{partner:?}");
        assert!((collision.rebound - 1.0).abs() < 1e-5, "{partner:?}");
        let damped = head_on(&GRAINS_AND_STEEL, partner, radius, mass, dt);
        assert!((damped.rebound - restitution).abs() < 2e-4, "{partner:?} {}", damped.rebound);
        assert!(damped.unaccounted.abs() < 1e-4, "{partner:?} {}", damped.unaccounted);
    }
}

#[test]
fn a_grain_slides_on_steel_with_the_friction_of_the_pair_and_springs_back_with_its_shear_modulus() {
    let shear = |young: f64| 2.0 * 1.8 * 1.2 / young;
    for (partner, young, friction) in [(Partner::Grain, 1e9, 0.3), (Partner::Intruder, 210e9, 0.2)]
    {
        let mut touching = Touching::new(law("hertz-mindlin", &GRAINS_AND_STEEL), partner);
        let overlap = 1e-6;
        let stiffness = 8.0 / (shear(1e9) + shear(young)) * (1e-3_f64 * overlap).sqrt();
        let stuck = touching.step(&sheared(overlap, 0.0, 1e-10), 1e-7, Response::default());
        assert!((-stuck.tangential_force.x / (stiffness * 1e-10) - 1.0).abs() < 1e-12);
        let slides = touching.step(&sheared(overlap, 0.0, 1e-4), 1e-7, Response::default());
        let ratio = -slides.tangential_force.x / slides.normal_force;
        assert!((ratio / friction - 1.0).abs() < 1e-12, "{partner:?} {ratio}");
    }
}
