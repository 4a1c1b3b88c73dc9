//! The energy ledger of an impact on a resistive medium, and samples for its log.

use std::borrow::Cow;

use super::assembly::{PARTS, Part, State};
use super::holding::accelerate;
use super::modes::{AXES, Modes};
use super::motion::{Loaded, System};
use super::observe::{Observer, SolverStep};
use super::{Flow, Impact, Load, Motion};
use engine::ledger::{ChannelKind, Ledger, Term, TermKind};
use engine::math::Vec3;

/// Nodes and weights of Gauss's quadrature on five points, exact to order nine: finer than the
/// solution that it is taken over.
const NODES: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// Where a term of the ledger comes from.
#[derive(Clone, Copy)]
enum Entry {
    Translation(usize),
    Rotation(usize),
    Height(usize),
    Account { law: usize, flow: Flow },
    Drive,
}

/// What a recorder hands on at each sample.
pub struct Sample<'a> {
    /// Counts the samples from 0.
    pub number: u64,
    /// (s).
    pub time: f64,
    /// The state.
    pub state: &'a State,
    /// By part.
    pub parts: &'a [PartSample],
    /// The ledger, closed at this time.
    pub ledger: &'a Ledger,
}

/// A part in a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartSample {
    /// Where it is and how it moves.
    pub part: Part,
    /// Force of the terms that vary smoothly with the velocity (N).
    pub dynamic: Vec3,
    /// Force of the frictions (N).
    pub friction: Vec3,
    /// Torque about the centre of mass (N m).
    pub torque: Vec3,
    /// Energy given to the medium so far (J).
    pub given: f64,
}

/// Keeps the ledger of an impact and hands on a sample at every multiple of an interval, and at the end.
///
/// The work of each law is integrated along the solution, where the force is found, and not taken
/// from what the body lost: so what the ledger does not account for measures the integration.
pub struct Recorder<'a, F> {
    impact: &'a Impact,
    interval: f64,
    entries: Vec<Entry>,
    ledger: Ledger,
    /// Work by entry (J): of what is lost since the last sample, of what is held since the start.
    work: Vec<f64>,
    given: [f64; PARTS],
    number: u64,
    sampled: f64,
    sink: F,
}

impl<'a, F: FnMut(&Sample<'_>)> Recorder<'a, F> {
    /// Opens the ledger on the start of `impact` and hands on the first sample; `interval` (s).
    pub fn new(impact: &'a Impact, interval: f64, sink: F) -> Self {
        let system = impact.system();
        let (entries, terms) = entries(&system);
        let mut recorder = Self {
            impact,
            interval,
            work: vec![0.0; entries.len()],
            entries,
            ledger: Ledger::new(terms),
            given: [0.0; PARTS],
            number: 0,
            sampled: 0.0,
            sink,
        };
        let start = *impact.start();
        let modes = impact.first_modes();
        let held = recorder.held(&system, &start, &modes);
        recorder.ledger.open(&held);
        recorder.hand_on(&system, 0.0, &start, &modes);
        recorder
    }

    /// The ledger as it stands.
    pub fn ledger(&self) -> &Ledger {
        &self.ledger
    }

    /// Energy given to the medium by each part (J).
    pub fn given(&self) -> &[f64; PARTS] {
        &self.given
    }

    /// Values of the entries that are held now, and zero for those that add up (J).
    fn held(&self, system: &System<'_>, state: &State, modes: &Modes) -> Vec<f64> {
        let assembly = system.assembly;
        let mut values: Vec<f64> = self
            .entries
            .iter()
            .map(|entry| match *entry {
                Entry::Translation(part) => assembly.kinetic_energy(part, state)[0],
                Entry::Rotation(part) => assembly.kinetic_energy(part, state)[1],
                Entry::Height(part) => {
                    let (height, mass) = assembly.weight_at(part, state);
                    mass * system.bed.gravity * height
                }
                Entry::Account { .. } | Entry::Drive => 0.0,
            })
            .collect();
        for part in 0..assembly.n_parts() {
            let entries = &self.entries;
            let squared_speed = assembly.part(part, state).velocity.norm_squared();
            system.visit(part, state, modes, |number, before, after| {
                let mass = after.added_mass - before.added_mass;
                for (value, entry) in values.iter_mut().zip(entries) {
                    if matches!(entry, Entry::Account { law, flow: Flow::AddedMass } if *law == number)
                    {
                        *value += 0.5 * mass * squared_speed;
                    }
                }
            });
        }
        values
    }

    /// Adds the work of the laws from `from` to `to` (s).
    fn integrate(&mut self, solver_step: &mut SolverStep<'_, '_>, from: f64, to: f64) {
        let half = 0.5 * (to - from);
        for (node, weight) in NODES {
            let state = solver_step.state(from + half * (1.0 + node));
            let (system, modes) = (solver_step.system, solver_step.modes);
            for part in 0..system.assembly.n_parts() {
                let Self { entries, work, given, .. } = self;
                let mut added = Vec::with_capacity(system.laws.len());
                let loaded = system.visit(part, &state, modes, |number, before, after| {
                    added.push((number, *before, *after));
                });
                let drive = power_of_drive(system, part, &state, &loaded);
                let drives = entries.iter().zip(work.iter_mut());
                drives
                    .filter(|(entry, _)| matches!(entry, Entry::Drive))
                    .for_each(|(_, work)| *work += half * weight * drive);
                for (number, before, after) in added {
                    let powers = powers(&loaded.part, &loaded.motion, &before, &after);
                    given[part] += half * weight * (powers[0] + powers[1] + powers[2]);
                    for (entry, work) in entries.iter().zip(work.iter_mut()) {
                        let Entry::Account { law, flow } = *entry else { continue };
                        let power = match flow {
                            Flow::Dynamic => powers[0],
                            Flow::Static => powers[1],
                            Flow::Recruitment => powers[2],
                            Flow::AddedMass => 0.0,
                        };
                        if law == number {
                            *work += half * weight * power;
                        }
                    }
                }
            }
        }
    }

    fn hand_on(&mut self, system: &System<'_>, time: f64, state: &State, modes: &Modes) {
        let (_, holds) = accelerate(system, state, modes);
        let parts: Vec<PartSample> = (0..system.assembly.n_parts())
            .map(|index| {
                let loaded = system.loaded(index, state, modes);
                let (dynamic, mut friction) = (
                    loaded.load.dynamic_force(&loaded.motion),
                    loaded.load.sliding_force(&loaded.motion),
                );
                for hold in holds.iter().filter(|hold| hold.part == index) {
                    friction[AXES[hold.component]] += hold.force;
                }
                let (centre, _) = system.assembly.placement(index, state);
                let arm = loaded.part.point - centre;
                let couple = Vec3::new(0.0, loaded.load.couple, 0.0);
                PartSample {
                    part: loaded.part,
                    dynamic,
                    friction,
                    torque: arm.cross(&(dynamic + friction)) + couple,
                    given: self.given[index],
                }
            })
            .collect();
        let Self { number, ledger, sink, .. } = self;
        sink(&Sample { number: *number, time, state, parts: &parts, ledger });
        self.number += 1;
        self.sampled = time;
    }

    fn sample(&mut self, system: &System<'_>, time: f64, state: &State, modes: &Modes) {
        let mut values = self.held(system, state, modes);
        for ((value, work), term) in values.iter_mut().zip(&mut self.work).zip(self.ledger.terms())
        {
            *value += *work;
            // The ledger adds up what is lost or put in; what is held it takes as it is.
            if term.kind != TermKind::Channel(ChannelKind::Stored) {
                *work = 0.0;
            }
        }
        self.ledger.close(&values);
        self.hand_on(system, time, state, modes);
    }
}

impl<F: FnMut(&Sample<'_>)> Observer for Recorder<'_, F> {
    fn solver_step(&mut self, solver_step: &mut SolverStep<'_, '_>) {
        let (mut from, to) = (solver_step.from(), solver_step.to());
        loop {
            let next = self.number as f64 * self.interval;
            if next > to {
                break;
            }
            self.integrate(solver_step, from, next);
            let state = solver_step.state(next);
            let (system, modes) = (solver_step.system, solver_step.modes);
            self.sample(system, next, &state, modes);
            from = next;
        }
        self.integrate(solver_step, from, to);
    }

    fn end(&mut self, time: f64, state: &State) {
        if time > self.sampled {
            let impact = self.impact;
            let modes = impact.last_modes(state);
            self.sample(&impact.system(), time, state, &modes);
        }
    }
}

/// Power (W) of the drive that keeps the velocity of a part, against the medium and its weight.
fn power_of_drive(system: &System<'_>, index: usize, state: &State, loaded: &Loaded) -> f64 {
    let (_, mass) = system.assembly.weight_at(index, state);
    let force = loaded.load.on_part(&loaded.motion).force - Vec3::z() * (mass * system.bed.gravity);
    -force.dot(&loaded.part.velocity) - loaded.load.couple * loaded.part.spin
}

/// Powers (W) that a part gives up to what a law added: to its dynamic, its static terms, and to the
/// recruitment of mass.
fn powers(part: &Part, motion: &Motion, before: &Load, after: &Load) -> [f64; 3] {
    let velocity = part.velocity;
    let dynamic = after.dynamic - before.dynamic;
    let couple = after.couple - before.couple;
    let friction = (after.friction - before.friction).component_mul(&motion.direction);
    let mut sliding = friction.dot(&velocity);
    for (component, axis) in AXES.into_iter().enumerate() {
        let (after, before) = (after.grip[component], before.grip[component]);
        let sense = motion.sense[component];
        if sense > 0.0 {
            sliding += (after.positive - before.positive) * velocity[axis];
        } else if sense < 0.0 {
            sliding -= (after.negative - before.negative) * velocity[axis];
        }
    }
    let recruitment = after.recruitment - before.recruitment;
    let held = 0.5 * (after.growth - before.growth);
    [
        -dynamic.dot(&velocity) - couple * part.spin,
        sliding,
        (recruitment - held) * velocity.norm_squared(),
    ]
}

/// The terms of the ledger, and where each comes from.
fn entries(system: &System<'_>) -> (Vec<Entry>, Vec<Term>) {
    const NAMES: [[&str; 3]; 3] = [
        ["intruder-translation", "intruder-rotation", "intruder"],
        ["link-1-translation", "link-1-rotation", "link-1"],
        ["link-2-translation", "link-2-rotation", "link-2"],
    ];
    let n_parts = system.assembly.n_parts();
    let (mut entries, mut terms) = (Vec::new(), Vec::new());
    let mut add = |entry, name: Cow<'static, str>, kind| {
        entries.push(entry);
        terms.push(Term { name, kind });
    };
    for part in 0..n_parts {
        let [translation, rotation, height] = NAMES[if n_parts == 1 { 0 } else { part + 1 }];
        add(Entry::Translation(part), translation.into(), TermKind::Kinetic);
        add(Entry::Rotation(part), rotation.into(), TermKind::Kinetic);
        add(Entry::Height(part), height.into(), TermKind::Potential);
    }
    for (number, law) in system.laws.iter().enumerate() {
        for account in law.accounts() {
            let entry = Entry::Account { law: number, flow: account.flow };
            let own = law.own_name().map(|name| Cow::Owned(name.to_owned()));
            let name = own.unwrap_or(account.channel.name.into());
            add(entry, name, TermKind::Channel(account.channel.kind));
        }
    }
    if system.assembly.is_driven() {
        add(Entry::Drive, "drive".into(), TermKind::Channel(ChannelKind::Input));
    }
    (entries, terms)
}
