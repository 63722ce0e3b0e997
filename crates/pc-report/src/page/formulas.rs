//! Formulas, each with its source to copy.

use pc_print::{Display, DisplayedPart};

use crate::page::html::{lines, text};

/// A `math` element in a box that scrolls by itself; browsers let the keyboard reach those that do.
pub(super) fn formula(mathml: &str) -> String {
    format!("<div class=\"formula\">{mathml}</div>\n")
}

/// The source for a paper.
pub(super) fn source(latex: &str) -> String {
    format!(
        "<details><summary>LaTeX</summary><pre tabindex=\"0\"><code>{}</code></pre></details>\n",
        lines(latex)
    )
}

/// Parts under headings of a level.
pub(super) fn parts(list: &[DisplayedPart], level: u8) -> String {
    list.iter().map(|part| self::part(part, level)).collect()
}

fn part(part: &DisplayedPart, level: u8) -> String {
    let DisplayedPart { title, display, notes } = part;
    let mut shown = format!("<h{level}>{title}</h{level}>\n");
    if let Some(Display { mathml, latex }) = display {
        shown += &formula(mathml);
        shown += &source(latex);
    }
    shown + &notes.iter().map(|note| format!("<p class=\"soft\">{}</p>\n", text(note))).collect::<String>()
}
