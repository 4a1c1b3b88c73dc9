//! What came of a plan: one JSON object, and a page in Markdown.

use std::fmt::Write as _;
use std::fs;
use std::process::Command;
use std::thread::available_parallelism;

use serde_json::{Value, json};

use super::lammps::SETTINGS;
use super::plan::{Measured, Peer, Plan, Results};
use super::sharing::{Crossover, Sharing};
use super::spread::Spread;
use super::trial::Trial;

/// How far the velocity of the intruder may be from that of a peer (–).
pub const AGREEMENT: f64 = 0.02;

/// The processor and how many cores it has.
fn machine() -> String {
    let cores = available_parallelism().map_or(1, usize::from);
    let text = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = text.lines().find(|line| line.starts_with("model name"));
    let model = model.and_then(|line| line.split_once(": ")).map_or("processor", |(_, name)| name);
    format!("{model}, {cores} cores")
}

/// The commit that the working folder stands on, with its date; nothing outside of a repository.
fn commit() -> Option<String> {
    let output = Command::new("git").args(["log", "-1", "--format=%h, %cs"]).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    let text = text.trim_end();
    (output.status.success() && !text.is_empty()).then(|| text.to_owned())
}

/// The widest instructions that this program was compiled for.
pub fn simd() -> &'static str {
    match (cfg!(target_feature = "avx512f"), cfg!(target_feature = "avx2")) {
        (true, _) => "avx512",
        (false, true) => "avx2",
        _ => "baseline",
    }
}

fn by_cpu(trials: &[Trial]) -> Option<Spread> {
    Spread::of(trials.iter().map(Trial::per_cpu_second))
}

fn by_wall(trials: &[Trial]) -> Option<Spread> {
    Spread::of(trials.iter().map(Trial::per_wall_second))
}

fn ratio(own: Option<Spread>, peer: Option<Spread>) -> Option<f64> {
    Some(own?.median / peer?.median)
}

/// Memory of the process per grain (byte), what it started with included.
fn memory_per_grain(measured: &Measured) -> Option<f64> {
    let trial = measured.one.first()?;
    Some(trial.held_bytes? as f64 / trial.grains as f64)
}

/// CPU time per grain and step of each bed of spheres over that of the smallest (–), with its grains.
fn growth(results: &Results) -> Vec<(usize, f64)> {
    let spheres = results.measured.iter().filter(|one| one.problem.name.starts_with("3d"));
    let rates = spheres.filter_map(|one| Some((one.one.first()?.grains, by_cpu(&one.one)?.median)));
    let rates: Vec<(usize, f64)> = rates.collect();
    let smallest = rates.first().map_or(f64::NAN, |(_, rate)| *rate);
    rates.into_iter().map(|(grains, rate)| (grains, smallest / rate)).collect()
}

/// Memory (byte) that each grain more takes, between the smallest and the largest bed of spheres; without the
/// program itself.
fn memory_per_further_grain(results: &Results) -> Option<f64> {
    let spheres = results.measured.iter().filter(|one| one.problem.name.starts_with("3d"));
    let trials = spheres.filter_map(|one| one.one.first());
    let held: Vec<(f64, f64)> =
        trials.filter_map(|one| Some((one.grains as f64, one.held_bytes? as f64))).collect();
    let (small, large) = (held.first()?, held.last()?);
    (large.0 > small.0).then(|| (large.1 - small.1) / (large.0 - small.0))
}

/// What a second core brings in each bed of spheres.
fn sharing(results: &Results) -> Vec<Sharing> {
    let spheres = results.measured.iter().filter(|one| one.problem.name.starts_with("3d"));
    spheres.filter_map(Sharing::of).collect()
}

/// A column of a problem.
fn of_peer(measured: &Measured, peer: &Peer) -> Value {
    json!({
        "problem": measured.problem.name,
        "peer_style": peer.style,
        "peer_build": peer.build,
        "simd": simd(),
        "same_law": peer.is_same_law,
        "one_core_grain_steps_per_cpu_s": by_cpu(&peer.one),
        "two_ranks_grain_steps_per_wall_s": by_wall(&peer.two),
        "plunge_over_it_one_core": measured.over(peer),
        "intruder_velocity_apart": measured.apart(peer),
        "trials": { "one": peer.one, "two": peer.two },
    })
}

/// Everything as one JSON object.
pub fn as_json(plan: &Plan, results: &Results) -> Value {
    let problem = |one: &Measured| {
        json!({
            "name": one.problem.name,
            "about": one.problem.about,
            "warm_up_steps": one.span.warm_up,
            "steps": one.span.steps,
            "plunge": {
                "one_core_grain_steps_per_cpu_s": by_cpu(&one.one),
                "two_threads_grain_steps_per_cpu_s": by_cpu(&one.two),
                "two_threads_grain_steps_per_wall_s": by_wall(&one.two),
                "memory_per_grain_bytes": memory_per_grain(one),
                "trials": { "one": one.one, "two": one.two },
            },
            "peers": one.peers.iter().map(|peer| of_peer(one, peer)).collect::<Vec<_>>(),
            "plunge_over_lammps": {
                "one_core": one.first_peer().and_then(|peer| one.over(peer)),
                "two_cores": ratio(by_wall(&one.two), one.first_peer().and_then(|peer| by_wall(&peer.two))),
                "fastest": one.fastest_peer().and_then(|peer| one.over(peer)),
            },
            "second_core": Sharing::of(one),
            "intruder_velocity_apart": one.disagreement(),
            "agrees": one.disagreement().map(|apart| apart <= AGREEMENT),
        })
    };
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "machine": machine(),
        "commit": commit(),
        "simd": simd(),
        "repeats": plan.repeats,
        "peer_builds": plan.lammps.iter().map(|lammps| json!({
            "name": "LAMMPS",
            "peer_build": lammps.build,
            "version": lammps.version,
            "settings": SETTINGS,
        })).collect::<Vec<_>>(),
        "problems": results.measured.iter().map(problem).collect::<Vec<_>>(),
        "growth": growth(results).iter().map(|(grains, factor)| json!({
            "grains": grains, "cpu_per_grain_step_over_smallest": factor,
        })).collect::<Vec<_>>(),
        "crossover": Crossover::of(&sharing(results)),
        "memory_per_further_grain_bytes": memory_per_further_grain(results),
        "ledger_cost": results.ledger,
        "logging_cost": results.logging,
        "batch": results.batch.map(|batch| json!({
            "impacts": batch.impacts,
            "grain_steps_per_s": batch.together,
            "one_alone_times_impacts": batch.expected,
            "loss": batch.loss(),
        })),
        "beds": results.beds,
    })
}

/// A rate (1/s) in millions.
fn millions(rate: Option<Spread>) -> String {
    let shown = |rate: f64| format!("{:.2}", 1e-6 * rate);
    rate.map_or("–".to_owned(), |Spread { median, least, most }| {
        format!("**{}** ({}–{})", shown(median), shown(least), shown(most))
    })
}

fn share(value: f64) -> String {
    format!("{:.1} %", 100.0 * value)
}

/// Every style of the peer on one core, a row each, with two columns per build.
fn peers(results: &Results) -> String {
    let all = || results.measured.iter().flat_map(|one| &one.peers);
    let mut builds: Vec<&str> = Vec::new();
    for peer in all() {
        if !builds.contains(&peer.build) {
            builds.push(peer.build);
        }
    }
    if builds.is_empty() {
        return String::new();
    }
    let mut text = "| problem, style of LAMMPS | same law |".to_owned();
    builds.iter().for_each(|build| {
        let _ = write!(text, " {build}, per CPU-second | plunge over it |");
    });
    let _ = writeln!(text, "\n|{}", " --- |".repeat(2 + 2 * builds.len()));
    for one in &results.measured {
        for first in one.peers.iter().filter(|peer| peer.build == builds[0]) {
            let same_law = if first.is_same_law { "yes" } else { "no" };
            let mut cells =
                vec![format!("{}, `{}`", one.problem.name, first.style), same_law.to_owned()];
            for build in &builds {
                let is_it = |peer: &&Peer| peer.style == first.style && peer.build == *build;
                let peer = one.peers.iter().find(is_it);
                cells.push(millions(peer.and_then(|peer| by_cpu(&peer.one))));
                let over = peer.and_then(|peer| one.over(peer));
                cells.push(over.map_or("–".to_owned(), |Spread { median, least, most }| {
                    format!("**{median:.2}** ({least:.2}–{most:.2})")
                }));
            }
            let _ = writeln!(text, "| {} |", cells.join(" | "));
        }
    }
    text.push('\n');
    text
}

/// The tables of the page on performance.
pub fn as_markdown(plan: &Plan, results: &Results) -> String {
    let or_dash = |value: Option<String>| value.unwrap_or_else(|| "–".to_owned());
    let mut text = match commit() {
        Some(commit) => format!("plunge of commit {commit}.\n"),
        None => String::new(),
    };
    let _ = writeln!(
        text,
        "On {}, plunge compiled for {}, {} repeats. Millions of grain-steps per second: median (least to most).",
        machine(),
        simd(),
        plan.repeats
    );
    let builds = plan.lammps.iter().map(|one| format!("{} ({})", one.version, one.build));
    let builds = builds.collect::<Vec<_>>().join(", ");
    if !builds.is_empty() {
        let _ = writeln!(text, "LAMMPS {builds}: {SETTINGS}.");
    }
    text.push_str(
        "\n| problem | plunge, one core, per CPU-second | LAMMPS, same law | ratio | plunge, two threads, per second \
         | LAMMPS, two ranks | ratio | byte per grain | velocity apart |\n\
         | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
    );
    for one in &results.measured {
        let first = one.first_peer();
        let (own, peer) = (by_cpu(&one.one), first.and_then(|peer| by_cpu(&peer.one)));
        let (own_two, peer_two) = (by_wall(&one.two), first.and_then(|peer| by_wall(&peer.two)));
        let paired = first.and_then(|peer| one.over(peer));
        let cells = [
            format!("{}: {}", one.problem.name, one.problem.about),
            millions(own),
            millions(peer),
            or_dash(paired.map(|ratio| format!("{:.2}", ratio.median))),
            millions(own_two),
            millions(peer_two),
            or_dash(ratio(own_two, peer_two).map(|ratio| format!("{ratio:.2}"))),
            or_dash(memory_per_grain(one).map(|bytes| format!("{bytes:.0}"))),
            or_dash(one.disagreement().map(share)),
        ];
        let _ = writeln!(text, "| {} |", cells.join(" | "));
    }
    text.push('\n');
    text.push_str(&peers(results));
    let growth = growth(results);
    if growth.len() > 1 {
        let steps = growth.iter().map(|(grains, factor)| format!("{factor:.2} at {grains}"));
        let steps = steps.collect::<Vec<_>>().join(", ");
        let _ = writeln!(
            text,
            "- Growth, CPU time per grain and step over the smallest bed of spheres: {steps}."
        );
    }
    let shared = results.measured.iter().filter_map(|one| {
        let sharing = Sharing::of(one)?;
        let [threads, ranks] = [sharing.threads?, sharing.ranks?].map(share);
        Some(format!("{} {threads} ({ranks})", one.problem.name))
    });
    let shared = shared.collect::<Vec<_>>().join(", ");
    if !shared.is_empty() {
        let _ = writeln!(
            text,
            "- Two cores over twice one, by wall time, with two threads (ranks): {shared}."
        );
    }
    if let Some(crossover) = Crossover::of(&sharing(results)) {
        let _ = writeln!(text, "- In space, two ranks of LAMMPS {}.", crossover.text());
    }
    if let Some(bytes) = memory_per_further_grain(results) {
        let _ = writeln!(text, "- Memory: {bytes:.0} byte for each grain more in space.");
    }
    for (what, cost) in [("energy ledger", results.ledger), ("default log", results.logging)] {
        if let Some(Spread { median, least, most }) = cost {
            let [median, least, most] = [median, least, most].map(share);
            let _ = writeln!(
                text,
                "- The {what}: {median} of a step without it ({least} to {most}), in a plane."
            );
        }
    }
    if let Some(batch) = results.batch {
        let _ = writeln!(
            text,
            "- {} impacts at the same time, each on one thread, in a plane: {} lost against one alone.",
            batch.impacts,
            share(batch.loss())
        );
    }
    for [first, again] in results.beds.iter().filter(|[first, _]| first.cache == "miss") {
        let _ = writeln!(
            text,
            "- Bed of {}: settled in {:.2} s; found again in {:.3} s.",
            first.bed, first.seconds, again.seconds
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;
    use crate::speed::problem::PROBLEMS;

    fn trial(grains: usize, cpu_s: f64, velocity: f64) -> Trial {
        Trial {
            grains,
            steps: 100,
            wall_s: cpu_s,
            cpu_s,
            peak_bytes: Some(2000 * grains as u64),
            held_bytes: Some(1000 * grains as u64 + 5_000_000),
            velocity_m_per_s: Some([0.0, 0.0, velocity]),
        }
    }

    fn peer(style: &str, is_same_law: bool, one: Trial) -> Peer {
        Peer {
            style: style.to_owned(),
            is_same_law,
            build: "wheel",
            one: vec![one],
            two: Vec::new(),
        }
    }

    fn results() -> (Plan, Results) {
        let measured = [1, 3].map(|index| {
            let problem = &PROBLEMS[index];
            let grains = 1000 * index;
            let seconds = 0.1 * (index * index) as f64;
            Measured {
                problem,
                span: problem.span,
                one: vec![trial(grains, seconds, -1.01)],
                two: Vec::new(),
                peers: vec![
                    peer("granular", true, trial(grains, 0.5 * seconds, -1.0)),
                    peer("gran/hertz/history", false, trial(grains, 0.25 * seconds, -1.25)),
                ],
            }
        });
        let plan = Plan {
            problems: Vec::new(),
            repeats: 1,
            shorter: 1,
            folder: PathBuf::new(),
            cache: PathBuf::new(),
            lammps: Vec::new(),
        };
        let measured = measured.into();
        (plan, Results { measured, beds: Vec::new(), logging: None, ledger: None, batch: None })
    }

    #[test]
    fn rates_ratios_growth_and_agreement_follow_from_the_trials() {
        let (plan, results) = results();
        let json = as_json(&plan, &results);
        let first = &json["problems"][0];
        assert_eq!(first["plunge"]["one_core_grain_steps_per_cpu_s"]["median"], 1e6);
        assert_eq!(first["plunge_over_lammps"]["one_core"]["median"], 0.5);
        assert_eq!(first["plunge_over_lammps"]["fastest"]["median"], 0.25);
        let fast = &first["peers"][1];
        for (key, expected) in [
            ("problem", json!("3d-12k")),
            ("peer_style", json!("gran/hertz/history")),
            ("peer_build", json!("wheel")),
            ("simd", json!(simd())),
            ("same_law", json!(false)),
        ] {
            assert_eq!(fast[key], expected, "{key}");
        }
        // What another law does is told and is no disagreement.
        assert!(fast["intruder_velocity_apart"].as_f64().is_some_and(|apart| apart > 0.19));
        assert_eq!(first["plunge"]["memory_per_grain_bytes"], 6000.0);
        assert_eq!(json["memory_per_further_grain_bytes"], 1000.0);
        assert_eq!(
            (&first["agrees"], &first["plunge_over_lammps"]["two_cores"]),
            (&json!(true), &Value::Null)
        );
        // Three times the grains in nine times the time.
        let growth = json["growth"][1]["cpu_per_grain_step_over_smallest"].as_f64();
        assert!(growth.is_some_and(|factor| (factor - 3.0).abs() < 1e-12), "{json:#}");
    }

    #[test]
    fn ranks_beside_threads_are_told_with_what_a_second_core_brings() {
        let (plan, mut results) = results();
        let [small, large] = &mut results.measured[..] else { panic!("two beds") };
        // 1e6 a second on one core; on two 1.5 times that, and of LAMMPS 2e6 and twice that.
        small.two = vec![trial(1000, 0.1 / 1.5, -1.0)];
        small.peers[0].two = vec![trial(1000, 0.025, -1.0)];
        large.two = Vec::new();
        let json = as_json(&plan, &results);
        let second = &json["problems"][0]["second_core"];
        for (key, expected) in [("threads", 0.75), ("ranks", 1.0), ("threads_over_ranks", 0.375)] {
            let found = second[key].as_f64().expect(key);
            assert!((found - expected).abs() < 1e-12, "{key}: {found}");
        }
        assert_eq!(json["crossover"], json!({ "ranks_overtake": "from", "grains": 1000 }));
        let page = as_markdown(&plan, &results);
        assert!(page.contains("two threads (ranks): 3d-12k 75.0 % (100.0 %)."), "{page}");
        assert!(
            page.contains(
                "are faster than plunge's two threads from the smallest bed on, of 1000 grains"
            ),
            "{page}"
        );
    }

    #[test]
    fn the_page_has_a_row_per_problem_and_a_dash_where_nothing_was_measured() {
        let (plan, results) = results();
        let page = as_markdown(&plan, &results);
        let row = page.lines().find(|line| line.starts_with("| 3d-12k")).expect("a row");
        assert!(
            row.contains(
                "| **1.00** (1.00–1.00) | **2.00** (2.00–2.00) | 0.50 | – | – | – | 6000 | 1.0 % |"
            ),
            "{row}"
        );
        assert!(page.contains("3.00 at 3000"), "{page}");
        let row =
            "| 3d-12k, `gran/hertz/history` | no | **4.00** (4.00–4.00) | **0.25** (0.25–0.25) |";
        assert!(page.lines().any(|line| line == row), "{page}");
    }
}
