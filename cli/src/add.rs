//! `plunge add`: an effect becomes part of a model.

use std::fs;
use std::path::{Path, PathBuf};

use configs::edit::{AddedEffect, Addition, add_effects};
use configs::{LoadOptions, Model, ModelSource, nearest};
use diagnosis::missing_force::FOUND;
use serde_json::{Value, json};

use crate::output::{self, CommandError, CommandResult};
use crate::workbench::write_whole;

/// Arguments of `plunge add`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// A model file, or the name of a shipped model.
    model: PathBuf,
    /// The effect to add; with --from, --effect says which.
    name: Option<String>,
    /// Its parameters: `q=0.4`, `rolling_friction=0.05`, `cohesion="120 Pa"`.
    #[arg(value_name = "KEY=VALUE")]
    values: Vec<String>,
    /// Take the effect and the fitted values from a diagnosis.json.
    #[arg(long, value_name = "DIAGNOSIS.json", conflicts_with_all = ["name", "values"])]
    from: Option<PathBuf>,
    /// Which of the effects of the diagnosis, or `found` for the formula of the missing force; without, what its verdict
    /// names.
    #[arg(long, value_name = "NAME", requires = "from")]
    effect: Option<String>,
    /// The file to write; without --force an existing file is refused.
    #[arg(short, long, value_name = "NEW.toml")]
    output: PathBuf,
    /// Write over the file.
    #[arg(long)]
    force: bool,
    /// Print one JSON object to stdout.
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &Args) -> CommandResult {
    let source = || ModelSource::from_argument(&args.model);
    let loaded = Model::load(source(), &LoadOptions::default())?;
    let addition = match (&args.from, &args.name) {
        (Some(path), _) => read_diagnosis(path, args.effect.as_deref())?,
        (None, Some(name)) => by_hand(name, &args.values)?,
        (None, None) => {
            return Err(CommandError::bad_input(
                "say which effect to add: `plunge add MODEL NAME key=value … -o NEW`, or \
                 `--from DIAGNOSIS.json`",
            ));
        }
    };
    if args.output.exists() && !args.force {
        return Err(CommandError::bad_input(format!(
            "{} is there already; choose another name, or --force to write over it",
            args.output.display()
        )));
    }
    let text = add_effects(loaded.original.as_str(), &addition).map_err(CommandError::bad_input)?;
    let folder = args.output.parent().unwrap_or(Path::new("")).to_owned();
    let name = args.output.display().to_string();
    let changed = ModelSource::Text { name: name.clone(), text: text.clone(), folder };
    Model::load(changed, &LoadOptions::default())?;
    write_whole(&args.output, &text)?;
    let effects: Vec<&str> = addition.effects.iter().map(|effect| effect.name.as_str()).collect();
    match args.json {
        true => output::json_to_stdout(&json!({
            "model": name,
            "added": effects,
            "fitted": addition.fitted.iter().map(|(path, value)| json!({
                "parameter": path, "value": value,
            })).collect::<Vec<_>>(),
        })),
        false => {
            let fitted = match addition.fitted.len() {
                0 => String::new(),
                n => format!(", {n} fitted values set"),
            };
            output::to_stdout(&format!("{name}: {} added{fitted}\n", effects.join(" and ")))
        }
    }
}

fn by_hand(name: &str, values: &[String]) -> Result<Addition, CommandError> {
    let values = values
        .iter()
        .map(|pair| {
            let (key, value) = pair.split_once('=').ok_or_else(|| {
                CommandError::bad_input(format!("`{pair}` is not of the form key=value"))
            })?;
            Ok((key.trim().to_owned(), value.trim().to_owned()))
        })
        .collect::<Result<_, CommandError>>()?;
    Ok(Addition {
        effects: vec![AddedEffect { name: name.to_owned(), values }],
        ..Addition::default()
    })
}

fn read_diagnosis(path: &Path, effect: Option<&str>) -> Result<Addition, CommandError> {
    let shown = path.display();
    let text = fs::read_to_string(path)
        .map_err(|error| CommandError::bad_input(format!("cannot read {shown}: {error}")))?;
    let object: Value = serde_json::from_str(&text)
        .map_err(|error| CommandError::bad_input(format!("{shown} is no JSON: {error}")))?;
    let Some(verdict) = object["verdict"].as_str() else {
        return Err(CommandError::bad_input(format!(
            "{shown} is no diagnosis: it has no `verdict`; --from takes the diagnosis.json that `plunge diagnose` writes"
        )));
    };
    let named: Vec<&str> = match effect {
        Some(name) => vec![name],
        None => strings(&object["effects"]),
    };
    if named.is_empty() {
        return Err(CommandError::bad_input(format!(
            "{shown} names no effect (its verdict is {verdict}); --effect says which to add all the \
             same"
        )));
    }
    from_diagnosis(&object, &named)
        .map_err(|why| CommandError::bad_input(format!("{shown}: {why}")))
}

fn strings(list: &Value) -> Vec<&str> {
    list.as_array().into_iter().flatten().filter_map(Value::as_str).collect()
}

/// What a diagnosis says of `effects`: their amplitudes, and the parameters of the model with them.
///
/// # Errors
/// If it says nothing of one of them.
pub(crate) fn from_diagnosis(object: &Value, effects: &[&str]) -> Result<Addition, String> {
    if effects == [FOUND] {
        return found(&object["missing_force"]);
    }
    let named = strings(&object["effects"]);
    let empty = Vec::new();
    let ranking = object["ranking"].as_array().unwrap_or(&empty);
    // What the verdict names was fitted together; any other effect was fitted alone.
    let (amplitudes, parameters): (&Vec<Value>, &Value) = match effects.len() == named.len()
        && effects.iter().all(|name| named.contains(name))
    {
        true => (object["amplitudes"].as_array().unwrap_or(&empty), &object["parameters"]),
        false => {
            let alone =
                effects.first().and_then(|name| ranking.iter().find(|entry| entry["id"] == *name));
            (ranking, alone.map_or(&Value::Null, |entry| &entry["parameters"]))
        }
    };
    let additions = effects
        .iter()
        .map(|name| {
            let entry = amplitudes.iter().find(|entry| entry["id"] == *name);
            match entry.and_then(|entry| entry["q"].as_f64()) {
                Some(0.0) => {
                    Err(format!("the amplitude of `{name}` is 0 there: it changes nothing"))
                }
                Some(q) => {
                    let form = entry.and_then(|entry| entry["form"].as_object());
                    let form = form.into_iter().flatten();
                    let form = form.map(|(key, value)| (key.clone(), value.to_string()));
                    let values = std::iter::once(("q".to_owned(), format!("{q}"))).chain(form);
                    Ok(AddedEffect { name: (*name).to_owned(), values: values.collect() })
                }
                None => Err(no_amplitude(name, ranking)),
            }
        })
        .collect::<Result<_, String>>()?;
    Ok(Addition { effects: additions, fitted: fitted(parameters), candidates: Vec::new() })
}

/// Why `ranking` has no amplitude of the effect `name`.
fn no_amplitude(name: &str, ranking: &[Value]) -> String {
    let ids = || ranking.iter().filter_map(|entry| entry["id"].as_str());
    let why = ranking.iter().find(|entry| entry["id"] == name);
    match (why.and_then(|entry| entry["note"].as_str()), nearest(name, ids())) {
        (Some(why), _) => format!("`{name}` was not fitted: {why}"),
        (None, Some(near)) => format!("no amplitude of `{name}` is there; did you mean `{near}`?"),
        (None, None) => {
            let known: Vec<&str> = ids().collect();
            format!(
                "no amplitude of `{name}` is there; of these there may be: {}",
                known.join(", ")
            )
        }
    }
}

/// The formula of the missing force that a diagnosis offers, with the parameters of the model with it.
fn found(missing_force: &Value) -> Result<Addition, String> {
    let (Some(q), Some(table)) = (missing_force["q"].as_f64(), missing_force["candidate"].as_str())
    else {
        return Err("it offers no formula for a missing force".to_owned());
    };
    let effect =
        AddedEffect { name: FOUND.to_owned(), values: vec![("q".to_owned(), format!("{q}"))] };
    Ok(Addition {
        effects: vec![effect],
        fitted: fitted(&missing_force["parameters"]),
        candidates: vec![table.to_owned()],
    })
}

/// Paths and values of `parameters`.
fn fitted(parameters: &Value) -> Vec<(String, f64)> {
    let entries = parameters.as_object().into_iter().flatten();
    entries.filter_map(|(path, entry)| Some((path.clone(), entry["value"].as_f64()?))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use configs::find_shipped;

    #[test]
    fn the_formula_of_a_missing_force_becomes_an_effect_and_comments_stay() {
        let object = json!({
            "effects": [],
            "missing_force": {
                "q": 15.4,
                "candidate": "[[candidate]]\nname = \"expression\"\nid = \"found\"\nkind = \"friction\"\n\
                    force = \"q * rho * g * A * D * exp(0 - ((z / mm - 19.5) / 5.6)^2)\"\n\
                    parameters.q = { unit = \"1\", range = [-10000, 10000] }\n\
                    parameters.mm = { value = 0.001, unit = \"m\" }\n",
                "parameters": { "resistance.drag": { "value": 1.25, "unit": "1" } },
            },
        });
        let addition = from_diagnosis(&object, &[FOUND]).expect("a formula");
        let shipped = find_shipped("two-term-vector").expect("it ships").text;
        let text = add_effects(shipped, &addition).expect("it is added");
        let comments = |text: &str| text.lines().filter(|line| line.contains('#')).count();
        assert_eq!(comments(&text), comments(shipped));
        let source = ModelSource::Text { name: "new".into(), text, folder: ".".into() };
        let loaded = Model::load(source, &LoadOptions::default()).expect("the model loads");
        let configs::Medium::Resistive(medium) = loaded.model.medium else { panic!("a force law") };
        let found =
            medium.effects.iter().find(|one| one.effect.name() == FOUND).expect("it is there");
        assert!((found.q - 15.4).abs() < 1e-9);
        assert!(medium.candidates.is_empty());
    }

    #[test]
    fn a_diagnosis_without_a_formula_says_so() {
        let object = json!({ "missing_force": null });
        let error = from_diagnosis(&object, &[FOUND]).expect_err("nothing to add");
        assert!(error.contains("no formula"), "{error}");
    }
}
