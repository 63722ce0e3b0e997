//! The part of a page on the theory of the motions.

use pc_print::{DisplayedEntry, DisplayedTheory};

use crate::page::formulas::{formula, source};
use crate::page::html::text;
use crate::picture::plane;

/// Formulas that take more bytes than this are left to `pc theory`.
const LONGEST: usize = 60_000;

/// Parts that take more bytes than this are left out too, so that a page is not too long.
const LONGEST_PART: usize = 90_000;

/// The parts of the theory, each under a heading.
pub(super) fn theory(parts: &[DisplayedTheory]) -> String {
    parts.iter().map(part).collect()
}

fn part(part: &DisplayedTheory) -> String {
    let mut shown = format!("<h3>{}</h3>\n", text(part.title));
    match &part.names {
        Some(names) if names.len() > LONGEST => {
            shown +=
                "<p>The meanings of the names z are too long to be shown here; pc theory prints them.</p>\n";
        }
        Some(names) => shown += &formula(names),
        None => {}
    }
    for (number, entry) in (1..).zip(&part.entries) {
        shown += &self::entry(entry, &format!("{}-{number}", part.key));
    }
    if let Some(latex) = part.latex.as_ref().filter(|latex| latex.len() <= LONGEST) {
        shown += &source(latex);
    }
    if shown.len() <= LONGEST_PART {
        return shown;
    }
    format!("<h3>{}</h3>\n<p>It is too long to be shown here; pc theory prints it.</p>\n", text(part.title))
}

fn entry(entry: &DisplayedEntry, id: &str) -> String {
    let mut head = String::new();
    if let Some(name) = &entry.name {
        head += &format!("<span class=\"name\">{}</span> ", text(name));
    }
    if let Some(verdict) = &entry.verdict {
        let class = match verdict {
            verdict if verdict.contains("disproved") => "verdict disproved",
            verdict if verdict.contains("proved") => "verdict proved",
            _ => "verdict",
        };
        head += &format!("<span class=\"{class}\">{}</span>", text(verdict));
    }
    // Formulas without further results share a display.
    let is_plain = head.is_empty() && entry.values.is_empty() && entry.words.is_empty();
    let class = if is_plain { "entry plain" } else { "entry" };
    let mut shown = format!("<div class=\"{class}\">\n");
    if !head.is_empty() {
        shown += &format!("<p>{head}</p>\n");
    }
    match &entry.mathml {
        Some(mathml) if mathml.len() > LONGEST => {
            shown += "<p>The formula is too long to be shown here; pc theory prints it.</p>\n";
        }
        Some(mathml) => shown += &formula(mathml),
        None => {}
    }
    if !entry.values.is_empty() {
        shown += &format!("<p>{}</p>\n", text(&entry.values.join(", ")));
    }
    shown += &entry
        .words
        .iter()
        .map(|words| format!("<p class=\"soft\">{}</p>\n", text(words)))
        .collect::<String>();
    if !entry.spectrum.is_empty() {
        shown += &plane::figure(&entry.spectrum, id);
    }
    shown + "</div>\n"
}
