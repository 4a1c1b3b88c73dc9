//! The report of one run: where the intruder went, and where its energy went.

mod course;
mod crater;
mod energy;
mod impact;
mod pair;
mod path;
mod player;
mod push;
mod sparkline;
mod thin;

use std::time::Duration;

use runner::run::{BedSummary, ForceSummary, LinkSummary, StopSummary, Summary};

pub use course::Course;
pub use impact::Seen;
pub(crate) use pair::page as pair_page;
pub use pair::picture as pair_picture;
pub use sparkline::sparkline;

use crate::ReportError;
use crate::figure::panel;
use crate::numbers::{fixed, share, with_prefix};
use crate::page::{Number, Page, Part, Section};
use crate::tables::Table;

/// The page of the run that `summary`, `course` and `seen` are of.
pub fn page(summary: &Summary, course: &Course, seen: &Seen) -> Result<String, ReportError> {
    let sections = [
        Section::new("Impact", impact::parts(seen, course)?),
        Section::new("Motion and force", motion(summary, course, seen)?),
        Section::new("Energy", energy_section(summary, course)?),
        Section::new("Links", links(&summary.links)),
        Section::new("Bed", bed(summary.bed.as_ref())),
        Section::new("Terms", vec![Part::Terms(terms(summary))]),
    ];
    let page = Page {
        title: summary.name.clone(),
        kind: "run",
        lead: lead(summary, course),
        headline: match &summary.intrusion {
            Some(push) => push::headline(summary, push),
            None => headline(summary, course),
        },
        sections: sections.into_iter().flatten().collect(),
        origin: origin(&summary.version, &summary.model_hash),
    };
    page.html()
}

/// The page of the run called `name` that has not ended: as far as `course` and `seen` go.
pub(crate) fn page_so_far(name: &str, course: &Course, seen: &Seen) -> Result<String, ReportError> {
    let panels = panels_of(&path::pictures(course, None)?);
    let motion = (!panels.is_empty()).then_some(Part::Panels(panels));
    let budget = energy::Budget::of(course);
    let energy = budget.map(|budget| Ok(Part::Panels(panels_of(&energy::pictures(&budget)?))));
    let sections = [
        Section::new("Impact", impact::parts(seen, course)?),
        Section::new("Motion and force", motion.into_iter().collect()),
        Section::new("Energy", energy.into_iter().collect::<Result<_, ReportError>>()?),
    ];
    let at_end = course.end().and_then(|time| Some((time, course.first_at(time)?)));
    let headline = at_end.map_or(Vec::new(), |(time, state)| {
        vec![
            Number::new("time so far", format!("{:.1} ms", 1e3 * time), "since contact"),
            Number::new("depth", format!("{:.2} mm", 1e3 * state.depth), ""),
            Number::new("speed", format!("{:.3} m/s", state.velocity.norm()), ""),
        ]
    });
    let page = Page {
        title: name.to_owned(),
        kind: "run so far",
        lead: "This run has not ended: the page goes as far as its logs do.".to_owned(),
        headline,
        sections: sections.into_iter().flatten().collect(),
        origin: Vec::new(),
    };
    page.html()
}

/// The page in place of that of a run without one, and `why`; a browser asks again `every` so often.
///
/// # Errors
/// If the page cannot be written.
pub fn page_of_none(why: &ReportError, every: Duration) -> Result<String, ReportError> {
    let again = format!(
        "A run has no log before its bed has settled. This page asks again every {} s.",
        every.as_secs()
    );
    let page = Page {
        title: "No page yet".to_owned(),
        kind: "run so far",
        lead: again,
        headline: Vec::new(),
        sections: Section::new("Reason", vec![Part::Text(why.to_string())]).into_iter().collect(),
        origin: Vec::new(),
    };
    page.html()
}

/// Where a page is from.
pub(crate) fn origin(version: &str, model_hash: &str) -> Vec<(&'static str, String)> {
    vec![("plunge", version.to_owned()), ("model", model_hash.to_owned())]
}

fn panels_of(pictures: &[(String, String)]) -> Vec<(String, String)> {
    pictures.iter().map(|(svg, caption)| panel(svg, caption)).collect()
}

fn lead(summary: &Summary, course: &Course) -> String {
    let pushed = summary.intrusion.as_ref();
    let ground = match (&summary.bed, pushed) {
        (Some(bed), Some(_)) => format!("into a bed of {} grains", bed.grains),
        (Some(bed), None) => format!("onto a bed of {} grains", bed.grains),
        (None, _) => "into a resistive medium".to_owned(),
    };
    let body = course.body.as_ref().filter(|body| body.model_hash == summary.model_hash);
    let of = body.map_or(String::new(), |body| format!(" of {}", body.words));
    let (speed, angle) = (summary.impact.speed_m_per_s, summary.impact.angle_deg);
    let how = format!("at {speed} m/s, {angle}\u{b0} from the horizontal");
    match pushed {
        Some(push) => {
            let depth = plots::short(1e3 * push.to_depth_m);
            format!("A push{of} {ground} to a depth of {depth} mm, {how} all the way.")
        }
        None => format!("An impact{of} {how}, {ground}."),
    }
}

fn headline(summary: &Summary, course: &Course) -> Vec<Number> {
    let StopSummary { stopped, stopping_time_s, stopping_time_z_s, stopping_time_x_s, .. } =
        summary.stop;
    let milliseconds = |time: Option<f64>| match time {
        Some(time) => format!("{:.1} ms", 1e3 * time),
        None => "not reached".to_owned(),
    };
    let horizontal = match stopping_time_x_s {
        Some(time) if time <= 0.0 => "no motion sideways at contact".to_owned(),
        time => format!("horizontal {}", milliseconds(time)),
    };
    let components = format!("vertical {}, {horizontal}", milliseconds(stopping_time_z_s));
    let depth_note = if stopped { "" } else { "still moving at the end" };
    let has_tip = course.body.as_ref().is_some_and(|body| body.has_tip);
    let range_note = if has_tip { "of the tip, until it stops moving sideways" } else { "" };
    let energy = &summary.energy;
    vec![
        Number::new("depth", format!("{:.2} mm", 1e3 * summary.stop.depth_m), depth_note),
        Number::new("range", format!("{:.2} mm", 1e3 * summary.stop.range_m), range_note),
        Number::new("stopping time", milliseconds(stopping_time_s), components),
        Number::new("at rest after", milliseconds(summary.stop.rest_time_s), ""),
        Number::new("energy at impact", with_prefix(energy.initial, "J"), ""),
        Number::new(
            "closure",
            share(energy.closure),
            "largest energy unaccounted for, over that at impact",
        ),
    ]
}

fn motion(summary: &Summary, course: &Course, seen: &Seen) -> Result<Vec<Part>, ReportError> {
    let mut panels = path::pictures(course, summary.stop.stopping_time_s)?;
    if let Some(over_depth) = summary.intrusion.as_ref().map(push::picture).transpose()?.flatten() {
        panels.insert(0, over_depth);
    }
    panels.extend(impact::crater(seen)?);
    let mut parts = vec![Part::Panels(panels_of(&panels))];
    if !course.complete {
        parts.push(Part::Text("The log is cut: curves go as far as it does.".to_owned()));
    }
    // At a set speed no part of the force overtakes the other, and nothing stops.
    let forces = summary.forces.as_ref().filter(|_| summary.intrusion.is_none());
    parts.extend(forces.map(|forces| Part::Text(forces_text(forces))));
    Ok(parts)
}

fn forces_text(forces: &ForceSummary) -> String {
    let newton = |force| match force {
        Some(force) => with_prefix(force, "N"),
        None => "not known".to_owned(),
    };
    let overtakes = match forces.static_overtakes_s {
        Some(time) => format!("Friction becomes the larger part of the force after {time:.4} s"),
        None => "Friction never becomes the larger part of the force".to_owned(),
    };
    let (whole, friction) = (newton(forces.force_at_stop), newton(forces.static_at_stop));
    format!("{overtakes}; at the stop the force is {whole}, of which {friction} is friction.")
}

fn energy_section(summary: &Summary, course: &Course) -> Result<Vec<Part>, ReportError> {
    let mut parts = Vec::new();
    if let Some(budget) = energy::Budget::of(course) {
        parts.push(Part::Panels(panels_of(&energy::pictures(&budget)?)));
    }
    let shares = summary.energy.shares();
    let mut table = Table::new(&["", "energy", "of what was supplied"]);
    let mut row = |name: String, value: f64| {
        let share = shares.percent(value);
        let share = share.map_or(String::new(), |share| format!("{share:.2} %"));
        table.rows.push(vec![name, with_prefix(value, "J"), share]);
    };
    for (name, energy) in &shares.sources {
        row(format!("supplied: {name}"), *energy);
    }
    for (name, energy) in &shares.uses {
        row(name.clone(), *energy);
    }
    if let Some(unaccounted) = shares.unaccounted {
        row("unaccounted for".to_owned(), unaccounted);
    }
    parts.push(Part::Table(table));
    Ok(parts)
}

fn links(links: &[LinkSummary]) -> Vec<Part> {
    if links.is_empty() {
        return Vec::new();
    }
    let head = ["link", "contact (s)", "stops after (s)", "depth (mm)", "given (J)", "of all (%)"];
    let mut table = Table::new(&head);
    for (index, link) in links.iter().enumerate() {
        table.rows.push(vec![
            (index + 1).to_string(),
            fixed(link.contact_s, 4),
            fixed(link.stopping_time_s, 4),
            fixed(Some(1e3 * link.depth_m), 2),
            format!("{:.4e}", link.given),
            fixed(link.given_share.map(|share| 100.0 * share), 1),
        ]);
    }
    vec![Part::Table(table)]
}

fn bed(bed: Option<&BedSummary>) -> Vec<Part> {
    let Some(bed) = bed else { return Vec::new() };
    let mut table = Table::new(&["", ""]);
    let mut row = |name: &str, value: String| table.rows.push(vec![name.to_owned(), value]);
    row("grains", bed.grains.to_string());
    row("packing fraction", format!("{:.4}", bed.packing_fraction));
    row("height", format!("{:.1} mm", 1e3 * bed.height_m));
    row("coordination", format!("{:.2}", bed.coordination));
    if let Some(activity) = &bed.activity {
        row("largest share in motion", format!("{:.1} %", 100.0 * activity.largest_moving_share));
        if let Some(time) = activity.dissipation_time_s {
            row("time to dissipate its motion", format!("{:.1} ms", 1e3 * time));
        }
    }
    let warnings = bed.warnings.iter().map(|warning| Part::Text(format!("Warning: {warning}.")));
    [Part::Table(table)].into_iter().chain(warnings).collect()
}

const TERMS_OF_AN_IMPACT: &[(&str, &str)] = &[
    (
        "range",
        "horizontal distance from the point of contact to where the body, of a link its tip, first stops moving \
         sideways",
    ),
    ("angle", "of the velocity at contact from the horizontal: 90\u{b0} is straight down"),
    (
        "stopping time",
        "from contact until the velocity, or a component of it, is zero for the first time; it can be late, because a \
         body creeps",
    ),
    (
        "at rest after",
        "from contact until the speed stays below a small share of the speed at contact; it can come before the \
         stopping time",
    ),
    ("energy supplied", "the motion of the body at contact, and what it gives by sinking"),
    (
        "closure",
        "the largest energy that no account holds at any time, over the energy at impact: how well the calculation \
         keeps its books",
    ),
];

const TERMS_OF_A_PUSH: &[(&str, &str)] = &[
    ("angle", "of the velocity from the horizontal: 90\u{b0} is straight down"),
    ("force", "of the ground on the body, without its weight: the mean over a fiftieth of the way"),
    ("work of the drive", "what holds the speed, against the bed and the weight of the body"),
    (
        "closure",
        "the largest energy that no account holds at any time, over what is given to the bed: how well the \
         calculation keeps its books",
    ),
];

/// What words of the page mean.
fn terms(summary: &Summary) -> Vec<(&'static str, &'static str)> {
    let mut terms = vec![(
        "depth",
        "of the lowest point of the body below the undisturbed surface, positive downward",
    )];
    terms.extend(match summary.intrusion {
        Some(_) => TERMS_OF_A_PUSH,
        None => TERMS_OF_AN_IMPACT,
    });

    if summary.bed.is_some() {
        terms.push((
            "sliding, normal and tangential damping",
            "what contacts dissipate: by friction while they slide, and \
                    by their dashpots",
        ));
        terms.push(("springs", "what contacts hold as they are pressed together"));
        terms.push((
            "packing fraction",
            "volume of the grains over that of the bed, in a plane the same of areas",
        ));
        terms.push(("coordination", "mean number of contacts of a grain"));
    }
    terms
}
