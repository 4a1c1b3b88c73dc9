//! A bed from a table of grains: `x_m,y_m,radius_m,mass_kg` in a plane, where y is up, and
//! `x_m,y_m,z_m,radius_m,mass_kg` in space, where z is.

use std::f64::consts::PI;
use std::fmt;

use engine::boundary::{Base, Container};
use engine::grains::Space;

use crate::diagnostics::{nearest, shorten};

/// One grain of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CsvGrain {
    /// Centre, from the left side (m).
    pub x: f64,
    /// Centre, from the front side (m); 0 in a plane.
    pub y: f64,
    /// Centre, up from the bottom (m).
    pub z: f64,
    /// Radius (m).
    pub radius: f64,
    /// Mass (kg).
    pub mass: f64,
}

/// The grains of a table, and what is odd about it.
#[derive(Clone, Debug, PartialEq)]
pub struct GrainTable {
    /// In the order of the table.
    pub grains: Vec<CsvGrain>,
    /// Columns that were ignored, for instance.
    pub warnings: Vec<String>,
}

/// What is wrong with a table, and on which line.
#[derive(Clone, Debug, PartialEq)]
pub struct CsvFault {
    /// Line of the file, from 1; 0 is the whole file.
    pub line: u64,
    /// Column by name, if it is one.
    pub column: Option<String>,
    /// What is wrong and what is right.
    pub message: String,
}

impl fmt::Display for CsvFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.line > 0 {
            write!(f, "line {}: ", self.line)?;
        }
        if let Some(column) = &self.column {
            write!(f, "column {column}: ")?;
        }
        f.write_str(&self.message)
    }
}

/// Most faults that are listed.
const FAULTS: usize = 10;
const KNOWN: [&str; 7] =
    ["x_m", "y_m", "z_m", "radius_m", "mass_kg", "density_kg_per_m2", "density_kg_per_m3"];

/// How deep a grain may reach into a wall, over its radius; deeper counts as outside.
const DEEPEST_IN_WALL: f64 = 0.5;

/// What the grains of a table lie in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Room {
    /// Discs in a plane or spheres in space.
    pub space: Space,
    /// The container.
    pub container: Container,
}

impl Room {
    /// Whether the sides let a grain of `inner` (m) without what may be in a wall be at `x`, `y` (m);
    /// `None` if they do, else the column and how it should be.
    fn refusal(&self, x: f64, y: f64, inner: f64) -> Option<(&'static str, String)> {
        if self.container.holds(self.space, (x, y), inner) {
            return None;
        }
        let [width, depth] = self.container.extents();
        let holds_x = self.container.holds(self.space, (x, 0.5 * depth), inner);
        Some(match self.container.base {
            Base::Circle { diameter } => (
                "x_m",
                format!("the grain at {x} m, {y} m is outside of the cylinder, {diameter} m wide"),
            ),
            Base::Rectangle { .. } if holds_x => {
                ("y_m", format!("the grain at {y} m is outside of the box, 0 to {depth} m"))
            }
            Base::Rectangle { .. } => {
                ("x_m", format!("the grain at {x} m is outside of the box, 0 to {width} m"))
            }
        })
    }
}

/// What a table has to say in one kind of space.
struct Names {
    up: &'static str,
    density: &'static str,
    /// The density of the other kind of space.
    other_density: &'static str,
    refusal: &'static str,
}

const PLANAR: Names = Names {
    up: "y_m",
    density: "density_kg_per_m2",
    other_density: "density_kg_per_m3",
    refusal: "`density_kg_per_m3` gives a disc no mass: a planar bed wants `mass_kg` or \
              `density_kg_per_m2`",
};

const SPATIAL: Names = Names {
    up: "z_m",
    density: "density_kg_per_m3",
    other_density: "density_kg_per_m2",
    refusal: "`density_kg_per_m2` gives a sphere no mass: a bed in space wants `mass_kg` or \
              `density_kg_per_m3`",
};

impl Names {
    fn of(space: Space) -> &'static Self {
        match space {
            Space::Planar => &PLANAR,
            Space::Spatial => &SPATIAL,
        }
    }
}

/// Reads the grains of a bed in `room`.
///
/// # Errors
/// Everything wrong with it, up to ten faults.
pub fn read(bytes: &[u8], room: Room) -> Result<GrainTable, Vec<CsvFault>> {
    let whole =
        |message: &str| vec![CsvFault { line: 0, column: None, message: message.to_owned() }];
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(whole("the file is UTF-16; save it as UTF-8"));
    }
    if std::str::from_utf8(bytes).is_err() {
        return Err(whole("the file is not UTF-8; save it as UTF-8"));
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(bytes);
    let header = match reader.headers() {
        Ok(header) => header.clone(),
        Err(error) => return Err(whole(&format!("the header cannot be read: {error}"))),
    };
    let names: Vec<&str> = header.iter().collect();
    if names.len() == 1 && names[0].contains([';', '\t']) {
        return Err(whole("the columns are separated by ; or tab; separate them by commas"));
    }
    let columns = Columns::find(&names, room.space)?;
    let mut faults = Vec::new();
    let (mut grains, mut lines) = (Vec::new(), Vec::new());
    for record in reader.records() {
        match record {
            Ok(record) => match columns.grain(&record, room) {
                Ok(grain) => {
                    lines.push(record.position().map_or(0, csv::Position::line));
                    grains.push(grain);
                }
                Err(fault) => faults.push(fault),
            },
            Err(error) => faults.push(CsvFault {
                line: error.position().map_or(0, csv::Position::line),
                column: None,
                message: match error.kind() {
                    csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
                        format!("{len} values found; the header has {expected_len}")
                    }
                    _ => error.to_string(),
                },
            }),
        }
        if faults.len() >= FAULTS {
            break;
        }
    }
    if faults.is_empty() && grains.is_empty() {
        faults.extend(whole("there is no grain below the header"));
    }
    if faults.is_empty() {
        faults.extend(too_high(&grains, &lines, room));
    }
    match faults.is_empty() {
        true => Ok(GrainTable { grains, warnings: columns.warnings }),
        false => Err(faults),
    }
}

/// The grains, on these lines of their table, that lie far above what can be a bed: higher than all of them on top of each
/// other and once the width of the container.
fn too_high(grains: &[CsvGrain], lines: &[u64], room: Room) -> Vec<CsvFault> {
    let [width, depth] = room.container.extents();
    let stacked: f64 = grains.iter().map(|grain| 2.0 * grain.radius).sum();
    let highest = stacked + width.max(depth);
    let faults = grains.iter().zip(lines).filter(|(grain, _)| grain.z > highest);
    let fault = |(grain, line): (&CsvGrain, &u64)| CsvFault {
        line: *line,
        column: Some(Names::of(room.space).up.to_owned()),
        message: format!(
            "the grain at {:?} m is far above the bed: all {} grains on top of each other are {stacked:.3} m high",
            grain.z,
            grains.len()
        ),
    };
    faults.map(fault).take(FAULTS).collect()
}

struct Columns {
    x: usize,
    y: Option<usize>,
    up: usize,
    radius: usize,
    mass: usize,
    /// Whether the column `mass` is a density.
    is_density: bool,
    warnings: Vec<String>,
}

impl Columns {
    fn find(names: &[&str], space: Space) -> Result<Self, Vec<CsvFault>> {
        let mut faults = Vec::new();
        let mut fault = |message: String| {
            faults.push(CsvFault { line: 1, column: None, message });
        };
        let found = names.iter().take(20).map(|name| shorten(name)).collect::<Vec<_>>().join(", ");
        let mut warnings = Vec::new();
        for (at, name) in names.iter().enumerate() {
            if names[..at].contains(name) {
                fault(format!("the column `{}` is listed twice", shorten(name)));
            } else if *name == "z_m" && space == Space::Planar {
                warnings.push("the column `z_m` is ignored: the bed is planar".to_owned());
            } else if !KNOWN.contains(name) && warnings.len() < FAULTS {
                warnings.push(format!("the column `{}` is ignored", shorten(name)));
            }
        }
        let at = |wanted: &str| names.iter().position(|name| *name == wanted);
        let mut need = |wanted: &str| {
            at(wanted).unwrap_or_else(|| {
                let near =
                    nearest(wanted, names.iter().copied().filter(|name| !KNOWN.contains(name)));
                let hint = near.map(|name| format!("; is it `{}`?", shorten(name)));
                fault(format!(
                    "the column `{wanted}` is missing; found: {found}{}",
                    hint.unwrap_or_default()
                ));
                0
            })
        };
        let wanted = Names::of(space);
        let x = need("x_m");
        let y = (space == Space::Spatial).then(|| need("y_m"));
        let (up, radius) = (need(wanted.up), need("radius_m"));
        let (mass, is_density) = match (at("mass_kg"), at(wanted.density)) {
            (Some(_), Some(_)) => {
                fault(format!("both `mass_kg` and `{}` are given; keep one", wanted.density));
                (0, false)
            }
            (Some(mass), None) => (mass, false),
            (None, Some(density)) => (density, true),
            (None, None) => {
                fault(match at(wanted.other_density) {
                    Some(_) => wanted.refusal.to_owned(),
                    None => format!("the column `mass_kg` is missing; found: {found}"),
                });
                (0, false)
            }
        };
        match faults.is_empty() {
            true => Ok(Self { x, y, up, radius, mass, is_density, warnings }),
            false => Err(faults),
        }
    }

    fn grain(&self, record: &csv::StringRecord, room: Room) -> Result<CsvGrain, CsvFault> {
        let line = record.position().map_or(0, csv::Position::line);
        let fault = |column: &str, message: String| CsvFault {
            line,
            column: Some(column.to_owned()),
            message,
        };
        let number = |at: usize, column: &str, positive: bool| {
            let text = record.get(at).unwrap_or_default();
            let wanted = if positive { "a positive number" } else { "a number" };
            text.parse::<f64>()
                .ok()
                .filter(|value| value.is_finite() && (!positive || *value > 0.0))
                .ok_or_else(|| {
                    fault(column, format!("found \"{}\"; expected {wanted}", shorten(text)))
                })
        };
        let x = number(self.x, "x_m", false)?;
        let y = self.y.map(|at| number(at, "y_m", false)).transpose()?;
        let names = Names::of(room.space);
        let z = number(self.up, names.up, false)?;
        let radius = number(self.radius, "radius_m", true)?;
        let mass = match self.is_density {
            false => number(self.mass, "mass_kg", true)?,
            true => {
                let density = number(self.mass, names.density, true)?;
                match room.space {
                    Space::Planar => density * PI * radius * radius,
                    Space::Spatial => density * 4.0 / 3.0 * PI * radius * radius * radius,
                }
            }
        };
        if !mass.is_normal() || !room.space.grain_inertia(mass, radius).is_normal() {
            return Err(fault("radius_m", "mass or moment of inertia out of range".to_owned()));
        }
        let inner = radius * (1.0 - DEEPEST_IN_WALL);
        let y = y.unwrap_or(0.0);
        if let Some((column, message)) = room.refusal(x, y, inner) {
            return Err(fault(column, message));
        }
        if z < inner {
            return Err(fault(names.up, format!("the grain at {z} m is below the bottom, 0 m")));
        }
        Ok(CsvGrain { x, y, z, radius, mass })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLANE: Room = Room { space: Space::Planar, container: Container::walled_box(1.0, 0.0) };
    const CUBE: Room = Room { space: Space::Spatial, container: Container::walled_box(1.0, 1.0) };

    fn faults(text: &str) -> String {
        let faults = read(text.as_bytes(), PLANE).expect_err("a faulty table");
        faults.iter().map(|fault| format!("{fault}\n")).collect()
    }

    #[test]
    fn byte_order_mark_and_crlf_are_accepted() {
        let text = "\u{feff}x_m,y_m,radius_m,mass_kg,colour\r\n0.5,0.1,0.01,1e-3,red\r\n";
        let table = read(text.as_bytes(), PLANE).expect("a good table");
        assert_eq!(table.grains, [CsvGrain { x: 0.5, y: 0.0, z: 0.1, radius: 0.01, mass: 1e-3 }]);
        assert_eq!(table.warnings, ["the column `colour` is ignored"]);
    }

    #[test]
    fn in_space_z_is_up_and_a_density_is_that_of_a_volume() {
        let text = "x_m,y_m,z_m,radius_m,density_kg_per_m3\n0.5,0.25,0.1,0.01,2500\n";
        let table = read(text.as_bytes(), CUBE).expect("a good table");
        let grain = table.grains[0];
        assert_eq!(
            CsvGrain { radius: 0.0, mass: 0.0, ..grain },
            CsvGrain { x: 0.5, y: 0.25, z: 0.1, radius: 0.0, mass: 0.0 }
        );
        // A few roundings apart.
        assert!((grain.mass / (2500.0 * PI / 6.0 * 0.02_f64.powi(3)) - 1.0).abs() < 1e-15);
        let text = "x_m,y_m,z_m,radius_m,density_kg_per_m2\n";
        let faults = read(text.as_bytes(), CUBE).expect_err("a density of a plane");
        assert!(faults[0].to_string().contains("gives a sphere no mass"));
        let text = "x_m,y_m,z_m,radius_m,mass_kg\n0.5,1.2,0.1,0.01,1e-3\n";
        let faults = read(text.as_bytes(), CUBE).expect_err("a grain outside");
        assert!(faults[0].to_string().contains("column y_m: the grain at 1.2 m is outside"));
    }

    #[test]
    fn a_grain_far_above_the_others_is_a_fault() {
        let header = "x_m,y_m,radius_m,mass_kg\n0.5,0.1,0.01,1e-3\n";
        for height in ["50", "1e300"] {
            let text = faults(&format!("{header}0.2,{height},0.01,1e-3\n"));
            assert!(text.starts_with("line 3: column y_m: the grain at "), "{text}");
            assert!(
                text.ends_with("all 2 grains on top of each other are 0.040 m high\n"),
                "{text}"
            );
        }
        // A grain may fall from the height of the width of its box.
        assert!(read(format!("{header}0.2,1.0,0.01,1e-3\n").as_bytes(), PLANE).is_ok());
    }

    #[test]
    fn faults_name_line_and_column() {
        let header = "x_m,y_m,radius_m,mass_kg\n";
        assert_eq!(
            faults(&format!("{header}0.5,0.1,0.01,1e-3\n0.5,0.1,-0.01,1e-3\n0.5,nan,0.01,1\n")),
            "line 3: column radius_m: found \"-0.01\"; expected a positive number\n\
             line 4: column y_m: found \"nan\"; expected a number\n"
        );
        assert_eq!(
            faults(&format!("{header}2.5,0.1,0.01,1e-3\n0.5,0.1\n")),
            "line 2: column x_m: the grain at 2.5 m is outside of the box, 0 to 1 m\n\
             line 3: 2 values found; the header has 4\n"
        );
        assert_eq!(faults(header), "there is no grain below the header\n");
        assert_eq!(
            faults("X_m,y_m,radius_m,density_kg_per_m3\n"),
            "line 1: the column `x_m` is missing; found: X_m, y_m, radius_m, density_kg_per_m3; is it `X_m`?\n\
             line 1: `density_kg_per_m3` gives a disc no mass: a planar bed wants `mass_kg` or \
             `density_kg_per_m2`\n"
        );
        assert!(faults("x_m;y_m\n1;2\n").contains("separate them by commas"));
    }
}
