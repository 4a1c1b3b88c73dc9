//! Every defective set is refused, or understood, with the expected message.

use std::fs;
use std::path::{Path, PathBuf};

use configs::{Color, Diagnostic, Sources, render_all};
use fixtures::Case;
use measurements::MeasurementSet;
use tempfile::TempDir;

/// Where the cases are.
const BAD: &str = "tests/data/bad";

/// A set on the disk, until this is dropped.
struct Written {
    folder: PathBuf,
    _around: TempDir,
}

/// The set `case` in a folder of its own: a good set with changes in it. What is no text stands
/// as a file in the folder of the case's name. Beside the new folder lies a table, `runs.csv`.
fn written(case: &Case) -> Result<Written, String> {
    let text = |error: std::io::Error| error.to_string();
    let around = tempfile::tempdir().map_err(text)?;
    let folder = around.path().join("set");
    fs::create_dir(&folder).map_err(text)?;
    fs::copy("tests/data/good/scalars/runs.csv", around.path().join("runs.csv")).map_err(text)?;
    for entry in fs::read_dir(Path::new("tests/data/good").join(&case.base)).map_err(text)? {
        let good = entry.map_err(text)?.path();
        let (name, stem) = (good.file_name().unwrap_or_default(), good.file_stem());
        let bytes = Path::new(BAD).join(&case.name).join(name);
        let changed = match fs::read(&bytes) {
            Ok(bytes) => bytes,
            Err(_) => {
                let stem = stem.unwrap_or_default().to_string_lossy();
                let good = fs::read_to_string(&good).map_err(text)?;
                case.apply_to(&stem, &good).map_err(|error| error.to_string())?.into_bytes()
            }
        };
        fs::write(folder.join(name), changed).map_err(text)?;
    }
    Ok(Written { folder, _around: around })
}

/// What a user reads about the set `case`.
fn message(case: &Case) -> Result<String, String> {
    let written = written(case)?;
    let show = |diagnostics: &[Diagnostic], sources: &Sources| match case.whole {
        true => render_all(diagnostics, sources, Color::Off),
        false => diagnostics.iter().map(|one| one.brief(sources)).collect(),
    };
    let text = match MeasurementSet::load(&written.folder) {
        Err(error) => show(&error.diagnostics, &error.sources),
        Ok(loaded) => {
            let lines = loaded.tables.iter().chain(&loaded.set.notes);
            let lines: String = lines.map(|line| format!("{line}\n")).collect();
            let denied = loaded.contradictions.iter().map(|one| one.diagnostic.clone());
            let all: Vec<Diagnostic> = denied.chain(loaded.warnings).collect();
            format!("accepted\n{lines}{}", show(&all, &loaded.sources))
        }
    };
    Ok(text.replace(&format!("{}/", written.folder.display()), ""))
}

/// The case `name`, written.
fn bad(name: &str) -> Written {
    let topics = fixtures::topics(Path::new(BAD)).unwrap_or_else(|error| panic!("{error}"));
    let mut cases = topics.iter().flat_map(|topic| &topic.cases);
    let case = cases.find(|case| case.name == name).expect("a case of this name");
    written(case).unwrap_or_else(|error| panic!("{error}"))
}

/// `BLESS=1` in the environment rewrites the expected messages.
#[test]
fn every_defect_of_a_set_brings_the_expected_message() {
    fixtures::check(Path::new(BAD), message).unwrap_or_else(|wrong| panic!("{wrong}"));
}

#[test]
fn what_differs_in_form_alone_reads_to_the_same_set() {
    let load =
        |folder: &Path| MeasurementSet::load(folder).unwrap_or_else(|error| panic!("{error}")).set;
    let plain = load(Path::new("tests/data/good/scalars"));
    for name in [
        "byte-order-mark",
        "line-ends-crlf",
        "line-ends-cr",
        "no-last-line-end",
        "blank-lines-and-no-last-line-end",
    ] {
        assert_eq!(load(&bad(name).folder), plain, "{name}");
    }
    for name in ["semicolons", "tabs", "semicolons-and-decimal-commas"] {
        assert_eq!(load(&bad(name).folder).runs, plain.runs, "{name}");
    }
}

#[test]
fn a_set_that_is_not_there_is_told_by_its_name() {
    let told =
        |path: &str| MeasurementSet::load(Path::new(path)).expect_err("no set").render(Color::Off);
    assert_eq!(told("tests/data/none"), "error: `tests/data/none`: there is no such file\n\n");
    assert_eq!(
        told("tests/data"),
        "error: `tests/data/measurement.toml`: there is no such file\n\n"
    );
}

#[test]
fn a_set_describes_itself() {
    let loaded = MeasurementSet::load(&bad("renamed-columns").folder)
        .unwrap_or_else(|error| panic!("{error}"));
    let wanted = "\
sample: trajectories, 2 conditions (1 held out), 2 runs
three-dimensional bed, 1480 kg/m^3, grains of 0.0008 m, gravity 9.81 m/s^2
baseline two-term-vector

condition  role     speed (m/s)  angle (deg)  shape   diameter (m)  mass (kg)  runs  readings  measured
c01        fit      1            90           sphere  0.0254        0.0667     1     7         stop_time, final_z, z(t)
c02        holdout  2            30           sphere  0.0254        0.0667     1     7         stop_time, final_z, final_x, z(t), x(t)

runs.csv: run, condition, repeat, order, stop_time (s), final_z (m), final_x (m)
trajectories.csv: run = trial, t = time_ms (ms), z = height_mm (mm, turned round), x (m)
source: made up for this test
note: In trajectories.csv the column `note` is ignored.
";
    assert_eq!(loaded.describe(), wanted);
    let without = wanted.lines().filter(|line| !line.contains(".csv: "));
    assert_eq!(loaded.set.describe().lines().collect::<Vec<_>>(), without.collect::<Vec<_>>());
}

#[test]
fn what_the_frames_and_the_names_of_files_say_may_be_left_out() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let write =
        |name: &str, text: String| fs::write(folder.path().join(name), text).expect("a file");
    // Free fall at 2 m/s, then a constant brake, at 1000 frames a second.
    let depth = |t: f64| 2.0 * t + if t < 0.0 { 4.905 * t * t } else { -40.0 * t * t };
    for run in ["a", "b"] {
        let row =
            |k: i32| format!("{0:.3};{1:.5}\n", f64::from(k), 1e2 * depth(1e-3 * f64::from(k)));
        write(
            &format!("drop {run}.csv"),
            "t;z\n".to_owned() + &(-40..20).map(row).collect::<String>(),
        );
    }
    write("runs.csv", "run;condition\ndrop a;c01\ndrop b;c01\n".to_owned());
    let toml = "schema = 1\n[measurement]\nid = \"left-out\"\nkind = \"trajectory\"\n\
                [instrument]\nrate_hz = \"1 kHz\"\nposition_sigma_m = \"10 um\"\n\
                [bed]\nbulk_density = \"1.52 g/cc\"\n[files]\nruns = \"runs.csv\"\ntrajectories = TABLES\n\
                [columns]\nt = { unit = \"ms\" }\nz = { unit = \"cm\" }\n\
                [[condition]]\nid = \"c01\"\nangle_deg = 90\nshape = \"cylinder\"\ndiameter = \"1 inch\"\n\
                height = \"3 cm\"\nmass = \"67 g\"\n";
    for tables in ["[\"drop a.csv\", \"drop b.csv\"]", "\"drop*.csv\""] {
        write("measurement.toml", toml.replace("TABLES", tables));
        let loaded = MeasurementSet::load(folder.path()).unwrap_or_else(|error| panic!("{error}"));
        let (set, condition) = (&loaded.set, &loaded.set.conditions[0]);
        assert_eq!(set.runs.iter().map(|run| run.frames.len()).collect::<Vec<_>>(), [60, 60]);
        assert_eq!(
            (condition.diameter, condition.mass, condition.height),
            (0.0254, 0.067, Some(0.03))
        );
        assert_eq!((set.bed.bulk_density, set.instrument.rate), (Some(1520.0), Some(1000.0)));
        assert_eq!(condition.role, measurements::Role::Fit);
        assert!((condition.speed - 2.0).abs() < 0.02, "{}", condition.speed);
        let note = "The speed of `c01` is ";
        assert!(set.notes.iter().any(|one| one.starts_with(note)), "{:?}", set.notes);
        assert!(loaded.contradictions.is_empty(), "{}", loaded.describe());
    }
}

#[test]
fn every_condition_of_a_set_of_two_beds_has_its_own_and_reads_back() {
    let good = Path::new("tests/data/good/scalars");
    let text = fs::read_to_string(good.join("measurement.toml")).expect("a good set");
    let (bed, two) = (
        "[bed]\n",
        "[[bed]]\nname = \"Mars\"\nbulk_density = \"1.2 g/cc\"\ngravity = 3.71\n[[bed]]\nname = \"Earth\"\n",
    );
    let text = text.replace(bed, two);
    let text = text.replace("id = \"c01\"\n", "id = \"c01\"\nbed = \"Earth\"\n");
    let text = text.replace("id = \"c02\"\n", "id = \"c02\"\nbed = \"Mars\"\n");
    let [folder, again] = [(); 2].map(|()| tempfile::tempdir().expect("a folder for the test"));
    fs::write(folder.path().join("measurement.toml"), text).expect("a writable folder");
    fs::copy(good.join("runs.csv"), folder.path().join("runs.csv")).expect("a writable folder");
    let set = MeasurementSet::load(folder.path()).unwrap_or_else(|error| panic!("{error}")).set;
    let of = |at: usize| {
        let bed = set.bed_of(&set.conditions[at]);
        (bed.bulk_density, bed.gravity, bed.grain_diameter)
    };
    assert_eq!(of(0), (Some(1480.0), 9.81, Some(8e-4)));
    assert_eq!(of(1), (Some(1200.0), 3.71, None));
    assert_eq!(set.bed.gravity.to_bits(), 3.71_f64.to_bits(), "the first of the list");
    let described = set.describe();
    assert!(described.contains("Mars: three-dimensional bed, 1200 kg/m^3"), "{described}");
    set.write(again.path()).expect("a writable folder");
    let read = MeasurementSet::load(again.path()).unwrap_or_else(|error| panic!("{error}")).set;
    assert_eq!(read, set);
}

#[test]
fn the_template_of_the_documentation_loads_without_a_warning() {
    let page = fs::read_to_string("../docs/measurement-sets.md").expect("the page of the format");
    let blocks: Vec<&str> = page.split("```").skip(1).step_by(2).collect();
    let block = |kind: &str, nth: usize| {
        let text = blocks.iter().filter_map(|block| block.strip_prefix(kind)).nth(nth);
        text.expect("a block of the template").trim_start()
    };
    let folder = tempfile::tempdir().expect("a folder for the test");
    let files = [
        ("measurement.toml", block("toml", 0).to_owned()),
        ("runs.csv", block("csv", 0).to_owned()),
        ("trajectories.csv", block("csv", 1).to_owned()),
    ];
    for (name, text) in files {
        fs::write(folder.path().join(name), text).expect("a writable folder");
    }
    let loaded = MeasurementSet::load(folder.path()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(loaded.render_warnings(Color::Off), "");
    assert!(loaded.set.notes.is_empty(), "{:?}", loaded.set.notes);
    assert_eq!(loaded.set.runs.len(), 2);
    // The keys of the second block are those of the tables.
    let mut columns = block("toml", 0).to_owned() + block("toml", 1);
    columns += "\n";
    fs::write(folder.path().join("measurement.toml"), columns).expect("a writable folder");
    let told = MeasurementSet::load(folder.path()).expect_err("columns with other names");
    assert!(told.diagnostics.iter().all(|one| one.message.contains("is missing")), "{told}");
}
