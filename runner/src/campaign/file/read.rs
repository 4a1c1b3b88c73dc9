//! The tables of a campaign file.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use configs::document::{Node, Table, Value};
use configs::reader::{Answer, Found, Reader, TableReader};
use configs::{Diagnostic, Sources, Span, nearest, shorten};
use configs::{ModelSource, SHIPPED, find_shipped, paths};

use super::settings::{axis, leaves, range, settings};
use super::{Axis, Campaign, CampaignModel, POINTS, Sample, SampleMethod, SampledRange, Setting};

/// What the schema calls the tables that set keys of a model.
pub(super) const SETTINGS: &str = "settings";
pub(super) const AXES: &str = "axes";
pub(super) const RANGES: &str = "ranges";
pub(super) const POINTS_ONE_BY_ONE: &str = "points";

/// The campaign in `root`, or nothing if what is wrong with it leaves none; all of it is reported.
pub(super) fn campaign(
    root: TableReader<'_>,
    folder: &Path,
    allow_paths: &[PathBuf],
) -> Option<Campaign> {
    let reader = root.reader;
    let head = root.table("campaign", Some("name = \"my-campaign\"\nmodels = [\"vertical-2d\"]"));
    let name = head.slug("name", None, "the name of the campaign and of its folder");
    let models = models(&head, folder, allow_paths);
    let seeds = seeds(&head);
    let logs = "whether logs of points stay once the points are done";
    head.asks("keep_logs", logs, || Answer::Boolean);
    let keep_logs = head.boolean("keep_logs", false);
    root.asks("set", "what every point has", || Answer::Defined(SETTINGS));
    let fixed = tables(&root, "set").map(|table| settings(reader, table)).unwrap_or_default();
    root.asks("product", "every value with every other", || Answer::Defined(AXES));
    let product: Vec<Axis> = tables(&root, "product")
        .map(leaves)
        .unwrap_or_default()
        .into_iter()
        .filter_map(|(key, entry)| axis(reader, key, entry))
        .collect();
    let listed = listed(&root);
    let sample = sample(&root);
    head.finish();
    root.finish();
    let campaign = Campaign {
        name: name?.value,
        models: models?,
        seeds: seeds?,
        keep_logs: keep_logs?,
        fixed,
        product,
        listed: listed?,
        sample: sample?,
        sources: Sources::default(),
    };
    refuse_twice(reader, &campaign);
    let n = campaign.n_points();
    if n > POINTS {
        let message = format!("these are {n} points; at most {POINTS} are planned");
        reader.report(Diagnostic::error(message));
    }
    Some(campaign)
}

/// The table `key` of the file, whatever its keys are.
fn tables<'a>(root: &TableReader<'a>, key: &'static str) -> Option<&'a Table> {
    // Reported by the reader if it is no table.
    let _ = root.table(key, None);
    match &root.node(key)?.value {
        Value::Table(table) => Some(table),
        _ => None,
    }
}

fn models(
    head: &TableReader<'_>,
    folder: &Path,
    allow_paths: &[PathBuf],
) -> Option<Vec<CampaignModel>> {
    head.header()?;
    if !head.has("models") {
        head.misses("models");
    }
    let what = "what every point is a change of: files beside this one, or shipped models";
    head.asks("models", what, || Answer::Texts);
    let names = head.raw_texts("models", "vertical-2d")?.unwrap_or_default();
    if names.is_empty() {
        let message = "[campaign] names no model: `models` is what every point is a change of";
        head.reader.report(
            Diagnostic::error(message).at(head.span_of("models").or(head.header()), "").help(
                "write models = [\"vertical-2d\"], with files beside this one or shipped models",
            ),
        );
        return None;
    }
    let mut models: Vec<CampaignModel> = Vec::new();
    let mut all = true;
    for Found { value: name, span } in names {
        let twice = models.iter().any(|model| model.name == name);
        let found = match twice {
            true => Err("this model is named twice".to_owned()),
            false => source(&name, folder, allow_paths),
        };
        match found {
            Ok(source) => models.push(CampaignModel { name, source, span }),
            Err(why) => {
                all = false;
                let message = format!("`{}`: {why}", shorten(&name));
                head.reader.report(Diagnostic::error(message).at(span, "in this campaign"));
            }
        }
    }
    all.then_some(models)
}

/// The text of the model that a campaign in `folder` calls `name`.
fn source(name: &str, folder: &Path, allow_paths: &[PathBuf]) -> Result<ModelSource, String> {
    let source = match (folder.join(name).is_file(), find_shipped(name)) {
        (false, Some(shipped)) => ModelSource::Shipped(shipped),
        (false, None) => {
            let near = nearest(name, SHIPPED.iter().map(|shipped| shipped.name));
            let hint = near.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
            return Err(format!("there is no such file, and no shipped model of that name{hint}"));
        }
        (true, _) => {
            let path = paths::resolve(name, folder, allow_paths);
            ModelSource::Path(path.map_err(|error| error.to_string())?)
        }
    };
    source.into_text().map_err(|error| error.to_string())
}

/// `seeds = 3` for 1, 2, 3, or a list.
fn seeds(head: &TableReader<'_>) -> Option<Vec<u64>> {
    let what = "in place of run.seed of each model: a list, or a number for 1, 2, and so on";
    head.asks("seeds", what, || Answer::Integers(1..=POINTS as u64));
    let Some(node) = head.node("seeds") else { return Some(Vec::new()) };
    let number = |value: &Value| match value {
        Value::Integer(number) => u64::try_from(*number).ok(),
        _ => None,
    };
    let found = match &node.value {
        Value::Integer(count) => {
            let count =
                u64::try_from(*count).ok().filter(|count| (1..=POINTS as u64).contains(count));
            count.map(|count| (1..=count).collect())
        }
        Value::Array(nodes) => {
            let seeds: Option<Vec<u64>> = nodes.iter().map(|node| number(&node.value)).collect();
            // A seed that is named twice would count one result twice.
            let are_distinct = |seeds: &Vec<u64>| {
                seeds.iter().collect::<BTreeSet<_>>().len() == seeds.len() && !seeds.is_empty()
            };
            seeds.filter(are_distinct)
        }
        _ => None,
    };
    if found.is_none() {
        head.reader.report(
            Diagnostic::error("`seeds` is neither a number of seeds nor a list of different ones")
                .at(node.span, "")
                .help("write seeds = 3 for 1, 2 and 3, or seeds = [7, 11]"),
        );
    }
    found
}

fn listed(root: &TableReader<'_>) -> Option<Vec<Vec<Setting>>> {
    // What stands there is read whole, so its keys are not asked for one by one.
    root.asks("point", "points one by one", || Answer::Defined(POINTS_ONE_BY_ONE));
    let Some(node) = root.node("point") else { return Some(Vec::new()) };
    let of_point = |node: &Node| match &node.value {
        Value::Table(table) => Some(settings(root.reader, table)),
        _ => None,
    };
    let found: Option<Vec<_>> = match &node.value {
        Value::Array(nodes) => nodes.iter().map(of_point).collect(),
        _ => None,
    };
    if found.is_none() {
        root.reader.report(
            Diagnostic::error("`point` is a list of tables")
                .at(node.span, format!("this is {}", node.value.kind()))
                .help("write [[point]], in double brackets, and the keys of a model below it"),
        );
    }
    found
}

fn sample(root: &TableReader<'_>) -> Option<Option<Sample>> {
    if !root.has("sample") {
        return Some(None);
    }
    let table = root.table("sample", None);
    let names = SampleMethod::ALL.map(|(name, _)| name);
    let method = table.choice("method", &names, &[], "how points are drawn");
    let method = method.and_then(|name| SampleMethod::ALL.into_iter().find(|one| one.0 == name));
    let most = method.map_or(POINTS, |(_, method)| method.most_points());
    let count = table.integer("count", None, 1..=most as u64, "how many points are drawn");
    let seed = table.integer("seed", Some(1), 0..=u64::MAX >> 1, "what the draw starts from");
    table.asks("ranges", "what is drawn", || Answer::Defined(RANGES));
    let ranges: Vec<SampledRange> = tables(&table, "ranges")
        .map(leaves)
        .unwrap_or_default()
        .into_iter()
        .filter_map(|(key, entry)| range(table.reader, key, entry))
        .collect();
    if ranges.is_empty() && !table.reader.failed() {
        table.reader.report(
            Diagnostic::error("[sample] has nothing to draw from")
                .at(table.header(), "")
                .help("write [sample.ranges]\nimpact.speed = [\"1 m/s\", \"4 m/s\"]"),
        );
    }
    table.finish();
    let (_, method) = method?;
    Some(Some(Sample { method, count: count?.value as usize, seed: seed?.value, ranges }))
}

/// A key that is set in two ways would be what the last of them says.
fn refuse_twice(reader: &Reader<'_>, campaign: &Campaign) {
    let mut first: BTreeMap<&str, Option<Span>> = BTreeMap::new();
    let mut take = |key, span: Option<Span>| {
        if let Some(earlier) = first.insert(key, span) {
            let message = format!("`{}` is set in two ways", shorten(key));
            reader.report(
                Diagnostic::error(message).at(span, "again here").with(earlier, "first here"),
            );
        }
    };
    if !campaign.seeds.is_empty() {
        take("run.seed", None);
    }
    campaign.fixed.iter().for_each(|one| take(&one.key, one.span));
    campaign.product.iter().for_each(|axis| take(&axis.key, axis.values[0].span));
    let mut listed: BTreeMap<&str, Option<Span>> = BTreeMap::new();
    for setting in campaign.listed.iter().flatten() {
        listed.entry(&setting.key).or_insert(setting.span);
    }
    listed.into_iter().for_each(|(key, span)| take(key, span));
    let ranges = campaign.sample.iter().flat_map(|sample| &sample.ranges);
    ranges.for_each(|range| take(&range.key, range.span));
}
