//! What is wrong with the text of a formula, and at which character: before `exmex` reads it, which says
//! no place, and where it would read something else than was meant.

use std::ops::Range;

use thiserror::Error;

/// Most numbers, variables, operators and functions of a formula.
pub const MOST_NODES: usize = 256;

/// Most parentheses inside each other.
pub const MOST_DEPTH: usize = 32;

/// The functions, each with how many values it takes. Beside them there is the number `pi`.
pub const FUNCTIONS: &[(&str, usize)] = &[
    ("abs", 1),
    ("sign", 1),
    ("sqrt", 1),
    ("cbrt", 1),
    ("exp", 1),
    ("ln", 1),
    ("log10", 1),
    ("sin", 1),
    ("cos", 1),
    ("tan", 1),
    ("asin", 1),
    ("acos", 1),
    ("atan", 1),
    ("sinh", 1),
    ("cosh", 1),
    ("tanh", 1),
    ("min", 2),
    ("max", 2),
];

/// What is wrong at a place of a formula.
#[derive(Clone, Debug, Error, PartialEq)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum SyntaxError {
    #[error("expected a formula")]
    Empty,
    #[error("`{0}` has no meaning here")]
    Character(char),
    #[error("this number is too large")]
    TooLarge,
    #[error("`{unknown}` is not known here; known: {}", known.join(", "))]
    Unknown { unknown: String, known: Vec<String> },
    #[error("`{0}` is a function: write {0}(…)")]
    Function(String),
    #[error("`{name}` takes {wanted}")]
    Arguments { name: String, wanted: &'static str },
    #[error("put the inner `min` or `max` first: max(min(a, b), c)")]
    SecondChoice,
    #[error("a value is missing here")]
    NoValue,
    #[error("an operator is missing here")]
    NoOperator,
    #[error("this parenthesis is not closed")]
    Open,
    #[error("this parenthesis was not opened")]
    Unopened,
    #[error("a sign before a power can be read in two ways: write -(a^b) or (-a)^b")]
    SignedPower,
    #[error("a power of a power can be read in two ways: write (a^b)^c or a^(b^c)")]
    TwicePower,
    #[error("a formula has at most {MOST_NODES} numbers, names and operators")]
    TooLong,
    #[error("at most {MOST_DEPTH} parentheses stand inside each other")]
    TooDeep,
    #[error("{0}")]
    Other(String),
}

/// Why a text is no formula, and where.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{fault}")]
pub struct FormulaError {
    /// The bytes of the text that it is about.
    pub at: Range<usize>,
    /// What is wrong there.
    pub fault: SyntaxError,
}

/// Whether a variable cannot have this name: it is a function's, or would be read as one.
pub fn is_reserved(name: &str) -> bool {
    name == "pi"
        || name.starts_with("min")
        || name.starts_with("max")
        || FUNCTIONS.iter().any(|(function, _)| *function == name)
}

/// How many bytes at the start of `text` are a number.
pub(super) fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits =
        |from: usize| bytes[from..].iter().take_while(|byte| byte.is_ascii_digit()).count();
    let whole = digits(0);
    let mut length = whole;
    if bytes.get(whole) == Some(&b'.') {
        let fraction = digits(whole + 1);
        if whole + fraction == 0 {
            return 0;
        }
        length += 1 + fraction;
    }
    if length > 0 && matches!(bytes.get(length), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(length + 1), Some(b'+' | b'-')));
        let exponent = bytes.get(length + 1 + sign..).map_or(0, |_| digits(length + 1 + sign));
        if exponent > 0 {
            length += 1 + sign + exponent;
        }
    }
    length
}

/// Whether `text` is a formula of `variables`.
pub(super) fn check(text: &str, variables: &[&str]) -> Result<(), FormulaError> {
    let mut reading = Reading { text, variables, at: 0, nodes: 0, groups: Vec::new() };
    reading.all()
}

/// A parenthesis that is open.
struct Group {
    at: usize,
    /// The function that it belongs to, and how many values that takes.
    function: Option<(&'static str, usize)>,
    commas: usize,
    /// Of the operand that it is or belongs to.
    before: Before,
}

/// What stands before an operand.
#[derive(Clone, Copy, Default)]
struct Before {
    signed: bool,
    raised: bool,
}

struct Reading<'a> {
    text: &'a str,
    variables: &'a [&'a str],
    at: usize,
    nodes: usize,
    groups: Vec<Group>,
}

impl<'a> Reading<'a> {
    fn all(&mut self) -> Result<(), FormulaError> {
        if self.text.trim().is_empty() {
            return Err(FormulaError { at: 0..self.text.len(), fault: SyntaxError::Empty });
        }
        let mut before = Before::default();
        loop {
            if !self.operand(&mut before)? {
                continue;
            }
            // An operand is complete; parentheses may end with it, and then an operator or the end comes.
            loop {
                match self.peek() {
                    None => return self.end(),
                    Some(')') => before = self.close()?,
                    Some(',') => {
                        self.comma()?;
                        before = Before::default();
                        break;
                    }
                    Some(c @ ('+' | '-' | '*' | '/')) => {
                        self.step(c.len_utf8())?;
                        before = Before::default();
                        break;
                    }
                    Some('^') => {
                        let here = self.at..self.at + 1;
                        let fault = match before {
                            Before { raised: true, .. } => Some(SyntaxError::TwicePower),
                            Before { signed: true, .. } => Some(SyntaxError::SignedPower),
                            _ => None,
                        };
                        if let Some(fault) = fault {
                            return Err(FormulaError { at: here, fault });
                        }
                        self.step(1)?;
                        before = Before { signed: false, raised: true };
                        break;
                    }
                    Some(c) if is_known(c) => {
                        return self.fail(c.len_utf8(), SyntaxError::NoOperator);
                    }
                    Some(c) => return self.fail(c.len_utf8(), SyntaxError::Character(c)),
                }
            }
        }
    }

    /// Reads what a value begins with; true if the value is complete.
    fn operand(&mut self, before: &mut Before) -> Result<bool, FormulaError> {
        let Some(c) = self.peek() else { return self.fail(0, SyntaxError::NoValue) };
        match c {
            '+' | '-' if !before.signed => {
                self.step(1)?;
                before.signed = true;
                Ok(false)
            }
            '(' => {
                self.open(None, *before)?;
                *before = Before::default();
                Ok(false)
            }
            '0'..='9' | '.' => self.number().map(|()| true),
            c if is_letter(c) => self.name(before),
            '+' | '-' | '*' | '/' | '^' | ',' | ')' => self.fail(1, SyntaxError::NoValue),
            c => self.fail(c.len_utf8(), SyntaxError::Character(c)),
        }
    }

    fn number(&mut self) -> Result<(), FormulaError> {
        let length = number_length(&self.text[self.at..]);
        if length == 0 {
            return self.fail(1, SyntaxError::Character('.'));
        }
        let value: f64 = self.text[self.at..self.at + length].parse().unwrap_or(f64::INFINITY);
        match value.is_finite() {
            true => self.step(length),
            false => self.fail(length, SyntaxError::TooLarge),
        }
    }

    /// A variable, or a function with its opening parenthesis; true if the value is complete.
    fn name(&mut self, before: &mut Before) -> Result<bool, FormulaError> {
        let rest = &self.text[self.at..];
        let length =
            rest.find(|c: char| !is_letter(c) && !c.is_ascii_digit()).unwrap_or(rest.len());
        let name = &rest[..length];
        if let Some(function) = FUNCTIONS.iter().find(|(function, _)| *function == name) {
            let start = self.at;
            self.step(length)?;
            if self.peek() != Some('(') {
                let fault = SyntaxError::Function(name.to_owned());
                return Err(FormulaError { at: start..start + length, fault });
            }
            let chooses = function.1 == 2;
            if chooses && self.groups.iter().any(|group| group.commas > 0) {
                let at = start..start + length;
                return Err(FormulaError { at, fault: SyntaxError::SecondChoice });
            }
            self.open(Some(*function), *before)?;
            *before = Before::default();
            return Ok(false);
        }
        if name != "pi" && (is_reserved(name) || !self.variables.contains(&name)) {
            let known = self.variables.iter().map(|&name| name.to_owned()).collect();
            let unknown = name.to_owned();
            return self.fail(length, SyntaxError::Unknown { unknown, known });
        }
        self.step(length).map(|()| true)
    }

    fn open(
        &mut self,
        function: Option<(&'static str, usize)>,
        before: Before,
    ) -> Result<(), FormulaError> {
        if self.groups.len() == MOST_DEPTH {
            return self.fail(1, SyntaxError::TooDeep);
        }
        self.groups.push(Group { at: self.at, function, commas: 0, before });
        self.at += 1;
        Ok(())
    }

    fn close(&mut self) -> Result<Before, FormulaError> {
        let Some(group) = self.groups.pop() else { return self.fail(1, SyntaxError::Unopened) };
        match group.function {
            Some((name, wanted)) if wanted != group.commas + 1 => {
                self.fail(1, arguments(name, wanted))
            }
            _ => {
                self.at += 1;
                Ok(group.before)
            }
        }
    }

    fn comma(&mut self) -> Result<(), FormulaError> {
        let at = self.at..self.at + 1;
        let fault = match self.groups.last_mut() {
            Some(Group { function: Some((_, wanted)), commas, .. }) if *commas + 1 < *wanted => {
                *commas += 1;
                self.at += 1;
                return Ok(());
            }
            Some(Group { function: Some((name, wanted)), .. }) => arguments(name, *wanted),
            _ => SyntaxError::Character(','),
        };
        Err(FormulaError { at, fault })
    }

    fn end(&self) -> Result<(), FormulaError> {
        match self.groups.last() {
            None => Ok(()),
            Some(group) => {
                Err(FormulaError { at: group.at..group.at + 1, fault: SyntaxError::Open })
            }
        }
    }

    /// The next character that is no white space.
    fn peek(&mut self) -> Option<char> {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_ascii_start().len();
        self.text[self.at..].chars().next()
    }

    /// Goes past a node of `length` bytes.
    fn step(&mut self, length: usize) -> Result<(), FormulaError> {
        self.nodes += 1;
        if self.nodes > MOST_NODES {
            return self.fail(length, SyntaxError::TooLong);
        }
        self.at += length;
        Ok(())
    }

    fn fail<T>(&self, length: usize, fault: SyntaxError) -> Result<T, FormulaError> {
        let at: Range<usize> = self.at..(self.at + length).min(self.text.len());
        Err(FormulaError { at, fault })
    }
}

fn arguments(name: &str, wanted: usize) -> SyntaxError {
    let wanted = if wanted == 1 { "one value" } else { "two values" };
    SyntaxError::Arguments { name: name.to_owned(), wanted }
}

/// What a name is made of, beside digits.
fn is_letter(c: char) -> bool {
    c.is_ascii_alphabetic() || c == '_' || ('α'..='ω').contains(&c) || ('Α'..='Ω').contains(&c)
}

/// What may begin a value.
fn is_known(c: char) -> bool {
    is_letter(c) || c.is_ascii_digit() || matches!(c, '.' | '(')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(text: &str) -> (Range<usize>, String) {
        let error = check(text, &["z", "v"]).expect_err(text);
        (error.at.clone(), error.to_string())
    }

    #[test]
    fn the_character_that_is_wrong_is_pointed_at() {
        for (text, at, what) in [
            ("  ", 0..2, "expected a formula"),
            ("v + ", 4..4, "a value is missing"),
            ("v * / z", 4..5, "a value is missing"),
            ("2 v", 2..3, "an operator is missing"),
            ("2 λ", 2..4, "an operator is missing"),
            ("(v)(z)", 3..4, "an operator is missing"),
            ("(v + (z)", 0..1, "not closed"),
            ("v + z)", 5..6, "not opened"),
            ("v + dpeth", 4..9, "`dpeth` is not known here; known: z, v"),
            ("sqrt v", 0..4, "write sqrt(…)"),
            ("sin(v, z)", 5..6, "`sin` takes one value"),
            ("max(v)", 5..6, "`max` takes two values"),
            ("max(z, min(z, v))", 7..10, "max(min(a, b), c)"),
            ("v, z", 1..2, "`,` has no meaning"),
            ("v = z", 2..3, "`=` has no meaning"),
            ("v² + z", 1..3, "`²` has no meaning"),
            ("{v}", 0..1, "`{` has no meaning"),
            ("-v^2", 2..3, "write -(a^b) or (-a)^b"),
            ("-(v + z)^2", 8..9, "write -(a^b)"),
            ("v^z^2", 3..4, "write (a^b)^c"),
            ("- -v", 2..3, "a value is missing"),
            ("1e999 * v", 0..5, "too large"),
            ("maximum", 0..7, "`maximum` is not known"),
        ] {
            let (place, message) = fault(text);
            assert_eq!(place, at, "{text}: {message}");
            assert!(message.contains(what), "{text}: {message}");
        }
    }

    #[test]
    fn formulas_have_a_largest_size() {
        let long = |n: usize| vec!["v"; n].join("+");
        assert!(check(&long(MOST_NODES / 2), &["v"]).is_ok());
        assert_eq!(fault(&long(MOST_NODES / 2 + 1)).1, SyntaxError::TooLong.to_string());
        let deep = |n: usize| format!("{}v{}", "(".repeat(n), ")".repeat(n));
        assert!(check(&deep(MOST_DEPTH), &["v"]).is_ok());
        assert_eq!(fault(&deep(MOST_DEPTH + 1)).1, SyntaxError::TooDeep.to_string());
    }

    #[test]
    fn numbers_end_where_they_end() {
        for (text, length) in
            [("1.5e-3*v", 6), ("2e", 1), ("2ex", 1), (".5", 2), (".", 0), ("1.", 2), ("7+1", 1)]
        {
            assert_eq!(number_length(text), length, "{text}");
        }
    }
}
