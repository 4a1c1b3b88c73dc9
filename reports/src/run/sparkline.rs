//! A curve as one line of text.

/// Heights from none to full.
const HEIGHTS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];

/// The curve through `points` (time and value, values from 0 on) in `width` characters, each the value
/// at the last point of its part of the time; empty without points.
pub fn sparkline(points: &[(f64, f64)], width: usize) -> String {
    let (Some(&(first, _)), Some(&(last, _))) = (points.first(), points.last()) else {
        return String::new();
    };
    let most = points.iter().fold(0.0_f64, |most, (_, value)| most.max(*value));
    let height = |value: f64| {
        let share = if most > 0.0 { value / most } else { 0.0 };
        HEIGHTS[((share * 7.0).round() as usize).min(7)]
    };
    (1..=width)
        .map(|at| {
            let until = first + (last - first) * at as f64 / width as f64;
            let after = points.partition_point(|(time, _)| *time <= until).max(1);
            height(points[after - 1].1)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_climbs_through_all_heights() {
        let ramp: Vec<(f64, f64)> = (0..=80).map(|at| (f64::from(at), f64::from(at))).collect();
        let line = sparkline(&ramp, 8);
        assert_eq!(line.chars().count(), 8);
        assert!(line.ends_with('█') && line.starts_with('▂'), "{line}");
        let heights: Vec<char> = line.chars().collect();
        assert!(heights.windows(2).all(|pair| pair[0] <= pair[1]), "{line}");
    }

    #[test]
    fn nothing_and_zero_are_no_curve_and_a_flat_one() {
        assert_eq!(sparkline(&[], 8), "");
        assert_eq!(sparkline(&[(0.0, 0.0), (1.0, 0.0)], 3), "▁▁▁");
    }
}
