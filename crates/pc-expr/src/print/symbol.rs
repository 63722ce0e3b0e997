//! Names of symbols taken apart: `ω1'` is ω with the index 1 and one dot.

/// Greek letters with their names in LaTeX.
pub(super) const GREEK: &[(char, &str)] = &[
    ('α', "alpha"),
    ('β', "beta"),
    ('γ', "gamma"),
    ('δ', "delta"),
    ('ε', "varepsilon"),
    ('ζ', "zeta"),
    ('η', "eta"),
    ('θ', "theta"),
    ('ι', "iota"),
    ('κ', "kappa"),
    ('λ', "lambda"),
    ('μ', "mu"),
    ('ν', "nu"),
    ('ξ', "xi"),
    ('π', "pi"),
    ('ρ', "rho"),
    ('ς', "varsigma"),
    ('σ', "sigma"),
    ('τ', "tau"),
    ('υ', "upsilon"),
    ('φ', "varphi"),
    ('χ', "chi"),
    ('ψ', "psi"),
    ('ω', "omega"),
    ('Γ', "Gamma"),
    ('Δ', "Delta"),
    ('Θ', "Theta"),
    ('Λ', "Lambda"),
    ('Ξ', "Xi"),
    ('Π', "Pi"),
    ('Σ', "Sigma"),
    ('Υ', "Upsilon"),
    ('Φ', "Phi"),
    ('Ψ', "Psi"),
    ('Ω', "Omega"),
];

/// A name in its parts.
pub(super) struct Symbol<'a> {
    pub(super) stem: &'a str,
    /// The number of primes at its end.
    pub(super) dots: usize,
    pub(super) index: Index<'a>,
}

/// The index of a symbol.
pub(super) enum Index<'a> {
    None,
    /// A text that is set as it is.
    Plain(&'a str),
    /// A symbol itself: ω1 in p_ω1.
    Symbol(&'a str),
}

impl<'a> Symbol<'a> {
    pub(super) fn of(name: &'a str) -> Symbol<'a> {
        let bare = name.trim_end_matches('\'');
        let (stem, index) = match bare.split_once('_') {
            Some((stem, index)) if !stem.is_empty() && !index.is_empty() => (stem, index),
            _ => bare.split_at(bare.trim_end_matches(|c: char| c.is_ascii_digit()).len()),
        };
        let plain = index.contains('_') || index.starts_with(|c: char| c.is_ascii_digit());
        let index = match index {
            "" => Index::None,
            _ if plain => Index::Plain(index),
            _ => Index::Symbol(index),
        };
        Symbol { stem, dots: name.len() - bare.len(), index }
    }
}

/// The Greek letter that a name spells.
pub(super) fn spelt(name: &str) -> Option<(char, &'static str)> {
    let spoken = if name == "th" { "theta" } else { name };
    let is_it =
        |(_, known): &&(char, &'static str)| *known == spoken || known.strip_prefix("var") == Some(spoken);
    GREEK.iter().find(is_it).copied()
}
