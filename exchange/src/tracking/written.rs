//! The files of an imported set.

use std::fmt::Write as _;
use std::path::Path;

use configs::toml_string as quoted;
use engine::units::{Dimension, significant};
use measurements::{Reading, median};

use super::bodies::Body;
use super::days;
use super::fault::Fault;
use super::options::Options;
use super::run::Run;
use super::settings::Settings;
use super::surface::{LEAST, Level};

/// Relative difference below which speeds count as equal.
const ROUNDING: f64 = 1e-9;

/// What is written.
pub(super) struct Known<'a> {
    pub(super) options: &'a Options,
    pub(super) settings: &'a Settings<'a>,
    pub(super) level: &'a Level,
    pub(super) runs: &'a [Run],
    pub(super) out: &'a Path,
}

/// Names and contents of the set itself.
///
/// # Errors
/// If an option of the bed is not a quantity.
pub(super) fn files(
    known: &Known<'_>,
    notes: &[String],
) -> Result<Vec<(&'static str, String)>, Fault> {
    Ok(vec![
        ("measurement.toml", measurement(known, notes)?),
        ("runs.csv", runs(known)),
        ("trajectories.csv", trajectories(known)),
    ])
}

/// Conditions in the order of their first runs.
fn conditions<'a>(known: &Known<'a>) -> Vec<(&'a str, Vec<&'a Run>)> {
    let mut all: Vec<(&str, Vec<&Run>)> = Vec::new();
    for run in known.runs {
        match all.iter_mut().find(|(id, _)| *id == run.condition) {
            Some((_, own)) => own.push(run),
            None => all.push((&run.condition, vec![run])),
        }
    }
    all
}

fn measurement(known: &Known<'_>, notes: &[String]) -> Result<String, Fault> {
    let Known { options, settings, level, runs, out } = known;
    let conditions = conditions(known);
    let mut text = String::new();
    let mut line = |words: String| text.push_str(&format!("{words}\n"));
    let (n, noun) = (runs.len(), if runs.len() == 1 { "run" } else { "runs" });
    line(format!(
        "# Made by `plunge import` from {n} {noun}; import.toml makes it again. Correct what you know better."
    ));
    notes.iter().for_each(|note| line(format!("# {note}")));
    line("\nschema = 1\n\n[measurement]".to_owned());
    line(format!("id = {}", quoted(&id(options, out))));
    line("kind = \"trajectory\"".to_owned());
    line("source = \"tables of a tracking program, read by plunge import\"".to_owned());
    line("\n[instrument]".to_owned());
    let of = |number: fn(&Run) -> f64| median(runs.iter().map(number)).unwrap_or(0.0);
    let step = of(|run| run.step);
    if runs.iter().all(|run| (run.step / step - 1.0).abs() < 0.01) {
        line(format!("rate_hz = {:<18} # by the steps between frames", in_toml(1.0 / step, 5)));
    }
    let noise = of(|run| run.noise);
    line(format!(
        "position_sigma_m = {:<9} # by what readings differ from a smooth path",
        in_toml(noise, 2)
    ));
    if let Some(scatter) = speed_scatter(&conditions) {
        line(format!(
            "speed_sigma_rel = {:<10} # of one run, by its fit or by the scatter within conditions",
            in_toml(scatter, 2)
        ));
    }
    if let Some(scatter) = angle_scatter(&conditions) {
        line(format!(
            "angle_sigma_deg = {:<10} # of one run, by its fit or by the scatter within conditions",
            in_toml(scatter, 2)
        ));
        line("angle_bias_sigma_deg = 0.0    # they are read from the paths".to_owned());
    }
    let (surface, by) = match level {
        Level::Stated(error) => (*error, "as it is stated"),
        Level::Common(level) => (level.se, "the one level of all runs, by their contacts"),
        Level::Own(shared) => (*shared, "what the levels of all runs share, by their contacts"),
    };
    line(format!("surface_sigma_m = {:<10} # of {by}", in_toml(surface, 2)));
    line(format!(
        "level_sigma_m = {:<12} # of one run against the others",
        in_toml(of(|run| run.touch.level_error).max(LEAST), 2)
    ));
    line("\n[bed]".to_owned());
    let is_planar = runs.iter().any(|run| run.body.is_planar());
    if is_planar {
        line("geometry = \"2d\"".to_owned());
    }
    line(format!("gravity = {:?}", settings.gravity));
    let density = if is_planar { Dimension::AREA_DENSITY } else { Dimension::DENSITY };
    let example = if is_planar { "20 kg/m^2" } else { "1.5 g/cc" };
    for (key, dimension, example) in
        [("bulk_density", density, example), ("grain_diameter", Dimension::LENGTH, "0.8 mm")]
    {
        match settings.quantity(key, dimension, &[])? {
            Some(value) => line(format!("{key} = {value:?}")),
            None => line(format!("# {key} = \"{example}\"  # not known")),
        }
    }
    line("\n[model]\nbaseline = \"two-term-vector\"".to_owned());
    line("\n[files]\nruns = \"runs.csv\"\ntrajectories = \"trajectories.csv\"".to_owned());
    line("delimiter = \",\"\ndecimal = \".\"".to_owned());
    line("\n# Without `role` each condition is left out in turn; role = \"holdout\" never lets one be fitted to.".to_owned());
    if options.get("bed_depth").is_none() {
        line("# With bed_depth = \"14 cm\" in each, which --bed-depth writes, an effect of the bottom can be found.".to_owned());
    }
    for (id, own) in &conditions {
        let speed = Reading::mean(own.iter().map(|run| run.speed));
        let from = match options.get("drop_height") {
            Some(_) => "from the height of release".to_owned(),
            None => format!(
                "± {}, from the frames before contact of {} {}",
                in_toml(speed.se, 2),
                own.len(),
                if own.len() == 1 { "run" } else { "runs" }
            ),
        };
        let angle = own.iter().map(|run| run.angle.value).sum::<f64>() / own.len() as f64;
        line(format!("\n[[condition]]\nid = {}", quoted(id)));
        line(format!("speed = {}  # {from}", in_toml(speed.value, 5)));
        line(format!("angle_deg = {}", in_toml(angle, 4)));
        body(&own[0].body, &mut line);
        if let Some(depth) = settings.quantity("bed_depth", Dimension::LENGTH, &own[0].labels)? {
            line(format!("bed_depth = {depth:?}"));
        }
    }
    Ok(text)
}

fn body(body: &Body, line: &mut impl FnMut(String)) {
    line(format!("shape = {}", quoted(&body.shape)));
    line(format!("diameter = {:?}", body.diameter));
    line(format!("mass = {:?}", body.mass));
    if let Some(height) = body.height {
        line(format!("height = {height:?}"));
    }
    if let Some(apex) = body.apex {
        line(format!("apex_deg = {apex:?}"));
    }
    if let Some(shaft) = body.shaft_diameter {
        line(format!("shaft_diameter = {shaft:?}"));
    }
}

fn runs(known: &Known<'_>) -> String {
    let mut text = String::from(
        "# contact: on the clock of the table (s); level: that of the surface on its axis (m)\n",
    );
    for run in known.runs {
        let _ = writeln!(
            text,
            "# {}: {}, contact {:.6} ± {:.6}, level {:.6}, speed {:.4} ± {:.4} m/s",
            run.name.escape_debug(),
            run.file.escape_debug(),
            run.touch.time.value,
            run.touch.time.se,
            run.sign * run.touch.level.value,
            run.speed.value,
            run.speed.se
        );
    }
    let has_order = known.runs.iter().all(|run| label(run, "order").is_some());
    let sessions = days::sessions(known.runs);
    let has_session = sessions.is_some();
    let is_written = [true, true, true, has_order, has_session];
    let mut rows = vec![["run", "condition", "repeat", "order", "session"].map(str::to_owned)];
    let mut counts: Vec<(&str, i64)> = Vec::new();
    for (place, run) in known.runs.iter().enumerate() {
        let at = counts.iter().position(|(id, _)| *id == run.condition).unwrap_or_else(|| {
            counts.push((&run.condition, 0));
            counts.len() - 1
        });
        counts[at].1 += 1;
        let repeat = label(run, "repeat").unwrap_or(counts[at].1).to_string();
        let order = label(run, "order").map_or(String::new(), |order| order.to_string());
        let session = sessions.as_ref().map_or(String::new(), |all| all[place].clone());
        rows.push([run.name.clone(), run.condition.clone(), repeat, order, session]);
    }
    let written = |row: &[String; 5]| -> Vec<String> {
        row.iter().zip(is_written).filter(|(_, is)| *is).map(|(cell, _)| cell.clone()).collect()
    };
    text.push_str(&table(rows.iter().map(written)));
    text
}

fn label(run: &Run, key: &str) -> Option<i64> {
    run.labels.iter().find(|(name, _)| name == key)?.1.trim().parse().ok()
}

fn trajectories(known: &Known<'_>) -> String {
    let is_oblique = known.runs.iter().any(|run| run.angle.value < 90.0);
    let columns = if is_oblique { 4 } else { 3 };
    let names = ["run", "t", "z", "x"].map(str::to_owned)[..columns].to_vec();
    let rows = known.runs.iter().flat_map(|run| {
        run.frames.iter().map(move |frame| {
            // Tenths of a micrometre and of a microsecond are finer than any camera.
            let [t, z, x] = [frame.t, frame.z, frame.x].map(|value| format!("{:.7}", value + 0.0));
            [run.name.clone(), t, z, x][..columns].to_vec()
        })
    });
    table(std::iter::once(names).chain(rows))
}

/// Rows as CSV; names with commas are quoted, and those that begin like a comment.
fn table(rows: impl Iterator<Item = Vec<String>>) -> String {
    let mut writer = csv::WriterBuilder::new().comment(Some(b'#')).from_writer(Vec::new());
    for row in rows {
        // Memory takes all that is written to it.
        let _ = writer.write_record(&row);
    }
    writer
        .into_inner()
        .map(|bytes| String::from_utf8_lossy(&bytes).into_owned())
        .unwrap_or_default()
}

/// The name of the set: as asked, else that of its folder.
fn id(options: &Options, out: &Path) -> String {
    let folder = std::path::absolute(out).ok();
    let folder = folder.as_deref().and_then(Path::file_name);
    let name = match (options.get("id"), folder) {
        (Some(id), _) => id.to_owned(),
        (None, Some(folder)) => folder.to_string_lossy().into_owned(),
        (None, None) => "my-drops".to_owned(),
    };
    let fits = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-' || c == '_';
    let slug: String =
        name.to_lowercase().chars().map(|c| if fits(c) { c } else { '-' }).take(64).collect();
    match slug.trim_matches('-') {
        "" => "my-drops".to_owned(),
        slug => slug.to_owned(),
    }
}

/// Scatter of the speeds of runs within `conditions`, relative, or the errors of their fits where those are larger.
fn speed_scatter(conditions: &[(&str, Vec<&Run>)]) -> Option<f64> {
    let error = |run: &Run| {
        let share = run.touch.own_speed_error / run.touch.sinking.se;
        share * run.speed.se / run.speed.value
    };
    let errors = conditions.iter().flat_map(|(_, own)| own).map(|run| error(run));
    let from_mean = |value: f64, mean: f64| value / mean - 1.0;
    let scatter = scatter_within(conditions, |run| run.speed.value, from_mean);
    let error = scatter.max(median(errors).unwrap_or(0.0));
    // Speeds from one stated height differ only by rounding.
    (error > ROUNDING).then_some(error)
}

/// The same of the angles (deg) of oblique impacts; `None` if all are straight.
fn angle_scatter(conditions: &[(&str, Vec<&Run>)]) -> Option<f64> {
    let is_oblique = |own: &[&Run]| own.iter().any(|run| run.angle.se > 0.0);
    let oblique: Vec<_> = conditions.iter().filter(|(_, own)| is_oblique(own)).cloned().collect();
    let errors = oblique.iter().flat_map(|(_, own)| own).map(|run| run.angle.se);
    let fit = median(errors)?;
    Some(fit.max(scatter_within(&oblique, |run| run.angle.value, |value, mean| value - mean)))
}

/// Standard deviation of a number within `conditions`, by its difference from their means; 0 where too few are repeated.
fn scatter_within(
    conditions: &[(&str, Vec<&Run>)],
    number: impl Fn(&Run) -> f64,
    from_mean: impl Fn(f64, f64) -> f64,
) -> f64 {
    let (mut sum, mut freedom) = (0.0, 0.0);
    for (_, own) in conditions {
        let n = own.len() as f64;
        let mean = own.iter().map(|run| number(run)).sum::<f64>() / n;
        sum += own.iter().map(|run| from_mean(number(run), mean).powi(2)).sum::<f64>();
        freedom += n - 1.0;
    }
    if freedom >= 3.0 { f64::sqrt(sum / freedom) } else { 0.0 }
}

/// A number with so many significant digits, as TOML has it.
fn in_toml(value: f64, digits: usize) -> String {
    format!("{:?}", significant(value, digits))
}
