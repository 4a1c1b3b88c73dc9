//! Definitions of stopping times and final depths.

use measurements::{FinalDefinition, Held, MeasurementSet, Outcome, Scalar, StopDefinition, hold};

use crate::world::Laboratory;
use crate::zeros::sound;

const BOTH: [StopDefinition; 2] = [StopDefinition::ComponentZero, StopDefinition::SpeedFivePercent];

fn held(set: &MeasurementSet, scalar: Scalar) -> Held {
    let all = hold(set, [true; 2]);
    all.into_iter().find(|held| held.scalar == scalar).expect("the frames reach the stop")
}

#[test]
fn no_sound_set_is_accused_of_another_definition() {
    for (seed, stop) in (0..100).flat_map(|seed| BOTH.map(|stop| (seed, stop))) {
        let laboratory = Laboratory { stop, ..sound(seed) };
        for held in hold(&laboratory.measure(seed), [true; 2]) {
            assert!(!held.outcome.is_contradiction(), "{seed} {held:?} {laboratory:?}");
        }
    }
}

#[test]
fn times_of_another_definition_are_named_wherever_the_noise_tells_them_apart() {
    let (mut named, mut all) = (0, 0);
    for (seed, stop) in (0..100).flat_map(|seed| BOTH.map(|stop| (seed, stop))) {
        let laboratory = Laboratory { stop, ..sound(seed) };
        let mut set = laboratory.measure(seed);
        let right = stop.word();
        let follows = hold(&set, [true; 2])
            .into_iter()
            .any(|held| held.scalar == Scalar::StopTime && held.outcome == Outcome::Follows);
        if !follows {
            continue;
        }
        set.stop = if stop == BOTH[0] { BOTH[1] } else { BOTH[0] };
        all += 1;
        named += usize::from(held(&set, Scalar::StopTime).outcome == Outcome::FollowsOther(right));
    }
    // Half of the cameras are too slow or the stops too sudden; where the right definition alone fits, the
    // wrong one is named, but for means that both definitions frame.
    assert!(all > 80 && named + 5 >= all, "{named} of {all}");
}

#[test]
fn the_definition_that_the_numbers_follow_is_named_with_how_much_the_other_misses() {
    let laboratory =
        Laboratory { stop: StopDefinition::ComponentZero, repeats: 8, ..Laboratory::default() };
    let mut set = laboratory.measure(7);
    set.stop = StopDefinition::SpeedFivePercent;
    let found = held(&set, Scalar::StopTime);
    assert_eq!(found.outcome, Outcome::FollowsOther("component-zero"), "{found:?}");
    let [own, other] = [&found.misses[0], &found.misses[1]];
    // At some 40 m/s² the last twentieth of 0.8 to 2.8 m/s takes one to three milliseconds.
    assert!((5e-4..5e-3).contains(&own.mean.value) && own.mean.value > own.limit, "{found:?}");
    assert!(other.mean.value.abs() < other.limit, "{found:?}");
}

#[test]
fn a_body_that_springs_back_has_a_deepest_and_a_resting_place() {
    let mut set = Laboratory { after: 40, ..Laboratory::default() }.measure(8);
    set.last = FinalDefinition::Deepest;
    for run in &mut set.runs {
        let (stop, deepest) = (run.stop_time, run.final_z);
        let (Some(stop), Some(deepest)) = (stop, deepest) else { continue };
        for frame in run.frames.iter_mut().filter(|frame| frame.t > stop) {
            // It comes back by 3 mm within 10 ms.
            frame.z -= 3e-3 * ((frame.t - stop) / 0.01).min(1.0);
        }
        run.final_z = Some(deepest);
    }
    assert_eq!(held(&set, Scalar::FinalDepth).outcome, Outcome::Follows);
    set.last = FinalDefinition::Resting;
    assert_eq!(held(&set, Scalar::FinalDepth).outcome, Outcome::FollowsOther("deepest"));
}

#[test]
fn numbers_in_another_unit_or_from_another_zero_follow_nothing() {
    let sound = Laboratory::default().measure(9);
    let mut milliseconds = sound.clone();
    for run in &mut milliseconds.runs {
        run.stop_time = run.stop_time.map(|time| 1e3 * time);
    }
    assert_eq!(held(&milliseconds, Scalar::StopTime).outcome, Outcome::FollowsNone);
    let mut shifted = sound.clone();
    for run in &mut shifted.runs {
        run.final_z = run.final_z.map(|depth| depth + 0.01);
    }
    assert_eq!(held(&shifted, Scalar::FinalDepth).outcome, Outcome::FollowsNone);
    assert!(!held(&sound, Scalar::FinalDepth).outcome.is_contradiction());
}

#[test]
fn clips_that_end_before_the_stop_say_nothing() {
    let mut set = Laboratory::default().measure(10);
    for run in &mut set.runs {
        let half = 0.5 * run.stop_time.unwrap_or(0.0);
        run.frames.retain(|frame| frame.t < half);
    }
    assert_eq!(hold(&set, [true; 2]), Vec::new());
}
