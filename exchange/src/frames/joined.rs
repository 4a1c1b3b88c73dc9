//! Which grains of a frame are of the bed, and which are in the air.

use std::collections::BTreeMap;

use super::grain::Grain;

/// Grains touch where their distance is less than this part of the sum of their radii: places in a log are single
/// numbers, and a grain that bounces on the bed is of it.
const TOUCHING: f32 = 1.02;

/// The corner of a cell of a grid.
type Cell = [i64; 3];

/// Which `grains` a chain of contacts joins to the lowest of them. Grains that fly, alone or in contact with each
/// other, are not.
pub(super) fn joined_to_the_lowest(grains: &[Grain]) -> Vec<bool> {
    let mut joined = vec![false; grains.len()];
    let width = 2.0 * TOUCHING * grains.iter().fold(0.0_f32, |most, grain| most.max(grain.radius));
    let is_lower = |a: &(usize, &Grain), b: &(usize, &Grain)| {
        let bottom = |grain: &Grain| grain.position[2] - grain.radius;
        bottom(a.1).total_cmp(&bottom(b.1))
    };
    let Some((lowest, _)) = grains.iter().enumerate().min_by(is_lower) else { return joined };
    if width.is_nan() || width <= 0.0 {
        return joined;
    }
    let cell = |grain: &Grain| grain.position.map(|x| i64::from((x / width).floor() as i32));
    let mut cells: BTreeMap<Cell, Vec<usize>> = BTreeMap::new();
    for (at, grain) in grains.iter().enumerate() {
        cells.entry(cell(grain)).or_default().push(at);
    }
    // The floor carries grains that have no contact with each other.
    let floor = grains[lowest].position[2] - grains[lowest].radius + 0.1 * grains[lowest].radius;
    let on_floor = |at: &usize| grains[*at].position[2] - grains[*at].radius <= floor;
    let mut next: Vec<usize> = (0..grains.len()).filter(on_floor).collect();
    next.iter().for_each(|at| joined[*at] = true);
    while let Some(from) = next.pop() {
        let [x, y, z] = cell(&grains[from]);
        let around = (-1..=1)
            .flat_map(|dx| (-1..=1).flat_map(move |dy| (-1..=1).map(move |dz| [dx, dy, dz])));
        for [dx, dy, dz] in around {
            for &to in cells.get(&[x + dx, y + dy, z + dz]).into_iter().flatten() {
                if !joined[to] && touch(&grains[from], &grains[to]) {
                    joined[to] = true;
                    next.push(to);
                }
            }
        }
    }
    joined
}

fn touch(a: &Grain, b: &Grain) -> bool {
    let square = |axis: usize| (a.position[axis] - b.position[axis]).powi(2);
    let reach = TOUCHING * (a.radius + b.radius);
    square(0) + square(1) + square(2) <= reach * reach
}

#[cfg(test)]
mod tests {
    use super::super::Frame;
    use super::*;

    const RADIUS: f32 = 1e-3;

    fn grain(id: usize, x: f32, z: f32) -> Grain {
        Grain { id: id as u32, position: [x, 0.0, z], radius: RADIUS, ..Grain::default() }
    }

    /// Columns of discs on each other, `height(k)` of them in the column `k`.
    fn columns(n: usize, height: impl Fn(usize) -> usize) -> Frame {
        let mut grains = Vec::new();
        for column in 0..n {
            for row in 0..height(column) {
                let place = |at: usize| RADIUS * (2.0 * at as f32 + 1.0);
                grains.push(grain(grains.len(), place(column), place(row)));
            }
        }
        Frame { grains, ..Frame::default() }
    }

    #[test]
    fn grains_in_the_air_are_not_of_the_bed_even_where_they_touch_each_other() {
        let mut frame = columns(5, |_| 3);
        let n = frame.grains.len();
        frame.grains.push(grain(n, 5e-3, 12e-3));
        frame.grains.push(grain(n + 1, 7e-3, 12e-3));
        let joined = joined_to_the_lowest(&frame.grains);
        assert!(joined[..n].iter().all(|joined| *joined));
        assert_eq!(joined[n..], [false, false]);
    }

    #[test]
    fn the_crater_of_a_known_heap_is_its_outline() {
        // A hole of slope 1 in columns of 20, with two grains in flight over it.
        let middle = 20_usize;
        let high = |column: usize| 6 + column.abs_diff(middle).min(14);
        let mut frame = columns(41, high);
        let n = frame.grains.len();
        frame.grains.push(grain(n, 41e-3, 60e-3));
        frame.grains.push(grain(n + 1, 43e-3, 60e-3));
        let axis = f64::from(RADIUS) * (2.0 * middle as f64 + 1.0);
        let surface = frame.crater(axis, 0.0);
        assert!(surface.len() >= 38, "{}", surface.len());
        for point in &surface {
            // An interval is half of one column and half of the next; the top of a disc is on average π/4 of a
            // radius over its centre, and columns differ by a diameter.
            let beside = (point.distance.abs() / 2e-3).min(14.0) + 6.0;
            let top = 2e-3 * beside - 1e-3 * (1.0 - std::f64::consts::FRAC_PI_4);
            assert!((point.position.z - top).abs() < 1.05e-3, "{point:?}, not {top}");
        }
    }
}
