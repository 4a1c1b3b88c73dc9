//! The damping ratio that makes a Hertz contact rebound with a given restitution.

use std::f64::consts::{FRAC_PI_2, PI};

/// β (–) of a normal force max(0, K δ^{3/2} + 2 √(5/6) β √(S_n m*) dδ/dt), S_n = 3/2 K √δ, with which a
/// collision rebounds with `restitution` (–), above 0 and at most 1, at any speed.
///
/// In y = δ^{5/4} and dτ = δ^{1/4} dt the contact is a linear oscillator of damping ratio β (Antypov &
/// Elliott, EPL 94, 50004 (2011)). The two part where its acceleration, and so the force, returns to
/// zero, earlier than where δ does (Schwager & Pöschel, Granul. Matter 9, 465 (2007)):
///
/// −ln e = (π − 2α) tan α, β = sin α; beyond critical damping −ln e = 2η coth η, β = cosh η
///
/// A law that may attract has π β/√(1 − β²) there, and a smaller β: 0.21545 for 1/2, against 0.25528.
pub fn damping_ratio(restitution: f64) -> f64 {
    let loss = -libm::log(restitution);
    if loss <= 2.0 {
        libm::sin(rising_root(|alpha| (PI - 2.0 * alpha) * libm::tan(alpha), loss, FRAC_PI_2))
    } else {
        // η coth η is not below η.
        libm::cosh(rising_root(|eta| 2.0 * eta / libm::tanh(eta), loss, 0.5 * loss))
    }
}

/// Where a rising function reaches `value` between 0 and `end`, to the last bit.
fn rising_root(of: impl Fn(f64) -> f64, value: f64, end: f64) -> f64 {
    let (mut low, mut high) = (0.0, end);
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        if of(middle) < value { low = middle } else { high = middle }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_damping_ratio_is_that_of_an_independent_integration() {
        // It took 4 000 steps per contact, and gives five or four digits.
        assert!((damping_ratio(0.5) - 0.255_276).abs() < 1e-6);
        assert!((damping_ratio(0.98) - 0.006_457).abs() < 5e-7);
    }

    #[test]
    fn nothing_is_damped_at_restitution_one_and_ever_more_below() {
        let ratios = [1.0, 0.9, 0.5, 0.136, 0.135, 0.1, 1e-3].map(damping_ratio);
        assert!(ratios[0].abs() < 1e-300, "{ratios:?}");
        assert!(ratios.windows(2).all(|pair| pair[1] > pair[0]), "{ratios:?}");
        // Critical damping leaves exp(−2) = 0.1353.
        assert!(ratios[3] < 1.0 && ratios[4] > 1.0, "{ratios:?}");
    }
}
