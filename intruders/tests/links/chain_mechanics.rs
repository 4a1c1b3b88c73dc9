//! The two-link chain and the free link as bodies: no medium, or forces that are given.

use resistive::{Impact, PartLoad, State, Surroundings};

use super::common::{FINE, LENGTH, MASS, chain, law, link};
use engine::math::Vec3;

const GRAVITY: f64 = 9.81;

/// A chain that turns, high above the bed.
fn tumbling() -> State {
    State { position: [0.0, 1000.0, 0.8, -0.4], rate: [0.3, 0.2, 6.0, -4.0], ..State::default() }
}

fn flight(gravity: f64, start: State) -> Impact {
    let launchable = chain([0.0, 0.0], Vec3::zeros());
    let bed = Surroundings { gravity, ..super::common::sand() };
    Impact::new(launchable.assembly, vec![super::common::resistance()], bed, start)
        .with_tolerance(FINE)
}

/// The states at `times` (s) in free flight, each where a run ends and the solver is most accurate.
fn states(impact: &Impact, times: &[f64]) -> Vec<State> {
    let end = |time: &f64| impact.run(*time, &mut ()).expect("the flight can be followed").state;
    times.iter().map(end).collect()
}

#[test]
fn a_free_chain_keeps_its_energy_for_ten_seconds() {
    for gravity in [0.0, GRAVITY] {
        let impact = flight(gravity, tumbling());
        let energy = |state: &State| -> f64 {
            (0..2)
                .map(|part| {
                    let [translation, rotation] = impact.assembly().kinetic_energy(part, state);
                    let (height, mass) = impact.assembly().weight_at(part, state);
                    translation + rotation + mass * gravity * height
                })
                .sum()
        };
        let start = energy(&tumbling());
        let times: Vec<f64> = (1..=10).map(f64::from).collect();
        for state in states(&impact, &times) {
            // Two thousand steps of some 1e-13 each.
            assert!((energy(&state) / start - 1.0).abs() < 1e-9, "gravity {gravity}");
        }
    }
}

#[test]
fn a_free_chain_keeps_its_momentum_and_its_angular_momentum() {
    let impact = flight(0.0, tumbling());
    let momenta = |state: &State| {
        let step = 1e-6;
        let moved = |time: f64| {
            let mut moved = *state;
            for (position, rate) in moved.position.iter_mut().zip(state.rate) {
                *position += time * rate;
            }
            [0, 1].map(|part| impact.assembly().placement(part, &moved))
        };
        let (before, here, after) = (moved(-step), moved(0.0), moved(step));
        let (mut linear, mut angular) = (Vec3::zeros(), 0.0);
        for part in 0..2 {
            let momentum = (after[part].0 - before[part].0) * (MASS / (2.0 * step));
            let turning = (after[part].1 - before[part].1) / (2.0 * step);
            linear += momentum;
            angular += here[part].0.cross(&momentum).y + MASS * LENGTH * LENGTH / 12.0 * turning;
        }
        (linear, angular)
    };
    let (linear, angular) = momenta(&tumbling());
    for state in states(&impact, &[1.0, 5.0]) {
        let now = momenta(&state);
        // Velocities by differences at a height of 1000 m lose 1e-13 m/1e-6 s, and the moment about
        // the origin has an arm of 1000 m.
        assert!((now.0 - linear).norm() < 1e-7, "{now:?}");
        assert!((now.1 - angular).abs() < 1e-4, "{now:?} {angular}");
    }
}

/// Centres (x, z) and angles of two free links that a constraint keeps together at their tops, and
/// their rates.
#[derive(Clone, Copy)]
struct Constrained([f64; 12]);

impl Constrained {
    fn of(state: &State) -> Self {
        let ([x, z, q1, q2], [vx, vz, w1, w2]) = (state.position, state.rate);
        let h = 0.5 * LENGTH;
        let mut all = [0.0; 12];
        for (index, (q, w)) in [(q1, w1), (q2, w2)].into_iter().enumerate() {
            let (sin, cos) = libm::sincos(q);
            all[3 * index..3 * index + 3].copy_from_slice(&[x - h * sin, z - h * cos, q]);
            let rate = [vx - h * w * cos, vz + h * w * sin, w];
            all[6 + 3 * index..9 + 3 * index].copy_from_slice(&rate);
        }
        Self(all)
    }

    /// Rates of change; the force at the joint is the multiplier that keeps the tops together.
    fn rates(&self) -> [f64; 12] {
        let (h, inertia) = (0.5 * LENGTH, MASS * LENGTH * LENGTH / 12.0);
        let ((s1, c1), (s2, c2)) = (libm::sincos(self.0[2]), libm::sincos(self.0[5]));
        let (w1, w2) = (self.0[8], self.0[11]);
        let share = h * h / inertia;
        let xx = 2.0 / MASS + share * (c1 * c1 + c2 * c2);
        let zz = 2.0 / MASS + share * (s1 * s1 + s2 * s2);
        let xz = -share * (c1 * s1 + c2 * s2);
        let right = [h * (w1 * w1 * s1 - w2 * w2 * s2), h * (w1 * w1 * c1 - w2 * w2 * c2)];
        let determinant = xx * zz - xz * xz;
        let fx = (zz * right[0] - xz * right[1]) / determinant;
        let fz = (xx * right[1] - xz * right[0]) / determinant;
        let mut rates = [0.0; 12];
        rates[..6].copy_from_slice(&self.0[6..]);
        rates[6..9].copy_from_slice(&[
            fx / MASS,
            fz / MASS - GRAVITY,
            h * (c1 * fx - s1 * fz) / inertia,
        ]);
        rates[9..].copy_from_slice(&[
            -fx / MASS,
            -fz / MASS - GRAVITY,
            -h * (c2 * fx - s2 * fz) / inertia,
        ]);
        rates
    }

    /// Runge–Kutta of order 4.
    fn step(&mut self, dt: f64) {
        let moved = |rates: &[f64; 12], dt: f64| {
            let mut moved = *self;
            for (value, rate) in moved.0.iter_mut().zip(rates) {
                *value += dt * rate;
            }
            moved
        };
        let k1 = self.rates();
        let k2 = moved(&k1, 0.5 * dt).rates();
        let k3 = moved(&k2, 0.5 * dt).rates();
        let k4 = moved(&k3, dt).rates();
        for index in 0..12 {
            self.0[index] += dt / 6.0 * (k1[index] + 2.0 * k2[index] + 2.0 * k3[index] + k4[index]);
        }
    }
}

#[test]
fn a_free_chain_moves_as_two_bodies_that_a_constraint_keeps_together() {
    let impact = flight(GRAVITY, tumbling());
    let mut reference = Constrained::of(&tumbling());
    let states = states(&impact, &[0.5, 1.0, 2.0]);
    let mut step = 0;
    for (state, steps) in states.iter().zip([5_000, 10_000, 20_000]) {
        while step < steps {
            reference.step(1e-4);
            step += 1;
        }
        for (ours, theirs) in Constrained::of(state).0.iter().zip(reference.0) {
            // The reference has converged to 1e-12 (halving its step shows it); the solver is within
            // 2e-8 rad/s after two seconds, which three finer tolerances approach.
            assert!((ours - theirs).abs() < 1e-7, "{ours} and {theirs} after {steps} steps");
        }
    }
}

#[test]
fn accelerations_obey_the_equations_of_the_chain_under_any_forces() {
    let launchable = chain([0.3, -0.2], Vec3::zeros());
    // Both links in the bed, in motion, with forces of no particular direction.
    let mut state = launchable.start;
    state.position[1] -= 0.08;
    state.rate = [0.4, -1.5, 3.0, -5.0];
    let forces = [Vec3::new(-2.0, 0.0, 7.0), Vec3::new(1.5, 0.0, 4.0)];
    let loads = forces.map(|force| PartLoad { force, couple: 0.0, added_mass: 0.0 });
    let acceleration = launchable.assembly.accelerate(&state, &loads, GRAVITY);

    // The equations count angles the other way round.
    let [ax, az, ..] = acceleration;
    let half = 0.5 * MASS * LENGTH;
    let (mut along_x, mut along_z) = (2.0 * MASS * ax, 2.0 * MASS * (az + GRAVITY));
    for part in 0..2 {
        let (angle, rate) = (-state.position[2 + part], -state.rate[2 + part]);
        let turning = -acceleration[2 + part];
        let (sin, cos) = libm::sincos(angle);
        along_x += half * (turning * cos - rate * rate * sin) - forces[part].x;
        along_z += half * (turning * sin + rate * rate * cos) - forces[part].z;
        let depth = LENGTH * cos - state.position[1];
        let arm = LENGTH - 0.5 * (depth / cos).min(LENGTH);
        let moment = MASS * LENGTH * LENGTH / 3.0 * turning
            + half * (ax * cos + az * sin)
            + half * GRAVITY * sin
            - arm * (forces[part].x * cos + forces[part].z * sin);
        assert!(moment.abs() < 1e-13, "link {part}: {moment:e} N m");
    }
    // Sums of forces of order 10 N: round-off.
    assert!(along_x.abs() < 1e-13 && along_z.abs() < 1e-13, "{along_x:e} {along_z:e}");
}

#[test]
fn a_free_link_turns_uniformly_about_its_centre_which_falls() {
    let launchable = link(0.7, Vec3::new(0.5, 0.0, 4.0), 9.0);
    let mut start = launchable.start;
    start.position[1] += 100.0;
    let impact = Impact::new(
        launchable.assembly,
        vec![law("link", &[("drag", 3.0), ("horizontal", 5.0)])],
        super::common::sand(),
        start,
    )
    .with_tolerance(FINE);
    for time in [0.3, 1.7] {
        let state = states(&impact, &[time])[0];
        let [x, z, angle, _] = state.position;
        let ([x0, z0, ..], [vx, vz, spin, _]) = (start.position, start.rate);
        // A parabola is exact for the solver: round-off of 100 m.
        assert!((x - x0 - vx * time).abs() < 1e-12);
        assert!((z - z0 - vz * time + 0.5 * GRAVITY * time * time).abs() < 1e-12);
        assert!((angle - 0.7 - spin * time).abs() < 1e-12);
    }
}
