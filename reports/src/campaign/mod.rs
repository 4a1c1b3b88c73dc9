//! The report of a campaign: what its points came to, over what was varied.

mod dependence;

use plots::axes;
use plots::legend::{self, Sign};
use plots::{Area, Drawn, Hover, PictureError, colour, short, svg};
use plotters::prelude::*;
use runner::campaign::{Counts, Headline, Outcome, Point, Results, Values, Varied, varied};

use self::dependence::{Dependence, bars};
use crate::ReportError;
use crate::figure::panel;
use crate::numbers::four_digits;
use crate::page::{Number, Page, Part, Section};
use crate::tables::Table;

/// Size of a panel (pixels).
const PANEL: (u32, u32) = (400, 270);

/// Characters of the name of a folder that tell it from others.
const NAME: usize = 12;

/// Most points that are listed one by one.
const MOST_POINTS: usize = 500;

/// What a row of panels shows of a point.
struct Response {
    title: &'static str,
    scale: f64,
    of: fn(&Headline) -> Option<f64>,
}

const RESPONSES: [Response; 3] = [
    Response { title: "depth (mm)", scale: 1e3, of: |one| Some(one.depth_m) },
    Response { title: "stopping time (ms)", scale: 1e3, of: |one| one.stopping_time_s },
    Response { title: "range (mm)", scale: 1e3, of: |one| Some(one.range_m) },
];

/// A key over whose numbers results are drawn.
struct Across {
    key: String,
    title: String,
    numbers: Vec<Option<f64>>,
}

/// The page of what a campaign has come to.
pub(crate) fn page(results: &Results) -> Result<String, ReportError> {
    let counts = results.counts();
    let Counts { points, done, failed, begun, waiting } = counts;
    let varied = varied(results);
    let lead = match counts.is_complete() {
        true => format!("{points} points, all of them done."),
        false => format!("{} of {points} points so far.", done + failed),
    };
    let worst = results.outcomes.iter().filter_map(Outcome::headline).filter_map(|one| one.closure);
    let worst = worst.reduce(f64::max);
    let page = Page {
        title: results.plan.name.clone(),
        kind: "campaign",
        lead,
        headline: vec![
            Number::new("done", done.to_string(), format!("of {points}")),
            Number::new("failed", failed.to_string(), ""),
            Number::new("to do", (begun + waiting).to_string(), format!("{begun} begun")),
            Number::new(
                "closure",
                worst.map_or("\u{2013}".to_owned(), |worst| format!("{worst:.1e}")),
                "the worst of all",
            ),
        ],
        sections: [
            Section::new("What it depends on", dependences(results, &varied)),
            Section::new("Responses", responses(results, &varied)?),
            Section::new("Failed", failures(results)),
            Section::new("Points", listed(results, &varied)),
        ]
        .into_iter()
        .flatten()
        .collect(),
        origin: vec![
            ("plunge", results.plan.version.clone()),
            ("varied", varied.iter().map(|one| one.key.as_str()).collect::<Vec<_>>().join(", ")),
        ],
    };
    page.html()
}

/// The values of a response in the order of the plan; `None` where it does not differ from point to point.
fn values(results: &Results, response: &Response) -> Option<Vec<Option<f64>>> {
    let of =
        |one: &Outcome| one.headline().and_then(response.of).map(|value| response.scale * value);
    let values: Vec<Option<f64>> = results.outcomes.iter().map(of).collect();
    let mut found = values.iter().flatten();
    let first = found.next()?;
    found.any(|value| value.total_cmp(first).is_ne()).then_some(values)
}

/// How each response goes with every key of numbers, strongest first.
fn dependences(results: &Results, varied: &[Varied]) -> Vec<Part> {
    let mut panels = Vec::new();
    for response in &RESPONSES {
        let Some(values) = values(results, response) else { continue };
        let of = |one: &Varied| match &one.values {
            Values::Numbers(numbers) => Dependence::of(&one.key, numbers, &values),
            Values::Texts(_) => None,
        };
        let mut found: Vec<Dependence> = varied.iter().filter_map(of).collect();
        found.sort_by(|a, b| b.rank_correlation.abs().total_cmp(&a.rank_correlation.abs()));
        if found.is_empty() {
            continue;
        }
        let clear = found.iter().filter(|one| one.is_clear());
        let said: Vec<String> =
            clear.map(|one| format!("{} ({:+.2})", one.key, one.rank_correlation)).collect();
        let (name, _) = response.title.split_once(" (").unwrap_or((response.title, ""));
        let most = match said.is_empty() {
            true => format!("No rank correlation of the {name} is told from zero."),
            false => format!("The {name} goes with {}, strongest first.", said.join(", ")),
        };
        let caption = format!("{most} Lines are 95 % intervals; grey bars are not told from zero.");
        panels.push(panel(&bars(&found), &caption));
    }
    if panels.is_empty() {
        return Vec::new();
    }
    let what = "Rank correlations (Spearman): +1 where a result always rises with what was varied, -1 where it always \
                falls.";
    vec![Part::Text(what.to_owned()), Part::Panels(panels)]
}

/// A figure per response that differs from point to point, and key that was varied.
fn responses(results: &Results, varied: &[Varied]) -> Result<Vec<Part>, PictureError> {
    let across: Vec<Across> = varied.iter().filter_map(Across::of).collect();
    let models = models(results);
    let mut panels = Vec::new();
    for response in &RESPONSES {
        let Some(values) = values(results, response).filter(|_| !across.is_empty()) else {
            continue;
        };
        let drawing = Drawing { results, response, values: &values, models: &models };
        for across in &across {
            let (title, key) = (sentence(response.title), &across.key);
            let caption = format!("{title} of every point that is done, over {key}.");
            panels.push(panel(&drawing.picture(across)?, &caption));
        }
    }
    let none = "Nothing is done yet that differs from point to point.";
    Ok(vec![if panels.is_empty() { Part::Text(none.to_owned()) } else { Part::Panels(panels) }])
}

fn sentence(title: &str) -> String {
    let (first, rest) = title.split_at(1);
    format!("{}{rest}", first.to_uppercase())
}

/// The models by their names, in the order of the plan.
fn models(results: &Results) -> Vec<&str> {
    let mut models: Vec<&str> = Vec::new();
    for Point { model, .. } in &results.plan.points {
        if !models.contains(&model.as_str()) {
            models.push(model);
        }
    }
    models
}

impl Across {
    /// Of numbers those themselves; of few words their places in the order of the plan.
    fn of(varied: &Varied) -> Option<Self> {
        let unit = varied.unit.as_ref().map_or(String::new(), |unit| format!(" ({unit})"));
        let key = varied.key.clone();
        match &varied.values {
            Values::Numbers(numbers) => {
                Some(Self { title: format!("{key}{unit}"), key, numbers: numbers.clone() })
            }
            Values::Texts(words) => {
                let mut known: Vec<&String> = Vec::new();
                let mut numbers = Vec::with_capacity(words.len());
                for word in words {
                    numbers.push(word.as_ref().map(|word| {
                        let found = known.iter().position(|one| *one == word);
                        let place = found.unwrap_or(known.len());
                        if found.is_none() {
                            known.push(word);
                        }
                        place as f64 + 1.0
                    }));
                }
                let names: Vec<String> =
                    (1..).zip(&known).map(|(at, word)| format!("{at} {word}")).collect();
                let title = format!("{key}: {}", names.join(", "));
                Some(Self { key, title, numbers })
            }
        }
    }
}

/// One response.
struct Drawing<'a> {
    results: &'a Results,
    response: &'a Response,
    /// In the order of the plan.
    values: &'a [Option<f64>],
    models: &'a [&'a str],
}

impl Drawing<'_> {
    fn picture(&self, across: &Across) -> Result<String, PictureError> {
        let signs: Vec<(Sign, String)> = match self.models {
            [_] => Vec::new(),
            models => models
                .iter()
                .enumerate()
                .map(|(at, model)| (Sign::Dot(colour(at)), (*model).to_owned()))
                .collect(),
        };
        let legend = if signs.is_empty() { 0 } else { legend::height(signs.len()) };
        svg((PANEL.0, PANEL.1 + legend), |area| {
            let (chart, below) = area.split_vertically(PANEL.1);
            self.panel(&chart, across)?;
            legend::draw(&below, &signs)
        })
    }

    fn panel(&self, area: &Area<'_>, across: &Across) -> Drawn {
        let points = || {
            self.results
                .points()
                .zip(&across.numbers)
                .zip(self.values)
                .filter_map(|(((point, _), x), y)| Some((point, (*x)?, (*y)?)))
        };
        let range = |of: fn((&Point, f64, f64)) -> f64| {
            let ends = points().map(of).fold(None, |ends: Option<(f64, f64)>, value| {
                let (low, high) = ends.unwrap_or((value, value));
                Some((low.min(value), high.max(value)))
            });
            let (low, high) = ends.unwrap_or((0.0, 1.0));
            let pad = if high > low { (high - low) / 12.0 } else { high.abs().max(1.0) / 12.0 };
            low - pad..high + pad
        };
        let over = [range(|(_, x, _)| x), range(|(_, _, y)| y)];
        let mut chart = axes::chart(area, over, 4, [&across.title, self.response.title])?;
        for (point, x, y) in points() {
            let model = self.models.iter().position(|model| *model == point.model).unwrap_or(0);
            chart.draw_series([Circle::new((x, y), 3, colour(model).filled())])?;
            let text = format!(
                "point {} of {}\n{}\n{}: {}",
                point.point,
                point.model,
                point.set.join("\n"),
                self.response.title,
                short(y)
            );
            chart.draw_series([Hover::at((x, y), text)])?;
        }
        Ok(())
    }
}

fn failures(results: &Results) -> Vec<Part> {
    let mut table = Table::new(&["point", "model", "set", "why"]);
    for (point, outcome) in results.points() {
        if let Some(why) = outcome.error() {
            table.rows.push(vec![
                point.point.to_string(),
                point.model.clone(),
                point.set.join(", "),
                why.to_owned(),
            ]);
        }
    }
    let any = !table.rows.is_empty();
    any.then_some(Part::Table(table)).into_iter().collect()
}

/// The value at the point `at` of the plan, of a number four digits: a drawn one has as many as there are.
fn shown(varied: &Varied, at: usize) -> String {
    let number = match &varied.values {
        Values::Numbers(numbers) => numbers[at],
        Values::Texts(_) => None,
    };
    let unit = varied.unit.as_ref().map_or(String::new(), |unit| format!(" {unit}"));
    number
        .map_or_else(|| varied.shown(at), |number| format!("{}{unit}", four_digits(&number.into())))
}

fn listed(results: &Results, varied: &[Varied]) -> Vec<Part> {
    let is_one_model = models(results).len() == 1;
    let mut head = if is_one_model { vec!["point"] } else { vec!["point", "model"] };
    head.extend(varied.iter().map(|one| one.key.as_str()));
    head.extend(["state", "depth (mm)", "stopping time (ms)", "folder, from its first letters"]);
    let mut table = Table::new(&head);
    for (at, (point, outcome)) in results.points().take(MOST_POINTS).enumerate() {
        let one = outcome.headline();
        let mut row = vec![point.point.to_string()];
        row.extend(Some(point.model.clone()).filter(|_| !is_one_model));
        row.extend(varied.iter().map(|varied| shown(varied, at)));
        row.push(outcome.word().to_owned());
        row.push(crate::numbers::fixed(one.map(|one| 1e3 * one.depth_m), 2));
        let time = one.and_then(|one| one.stopping_time_s);
        row.push(crate::numbers::fixed(time.map(|time| 1e3 * time), 2));
        row.push(point.hash.chars().take(NAME).collect());
        table.rows.push(row);
    }
    let mut parts = vec![Part::Table(table)];
    if results.plan.points.len() > MOST_POINTS {
        let rest = format!("The first {MOST_POINTS}; all are in {}.", runner::campaign::TABLE);
        parts.push(Part::Text(rest));
    }
    parts
}
