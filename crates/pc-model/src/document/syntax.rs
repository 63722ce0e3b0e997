//! The TOML layer: it turns bytes into a table and puts the parser's errors into plain words.

use std::ops::Range;

use toml::de::{DeTable, Error};

use crate::diagnostics::error::ModelError;
use crate::diagnostics::error_kind::ErrorKind;
use crate::diagnostics::source::{Place, Source};

/// The TOML table of a whole file.
pub(super) fn table(source: &Source) -> Result<DeTable<'_>, ModelError> {
    let at = |span: Range<usize>, kind: ErrorKind| source.error(&Place { entry: String::new(), span }, kind);
    if let Some((offset, byte)) = source.damage() {
        return Err(at(offset..offset + 1, ErrorKind::NotText { byte }));
    }
    let root = DeTable::parse(source.text()).map_err(|error| {
        let end = source.text().trim_end().len();
        let span = error.span().filter(|span| span.start < end).unwrap_or(end..end);
        let kind = kind(source, &error, &span);
        at(span, kind)
    })?;
    let root = root.into_inner();
    if root.is_empty() {
        return Err(at(0..0, ErrorKind::Empty));
    }
    Ok(root)
}

fn kind(source: &Source, error: &Error, span: &Range<usize>) -> ErrorKind {
    let message = error.message();
    if message == "duplicate key" {
        return ErrorKind::DuplicateKey { key: source.slice(span.clone()).into() };
    }
    ErrorKind::Toml { message: message.into(), help: help(source, message, span) }
}

/// What was probably meant by the line at `span`.
fn help(source: &Source, message: &str, span: &Range<usize>) -> &'static str {
    let text = source.text();
    let start = text[..text.floor_char_boundary(span.start)].rfind('\n').map_or(0, |newline| newline + 1);
    let line = text[start..].lines().next().unwrap_or_default();
    let value = line.split_once('=').map_or("", |(_, value)| value.trim());
    let found = source.slice(span.clone()).chars().next().unwrap_or_default();
    let key = message.starts_with("invalid unquoted key");
    if message.contains("recurs") {
        "a model needs no such nesting"
    } else if key && !found.is_ascii() {
        "Greek names need quotes as keys: `\"θ\" = 1.0`"
    } else if key && found == '\'' {
        "a velocity needs quotes as a key: `\"x'\" = 1.0`"
    } else if value.starts_with('\'') {
        "write expressions in double quotes; a prime ends a string in single quotes"
    } else if is_decimal_comma(value) {
        "the decimal separator is a point, as in `x = 2.0`"
    } else if message.starts_with("string values must be quoted") {
        "a value is a number, as `x = 1.0`, or a text in double quotes, as `kinetic = \"m/2*v^2\"`"
    } else if message.starts_with("missing escaped value") {
        "expressions need no backslash; in other texts write it twice"
    } else if message.starts_with("invalid basic string") {
        "close the string with `\"` on the same line; a text of several lines stands between `\"\"\"`"
    } else {
        "an entry is written `name = value` on one line, a section begins with `[name]`"
    }
}

/// Whether a value is a number written with a comma, used as a decimal mark or between thousands.
fn is_decimal_comma(value: &str) -> bool {
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let value = value.split('#').next().unwrap_or_default().trim();
    value
        .trim_start_matches(['+', '-'])
        .split_once(',')
        .is_some_and(|(whole, part)| digits(whole) && digits(part))
}
