//! Names as identifiers of C and Rust.

use crate::codegen::layout::Language;
use crate::codegen::{c, rust};

/// Lower-case names of α to ω.
const GREEK: [&str; 25] = [
    "alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "iota", "kappa", "lambda", "mu",
    "nu", "xi", "omicron", "pi", "rho", "sigma", "sigma", "tau", "upsilon", "phi", "chi", "psi", "omega",
];

/// The name of a Greek letter in Latin ones, with a capital for a capital letter.
///
/// ```
/// assert_eq!(pc_expr::greek('Θ').as_deref(), Some("Theta"));
/// assert_eq!(pc_expr::greek('x'), None);
/// ```
pub fn greek(letter: char) -> Option<String> {
    let name = |c: char, first: char| GREEK.get((c as usize).checked_sub(first as usize)?).copied();
    match letter {
        'α'..='ω' => name(letter, 'α').map(str::to_owned),
        'Α'..='Ω' => {
            let name = name(letter, 'Α')?;
            Some(name[..1].to_uppercase() + &name[1..])
        }
        'ϑ' => Some("theta".to_owned()),
        'ϕ' => Some("phi".to_owned()),
        'ϖ' => Some("pi".to_owned()),
        'ϰ' => Some("kappa".to_owned()),
        'ϱ' => Some("rho".to_owned()),
        'ϵ' => Some("epsilon".to_owned()),
        _ => None,
    }
}

/// `name` spelt in ASCII letters, digits and single `_`, beginning with a letter; empty if the name is empty.
fn spelt(name: &str) -> String {
    let stem = name.trim_end_matches('\'');
    let mut text = String::new();
    let mut after_greek = false;
    for letter in stem.chars() {
        let word = greek(letter);
        // A letter begins a new word; a digit is an index of the word before it.
        let joined = text.ends_with(|c: char| c.is_ascii_alphanumeric());
        if joined && (word.is_some() || after_greek && letter.is_ascii_alphabetic()) {
            text.push('_');
        }
        after_greek = word.is_some();
        match (word, letter) {
            (Some(word), _) => text += &word,
            (None, '₀'..='₉') => text.push(char::from(b'0' + (letter as u32 - '₀' as u32) as u8)),
            (None, c) if c.is_ascii_alphanumeric() => text.push(c),
            (None, c) if c.is_alphanumeric() => text += &format!("u{:x}", u32::from(c)),
            _ => text.push('_'),
        }
    }
    match name.len() - stem.len() {
        0 => {}
        1 => text += "_dot",
        2 => text += "_ddot",
        order => text += &format!("_d{order}"),
    }
    // C++ reserves double underscores, C leading ones.
    let mut text = text.split('_').filter(|part| !part.is_empty()).collect::<Vec<_>>().join("_");
    if text.starts_with(|c: char| c.is_ascii_digit()) {
        text.insert_str(0, "n_");
    }
    text
}

pub(crate) fn distinct<S: AsRef<str>>(language: Language, names: &[S], reserved: &[&str]) -> Vec<String> {
    let mut taken: Vec<String> = Vec::with_capacity(names.len());
    for name in names {
        let mut text = spelt(name.as_ref());
        if text.is_empty() {
            text = "unnamed".to_owned();
        }
        if is_reserved(language, &text) || reserved.contains(&text.as_str()) {
            text.push('_');
        }
        let stem = text.trim_end_matches('_').to_owned();
        let mut number = 2;
        while taken.contains(&text) || reserved.contains(&text.as_str()) {
            text = format!("{stem}_{number}");
            number += 1;
        }
        taken.push(text);
    }
    taken
}

/// Whether a local variable of this name would not compile, or would hide an argument or a function that the
/// code calls.
fn is_reserved(language: Language, name: &str) -> bool {
    matches!(name, "t" | "y" | "p" | "main")
        || match language {
            Language::C => c::is_reserved(name),
            Language::Rust => rust::is_reserved(name),
        }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identifiers_are_valid_and_distinct() {
        let names = [
            "γ1", "γ_1", "gamma1", "ω", "Ω", "αβ", "mγ", "γm", "θ'", "q''", "ω₃", "int", "fn", "y", "1x", "",
        ];
        let c = distinct(Language::C, &names, &["q_ddot"]);
        let expected = [
            "gamma1",
            "gamma_1",
            "gamma1_2",
            "omega",
            "Omega",
            "alpha_beta",
            "m_gamma",
            "gamma_m",
            "theta_dot",
            "q_ddot_",
            "omega3",
            "int_",
            "fn",
            "y_",
            "n_1x",
            "unnamed",
        ];
        assert_eq!(c, expected);
        assert_eq!(distinct(Language::Rust, &["int", "fn", "__x__y"], &[]), ["int", "fn_", "x_y"]);
        assert_eq!(distinct(Language::C, &["x_", "x", "x"], &[]), ["x", "x_2", "x_3"]);
    }
}
