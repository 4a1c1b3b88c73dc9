//! What is written reads back, what names and rows decide is nothing, and no table breaks the reader.

use std::fs;
use std::path::Path;

use configs::Color;
use measurements::{Frame, Kind, MeasurementSet, Run};
use proptest::prelude::*;
use proptest::sample::Index;

const HEAD: &str = r#"
schema = 1
condition = [
    { id = "c01", role = "fit", speed = 1, angle_deg = 90, shape = "sphere", diameter = 0.02, mass = 0.05 },
    { id = "c02", role = "holdout", speed = 2, angle_deg = 45, shape = "cone", diameter = 0.02, mass = 0.05, height = 0.0173, apex_deg = 60, spin = -3, packing = 0.6, bed_depth = 0.1 },
    { id = "c03", role = "fit", speed = 2, angle_deg = 90, shape = "link", diameter = 0.02, mass = 0.05, length = 0.2, link_angle_deg = -30 },
]
[measurement]
id = "sample"
kind = "trajectory"
source = "made up \"here\""
[instrument]
rate_hz = 1000
[files]
runs = "runs.csv"
trajectories = "trajectories.csv"
"#;

/// A set as its two tables hold it.
#[derive(Clone, Debug)]
struct Tables {
    runs: Vec<Run>,
}

impl Tables {
    /// `order` of the runs and `names` for them; the rows of a trajectory stay in the order of time.
    fn load(&self, order: &[usize], names: &[String]) -> MeasurementSet {
        let folder = tempfile::tempdir().expect("a folder for the test");
        let cell = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:?}"));
        let count = |value: Option<i64>| value.map_or(String::new(), |value| value.to_string());
        let mut runs = String::from("run,condition,repeat,order,stop_time,final_z,final_x\n");
        let mut rows = String::from("run,t,z,x,sigma_z\n");
        for index in order {
            let (run, name) = (&self.runs[*index], &names[*index]);
            runs += &format!(
                "{name},c0{},{},{},{},{},{}\n",
                run.condition + 1,
                count(run.repeat),
                count(run.order),
                cell(run.stop_time),
                cell(run.final_z),
                cell(run.final_x)
            );
            for Frame { t, z, x, sigma } in &run.frames {
                rows += &format!("{name},{t:?},{z:?},{x:?},{}\n", cell(*sigma));
            }
        }
        let write = |name: &str, text: &str| {
            fs::write(folder.path().join(name), text).expect("a writable folder");
        };
        write("measurement.toml", HEAD);
        write("runs.csv", &runs);
        write("trajectories.csv", &rows);
        load(folder.path())
    }
}

fn load(folder: &Path) -> MeasurementSet {
    MeasurementSet::load(folder).unwrap_or_else(|error| panic!("{error}")).set
}

/// A run of `condition`, drawn from so few values that many are alike.
fn run(condition: usize) -> impl Strategy<Value = Run> {
    let few = || prop_oneof![Just(None), Just(Some(0.01)), Just(Some(0.02))];
    let label = || prop_oneof![Just(None), (1i64..3).prop_map(Some)];
    let frame = (0.0..0.01, 0.0..0.01, few());
    (label(), label(), few(), few(), few(), prop::collection::vec(frame, 1..4)).prop_map(
        move |(repeat, order, stop_time, final_z, final_x, frames)| Run {
            repeat,
            order,
            stop_time,
            final_z,
            final_x,
            frames: onward(&frames),
            ..Run::new(String::new(), condition)
        },
    )
}

/// Frames that go forward and down by `steps`, as those of an impact do.
fn onward(steps: &[(f64, f64, Option<f64>)]) -> Vec<Frame> {
    let mut last = Frame { t: 0.0, z: 0.0, x: 0.0, sigma: None };
    let step = |(z, x, sigma): &(f64, f64, Option<f64>)| {
        last = Frame { t: last.t + 1e-3, z: last.z + z, x: last.x + x, sigma: *sigma };
        last
    };
    steps.iter().map(step).collect()
}

fn tables() -> impl Strategy<Value = Tables> {
    let others = prop::collection::vec((0usize..3).prop_flat_map(run), 0..6);
    (run(0), run(1), run(2), others)
        .prop_map(|(a, b, c, others)| Tables { runs: [vec![a, b, c], others].concat() })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn renaming_and_reordering_runs_changes_nothing_but_the_names(
        tables in tables(),
        picks in prop::collection::vec(any::<Index>(), 9),
        prefix in "[a-z]{1,3}",
    ) {
        let n = tables.runs.len();
        let mut order: Vec<usize> = (0..n).collect();
        for (at, pick) in picks.iter().take(n).enumerate() {
            order.swap(at, pick.index(n));
        }
        let in_order: Vec<usize> = (0..n).collect();
        let plain: Vec<String> = (0..n).map(|index| format!("r{index}")).collect();
        let other: Vec<String> = (0..n).map(|index| format!("{prefix}{}", n - index)).collect();
        let nameless = |mut set: MeasurementSet| {
            set.runs.iter_mut().for_each(|run| run.name.clear());
            set
        };
        let (a, b) = (tables.load(&in_order, &plain), tables.load(&order, &other));
        prop_assert_eq!(nameless(a), nameless(b));
    }

    #[test]
    fn a_written_set_reads_back_to_the_same_bits(tables in tables()) {
        let in_order: Vec<usize> = (0..tables.runs.len()).collect();
        let names: Vec<String> = in_order.iter().map(|index| format!("r{index}")).collect();
        let mut set = tables.load(&in_order, &names);
        // Names that look like a comment, a separator and a quote.
        for (run, name) in set.runs.iter_mut().zip(["#1", "a, b", "the \"third\""]) {
            run.name = name.to_owned();
        }
        let folder = tempfile::tempdir().expect("a folder for the test");
        set.write(folder.path()).expect("a writable folder");
        prop_assert_eq!(load(folder.path()), set);
    }

    #[test]
    fn whatever_a_table_holds_the_answer_is_a_set_or_a_message(
        runs in "(run[,;\t]condition[,;\t]final_z[,;\t]repeat)?[a-c0-9éµ\\-.,;#\" \t\r\n\u{0}\u{feff}]{0,80}",
        rows in "(run,t,z,x,sigma_z\n)?(r1,[0-9e\\-.]{0,4},[0-9\\-.]{0,3},0,\"?1?\n){0,5}[ -~é\r\n]{0,40}",
    ) {
        let folder = tempfile::tempdir().expect("a folder for the test");
        let write = |name: &str, text: &str| {
            fs::write(folder.path().join(name), text).expect("a writable folder");
        };
        write("measurement.toml", HEAD);
        for runs in [runs.as_str(), "run,condition\nr1,c01\nr2,c02\nr3,c03\n"] {
            write("runs.csv", runs);
            write("trajectories.csv", &rows);
            if let Err(error) = MeasurementSet::load(folder.path()) {
                let told = error.render(Color::Off);
                prop_assert!(told.starts_with("error: ") || told.starts_with("warning: "), "{told}");
            }
        }
    }
}

#[test]
fn shipped_sets_and_sets_of_scalars_read_back_too() {
    for name in ["s1-tables", "free-link", "katsuragi-durian"] {
        let set =
            load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../validation/data").join(name));
        let folder = tempfile::tempdir().expect("a folder for the test");
        set.write(folder.path()).expect("a writable folder");
        assert_eq!(load(folder.path()), set, "{name}");
    }
}

#[test]
fn a_set_that_was_never_read_reads_back_without_new_notes() {
    let mut set = load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../validation/data/free-link"));
    set.notes.clear();
    set.kind = Kind::Trajectory;
    for run in &mut set.runs {
        run.frames = vec![Frame { t: 1e-3, z: 1.5e-3, x: 0.0, sigma: None }];
    }
    let folder = tempfile::tempdir().expect("a folder for the test");
    set.write(folder.path()).expect("a writable folder");
    assert_eq!(load(folder.path()), set);
}

#[test]
fn a_name_that_no_cell_can_hold_is_not_written() {
    let mut set = load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../validation/data/free-link"));
    for name in ["", " a", "a\nb"] {
        set.runs[0].name = name.to_owned();
        let folder = tempfile::tempdir().expect("a folder for the test");
        assert!(set.write(folder.path()).is_err(), "{name:?}");
        assert!(!folder.path().join("measurement.toml").exists());
    }
}
