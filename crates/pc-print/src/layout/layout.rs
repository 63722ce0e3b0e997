//! The layout of a page of equations.

use crate::words::lines::columns;

/// The layout of a page of equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// The width of a line, in columns.
    pub width: usize,
    /// Whether equations in text are cut off after their first line.
    pub brief: bool,
    /// Whether definitions of the model are written out.
    pub inline: bool,
    /// Whether all reactions are printed, as formulas and as forces.
    pub reactions: bool,
    /// Whether brackets are printed by their coefficients c_rs^m, the symbols γ_rs^m of Boltzmann and Hamel.
    pub symbols: bool,
}

impl Default for Layout {
    fn default() -> Layout {
        Layout { width: 100, brief: false, inline: false, reactions: false, symbols: false }
    }
}

/// Left-hand sides wider than this are not padded.
const WIDEST_PADDED: usize = 24;
/// The greatest indentation of a continuation line.
const DEEPEST: usize = 32;
/// The indentation of a continuation line for which there is no room to the right of the equals sign.
const HANGING: usize = 4;
/// Left-hand sides wider than this are put on a line of their own.
const LONG_LEFT: usize = 60;

impl Layout {
    /// The number of columns available between two signs.
    pub(crate) fn room(&self) -> usize {
        self.width.saturating_sub(24).max(24)
    }

    /// The equations `left = right`, each side a list of terms, with aligned equals signs except after long
    /// left-hand sides.
    pub(crate) fn aligned(&self, equations: &[(Vec<String>, Vec<String>)]) -> Vec<String> {
        let wide = |(left, _): &(Vec<String>, Vec<String>)| columns(&left.join(" "));
        let width = equations.iter().map(wide).filter(|&width| width <= WIDEST_PADDED).max().unwrap_or(0);
        equations.iter().flat_map(|(left, right)| self.equation(left, right, width)).collect()
    }

    fn equation(&self, left: &[String], right: &[String], padding: usize) -> Vec<String> {
        let whole = left.join(" ");
        if columns(&whole) <= LONG_LEFT {
            return self.flowed(&format!("{whole:padding$} = "), right);
        }
        let mut lines = self.flowed("", left);
        let equals = format!("{:HANGING$}= ", "");
        let together = lines.last().filter(|_| lines.len() == 1);
        match together.map(|left| format!("{left} = {}", right.join(" "))) {
            Some(line) if columns(&line) <= self.width => vec![line],
            _ => {
                lines.extend(self.flowed(&equals, right));
                lines
            }
        }
    }

    /// The terms one after the other, on as many lines as needed, the first of which begins with `head`.
    pub(crate) fn flowed(&self, head: &str, terms: &[String]) -> Vec<String> {
        let indent = if columns(head) <= DEEPEST && !head.is_empty() { columns(head) } else { HANGING };
        let mut lines = vec![head.to_owned()];
        let mut started = false;
        for term in terms {
            let Some(line) = lines.last_mut() else { break };
            if !started && (columns(line) + columns(term) <= self.width || columns(head) <= HANGING) {
                line.push_str(term);
            } else if !started {
                line.truncate(line.trim_end().len());
                lines.push(format!("{:HANGING$}{term}", ""));
            } else if columns(line) + 1 + columns(term) <= self.width {
                line.push(' ');
                line.push_str(term);
            } else if self.brief {
                line.push_str(" …");
                break;
            } else if indent + columns(term) <= self.width {
                lines.push(format!("{:indent$}{term}", ""));
            } else {
                lines.push(format!("{:HANGING$}{term}", ""));
            }
            started = true;
        }
        lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn terms(text: &str) -> Vec<String> {
        text.split('|').map(str::to_owned).collect()
    }

    #[test]
    fn short_equations_stand_under_each_other() {
        let layout = Layout::default();
        let lines = layout.aligned(&[(terms("x'"), terms("a|+ b")), (terms("phi'"), terms("-c"))]);
        assert_eq!(lines, ["x'   = a + b", "phi' = -c"]);
    }

    #[test]
    fn long_sides_go_on_under_their_first_term() {
        let layout = Layout { width: 20, ..Layout::default() };
        let lines = layout.aligned(&[(terms("x'"), terms("aaaaaaaa|+ bbbb|- cccc|+ d"))]);
        assert_eq!(lines, ["x' = aaaaaaaa + bbbb", "     - cccc + d"]);
        let brief = Layout { brief: true, ..layout };
        assert_eq!(
            brief.aligned(&[(terms("x'"), terms("aaaaaaaa|+ bbbb|- cccc"))]),
            ["x' = aaaaaaaa + bbbb …"]
        );
    }

    #[test]
    fn a_long_left_side_has_lines_of_its_own() {
        let layout = Layout { width: 64, ..Layout::default() };
        let long = "a".repeat(61);
        assert_eq!(layout.aligned(&[(vec![long.clone()], terms("b|+ c"))]), [long, "    = b + c".to_owned()]);
    }
}
