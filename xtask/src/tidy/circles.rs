//! No files of a crate import each other in a circle, a module and those below it included.
//!
//! Read are the `use` lines of what is no test. A name is followed through re-exports to the file that has it; what a
//! module hands on of those below it is no use.

use std::collections::{BTreeMap, BTreeSet};

use super::{Problem, TextFile};

/// The folder of a crate, then the names of the modules down to this one.
type Module = Vec<String>;

/// A `use` of one name: on which line, of what, and whether it is handed on.
type Use = (usize, Module, bool);

/// The modules that each module uses, with a line on which it does.
type Arrows<'m> = BTreeMap<&'m Module, BTreeMap<&'m Module, usize>>;

/// Every import within a crate that lies on a circle.
pub(crate) fn check(files: &[TextFile]) -> Vec<Problem> {
    let modules: BTreeMap<Module, &TextFile> =
        files.iter().filter_map(|file| Some((module(file.path.to_str()?)?, file))).collect();
    let uses: BTreeMap<&Module, Vec<Use>> =
        modules.iter().map(|(module, file)| (module, uses(&file.text, module, &modules))).collect();
    let mut arrows = Arrows::new();
    for (from, uses_of_file) in &uses {
        for (line, path, is_handed_on) in uses_of_file {
            let to = home(path, &uses);
            if to != *from && !(*is_handed_on && to.starts_with(from)) {
                arrows.entry(from).or_default().entry(to).or_insert(*line);
            }
        }
    }
    let mut problems = Vec::new();
    for (from, targets) in &arrows {
        for (to, line) in targets.iter().filter(|(to, _)| reaches(to, from, &arrows)) {
            let [file, other] = [*from, *to].map(|module| modules[module].path.clone());
            let what = format!("uses {}, which uses it in turn", other.display());
            let right = "move what both need into a file below them".to_owned();
            problems.push(Problem { file, line: *line, what, right });
        }
    }
    problems
}

/// The module that the file at `path` is; none of tests and programs beside a library.
fn module(path: &str) -> Option<Module> {
    let (folder, inside) = path.strip_suffix(".rs")?.split_once("/src/")?;
    let mut names: Vec<&str> = inside.split('/').collect();
    if names.iter().any(|name| ["bin", "tests", "testing"].contains(name)) {
        return None;
    }
    if ["lib", "main", "mod"].contains(names.last()?) {
        names.pop();
    }
    Some([folder].into_iter().chain(names).map(str::to_owned).collect())
}

/// The `use` lines of `text`, the file of `module`, that are of the same crate.
fn uses(text: &str, module: &Module, modules: &BTreeMap<Module, &TextFile>) -> Vec<Use> {
    let code = text.split("mod tests {").next().unwrap_or_default();
    let (mut found, mut line) = (Vec::new(), 1);
    for statement in code.split_inclusive(';') {
        let lines: Vec<&str> = statement.split('\n').map(str::trim).collect();
        let is_use = |line: &&str| line.starts_with("use ") || is_handed_on(line);
        if let Some(at) = lines.iter().rposition(is_use) {
            let joined = lines[at..].concat();
            let tree = joined.split_once("use ").map_or("", |(_, tree)| tree);
            let paths = expanded(tree.trim_end_matches(';')).into_iter();
            let of_crate = paths.filter_map(|path| absolute(&path, module, modules));
            found.extend(of_crate.map(|path| (line + at, path, is_handed_on(lines[at]))));
        }
        line += lines.len() - 1;
    }
    found
}

fn is_handed_on(line: &str) -> bool {
    line.starts_with("pub")
        && line.split_once(' ').is_some_and(|(_, rest)| rest.starts_with("use "))
}

/// The paths of `a::{b, c::{d, e}}`, each whole and without its new name.
fn expanded(tree: &str) -> Vec<String> {
    let Some((head, inside)) = tree.trim().trim_end_matches(',').split_once('{') else {
        return vec![tree.split(" as ").next().unwrap_or_default().trim().to_owned()];
    };
    let inside = inside.rsplit_once('}').map_or(inside, |(inside, _)| inside);
    let mut depth = 0;
    let parts = inside.split(|c: char| {
        depth += i32::from(c == '{') - i32::from(c == '}');
        c == ',' && depth == 0
    });
    let of_part = |part: &str| expanded(part).into_iter().map(|path| format!("{head}{path}"));
    parts.filter(|part| !part.trim().is_empty()).flat_map(of_part).collect()
}

/// `path`, as it stands in `module`, from the crate down; `None` where it is of another crate.
fn absolute(path: &str, module: &Module, modules: &BTreeMap<Module, &TextFile>) -> Option<Module> {
    let names: Vec<&str> = path.split("::").filter(|name| *name != "self").collect();
    let from_root = names.first() == Some(&"crate");
    let up = names.iter().take_while(|name| **name == "super").count();
    let base = &module[..if from_root { 1 } else { module.len() - up }];
    let below = names[up + usize::from(from_root)..].iter().map(|name| (*name).to_owned());
    let whole: Module = base.iter().cloned().chain(below).collect();
    // Any other path begins with a crate or with a child of the module.
    let is_child = || modules.contains_key(whole.get(..=module.len()).unwrap_or_default());
    (from_root || up > 0 || path.starts_with("self::") || is_child()).then_some(whole)
}

/// The file that has what `path` names.
fn home<'m>(path: &Module, uses: &BTreeMap<&'m Module, Vec<Use>>) -> &'m Module {
    let mut seen = BTreeSet::new();
    let mut path = path.clone();
    loop {
        let known = (1..=path.len()).rev().find_map(|n| uses.get_key_value(&path[..n].to_vec()));
        let (module, uses_of_file) = known.expect("a path begins with a crate that has a root");
        let name = path.get(module.len());
        let mut handed_on =
            uses_of_file.iter().filter(|(_, to, is_public)| *is_public && to.last() == name);
        match handed_on.next().filter(|_| name.is_some() && seen.insert(path.clone())) {
            Some((_, to, _)) => path = [to, &path[module.len() + 1..]].concat(),
            None => return module,
        }
    }
}

/// Whether a way along `arrows` leads from `start` to `end`.
fn reaches(start: &Module, end: &Module, arrows: &Arrows<'_>) -> bool {
    let (mut seen, mut next) = (BTreeSet::from([start]), vec![start]);
    while let Some(module) = next.pop() {
        let targets = arrows.get(module).into_iter().flat_map(BTreeMap::keys).copied();
        next.extend(targets.filter(|to| seen.insert(to)));
    }
    seen.contains(end)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(files: &[(&str, &str)]) -> Vec<String> {
        let file =
            |(path, text): &(&str, &str)| TextFile { path: path.into(), text: (*text).to_owned() };
        check(&files.iter().map(file).collect::<Vec<_>>()).iter().map(Problem::to_string).collect()
    }

    #[test]
    fn a_circle_is_found_through_re_exports_and_lists_and_a_tree_is_none() {
        let [lib, b] =
            [("a/src/lib.rs", "pub use c::d::D;\n"), ("a/src/b.rs", "use crate::{c::{C}, D};\n")];
        let [c, d] = [("a/src/c/mod.rs", "mod d;\n"), ("a/src/c/d.rs", "use super::C;\n")];
        assert!(found(&[lib, b, c, d]).is_empty());
        let circle =
            found(&[lib, b, c, ("a/src/c/d.rs", "use super::C;\n\nuse crate::b::{\n    B,\n};\n")]);
        assert_eq!(circle.len(), 2, "{circle:?}");
        assert!(circle[1].starts_with("a/src/c/d.rs:3: uses a/src/b.rs, which uses it in turn"));
        let parent = found(&[("a/src/lib.rs", "use d::D;\n"), ("a/src/d.rs", "use super::E;\n")]);
        assert_eq!(parent.len(), 2, "{parent:?}");
    }
}
