//! The theory for people.

use crate::lines::columns;
use crate::text::underlined;
use crate::theory::description::{Entry, Theory};
use crate::theory::folded::folded;
use crate::words::{short, wrapped};

/// The most columns of a line.
const WIDTH: usize = 100;

/// Titles with the entries under them.
pub(crate) fn written(theory: &Theory) -> String {
    let section = |section: &crate::theory::description::Section| {
        let lines = section.entries.iter().flat_map(lines);
        let lines: String = lines.map(|line| format!("  {line}\n")).collect();
        format!("{}\n{lines}", section.title)
    };
    let sections: Vec<String> = theory.sections.iter().map(section).collect();
    underlined(&format!("{}: theory", theory.title)) + &sections.join("\n")
}

/// Name, formulas and verdict, then what else is said, further in.
fn lines(entry: &Entry) -> Vec<String> {
    let verdict = entry.verdict.map(|(subject, verdict)| match subject {
        None => verdict.in_words(),
        Some(subject) => format!("{subject} {}", verdict.in_words()),
    });
    let name = entry.name.as_ref().map_or_else(String::new, |name| format!("{name}: "));
    let mut heads: Vec<String> =
        entry.formulas.iter().map(|(left, right)| format!("{} = {}", left.book, right.book)).collect();
    if !entry.values.is_empty() {
        let values = entry.values.iter().map(|(name, value)| format!("{name} = {}", short(*value, 6)));
        heads.extend(wrapped(values, WIDTH - 20));
    }
    if let Some(first) = heads.first_mut() {
        *first = name + first;
        if let Some(verdict) = &verdict {
            // Behind the formula it is on.
            *first += &format!("   ({verdict})");
        }
    }
    let mut words = entry.words.iter();
    let mut all: Vec<String> = heads.iter().enumerate().flat_map(|(i, line)| indented(line, i > 0)).collect();
    if heads.is_empty() {
        let first = words.next().cloned();
        all.extend(match (first, verdict) {
            (Some(words), Some(verdict)) => Some(format!("{verdict}: {words}")),
            (words, verdict) => words.or(verdict),
        });
    }
    all.extend(words.map(|words| format!("    {words}")));
    all
}

/// The line, broken where it is long, all of it further in if it is not the first.
fn indented(line: &str, further: bool) -> Vec<String> {
    let margin = if further { "    " } else { "" };
    let parts = if columns(line) <= WIDTH { vec![line.to_owned()] } else { folded(line, WIDTH) };
    let all = parts.into_iter().enumerate();
    all.map(|(i, part)| if i == 0 { format!("{margin}{part}") } else { format!("{margin}      {part}") })
        .collect()
}
