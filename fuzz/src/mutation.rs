//! Changes of bytes that come near to what readers look at.

use rand::RngExt;
use rand_pcg::Pcg64;

/// Most changes of one input.
const MOST_CHANGES: u32 = 4;

/// Longest input that is made (bytes).
const LONGEST: usize = 1 << 18;

/// Bytes of a stretch that is cut, doubled or taken from elsewhere.
const LONGEST_STRETCH: usize = 64;

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

/// `input` with one to four changes, some of which take a piece of `other`.
pub fn changed(input: &[u8], other: &[u8], random: &mut Pcg64) -> Vec<u8> {
    let mut bytes = input.to_vec();
    for _ in 0..random.random_range(1..=MOST_CHANGES) {
        change(&mut bytes, other, random);
    }
    bytes.truncate(LONGEST);
    bytes
}

fn change(bytes: &mut Vec<u8>, other: &[u8], random: &mut Pcg64) {
    let at = random.random_range(0..=bytes.len());
    match random.random_range(0..9) {
        0 => {
            let bit = random.random_range(0..8);
            bytes.iter_mut().skip(at).take(1).for_each(|byte| *byte ^= 1 << bit);
        }
        1 => {
            let value = random.random();
            bytes.iter_mut().skip(at).take(1).for_each(|byte| *byte = value);
        }
        2 => drop(bytes.drain(stretch(bytes, at, random))),
        3 => {
            let doubled = bytes[stretch(bytes, at, random)].to_vec();
            insert(bytes, at, &doubled);
        }
        4 => {
            let from = random.random_range(0..=other.len());
            insert(bytes, at, &other[stretch(other, from, random)]);
        }
        5 => {
            let word = WORDS[random.random_range(0..WORDS.len())];
            insert(bytes, at, word.as_bytes());
        }
        6 => {
            let number = number_from(bytes, at);
            let word = WORDS[random.random_range(0..WORDS.len())];
            drop(bytes.splice(number, word.bytes()));
        }
        7 => {
            let count = COUNTS[random.random_range(0..COUNTS.len())].to_le_bytes();
            let width = [1, 2, 4, 8][random.random_range(0..4)];
            bytes.iter_mut().skip(at).zip(&count[..width]).for_each(|(byte, new)| *byte = *new);
        }
        _ => move_a_line(bytes, at, random),
    }
}

fn insert(bytes: &mut Vec<u8>, at: usize, piece: &[u8]) {
    drop(bytes.splice(at..at, piece.iter().copied()));
}

/// A stretch of `bytes` from `at` on; now and then all that is left.
fn stretch(bytes: &[u8], at: usize, random: &mut Pcg64) -> std::ops::Range<usize> {
    let left = bytes.len() - at;
    let most = if random.random_range(0..16) == 0 { left } else { left.min(LONGEST_STRETCH) };
    at..at + random.random_range(0..=most)
}

/// Where the next number at or after `at` stands; nowhere, at the end, if there is none.
fn number_from(bytes: &[u8], at: usize) -> std::ops::Range<usize> {
    let is_digit = |byte: &u8| byte.is_ascii_digit();
    let start = bytes[at..].iter().position(is_digit).map_or(bytes.len(), |found| at + found);
    let of_number = |byte: &&u8| byte.is_ascii_digit() || **byte == b'.';
    start..start + bytes[start..].iter().take_while(of_number).count()
}

/// Takes the line at `at` out and puts it somewhere else.
fn move_a_line(bytes: &mut Vec<u8>, at: usize, random: &mut Pcg64) {
    let start = bytes[..at].iter().rposition(|byte| *byte == b'\n').map_or(0, |found| found + 1);
    let end =
        bytes[at..].iter().position(|byte| *byte == b'\n').map_or(bytes.len(), |n| at + n + 1);
    let line: Vec<u8> = bytes.drain(start..end).collect();
    let to = random.random_range(0..=bytes.len());
    let to = bytes[..to].iter().rposition(|byte| *byte == b'\n').map_or(0, |found| found + 1);
    insert(bytes, to, &line);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_are_many_stay_within_bounds_and_follow_from_the_seed() {
        let text = b"speed = \"2 m/s\"\nangle = 90\n\nmass = 0.5\n";
        let made = |seed| -> Vec<Vec<u8>> {
            let mut random = Pcg64::new(seed, 0);
            let mut input = text.to_vec();
            let next = |_| {
                input = changed(&input, text, &mut random);
                input.clone()
            };
            (0..2000).map(next).collect()
        };
        let first = made(1);
        assert_eq!(first, made(1));
        assert_ne!(first, made(2));
        let different: std::collections::BTreeSet<_> = first.iter().collect();
        // A change may be none, and may take another back.
        assert!(different.len() > 1500, "{}", different.len());
        assert!(first.iter().all(|input| input.len() <= LONGEST));
    }
}
