//! `measurement.toml`: everything of a set but its tables.

pub(crate) mod beds;
pub(crate) mod bodies;
pub(crate) mod conditions;
pub(crate) mod feasible;
pub(crate) mod optional;
pub(crate) mod priors;
pub(crate) mod sizes;
pub(crate) mod template;
pub(crate) mod unstated;

use configs::document::Value;
use configs::reader::{Answer, TableReader};
use configs::{Diagnostic, Span, limits};
use engine::params::ParamSpec;

use crate::curves::curve::Curve;
use crate::document::beds::Beds;
use crate::document::conditions::ConditionPlaces;
use crate::document::optional::{optional, optional_choice};
use crate::document::unstated::Unstated;
use crate::keys;
use crate::table::Format;
use crate::table::columns::{ColumnNames, TRAJECTORIES};
use crate::table::dialect::{Decimal, Delimiter};
use crate::{
    Feasible, FinalDefinition, Geometry, Instrument, Kind, MeasurementSet, StatedError,
    StopDefinition, SurfaceDefinition,
};

/// What `measurement.toml` says.
pub(crate) struct Document {
    /// Without runs.
    pub(crate) set: MeasurementSet,
    /// Free text on the frame of reference.
    pub(crate) frame: Option<String>,
    /// Free text on the part of the motion that is analysed.
    pub(crate) phase: Option<String>,
    pub(crate) files: Files,
    pub(crate) places: Vec<ConditionPlaces>,
    /// Where the definitions of the stop and of the final place are stated, if they are.
    pub(crate) definitions: [Option<Span>; 2],
    /// Whether the set states from where depths count.
    pub(crate) states_surface: bool,
    /// The header of `[measurement]`.
    pub(crate) header: Option<Span>,
    /// Whether the notes are those of an exported set, which already say what was assumed.
    pub(crate) is_exported: bool,
}

/// `[files]` and `[columns]`.
pub(crate) struct Files {
    pub(crate) runs: FileName,
    /// Tables of readings, or patterns that give them; none for scalars.
    pub(crate) readings: Vec<FileName>,
    pub(crate) missing: Missing,
    pub(crate) format: Format,
}

/// A table as the set names it.
pub(crate) struct FileName {
    pub(crate) name: String,
    pub(crate) span: Option<Span>,
}

/// What to do about cells without a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Missing {
    /// Refuse the table.
    Error,
    /// Go on without them.
    Drop,
}

/// Reads everything. `None` when something required could not be read; that is reported then.
pub(crate) fn read(root: TableReader<'_>) -> Option<Document> {
    let mut unstated = Unstated::default();
    root.number(&keys::SCHEMA);
    let head = head(root.table("measurement", Some(MEASUREMENT_EXAMPLE)), &mut unstated);
    let kind = head.as_ref().map(|head| head.kind);
    let curve = kind.and_then(Kind::curve);
    let instrument = instrument(root.table("instrument", None), curve, &mut unstated);
    let files = files(root.table("files", Some(FILES_EXAMPLE)), kind);
    let readings = curve.map_or(&TRAJECTORIES[..], |curve| &curve.columns[0][..]);
    let columns = ColumnNames::read(root.table("columns", None), readings);
    let stated = stated(root.table("noise", None), curve, &mut unstated);
    let feasible = Feasible::read(root.table("feasible", None));
    let priors = priors::read(&root);
    let beds = Beds::of(&root);
    let model = root.table("model", None);
    let baseline = optional_text(&model, "baseline", "two-term-vector", "the model to start from");
    model.finish();
    let tables = root.tables("condition", limits::CONDITIONS);
    if tables.is_empty() && !root.has("condition") {
        root.reader.report(
            Diagnostic::error("there is no [[condition]]")
                .help("one table per setting of the experiment, in double brackets"),
        );
    }
    let (conditions, places) = conditions::read(tables, kind, &beds, &mut unstated);
    let is_planar =
        |condition: &crate::Condition| condition.shape_entry().is_some_and(|entry| !entry.spatial);
    let planar = conditions.iter().any(is_planar);
    let (bed, beds) = beds.read(planar, &mut unstated);
    if bed.geometry == Geometry::Spatial {
        bodies::check(root.reader, &conditions, &places);
    }
    unstated.absent_if(baseline.is_none(), "model.baseline");
    root.finish();

    let head = head?;
    let is_exported = head.notes.is_some();
    let notes = head.notes.unwrap_or_else(|| unstated.sentences());
    let mut files = files?;
    files.format.columns = columns;
    let set = MeasurementSet {
        id: head.id,
        source: head.source,
        kind: head.kind,
        instrument,
        bed,
        beds,
        baseline,
        stated,
        stop: head.stop,
        last: head.last,
        surface: head.surface.unwrap_or(SurfaceDefinition::FirstContact),
        feasible,
        priors,
        conditions,
        runs: Vec::new(),
        keep: head.keep,
        notes,
    };
    Some(Document {
        set,
        frame: head.frame,
        phase: head.phase,
        files,
        places,
        definitions: head.definitions,
        states_surface: head.surface.is_some(),
        header: head.header,
        is_exported,
    })
}

const MEASUREMENT_EXAMPLE: &str = "id = \"lab-2024-03\"\nkind = \"trajectory\"";
const FILES_EXAMPLE: &str = "runs = \"runs.csv\"\ntrajectories = \"trajectories.csv\"";

/// `[measurement]`.
struct Head {
    id: String,
    kind: Kind,
    source: Option<String>,
    frame: Option<String>,
    phase: Option<String>,
    stop: StopDefinition,
    last: FinalDefinition,
    surface: Option<SurfaceDefinition>,
    keep: Vec<String>,
    notes: Option<Vec<String>>,
    definitions: [Option<Span>; 2],
    header: Option<Span>,
}

/// The definition below `key` that may be left out, of `all`, which `word` spells as a set does.
fn definition<T: Copy, W: Fn(T) -> &'static str>(
    table: &TableReader<'_>,
    key: &'static str,
    (all, word): ([T; 2], W),
    meaning: &str,
) -> Option<T> {
    let words: Vec<&'static str> = all.iter().map(|one| word(*one)).collect();
    let said = optional_choice(table, key, &words, meaning)?;
    all.into_iter().find(|one| word(*one) == said)
}

fn head(table: TableReader<'_>, unstated: &mut Unstated) -> Option<Head> {
    let id = table.slug("id", None, "the name of the set");
    let kind = table.choice("kind", &Kind::words(), &[], "what was measured");
    let kind = kind.map(|kind| match kind {
        "scalar" => Kind::Scalar,
        word => Kind::of_curve(word).unwrap_or(Kind::Trajectory),
    });
    let source = optional_text(&table, "source", "…", "where the numbers are from");
    let frame = optional_text(&table, "frame", "…", "the frame of reference in words");
    let phase = optional_text(&table, "phase", "…", "the part of the motion in words");
    let all = (StopDefinition::ALL, StopDefinition::word);
    let stop = definition(&table, "stop_definition", all, "when an intruder counts as stopped");
    let all = (FinalDefinition::ALL, FinalDefinition::word);
    let last = definition(&table, "final", all, "which depth and range a run gives");
    let all = (SurfaceDefinition::ALL, SurfaceDefinition::word);
    let surface =
        definition(&table, "surface_definition", all, "from where depths count over coarse grains");
    table.asks("notes", "what was assumed, of a set that was written by plunge", || Answer::Texts);
    table.asks("keep", "runs that are used as they are, however stray they look", || Answer::Texts);
    let notes = table.texts("notes");
    let keep = table.texts("keep").unwrap_or_default();
    let definitions = ["stop_definition", "final"].map(|key| table.span_of(key));
    let header = table.header();
    table.finish();
    unstated.absent_if(source.is_none(), "measurement.source");
    let stop = stop.or_else(|| {
        let stop = match kind? {
            Kind::Scalar => StopDefinition::ComponentZero,
            // What is pushed does not stop.
            Kind::ForceDepth => return Some(StopDefinition::ComponentZero),
            _ => StopDefinition::SpeedFivePercent,
        };
        unstated.assume(format!("measurement.stop_definition = \"{}\"", stop.word()));
        Some(stop)
    });
    let last = last.unwrap_or_else(|| {
        if kind != Some(Kind::ForceDepth) {
            unstated.assume("measurement.final = \"resting\"".to_owned());
        }
        FinalDefinition::Resting
    });
    Some(Head {
        // What is wrong with a name was reported, and does not keep the kind from being known.
        id: id.map_or_else(String::new, |id| id.value),
        kind: kind?,
        source,
        frame,
        phase,
        stop: stop?,
        last,
        surface,
        keep,
        notes,
        definitions,
        header,
    })
}

fn instrument(
    table: TableReader<'_>,
    curve: Option<&Curve>,
    unstated: &mut Unstated,
) -> Instrument {
    let mut number = |spec: &ParamSpec, path: &'static str, is_of_kind: bool| {
        let value = optional(&table, spec);
        unstated.absent_if(value.is_none() && is_of_kind, path);
        unstated.positive(value, path)
    };
    let is_forces = curve.is_some_and(|curve| curve.kind == Kind::ForceDepth);
    let is_read = |spec: &ParamSpec| curve.is_some_and(|curve| curve.sigma_key == spec.key);
    let [force, acceleration, velocity, spin] =
        [&keys::FORCE_SIGMA, &keys::ACCELERATION_SIGMA, &keys::VELOCITY_SIGMA, &keys::SPIN_SIGMA];
    let acceleration_path = "instrument.acceleration_sigma_m_s2";
    let position = "instrument.position_sigma_m";
    let instrument = Instrument {
        rate: number(&keys::RATE, "instrument.rate_hz", !is_forces),
        position_sigma: number(&keys::POSITION_SIGMA, position, curve.is_none()),
        force_sigma: number(force, "instrument.force_sigma_N", is_read(force)),
        acceleration_sigma: number(acceleration, acceleration_path, is_read(acceleration)),
        velocity_sigma: number(velocity, "instrument.velocity_sigma_m_s", is_read(velocity)),
        spin_sigma: number(spin, "instrument.spin_sigma_rad_s", is_read(spin)),
        acceleration_range: optional(&table, &keys::ACCELERATION_RANGE),
        speed_sigma_rel: number(&keys::SPEED_SIGMA, "instrument.speed_sigma_rel", !is_forces),
        angle_sigma_deg: optional(&table, &keys::ANGLE_SIGMA),
        level_sigma: number(&keys::LEVEL_SIGMA, "instrument.level_sigma_m", true),
        // Unlike an error of readings, none of these may be missed: zero says that it is exact.
        time_sigma: optional(&table, &keys::TIME_SIGMA),
        zero_sigma: optional(&table, &keys::ZERO_SIGMA),
        surface_sigma: optional(&table, &keys::SURFACE_SIGMA),
        speed_bias_sigma_rel: optional(&table, &keys::SPEED_BIAS_SIGMA),
        angle_bias_sigma_deg: optional(&table, &keys::ANGLE_BIAS_SIGMA),
        scale_sigma_rel: optional(&table, &keys::SCALE_SIGMA),
        mass_sigma_rel: optional(&table, &keys::MASS_SIGMA),
        tilt_sigma_deg: optional(&table, &keys::TILT_SIGMA),
        session_sigma_rel: optional(&table, &keys::SESSION_SIGMA),
    };
    table.finish();
    instrument
}

fn stated(table: TableReader<'_>, curve: Option<&Curve>, unstated: &mut Unstated) -> StatedError {
    let mut number = |spec: &ParamSpec, path: &'static str| {
        let value = optional(&table, spec);
        unstated.absent_if(value.is_none() && curve.is_none(), path);
        unstated.positive(value, path)
    };
    let stated = StatedError {
        stop_time: number(&keys::STOP_TIME_ERROR, "noise.stop_time_rel"),
        final_z: number(&keys::FINAL_Z_ERROR, "noise.final_z_rel"),
        final_x: number(&keys::FINAL_X_ERROR, "noise.final_x_rel"),
    };
    table.finish();
    stated
}

fn files(table: TableReader<'_>, kind: Option<Kind>) -> Option<Files> {
    table.header()?;
    let name = |key, meaning| {
        let found = table.text(key, None, &format!("{key}.csv"), meaning)?;
        Some(FileName { name: found.value, span: found.span })
    };
    let runs = name("runs", "the table of runs");
    let curve = kind.and_then(Kind::curve);
    let readings = match (kind, table.has("trajectories")) {
        _ if curve.is_some() => readings(&table, curve?.files)?,
        (Some(Kind::Scalar), true) => {
            table.reader.report(
                Diagnostic::error("a set of scalars has no trajectories")
                    .at(table.span_of("trajectories"), "a table of trajectories")
                    .help("write kind = \"trajectory\" above, or remove this line"),
            );
            Vec::new()
        }
        (Some(Kind::Trajectory), _) => readings(&table, "trajectories")?,
        _ => Vec::new(),
    };
    let missing = match optional_choice(
        &table,
        "missing",
        &["error", "drop"],
        "what cells without a number do",
    ) {
        Some("drop") => Missing::Drop,
        _ => Missing::Error,
    };
    let delimiter = optional_choice(
        &table,
        "delimiter",
        &Delimiter::ALL.map(Delimiter::word),
        "what stands between cells",
    )
    .and_then(|word| Delimiter::ALL.into_iter().find(|one| one.word() == word));
    let decimal = optional_choice(&table, "decimal", &[".", ","], "what stands before decimals")
        .map(|word| match word {
            "." => Decimal::Point,
            _ => Decimal::Comma,
        });
    table.finish();
    let format = Format { delimiter, decimal, columns: ColumnNames::default() };
    Some(Files { runs: runs?, readings, missing, format })
}

/// One table of readings below `key`, or a list of them.
fn readings(table: &TableReader<'_>, key: &'static str) -> Option<Vec<FileName>> {
    let is_list = table.node(key).is_some_and(|node| matches!(node.value, Value::Array(_)));
    if !is_list {
        let found = table.text(key, None, &format!("{key}.csv"), &format!("the table of {key}"))?;
        return Some(vec![FileName { name: found.value, span: found.span }]);
    }
    let names = table.raw_texts(key, "drop-1.csv")??;
    if names.is_empty() {
        table.reader.report(
            Diagnostic::error(format!("`{key}` is an empty list"))
                .at(table.span_of(key), "a table at least")
                .help(format!("write {key} = [\"drop-1.csv\", \"drop-2.csv\"] or \"drop-*.csv\"")),
        );
        return None;
    }
    Some(names.into_iter().map(|one| FileName { name: one.value, span: one.span }).collect())
}

fn optional_text(
    table: &TableReader<'_>,
    key: &'static str,
    example: &str,
    meaning: &str,
) -> Option<String> {
    let found = table.has(key).then(|| table.text(key, None, example, meaning));
    found.flatten().map(|found| found.value)
}
