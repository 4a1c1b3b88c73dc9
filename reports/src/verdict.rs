//! A verdict, and what it rests on, in words.

use diagnosis::verdict::Verdict;
use serde_json::Value;

use crate::claim;
use crate::numbers::{text, texts};

/// The verdict of a diagnosis, the object of its `diagnosis.json`, in a sentence.
pub fn verdict_in_words(diagnosis: &Value) -> String {
    let effects = texts(&diagnosis["effects"]);
    match claim::verdict_of(diagnosis) {
        Verdict::NothingDetected if claim::misses(diagnosis) => {
            format!(
                "nothing detected in what was fitted; {} are missed by more than their noise",
                claim::held_out(diagnosis)
            )
        }
        Verdict::NothingDetected => "nothing detected: the data are explained".to_owned(),
        Verdict::Supported => format!("supported: {}", effects.join(", ")),
        Verdict::NotSeparable => format!(
            "one of {{{}}}: these data cannot tell them apart",
            texts(&diagnosis["not_separable"]).join(", ")
        ),
        Verdict::Pair => {
            format!("pair: {}, or one effect outside the list", effects.join(" + "))
        }
        Verdict::NoneOfTheCandidates => "none of the candidates".to_owned(),
        Verdict::ExplainedByApparatus => {
            let named = named_errors(&diagnosis["apparatus"]);
            format!("explained by the apparatus, no effect needed: {named}")
        }
        Verdict::ExplainedByPreparation => {
            let named = named_errors(&diagnosis["preparation"]);
            format!("explained by the preparation of the bed, no effect needed: {named}")
        }
        Verdict::BelowNoise => match claim::best_fit(diagnosis) {
            Some(_) => {
                "something is missing, and too small on held-out conditions to be named".to_owned()
            }
            None => "below what these data can show: no effect is named".to_owned(),
        },
        Verdict::CannotTell => "cannot tell".to_owned(),
    }
}

/// Those of `errors`, of the apparatus or the preparation, that a diagnosis names, with their size.
fn named_errors(errors: &Value) -> String {
    let errors = errors.as_array().map_or(&[][..], Vec::as_slice);
    let named = errors.iter().filter(|error| error["named"] == true);
    named.map(apparatus_error).collect::<Vec<_>>().join(", ")
}

/// An error of the apparatus with its size: `clock-zero 0.7 ± 0.1 ms`.
pub fn apparatus_error(error: &Value) -> String {
    let (id, size) = error_in_words(error, "value", "se");
    format!("{id} {size}")
}

/// The name of an error that runs share, and of its keys `value` and `se` the size in a usual unit.
pub(crate) fn error_in_words(error: &Value, value: &str, se: &str) -> (String, String) {
    let (factor, unit) = match error["unit"].as_str().unwrap_or_default() {
        "s" => (1e3, " ms"),
        "m" => (1e3, " mm"),
        "rad" => (180.0 / std::f64::consts::PI, "°"),
        "kg/m^2" => (1.0, " kg/m²"),
        "kg/m^3" => (1.0, " kg/m³"),
        _ => (1e2, " %"),
    };
    // A coefficient of a bed or a session is the exponential of this number times that of the others.
    let is_logarithm = ["bed", "session"].iter().any(|id| error["id"] == *id);
    let of_mean = error[value].as_f64().filter(|_| is_logarithm).map_or(0.0, |value| value);
    let in_unit = |key: &str, number: f64| match (is_logarithm, key == value) {
        (false, _) => factor * number,
        (true, true) => factor * libm::expm1(number),
        (true, false) => factor * libm::exp(of_mean) * number,
    };
    let number = |key: &str| error[key].as_f64().map(|number| in_unit(key, number));
    // A small error takes more digits.
    let digits = match number(se) {
        Some(se) if se > 1e-6 && se < 0.01 => 1 - libm::log10(se).floor() as i32,
        _ => 2,
    };
    // What rounds to zero has no sign.
    let least = 0.5 * libm::pow(10.0, -f64::from(digits));
    let digits = usize::try_from(digits).unwrap_or(2);
    let shown = |value: f64| format!("{:.digits$}", if value.abs() < least { 0.0 } else { value });
    let size = match (number(value), number(se)) {
        (Some(value), Some(se)) => format!("{} ± {}{unit}", shown(value), shown(se)),
        (Some(value), None) => format!("{}{unit}", shown(value)),
        (None, _) => "\u{2013}".to_owned(),
    };
    let id = match error["of"].as_str() {
        Some(of) => format!("{} ({of})", text(&error["id"])),
        None => text(&error["id"]),
    };
    (id, size)
}

/// What the verdict of a diagnosis rests on, in a sentence; none where nothing is named.
pub fn strength_in_words(diagnosis: &Value) -> Option<String> {
    let verdict = claim::verdict_of(diagnosis);
    let names = verdict.names_effects()
        || verdict == Verdict::NoneOfTheCandidates
        || claim::misses(diagnosis);
    match diagnosis["strength"].as_str().filter(|_| names)? {
        "suggested" => {
            let reasons = texts(&diagnosis["strength_reasons"]);
            let words: Vec<&str> = reasons.iter().map(|reason| reason_in_words(reason)).collect();
            Some(match words.is_empty() {
                true => "Suggested only.".to_owned(),
                false => format!("Suggested only, because {}.", words.join("; ")),
            })
        }
        _ => Some(format!(
            "Confirmed: by the scatter of repeats and by {}.",
            claim::held_out(diagnosis)
        )),
    }
}

/// What each effect that a diagnosis names is as a force, in a sentence each; none of what is no force.
pub fn forces_in_words(diagnosis: &Value) -> Vec<String> {
    let force = |amplitude: &Value| {
        let (id, force) = (text(&amplitude["id"]), &amplitude["force"]);
        greatest_force(&id, force).or_else(|| mean_force(&id, force))
    };
    let amplitudes = diagnosis["amplitudes"].as_array().map_or(&[][..], Vec::as_slice);
    amplitudes.iter().filter_map(force).collect()
}

/// Of an effect of a force law.
fn greatest_force(id: &str, force: &Value) -> Option<String> {
    let [greatest, of, depth, speed, share] =
        ["greatest", "of", "depth", "speed", "share_of_work"].map(|key| force[key].as_f64());
    let (greatest, share, short) = (greatest?, share?, plots::short);
    // What is left of a force across the motion is rounding.
    if greatest.abs() < 1e-9 * of?.abs() {
        return Some(format!("{id} acts across the motion: it does no work."));
    }
    let size = match greatest < 0.0 {
        true => {
            format!("weakens the resistance by up to {} N, to {} N", short(-greatest), short(of?))
        }
        false => format!("adds up to {} N, of {} N in all", short(greatest), short(of?)),
    };
    let work = match share < 0.0 {
        true => format!("the bed does {:.1} % less work with it", -100.0 * share),
        false => format!("it does {:.1} % of the work of the bed", 100.0 * share),
    };
    Some(format!(
        "{id} {size}, at a depth of {} mm and {} m/s in {}; {work}.",
        short(1e3 * depth?),
        short(speed?),
        text(&force["condition"]),
    ))
}

/// Of an effect of a bed of grains.
fn mean_force(id: &str, force: &Value) -> Option<String> {
    let [mean, of, depth, speed] = ["mean", "of", "depth", "speed"].map(|key| force[key].as_f64());
    let (mean, short) = (mean?, plots::short);
    let change = if mean < 0.0 { "lowers" } else { "raises" };
    Some(format!(
        "{id} {change} the mean vertical force on the way down by {} N, to {} N, at {} m/s to a depth of {} mm in {}.",
        short(mean.abs()),
        short(of?),
        short(speed?),
        short(1e3 * depth?),
        text(&force["condition"]),
    ))
}

/// One of the `strength_reasons` in words.
fn reason_in_words(reason: &str) -> &str {
    match reason {
        "stated-errors" => "the errors are stated and not seen in repeats",
        "assumed-scatter" => "nothing was repeated, and the scatter from run to run is assumed",
        "few-repeats" => "the repeats give fewer than 8 independent deviations",
        "held-out-no-better" => "what was held out is not predicted better by more than chance",
        "held-out-above-noise" => {
            "conditions that were held out are missed by more than their repeats scatter, as where days, pourings or \
             levels differ (a column `session` in the table of runs says which runs share one)"
        }
        "conditions-differ" => {
            "the model is rejected unless conditions differ as beds do that are poured anew"
        }
        "held-out-not-judged" => {
            "nothing that was held out could be predicted both without and with it"
        }
        "conditions-not-predicted" => {
            "with it, the model fails to predict held-out conditions that it predicts without it"
        }
        "amplitude-outside-usual-range" => "its amplitude is outside of its usual range",
        "apparatus-far-from-stated" => {
            "the fit moves an error of the apparatus by more than 4 standard deviations of what is known of it"
        }
        "of-another-form" => {
            "something is left over beside it: its form is another, or there is more"
        }
        "no-likelier-than-any-force" => {
            "the best of the listed effects explains the data, and a force of another form is about as likely"
        }
        "small-plan" => "the plan of impacts is too small to confirm anything",
        "few-tested" => "half of the effects or more could not be tested",
        "fresh-beds-no-nearer" => {
            "impacts with it, on fresh beds, are no nearer to what was held out"
        }
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn coefficients_of_a_bed_are_told_as_a_share_and_not_as_a_logarithm() {
        let error = |id: &str, value: f64| json!({ "id": id, "of": "B, drag", "unit": "1", "value": value, "se": 0.01 });
        // ln 2.2 and ln 0.4.
        assert_eq!(apparatus_error(&error("bed", 0.788_457)), "bed (B, drag) 120.00 ± 2.20 %");
        assert_eq!(apparatus_error(&error("bed", -0.916_291)), "bed (B, drag) -60.00 ± 0.40 %");
        assert_eq!(apparatus_error(&error("mass", 0.05)), "mass (B, drag) 5.00 ± 1.00 %");
    }
}
