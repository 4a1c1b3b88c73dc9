//! Text as a sheet: encoding, line ends, separator and decimals are found out.

use encoding_rs::{SHIFT_JIS, WINDOWS_1252};

use super::fault::Fault;
use super::sheet::{Number, Row, Sheet, number};

/// Lines that separator and decimals are found from.
const SAMPLE: usize = 400;

/// What may stand between cells, with its name; the first that gives most numbers is it.
const SEPARATORS: [(Option<u8>, &str); 5] = [
    (Some(b'\t'), "tabs"),
    (Some(b';'), "semicolons"),
    (Some(b'|'), "bars"),
    (Some(b','), "commas"),
    (None, "blanks"),
];

/// The table in `bytes`, the content of the file that messages call `file`.
///
/// # Errors
/// If it is not text, or a quoted cell does not end on its line.
pub(super) fn read(file: &str, stem: &str, bytes: &[u8]) -> Result<Sheet, Fault> {
    let mut notes = Vec::new();
    let text = decode(bytes, &mut notes);
    if text.contains('\0') {
        let what = "this is not text";
        let right = "a table is text, or a spreadsheet named .xlsx, .xls or .ods";
        return Err(Fault::new(file, what, right));
    }
    let lines: Vec<(u64, &str)> = (1..)
        .zip(lines(&text).map(without_stamp))
        .filter(|(_, line)| !line.trim().is_empty())
        .collect();
    // What stands above the numbers has other separators.
    let sample = &lines[lines.len().min(lines.len() / 4).min(40)..];
    let sample = &sample[..sample.len().min(SAMPLE)];
    let score = |separator: Option<u8>| -> usize {
        let count = |line: &str| {
            let cells = split(line, separator).unwrap_or_default();
            let is_number = |cell: &&String| {
                let with = |comma: bool| matches!(number(cell, comma), Number::Value(_));
                with(false) || with(true)
            };
            cells.iter().filter(is_number).count()
        };
        sample.iter().map(|(_, line)| count(line)).sum()
    };
    // Where cells hold words alone, or numbers with their units, the first line tells.
    let columns = |separator: Option<u8>| match (separator, sample.first()) {
        (Some(_), Some((_, line))) => split(line, separator).map_or(0, |cells| cells.len()),
        _ => 0,
    };
    let (separator, separated) = SEPARATORS
        .into_iter()
        .rev()
        .max_by_key(|(separator, _)| match score(*separator) {
            0 => (0, columns(*separator)),
            numbers => (numbers, 0),
        })
        .unwrap_or((Some(b','), "commas"));
    let mut rows = Vec::with_capacity(lines.len());
    for (line, text) in lines {
        let cells = split(text, separator).ok_or_else(|| {
            Fault::new(file, "a quoted cell does not end on its line", "close its quote").at(line)
        })?;
        rows.push(Row { line, cells });
    }
    rows.retain(|row| !row.is_blank());
    drop_comments(&mut rows);
    drop_row_names(&mut rows);
    let decimal_comma = has_decimal_commas(&rows);
    Ok(Sheet {
        file: file.to_owned(),
        stem: stem.to_owned(),
        separated,
        decimal_comma,
        rows,
        notes,
    })
}

/// Removes comments between rows whose first number grows: before another drop it starts again.
fn drop_comments(rows: &mut Vec<Row>) {
    let is_comment = |row: &Row| row.cells[0].starts_with(['#', '%']);
    let first = |row: &Row| {
        [false, true].into_iter().find_map(|comma| match number(row.cell(0), comma) {
            Number::Value(value) => Some(value),
            _ => None,
        })
    };
    let mut before = None;
    let mut kept: Vec<bool> = Vec::with_capacity(rows.len());
    for (at, row) in rows.iter().enumerate() {
        let behind = || rows[at..].iter().find(|row| !is_comment(row)).and_then(first);
        let goes_on = || before.zip(behind()).is_some_and(|(before, behind)| before < behind);
        kept.push(!is_comment(row) || !goes_on());
        if !is_comment(row) {
            before = first(row);
        }
    }
    let mut kept = kept.into_iter();
    rows.retain(|_| kept.next().unwrap_or(true));
}

/// Removes the numbers of rows that R writes before them without a name in the header.
fn drop_row_names(rows: &mut [Row]) {
    let Some((header, below)) = rows.split_first_mut() else { return };
    let is_numbered = |(nth, row): (usize, &Row)| {
        row.cells.len() == header.cells.len() + 1 && row.cells[0] == nth.to_string()
    };
    if !below.is_empty() && (1..).zip(&*below).all(is_numbered) {
        below.iter_mut().for_each(|row| drop(row.cells.remove(0)));
    }
}

/// A line without the time of day that a serial monitor puts before it, as in `14:22:31.100 -> 12,158.35`.
fn without_stamp(line: &str) -> &str {
    let is_time = |text: &str| {
        text.contains(':')
            && text.bytes().all(|byte| byte.is_ascii_digit() || b":.".contains(&byte))
    };
    line.split_once(" -> ").filter(|(stamp, _)| is_time(stamp)).map_or(line, |(_, rest)| rest)
}

/// UTF-8 or UTF-16 by its byte order mark, or UTF-16 by its zeros, else UTF-8, else Shift-JIS where that gives Japanese words,
/// else Windows-1252, which holds Latin-1.
fn decode(bytes: &[u8], notes: &mut Vec<String>) -> String {
    let wide = |bytes: &[u8], of: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes.chunks_exact(2).map(|pair| of([pair[0], pair[1]])).collect();
        String::from_utf16_lossy(&units)
    };
    match bytes {
        [0xef, 0xbb, 0xbf, rest @ ..] => String::from_utf8_lossy(rest).into_owned(),
        [0xff, 0xfe, rest @ ..] => wide(rest, u16::from_le_bytes),
        [0xfe, 0xff, rest @ ..] => wide(rest, u16::from_be_bytes),
        [0, ..] if is_wide(bytes, 0) => wide(bytes, u16::from_be_bytes),
        [_, 0, ..] if is_wide(bytes, 1) => wide(bytes, u16::from_le_bytes),
        _ => match std::str::from_utf8(bytes) {
            Ok(text) => text.to_owned(),
            Err(_) => {
                let (encoding, text) = match japanese(bytes) {
                    Some(text) => ("Shift-JIS", text),
                    None => ("Windows-1252", WINDOWS_1252.decode(bytes).0.into_owned()),
                };
                notes.push(format!("it is not UTF-8 and was read as {encoding}"));
                text
            }
        },
    }
}

/// Whether nearly every second of `bytes`, from `first` on, is zero, as in UTF-16 of Latin letters.
fn is_wide(bytes: &[u8], first: usize) -> bool {
    let high = bytes.iter().skip(first).step_by(2);
    let zeros = high.clone().filter(|byte| **byte == 0).count();
    bytes.len().is_multiple_of(2) && 10 * zeros >= 9 * high.count()
}

/// `bytes` from Shift-JIS, if that gives words of kana or of several kanji: single ones are accented Latin letters misread.
fn japanese(bytes: &[u8]) -> Option<String> {
    let text = SHIFT_JIS.decode_without_bom_handling_and_without_replacement(bytes)?;
    let letters: Vec<char> = text.chars().collect();
    let is_kanji = |letter: &char| ('\u{4e00}'..='\u{9fff}').contains(letter);
    let is_word = letters.windows(2).any(|pair| pair.iter().all(is_kanji))
        || letters.iter().any(|letter| ('\u{3041}'..='\u{30ff}').contains(letter));
    is_word.then(|| text.into_owned())
}

/// Lines that end in LF, CRLF or CR.
fn lines(text: &str) -> impl Iterator<Item = &str> {
    text.split('\n').flat_map(|line| line.strip_suffix('\r').unwrap_or(line).split('\r'))
}

/// The cells of a line, without blanks and quotes around them; `None` where a quote stays open.
fn split(line: &str, separator: Option<u8>) -> Option<Vec<String>> {
    let Some(separator) = separator else {
        let mut cells: Vec<String> = Vec::new();
        for cell in line.split_whitespace() {
            match cells.last_mut() {
                // The unit of the name before it.
                Some(name) if is_bracketed(cell) => *name = format!("{name} {cell}"),
                _ => cells.push(cell.trim_matches('"').to_owned()),
            }
        }
        return Some(cells);
    };
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(separator)
        .has_headers(false)
        .flexible(true)
        .buffer_capacity(line.len() + 1)
        .from_reader(line.as_bytes());
    let mut record = csv::StringRecord::new();
    // A quote that stays open takes up the end of the line.
    let open = line.matches('"').count() % 2 == 1
        && line
            .split(char::from(separator))
            .any(|cell| cell.trim_start().starts_with('"') && cell.matches('"').count() % 2 == 1);
    if open {
        return None;
    }
    reader.read_record(&mut record).ok()?;
    // A tabulator within a cell is another separator.
    Some(record.iter().map(|cell| cell.trim_matches(' ').to_owned()).collect())
}

fn is_bracketed(cell: &str) -> bool {
    cell.starts_with('[') && cell.ends_with(']') || cell.starts_with('(') && cell.ends_with(')')
}

/// Whether decimals stand behind a comma; `1,234` alone may be more than a thousand.
fn has_decimal_commas(rows: &[Row]) -> bool {
    let cells = || rows.iter().flat_map(|row| &row.cells);
    let has = |comma: bool, mark: char| {
        cells().any(|cell| cell.contains(mark) && matches!(number(cell, comma), Number::Value(_)))
    };
    let groups = |cell: &String| {
        cell.split_once(',').is_none_or(|(_, rest)| rest.split(',').all(|part| part.len() == 3))
    };
    let all_group =
        cells().filter(|cell| matches!(number(cell, true), Number::Value(_))).all(groups);
    has(true, ',') && !has(false, '.') && !all_group
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet(text: &str) -> Sheet {
        read("a.csv", "a", text.as_bytes()).expect("a table")
    }

    #[test]
    fn separators_and_decimals_are_found_out() {
        let semicolons = sheet("t (ms);y (cm)\n0;18,4\n1,5;18,2\n");
        assert_eq!((semicolons.separated, semicolons.decimal_comma), ("semicolons", true));
        assert_eq!(sheet("t\ty\n0\t1,5\n1\t1,6\n").separated, "tabs");
        assert_eq!(sheet("t,y\n0,1.5\n1,1.6\n").separated, "commas");
        let blanks = sheet("# t y\n0:00:00:00  866,00 320,00 \n0:00:00:03 847,00 321,00 \n");
        assert_eq!((blanks.separated, blanks.decimal_comma), ("blanks", true));
    }

    #[test]
    fn line_ends_marks_and_encodings_change_nothing() {
        let plain = sheet("t,y\n0,1.5\n1,1.6\n").rows;
        assert_eq!(sheet("\u{feff}t,y\r\n0,1.5\r\n1,1.6").rows, plain);
        assert_eq!(sheet("t,y\r0,1.5\r1,1.6\r\r").rows, plain);
        let wide: Vec<u8> =
            "\u{feff}t,y\n0,1.5\n1,1.6\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
        assert_eq!(read("a.csv", "a", &wide).expect("a table").rows, plain);
        assert_eq!(read("a.csv", "a", &wide[2..]).expect("a table").rows, plain);
        let (bytes, ..) = SHIFT_JIS.encode("\u{6642}\u{9593},\u{9ad8}\u{3055}\n0,1.5\n");
        let japanese = read("a.csv", "a", &bytes).expect("a table");
        assert_eq!(japanese.rows[0].cells, ["\u{6642}\u{9593}", "\u{9ad8}\u{3055}"]);
        let latin = read("a.csv", "a", b"Slice n\xb0,Y \x96\n1,2\n").expect("a table");
        assert_eq!(latin.rows[0].cells, ["Slice n°", "Y –"]);
        assert_eq!(latin.notes.len(), 1);
    }

    #[test]
    fn numbers_of_rows_and_stamps_of_a_monitor_are_no_cells() {
        let plain = sheet("t,y\n0,1.5\n1,1.6\n").rows;
        assert_eq!(sheet("\"t\" \"y\"\n\"1\" 0 1.5\n\"2\" 1 1.6\n").rows, plain);
        let stamped = "10:00:00.1 -> t,y\n10:00:00.2 -> 0,1.5\n10:00:00.3 -> 1,1.6\n";
        assert_eq!(sheet(stamped).rows, plain);
    }

    #[test]
    fn an_open_quote_is_told_with_its_line() {
        let fault = read("a.csv", "a", b"t,y\n0,\"1.5\n1,2\n2,3\n").expect_err("a quote");
        assert_eq!(fault.line, Some(2));
        assert!(read("a.csv", "a", b"PK\x03\x04\0\0").is_err());
    }
}
