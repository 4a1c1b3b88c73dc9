//! Changes of bytes that come near to what readers look at, as values that can be generated and made smaller.

use std::ops::Range;

use bolero::TypeGenerator;

/// Longest input that is made (bytes).
const LONGEST: usize = 1 << 18;

/// Words that mean something to one reader or another.
const WORDS: [&str; 36] = [
    "nan",
    "inf",
    "-inf",
    "-1",
    "0",
    "1e308",
    "1e-308",
    "-0.0",
    "9223372036854775807",
    "1e999",
    "\"\"",
    "\" m\"",
    "\"1e308 m\"",
    "\"-1 kg\"",
    "[]",
    "{}",
    "[[",
    "]]",
    "=",
    "\"",
    "\n",
    "\r",
    "\u{feff}",
    ";",
    "\t",
    ",,",
    "1,5",
    "1.234,5",
    "\u{0}",
    "\u{202e}",
    "é",
    "(((((((((((((((((",
    "^^",
    "min(",
    "1e",
    "#",
];

/// Whole numbers that lengths and counts go wrong at.
const COUNTS: [u64; 9] = [0, 1, 0x7f, 0x80, 0xffff, 0x7fff_ffff, 0xffff_ffff, 1 << 40, u64::MAX];

/// A place in an input, whatever its length.
#[derive(Clone, Copy, Debug, TypeGenerator)]
pub struct Place(u32);

/// One of a list, whatever its length.
#[derive(Clone, Copy, Debug, TypeGenerator)]
pub struct Choice(u16);

/// A change of an input.
#[derive(Clone, Copy, Debug, TypeGenerator)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum Edit {
    FlipBit {
        at: Place,
        bit: Choice,
    },
    SetByte {
        at: Place,
        to: u8,
    },
    Cut {
        at: Place,
        bytes: u8,
    },
    CutRest {
        at: Place,
    },
    Double {
        at: Place,
        bytes: u8,
    },
    /// A piece of another input.
    Take {
        from: Place,
        bytes: u8,
        at: Place,
    },
    Insert {
        at: Place,
        word: Choice,
    },
    /// The next number becomes a word.
    ReplaceNumber {
        at: Place,
        by: Choice,
    },
    SetCount {
        at: Place,
        to: Choice,
        width: Choice,
    },
    MoveLine {
        at: Place,
        to: Place,
    },
}

impl Place {
    /// From 0 to `length`, both of them possible.
    fn of(self, length: usize) -> usize {
        ((u64::from(self.0) * (length as u64 + 1)) >> u32::BITS) as usize
    }
}

impl Choice {
    /// The item of `list`, which is not empty.
    pub fn of<T>(self, list: &[T]) -> &T {
        &list[usize::from(self.0) % list.len()]
    }
}

/// `input` with `edits` one after another, which may take pieces of `other`.
pub fn edited(input: &[u8], other: &[u8], edits: &[Edit]) -> Vec<u8> {
    let mut bytes = input.to_vec();
    edits.iter().for_each(|edit| edit.make(&mut bytes, other));
    bytes.truncate(LONGEST);
    bytes
}

impl Edit {
    fn make(self, bytes: &mut Vec<u8>, other: &[u8]) {
        let n = bytes.len();
        match self {
            Self::FlipBit { at, bit } => {
                let mask = bit.of(&[1, 2, 4, 8, 16, 32, 64, 128]);
                bytes.iter_mut().skip(at.of(n)).take(1).for_each(|byte| *byte ^= mask);
            }
            Self::SetByte { at, to } => {
                bytes.iter_mut().skip(at.of(n)).take(1).for_each(|byte| *byte = to);
            }
            Self::Cut { at, bytes: length } => drop(bytes.drain(stretch(bytes, at, length))),
            Self::CutRest { at } => bytes.truncate(at.of(n)),
            Self::Double { at, bytes: length } => {
                let doubled = bytes[stretch(bytes, at, length)].to_vec();
                insert(bytes, at.of(n), &doubled);
            }
            Self::Take { from, bytes: length, at } => {
                insert(bytes, at.of(n), &other[stretch(other, from, length)]);
            }
            Self::Insert { at, word } => insert(bytes, at.of(n), word.of(&WORDS).as_bytes()),
            Self::ReplaceNumber { at, by } => {
                let number = number_from(bytes, at.of(n));
                drop(bytes.splice(number, by.of(&WORDS).bytes()));
            }
            Self::SetCount { at, to, width } => {
                let count = &to.of(&COUNTS).to_le_bytes()[..*width.of(&[1, 2, 4, 8])];
                let places = bytes.iter_mut().skip(at.of(n));
                places.zip(count).for_each(|(byte, new)| *byte = *new);
            }
            Self::MoveLine { at, to } => move_line(bytes, at.of(n), to),
        }
    }
}

fn insert(bytes: &mut Vec<u8>, at: usize, piece: &[u8]) {
    drop(bytes.splice(at..at, piece.iter().copied()));
}

/// So many bytes from a place on, as far as there are.
fn stretch(bytes: &[u8], at: Place, length: u8) -> Range<usize> {
    let start = at.of(bytes.len());
    start..bytes.len().min(start + usize::from(length))
}

/// The range of the next number at or after `at`; empty and at the end without one.
fn number_from(bytes: &[u8], at: usize) -> Range<usize> {
    let is_digit = |byte: &u8| byte.is_ascii_digit();
    let start = bytes[at..].iter().position(is_digit).map_or(bytes.len(), |found| at + found);
    let of_number = |byte: &&u8| byte.is_ascii_digit() || **byte == b'.';
    start..start + bytes[start..].iter().take_while(of_number).count()
}

/// Takes the line at `at` out and puts it before another.
fn move_line(bytes: &mut Vec<u8>, at: usize, to: Place) {
    let start_of = |bytes: &[u8], at: usize| {
        bytes[..at].iter().rposition(|byte| *byte == b'\n').map_or(0, |found| found + 1)
    };
    let start = start_of(bytes, at);
    let end =
        bytes[at..].iter().position(|byte| *byte == b'\n').map_or(bytes.len(), |n| at + n + 1);
    let line: Vec<u8> = bytes.drain(start..end).collect();
    let to = start_of(bytes, to.of(bytes.len()));
    insert(bytes, to, &line);
}

#[cfg(test)]
mod tests {
    use super::*;

    const FIRST: Place = Place(0);
    const LAST: Place = Place(u32::MAX);

    #[test]
    fn each_edit_makes_the_change_that_it_names() {
        let text = b"speed = 2.5\nangle = 90\n";
        let with = |edit| String::from_utf8(edited(text, b"other", &[edit])).expect("ASCII");
        let first = Choice(0);
        for (edit, expected) in [
            (Edit::FlipBit { at: FIRST, bit: first }, "rpeed = 2.5\nangle = 90\n"),
            (Edit::SetByte { at: FIRST, to: b'S' }, "Speed = 2.5\nangle = 90\n"),
            (Edit::Cut { at: FIRST, bytes: 8 }, "2.5\nangle = 90\n"),
            (Edit::CutRest { at: FIRST }, ""),
            (Edit::Double { at: FIRST, bytes: 2 }, "spspeed = 2.5\nangle = 90\n"),
            (Edit::Take { from: FIRST, bytes: 9, at: LAST }, "speed = 2.5\nangle = 90\nother"),
            (Edit::Insert { at: FIRST, word: first }, "nanspeed = 2.5\nangle = 90\n"),
            (Edit::ReplaceNumber { at: FIRST, by: first }, "speed = nan\nangle = 90\n"),
            (
                Edit::SetCount { at: FIRST, to: first, width: Choice(1) },
                "\0\0eed = 2.5\nangle = 90\n",
            ),
            (Edit::MoveLine { at: FIRST, to: LAST }, "angle = 90\nspeed = 2.5\n"),
            // Behind the last byte there is nothing to change.
            (Edit::SetByte { at: LAST, to: b'S' }, "speed = 2.5\nangle = 90\n"),
        ] {
            assert_eq!(with(edit), expected, "{edit:?}");
        }
    }

    #[test]
    fn no_edit_fails_on_nothing_and_none_makes_an_input_too_long() {
        let long = vec![b'1'; LONGEST];
        bolero::check!().with_iterations(2000).with_type::<Edit>().cloned().for_each(|edit| {
            drop(edited(b"", b"", &[edit]));
            assert!(edited(&long, &long, &[edit; 2]).len() <= LONGEST, "{edit:?}");
        });
    }
}
