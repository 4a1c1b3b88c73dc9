//! The course of a run, thinned to what figures show.

use std::path::Path;

use configs::{Intruder, LoadOptions, Model, ModelSource};
use exchange::read::{BodyState, BodyStates, Closing, EnergyBudgets, Keep, ReadError, read_run};
use exchange::run_files::RunFiles;

use super::sparkline::sparkline;
use super::thin::places;
use crate::scene::Forces;

/// Most samples of a curve.
const SAMPLES: usize = 320;

/// Where the bodies of a run were and where its energy was, over time.
#[derive(Clone, Debug)]
pub struct Course {
    /// The bodies, each at its own times.
    pub(super) bodies: Vec<BodyStates>,
    /// The energy budget; none if the log has none.
    pub(super) energy: Option<EnergyBudgets>,
    /// The forces of the ground.
    pub(super) forces: Forces,
    /// Whether the log is whole.
    pub(super) complete: bool,
    /// The body of the model beside the log, if there is one.
    pub(super) body: Option<Body>,
}

/// The body of a model.
#[derive(Clone, Debug)]
pub(super) struct Body {
    /// Of its model.
    pub(super) model_hash: String,
    /// Its shape, size and mass.
    pub(super) words: String,
    /// Whether its motion is that of a tip.
    pub(super) has_tip: bool,
}

impl Body {
    /// Of the model in `folder`, which wrote a run there.
    fn in_folder(folder: &Path) -> Option<Self> {
        let file = folder.join("model.toml");
        let source = file.is_file().then_some(ModelSource::Path(file))?;
        let model = Model::load(source, &LoadOptions::default()).ok()?.model;
        let Intruder { shape, params, mass, .. } = &model.intruder;
        let sizes = params.iter().filter(|(key, _)| ["diameter", "height", "length"].contains(key));
        let sizes = sizes.map(|(key, size)| format!("{key} {} mm", plots::short(1e3 * size)));
        let mass = format!("mass {} g", plots::short(1e3 * mass));
        let words: Vec<String> = sizes.chain([mass]).collect();
        let has_tip = shape.links.is_some();
        let shape = shape.name.replace('-', " ");
        let words = format!("a {shape} ({})", words.join(", "));
        Some(Self { model_hash: model.hash(), words, has_tip })
    }
}

impl Course {
    /// Of `run`, a folder or a log.
    ///
    /// # Errors
    /// If its log cannot be read.
    pub fn read(run: &Path) -> Result<Self, ReadError> {
        let file = RunFiles::so_far(run).log;
        let log = read_run(&file, Keep::All)?;
        Ok(Self {
            bodies: log.bodies.iter().map(thinned).collect(),
            energy: log.energy.as_ref().map(thinned_budget),
            forces: Forces::of(&log.loads),
            complete: log.complete,
            body: file.parent().and_then(Body::in_folder),
        })
    }

    /// How far the log goes (s); `None` if no body moves yet.
    pub(super) fn end(&self) -> Option<f64> {
        self.bodies
            .iter()
            .filter_map(|body| body.states.last())
            .map(|state| state.time)
            .reduce(f64::max)
    }

    /// The state of the first body at the sample nearest to `time` (s).
    pub(super) fn first_at(&self, time: f64) -> Option<&BodyState> {
        let states = &self.bodies.first()?.states;
        let after =
            states.partition_point(|state| state.time < time).min(states.len().checked_sub(1)?);
        let before = after.saturating_sub(1);
        let off = |at: usize| (states[at].time - time).abs();
        states.get(if off(before) < off(after) { before } else { after })
    }

    /// Depth and speed of the first body over time, each as a line of `width` characters.
    pub fn sparklines(&self, width: usize) -> [String; 2] {
        let states = self.bodies.first().map_or(&[][..], |body| &body.states);
        let line = |of: fn(&BodyState) -> f64| {
            let points: Vec<(f64, f64)> = states.iter().map(|one| (one.time, of(one))).collect();
            sparkline(&points, width)
        };
        [line(|one| one.depth.max(0.0)), line(|one| one.velocity.norm())]
    }
}

fn thinned(body: &BodyStates) -> BodyStates {
    let times: Vec<f64> = body.states.iter().map(|state| state.time).collect();
    let states = places(&times, SAMPLES).into_iter().map(|place| body.states[place]).collect();
    BodyStates { name: body.name.clone(), states }
}

fn thinned_budget(budget: &EnergyBudgets) -> EnergyBudgets {
    let places = places(&budget.time, SAMPLES);
    let of = |series: &[f64]| places.iter().map(|&place| series[place]).collect();
    EnergyBudgets {
        terms: budget.terms.clone(),
        time: of(&budget.time),
        values: budget.values.iter().map(|series| of(series)).collect(),
        closing: budget.closing.as_ref().map(|closing| Closing {
            unaccounted: of(&closing.unaccounted),
            closure: of(&closing.closure),
        }),
    }
}
