//! `[fit]`: which numbers of a force law a fit may change.

use engine::params::ParamDefault;

use crate::diagnostics::{Diagnostic, nearest, shorten};
use crate::model::{Coefficient, EffectChoice, ResistanceChoice};
use crate::reader::{Answer, Found, TableReader};

/// The paths of the free numbers: those that `free` lists, tables node by node, else the required
/// coefficients of the baseline as far as they are numbers.
pub(super) fn free(
    table: TableReader<'_>,
    resistance: Option<&ResistanceChoice>,
    effects: Option<&[EffectChoice]>,
) -> Option<Vec<String>> {
    table.asks("free", "the numbers that a fit may change, by their paths", || Answer::Texts);
    let given = table.raw_texts("free", "resistance.drag");
    let (resistance, effects) = (resistance?, effects?);
    let free = match given? {
        Some(given) => expanded(&table, &given, resistance, effects)?,
        None => required(resistance),
    };
    table.note_texts("free", &free);
    table.finish();
    Some(free)
}

fn required(resistance: &ResistanceChoice) -> Vec<String> {
    let required = resistance.iter().filter(|(spec, _)| spec.default == ParamDefault::Required);
    required.flat_map(|(spec, _)| resistance.paths_of(spec.key)).collect()
}

/// The listed paths, each table by its nodes; every fault is reported.
fn expanded(
    table: &TableReader<'_>,
    given: &[Found<String>],
    resistance: &ResistanceChoice,
    effects: &[EffectChoice],
) -> Option<Vec<String>> {
    let mut free: Vec<String> = Vec::new();
    let mut sound = true;
    for path in given {
        let fault = match paths(&path.value, resistance, effects) {
            Err(fault) => *fault,
            Ok(found) => match found.iter().find(|one| free.contains(one)) {
                Some(again) => {
                    Diagnostic::error(format!("`{again}` is listed twice")).help("keep it once")
                }
                None => {
                    free.extend(found);
                    continue;
                }
            },
        };
        table.reader.report(fault.at(path.span, ""));
        sound = false;
    }
    sound.then_some(free)
}

/// The numbers that `path` means, or what is wrong with it.
fn paths(
    path: &str,
    resistance: &ResistanceChoice,
    effects: &[EffectChoice],
) -> Result<Vec<String>, Box<Diagnostic>> {
    let mut known: Vec<String> = Vec::new();
    for (spec, coefficient) in resistance.iter() {
        let whole = format!("resistance.{}", spec.key);
        let nodes = resistance.paths_of(spec.key);
        if path == whole {
            return match coefficient {
                Coefficient::Expression(_) => {
                    let what = format!("`{whole}` is an expression, which a fit cannot change");
                    let advice = "give it a number, or take it out of `free`";
                    Err(Diagnostic::error(what).help(advice).into())
                }
                _ => Ok(nodes),
            };
        }
        known.push(whole);
        known.extend(nodes);
    }
    known.extend(effects.iter().map(|effect| format!("effect.{}.q", effect.effect.name())));
    if known.iter().any(|one| one == path) {
        return Ok(vec![path.to_owned()]);
    }
    let fault = Diagnostic::error(format!("there is no number `{}` in this model", shorten(path)));
    let advice = match nearest(path, known.iter().map(String::as_str)) {
        Some(near) => format!("did you mean `{near}`?"),
        None => "write it as \"resistance.KEY\" or \"effect.NAME.q\"".to_owned(),
    };
    Err(fault.help(advice).into())
}
