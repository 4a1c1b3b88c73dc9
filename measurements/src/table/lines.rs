//! The lines of a table, whatever ends them, without comments and empty ones.

use std::io::{self, BufRead};

use thiserror::Error;

/// Longest line that is read (byte).
const LONGEST_LINE: usize = 10_000;

/// Why there is no next line.
#[derive(Debug, Error)]
pub(crate) enum LineFault {
    #[error("the file is UTF-16 or no text; save it as UTF-8")]
    Utf16,
    #[error("line {0} is not UTF-8, perhaps Latin-1; save the file as UTF-8")]
    NotUtf8(u64),
    #[error("line {0} is longer than {LONGEST_LINE} bytes")]
    TooLong(u64),
    #[error("{0}")]
    Io(#[from] io::Error),
}

/// Reads a table line by line: LF, CRLF and CR end a line, a byte order mark is skipped.
pub(crate) struct Lines<R> {
    reader: R,
    number: u64,
    after_cr: bool,
    bytes: Vec<u8>,
}

impl<R: BufRead> Lines<R> {
    pub(crate) fn new(reader: R) -> Self {
        Self { reader, number: 0, after_cr: false, bytes: Vec::new() }
    }

    /// Puts the next line that is neither empty nor a `#` comment into `text` and gives its number,
    /// from 1; `None` at the end.
    pub(crate) fn next(&mut self, text: &mut String) -> Result<Option<u64>, LineFault> {
        loop {
            if !self.fill()? {
                return Ok(None);
            }
            let mut bytes = self.bytes.as_slice();
            if self.number == 1 {
                let utf_16 = bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]);
                if utf_16 || bytes.contains(&0) {
                    return Err(LineFault::Utf16);
                }
                bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
            }
            let line = std::str::from_utf8(bytes).map_err(|_| LineFault::NotUtf8(self.number))?;
            if !line.trim().is_empty() && !line.starts_with('#') {
                text.clear();
                text.push_str(line);
                return Ok(Some(self.number));
            }
        }
    }

    /// Reads one line, without its end, into `bytes`; `false` at the end of the file.
    fn fill(&mut self) -> Result<bool, LineFault> {
        self.bytes.clear();
        self.number += 1;
        let mut anything = false;
        loop {
            let buffer = self.reader.fill_buf()?;
            if buffer.is_empty() {
                return Ok(anything);
            }
            if self.after_cr && buffer[0] == b'\n' {
                self.after_cr = false;
                self.reader.consume(1);
                continue;
            }
            self.after_cr = false;
            anything = true;
            let end = buffer.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
            let part = &buffer[..end.unwrap_or(buffer.len())];
            if self.bytes.len() + part.len() > LONGEST_LINE {
                return Err(LineFault::TooLong(self.number));
            }
            self.bytes.extend_from_slice(part);
            let (length, is_cr) = (part.len(), end.is_some_and(|at| buffer[at] == b'\r'));
            self.reader.consume(length + usize::from(end.is_some()));
            if end.is_some() {
                self.after_cr = is_cr;
                return Ok(true);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(bytes: &[u8]) -> Vec<(u64, String)> {
        // A buffer of three bytes, so that line ends fall between two fillings.
        let mut lines = Lines::new(io::BufReader::with_capacity(3, bytes));
        let (mut text, mut all) = (String::new(), Vec::new());
        while let Some(number) = lines.next(&mut text).expect("readable lines") {
            all.push((number, text.clone()));
        }
        all
    }

    #[test]
    fn every_line_end_gives_the_same_lines_and_numbers() {
        let wanted = [(1, "a,b".to_owned()), (3, "1,2".to_owned()), (5, "3,4".to_owned())];
        for end in ["\n", "\r\n", "\r"] {
            let text = ["a,b", "# a \"comment", "1,2", "", "3,4"].join(end);
            assert_eq!(lines(text.as_bytes()), wanted, "{end:?}");
            assert_eq!(lines(format!("\u{feff}{text}{end}{end}").as_bytes()), wanted, "{end:?}");
        }
    }

    #[test]
    fn a_file_without_a_line_break_does_not_fill_the_memory() {
        let mut lines = Lines::new(io::BufReader::new(io::repeat(b'1')));
        let fault = lines.next(&mut String::new()).expect_err("an endless line");
        assert_eq!(fault.to_string(), "line 1 is longer than 10000 bytes");
    }
}
