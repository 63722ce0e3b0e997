//! Plain characters set as in a book: vulgar fractions and raised exponents.

use crate::graph::number::Number;
use crate::print::piece::{Binding, Piece, multiple_of_pi, number as plain};

const FRACTIONS: &[(&str, char)] = &[
    ("1/2", '½'),
    ("1/3", '⅓'),
    ("2/3", '⅔'),
    ("1/4", '¼'),
    ("3/4", '¾'),
    ("1/6", '⅙'),
    ("1/8", '⅛'),
    ("3/8", '⅜'),
];
const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];

pub(super) fn number(c: Number) -> Piece {
    if let Some((num, den)) = multiple_of_pi(c) {
        let above = if num == 1 { "π".to_owned() } else { format!("{num}π") };
        return if den == 1 { Piece::atom(above) } else { Piece::product(format!("{above}/{den}")) };
    }
    let piece = plain(c);
    let (sign, size) = piece.text.strip_prefix('-').map_or(("", piece.text.as_str()), |size| ("-", size));
    match FRACTIONS.iter().find(|(text, _)| *text == size) {
        Some((_, fraction)) => Piece {
            text: format!("{sign}{fraction}"),
            binding: if sign.is_empty() { Binding::Atom } else { Binding::Sum },
        },
        None => piece,
    }
}

pub(super) fn power(base: Piece, exponent: Piece) -> String {
    let base = base.at_least(Binding::Atom);
    let (sign, digits) =
        exponent.text.strip_prefix('-').map_or(("", &exponent.text[..]), |digits| ("⁻", digits));
    let raised: Option<String> =
        digits.chars().map(|c| c.to_digit(10).map(|digit| RAISED[digit as usize])).collect();
    match raised {
        Some(raised) => format!("{base}{sign}{raised}"),
        None => format!("{base}^{}", exponent.at_least(Binding::Atom)),
    }
}
