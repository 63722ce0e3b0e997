//! Linear combinations and columns of text.

/// The linear combination with these coefficients and elements, such as `2 X1 - X3`; `0` if all coefficients
/// are 0.
pub fn combination(terms: impl IntoIterator<Item = (String, String)>) -> String {
    combined(terms).join(" ")
}

/// The terms of the combination, all except the first preceded by their sign and a space.
pub(crate) fn combined(terms: impl IntoIterator<Item = (String, String)>) -> Vec<String> {
    let mut sum: Vec<String> = Vec::new();
    for (coefficient, element) in terms.into_iter().filter(|(coefficient, _)| coefficient != "0") {
        let (sign, size) = match coefficient.strip_prefix('-') {
            Some(rest) if !is_sum(rest) => ("-", rest),
            _ => ("+", coefficient.as_str()),
        };
        let sign = match (sum.is_empty(), sign) {
            (true, "-") => "-",
            (true, _) => "",
            (false, "-") => "- ",
            (false, _) => "+ ",
        };
        sum.push(match size {
            "1" => format!("{sign}{element}"),
            // An element behind a quotient would be read as part of its divisor.
            _ if is_sum(size) || is_quotient(size) => format!("{sign}({size}) {element}"),
            _ => format!("{sign}{size} {element}"),
        });
    }
    if sum.is_empty() { vec!["0".to_owned()] } else { sum }
}

fn is_sum(text: &str) -> bool {
    let outside = outside_of_brackets(text);
    outside.contains(" + ") || outside.contains(" - ")
}

/// The part of the text that is outside all brackets.
fn outside_of_brackets(text: &str) -> String {
    let mut depth = 0usize;
    let is_outside = |c: &char| {
        match c {
            '(' | '{' => depth += 1,
            ')' | '}' => depth = depth.saturating_sub(1),
            _ => return depth == 0,
        }
        false
    };
    text.chars().filter(is_outside).collect()
}

/// Whether the text is a quotient that contains more than numbers.
fn is_quotient(text: &str) -> bool {
    outside_of_brackets(text).contains('/') && text.chars().any(char::is_alphabetic)
}

/// The number of characters, each one column wide.
pub fn columns(text: &str) -> usize {
    text.chars().count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn combinations_read_as_written_by_hand() {
        let sum =
            |terms: &[(&str, &str)]| combination(terms.iter().map(|&(c, x)| (c.to_owned(), x.to_owned())));
        assert_eq!(sum(&[("0", "X1"), ("0", "X2")]), "0");
        assert_eq!(sum(&[("-1", "X1"), ("2/3", "X2"), ("-a", "X3")]), "-X1 + 2/3 X2 - a X3");
        assert_eq!(sum(&[("1", "X1"), ("a - b", "X2")]), "X1 + (a - b) X2");
        assert_eq!(sum(&[("1", "X1"), ("-2 (a/c - b)", "X2")]), "X1 - 2 (a/c - b) X2");
        let quotient = [("-cos(θ)/sin(θ)", "X1"), ("a/b", "X2")].map(|(c, x)| (c.to_owned(), x.to_owned()));
        assert_eq!(combination(quotient), "-(cos(θ)/sin(θ)) X1 + (a/b) X2");
    }
}
