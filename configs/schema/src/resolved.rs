//! The model as it was understood: every value that was read or assumed, in SI, as TOML again.

use toml_edit::Value;

/// TOML text under construction, one section per table read.
#[derive(Debug, Default)]
pub(crate) struct Resolved {
    sections: Vec<Section>,
}

#[derive(Debug)]
struct Section {
    header: String,
    lines: Vec<(String, String)>,
}

impl Section {
    fn write(&self, keep: impl Fn(&str) -> bool, out: &mut String) {
        if !out.is_empty() {
            out.push('\n');
        }
        out.push_str(&self.header);
        out.push('\n');
        for (key, value) in self.lines.iter().filter(|(key, _)| keep(key)) {
            out.push_str(&format!("{key} = {value}\n"));
        }
    }
}

impl Resolved {
    /// Starts a section under `header`, such as `[run]` or `[[effect]]`, and gives its number.
    pub(crate) fn open(&mut self, header: String) -> usize {
        self.sections.push(Section { header, lines: Vec::new() });
        self.sections.len() - 1
    }

    /// Adds a line whose value is TOML already.
    pub(crate) fn line(&mut self, section: usize, key: &str, value: String) {
        self.sections[section].lines.push((key.to_owned(), value));
    }

    /// The whole model; sections without a line are left out.
    pub(crate) fn text(&self) -> String {
        let mut out = String::new();
        for section in self.sections.iter().filter(|section| !section.lines.is_empty()) {
            section.write(|_| true, &mut out);
        }
        out
    }

    /// The whole model but for the place of its table of grains.
    pub(crate) fn hashed_text(&self) -> String {
        let mut out = String::new();
        for section in self.sections.iter().filter(|section| !section.lines.is_empty()) {
            let is_bed = section.header == "[bed]";
            section.write(|key| !(is_bed && key == "file"), &mut out);
        }
        out
    }

    /// Everything that the prepared bed depends on and nothing else: the seed, the gravity, the
    /// container, the recipe, and the contact law as far as it acts without an intruder.
    pub(crate) fn bed_key_text(&self) -> String {
        let mut out = String::new();
        for section in &self.sections {
            let keep: fn(&str) -> bool = match section.header.as_str() {
                "[run]" => |key| key == "seed",
                "[contact_law]" => |key| !key.starts_with("intruder_"),
                "[bed]" => |key| key != "file",
                "[medium]" => |key| key != "grain_inertia",
                "[container]" | "[[bed.grains]]" | "[[bed.effect]]" => |_| true,
                _ => continue,
            };
            section.write(keep, &mut out);
        }
        out
    }
}

/// `text` as a TOML string.
#[must_use]
pub fn quoted(text: &str) -> String {
    Value::from(text).to_string().trim().to_owned()
}
