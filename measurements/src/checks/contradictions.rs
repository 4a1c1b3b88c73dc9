//! Where a set contradicts its own frames, with what to write instead.

use configs::Diagnostic;
use engine::units::{self, Dimension};

use crate::checks::agreement::Agreement;
use crate::contact::definitions::{Held, Outcome, Scalar};
use crate::contact::zeros::{Offset, Severity, SpeedRatio, Zero};
use crate::contradiction::{Contradiction, ContradictionKind};
use crate::document::Document;
use crate::reading::Reading;
use crate::table::findings::Findings;
use crate::{MeasurementSet, RunContact};

/// Most runs whose numbers a message lists.
const LISTED: usize = 12;

/// Relative spread of the speed ratios below which all conditions are off alike.
const ALIKE: f64 = 0.03;

/// All contradictions, with those that are `known` already. Small offsets are warned of, before all else.
pub(crate) fn find(
    set: &MeasurementSet,
    agreement: &Agreement,
    (document, known, findings): (&Document, Vec<Contradiction>, &mut Findings),
) -> Vec<Contradiction> {
    let mut all = known;
    // In a wrong unit nothing else is right either.
    if all.iter().any(|one| one.kind == ContradictionKind::Speeds) {
        return all;
    }
    let speeds = &agreement.zeros.speeds;
    if let Some(warning) = of_slowed(&agreement.zeros.contacts, document) {
        first(warning, findings);
    }
    if let Some(offset) = &agreement.zeros.offset {
        let diagnostic = of_offset(set, offset, (&agreement.zeros.contacts, document));
        match offset.severity {
            Severity::Wrong => {
                // What ends at a wrong zero ends at a wrong time and depth.
                return vec![Contradiction { kind: ContradictionKind::Zeros, diagnostic }];
            }
            _ => first(diagnostic, findings),
        }
    }
    if let Some((severity, diagnostic)) = of_speeds(set, speeds, document) {
        match severity {
            Severity::Wrong => {
                all.push(Contradiction { kind: ContradictionKind::Speeds, diagnostic });
            }
            _ => first(diagnostic, findings),
        }
    }
    let held = agreement.held.iter().filter(|held| held.outcome.is_contradiction());
    all.extend(held.map(|held| Contradiction {
        kind: ContradictionKind::Scalars,
        diagnostic: of_held(held, document),
    }));
    all
}

/// Warns before everything else that was found.
fn first(diagnostic: Diagnostic, findings: &mut Findings) {
    findings.warn(Diagnostic { severity: configs::Severity::Warning, ..diagnostic });
    findings.diagnostics.rotate_right(1);
}

/// That bodies are slowed before their contact, if the zeros are right; none if no body is.
fn of_slowed(contacts: &[RunContact], document: &Document) -> Option<Diagnostic> {
    let slowed: Vec<f64> = contacts
        .iter()
        .filter(|one| one.is_slowed)
        .map(|one| one.contact.acceleration.value)
        .collect();
    let (n, all) = (slowed.len(), contacts.len());
    let mean = slowed.iter().sum::<f64>() / n as f64;
    let table = document.files.readings.first().and_then(|table| table.span);
    (n > 0).then(|| {
        Diagnostic::warning(format!(
            "{n} of {all} runs do not fall freely before t = 0: their acceleration is {mean:.1} m/s² downward on average"
        ))
        .at(table, "the frames before first contact")
        .help("guides or air slow the body, or the bed does, and t = 0 is later than first contact: look at the frames")
    })
}

/// A reading with its error, both in the thousandth of the SI unit.
fn milli(reading: Reading, unit: &str) -> String {
    format!("{:.2} ± {:.2} {unit}", 1e3 * reading.value, 1e3 * reading.se)
}

fn of_offset(
    set: &MeasurementSet,
    offset: &Offset,
    (contacts, document): (&[RunContact], &Document),
) -> Diagnostic {
    let Offset { zero, time, depth, is_common, .. } = *offset;
    let n = contacts.len();
    let runs = if n == 1 { "1 run".to_owned() } else { format!("{n} runs") };
    let (clock, surface) = (milli(time, "ms"), milli(depth, "mm"));
    let message = match (is_common, zero) {
        (false, _) => {
            let off = contacts.iter().filter(|one| one.is_off).count();
            format!(
                "t = 0 is not first contact, or z = 0 not the surface, in {off} of {runs}, and \
                 not by the same in all"
            )
        }
        (_, Zero::Depth) => format!(
            "z = 0 is not the surface: the frames of {runs} show the surface at z = {surface}"
        ),
        (_, Zero::Clock) => format!(
            "t = 0 is not first contact: the frames of {runs} show first contact at t = {clock}"
        ),
        (_, Zero::Both) => format!(
            "t = 0 is not first contact, and z = 0 not the surface: the frames of {runs} show \
             first contact at t = {clock} and z = {surface}"
        ),
    };
    let columns = &document.files.format.columns;
    let place = ["z", "t"].iter().find_map(|key| columns.of(key)?.span);
    let table = document.files.readings.first().and_then(|table| table.span);
    let help = match is_common {
        true => zeros_to_write(document, offset),
        false => zeros_by_run(set, contacts, document),
    };
    let label = "depth counts from the surface, time from first contact";
    Diagnostic::error(message).at(place.or(table), label).help(help)
}

/// Column `key` with the zero `value` (SI, counted our way), as `[columns]` says it.
fn column(document: &Document, key: &str, value: f64, dimension: Dimension) -> String {
    let known = document.files.format.columns.of(key);
    let unit = known.and_then(|one| one.unit.clone());
    let unit = unit.unwrap_or_else(|| dimension.si_unit());
    let (name, sign, zero) =
        known.map_or((key, 1.0, 0.0), |one| (one.name.as_str(), one.sign, one.zero));
    let sign_text = if sign < 0.0 { ", sign = -1" } else { "" };
    let zero = in_unit(zero + sign * value, &unit, dimension);
    format!("{key} = {{ name = \"{name}\", unit = \"{unit}\"{sign_text}, zero = \"{zero}\" }}")
}

/// `value` (SI) in `unit`, to the fifth of a thousandth of its SI unit that can be told here.
fn in_unit(value: f64, unit: &str, dimension: Dimension) -> String {
    let one = units::parse(&format!("1 {unit}"), dimension).unwrap_or(1.0);
    let digits = (5.0 + libm::log10(one)).clamp(0.0, 9.0) as usize;
    format!("{:.digits$} {unit}", value / one)
}

fn zeros_to_write(document: &Document, offset: &Offset) -> String {
    let clock = || column(document, "t", offset.time.value, Dimension::TIME);
    let depth = || column(document, "z", offset.depth.value, Dimension::LENGTH);
    let lines = match offset.zero {
        Zero::Depth => depth(),
        Zero::Clock => clock(),
        Zero::Both => format!("{}\n{}", clock(), depth()),
    };
    format!("write below [columns]:\n{lines}")
}

fn zeros_by_run(set: &MeasurementSet, contacts: &[RunContact], document: &Document) -> String {
    let columns = &document.files.format.columns;
    let of = |key: &str, value: f64, dimension: Dimension| {
        let known = columns.of(key);
        let unit = known.and_then(|one| one.unit.clone()).unwrap_or_else(|| dimension.si_unit());
        in_unit(known.map_or(1.0, |one| one.sign) * value, &unit, dimension)
    };
    let off = contacts.iter().filter(|one| one.is_off);
    let lines: Vec<String> = off
        .take(LISTED)
        .map(|one| {
            let (t, z) = one.contact.own_zeros();
            let (t, z) = (of("t", t, Dimension::TIME), of("z", z, Dimension::LENGTH));
            format!("{}: t_zero {t}, z_zero {z}", configs::shorten(&set.runs[one.run].name))
        })
        .collect();
    format!(
        "shift each run, by the columns t_zero and z_zero of its table of runs:\n{}",
        lines.join("\n")
    )
}

/// The worst of the speeds.
fn of_speeds(
    set: &MeasurementSet,
    speeds: &[SpeedRatio],
    document: &Document,
) -> Option<(Severity, Diagnostic)> {
    let off = |one: &&SpeedRatio| one.severity > Severity::None;
    let size = |one: &SpeedRatio| (one.ratio.value - 1.0).abs();
    let worst = speeds
        .iter()
        .filter(off)
        .max_by(|a, b| a.severity.cmp(&b.severity).then(size(a).total_cmp(&size(b))))?;
    let condition = &set.conditions[worst.condition];
    let found = condition.speed * worst.ratio.value;
    let error = condition.speed * worst.ratio.se;
    let others = speeds.iter().filter(off).count() - 1;
    let more = match others {
        0 => String::new(),
        1 => ", and 1 other condition is off too".to_owned(),
        n => format!(", and {n} other conditions are off too"),
    };
    let id = configs::shorten(&condition.id);
    let message = format!(
        "the frames of `{id}` show {found:.3} ± {error:.3} m/s at first contact, stated are {} \
         m/s{more}",
        condition.speed
    );
    let (least, most) = speeds.iter().fold((f64::INFINITY, 0.0_f64), |(least, most), one| {
        (least.min(one.ratio.value), most.max(one.ratio.value))
    });
    let alike = speeds.len() > 1 && most - least < ALIKE * most;
    let help = match alike {
        true => format!(
            "all conditions are off by the factor {:.3}: is a unit or the scale of the camera, or are \
             the stated speeds wrong? write speed = {found:.3} here if it is the speed",
            worst.ratio.value
        ),
        false => {
            format!("write speed = {found:.3}, or look at the clock and the scale of its runs")
        }
    };
    let place = document.places[worst.condition].speed;
    Some((worst.severity, Diagnostic::error(message).at(place, "the stated speed").help(help)))
}

fn of_held(held: &Held, document: &Document) -> Diagnostic {
    let (own, key) = (held.misses[0].definition, held.scalar.definition_key());
    let what = held.scalar.plural();
    let miss = |index: usize| milli(held.misses[index].mean, held.scalar.unit());
    let place = match held.scalar {
        Scalar::StopTime => document.definitions[0],
        Scalar::FinalDepth | Scalar::FinalRange => document.definitions[1],
    };
    let label = match held.is_stated {
        true => "stated here".to_owned(),
        false => format!("{key} is not stated; \"{own}\" is assumed"),
    };
    let (message, help) = match held.outcome {
        Outcome::FollowsOther(other) => (
            format!(
                "the {what} follow `{other}`, not `{own}`: in the mean of {} runs they are {} off \
                 what the trajectories give by `{own}`, and {} by `{other}`",
                held.runs,
                miss(0),
                miss(1)
            ),
            format!("write {key} = \"{other}\" below [measurement]"),
        ),
        _ => {
            let [stated, measured] = held.means;
            let ratio = stated / measured;
            let help = match ratio.abs() {
                r if !(0.5..2.0).contains(&r) => format!(
                    "they are {ratio:.3} times what the trajectories show; [columns] gives the unit \
                     and the sign of `{}`",
                    held.scalar.key()
                ),
                _ => format!(
                    "does `{}` count from another zero than the trajectories? [columns] takes a \
                     zero for each",
                    held.scalar.key()
                ),
            };
            let message = format!(
                "the {what} do not belong to the trajectories: in the mean of {} runs they are {} off \
                 what those give by `{own}`, and {} by `{}`",
                held.runs,
                miss(0),
                miss(1),
                held.misses[1].definition
            );
            (message, help)
        }
    };
    Diagnostic::error(message).at(place.or(document.header), label).help(help)
}
