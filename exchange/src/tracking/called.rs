//! What the names of runs say where no pattern takes them apart: which part numbers the repeats, and which tells conditions.

/// The words of `name`: letters, digits and decimal points.
pub(super) fn words(name: &str) -> impl Iterator<Item = &str> {
    name.split(|c: char| !c.is_alphanumeric() && c != '.')
}

/// A run of letters or of digits in a name.
#[derive(Clone, Copy, Debug)]
struct Token<'a> {
    /// The text between the token before and this one.
    gap: &'a str,
    text: &'a str,
    kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Word,
    /// A number with a unit, or after a word for a height or a speed: it is never the number of a repeat.
    Quantity,
    /// A date, a time of day or the number of a clip: none of them identifies a condition.
    Clip,
    /// Any other number.
    Free,
}

/// Where the number of a repeat may stand, in the order in which they are tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    /// Behind a word for it, as in `h10_r2`.
    Marked,
    /// In brackets, as in `h10 (2)`.
    Bracketed,
    /// At the end, as in `h10_2`.
    Last,
    /// Behind a word that may be for something else, as in `drop2_loose`.
    Perhaps,
    /// A number that stands alone, as in `2_loose`.
    Alone,
    /// One letter at the end, as in `loose-b`.
    Letter,
}

const PLACES: [Place; 6] =
    [Place::Marked, Place::Bracketed, Place::Last, Place::Perhaps, Place::Alone, Place::Letter];

const MARKS: [&str; 16] = [
    "repeat",
    "rep",
    "replicate",
    "trial",
    "run",
    "take",
    "shot",
    "test",
    "try",
    "r",
    "nr",
    "no",
    "wdh",
    "versuch",
    "essai",
    "essay",
];
const PERHAPS: [&str; 7] = ["drop", "fall", "t", "n", "b", "bed", "seed"];
const MAGNITUDES: [&str; 11] = [
    "h",
    "height",
    "höhe",
    "fallhöhe",
    "hauteur",
    "v",
    "vel",
    "speed",
    "velocity",
    "vitesse",
    "geschwindigkeit",
];
const UNITS: [&str; 17] = [
    "mm", "cm", "m", "in", "inch", "ft", "um", "g", "kg", "mg", "deg", "grad", "ms", "s", "hz",
    "fps", "pct",
];
const CLIPS: [&str; 13] = [
    "img", "dsc", "dscn", "dscf", "mov", "mvi", "vid", "gopr", "gx", "gh", "clip", "video", "movie",
];
const DAYS: [&str; 4] = ["day", "date", "session", "tag"];

/// Each of `names` without the number of its repeat: the runs of one condition have the same key. All keys are empty if names
/// differ only in numbers that never recur, such as times of day.
///
/// If the number can stand in several places, the first place is taken at which runs of the same key `agree`.
pub(super) fn keys(names: &[&str], agree: impl Fn(&[usize]) -> bool) -> Vec<String> {
    let all = without_shared_end(names.iter().map(|name| tokens(name)).collect());
    let with = |first: Place| -> Vec<String> {
        all.iter().map(|tokens| key(tokens, repeat(tokens, first))).collect()
    };
    let is_there = |place: &&Place| all.iter().any(|tokens| at(tokens, **place).is_some());
    let found: Vec<Vec<String>> =
        PLACES.iter().filter(is_there).map(|place| with(*place)).collect();
    let is_agreed = |keys: &&Vec<String>| groups(keys).iter().all(|(_, own)| agree(own));
    let repeats = |keys: &&Vec<String>| groups(keys).len() < keys.len();
    let is_of_numbers = |tokens: &Vec<Token<'_>>| {
        tokens.iter().all(|token| matches!(token.kind, Kind::Free | Kind::Clip))
    };
    if all.iter().all(is_of_numbers) && !found.iter().any(|keys| repeats(&keys)) {
        return vec![String::new(); names.len()];
    }
    found
        .iter()
        .filter(repeats)
        .find(is_agreed)
        .or_else(|| found.iter().find(repeats))
        .or(found.first())
        .cloned()
        .unwrap_or_else(|| all.iter().map(|tokens| key(tokens, None)).collect())
}

/// Names without the words and numbers that all of them end with.
fn without_shared_end(mut all: Vec<Vec<Token<'_>>>) -> Vec<Vec<Token<'_>>> {
    let is_shared = |all: &[Vec<Token<'_>>]| {
        let Some(last) = all.first().and_then(|own| own.last()).copied() else { return false };
        let is_same = |own: &Vec<Token<'_>>| {
            own.len() > 1
                && own
                    .last()
                    .is_some_and(|other| other.text == last.text && other.kind == last.kind)
        };
        all.len() > 1 && last.kind != Kind::Quantity && !is_unit(&last) && all.iter().all(is_same)
    };
    while is_shared(&all) {
        all.iter_mut().for_each(|own| own.truncate(own.len() - 1));
    }
    all
}

/// Each of `keys` once, without regard to capitals, with the places where it stands.
pub(super) fn groups(keys: &[String]) -> Vec<(String, Vec<usize>)> {
    let mut all: Vec<(String, Vec<usize>)> = Vec::new();
    for (at, key) in keys.iter().enumerate() {
        match all.iter_mut().find(|(own, _)| own.to_lowercase() == key.to_lowercase()) {
            Some((_, own)) => own.push(at),
            None => all.push((key.clone(), vec![at])),
        }
    }
    all
}

/// The words and numbers of `name`, in small letters.
pub(super) fn parts(name: &str) -> Vec<String> {
    tokens(name).into_iter().map(|one| one.text.to_lowercase()).collect()
}

fn is_in(words: &[&str], text: &str) -> bool {
    words.contains(&text.to_lowercase().as_str())
}

fn is_digits(text: &str) -> bool {
    text.bytes().all(|byte| byte.is_ascii_digit())
}

/// The runs of letters and of digits in `name`. Decimals stand between digits where a unit follows.
fn tokens(name: &str) -> Vec<Token<'_>> {
    let mut all: Vec<Token<'_>> = Vec::new();
    let mut rest = name;
    while let Some(start) = rest.find(char::is_alphanumeric) {
        let (gap, from) = rest.split_at(start);
        let is_number = from.starts_with(|c: char| c.is_ascii_digit());
        let other = |c: char| !c.is_alphanumeric() || c.is_ascii_digit() != is_number;
        let end = from.find(other).unwrap_or(from.len());
        let numbers_run = all.last().is_some_and(|word| {
            gap.is_empty() && (is_in(&MARKS, word.text) || is_in(&PERHAPS, word.text))
        });
        let end = match is_number && !numbers_run {
            true => end + decimals(&from[end..]),
            false => end,
        };
        let (text, behind) = from.split_at(end);
        let kind = if is_number { Kind::Free } else { Kind::Word };
        all.push(Token { gap, text, kind });
        rest = behind;
    }
    let kinds: Vec<Kind> = (0..all.len()).map(|at| kind(&all, at)).collect();
    all.iter_mut().zip(kinds).for_each(|(one, kind)| one.kind = kind);
    all
}

/// Length of the decimals at the start of `text`, if a unit follows them.
fn decimals(text: &str) -> usize {
    let of = || {
        let digits = text.strip_prefix(['.', ','])?;
        let end = digits.find(|c: char| !c.is_ascii_digit()).filter(|end| *end > 0)?;
        let unit = digits[end..].split(|c: char| !c.is_alphabetic()).next()?;
        is_in(&UNITS, unit).then_some(1 + end)
    };
    of().unwrap_or(0)
}

/// Whether a word is the unit of the number before it; behind a blank, `in` and single letters are words.
fn is_unit(word: &Token<'_>) -> bool {
    let is_long = word.text.len() > 1 && word.text != "in";
    is_in(&UNITS, word.text) && (word.gap.is_empty() || word.gap == " " && is_long)
}

fn kind(all: &[Token<'_>], at: usize) -> Kind {
    let number = |at: usize| all.get(at).filter(|one| one.kind == Kind::Free);
    let before = at.checked_sub(1).map(|before| all[before]).filter(|one| one.kind == Kind::Word);
    let is_behind = |words: &[&str]| before.is_some_and(|word| is_in(words, word.text));
    if number(at).is_none() {
        // The word before the number of a clip goes with it.
        let names_clip =
            number(at + 1).is_some() && (is_in(&CLIPS, all[at].text) || is_in(&DAYS, all[at].text));
        return if names_clip { Kind::Clip } else { Kind::Word };
    }
    let has_unit = all.get(at + 1).is_some_and(is_unit);
    let text = all[at].text;
    let is_counted = text.len() > 2 && text.starts_with('0') && is_digits(text);
    match () {
        () if has_unit || is_behind(&MAGNITUDES) => Kind::Quantity,
        () if is_counted || is_behind(&CLIPS) || is_behind(&DAYS) => Kind::Clip,
        () if is_of_date(all, at) => Kind::Clip,
        () => Kind::Free,
    }
}

/// Whether a number is a part of a date such as `2024-03-05` or `20240305_141500`.
fn is_of_date(all: &[Token<'_>], at: usize) -> bool {
    let is_year =
        |text: &str| text.len() == 4 && (text.starts_with("19") || text.starts_with("20"));
    let is_day = |text: &str| text.len() == 8 && is_year(&text[..4]);
    let is_short = |text: &str| text.len() <= 2;
    let text = |at: Option<usize>| {
        at.and_then(|at| all.get(at))
            .map(|one| one.text)
            .filter(|text| is_digits(text))
            .unwrap_or("x")
    };
    let own = text(Some(at));
    let follows_day = own.len() == 6 && is_day(text(at.checked_sub(1)));
    let is_triple = |from: Option<usize>| {
        let [a, b, c] = [0, 1, 2].map(|nth| text(from.map(|from| from + nth)));
        let are = |year: &str, others: [&str; 2]| {
            is_year(year) && others.iter().all(|one| is_digits(one) && is_short(one))
        };
        are(a, [b, c]) || are(c, [a, b])
    };
    is_day(own) || follows_day || (0..3).any(|back| is_triple(at.checked_sub(back)))
}

/// The token that numbers the repeat, if one stands in this place.
fn at(tokens: &[Token<'_>], place: Place) -> Option<usize> {
    let is_free = |at: &usize| tokens[*at].kind == Kind::Free;
    let free = || (0..tokens.len()).filter(is_free);
    let behind = |at: usize, words: &[&str]| {
        let word = at.checked_sub(1).map(|before| tokens[before]);
        word.is_some_and(|word| word.kind == Kind::Word && is_in(words, word.text))
    };
    let is_apart = |at: &usize| {
        let before = at
            .checked_sub(1)
            .is_none_or(|before| !tokens[*at].gap.is_empty() || tokens[before].kind != Kind::Word);
        before && tokens.get(at + 1).is_none_or(|next| !next.gap.is_empty())
    };
    match place {
        Place::Marked => free().find(|at| behind(*at, &MARKS)),
        Place::Bracketed => free().find(|at| tokens[*at].gap.ends_with(['(', '#'])),
        Place::Last => free().find(|at| at + 1 == tokens.len()),
        Place::Perhaps => free().find(|at| behind(*at, &PERHAPS)),
        Place::Alone => match free().collect::<Vec<_>>()[..] {
            [only] => Some(only).filter(is_apart),
            _ => None,
        },
        Place::Letter => {
            let last = tokens.len().checked_sub(1).filter(|last| *last > 0)?;
            let one = tokens[last];
            (one.kind == Kind::Word && one.text.chars().count() == 1 && !is_unit(&one))
                .then_some(last)
        }
    }
}

/// The token that numbers the repeat, looked for in the place `first`, then in the others.
fn repeat(tokens: &[Token<'_>], first: Place) -> Option<usize> {
    std::iter::once(first).chain(PLACES).find_map(|place| at(tokens, place))
}

/// The name without the number of its repeat, the word for it, and clips.
fn key(tokens: &[Token<'_>], repeat: Option<usize>) -> String {
    let is_mark = |at: usize| {
        repeat == Some(at + 1)
            && (is_in(&MARKS, tokens[at].text) || is_in(&PERHAPS, tokens[at].text))
    };
    let (mut key, mut is_cut) = (String::new(), false);
    for (at, Token { gap, text, kind }) in tokens.iter().enumerate() {
        if repeat == Some(at) || is_mark(at) || *kind == Kind::Clip {
            is_cut = true;
            continue;
        }
        if !key.is_empty() {
            key.push_str(match *gap {
                "" if is_cut => "_",
                "" | "-" | "." | "=" => gap,
                _ => "_",
            });
        }
        key.push_str(text);
        is_cut = false;
    }
    key
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_beside_the_number_of_the_repeat_tells_conditions() {
        for (names, wanted) in [
            ([["h10_r1", "h10_r2"], ["h20_r1", "h20_r2"]], ["h10", "h20"]),
            ([["loose/drop1", "loose/drop2"], ["dense/drop1", "dense/drop2"]], ["loose", "dense"]),
            (
                [["phi58_h10_1", "phi58_h10_2"], ["phi62_h10_1", "phi62_h10_2"]],
                ["phi58_h10", "phi62_h10"],
            ),
            (
                [["dense_20cm_r1", "dense_20cm_r2"], ["loose_20cm_r1", "loose_20cm_r2"]],
                ["dense_20cm", "loose_20cm"],
            ),
            ([["h10cm (1)", "h10cm (2)"], ["h11cm (1)", "h11cm (2)"]], ["h10cm", "h11cm"]),
            ([["H10R1", "H10R2"], ["H11R1", "H11R2"]], ["H10", "H11"]),
            ([["r1_h10", "r2_h10"], ["r1_h11", "r2_h11"]], ["h10", "h11"]),
            (
                [
                    ["2024_03_05_10cm_run1_final", "2024_03_05_10cm_run2_final"],
                    ["2024_03_06_10.5cm_run1_final", "2024_03_06_10.5cm_run2_final"],
                ],
                ["10cm", "10.5cm"],
            ),
            (
                [["IMG_0001_10cm", "IMG_0002_10cm"], ["IMG_0003_11cm", "IMG_0004_11cm"]],
                ["10cm", "11cm"],
            ),
            ([["drop1.10cm", "drop2.10cm"], ["drop1.11cm", "drop2.11cm"]], ["10cm", "11cm"]),
            ([["10-1", "10-2"], ["11-1", "11-2"]], ["10", "11"]),
            ([["h10.1", "h10.2"], ["h11.1", "h11.2"]], ["h10", "h11"]),
            ([["1_dense", "2_dense"], ["1_loose", "2_loose"]], ["dense", "loose"]),
            ([["dense-a", "dense-b"], ["loose-a", "loose-b"]], ["dense", "loose"]),
            ([["drop1", "drop2"], ["drop3", "drop4"]], ["", ""]),
            ([["IMG_0001", "IMG_0002"], ["IMG_0003", "IMG_0004"]], ["", ""]),
            (
                [["20240503_141500", "20240503_141600"], ["20240504_101500", "20240504_101600"]],
                ["", ""],
            ),
        ] {
            let found = keys(&names.concat(), |own| own.iter().all(|at| at / 2 == own[0] / 2));
            assert_eq!(found, [wanted[0], wanted[0], wanted[1], wanted[1]], "{names:?}");
        }
    }

    #[test]
    fn of_two_numbers_that_may_be_the_repeat_it_is_the_one_whose_runs_agree() {
        let names = ["drop_10_1", "drop_10_2", "drop_20_1", "drop_20_2"];
        let is_low = |at: &usize| *at < 2;
        let agree = |own: &[usize]| own.iter().all(is_low) || !own.iter().any(is_low);
        assert_eq!(keys(&names, agree), ["drop_10", "drop_10", "drop_20", "drop_20"]);
        assert_eq!(parts("Steel_h10-1"), ["steel", "h", "10", "1"]);
    }
}
