//! The report of a diagnosis: which effect is missing, what else it could be, and what to measure next.

use diagnosis::verdict::Verdict;
use serde_json::Value;

use crate::about::About;
use crate::claim;
use crate::comparison::{by_kind, views};
use crate::figure::figure;
use crate::numbers::{fixed, four_digits, list, probability, text, texts};
use crate::page::{Card, Page, Part, Section};
use crate::tables::Table;
use crate::verdict::{error_in_words, forces_in_words, strength_in_words, verdict_in_words};
use crate::{ReportError, Texts, object, tables};

/// The file whose presence means a diagnosis.
pub(crate) const RESULT: &str = "diagnosis.json";

/// How often verdicts come true, where it was asked.
const CALIBRATION: &str = "calibration.json";

/// Most effects with a card of their own; the table has all.
const CARDS: usize = 6;

pub(crate) fn page(texts: &Texts) -> Result<String, ReportError> {
    let diagnosis = object(texts, RESULT)?;
    let found = object(texts, "where_it_fails.json")?;
    let model = text(&found["models"][0]["model"]);
    let set = text(&found["set"]);
    let mut sections = vec![
        Section::new("Verdict", verdict(&diagnosis, texts)?),
        Section::new("The missing force", missing_force(&diagnosis, texts)),
        Section::new("Effects", effects(&diagnosis)),
    ];
    // What is left over stands with the verdict.
    sections.extend(views(texts, &["signatures.svg"]).into_iter().map(Some));
    sections.extend([
        Section::new("Errors by kind of number", by_kind(texts)),
        Section::new("How often verdicts are right in this design", calibrated(texts)?),
        Section::new("Apparatus and preparation", shared_errors(&diagnosis)),
        Section::new("What the new runs say", after(&diagnosis)),
        Section::new("What to measure next", next(&diagnosis)),
        Section::new("Corrected parameters", corrected(&diagnosis)),
        Section::new("All effects", ranking(&diagnosis)),
        Section::new("Tests behind the verdict", tests_behind(&diagnosis)),
    ]);
    let page = Page {
        title: if set.is_empty() { "diagnosis".to_owned() } else { set },
        kind: "diagnosis",
        lead: match model.as_str() {
            "" => "What the model lacks.".to_owned(),
            model => format!("What {model} lacks."),
        },
        headline: Vec::new(),
        sections: sections.into_iter().flatten().collect(),
        origin: vec![("plunge", env!("CARGO_PKG_VERSION").to_owned())],
    };
    page.html()
}

/// The probabilities that a verdict rests on.
fn tests_behind(diagnosis: &Value) -> Vec<Part> {
    let mut table = Table::new(&["", "p", "how often chance alone does as much"]);
    for (key, name, meaning) in [
        ("p_lof", "lack of fit of the model", "misses the data as far, if it is right"),
        ("p1", "best effect", "one of all that were tried helps as much, if none is there"),
        (
            "p_lof_with",
            "lack of fit with the best effect",
            "misses the data as far, if it is right",
        ),
    ] {
        if let Some(p) = diagnosis[key].as_f64() {
            table.rows.push(vec![name.to_owned(), probability(Some(p)), meaning.to_owned()]);
        }
    }
    if table.rows.is_empty() { Vec::new() } else { vec![Part::Table(table)] }
}

fn verdict(diagnosis: &Value, texts_of: &Texts) -> Result<Vec<Part>, ReportError> {
    let mut parts = vec![Part::Answer(claim::sentence(diagnosis))];
    parts.extend(claim::pictures(diagnosis, texts_of)?);
    parts.extend(forces_in_words(diagnosis).iter().map(|force| Part::Text(sentence(force))));
    parts.extend(claim::probability(diagnosis).map(|said| said.replace('`', "")).map(Part::Text));
    parts.extend(claim::decides(diagnosis).map(Part::Text));
    parts.push(Part::Text(format!("In short: {}.", verdict_in_words(diagnosis))));
    parts.extend(strength_in_words(diagnosis).map(Part::Text));
    parts.extend(not_predicted(diagnosis).map(Part::Text));
    parts.extend(texts(&diagnosis["warnings"]).into_iter().map(|one| Part::Text(sentence(&one))));
    let unexplained = &diagnosis["unexplained"];
    let hint = text(&unexplained["hint"]);
    // Without a verdict the claim has said it.
    if !hint.is_empty() && claim::verdict_of(diagnosis) != Verdict::CannotTell {
        parts.push(Part::Text(sentence(&hint)));
    }
    let depends_on = texts(&unexplained["depends_on"]);
    if !depends_on.is_empty() {
        let on = depends_on.join(", ");
        parts.push(Part::Text(format!("What remains of the force depends on {on}.")));
    }
    Ok(parts)
}

/// `text` as a sentence.
fn sentence(text: &str) -> String {
    let mut letters = text.trim_end_matches('.').chars();
    letters
        .next()
        .map_or_else(String::new, |first| format!("{}{}.", first.to_uppercase(), letters.as_str()))
}

/// What all runs share: errors of the apparatus, and how the bed differs from the model's.
fn shared_errors(diagnosis: &Value) -> Vec<Part> {
    let head = ["", "estimate", "known to (standard deviation)", "named"];
    let mut table = Table::new(&head);
    for error in list(&diagnosis["preparation"]).iter().chain(list(&diagnosis["apparatus"])) {
        let (id, size) = error_in_words(error, "value", "se");
        let (_, known) = error_in_words(error, "prior_sigma", "");
        let named = if error["named"] == true { "yes" } else { "no" };
        table.rows.push(vec![id, size, known, named.to_owned()]);
    }
    let intro = "These are fitted with every effect, and no effect is credited with them. One is named where the data show \
                 it and it is larger than expected.";
    match table.rows.is_empty() {
        true => Vec::new(),
        false => vec![Part::Text(intro.to_owned()), Part::Table(table)],
    }
}

/// The force that no listed effect explains, and the formula for it.
fn missing_force(diagnosis: &Value, texts: &Texts) -> Vec<Part> {
    let force = &diagnosis["missing_force"];
    let Some(words) = force["words"].as_str() else { return Vec::new() };
    let mut parts = vec![Part::Text(sentence(words))];
    let caption = "Force that the model lacks, against the motion, with the band that holds it with 95 %: a panel per \
                   condition, depth to the right.";
    parts.extend(texts.get("missing_force.svg").map(|svg| figure(svg, caption)));
    match force["candidate"].as_str() {
        Some(table) => {
            let errors = claim::errors(&force["holdout"]).map_or_else(String::new, |[before, after, noise]| {
                format!(
                    " On conditions that were not fitted to the error falls from {before} to {after}; their means are \
                     known to {noise}."
                )
            });
            let q = four_digits(&force["q"]);
            parts.push(Part::Text(format!(
                "A formula fits and predicts; it does not explain. Its amplitude q is {q}.{errors}"
            )));
            parts.push(Part::Listing(table.to_owned()));
        }
        None if force["formula_sought"] == false => {}
        None => parts.push(Part::Text(
            "No formula of the library predicts conditions that were not fitted to.".to_owned(),
        )),
    }
    parts
}

/// Which conditions that were held out are in no error, in a sentence; none if all are judged.
fn not_predicted(diagnosis: &Value) -> Option<String> {
    let held_out = &diagnosis["holdout"];
    let one = |one: &Value| {
        let by = match one["by"].as_str() {
            Some("before") => "without it",
            Some("after") => "with it",
            _ => "either way",
        };
        format!("{} cannot be predicted {by} ({})", text(&one["condition"]), text(&one["why"]))
    };
    let conditions: Vec<String> = list(&held_out["not_predicted"]).iter().map(one).collect();
    let judged = four_digits(&held_out["conditions_judged"]);
    (!conditions.is_empty()).then(|| {
        format!("The error held out is of {judged} conditions alone: {}.", conditions.join("; "))
    })
}

/// An amplitude with its standard error and `unit`, or as the end of its range.
fn amplitude(of: &Value, unit: &str) -> String {
    let in_unit = |text: String| if unit.is_empty() { text } else { format!("{text} {unit}") };
    let (q, se) = tables::amplitude(of);
    match of["at_bound"].as_str() {
        Some(_) => format!("{}, the {se}", in_unit(q)),
        None => in_unit(format!("{q} \u{b1} {se}")),
    }
}

/// What is usual of an effect whose amplitude is not.
fn usual(effect: &Value) -> Option<String> {
    let range = effect["usual_range"].as_array().filter(|_| effect["unusual"] == true)?;
    let [least, most] = [range.first()?, range.get(1)?].map(four_digits);
    Some(format!("{least} to {most}, and this is outside of it"))
}

/// Simulated sets by truth and verdict, where they were asked for.
fn calibrated(texts: &Texts) -> Result<Vec<Part>, ReportError> {
    if !texts.contains_key(CALIBRATION) {
        return Ok(Vec::new());
    }
    let calibration = object(texts, CALIBRATION)?;
    let table = tables::calibration(&calibration);
    let words =
        "Sets with these conditions, repeats and noise were simulated and diagnosed.".to_owned();
    Ok(vec![Part::Text(words), Part::Table(table)])
}

fn testable(diagnosis: &Value) -> impl Iterator<Item = &Value> {
    list(&diagnosis["ranking"]).iter().filter(|effect| effect["status"] == "ranked")
}

fn effects(diagnosis: &Value) -> Vec<Part> {
    let mut named = texts(&diagnosis["effects"]);
    named.extend(texts(&diagnosis["not_separable"]));
    let about = (&named[..], diagnosis["bed"].is_object());
    let cards: Vec<Card> = testable(diagnosis)
        .enumerate()
        .filter(|(at, effect)| *at < CARDS || named.contains(&text(&effect["id"])))
        .map(|(at, effect)| {
            let amplitudes = list(&diagnosis["amplitudes"]);
            card(at, effect, amplitudes.iter().find(|one| one["id"] == effect["id"]), about)
        })
        .collect();
    if cards.is_empty() { Vec::new() } else { vec![Part::Cards(cards)] }
}

/// The effect in the place `at`, with its amplitude in the verdict, if it has one there.
fn card(
    at: usize,
    effect: &Value,
    fitted: Option<&Value>,
    (named, is_of_a_bed): (&[String], bool),
) -> Card {
    let id = text(&effect["id"]);
    let about = About::of(&id, is_of_a_bed);
    let unit = effect["unit"].as_str().filter(|unit| *unit != "1").unwrap_or_default();
    let of = fitted.unwrap_or(effect);
    let mut facts = vec![("amplitude", amplitude(of, unit))];
    facts.extend(claim::form(of).map(|form| ("form", form)));
    facts.extend(usual(effect).map(|usual| ("usual", usual)));
    facts.extend([
        ("fall of \u{3c7}\u{b2}", fixed(effect["delta"].as_f64(), 1)),
        ("ranked first if there", fixed(effect["predicted_top1"].as_f64(), 2)),
        ("detection limit", four_digits(&effect["detection_limit"])),
    ]);
    let mut notes: Vec<_> = about.law.map(|law| ("law", law.to_owned())).into_iter().collect();
    notes.extend(about.amplitude.map(|meaning| ("q", meaning.to_owned())));
    let note = text(&effect["note"]);
    if !note.is_empty() {
        let name = if note.starts_with("from ") { "separable" } else { "note" };
        notes.push((name, note));
    }
    notes.extend(about.source.map(|source| ("source", source.to_owned())));
    Card {
        rank: format!("{}.", at + 1),
        summary: about.summary,
        facts,
        notes,
        named: named.contains(&id),
        title: id,
    }
}

fn ranking(diagnosis: &Value) -> Vec<Part> {
    let table = tables::ranking(diagnosis);
    let mut parts = Vec::new();
    if !table.rows.is_empty() {
        let intro = "Estimates of each effect alone, in the form that fits best, by which effects are ranked. The verdict fits what \
                     it names once more, with all that is uncertain. Behind: how much less \u{3c7}\u{b2} falls than by the \
                     best. Ranked first if there: the share of simulated sets with such an effect in which it comes first. \
                     Limit: the least amplitude that is seen.";
        parts.extend([Part::Text(intro.to_owned()), Part::Table(table)]);
    }
    for (status, heading) in [
        ("not-testable", "not testable with these data"),
        ("not-tested", "not tested"),
        ("imitated", "imitated by the parameters of the model"),
        ("not-integrated", "could not be computed"),
    ] {
        let mut refused = Table::new(&[heading, "why"]);
        let of_status = list(&diagnosis["ranking"]).iter().filter(|one| one["status"] == status);
        refused.rows.extend(of_status.map(|one| vec![text(&one["id"]), text(&one["note"])]));
        if !refused.rows.is_empty() {
            parts.push(Part::Table(refused));
        }
    }
    parts
}

fn next(diagnosis: &Value) -> Vec<Part> {
    let Some(last) = list(&diagnosis["next"]).last() else { return Vec::new() };
    let bits = |key: &str| fixed(last[key].as_f64(), 2);
    let intro = format!(
        "These conditions, in this order, are expected to tell {} of the {} bit that are open about which effect it is:",
        bits("expected_bits"),
        bits("open_bits")
    );
    vec![Part::Text(intro), Part::Table(tables::next(diagnosis))]
}

/// What an earlier diagnosis expected of new runs, and what they told.
fn after(diagnosis: &Value) -> Vec<Part> {
    let after = &diagnosis["after"];
    if list(&after["hypotheses"]).is_empty() {
        return Vec::new();
    }
    let intro = format!(
        "The runs that came after the earlier diagnosis tell {} bit of which effect it is. \u{3c7}\u{b2} per datum is \
         about 1 under a hypothesis that expected them.",
        fixed(after["told_bits"].as_f64(), 2)
    );
    let intro = match after["is_unexpected"].as_bool() {
        Some(true) => format!(
            "{intro} No hypothesis expected them: even the nearest misses by more than chance does."
        ),
        _ => intro,
    };
    let tables = [tables::hypotheses(after), tables::new_runs(after)].map(Part::Table);
    [Part::Text(intro)].into_iter().chain(tables).collect()
}

fn corrected(diagnosis: &Value) -> Vec<Part> {
    let mut table = Table::new(&["", "value", "standard error", "unit"]);
    for amplitude in list(&diagnosis["amplitudes"]) {
        let name = format!("{}, amplitude", text(&amplitude["id"]));
        let (q, se) = tables::amplitude(amplitude);
        table.rows.push(vec![name, q, se, String::new()]);
    }
    for (name, entry) in diagnosis["parameters"].as_object().into_iter().flatten() {
        let se = match entry["at_bound"].as_str() {
            Some("lower") => "at the lower end of its range".to_owned(),
            Some("upper") => "at the upper end of its range".to_owned(),
            _ => four_digits(&entry["se"]),
        };
        let value = four_digits(&entry["value"]);
        table.rows.push(vec![name.clone(), value, se, text(&entry["unit"])]);
    }
    if table.rows.is_empty() { Vec::new() } else { vec![Part::Table(table)] }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    /// As `plunge diagnose` writes it, with two effects that the data do not tell apart.
    fn texts_of_a_diagnosis() -> Texts {
        let effect = |id: &str, delta: f64| {
            json!({
                "id": id, "q": 0.5, "se": 0.1, "unit": "1", "delta": delta, "predicted_top1": 0.5,
                "status": "ranked", "testable": true, "detection_limit": 0.2, "note": "from the other by depth"
            })
        };
        let hidden = json!({
            "id": "magnus", "status": "not-testable", "testable": false, "note": "no run spins"
        });
        let failed = json!({
            "id": "tilt", "status": "not-integrated", "testable": true, "note": "it never stops"
        });
        let bounded = json!({
            "id": "camera-scale", "q": -0.25, "se": null, "at_bound": "lower", "unit": "1",
            "usual_range": [-0.05, 0.05], "unusual": true, "delta": 1.0, "predicted_top1": 0.0,
            "status": "ranked", "testable": true, "detection_limit": 0.2, "note": ""
        });
        let diagnosis = json!({
            "verdict": "not-separable", "strength": "suggested", "effects": ["janssen"],
            "strength_reasons": ["stated-errors", "held-out-no-better"],
            "not_separable": ["janssen", "depth-exponent"],
            "ranking": [
                effect("janssen", 30.0), effect("depth-exponent", 29.0), bounded, hidden, failed
            ],
            "p1": 1e-5, "p_lof": 1e-6, "p_lof_with": 0.4,
            "holdout": { "before": 0.1, "after": 0.02, "noise_floor": 0.06, "unit": "1" },
            "unexplained": { "depends_on": [], "hint": "" },
            "next": [], "parameters": {}, "amplitudes": [{ "id": "janssen", "q": 0.5, "se": 0.1 }]
        });
        let found = json!({ "set": "a-set", "models": [{ "model": "two-term-vector" }] });
        let svg = plots::svg((30, 20), |_| Ok(())).expect("a picture");
        Texts::from([
            (RESULT.to_owned(), diagnosis.to_string()),
            ("where_it_fails.json".to_owned(), found.to_string()),
            ("signatures.svg".to_owned(), svg),
        ])
    }

    #[test]
    fn a_diagnosis_shows_its_whole_set_and_what_it_could_not_test() {
        let html = page(&texts_of_a_diagnosis()).expect("a page");
        assert!(html.contains("one of {janssen, depth-exponent}: these data"), "{html}");
        let strength = "Suggested only, because the errors are stated and not seen in repeats; what was \
                        held out is not predicted better by more than chance.";
        assert!(html.contains(strength), "{html}");
        assert!(html.contains("at most -0.25, the end of the range"), "{html}");
        assert!(html.contains("-0.05 to 0.05, and this is outside of it"), "{html}");
        assert!(
            html.contains("could not be computed") && html.contains("it never stops"),
            "{html}"
        );
        assert_eq!(html.matches("<article class=\"named\">").count(), 2, "a card for both");
        assert!(html.contains("no run spins"), "{html}");
        assert!(html.contains("falls from 10.0 % to 2.0 %, where the noise is 6.0 %"), "{html}");
        assert_eq!(
            html.matches("<svg").count(),
            2,
            "the view that there is, and the error held out"
        );
        let claim = "The model lacks one of janssen, depth-exponent";
        assert!(html.contains(claim), "{html}");
        let before_numbers = html.find(claim) < html.rfind("Tests behind the verdict");
        assert!(before_numbers, "the claim comes first");
    }

    #[test]
    fn the_same_files_give_the_same_page() {
        let texts = texts_of_a_diagnosis();
        assert_eq!(page(&texts).expect("a page"), page(&texts).expect("a page"));
    }

    #[test]
    fn a_diagnosis_that_is_no_json_is_named() {
        let texts = Texts::from([(RESULT.to_owned(), "{".to_owned())]);
        let error = page(&texts).expect_err("no page").to_string();
        assert!(error.starts_with("diagnosis.json cannot be read"), "{error}");
    }
}
