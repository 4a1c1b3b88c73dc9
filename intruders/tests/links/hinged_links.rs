//! The chain as it moves in a bed of grains, here without one, against the chain of the solver.

use resistive::{Impact, PartLoad, State, Surroundings};

use super::common::{DIAMETER, FINE, LENGTH, MASS, chain, resistance, sand};
use engine::body::Mechanism;
use engine::grains::Space;
use engine::math::Vec3;
use engine::params::ParamTable;
use engine::surface::Wrench;
use intruders::HingedLinks;

const GRAVITY: f64 = 9.81;
const ANGLES: [f64; 2] = [0.8, -0.4];

/// At the joint (m/s), and of both links (rad/s).
const VELOCITY: Vec3 = Vec3::new(0.3, 0.0, 0.2);
const SPIN: f64 = 9.0;

/// Velocity of the deeper tip, which is that of the second link (m/s).
fn tip_velocity() -> Vec3 {
    let (sin, cos) = libm::sincos(ANGLES[1]);
    VELOCITY + Vec3::new(-cos, 0.0, sin) * (SPIN * LENGTH)
}

fn links(height: f64) -> HingedLinks {
    let mut params = ParamTable::new();
    let given = [
        ("length", LENGTH),
        ("diameter", DIAMETER),
        ("link_angle_1", ANGLES[0]),
        ("link_angle_2", ANGLES[1]),
    ];
    for (key, value) in given {
        params.set(key, value);
    }
    let make = intruders::find("two-link-chain").and_then(|entry| entry.links).expect("a chain");
    let mut links = make(&params, Space::Spatial, 2.0 * MASS);
    links.launch(Vec3::new(0.0, 0.03, height), tip_velocity(), SPIN);
    links
}

/// Steps of `dt` (s) in empty space, with a look after each.
fn fly(
    links: &mut HingedLinks,
    gravity: f64,
    (dt, steps): (f64, usize),
    mut look: impl FnMut(&HingedLinks),
) {
    let (nothing, gravity) = ([Wrench::default(); 2], Vec3::new(0.0, 0.0, -gravity));
    links.load(&nothing, gravity);
    for _ in 0..steps {
        links.kick_drift(dt);
        links.load(&nothing, gravity);
        links.kick(dt);
        look(links);
    }
}

/// Kinetic and potential energy (J).
fn energy(links: &HingedLinks, gravity: f64) -> f64 {
    links
        .bodies()
        .iter()
        .map(|body| {
            let [translation, rotation] = body.kinetic_energy();
            translation + rotation + body.mass * gravity * body.position.z
        })
        .sum()
}

/// Largest distance (m) of the middle or the top of a link from where the solver has them after a
/// second.
fn error_after_a_second(gravity: f64, dt: f64) -> f64 {
    let height = 1000.0;
    let launchable = chain(ANGLES, Vec3::zeros());
    let [angle_1, angle_2] = ANGLES;
    let start = State {
        position: [0.0, height, angle_1, angle_2],
        rate: [VELOCITY.x, VELOCITY.z, SPIN, SPIN],
        ..State::default()
    };
    let bed = Surroundings { gravity, ..sand() };
    let impact =
        Impact::new(launchable.assembly, vec![resistance()], bed, start).with_tolerance(FINE);
    let end = impact.run(1.0, &mut ()).expect("the flight can be followed").state;
    let mut links = links(height);
    fly(&mut links, gravity, (dt, (1.0 / dt).round() as usize), |_| ());
    let apart = |index: usize| {
        let (body, (centre, angle)) =
            (&links.bodies()[index], impact.assembly().placement(index, &end));
        let (sin, cos) = libm::sincos(angle);
        let axis = Vec3::new(sin, 0.0, cos) * (0.5 * LENGTH);
        let moved = body.position - Vec3::y() * 0.03 - centre;
        moved.norm().max((moved + body.orientation * Vec3::z() * (0.5 * LENGTH) - axis).norm())
    };
    apart(0).max(apart(1))
}

#[test]
fn a_free_chain_moves_as_that_of_the_solver_to_second_order_in_the_step() {
    for gravity in [0.0, GRAVITY] {
        let errors = [1e-3, 5e-4, 2.5e-4].map(|dt| error_after_a_second(gravity, dt));
        for pair in errors.windows(2) {
            let order = libm::log2(pair[0] / pair[1]);
            assert!(order > 1.9, "gravity {gravity}: {errors:?}, order {order}");
        }
        assert!(errors[2] < 1e-4, "gravity {gravity}: {errors:?}");
    }
}

#[test]
fn the_energy_of_a_free_chain_swings_within_second_order_and_does_not_drift() {
    for gravity in [0.0, GRAVITY] {
        let worst = [2e-3, 1e-3].map(|dt| {
            let mut links = links(0.0);
            let scale = energy(&links, 0.0);
            let before = energy(&links, gravity);
            let (mut halves, mut seen, steps) = ([0.0_f64; 2], 0, (10.0 / dt) as usize);
            fly(&mut links, gravity, (dt, steps), |links| {
                let half = usize::from(2 * seen >= steps);
                let error = (energy(links, gravity) - before).abs() / scale;
                halves[half] = halves[half].max(error);
                seen += 1;
            });
            // The same swing in the second five seconds as in the first; a drift would double it.
            assert!(halves[1] < 1.3 * halves[0], "gravity {gravity}: {halves:?}");
            halves[0].max(halves[1])
        });
        assert!(worst[1] < 1e-3 && worst[0] / worst[1] > 3.5, "gravity {gravity}: {worst:?}");
    }
}

#[test]
fn without_gravity_momentum_and_angular_momentum_stay_to_round_off() {
    let mut links = links(0.0);
    let momenta = |links: &HingedLinks| {
        let mut sums = (Vec3::zeros(), 0.0);
        for body in links.bodies() {
            let momentum = body.velocity * body.mass;
            sums.0 += momentum;
            let arm = body.position - Vec3::y() * 0.03;
            sums.1 += arm.cross(&momentum).y + body.angular_momentum.y;
        }
        sums
    };
    let before = momenta(&links);
    let mut worst = (0.0_f64, 0.0_f64);
    fly(&mut links, 0.0, (1e-3, 10_000), |links| {
        let now = momenta(links);
        worst.0 = worst.0.max((now.0 - before.0).norm());
        worst.1 = worst.1.max((now.1 - before.1).abs());
    });
    // Ten thousand steps with some 1e-17 of round-off each, of 0.05 kg m/s and 0.04 kg m²/s, and an
    // arm that grows to 3 m.
    assert!(worst.0 < 1e-14 && worst.1 < 1e-13, "{worst:?} of {before:?}");
}

#[test]
fn the_joint_never_opens() {
    let mut links = links(0.0);
    fly(&mut links, GRAVITY, (1e-3, 2_000), |links| {
        let [front, rear] = links.bodies() else { panic!("two links") };
        let top = |body: &engine::body::RigidBody| {
            body.position + body.orientation * Vec3::z() * (0.5 * LENGTH)
        };
        // Round-off of sums at 20 m, without a trend.
        assert!((top(front) - top(rear)).norm() < 2e-14);
        for body in [front, rear] {
            assert_eq!((body.position.y.to_bits(), body.velocity.y), (0.03_f64.to_bits(), 0.0));
        }
    });
}

#[test]
fn loads_accelerate_the_chain_as_the_equations_of_the_solver_say() {
    let launchable = chain(ANGLES, Vec3::zeros());
    let forces = [Vec3::new(-2.0, 0.5, 7.0), Vec3::new(1.5, -0.5, 4.0)];
    let couples = [0.3, -0.2];
    // All of it immersed, so that the load of a link acts on its centre.
    let start = State { position: [0.0, -1.0, ANGLES[0], ANGLES[1]], ..State::default() };
    let loads = [0, 1].map(|index: usize| PartLoad {
        force: Vec3::new(forces[index].x, 0.0, forces[index].z),
        couple: couples[index],
        added_mass: 0.0,
    });
    let expected = launchable.assembly.accelerate(&start, &loads, GRAVITY);

    let mut links = links(-1.0);
    links.launch(Vec3::new(0.0, 0.0, -1.0), Vec3::zeros(), 0.0);
    let wrenches = [0, 1].map(|index: usize| Wrench {
        force: forces[index],
        torque: Vec3::new(0.7, couples[index], -0.4),
        contacts: 1,
    });
    links.load(&wrenches, Vec3::new(0.0, 0.0, -GRAVITY));
    // From rest, a kick of two seconds leaves the rates that a second of acceleration makes.
    links.kick(2.0);
    for (index, body) in links.bodies().iter().enumerate() {
        // Two ways through the same 4 by 4 matrix.
        assert!((body.spin().y / expected[2 + index] - 1.0).abs() < 1e-12, "link {index}");
        let (sin, cos) = libm::sincos(ANGLES[index]);
        let arm = 0.5 * LENGTH * expected[2 + index];
        let velocity = Vec3::new(expected[0] - arm * cos, 0.0, expected[1] + arm * sin);
        assert!((body.velocity - velocity).norm() < 1e-11, "link {index}");
    }
}

#[test]
fn a_saved_chain_is_restored_to_the_bit_and_goes_on_so() {
    let mut chain = links(0.0);
    fly(&mut chain, GRAVITY, (1e-3, 10), |_| ());
    let mut other = links(5.0);
    assert!(other.restore(&chain.save()));
    assert_eq!(other.save(), chain.save());
    for links in [&mut chain, &mut other] {
        fly(links, GRAVITY, (1e-3, 10), |_| ());
    }
    assert_eq!(other.save(), chain.save());
    assert!(!other.restore(&[1.0, 2.0]));
}
