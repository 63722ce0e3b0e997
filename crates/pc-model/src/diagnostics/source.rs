//! The text of a model file, and how a place in it is displayed.

use std::ops::Range;

/// A model file: its name as shown in messages, and its text.
#[derive(Clone, Debug, Default)]
pub struct Source {
    name: String,
    text: String,
    /// The offset of the first byte that is not UTF-8, and that byte.
    damage: Option<(usize, u8)>,
}

/// A line and a column, both counted from 1, the column in characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Position {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

/// A place in a model file: the bytes `span`, and the entry to which they belong, such as `[lagrangian]
/// kinetic`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// The section and the entry; empty if there is neither.
    pub entry: String,
    /// Bytes in the file.
    pub span: Range<usize>,
}

/// The number of characters of a long line that are shown before and after the start of the marked text.
const BEFORE: usize = 60;
const AFTER: usize = 100;

impl Source {
    /// A model file whose contents are already text.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self { name: name.into(), text: text.into(), damage: None }
    }

    /// A model file as read from disk. Bytes that are not UTF-8 are refused later, by
    /// [`Document::parse`](crate::Document::parse).
    pub fn from_bytes(name: impl Into<String>, bytes: &[u8]) -> Self {
        let damage = std::str::from_utf8(bytes).err().map(|error| {
            let offset = error.valid_up_to();
            (offset, bytes.get(offset).copied().unwrap_or_default())
        });
        Self { name: name.into(), text: String::from_utf8_lossy(bytes).into_owned(), damage }
    }

    /// Name of the file, as shown in messages.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The whole text.
    pub fn text(&self) -> &str {
        &self.text
    }

    pub(crate) fn damage(&self) -> Option<(usize, u8)> {
        self.damage
    }

    /// The text of a byte range; empty if the range is not in the text.
    pub fn slice(&self, span: Range<usize>) -> &str {
        self.text.get(span).unwrap_or_default()
    }

    /// The line and column of a byte offset; an offset past the end counts as the end.
    pub fn position(&self, offset: usize) -> Position {
        let offset = self.text.floor_char_boundary(offset);
        let before = &self.text[..offset];
        let start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let line = before.bytes().filter(|byte| *byte == b'\n').count() + 1;
        Position { line, column: before[start..].chars().count() + 1 }
    }

    /// The line on which `span` begins, with carets below the part covered by `span`.
    pub(crate) fn excerpt(&self, span: Range<usize>) -> String {
        let start = self.text.floor_char_boundary(span.start);
        let line_start = self.text[..start].rfind('\n').map_or(0, |newline| newline + 1);
        let rest = &self.text[line_start..];
        let line = rest.split('\n').next().unwrap_or_default();
        let line = line.strip_suffix('\r').unwrap_or(line);
        let start = (start - line_start).min(line.len());
        let end = line.ceil_char_boundary(span.end.saturating_sub(line_start)).max(start);

        let from = line[..start].char_indices().rev().nth(BEFORE - 1).map_or(0, |(at, _)| at);
        let to = line[start..].char_indices().nth(AFTER).map_or(line.len(), |(at, _)| start + at);
        let (cut_left, cut_right) = (if from > 0 { "…" } else { "" }, if to < line.len() { "…" } else { "" });
        let shown: String = line[from..to].chars().map(visible).collect();
        let indent: String = cut_left.chars().chain(line[from..start].chars()).map(blank).collect();
        let width: usize = line[start..end.min(to)].chars().map(width).sum();
        format!("    {cut_left}{shown}{cut_right}\n    {indent}{}", "^".repeat(width.max(1)))
    }
}

/// The character in a form that is safe for a terminal.
fn visible(c: char) -> char {
    if c.is_control() && c != '\t' { char::REPLACEMENT_CHARACTER } else { c }
}

/// White space that is as wide as the character.
fn blank(c: char) -> &'static str {
    match (c, width(c)) {
        ('\t', _) => "\t",
        (_, 0) => "",
        (_, 1) => " ",
        _ => "  ",
    }
}

/// The number of columns that the character takes up in a terminal.
fn width(c: char) -> usize {
    match c {
        '\u{300}'..='\u{36f}' | '\u{200b}'..='\u{200f}' | '\u{fe00}'..='\u{fe0f}' | '\u{feff}' => 0,
        '\u{1100}'..='\u{115f}'
        | '\u{2e80}'..='\u{303e}'
        | '\u{3041}'..='\u{a4cf}'
        | '\u{ac00}'..='\u{d7a3}'
        | '\u{f900}'..='\u{faff}'
        | '\u{fe30}'..='\u{fe6f}'
        | '\u{ff00}'..='\u{ff60}'
        | '\u{ffe0}'..='\u{ffe6}'
        | '\u{1f300}'..='\u{1f64f}'
        | '\u{1f680}'..='\u{1f6ff}'
        | '\u{1f900}'..='\u{1f9ff}'
        | '\u{20000}'..='\u{3fffd}' => 2,
        _ => 1,
    }
}
