//! Formulas, each with its source for copying.

use std::borrow::Cow;

use pc_print::{Display, DisplayedPart};

use crate::page::html::{lines, text};

/// The number of lines of a formula that are kept together: page breaks fall between such parts, and a part
/// longer than a page would be cut.
const LINES: usize = 10;

/// A formula in a box that scrolls separately; browsers make such boxes accessible from the keyboard.
pub(super) fn formula(mathml: &str) -> String {
    format!("<div class=\"formula\">{}</div>\n", in_parts(mathml))
}

/// A long table of lines, divided into several tables.
fn in_parts(mathml: &str) -> Cow<'_, str> {
    let (Some(start), Some(end)) = (mathml.find("<mtr>"), mathml.rfind("</mtr>")) else {
        return mathml.into();
    };
    let (head, lines, tail) =
        (&mathml[..start], &mathml[start..end + "</mtr>".len()], &mathml[end + "</mtr>".len()..]);
    let lines: Vec<&str> = lines.split_inclusive("</mtr>").collect();
    if lines.len() <= LINES {
        return mathml.into();
    }
    lines.chunks(LINES).map(|part| format!("{head}{}{tail}", part.concat())).collect::<String>().into()
}

/// The LaTeX source, hidden until it is opened.
pub(super) fn source(latex: &str) -> String {
    format!(
        "<details><summary>LaTeX</summary><pre tabindex=\"0\"><code>{}</code></pre></details>\n",
        lines(latex)
    )
}

/// Parts under headings of the given level.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_table_is_divided() {
        let table = |lines: std::ops::Range<usize>| {
            let lines: String = lines.map(|i| format!("<mtr><mtd>{i}</mtd></mtr>")).collect();
            format!("<math display=\"block\"><mtable>{lines}</mtable></math>")
        };
        assert_eq!(in_parts(&table(0..10)), table(0..10));
        assert_eq!(in_parts(&table(0..30)), table(0..10) + &table(10..20) + &table(20..30));
        assert_eq!(in_parts("<math><mi>x</mi></math>"), "<math><mi>x</mi></math>");
    }
}
