//! `plunge check`: what a model means and what it will cost; `check_set` has measurement sets.

use std::path::PathBuf;

use configs::estimate::Estimate;
use configs::{Color, GrainModel, Medium, Model, ResistiveModel, TimeStep, stability};
use resistive::Space;
use serde_json::{Map, Value, json};

use crate::check_cost::GrainCost;
use crate::check_set;
use crate::common::Common;
use crate::output::{self, CommandError, CommandResult};
use crate::table_file;

/// Arguments of `plunge check`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// A model file, or the name of a shipped model. Or a measurement set: its folder or its file.
    #[arg(value_name = "MODEL|SET")]
    model: PathBuf,
    /// Estimate time and memory on this machine from a column of the bed: some seconds, once per bed.
    #[arg(long)]
    pub(crate) measure: bool,
    #[command(flatten)]
    pub(crate) common: Common,
}

pub(crate) fn run(args: &Args) -> CommandResult {
    table_file::refuse(&args.model)?;
    check_set::refuse_campaign(&args.model)?;
    if check_set::is_set(&args.model) {
        return check_set::run(&args.model, &args.common);
    }
    let loaded = args.common.load(&args.model)?;
    let model = &loaded.model;
    args.common.refuse_too_large(model)?;
    let facts = match &model.medium {
        Medium::Grains(medium) => of_grains(GrainModel { model, medium }, args)?,
        Medium::Resistive(medium) => of_resistance(ResistiveModel { model, medium }),
    };
    match args.common.json {
        true => {
            let warnings: Vec<String> =
                loaded.warnings.iter().map(|one| one.render(&loaded.sources, Color::Off)).collect();
            output::json_to_stdout(&as_json(model, facts, &warnings))
        }
        false => output::to_stdout(&as_text(model, &facts)),
    }
}

/// What there is to say of a model by its medium.
struct Facts {
    /// Names and values, as shown.
    lines: Vec<(&'static str, String)>,
    /// The same as keys of the JSON object.
    json: Map<String, Value>,
}

fn of_grains(grains: GrainModel<'_>, args: &Args) -> Result<Facts, CommandError> {
    let estimate = Estimate::of(grains);
    let times = stability::times(grains);
    let collision = times.collision;
    let step = stability::time_step(grains);
    let mut lines = vec![
        ("grains", estimate.n_grains.to_string()),
        ("impacts", estimate.n_conditions.to_string()),
    ];
    match (step, estimate.steps) {
        (Some(step), Some(steps)) => {
            let per_collision = collision.map_or(String::new(), |time| {
                format!(", {:.1} per shortest collision", time / step)
            });
            let decided = match (grains.medium.stepping.time_step, times.step()) {
                (TimeStep::Auto, Some((_, by))) => format!(", set by {}", by.describe()),
                _ => String::new(),
            };
            lines.push((
                "time step",
                format!("{:e} s{per_collision}{decided}", reports::rounded(step, 4)),
            ));
            lines.push(("steps", format!("{steps} at most, per impact")));
        }
        _ => lines.push(("time step", "known when the laws are built".to_owned())),
    }
    let cost = GrainCost::of(grains, &args.common, args.measure)?;
    lines.extend(cost.lines());
    let json = [
        ("bed", json!({ "grains": estimate.n_grains })),
        (
            "time",
            json!({
                "duration_s": grains.model.run.duration,
                "dt_s": step,
                "steps": estimate.steps,
                "shortest_collision_s": collision,
            }),
        ),
        ("cost", cost.json()),
    ];
    let json = json.map(|(key, value)| (key.to_owned(), value)).into_iter().collect();
    Ok(Facts { lines, json })
}

fn of_resistance(resistive: ResistiveModel<'_>) -> Facts {
    let ResistiveModel { model, medium } = resistive;
    let law = medium.resistance.entry;
    let effects: Vec<&str> = medium.effects.iter().map(|effect| effect.effect.name()).collect();
    let integrated = match effects.as_slice() {
        [] => law.name.to_owned(),
        effects => format!("{} with {}", law.name, effects.join(", ")),
    };
    let dimension = match medium.space {
        Space::Planar => 2,
        Space::Spatial => 3,
    };
    let free = medium.free_parameters();
    let shown: Vec<&str> = free.iter().map(|one| one.path.as_str()).collect();
    let lines = vec![
        ("law", integrated),
        ("", law.formula.to_owned()),
        ("body", format!("{}, in {dimension} dimensions", model.intruder.shape.name)),
        ("impacts", model.conditions().len().to_string()),
        ("solver", "steps of its own, to about 1e-10 m".to_owned()),
        ("samples", format!("every {:e} s in the log", medium.log_interval)),
        ("free", if shown.is_empty() { "nothing".to_owned() } else { shown.join(", ") }),
    ];
    let parameters: Vec<Value> = free
        .iter()
        .map(|one| json!({ "path": one.path, "value": one.value, "unit": one.unit }))
        .collect();
    let json = [
        ("law", json!({ "name": law.name, "effects": effects })),
        ("free", json!(parameters)),
        ("time", json!({ "duration_s": model.run.duration, "interval_s": medium.log_interval })),
    ];
    Facts { lines, json: json.map(|(key, value)| (key.to_owned(), value)).into_iter().collect() }
}

fn as_text(model: &Model, facts: &Facts) -> String {
    let mut text = format!("{}: a valid model\n\n", model.run.name);
    let hash = ("hash", model.hash());
    for (name, value) in std::iter::once(&hash).chain(&facts.lines) {
        text.push_str(&format!("  {name:<12}{value}\n"));
    }
    format!("{text}\nIn SI, with every default:\n\n{}", model.resolved_toml())
}

fn as_json(model: &Model, facts: Facts, warnings: &[String]) -> Value {
    let mut object = json!({
        "name": model.run.name,
        "version": env!("CARGO_PKG_VERSION"),
        "valid": true,
        "model_hash": model.hash(),
        "medium": model.medium.kind(),
        "impacts": model.conditions().iter().map(|condition| json!({
            "speed_m_per_s": condition.speed,
            "angle_deg": condition.angle_deg(),
            "position_index": condition.position_index,
        })).collect::<Vec<_>>(),
    });
    for (key, value) in facts.json {
        object[key] = value;
    }
    object["resolved_toml"] = json!(model.resolved_toml());
    object["warnings"] = json!(warnings);
    object
}
