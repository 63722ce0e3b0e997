//! Characters that are not seen, and do something all the same.

/// Control characters, ends of lines and paragraphs, what changes the direction of writing, marks at the beginning of a text,
/// and what no text may contain (XML 1.0, 2.2).
pub fn is_hidden(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{2028}' | '\u{2029}' | '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{feff}')
        || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{fff9}'..='\u{fffb}')
        || matches!(c, '\u{fffe}' | '\u{ffff}')
}
