//! A formula for a missing force: one or two terms of the library, chosen by what they explain of the measurements beside
//! the parameters, refitted as parts of the model, and kept only where they predict.

use argmin::core::{CostFunction, Executor, State as _};
use argmin::solver::neldermead::NelderMead;
use engine::params::Range;
use engine::units::Dimension;
use nalgebra::DVector;
use rayon::prelude::*;
use resistive::{Acts, Direction, Draft, OwnParameter};

use super::library::library;
use super::response::Response;
use super::term::{MILLIMETRE, State, Term, short};
use crate::fit::Fit;
use crate::fit::problem::{FitError, FitProblem, Fitted};
use crate::forward::ByFormulas;
use crate::forward::field::{Field, Grid};
use crate::forward::sensitivity::Point;
use crate::misfit::held_out::{HeldOut, NEARER};

/// Forms of the library that are searched for their best numbers, alone and with a second.
const SEARCHED: usize = 8;
const SEARCHED_WITH: usize = 3;

/// Most evaluations of such a search.
const EVALUATIONS: u64 = 60;

/// Largest amplitude of a formula, in units of what its force is made of.
const MOST: f64 = 1e4;

/// Formulas of one and of two terms that are refitted as parts of the model.
const SINGLES: usize = 3;
const DOUBLES: usize = 2;

/// Formulas whose own noise is estimated, which is slow; and by how much the ratio of errors on held-out conditions may
/// be larger under the noise of the search than what is kept.
const JUDGED: usize = 2;
const SLACK: f64 = 1.2;

/// Terms more alike than this are one.
const ALIKE: f64 = 0.98;

/// Fall of the deviance that a term is worth: it is chosen from hundreds.
const WORTH: f64 = 20.0;

/// Share of the scatter between conditions that may be left beside a formula.
const LEFT: f64 = 0.5;

/// A force that may be negative goes to zero with the speed over this share of √(g D).
const REST: &str = "tanh(20 * v / V_s)";

/// The name of the effect.
pub const FOUND: &str = "found";

/// A force that fits and predicts; no explanation.
#[derive(Clone, Debug)]
pub struct Formula {
    /// The force (N), with the amplitude `q`.
    pub force: String,
    /// `friction` or `drag`, as in a model file.
    pub kind: &'static str,
    /// What it looks like.
    pub words: String,
    /// Errors on held-out conditions without and with it.
    pub holdout: HeldOut,
    /// How many terms it has.
    pub terms: usize,
    /// The model with it, fitted; the amplitude is the last unknown.
    pub fitted: Fitted,
}

impl Formula {
    /// The first of `refitted` (best first) that is worth keeping. As many are looked at as one search refits, and
    /// [`JUDGED`] of those that predict under the noise of the search are judged.
    pub(super) fn kept(
        problem: &FitProblem<'_>,
        by: &dyn ByFormulas,
        baseline: &Fitted,
        refitted: Vec<Refitted>,
    ) -> Result<Option<Self>, FitError> {
        let mut judged = 0;
        for one in refitted.into_iter().take(SINGLES + DOUBLES) {
            let own = draft(FOUND, one.force.clone(), by);
            let extended =
                by.extended(vec![own]).map_err(|why| FitError::Formula(why.to_string()))?;
            let with = FitProblem { forward: &*extended, ..*problem };
            let holdout = HeldOut::of(&with, baseline, &one.fitted)?;
            if holdout.is_above_noise() != Some(true) {
                break;
            }
            if ratio(&holdout).is_none_or(|ratio| ratio > SLACK * NEARER) {
                continue;
            }
            let formula = Self::judged(&with, baseline, one)?;
            if predicts(&formula, baseline) {
                return Ok(Some(formula));
            }
            judged += 1;
            if judged == JUDGED {
                break;
            }
        }
        Ok(None)
    }

    /// `refitted`, a part of the model `with`, before conditions that it was not fitted to.
    fn judged(
        with: &FitProblem<'_>,
        baseline: &Fitted,
        refitted: Refitted,
    ) -> Result<Self, FitError> {
        let Refitted { force, terms, amplitudes, fitted } = refitted;
        // The noise of the search differs from the noise beside the formula, which is estimated here.
        let under_its_own = |point: &Point| {
            let noise = with.fit(point).ok()?;
            let fit = with.data(&noise.weights).fit_as_listed(point).ok()?;
            Some(Fitted { fit, ..noise })
        };
        let fitted = under_its_own(&fitted.fit.point).unwrap_or(fitted);
        let holdout = HeldOut::of(with, baseline, &fitted)?;
        let q = fitted.fit.point.effects.last().map_or(0.0, |(_, q)| *q);
        let sense = if q < 0.0 { "pushes along the motion" } else { "resists" };
        let each: Vec<String> = terms.iter().map(Term::words).collect();
        let signs = match amplitudes[..] {
            [a, b] if a * b < 0.0 => "; the second takes away from the first",
            _ => "",
        };
        let words = format!("a force that {sense} and {}{signs}", each.join("; and one that "));
        let (force, kind) = force;
        Ok(Self { force, kind, words, holdout, terms: terms.len(), fitted })
    }

    /// Its amplitude.
    pub fn amplitude(&self) -> f64 {
        self.fitted.fit.point.effects.last().map_or(0.0, |(_, q)| *q)
    }

    /// The table of a candidate for a model file.
    pub fn table(&self) -> String {
        let Self { force, kind, words, .. } = self;
        let millimetre = match uses_millimetres(force) {
            true => "parameters.mm = { value = 0.001, unit = \"m\" }\n",
            false => "",
        };
        format!(
            "[[candidate]]\nname = \"expression\"\nid = \"{FOUND}\"\n\
             summary = \"fits and predicts; not an explanation: {words}\"\nkind = \"{kind}\"\n\
             force = \"{force}\"\nparameters.q = {{ unit = \"1\", range = [-{MOST}, {MOST}] }}\n{millimetre}"
        )
    }
}

/// Terms with what they explain.
#[derive(Clone, Debug)]
struct Choice {
    terms: Vec<Term>,
    /// Their answers beside the parameters.
    columns: Vec<DVector<f64>>,
    /// Their amplitudes, to first order.
    amplitudes: Vec<f64>,
    /// Fall of χ².
    fall: f64,
}

impl Choice {
    /// Its first term and that of `second`; `None` where both do the same.
    fn and(&self, response: &Response, second: &Self) -> Option<Self> {
        let both = [&self.columns[0], &second.columns[0]];
        let (fall, amplitudes) = explained(&both, &response.residual)?;
        let terms = vec![self.terms[0].clone(), second.terms[0].clone()];
        Some(Self { terms, columns: both.map(Clone::clone).to_vec(), amplitudes, fall })
    }
}

/// Where a formula is looked for.
#[derive(Clone, Copy)]
pub(super) struct Search<'a> {
    pub(super) problem: &'a FitProblem<'a>,
    pub(super) by: &'a dyn ByFormulas,
    /// The model as it is, fitted.
    pub(super) baseline: &'a Fitted,
    /// Parameters of the model with the force that is missing.
    pub(super) near: &'a [f64],
    pub(super) response: &'a Response,
    /// What the bodies go through.
    pub(super) states: &'a [State],
}

impl Search<'_> {
    /// The most promising formulas as parts of the model, a second term counted at what it has to be worth; best first.
    pub(super) fn refitted(&self) -> Vec<Refitted> {
        let terms = library(self.states);
        let known: Vec<Choice> =
            terms.into_par_iter().filter_map(|term| choose(self.response, term, None)).collect();
        let singles = singles(self.response, known.clone());
        let doubles = doubles(self.response, &known, &singles);
        let finalists: Vec<&Choice> =
            singles.iter().take(SINGLES).chain(doubles.iter().take(DOUBLES)).collect();
        let mut refitted: Vec<Refitted> =
            finalists.into_par_iter().filter_map(|choice| self.refit(choice)).collect();
        refitted.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
        refitted
    }

    /// The model with the terms of `choice` as one force; `None` where it cannot be integrated.
    fn refit(&self, choice: &Choice) -> Option<Refitted> {
        let first = self.problem.forward.candidates().len();
        let (amplitudes, parameters) = (choice.amplitudes.clone(), self.near.to_vec());
        let force = force(&choice.terms, &amplitudes, self.states);
        let effects = vec![(first, amplitudes[0])];
        let fit = self.fit(draft(FOUND, force.clone(), self.by), Point { parameters, effects })?;
        let fitted = Fitted { fit, ..self.baseline.clone() };
        Some(Refitted { force, terms: choice.terms.clone(), amplitudes, fitted })
    }

    /// The fit from `start`, or from half of its amplitudes where the model cannot be integrated with them.
    fn fit(&self, draft: Draft, start: Point) -> Option<Fit> {
        const HALVINGS: usize = 3;
        let extended = self.by.extended(vec![draft]).ok()?;
        let with = FitProblem { forward: &*extended, ..*self.problem };
        let data = with.data(&self.baseline.weights);
        let mut point = start;
        for _ in 0..HALVINGS {
            match data.fit_as_listed(&point) {
                Ok(fit) => return Some(fit),
                Err(_) => point.effects.iter_mut().for_each(|(_, q)| *q *= 0.5),
            }
        }
        None
    }
}

/// A formula as a part of the model.
pub(super) struct Refitted {
    /// With its kind.
    force: (String, &'static str),
    terms: Vec<Term>,
    amplitudes: Vec<f64>,
    fitted: Fitted,
}

impl Refitted {
    /// Its force on `grid`, under the mean gravity where that counts; `None` where impacts do not share it.
    pub(super) fn field(&self, problem: &FitProblem<'_>, grid: &Grid) -> Option<Field> {
        if self.terms.iter().any(Term::is_of_impact) {
            return None;
        }
        let fit = &problem.observed.fit;
        let conditions = || fit.iter().map(|&at| &problem.set.conditions[at]);
        let n = fit.len().max(1) as f64;
        let gravity = conditions().map(|one| problem.set.bed_of(one).gravity).sum::<f64>() / n;
        let states: Vec<State> = (0..grid.against())
            .map(|node| grid.node(node))
            .map(|[depth, speed, angle, diameter]| State {
                depth,
                speed,
                impact_speed: speed,
                angle,
                diameter,
                gravity,
            })
            .collect();
        let q = self.fitted.fit.point.effects.last().map_or(0.0, |(_, q)| *q);
        let mut values = vec![0.0; grid.len()];
        for (term, amplitude) in self.terms.iter().zip(&self.amplitudes) {
            let share = q * amplitude / self.amplitudes[0];
            let each = values.iter_mut().zip(term.values(&states).unwrap_or_default());
            each.for_each(|(value, of_term)| *value += share * of_term);
        }
        Some(Field { grid: grid.clone(), values })
    }

    /// The parameters of the model with it.
    pub(super) fn point(&self) -> Point {
        Point { effects: Vec::new(), parameters: self.fitted.fit.point.parameters.clone() }
    }

    /// The deviance and what its terms have to be worth.
    pub(super) fn cost(&self) -> f64 {
        self.fitted.deviance() + WORTH * self.terms.len() as f64
    }
}

/// Whether the formula leaves most of the scatter between conditions. Such a formula does not describe what is missing, even
/// if it predicts the held-out conditions by chance.
fn leaves_them_apart(formula: &Formula, baseline: &Fitted) -> bool {
    let [before, after] = [baseline, &formula.fitted].map(|one| one.noise.sessions);
    after.sd > after.sigma.max(LEFT * before.sd)
}

/// The error that is left on held-out conditions, over that of the model as it is.
fn ratio(holdout: &HeldOut) -> Option<f64> {
    Some(holdout.after? / holdout.before?)
}

/// Whether it is worth its terms and takes a quarter of a clear error on conditions that it has not seen.
fn predicts(formula: &Formula, baseline: &Fitted) -> bool {
    let holdout = &formula.holdout;
    let fall = baseline.deviance() - formula.fitted.deviance();
    holdout.is_above_noise() == Some(true)
        && ratio(holdout).is_some_and(|ratio| ratio <= NEARER)
        && holdout.ratio_at_most.is_none_or(|most| most < 1.0)
        && holdout.log_density_gain > 0.0
        && holdout.not_predicted.is_empty()
        && fall >= WORTH * formula.terms as f64
        && !leaves_them_apart(formula, baseline)
}

/// Single terms, best first, with their best numbers; of terms that are alike only the best.
fn singles(response: &Response, all: Vec<Choice>) -> Vec<Choice> {
    let mut searched: Vec<Choice> = different(all, SEARCHED)
        .into_par_iter()
        .map(|choice| search(response, choice, None))
        .collect();
    searched.sort_by(|a, b| b.fall.total_cmp(&a.fall));
    different(searched, SEARCHED)
}

/// Two terms, likewise: each of the best with what helps it most.
fn doubles(response: &Response, known: &[Choice], singles: &[Choice]) -> Vec<Choice> {
    let first = &singles[..singles.len().min(SEARCHED_WITH)];
    let mut found: Vec<Choice> = first
        .par_iter()
        .filter_map(|first| {
            let with = known.iter().filter_map(|second| first.and(response, second));
            let best = with.max_by(|a, b| a.fall.total_cmp(&b.fall))?;
            Some(search(response, best, Some(first)))
        })
        .collect();
    found.sort_by(|a, b| b.fall.total_cmp(&a.fall));
    found
}

/// The best of `choices` whose first terms look different.
fn different(mut choices: Vec<Choice>, most: usize) -> Vec<Choice> {
    choices.sort_by(|a, b| b.fall.total_cmp(&a.fall));
    let mut kept: Vec<Choice> = Vec::new();
    for choice in choices {
        let alike = |other: &Choice| {
            let (a, b) = (&choice.columns[0], &other.columns[0]);
            a.dot(b).abs() > ALIKE * a.norm() * b.norm()
        };
        if kept.len() < most && !kept.iter().any(alike) {
            kept.push(choice);
        }
    }
    kept
}

/// What `term` explains, beside `first` where that is given. `None` where it does nothing or both do the same.
fn choose(response: &Response, term: Term, first: Option<&Choice>) -> Option<Choice> {
    let values = response.states().map(|states| term.values(states));
    let column = response.of_values(&values.collect::<Option<Vec<_>>>()?);
    let (fall, amplitudes) = explained(&[&column], &response.residual)?;
    let one = Choice { terms: vec![term], columns: vec![column], amplitudes, fall };
    match first {
        Some(first) => first.and(response, &one),
        None => Some(one),
    }
}

/// Fall of χ² and amplitudes by least squares.
fn explained(columns: &[&DVector<f64>], residual: &DVector<f64>) -> Option<(f64, Vec<f64>)> {
    match *columns {
        [one] => {
            let norm = one.norm_squared();
            let pull = one.dot(residual);
            (norm > 0.0).then(|| (pull * pull / norm, vec![pull / norm]))
        }
        [a, b] => {
            let (aa, bb, ab) = (a.norm_squared(), b.norm_squared(), a.dot(b));
            let own = aa * bb - ab * ab;
            if own <= (1.0 - ALIKE * ALIKE) * aa * bb {
                return None;
            }
            let (ra, rb) = (a.dot(residual), b.dot(residual));
            let (x, y) = ((bb * ra - ab * rb) / own, (aa * rb - ab * ra) / own);
            Some((x * ra + y * rb, vec![x, y]))
        }
        _ => None,
    }
}

/// The numbers of the last term of a choice, that it explains most with.
struct Numbers<'a> {
    response: &'a Response,
    choice: &'a Choice,
    first: Option<&'a Choice>,
    least: Vec<f64>,
    greatest: Vec<f64>,
}

impl Numbers<'_> {
    fn with(&self, numbers: &[f64]) -> Option<Choice> {
        let mut ranges = self.least.iter().zip(&self.greatest);
        let is_outside = |number: &f64| {
            ranges.next().is_some_and(|(least, most)| !(least..=most).contains(&number))
        };
        if numbers.iter().any(is_outside) {
            return None;
        }
        let last = self.choice.terms.last()?;
        // What is searched is what will be written.
        let rounded: Vec<f64> =
            numbers.iter().map(|number| short(*number).parse().unwrap_or(*number)).collect();
        choose(self.response, last.with(&rounded), self.first)
    }
}

impl CostFunction for &Numbers<'_> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, at: &Vec<f64>) -> Result<f64, argmin::core::Error> {
        Ok(self.with(at).map_or(f64::INFINITY, |choice| -choice.fall))
    }
}

fn search(response: &Response, choice: Choice, first: Option<&Choice>) -> Choice {
    /// Of a number, for the first simplex; and the share below which none falls.
    const STEP: f64 = 0.25;
    const LEAST: f64 = 0.4;
    let start = choice.terms.last().map_or_else(Vec::new, Term::numbers);
    if start.is_empty() {
        return choice;
    }
    let least = start.iter().map(|number| LEAST * number).collect();
    let states: Vec<State> = response.states().flatten().copied().collect();
    let greatest = choice.terms.last().map_or_else(Vec::new, |term| term.greatest(&states));
    let numbers = Numbers { response, choice: &choice, first, least, greatest };
    let mut simplex = vec![start.clone()];
    for at in 0..start.len() {
        let mut corner = start.clone();
        corner[at] *= 1.0 + STEP;
        simplex.push(corner);
    }
    let solver = NelderMead::new(simplex);
    let found =
        Executor::new(&numbers, solver).configure(|state| state.max_iters(EVALUATIONS)).run();
    let best = found.ok().and_then(|result| result.state().get_best_param().cloned());
    let better = best.and_then(|best| numbers.with(&best)).filter(|one| one.fall > choice.fall);
    better.unwrap_or(choice)
}

/// The force of `terms` as a formula with one amplitude, and its kind: a friction where it resists everywhere and is there
/// at rest.
fn force(terms: &[Term], amplitudes: &[f64], states: &[State]) -> (String, &'static str) {
    let sum = match (terms, amplitudes) {
        ([one], _) => one.text(),
        ([a, b], [x, y]) => {
            let ratio = y / x;
            let sign = if ratio < 0.0 { "-" } else { "+" };
            format!("({} {sign} {} * {})", a.text(), short(ratio.abs()), b.text())
        }
        _ => String::new(),
    };
    let values: Vec<Vec<f64>> = terms.iter().filter_map(|term| term.values(states)).collect();
    let total = |at: usize| values.iter().zip(amplitudes).map(|(of, q)| q * of[at]).sum::<f64>();
    let resists = (0..states.len()).all(|at| total(at) >= 0.0);
    let needs_motion = terms.iter().all(Term::needs_motion);
    match (needs_motion, resists) {
        (true, _) => (format!("q * rho * g * A * D * {sum}"), "drag"),
        (false, true) => (format!("q * rho * g * A * D * {sum}"), "friction"),
        (false, false) => (format!("q * rho * g * A * D * {sum} * {REST}"), "drag"),
    }
}

fn draft(id: &str, (force, kind): (String, &str), by: &dyn ByFormulas) -> Draft {
    let direction = match kind {
        "friction" => Direction::Friction,
        _ => Direction::AgainstMotion,
    };
    let mut parameters = vec![OwnParameter {
        name: "q".to_owned(),
        dimension: Dimension::NONE,
        value: None,
        range: Range::closed(-MOST, MOST),
    }];
    if uses_millimetres(&force) {
        parameters.push(OwnParameter {
            name: MILLIMETRE.to_owned(),
            dimension: Dimension::LENGTH,
            value: Some(1e-3),
            range: Range::closed(0.0, 1.0),
        });
    }
    let (id, summary) = (id.to_owned(), String::new());
    Draft { id, summary, force, direction, acts: Acts::InBed, parameters, space: by.space() }
}

fn uses_millimetres(force: &str) -> bool {
    force.contains("z / mm")
}
