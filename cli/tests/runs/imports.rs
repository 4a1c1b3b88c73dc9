//! `plunge import` of tables: two commands from a folder of tables to a diagnosis, and what it refuses.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use crate::common::{Call, folder, names};

/// Height (cm) of a ball that falls 20 cm, or `height` (cm), and is stopped by a force `b v² + k z + c`, at 500 frames
/// a second: none of it is code of plunge.
fn table(height: f64, seed: u32) -> String {
    let (g, mass): (f64, f64) = (9.81, 0.067);
    let scatter = |k: u32| 1.0 + 0.03 * (f64::from((seed * 31 + k * 17) % 21) / 10.0 - 1.0);
    let (b, k, c) = (1.6 * scatter(1), 35.0 * scatter(2), 0.5 * scatter(3));
    let (hold, fall) = (0.1, (2.0 * 0.01 * height / g).sqrt());
    let (mut depth, mut velocity, mut now) = (0.0, g * fall, hold + fall);
    let mut text = String::from("t (ms);y (cm)\n");
    for frame in 0..350_u32 {
        let t = f64::from(frame) / 500.0;
        let z = match t {
            t if t < hold => 0.01 * height,
            t if t < hold + fall => 0.01 * height - 0.5 * g * (t - hold).powi(2),
            t => {
                while now < t && velocity > 0.0 {
                    let step = 1e-5;
                    velocity += step * (g - (b * velocity * velocity + k * depth + c) / mass);
                    depth += step * velocity.max(0.0);
                    now += step;
                }
                -depth
            }
        };
        // Nearly normal.
        let uniform =
            |k: u32| f64::from((frame * 7919 + seed * 104_729 + k * 1291) % 1009) / 1009.0 - 0.5;
        let noise = (0..4).map(uniform).sum::<f64>();
        let row = format!("{:.2};{:.4}\n", 1e3 * t, 18.4 + 1e2 * z + 0.015 * noise);
        let _ = write!(text, "{}", row.replace('.', ","));
    }
    text
}

/// Leaves tables of drops from four heights, three times each, in `folder`.
fn write_tables(folder: &Path) {
    for (at, height) in [5.0, 10.0, 20.0, 40.0].into_iter().enumerate() {
        for repeat in 1..4_u32 {
            let text = table(height, 10 * at as u32 + repeat);
            fs::write(folder.join(format!("ball_h{height:02}_r{repeat}.csv")), text)
                .expect("a table");
        }
    }
}

const BALL: [&str; 4] = ["--diameter", "25.4mm", "--mass", "67 g"];

#[test]
fn two_commands_lead_from_tables_to_a_named_effect() {
    let here = folder();
    write_tables(here.path());
    let call = Call::new(["import", "ball_*.csv", "-o", "my"]).args(BALL).inside(here.path());
    let text = call.done().stdout;
    for wanted in [
        "one drop, semicolons",
        "y (cm), up",
        "Surface: one level for all runs",
        "4 conditions, 12 runs",
    ] {
        assert!(text.contains(wanted), "{wanted}: {text}");
    }
    let said = Call::new(["diagnose", "my"]).inside(here.path()).done().stdout;
    assert!(said.contains("VERDICT") && said.contains("yield-stress"), "{said}");
    assert!(said.contains("left out one at a time"), "{said}");
}

#[test]
fn an_import_is_repeated_by_its_file_and_refused_over_another_set() {
    let here = folder();
    write_tables(here.path());
    let import = |more: &[&str]| Call::new(["import"]).args(more).inside(here.path());
    import(&["ball_h05_r1.csv", "ball_h40_r1.csv", "-o", "my"])
        .args(BALL)
        .args(["--condition", "{body}_h{height}_r{repeat}"])
        .done();
    import(&["my/import.toml", "-o", "again"]).done();
    for name in ["runs.csv", "trajectories.csv", "import.toml"] {
        let read = |set: &str| fs::read_to_string(here.path().join(set).join(name)).expect(name);
        assert_eq!(read("my"), read("again"), "{name}");
    }
    let set = fs::read_to_string(here.path().join("my/measurement.toml")).expect("a set");
    assert!(set.contains("id = \"ball_h05\"") && !set.contains("\nrole ="), "{set}");
    // In place, nothing is new.
    import(&["--from", "my/import.toml"]).done();
    let message = import(&["ball_h05_r1.csv", "-o", "my"]).args(BALL).fails(2);
    assert!(message.contains("my holds another set; --force replaces it"), "{message}");
    fs::write(here.path().join("ball_h05_r1.csv"), table(15.0, 77)).expect("a table");
    let message = import(&["my/import.toml", "-o", "third"]).fails(2);
    assert!(message.contains("ball_h05_r1.csv: it is not what it was"), "{message}");
    let wrong = set.replace("schema", "scheme");
    fs::write(here.path().join("my/import.toml"), wrong).expect("a file");
    let message = import(&["my/import.toml", "-o", "third"]).fails(2);
    assert!(message.contains("the table [import] is missing"), "{message}");
    assert!(!names(here.path()).contains(&"third".to_owned()));
}

#[test]
fn what_is_missing_is_asked_for_before_anything_is_written() {
    let here = folder();
    write_tables(here.path());
    let fails = |more: &[&str]| {
        Call::new(["import", "ball_h05_r1.csv"]).args(more).inside(here.path()).fails(2)
    };
    let message = fails(&BALL);
    assert!(message.contains("add -o SET"), "{message}");
    let message = fails(&["-o", "my", "--mass", "67 g"]);
    assert!(
        message.contains("no table says the diameter of the body")
            && message.contains("write --diameter 25.4mm"),
        "{message}"
    );
    let message = fails(&["-o", "my", "--mass", "67 g", "--diameter", "25,4 mm"]);
    assert!(
        message.contains("--diameter: \"25,4 mm\" has a decimal comma")
            && message.contains("25.4 mm"),
        "{message}"
    );
    let message = fails(&["-o", "my", "--column", "q=t"]);
    assert!(message.contains("--column q=t: write t=NAME"), "{message}");
    let message = fails(&["nothing_*.csv", "-o", "my"]);
    assert!(message.contains("nothing_*.csv: no file fits this pattern"), "{message}");
    let message =
        Call::new(["import", "none.csv", "-o", "my"]).args(BALL).inside(here.path()).fails(2);
    assert!(message.contains("none.csv: there is no such file"), "{message}");
    assert!(!names(here.path()).contains(&"my".to_owned()));
    let bodies = "body;diameter (mm);mass (g);shape\nball;25,4;67;sphere\n";
    fs::write(here.path().join("bodies.csv"), bodies).expect("a table");
    let call = Call::new([
        "import",
        "ball_h05_r1.csv",
        "ball_h40_r2.csv",
        "-o",
        "my",
        "--bodies",
        "bodies.csv",
        "--json",
    ]);
    let call = call.args([
        "--condition",
        "{body}_h{height}_r{repeat}",
        "--drop-height",
        "{height} cm",
        "--surface",
        "18.4cm",
    ]);
    let said = call.inside(here.path()).done().stdout;
    let json: serde_json::Value = serde_json::from_str(&said).expect("one object");
    assert_eq!(json["conditions"], 2);
    let speed = json["runs"][1]["speed_m_per_s"]["value"].as_f64().expect("a speed");
    assert!((speed - (2.0 * 9.81 * 0.4_f64).sqrt()).abs() < 1e-12, "{speed}");
    let set = fs::read_to_string(here.path().join("my/measurement.toml")).expect("a set");
    assert!(set.contains("diameter = 0.0254") && set.contains("mass = 0.067"), "{set}");
}

#[test]
fn a_set_that_is_refused_leaves_nothing_and_the_one_before_it_as_it_was() {
    let here = folder();
    write_tables(here.path());
    let import = |more: &[&str]| {
        Call::new(["import", "ball_h05_r1.csv", "-o", "my", "--diameter", "25.4mm"])
            .args(more)
            .inside(here.path())
    };
    // As no body has.
    let heavy = ["--mass", "67 kg", "--shape", "cylinder", "--height", "2mm"];
    assert!(import(&heavy).fails(2).contains("as no body has"));
    assert!(!names(here.path()).contains(&"my".to_owned()));
    import(&["--mass", "67 g"]).done();
    let read = || fs::read_to_string(here.path().join("my/measurement.toml")).expect("a set");
    let before = read();
    import(&[&heavy[..], &["--force"]].concat()).fails(2);
    assert_eq!(read(), before);
    import(&["--mass", "67 g"]).done();
}
