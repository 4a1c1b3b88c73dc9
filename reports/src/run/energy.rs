//! The energy budget over time: what was supplied, what became of it, and what is not accounted for.

use plots::axes::{self, Frame};
use plots::legend::{self, Sign};
use plots::{Area, Drawn, Hover, PictureError, colour, svg};
use plotters::prelude::*;

use super::Course;
use super::thin::places;
use crate::numbers::{prefix_of, with_prefix};

/// Size of the stack without its legend, and of the panel of what is unaccounted for (pixels).
const STACK: (u32, u32) = (400, 330);
const REST: (u32, u32) = (400, 220);

/// What the axis of time says, and how many times along it.
const TIME: &str = "time (ms)";
const TIMES: usize = 6;

/// Columns that say their values.
const COLUMNS: usize = 120;

/// Share of what is supplied below which a layer is not seen and not drawn.
const LEAST: f64 = 1e-3;

/// Share of what is supplied from which on a source is named.
const SAID: f64 = 0.01;

/// Where energy is or went.
struct Layer {
    name: String,
    colour: RGBColor,
    /// (J), at each time.
    values: Vec<f64>,
}

/// The energies of a run over time.
pub(super) struct Budget {
    /// (ms).
    time: Vec<f64>,
    layers: Vec<Layer>,
    /// What supplies energy, in words.
    sources: Vec<String>,
    /// What they have supplied (J), at each time.
    supplied: Vec<f64>,
    /// What is missing; none where the layers are not all there are.
    missing: Option<Missing>,
}

/// What is supplied and in no layer.
struct Missing {
    /// (J), at each time.
    values: Vec<f64>,
    /// What they are counted in (J), and what that is.
    scale: f64,
    of: &'static str,
}

impl Budget {
    /// Of `course`; `None` if its log has no energies, or nothing moves in it.
    ///
    /// Accounts are those of [`runner::run::EnergySummary::shares`]: one that is negative is a source.
    pub(super) fn of(course: &Course) -> Option<Self> {
        let energy = course.energy.as_ref()?;
        let mut accounts: Vec<Account> = Vec::new();
        for (term, values) in energy.terms.iter().zip(&energy.values) {
            Account::book(&mut accounts, term, values);
        }
        let mut supplied = vec![0.0; energy.time.len()];
        let mut layers = Vec::new();
        for account in &accounts {
            supplied.iter_mut().zip(&account.uses).for_each(|(sum, use_)| *sum += (-use_).max(0.0));
            let values = account.uses.iter().map(|use_| use_.max(0.0)).collect();
            layers.push(Layer { name: account.name.clone(), colour: BLACK, values });
        }
        let most = |values: &[f64]| values.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        let whole = most(&supplied);
        layers.retain(|layer| most(&layer.values) > LEAST * whole);
        layers.iter_mut().enumerate().for_each(|(at, layer)| layer.colour = colour(at));
        let gives = |account: &&Account| account.uses.iter().any(|use_| -use_ > SAID * whole);
        let mut sources: Vec<String> =
            accounts.iter().filter(gives).map(|one| one.source.clone()).collect();
        sources.sort_unstable();
        sources.dedup();
        let is_pushed = energy.terms.iter().any(|term| term.starts_with("input_drive"));
        let missing = energy.closing.as_ref().map(|closing| {
            let (scale, of) = match (closing.closure.last(), most(&closing.unaccounted)) {
                // A slow drive has next to no energy at the start.
                _ if is_pushed => (whole, "of all that is supplied"),
                // The closure is the largest of them over the energy at impact.
                (Some(&closure), most) if closure > 0.0 && most > 0.0 => {
                    (most / closure, "of the energy at impact")
                }
                _ => (whole, "of all that is supplied"),
            };
            let values = closing.unaccounted.iter().map(|energy| -energy).collect();
            Missing { values, scale, of }
        });
        (energy.time.len() > 1 && whole > 0.0).then(|| Self {
            time: energy.time.iter().map(|time| 1e3 * time).collect(),
            layers,
            sources,
            supplied,
            missing,
        })
    }
}

/// An account of the energy.
struct Account {
    name: String,
    /// What it is as a source.
    source: String,
    /// What it holds or has taken (J), at each time; negative where it gives.
    uses: Vec<f64>,
}

impl Account {
    /// Books a term of the log in one or two of `accounts`.
    fn book(accounts: &mut Vec<Self>, term: &str, values: &[f64]) {
        let name = term.strip_suffix("_J").unwrap_or(term);
        let (kind, of) = name.split_once('_').unwrap_or((name, ""));
        let start = values.first().copied().unwrap_or(0.0);
        let since_start = || values.iter().map(|value| value - start);
        let mut add = |name: &str, source: &str, uses: &mut dyn Iterator<Item = f64>| match accounts
            .iter_mut()
            .find(|account| account.name == name)
        {
            Some(one) => one.uses.iter_mut().zip(uses).for_each(|(sum, use_)| *sum += use_),
            None => accounts.push(Self {
                name: name.to_owned(),
                source: source.to_owned(),
                uses: uses.collect(),
            }),
        };
        match kind {
            "kinetic" | "potential" if of.starts_with("grains") => {
                add("grains, motion and height", "the height of the grains", &mut since_start());
            }
            "kinetic" => {
                let at_start = std::iter::repeat_n(-start, values.len());
                add("motion at the start", "the motion at the start", &mut { at_start });
                add("intruder in motion", "", &mut values.iter().copied());
            }
            "potential" => add("intruder raised", "the height of the intruder", &mut since_start()),
            "elastic" => add("held by springs", "springs", &mut since_start()),
            "input" if of == "drive" => {
                add("taken by the drive", "the drive", &mut values.iter().map(|value| -value));
            }
            "input" => add(
                &format!("taken by the {}", of.replace('_', " ")),
                &format!("the {}", of.replace('_', " ")),
                &mut values.iter().map(|value| -value),
            ),
            _ => add(
                &format!("lost to {}", of.replace('_', " ")),
                "contacts that give energy back",
                &mut values.iter().copied(),
            ),
        }
    }
}

/// The stack with the supply over it, and what is unaccounted for, each with what it shows.
pub(super) fn pictures(budget: &Budget) -> Result<Vec<(String, String)>, PictureError> {
    let rows: Vec<(Sign, String)> = budget
        .layers
        .iter()
        .rev()
        .map(|layer| (Sign::Square(layer.colour), layer.name.clone()))
        .chain([(Sign::Dashed(BLACK), "supplied".to_owned())])
        .collect();
    let stack = svg((STACK.0, STACK.1 + legend::height(rows.len())), |area| {
        let (chart, below) = area.split_vertically(STACK.1);
        budget.draw_stack(&chart)?;
        legend::draw(&below, &rows)
    })?;
    let mut pictures = vec![(stack, budget.caption())];
    if let Some(missing) = &budget.missing {
        let picture = svg(REST, |area| budget.draw_rest(missing, area))?;
        let of = missing.of;
        let caption = format!(
            "What the stack misses of the line: energy that no account holds, in parts {of}."
        );
        pictures.push((picture, caption));
    }
    Ok(pictures)
}

impl Budget {
    /// What the stack shows, in words.
    fn caption(&self) -> String {
        let supplied = match &self.sources[..] {
            [] => "all that has come in".to_owned(),
            [one] => one.clone(),
            [first @ .., last] => format!("{} and {last}", first.join(", ")),
        };
        let what = match self.missing {
            Some(_) => "what has become of it",
            None => "as much of what has become of it as the program tells that made the run",
        };
        format!(
            "Energy supplied (dashed), by {supplied}, and {what}. Springs and heights count from the start."
        )
    }

    fn last(&self) -> f64 {
        self.time.last().copied().unwrap_or(0.0).max(1e-9)
    }

    /// Lower and upper edges (J) of each layer.
    fn edges(&self) -> Vec<Vec<(f64, f64)>> {
        let mut top = vec![0.0; self.time.len()];
        let edge = |(value, top): (&f64, &mut f64)| {
            let from = *top;
            *top += value;
            (from, *top)
        };
        let layer = |one: &Layer| one.values.iter().zip(&mut top).map(edge).collect();
        self.layers.iter().map(layer).collect()
    }

    fn draw_stack(&self, area: &Area<'_>) -> Drawn {
        let edges = self.edges();
        let high = edges.iter().flatten().fold(0.0_f64, |high, edge| high.max(edge.1));
        let high = self.supplied.iter().fold(high, |high, value| high.max(*value));
        let (factor, prefix) = prefix_of(high);
        let top = 1.05 * factor * high;
        let names = [TIME, &format!("energy ({prefix}J)")];
        let mut chart = axes::chart(area, [0.0..self.last(), 0.0..top], TIMES, names)?;
        for (layer, edges) in self.layers.iter().zip(&edges) {
            let lower = self.time.iter().zip(edges).map(|(t, edge)| (*t, factor * edge.0));
            let upper = self.time.iter().zip(edges).map(|(t, edge)| (*t, factor * edge.1));
            let outline: Vec<(f64, f64)> = lower.chain(upper.rev()).collect();
            chart.draw_series([Polygon::new(outline, layer.colour.mix(0.85).filled())])?;
        }
        let line = self.time.iter().zip(&self.supplied).map(|(t, value)| (*t, factor * value));
        chart.draw_series(DashedLineSeries::new(line, 5, 4, BLACK.stroke_width(2)))?;
        chart.draw_series(
            self.columns(|place| self.stack_at(place))
                .into_iter()
                .map(|([from, to], text)| Hover::over([(from, 0.0), (to, top)], text)),
        )?;
        Ok(())
    }

    fn draw_rest(&self, missing: &Missing, area: &Area<'_>) -> Drawn {
        let shares: Vec<f64> = missing.values.iter().map(|value| value / missing.scale).collect();
        let most = shares.iter().fold(1e-15_f64, |most, share| most.max(share.abs()));
        // Labels of such numbers fit no axis as they are.
        let exponent = libm::log10(most).floor();
        let factor = libm::pow(10.0, -exponent);
        let up = -1.3 * factor * most..1.3 * factor * most;
        let mut chart = Frame {
            ranges: [0.0..self.last(), up.clone()],
            ticks: [TIMES, 4],
            names: [TIME, &format!("missing (1e{exponent})")],
            above: 8,
            below: 0,
            grid: true,
        }
        .draw(area)?;
        let line = self.time.iter().zip(&shares).map(|(t, share)| (*t, factor * share));
        chart.draw_series(LineSeries::new(line, colour(1).stroke_width(2)))?;
        let text = |place: usize| format!("missing: {:.2e} {}", shares[place], missing.of);
        chart.draw_series(
            self.columns(text)
                .into_iter()
                .map(|([from, to], text)| Hover::over([(from, up.start), (to, up.end)], text)),
        )?;
        Ok(())
    }

    /// Every layer at `place`, from the top.
    fn stack_at(&self, place: usize) -> String {
        let layers = self.layers.iter().rev();
        let lines = layers
            .map(|layer| format!("{}: {}", layer.name, with_prefix(layer.values[place], "J")));
        let supplied = format!("supplied: {}", with_prefix(self.supplied[place], "J"));
        [supplied].into_iter().chain(lines).collect::<Vec<_>>().join("\n")
    }

    /// Parts of the time (ms) with what `text` says of a place in each.
    fn columns(&self, text: impl Fn(usize) -> String) -> Vec<([f64; 2], String)> {
        let kept = places(&self.time, COLUMNS);
        let middle = |a: usize, b: usize| 0.5 * (self.time[a] + self.time[b]);
        let column = |(at, &place): (usize, &usize)| {
            let from = at.checked_sub(1).map_or(0.0, |before| middle(kept[before], place));
            let to = kept.get(at + 1).map_or(self.last(), |&after| middle(place, after));
            ([from, to], format!("{:.2} ms\n{}", self.time[place], text(place)))
        };
        kept.iter().enumerate().map(column).collect()
    }
}

#[cfg(test)]
mod tests {
    use exchange::read::{Closing, EnergyBudgets};

    use super::*;

    /// A body of 1 J that loses half of it to friction, half to its height, in which it rises.
    fn course() -> Course {
        let budget = EnergyBudgets {
            terms: [
                "kinetic_intruder_translation_J",
                "potential_intruder_J",
                "dissipated_sliding_J",
            ]
            .map(str::to_owned)
            .into(),
            time: vec![0.0, 1.0],
            values: vec![vec![1.0, 0.0], vec![0.2, 0.7], vec![0.0, 0.49]],
            closing: Some(Closing { unaccounted: vec![0.0, -0.01], closure: vec![0.0, 0.01] }),
        };
        Course {
            bodies: Vec::new(),
            energy: Some(budget),
            forces: crate::scene::Forces::default(),
            complete: true,
            body: None,
        }
    }

    #[test]
    fn the_stack_misses_of_the_supply_what_is_unaccounted_for() {
        let budget = Budget::of(&course()).expect("energies");
        // What it has put into its height is a layer.
        assert_eq!(budget.supplied, [1.0, 1.0]);
        assert_eq!(budget.sources, ["the motion at the start"]);
        let stacked: f64 = budget.layers.iter().map(|layer| layer.values[1]).sum();
        // Sums of three numbers near one.
        let missing = budget.missing.expect("the terms are all there are");
        assert!((budget.supplied[1] - stacked - missing.values[1]).abs() < 1e-15);
        assert!((missing.scale - 1.0).abs() < 1e-12, "the energy at impact, by a division");
    }

    #[test]
    fn what_gives_is_supplied_and_in_no_layer_as_in_the_table_of_shares() {
        let mut course = course();
        let energy = course.energy.as_mut().expect("energies");
        // Grains that sink by 0.25 J, springs of a bed at rest that hold 2 J, and a drive.
        for (term, values) in [
            ("potential_grains_J", [4.0, 3.75]),
            ("elastic_contacts_J", [2.0, 2.125]),
            ("input_drive_J", [0.0, 0.5]),
        ] {
            energy.terms.push(term.to_owned());
            energy.values.push(values.into());
        }
        let budget = Budget::of(&course).expect("energies");
        // Sums of powers of two: exact.
        assert_eq!(budget.supplied, [1.0, 1.75]);
        let names: Vec<&str> = budget.layers.iter().map(|layer| layer.name.as_str()).collect();
        assert_eq!(names.len(), 4, "{names:?}");
        assert!(!names.contains(&"grains, motion and height"), "{names:?}");
        let springs = budget.layers.iter().find(|layer| layer.name == "held by springs");
        assert_eq!(springs.expect("springs").values, [0.0, 0.125]);
        let sources = ["the drive", "the height of the grains", "the motion at the start"];
        assert_eq!(budget.sources, sources);
        assert!(budget.edges().iter().flatten().all(|edge| edge.0 <= edge.1));
    }

    #[test]
    fn every_layer_is_drawn_and_says_its_energy() {
        let pictures = pictures(&Budget::of(&course()).expect("energies")).expect("pictures");
        let picture = &pictures[0].0;
        for layer in ["intruder in motion", "lost to sliding"] {
            assert!(picture.matches(layer).count() >= 3, "legend and two columns: {layer}");
        }
        assert!(picture.contains("supplied: 1 J"));
    }
}
