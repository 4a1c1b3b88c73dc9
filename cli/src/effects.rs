//! `plunge effects`: the library of laws and effects.

use std::path::PathBuf;

use configs::{describe_range, nearest};
use contact_laws::{ActsOn, Candidacy, Candidate, GRAIN_FORCES, GrainForceEntry, LAWS, LawEntry};
use engine::grains::Space;
use engine::ledger::{Channel, ChannelKind};
use engine::params::{ParamDefault, ParamSpec, Range};
use engine::units::format_si;
use resistive::{Confounder, OtherForm, RESISTANCE_LAWS, ResistanceEntry, Role, confounders};
use serde_json::{Value, json};

use crate::bed_changes;
use crate::output::{self, CommandError, CommandResult};
use crate::own_effects::{self, OwnInModel};

/// Arguments of `plunge effects`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// The law or effect to describe; all are listed without it.
    name: Option<String>,
    /// List and describe the effects that this model defines too: a file, or the name of a shipped model.
    #[arg(long, value_name = "MODEL")]
    model: Option<PathBuf>,
    /// Print one JSON object to stdout.
    #[arg(long)]
    json: bool,
}

/// A law or effect of either medium, as it is described.
struct Described {
    name: &'static str,
    /// The kind of medium that it acts in.
    medium: &'static str,
    acts_on: &'static str,
    /// The table of a model file that it is written in.
    table: &'static str,
    summary: &'static str,
    formula: &'static str,
    signature: &'static str,
    source: &'static str,
    params: &'static [ParamSpec],
    /// The values of other parameters that a diagnosis tries.
    forms: &'static [OtherForm],
    channels: Vec<Channel>,
    /// What an expression in place of a parameter may depend on.
    variables: &'static [&'static str],
    /// What data must have to show an effect.
    shows_with: Vec<&'static str>,
    /// The effects that look like it.
    confounders: Vec<Confounder>,
    on_beds: OnBeds,
}

/// Whether the diagnosis of a bed of grains looks for an effect.
enum OnBeds {
    /// It is simulated.
    Simulated(Candidate),
    /// It is predicted by a force law.
    Predicted,
    /// It is not looked for, for this reason.
    No(&'static str),
}

impl From<Candidacy> for OnBeds {
    fn from(candidacy: Candidacy) -> Self {
        match candidacy {
            Candidacy::Candidate(candidate) => Self::Simulated(candidate),
            Candidacy::None(why) => Self::No(why),
        }
    }
}

impl OnBeds {
    fn text(&self) -> String {
        match self {
            Self::Simulated(Candidate { amplitude, screen, range: (least, most), .. }) => {
                format!("of beds: {amplitude}, {least} to {most}, screened at {screen}")
            }
            Self::Predicted => "of beds: predicted by the force law nearest to the bed".to_owned(),
            Self::No(why) => format!("not of beds: {why}"),
        }
    }

    fn json(&self) -> Value {
        match self {
            Self::Simulated(candidate) => json!({
                "amplitude": candidate.amplitude,
                "screened_at": candidate.screen,
                "range": [candidate.range.0, candidate.range.1],
                "told_apart": candidate.separable_from,
            }),
            Self::Predicted => json!({ "by": "force-law" }),
            Self::No(why) => json!({ "none": why }),
        }
    }
}

impl From<&LawEntry> for Described {
    fn from(law: &LawEntry) -> Self {
        let (acts_on, table) = match law.acts_on {
            ActsOn::ContactBase => ("contact-base", "[contact_law]"),
            ActsOn::ContactEffect => ("contact-effect", "[[effect]]"),
        };
        Self {
            name: law.name,
            medium: "grains",
            acts_on,
            table,
            summary: law.summary,
            formula: law.formula,
            signature: law.signature,
            source: law.source,
            params: law.params,
            forms: &[],
            channels: law.channels.to_vec(),
            variables: &[],
            shows_with: Vec::new(),
            confounders: Vec::new(),
            on_beds: law.candidacy.into(),
        }
    }
}

impl From<&GrainForceEntry> for Described {
    fn from(force: &GrainForceEntry) -> Self {
        Self {
            name: force.name,
            medium: "grains",
            acts_on: match force.only_in.map(|(space, _)| space) {
                Some(Space::Planar) => "discs",
                Some(Space::Spatial) => "spheres",
                None => "grains",
            },
            table: "[[effect]]",
            summary: force.summary,
            formula: force.formula,
            signature: force.signature,
            source: force.source,
            params: force.params,
            forms: &[],
            channels: vec![Channel { name: force.name, kind: ChannelKind::Dissipated }],
            variables: &[],
            shows_with: Vec::new(),
            confounders: Vec::new(),
            on_beds: force.candidacy.into(),
        }
    }
}

impl From<&ResistanceEntry> for Described {
    fn from(law: &ResistanceEntry) -> Self {
        let (acts_on, table, visible, absent) = match law.role {
            Role::Baseline => {
                ("resistance-base", "[resistance]", &[][..], Some("it is the force law itself"))
            }
            Role::Effect(facts) => {
                let absent = facts.kind.absent_from_beds();
                ("resistance-effect", "[[effect]]", facts.visible, absent)
            }
        };
        Self {
            name: law.name,
            medium: "resistive-force",
            acts_on,
            table,
            summary: law.summary,
            formula: law.formula,
            signature: law.signature,
            source: law.source,
            params: law.params,
            forms: law.forms,
            channels: law.accounts.iter().map(|account| account.channel).collect(),
            variables: law.variables,
            shows_with: visible.iter().map(|need| need.describe()).collect(),
            confounders: confounders(law.name).collect(),
            on_beds: absent.map_or(OnBeds::Predicted, OnBeds::No),
        }
    }
}

/// Everything there is, by medium.
fn library() -> Vec<Described> {
    let grains = LAWS.iter().map(|law| Described::from(*law));
    let forces = GRAIN_FORCES.iter().map(|force| Described::from(*force));
    grains.chain(forces).chain(RESISTANCE_LAWS.iter().map(|law| Described::from(*law))).collect()
}

pub(crate) fn run(args: &Args) -> CommandResult {
    let library = library();
    let own = match &args.model {
        Some(model) => own_effects::of(model)?,
        None => Vec::new(),
    };
    let Some(name) = &args.name else {
        return list(&library, &own, args.json);
    };
    if name == "expression" {
        return own_effects::describe_formulas(args.json);
    }
    if let Some(own) = own.iter().find(|one| one.effect.id() == name) {
        return own.describe(args.json);
    }
    let law = library.iter().find(|law| law.name == name);
    let change = bed_changes::all().find(|change| change.id == name);
    if law.is_none() && change.is_none() {
        return Err(unknown(name, &library));
    }
    if !args.json {
        let texts = [law.map(as_text), change.map(bed_changes::as_text)];
        return output::to_stdout(&texts.into_iter().flatten().collect::<Vec<_>>().join("\n"));
    }
    match (law.map(as_json), change.map(bed_changes::as_json)) {
        (Some(mut law), Some(change)) => {
            law["change_of_beds"] = change;
            output::json_to_stdout(&law)
        }
        (law, change) => output::json_to_stdout(&json!(law.or(change))),
    }
}

fn unknown(name: &str, library: &[Described]) -> CommandError {
    let changes = bed_changes::all().map(|change| change.id);
    let names: Vec<&str> = library.iter().map(|law| law.name).chain(changes).collect();
    let hint = match nearest(name, names.iter().copied()) {
        Some(near) => format!("did you mean `{near}`? "),
        None => String::new(),
    };
    CommandError::bad_input(format!(
        "there is no law or effect `{name}`; {hint}there are: {}",
        names.join(", ")
    ))
}

fn list(library: &[Described], own: &[OwnInModel], as_object: bool) -> CommandResult {
    if as_object {
        let own = own.iter().map(OwnInModel::as_json);
        let laws: Vec<Value> = library.iter().map(as_json).chain(own).collect();
        let changes: Vec<Value> = bed_changes::all().map(bed_changes::as_json).collect();
        return output::json_to_stdout(&json!({ "effects": laws, "changes_of_beds": changes }));
    }
    let names = library.iter().map(|law| law.name).chain(own.iter().map(|one| one.effect.id()));
    let width = names.map(str::len).max().unwrap_or(0) + 2;
    let mut text = String::new();
    let mut medium = "";
    for law in library {
        if law.medium != medium {
            let gap = if medium.is_empty() { "" } else { "\n" };
            medium = law.medium;
            text.push_str(&format!("{gap}medium of the kind \"{medium}\"\n"));
        }
        text.push_str(&format!("  {:<width$}{:<15}{}\n", law.name, law.table, law.summary));
    }
    text.push_str(&format!(
        "  {:<width$}{:<15}a force of your own, as a formula\n",
        "expression", "[[effect]]"
    ));
    text.push_str("\nchanges of a bed that its diagnosis tries\n");
    for change in bed_changes::all() {
        text.push_str(&format!("  {:<width$}{}\n", change.id, change.amplitude));
    }
    if !own.is_empty() {
        text.push_str("\ndefined by the model\n");
    }
    for one in own {
        let summary = &one.effect.draft().summary;
        text.push_str(&format!("  {:<width$}{:<15}{summary}\n", one.effect.id(), one.table()));
    }
    text.push_str("\n`plunge effects NAME` gives law, parameters, ranges and source.\n");
    output::to_stdout(&text)
}

fn as_text(law: &Described) -> String {
    let mut text = format!(
        "{}  {}, in a medium of the kind \"{}\"\n\n{}\n\n",
        law.name, law.table, law.medium, law.summary
    );
    let mut line = |name: &str, value: &str| text.push_str(&format!("{name:<11}{value}\n"));
    line("law", law.formula);
    line("signature", law.signature);
    line("source", law.source);
    let channels: Vec<String> = law
        .channels
        .iter()
        .map(|channel| format!("{} ({})", channel.name, kind_name(channel.kind)))
        .collect();
    match channels.as_slice() {
        [] => line("energy", "books nothing of its own"),
        channels => line("energy", &channels.join(", ")),
    }
    if !law.shows_with.is_empty() {
        line("shows with", &law.shows_with.join(", "));
    }
    for (index, confounder) in law.confounders.iter().enumerate() {
        let name = if index == 0 { "separable" } else { "" };
        line(name, &format!("from {}", confounder.describe()));
    }
    line("diagnosis", &law.on_beds.text());
    for (index, form) in law.forms.iter().enumerate() {
        let values: Vec<String> =
            form.values.iter().map(|(key, value)| format!("{key} = {value}")).collect();
        line(if index == 0 { "forms" } else { "" }, &format!("also with {}", values.join(", ")));
    }
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
    if !law.variables.is_empty() {
        text.push_str(&format!(
            "\nA parameter may be a table over the impact angle, {{ angle = […], value = […] }}, or\n\
             {{ expression = \"…\" }} of {}, in SI.\n",
            law.variables.join(", ")
        ));
    }
    text
}

fn default_text(spec: &ParamSpec) -> String {
    match spec.default {
        ParamDefault::Required => match spec.dimension.si_unit() {
            unit if unit.is_empty() => "required, a pure number".to_owned(),
            unit => format!("required, in {unit}"),
        },
        ParamDefault::Value(value) => format!("default {}", format_si(value, spec.dimension)),
        ParamDefault::SameAs(key) => format!("default: {key}"),
        ParamDefault::FromBase(key) => {
            format!("default: {key} of the contact law, which must have it")
        }
    }
}

fn kind_name(kind: ChannelKind) -> &'static str {
    match kind {
        ChannelKind::Stored => "stored",
        ChannelKind::Dissipated => "dissipated",
        ChannelKind::Input => "input",
    }
}

fn as_json(law: &Described) -> Value {
    let mut object = json!({
        "name": law.name,
        "medium": law.medium,
        "acts_on": law.acts_on,
        "table": law.table,
        "summary": law.summary,
        "law": law.formula,
        "signature": law.signature,
        "source": law.source,
        "parameters": law.params.iter().map(parameter_json).collect::<Vec<_>>(),
        "energy": law.channels.iter().map(|channel| json!({
            "channel": channel.name,
            "kind": kind_name(channel.kind),
        })).collect::<Vec<_>>(),
    });
    object["diagnosis_of_beds"] = law.on_beds.json();
    if !law.forms.is_empty() {
        let form = |form: &OtherForm| -> Value { form.values.iter().copied().collect() };
        object["forms"] = law.forms.iter().map(form).collect();
    }
    if !law.variables.is_empty() {
        object["variables"] = json!(law.variables);
    }
    if !law.shows_with.is_empty() {
        object["shows_with"] = json!(law.shows_with);
    }
    if !law.confounders.is_empty() {
        let told_apart: Vec<Value> = law.confounders.iter().map(confounder_json).collect();
        object["told_apart"] = json!(told_apart);
    }
    object
}

fn confounder_json(confounder: &Confounder) -> Value {
    let by: Vec<&str> = confounder.any_of.iter().map(|need| need.describe()).collect();
    json!({ "from": confounder.effect, "by_any_of": by })
}

fn parameter_json(spec: &ParamSpec) -> Value {
    json!({
        "key": spec.key,
        "meaning": spec.meaning,
        "unit": spec.dimension.si_unit(),
        "required": spec.default == ParamDefault::Required,
        "default": match spec.default {
            ParamDefault::Value(value) => json!(value),
            ParamDefault::SameAs(key) => json!(key),
            ParamDefault::FromBase(key) => json!(format!("contact_law.{key}")),
            ParamDefault::Required => Value::Null,
        },
        "allowed": range_json(spec.allowed),
        "plausible": range_json(spec.plausible),
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
