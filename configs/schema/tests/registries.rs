//! Every law and effect stands in a file of its name with its tests, and a shipped model uses it.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use configs::SHIPPED;
use contact_laws::{GRAIN_FORCES, LAWS};
use resistive::{RESISTANCE_LAWS, Role};
use toml_edit::{DocumentMut, Item, Table};

/// The folders of registered laws, with the names in them.
fn registered() -> [(&'static str, Vec<&'static str>); 3] {
    [
        ("contact-laws/src", LAWS.iter().map(|law| law.name).collect()),
        ("contact-laws/src/grain_force", GRAIN_FORCES.iter().map(|force| force.name).collect()),
        ("resistive/src/laws", RESISTANCE_LAWS.iter().map(|law| law.name).collect()),
    ]
}

/// The tables of `table` and below that are called something, as their names.
fn names(table: &Table, found: &mut BTreeSet<String>) {
    for (key, item) in table {
        match item {
            Item::Table(table) => names(table, found),
            Item::ArrayOfTables(tables) => tables.iter().for_each(|table| names(table, found)),
            Item::Value(value) if key == "name" => found.extend(value.as_str().map(str::to_owned)),
            _ => {}
        }
    }
}

#[test]
fn a_law_stands_in_the_file_of_its_name_with_its_tests() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    for (folder, laws) in registered() {
        for law in laws {
            let module = root.join(folder).join(law.replace('-', "_"));
            let file = [module.with_extension("rs"), module.join("mod.rs")];
            let text = file.iter().find_map(|path| fs::read_to_string(path).ok());
            let text = text.unwrap_or_else(|| panic!("`{law}` has no file of its own in {folder}"));
            assert!(text.contains("#[test]"), "`{law}` has no test solved by hand beside it");
        }
    }
}

/// Forces on single grains, and effects of a resistive medium, need no model: tests that all of them share build them.
#[test]
fn a_shipped_model_uses_each_law() {
    let mut used = BTreeSet::new();
    for model in SHIPPED {
        let mut document: DocumentMut = model.text.parse().expect("a shipped model is TOML");
        document.remove("run");
        names(&document, &mut used);
    }
    let is_added = |law: &&str| {
        let entry = RESISTANCE_LAWS.iter().find(|entry| entry.name == *law);
        entry.is_some_and(|entry| matches!(entry.role, Role::Effect(_)))
    };
    let [contact, _, resistive] = registered();
    let laws = contact.1.into_iter().chain(resistive.1);
    let unused: Vec<&str> =
        laws.filter(|law| !is_added(law) && !used.contains::<str>(law)).collect();
    assert!(unused.is_empty(), "no model in configs uses {unused:?}");
}
