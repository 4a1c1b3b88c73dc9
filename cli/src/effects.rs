//! `plunge effects`: the library of laws and effects.

use configs::contact_laws::{ActsOn, LAWS, LawEntry, find};
use configs::engine::ledger::ChannelKind;
use configs::engine::params::{Default, ParamSpec, Range};
use configs::engine::units::format_si;
use configs::{describe_range, nearest};
use serde_json::{Value, json};

use crate::output::{self, CommandError, CommandResult};

/// Arguments of `plunge effects`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// The law or effect to describe; all are listed without it.
    name: Option<String>,
    /// Print one JSON object to stdout.
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &Args) -> CommandResult {
    let Some(name) = &args.name else {
        return list(args.json);
    };
    let law = find(name).ok_or_else(|| unknown(name))?;
    match args.json {
        true => output::json_to_stdout(&as_json(law)),
        false => output::to_stdout(&as_text(law)),
    }
}

fn unknown(name: &str) -> CommandError {
    let names: Vec<&str> = LAWS.iter().map(|law| law.name).collect();
    let hint = match nearest(name, names.iter().copied()) {
        Some(near) => format!("did you mean `{near}`? "),
        None => String::new(),
    };
    CommandError::bad_input(format!(
        "there is no law or effect `{name}`; {hint}there are: {}",
        names.join(", ")
    ))
}

fn list(as_object: bool) -> CommandResult {
    if as_object {
        let laws: Vec<Value> = LAWS.iter().map(|law| as_json(law)).collect();
        return output::json_to_stdout(&json!({ "effects": laws }));
    }
    let width = LAWS.iter().map(|law| law.name.len()).max().unwrap_or(0) + 2;
    let mut text = String::new();
    for law in LAWS {
        text.push_str(&format!(
            "{:<width$}{:<14}{}\n",
            law.name,
            table_of(law.acts_on),
            law.summary
        ));
    }
    text.push_str("\n`plunge effects NAME` gives law, parameters, ranges and source.\n");
    output::to_stdout(&text)
}

/// The table of a model file that a law is written in.
fn table_of(acts_on: ActsOn) -> &'static str {
    match acts_on {
        ActsOn::ContactBase => "[contact_law]",
        ActsOn::ContactEffect => "[[effect]]",
    }
}

fn as_text(law: &LawEntry) -> String {
    let mut text = format!("{}  {}\n\n{}\n\n", law.name, table_of(law.acts_on), law.summary);
    let mut line = |name: &str, value: &str| text.push_str(&format!("{name:<11}{value}\n"));
    line("law", law.formula);
    line("signature", law.signature);
    line("source", law.source);
    let channels: Vec<String> = law
        .channels
        .iter()
        .map(|channel| format!("{} ({})", channel.name, kind_name(channel.kind)))
        .collect();
    line("energy", &channels.join(", "));
    text.push_str("\nparameters\n");
    let width = law.params.iter().map(|spec| spec.key.len()).max().unwrap_or(0) + 2;
    for spec in law.params {
        let indent = " ".repeat(width + 2);
        text.push_str(&format!("  {:<width$}{}\n", spec.key, spec.meaning));
        text.push_str(&format!(
            "{indent}{}; allowed {}; usual {}\n",
            default_text(spec),
            describe_range(spec.allowed, spec.dimension),
            describe_range(spec.plausible, spec.dimension)
        ));
    }
    text
}

fn default_text(spec: &ParamSpec) -> String {
    match spec.default {
        Default::Required => match spec.dimension.si_unit() {
            unit if unit.is_empty() => "required, a pure number".to_owned(),
            unit => format!("required, in {unit}"),
        },
        Default::Value(value) => format!("default {}", format_si(value, spec.dimension)),
        Default::SameAs(key) => format!("default: {key}"),
    }
}

fn kind_name(kind: ChannelKind) -> &'static str {
    match kind {
        ChannelKind::Stored => "stored",
        ChannelKind::Dissipated => "dissipated",
        ChannelKind::Input => "input",
    }
}

fn as_json(law: &LawEntry) -> Value {
    json!({
        "name": law.name,
        "acts_on": match law.acts_on {
            ActsOn::ContactBase => "contact-base",
            ActsOn::ContactEffect => "contact-effect",
        },
        "table": table_of(law.acts_on),
        "summary": law.summary,
        "law": law.formula,
        "signature": law.signature,
        "source": law.source,
        "parameters": law.params.iter().map(|spec| json!({
            "key": spec.key,
            "meaning": spec.meaning,
            "unit": spec.dimension.si_unit(),
            "required": spec.default == Default::Required,
            "default": match spec.default {
                Default::Value(value) => json!(value),
                Default::SameAs(key) => json!(key),
                Default::Required => Value::Null,
            },
            "allowed": range_json(spec.allowed),
            "plausible": range_json(spec.plausible),
        })).collect::<Vec<_>>(),
        "energy": law.channels.iter().map(|channel| json!({
            "channel": channel.name,
            "kind": kind_name(channel.kind),
        })).collect::<Vec<_>>(),
    })
}

/// Bounds that are the largest double stand for none.
fn range_json(range: Range) -> Value {
    let bound = |value: f64| (value.abs() < f64::MAX).then_some(value);
    json!({
        "min": bound(range.min),
        "min_included": range.includes_min,
        "max": bound(range.max),
    })
}
