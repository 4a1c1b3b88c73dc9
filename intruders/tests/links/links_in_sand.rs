//! Links and chains under the resistance of a link, from first contact to rest.

use resistive::{Ending, Impact, PartSample, Recorder, State, Trajectory};

use super::common::{chain, down, into_sand, law, link, resistance};
use engine::math::Vec3;

/// Longer than any of these impacts (s).
const LONG: f64 = 2.0;

fn run(impact: &Impact) -> Ending {
    impact.run(LONG, &mut ()).expect("the impact can be followed")
}

/// The samples of an impact, the energy given by each part and the relative closure of the ledger.
fn record(impact: &Impact) -> (Vec<Vec<PartSample>>, [f64; 2], f64) {
    let mut samples = Vec::new();
    let mut recorder = Recorder::new(impact, 1e-3, |sample| samples.push(sample.parts.to_vec()));
    impact.run(LONG, &mut recorder).expect("the impact can be followed");
    let given = *recorder.given();
    let closure = recorder.ledger().closure(recorder.ledger().balance().initial);
    (samples, given, closure)
}

/// Kinetic energy and potential energy of all parts (J).
fn mechanical_energy(impact: &Impact, state: &State) -> f64 {
    let assembly = impact.assembly();
    (0..assembly.n_parts())
        .map(|part| {
            let [translation, rotation] = assembly.kinetic_energy(part, state);
            let (height, mass) = assembly.weight_at(part, state);
            translation + rotation + mass * impact.bed().gravity * height
        })
        .sum()
}

#[test]
fn a_link_stops_at_every_angle_and_speed_without_chatter() {
    for angle in [0.0, 10.0, 32.0, 47.0, 62.0, 80.0, -32.0] {
        for speed in [0.5, 1.0, 2.0, 3.0, 5.0] {
            let launchable = link(f64::to_radians(angle), down(speed), 0.0);
            let ending = run(&into_sand(launchable, vec![resistance()]));
            assert!(ending.stopped && ending.time < 0.1, "{angle} {speed}");
            // Between 11 and 28: friction lets go or takes hold a few times at most.
            assert!(ending.steps < 200, "{angle} {speed}: {} steps", ending.steps);
        }
    }
}

#[test]
fn a_chain_stops_at_every_pair_of_angles_without_chatter() {
    let pairs =
        [[32.0, -32.0], [32.0, -20.0], [50.0, 10.0], [32.0, 32.0], [0.0, 0.0], [20.0, 40.0]];
    for angles in pairs {
        for speed in [0.5, 1.0, 2.0, 3.0, 5.0] {
            let launchable = chain(angles.map(f64::to_radians), down(speed));
            let ending = run(&into_sand(launchable, vec![resistance()]));
            assert!(ending.stopped && ending.time < 0.2, "{angles:?} {speed}");
            let stops = ending.parts.map(|part| (part.contact, part.vertical));
            let in_order = |(contact, stop)| contact < stop;
            assert!(stops.into_iter().all(in_order), "{angles:?} {speed}: {stops:?}");
            // Between 11 and 61.
            assert!(ending.steps < 400, "{angles:?} {speed}: {} steps", ending.steps);
        }
    }
}

#[test]
fn a_link_that_is_thrown_sideways_reverses_and_sticks_without_chatter() {
    for (angle, x, spin) in
        [(0.5, 1.0, 0.0), (0.5, -1.0, 0.0), (-0.2, 0.05, 20.0), (0.0, 0.0, -30.0)]
    {
        let launchable = link(angle, Vec3::new(x, 0.0, -1.5), spin);
        let ending = run(&into_sand(launchable, vec![resistance()]));
        assert!(ending.stopped && ending.steps < 400, "{angle} {x} {spin}: {}", ending.steps);
    }
}

#[test]
fn a_chain_of_which_friction_holds_everything_is_at_rest() {
    let launchable = chain([50.0, 10.0].map(f64::to_radians), down(1.0));
    let ending = run(&into_sand(launchable, vec![resistance()]));
    assert!(ending.stopped);
    assert!(ending.state.rate.iter().all(|rate| rate.abs() < f64::MIN_POSITIVE));
    let last =
        ending.parts.map(|part| part.vertical).into_iter().max_by(|a, b| a.partial_cmp(b).unwrap());
    assert_eq!(last.flatten(), Some(ending.time));
}

#[test]
fn where_a_tip_stops_friction_is_still_against_the_motion_of_the_middle() {
    let impact = into_sand(link(32_f64.to_radians(), down(2.0), 0.0), vec![resistance()]);
    let (samples, ..) = record(&impact);
    let last = samples.last().expect("there is a sample at the end")[0];
    assert!(last.part.tip_velocity.z.abs() < 1e-9, "the tip has stopped");
    assert!(last.part.velocity.z < -0.1, "the middle has not");
    assert!(last.friction.z > 0.0, "{:?}", last.friction);
}

#[test]
fn the_energy_that_the_links_give_to_the_bed_is_what_they_lose() {
    for angles in [[32.0, -32.0], [32.0, -20.0], [50.0, 10.0]] {
        let launchable = chain(angles.map(f64::to_radians), down(2.0));
        let impact = into_sand(launchable, vec![resistance()]);
        let (_, given, closure) = record(&impact);
        let ending = run(&impact);
        let before = mechanical_energy(&impact, impact.start());
        let lost = before - mechanical_energy(&impact, &ending.state);
        // Both sides are integrated, to some 1e-10 by solver and quadrature.
        assert!(closure < 1e-8, "{angles:?}: {closure:e}");
        assert!(((given[0] + given[1]) / lost - 1.0).abs() < 1e-8, "{angles:?}");
    }
}

#[test]
fn a_link_that_drifted_before_its_contact_enters_as_it_moves() {
    // The second tip starts without horizontal velocity and has 0.1 m/s when it meets the surface.
    let laws = vec![resistance(), law("added-mass", &[("q", 1.0)])];
    let ending = run(&into_sand(chain([0.3, -0.5], down(3.0)), laws));
    assert!(ending.stopped && ending.steps < 400, "{} steps", ending.steps);
}

#[test]
fn friction_against_the_direction_of_motion_follows_a_link_that_turns() {
    let laws = vec![law("two-term-vector", &[("drag", 1.0), ("friction", 15.0)])];
    let (samples, _, closure) = record(&into_sand(link(0.8, down(3.0), 0.0), laws));
    let sideways = |sample: &&Vec<PartSample>| sample[0].part.velocity.x.abs() > 0.1;
    assert!(samples.iter().filter(sideways).count() > 3, "it goes sideways");
    for part in samples.iter().skip(1).map(|sample| sample[0]) {
        let along = part.friction.cross(&part.part.velocity).norm();
        // Parallel but for round-off.
        let most = 1e-12 * part.friction.norm() * part.part.velocity.norm();
        assert!(along <= most && part.friction.dot(&part.part.velocity) <= 0.0, "{part:?}");
    }
    assert!(closure < 1e-9, "{closure:e}");
}

#[test]
fn grains_that_move_with_a_link_that_turns_are_accounted_for() {
    for angle in [0.3, 0.8] {
        let launchable = link(angle, down(3.0), 0.0);
        let laws = vec![resistance(), law("added-mass", &[("q", 1.0)])];
        let (_, _, closure) = record(&into_sand(launchable, laws));
        // The error of solver and quadrature; a rate of the volume taken from the middle leaves 1e-3.
        assert!(closure < 1e-9, "{angle}: {closure:e}");
    }
}

#[test]
fn mirrored_angles_give_a_mirrored_motion_and_half_of_the_energy_to_each_link() {
    let impact = into_sand(chain([0.5, -0.5], down(2.0)), vec![resistance()]);
    let times: Vec<f64> = (1..40).map(|k| 1e-3 * f64::from(k)).collect();
    let mut trajectory = Trajectory::at(&times);
    impact.run(LONG, &mut trajectory).expect("the impact can be followed");
    let start_x = impact.start().position[0];
    for state in trajectory.states() {
        let [x, _, q1, q2] = state.position;
        // Every operation has its mirror image: round-off of the linear solver alone.
        assert!((x - start_x).abs() < 1e-12 && (q1 + q2).abs() < 1e-11, "{state:?}");
    }
    let (_, given, _) = record(&impact);
    assert!((given[0] / given[1] - 1.0).abs() < 1e-11, "{given:?}");

    let mirrored = into_sand(chain([-0.5, 0.5], down(2.0)), vec![resistance()]);
    let (here, there) = (run(&impact), run(&mirrored));
    // Round-off decides on which step friction lets a component go, so the steps differ and with them
    // the error of the solver, 1e-10.
    assert!((here.time / there.time - 1.0).abs() < 1e-8);
    assert!((here.parts[0].depth / there.parts[0].depth - 1.0).abs() < 1e-8);
}

#[test]
fn a_link_that_moves_along_its_axis_meets_no_drag() {
    let only_drag = || {
        let zero = [("horizontal", 0.0), ("plunging", 0.0), ("withdrawing", 0.0)];
        law("link", &[[("drag", 5.0)].as_slice(), &zero].concat())
    };
    let (angle, speed) = (0.4_f64, 2.0);
    let velocity = Vec3::new(-libm::sin(angle), 0.0, -libm::cos(angle)) * speed;
    let launchable = link(angle, velocity, 0.0);
    let mut bed = super::common::sand();
    bed.gravity = 0.0;
    let rate = launchable.start.rate;
    let impact = Impact::new(launchable.assembly, vec![only_drag()], bed, launchable.start);
    let ending = impact.run(0.05, &mut ()).expect("nothing acts on it");
    for (now, before) in ending.state.rate.into_iter().zip(rate) {
        // The angle between axis and velocity is zero but for round-off.
        assert!((now - before).abs() < 1e-12, "{:?}", ending.state.rate);
    }
    let across = link(angle, Vec3::new(libm::cos(angle), 0.0, -libm::sin(angle)) * speed, 0.0);
    let impact = Impact::new(across.assembly, vec![only_drag()], bed, across.start);
    let ending = impact.run(0.05, &mut ()).expect("the impact can be followed");
    assert!(ending.state.rate[0] < 0.9 * rate[0].abs().max(speed), "drag acts across");
}

#[test]
fn a_steeper_and_a_faster_link_goes_deeper_and_a_faster_one_stops_sooner() {
    let depth_and_time = |angle: f64, speed| {
        let ending =
            run(&into_sand(link(angle.to_radians(), down(speed), 0.0), vec![resistance()]));
        (ending.parts[0].depth, ending.time)
    };
    for (steep, flat) in [(0.0, 32.0), (32.0, 55.0)] {
        let (here, there) = (depth_and_time(steep, 2.0), depth_and_time(flat, 2.0));
        assert!(here.0 > there.0 && here.1 > there.1, "{steep} and {flat}");
    }
    let (slow, fast) = (depth_and_time(32.0, 1.3), depth_and_time(32.0, 2.3));
    assert!(fast.0 > slow.0 && fast.1 < slow.1);
}
