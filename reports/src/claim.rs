//! The claim of a diagnosis: one sentence, and one picture beside it.

use diagnosis::diagnose::ALPHA;
use diagnosis::misfit::error_unit::Unit;
use diagnosis::misfit::held_out::LeftOut;
use diagnosis::verdict::Verdict;
use plots::sheet::{Anchor, Layer, Mark, Sheet};
use serde::Deserialize;
use serde_json::Value;

use crate::about::About;
use crate::figure::{figure, panel};
use crate::numbers::{four_digits, list, text, texts};
use crate::page::Part;
use crate::{ReportError, Texts};

/// What the model lacks, how large that is, and how much better it predicts what was held out.
pub fn sentence(diagnosis: &Value) -> String {
    let effects = texts(&diagnosis["effects"]);
    let claim = match verdict_of(diagnosis) {
        Verdict::Supported => {
            format!(
                "The model lacks {}{}",
                explained(diagnosis, &effects).join(", "),
                sizes(diagnosis)
            )
        }
        Verdict::NotSeparable => format!(
            "The model lacks one of {}; these data cannot tell which. The best is {}{}",
            texts(&diagnosis["not_separable"]).join(", "),
            explained(diagnosis, &effects).join(", "),
            sizes(diagnosis)
        ),
        Verdict::Pair => format!(
            "The model lacks {} together, or one effect outside of the list{}",
            explained(diagnosis, &effects).join(" and "),
            sizes(diagnosis)
        ),
        Verdict::NoneOfTheCandidates => {
            match best_fit(diagnosis).filter(|_| is_one_of_many(diagnosis)) {
                Some(best) => format!(
                    "The model lacks something: {best} fits best, and a force that is not listed does about as well"
                ),
                None => format!("The model lacks something that {}", explained_by_none(diagnosis)),
            }
        }
        Verdict::NothingDetected if explains_if_conditions_differ(diagnosis) => {
            "Nothing is missing that these data could show, if conditions differ as beds do that are poured anew".to_owned()
        }
        Verdict::NothingDetected => "Nothing is missing that these data could show".to_owned(),
        Verdict::ExplainedByApparatus => {
            "Errors of the apparatus explain what the model misses; no effect is needed".to_owned()
        }
        Verdict::ExplainedByPreparation => {
            "The preparation of the bed explains what the model misses; no effect is needed"
                .to_owned()
        }
        Verdict::BelowNoise => match best_fit(diagnosis) {
            Some(best) => format!(
                "The data contradict the model, and {best} fits best, but no effect is named: held-out conditions show too \
                 little of it"
            ),
            None => "What the model misses is below what these data can show; no effect is named"
                .to_owned(),
        },
        Verdict::CannotTell => {
            match text(&diagnosis["unexplained"]["hint"]).trim_end_matches('.') {
                "" => "These data cannot tell what the model lacks".to_owned(),
                why => format!("There is no verdict: {why}"),
            }
        }
    };
    match errors(&diagnosis["holdout"]) {
        Some([before, after, noise]) if !list(&diagnosis["amplitudes"]).is_empty() => {
            let goes = if falls(diagnosis) { "falls" } else { "goes" };
            let held_out = held_out(diagnosis);
            let error = format!(
                "error on {held_out} {goes} from {before} to {after}, where the noise is {noise}{}",
                weighed(diagnosis)
            );
            match diagnosis["holdout"]["explained"].as_f64().filter(|share| *share > 0.0) {
                Some(share) => {
                    format!(
                        "{claim}. It explains {:.0} % of what exceeds noise: the {error}.",
                        1e2 * share
                    )
                }
                None => format!("{claim}. The {error}."),
            }
        }
        Some([before, _, noise]) if misses(diagnosis) => {
            let held_out = held_out(diagnosis);
            format!("{claim}. The error on {held_out} is {before}, where the noise is {noise}.")
        }
        _ => format!("{claim}."),
    }
}

/// What the errors are of that are called held out.
pub(crate) fn held_out(diagnosis: &Value) -> &'static str {
    LeftOut::deserialize(&diagnosis["holdout"]["conditions"]).unwrap_or(LeftOut::Holdout).in_words()
}

/// The verdict of a diagnosis; of a file that has none, that it cannot tell.
pub(crate) fn verdict_of(diagnosis: &Value) -> Verdict {
    Verdict::deserialize(&diagnosis["verdict"]).unwrap_or(Verdict::CannotTell)
}

/// That no candidate explains what is missing, and how many could be tested.
fn explained_by_none(diagnosis: &Value) -> String {
    let with = |status: &str| {
        let ranking = list(&diagnosis["ranking"]).iter();
        ranking.filter(|effect| effect["status"] == status).count()
    };
    let (tested, others) = (with("ranked"), with("not-testable") + with("not-tested"));
    match (tested, others) {
        (_, 0) => "none of the candidate effects explains".to_owned(),
        (1, n) => {
            format!("the one effect that could be tested does not explain; {n} could not be tested")
        }
        (tested, n) => {
            format!(
                "none of the {tested} effects that could be tested explains; {n} could not be tested"
            )
        }
    }
}

/// The names of `effects`, each with what it does.
fn explained(diagnosis: &Value, effects: &[String]) -> Vec<String> {
    let is_of_a_bed = diagnosis["bed"].is_object();
    let explained = |id: &String| {
        let summary = About::of(id, is_of_a_bed).summary;
        let mut letters = summary.trim_end_matches('.').chars();
        let first = letters.next().map_or_else(String::new, |first| first.to_lowercase().collect());
        format!("{id} ({first}{})", letters.as_str())
    };
    effects.iter().map(explained).collect()
}

/// Whether held-out conditions are missed by more than noise though no effect is named.
pub(crate) fn misses(diagnosis: &Value) -> bool {
    texts(&diagnosis["strength_reasons"]).iter().any(|one| one == "held-out-above-noise")
}

/// Whether the model of a `diagnosis` that names nothing explains the data only if conditions differ by more than their repeats
/// do, as beds that are poured anew.
pub fn explains_if_conditions_differ(diagnosis: &Value) -> bool {
    texts(&diagnosis["strength_reasons"]).iter().any(|one| one == "conditions-differ")
}

/// Standard errors from which an amplitude is one.
const CLEAR: f64 = 3.0;

/// The first of the ranking with its size, if the best of the candidates helps by more than chance.
pub(crate) fn best_fit(diagnosis: &Value) -> Option<String> {
    let best = list(&diagnosis["ranking"]).first().filter(|best| best["status"] == "ranked")?;
    let (q, se) = (best["q"].as_f64()?, best["se"].as_f64()?);
    let is_seen = diagnosis["p1"].as_f64()? <= ALPHA && q.abs() > CLEAR * se;
    is_seen.then(|| format!("{} ({} ± {})", text(&best["id"]), plots::short(q), plots::short(se)))
}

/// Whether the best of the candidates explains the data, and is not named since a force of any form is as likely.
fn is_one_of_many(diagnosis: &Value) -> bool {
    let mut reasons = texts(&diagnosis["strength_reasons"]).into_iter();
    reasons.any(|one| one == "no-likelier-than-any-force")
}

fn falls(diagnosis: &Value) -> bool {
    let [before, after] = ["before", "after"].map(|key| diagnosis["holdout"][key].as_f64());
    before > after
}

/// The error in units of what is expected, where the error itself does not fall.
fn weighed(diagnosis: &Value) -> String {
    let [before, after] =
        ["before", "after"].map(|key| diagnosis["holdout"]["weighed"][key].as_f64());
    match before.zip(after) {
        Some((before, after)) if !falls(diagnosis) => format!(
            "; in units of the noise and of the uncertainty of each prediction it goes from {before:.2} to {after:.2}"
        ),
        _ => String::new(),
    }
}

/// The amplitudes with their intervals.
fn sizes(diagnosis: &Value) -> String {
    let size = |of: &Value| {
        let interval = match (of["interval_95"][0].as_f64(), of["interval_95"][1].as_f64()) {
            (Some(low), Some(high)) => {
                format!(" (95 % interval {} to {})", plots::short(low), plots::short(high))
            }
            _ if of["se"].is_null() => String::new(),
            _ => format!(" \u{b1} {}", four_digits(&of["se"])),
        };
        let bound = match of["at_bound"].as_str() {
            Some("upper") => "at least ",
            Some("lower") => "at most ",
            _ => "",
        };
        let q = of["q"].as_f64().map_or_else(String::new, plots::short);
        let unit = list(&diagnosis["ranking"]).iter().find(|effect| effect["id"] == of["id"]);
        let unit = unit.map(|effect| text(&effect["unit"])).filter(|unit| unit != "1");
        let unit = unit.map_or_else(String::new, |unit| format!(" {unit}"));
        let form = form(of).map_or_else(String::new, |form| format!(", in its form with {form}"));
        let meaning = About::of(&text(&of["id"]), diagnosis["bed"].is_object()).amplitude;
        let meaning = meaning.map_or_else(String::new, |meaning| format!(", {meaning}"));
        format!("q = {bound}{q}{unit}{interval}{meaning}{form}")
    };
    let sizes: Vec<String> = list(&diagnosis["amplitudes"]).iter().map(size).collect();
    if sizes.is_empty() { String::new() } else { format!(", {}", sizes.join(" and ")) }
}

/// The form of an effect where it is not the listed one.
pub(crate) fn form(effect: &Value) -> Option<String> {
    let form = effect["form"].as_object().filter(|form| !form.is_empty())?;
    let keys = form.iter().map(|(key, value)| format!("{key} = {}", four_digits(value)));
    Some(keys.collect::<Vec<_>>().join(", "))
}

/// Errors on what was `held_out`: before, after, and the noise.
pub(crate) fn errors(held_out: &Value) -> Option<[String; 3]> {
    let unit: Unit = serde_json::from_value(held_out["unit"].clone()).ok()?;
    let shown = |key: &str| {
        let error = held_out[key].as_f64()?;
        Some(unit.told(error))
    };
    Some([shown("before")?, shown("after")?, shown("noise_floor")?])
}

/// What was left over and what effects add, and the error held out.
pub(crate) fn pictures(diagnosis: &Value, texts: &Texts) -> Result<Vec<Part>, ReportError> {
    let mut parts = Vec::new();
    if let Some(svg) = texts.get("signatures.svg") {
        let caption = "What the model leaves over of the measurements, and what the two best effects would add: an effect \
                       that follows the dots explains them.";
        parts.push(figure(svg, caption));
    }
    if let Some(svg) = bars(diagnosis) {
        let with = if has_effect(diagnosis) { " and with the effect" } else { "" };
        let caption = format!(
            "Error on {}, of the model as it is{with}, and the noise of the measured means, below which no model can be \
             told right.",
            held_out(diagnosis)
        );
        parts.push(Part::Panels(vec![panel(&svg, &caption)]));
    }
    Ok(parts)
}

/// Whether the error after is one with an effect.
fn has_effect(diagnosis: &Value) -> bool {
    !list(&diagnosis["amplitudes"]).is_empty()
}

/// A bar for each error held out.
fn bars(diagnosis: &Value) -> Option<String> {
    const LEFT: f64 = 110.0;
    const ROOM: f64 = 200.0;
    let held_out = &diagnosis["holdout"];
    let words = errors(held_out)?;
    let errors =
        ["before", "after", "noise_floor"].map(|key| held_out[key].as_f64().unwrap_or(0.0));
    let most = errors.iter().fold(f64::MIN_POSITIVE, |most, error| most.max(*error));
    let mut marks = Vec::new();
    let names = ["model as it is", "with the effect", "noise"];
    let colours = [[213, 94, 0], [0, 114, 178], [128, 128, 128]];
    let bars = names.into_iter().zip(errors).zip(words.into_iter().zip(colours));
    let bars = bars.enumerate().filter(|(at, _)| *at != 1 || has_effect(diagnosis));
    let bars: Vec<_> = bars.map(|(_, bar)| bar).collect();
    let size = (400, 18 + 44 * bars.len() as u32);
    for (at, ((name, error), (words, colour))) in bars.into_iter().enumerate() {
        let middle = 30.0 + 44.0 * at as f64;
        let length = ROOM * error / most;
        let letters = |place, text: String, anchor| Mark::Text {
            place,
            text,
            size: 12.0,
            anchor,
            upright: false,
        };
        marks.push(letters([LEFT - 8.0, middle], name.to_owned(), Anchor::End));
        marks.push(Mark::Box { place: [LEFT, middle - 12.0, length.max(1.0), 24.0], colour });
        marks.push(letters([LEFT + length + 8.0, middle], words, Anchor::Start));
    }
    Some(Sheet { size, layers: vec![Layer { clip: None, marks }] }.svg())
}

/// How often such a verdict is right, in a sentence; none where nothing can be told.
pub fn probability(diagnosis: &Value) -> Option<String> {
    let of = &diagnosis["probability"];
    let share = |key: &str| of[key].as_f64();
    let (Some(nothing), Some(unlisted)) = (share("nothing"), share("unlisted")) else {
        let is_of_a_law =
            diagnosis["bed"].is_null() && verdict_of(diagnosis) != Verdict::CannotTell;
        return is_of_a_law.then(|| {
            "How often such a verdict is right: `--calibrate` counts in simulated sets of your design.".to_owned()
        });
    };
    let counted_in = of["counted_in"].as_str();
    // An error of the apparatus counts as a name, except in the benchmark of beds, which hides none.
    let names_nothing = texts(&diagnosis["effects"]).is_empty()
        && (counted_in == Some("bed-benchmark")
            || verdict_of(diagnosis) != Verdict::ExplainedByApparatus);
    let (sets, more) = match counted_in {
        Some("design") => ("simulated sets of this design with this verdict", ""),
        Some("bed-benchmark") if names_nothing => {
            ("benchmark beds of 450 discs in which no effect is named", "")
        }
        Some("bed-benchmark") => ("benchmark beds of 450 discs in which an effect is named", ""),
        _ => (
            "benchmark sets with this verdict",
            " `--calibrate` counts in simulated sets of your design.",
        ),
    };
    let named = match share("right").filter(|_| !names_nothing) {
        Some(right) => format!("what is missing is named in {:.0} %", 100.0 * right),
        None => {
            format!("a listed effect is missing in {:.0} %", 100.0 * (1.0 - nothing - unlisted))
        }
    };
    Some(format!(
        "Of {sets}, where nothing, a listed and an unlisted effect are equally likely, {named}, nothing is \
         missing in {:.0} %, something unlisted in {:.0} %.{more}",
        100.0 * nothing,
        100.0 * unlisted
    ))
}

/// Which runs would decide, if any are expected to tell half of what is open.
pub(crate) fn decides(diagnosis: &Value) -> Option<String> {
    let best = list(&diagnosis["next"]).first()?;
    let last = list(&diagnosis["next"]).last()?;
    let [told, open] = ["expected_bits", "open_bits"].map(|key| last[key].as_f64());
    let (told, open) = (told?, open?);
    if told < 0.5 * open {
        return None;
    }
    let others = match list(&diagnosis["next"]).len() {
        1 => String::new(),
        2 => " and one other condition".to_owned(),
        n => format!(" and {} other conditions", n - 1),
    };
    Some(format!(
        "What would decide between {}: {} runs with the {} of {} mm at {} m/s and {}\u{b0}{others}, expected to tell \
         {told:.1} of {open:.1} bit.",
        texts(&best["separates"]).join(" and "),
        four_digits(&best["repeats"]),
        text(&best["shape"]),
        plots::short(1e3 * best["diameter_m"].as_f64()?),
        four_digits(&best["speed_m_per_s"]),
        four_digits(&best["angle_deg"])
    ))
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn the_claim_says_what_how_large_and_how_much_better() {
        let diagnosis = json!({
            "verdict": "supported", "effects": ["rail-friction"],
            "ranking": [{ "id": "rail-friction", "unit": "N" }],
            "amplitudes": [{ "id": "rail-friction", "q": 0.2201, "se": 0.02, "interval_95": [0.178, 0.262] }],
            "holdout": { "before": 1.09e-3, "after": 0.12e-3, "noise_floor": 0.1e-3, "explained": 0.994, "unit": "m" },
        });
        assert_eq!(
            sentence(&diagnosis),
            "The model lacks rail-friction (a constant friction of the guide, in the bed and above, whatever the area), q = \
             0.22 N (95 % interval 0.178 to 0.262), friction in newtons. It explains 99 % of what exceeds noise: the error \
             on held-out conditions falls from 1.090 mm to 0.120 mm, where the noise is 0.100 mm."
        );
        let svg = bars(&diagnosis).expect("bars");
        // Lengths go as the errors: 200 pixels for the largest.
        assert!(svg.contains("width=\"200\"") && svg.contains("width=\"22\""), "{svg}");
        let mut hidden = diagnosis.clone();
        hidden["holdout"]["after"] = json!(1.2e-3);
        hidden["holdout"]["weighed"] = json!({ "before": 1.62, "after": 0.907 });
        assert!(sentence(&hidden).contains("goes from 1.090 mm to 1.200 mm"));
        assert!(
            sentence(&hidden).contains("uncertainty of each prediction it goes from 1.62 to 0.91")
        );
        let mut without = diagnosis;
        without["amplitudes"] = json!([]);
        assert!(!bars(&without).expect("bars").contains("with the effect"));
    }

    #[test]
    fn an_error_of_the_apparatus_is_no_named_effect_of_a_bed() {
        let said = |counted_in: &str| {
            let shares =
                json!({ "counted_in": counted_in, "right": 0.1, "nothing": 0.5, "unlisted": 0.3 });
            let verdict = "explained-by-apparatus";
            probability(&json!({ "verdict": verdict, "effects": [], "probability": shares }))
        };
        let of_a_bed = said("bed-benchmark").expect("a sentence");
        assert!(of_a_bed.contains("in which no effect is named"), "{of_a_bed}");
        let of_a_law = said("benchmark").expect("a sentence");
        assert!(of_a_law.contains("what is missing is named in 10 %"), "{of_a_law}");
    }

    #[test]
    fn the_claim_says_what_form_what_was_left_out_and_what_could_not_be_tested() {
        let diagnosis = json!({
            "verdict": "supported", "effects": ["added-mass"], "ranking": [],
            "amplitudes": [{ "id": "added-mass", "q": 2.27, "form": { "recruitment": 0.5 }, "interval_95": [1.75, 2.79] }],
            "holdout": {
                "before": 1e-3, "after": 5e-4, "noise_floor": 1e-4, "unit": "m", "conditions": "one-at-a-time"
            },
        });
        assert_eq!(
            sentence(&diagnosis),
            "The model lacks added-mass (grains that move with the intruder and add to its inertia), q = 2.27 (95 % interval \
             1.75 to 2.79), moving grains in units of the displaced bed, in its form with recruitment = 0.5. The \
             error on conditions left out one at a time falls from 1.000 mm to 0.500 mm, where the noise is 0.100 mm."
        );
        let none = json!({
            "verdict": "none-of-the-candidates", "amplitudes": [],
            "ranking": [{ "status": "ranked" }, { "status": "not-testable" }, { "status": "not-tested" }],
        });
        assert_eq!(
            sentence(&none),
            "The model lacks something that the one effect that could be tested does not explain; 2 could not be tested."
        );
    }

    #[test]
    fn nothing_missing_claims_no_size() {
        let nothing = json!({ "verdict": "nothing-detected", "amplitudes": [], "holdout": {} });
        assert_eq!(sentence(&nothing), "Nothing is missing that these data could show.");
        assert!(bars(&nothing).is_none() && decides(&nothing).is_none());
    }
}
