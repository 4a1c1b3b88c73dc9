//! A set as a folder that reads back to the same set.

use std::fmt::Write as _;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use configs::toml_string as quoted;
use engine::checkpoint::write_whole;
use thiserror::Error;

use crate::curves::curve::Curve;
use crate::{
    Bed, Condition, Crater, Feasible, Geometry, Kind, MeasurementSet, ParameterPrior, Run,
};

/// Why a set cannot be written.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum WriteError {
    #[error("{path}: {source}", path = path.display())]
    Io { path: PathBuf, source: io::Error },
    #[error("the run `{0}` cannot be written: blanks at its ends, a line break, or nothing at all")]
    Name(String),
}

impl MeasurementSet {
    /// Writes `measurement.toml` and its tables into `folder`, which is made where it is missing.
    /// [`MeasurementSet::load`] gives the same set again, down to the bit.
    ///
    /// # Errors
    /// When a file cannot be written, or the name of a run does not fit into a cell.
    pub fn write(&self, folder: &Path) -> Result<(), WriteError> {
        let fits =
            |name: &str| name.trim() == name && !name.is_empty() && !name.contains(['\n', '\r']);
        if let Some(run) = self.runs.iter().find(|run| !fits(&run.name)) {
            return Err(WriteError::Name(run.name.clone()));
        }
        fs::create_dir_all(folder)
            .map_err(|source| WriteError::Io { path: folder.to_owned(), source })?;
        put(&folder.join("runs.csv"), self.runs_table())?;
        if self.kind == Kind::Trajectory {
            put(&folder.join("trajectories.csv"), self.trajectory_table())?;
        }
        if let Some(curve) = self.kind.curve() {
            put(&folder.join(table_name(curve)), self.curve_table(curve))?;
        }
        put(&folder.join("measurement.toml"), Ok(self.toml().into_bytes()))
    }

    fn toml(&self) -> String {
        let mut file = Toml(String::from("schema = 1\n"));
        file.table("[measurement]");
        file.word("id", &self.id);
        let curve = self.kind.curve();
        file.word(
            "kind",
            match (curve, self.kind) {
                (Some(curve), _) => curve.word,
                (None, Kind::Scalar) => "scalar",
                (None, _) => "trajectory",
            },
        );
        file.text("source", self.source.as_deref());
        file.word("stop_definition", self.stop.word());
        file.word("final", self.last.word());
        file.word("surface_definition", self.surface.word());
        let notes: Vec<String> = self.notes.iter().map(|note| quoted(note)).collect();
        file.line("notes", &format!("[{}]", notes.join(", ")));
        if !self.keep.is_empty() {
            let keep: Vec<String> = self.keep.iter().map(|name| quoted(name)).collect();
            file.line("keep", &format!("[{}]", keep.join(", ")));
        }
        file.table("[instrument]");
        file.number("rate_hz", self.instrument.rate);
        file.number("position_sigma_m", self.instrument.position_sigma);
        file.number("force_sigma_N", self.instrument.force_sigma);
        file.number("acceleration_sigma_m_s2", self.instrument.acceleration_sigma);
        file.number("velocity_sigma_m_s", self.instrument.velocity_sigma);
        file.number("spin_sigma_rad_s", self.instrument.spin_sigma);
        file.number("acceleration_range_m_s2", self.instrument.acceleration_range);
        file.number("speed_sigma_rel", self.instrument.speed_sigma_rel);
        file.number("angle_sigma_deg", self.instrument.angle_sigma_deg);
        file.number("level_sigma_m", self.instrument.level_sigma);
        file.number("time_sigma_s", self.instrument.time_sigma);
        file.number("zero_sigma_m", self.instrument.zero_sigma);
        file.number("surface_sigma_m", self.instrument.surface_sigma);
        file.number("speed_bias_sigma_rel", self.instrument.speed_bias_sigma_rel);
        file.number("angle_bias_sigma_deg", self.instrument.angle_bias_sigma_deg);
        file.number("scale_sigma_rel", self.instrument.scale_sigma_rel);
        file.number("mass_sigma_rel", self.instrument.mass_sigma_rel);
        file.number("tilt_sigma_deg", self.instrument.tilt_sigma_deg);
        file.number("session_sigma_rel", self.instrument.session_sigma_rel);
        if self.beds.is_empty() {
            file.table("[bed]");
            file.bed(&self.bed);
        }
        for named in &self.beds {
            file.table("[[bed]]");
            file.text("name", Some(&named.name));
            file.bed(&named.bed);
        }
        file.table("[model]");
        file.text("baseline", self.baseline.as_deref());
        file.table("[noise]");
        file.number("stop_time_rel", self.stated.stop_time);
        file.number("final_z_rel", self.stated.final_z);
        file.number("final_x_rel", self.stated.final_x);
        file.feasible(&self.feasible);
        if !self.priors.is_empty() {
            file.table("[parameters]");
            for (name, prior) in self.priors.iter().map(ParameterPrior::line) {
                file.line(&name, &prior);
            }
        }
        file.table("[files]");
        file.word("runs", "runs.csv");
        match curve {
            Some(curve) => file.word(curve.files, &table_name(curve)),
            None if self.kind == Kind::Trajectory => file.word("trajectories", "trajectories.csv"),
            None => {}
        }
        // The names of conditions and runs may hold what would look like a separator.
        file.word("delimiter", ",");
        file.word("decimal", ".");
        for condition in &self.conditions {
            let bed = condition.bed.map(|at| self.beds[at].name.as_str());
            file.condition(condition, bed, self.kind);
        }
        file.0
    }

    fn runs_table(&self) -> io::Result<Vec<u8>> {
        let count = |value: Option<i64>| value.map_or(String::new(), |value| value.to_string());
        const HEADER: [&str; 10] = [
            "run",
            "condition",
            "repeat",
            "order",
            "stop_time",
            "final_z",
            "final_x",
            "session",
            "crater_depth",
            "rim_diameter",
        ];
        let any = |has: fn(&Run) -> bool| self.runs.iter().any(has);
        let has_craters = any(|run| run.crater != Crater::default());
        let columns: Vec<usize> = (0..HEADER.len())
            .filter(|at| match at {
                7 => any(|run| run.session.is_some()),
                8 | 9 => has_craters,
                _ => true,
            })
            .collect();
        let mut table = csv_writer();
        table.write_record(columns.iter().map(|&at| HEADER[at]))?;
        for run in &self.runs {
            let cells = [
                run.name.as_str(),
                &self.conditions[run.condition].id,
                &count(run.repeat),
                &count(run.order),
                &cell(run.stop_time),
                &cell(run.final_z),
                &cell(run.final_x),
                run.session.as_deref().unwrap_or_default(),
                &cell(run.crater.depth),
                &cell(run.crater.rim_diameter),
            ];
            table.write_record(columns.iter().map(|&at| cells[at]))?;
        }
        table.into_inner().map_err(|error| error.into_error())
    }

    fn trajectory_table(&self) -> io::Result<Vec<u8>> {
        let has_sigma = |run: &Run| run.frames.iter().any(|frame| frame.sigma.is_some());
        let columns = if self.runs.iter().any(has_sigma) { 5 } else { 4 };
        let mut table = csv_writer();
        table.write_record(&["run", "t", "z", "x", "sigma_z"][..columns])?;
        for run in &self.runs {
            for frame in &run.frames {
                let [t, z, x] = [frame.t, frame.z, frame.x].map(|value| cell(Some(value)));
                let cells = [run.name.as_str(), &t, &z, &x, &cell(frame.sigma)];
                table.write_record(&cells[..columns])?;
            }
        }
        table.into_inner().map_err(|error| error.into_error())
    }

    fn curve_table(&self, curve: &Curve) -> io::Result<Vec<u8>> {
        let has_sigma = |run: &Run| run.samples.iter().any(|sample| sample.sigma.is_some());
        let columns = if self.runs.iter().any(has_sigma) { 4 } else { 3 };
        let mut table = csv_writer();
        table.write_record(&curve.columns[0].map(|column| column.key)[..columns])?;
        for run in &self.runs {
            for sample in &run.samples {
                let [at, value] = [sample.at, sample.value].map(|value| cell(Some(value)));
                let cells = [run.name.as_str(), &at, &value, &cell(sample.sigma)];
                table.write_record(&cells[..columns])?;
            }
        }
        table.into_inner().map_err(|error| error.into_error())
    }
}

/// The name of a table of curves.
fn table_name(curve: &Curve) -> String {
    format!("{}.csv", curve.files)
}

fn csv_writer() -> csv::Writer<Vec<u8>> {
    // A name that begins like a comment is quoted.
    csv::WriterBuilder::new().comment(Some(b'#')).from_writer(Vec::new())
}

/// The shortest text that reads back to the same bits.
fn cell(value: Option<f64>) -> String {
    value.map_or(String::new(), |value| format!("{value:?}"))
}

/// A name that is there is a whole file.
fn put(path: &Path, content: io::Result<Vec<u8>>) -> Result<(), WriteError> {
    content
        .and_then(|content| write_whole(path, &content))
        .map_err(|source| WriteError::Io { path: path.to_owned(), source })
}

/// `measurement.toml` under construction.
struct Toml(String);

impl Toml {
    fn table(&mut self, header: &str) {
        let _ = writeln!(self.0, "\n{header}");
    }

    fn line(&mut self, key: &str, value: &str) {
        let _ = writeln!(self.0, "{key} = {value}");
    }

    fn word(&mut self, key: &str, value: &str) {
        self.line(key, &quoted(value));
    }

    fn text(&mut self, key: &str, value: Option<&str>) {
        if let Some(value) = value {
            self.word(key, value);
        }
    }

    fn number(&mut self, key: &str, value: Option<f64>) {
        if let Some(value) = value {
            self.line(key, &format!("{value:?}"));
        }
    }

    fn numbers(&mut self, key: &str, values: &[f64]) {
        if !values.is_empty() {
            self.line(key, &format!("{values:?}"));
        }
    }

    fn feasible(&mut self, feasible: &Feasible) {
        if *feasible == Feasible::default() {
            return;
        }
        self.table("[feasible]");
        self.numbers("speed", feasible.speed.as_ref().map_or(&[], |range| &range[..]));
        for (key, values) in feasible.lists() {
            self.numbers(key, values);
        }
        if let Some(cost) = &feasible.cost {
            let entries = cost.entries().map(|(key, value)| format!("{key} = {value:?}"));
            self.line("cost", &format!("{{ {} }}", entries.join(", ")));
        }
    }

    fn bed(&mut self, bed: &Bed) {
        self.word("geometry", if bed.geometry == Geometry::Planar { "2d" } else { "3d" });
        self.number("bulk_density", bed.bulk_density);
        self.number("gravity", Some(bed.gravity));
        self.number("grain_diameter", bed.grain_diameter);
        let stated = &bed.stated;
        for (key, value) in [
            ("fluid_density", stated.fluid.map(|fluid| fluid.density)),
            ("fluid_viscosity", stated.fluid.map(|fluid| fluid.viscosity)),
            ("packing_fraction", stated.packing_fraction),
            ("packing_fraction_sigma", stated.packing_fraction_sigma),
            ("surface_height", stated.surface_height),
            ("surface_height_sigma", stated.surface_height_sigma),
            ("bulk_density_sigma", stated.bulk_density_sigma),
            ("grain_diameter_sigma", stated.grain_diameter_sigma),
            ("coordination", stated.coordination),
            ("coordination_sigma", stated.coordination_sigma),
        ] {
            self.number(key, value);
        }
    }

    /// `bed` is the name of its bed, in a set of several.
    fn condition(&mut self, condition: &Condition, bed: Option<&str>, kind: Kind) {
        self.table("[[condition]]");
        self.word("id", &condition.id);
        self.word("role", condition.role.word());
        self.number("speed", Some(condition.speed));
        self.number("angle_deg", Some(condition.angle_deg));
        self.word("shape", &condition.shape);
        self.number("diameter", Some(condition.diameter));
        let is_stated = kind != Kind::ForceDepth || condition.mass > 0.0;
        self.number("mass", Some(condition.mass).filter(|_| is_stated));
        self.number("spin", Some(condition.spin));
        self.text("bed", bed);
        self.number("packing", condition.packing);
        self.number("bed_depth", condition.bed_depth);
        self.number("length", condition.length);
        self.number("height", condition.height);
        self.number("shaft_diameter", condition.shaft_diameter);
        self.number("apex_deg", condition.apex_deg);
        self.number("link_angle_deg", condition.link_angle_deg);
    }
}
