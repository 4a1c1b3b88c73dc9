//! The columns of a table of errors.

use measurements::Axis;

use crate::forward::observable::Observable;

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
pub fn columns() -> Vec<Column> {
    let of_kind = |observable: Observable| {
        let Axis { name, unit, scale } = named(observable);
        Column { key: observable.key(), heading: format!("{name} ({unit})"), scale }
    };
    let relative = Column { key: "rms_relative", heading: "relative (%)".to_owned(), scale: 1e2 };
    Observable::ALL.map(of_kind).into_iter().chain([relative]).collect()
}

/// The name, unit and scale of a kind of number in tables.
pub fn named(observable: Observable) -> Axis {
    let [name, unit] = match observable {
        Observable::Depth => ["z", "mm"],
        Observable::Range => ["x", "mm"],
        Observable::StopTime => ["stop time", "ms"],
        Observable::FinalDepth => ["depth", "mm"],
        Observable::FinalRange => ["range", "mm"],
        Observable::CraterDepth => ["crater depth", "mm"],
        Observable::RimDiameter => ["rim diameter", "mm"],
        of_curve => {
            let [_, axis, _] = of_curve.axes();
            return axis;
        }
    };
    Axis { name, unit, scale: 1e3 }
}
