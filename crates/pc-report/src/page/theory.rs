//! What can be said of the motions.

use pc_print::{DisplayedEntry, DisplayedTheory};

use crate::page::formulas::{formula, source};
use crate::page::html::text;
use crate::picture::plane;

/// Formulas of more bytes are left to `pc theory`.
const LONGEST: usize = 60_000;

/// Each part under a heading.
pub(super) fn theory(parts: &[DisplayedTheory]) -> String {
    parts.iter().map(part).collect()
}

fn part(part: &DisplayedTheory) -> String {
    let mut shown = format!("<h3>{}</h3>\n", text(part.title));
    if let Some(names) = &part.names {
        shown += &formula(names, &format!("{}: names", part.title));
    }
    for (number, entry) in (1..).zip(&part.entries) {
        shown += &self::entry(entry, part.title, &format!("{}-{number}", part.key));
    }
    if let Some(latex) = part.latex.as_ref().filter(|latex| latex.len() <= LONGEST) {
        shown += &source(latex);
    }
    shown
}

fn entry(entry: &DisplayedEntry, title: &str, id: &str) -> String {
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
    let mut shown = String::from("<div class=\"entry\">\n");
    if !head.is_empty() {
        shown += &format!("<p>{head}</p>\n");
    }
    match &entry.mathml {
        Some(mathml) if mathml.len() > LONGEST => {
            shown += "<p>The formula is too long to be shown here; pc theory prints it.</p>\n";
        }
        Some(mathml) => shown += &formula(mathml, entry.name.as_deref().unwrap_or(title)),
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
