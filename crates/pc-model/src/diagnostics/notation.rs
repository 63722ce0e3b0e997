//! Names as other notations write them: `theta_dot` for `θ'`.

use pc_expr::greek;

/// The one of the `known` names that `word` means in another notation: Greek letters by their names, and a rate by a `dot`
/// after it or a `d` before it.
pub(crate) fn meant<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let whole = spelled(word);
    let rate = whole.strip_suffix("dot").or_else(|| whole.strip_prefix('d'));
    known.into_iter().find(|name| match name.strip_suffix('\'') {
        Some(coordinate) => rate == Some(&spelled(coordinate)),
        None => whole == spelled(name),
    })
}

/// A name in Latin letters and digits.
fn spelled(name: &str) -> String {
    let letter = |c: char| greek(c).unwrap_or_else(|| c.to_string());
    name.chars().filter(|&c| c != '_').map(letter).collect()
}

#[cfg(test)]
mod tests {
    use super::meant;

    #[test]
    fn greek_letters_and_dots_are_recognised() {
        let known = ["θ", "θ'", "q1", "q1'", "Ω", "ω_x", "front_wheel'", "m"];
        for (word, name) in [
            ("theta", "θ"),
            ("theta_dot", "θ'"),
            ("thetadot", "θ'"),
            ("θ_dot", "θ'"),
            ("dtheta", "θ'"),
            ("q1dot", "q1'"),
            ("dq1", "q1'"),
            ("Omega", "Ω"),
            ("omega_x", "ω_x"),
            ("omegax", "ω_x"),
            ("front_wheel_dot", "front_wheel'"),
        ] {
            assert_eq!(meant(word, known), Some(name), "{word}");
        }
        for word in ["omega", "q2dot", "dot", "d", "mass"] {
            assert_eq!(meant(word, known), None, "{word}");
        }
    }
}
