//! `[[condition]]`.

use configs::reader::{Found, TableReader};
use configs::{Diagnostic, Span, shorten};

use crate::document::beds::Beds;
use crate::document::optional::optional;
use crate::document::unstated::Unstated;
use crate::keys;
use crate::{Condition, Kind, Role};

/// Where a condition says what its runs are held against.
#[derive(Clone, Copy, Default)]
pub(crate) struct ConditionPlaces {
    pub(crate) id: Option<Span>,
    /// `None` where the frames have to say the speed.
    pub(crate) speed: Option<Span>,
    pub(crate) angle: Option<Span>,
    pub(crate) diameter: Option<Span>,
    pub(crate) mass: Option<Span>,
    pub(crate) shaft: Option<Span>,
}

/// Relative difference between the height of a cone and that of its angle that rounding explains.
const SAME_HEIGHT: f64 = 0.03;

/// Reads all conditions that can be read; the others are reported.
pub(crate) fn read(
    tables: Vec<TableReader<'_>>,
    kind: Option<Kind>,
    beds: &Beds<'_>,
    unstated: &mut Unstated,
) -> (Vec<Condition>, Vec<ConditionPlaces>) {
    let (mut conditions, mut places) = (Vec::<Condition>::new(), Vec::<ConditionPlaces>::new());
    let mut absent = Absent::default();
    for table in tables {
        let reader = table.reader;
        let Some((condition, place)) = condition(table, (kind, beds), &mut absent) else {
            continue;
        };
        if let Some(first) = conditions.iter().position(|other| other.id == condition.id) {
            let id = shorten(&condition.id);
            reader.report(
                Diagnostic::error(format!("the condition `{id}` is listed twice"))
                    .at(place.id, "again here")
                    .with(places[first].id, "first here"),
            );
        }
        conditions.push(condition);
        places.push(place);
    }
    absent.tell(conditions.len(), unstated);
    (conditions, places)
}

fn condition(
    table: TableReader<'_>,
    (kind, beds): (Option<Kind>, &Beds<'_>),
    absent: &mut Absent,
) -> Option<(Condition, ConditionPlaces)> {
    let id = table.text("id", None, "c01", "the name of the condition");
    let role = match table.has("role") {
        true => table.choice("role", &["fit", "holdout"], &[], "whether it may be fitted to"),
        false => Some("fit"),
    };
    // Frames before contact say it too: what is not stated is read from them afterwards.
    let speed = match table.has("speed") {
        true => table.number(&keys::SPEED).map(|found| found.value),
        false => Some(f64::NAN),
    };
    let angle = table.number(&keys::ANGLE);
    let shape = table.choice("shape", &intruders::names(), &[], "the shape of the intruder");
    let diameter = table.number(&keys::DIAMETER);
    // A drive moves any mass alike.
    let mass = match kind == Some(Kind::ForceDepth) && !table.has("mass") {
        true => Some(0.0),
        false => table.number(&keys::MASS).map(|found| found.value),
    };
    let spin = table.number(&keys::SPIN);
    let bed = beds.named_by(&table);
    let [packing, bed_depth, length, height, shaft, apex, link_angle] = [
        &keys::PACKING,
        &keys::BED_DEPTH,
        &keys::LENGTH_OF_LINK,
        &keys::HEIGHT,
        &keys::SHAFT_DIAMETER,
        &keys::APEX,
        &keys::LINK_ANGLE,
    ]
    .map(|spec| optional(&table, spec));
    // Cells of the tables are without blanks around them too.
    let id = id.map(|id| Found { value: id.value.trim().to_owned(), ..id });
    if let Some(id) = id.as_ref().filter(|id| id.value.is_empty()) {
        let diagnostic = Diagnostic::error("`id` is empty").at(id.span, "expected a name");
        table.reader.report(diagnostic);
    }
    let places = ConditionPlaces {
        id: id.as_ref().and_then(|id| id.span),
        speed: table.span_of("speed"),
        angle: table.span_of("angle_deg"),
        diameter: table.span_of("diameter"),
        mass: table.span_of("mass"),
        shaft: table.span_of("shaft_diameter"),
    };
    let wanted = shape.and_then(intruders::find).map_or(&[][..], |entry| entry.measured.keys);
    for key in ["role", "packing", "bed_depth"].iter().chain(wanted) {
        absent.count(key, !table.has(key));
    }
    if let (Some(size), Some(height), Some(apex)) = (&diameter, height, apex)
        && wanted.contains(&"apex_deg")
    {
        let whole = 0.5 * size.value / libm::tan(0.5 * apex.to_radians());
        if (height / whole - 1.0).abs() > SAME_HEIGHT {
            let message = format!(
                "a {} of diameter {:.4} m and apex_deg {apex} is {whole:.4} m high, not {height:.4} m",
                shape.unwrap_or_default(),
                size.value
            );
            table.reader.report(
                Diagnostic::error(message)
                    .at(table.span_of("apex_deg"), "this is the full angle at the tip")
                    .help("state the one of `apex_deg` and `height` that is measured"),
            );
        }
    }
    table.finish();
    let condition = Condition {
        id: id?.value,
        role: match role? {
            "fit" => Role::Fit,
            _ => Role::Holdout,
        },
        speed: speed?,
        angle_deg: angle?.value,
        shape: shape?.to_owned(),
        diameter: diameter?.value,
        mass: mass?,
        spin: spin?.value,
        packing,
        bed_depth,
        bed,
        length,
        height,
        shaft_diameter: shaft,
        apex_deg: apex,
        link_angle_deg: link_angle,
    };
    Some((condition, places))
}

/// How many conditions do without a key.
#[derive(Default)]
struct Absent(Vec<(&'static str, usize)>);

impl Absent {
    fn count(&mut self, key: &'static str, absent: bool) {
        match self.0.iter_mut().find(|(other, _)| *other == key) {
            Some((_, n)) => *n += usize::from(absent),
            None => self.0.push((key, usize::from(absent))),
        }
    }

    fn tell(self, conditions: usize, unstated: &mut Unstated) {
        for (key, n) in self.0 {
            let some = if n < conditions { " (of some)" } else { "" };
            unstated.absent_if(n > 0, &format!("condition.{key}{some}"));
        }
    }
}
