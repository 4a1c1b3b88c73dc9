//! What a campaign will run: its points, each with the hash of what it is.

use std::collections::{BTreeMap, BTreeSet};
use std::num::NonZero;
use std::path::PathBuf;

use configs::estimate::Estimate;
use configs::{ConfigError, Diagnostic, LoadOptions, Loaded, Model};

use super::file::{Campaign, CampaignModel, Setting};
use crate::run::{bed_key, result_key};
use serde::{Deserialize, Serialize};

use super::sampling::shares;

/// Work of an impact on a resistive medium, in that of grain-steps: some milliseconds.
const RESISTIVE: f64 = 5e4;

/// The points of a campaign, as `points.json` has them.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Plan {
    /// Name of the campaign.
    pub name: String,
    /// Version of the program that planned it.
    pub version: String,
    /// Whether logs stay once a point is done.
    pub keep_logs: bool,
    /// The points, models slowest, then seeds, then what is varied.
    pub points: Vec<Point>,
}

/// One impact of a campaign.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Point {
    /// Which, from 1.
    pub point: usize,
    /// The model as the campaign names it.
    pub model: String,
    /// What is set in it, as `--set` takes it.
    pub set: Vec<String>,
    /// Hash of the resolved model and of the version of the engine, in hexadecimal: equal points are one.
    pub hash: String,
}

/// What a point takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Need {
    /// Key of its bed, if it falls on grains.
    pub bed: Option<[u8; 32]>,
    /// Work (grain-steps) at most: as long as the model may run.
    pub work: f64,
    /// Memory while it runs (byte).
    pub memory: u64,
}

/// A plan with what is needed to run it.
#[derive(Clone, Debug)]
pub struct Planned {
    /// The plan.
    pub plan: Plan,
    /// What each point takes.
    pub needs: Vec<Need>,
    /// What authors of models should look at, each said once.
    pub warnings: BTreeSet<String>,
    models: BTreeMap<String, CampaignModel>,
    allow_paths: Vec<PathBuf>,
}

impl Plan {
    /// How many points are not the same as one before.
    pub(crate) fn n_distinct(&self) -> usize {
        self.points.iter().map(|point| &point.hash).collect::<BTreeSet<_>>().len()
    }
}

impl Planned {
    /// The points of `campaign`, whose models may read data files below `allow_paths`, each read and
    /// checked.
    ///
    /// # Errors
    /// A setting that no model takes, at its place in the campaign, or a model with a list of
    /// conditions of its own.
    pub fn of(campaign: &Campaign, allow_paths: &[PathBuf]) -> Result<Self, ConfigError> {
        check_alone(campaign, allow_paths)?;
        let settings = settings(campaign);
        let seeds: Vec<Option<u64>> = match campaign.seeds.as_slice() {
            [] => vec![None],
            seeds => seeds.iter().copied().map(Some).collect(),
        };
        let mut drafts: Vec<(&CampaignModel, Vec<String>)> = Vec::new();
        for model in &campaign.models {
            for seed in &seeds {
                let seed = seed.map(|seed| format!("run.seed={seed}"));
                drafts.extend(settings.iter().map(|settings| {
                    let set = settings.iter().map(Setting::assignment).chain(seed.clone());
                    (model, set.collect())
                }));
            }
        }
        let checked = side_by_side(&drafts, |(model, set)| {
            let loaded = load(model, set.clone(), allow_paths)?;
            let warnings: Vec<String> =
                loaded.warnings.iter().map(|one| one.message.clone()).collect();
            Ok((hash(&loaded.model), need(&loaded.model), warnings))
        });
        let (mut points, mut needs) = (Vec::with_capacity(drafts.len()), Vec::new());
        let mut warnings = BTreeSet::new();
        for (at, (checked, (model, set))) in checked.into_iter().zip(drafts).enumerate() {
            let (hash, need, told) = checked.map_err(|error| {
                let what = set.join(", ");
                refused(campaign, model, &format!("point {} ({what})", at + 1), &error)
            })?;
            needs.push(need);
            warnings.extend(told);
            points.push(Point { point: at + 1, model: model.name.clone(), set, hash });
        }
        let models = campaign.models.iter().map(|model| (model.name.clone(), model.clone()));
        Ok(Self {
            plan: Plan {
                name: campaign.name.clone(),
                version: env!("CARGO_PKG_VERSION").to_owned(),
                keep_logs: campaign.keep_logs,
                points,
            },
            needs,
            warnings,
            models: models.collect(),
            allow_paths: allow_paths.to_owned(),
        })
    }

    /// The point at `index` of `plan`, alone: what a task needs that runs it, whatever else is planned.
    /// `None` if it is no longer what `campaign` says.
    ///
    /// # Errors
    /// If its model cannot be loaded.
    pub fn of_point(
        campaign: &Campaign,
        plan: Plan,
        index: usize,
        allow_paths: &[PathBuf],
    ) -> Result<Option<Self>, ConfigError> {
        let Some(point) = plan.points.into_iter().nth(index) else { return Ok(None) };
        let model = campaign.models.iter().find(|model| model.name == point.model);
        let Some(model) = model else { return Ok(None) };
        let loaded = load(model, point.set.clone(), allow_paths)?;
        if hash(&loaded.model) != point.hash {
            return Ok(None);
        }
        Ok(Some(Self {
            needs: vec![need(&loaded.model)],
            warnings: loaded.warnings.iter().map(|one| one.message.clone()).collect(),
            models: BTreeMap::from([(model.name.clone(), model.clone())]),
            allow_paths: allow_paths.to_owned(),
            plan: Plan { points: vec![point], ..plan },
        }))
    }

    /// Memory (byte) of the `n` largest points at once.
    pub fn memory(&self, n: usize) -> u64 {
        let mut all: Vec<u64> = self.needs.iter().map(|need| need.memory).collect();
        all.sort_unstable_by(|a, b| b.cmp(a));
        all.into_iter().take(n).fold(0, u64::saturating_add)
    }

    /// The model of the point at `index`.
    ///
    /// # Errors
    /// If a file that it reads is no longer what it was.
    pub fn load(&self, index: usize) -> Result<Loaded, ConfigError> {
        let point = &self.plan.points[index];
        load(&self.models[&point.model], point.set.clone(), &self.allow_paths)
    }
}

/// Key and value of what `--set` takes.
pub fn split(assignment: &str) -> (&str, &str) {
    assignment.split_once('=').unwrap_or((assignment, ""))
}

/// The settings of every point of one model and one seed.
fn settings(campaign: &Campaign) -> Vec<Vec<Setting>> {
    let mut all = vec![campaign.fixed.clone()];
    let mut cross = |choices: &[Vec<Setting>]| {
        let with = |before: &Vec<Setting>| {
            let before = before.clone();
            choices.iter().map(move |more| [&before[..], more].concat())
        };
        all = all.iter().flat_map(with).collect();
    };
    for axis in &campaign.product {
        cross(&axis.values.iter().map(|value| vec![value.clone()]).collect::<Vec<_>>());
    }
    if !campaign.listed.is_empty() {
        cross(&campaign.listed);
    }
    if let Some(sample) = &campaign.sample {
        let point = |shares: Vec<f64>| -> Vec<Setting> {
            sample.ranges.iter().zip(shares).map(|(range, share)| range.at(share)).collect()
        };
        cross(&shares(sample).into_iter().map(point).collect::<Vec<_>>());
    }
    all
}

/// Refuses what a model does not take by itself, where it stands in the campaign.
fn check_alone(campaign: &Campaign, allow_paths: &[PathBuf]) -> Result<(), ConfigError> {
    let product = campaign.product.iter().flat_map(|axis| &axis.values);
    let listed = campaign.listed.iter().flatten();
    let written: Vec<Setting> =
        campaign.fixed.iter().chain(product).chain(listed).cloned().collect();
    let ranges = campaign.sample.iter().flat_map(|sample| &sample.ranges);
    let ends = ranges
        .flat_map(|range| [0.0, 1.0].map(|share| Setting { span: range.span, ..range.at(share) }));
    let all: Vec<Setting> = written.into_iter().chain(ends).collect();
    for model in &campaign.models {
        let plain = load(model, Vec::new(), allow_paths);
        if let Ok(Loaded { model: Model { conditions: Some(_), .. }, .. }) = &plain {
            let message = format!("`{}` lists [conditions], and a point is one impact", model.name);
            return Err(campaign.error(
                Diagnostic::error(message)
                    .at(model.span, "")
                    .help("take the table out of the model, and vary its keys in [product]"),
            ));
        }
        if plain.is_err() {
            // It may need several settings at once; the points say so.
            continue;
        }
        let checked = side_by_side(&all, |setting| {
            load(model, vec![setting.assignment()], allow_paths).map(drop)
        });
        for (setting, checked) in all.iter().zip(checked) {
            if let Err(error) = checked
                && !is_needed_with_others(campaign, setting, model, allow_paths)
            {
                let error = Diagnostic::error(format!(
                    "`{}` is not a setting that {} takes",
                    setting.assignment(),
                    model.name
                ))
                .at(setting.span, "")
                .help(error.to_string().trim_end());
                return Err(campaign.error(error));
            }
        }
    }
    Ok(())
}

/// Whether what is refused alone is accepted at a point that has it.
fn is_needed_with_others(
    campaign: &Campaign,
    setting: &Setting,
    model: &CampaignModel,
    allow_paths: &[PathBuf],
) -> bool {
    let listed = campaign.listed.iter().find(|point| point.contains(setting));
    let listed = listed.or(campaign.listed.first()).into_iter().flatten();
    let product = campaign.product.iter().map(|axis| &axis.values[0]);
    let ranges = campaign.sample.iter().flat_map(|sample| &sample.ranges);
    let drawn: Vec<Setting> = ranges.map(|range| range.at(0.0)).collect();
    let others = campaign.fixed.iter().chain(product).chain(listed).chain(&drawn);
    let others = others.filter(|other| other.key != setting.key);
    let set = others.chain([setting]).map(Setting::assignment).collect();
    load(model, set, allow_paths).is_ok()
}

fn load(
    model: &CampaignModel,
    sets: Vec<String>,
    allow_paths: &[PathBuf],
) -> Result<Loaded, ConfigError> {
    let options = LoadOptions { sets, seed: None, allow_paths: allow_paths.to_owned() };
    Model::load(model.source.clone(), &options)
}

fn refused(
    campaign: &Campaign,
    model: &CampaignModel,
    what: &str,
    error: &ConfigError,
) -> ConfigError {
    let message = format!("{what} is not a model that can be run");
    let error = Diagnostic::error(message).at(model.span, "of this model").help(error.to_string());
    campaign.error(error)
}

fn hash(model: &Model) -> String {
    let key = result_key(&format!("point\n{}", model.hash()));
    key[..16].iter().map(|byte| format!("{byte:02x}")).collect()
}

fn need(model: &Model) -> Need {
    let Some(grains) = model.grains() else {
        return Need { bed: None, work: RESISTIVE, memory: 0 };
    };
    let steps = grains.time_step().map_or(0.0, |step| model.run.duration / step);
    let work = grains.n_grains() as f64 * steps;
    Need { bed: Some(bed_key(grains)), work, memory: Estimate::of(grains).memory_bytes }
}

/// What `of` makes of every one of `things`, in their order, on all cores.
fn side_by_side<T: Sync, R: Send>(things: &[T], of: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let cores = std::thread::available_parallelism().map_or(1, NonZero::get);
    let share = things.len().div_ceil(cores).max(1);
    let of = &of;
    std::thread::scope(|scope| {
        let shares: Vec<_> = things
            .chunks(share)
            .map(|chunk| scope.spawn(move || chunk.iter().map(of).collect::<Vec<R>>()))
            .collect();
        shares
            .into_iter()
            .flat_map(|share| share.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
            .collect()
    })
}
