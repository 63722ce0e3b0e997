//! Symbols in the place of long constants.
//!
//! A constant such as 1.4142135623730951 is no short rational: coefficients with its powers cannot be read back from their
//! residues. With a symbol in its place they can, and hold for every value of the symbol.

use std::ops::{Add, Mul, Neg};

use pc_expr::{Expr, Folding, Function, Graph, Number, Scalar};

use crate::integrals::present_values::is_short;

/// The expressions with a symbol for each long constant, up to its sign; its name is the number.
pub(crate) fn with_symbols<'g>(graph: &'g Graph, expressions: &[Expr<'g>]) -> Vec<Expr<'g>> {
    // A graph cannot grow while it is evaluated.
    let page = Graph::with_folding(Folding::Structural);
    let named = |x: Expr<'g>| {
        let symbol = page.symbol(&x.to_string());
        (x, Named { graph: Some(&page), of: Ok(symbol) })
    };
    let values: Vec<_> = graph.symbols_of(expressions).into_iter().map(named).collect();
    // All symbols have a value, so none is unbound.
    let written = graph.evaluate(expressions, &values).unwrap_or_default();
    let written: Vec<Expr<'_>> = written.into_iter().map(|x: Named<'_>| x.in_graph(&page)).collect();
    match symbols_with_numbers(&page, &written).is_empty() {
        true => expressions.to_vec(),
        false => page.transcribe(&written, graph),
    }
}

/// The symbols of long constants in the expressions, with their numbers.
pub(crate) fn symbols_with_numbers<'g>(
    graph: &'g Graph,
    expressions: &[Expr<'g>],
) -> Vec<(Expr<'g>, Expr<'g>)> {
    let number = |x: Expr<'g>| Some((x, number_named(&x.symbol_name()?)?.into()));
    graph.symbols_of(expressions).into_iter().filter_map(number).collect()
}

/// The name of the symbol of a positive number: a quotient of integers where it is one, otherwise a decimal number.
fn name_of(number: Number) -> String {
    match number {
        Number::Rational { num, den } => format!("{num}/{den}"),
        Number::Scaled { .. } | Number::Real(_) => number.to_f64().to_string(),
    }
}

/// The number whose symbol has this name.
fn number_named(name: &str) -> Option<Number> {
    if !name.starts_with(|c: char| c.is_ascii_digit()) {
        return None;
    }
    match name.split_once('/') {
        Some((num, den)) => Some(Number::ratio(num.parse().ok()?, den.parse().ok()?)),
        None => name.parse::<f64>().ok().map(Number::from),
    }
}

/// An expression, or a number that no expression of the graph has met yet.
#[derive(Clone, Copy)]
struct Named<'g> {
    graph: Option<&'g Graph>,
    of: Result<Expr<'g>, Number>,
}

impl<'g> Named<'g> {
    fn in_graph(self, graph: &'g Graph) -> Expr<'g> {
        match self.of {
            Ok(x) => x,
            Err(number) if number.is_finite() && !is_short(number) => {
                let symbol = graph.symbol(&name_of(number.abs()));
                if number.is_negative() { -symbol } else { symbol }
            }
            Err(number) => number.into(),
        }
    }

    /// The result of an operation on expressions, or on numbers where none of the operands is an expression.
    fn combined<const N: usize>(operands: [Self; N], f: impl Fn([Expr<'g>; N]) -> Expr<'g>) -> Self {
        let graph = operands.iter().find_map(|x| x.graph);
        let x = f(operands.map(|x| match (graph, x.of) {
            (Some(graph), _) => x.in_graph(graph),
            (None, Ok(x)) => x,
            (None, Err(number)) => number.into(),
        }));
        match x.constant() {
            Some(number) => Named { graph: None, of: Err(number) },
            None => Named { graph, of: Ok(x) },
        }
    }
}

impl Add for Named<'_> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Named::combined([self, other], |[x, y]| x + y)
    }
}

impl Mul for Named<'_> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Named::combined([self, other], |[x, y]| x * y)
    }
}

impl Neg for Named<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        Named::combined([self], |[x]| -x)
    }
}

impl Scalar for Named<'_> {
    fn from_f64(value: f64) -> Self {
        Named::constant(value.into())
    }

    fn constant(value: Number) -> Self {
        Named { graph: None, of: Err(value) }
    }

    fn powi(self, exponent: i32) -> Self {
        Named::combined([self], |[x]| x.powi(exponent))
    }

    fn call(function: Function, args: &[Self]) -> Self {
        match *args {
            [x] => Named::combined([x], |args| Expr::apply(function, &args)),
            [x, y] => Named::combined([x, y], |args| Expr::apply(function, &args)),
            [x, y, z, ..] => Named::combined([x, y, z], |args| Expr::apply(function, &args)),
            [] => Named::constant(Number::UNDEFINED),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_constants_become_symbols() {
        let graph = Graph::new();
        let x = graph.symbol("x");
        let root = 2f64.sqrt();
        let f = [root * x.square() - 0.5 * x, (1.0 - root * x).sin(), 3.0 * x];
        let [a, b, c] = with_symbols(&graph, &f)[..] else { panic!("three of them") };
        let s = graph.symbol(&name_of(root.into()));
        assert_eq!([a, b, c], [s * x.square() - 0.5 * x, (1.0 - s * x).sin(), 3.0 * x]);
        assert_eq!(graph.substitute(&[a, b], &symbols_with_numbers(&graph, &[a, b])), f[..2]);
    }
}
