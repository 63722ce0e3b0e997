//! The part of a page on the theory of the motions.

use pc_print::{DisplayedEntry, DisplayedEquation, DisplayedTheory};

use crate::page::formulas::{meanings, source};
use crate::page::html::text;
use crate::page::terms::equations;
use crate::picture::plane;

/// Formulas that take more bytes than this are left to `pc theory`.
const LONGEST: usize = 60_000;

/// Parts that take more bytes than this are left out too, so that a page is not too long.
const LONGEST_PART: usize = 90_000;

/// The parts of the theory, each under a heading.
pub(super) fn theory(parts: &[DisplayedTheory]) -> String {
    let mut theory = Shown::default();
    parts.iter().map(|part| theory.part(part)).collect()
}

/// What is shown so far.
#[derive(Default)]
struct Shown {
    /// The names whose meanings are not on the page: formulas that use them would say nothing.
    unknown: Vec<String>,
}

impl Shown {
    fn part(&mut self, part: &DisplayedTheory) -> String {
        let mut shown = format!("<h3>{}</h3>\n", text(part.title));
        let names = meanings(&part.names);
        if names.len() > LONGEST {
            self.unknown.extend(part.names.iter().map(|name| name.left.clone()));
        } else {
            shown += &names;
        }
        for (number, entry) in (1..).zip(&part.entries) {
            shown += &self.entry(entry, &format!("{}-{number}", part.key));
        }
        if let Some(latex) = part.latex.as_ref().filter(|latex| latex.len() <= LONGEST) {
            shown += &source(latex);
        }
        if shown.len() <= LONGEST_PART {
            return shown;
        }
        self.unknown.extend(part.names.iter().map(|name| name.left.clone()));
        format!(
            "<h3>{}</h3>\n<p>It is too long to be shown here; pc theory prints it.</p>\n",
            text(part.title)
        )
    }

    /// The formulas, unless they are too long, or use names that are.
    fn formulas(&self, list: &[DisplayedEquation]) -> String {
        if list.is_empty() {
            return String::new();
        }
        let is_unknown = |side: &String| self.unknown.iter().any(|name| side.contains(name));
        let shown = equations(list);
        if shown.len() > LONGEST {
            return "<p>The formula is too long to be shown here; pc theory prints it.</p>\n".to_owned();
        }
        if list.iter().any(|equation| is_unknown(&equation.left) || is_unknown(&equation.right)) {
            return "<p>The formula is written with names whose meanings are too long to be shown here; pc theory prints \
                    them.</p>\n"
                .to_owned();
        }
        shown
    }

    fn entry(&self, entry: &DisplayedEntry, id: &str) -> String {
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
        shown += &self.formulas(&entry.formulas);
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
}
