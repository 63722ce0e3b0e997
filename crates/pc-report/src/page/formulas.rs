//! Formulas, each with its source for copying.

use pc_print::{Display, DisplayedEquation, DisplayedPart};

use crate::page::html::{lines, text};
use crate::page::terms::{are_narrow, equations};

/// The meanings of names, with what precedes them.
pub(super) fn meanings(names: &[DisplayedEquation]) -> String {
    let sentence = match names {
        [] => return String::new(),
        [_] => "This name stands for an expression in the formulas below:",
        _ => "These names stand for expressions in the formulas below:",
    };
    format!("<p class=\"soft\">{sentence}</p>\n{}", equations(names))
}

/// The LaTeX source, hidden until it is opened.
pub(super) fn source(latex: &str) -> String {
    format!(
        "<details><summary>LaTeX</summary><pre tabindex=\"0\"><code>{}</code></pre></details>\n",
        lines(latex)
    )
}

/// Parts under headings of the given level: short ones in pairs beside each other, where the page is wide.
pub(super) fn parts(list: &[DisplayedPart], level: u8) -> String {
    let mut shown = String::new();
    let mut single: Option<String> = None; // a short part that waits for another
    for part in list {
        let body = self::part(part, level);
        if !is_narrow(part) {
            shown += &single.take().unwrap_or_default();
            shown += &body;
        } else if let Some(first) = single.take() {
            shown += &format!("<div class=\"pair\">\n{}{}</div>\n", of_two(&first), of_two(&body));
        } else {
            single = Some(body);
        }
    }
    shown + &single.unwrap_or_default()
}

fn of_two(part: &str) -> String {
    format!("<div>\n{part}</div>\n")
}

fn is_narrow(part: &DisplayedPart) -> bool {
    part.display.as_ref().is_none_or(|display| are_narrow(&display.names) && are_narrow(&display.equations))
}

fn part(part: &DisplayedPart, level: u8) -> String {
    let DisplayedPart { title, display, notes } = part;
    let mut shown = format!("<h{level}>{title}</h{level}>\n");
    if let Some(Display { names, equations: list, latex, .. }) = display {
        shown += &meanings(names);
        if !list.is_empty() {
            shown += &equations(list);
        }
        shown += &source(latex);
    }
    shown + &notes.iter().map(|note| format!("<p class=\"soft\">{}</p>\n", text(note))).collect::<String>()
}
