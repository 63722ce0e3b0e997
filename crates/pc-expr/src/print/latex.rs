//! The pieces of an expression in LaTeX.

use crate::graph::function::Function;
use crate::graph::number::Number;
use crate::graph::undetermined::{Differentiation, Undetermined};
use crate::print::piece::{Binding, Piece, multiple_of_pi};
use crate::print::symbol::{GREEK, Index, Symbol, spelt};

/// `ω1` is \omega_{1}, `x'` is \dot{x}, `x''` is \ddot{x}; a name of several letters is set upright, unless it is
/// the name of a Greek letter.
pub(super) fn symbol(name: &str) -> String {
    let Symbol { stem, dots, index } = Symbol::of(name);
    let stem = letters(stem);
    let stem = match dots {
        0 => stem,
        1 => format!("\\dot{{{stem}}}"),
        _ => format!("\\ddot{{{stem}}}"),
    };
    match index {
        Index::None => stem,
        Index::Plain(index) => format!("{stem}_{{{}}}", letters(index)),
        Index::Symbol(index) => format!("{stem}_{{{}}}", symbol(index)), // p_ω1 is p_{\omega_{1}}
    }
}

fn letters(text: &str) -> String {
    let mut chars = text.chars();
    if let (Some(letter), None) = (chars.next(), chars.next()) {
        let named = GREEK.iter().find(|(greek, _)| *greek == letter);
        return named.map_or_else(|| character(letter), |(_, name)| format!("\\{name}"));
    }
    if let Some((_, name)) = spelt(text) {
        return format!("\\{name}");
    }
    if text.chars().all(|c| c.is_ascii_digit()) {
        return text.to_owned();
    }
    let spelt: String = text
        .chars()
        .map(|c| match GREEK.iter().find(|(greek, _)| *greek == c) {
            Some((_, name)) => format!("{{\\{name}}}"),
            None => character(c),
        })
        .collect();
    format!("\\mathrm{{{spelt}}}")
}

/// The code that prints a character as itself in mathematics mode: names of reactions contain those of
/// constraints, which may be any text.
fn character(c: char) -> String {
    match c {
        '_' | '{' | '}' | '$' | '%' | '&' | '#' => format!("\\{c}"),
        '\\' => "\\backslash{}".to_owned(),
        '^' => "\\wedge{}".to_owned(),
        '~' => "\\sim{}".to_owned(),
        c if c.is_whitespace() || c.is_control() => "\\ ".to_owned(),
        c => c.to_string(),
    }
}

pub(super) fn number(c: Number) -> Piece {
    if let Some((num, den)) = multiple_of_pi(c) {
        let above = if num == 1 { "\\pi".to_owned() } else { format!("{num} \\pi") };
        return Piece::product(if den == 1 { above } else { format!("\\frac{{{above}}}{{{den}}}") });
    }
    let text = c.to_string();
    let (sign, size) = text.strip_prefix('-').map_or(("", text.as_str()), |size| ("-", size));
    let size = match (size.split_once('/'), size.split_once('e')) {
        (Some((num, den)), _) => format!("\\frac{{{num}}}{{{den}}}"),
        (None, Some((mantissa, exponent))) => format!("{mantissa} \\cdot 10^{{{exponent}}}"),
        (None, None) => size.to_owned(),
    };
    let binding = if sign.is_empty() { Binding::Product } else { Binding::Sum };
    Piece { text: format!("{sign}{size}"), binding }
}

pub(super) fn call(function: Function, args: Vec<Piece>) -> Piece {
    let args: Vec<String> = args.into_iter().map(|arg| arg.text).collect();
    let listed = args.join(", ");
    let text = match function {
        Function::Sqrt => format!("\\sqrt{{{listed}}}"),
        Function::Abs => format!("\\left|{listed}\\right|"),
        Function::Exp => {
            // upright, unlike a symbol of one letter
            return Piece { text: format!("\\mathrm{{e}}^{{{listed}}}"), binding: Binding::Power };
        }
        Function::Step => format!("\\operatorname{{step}}\\left({listed}\\right)"),
        Function::Sign => format!("\\operatorname{{sgn}}\\left({listed}\\right)"),
        Function::Atan2 => format!("\\operatorname{{atan2}}\\left({listed}\\right)"),
        Function::Asin | Function::Acos | Function::Atan => {
            format!("\\arc{}\\left({listed}\\right)", &function.name()[1..])
        }
        _ if is_simple(&listed) => format!("\\{} {listed}", function.name()),
        _ => format!("\\{}\\left({listed}\\right)", function.name()),
    };
    Piece::atom(text)
}

/// V(r), V'(r), V^{(4)}(r), A_{,x,y}(x, y)
pub(super) fn applied(function: Undetermined, name: &str, args: &[String]) -> String {
    let (name, listed) = (symbol(name), args.join(", "));
    let differentiated = match function.differentiation(args) {
        Differentiation::None => name,
        Differentiation::Primes(count) => format!("{name}{}", "'".repeat(count)),
        Differentiation::Order(order) => format!("{name}^{{({order})}}"),
        Differentiation::Indices(indices) => {
            let (stem, index) = match name.strip_suffix('}').and_then(|name| name.split_once("_{")) {
                Some((stem, index)) => (stem.to_owned(), index.to_owned()),
                None => (name, String::new()),
            };
            format!("{stem}_{{{index},{}}}", indices.join(","))
        }
    };
    format!("{differentiated}\\left({listed}\\right)")
}

/// Functions whose argument may follow without brackets.
const BARE: [&str; 6] = ["\\sin", "\\cos", "\\sinh", "\\cosh", "\\tanh", "\\log"];

/// Whether an argument is a single symbol, which needs no brackets after \sin.
fn is_simple(argument: &str) -> bool {
    !argument.contains([' ', '+', '-', '(']) && !argument.contains("\\frac")
}

pub(super) fn power(base: &Piece, exponent: &str) -> String {
    // (\sin x)^2 is written \sin^2 x
    for function in BARE {
        if base.binding == Binding::Atom
            && let Some(rest) = base.text.strip_prefix(function)
            && (rest.starts_with(' ') || rest.starts_with("\\left"))
        {
            return format!("{function}^{{{exponent}}}{rest}");
        }
    }
    match base.binding {
        Binding::Atom => format!("{}^{{{exponent}}}", base.text),
        _ => format!("\\left({}\\right)^{{{exponent}}}", base.text),
    }
}

/// The argument in brackets after a function, if another factor follows: \sin x y would be read as sin(x y).
fn closed(factor: &str) -> String {
    let bare = BARE.iter().find_map(|function| {
        let rest = factor.strip_prefix(function)?;
        let power =
            rest.strip_prefix("^{").map_or(Some(0), |exponent| end_of_group(exponent).map(|end| end + 2))?;
        rest[power..].strip_prefix(' ')
    });
    match bare {
        Some(argument) => {
            let head = &factor[..factor.len() - argument.len() - 1];
            format!("{head}\\left({argument}\\right)")
        }
        None => factor.to_owned(),
    }
}

/// The position after the brace that closes a group opened before the text begins.
fn end_of_group(text: &str) -> Option<usize> {
    let mut depth = 1;
    for (i, c) in text.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return Some(i + 1);
        }
    }
    None
}

/// Factors side by side, two numbers separated by a dot. As usual, the argument of \sin x \cos y ends before
/// the next function.
pub(super) fn juxtaposed(factors: &[String]) -> String {
    let mut text = String::new();
    let ends_argument = |factor: &String| BARE.iter().any(|function| factor.starts_with(function));
    for (i, factor) in factors.iter().enumerate() {
        let digit = |c: Option<char>| c.is_some_and(|c| c.is_ascii_digit());
        if digit(text.chars().last()) && digit(factor.chars().next()) {
            text.push_str(" \\cdot ");
        } else if !text.is_empty() {
            // A space separates names of several letters and names with indices from each other.
            let is_name = |factor: &str| {
                let word = factor.starts_with("\\mathrm{") && !factor.starts_with("\\mathrm{e}^");
                word || factor.contains("_{") && !factor.contains(' ')
            };
            let between = is_name(&factors[i - 1]) || is_name(factor);
            text.push_str(if between { "\\, " } else { " " });
        }
        let bracketed = factor.strip_prefix('(').and_then(|inner| inner.strip_suffix(')'));
        match bracketed {
            Some(inner) => text.push_str(&format!("\\left({inner}\\right)")),
            None if factors.get(i + 1).is_some_and(|next| !ends_argument(next)) => {
                text.push_str(&closed(factor));
            }
            None => text.push_str(factor),
        }
    }
    text
}

/// Whether the brackets in a text match each other.
fn is_balanced(text: &str) -> bool {
    let mut depth = 0;
    for c in text.chars() {
        match c {
            '(' => depth += 1,
            ')' => depth -= 1,
            _ => {}
        }
        if depth < 0 {
            return false;
        }
    }
    depth == 0
}

/// Factors above or below a fraction bar, where a single sum needs no brackets.
pub(super) fn alone(mut factors: Vec<Piece>) -> String {
    if factors.len() == 1 {
        let text = factors.remove(0).text;
        let bracketed = text.strip_prefix('(').and_then(|inner| inner.strip_suffix(')'));
        return bracketed.filter(|inner| is_balanced(inner)).map_or(text.clone(), str::to_owned);
    }
    juxtaposed(&factors.into_iter().map(|p| p.at_least(Binding::Product)).collect::<Vec<String>>())
}
