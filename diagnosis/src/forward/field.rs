//! A force against the motion of a body, and one normal to it, over its depth, its speed, its impact angle and its diameter.

/// Nodes over depth (m), speed (m/s), angle (rad) and diameter (m): between them a field is linear, beyond constant.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// In rising order, at least one of each.
    pub axes: [Vec<f64>; 4],
    /// Whether there is a force normal to the motion too. Its nodes stand behind those of the force against it.
    pub is_sideways: bool,
}

impl Grid {
    /// How many nodes there are.
    pub fn len(&self) -> usize {
        self.against() * (1 + usize::from(self.is_sideways))
    }

    /// How many of them are of the force against the motion.
    pub fn against(&self) -> usize {
        self.axes.iter().map(Vec::len).product()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Node `index`: depth, speed, angle, diameter.
    pub fn node(&self, index: usize) -> [f64; 4] {
        let mut rest = index % self.against();
        let mut node = [0.0; 4];
        for (place, axis) in node.iter_mut().zip(&self.axes).rev() {
            *place = axis[rest % axis.len()];
            rest /= axis.len();
        }
        node
    }

    /// The node in units of the extent of each axis, for distances.
    pub fn scaled(&self, index: usize) -> Scaled {
        let node = self.node(index);
        let at = std::array::from_fn(|axis| {
            let ends = &self.axes[axis];
            let width = ends[ends.len() - 1] - ends[0];
            if width > 0.0 { (node[axis] - ends[0]) / width } else { 0.0 }
        });
        Scaled { at, is_sideways: index >= self.against() }
    }

    /// The nodes of the force normal to the motion around `place` with their shares; none where there is no such force.
    pub(crate) fn sideways_shares_at(&self, place: [f64; 4]) -> impl Iterator<Item = (usize, f64)> {
        let behind = self.against();
        let all = self.is_sideways.then(|| self.shares_at(place));
        all.into_iter().flatten().map(move |(node, share)| (node + behind, share))
    }

    /// The nodes around `place` with their shares: a field there is the sum of its values times these.
    pub(crate) fn shares_at(&self, place: [f64; 4]) -> [(usize, f64); 16] {
        let ends: [[(usize, f64); 2]; 4] =
            std::array::from_fn(|axis| shares(&self.axes[axis], place[axis]));
        std::array::from_fn(|corner| {
            let mut all = (0, 1.0);
            for (axis, ends) in ends.iter().enumerate() {
                let (node, share) = ends[corner >> axis & 1];
                all = (all.0 * self.axes[axis].len() + node, all.1 * share);
            }
            all
        })
    }
}

/// A node in units of the extent of each axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scaled {
    /// Depth, speed, angle, diameter.
    pub at: [f64; 4],
    /// Whether it is of the force normal to the motion.
    pub is_sideways: bool,
}

/// The two nodes around `x` with their shares.
fn shares(nodes: &[f64], x: f64) -> [(usize, f64); 2] {
    let upper = nodes.partition_point(|&node| node <= x);
    let last = nodes.len() - 1;
    match upper {
        0 => [(0, 1.0), (0, 0.0)],
        upper if upper > last => [(last, 1.0), (last, 0.0)],
        upper => {
            let share = (x - nodes[upper - 1]) / (nodes[upper] - nodes[upper - 1]);
            [(upper - 1, 1.0 - share), (upper, share)]
        }
    }
}

/// A force over a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Where it is given.
    pub grid: Grid,
    /// In units of ρ g A D, by node: bulk density, gravity, area that drag and friction act on, diameter.
    pub values: Vec<f64>,
}

impl Field {
    /// The force against the motion at a depth (m), a speed (m/s), an impact angle (rad) and a diameter (m), in units of
    /// ρ g A D.
    pub fn at(&self, place: [f64; 4]) -> f64 {
        let shares = self.grid.shares_at(place);
        shares.into_iter().map(|(node, share)| share * self.values[node]).sum()
    }

    /// The force normal to the motion there, in the plane of motion, out of the bed where the body sinks; in the same units.
    pub(crate) fn sideways_at(&self, place: [f64; 4]) -> f64 {
        self.grid.sideways_shares_at(place).map(|(node, share)| share * self.values[node]).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_is_linear_between_nodes_and_constant_beyond() {
        let axes = [vec![0.0, 0.1], vec![0.0, 1.0, 2.0], vec![1.0], vec![0.02, 0.03]];
        let grid = Grid { axes, is_sideways: true };
        let of = |[depth, speed, _, diameter]: [f64; 4]| {
            3.0 + 20.0 * depth - speed + 5.0 * depth * speed + 100.0 * diameter * speed
        };
        let sign = |node: usize| if node < grid.against() { 1.0 } else { -1.0 };
        let values = (0..grid.len()).map(|node| sign(node) * of(grid.node(node))).collect();
        let field = Field { grid, values };
        for place in [[0.03, 0.4, 1.0, 0.02], [0.1, 2.0, 1.0, 0.025], [0.07, 1.9, 1.0, 0.03]] {
            assert!((field.at(place) - of(place)).abs() < 1e-12);
            assert!((field.sideways_at(place) + of(place)).abs() < 1e-12);
        }
        assert!((field.at([0.5, 9.0, 0.2, 0.04]) - of([0.1, 2.0, 1.0, 0.03])).abs() < 1e-12);
    }
}
