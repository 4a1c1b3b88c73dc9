//! `report.html`: every run leaves one, of its own results alone, and none makes a run fail.

use std::fs;
use std::path::Path;

use crate::common::{Call, folder, names};

fn report(folder: &Path) -> String {
    fs::read_to_string(folder.join("report.html")).expect("a report")
}

fn resistive(out: &Path, settings: &[&str]) {
    Call::new(["run", "--json", "--out"]).arg(out).arg("two-term-vector").set(settings).done();
}

/// Figures, and places in them that say a value.
fn figures(page: &str) -> (usize, usize) {
    (page.matches("<figure>").count(), page.matches("</title></").count())
}

#[test]
fn a_run_of_either_medium_leaves_a_page_with_its_motion_and_its_energies() {
    let (grains, law) = (folder(), folder());
    Call::run(grains.path()).done();
    resistive(law.path(), &[]);
    // Depth, velocity, force, acceleration, energy and what it misses; of a bed its three moments and its crater too.
    for (folder, losses, expected) in
        [(grains.path(), "lost to sliding", 10), (law.path(), "lost to depth friction", 6)]
    {
        let page = report(folder);
        let (figures, values) = figures(&page);
        // A hundred and twenty columns in each panel, fewer where samples are.
        assert!(figures == expected && values > 200, "{figures} figures, {values} values");
        assert!(page.contains(losses), "{losses}");
        assert!(!page.contains("://") && !page.contains("NaN"), "no address, and only numbers");
    }
}

#[test]
fn a_page_shows_the_grains_and_says_how_to_log_them_where_they_were_not() {
    let (logged, not) = (folder(), folder());
    Call::run(logged.path()).done();
    Call::run(not.path()).set(&["log.grains=false"]).done();
    let page = report(logged.path());
    let data = page.split("id=\"scenes\">").nth(1).and_then(|from| from.split("</script>").next());
    let data: serde_json::Value = serde_json::from_str(data.expect("scenes")).expect("JSON");
    let frames = data["times"].as_array().expect("times").len();
    let view = &data["views"][0];
    assert_eq!(view["n"], 300, "all grains of a small bed");
    for of_frames in ["bodies", "forces", "frames"] {
        assert_eq!(view[of_frames].as_array().map(Vec::len), Some(frames), "{of_frames}");
    }
    let page = report(not.path());
    assert!(!page.contains("id=\"scenes\"") && page.contains("--set log.grains=true"), "{page}");
}

#[test]
fn the_same_run_gives_the_same_page_whatever_the_threads_and_the_folder() {
    let (one, other) = (folder(), folder());
    Call::run(one.path()).arg("--threads").arg("1").done();
    Call::run(other.path()).arg("--threads").arg("3").done();
    assert!(report(one.path()) == report(other.path()));
}

#[test]
fn a_report_is_made_again_with_the_same_bytes() {
    let out = folder();
    Call::run(out.path()).done();
    let first = report(out.path());
    fs::remove_file(out.path().join("report.html")).expect("a report");
    let ended = Call::new(["report", "--json"]).arg(out.path()).done();
    assert!(ended.json()["report"].as_str().is_some_and(|file| file.ends_with("report.html")));
    assert!(report(out.path()) == first);
    // A finished run that lost its report gets it back, and one that has it keeps it.
    fs::write(out.path().join("report.html"), "mine").expect("a file");
    Call::run(out.path()).done();
    assert_eq!(report(out.path()), "mine");
    fs::remove_file(out.path().join("report.html")).expect("a report");
    Call::run(out.path()).done();
    assert!(report(out.path()) == first);
}

#[test]
fn a_list_has_a_page_and_so_has_each_of_its_runs() {
    let out = folder();
    let conditions = ["conditions.speed=[\"1 m/s\", \"2 m/s\"]", "conditions.angle=[\"45 deg\"]"];
    resistive(out.path(), &conditions);
    for member in ["001", "002"] {
        assert_eq!(figures(&report(&out.path().join(member))).0, 6, "{member}");
    }
    let page = report(out.path());
    assert_eq!(figures(&page), (2, 4), "two conditions in two panels");
}

#[test]
fn a_push_is_reported_as_one_with_its_force_over_depth_and_the_work_of_its_drive() {
    let out = folder();
    Call::new(["run", "--json", "--out"]).arg(out.path()).arg("bekker").done();
    let page = report(out.path());
    for said in
        ["A push of a cylinder (diameter", "work of the drive", "force at the end", "mm deep"]
    {
        assert!(page.contains(said), "{said} in {page}");
    }
    for of_an_impact in ["not reached", "An impact", "acceleration (m/s", "Friction becomes"] {
        assert!(!page.contains(of_an_impact), "{of_an_impact} in {page}");
    }
}

#[test]
fn a_report_that_cannot_be_made_is_told_and_the_run_stays_done() {
    let out = folder();
    let first = Call::run(out.path()).done();
    fs::remove_file(out.path().join("report.html")).expect("a report");
    fs::write(out.path().join("run.mcap"), "no log").expect("a file");
    let again = Call::run(out.path()).done();
    assert!(
        again.stderr.contains("warning: ") && again.stderr.contains("report.html"),
        "{again:?}"
    );
    assert_eq!(again.stdout, first.stdout, "the result is what it was");
    let message = Call::new(["report"]).arg(out.path()).fails(2);
    assert!(message.contains("not an MCAP file"), "{message}");
}

#[test]
fn a_folder_without_results_has_no_report() {
    let out = folder();
    let message = Call::new(["report"]).arg(out.path()).fails(2);
    assert!(message.contains("holds no finished run"), "{message}");
    assert!(names(out.path()).is_empty());
}

#[test]
fn two_runs_compared_leave_a_page_with_both_paths() {
    let (one, other, out) = (folder(), folder(), folder());
    resistive(one.path(), &[]);
    resistive(other.path(), &["impact.speed=3 m/s"]);
    let to = out.path().join("pair");
    Call::new(["compare", "--json", "--out"]).arg(&to).arg(one.path()).arg(other.path()).done();
    assert_eq!(names(&to), ["comparison.json", "inputs.blake3", "paths.svg", "report.html"]);
    assert_eq!(figures(&report(&to)).0, 1);
    let first = report(&to);
    Call::new(["report"]).arg(&to).done();
    assert!(report(&to) == first);
}
