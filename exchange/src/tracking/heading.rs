//! What the name of a column says: what stands in it, of which point, in which unit.

use engine::units::Dimension;

use super::units::Unit;

/// What stands in a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    Time,
    Frame,
    /// The coordinate that the body falls along.
    Vertical,
    /// The coordinate along the surface.
    Forward,
    Run,
}

/// The name of a column, taken apart.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Heading {
    /// As the table has it.
    pub(super) name: String,
    /// Without unit, in small letters.
    pub(super) stem: String,
    pub(super) unit: Unit,
}

const TIME: [&str; 15] = [
    "t",
    "millis",
    "time",
    "times",
    "zeit",
    "temps",
    "tiempo",
    "tempo",
    "elapsed time",
    "position_t",
    "x_value",
    "timestamp",
    "epoch",
    "seconds",
    "time stamp",
];
const FRAME: [&str; 16] = [
    "frame",
    "frames",
    "frame number",
    "frame_number",
    "frame no",
    "slice",
    "slice n°",
    "image",
    "frame_idx",
    "bild",
    "bildnummer",
    "frame #",
    "frame id",
    "frame_id",
    "image_number",
    "image number",
];
const VERTICAL: [&str; 28] = [
    "y",
    "z",
    "depth",
    "height",
    "position",
    "position_y",
    "pos_y",
    "y_pos",
    "posy",
    "ypos",
    "distance",
    "elevation",
    "höhe",
    "tiefe",
    "hauteur",
    "profondeur",
    "altura",
    "cy",
    "yc",
    "centroid_y",
    "center_y",
    "centre_y",
    "y_center",
    "y_centre",
    "bbox_top",
    "weg",
    "displacement",
    "déplacement",
];
const FORWARD: [&str; 14] = [
    "x",
    "position_x",
    "pos_x",
    "x_pos",
    "posx",
    "xpos",
    "cx",
    "xc",
    "centroid_x",
    "center_x",
    "centre_x",
    "x_center",
    "x_centre",
    "bbox_left",
];
const RUN: [&str; 31] = [
    "run",
    "trial",
    "drop",
    "shot",
    "experiment",
    "track",
    "track_id",
    "track n°",
    "tid",
    "particle",
    "trajectory",
    "test",
    "run_id",
    "run no",
    "track id",
    "versuch",
    "clip",
    "video",
    "sample",
    "test no",
    "test number",
    "trial number",
    "run number",
    "drop number",
    "essai",
    "aufnahme",
    "drop_id",
    "drop id",
    "trial_id",
    "trial id",
    "shot_id",
];

/// Whether what is called so holds means or errors of the others.
pub(super) fn is_statistic(name: &str) -> bool {
    const NAMES: [&str; 18] = [
        "min",
        "max",
        "mean",
        "average",
        "avg",
        "median",
        "mittel",
        "mittelwert",
        "moyenne",
        "media",
        "std",
        "stdev",
        "stddev",
        "sd",
        "se",
        "sem",
        "sigma",
        "error",
    ];
    NAMES.contains(&name.trim().to_lowercase().as_str())
}

impl Heading {
    /// Takes the name of a column apart: `t (ms)`, `y [cm]`, `z_mm`, `t/ms`, `Latest: Position (m)`.
    pub(super) fn of(name: &str) -> Self {
        let name = name.trim().trim_start_matches('#').trim();
        let bare = name.rsplit_once(": ").map_or(name, |(_, bare)| bare).trim();
        let (stem, unit) = match with_unit_inside(bare) {
            Some(taken_apart) => taken_apart,
            None => {
                let (stem, unit) = stem_and_unit(bare);
                (stem.trim().to_owned(), unit)
            }
        };
        Self { name: name.to_owned(), stem: stem.to_lowercase(), unit }
    }

    /// What stands in the column, if its name says it.
    pub(super) fn role(&self) -> Option<Role> {
        role(&self.stem)
    }

    /// Whether name or unit is that of a force or of a pressure.
    pub(super) fn is_force(&self) -> bool {
        const NAMES: [&str; 8] = [
            "force",
            "load",
            "kraft",
            "standardkraft",
            "prüfkraft",
            "compressive load",
            "qc",
            "cone resistance",
        ];
        const UNITS: [&str; 10] = ["n", "kn", "mn", "gf", "kgf", "lbf", "pa", "kpa", "mpa", "bar"];
        NAMES.contains(&self.stem.as_str())
            || matches!(&self.unit, Unit::Unknown(unit) if UNITS.contains(&unit.to_lowercase().as_str()))
    }

    /// Whether name or unit is that of an acceleration.
    pub(super) fn is_acceleration(&self) -> bool {
        const NAMES: [&str; 6] = ["ax", "ay", "az", "acc", "accel", "acceleration"];
        const UNITS: [&str; 5] = ["m/s2", "m/s^2", "m/s²", "m s^-2", "m/s/s"];
        let first = self.stem.split([' ', '_', '-']).next();
        // `g` is the unit of masses too, so it counts in the column of an axis alone.
        let is_of_axis = || self.role().is_some() || self.point().is_some() || self.stem == "a";
        let is_unit = |unit: &str| match unit.to_lowercase().as_str() {
            "g" => is_of_axis(),
            unit => UNITS.contains(&unit),
        };
        first.is_some_and(|word| NAMES.contains(&word))
            || matches!(&self.unit, Unit::Unknown(unit) if is_unit(unit))
    }

    /// Whether its unit is one of length.
    pub(super) fn is_length(&self) -> bool {
        self.unit.si(Dimension::LENGTH).is_some()
    }

    /// Whether name or unit is that of a velocity.
    pub(super) fn is_velocity(&self) -> bool {
        const NAMES: [&str; 6] = ["vx", "vy", "vz", "vel", "velocity", "speed"];
        const UNITS: [&str; 5] = ["m/s", "cm/s", "mm/s", "m s^-1", "km/h"];
        let first = self.stem.split([' ', '_', '-']).next();
        // A drop that is called by its speed has a unit of length.
        let is_named = !self.is_length() && first.is_some_and(|word| NAMES.contains(&word));
        is_named
            || matches!(&self.unit, Unit::Unknown(unit) if UNITS.contains(&unit.to_lowercase().as_str()))
    }

    /// The coordinate and the point of names such as `y2`, `x_left`, `ball_y`; none of plain names.
    pub(super) fn point(&self) -> Option<(Role, String)> {
        let axis = |text: &str| match text {
            "x" => Some(Role::Forward),
            "y" | "z" => Some(Role::Vertical),
            _ => None,
        };
        let last_word = |text: &str| match text {
            "position" | "height" | "depth" => Some(Role::Vertical),
            _ => axis(text),
        };
        let stem = self.stem.as_str();
        let (first, rest) = stem.split_at_checked(1)?;
        if let Some(role) = axis(first)
            && !rest.is_empty()
            && (rest.starts_with(|c: char| c.is_ascii_digit()) || rest.starts_with(['_', ' ', '-']))
        {
            return Some((role, rest.trim_matches(['_', ' ', '-']).to_owned()));
        }
        let (rest, last) = stem.rsplit_once(['_', ' ', '.', '-'])?;
        Some((last_word(last)?, rest.trim_matches(['_', ' ', '-', '.']).to_owned()))
    }

    /// What stands in the column and of which drop, of names such as `t_h10_r1`, `y2`, `h10_r1 t`; none of plain names.
    pub(super) fn of_drop(&self) -> Option<(Role, String)> {
        const ENDS: [char; 4] = ['_', ' ', '.', '-'];
        let stem = self.stem.as_str();
        let name = |rest: &str| rest.trim_matches(ENDS).to_owned();
        let of_word = |word: &str, rest: &str| {
            role(word).filter(|_| !name(rest).is_empty()).map(|role| (role, name(rest)))
        };
        let first = stem.find(ENDS).or_else(|| stem.find(|c: char| c.is_ascii_digit()));
        let first = first.and_then(|at| of_word(&stem[..at], &stem[at..]));
        let digits = stem.find(|c: char| c.is_ascii_digit());
        let numbered = || digits.and_then(|at| of_word(&stem[..at], &stem[at..]));
        let last = || stem.rfind(ENDS).and_then(|at| of_word(&stem[at + 1..], &stem[..at]));
        first.or_else(numbered).or_else(last)
    }
}

fn role(stem: &str) -> Option<Role> {
    match () {
        () if TIME.contains(&stem) => Some(Role::Time),
        () if FRAME.contains(&stem) => Some(Role::Frame),
        () if VERTICAL.contains(&stem) => Some(Role::Vertical),
        () if FORWARD.contains(&stem) => Some(Role::Forward),
        () if RUN.contains(&stem) => Some(Role::Run),
        () => None,
    }
}

/// `Time (s) Run #1`: a drop may stand behind the unit.
fn with_unit_inside(bare: &str) -> Option<(String, Unit)> {
    let (stem, rest) = bare.split_once('(')?;
    let (unit, drop) = rest.split_once(')')?;
    let is_inside = !drop.trim().is_empty() && !drop.contains('(') && !stem.trim().is_empty();
    is_inside.then(|| (format!("{} {}", stem.trim(), drop.trim()), Unit::of(unit)))
}

fn stem_and_unit(bare: &str) -> (&str, Unit) {
    for (open, close) in [('(', ')'), ('[', ']')] {
        if let Some((stem, unit)) = bare.strip_suffix(close).and_then(|text| text.rsplit_once(open))
        {
            return (stem, Unit::of(unit));
        }
    }
    // A whole name such as `position_y` is not taken apart; `y_mm` and `t/ms` are.
    if role(&bare.to_lowercase()).is_none()
        && let Some((stem, unit)) = bare.rsplit_once(['/', '_', ' '])
        && let Some(unit) = Unit::maybe(unit)
    {
        let stem = stem.trim_end_matches(['/', ' ']);
        return (stem.strip_suffix(" in").unwrap_or(stem), unit);
    }
    (bare, Unit::Unstated)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_say_what_stands_in_a_column_and_in_which_unit() {
        let read = |name: &str| {
            let heading = Heading::of(name);
            (heading.role(), heading.unit.word().to_owned())
        };
        for (name, role, unit) in [
            ("t (ms)", Role::Time, "ms"),
            ("Time [s]", Role::Time, "s"),
            ("Latest: Position (m)", Role::Vertical, "m"),
            ("y_mm", Role::Vertical, "mm"),
            ("t/ms", Role::Time, "ms"),
            ("t / ms", Role::Time, "ms"),
            ("Zeit in ms", Role::Time, "ms"),
            ("POSITION_Y", Role::Vertical, "not said"),
            ("height (px)", Role::Vertical, "px"),
            ("Frame", Role::Frame, "not said"),
            ("X (micron)", Role::Forward, "um"),
            ("y (furlong)", Role::Vertical, "furlong"),
            ("TRACK_ID", Role::Run, "not said"),
        ] {
            assert_eq!(read(name), (Some(role), unit.to_owned()), "{name}");
        }
        assert_eq!(Heading::of("v_y (m/s)").role(), None);
        let are = ["az", "Acceleration y (m/s²)", "z (g)", "acc_z"].map(Heading::of);
        assert!(are.iter().all(Heading::is_acceleration));
        let others = ["a1", "y", "z (mm)", "t", "mass (g)"].map(Heading::of);
        assert!(!others.iter().any(Heading::is_acceleration));
    }

    #[test]
    fn names_of_columns_say_the_drop() {
        let of = |name: &str| Heading::of(name).of_drop();
        for (name, role, drop) in [
            ("t_h10_r1 (ms)", Role::Time, "h10_r1"),
            ("y2 (cm)", Role::Vertical, "2"),
            ("h10_r1 t", Role::Time, "h10_r1"),
            ("height_10_1", Role::Vertical, "10_1"),
            ("Time 3", Role::Time, "3"),
            ("Position (m) Run #12", Role::Vertical, "run #12"),
        ] {
            assert_eq!(of(name), Some((role, drop.to_owned())), "{name}");
        }
        assert_eq!(["t", "y (mm)", "note"].map(of), [None, None, None]);
    }

    #[test]
    fn names_of_points_have_a_coordinate() {
        let point = |name: &str| Heading::of(name).point();
        assert_eq!(point("y1 (cm)"), Some((Role::Vertical, "1".to_owned())));
        assert_eq!(point("x_2"), Some((Role::Forward, "2".to_owned())));
        assert_eq!(point("Ball A y"), Some((Role::Vertical, "ball a".to_owned())));
        assert_eq!(point("y"), None);
        assert_eq!(point("drop1"), None);
        assert_eq!(point("v_x").map(|point| point.1), Some("v".to_owned()));
    }
}
