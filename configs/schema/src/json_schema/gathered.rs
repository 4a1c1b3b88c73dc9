//! The notes of many readings as one schema.

use serde_json::{Map, Value, json};

use super::answers::{Leaf, Writer, definition, dimensions};
use super::facts::{Facts, Situation};
use crate::reader::{Answer, Asked, Word};

/// What a schema says beyond the answers.
#[derive(Clone, Debug)]
pub struct Format {
    /// What the file is called.
    pub title: &'static str,
    /// What it is, in a sentence.
    pub description: &'static str,
    /// Whether bare numbers in SI may stand for quantities.
    pub takes_bare: bool,
    /// Tables with the key in each that decides which other keys it takes.
    pub own: &'static [(&'static str, &'static str)],
    /// Tables with the keys that decide what every table takes.
    pub of_file: &'static [(&'static str, &'static str)],
    /// Keys that every table of a name takes besides, and what else is defined: by the names that
    /// [`Answer::Defined`] uses.
    pub definitions: Value,
}

/// What was asked of many files of one format.
#[derive(Clone, Debug)]
pub struct Gathered {
    format: Format,
    facts: Vec<(Situation, Facts)>,
}

/// Which facts count.
#[derive(Clone, Copy)]
enum Where<'a> {
    All,
    /// Those of files where this of the deciding words is this one.
    OfFile(usize, &'a Word),
    /// Those of tables where the deciding word is this one, or is not there.
    Own(Option<&'a Word>),
}

impl Gathered {
    /// Nothing yet.
    pub fn new(format: Format) -> Self {
        Self { format, facts: Vec::new() }
    }

    /// Takes in what was asked of one file.
    pub fn add(&mut self, asked: &Asked) {
        let word_of = |table: &str, key: &str| {
            let seen = asked.tables.iter().find(|seen| seen.name == table)?;
            seen.words.iter().find(|(known, _)| known == key).map(|(_, word)| word.clone())
        };
        let of_file: Vec<Option<Word>> =
            self.format.of_file.iter().map(|(table, key)| word_of(table, key)).collect();
        for (at, seen) in asked.tables.iter().enumerate() {
            let own = self.decider(&seen.name).and_then(|decider| {
                seen.words.iter().find(|(key, _)| key == decider).map(|(_, word)| word.clone())
            });
            let situation = Situation { table: seen.name.clone(), own, of_file: of_file.clone() };
            let facts = match self.facts.iter_mut().find(|(known, _)| *known == situation) {
                Some((_, facts)) => facts,
                None => {
                    self.facts.push((situation, Facts::default()));
                    &mut self.facts.last_mut().expect("it was just added").1
                }
            };
            facts.add_reading(seen);
            for question in asked.questions.iter().filter(|question| question.of == at) {
                let (answer, meaning) = (question.answer.clone(), question.meaning.clone());
                facts
                    .add(question.key, Leaf { answer, meaning, default: question.default.clone() });
            }
        }
    }

    /// The schema.
    pub fn schema(&self) -> Value {
        let mut schema = Map::new();
        schema.insert("$schema".into(), json!("http://json-schema.org/draft-07/schema#"));
        schema.insert("title".into(), json!(self.format.title));
        schema.insert("description".into(), json!(self.format.description));
        if let Value::Object(object) = self.object("") {
            schema.extend(object);
        }
        let mut conditions = Vec::new();
        for (at, (table, key)) in self.format.of_file.iter().enumerate() {
            for word in self.words(|situation| situation.of_file[at].as_ref()) {
                if let Some(then) = self.difference("", Where::OfFile(at, word)) {
                    let mut holds = is(key, word);
                    holds["type"] = json!("object");
                    let condition = json!({ "properties": { *table: holds }, "required": [table] });
                    conditions.push(json!({ "if": condition, "then": then }));
                }
            }
        }
        if !conditions.is_empty() {
            schema.insert("allOf".into(), Value::Array(conditions));
        }
        schema.insert("definitions".into(), Value::Object(self.definitions()));
        Value::Object(schema)
    }

    fn definitions(&self) -> Map<String, Value> {
        let mut definitions = self.format.definitions.as_object().cloned().unwrap_or_default();
        let leaves = self.facts.iter().flat_map(|(_, facts)| &facts.keys);
        let answers = leaves.flat_map(|(_, leaves)| leaves).map(|leaf| &leaf.answer);
        definitions.extend(answers.flat_map(dimensions).map(definition));
        definitions
    }

    fn writer(&self) -> Writer {
        Writer { takes_bare: self.format.takes_bare }
    }

    fn decider(&self, table: &str) -> Option<&'static str> {
        self.format.own.iter().find(|(known, _)| *known == table).map(|(_, key)| *key)
    }

    /// The different words of a kind, as they were met.
    fn words<'a>(&'a self, of: impl Fn(&'a Situation) -> Option<&'a Word>) -> Vec<&'a Word> {
        let mut words: Vec<&Word> = Vec::new();
        for word in self.facts.iter().filter_map(|(situation, _)| of(situation)) {
            if !words.contains(&word) {
                words.push(word);
            }
        }
        words
    }

    /// What is known of `table` in some situations; nothing if it was never asked for there.
    fn facts(&self, table: &str, within: Where<'_>) -> Option<Facts> {
        let counts = |situation: &Situation| match within {
            Where::All => true,
            Where::OfFile(at, word) => situation.of_file[at].as_ref() == Some(word),
            Where::Own(word) => situation.own.as_ref() == word,
        };
        let mut found: Option<Facts> = None;
        for (situation, facts) in &self.facts {
            if situation.table == table && counts(situation) {
                found.get_or_insert_default().merge(facts);
            }
        }
        found
    }

    /// The schema of `table` with everything that it takes anywhere.
    fn object(&self, table: &str) -> Value {
        let facts = self.facts(table, Where::All).unwrap_or_default();
        let properties: Map<String, Value> = facts
            .keys
            .iter()
            .map(|(key, leaves)| ((*key).to_owned(), self.property(table, key, leaves)))
            .collect();
        let mut object = json!({ "type": "object", "properties": properties });
        require(&mut object, &facts.required());
        object["additionalProperties"] = json!(false);
        let conditions = self.own_conditions(table, &facts);
        if !conditions.is_empty() {
            object["allOf"] = Value::Array(conditions);
        }
        object
    }

    fn property(&self, table: &str, key: &str, leaves: &[Leaf]) -> Value {
        match tables_of(leaves) {
            Some(Answer::Tables) => {
                json!({ "type": "array", "items": self.object(&below(table, key)) })
            }
            Some(Answer::TableOrTables) => {
                let one = self.object(&below(table, key));
                let list = json!({ "items": one });
                // An editor then says what is wrong with a key, and not that neither of two fits.
                json!({ "if": { "type": "array" }, "then": list, "else": one })
            }
            Some(_) => self.object(&below(table, key)),
            None => self.writer().value(leaves),
        }
    }

    /// What the deciding word of `table` says of its other keys.
    fn own_conditions(&self, table: &str, all: &Facts) -> Vec<Value> {
        let Some(decider) = self.decider(table) else { return Vec::new() };
        let own = |situation: &'_ Situation| situation.table == table;
        let words = self.words(|situation| situation.own.as_ref().filter(|_| own(situation)));
        let mut situations: Vec<Option<&Word>> = words.into_iter().map(Some).collect();
        if !all.required().contains(&decider) {
            situations.push(None);
        }
        let condition = |word: Option<&Word>| {
            let then = self.difference(table, Where::Own(word))?;
            let holds = match word {
                Some(word) => is(decider, word),
                None => json!({ "not": { "required": [decider] } }),
            };
            Some(json!({ "if": holds, "then": then }))
        };
        situations.into_iter().filter_map(condition).collect()
    }

    /// What holds of `table` only in some situations.
    fn difference(&self, table: &str, within: Where<'_>) -> Option<Value> {
        let all = self.facts(table, Where::All)?;
        let here = self.facts(table, within)?;
        let mut properties = Map::new();
        for (key, leaves) in &all.keys {
            let value = match here.leaves(key) {
                None => Some(json!(false)),
                Some(own) => self.changed(table, key, (leaves, own), within),
            };
            properties.extend(value.map(|value| ((*key).to_owned(), value)));
        }
        let always = all.required();
        let mut required = here.required();
        required.retain(|key| !always.contains(key));
        if properties.is_empty() && required.is_empty() {
            return None;
        }
        let mut difference = json!({});
        if !properties.is_empty() {
            difference["properties"] = Value::Object(properties);
        }
        require(&mut difference, &required);
        Some(difference)
    }

    fn changed(
        &self,
        table: &str,
        key: &str,
        (all, here): (&[Leaf], &[Leaf]),
        within: Where<'_>,
    ) -> Option<Value> {
        match tables_of(all) {
            // The keys of tables below do not hang on the words of this one.
            Some(_) if matches!(within, Where::Own(_)) => None,
            Some(Answer::Tables) => {
                let items = self.difference(&below(table, key), within)?;
                Some(json!({ "items": items }))
            }
            Some(Answer::TableOrTables) => {
                let one = self.difference(&below(table, key), within)?;
                let is_list = json!({ "type": "array" });
                Some(json!({ "if": is_list, "then": { "items": one }, "else": one }))
            }
            Some(_) => self.difference(&below(table, key), within),
            None => {
                let mut here = here.to_vec();
                here.sort_by_key(|leaf| all.iter().position(|one| one == leaf));
                let (all, here) = (self.writer().value(all), self.writer().value(&here));
                (all != here).then_some(here)
            }
        }
    }
}

/// The answer that is a table or a list of tables, whose keys are asked for one by one.
fn tables_of(leaves: &[Leaf]) -> Option<&Answer> {
    let mut answers = leaves.iter().map(|leaf| &leaf.answer);
    match answers.clone().any(|answer| matches!(answer, Answer::Defined(_))) {
        true => None,
        false => answers.find(|answer| {
            matches!(answer, Answer::Table | Answer::Tables | Answer::TableOrTables)
        }),
    }
}

fn below(table: &str, key: &str) -> String {
    match table {
        "" => key.to_owned(),
        table => format!("{table}.{key}"),
    }
}

/// That `word` stands at `key`.
fn is(key: &str, word: &Word) -> Value {
    let value = match word {
        Word::Text(text) => json!(text),
        Word::Integer(number) => json!(number),
    };
    json!({ "properties": { key: { "const": value } }, "required": [key] })
}

fn require(object: &mut Value, keys: &[&str]) {
    if !keys.is_empty() {
        object["required"] = json!(keys);
    }
}
