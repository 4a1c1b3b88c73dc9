//! What `diagnose` and `compare` say, held by its words and numbers, and that they end: with numbers nobody measures,
//! and when they are asked to.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

#[cfg(unix)]
#[path = "runs/ignored.rs"]
mod ignored;

#[cfg(unix)]
use ignored::is_ignored;
use serde_json::Value;

/// What takes seconds may take this long on a machine that does much else.
const SECONDS: Duration = Duration::from_secs(120);

fn shipped(set: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../validation/data").join(set)
}

fn command(folder: &Path, args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_plunge"));
    command.current_dir(folder).args(args).env_remove("PLUNGE_CACHE");
    command
}

fn plunge(folder: &Path, args: &[&str]) -> Output {
    command(folder, args).output().expect("the binary runs")
}

fn shown(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn text(path: &Path) -> &str {
    path.to_str().expect("a test path is UTF-8")
}

#[test]
fn the_template_lacks_nothing() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    assert!(plunge(here, &["new", "measurements"]).status.success());
    let said = shown(&plunge(here, &["diagnose", "measurements"]));
    assert!(said.contains("\nVERDICT  nothing detected"), "{said}");
}

#[test]
fn the_example_of_the_readme_names_what_helps_and_nothing_else() {
    let here = tempfile::tempdir().unwrap();
    let set = shipped("s1-tables-vertical");
    let output = plunge(here.path(), &["diagnose", text(&set), "--quiet"]);
    let said = shown(&output);
    for line in [
        "VERDICT  one of {added-mass, depth-exponent, rail-friction, yield-stress, buoyancy, janssen}: \
         these data cannot tell them apart",
        "Suggested only, because the errors are stated and not seen in repeats; its amplitude is outside of its usual range.",
        "Error on held-out conditions: 10.1 % before, 1.7 % after (noise of the means 6.0 %); 100 % of what exceeds \
         noise is explained.",
    ] {
        assert!(said.lines().any(|one| one == line), "{line:?} is not in\n{said}");
    }
    assert!(
        said.contains("immersion          at most 0  end of the range"),
        "an amplitude at its bound: {said}"
    );
    assert!(said.contains("unusual: added-mass of 7.73"), "{said}");
    assert!(said.contains(", where 0 to 5 is usual"), "{said}");
    assert!(!said.contains("0.0000  0.0000"), "no error of zero: {said}");

    let file = here.path().join("runs/s1-tables-vertical-diagnose/diagnosis.json");
    let found: Value = serde_json::from_str(&fs::read_to_string(file).unwrap()).unwrap();
    assert_eq!(found["strength"], "suggested");
    let reasons = serde_json::json!(["stated-errors", "amplitude-outside-usual-range"]);
    assert_eq!(found["strength_reasons"], reasons);
    let held_out = &found["holdout"];
    assert_eq!(
        (&held_out["conditions_judged"], &held_out["not_predicted"]),
        (&2.into(), &Value::Array(vec![]))
    );
    // To the digits that README has.
    for (key, expected) in [("before", 0.101), ("after", 0.017), ("noise_floor", 0.060)] {
        let error = held_out[key].as_f64().expect("an error");
        assert!((error - expected).abs() < 5e-4, "{key}: {error}");
    }
    let ranking = found["ranking"].as_array().unwrap();
    let of = |id: &str| ranking.iter().find(|one| one["id"] == id).expect("it is listed");
    let wall = of("bottom-wall");
    assert_eq!((&wall["at_bound"], &wall["se"]), (&"lower".into(), &Value::Null));
    // Errors of the apparatus are looked for beside every effect, and are none.
    assert!(!ranking.iter().any(|one| one["id"] == "camera-scale" || one["id"] == "tilt"));
    let looked_for = found["apparatus"].as_array().unwrap();
    assert!(looked_for.iter().any(|one| one["id"] == "camera-scale" && one["named"] == false));
    let mass = of("added-mass");
    assert_eq!((&mass["at_bound"], &mass["unusual"]), (&Value::Null, &true.into()));
    assert_eq!(mass["usual_range"], serde_json::json!([0.0, 5.0]));
    assert_eq!(of("magnus")["status"], "not-testable");
    let rejected = found["p_lof"].as_f64().unwrap();
    let explained = found["p_lof_with"].as_f64().unwrap();
    assert!(rejected < 1e-4 && explained > 0.95, "{rejected} {explained}");
}

/// The tables of `s1-tables-vertical` in `folder`/`name`, each number of each run changed: of its place in the
/// table, its stopping time and its depth.
fn changed(folder: &Path, name: &str, change: impl Fn(usize, &mut f64, &mut f64)) -> String {
    let set = folder.join(name);
    fs::create_dir(&set).unwrap();
    let source = shipped("s1-tables-vertical");
    fs::copy(source.join("measurement.toml"), set.join("measurement.toml")).unwrap();
    let table = fs::read_to_string(source.join("runs.csv")).unwrap();
    let mut place = 0;
    let rows = table.lines().map(|line| {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        if line.starts_with("a90") {
            let [mut time, mut depth] = [2, 3].map(|at| cells[at].parse().unwrap());
            change(place, &mut time, &mut depth);
            cells[2] = format!("{time:e}");
            cells[3] = format!("{depth:e}");
            place += 1;
        }
        cells.join(",") + "\n"
    });
    fs::write(set.join("runs.csv"), rows.collect::<String>()).unwrap();
    assert_eq!(place, 8, "the rows of the table are found");
    text(&set).to_owned()
}

/// Exit code and stderr of a call that must end in seconds.
fn ends(folder: &Path, args: &[&str]) -> (Option<i32>, String) {
    let errors = folder.join("stderr");
    let mut child = command(folder, args)
        .stdout(Stdio::null())
        .stderr(fs::File::create(&errors).unwrap())
        .spawn()
        .expect("the binary runs");
    let code = ended_within(&mut child, SECONDS).unwrap_or_else(|| panic!("{args:?} does not end"));
    (code, fs::read_to_string(errors).unwrap())
}

/// Exit code, 128 and its number for a signal; `None` if it has not ended by then, which it has afterwards.
fn ended_within(child: &mut Child, limit: Duration) -> Option<Option<i32>> {
    let start = Instant::now();
    while start.elapsed() < limit {
        if let Some(status) = child.try_wait().expect("it can be waited for") {
            #[cfg(unix)]
            let signal = std::os::unix::process::ExitStatusExt::signal(&status);
            #[cfg(not(unix))]
            let signal: Option<i32> = None;
            return Some(status.code().or(signal.map(|number| 128 + number)));
        }
        sleep(Duration::from_millis(10));
    }
    child.kill().expect("it can be killed");
    child.wait().expect("it can be waited for");
    None
}

#[test]
fn numbers_that_no_model_fits_end_in_seconds_with_an_answer() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let sets = [
        changed(here, "one-millimetre", |at, _, depth| {
            *depth = if at == 3 { 1e-3 } else { *depth }
        }),
        changed(here, "deeper", |_, _, depth| *depth *= 3.0),
        changed(here, "far-deeper", |_, _, depth| *depth *= 10.0),
        changed(here, "shallow", |_, _, depth| *depth *= 0.01),
        changed(here, "metres", |_, _, depth| *depth *= 1000.0),
        changed(here, "milliseconds", |_, time, _| *time *= 1e-3),
    ];
    for set in &sets {
        for command in ["compare", "diagnose"] {
            let (code, errors) = ends(here, &[command, set, "--quiet", "--force", "--out", "out"]);
            // Answered, refused as it is read, or with the condition that cannot be.
            let clear = match code {
                Some(0) => true,
                Some(2) => errors.contains("error: "),
                _ => code == Some(1) && errors.contains("the condition `a90-v"),
            };
            assert!(clear, "{command} {set}: {code:?} {errors}");
        }
    }
}

#[test]
fn numbers_that_no_laboratory_has_are_bad_input_with_the_run_that_has_them() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let sets = [
        changed(here, "atoms", |at, _, depth| *depth = if at == 3 { 1e-10 } else { *depth }),
        changed(here, "planets", |at, _, depth| *depth = if at == 3 { 1e307 } else { *depth }),
        changed(here, "ages", |at, time, _| *time = if at == 3 { 1e307 } else { *time }),
    ];
    for set in &sets {
        for command in ["check", "compare", "diagnose"] {
            let (code, errors) = ends(here, &[command, set]);
            assert_eq!(code, Some(2), "{command} {set}: {errors}");
            assert!(
                errors.contains("the run `a90-v2.0`") && errors.contains("its size is"),
                "{errors}"
            );
        }
    }
    let weightless = changed(here, "weightless", |_, _, _| ());
    let file = Path::new(&weightless).join("measurement.toml");
    let words = fs::read_to_string(&file).unwrap();
    for gravity in ["0", "1e10"] {
        fs::write(&file, words.replace("gravity = 9.81", &format!("gravity = {gravity}"))).unwrap();
        let (code, errors) = ends(here, &["compare", &weightless]);
        assert!(code == Some(2) && errors.contains("gravity"), "{gravity}: {code:?} {errors}");
    }
}

/// A set of so many conditions that nothing is done with it in a second.
fn large(folder: &Path) -> String {
    let set = folder.join("large");
    fs::create_dir(&set).unwrap();
    let mut words = String::from(
        "schema = 1\n[measurement]\nid = \"large\"\nkind = \"scalar\"\nstop_definition = \"component-zero\"\n\
         final = \"deepest\"\n[bed]\ngeometry = \"2d\"\nbulk_density = 2.4259\ngravity = 9.81\n\
         [model]\nbaseline = \"two-term-components\"\n[noise]\nstop_time_rel = 0.06\nfinal_z_rel = 0.06\n\
         [files]\nruns = \"runs.csv\"\n",
    );
    let mut rows = String::from("run,condition,stop_time,final_z\n");
    for at in 0..4000 {
        let speed = 0.5 + f64::from(at) / 1000.0;
        let _ = write!(
            words,
            "[[condition]]\nid = \"c{at}\"\nrole = \"fit\"\nspeed = {speed}\nangle_deg = 90\nshape = \"disc\"\n\
             diameter = 0.0446\nmass = 0.0322\n\n"
        );
        let _ = writeln!(rows, "r{at},c{at},{},{}", 0.15 + 0.02 / speed, 0.07 + 0.03 * speed);
    }
    fs::write(set.join("measurement.toml"), words).unwrap();
    fs::write(set.join("runs.csv"), rows).unwrap();
    text(&set).to_owned()
}

#[cfg(unix)]
#[test]
fn a_comparison_and_a_diagnosis_end_soon_after_a_signal_whatever_they_do() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let set = large(here);
    for (name, number) in [("TERM", 15), ("INT", 2)] {
        if is_ignored(number) {
            continue; // then commands ignore it too
        }
        for (command_name, millis) in [
            ("compare", 300),
            ("compare", 1000),
            ("compare", 2500),
            ("diagnose", 700),
            ("diagnose", 2000),
        ] {
            let errors = here.join("stderr");
            let mut child = command(here, &[command_name, &set, "--out", "out"])
                .stdout(Stdio::null())
                .stderr(fs::File::create(&errors).unwrap())
                .spawn()
                .expect("the binary runs");
            sleep(Duration::from_millis(millis));
            assert!(child.try_wait().unwrap().is_none(), "{command_name} ends by itself");
            let sent = Command::new("kill").args(["-s", name, &child.id().to_string()]).status();
            assert!(sent.expect("kill runs").success());
            // Two seconds are promised, on a machine that does nothing else.
            let ended = ended_within(&mut child, Duration::from_secs(6));
            let said = fs::read_to_string(&errors).unwrap();
            assert_eq!(ended, Some(Some(128 + number)), "{command_name} after {millis} ms: {said}");
            assert!(said.contains("stopped by a signal; "), "{said}");
            assert!(!here.join("out").exists(), "nothing was written");
        }
    }
}

/// A copy of a shipped set at `to`, with the lines that `keep` holds.
fn copy_of(set: &str, to: &Path, keep: impl Fn(&str) -> bool) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(shipped(set)).unwrap() {
        let from = entry.unwrap().path();
        let all = fs::read_to_string(&from).unwrap();
        let kept: Vec<&str> = all.lines().filter(|line| keep(line)).collect();
        fs::write(to.join(from.file_name().unwrap()), kept.join("\n") + "\n").unwrap();
    }
}

#[test]
fn new_runs_are_held_against_what_an_earlier_diagnosis_expected() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let new = "a90-v4.0";
    copy_of("s1-tables-vertical", &here.join("early"), |line| !line.contains(new));
    copy_of("s1-tables-vertical", &here.join("all"), |_| true);
    assert!(plunge(here, &["diagnose", "early", "--out", "first", "--quiet"]).status.success());
    let old = "first/diagnosis.json";
    let said =
        plunge(here, &["diagnose", "all", "--after", old, "--out", "second", "--json", "--quiet"]);
    let said: Value = serde_json::from_slice(&said.stdout).expect("one JSON object");
    let after = &said["after"];
    let came = after["came"].as_array().expect("the new condition");
    assert_eq!((came.len(), &came[0]["condition"], &came[0]["runs"]), (1, &new.into(), &1.into()));
    assert_eq!(came[0]["quantity"], "final_z_m");
    let measured = came[0]["measured"].as_f64().expect("a depth");
    let hypotheses = after["hypotheses"].as_array().expect("the effects that were open");
    let sum = |key: &str| hypotheses.iter().filter_map(|one| one[key].as_f64()).sum::<f64>();
    assert!((sum("before") - 1.0).abs() < 1e-4 && (sum("after") - 1.0).abs() < 1e-4, "{after}");
    // The tables are a smooth law: all effects that explain the rest come within their errors.
    for expected in came[0]["expected"].as_array().expect("one for each hypothesis") {
        let [value, se] = ["value", "se"].map(|key| expected[key].as_f64().expect("a number"));
        assert!((value - measured).abs() < 3.0 * se, "{expected} {measured}");
    }
    let text =
        shown(&plunge(here, &["diagnose", "all", "--after", old, "--out", "again", "--quiet"]));
    assert!(
        text.contains("\nNEW RUNS  measured, and as expected from the earlier ones:"),
        "{text}"
    );
    for (set, of, why) in [
        ("early", "first/diagnosis.json", "it rests on every run of the set"),
        ("early", "second/diagnosis.json", "which the set has not"),
        ("all", "early/runs.csv", "this is not the diagnosis.json"),
        ("all", "nowhere.json", "nowhere.json"),
    ] {
        let output = plunge(here, &["diagnose", set, "--after", of, "--out", "third"]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && said.contains(why), "{of}: {said}");
    }
}
