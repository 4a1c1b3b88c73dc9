//! What must hold for every registered law, whatever it says.

use contact_laws::{ActsOn, LAWS, LawEntry};
use engine::contact::{Contact, Encounter, Partner, Response, Slot};
use engine::grains::Space;
use engine::lanes::{COARSE_ERROR, Eight, Lanes, MOST_LANES, Vector, vector_of};
use engine::math::{Quat, Vec3};
use engine::params::{ParamDefault, ParamTable};
use engine::stage::{Batch, Histories};
use engine::stage::{ContactStage, Sweep};

const DT: f64 = 1e-5;

/// Middle of the plausible range, or what the entry gives where a file need not say anything.
fn table(entry: &LawEntry) -> ParamTable {
    let mut table = ParamTable::new();
    for spec in entry.params {
        let middle = 0.5 * (spec.plausible.min + spec.plausible.max);
        let value = match spec.default {
            // The span of a stiffness is decades: its middle is the geometric one.
            ParamDefault::Required if spec.plausible.min > 0.0 => {
                (spec.plausible.min * spec.plausible.max).sqrt()
            }
            ParamDefault::Required => middle,
            ParamDefault::Value(value) => value,
            ParamDefault::SameAs(key) => table.get(key),
            // The elastic constants of a contact law.
            ParamDefault::FromBase(key) if key.ends_with("poisson_ratio") => 0.3,
            ParamDefault::FromBase(_) => 1e8,
        };
        table.set(spec.key, value);
    }
    table
}

/// A contact that closes, shears, turns over and opens again, at unequal bodies.
fn episode() -> Vec<Contact> {
    let tilted = |angle: f64| Vec3::new(libm::sin(angle), 0.1, libm::cos(angle)).normalize();
    let overlaps = [2e-6, 1.5e-5, 4e-5, 3e-5, 1e-5, -1e-6];
    let mut before = 0.0;
    (0..overlaps.len())
        .map(|step| {
            let normal = tilted(0.02 * step as f64);
            let slip = Vec3::new(3e-6, -1e-6, 2e-6) * (step as f64 - 1.5);
            let slip = slip - normal * slip.dot(&normal);
            let overlap_step = overlaps[step] - before;
            before = overlaps[step];
            Contact {
                normal,
                overlap: overlaps[step],
                overlap_rate: overlap_step / DT,
                overlap_step,
                slip_velocity: slip / DT,
                slip_step: slip,
                relative_spin: Vec3::new(20.0, -30.0, 10.0),
                relative_turn: Vec3::new(2e-4, -3e-4, 1e-4),
                inverse_radius_eff: 1.0 / 2e-3 + 1.0 / 3e-3,
                inverse_radius_eff_before: 1.0 / 2e-3 + 1.0 / 3e-3,
                inverse_mass_eff: 1.0 / 5e-5 + 1.0 / 1e-4,
                rolling_mobility: 1.0 / 7e-10,
            }
        })
        .collect()
}

/// The episode seen from a world turned by `turn`.
fn turned(contact: &Contact, turn: Quat) -> Contact {
    Contact {
        normal: turn * contact.normal,
        slip_velocity: turn * contact.slip_velocity,
        slip_step: turn * contact.slip_step,
        relative_spin: turn * contact.relative_spin,
        relative_turn: turn * contact.relative_turn,
        ..*contact
    }
}

/// The episode with the names of both bodies exchanged.
fn swapped(contact: &Contact) -> Contact {
    Contact {
        normal: -contact.normal,
        slip_velocity: -contact.slip_velocity,
        slip_step: -contact.slip_step,
        relative_spin: -contact.relative_spin,
        relative_turn: -contact.relative_turn,
        ..*contact
    }
}

/// What `law` answers to each contact of an episode, and what it books in all.
fn play(law: &dyn ContactStage, episode: &[Contact]) -> (Vec<Response>, Vec<f64>) {
    let mut history = vec![0.0; law.history_len(Space::Spatial)];
    let mut energy = vec![0.0; law.channels().len()];
    let responses = episode
        .iter()
        .map(|contact| {
            let mut response = before_the_law(law, contact);
            let batch = Batch {
                partner: Partner::Grain,
                contacts: std::slice::from_ref(contact),
                records: &[[0; MOST_LANES]],
                responses: std::slice::from_mut(&mut response),
            };
            law.sweep(batch, DT, Histories { values: &mut history, offset: 0 }, Some(&mut energy));
            response
        })
        .collect();
    (responses, energy)
}

/// An effect finds what a base law would have answered.
fn before_the_law(law: &dyn ContactStage, contact: &Contact) -> Response {
    match law.slot() {
        Slot::Base => Response::default(),
        _ => Response {
            normal_force: 3200.0 * contact.overlap.max(0.0),
            normal_stiffness: 3200.0,
            ..Response::default()
        },
    }
}

/// Round-off of some tens of operations, of the largest value of the episode.
fn assert_close(values: impl Iterator<Item = (f64, f64)>, what: &str) {
    assert_within(1e-13, values, what);
}

fn assert_within(share: f64, values: impl Iterator<Item = (f64, f64)>, what: &str) {
    let values: Vec<(f64, f64)> = values.collect();
    let scale = values.iter().fold(0.0_f64, |scale, (a, b)| scale.max(a.abs()).max(b.abs()));
    for (a, b) in values {
        assert!((a - b).abs() <= share * scale, "{what}: {a:e} against {b:e}");
    }
}

fn vectors(a: Vec3, b: Vec3) -> impl Iterator<Item = (f64, f64)> {
    (0..3).map(move |axis| (a[axis], b[axis]))
}

#[test]
fn every_registered_law_says_what_it_is_and_where_it_comes_from() {
    for entry in LAWS {
        let name = entry.name;
        for (text, what) in [
            (entry.summary, "summary"),
            (entry.formula, "formula"),
            (entry.signature, "signature"),
            (entry.source, "source"),
        ] {
            assert!(!text.trim().is_empty(), "{name} has no {what}");
        }
        assert!(!entry.params.is_empty() && !entry.channels.is_empty(), "{name}");
        assert!(name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-'));
        for spec in entry.params {
            let key = spec.key;
            let snake = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
            assert!(key.starts_with(|c: char| c.is_ascii_lowercase()), "{name}.{key}");
            assert!(key.chars().all(snake), "{name}.{key}");
            assert!(!spec.meaning.is_empty(), "{name}.{key}");
            assert!(spec.plausible.min < spec.plausible.max, "{name}.{key}");
            for bound in [spec.plausible.min, spec.plausible.max] {
                assert!(spec.allowed.contains(bound), "{name}.{key}: {bound} is not allowed");
            }
            if let ParamDefault::Value(value) = spec.default {
                assert!(spec.allowed.contains(value), "{name}.{key}: {value} is not allowed");
            }
        }
    }
}

#[test]
fn every_registered_law_can_be_built_from_its_param_specs_and_rejects_each_missing_key() {
    for entry in LAWS {
        let full = table(entry);
        let law = (entry.build)(&full);
        assert_eq!(law.name(), entry.name);
        assert_eq!(law.channels(), entry.channels);
        for missing in entry.params {
            let short: ParamTable = full.iter().filter(|(key, _)| *key != missing.key).collect();
            let built = std::panic::catch_unwind(|| (entry.build)(&short));
            assert!(built.is_err(), "{} is built without `{}`", entry.name, missing.key);
        }
    }
}

#[test]
fn every_registered_law_is_unchanged_by_a_rotation_of_the_world() {
    let turn = Quat::new_normalize(nalgebra::Quaternion::new(0.3, -0.7, 0.2, 0.5));
    for entry in LAWS {
        let law = (entry.build)(&table(entry));
        let episode = episode();
        let other: Vec<Contact> = episode.iter().map(|contact| turned(contact, turn)).collect();
        let (here, energy) = play(&*law, &episode);
        let (there, other_energy) = play(&*law, &other);
        let both = || here.iter().zip(&there);
        assert_close(both().map(|(a, b)| (a.normal_force, b.normal_force)), entry.name);
        assert_close(
            both().flat_map(|(a, b)| vectors(turn * a.tangential_force, b.tangential_force)),
            entry.name,
        );
        assert_close(both().flat_map(|(a, b)| vectors(turn * a.couple, b.couple)), entry.name);
        // Components that damping had a step ago are rounded, each by itself, and turned they are others.
        assert_within(COARSE_ERROR, energy.into_iter().zip(other_energy), entry.name);
    }
}

#[test]
fn every_registered_law_gives_equal_and_opposite_force_when_i_and_j_swap() {
    for entry in LAWS {
        let law = (entry.build)(&table(entry));
        let episode = episode();
        let other: Vec<Contact> = episode.iter().map(swapped).collect();
        let (here, energy) = play(&*law, &episode);
        let (there, other_energy) = play(&*law, &other);
        for (a, b) in here.iter().zip(&there) {
            // A change of sign is exact.
            assert_eq!(a.normal_force.to_bits(), b.normal_force.to_bits(), "{}", entry.name);
            assert_eq!(a.tangential_force, -b.tangential_force, "{}", entry.name);
            assert_eq!(a.couple, -b.couple, "{}", entry.name);
        }
        assert_eq!(energy, other_energy, "{}", entry.name);
    }
}

/// Contacts side by side.
fn side_by_side<const N: usize>(contacts: [Contact<f64, N>; MOST_LANES]) -> Contact<Eight, N> {
    let number = |of: fn(&Contact<f64, N>) -> f64| Eight::from_lanes(|lane| of(&contacts[lane]));
    let vector = |of: fn(&Contact<f64, N>) -> Vector<f64, N>| {
        vector_of(|at| Eight::from_lanes(|lane| of(&contacts[lane])[at]))
    };
    Contact {
        normal: vector(|contact| contact.normal),
        overlap: number(|contact| contact.overlap),
        overlap_rate: number(|contact| contact.overlap_rate),
        overlap_step: number(|contact| contact.overlap_step),
        slip_velocity: vector(|contact| contact.slip_velocity),
        slip_step: vector(|contact| contact.slip_step),
        relative_spin: vector(|contact| contact.relative_spin),
        relative_turn: vector(|contact| contact.relative_turn),
        inverse_radius_eff: number(|contact| contact.inverse_radius_eff),
        inverse_radius_eff_before: number(|contact| contact.inverse_radius_eff_before),
        inverse_mass_eff: number(|contact| contact.inverse_mass_eff),
        rolling_mobility: number(|contact| contact.rolling_mobility),
    }
}

/// The episode as a plane sees it.
fn flat(contact: &Contact) -> Contact<f64, 1> {
    let first = |vector: Vec3| Vector::from([vector.x]);
    Contact {
        normal: first(Vec3::zeros()),
        overlap: contact.overlap,
        overlap_rate: contact.overlap_rate,
        overlap_step: contact.overlap_step,
        slip_velocity: first(contact.slip_velocity),
        slip_step: first(contact.slip_step),
        relative_spin: first(contact.relative_spin),
        relative_turn: first(contact.relative_turn),
        inverse_radius_eff: contact.inverse_radius_eff,
        inverse_radius_eff_before: contact.inverse_radius_eff_before,
        inverse_mass_eff: contact.inverse_mass_eff,
        rolling_mobility: contact.rolling_mobility,
    }
}

/// Plays the episode in eight lanes, each a contact ahead of the one before, and lane by lane.
fn assert_lanes_agree<const N: usize>(
    law: &(dyn ContactStage + 'static),
    episode: &[Contact<f64, N>],
) where
    dyn ContactStage: Sweep<f64, N> + Sweep<Eight, N>,
{
    let space = if N == 1 { Space::Planar } else { Space::Spatial };
    let len = law.history_len(space);
    let (mut together, mut alone) = (vec![0.0; MOST_LANES * len], vec![0.0; MOST_LANES * len]);
    let mut energy = [vec![0.0; law.channels().len()], vec![0.0; law.channels().len()]];
    let starts: [u32; MOST_LANES] = std::array::from_fn(|lane| (lane * len) as u32);
    let base = |overlap: f64| match law.slot() {
        Slot::Base => [0.0; 2],
        _ => [3200.0 * overlap.max(0.0), 3200.0],
    };
    for step in 0..episode.len() {
        let contacts: [Contact<f64, N>; MOST_LANES] =
            std::array::from_fn(|lane| episode[(step + lane) % episode.len()]);
        let pressed = |at: usize| Eight::from_lanes(|lane| base(contacts[lane].overlap)[at]);
        let [normal_force, normal_stiffness] = [pressed(0), pressed(1)];
        let mut eight =
            Response::<Eight, N> { normal_force, normal_stiffness, ..Response::default() };
        let batch = Batch {
            partner: Partner::Grain,
            contacts: &[side_by_side(contacts)],
            records: &[starts],
            responses: std::slice::from_mut(&mut eight),
        };
        let histories = Histories { values: &mut together, offset: 0 };
        Sweep::<Eight, N>::sweep(law, batch, DT, histories, Some(&mut energy[0]));
        for (lane, contact) in contacts.iter().enumerate() {
            let [normal_force, normal_stiffness] = base(contact.overlap);
            let mut one =
                Response::<f64, N> { normal_force, normal_stiffness, ..Response::default() };
            let batch = Batch {
                partner: Partner::Grain,
                contacts: std::slice::from_ref(contact),
                records: &[[starts[lane]; MOST_LANES]],
                responses: std::slice::from_mut(&mut one),
            };
            let histories = Histories { values: &mut alone, offset: 0 };
            Sweep::<f64, N>::sweep(law, batch, DT, histories, Some(&mut energy[1]));
            let what = format!("{} in lane {lane} of step {step}", law.name());
            let same = |eight: Eight, one: f64| eight.lane(lane).total_cmp(&(one + 0.0)).is_eq();
            let zero = Eight::from_lanes(|_| 0.0);
            assert!(same(eight.normal_force + zero, one.normal_force), "{what}");
            assert!(same(eight.adhesive_force + zero, one.adhesive_force), "{what}");
            for at in 0..N {
                assert!(
                    same(eight.tangential_force[at] + zero, one.tangential_force[at]),
                    "{what}"
                );
                assert!(same(eight.couple[at] + zero, one.couple[at]), "{what}");
            }
        }
        assert_eq!(together, alone, "{} remembers something else", law.name());
    }
    let [together, alone] = energy;
    assert_close(together.into_iter().zip(alone), law.name());
}

#[test]
fn every_registered_law_says_the_same_of_eight_contacts_at_once_and_of_each_alone() {
    for entry in LAWS {
        let law = (entry.build)(&table(entry));
        let flat: Vec<Contact<f64, 1>> = episode().iter().map(flat).collect();
        assert_lanes_agree(&*law, &episode());
        assert_lanes_agree(&*law, &flat);
    }
}

#[test]
fn every_registered_law_is_silent_where_nothing_touches() {
    for entry in LAWS {
        let law = (entry.build)(&table(entry));
        let mut contact = episode().remove(0);
        for overlap in [0.0, -1e-9] {
            contact.overlap = overlap;
            contact.overlap_step = 0.0;
            let before = before_the_law(&*law, &contact);
            let (after, energy) = play(&*law, std::slice::from_ref(&contact));
            let change = (after[0].normal_force - before.normal_force).abs()
                + after[0].tangential_force.norm()
                + after[0].couple.norm()
                + energy.iter().map(|energy| energy.abs()).sum::<f64>();
            assert!(change <= 0.0, "{} at {overlap:e}: {change:e}", entry.name);
        }
    }
}

#[test]
fn every_registered_law_has_channels_of_its_own_in_whatever_bed() {
    // Base laws may share: a bed has one of them.
    for base in LAWS.iter().filter(|entry| entry.acts_on == ActsOn::ContactBase) {
        let effects = LAWS.iter().filter(|entry| entry.acts_on == ActsOn::ContactEffect);
        let mut seen = Vec::new();
        for channel in std::iter::once(base).chain(effects).flat_map(|entry| entry.channels) {
            let account = (channel.name, channel.kind);
            assert!(!seen.contains(&account), "{account:?} is booked twice");
            seen.push(account);
        }
    }
}

#[test]
fn a_head_on_collision_of_a_linear_law_rebounds_as_its_damping_says() {
    let entry = contact_laws::find("linear-spring-dashpot").expect("the law is registered");
    let (stiffness, mass) = (3200.0, 2.45e-5);
    for rate in [0.0, 1e3, 1e4] {
        let mut table = table(entry);
        table.set("normal_stiffness", stiffness);
        table.set("normal_damping_rate", rate);
        let stages = [(entry.build)(&table)];
        let encounter = Encounter { mass_eff: mass, radius_eff: 1e-3, speed: 0.5 };
        let found = engine::rebound::restitution(&stages, Partner::Grain, &encounter);
        // A damped oscillator through half its period; it may attract before it lets go.
        let natural = (stiffness / mass - 0.25 * rate * rate).sqrt();
        let exact = libm::exp(-0.5 * rate * std::f64::consts::PI / natural);
        // The last step, of which there are 2000, is taken whole.
        assert!((found.expect("it has a duration") - exact).abs() < 1e-3, "{found:?} {exact}");
    }
}
