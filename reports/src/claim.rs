//! The claim of a diagnosis: one sentence, and one picture beside it.

use plots::sheet::{Anchor, Layer, Mark, Sheet};
use serde_json::Value;

use crate::figure::{figure, panel};
use crate::numbers::{four_digits, list, text, texts};
use crate::page::Part;
use crate::{ReportError, Texts};

/// What the model lacks, how large that is, and how much better it predicts what was held out.
pub(crate) fn sentence(diagnosis: &Value) -> String {
    let effects = texts(&diagnosis["effects"]);
    let claim = match diagnosis["verdict"].as_str().unwrap_or_default() {
        "supported" => format!("The model lacks {}{}", effects.join(", "), sizes(diagnosis)),
        "not-separable" => format!(
            "The model lacks one of {}; these data cannot tell which. The best is {}{}",
            texts(&diagnosis["not_separable"]).join(", "),
            effects.join(", "),
            sizes(diagnosis)
        ),
        "pair" => format!(
            "The model lacks {} together, or one effect outside of the list{}",
            effects.join(" and "),
            sizes(diagnosis)
        ),
        "none-of-the-candidates" => {
            "The model lacks something that none of the candidate effects explains".to_owned()
        }
        "nothing-detected" => "Nothing is missing that these data could show".to_owned(),
        "explained-by-apparatus" => {
            "Errors of the apparatus explain what the model misses; no effect is needed".to_owned()
        }
        "below-noise" => {
            "What the model misses is below what these data can show; no effect is named".to_owned()
        }
        _ => "These data cannot tell what the model lacks".to_owned(),
    };
    match errors(diagnosis) {
        Some([before, after, noise]) if !list(&diagnosis["amplitudes"]).is_empty() => format!(
            "{claim}. The error on held-out conditions falls from {before} to {after}, where the noise is {noise}."
        )
        .replace("falls from", if falls(diagnosis) { "falls from" } else { "goes from" }),
        _ => format!("{claim}."),
    }
}

fn falls(diagnosis: &Value) -> bool {
    let [before, after] = ["before", "after"].map(|key| diagnosis["holdout"][key].as_f64());
    before > after
}

/// The amplitudes with their intervals.
fn sizes(diagnosis: &Value) -> String {
    let size = |of: &Value| {
        let interval = match (of["interval_95"][0].as_f64(), of["interval_95"][1].as_f64()) {
            (Some(low), Some(high)) => {
                format!(" (95 % interval {} to {})", plots::short(low), plots::short(high))
            }
            _ => format!(" \u{b1} {}", four_digits(&of["se"])),
        };
        let q = of["q"].as_f64().map_or_else(String::new, plots::short);
        let unit = list(&diagnosis["ranking"]).iter().find(|effect| effect["id"] == of["id"]);
        let unit = unit.map(|effect| text(&effect["unit"])).filter(|unit| unit != "1");
        let unit = unit.map_or_else(String::new, |unit| format!(" {unit}"));
        format!("q = {q}{unit}{interval}")
    };
    let sizes: Vec<String> = list(&diagnosis["amplitudes"]).iter().map(size).collect();
    if sizes.is_empty() { String::new() } else { format!(", {}", sizes.join(" and ")) }
}

/// Errors on what was held out: before, after, and the noise.
fn errors(diagnosis: &Value) -> Option<[String; 3]> {
    let held_out = &diagnosis["holdout"];
    let shown = |key: &str| {
        let error = held_out[key].as_f64()?;
        Some(match held_out["unit"].as_str() {
            Some("m") => format!("{:.3} mm", 1e3 * error),
            Some("N") => format!("{error:.3} N"),
            Some("m/s^2") => format!("{error:.3} m/s²"),
            _ => format!("{:.1} %", 100.0 * error),
        })
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
        let caption = "Error on conditions that were held out, of the model as it is and with the effect, and the noise \
                       of the measured means, below which no model can be told right.";
        parts.push(Part::Panels(vec![panel(&svg, caption)]));
    }
    Ok(parts)
}

/// A bar for each error held out.
fn bars(diagnosis: &Value) -> Option<String> {
    const SIZE: (u32, u32) = (400, 150);
    const LEFT: f64 = 110.0;
    const ROOM: f64 = 200.0;
    let words = errors(diagnosis)?;
    let held_out = &diagnosis["holdout"];
    let errors =
        ["before", "after", "noise_floor"].map(|key| held_out[key].as_f64().unwrap_or(0.0));
    let most = errors.iter().fold(f64::MIN_POSITIVE, |most, error| most.max(*error));
    let mut marks = Vec::new();
    let names = ["model as it is", "with the effect", "noise"];
    let colours = [[213, 94, 0], [0, 114, 178], [128, 128, 128]];
    for (at, ((name, error), (words, colour))) in
        names.into_iter().zip(errors).zip(words.into_iter().zip(colours)).enumerate()
    {
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
    Some(Sheet { size: SIZE, layers: vec![Layer { clip: None, marks }] }.svg())
}

/// How likely the verdict is right, where it was asked.
pub(crate) fn probability(diagnosis: &Value) -> Option<String> {
    let of = &diagnosis["probability"];
    let shown = |key: &str| of[key].as_f64().map_or("\u{2013}".to_owned(), |p| format!("{p:.2}"));
    of["right"].as_f64().map(|_| {
        format!(
            "Of simulated sets with this verdict, where nothing, a listed and an unlisted effect are equally likely, a \
             share of {} is named rightly; in {} nothing is missing, in {} something unlisted.",
            shown("right"),
            shown("nothing"),
            shown("unlisted")
        )
    })
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
            "holdout": { "before": 1.09e-3, "after": 0.12e-3, "noise_floor": 0.1e-3, "unit": "m" },
        });
        assert_eq!(
            sentence(&diagnosis),
            "The model lacks rail-friction, q = 0.22 N (95 % interval 0.178 to 0.262). The error on held-out conditions \
             falls from 1.090 mm to 0.120 mm, where the noise is 0.100 mm."
        );
        let svg = bars(&diagnosis).expect("bars");
        // Lengths go as the errors: 200 pixels for the largest.
        assert!(svg.contains("width=\"200\"") && svg.contains("width=\"22\""), "{svg}");
    }

    #[test]
    fn nothing_missing_claims_no_size() {
        let nothing = json!({ "verdict": "nothing-detected", "amplitudes": [], "holdout": {} });
        assert_eq!(sentence(&nothing), "Nothing is missing that these data could show.");
        assert!(bars(&nothing).is_none() && decides(&nothing).is_none());
    }
}
