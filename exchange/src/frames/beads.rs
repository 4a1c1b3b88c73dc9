//! Bodies among particles: a body that is not round is beads on its surface.
//!
//! A sphere around a cone or a link would cover grains that the body never touches, and beads show where it
//! is, how it is turned and how each of its points moves. They lie on the surface, not in it: each stands
//! out by its radius.

use std::f64::consts::PI;

use super::surfaces::{Surface, cross};

/// Beads of a surface: enough to see an edge by, few beside the grains of a bed.
const BEADS: usize = 1000;

/// Steps of an even sequence in a square: the first two powers of the inverse of the plastic number.
///
/// Source: M. Roberts, The unreasonable effectiveness of quasirandom sequences (2018).
const STEPS: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2];

/// A sphere that stands for a body or for a share of its surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bead {
    /// (m).
    pub(super) centre: [f64; 3],
    /// (m).
    pub(super) radius: f64,
}

/// Beads on `surface`, spread evenly over its area, each with the cross-section of its share.
pub(super) fn on(surface: &Surface) -> Vec<Bead> {
    let corner = |index: u32| surface.corners[index as usize];
    let triangles: Vec<[[f64; 3]; 3]> =
        surface.triangles.iter().map(|corners| corners.map(corner)).collect();
    let areas: Vec<f64> = triangles.iter().map(area).collect();
    let whole: f64 = areas.iter().sum();
    let share = whole / BEADS as f64;
    let radius = (share / PI).sqrt();
    let (mut beads, mut passed) = (Vec::with_capacity(BEADS), 0.0);
    for (triangle, area) in triangles.iter().zip(areas) {
        passed += area;
        // The bead of a share lies where half of it has been passed.
        while beads.len() < BEADS && (beads.len() as f64 + 0.5) * share < passed {
            let centre = within(triangle, beads.len());
            beads.push(Bead { centre, radius });
        }
    }
    beads
}

/// A point of a triangle: number `index` of an even sequence.
fn within([a, b, c]: &[[f64; 3]; 3], index: usize) -> [f64; 3] {
    let [mut u, mut v] = STEPS.map(|step| (step * (index as f64 + 1.0)).fract());
    if u + v > 1.0 {
        (u, v) = (1.0 - u, 1.0 - v);
    }
    [0, 1, 2].map(|axis| a[axis] + u * (b[axis] - a[axis]) + v * (c[axis] - a[axis]))
}

fn area([a, b, c]: &[[f64; 3]; 3]) -> f64 {
    let edge = |to: &[f64; 3]| [0, 1, 2].map(|axis| to[axis] - a[axis]);
    let normal = cross(edge(b), edge(c));
    0.5 * normal.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::super::surfaces::barrel;
    use super::*;

    #[test]
    fn beads_lie_on_the_surface_as_many_on_each_part_as_its_area_asks_for() {
        let barrel = barrel();
        let beads = on(&barrel);
        assert_eq!(beads.len(), BEADS);
        let on_a_lid = |bead: &&Bead| (bead.centre[2].abs() - 0.5).abs() < 1e-12;
        let lids = beads.iter().filter(on_a_lid).count();
        // A third of a cylinder as wide as high: 2 π/4 of 2 π/4 + π; a bead more or less at each end.
        assert!(lids.abs_diff(BEADS / 3) <= 2, "{lids}");
        for Bead { centre: [x, y, z], radius } in beads.iter().filter(|bead| !on_a_lid(bead)) {
            let from_axis = (x * x + y * y).sqrt();
            // Chords of 48 corners come as near as cos(π/48) = 0.9979 of the radius.
            assert!((0.9978 * 0.5..=0.5 + 1e-12).contains(&from_axis) && z.abs() < 0.5);
            // A thousandth of 3π/2, as a disc: sqrt(0.0015); 48 corners lack 0.3 % of the area.
            assert!((radius / 0.0015_f64.sqrt() - 1.0).abs() < 3e-3, "{radius}");
        }
        let around = |from: f64, to: f64| {
            let angle = |bead: &&Bead| libm::atan2(bead.centre[1], bead.centre[0]);
            beads.iter().filter(|bead| (from..to).contains(&angle(bead))).count()
        };
        for quarter in [-PI, -0.5 * PI, 0.0, 0.5 * PI] {
            let n = around(quarter, quarter + 0.5 * PI);
            // By area; a bead more or less at each end of the lids and the side.
            assert!(n.abs_diff(BEADS / 4) <= 6, "{n} of a quarter");
        }
    }

    #[test]
    fn a_surface_without_area_has_no_beads() {
        assert!(on(&Surface::default()).is_empty());
        let point = Surface { corners: vec![[1.0; 3]], triangles: vec![[0, 0, 0]] };
        assert!(on(&point).is_empty());
    }
}
