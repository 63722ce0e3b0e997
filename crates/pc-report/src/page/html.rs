//! Elements of a page, and text whose markup characters are escaped.

use pc_print::{one_line, visible, visible_json};
use serde_json::Value;

use crate::base64::base64;

/// Text on one line, for use between elements or within quotation marks.
pub fn text(text: &str) -> String {
    escaped(&one_line(text))
}

/// Text on several lines, for use between elements.
pub(crate) fn lines(text: &str) -> String {
    escaped(&visible(text))
}

fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe += "&amp;",
            '<' => safe += "&lt;",
            '>' => safe += "&gt;",
            '"' => safe += "&quot;",
            '\'' => safe += "&#39;",
            // Not among the characters of XML.
            '\u{fffe}' | '\u{ffff}' => safe.push('\u{fffd}'),
            c => safe.push(c),
        }
    }
    safe
}

/// A part of a page, with a heading to which the table of contents links.
pub(crate) struct Part {
    pub(crate) id: &'static str,
    pub(crate) title: &'static str,
    pub(crate) body: String,
}

impl Part {
    pub(crate) fn new(id: &'static str, title: &'static str, body: String) -> Part {
        Part { id, title, body }
    }

    pub(crate) fn section(&self) -> String {
        let Part { id, title, body } = self;
        format!(
            "<section id=\"{id}\" aria-labelledby=\"{id}-h\">\n<h2 id=\"{id}-h\">{title}</h2>\n{body}</section>\n"
        )
    }
}

/// A paragraph.
pub(crate) fn paragraph(words: &str) -> String {
    format!("<p>{}</p>\n", text(words))
}

/// A table of labels, each with its lines.
pub(crate) fn described<L: AsRef<str>>(entries: &[(L, Vec<String>)]) -> String {
    let entry = |(label, all): &(L, Vec<String>)| {
        let all: Vec<String> = all.iter().map(|line| text(line)).collect();
        format!("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", text(label.as_ref()), all.join("<br/>"))
    };
    format!(
        "<div class=\"scroll\"><table class=\"facts\"><tbody>\n{}</tbody></table></div>\n",
        entries.iter().map(entry).collect::<String>()
    )
}

/// Data for a script: JSON that contains neither `</script>` nor the end of a CDATA section.
pub fn data(value: &Value) -> String {
    visible_json(value).replace('<', "\\u003c").replace('>', "\\u003e").replace('&', "\\u0026")
}

/// The ids of the data of plots and of the player, by which their scripts find them.
pub(super) const PLOTS: &str = "plots-data";
pub(super) const PLAYER: &str = "player-data";

/// A page without external resources.
pub(crate) fn page(title: &str, body: &str) -> String {
    let title = text(title);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n\
         <meta name=\"color-scheme\" content=\"light dark\"/>\n<title>{title}</title>\n<style>\n{STYLE}{}{}{}</style>\n</head>\n\
         <body>\n{body}</body>\n</html>\n",
        if body.contains("<math") { of_formulas() } else { String::new() },
        if body.contains(PLOTS) { OF_PLOTS } else { "" },
        if body.contains(PLAYER) { OF_VIEWER } else { "" }
    )
}

const STYLE: &str = include_str!("style.css");
const OF_PLOTS: &str = include_str!("../../plots/dist/plots.css");
const OF_VIEWER: &str = include_str!("viewer.css");

/// The style of pages that may have formulas, plots and a viewer.
pub fn style() -> String {
    format!("{STYLE}{}{OF_PLOTS}{OF_VIEWER}", of_formulas())
}

/// The style of formulas, with their font: browsers without a mathematical font of their own would set roots
/// and brackets in pieces that do not fit.
fn of_formulas() -> String {
    let font = base64(include_bytes!("../../fonts/STIXTwoMath-subset.woff2"));
    format!(
        "@font-face {{ font-family: \"pc formulas\"; src: url(data:font/woff2;base64,{font}) format(\"woff2\"); }}\n{}",
        include_str!("formulas.css")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_no_markup() {
        assert_eq!(
            text("</title><script>alert('x')</script>&"),
            "&lt;/title&gt;&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt;&amp;"
        );
        assert_eq!(text("a\n\u{202e}b\u{ffff}"), "a \u{fffd}b\u{fffd}");
        assert_eq!(lines("a\n<b>\u{1b}"), "a\n&lt;b&gt;\u{fffd}");
    }
}
