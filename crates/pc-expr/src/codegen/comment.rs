//! Text for comments and strings.

/// `text` on one line, without anything that ends or breaks a comment.
pub(crate) fn comment(text: &str) -> String {
    let visible = |c: char| if c.is_whitespace() || is_hidden(c) { ' ' } else { c };
    let mut text: String = text.chars().map(visible).collect();
    // The ends of a comment, and the trigraphs of C.
    for (sign, apart) in [("*/", "* /"), ("/*", "/ *"), ("??", "? ?")] {
        while text.contains(sign) {
            text = text.replace(sign, apart);
        }
    }
    // A backslash at the end of a line joins the next one to it.
    text.trim().trim_end_matches('\\').trim_end().to_owned()
}

/// Whether this is a control character or changes the direction of writing.
pub(crate) fn is_hidden(c: char) -> bool {
    !matches!(c, '\'' | '"' | '\\') && c.escape_debug().len() > 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_stay_comments() {
        assert_eq!(comment("a */ b\n/* c \u{202e}\\"), "a * / b / * c");
        assert_eq!(comment("???"), "? ? ?");
    }
}
