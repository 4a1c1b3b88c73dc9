//! `cargo xtask bench resistive`: how many impacts on a resistive medium one core integrates in a second.

use std::error::Error;
use std::io::Write;
use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;
use configs::{LoadOptions, Model, ModelSource, find_shipped};
use validation::command::conclude;

/// Impacts per second on resistive media, on one core and without a log.
#[derive(Parser)]
#[command(bin_name = "cargo xtask bench resistive")]
struct Nothing {}

/// Impacts of each kind: enough for a second or so of work.
const IMPACTS: u32 = 4000;

/// Repetitions; the median of their rates is shown.
const REPEATS: usize = 5;

fn main() -> ExitCode {
    conclude(bench)
}

fn bench(_: &Nothing, out: &mut dyn Write) -> Result<ExitCode, Box<dyn Error>> {
    writeln!(
        out,
        "impacts per second on one core, without a log: median of {REPEATS} (least, most)\n"
    )?;
    for name in ["two-term-vector", "two-term-components", "poncelet", "link"] {
        for angle in ["90 deg", "45 deg"] {
            let mut rates =
                (0..REPEATS).map(|_| rate(name, angle)).collect::<Result<Vec<f64>, _>>()?;
            rates.sort_by(f64::total_cmp);
            let [least, median, most] = [0, REPEATS / 2, REPEATS - 1].map(|place| rates[place]);
            writeln!(out, "{name:<22}{angle:<9}{median:>9.0} ({least:.0}, {most:.0})")?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// Impacts per second of the shipped model `name` between 0.5 and 4 m/s; each is built anew.
fn rate(name: &str, angle: &str) -> Result<f64, Box<dyn Error>> {
    let text = find_shipped(name).ok_or("the model ships")?.text.to_owned();
    let source = ModelSource::Text { name: name.to_owned(), text, folder: ".".into() };
    let sets = vec![format!("impact.angle=\"{angle}\"")];
    let model = Model::load(source, &LoadOptions { sets, ..LoadOptions::default() })?.model;
    let resistive = model.resistive().ok_or("a resistive model")?;
    let mut condition = model.conditions()[0];
    let clock = Instant::now();
    for number in 0..IMPACTS {
        condition.speed = 0.5 + 3.5 * f64::from(number) / f64::from(IMPACTS);
        resistive.impact(&condition).run(model.run.duration, &mut ())?;
    }
    Ok(f64::from(IMPACTS) / clock.elapsed().as_secs_f64())
}
