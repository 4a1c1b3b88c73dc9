//! Threads change the time a run takes, and nothing else.

use crate::common::{Call, assert_same_run, folder};

/// A bed of several blocks of grains, so that threads have something to share.
const SEVERAL_BLOCKS: [&str; 4] = [
    "bed.grains.0.count=1260",
    "bed.grains.1.count=240",
    "container.width=50 cm",
    "run.duration=3 ms",
];

const ROLLING: &str = r#"effect=[{ name = "rolling-resistance", rolling_friction = 0.05 }]"#;

#[test]
fn a_run_on_1_2_3_and_8_threads_is_the_same_bytes_with_and_without_an_effect() {
    for effects in [&[][..], &[ROLLING]] {
        let folder = folder();
        let run = |threads: &str| {
            let out = folder.path().join(threads);
            let call = Call::run(&out).set(&SEVERAL_BLOCKS).set(effects);
            (call.arg("--threads").arg(threads).done(), out)
        };
        // The first one prepares the bed, so that the others find it.
        run("4");
        let (first, one) = run("1");
        assert_eq!(first.json()["cost"]["threads"], 1);
        for threads in ["2", "3", "8"] {
            let (ended, out) = run(threads);
            assert_eq!(ended.json()["cost"]["threads"].to_string(), threads);
            assert_eq!(ended.result(), first.result(), "{threads} threads");
            assert_same_run(&out, &one);
        }
    }
}

#[test]
fn a_bed_prepared_on_1_and_3_threads_is_the_same_bytes() {
    let folder = folder();
    let beds = ["1", "3"].map(|threads| {
        let cache = folder.path().join(threads);
        let call = Call::new(["bed", "--json", "--threads", threads, "--cache"]).arg(&cache);
        let bed = call.arg(crate::common::small_model()).set(&["bed.grains.0.count=700"]).done();
        let path = bed.json()["path"].as_str().expect("the file in the cache").to_owned();
        std::fs::read(path).expect("the bed")
    });
    assert!(beds[0] == beds[1]);
}

#[test]
fn no_threads_at_all_are_refused() {
    let folder = folder();
    Call::run(folder.path()).arg("--threads").arg("0").fails(2);
}
