//! Where a function comes to zero between two values of opposite signs.

/// Most evaluations: bisection alone halves any interval of doubles to nothing in fewer.
const MOST: usize = 200;

/// A root of `value` between `from` and `to`, where it has the values `start` and `end` of opposite signs, to
/// within `tolerance`: inverse quadratic interpolation where three values make it safe, else bisection.
///
/// Source: T. R. Chandrupatla, Adv. Eng. Softw. 28, 145 (1997).
pub(super) fn root(
    (from, start): (f64, f64),
    (to, end): (f64, f64),
    tolerance: f64,
    mut value: impl FnMut(f64) -> f64,
) -> f64 {
    // The newest point, the one on the other side of the root, and the one before the newest.
    let ((mut a, mut fa), (mut b, mut fb)) = ((to, end), (from, start));
    let mut share = 0.5;
    for _ in 0..MOST {
        let x = a + share * (b - a);
        let fx = value(x);
        let (c, fc);
        if (fx > 0.0) == (fa > 0.0) {
            (c, fc) = (a, fa);
        } else {
            (c, fc) = (b, fb);
            (b, fb) = (a, fa);
        }
        (a, fa) = (x, fx);
        let (best, of_best) = if fa.abs() < fb.abs() { (a, fa) } else { (b, fb) };
        let least = 0.5 * tolerance / (b - a).abs();
        if least > 0.5 || of_best == 0.0 || !of_best.is_finite() {
            return best;
        }
        let place = (a - b) / (c - b);
        let height = (fa - fb) / (fc - fb);
        // The parabola through the three points is monotonic between the two that hold the root.
        let is_safe = 1.0 - (1.0 - place).sqrt() < height && height < place.sqrt();
        let interpolated = || {
            fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
        };
        share = if is_safe { interpolated() } else { 0.5 };
        share = share.clamp(least, 1.0 - least);
    }
    a
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    #[test]
    fn roots_are_found_to_the_last_digits_in_few_evaluations() {
        type Case = (fn(f64) -> f64, f64, f64, f64);
        let cases: [Case; 5] = [
            (|x| 1.0 - x, 0.0, 3.0, 1.0),
            (|x| 2.0 - x * x, 0.0, 2.0, std::f64::consts::SQRT_2),
            (|x| libm::cos(x) - x, 0.0, 1.0, 0.739_085_133_215_160_6),
            // Flat on one side of the root, and flat at it.
            (|x| libm::exp(-40.0 * x) - 1e-12, 0.0, 3.0, 12.0 * std::f64::consts::LN_10 / 40.0),
            (|x| (1.0 - x) * (1.0 - x) * (1.0 - x), 0.0, 1.9, 1.0),
        ];
        for (number, (function, from, to, expected)) in cases.into_iter().enumerate() {
            let evaluations = Cell::new(0);
            let counted = |x| {
                evaluations.set(evaluations.get() + 1);
                function(x)
            };
            let tolerance = 4.0 * f64::EPSILON * (1.0 + to);
            let found = root((from, function(from)), (to, function(to)), tolerance, counted);
            // A triple root is where the function is below its rounding, which is much wider.
            let near = if number == 4 { 1e-5 } else { tolerance };
            assert!((found - expected).abs() <= near, "{number}: {found} for {expected}");
            // Bisection takes 52.
            assert!(evaluations.get() <= 60, "{number}: {evaluations:?}");
        }
    }

    #[test]
    fn a_value_that_is_not_finite_ends_the_search() {
        let found = root((0.0, 1.0), (1.0, -1.0), 1e-15, |_| f64::NAN);
        assert!((0.0..=1.0).contains(&found), "{found}");
    }
}
