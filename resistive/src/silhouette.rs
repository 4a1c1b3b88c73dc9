//! What of a body is in the medium, by the depth of its lowest point.

pub use engine::grains::Space;

/// The shape of a compact body that enters along its axis and keeps its attitude.
///
/// All areas are m² and volumes m³; of a planar body m and m².
pub trait Silhouette: Send + Sync {
    /// Diameter (m).
    fn diameter(&self) -> f64;

    /// Height from the lowest point to the highest (m).
    fn height(&self) -> f64;

    /// Area that the whole body shows along its axis.
    fn frontal_area(&self) -> f64;

    /// Area that the portion below the surface shows along the axis, at `depth` (m) above zero.
    fn immersed_area(&self, depth: f64) -> f64;

    /// Area of the section of the body at the surface.
    fn section(&self, depth: f64) -> f64;

    /// Volume below the surface.
    fn volume(&self, depth: f64) -> f64;
    /// Area of the surface of the body that is below the bed's: the leading face and, of a cylinder,
    /// the side, which touches grains but is not driven into them. The top does not count.
    ///
    /// Spatial: cap 2πRz up to its equator, cylinder πR² + 2πRz, cone πz² tan(a)/cos(a) with half its
    /// apex angle a: the geometric contact areas of hemispheres, cylinders and cones in granular impact.
    fn contact_area(&self, depth: f64) -> f64;
}
