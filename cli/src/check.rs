//! `plunge check`: what a model means and what it will cost.

use std::path::PathBuf;

use configs::estimate::Estimate;
use configs::{Color, Model, stability};
use serde_json::{Value, json};

use crate::common::Common;
use crate::output::{self, CommandResult};

/// Arguments of `plunge check`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// A model file, or the name of a shipped model.
    model: PathBuf,
    #[command(flatten)]
    common: Common,
}

pub(crate) fn run(args: &Args) -> CommandResult {
    let loaded = args.common.load(&args.model)?;
    let model = &loaded.model;
    let estimate = Estimate::of(model);
    args.common.refuse_too_large(model)?;
    match args.common.json {
        true => {
            let mut object = as_json(model, &estimate);
            let warnings: Vec<String> =
                loaded.warnings.iter().map(|one| one.render(&loaded.sources, Color::Off)).collect();
            object["warnings"] = json!(warnings);
            output::json_to_stdout(&object)
        }
        false => output::to_stdout(&as_text(model, &estimate)),
    }
}

fn as_text(model: &Model, estimate: &Estimate) -> String {
    let mut text = format!("{}: a valid model\n\n", model.run.name);
    let mut line = |name: &str, value: String| text.push_str(&format!("  {name:<12}{value}\n"));
    line("hash", model.hash());
    line("grains", estimate.n_grains.to_string());
    line("impacts", estimate.n_conditions.to_string());
    match (stability::time_step(model), estimate.steps) {
        (Some(step), Some(steps)) => {
            let collision = stability::shortest_collision_time(model)
                .map(|time| format!(", {:.1} per shortest collision", time / step));
            line("time step", format!("{step:e} s{}", collision.unwrap_or_default()));
            line("steps", format!("{steps} at most, per impact"));
        }
        _ => line("time step", "known when the laws are built".to_owned()),
    }
    line("memory", format!("about {}", output::bytes(estimate.memory_bytes)));
    if let Some(time) = estimate.run_time_s {
        let note = "at most, per impact, without preparing the bed";
        line("run time", format!("about {} {note}", duration(time)));
    }
    format!("{text}\nIn SI, with every default:\n\n{}", model.resolved_toml())
}

fn as_json(model: &Model, estimate: &Estimate) -> Value {
    json!({
        "name": model.run.name,
        "version": env!("CARGO_PKG_VERSION"),
        "valid": true,
        "model_hash": model.hash(),
        "medium": "grains",
        "bed": { "grains": estimate.n_grains },
        "impacts": model.conditions().iter().map(|condition| json!({
            "speed_m_per_s": condition.speed,
            "angle_deg": condition.angle_deg(),
            "position_index": condition.position_index,
        })).collect::<Vec<_>>(),
        "time": {
            "duration_s": model.run.duration,
            "dt_s": stability::time_step(model),
            "steps": estimate.steps,
            "shortest_collision_s": stability::shortest_collision_time(model),
        },
        "resolved_toml": model.resolved_toml(),
        "cost": {
            "memory_bytes": estimate.memory_bytes,
            "run_time_s": estimate.run_time_s,
        },
    })
}

/// A duration in the unit that one would say.
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 1.0 => "1 s".to_owned(),
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s if s < 172_800.0 => format!("{:.0} h", s / 3600.0),
        s => format!("{:.0} days", s / 86_400.0),
    }
}
