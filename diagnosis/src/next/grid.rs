//! The conditions that could be measured next.

use measurements::{Condition, MeasurementSet};

use super::Recommendation;

/// Most conditions that are tried.
const MOST: usize = 60;

/// Speeds that are tried, evenly spaced.
const SPEEDS: usize = 4;

/// Angles that are tried where the set's author names none (deg).
const ANGLES: [f64; 3] = [90.0, 60.0, 35.0];

/// Spins that are tried besides those of a set in which anything spins (rad/s).
const SPINS: [f64; 3] = [-100.0, 0.0, 100.0];

/// Share of its mass at which every intruder is tried too: a hollow or lighter one.
const LIGHTER: f64 = 0.5;

/// At most [`MOST`] feasible conditions of `set`, in an order that the set decides.
pub(super) fn feasible(set: &MeasurementSet) -> Vec<Condition> {
    let limits = &set.feasible;
    let distinct = |of: fn(&Condition) -> Option<f64>| sorted(set.conditions.iter().filter_map(of));
    let either = |stated: &[f64], otherwise: Vec<f64>| match stated {
        [] => otherwise,
        _ => sorted(stated.iter().copied()),
    };
    let spins = distinct(|one| Some(one.spin));
    let spins = match spins.iter().any(|spin| *spin != 0.0) {
        true => sorted(spins.into_iter().chain(SPINS)),
        false => vec![0.0],
    };
    let unknown_or = |values: Vec<f64>| match values.is_empty() {
        true => vec![None],
        false => values.into_iter().map(Some).collect(),
    };
    let bodies = bodies(set);
    let speeds = speeds(set);
    let angles = either(&limits.angle_deg, ANGLES.to_vec());
    let spins = either(&limits.spin, spins);
    let packings = unknown_or(either(&limits.packing, distinct(|one| one.packing)));
    let depths = unknown_or(either(&limits.bed_depth, distinct(|one| one.bed_depth)));
    // Of one bed a condition need not say which it is.
    let beds = match set.beds.len() {
        0 | 1 => vec![None],
        n => (0..n).map(Some).collect(),
    };
    let sizes = [
        beds.len(),
        depths.len(),
        packings.len(),
        spins.len(),
        bodies.len(),
        angles.len(),
        speeds.len(),
    ];
    chosen(sizes.iter().product())
        .enumerate()
        .map(|(number, place)| {
            let [bed, depth, packing, spin, body, angle, speed] = digits(place, sizes);
            Condition {
                id: format!("next-{}", number + 1),
                speed: speeds[speed],
                angle_deg: angles[angle],
                spin: spins[spin],
                packing: packings[packing],
                bed_depth: depths[depth],
                bed: beds[bed],
                ..bodies[body].clone()
            }
        })
        .collect()
}

/// From half the smallest speed of the set to its largest, or what is feasible.
fn speeds(set: &MeasurementSet) -> Vec<f64> {
    let of_set = || set.conditions.iter().map(|one| one.speed).filter(|speed| *speed > 0.0);
    let largest = of_set().fold(0.0, f64::max);
    let [from, to] =
        set.feasible.speed.unwrap_or([0.5 * of_set().fold(largest, f64::min), largest]);
    let step = (to - from) / (SPEEDS - 1) as f64;
    sorted((0..SPEEDS).map(|k| from + step * k as f64))
}

/// Every intruder of the set in every feasible size and mass.
fn bodies(set: &MeasurementSet) -> Vec<Condition> {
    let limits = &set.feasible;
    let mut bodies: Vec<Condition> = Vec::new();
    for like in &set.conditions {
        let own = (&[like.diameter][..], &[like.mass, LIGHTER * like.mass][..]);
        let diameters = if limits.diameter.is_empty() { own.0 } else { &limits.diameter };
        let masses = if limits.mass.is_empty() { own.1 } else { &limits.mass };
        for &diameter in diameters {
            for &mass in masses {
                let body = Condition { diameter, mass, ..like.clone() };
                if !bodies.iter().any(|other| is_same_body(other, &body)) {
                    bodies.push(body);
                }
            }
        }
    }
    bodies
}

/// What the runs of `one` cost after those of `before`, if `set` says what measuring costs.
pub(super) fn cost(
    set: &MeasurementSet,
    before: &[Recommendation],
    one: &Recommendation,
) -> Option<f64> {
    let cost = set.feasible.cost?;
    let there = || set.conditions.iter().chain(before.iter().map(|one| &one.condition));
    let is_new = |same: fn(&Condition, &Condition) -> bool| {
        if there().any(|other| same(other, &one.condition)) { 0.0 } else { 1.0 }
    };
    let (body, bed) = (is_new(is_same_body), is_new(is_same_bed));
    Some(cost.condition + cost.run * one.repeats as f64 + cost.body * body + cost.bed * bed)
}

fn is_same_bed(a: &Condition, b: &Condition) -> bool {
    (a.packing, a.bed_depth, a.bed) == (b.packing, b.bed_depth, b.bed)
}

fn is_same_body(a: &Condition, b: &Condition) -> bool {
    let sizes = |one: &Condition| {
        let body = (one.diameter, one.mass, one.length, one.height, one.shaft_diameter);
        (body, one.apex_deg, one.link_angle_deg)
    };
    a.shape == b.shape && sizes(a) == sizes(b)
}

/// Places in a list of `n`: all, or [`MOST`] in golden steps, which come round every digit of a place
/// evenly.
fn chosen(n: usize) -> impl Iterator<Item = usize> {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let mut step = if n > MOST { (golden * n as f64) as usize } else { 1 };
    while common_divisor(step, n) > 1 {
        step += 1;
    }
    (0..n.min(MOST)).map(move |k| (k * step) % n)
}

fn common_divisor(a: usize, b: usize) -> usize {
    if b == 0 { a } else { common_divisor(b, a % b) }
}

/// The number `place` in a system whose digits have `sizes` values, the last one running fastest.
fn digits<const N: usize>(mut place: usize, sizes: [usize; N]) -> [usize; N] {
    let mut digits = [0; N];
    for at in (0..N).rev() {
        digits[at] = place % sizes[at];
        place /= sizes[at];
    }
    digits
}

fn sorted(values: impl IntoIterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.into_iter().collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_sets::{condition, set};
    use measurements::{Cost, Feasible, Kind, NamedBed};

    fn measured() -> MeasurementSet {
        let conditions = [(1.0, 90.0), (2.0, 60.0), (3.0, 35.0)];
        let conditions = conditions.map(|(speed, angle)| condition(speed, angle));
        set(Kind::Scalar, conditions.into(), Vec::new())
    }

    #[test]
    fn by_default_the_grid_is_taken_from_the_set() {
        let grid = feasible(&measured());
        // Four speeds, three angles, one sphere at two masses.
        assert_eq!(grid.len(), 24);
        let of = |value: fn(&Condition) -> f64| sorted(grid.iter().map(value));
        assert_eq!((of(|one| one.speed)[0], of(|one| one.speed)[3]), (0.5, 3.0));
        assert_eq!(of(|one| one.angle_deg), [35.0, 60.0, 90.0]);
        assert_eq!(of(|one| one.mass), [0.5 * 0.0667, 0.0667]);
        assert!(grid.iter().all(|one| one.spin == 0.0 && one.packing.is_none()));
    }

    #[test]
    fn every_body_is_tried_in_every_bed_of_several() {
        let mut set = measured();
        for name in ["loose", "dense"] {
            set.beds.push(NamedBed { name: name.to_owned(), bed: set.bed });
        }
        for (condition, bed) in set.conditions.iter_mut().zip([0, 1, 1]) {
            condition.bed = Some(bed);
        }
        let grid = feasible(&set);
        // As many as of one bed, in each.
        let of = |bed| grid.iter().filter(|one| one.bed == Some(bed)).count();
        assert_eq!([of(0), of(1)], [24, 24]);
    }

    #[test]
    fn limits_are_obeyed_and_a_large_grid_is_thinned_to_conditions_that_differ() {
        let mut set = measured();
        set.feasible = Feasible {
            speed: Some([0.5, 1.5]),
            angle_deg: vec![80.0, 70.0],
            mass: vec![0.01, 0.02, 0.03],
            diameter: vec![0.02, 0.03],
            spin: vec![-50.0, 50.0],
            packing: vec![0.6],
            bed_depth: vec![0.1, 0.2, 0.3],
            cost: None,
        };
        let grid = feasible(&set);
        assert_eq!(grid.len(), MOST);
        for (at, one) in grid.iter().enumerate() {
            let limits = &set.feasible;
            assert!((0.5..=1.5).contains(&one.speed), "{one:?}");
            assert!(limits.angle_deg.contains(&one.angle_deg), "{one:?}");
            assert!(limits.mass.contains(&one.mass), "{one:?}");
            assert!(limits.diameter.contains(&one.diameter), "{one:?}");
            assert!(limits.spin.contains(&one.spin) && one.packing == Some(0.6), "{one:?}");
            assert!(limits.bed_depth.contains(&one.bed_depth.unwrap_or(0.0)), "{one:?}");
            let same =
                |other: &Condition| Condition { id: one.id.clone(), ..other.clone() } == *one;
            assert!(!grid[..at].iter().any(same), "{one:?} stands twice");
        }
        // Every value of every list is tried.
        let n = |of: fn(&Condition) -> f64| sorted(grid.iter().map(of)).len();
        assert_eq!([n(|one| one.speed), n(|one| one.mass), n(|one| one.diameter)], [4, 3, 2]);
        assert_eq!([n(|one| one.angle_deg), n(|one| one.spin)], [2, 2]);
    }

    #[test]
    fn a_body_or_a_bed_is_paid_for_once() {
        let mut set = measured();
        let of = |condition: Condition| Recommendation {
            condition,
            bed: None,
            repeats: 4,
            expected_bits: 0.0,
            separates: [String::new(), String::new()],
            expected_delta: 0.0,
            cost: None,
        };
        let known = of(condition(1.7, 45.0));
        assert_eq!(cost(&set, &[], &known), None);
        set.feasible.cost = Some(Cost { run: 0.5, condition: 1.0, body: 10.0, bed: 20.0 });
        assert_eq!(cost(&set, &[], &known), Some(3.0));
        let light = of(Condition { mass: 0.01, ..known.condition.clone() });
        assert_eq!(cost(&set, &[], &light), Some(13.0));
        let loose = of(Condition { packing: Some(0.58), ..light.condition.clone() });
        assert_eq!(cost(&set, &[], &loose), Some(33.0));
        assert_eq!(cost(&set, std::slice::from_ref(&light), &loose), Some(23.0));
        assert_eq!(cost(&set, &[light, loose.clone()], &loose), Some(3.0));
    }
}
