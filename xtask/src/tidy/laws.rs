//! A law or effect that is registered has a test beside it and a model that uses it. An effect of a
//! resistive medium needs no model: it has one amplitude, and tests that all of them share build it.

use std::path::{Path, PathBuf};

use super::{Problem, TextFile, numbered};

/// Files with tables of laws; the laws stand beside them.
const REGISTRIES: [&str; 2] = ["contact-laws/src/lib.rs", "resistive/src/laws/mod.rs"];

/// A line of a registry table: `module::CONSTANT`.
#[derive(Debug, PartialEq, Eq)]
struct Registered<'a> {
    module: &'a str,
    constant: &'a str,
    line: usize,
}

/// Checks every entry of the tables in the registries.
pub(crate) fn check(files: &[TextFile]) -> Vec<Problem> {
    REGISTRIES.iter().flat_map(|registry| check_registry(registry, files)).collect()
}

fn check_registry(registry: &str, files: &[TextFile]) -> Vec<Problem> {
    let text_of = |path: &Path| files.iter().find(|f| f.path == path).map(|f| f.text.as_str());
    let folder = registry.rsplit_once('/').map_or("", |(folder, _)| folder);
    let Some(text) = text_of(Path::new(registry)) else {
        return vec![Problem {
            file: registry.into(),
            line: 1,
            what: "the registry of laws is not there".into(),
            right: "if it has moved, say so in xtask/src/tidy/laws.rs".into(),
        }];
    };
    let entries = registered(text);
    if entries.is_empty() {
        return vec![Problem {
            file: registry.into(),
            line: 1,
            what: "no table of laws is recognised".into(),
            right: "`static LAWS: &[…] = &[…]` with entries `&module::ENTRY`".into(),
        }];
    }

    let mut problems = Vec::new();
    for entry in entries {
        let Registered { module, constant, line } = entry;
        let candidates = [format!("{folder}/{module}.rs"), format!("{folder}/{module}/mod.rs")];
        let file = candidates.iter().map(PathBuf::from).find(|path| text_of(path).is_some());
        let Some(file) = file else {
            problems.push(Problem {
                file: registry.into(),
                line,
                what: format!("`{module}::{constant}` has no file of its own"),
                right: format!("put the law into {}", candidates[0]),
            });
            continue;
        };
        let text = text_of(&file).unwrap_or_default();
        let Some((name_line, name)) = law_name(text, constant) else {
            problems.push(Problem {
                file,
                line: 1,
                what: format!("the name of `{constant}` is not recognised"),
                right: "write it as a literal: `name: \"…\"` or `const NAME: &str = \"…\"`".into(),
            });
            continue;
        };
        let mut problem = |what, right| {
            problems.push(Problem { file: file.clone(), line: name_line, what, right });
        };
        if name.replace('-', "_") != module {
            let right = format!("call the file {}.rs", name.replace('-', "_"));
            problem(format!("`{name}` stands in the module `{module}`"), right);
        }
        if !numbered(text).any(|(_, line)| line.trim_start().starts_with("#[test]")) {
            let right = "add a case solved by hand at the bottom of the file".into();
            problem(format!("`{name}` has no test beside it"), right);
        }
        let needs_model = !is_resistive_effect(text, constant);
        if needs_model && !files.iter().any(|f| is_model(&f.path) && model_names(&f.text, name)) {
            let right = format!("add one that says `name = \"{name}\"` to its law or effect");
            problem(format!("no model in configs/*.toml uses `{name}`"), right);
        }
    }
    problems
}

/// The entries of every `static …: &[…] = &[…];` of the registry.
fn registered(registry: &str) -> Vec<Registered<'_>> {
    let mut entries = Vec::new();
    let mut in_table = false;
    for (line, content) in numbered(registry) {
        let code = content.split("//").next().unwrap_or_default();
        let values = if in_table {
            code
        } else if code.trim_start().trim_start_matches("pub ").starts_with("static ") {
            code.split_once('=').map_or("", |(_, values)| values)
        } else {
            continue;
        };
        for value in values.split([',', '[', ']', ';']) {
            let path = value.trim().trim_start_matches('&');
            if let Some((module, constant)) = path.split_once("::") {
                entries.push(Registered { module, constant, line });
            }
        }
        in_table = !code.trim_end().ends_with(';');
    }
    entries
}

/// The name that `constant` gives its law, with its line: the first literal after the constant's
/// declaration, else the `NAME` of the trait.
fn law_name<'a>(text: &'a str, constant: &str) -> Option<(usize, &'a str)> {
    let declaration = format!("const {constant}:");
    numbered(text)
        .skip_while(|(_, line)| !line.contains(&declaration))
        .chain(numbered(text).filter(|(_, line)| line.contains("const NAME:")))
        .find_map(|(number, line)| {
            let line = line.trim_start();
            let rest = line.strip_prefix("name: \"").or_else(|| {
                let (_, value) = line.split_once("const NAME:")?.1.split_once('=')?;
                value.trim_start().strip_prefix('"')
            })?;
            Some((number, rest.split_once('"')?.0))
        })
}

/// Whether `constant` says that it is an effect of a resistive medium.
fn is_resistive_effect(text: &str, constant: &str) -> bool {
    let declaration = format!("const {constant}:");
    numbered(text)
        .skip_while(|(_, line)| !line.contains(&declaration))
        .find_map(|(_, line)| line.trim_start().strip_prefix("role: Role::"))
        .is_some_and(|role| role.starts_with("Effect"))
}

fn is_model(path: &Path) -> bool {
    path.parent() == Some(Path::new("configs")) && path.extension().is_some_and(|e| e == "toml")
}

/// Whether a table of the model other than `[run]` is called `law`.
fn model_names(model: &str, law: &str) -> bool {
    let mut table = "";
    model.lines().map(str::trim).any(|line| {
        if line.starts_with('[') {
            table = line;
            return false;
        }
        let value = line.strip_prefix("name").map(str::trim_start);
        let value = value.and_then(|rest| rest.strip_prefix('=')).map(str::trim_start);
        let quoted = value.and_then(|rest| rest.strip_prefix(['"', '\'']));
        let name = quoted.and_then(|rest| rest.split(['"', '\'']).next());
        name == Some(law) && !table.starts_with("[run]")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const REGISTRY_TEXT: &str = "\
mod registry;
/// Every law.
pub static LAWS: &[&LawEntry] = &[&linear_spring::ENTRY, &rolling::ENTRY];
pub static FIELDS: &[&FieldEntry] = &[
    // &retired::ENTRY,
    &drag::LINEAR,
];
fn find() { LAWS.iter().find(|entry| entry.name == name).copied() }
";
    const LAW: &str =
        "const ENTRY: LawEntry = LawEntry {\n    name: \"rolling\",\n};\n#[test]\nfn f() {}\n";

    /// What is wrong with the registry of contact laws.
    fn whats(files: &[(&str, &str)]) -> Vec<String> {
        whats_of(REGISTRIES[0], files)
    }

    fn whats_of(registry: &str, files: &[(&str, &str)]) -> Vec<String> {
        let files = files
            .iter()
            .map(|(path, text)| TextFile { path: path.into(), text: (*text).to_owned() })
            .collect::<Vec<_>>();
        check_registry(registry, &files).into_iter().map(|problem| problem.what).collect()
    }

    const ONE_LAW: (&str, &str) =
        (REGISTRIES[0], "static LAWS: &[&LawEntry] = &[&rolling::ENTRY];");
    const MODEL: (&str, &str) = ("configs/m.toml", "[[effect]]\nname = \"rolling\"\n");

    #[test]
    fn every_table_of_the_registry_is_read() {
        let found = registered(REGISTRY_TEXT);
        let found = found.iter().map(|e| (e.module, e.constant, e.line)).collect::<Vec<_>>();
        let expected =
            [("linear_spring", "ENTRY", 3), ("rolling", "ENTRY", 3), ("drag", "LINEAR", 6)];
        assert_eq!(found, expected);
    }

    #[test]
    fn a_law_with_a_test_and_a_model_passes() {
        let law = ("contact-laws/src/rolling.rs", LAW);
        assert!(whats(&[ONE_LAW, law, MODEL]).is_empty());
    }

    #[test]
    fn a_law_without_a_test_or_a_model_is_reported() {
        let law = (
            "contact-laws/src/rolling.rs",
            "const ENTRY: LawEntry = LawEntry {\nname: \"rolling\",\n};",
        );
        let beds = ("configs/beds/m.toml", MODEL.1);
        let expected =
            ["`rolling` has no test beside it", "no model in configs/*.toml uses `rolling`"];
        assert_eq!(whats(&[ONE_LAW, law, beds]), expected);
    }

    #[test]
    fn a_law_stands_in_the_file_of_its_name() {
        let law =
            ("contact-laws/src/rolling.rs", LAW.replace("\"rolling\"", "\"rolling-friction\""));
        let model = MODEL.1.replace("rolling", "rolling-friction");
        let found = whats(&[ONE_LAW, (law.0, &law.1), (MODEL.0, &model)]);
        assert_eq!(found, ["`rolling-friction` stands in the module `rolling`"]);
        assert_eq!(whats(&[ONE_LAW, MODEL]), ["`rolling::ENTRY` has no file of its own"]);
    }

    #[test]
    fn of_the_resistive_laws_only_baselines_need_a_model() {
        let registry = (REGISTRIES[1], "static RESISTANCE_LAWS: &[&E] = &[&drag::ENTRY];");
        let law = |role: &str| {
            format!(
                "const ENTRY: E = E {{\n    name: \"drag\",\n    role: Role::{role},\n}};\n#[test]\n"
            )
        };
        let found = |role: &str| {
            let law = law(role);
            let file = ("resistive/src/laws/drag.rs", law.as_str());
            whats_of(REGISTRIES[1], &[registry, file])
        };
        assert_eq!(found("Baseline"), ["no model in configs/*.toml uses `drag`"]);
        assert!(found("Effect(Facts {").is_empty());
    }

    #[test]
    fn the_name_is_read_from_the_entry_or_from_the_trait() {
        assert_eq!(law_name(LAW, "ENTRY"), Some((2, "rolling")));
        let by_trait =
            "impl L {\n    const NAME: &'static str = \"hooke\";\n}\nconst ENTRY: E = E::of();";
        assert_eq!(law_name(by_trait, "ENTRY"), Some((2, "hooke")));
        assert_eq!(law_name("const ENTRY: E = make();", "ENTRY"), None);
    }

    #[test]
    fn the_name_of_a_run_is_not_the_name_of_a_law() {
        assert!(!model_names("[run]\nname = \"rolling\"\n", "rolling"));
        assert!(!model_names("[[effect]]\nname = \"rolling-resistance\"\n", "rolling"));
        assert!(!model_names("[[effect]]\n# name = \"rolling\"\n", "rolling"));
        assert!(model_names("[run]\nname = 'a'\n[[effect]]\nname='rolling' # q\n", "rolling"));
    }

    #[test]
    fn a_registry_that_is_not_understood_is_itself_a_problem() {
        assert_eq!(whats(&[]), ["the registry of laws is not there"]);
        assert_eq!(whats(&[(REGISTRIES[0], "mod a;")]), ["no table of laws is recognised"]);
    }
}
