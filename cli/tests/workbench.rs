//! The workbench seen from outside: compare, diagnose, add, and compare again.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

/// A shipped measurement set.
fn shipped(set: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../validation/data").join(set)
}

fn plunge(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_plunge"))
        .current_dir(folder)
        .args(args)
        .output()
        .expect("the binary runs")
}

fn json(folder: &Path, args: &[&str]) -> Value {
    let output = plunge(folder, args);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{args:?}: {errors}");
    serde_json::from_slice(&output.stdout).expect("one JSON object")
}

fn text(path: &Path) -> &str {
    path.to_str().expect("a test path is UTF-8")
}

/// A copy of a shipped set, so that it can be changed.
fn copied(set: &str, into: &Path) -> PathBuf {
    let copy = into.join(set);
    fs::create_dir(&copy).unwrap();
    for file in fs::read_dir(shipped(set)).unwrap() {
        let file = file.unwrap();
        fs::copy(file.path(), copy.join(file.file_name())).unwrap();
    }
    copy
}

fn relative(model: &Value, role: &str) -> f64 {
    model["rms"][role]["rms_relative"].as_f64().expect("an error")
}

#[test]
fn the_error_falls_when_the_effect_that_was_found_is_added() {
    let here = tempfile::tempdir().unwrap();
    let (set, here) = (shipped("s1-tables-vertical"), here.path());
    let before = json(here, &["compare", text(&set), "--json", "--quiet"]);
    // 12 % is what the published law misses its own tables by at 90 degrees after a refit.
    let published = relative(&before["models"][0], "fit");
    assert!((0.10..0.15).contains(&published), "{published}");
    assert!(before["models"][0]["p_lof"].as_f64().unwrap() < 1e-3);

    let found = json(here, &["diagnose", text(&set), "--json", "--quiet"]);
    assert_eq!(found["verdict"], "not-separable");
    let together: Vec<&str> =
        found["not_separable"].as_array().unwrap().iter().filter_map(Value::as_str).collect();
    for effect in ["yield-stress", "depth-exponent", "janssen"] {
        assert!(together.contains(&effect), "{together:?}");
    }
    assert!(!together.contains(&"viscous-drag"), "{together:?}");
    let ranking = found["ranking"].as_array().unwrap();
    let exponent = ranking.iter().find(|effect| effect["id"] == "depth-exponent").unwrap();
    // An independent search over all sixteen numbers found the power 0.447.
    assert!((exponent["q"].as_f64().unwrap() + 0.55).abs() < 0.02, "{exponent}");

    for (effect, most) in [("yield-stress", 0.036), ("janssen", 0.05)] {
        let model = format!("runs/s1-tables-vertical-diagnose/model+{effect}.toml");
        let out = ["--out", effect, "--json", "--quiet"];
        let with = json(here, &[&["compare", text(&set), "--model", &model], &out[..]].concat());
        let error = relative(&with["models"][0], "fit");
        assert!(error < most, "{effect}: {error}");
    }

    let folder = here.join("runs/s1-tables-vertical-diagnose");
    let diagnosis = folder.join("diagnosis.json");
    let added = here.join("better.toml");
    let effect = ["--effect", "depth-exponent", "-o", text(&added)];
    let add = plunge(
        here,
        &[&["add", "two-term-components", "--from", text(&diagnosis)], &effect[..]].concat(),
    );
    assert!(add.status.success(), "{}", String::from_utf8_lossy(&add.stderr));
    assert_eq!(
        fs::read_to_string(&added).unwrap(),
        fs::read_to_string(folder.join("model+depth-exponent.toml")).unwrap(),
        "the proposed model is what `add` writes"
    );
    let models = ["--model", "two-term-components", "--model", text(&added), "--force"];
    let after = json(here, &[&["compare", text(&set), "--json", "--quiet"], &models[..]].concat());
    let [old, new] = [0, 1].map(|index| &after["models"][index]);
    assert!((relative(old, "fit") - published).abs() < 1e-9);
    // 2.9 % was found for this exponent by an independent search; held out, a third is left too.
    assert!(relative(new, "fit") < 0.035, "{}", relative(new, "fit"));
    assert!(relative(new, "holdout") < relative(old, "holdout") / 3.0);
    assert!(new["p_lof"].as_f64().unwrap() > 0.05);
}

#[test]
fn the_published_law_sinks_too_deep_when_slow_and_too_little_when_fast() {
    let here = tempfile::tempdir().unwrap();
    let set = shipped("s1-tables-vertical");
    let args = ["compare", text(&set), "--quiet", "--set", "fit.free=[]"];
    let output = plunge(here.path(), &args);
    let shown = String::from_utf8(output.stdout).unwrap();
    let depth_at = |condition: &str| {
        let of = |line: &&str| line.contains(condition) && line.contains("depth");
        shown.lines().find(of).unwrap_or_else(|| panic!("no depth of {condition}")).to_owned()
    };
    // The published law integrated by another program: 120.4 mm for 96.9, 174.1 for 189.3.
    assert!(depth_at("a90-v1.0").contains("120.4 (+24 %)"), "{shown}");
    assert!(depth_at("a90-v4.0").contains("174.1 (-8 %)"), "{shown}");
}

#[test]
fn where_a_model_fails_is_written_and_listed_and_old_views_do_not_stay() {
    let here = tempfile::tempdir().unwrap();
    let (set, folder) = (shipped("s1-tables-vertical"), here.path().join("out"));
    let written = |command: &str| {
        let args = [command, text(&set), "--quiet", "--out", "out", "--force"];
        let output = plunge(here.path(), &args);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let shown = String::from_utf8(output.stdout).unwrap();
        let listed = shown.lines().find_map(|line| line.strip_prefix("written to out: "));
        let mut listed: Vec<String> =
            listed.expect("files are listed").split(", ").map(str::to_owned).collect();
        listed.sort();
        let entries = fs::read_dir(&folder).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut found: Vec<String> = names.filter(|name| name != "inputs.blake3").collect();
        found.sort();
        assert_eq!(listed, found, "what is listed is there, and nothing else");
        found
    };
    let views = [
        "covariates.svg",
        "errors.svg",
        "force_errors.csv",
        "map-speed-angle.svg",
        "report.html",
        "residuals.csv",
        "where_it_fails.json",
    ];
    let diagnosed = written("diagnose");
    let of_diagnosis = ["diagnosis.json", "signatures.csv", "signatures.svg"];
    for name in views.iter().chain(&of_diagnosis) {
        assert!(diagnosed.iter().any(|found| found == name), "{name} in {diagnosed:?}");
    }
    let table = fs::read_to_string(folder.join("signatures.csv")).unwrap();
    // Two numbers of each of eight conditions, for two effects, and a header.
    assert_eq!(table.lines().count(), 1 + 2 * 2 * 8);

    let compared = written("compare");
    let mut expected = [&views[..], &["comparison.json", "comparison.svg"]].concat();
    expected.sort_unstable();
    assert_eq!(compared, expected, "tables alone: no depths, no trajectories, no signatures");
}

#[test]
fn every_shipped_set_is_compared_with_the_baseline_that_it_names() {
    let here = tempfile::tempdir().unwrap();
    for set in ["free-link", "katsuragi-durian", "s1-tables"] {
        let found = json(here.path(), &["compare", text(&shipped(set)), "--json", "--quiet"]);
        let model = &found["models"][0];
        assert!(relative(model, "fit") < 0.2, "{set}: {model}");
        assert!(model["p_lof"].is_number(), "{set}");
    }
}

#[test]
fn an_added_effect_leaves_the_rest_of_the_model_as_it_was_written() {
    let here = tempfile::tempdir().unwrap();
    let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("../configs/two-term-vector.toml");
    let before = fs::read_to_string(&model).unwrap();
    let add =
        plunge(here.path(), &["add", text(&model), "viscous-drag", "q=0.5", "-o", "new.toml"]);
    assert!(add.status.success(), "{}", String::from_utf8_lossy(&add.stderr));
    let after = fs::read_to_string(here.path().join("new.toml")).unwrap();
    let kept: Vec<&str> = before.lines().filter(|line| !line.starts_with("free")).collect();
    let shown: Vec<&str> = after.lines().filter(|line| !line.starts_with("free")).collect();
    assert_eq!(shown[..kept.len()], kept[..]);
    assert_eq!(shown[kept.len()..], ["", "[[effect]]", "name = \"viscous-drag\"", "q = 0.5"]);
}

#[test]
fn a_diagnosis_does_not_hang_on_names_or_order_and_not_on_what_is_held_out() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let set = copied("s1-tables-vertical", here);
    let diagnose = || {
        let args = ["diagnose", text(&set), "--json", "--quiet", "--out", "out"];
        let output = plunge(here, &args);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let first = diagnose();
    assert_eq!(first, diagnose(), "equal inputs give equal bytes");

    let runs = set.join("runs.csv");
    let table = fs::read_to_string(&runs).unwrap();
    let is_row = |line: &&str| !line.starts_with('#') && !line.starts_with("run,");
    let head: Vec<&str> = table.lines().filter(|line| !is_row(line)).collect();
    let mut rows: Vec<String> =
        table.lines().filter(is_row).map(|row| format!("renamed-{row}")).collect();
    rows.reverse();
    fs::write(&runs, format!("{}\n{}\n", head.join("\n"), rows.join("\n"))).unwrap();
    let renamed = diagnose().replace("renamed-", "");
    assert_eq!(first, renamed, "names and order of runs change nothing but the names");

    let corrupted = table.lines().map(|line| {
        let cells: Vec<&str> = line.split(',').collect();
        match cells[1..].first() {
            // 1.5 and 3.5 m/s are held out.
            Some(&condition) if condition.ends_with("v1.5") || condition.ends_with("v3.5") => {
                let mut cells = cells.clone();
                cells[4] = "0.5";
                cells.join(",")
            }
            _ => line.to_owned(),
        }
    });
    fs::write(&runs, corrupted.map(|line| line + "\n").collect::<String>()).unwrap();
    fs::remove_dir_all(here.join("out")).unwrap();
    let corrupt: Value = serde_json::from_str(&diagnose()).unwrap();
    let first: Value = serde_json::from_str(&first).unwrap();
    assert_ne!(corrupt["holdout"], first["holdout"], "held-out rows are judged");
    assert_eq!(corrupt["ranking"], first["ranking"], "held-out rows choose nothing");
}

#[test]
fn results_of_other_inputs_are_not_written_over() {
    let here = tempfile::tempdir().unwrap();
    let set = shipped("katsuragi-durian");
    let args = ["compare", text(&set), "--quiet", "--out", "out"];
    assert!(plunge(here.path(), &args).status.success());
    let again = plunge(here.path(), &args);
    assert!(again.status.success(), "the same inputs may come again");
    let other = [&args[..], &["--seed", "7"]].concat();
    let refused = plunge(here.path(), &other);
    assert_eq!(refused.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("--force"));
    assert!(plunge(here.path(), &[&other[..], &["--force"]].concat()).status.success());
}

#[test]
fn sets_that_were_simulated_are_kept_for_the_same_inputs_and_not_for_others() {
    let here = tempfile::tempdir().unwrap();
    let (set, file) = (shipped("s1-tables-vertical"), here.path().join("out/calibration.json"));
    let args = ["diagnose", text(&set), "--json", "--quiet", "--out", "out"];
    let plain = json(here.path(), &args);
    assert_ne!(plain["probability"]["counted_in"], "design");
    let simulated = [("nothing", "nothing-detected", ""), ("janssen", "not-separable", "janssen")];
    let sets = simulated.map(|(truth, verdict, named)| {
        let named: Vec<&str> = Some(named).filter(|name| !name.is_empty()).into_iter().collect();
        serde_json::json!({ "truth": truth, "verdict": verdict, "named": named, "covered": null })
    });
    fs::write(&file, serde_json::json!({ "rows": [], "sets": sets }).to_string()).unwrap();
    let kept = json(here.path(), &args);
    assert_eq!(kept["probability"]["counted_in"], "design");
    assert_eq!(kept["probability"]["right"], 1.0);
    assert!(file.exists());
    let other = [&args[..], &["--seed", "7", "--force"]].concat();
    assert_ne!(json(here.path(), &other)["probability"]["counted_in"], "design");
    assert!(!file.exists());
}

#[test]
fn what_cannot_be_compared_is_answered_with_what_could_be() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let set = shipped("s1-tables-vertical");
    let message = |args: &[&str]| {
        let output = plunge(here, args);
        assert_eq!(output.status.code(), Some(2), "{args:?}");
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    assert!(message(&["compare", "nowhere"]).contains("nowhere"));
    let spatial = shipped("katsuragi-durian");
    let grains = message(&["compare", text(&spatial), "--quiet", "--model", "vertical-2d"]);
    assert!(grains.contains("a bed in 2d, and the set is one in 3d"), "{grains}");
    let args = ["diagnose", text(&set), "--model", "vertical-2d", "--plan", "--quiet"];
    let typo = message(&[&args[..], &["--candidate", "roling"]].concat());
    assert!(typo.contains("rolling-resistance") && typo.contains("rail-friction"), "{typo}");
    let free = message(&[&args[..], &["--free", "tilt"]].concat());
    assert!(free.contains("no candidate `tilt`"), "an apparatus is no parameter of a bed: {free}");
    let typo = message(&["add", "two-term-vector", "jansen", "q=1", "-o", "new.toml"]);
    assert!(typo.contains("did you mean `janssen`?"), "{typo}");
    assert!(!here.join("new.toml").exists());
    let nothing = message(&["add", "two-term-vector", "-o", "new.toml"]);
    assert!(nothing.contains("--from"), "{nothing}");
}

#[test]
fn a_plan_of_impacts_on_beds_is_shaped_by_its_budget_and_runs_nothing() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let set = shipped("s1-tables-vertical");
    let plan = |budget: &[&str]| {
        let args =
            ["diagnose", text(&set), "--model", "vertical-2d", "--plan", "--json", "--quiet"];
        json(here, &[&args[..], budget].concat())["cost"]["plan"].clone()
    };
    let standard = plan(&[]);
    assert_eq!(standard["size"], "standard");
    let (few, many) = (plan(&["--budget", "1 s"]), plan(&["--budget", "9000 h"]));
    assert_eq!((&few["size"], &many["size"]), (&"smallest".into(), &"thorough".into()));
    let impacts = |plan: &Value| plan["impacts"].as_u64().unwrap();
    assert!(impacts(&few) < impacts(&standard) && impacts(&standard) < impacts(&many));
    assert!(!here.join("runs").exists(), "nothing is run, and nothing written");
}

#[test]
fn a_candidate_in_the_model_is_listed_ranked_and_made_a_part_of_it() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    let baseline =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../configs/two-term-components.toml");
    let candidate = "\n# grains that stick\n[[candidate]]\nname = \"expression\"\nid = \"stickiness\"\n\
                     force = \"q * rho * g * A * D\"\nkind = \"friction\"\n\
                     parameters.q = { unit = \"1\", range = [0, 50] }\n";
    let text_of_model = format!("{}{candidate}", fs::read_to_string(baseline).unwrap());
    fs::write(here.join("mine.toml"), &text_of_model).unwrap();
    let listed = json(here, &["effects", "--model", "mine.toml", "--json"]);
    let own = listed["effects"].as_array().unwrap().last().unwrap().clone();
    assert_eq!((&own["name"], &own["table"]), (&"stickiness".into(), &"[[candidate]]".into()));

    let set = shipped("s1-tables-vertical");
    let args =
        ["diagnose", text(&set), "--model", "mine.toml", "--json", "--quiet", "--out", "out"];
    let found = json(here, &args);
    let ranking = found["ranking"].as_array().unwrap();
    let q = |id: &str| ranking.iter().find(|one| one["id"] == id).unwrap()["q"].as_f64().unwrap();
    // The formula is that of an effect of the table: only the places where derivatives are taken differ.
    assert!((q("stickiness") / q("yield-stress") - 1.0).abs() < 1e-3, "{ranking:?}");

    let from = ["--from", "out/diagnosis.json", "--effect", "stickiness", "-o", "with.toml"];
    let add = plunge(here, &[&["add", "mine.toml"], &from[..]].concat());
    assert!(add.status.success(), "{}", String::from_utf8_lossy(&add.stderr));
    let with = fs::read_to_string(here.join("with.toml")).unwrap();
    assert!(with.contains("# grains that stick\n[[effect]]\nname = \"expression\"\n"), "{with}");
    let listed = json(here, &["effects", "stickiness", "--model", "with.toml", "--json"]);
    let value = listed["parameters"][0]["value"].as_f64().unwrap();
    // Nine digits are written.
    assert!((value / q("stickiness") - 1.0).abs() < 1e-8, "{value}");
    let again = ["compare", text(&set), "--model", "with.toml", "--json", "--quiet"];
    assert!(relative(&json(here, &again)["models"][0], "fit") < 0.036);
}
