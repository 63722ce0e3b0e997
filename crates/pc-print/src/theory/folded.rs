//! Long formulas broken into several lines.

/// The formula on lines of at most `width` characters, as far as possible; it is broken before a sign of a
/// sum, inside as few brackets as possible. No part of the formula is left out.
pub(crate) fn folded(formula: &str, width: usize) -> Vec<String> {
    broken(formula, width, usize::MAX)
}

/// The formula broken only outside all brackets.
pub(crate) fn folded_outside(formula: &str, width: usize) -> Vec<String> {
    broken(formula, width, 0)
}

fn broken(formula: &str, width: usize, deepest: usize) -> Vec<String> {
    let mut rest: Vec<char> = formula.chars().collect();
    let mut lines = Vec::new();
    while rest.len() > width {
        let places = signs(&rest);
        let within = |depth: usize| {
            places
                .iter()
                .filter(move |&&(place, at)| at == depth && place <= width)
                .map(|&(place, _)| place)
                .max()
        };
        let most = places.iter().map(|&(_, depth)| depth).max().unwrap_or(0).min(deepest);
        // If nothing fits, the first place beyond is used.
        let beyond = || places.iter().find(|&&(_, depth)| depth <= deepest).map(|&(place, _)| place);
        let Some(place) = (0..=most).find_map(within).or_else(beyond) else { break };
        let tail = rest.split_off(place);
        lines.push(rest.into_iter().collect::<String>().trim_end().to_owned());
        rest = tail;
    }
    lines.push(rest.into_iter().collect());
    lines
}

/// The positions of ` + ` and ` - `, except at the beginning, with the number of brackets around them.
fn signs(text: &[char]) -> Vec<(usize, usize)> {
    let (mut depth, mut places) = (0usize, Vec::new());
    for (i, &c) in text.iter().enumerate() {
        match c {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth = depth.saturating_sub(1),
            '+' | '-' if i > 1 && text[i - 1] == ' ' && text.get(i + 1) == Some(&' ') => {
                places.push((i, depth));
            }
            _ => {}
        }
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_broken_in_few_brackets() {
        let formula = "f = a + (b - c) (d + e) - g";
        assert_eq!(folded(formula, 100), [formula]);
        assert_eq!(folded(formula, 25), ["f = a + (b - c) (d + e)", "- g"]);
        assert_eq!(folded(formula, 20), ["f = a", "+ (b - c) (d + e)", "- g"]);
        assert_eq!(folded("(a + b) (c + d)", 14), ["(a + b) (c", "+ d)"]);
        assert_eq!(folded_outside("{a + b}{c + d}", 5), ["{a + b}{c + d}"]);
        assert_eq!(folded("abcdefgh", 3), ["abcdefgh"]);
    }
}
