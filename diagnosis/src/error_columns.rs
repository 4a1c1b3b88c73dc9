//! The columns of a table of errors.

use crate::observable::Observable;

/// A column: errors of one kind of number, or of all scalars together.
pub struct Column {
    /// Key of the errors in JSON.
    pub key: &'static str,
    /// What it says, with the unit.
    pub heading: String,
    /// How many of its unit are one of SI.
    pub scale: f64,
}

/// Every column, in the order of [`Observable::ALL`]; the last is relative.
#[must_use]
pub fn columns() -> Vec<Column> {
    let of_kind = |observable: Observable| {
        let (name, unit, scale) = match observable {
            Observable::Depth => ("z", "mm", 1e3),
            Observable::Range => ("x", "mm", 1e3),
            Observable::StopTime => ("stop time", "ms", 1e3),
            Observable::FinalDepth => ("depth", "mm", 1e3),
            Observable::FinalRange => ("range", "mm", 1e3),
            of_curve => {
                let [_, axis, _] = of_curve.axes();
                (axis.name, axis.unit, axis.scale)
            }
        };
        Column { key: observable.key(), heading: format!("{name} ({unit})"), scale }
    };
    let relative = Column { key: "rms_relative", heading: "relative (%)".to_owned(), scale: 1e2 };
    Observable::ALL.map(of_kind).into_iter().chain([relative]).collect()
}
