//! Memory that goes by the size of a container, however few grains are in it.

use super::report::spacing;
use crate::boundary::Container;
use crate::space::Space;

/// Layers of cells in which grains are placed, at least.
const LAYERS: f64 = 2.0;

/// The larger of two memories (byte): that of the cells in which grains up to the diameter `largest` (m) are placed, and that
/// of the columns in which the height of a bed of grains of diameter `mean` (m) is measured. It may be infinite.
pub fn container_bytes((space, container): (Space, &Container), [largest, mean]: [f64; 2]) -> f64 {
    let [width, depth] = container.extents();
    let over = |size: f64| {
        let along = |length: f64| (length / size).max(1.0);
        match space {
            Space::Planar => along(width),
            Space::Spatial => along(width) * along(depth),
        }
    };
    let cells = LAYERS * over(largest) * size_of::<Vec<usize>>() as f64;
    let columns = over(spacing(space) * mean) * size_of::<f64>() as f64;
    cells.max(columns)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_costs_as_much_as_it_has_cells_and_columns() {
        let room = Container::walled_box(10.0, 1.0);
        // 2 layers of 1000 cells of 24 bytes; columns 50 to a diameter, 8 bytes each.
        let planar = container_bytes((Space::Planar, &room), [0.01, 0.01]);
        assert!((planar / (1000.0 * 50.0 * 8.0) - 1.0).abs() < 1e-12);
        let many_sizes = container_bytes((Space::Planar, &room), [0.01, 1.0]);
        assert!((many_sizes / (1000.0 * 2.0 * 24.0) - 1.0).abs() < 1e-12);
        let spatial = container_bytes((Space::Spatial, &room), [0.01, 0.01]);
        assert!((spatial / (1000.0 * 100.0 * 100.0 * 8.0) - 1.0).abs() < 1e-12);
        let endless = Container::walled_box(1e307, 1e307);
        assert!(container_bytes((Space::Spatial, &endless), [0.01, 0.01]).is_infinite());
    }
}
