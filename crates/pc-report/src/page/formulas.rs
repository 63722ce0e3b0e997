//! Formulas, each with its source to copy.

use pc_print::{Display, DisplayedPart};

use crate::page::html::{lines, text};

/// A `math` element in a box that scrolls by itself, reached by the keyboard.
pub(super) fn formula(mathml: &str, label: &str) -> String {
    format!(
        "<div class=\"formula\" tabindex=\"0\" role=\"region\" aria-label=\"{}\">{mathml}</div>\n",
        text(label)
    )
}

/// The source for a paper.
pub(super) fn source(latex: &str) -> String {
    format!(
        "<details><summary>LaTeX</summary><pre tabindex=\"0\"><code>{}</code></pre></details>\n",
        lines(latex)
    )
}

/// Parts under headings of a level, called `of`.
pub(super) fn parts(list: &[DisplayedPart], level: u8, of: &str) -> String {
    list.iter().map(|part| self::part(part, level, of)).collect()
}

fn part(part: &DisplayedPart, level: u8, of: &str) -> String {
    let DisplayedPart { title, display, notes } = part;
    let mut shown = format!("<h{level}>{title}</h{level}>\n");
    let label = if of.is_empty() { (*title).to_owned() } else { format!("{title}: {of}") };
    if let Some(Display { mathml, latex }) = display {
        shown += &formula(mathml, &label);
        shown += &source(latex);
    }
    shown + &notes.iter().map(|note| format!("<p class=\"soft\">{}</p>\n", text(note))).collect::<String>()
}
