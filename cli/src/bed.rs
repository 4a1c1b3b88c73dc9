//! `plunge bed`: prepares the bed of a model into the cache.

use std::path::PathBuf;

use engine::bed::BedReport;
use engine::grain_bed::RestingBed;
use runner::run::{BedSummary, Control as _};
use serde_json::json;

use crate::common::Common;
use crate::control::Terminal;
use crate::output::{self, CommandError, CommandResult};

/// Arguments of `plunge bed`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// A model file, or the name of a shipped model.
    model: PathBuf,
    #[command(flatten)]
    common: Common,
}

pub(crate) fn run(args: &Args) -> CommandResult {
    prepared(args).map(drop)
}

/// Prepares the bed, says what `plunge bed` says of it, and gives it.
pub(crate) fn prepared(args: &Args) -> Result<RestingBed, CommandError> {
    let common = &args.common;
    let model = common.load(&args.model)?.model;
    let grains = model.grains().ok_or_else(|| {
        let kind = model.medium.kind();
        CommandError::bad_input(format!("a medium of the kind \"{kind}\" has no bed to prepare"))
    })?;
    let mut terminal = Terminal::new(common.quiet);
    let bed = common.prepared(grains, &mut terminal)?;
    let report = BedReport::of(&grains.bed(&bed.resting));
    let summary = BedSummary::new(&report, bed.cache, grains);
    for warning in &summary.warnings {
        terminal.warn(warning);
    }
    if common.json {
        let mut object = json!(summary);
        // Not the path itself: one that is not UTF-8 cannot be encoded.
        object["path"] = json!(bed.path.as_ref().map(|path| path.to_string_lossy()));
        object["mean_diameter_m"] = json!(report.mean_diameter);
        output::json_to_stdout(&object)?;
        return Ok(bed.resting);
    }
    let inside = report
        .packing_fraction_inside
        .map_or(String::new(), |inside| format!(", {inside:.4} away from walls and surface"));
    let place = match (bed.cache, &bed.path) {
        ("hit", Some(path)) => format!("cached in {}", path.display()),
        (_, Some(path)) => format!("prepared into {}", path.display()),
        (_, None) => "read from its table".to_owned(),
    };
    output::to_stdout(&format!(
        "{name}: {place}\n\n  \
         grains            {grains}\n  \
         packing fraction  {fraction:.4} over width and mean height{inside}\n  \
         height            {height:.4} m, {diameters:.1} mean grain diameters\n  \
         coordination      {coordination:.3} contacts per grain\n",
        name = model.run.name,
        grains = report.grains,
        fraction = report.packing_fraction,
        height = report.height,
        diameters = report.height / report.mean_diameter,
        coordination = report.coordination,
    ))?;
    Ok(bed.resting)
}
