//! What measurements of a shape need to know of it beside its geometry.

/// Names of a shape and of its sizes in tables, and how it enters a bed.
#[derive(Debug)]
pub struct Measured {
    /// Other words for it in tables, lower case, of other languages too.
    pub words: &'static [&'static str],
    /// Keys of a measured condition that state its size beside the diameter.
    pub keys: &'static [&'static str],
    /// `None` for a shape whose lowest point does not fall as its mass does; no import makes such a body.
    pub tip: Option<TipForm>,
    /// Height (m) of the centre that cameras track above the lowest point, from diameter and height (m); `None` where there
    /// is no such centre.
    pub centre: fn(f64, Option<f64>) -> Option<f64>,
}

/// The part of a body that meets the bed first.
#[derive(Debug)]
pub struct TipForm {
    /// Power of the time since contact with which the path departs from free fall.
    pub departure: f64,
    /// Whether the lowest point of a body that spins falls as its mass does.
    pub is_round: bool,
    /// Share of the diameter that the tip goes into a bed without being braked noticeably.
    pub soft_entry: f64,
    /// Section in the surface over the largest, by depth below first contact in diameters and full apex angle (rad).
    pub section: fn(f64, f64) -> f64,
    /// Growth of the immersed volume with depth over the largest section, by the same.
    pub entering: fn(f64, f64) -> f64,
}

/// Section of a sphere over the largest, `depth` diameters below its lowest point; negative above its top.
pub(crate) fn spherical(depth: f64) -> f64 {
    4.0 * depth * (1.0 - depth)
}

/// The same in the surface, which lies against the widest section once that is below it.
pub(crate) fn of_sphere(depth: f64) -> f64 {
    if depth < 0.5 { spherical(depth) } else { 1.0 }
}

/// The centre of a shape without a tracked centre.
pub(crate) fn no_centre(_: f64, _: Option<f64>) -> Option<f64> {
    None
}
