//! What may be in an output folder, and what is done about it.

use std::fs::{self, File};
use std::path::Path;

use crate::common::{
    Call, assert_same_run, cache, ended_on_the_way, folder, names, small_model, summary, wait_for,
};

const SHORT: [&str; 1] = ["run.duration=2 ms"];

fn short(out: &Path) -> Call {
    Call::run(out).set(&SHORT)
}

fn modified(path: &Path) -> std::time::SystemTime {
    fs::metadata(path).and_then(|data| data.modified()).expect("a file with a time")
}

#[test]
fn results_of_other_inputs_are_refused_unless_forced() {
    let out = folder();
    short(out.path()).done();
    let before = fs::read(out.path().join("run.mcap")).expect("the log");
    for other in [&["impact.speed=2 m/s"][..], &["log.flush_every=7"], &["run.checkpoint_every=7"]]
    {
        for resume in [false, true] {
            let call = short(out.path()).set(other);
            let message = if resume { call.arg("--resume") } else { call }.fails(2);
            assert!(message.contains("other inputs") && message.contains("--force"), "{message}");
        }
    }
    assert!(short(out.path()).arg("--seed").arg("7").fails(2).contains("other inputs"));
    assert!(fs::read(out.path().join("run.mcap")).expect("the log") == before);
    let forced = short(out.path()).set(&["impact.speed=2 m/s"]).arg("--force").done();
    assert_eq!(forced.json()["impact"]["speed_m_per_s"], 2.0);
    assert_eq!(summary(out.path())["impact"]["speed_m_per_s"], 2.0);
}

#[test]
fn a_finished_run_of_the_same_inputs_is_reported_as_it_is() {
    let out = folder();
    let first = short(out.path()).done();
    assert_eq!(first.json(), summary(out.path()));
    let files = names(out.path());
    let times = || ["run.mcap", "summary.json"].map(|name| modified(&out.path().join(name)));
    let before = times();
    // Neither the threads nor another way to name the folder are inputs.
    let again = short(out.path()).done();
    let resumed = short(&out.path().join(".")).arg("--resume").arg("--threads").arg("1").done();
    assert_eq!((&again.stdout, &resumed.stdout), (&first.stdout, &first.stdout));
    assert_eq!(times(), before);
    assert_eq!(names(out.path()), files);
}

#[test]
fn an_unfinished_run_needs_resume_and_says_so() {
    let out = folder();
    let long = || Call::run(out.path()).set(&["run.checkpoint_every=100"]);
    let ended = ended_on_the_way(long, &out.path().join("checkpoint"), &["KILL"]);
    assert_eq!(ended.code, None, "a signal ended it");
    let message = long().fails(2);
    assert!(message.contains("unfinished") && message.contains("--resume"), "{message}");
    assert!(message.contains("--force"), "{message}");
    long().arg("--resume").done();
}

#[test]
fn a_folder_that_another_run_writes_to_is_refused_even_if_forced() {
    let out = folder();
    let mut child = Call::run(out.path()).set(&["run.duration=1 s"]).start();
    wait_for(&out.path().join("run.mcap.partial"));
    for flag in ["--force", "--resume", "--quiet"] {
        let message = short(out.path()).arg(flag).fails(2);
        assert!(message.contains("another run is writing"), "{message}");
    }
    child.kill().expect("it can be killed");
    child.wait().expect("it ends");
    // The lock goes with the process that held it.
    short(out.path()).arg("--force").done();
}

#[test]
fn folders_that_cannot_be_written_to_are_bad_input() {
    let parent = folder();
    let file = parent.path().join("file");
    fs::write(&file, "a file").expect("a file");
    for out in [file.clone(), file.join("below")] {
        let message = short(&out).fails(2);
        assert!(message.contains("file") && message.contains("cannot write to"), "{message}");
    }
    let out = parent.path().join("out");
    let args = ["run", "--cache"].map(std::ffi::OsStr::new);
    let message = Call::new(args).arg(&file).arg("--out").arg(&out).arg(small_model()).fails(2);
    assert!(message.contains("cannot write to"), "{message}");
    assert_eq!(fs::read_to_string(&file).expect("the file"), "a file");
    short(&parent.path().join("x".repeat(300))).fails(2);
    // The longest name a file system takes, and folders above that are made.
    short(&parent.path().join("deep").join("y".repeat(255))).done();
}

#[cfg(unix)]
#[test]
fn a_read_only_folder_is_bad_input() {
    use std::os::unix::fs::PermissionsExt as _;
    let out = folder();
    let mode = |bits| fs::set_permissions(out.path(), fs::Permissions::from_mode(bits));
    mode(0o555).expect("permissions");
    // Permissions stop everybody but root; the folders that the kernel makes stop root as well.
    let may_write_anywhere = File::create(out.path().join("probe")).is_ok();
    let (folder, message) = match may_write_anywhere {
        false => (out.path().to_owned(), short(out.path()).fails(2)),
        true => {
            let folder = Path::new("/sys/kernel/plunge").to_owned();
            let refused = fs::create_dir(&folder).is_err();
            assert!(refused, "run this test on Linux, or as another user than root");
            (folder.clone(), short(&folder).fails(2))
        }
    };
    let expected = format!("cannot write to the folder {}", folder.display());
    assert!(message.contains(&expected), "{message}");
    mode(0o755).expect("permissions");
}

// Other systems have file systems with rules of their own.
#[cfg(target_os = "linux")]
#[test]
fn a_path_that_is_not_utf_8_is_as_good_as_any() {
    use std::os::unix::ffi::OsStrExt as _;
    let parent = folder();
    let strange = parent.path().join(std::ffi::OsStr::from_bytes(b"caf\xe9"));
    fs::create_dir(&strange).expect("a folder of any name");
    let (model, out, beds) =
        (strange.join("model.toml"), strange.join("out"), strange.join("beds"));
    fs::copy(small_model(), &model).expect("a model");
    Call::run_model(&model, &out).set(&SHORT).done();
    short(&parent.path().join("out")).done();
    assert_same_run(&out, &parent.path().join("out"));
    assert!(Call::run_model(&model, &out).set(&["run.seed=2"]).fails(2).contains("other inputs"));
    let bed = Call::new(["bed", "--json", "--cache"]).arg(&beds).arg(&model).done();
    assert_eq!(bed.json()["cache"], "miss");
    for command in ["run", "bed", "check"] {
        Call::new([command]).arg(strange.join("none.toml")).fails(2);
    }
}

#[test]
fn files_of_others_are_refused_and_kept_when_forced() {
    let out = folder();
    let (notes, deep) = (out.path().join("notes.txt"), out.path().join("data/001"));
    fs::create_dir_all(&deep).expect("a folder");
    fs::write(&notes, "mine").expect("a file");
    fs::write(deep.join("model.toml"), "mine").expect("a file");
    let message = short(out.path()).fails(2);
    assert!(message.contains("`data`") && message.contains("--force"), "{message}");
    assert_eq!(names(out.path()), ["data", "notes.txt"]);
    for _ in 0..2 {
        short(out.path()).arg("--force").done();
        assert_eq!(fs::read_to_string(&notes).expect("the file"), "mine");
        assert_eq!(fs::read_to_string(deep.join("model.toml")).expect("the file"), "mine");
    }
}

#[test]
fn a_file_named_like_a_result_is_kept_even_when_forced_where_no_run_has_been() {
    for name in ["summary.json", "grains.csv", "model.toml"] {
        let out = folder();
        fs::write(out.path().join(name), "mine").expect("a file");
        for _ in 0..2 {
            let message = short(out.path()).arg("--force").fails(2);
            assert!(message.contains(name) && message.contains("--out"), "{message}");
        }
        assert_eq!(names(out.path()), [name]);
        assert_eq!(fs::read_to_string(out.path().join(name)).expect("the file"), "mine");
    }
}

#[test]
fn force_removes_every_file_of_earlier_runs_and_no_other() {
    let out = folder();
    let list = ["conditions.speed=[\"1 m/s\", \"2 m/s\"]"];
    short(out.path()).set(&list).done();
    for name in ["002/mine.txt", "003", "2024", "checkpoint.partial", "run.mcap.partial.new"] {
        fs::write(out.path().join(name), "").expect("a file");
    }
    fs::create_dir(out.path().join("004")).expect("a folder");
    fs::write(out.path().join("004/run.mcap"), "without a model").expect("a file");
    short(out.path()).arg("--force").done();
    let left = [
        ".lock",
        "002",
        "003",
        "004",
        "2024",
        "grains.mcap",
        "model.toml",
        "report.html",
        "run.mcap",
        "summary.json",
    ];
    assert_eq!(names(out.path()), left);
    assert_eq!(names(&out.path().join("002")), ["mine.txt"]);
    assert_eq!(names(&out.path().join("004")), ["run.mcap"]);
}

#[test]
fn the_model_in_an_output_folder_runs_again_in_that_folder() {
    let (out, other) = (folder(), folder());
    short(out.path()).done();
    let model = out.path().join("model.toml");
    let before = fs::read(&model).expect("the model");
    Call::run_model(&model, out.path()).done();
    Call::run_model(&model, out.path()).arg("--force").done();
    assert!(fs::read(&model).expect("the model") == before);
    Call::run_model(&model, other.path()).done();
    assert_same_run(out.path(), other.path());
}

#[test]
fn without_out_a_run_goes_below_the_current_folder_by_its_name() {
    let here = folder();
    let arguments = ["run", "--quiet", "--cache"].map(std::ffi::OsStr::new);
    let call = Call::new(arguments).arg(cache()).arg(small_model()).set(&SHORT);
    call.inside(here.path()).done();
    assert!(here.path().join("runs/small-2d/run.mcap").is_file());
    assert_eq!(names(here.path()), ["runs"]);
}
