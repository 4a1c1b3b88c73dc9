//! A set in a few lines of plain text.

use crate::{Bed, Condition, Geometry, Kind, Loaded, MeasurementSet, Role, Run};

impl Loaded {
    /// [`MeasurementSet::describe`] with the columns that were understood.
    pub fn describe(&self) -> String {
        self.set.describe_with(&self.tables)
    }
}

impl MeasurementSet {
    /// What the set holds, for a reader at a terminal: conditions, roles, runs, units and notes.
    pub fn describe(&self) -> String {
        self.describe_with(&[])
    }

    /// The same with a line for each table.
    fn describe_with(&self, tables: &[String]) -> String {
        let kind = match (self.kind.curve(), self.kind) {
            (Some(curve), _) => curve.plural,
            (None, Kind::Scalar) => "scalars",
            (None, _) => "trajectories",
        };
        let (conditions, runs) = (self.conditions.len(), self.runs.len());
        let holdout = self.conditions.iter().filter(|one| one.role == Role::Holdout).count();
        let mut text = format!(
            "{}: {kind}, {conditions} conditions ({holdout} held out), {runs} runs\n",
            self.id
        );
        if self.beds.is_empty() {
            text.push_str(&describe_bed("", &self.bed));
        }
        for named in &self.beds {
            text.push_str(&describe_bed(&format!("{}: ", named.name), &named.bed));
        }
        if let Some(baseline) = &self.baseline {
            text.push_str(&format!("baseline {baseline}\n"));
        }
        text.push('\n');
        text.push_str(&aligned(&self.rows()));
        text.push('\n');
        for table in tables {
            text.push_str(&format!("{table}\n"));
        }
        if let Some(source) = &self.source {
            text.push_str(&format!("source: {}\n", source.trim()));
        }
        for note in &self.notes {
            text.push_str(&format!("note: {note}\n"));
        }
        text
    }

    fn rows(&self) -> Vec<Vec<String>> {
        let heads = [
            "condition",
            "role",
            "speed (m/s)",
            "angle (deg)",
            "shape",
            "diameter (m)",
            "mass (kg)",
            "runs",
            "readings",
            "measured",
        ];
        let mut rows = vec![heads.map(str::to_owned).to_vec()];
        for (index, condition) in self.conditions.iter().enumerate() {
            let runs: Vec<&Run> = self.runs.iter().filter(|run| run.condition == index).collect();
            let moves_along = runs.iter().flat_map(|run| &run.frames).any(|frame| frame.x != 0.0);
            let path = if moves_along { "z(t), x(t)" } else { "z(t)" };
            let function = self.kind.curve().map_or(path, |curve| curve.function);
            rows.push(row(condition, &runs, function));
        }
        rows
    }
}

fn row(condition: &Condition, runs: &[&Run], function: &str) -> Vec<String> {
    let any = |has: fn(&Run) -> bool| runs.iter().any(|run| has(run));
    let measured = [
        ("stop_time", any(|run| run.stop_time.is_some())),
        ("final_z", any(|run| run.final_z.is_some())),
        ("final_x", any(|run| run.final_x.is_some())),
        ("crater_depth", any(|run| run.crater.depth.is_some())),
        ("rim_diameter", any(|run| run.crater.rim_diameter.is_some())),
        (function, any(|run| run.has_readings())),
    ];
    let measured: Vec<&str> =
        measured.iter().filter(|(_, is_there)| *is_there).map(|(name, _)| *name).collect();
    vec![
        condition.id.clone(),
        condition.role.word().to_owned(),
        condition.speed.to_string(),
        condition.angle_deg.to_string(),
        condition.shape.clone(),
        condition.diameter.to_string(),
        if condition.mass > 0.0 { condition.mass.to_string() } else { String::from("-") },
        runs.len().to_string(),
        runs.iter().map(|run| run.frames.len() + run.samples.len()).sum::<usize>().to_string(),
        measured.join(", "),
    ]
}

/// Rows with their columns below each other.
fn aligned(rows: &[Vec<String>]) -> String {
    let width = |column: usize| {
        rows.iter().map(|row| row[column].chars().count()).max().unwrap_or_default()
    };
    let widths: Vec<usize> = (0..rows.first().map_or(0, Vec::len)).map(width).collect();
    let mut text = String::new();
    for row in rows {
        let cells = row.iter().zip(&widths).map(|(cell, width)| format!("{cell:<width$}"));
        text.push_str(cells.collect::<Vec<_>>().join("  ").trim_end());
        text.push('\n');
    }
    text
}

/// What `bed` is, in a line that begins with `name`.
fn describe_bed(name: &str, bed: &Bed) -> String {
    let (kind, unit) = match bed.geometry {
        Geometry::Planar => ("planar", "kg/m^2"),
        Geometry::Spatial => ("three-dimensional", "kg/m^3"),
    };
    let mut parts = vec![format!("{name}{kind} bed")];
    parts.extend(bed.bulk_density.map(|density| format!("{density} {unit}")));
    parts.extend(bed.grain_diameter.map(|diameter| format!("grains of {diameter} m")));
    parts.extend(bed.stated.fluid.map(|fluid| {
        format!("under a fluid of {} kg/m^3 and {} Pa s", fluid.density, fluid.viscosity)
    }));
    parts.push(format!("gravity {} m/s^2", bed.gravity));
    format!("{}\n", parts.join(", "))
}
