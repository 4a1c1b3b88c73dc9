//! Which crate may import which: ours by the table of crates, others by "only it imports".

use std::path::Path;

use anyhow::{Context, Result};
use serde_json::Value;

use super::{Problem, TextFile, numbered};

/// Each of our crates, and the ones of ours that it may import. Dev-dependencies are free.
const ALLOWED: [(&str, &str); 17] = [
    ("engine", ""),
    ("contact-laws", "engine"),
    ("resistive", "engine"),
    ("intruders", "engine resistive"),
    ("configs", "engine contact-laws resistive intruders"),
    ("measurements", "engine intruders configs"),
    ("plots", ""),
    ("runner", "engine resistive intruders configs"),
    ("exchange", "engine contact-laws intruders configs measurements runner"),
    ("diagnosis", "engine contact-laws resistive intruders configs measurements plots runner"),
    ("reports", "contact-laws resistive configs measurements plots runner exchange diagnosis"),
    (
        "plunge",
        "engine contact-laws resistive configs measurements runner exchange diagnosis reports",
    ),
    ("plunge-python", "exchange plunge"),
    (
        "validation",
        "engine contact-laws resistive intruders configs measurements plots runner exchange diagnosis",
    ),
    ("fixtures", ""),
    ("fuzz", "engine resistive configs measurements runner exchange fixtures"),
    ("xtask", ""),
];

/// Crates of others that are kept behind one of ours (two where a second reads what the first writes).
const ONLY: [(&str, &str); 47] = [
    ("annotate-snippets", "configs"),
    ("anyhow", "plunge xtask"),
    ("askama", "reports"),
    ("bolero", "fuzz"),
    ("argmin", "diagnosis validation"),
    ("argmin-math", "diagnosis validation"),
    ("arrayvec", "engine"),
    ("calamine", "exchange"),
    ("clap", "plunge validation"),
    ("clap_complete", "plunge"),
    ("clap_mangen", "plunge"),
    ("comfy-table", "plunge"),
    ("exmex", "resistive"),
    ("foxglove", "engine"),
    ("flate2", "reports"),
    ("gif", "reports"),
    ("glob", "measurements exchange"),
    ("http-range-header", "plunge"),
    ("httparse", "plunge"),
    ("indicatif", "plunge"),
    ("jsonschema", "fixtures"),
    ("levenberg-marquardt", "diagnosis"),
    ("lexopt", "xtask"),
    ("mcap", "engine exchange"),
    // The fits of `diagnosis` speak the version that `levenberg-marquardt` is built on.
    ("nalgebra", "engine resistive measurements diagnosis validation"),
    ("noto-sans-mono-bitmap", "plots"),
    ("num-traits", "engine"),
    ("parquet", "exchange"),
    ("parry3d-f64", "intruders"),
    ("plotters", "plots diagnosis validation reports"),
    ("plotters-backend", "plots"),
    ("png", "reports"),
    ("postcard", "engine fuzz"),
    ("prost-reflect", "exchange"),
    ("pyo3", "plunge-python"),
    ("pyo3-build-config", "plunge-python"),
    ("rayon", "engine diagnosis validation"),
    ("rustix", "validation"),
    ("safe_arch", "engine"),
    ("signal-hook", "plunge"),
    ("sobol_burley", "runner"),
    ("statrs", "diagnosis reports validation"),
    ("toml", "plunge-python"),
    ("tiny-skia", "plots"),
    ("toml_edit", "configs fixtures"),
    ("wide", "engine"),
    ("xshell", "xtask"),
];

/// One line of a manifest's `[dependencies]` or `[build-dependencies]`.
struct Arrow<'a> {
    from: &'a str,
    to: &'a str,
    /// The key in the manifest, which a rename makes differ from `to`.
    key: &'a str,
}

/// Checks the crates that `cargo metadata` lists; `files` give the lines of their manifests.
pub(crate) fn check(metadata: &str, files: &[TextFile]) -> Result<Vec<Problem>> {
    let metadata: Value = serde_json::from_str(metadata)?;
    let root = field(&metadata, "workspace_root")?;
    let packages = list(&metadata, "packages")?;
    let names = packages.iter().map(|p| field(p, "name")).collect::<Result<Vec<_>>>()?;

    let mut problems = Vec::new();
    for package in packages {
        let from = field(package, "name")?;
        let manifest = Path::new(field(package, "manifest_path")?);
        let file = manifest.strip_prefix(root).unwrap_or(manifest).to_owned();
        let text = files.iter().find(|f| f.path == file).map_or("", |f| f.text.as_str());
        if !ALLOWED.iter().any(|(name, _)| *name == from) {
            problems.push(Problem {
                line: numbered(text).find(|(_, l)| l.starts_with("name")).map_or(1, |(n, _)| n),
                file: file.clone(),
                what: format!("the crate `{from}` is not in the table of crates"),
                right: "add its row, with what it may import, to xtask/src/tidy/arrows.rs".into(),
            });
        }
        for dependency in list(package, "dependencies")? {
            if dependency["kind"] == "dev" {
                continue;
            }
            let to = field(dependency, "name")?;
            let key = dependency["rename"].as_str().unwrap_or(to);
            problems.extend(check_arrow(&Arrow { from, to, key }, &names, &file, text));
        }
    }
    Ok(problems)
}

fn check_arrow(arrow: &Arrow<'_>, ours: &[&str], file: &Path, text: &str) -> Option<Problem> {
    let Arrow { from, to, key } = *arrow;
    let right = if ours.contains(&to) {
        let allowed = row(&ALLOWED, from)?;
        if allowed.contains(&to) {
            return None;
        }
        match allowed.is_empty() {
            true => format!("`{from}` imports none of our crates"),
            false => format!("of our crates `{from}` may import {}", names(&allowed)),
        }
    } else {
        let allowed = row(&ONLY, to)?;
        if allowed.contains(&from) {
            return None;
        }
        format!("only {} may import `{to}`: ask it for what is needed", names(&allowed))
    };
    let what = format!("`{from}` imports `{to}`");
    Some(Problem { file: file.to_owned(), line: line_of(text, key), what, right })
}

/// The names that `table` lists for `name`.
fn row(table: &[(&str, &'static str)], name: &str) -> Option<Vec<&'static str>> {
    let (_, values) = table.iter().find(|(key, _)| *key == name)?;
    Some(values.split_whitespace().collect())
}

fn names(list: &[&str]) -> String {
    list.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

/// The line of `manifest` on which the dependency `key` stands, dev-dependencies aside; 1 if none.
fn line_of(manifest: &str, key: &str) -> usize {
    let mut in_dependencies = false;
    for (line, content) in numbered(manifest) {
        let content = content.trim();
        if let Some(header) = content.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
            let is_dev = header.contains("dev-dependencies");
            in_dependencies = header.ends_with("dependencies") && !is_dev;
            if !is_dev && header.ends_with(&format!("dependencies.{key}")) {
                return line;
            }
        } else if in_dependencies
            && let Some(rest) = content.strip_prefix(key)
            && rest.starts_with(['.', '=', ' '])
        {
            return line;
        }
    }
    1
}

fn field<'v>(value: &'v Value, key: &str) -> Result<&'v str> {
    value[key].as_str().with_context(|| format!("cargo metadata without `{key}`"))
}

fn list<'v>(value: &'v Value, key: &str) -> Result<&'v [Value]> {
    let list = value[key].as_array().with_context(|| format!("cargo metadata without `{key}`"))?;
    Ok(list)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    /// The problems of a workspace of `crates`, each with its dependencies as (name, kind).
    fn problems(crates: &[(&str, &[(&str, Value)])]) -> Vec<Problem> {
        let package = |(name, dependencies): &(&str, &[(&str, Value)])| {
            let dependencies = dependencies
                .iter()
                .map(|(to, kind)| json!({ "name": to, "kind": kind, "rename": null }))
                .collect::<Vec<_>>();
            json!({ "name": name, "manifest_path": format!("/w/{name}/Cargo.toml"), "dependencies": dependencies })
        };
        let packages = crates.iter().map(package).collect::<Vec<_>>();
        let metadata = json!({ "workspace_root": "/w", "packages": packages }).to_string();
        check(&metadata, &[]).expect("the metadata above is complete")
    }

    fn whats(crates: &[(&str, &[(&str, Value)])]) -> Vec<String> {
        problems(crates).into_iter().map(|problem| problem.what).collect()
    }

    const NORMAL: Value = Value::Null;

    #[test]
    fn arrows_of_the_table_pass_and_the_others_do_not() {
        assert!(whats(&[("engine", &[]), ("contact-laws", &[("engine", NORMAL)])]).is_empty());
        let found = problems(&[("engine", &[("intruders", NORMAL)]), ("intruders", &[])]);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].file, Path::new("engine/Cargo.toml"));
        assert_eq!(found[0].what, "`engine` imports `intruders`");
        assert_eq!(found[0].right, "`engine` imports none of our crates");
    }

    #[test]
    fn a_build_dependency_is_an_arrow_and_a_dev_dependency_is_none() {
        let arrow = |kind| whats(&[("engine", &[("configs", json!(kind))]), ("configs", &[])]);
        assert_eq!(arrow("build"), ["`engine` imports `configs`"]);
        assert!(arrow("dev").is_empty());
    }

    #[test]
    fn a_crate_of_others_stays_behind_the_one_that_wraps_it() {
        assert!(whats(&[("engine", &[("rayon", NORMAL), ("serde", NORMAL)])]).is_empty());
        let found = problems(&[("contact-laws", &[("rayon", NORMAL)])]);
        assert_eq!(found[0].what, "`contact-laws` imports `rayon`");
        assert_eq!(
            found[0].right,
            "only `engine`, `diagnosis`, `validation` may import `rayon`: ask it for what is needed"
        );
    }

    #[test]
    fn a_crate_without_a_row_is_reported() {
        assert_eq!(whats(&[("viewer", &[])]), ["the crate `viewer` is not in the table of crates"]);
    }

    #[test]
    fn every_arrow_of_the_table_points_to_a_crate_further_up() {
        for (index, (from, imports)) in ALLOWED.iter().enumerate() {
            let above = ALLOWED[..index].iter().map(|(name, _)| *name).collect::<Vec<_>>();
            assert!(
                imports.split_whitespace().all(|to| above.contains(&to)),
                "`{from}` imports downwards"
            );
        }
    }

    #[test]
    fn the_line_is_that_of_the_dependency_itself() {
        let manifest = "\
[package]
name = \"rayon\"
[dev-dependencies]
rayon.workspace = true
[dependencies]
rayon-core = \"1\"
rayon.workspace = true
[dependencies.glam]
version = \"0.33\"
";
        assert_eq!(line_of(manifest, "rayon"), 7);
        assert_eq!(line_of(manifest, "glam"), 8);
        assert_eq!(line_of(manifest, "absent"), 1);
    }
}
