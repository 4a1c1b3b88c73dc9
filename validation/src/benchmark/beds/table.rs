//! The outcomes as a table for the docs.

use std::fmt::Write as _;

use measurements::median;

use super::case::Outcome;
use super::hidden::UNLISTED;

/// Every case and the rates, as Markdown.
pub fn table(outcomes: &[Outcome]) -> String {
    let mut text = String::from(
        "| hidden | draw | verdict | named | packing found | right | held out before → after (floor), mm | impacts | min |\n\
         | --- | ---: | --- | --- | --- | --- | --- | ---: | ---: |\n",
    );
    for one in outcomes {
        let held_out = one.held_out.map_or_else(String::new, |[before, after, floor]| {
            format!("{:.2} → {:.2} ({:.2})", 1e3 * before, 1e3 * after, 1e3 * floor)
        });
        let packing = one.packing.map_or_else(String::new, |(by, se, is_named)| {
            format!("{by:+.4} ± {se:.4}{}", if is_named { ", named" } else { "" })
        });
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {packing} | {} | {held_out} | {} | {:.1} |",
            one.hidden,
            one.seed,
            one.verdict,
            one.named.join(", "),
            if one.right { "yes" } else { "no" },
            one.impacts,
            one.seconds / 60.0
        );
    }
    let _ = writeln!(text, "\n{}", rates(outcomes));
    text
}

/// How often what was wanted came out.
fn rates(outcomes: &[Outcome]) -> String {
    let of = |wanted: &dyn Fn(&&Outcome) -> bool| -> Vec<&Outcome> {
        outcomes.iter().filter(wanted).collect()
    };
    let nothing = |one: &&Outcome| one.hidden.starts_with("nothing");
    let unlisted = |one: &&Outcome| one.hidden.starts_with(UNLISTED);
    let share = |of: &[&Outcome], holds: &dyn Fn(&Outcome) -> bool| {
        format!("{} of {}", of.iter().filter(|one| holds(one)).count(), of.len())
    };
    let listed = of(&|one| !nothing(one) && !unlisted(one));
    let above = |one: &Outcome| {
        one.verdict == "supported"
            && one.held_out.is_some_and(|[_, after, floor]| after > 1.3 * floor)
    };
    let predicted: Vec<f64> = listed.iter().filter_map(|one| one.predicted).collect();
    let mean = predicted.iter().sum::<f64>() / predicted.len().max(1) as f64;
    let lines = [
        format!("right, alone or among at most three: {}", share(&listed, &|one| one.right)),
        format!("ranked first: {} (predicted {mean:.2})", share(&listed, &|one| one.first)),
        format!("a wrong effect, pair or set named: {}", share(&of(&|_| true), &|one| one.wrong)),
        format!(
            "no physics named where nothing is hidden: {}",
            share(&of(&nothing), &|one| one.named.is_empty())
        ),
        format!(
            "the right verdict where nothing is hidden: {}",
            share(&of(&nothing), &|one| one.right)
        ),
        format!(
            "impacts, median: {:.0} where nothing is hidden, {:.0} where a listed effect is",
            median_of_impacts(&of(&nothing)),
            median_of_impacts(&listed)
        ),
        format!(
            "nothing named where what is hidden is not listed: {}",
            share(&of(&unlisted), &|one| one.right)
        ),
        format!(
            "supported, and after it more than 1.3 times the floor: {}",
            share(&of(&|one| one.verdict == "supported"), &above)
        ),
    ];
    lines.map(|line| format!("- {line}")).join("\n")
}

fn median_of_impacts(outcomes: &[&Outcome]) -> f64 {
    median(outcomes.iter().map(|one| one.impacts as f64)).unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_count_listed_unlisted_and_empty_beds_apart() {
        let outcome = |hidden: &str, right, wrong| Outcome {
            hidden: hidden.to_owned(),
            seed: 0,
            verdict: "supported".to_owned(),
            named: vec!["packing".to_owned()],
            packing: Some((-0.0123, 0.003, true)),
            hint: String::new(),
            right,
            wrong,
            predicted: Some(0.5),
            first: right,
            held_out: Some([2e-3, 1e-3, 5e-4]),
            impacts: 10,
            seconds: 60.0,
        };
        let outcomes = [
            outcome("packing 1", true, false),
            outcome("nothing", false, true),
            outcome("less gravity", true, false),
        ];
        let text = table(&outcomes);
        assert!(text.contains(
            "| packing 1 | 0 | supported | packing | -0.0123 ± 0.0030, named | yes | 2.00 → 1.00 (0.50) | 10 | 1.0 |"
        ));
        assert!(text.contains("at most three: 1 of 1"));
        assert!(text.contains("wrong effect, pair or set named: 1 of 3"));
        assert!(text.contains("where nothing is hidden: 0 of 1"));
        assert!(text.contains("1.3 times the floor: 3 of 3"));
    }
}
