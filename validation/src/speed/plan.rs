//! Trials in turns: every repeat goes once through all problems and programs, so that whatever else the
//! machine does falls on all of them alike.

use std::path::{Path, PathBuf};
use std::thread::available_parallelism;

use serde::Serialize;

use super::SpeedError;
use super::lammps::{Lammps, export};
use super::problem::{BedTime, Problem};
use super::spread::Spread;
use super::style::Style;
use super::trial::{Extent, Order, Span, Trial};

/// How much is done.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The problems.
    pub problems: Vec<&'static Problem>,
    /// How often each is timed.
    pub repeats: usize,
    /// By how much the spans of the problems are shortened.
    pub shorter: u64,
    /// Where problems, decks and logs are written.
    pub folder: PathBuf,
    /// The folder of prepared beds.
    pub cache: PathBuf,
    /// The peers, if there are to be any: builds of one LAMMPS.
    pub lammps: Vec<Lammps>,
}

/// What was measured of one problem.
#[derive(Debug)]
pub struct Measured {
    /// The problem.
    pub problem: &'static Problem,
    /// Which steps were timed.
    pub span: Span,
    /// plunge on one thread.
    pub one: Vec<Trial>,
    /// plunge on two threads.
    pub two: Vec<Trial>,
    /// LAMMPS: every style of every build; the style of the same law of the first build comes first.
    pub peers: Vec<Peer>,
}

/// A pair style of a build of LAMMPS.
#[derive(Debug)]
pub struct Peer {
    /// The style, as LAMMPS calls it.
    pub style: String,
    /// Whether its forces are those of the model.
    pub is_same_law: bool,
    /// Where the build comes from.
    pub build: &'static str,
    /// On one core.
    pub one: Vec<Trial>,
    /// On two ranks, of the first peer alone.
    pub two: Vec<Trial>,
}

impl Measured {
    /// The peer of the same law, of the first build.
    pub fn first_peer(&self) -> Option<&Peer> {
        self.peers.first()
    }

    /// The fastest peer on one core, by the median of CPU time.
    pub fn fastest_peer(&self) -> Option<&Peer> {
        let rate = |peer: &Peer| {
            let spread = Spread::of(peer.one.iter().map(Trial::per_cpu_second));
            spread.map_or(0.0, |spread| spread.median)
        };
        self.peers.iter().max_by(|a, b| rate(a).total_cmp(&rate(b)))
    }

    /// Rate of plunge on one core over that of `peer` in the same repeat (–).
    pub fn over(&self, peer: &Peer) -> Option<Spread> {
        let pairs = self.one.iter().zip(&peer.one);
        Spread::of(pairs.map(|(own, peer)| own.per_cpu_second() / peer.per_cpu_second()))
    }

    /// How far the velocity of the intruder at the end is from that of `peer`, over the latter (–).
    pub fn apart(&self, peer: &Peer) -> Option<f64> {
        let [own, peer] = [&self.one, &peer.one].map(|trials| trials.first()?.velocity_m_per_s);
        let (own, peer) = (own?, peer?);
        let square = |v: [f64; 3]| v.iter().map(|component| component * component).sum::<f64>();
        let apart = std::array::from_fn(|axis| own[axis] - peer[axis]);
        Some((square(apart) / square(peer)).sqrt())
    }

    /// The largest of these over the peers of the same law (–).
    pub fn disagreement(&self) -> Option<f64> {
        let same = self.peers.iter().filter(|peer| peer.is_same_law);
        same.filter_map(|peer| self.apart(peer)).max_by(f64::total_cmp)
    }
}

/// What a part of plunge costs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Batch {
    /// Impacts at the same time, each on one thread.
    pub impacts: usize,
    /// Grain-steps per second of all of them together (1/s).
    pub together: f64,
    /// The same of one impact alone, times the number of impacts (1/s).
    pub expected: f64,
}

impl Batch {
    /// What is lost by running them together (–).
    pub fn loss(&self) -> f64 {
        1.0 - self.together / self.expected
    }
}

/// Everything that was measured.
#[derive(Debug)]
pub struct Results {
    /// By problem.
    pub measured: Vec<Measured>,
    /// How long beds took, first to prepare or find them, then to find them again.
    pub beds: Vec<[BedTime; 2]>,
    /// CPU time of a step with the default log over that without one, less one (–); of the problem in a
    /// plane.
    pub logging: Option<Spread>,
    /// The same of a step with the energy ledger over one without.
    pub ledger: Option<Spread>,
    /// Impacts in parallel, of the problem in a plane.
    pub batch: Option<Batch>,
}

/// Carries out `plan`; `say` is told what comes next.
///
/// # Errors
/// If a problem cannot be written or a trial fails.
pub fn run(plan: &Plan, say: &dyn Fn(&str)) -> Result<Results, SpeedError> {
    let mut written = Vec::new();
    let mut beds = Vec::new();
    let mut measured = Vec::new();
    for problem in &plan.problems {
        say(&format!("{}: bed", problem.name));
        let (_, first) = problem.write(&plan.folder, &plan.cache)?;
        let (model, again) = problem.write(&plan.folder, &plan.cache)?;
        let mut one = nothing_of(problem, plan.shorter);
        if !plan.lammps.is_empty() {
            let styles = export(&model, &|style| deck(plan, problem, &style.name))?;
            one.peers = peers(plan, &styles);
        }
        measured.push(one);
        written.push(model);
        beds.push([first, again]);
    }
    let (mut logging, mut ledger) = (Vec::new(), Vec::new());
    for repeat in 1..=plan.repeats {
        for (one, model) in measured.iter_mut().zip(&written) {
            say(&format!("{}: {repeat} of {}", one.problem.name, plan.repeats));
            take_turns(plan, one, model)?;
            if is_planar(one.problem) {
                let folder = plan.folder.join(one.problem.name).join("logged");
                let logged = to_extent(one, model, Extent::Run(folder))?;
                let forces = to_extent(one, model, Extent::Forces)?;
                logging.push(extra_cost(Some(&logged), one.one.last()));
                ledger.push(extra_cost(one.one.last(), Some(&forces)));
            }
        }
    }
    let planar = measured.iter().zip(&written).find(|(one, _)| is_planar(one.problem));
    let batch = planar.map(|(one, model)| in_parallel(one, model, say)).transpose()?;
    Ok(Results { measured, beds, logging: Spread::of(logging), ledger: Spread::of(ledger), batch })
}

fn nothing_of(problem: &'static Problem, shorter: u64) -> Measured {
    let Span { warm_up, steps } = problem.span;
    // A run looks at its progress every 50 steps.
    let span = Span { warm_up, steps: (steps / shorter).max(100) };
    Measured { problem, span, one: Vec::new(), two: Vec::new(), peers: Vec::new() }
}

/// Every style of every build.
fn peers(plan: &Plan, styles: &[Style]) -> Vec<Peer> {
    let of = |lammps: &Lammps| {
        let build = lammps.build;
        styles.iter().map(move |style| Peer {
            style: style.name.clone(),
            is_same_law: style.is_same_law,
            build,
            one: Vec::new(),
            two: Vec::new(),
        })
    };
    plan.lammps.iter().flat_map(of).collect()
}

fn is_planar(problem: &Problem) -> bool {
    problem.name.starts_with("2d")
}

fn deck(plan: &Plan, problem: &Problem, style: &str) -> PathBuf {
    plan.folder.join(problem.name).join("lammps").join(style.replace('/', "-"))
}

/// One trial of each program.
fn take_turns(plan: &Plan, measured: &mut Measured, model: &Path) -> Result<(), SpeedError> {
    let span = measured.span;
    let order = |threads| Order { model: model.to_owned(), span, threads, extent: Extent::Steps };
    measured.one.push(order(1).in_a_process()?);
    for peer in &mut measured.peers {
        let lammps = plan.lammps.iter().find(|lammps| lammps.build == peer.build);
        let deck = deck(plan, measured.problem, &peer.style);
        peer.one.extend(lammps.map(|lammps| lammps.trial(&deck, span, 1)).transpose()?);
    }
    measured.two.push(order(2).in_a_process()?);
    let first = plan.lammps.first().filter(|lammps| lammps.has_ranks());
    if let (Some(lammps), Some(peer)) = (first, measured.peers.first_mut()) {
        peer.two.push(lammps.trial(&deck(plan, measured.problem, &peer.style), span, 2)?);
    }
    Ok(())
}

/// A trial of plunge on one thread, to another extent than steps alone.
fn to_extent(of: &Measured, model: &Path, extent: Extent) -> Result<Trial, SpeedError> {
    Order { model: model.to_owned(), span: of.span, threads: 1, extent }.in_a_process()
}

/// CPU time per step of `more` over that of `less`, less one.
fn extra_cost(more: Option<&Trial>, less: Option<&Trial>) -> f64 {
    let [more, less] = [more, less].map(|trial| trial.map_or(f64::NAN, Trial::per_cpu_second));
    less / more - 1.0
}

/// As many impacts as there are cores, at the same time.
fn in_parallel(of: &Measured, model: &Path, say: &dyn Fn(&str)) -> Result<Batch, SpeedError> {
    let impacts = available_parallelism().map_or(1, usize::from);
    say(&format!("{}: {impacts} impacts at the same time", of.problem.name));
    let order = Order { model: model.to_owned(), span: of.span, threads: 1, extent: Extent::Steps };
    let alone = order.in_a_process()?.per_wall_second();
    let together = order.in_processes(impacts)?.iter().map(Trial::per_wall_second).sum();
    Ok(Batch { impacts, together, expected: impacts as f64 * alone })
}
