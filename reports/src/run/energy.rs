//! The energy budget over time: what was supplied, what became of it, and what is not accounted for.

use plots::legend::{self, Sign};
use plots::{Area, Drawn, GREY, Hover, PictureError, colour, letters, svg};
use plotters::prelude::*;

use super::Course;
use super::thin::places;
use crate::numbers::{prefix_of, with_prefix};

/// Size of the figure without its legend, and height of the panel of what is unaccounted for (pixels).
const SIZE: (u32, u32) = (940, 470);
const LOWER: u32 = 130;

/// What the axis of time says, and how many times along it.
const TIME: &str = "time (ms)";
const TIMES: usize = 8;

/// Columns that say their values.
const COLUMNS: usize = 120;

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
    /// What the impact, the weights and whatever puts energy in have supplied (J), at each time.
    supplied: Vec<f64>,
    /// What is missing; none where the layers are not all there are.
    missing: Option<Missing>,
}

/// What is supplied and in no layer.
struct Missing {
    /// (J), at each time.
    values: Vec<f64>,
    /// What they are counted in (J).
    scale: f64,
}

impl Budget {
    /// Of `course`; `None` if its log has no energies, or nothing moves in it.
    pub(super) fn of(course: &Course) -> Option<Self> {
        let energy = course.energy.as_ref()?;
        let n = energy.time.len();
        let mut layers: Vec<Layer> = Vec::new();
        let mut supplied = vec![0.0; n];
        for (term, values) in energy.terms.iter().zip(&energy.values) {
            match Account::of(term) {
                Account::Layer(name) => add_to(&mut layers, name, values),
                Account::Weight => {
                    let start = values.first().copied().unwrap_or(0.0);
                    supplied.iter_mut().zip(values).for_each(|(sum, value)| *sum += start - value);
                }
                Account::Input => {
                    supplied.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
                }
            }
        }
        // What is there at the start: the motion of the intruder, and what springs of a bed at rest hold.
        let at_start: f64 = layers.iter().filter_map(|layer| layer.values.first()).sum();
        supplied.iter_mut().for_each(|sum| *sum += at_start);
        let most = |values: &[f64]| values.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        let whole = most(&supplied);
        layers.retain(|layer| most(&layer.values) > 1e-6 * whole);
        layers.iter_mut().enumerate().for_each(|(at, layer)| layer.colour = colour(at));
        let missing = energy.closing.as_ref().map(|closing| Missing {
            values: closing.unaccounted.iter().map(|energy| -energy).collect(),
            scale: match (closing.closure.last(), most(&closing.unaccounted)) {
                // The closure is the largest of them over the energy at impact.
                (Some(&closure), most) if closure > 0.0 && most > 0.0 => most / closure,
                _ => whole,
            },
        });
        (n > 1 && whole > 0.0).then(|| Self {
            time: energy.time.iter().map(|time| 1e3 * time).collect(),
            layers,
            supplied,
            missing,
        })
    }
}

/// Letters of the numbers along an axis, the same in panels of any height.
fn small() -> TextStyle<'static> {
    ("sans-serif", 11.0).into_font().into()
}

/// What a term of the log counts as.
enum Account {
    /// A layer of the stack, by name.
    Layer(String),
    /// Energy of height, of which a loss is a supply.
    Weight,
    /// Energy put in.
    Input,
}

impl Account {
    fn of(term: &str) -> Self {
        let name = term.strip_suffix("_J").unwrap_or(term);
        let (kind, of) = name.split_once('_').unwrap_or((name, ""));
        match kind {
            "potential" => Self::Weight,
            "input" => Self::Input,
            "kinetic" if of.starts_with("grains") => Self::Layer("grains in motion".to_owned()),
            "kinetic" => Self::Layer("intruder in motion".to_owned()),
            "elastic" => Self::Layer("held by springs".to_owned()),
            _ => Self::Layer(format!("lost to {}", of.replace('_', " "))),
        }
    }
}

fn add_to(layers: &mut Vec<Layer>, name: String, values: &[f64]) {
    match layers.iter_mut().find(|layer| layer.name == name) {
        Some(layer) => layer.values.iter_mut().zip(values).for_each(|(sum, v)| *sum += v),
        None => layers.push(Layer { name, colour: BLACK, values: values.to_vec() }),
    }
}

/// The stack with the supply over it, and what is unaccounted for below.
pub(super) fn picture(budget: &Budget) -> Result<String, PictureError> {
    let rows: Vec<(Sign, String)> = budget
        .layers
        .iter()
        .rev()
        .map(|layer| (Sign::Square(layer.colour), layer.name.clone()))
        .chain([(Sign::Dashed(BLACK), "supplied by the impact and the weight".to_owned())])
        .collect();
    svg((SIZE.0, SIZE.1 + legend::height(rows.len())), |area| {
        let (charts, below) = area.split_vertically(SIZE.1);
        match &budget.missing {
            Some(missing) => {
                let (stack, rest) = charts.split_vertically(SIZE.1 - LOWER);
                budget.draw_stack(&stack, 0)?;
                budget.draw_rest(missing, &rest)?;
            }
            None => budget.draw_stack(&charts, TIMES)?,
        }
        legend::draw(&below, &rows)
    })
}

impl Budget {
    /// What the picture shows, in words.
    pub(super) fn caption(&self) -> &'static str {
        match self.missing {
            Some(_) => {
                "What the impact and the weight have supplied (dashed), and what has become of it. What \
                 the stack misses of the line is not accounted for; below, in parts of the energy at \
                 impact."
            }
            None => {
                "What the impact and the weight have supplied (dashed), and as much of what has become of \
                 it as the program tells that made the run."
            }
        }
    }

    fn last(&self) -> f64 {
        self.time.last().copied().unwrap_or(0.0).max(1e-9)
    }

    /// Lower and upper edges (J) of each layer: what is positive stands on zero, what is negative hangs
    /// below it.
    fn edges(&self) -> Vec<Vec<(f64, f64)>> {
        let (mut above, mut below) = (vec![0.0; self.time.len()], vec![0.0; self.time.len()]);
        let edge = |(value, (above, below)): (&f64, (&mut f64, &mut f64))| {
            let side = if *value < 0.0 { below } else { above };
            let from = *side;
            *side += value;
            (from.min(*side), from.max(*side))
        };
        let layer = |one: &Layer| {
            one.values.iter().zip(above.iter_mut().zip(&mut below)).map(edge).collect()
        };
        self.layers.iter().map(layer).collect()
    }

    /// With so many `times` along its axis: none where there is another panel below.
    fn draw_stack(&self, area: &Area<'_>, times: usize) -> Drawn {
        let edges = self.edges();
        let all = || edges.iter().flatten();
        let high = all().fold(0.0_f64, |high, edge| high.max(edge.1));
        let high = self.supplied.iter().fold(high, |high, value| high.max(*value));
        let low = all().fold(0.0_f64, |low, edge| low.min(edge.0));
        let (factor, prefix) = prefix_of(high);
        let up = 1.05 * factor * low..1.05 * factor * high;
        let mut chart = ChartBuilder::on(area)
            .margin(8)
            .x_label_area_size(if times > 0 { 36 } else { 8 })
            .y_label_area_size(66)
            .build_cartesian_2d(0.0..self.last(), up.clone())?;
        chart
            .configure_mesh()
            .disable_x_mesh()
            .x_labels(times)
            .x_desc(if times > 0 { TIME } else { "" })
            .y_labels(6)
            .y_label_formatter(&|value| plots::short(*value))
            .label_style(small())
            .y_desc(format!("energy ({prefix}J)"))
            .axis_desc_style(letters())
            .light_line_style(WHITE)
            .bold_line_style(GREY)
            .draw()?;
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
                .map(|([from, to], text)| Hover::over([(from, up.start), (to, up.end)], text)),
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
        let mut chart = ChartBuilder::on(area)
            .margin(8)
            .x_label_area_size(36)
            .y_label_area_size(66)
            .build_cartesian_2d(0.0..self.last(), up.clone())?;
        chart
            .configure_mesh()
            .disable_x_mesh()
            .x_labels(TIMES)
            .y_labels(3)
            .x_label_formatter(&|value| plots::short(*value))
            .y_label_formatter(&|value| plots::short(*value))
            .label_style(small())
            .x_desc(TIME)
            .y_desc(format!("missing (1e{exponent})"))
            .axis_desc_style(letters())
            .light_line_style(WHITE)
            .bold_line_style(GREY)
            .draw()?;
        let line = self.time.iter().zip(&shares).map(|(t, share)| (*t, factor * share));
        chart.draw_series(LineSeries::new(line, colour(1).stroke_width(2)))?;
        let text = |place: usize| format!("missing: {:.2e} of the impact", shares[place]);
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
        }
    }

    #[test]
    fn the_stack_misses_of_the_supply_what_is_unaccounted_for() {
        let budget = Budget::of(&course()).expect("energies");
        assert_eq!(budget.supplied, [1.0, 0.5]);
        let stacked: f64 = budget.layers.iter().map(|layer| layer.values[1]).sum();
        // Sums of three numbers near one.
        let missing = budget.missing.expect("the terms are all there are");
        assert!((budget.supplied[1] - stacked - missing.values[1]).abs() < 1e-15);
        assert!((missing.scale - 1.0).abs() < 1e-12, "the energy at impact, by a division");
    }

    #[test]
    fn what_is_negative_hangs_below_zero_and_the_rest_stands_on_it() {
        let layer =
            |values: &[f64]| Layer { name: String::new(), colour: BLACK, values: values.to_vec() };
        let budget = Budget {
            time: vec![0.0],
            layers: vec![layer(&[2.0]), layer(&[-1.0]), layer(&[3.0])],
            supplied: vec![4.0],
            missing: None,
        };
        let edges: Vec<(f64, f64)> = budget.edges().into_iter().flatten().collect();
        assert_eq!(edges, [(0.0, 2.0), (-1.0, 0.0), (2.0, 5.0)]);
    }

    #[test]
    fn every_layer_is_drawn_and_says_its_energy() {
        let picture = picture(&Budget::of(&course()).expect("energies")).expect("a picture");
        for layer in ["intruder in motion", "lost to sliding"] {
            assert!(picture.matches(layer).count() >= 3, "legend and two columns: {layer}");
        }
        assert!(picture.contains("supplied: 500 mJ"));
    }
}
