//! Names of files and runs taken apart by a pattern such as `{body}_h{height}_r{repeat}`.

/// A pattern of names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Pattern {
    text: String,
    parts: Vec<Part>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Part {
    Literal(String),
    Field(String),
}

/// Fields that do not tell conditions apart.
const OF_RUN: [&str; 11] =
    ["repeat", "rep", "trial", "take", "shot", "order", "run", "drop", "versuch", "essai", "_"];

/// Columns of quantities that are set before a drop.
pub(super) const SET: [&str; 14] = [
    "height",
    "h",
    "drop height",
    "drop_height",
    "höhe",
    "fallhöhe",
    "hauteur",
    "angle",
    "angle_deg",
    "packing",
    "phi",
    "density",
    "bed",
    "sand",
];

/// Fields that say which runs are of one day or one pouring, and no condition either.
pub(super) const OF_SESSION: [&str; 3] = ["session", "day", "date"];

/// Whether a field or column of this name is of a run alone, or of a session.
pub(super) fn is_of_run(name: &str) -> bool {
    OF_RUN.contains(&name) || OF_SESSION.contains(&name)
}

impl Pattern {
    /// Reads a pattern.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let mut parts = Vec::new();
        let mut rest = text;
        while let Some((literal, after)) = rest.split_once('{') {
            let (field, behind) = after.split_once('}').ok_or("a brace is not closed")?;
            if field.is_empty() || field.contains('{') {
                return Err("a field has no name".to_owned());
            }
            if !literal.is_empty() {
                parts.push(Part::Literal(literal.to_owned()));
            } else if matches!(parts.last(), Some(Part::Field(_))) {
                return Err(format!(
                    "nothing stands before {{{field}}} to tell it from the field before"
                ));
            }
            parts.push(Part::Field(field.to_owned()));
            rest = behind;
        }
        if !rest.is_empty() {
            parts.push(Part::Literal(rest.to_owned()));
        }
        let has_field = parts.iter().any(|part| matches!(part, Part::Field(_)));
        has_field.then(|| Self { text: text.to_owned(), parts }).ok_or("it has no field".to_owned())
    }

    /// How many folders around a file the pattern names.
    pub(super) fn folders(&self) -> usize {
        self.text.matches('/').count()
    }

    pub(super) fn text(&self) -> &str {
        &self.text
    }

    /// The name of a condition whose runs have these fields: the pattern without what is of a run alone.
    pub(super) fn condition(&self, fields: &[(String, String)]) -> String {
        let (mut name, mut before) = (String::new(), "");
        for part in &self.parts {
            match part {
                Part::Literal(literal) => before = literal,
                Part::Field(field) => {
                    if !is_of_run(field) {
                        let value = fields.iter().find(|(own, _)| own == field);
                        name.push_str(before);
                        name.push_str(value.map_or("", |(_, value)| value));
                    }
                    before = "";
                }
            }
        }
        match name.trim_matches(['_', '-', ' ', '/', '.']) {
            "" => "all".to_owned(),
            name => name.to_owned(),
        }
    }

    /// The fields of `name`, if it fits; what stands between fields is looked for from the end.
    pub(super) fn fields(&self, name: &str) -> Option<Vec<(String, String)>> {
        let mut fields = Vec::new();
        let mut rest = name;
        for (at, part) in self.parts.iter().enumerate().rev() {
            match part {
                Part::Literal(literal) => rest = rest.strip_suffix(literal.as_str())?,
                Part::Field(field) => {
                    let value = match at.checked_sub(1).map(|before| &self.parts[before]) {
                        Some(Part::Literal(before)) => {
                            let start = rest.rfind(before.as_str())? + before.len();
                            let (left, value) = rest.split_at(start);
                            rest = left;
                            value
                        }
                        _ => std::mem::take(&mut rest),
                    };
                    if value.is_empty() {
                        return None;
                    }
                    fields.push((field.clone(), value.to_owned()));
                }
            }
        }
        fields.reverse();
        rest.is_empty().then_some(fields)
    }
}

/// `text` with `{field}` replaced by the value of that label; the error is a field that no label has.
pub(super) fn filled(text: &str, labels: &[(String, String)]) -> Result<String, String> {
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('{') {
        let Some((field, behind)) = after.split_once('}') else { break };
        let value = labels.iter().find(|(name, _)| name == field);
        let (_, value) = value.ok_or_else(|| field.to_owned())?;
        out.push_str(before);
        out.push_str(value);
        rest = behind;
    }
    out.push_str(rest);
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_taken_apart_from_their_end() {
        let pattern = Pattern::parse("{body}_h{height}_r{repeat}").expect("a pattern");
        let fields = pattern.fields("steel_ball_h20_r3").expect("it fits");
        let values: Vec<&str> = fields.iter().map(|(_, value)| value.as_str()).collect();
        assert_eq!(values, ["steel_ball", "20", "3"]);
        assert_eq!(pattern.condition(&fields), "steel_ball_h20");
        let dated = Pattern::parse("{date}_{body}_h{height}_{take}").expect("a pattern");
        let fields_of = dated.fields("2024-05-03_steel_h20_3").expect("it fits");
        assert_eq!(dated.condition(&fields_of), "steel_h20");
        assert_eq!(pattern.fields("steel_20_3"), None);
        assert_eq!(pattern.fields("_h20_r3"), None);
        assert_eq!(filled("{height} cm", &fields), Ok("20 cm".to_owned()));
        assert_eq!(filled("{mass}", &fields), Err("mass".to_owned()));
    }

    #[test]
    fn patterns_that_cannot_be_told_apart_are_refused() {
        for text in ["{a}{b}", "{a", "plain", "{}"] {
            assert!(Pattern::parse(text).is_err(), "{text}");
        }
    }
}
