//! The theory for a paper: displays of LaTeX with amsmath.

use std::fmt::Write as _;

use crate::language::latex::aligned;
use crate::language::latex::in_text;
use crate::theory::description::{Entry, Section, Theory};
use crate::theory::folded::folded_outside;
use crate::words::visible::one_line;
use crate::words::words::short;

/// The largest number of characters on a line of source, about the width of a page.
const WIDTH: usize = 140;

/// A display for each section, with a comment above it; sentences are written as comments below it.
pub(crate) fn written(theory: &Theory<'_>) -> String {
    let mut page = format!("% {}: theory (needs amsmath)\n", one_line(&theory.title));
    for section in &theory.sections {
        // Writing to a string cannot fail.
        let _ = write!(page, "\n% {}\n", section.title);
        if let Some(display) = display(section) {
            let _ = writeln!(page, "{display}");
        }
        for entry in &section.entries {
            for words in &entry.words {
                let of = entry.name.as_ref().map_or_else(String::new, |name| format!("{name}: "));
                let _ = writeln!(page, "% {of}{words}");
            }
        }
    }
    page
}

/// The formulas of a section, if it has any.
pub(crate) fn display(section: &Section<'_>) -> Option<String> {
    let names = section.names.iter().flat_map(|(name, value)| formula(&name.latex, &value.latex, ""));
    let lines: Vec<String> = names.chain(section.entries.iter().flat_map(lines)).collect();
    (!lines.is_empty()).then(|| aligned(&lines))
}

fn lines(entry: &Entry<'_>) -> Vec<String> {
    let verdict = entry.verdict.map_or_else(String::new, |(subject, verdict)| {
        let subject = subject.map_or_else(String::new, |subject| format!("{subject} "));
        format!(" && \\text{{{}}}", in_text(&format!("{subject}{}", verdict.in_words())))
    });
    let values = entry.values.iter().map(|(name, value)| (latex_name(name), short(*value, 6)));
    let formulas = entry.formulas.iter().map(|(left, right)| (left.latex.clone(), right.latex.clone()));
    let mut lines: Vec<String> = Vec::new();
    for (i, (left, right)) in formulas.chain(values).enumerate() {
        lines.extend(formula(&left, &right, if i == 0 { &verdict } else { "" }));
    }
    if lines.is_empty() && !verdict.is_empty() {
        lines.push(format!(" {verdict}"));
    }
    lines
}

/// The formula `left = right` on as many lines as needed, followed by `end`.
fn formula(left: &str, right: &str, end: &str) -> Vec<String> {
    let parts = folded_outside(right, WIDTH);
    let line = |(j, part): (usize, &String)| {
        let start = if j == 0 { format!("  {left} &= ") } else { "  &\\quad ".to_owned() };
        format!("{start}{part}{}", if j + 1 == parts.len() { end } else { "" })
    };
    parts.iter().enumerate().map(line).collect()
}

/// A name of the model, written as a symbol.
fn latex_name(name: &str) -> String {
    pc_mech::Graph::new().symbol(name).display(pc_mech::Style::Latex)
}
