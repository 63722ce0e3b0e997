//! The theory as text.

use crate::language::text::underlined;
use crate::theory::description::{Entry, Section, Theory};
use crate::theory::folded::folded;
use crate::words::lines::columns;
use crate::words::visible::one_line;
use crate::words::words::{short, wrapped};

/// The largest number of columns of a line.
const WIDTH: usize = 100;

/// The titles, each with its entries below.
pub(crate) fn written(theory: &Theory<'_>) -> String {
    let section = |section: &Section<'_>| {
        let names = section
            .names
            .iter()
            .flat_map(|(name, value)| indented(&format!("{} = {}", name.book, value.book), false));
        let lines = names.chain(section.entries.iter().flat_map(lines));
        let lines: String = lines.map(|line| format!("  {line}\n")).collect();
        format!("{}\n{lines}", section.title)
    };
    let sections: Vec<String> = theory.sections.iter().map(section).collect();
    underlined(&format!("{}: theory", one_line(&theory.title))) + &sections.join("\n")
}

/// The lines of an entry: its name and its formulas with their verdict, followed by the remaining lines,
/// indented further.
fn lines(entry: &Entry<'_>) -> Vec<String> {
    let mut verdict = entry.verdict.map(|(subject, verdict)| match subject {
        None => verdict.in_words(),
        Some(subject) => format!("{subject} {}", verdict.in_words()),
    });
    let name = entry.name.as_ref().map_or_else(String::new, |name| format!("{name}: "));
    let mut heads: Vec<String> =
        entry.formulas.iter().map(|(left, right)| format!("{} = {}", left.book, right.book)).collect();
    if let Some(first) = heads.first_mut()
        && let Some(verdict) = verdict.take()
    {
        *first += &format!("   ({verdict})");
    }
    let values = entry.values.iter().map(|(name, value)| format!("{name} = {}", short(*value, 6)));
    heads.extend(wrapped(values, WIDTH - 10));
    if let Some(first) = heads.first_mut() {
        *first = name + first;
    }
    let mut all: Vec<String> = heads.iter().enumerate().flat_map(|(i, line)| indented(line, i > 0)).collect();
    let margin = if heads.is_empty() { "" } else { "    " };
    let mut words = entry.words.clone();
    if let Some(verdict) = verdict {
        match words.first_mut() {
            Some(first) => *first = format!("{verdict}: {first}"),
            None => words.push(verdict),
        }
    }
    for words in words {
        let parts = in_lines(&words, WIDTH - margin.len());
        all.extend(
            parts
                .into_iter()
                .enumerate()
                .map(|(i, line)| format!("{margin}{}{line}", if i == 0 { "" } else { "  " })),
        );
    }
    all
}

/// The words, divided into lines of at most `width` characters.
fn in_lines(words: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in words.split(' ') {
        let line = lines.len() - 1;
        if !lines[line].is_empty() && columns(&lines[line]) + 1 + columns(word) > width {
            lines.push(word.to_owned());
        } else {
            let space = if lines[line].is_empty() { "" } else { " " };
            lines[line] += &format!("{space}{word}");
        }
    }
    lines
}

/// The line, broken if it is long, and indented if `further` is set.
fn indented(line: &str, further: bool) -> Vec<String> {
    let margin = if further { "    " } else { "" };
    let parts = if columns(line) <= WIDTH { vec![line.to_owned()] } else { folded(line, WIDTH) };
    let all = parts.into_iter().enumerate();
    all.map(|(i, part)| if i == 0 { format!("{margin}{part}") } else { format!("{margin}      {part}") })
        .collect()
}
