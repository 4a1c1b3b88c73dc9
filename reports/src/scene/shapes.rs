//! Outlines of bodies.

/// The corners of the convex hull of `points`, counter-clockwise. Bodies are convex, each link of a chain for itself.
///
/// Source: A. M. Andrew, Information Processing Letters 9, 216 (1979).
pub(crate) fn hull(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let half = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for point in points {
            while let [.., a, b] = chain[..]
                && (b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0]) <= 0.0
            {
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let lower = half(&mut points.iter().copied());
    let upper = half(&mut points.iter().rev().copied());
    [lower, upper].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hull_goes_around_and_leaves_out_what_is_inside_and_on_its_edges() {
        let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]];
        let within = [[1.0, 0.5], [1.0, 0.0], [0.0, 0.5]];
        let points: Vec<[f64; 2]> = within.into_iter().chain(corners).chain(corners).collect();
        assert_eq!(hull(points), corners);
        assert_eq!(hull(vec![[1.0, 1.0]; 3]), [[1.0, 1.0]]);
    }
}
