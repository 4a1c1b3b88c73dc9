//! The table that LAMMPS writes of the intruder, read back.

use std::path::Path;

use engine::math::Vec3;
use serde::Deserialize;

use super::import::error::ImportError;

/// The intruder, and the energies of the grains, at one time; in SI, along the axes of plunge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sample {
    pub(super) step: u64,
    /// Since first contact.
    pub(super) time: f64,
    pub(super) position: Vec3,
    pub(super) velocity: Vec3,
    pub(super) spin: Vec3,
    /// Of contacts and of gravity.
    pub(super) force: Vec3,
    pub(super) torque: Vec3,
    /// Of the grains: translation, rotation, height (J).
    pub(super) energies: [f64; 3],
}

/// A line of the table. In a plane it lacks what is zero.
#[derive(Deserialize)]
struct Row {
    step: u64,
    time_s: f64,
    x_m: f64,
    #[serde(default)]
    y_m: f64,
    z_m: f64,
    vx_m_per_s: f64,
    #[serde(default)]
    vy_m_per_s: f64,
    vz_m_per_s: f64,
    #[serde(rename = "fx_N")]
    force_x: f64,
    #[serde(rename = "fy_N", default)]
    force_y: f64,
    #[serde(rename = "fz_N")]
    force_z: f64,
    #[serde(default)]
    spin_x_rad_per_s: f64,
    spin_y_rad_per_s: f64,
    #[serde(default)]
    spin_z_rad_per_s: f64,
    #[serde(rename = "torque_x_N_m", default)]
    torque_x: f64,
    #[serde(rename = "torque_y_N_m")]
    torque_y: f64,
    #[serde(rename = "torque_z_N_m", default)]
    torque_z: f64,
    #[serde(rename = "kinetic_grains_translation_J")]
    translation: f64,
    #[serde(rename = "kinetic_grains_rotation_J")]
    rotation: f64,
    #[serde(rename = "potential_grains_J")]
    height: f64,
}

impl From<Row> for Sample {
    fn from(row: Row) -> Self {
        Self {
            step: row.step,
            time: row.time_s,
            position: Vec3::new(row.x_m, row.y_m, row.z_m),
            velocity: Vec3::new(row.vx_m_per_s, row.vy_m_per_s, row.vz_m_per_s),
            spin: Vec3::new(row.spin_x_rad_per_s, row.spin_y_rad_per_s, row.spin_z_rad_per_s),
            force: Vec3::new(row.force_x, row.force_y, row.force_z),
            torque: Vec3::new(row.torque_x, row.torque_y, row.torque_z),
            energies: [row.translation, row.rotation, row.height],
        }
    }
}

/// The samples in the table at `path`, whose text is `text`, up to its last whole line: LAMMPS may have
/// been stopped in the middle of one.
pub(super) fn samples(path: &Path, text: &str) -> Result<Vec<Sample>, ImportError> {
    let whole = text.rfind('\n').map_or("", |end| &text[..=end]);
    let refused = |why: String| ImportError::Misread { path: path.to_owned(), why };
    let mut samples: Vec<Sample> = Vec::new();
    for row in csv::Reader::from_reader(whole.as_bytes()).deserialize::<Row>() {
        let sample = Sample::from(row.map_err(|error| refused(error.to_string()))?);
        if samples.last().is_some_and(|last| last.step >= sample.step) {
            return Err(refused(format!("step {} stands behind a later one", sample.step)));
        }
        samples.push(sample);
    }
    match samples.len() {
        0 | 1 => Err(refused("it has fewer than two lines of numbers".to_owned())),
        _ => Ok(samples),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "\n\
step,time_s,x_m,z_m,vx_m_per_s,vz_m_per_s,fx_N,fz_N,spin_y_rad_per_s,torque_y_N_m,\
kinetic_grains_translation_J,kinetic_grains_rotation_J,potential_grains_J\n\
0,0,0.02,0.015,0,-2,0,-0.0981,-3,0,0,0,1.5e-4\n\
10,1e-4,0.02,0.0148,0.25,-1.9,1,2,-2.5,0.125,1e-6,2e-7,1.4e-4\n";

    fn read(text: &str) -> Result<Vec<Sample>, String> {
        samples(Path::new("intruder.csv"), text).map_err(|error| error.to_string())
    }

    #[test]
    fn what_a_planar_table_lacks_is_zero_and_a_cut_line_is_left_out() {
        let read = read(&format!("{TABLE}20,2e-4,0.02,0.01")).expect("two lines");
        assert_eq!(read.len(), 2);
        let last = read[1];
        assert_eq!((last.step, last.time), (10, 1e-4));
        assert_eq!(last.velocity, Vec3::new(0.25, 0.0, -1.9));
        assert_eq!(last.force, Vec3::new(1.0, 0.0, 2.0));
        assert_eq!((last.spin.y, last.torque.y), (-2.5, 0.125));
        assert_eq!(last.energies.map(f64::to_bits), [1e-6, 2e-7, 1.4e-4].map(f64::to_bits));
    }

    #[test]
    fn what_is_no_such_table_is_refused_with_its_reason() {
        let no_force = TABLE.replace("fz_N", "fz");
        let twice = format!("{TABLE}{}", TABLE.lines().last().expect("a line")) + "\n";
        for (text, part) in [
            (no_force.as_str(), "fz_N"),
            (twice.as_str(), "step 10"),
            (TABLE.split_at(TABLE.len() - 70).0, "fewer than two"),
            ("", "fewer than two"),
            (&TABLE.replace("1.4e-4", "lost"), "field 12"),
        ] {
            let why = read(text).expect_err(part);
            assert!(why.contains(part), "`{part}` is not in {why}");
        }
    }
}
