//! Identities between expressions with square roots.

use std::cell::RefCell;
use std::ops::{Add, Mul, Neg};

use pc_expr::{Expr, Folding, Function, Graph, Number, Scalar};

/// Whether `expression` is zero wherever it is defined, as far as the graph can decide after this function
/// has related the roots to each other.
///
/// The graph knows the square of each root, but few relations between the roots of different sums. So each
/// root √u becomes a symbol r and, if u is linear in a symbol z, this symbol is eliminated: z = (r² −
/// u_0)/u_1 for u = u_0 + u_1 z. The result is rational in r, and it is zero for all r only if `expression`
/// is zero for all z.
pub(crate) fn vanishes<'g>(graph: &'g Graph, expression: Expr<'g>) -> bool {
    if expression.is_zero() {
        return true;
    }
    let rational = graph.page(Folding::ByValue);
    let roots = RefCell::new(Vec::new());
    let place = Some((&rational, &roots));
    let renamed = |i: usize| Rooted { value: rational.symbol(&format!("x{i}")), roots: place };
    let symbols = graph.symbols_of(&[expression]);
    let symbols: Vec<_> = symbols.into_iter().enumerate().map(|(i, symbol)| (symbol, renamed(i))).collect();
    let Ok(values) = graph.evaluate(&[expression], &symbols) else { return false };
    let mut rest = vec![values[0].value];
    let (radicands, names): (Vec<_>, Vec<_>) = roots.borrow().iter().copied().unzip();
    rest.extend(radicands);
    for (i, &root) in names.iter().enumerate() {
        if let Some(solution) = solved(&rational, rest[1 + i], root) {
            rest = rational.substitute(&rest, &[solution]);
        }
    }
    rest[0].is_zero()
}

/// A symbol z in which `radicand` is linear, with its value where `radicand` is r².
fn solved<'h>(graph: &'h Graph, radicand: Expr<'h>, root: Expr<'h>) -> Option<(Expr<'h>, Expr<'h>)> {
    let symbols = graph.symbols_of(&[radicand]);
    symbols.into_iter().filter(|&z| z != root).find_map(|z| {
        let slope = radicand.derivative(z);
        if slope.is_zero() || slope.depends_on(z) {
            return None;
        }
        let rest = graph.substitute(&[radicand, slope], &[(z, Expr::ZERO)]);
        Some((z, (root.square() - rest[0]) / rest[1])).filter(|(_, value)| !value.is_undefined())
    })
}

/// Radicands, each with the symbol of its root.
type Roots<'h> = RefCell<Vec<(Expr<'h>, Expr<'h>)>>;

/// An expression in which symbols stand for roots; a constant has no graph.
#[derive(Clone, Copy)]
struct Rooted<'a, 'h> {
    value: Expr<'h>,
    roots: Option<(&'h Graph, &'a Roots<'h>)>,
}

impl Add for Rooted<'_, '_> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Rooted { value: self.value + other.value, roots: self.roots.or(other.roots) }
    }
}

impl Mul for Rooted<'_, '_> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Rooted { value: self.value * other.value, roots: self.roots.or(other.roots) }
    }
}

impl Neg for Rooted<'_, '_> {
    type Output = Self;
    fn neg(self) -> Self {
        Rooted { value: -self.value, ..self }
    }
}

impl Scalar for Rooted<'_, '_> {
    fn from_f64(value: f64) -> Self {
        Rooted { value: value.into(), roots: None }
    }

    fn constant(value: Number) -> Self {
        Rooted { value: value.into(), roots: None }
    }

    fn powi(self, exponent: i32) -> Self {
        Rooted { value: self.value.powi(exponent), ..self }
    }

    fn call(function: Function, args: &[Self]) -> Self {
        let values: Vec<_> = args.iter().map(|arg| arg.value).collect();
        let place = args.iter().find_map(|arg| arg.roots);
        let value = match (function, place) {
            (Function::Sqrt, Some((graph, roots))) => root_of(graph, roots, values[0]),
            _ => Expr::apply(function, &values),
        };
        Rooted { value, roots: place }
    }
}

/// The symbol of √`radicand`; equal radicands share one symbol.
fn root_of<'h>(graph: &'h Graph, roots: &Roots<'h>, radicand: Expr<'h>) -> Expr<'h> {
    let mut roots = roots.borrow_mut();
    if let Some(&(_, root)) = roots.iter().find(|(known, _)| *known == radicand) {
        return root;
    }
    let root = graph.symbol(&format!("r{}", roots.len()));
    roots.push((radicand, root));
    root
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identities_of_roots_are_used() {
        let graph = Graph::new();
        let [x, e] = graph.symbols(["x", "E"]);
        let r = (2.0 * e - x.square()).sqrt();
        let zero = (r / 2.0 + (e - x.square() / 2.0) / r).square() + x.square() - 2.0 * e;
        assert!(vanishes(&graph, zero));
        assert!(vanishes(&graph, (r + 1.0 / r) - (r.square() + 1.0) / r));
        assert!(!vanishes(&graph, zero + x / 1e9));
        assert!(!vanishes(&graph, x.square().sqrt() - x)); // |x|
        assert!(!vanishes(&graph, r - x));
    }
}
