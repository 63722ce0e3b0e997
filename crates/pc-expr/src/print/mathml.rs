//! The pieces of an expression in presentation MathML.
//!
//! A piece is a row: elements side by side. Where one element is required, such as a base or a numerator, the
//! row is put into an `mrow`. Invisible operators tell screen readers how neighbours are joined.

use crate::graph::function::Function;
use crate::graph::number::Number;
use crate::graph::undetermined::{Differentiation, Undetermined};
use crate::print::piece::{Binding, Piece, multiple_of_pi};
use crate::print::symbol::{Index, Symbol, spelt};

pub(super) const PLUS: &str = "<mo>+</mo>";
pub(super) const MINUS: &str = "<mo>−</mo>";
/// Brackets that do not grow, so that a line may end between them.
pub(super) const BRACKETS: [&str; 2] = ["<mo stretchy=\"false\">(</mo>", "<mo stretchy=\"false\">)</mo>"];
/// The words of a sentence: before the names, between a name and its meaning, and between two such pairs.
pub(super) const WORDS: [&str; 3] = ["<mtext> where </mtext>", "<mo>=</mo>", "<mo>,</mo>"];

const APPLY: &str = "<mo>&#x2061;</mo>";
const TIMES: &str = "<mo>&#x2062;</mo>";
/// Between a function and an argument without brackets.
const BARE: &str = "<mo>&#x2061;</mo><mspace width=\"0.17em\"/>";

/// Functions whose exponents are written after their names.
const RAISED: [Function; 6] =
    [Function::Sin, Function::Cos, Function::Sinh, Function::Cosh, Function::Tanh, Function::Log];

/// `ω1` has the index 1, `x'` a dot, `x''` two; a name of several letters is upright, unless it is the name
/// of a Greek letter.
pub(super) fn symbol(name: &str) -> String {
    let Symbol { stem, dots, index } = Symbol::of(name);
    let stem = letters(stem);
    let stem = match dots {
        0 => stem,
        1 => format!("<mover>{stem}<mo>˙</mo></mover>"),
        _ => format!("<mover>{stem}<mo>¨</mo></mover>"),
    };
    match index {
        Index::None => stem,
        Index::Plain(index) => format!("<msub>{stem}{}</msub>", letters(index)),
        Index::Symbol(index) => format!("<msub>{stem}{}</msub>", symbol(index)),
    }
}

fn letters(text: &str) -> String {
    if !text.is_empty() && text.chars().all(|c| c.is_ascii_digit()) {
        return format!("<mn>{text}</mn>");
    }
    match spelt(text) {
        Some((letter, _)) => format!("<mi>{letter}</mi>"),
        None => format!("<mi>{}</mi>", text.chars().map(character).collect::<String>()),
    }
}

/// A character, escaped for the text of a page: names of reactions contain those of constraints, which may be
/// any text.
fn character(c: char) -> String {
    match c {
        '<' => "&lt;".to_owned(),
        '>' => "&gt;".to_owned(),
        '&' => "&amp;".to_owned(),
        '"' => "&quot;".to_owned(),
        '\'' => "&#39;".to_owned(),
        c if c.is_whitespace() => " ".to_owned(),
        // These are not characters of XML.
        c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => '\u{fffd}'.to_string(),
        c => c.to_string(),
    }
}

pub(super) fn number(c: Number) -> Piece {
    if let Some((num, den)) = multiple_of_pi(c) {
        let above =
            if num == 1 { "<mi>π</mi>".to_owned() } else { format!("<mn>{num}</mn>{TIMES}<mi>π</mi>") };
        let den = den.to_string();
        return Piece::product(if den == "1" { above } else { over(&above, &format!("<mn>{den}</mn>")) });
    }
    if c == Number::UNDEFINED {
        return Piece::atom("<mtext>undefined</mtext>");
    }
    let text = c.to_string();
    let (sign, size) = text.strip_prefix('-').map_or(("", text.as_str()), |size| (MINUS, size));
    let size = match (size.split_once('/'), size.split_once('e')) {
        (Some((num, den)), _) => over(&format!("<mn>{num}</mn>"), &format!("<mn>{den}</mn>")),
        (None, Some((mantissa, exponent))) => {
            let exponent = exponent.replace('-', "−");
            format!("<mn>{mantissa}</mn><mo>⋅</mo><msup><mn>10</mn><mn>{exponent}</mn></msup>")
        }
        (None, None) => format!("<mn>{size}</mn>"),
    };
    let binding = if sign.is_empty() { Binding::Product } else { Binding::Sum };
    Piece { text: format!("{sign}{size}"), binding }
}

pub(super) fn call(function: Function, args: Vec<Piece>) -> Piece {
    let args: Vec<String> = args.into_iter().map(|arg| arg.text).collect();
    let listed = args.join("<mo>,</mo>");
    let name = match function {
        Function::Sqrt => return Piece::atom(format!("<msqrt>{listed}</msqrt>")),
        Function::Abs => return Piece::atom(format!("<mrow><mo>|</mo>{listed}<mo>|</mo></mrow>")),
        Function::Exp => {
            let text = format!("<msup><mi mathvariant=\"normal\">e</mi>{}</msup>", one(&listed));
            return Piece { text, binding: Binding::Power };
        }
        Function::Asin | Function::Acos | Function::Atan => format!("arc{}", &function.name()[1..]),
        Function::Sign => "sgn".to_owned(),
        other => other.name().to_owned(),
    };
    let is_bare = RAISED.contains(&function) && is_symbol(&listed);
    let argument = if is_bare { format!("{BARE}{listed}") } else { format!("{APPLY}{}", bracketed(&listed)) };
    Piece::atom(format!("<mi>{name}</mi>{argument}"))
}

/// V(r), V′(r), A_{,x,y}(x, y)
pub(super) fn applied(function: Undetermined, name: &str, args: &[String]) -> String {
    let (name, listed) = (symbol(name), args.join("<mo>,</mo>"));
    let differentiated = match function.differentiation(args) {
        Differentiation::None => name,
        Differentiation::Primes(count) => format!("<msup>{name}<mo>{}</mo></msup>", "′".repeat(count)),
        Differentiation::Order(order) => {
            format!("<msup>{name}<mrow><mo>(</mo><mn>{order}</mn><mo>)</mo></mrow></msup>")
        }
        Differentiation::Indices(indices) => {
            let index = |index: &String| match index.starts_with('<') {
                true => format!("<mo>,</mo>{index}"),
                false => format!("<mo>,</mo><mn>{index}</mn>"),
            };
            format!(
                "<msub>{}<mrow>{}</mrow></msub>",
                one(&name),
                indices.iter().map(index).collect::<String>()
            )
        }
    };
    format!("{differentiated}{APPLY}{}", bracketed(&listed))
}

pub(super) fn power(base: &Piece, exponent: &str) -> String {
    // Integer exponents are plain digits.
    let exponent = if exponent.contains('<') { one(exponent) } else { format!("<mn>{exponent}</mn>") };
    // (sin x)² is written sin² x
    for function in RAISED {
        let name = format!("<mi>{}</mi>", function.name());
        if base.binding == Binding::Atom
            && let Some(rest) = base.text.strip_prefix(&name)
            && rest.starts_with(APPLY)
        {
            return format!("<msup>{name}{exponent}</msup>{rest}");
        }
    }
    // A base with an index takes its exponent above the index.
    match (base.binding, base.text.strip_prefix("<msub>")) {
        (Binding::Atom, Some(rest)) if rest.ends_with("</msub>") => {
            format!("<msubsup>{}{exponent}</msubsup>", &rest[..rest.len() - "</msub>".len()])
        }
        (Binding::Atom, _) => format!("<msup>{}{exponent}</msup>", one(&base.text)),
        _ => format!("<msup>{}{exponent}</msup>", bracketed(&base.text)),
    }
}

/// Factors side by side, two numbers separated by a dot. The argument of sin x cos y ends before the next
/// function; before another factor it needs brackets, as sin x y is read as sin(x y).
pub(super) fn juxtaposed(factors: &[String]) -> String {
    let mut text = String::new();
    for (i, factor) in factors.iter().enumerate() {
        if i > 0 {
            let digits = factors[i - 1].ends_with("</mn>") && factor.starts_with("<mn>");
            let apart =
                is_name(&factors[i - 1]) || is_name(factor) || is_call(factor) || is_call(&factors[i - 1]);
            text.push_str(match (digits, apart) {
                (true, _) => "<mo>⋅</mo>",
                (false, true) => "<mo>&#x2062;</mo><mspace width=\"0.17em\"/>",
                (false, false) => TIMES,
            });
        }
        match bare_call(factor) {
            Some((head, argument)) if factors.get(i + 1).is_some_and(|next| !is_call(next)) => {
                text.push_str(&format!("{head}{APPLY}{}", bracketed(argument)));
            }
            _ => text.push_str(factor),
        }
    }
    text
}

/// A quotient; a lone sum above or below the bar needs no brackets.
pub(super) fn fraction(above: Vec<Piece>, below: Vec<Piece>) -> String {
    over(&alone(above), &alone(below))
}

fn alone(mut factors: Vec<Piece>) -> String {
    if factors.len() == 1 {
        let text = factors.remove(0).text;
        let inner = text.strip_prefix(OPEN).and_then(|inner| inner.strip_suffix(CLOSE));
        return inner.filter(|inner| !inner.contains("<mo>(")).map_or(text.clone(), str::to_owned);
    }
    let factors = factors.into_iter().map(|piece| match piece.binding {
        Binding::Sum => bracketed(&piece.text),
        _ => piece.text,
    });
    juxtaposed(&factors.collect::<Vec<_>>())
}

const OPEN: &str = "<mrow><mo>(</mo>";
const CLOSE: &str = "<mo>)</mo></mrow>";

/// The row in brackets that grow with it.
pub(super) fn bracketed(row: &str) -> String {
    format!("{OPEN}{row}{CLOSE}")
}

fn over(above: &str, below: &str) -> String {
    format!("<mfrac>{}{}</mfrac>", one(above), one(below))
}

/// The row as one element.
fn one(row: &str) -> String {
    let is_token = row.matches('<').count() == 2; // one opening and one closing tag
    if is_token { row.to_owned() } else { format!("<mrow>{row}</mrow>") }
}

/// Whether the row is a single symbol, which needs no brackets after sin.
fn is_symbol(row: &str) -> bool {
    let inner = row.strip_prefix("<msub>").and_then(|inner| inner.strip_suffix("</msub>"));
    let tokens = inner.unwrap_or(row).matches("</m").count();
    row.starts_with("<m") && row.matches("<mo").count() == 0 && tokens == if inner.is_some() { 2 } else { 1 }
}

/// Whether the factor is a function with its argument.
fn is_call(factor: &str) -> bool {
    RAISED.iter().any(|function| {
        let rest = factor.strip_prefix("<msup>").unwrap_or(factor);
        rest.strip_prefix("<mi>")
            .and_then(|rest| rest.strip_prefix(function.name()))
            .is_some_and(|rest| rest.starts_with("</mi>") && factor.contains(APPLY))
    })
}

/// The name of a function, with its power, and its argument, if that has no brackets; calls inside the
/// argument do not count.
fn bare_call(factor: &str) -> Option<(&str, &str)> {
    let is_outermost = |before: &str| {
        let closed = before.matches("</m").count() + before.matches("/>").count();
        before.matches("<m").count() == closed
    };
    let mut places = factor.match_indices(BARE).map(|(place, _)| place);
    let place = places.find(|&place| is_outermost(&factor[..place])).filter(|_| is_call(factor))?;
    Some((&factor[..place], &factor[place + BARE.len()..]))
}

/// Whether the factor is a name of several letters or with an index, which needs a space beside another.
fn is_name(factor: &str) -> bool {
    if factor.starts_with("<msub>") || factor.starts_with("<msubsup>") {
        return true;
    }
    let name = factor.strip_prefix("<mi>").and_then(|rest| rest.strip_suffix("</mi>"));
    name.is_some_and(|name| !name.contains('<') && name.chars().count() > 1)
}
