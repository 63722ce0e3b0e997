//! Translates places in a decoded TOML string back to places in the file.

use std::ops::Range;

/// Maps offsets in the value of a TOML string (or key, or number) to offsets in the file in which it is
/// written.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TextMap {
    pieces: Vec<Piece>,
    /// The offset in the file at which the value ends, before the closing quotes.
    end: usize,
}

/// The bytes `decoded` of the value correspond to the bytes `file`; they are verbatim if the lengths agree,
/// otherwise they are an escape.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Piece {
    decoded: Range<usize>,
    file: Range<usize>,
}

impl TextMap {
    /// The map of the literal `raw`, which begins at offset `start` in the file and has the value `value`.
    pub(crate) fn new(raw: &str, start: usize, value: &str) -> Self {
        let mut scan = Scan::new(raw, start);
        scan.run();
        if scan.decoded == value {
            return Self { pieces: scan.pieces, end: start + scan.at };
        }
        // An unknown kind of literal: the value lies somewhere in it.
        let whole = Piece { decoded: 0..value.len(), file: start..start + raw.len() };
        Self { pieces: vec![whole], end: start + raw.len() }
    }

    /// The map that takes a text to itself.
    pub(crate) fn verbatim(text: &str) -> Self {
        let whole = 0..text.len();
        Self { pieces: vec![Piece { decoded: whole.clone(), file: whole }], end: text.len() }
    }

    /// The map that takes every part of a text of `length` bytes to the same place in the file.
    pub(crate) fn standing_for(place: Range<usize>, length: usize) -> Self {
        Self { end: place.end, pieces: vec![Piece { decoded: 0..length, file: place }] }
    }

    /// The bytes in the file that correspond to these bytes of the value.
    pub fn locate(&self, span: Range<usize>) -> Range<usize> {
        let start = self.place(span.start).map_or(self.end, |(piece, file)| file.unwrap_or(piece.file.start));
        if span.end <= span.start {
            return start..start;
        }
        let end = match self.place(span.end - 1) {
            Some((_, Some(file))) => file + 1,
            Some((piece, None)) => piece.file.end,
            None => self.end,
        };
        start..end.max(start)
    }

    /// The piece that contains an offset, and the offset in the file if the piece is verbatim.
    fn place(&self, offset: usize) -> Option<(&Piece, Option<usize>)> {
        let piece = self.pieces.get(self.pieces.partition_point(|piece| piece.decoded.end <= offset))?;
        let verbatim = piece.decoded.len() == piece.file.len();
        Some((piece, verbatim.then(|| piece.file.start + (offset - piece.decoded.start))))
    }
}

/// A scan of a literal that has already been accepted as TOML.
struct Scan<'a> {
    raw: &'a str,
    start: usize,
    /// The offset in `raw`.
    at: usize,
    decoded: String,
    pieces: Vec<Piece>,
}

impl<'a> Scan<'a> {
    fn new(raw: &'a str, start: usize) -> Self {
        Self { raw, start, at: 0, decoded: String::new(), pieces: Vec::new() }
    }

    fn run(&mut self) {
        let quote = ["\"\"\"", "'''", "\"", "'"].into_iter().find(|quote| self.raw.starts_with(quote));
        let quote = quote.unwrap_or_default();
        self.at = quote.len();
        if quote.len() == 3 {
            let body = &self.raw[self.at..];
            self.at +=
                ["\r\n", "\n"].iter().find(|newline| body.starts_with(**newline)).map_or(0, |n| n.len());
        }
        let body = &self.raw[self.at..];
        let end = self.at + body.strip_suffix(quote).unwrap_or(body).len();
        while self.at < end {
            let rest = &self.raw[self.at..end];
            let verbatim =
                if quote.starts_with('"') { rest.find('\\').unwrap_or(rest.len()) } else { rest.len() };
            if verbatim > 0 {
                self.push(&rest[..verbatim], verbatim);
            } else {
                self.escape(rest);
            }
        }
    }

    fn push(&mut self, value: &str, length: usize) {
        let decoded = self.decoded.len()..self.decoded.len() + value.len();
        let file = self.start + self.at..self.start + self.at + length;
        self.decoded.push_str(value);
        self.pieces.push(Piece { decoded, file });
        self.at += length;
    }

    /// Advances past the escape with which `rest` begins.
    fn escape(&mut self, rest: &str) {
        let mut characters = rest.chars().skip(1);
        let Some(letter) = characters.next() else { return self.push("\\", 1) };
        let digits = match letter {
            'x' => 2,
            'u' => 4,
            'U' => 8,
            _ => 0,
        };
        let value = match letter {
            'b' => Some('\u{8}'),
            'e' => Some('\u{1b}'),
            'f' => Some('\u{c}'),
            'n' => Some('\n'),
            'r' => Some('\r'),
            't' => Some('\t'),
            '\\' | '"' => Some(letter),
            'x' | 'u' | 'U' => rest
                .get(2..2 + digits)
                .and_then(|digits| u32::from_str_radix(digits, 16).ok())
                .and_then(char::from_u32),
            _ => None,
        };
        match value {
            Some(value) => self.push(value.encode_utf8(&mut [0; 4]), 2 + digits),
            // A backslash at the end of a line: it and all following white space are removed.
            None => {
                let space = rest[1..].trim_start_matches([' ', '\t', '\r', '\n']);
                self.at += (rest.len() - space.len()).max(1);
            }
        }
    }
}
