//! Runs that cannot be trusted, and models that no machine holds.

use std::time::{Duration, Instant};

use crate::common::{Call, folder, names, small_model};
use crate::log::Log;

#[test]
fn a_trillion_grains_are_refused_at_once_with_the_bytes_they_need() {
    if configs::estimate::available_memory_bytes().is_none() {
        return; // a system that does not say
    }
    for command in ["run", "bed", "check"] {
        let here = folder();
        let call = Call::new([command]).arg(small_model()).inside(here.path());
        let start = Instant::now();
        let message = call.set(&["bed.grains.0.count=1000000000000"]).fails(2);
        assert!(start.elapsed() < Duration::from_secs(1), "{command}: {:?}", start.elapsed());
        assert!(
            message.contains("1000000000048 grains need about") && message.contains(" PB, "),
            "{message}"
        );
        assert!(message.contains("free") && message.contains("--force"), "{message}");
        assert_eq!(names(here.path()), [""; 0], "nothing is written");
    }
}

#[test]
fn more_grains_than_can_be_numbered_are_refused_even_if_forced() {
    let here = folder();
    for command in ["run", "bed"] {
        let call = Call::new([command, "--force"]).arg(small_model()).inside(here.path());
        let message = call.set(&["bed.grains.0.count=1000000000000"]).fails(2);
        assert!(message.contains("4294967295"), "{message}");
    }
}

#[test]
fn an_open_energy_budget_ends_the_run_with_step_and_smaller_step_and_a_readable_log() {
    let out = folder();
    let call = || Call::run(out.path()).set(&["energy.abort_above=1e-4"]);
    let message = call().fails(1);
    let step = message.split_once("step ").and_then(|(_, rest)| rest.split_once(':'));
    let step: usize = step.and_then(|(step, _)| step.parse().ok()).expect("the step");
    assert!(message.contains("a time step of 5e-6 s"), "{message}");
    assert!(message.contains("0.0001 is allowed"), "{message}");
    assert!(!message.contains("closure of 0.000 "), "{message}");
    let whole = out.path().join("whole.mcap");
    let partial = out.path().join("run.mcap.partial");
    Call::new(["recover"]).arg(&partial).arg(&whole).done();
    let log = Log::read(&whole);
    assert!(log.says("/log", "unaccounted for"));
    // Step 0 and all steps before the one that cannot be trusted.
    assert_eq!(log.count("/energy/budget"), step);
    // It is unfinished, and to go on leads to the same fault.
    std::fs::remove_file(whole).expect("the log");
    assert!(call().fails(2).contains("--resume"));
    assert_eq!(call().arg("--resume").fails(1), message);
}

#[cfg(target_os = "linux")]
#[test]
fn a_result_that_cannot_be_said_is_a_failure() {
    let out = folder();
    let call = || Call::run(out.path()).set(&["run.duration=1 ms"]);
    let message = call().after("exec >/dev/full").fails(1);
    assert!(message.contains("stdout"), "{message}");
    // The run itself is done.
    call().done();
}

#[test]
fn a_time_step_that_is_too_large_is_refused_with_one_that_is_not() {
    let out = folder();
    let message = Call::run(out.path()).set(&["run.time_step=1 ms"]).fails(2);
    assert!(message.contains("or less, or \"auto\""), "{message}");
    assert_eq!(names(out.path()), [""; 0]);
}

#[test]
fn an_intruder_that_starts_in_a_wall_is_refused() {
    let out = folder();
    let message = Call::run(out.path()).set(&["impact.x=5 mm"]).fails(2);
    assert!(message.contains("side") || message.contains("wall"), "{message}");
}

#[test]
fn a_bed_that_settles_needs_gravity() {
    let message = Call::new(["bed"]).arg(small_model()).set(&["medium.gravity=0 m/s^2"]).fails(2);
    assert!(message.contains("needs gravity"), "{message}");
}

#[test]
fn a_bed_that_loses_no_energy_is_given_up_with_a_reason() {
    let cache = folder();
    let call = Call::new(["bed", "--cache"]).arg(cache.path()).arg(small_model());
    let lossless = [
        "contact_law.normal_damping_rate=0 1/s",
        "contact_law.tangential_damping_rate=0 1/s",
        "contact_law.friction=0",
        "bed.preparation_friction=0",
        "bed.grains.0.count=12",
        "bed.grains.1.count=3",
    ];
    let message = call.set(&lossless).fails(1);
    assert!(message.contains("of a bed at rest"), "{message}");
}

#[test]
fn a_box_that_is_wide_and_empty_is_refused_with_what_its_grains_would_cover() {
    if configs::estimate::available_memory_bytes().is_none() {
        return; // a system that does not say
    }
    for command in ["run", "bed", "check"] {
        let here = folder();
        let call = Call::new([command]).arg(small_model()).inside(here.path());
        // 300 grains of 4.85 mm side by side are 1.45 m long.
        let message = call.set(&["container.width=1e8 m"]).fails(2);
        assert!(message.contains("a container 100000000 m wide need about"), "{message}");
        assert!(message.contains("300 grains cover the floor of one that is 1.454 m"), "{message}");
        assert_eq!(names(here.path()), [""; 0], "nothing is written");
    }
}

#[test]
fn an_intruder_shot_at_a_side_at_five_degrees_stays_in_its_box() {
    let out = folder();
    // Stiff enough that no grain is crushed between the intruder and the side.
    let settings = [
        "impact.angle=5 deg",
        "impact.speed=10 m/s",
        "contact_law.normal_stiffness=1e5 N/m",
        "contact_law.tangential_stiffness=1e5 N/m",
        "run.time_step=auto",
        "run.duration=20 ms",
    ];
    let summary = Call::run(out.path()).set(&settings).done().json();
    let number = |table: &str, key: &str| summary[table][key].as_f64().expect("a number");
    assert!(number("energy", "closure") < 1e-2, "{summary}");
    // It starts in the middle of a box of 10 cm with a radius of 1 cm: to the side there are 4 cm, and to the floor less than
    // the bed is high. v √(m/k) = 2.5 mm bounds how far it goes into the side.
    assert!(number("stop", "range_m") < 0.0425, "{summary}");
    assert!(number("stop", "depth_m") < number("bed", "height_m"), "{summary}");
}
