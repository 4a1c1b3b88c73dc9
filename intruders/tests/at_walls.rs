//! Walls and floor act on the intruder as on a grain.

use std::f64::consts::PI;

use engine::body::{Mechanism, RigidBody};
use engine::boundary::{Base, Container};
use engine::error::StepError;
use engine::grain_bed::{GrainBed, RestingBed};
use engine::grains::{Grain, Space};
use engine::math::{Quat, Vec3, turned_about_y};
use engine::parallel::with_threads;
use engine::params::ParamTable;
use engine::simulation::{Settings, Simulation, Snapshot};
use engine::stage::ContactStage;
use engine::world::World;

/// A shape, its parameters, and its space.
type Shape = (&'static str, &'static [(&'static str, f64)], Space);

const BALL: Shape = ("sphere", &[("diameter", 0.02)], Space::Spatial);
const DISC: Shape = ("disc", &[("diameter", 0.02)], Space::Planar);
const CYLINDER: Shape = ("cylinder", &[("diameter", 0.02), ("height", 0.01)], Space::Spatial);
const RECTANGLE: Shape = ("cylinder", &[("diameter", 0.02), ("height", 0.01)], Space::Planar);
const HEMISPHERE: Shape = ("hemisphere", &[("diameter", 0.02)], Space::Spatial);
const HALF_DISC: Shape = ("hemisphere", &[("diameter", 0.02)], Space::Planar);
const CONE: Shape = ("cone", &[("diameter", 0.02), ("apex_angle", 1.2)], Space::Spatial);
const WEDGE: Shape = ("cone", &[("diameter", 0.02), ("apex_angle", 1.2)], Space::Planar);
const LINK: Shape = ("link", &[("length", 0.04), ("diameter", 0.01)], Space::Spatial);
const FLAT_LINK: Shape = ("link", &[("length", 0.04), ("diameter", 0.01)], Space::Planar);

const SHAPES: [Shape; 10] =
    [BALL, DISC, CYLINDER, RECTANGLE, HEMISPHERE, HALF_DISC, CONE, WEDGE, LINK, FLAT_LINK];

/// (kg).
const MASS: f64 = 0.02;

/// Radius (m) of the grains.
const GRAIN: f64 = 2.28e-3;

const GRAVITY: f64 = 9.81;

/// (N/m).
const STIFFNESS: f64 = 1e5;

/// The linear law; what is not for walls would show at once if a wall took it.
#[derive(Clone, Copy)]
struct AtWalls {
    friction: f64,
    normal_damping_rate: f64,
    tangential_damping_rate: f64,
}

const SPRINGS: AtWalls =
    AtWalls { friction: 0.0, normal_damping_rate: 0.0, tangential_damping_rate: 0.0 };

/// A law that dissipates in every way.
const ROUGH: AtWalls =
    AtWalls { friction: 0.3, normal_damping_rate: 300.0, tangential_damping_rate: 200.0 };

/// The law called `name` with SI values for all of its parameters.
fn law(name: &str, values: &[(&'static str, f64)]) -> Box<dyn ContactStage> {
    let params: ParamTable = values.iter().copied().collect();
    (contact_laws::find(name).expect("it is registered").build)(&params)
}

/// Rolling resistance with this μ_r (–).
fn rolling(rolling_friction: f64) -> Box<dyn ContactStage> {
    let values = [("rolling_friction", rolling_friction), ("rolling_damping_ratio", 0.3)];
    law("rolling-resistance", &values)
}

impl AtWalls {
    fn stage(self) -> Box<dyn ContactStage> {
        let values = [
            ("normal_stiffness", STIFFNESS),
            ("tangential_stiffness", STIFFNESS),
            ("normal_damping_rate", self.normal_damping_rate),
            ("tangential_damping_rate", self.tangential_damping_rate),
            ("friction", 0.9),
            ("wall_friction", self.friction),
            ("intruder_friction", 0.7),
        ];
        law("linear-spring-dashpot", &values)
    }
}

/// Its mass goes by no grain: so many kilograms of the shape, at rest at the origin.
fn body((name, values, space): Shape) -> RigidBody {
    let params: ParamTable = values.iter().copied().collect();
    let body = (intruders::find(name).expect("it is registered").build)(&params, space);
    RigidBody::new(name, body.surface, MASS, body.inertia_per_mass * MASS)
}

/// `body` in `container`, beside a grain that floats out of its way where there is no gravity.
fn alone(
    body: impl Mechanism + 'static,
    (space, container): (Space, Container),
    gravity: f64,
    laws: Vec<Box<dyn ContactStage>>,
    dt: f64,
) -> World {
    let y = if space == Space::Spatial { 0.1 } else { 0.0 };
    let far = match gravity > 0.0 {
        true => Vec3::new(GRAIN, y, GRAIN),
        false => Vec3::new(0.1, y, 0.5),
    };
    let (n_parts, grains) = (body.parts().len(), vec![grain(far, Vec3::zeros(), 0)]);
    let bed = bed((space, container), gravity, grains, laws, n_parts);
    World::new(bed, Box::new(body), dt)
}

fn grain(position: Vec3, velocity: Vec3, id: u32) -> Grain {
    Grain { position, velocity, spin: Vec3::zeros(), radius: GRAIN, mass: 4.9e-5, id }
}

fn bed(
    (space, container): (Space, Container),
    gravity: f64,
    grains: Vec<Grain>,
    laws: Vec<Box<dyn ContactStage>>,
    n_parts: usize,
) -> GrainBed {
    let resting = RestingBed::without_history(space, grains);
    GrainBed::new(&resting, container, Vec3::z() * -gravity, laws, n_parts)
}

fn run(world: &mut World, n: usize) {
    for _ in 0..n {
        world.advance().expect("a sound step");
    }
}

const BOX: Container = Container::walled_box(0.2, 0.2);

/// The middle of [`BOX`], at `z` (m).
fn middle(space: Space, z: f64) -> Vec3 {
    Vec3::new(0.1, if space == Space::Spatial { 0.1 } else { 0.0 }, z)
}

/// Kinetic and potential energy of the intruder (J).
fn energy(world: &World) -> f64 {
    let body = &world.intruder().bodies()[0];
    body.kinetic_energy().iter().sum::<f64>() + MASS * GRAVITY * body.position.z
}

/// Speed after over speed before a collision with a spring of [`STIFFNESS`] and a dashpot: what a damped oscillator has
/// left after half a period.
fn restitution(damping_rate: f64) -> f64 {
    let half = 0.5 * damping_rate;
    let natural_2 = STIFFNESS / MASS;
    let damped = (natural_2 - half * half).sqrt();
    libm::exp(-half * PI / damped)
}

#[test]
fn a_ball_dropped_on_the_floor_bounces_to_the_square_of_its_restitution() {
    for shape in [BALL, DISC] {
        for damping_rate in [0.0, 200.0, 1000.0] {
            let e = restitution(damping_rate);
            let (height, radius) = (0.05, 0.01);
            let mut ball = body(shape);
            let start = middle(shape.2, radius + height);
            ball.launch(start, Quat::identity(), Vec3::zeros(), Vec3::zeros());
            let law = AtWalls { normal_damping_rate: damping_rate, ..SPRINGS };
            let mut world = alone(ball, (shape.2, BOX), GRAVITY, vec![law.stage()], 2e-6);
            let (mut top, mut has_bounced) = (0.0_f64, false);
            // Down in 0.1 s, and up in no more.
            for _ in 0..100_000 {
                run(&mut world, 1);
                let ball = &world.intruder().bodies()[0];
                has_bounced |= ball.contact.contacts > 0;
                if has_bounced {
                    top = top.max(ball.position.z - radius);
                }
            }
            assert!(has_bounced);
            // In the contact, which lasts √(m/k) π = 1.4 ms, the weight stops m g against a force of some v √(k m) = 44 N.
            assert!((top / height - e * e).abs() < 5e-3, "{}: {top} {e}", shape.0);
        }
    }
}

#[test]
fn every_wall_sends_a_ball_back_with_its_restitution() {
    let law = AtWalls { normal_damping_rate: 500.0, ..SPRINGS };
    let e = restitution(500.0);
    let cylinder =
        Container { base: Base::Circle { diameter: 0.2 }, ..Container::walled_box(0.2, 0.2) };
    let aslant = Vec3::new(0.6, 0.8, 0.0);
    let down = -Vec3::z();
    let flat = [Vec3::x(), -Vec3::x(), Vec3::y(), -Vec3::y(), down];
    let walls = flat.map(|direction| (BOX, direction)).into_iter();
    let round = [aslant, Vec3::y(), down].map(|direction| (cylinder, direction));
    for (container, direction) in walls.chain(round) {
        for shape in [BALL, DISC] {
            if shape.2 == Space::Planar && (direction.y != 0.0 || container.base != BOX.base) {
                continue;
            }
            let mut ball = body(shape);
            let start = middle(shape.2, 0.1);
            ball.launch(start, Quat::identity(), direction * 2.0, Vec3::zeros());
            let mut world = alone(ball, (shape.2, container), 0.0, vec![law.stage()], 2e-6);
            // There and back takes 0.1 s.
            run(&mut world, 30_000);
            let velocity = world.intruder().bodies()[0].velocity;
            // The dashpot pulls at the end, and the contact opens inside of a step: γ dt = 1e-3 of the speed at most.
            assert!((velocity + direction * (2.0 * e)).norm() < 1e-3, "{velocity:?} {direction:?}");
            let walls = world.ledger().value("dissipated_walls_J").expect("an account of walls");
            let lost = 0.5 * MASS * 4.0 * (1.0 - e * e);
            assert!((walls / lost - 1.0).abs() < 1e-3, "{walls:e} of {lost:e}");
        }
    }
}

#[test]
fn a_face_slides_along_a_wall_with_the_friction_of_walls() {
    for shape in [CYLINDER, RECTANGLE] {
        let law = AtWalls { friction: 0.25, normal_damping_rate: 500.0, ..SPRINGS };
        let mut slider = body(shape);
        // In equilibrium on the points that carry it: three in space, two in a plane.
        let n = if shape.2 == Space::Spatial { 3.0 } else { 2.0 };
        let start = middle(shape.2, 0.005 - MASS * GRAVITY / (n * STIFFNESS)) - Vec3::x() * 0.05;
        let speed = 0.5;
        slider.launch(start, Quat::identity(), Vec3::x() * speed, Vec3::zeros());
        let mut world = alone(slider, (shape.2, BOX), GRAVITY, vec![law.stage()], 5e-6);
        let deceleration = law.friction * GRAVITY;
        let time = speed / deceleration;
        let half_way = (0.5 * time / 5e-6) as usize;
        run(&mut world, half_way);
        let velocity = world.intruder().bodies()[0].velocity;
        // The face tips onto its front edge at first, by μ g against a spring of 1e5 N/m: for some milliseconds the normal
        // force swings about the weight.
        assert!((velocity.x - 0.5 * speed).abs() < 2e-3 * speed, "{}: {velocity:?}", shape.0);
        run(&mut world, half_way * 2);
        let slider = &world.intruder().bodies()[0];
        let way = slider.position.x - start.x;
        assert!((way / (0.5 * speed * time) - 1.0).abs() < 5e-3, "{way}");
        assert!(slider.velocity.norm() < 1e-5, "it sticks");
        assert!(slider.contact.contacts >= 2, "it lies on its face");
        let weight = slider.contact.force - Vec3::z() * (MASS * GRAVITY);
        assert!(weight.norm() < 1e-3 * MASS * GRAVITY, "{weight:?}");
    }
}

/// `shape`, thrown aslant and spinning at floor and sides, after `time` (s) of steps of `dt` (s): the worst energy
/// unaccounted for, over that at the start.
fn tumble(shape: Shape, law: AtWalls, time: f64, dt: f64) -> (f64, World) {
    let mut thrown = body(shape);
    let in_space = shape.2 == Space::Spatial;
    let velocity = Vec3::new(1.5, if in_space { 0.4 } else { 0.0 }, -1.0);
    let spin = if in_space { Vec3::new(10.0, 30.0, -5.0) } else { Vec3::y() * 30.0 };
    thrown.launch(middle(shape.2, 0.05), turned_about_y(0.7), velocity, spin);
    let start = 0.5 * MASS * velocity.norm_squared() + MASS * GRAVITY * 0.05;
    let mut world = alone(thrown, (shape.2, BOX), GRAVITY, vec![law.stage()], dt);
    let mut worst = 0.0_f64;
    for _ in 0..(time / dt).round() as usize {
        run(&mut world, 1);
        worst = worst.max(world.ledger().balance().unaccounted.abs() / start);
    }
    (worst, world)
}

#[test]
fn energy_closes_to_second_order_for_every_shape_that_tumbles_between_walls() {
    for law in [SPRINGS, ROUGH] {
        let mut sums = [0.0; 2];
        for shape in SHAPES {
            let (coarse, world) = tumble(shape, law, 0.15, 8e-6);
            let (fine, _) = tumble(shape, law, 0.15, 4e-6);
            let walls = world.ledger().value("dissipated_walls_J").expect("an account of walls");
            assert_eq!(walls > 1e-4, law.friction > 0.0, "{} {walls:e}", shape.0);
            // (ω dt)² = 3e-4 of the energy that a spring holds, some of which returns.
            assert!(coarse < 3e-4, "{} {:?}: {coarse:e}", shape.0, shape.2);
            sums = [sums[0] + coarse, sums[1] + fine];
        }
        // A contact that opens inside of a step leaves an error of its own phase, so not each by itself.
        assert!(sums[0] / sums[1] > 3.0, "{sums:?}");
    }
}

#[test]
fn every_shape_stays_between_its_walls_on_the_floor_and_no_energy_comes_back() {
    let law = AtWalls { normal_damping_rate: 1500.0, ..ROUGH };
    for shape in SHAPES {
        let (worst, mut world) = tumble(shape, law, 0.6, 1e-5);
        let (before, steps, mut lift) = (energy(&world), 5_000, 0.0);
        for _ in 0..steps {
            run(&mut world, 1);
            lift += world.intruder().bodies()[0].contact.force.z / f64::from(steps);
        }
        let at = world.intruder().bodies()[0].position;
        assert!((0.0..0.2).contains(&at.x) && (0.0..0.2).contains(&at.z), "{} {at:?}", shape.0);
        // What rolls goes on rolling, since nothing here resists it; the springs of the floor hold some 1e-8 J.
        assert!(energy(&world) <= before + 1e-7, "{}: {before:e} {:e}", shape.0, energy(&world));
        assert!(worst < 1e-3, "{}: {worst:e}", shape.0);
        // Some still rock on an edge, or fall over it.
        let lowest = world.intruder().bodies()[0].lowest();
        assert!(lift > 0.0 && lowest.abs() < 1e-3, "{} {lift} {lowest}", shape.0);
    }
}

#[test]
fn a_hertz_contact_of_a_ball_with_a_wall_has_the_theory_s_force_and_rebound() {
    let values = [
        [("young_modulus", 1e8), ("poisson_ratio", 0.25)],
        [("wall_young_modulus", 1e8), ("wall_poisson_ratio", 0.25)],
        [("intruder_young_modulus", 1e8), ("intruder_poisson_ratio", 0.25)],
        [("friction", 0.0), ("wall_friction", 0.0)],
        [("intruder_friction", 0.0), ("restitution", 1.0)],
        [("wall_restitution", 1.0), ("intruder_restitution", 1.0)],
        [("tangential_damping", 0.0), ("tangential_damping", 0.0)],
    ];
    let modulus_eff = 0.5 * 1e8 / (1.0 - 0.0625);
    let cylinder = Container { base: Base::Circle { diameter: 0.2 }, ..BOX };
    for (container, radius_eff) in [(BOX, 0.01_f64), (cylinder, 1.0 / (100.0 - 10.0))] {
        let mut ball = body(BALL);
        let start = middle(Space::Spatial, 0.1);
        ball.launch(start, Quat::identity(), Vec3::x(), Vec3::zeros());
        let laws = vec![law("hertz-mindlin", &values.concat())];
        let mut world = alone(ball, (Space::Spatial, container), 0.0, laws, 2e-6);
        let mut deepest = 0.0_f64;
        for _ in 0..60_000 {
            run(&mut world, 1);
            deepest = deepest.max(world.intruder().bodies()[0].position.x + 0.01 - 0.2);
        }
        // ½ m v² = (8/15) E* √R* δ^{5/2}, found between steps: (ω dt)² = 1e-5 of it.
        let exact = 0.5 * MASS / (8.0 / 15.0 * modulus_eff * radius_eff.sqrt());
        let exact = libm::pow(exact, 0.4);
        assert!((deepest / exact - 1.0).abs() < 1e-4, "{deepest:e} {exact:e}");
        let velocity = world.intruder().bodies()[0].velocity;
        assert!((velocity + Vec3::x()).norm() < 1e-4, "{velocity:?}");
    }
}

#[test]
fn rolling_resistance_stops_a_ball_on_the_floor() {
    let mut ball = body(BALL);
    let speed = 0.1;
    let start = middle(Space::Spatial, 0.01) - Vec3::x() * 0.05;
    ball.launch(start, Quat::identity(), Vec3::x() * speed, Vec3::y() * (speed / 0.01));
    let law = AtWalls { friction: 0.5, normal_damping_rate: 500.0, ..SPRINGS };
    let laws = vec![law.stage(), rolling(0.05)];
    let mut world = alone(ball, (Space::Spatial, BOX), GRAVITY, laws, 5e-6);
    // M = μ_r R m g against I = 7/5 m R² about the contact.
    let deceleration = 0.05 * GRAVITY / 1.4;
    let half = 0.5 * speed / deceleration;
    run(&mut world, (half / 5e-6) as usize);
    let velocity = world.intruder().bodies()[0].velocity.x;
    // The couple's spring winds up within some milliseconds.
    assert!((velocity / (0.5 * speed) - 1.0).abs() < 2e-2, "{velocity}");
}

fn snapshots(law: AtWalls) -> Simulation {
    // A layer from side to side, and one in its hollows.
    let spacing = (0.2 - 2.0 * GRAIN) / 42.0;
    let place = |k: u32| {
        let (column, row) = (f64::from(k % 43), f64::from(k / 43));
        let height = (4.0 * GRAIN * GRAIN - 0.25 * spacing * spacing).sqrt();
        Vec3::new(GRAIN + spacing * (column + 0.5 * row), 0.0, GRAIN + height * row)
    };
    let grains = (0..85).map(|k| grain(place(k), Vec3::zeros(), k)).collect();
    let mut thrown = body(RECTANGLE);
    let at = Vec3::new(0.17, 0.0, 0.06);
    thrown.launch(at, turned_about_y(0.3), Vec3::new(4.0, 0.0, -2.0), Vec3::y() * 10.0);
    let laws = vec![law.stage(), rolling(0.1)];
    let bed = bed((Space::Planar, BOX), GRAVITY, grains, laws, 1);
    let settings = Settings { dt: 5e-6, duration: 1.0, abort_above: 1.0 };
    Simulation::new(bed, Box::new(thrown), settings)
}

fn bytes(snapshot: &Snapshot) -> Vec<u8> {
    postcard::to_stdvec(snapshot).expect("a snapshot can be written")
}

/// Advances to `step`, and says in how many steps the intruder touched a wall.
fn advance_to(simulation: &mut Simulation, step: u64) -> usize {
    let mut touching = 0;
    while simulation.clock().step < step {
        simulation.advance().expect("a sound step");
        touching += usize::from(simulation.bed().intruder_wall_contacts() > 0);
    }
    touching
}

#[test]
fn a_run_resumed_while_the_intruder_touches_a_wall_and_on_any_number_of_threads_ends_alike() {
    const END: u64 = 3_000;
    let end = with_threads(1, || {
        let mut whole = snapshots(ROUGH);
        let (mut saved, mut touching) = (Vec::new(), 0);
        for step in (0..END).step_by(100) {
            saved.push(bytes(&whole.save()));
            touching += advance_to(&mut whole, step + 100);
        }
        assert!(whole.bed().touching_pairs().len() > 20, "grains touch");
        assert!(touching > 200, "{touching} steps at a wall are few");
        let end = bytes(&whole.save());
        for state in &saved {
            let state: Snapshot = postcard::from_bytes(state).expect("a snapshot can be read");
            let from = state.step();
            let mut resumed = snapshots(ROUGH);
            assert!(resumed.restore(state), "step {from} does not fit");
            advance_to(&mut resumed, END);
            assert!(bytes(&resumed.save()) == end, "from step {from} the run ends otherwise");
        }
        end
    })
    .expect("one thread");
    for threads in [2, 3] {
        let other = with_threads(threads, || {
            let mut simulation = snapshots(ROUGH);
            advance_to(&mut simulation, END);
            bytes(&simulation.save())
        });
        assert!(other.expect("so many threads") == end, "{threads} threads make other bits");
    }
}

#[test]
fn the_closure_of_a_run_is_the_largest_energy_unaccounted_for_over_that_of_the_impact() {
    let mut simulation = snapshots(ROUGH);
    let body = &simulation.intruder().bodies()[0];
    let start = 0.5 * MASS * body.velocity.norm_squared()
        + 0.5 * body.inertia.y * body.spin().norm_squared();
    let mut worst = 0.0_f64;
    for step in 1..=1_500 {
        advance_to(&mut simulation, step);
        let ledger = simulation.ledger();
        let now = ledger.terms().iter().zip(&ledger.balance().values);
        let total: f64 = now.map(|(term, value)| term.sign() * value).sum();
        worst = worst.max((total - ledger.balance().initial).abs());
    }
    assert!(worst > 0.0);
    // Sums of some twenty terms, each rounded, over a difference that is a ten thousandth of them.
    assert!((simulation.closure() * start / worst - 1.0).abs() < 1e-9);
}

#[test]
fn a_chain_falls_onto_the_floor_and_lies_there() {
    let mut params = ParamTable::new();
    for (key, value) in
        [("length", 0.05), ("diameter", 0.01), ("link_angle_1", 0.6), ("link_angle_2", -0.8)]
    {
        params.set(key, value);
    }
    let chain = intruders::find("two-link-chain").expect("it is registered");
    let build = chain.links.expect("it is linked");
    let after = |space: Space, dt: f64| {
        let mut links = build(&params, space, 2.0 * MASS);
        links.launch(middle(space, 0.07), Vec3::new(0.3, 0.0, -1.0), 0.0);
        let mut world = alone(links, (space, BOX), GRAVITY, vec![ROUGH.stage()], dt);
        run(&mut world, (0.6 / dt).round() as usize);
        let unaccounted = world.ledger().balance().worst;
        (unaccounted / (2.0 * MASS * GRAVITY * 0.07), world)
    };
    for space in [Space::Planar, Space::Spatial] {
        let (closure, world) = after(space, 5e-6);
        assert!(closure < 2e-3, "{closure:e}");
        let lift: f64 = world.intruder().bodies().iter().map(|body| body.contact.force.z).sum();
        assert!((lift / (2.0 * MASS * GRAVITY) - 1.0).abs() < 0.05, "{lift}");
        for link in world.intruder().bodies() {
            assert!(link.lowest() > -1e-4 && link.lowest() < 0.02, "{}", link.lowest());
        }
    }
}

#[test]
fn what_goes_through_a_wall_or_jumps_over_grains_is_an_error_that_gives_numbers() {
    let mut fast = body(BALL);
    let start = middle(Space::Spatial, 0.1);
    fast.launch(start, Quat::identity(), Vec3::x() * 1e4, Vec3::zeros());
    let mut world = alone(fast, (Space::Spatial, BOX), 0.0, vec![SPRINGS.stage()], 1e-5);
    let error = world.advance().expect_err("0.1 m in a step");
    let StepError::IntruderTooFast { way, suggested_dt, .. } = error else {
        panic!("{error}");
    };
    // A tenth of the radius of the grain, 2.28 mm, at 1e4 m/s.
    assert!((way - 0.1).abs() < 1e-12 && (suggested_dt - 2.28e-8).abs() < 1e-12);

    // v √(m/k) = 45 mm, more than four radii.
    let mut heavy = body(BALL);
    heavy.launch(start, Quat::identity(), Vec3::x() * 100.0, Vec3::zeros());
    let mut world = alone(heavy, (Space::Spatial, BOX), 0.0, vec![SPRINGS.stage()], 1e-5);
    let error = (0..200).find_map(|_| world.advance().err()).expect("it goes through");
    assert!(error.to_string().contains("inside of the side"), "{error}");
}

#[test]
fn where_an_intruder_never_touches_a_wall_no_bit_depends_on_what_walls_do() {
    let after = |law: AtWalls| {
        let mut disc = body(DISC);
        let start = middle(Space::Planar, 0.1);
        disc.launch(start, Quat::identity(), Vec3::new(0.2, 0.0, 0.3), Vec3::y());
        let mut world = alone(disc, (Space::Planar, BOX), 0.0, vec![law.stage()], 1e-5);
        run(&mut world, 2_000);
        assert_eq!(world.bed().intruder_wall_contacts(), 0);
        let disc = &world.intruder().bodies()[0];
        (disc.save(), world.ledger().balance().values.clone())
    };
    assert_eq!(after(SPRINGS), after(ROUGH));
}
