//! A bed from a table of grains: `x_m,y_m[,z_m],radius_m,mass_kg` (in a planar bed y is up).

use std::fmt;

use crate::diagnostics::{nearest, shorten};

/// One grain of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CsvGrain {
    /// Centre, from the left side (m).
    pub x: f64,
    /// Centre, up from the bottom (m).
    pub y: f64,
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

/// Reads the grains of a planar bed in a box of `width` (m).
///
/// # Errors
/// Everything wrong with it, up to ten faults.
pub fn read_planar(bytes: &[u8], width: f64) -> Result<GrainTable, Vec<CsvFault>> {
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
    let columns = Columns::find(&names)?;
    let mut faults = Vec::new();
    let mut grains = Vec::new();
    for record in reader.records() {
        match record {
            Ok(record) => match columns.grain(&record, width) {
                Ok(grain) => grains.push(grain),
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
    match faults.is_empty() {
        true => Ok(GrainTable { grains, warnings: columns.warnings }),
        false => Err(faults),
    }
}

struct Columns {
    x: usize,
    y: usize,
    radius: usize,
    mass: usize,
    /// Whether the column `mass` is a density per area.
    is_density: bool,
    warnings: Vec<String>,
}

impl Columns {
    fn find(names: &[&str]) -> Result<Self, Vec<CsvFault>> {
        let mut faults = Vec::new();
        let mut fault = |message: String| {
            faults.push(CsvFault { line: 1, column: None, message });
        };
        let found = names.iter().take(20).map(|name| shorten(name)).collect::<Vec<_>>().join(", ");
        let mut warnings = Vec::new();
        for (at, name) in names.iter().enumerate() {
            if names[..at].contains(name) {
                fault(format!("the column `{}` stands twice", shorten(name)));
            } else if *name == "z_m" {
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
        let (x, y, radius) = (need("x_m"), need("y_m"), need("radius_m"));
        let (mass, is_density) = match (at("mass_kg"), at("density_kg_per_m2")) {
            (Some(_), Some(_)) => {
                fault("both `mass_kg` and `density_kg_per_m2` are given; keep one".to_owned());
                (0, false)
            }
            (Some(mass), None) => (mass, false),
            (None, Some(density)) => (density, true),
            (None, None) => {
                fault(match at("density_kg_per_m3") {
                    Some(_) => "`density_kg_per_m3` gives a disc no mass: a planar bed wants \
                                `mass_kg` or `density_kg_per_m2`"
                        .to_owned(),
                    None => format!("the column `mass_kg` is missing; found: {found}"),
                });
                (0, false)
            }
        };
        match faults.is_empty() {
            true => Ok(Self { x, y, radius, mass, is_density, warnings }),
            false => Err(faults),
        }
    }

    fn grain(&self, record: &csv::StringRecord, width: f64) -> Result<CsvGrain, CsvFault> {
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
                    fault(column, format!("found \"{}\"; {wanted} is wanted", shorten(text)))
                })
        };
        let x = number(self.x, "x_m", false)?;
        let y = number(self.y, "y_m", false)?;
        let radius = number(self.radius, "radius_m", true)?;
        let mass = match self.is_density {
            false => number(self.mass, "mass_kg", true)?,
            true => {
                let density = number(self.mass, "density_kg_per_m2", true)?;
                density * std::f64::consts::PI * radius * radius
            }
        };
        if !mass.is_normal() || !(0.5 * mass * radius * radius).is_normal() {
            return Err(fault("radius_m", "mass or moment of inertia out of range".to_owned()));
        }
        let inner = radius * (1.0 - DEEPEST_IN_WALL);
        if x < inner || x > width - inner {
            return Err(fault(
                "x_m",
                format!("the grain at {x} m is outside of the box, 0 to {width} m"),
            ));
        }
        if y < inner {
            return Err(fault("y_m", format!("the grain at {y} m is below the bottom, 0 m")));
        }
        Ok(CsvGrain { x, y, radius, mass })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn faults(text: &str) -> String {
        let faults = read_planar(text.as_bytes(), 1.0).expect_err("a faulty table");
        faults.iter().map(|fault| format!("{fault}\n")).collect()
    }

    #[test]
    fn byte_order_mark_and_crlf_are_accepted() {
        let text = "\u{feff}x_m,y_m,radius_m,mass_kg,colour\r\n0.5,0.1,0.01,1e-3,red\r\n";
        let table = read_planar(text.as_bytes(), 1.0).expect("a good table");
        assert_eq!(table.grains, [CsvGrain { x: 0.5, y: 0.1, radius: 0.01, mass: 1e-3 }]);
        assert_eq!(table.warnings, ["the column `colour` is ignored"]);
    }

    #[test]
    fn faults_name_line_and_column() {
        let header = "x_m,y_m,radius_m,mass_kg\n";
        assert_eq!(
            faults(&format!("{header}0.5,0.1,0.01,1e-3\n0.5,0.1,-0.01,1e-3\n0.5,nan,0.01,1\n")),
            "line 3: column radius_m: found \"-0.01\"; a positive number is wanted\n\
             line 4: column y_m: found \"nan\"; a number is wanted\n"
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
