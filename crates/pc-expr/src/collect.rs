//! Short forms: expressions rebuilt as polynomials whose coefficients have forgotten what they do not depend on.
//!
//! Nothing here needs to be trusted: a form that is built is adopted only where its fingerprint says that it is the
//! same function, and only where it is cheaper. With [`Folding::Structural`] expressions stay as they are.

use crate::dag::{Atom, Dag, Folding, NodeId};
use crate::expr::Expr;
use crate::function::Function;
use crate::graph::Graph;
use crate::number::Number;

/// Greatest degree in one variable that is looked for.
const MAX_DEGREE: usize = 4;
/// Expressions longer than this when written out are left as they are.
const TOO_LONG: u32 = 20_000;

/// A polynomial Σ c·z_1^e_1 z_2^e_2 ….
#[derive(Clone, Debug)]
pub struct Polynomial<'g> {
    /// The variables z.
    pub variables: Vec<Expr<'g>>,
    /// Exponents of the variables, and the coefficient.
    pub terms: Vec<(Vec<u32>, Expr<'g>)>,
}

impl Graph {
    /// Each expression in the shortest form found: collected by powers of `variables` in this order, every
    /// coefficient without the symbols it does not depend on.
    pub fn shorten<'g>(&'g self, expressions: &[Expr<'g>], variables: &[Expr<'g>]) -> Vec<Expr<'g>> {
        expressions.iter().map(|&e| self.collect(e, variables)).collect()
    }

    fn collect<'g>(&'g self, e: Expr<'g>, variables: &[Expr<'g>]) -> Expr<'g> {
        if self.folding() == Folding::Structural || e.constant().is_some() || e.tree_cost() > TOO_LONG {
            return e;
        }
        let present = self.symbols_of(&[e]);
        let Some((position, powers)) = variables.iter().enumerate().find_map(|(position, &z)| {
            let powers = if present.contains(&z) { self.powers(e, z)? } else { return None };
            (powers.len() > 1).then_some((position, powers))
        }) else {
            return self.forget(e);
        };
        let rest = &variables[position + 1..];
        let z = variables[position];
        let terms = powers.into_iter().enumerate().map(|(i, c)| self.collect(c, rest) * z.powi(i as i32));
        let collected = self.sum(terms.collect::<Vec<_>>());
        if collected.tree_cost() <= e.tree_cost() { collected } else { self.forget(e) }
    }

    /// e as a polynomial in all of `variables`, if it is one.
    pub fn polynomial<'g>(&'g self, e: Expr<'g>, variables: &[Expr<'g>]) -> Option<Polynomial<'g>> {
        let mut terms = vec![(Vec::new(), e)];
        for &z in variables {
            let mut next = Vec::new();
            for (exponents, coefficient) in terms {
                for (i, c) in self.powers(coefficient, z)?.into_iter().enumerate() {
                    if !c.is_zero() {
                        let mut exponents = exponents.clone();
                        exponents.push(i as u32);
                        next.push((exponents, c));
                    }
                }
            }
            terms = next;
        }
        for (_, c) in &mut terms {
            *c = self.forget(*c);
        }
        Some(Polynomial { variables: variables.to_vec(), terms })
    }

    /// The coefficients c_i = (1/i!) ∂ⁱe/∂zⁱ at z = 0 of a polynomial in z, if e is one of moderate degree.
    fn powers<'g>(&'g self, e: Expr<'g>, z: Expr<'g>) -> Option<Vec<Expr<'g>>> {
        let (symbol, output) = (z.symbol_in(self), e.atom_in(self));
        if self.with(|dag| dag.is_below_a_call(symbol, output)) {
            return None; // four derivatives of a root would show the same
        }
        let mut derivatives = vec![e];
        loop {
            let next = derivatives[derivatives.len() - 1].derivative(z);
            if next.is_zero() {
                break;
            }
            // The derivatives of a polynomial become shorter; where they grow there is none to be found.
            let growing =
                next.tree_cost() > derivatives[derivatives.len() - 1].tree_cost().saturating_mul(2) + 8;
            if derivatives.len() > MAX_DEGREE || growing {
                return None;
            }
            derivatives.push(next);
        }
        let before = self.zero_divisions();
        let mut at_zero = self.substitute(&derivatives, &[(z, Expr::ZERO)]);
        if self.zero_divisions() > before || at_zero.iter().any(|c| c.is_undefined()) {
            return None; // a polynomial, but written with a quotient that is singular at 0
        }
        let mut factorial = 1;
        for (i, c) in at_zero.iter_mut().enumerate().skip(1) {
            factorial *= i as i64;
            *c *= Expr::ratio(1, factorial);
        }
        Some(at_zero)
    }

    /// e written without the symbols that it contains but does not depend on: they are put to a regular value.
    fn forget<'g>(&'g self, e: Expr<'g>) -> Expr<'g> {
        let mut short = e;
        for z in self.symbols_of(&[e]) {
            if !self.symbols_of(&[short]).contains(&z) || short.depends_on(z) {
                continue;
            }
            // A form with a vanishing denominator or another value is not taken: try the next point.
            for (sin, cos) in [(0, 1), (1, 0)]
                .map(|(s, c)| (Number::integer(s), Number::integer(c)))
                .into_iter()
                .chain([(Number::ratio(3, 5), Number::ratio(4, 5))])
            {
                let candidate = self.at_point(short, z, sin, cos);
                if self.is_same_value(candidate, e) {
                    short = candidate;
                    break;
                }
            }
        }
        short
    }

    /// e with z = 0, sin z and cos z as given.
    fn at_point<'g>(&'g self, e: Expr<'g>, z: Expr<'g>, sin: Number, cos: Number) -> Expr<'g> {
        let (symbol, output) = (z.symbol_in(self), e.atom_in(self));
        self.build(|dag| {
            let divisions = dag.zero_divisions().len();
            let mut replacements = vec![(symbol, Atom::ZERO)];
            for (function, value) in [(Function::Sin, sin), (Function::Cos, cos)] {
                if let Some(node) = call_node(dag, function, symbol) {
                    replacements.push((node, Atom::Constant(value)));
                }
            }
            let value = dag.substitute(&[output], &replacements)[0];
            dag.forget_zero_divisions(divisions);
            value
        })
    }

    /// Whether two expressions have the same fingerprint.
    fn is_same_value<'g>(&'g self, a: Expr<'g>, b: Expr<'g>) -> bool {
        (a - b).is_zero()
    }
}

fn call_node(dag: &mut Dag, function: Function, symbol: NodeId) -> Option<NodeId> {
    match dag.call(function, &[Atom::Node(symbol)]) {
        Atom::Node(node) => Some(node),
        Atom::Constant(_) => None,
    }
}

impl<'g> Polynomial<'g> {
    /// The polynomial written out in another graph, coefficients in front of their monomials, not nested.
    pub fn expanded<'h>(&self, from: &'g Graph, into: &'h Graph) -> Expr<'h> {
        let terms = self.terms.iter().map(|(exponents, coefficient)| {
            let monomial = self.variables.iter().zip(exponents).fold(Expr::ONE, |product, (z, &e)| {
                product * into.symbol(&z.symbol_name().unwrap_or_default()).powi(e as i32)
            });
            from.transcribe(&[*coefficient], into)[0] * monomial
        });
        into.sum(terms.collect::<Vec<_>>())
    }
}

impl Graph {
    /// The expressions rebuilt in another graph, symbols of the same names.
    pub fn transcribe<'g, 'h>(&'g self, expressions: &[Expr<'g>], into: &'h Graph) -> Vec<Expr<'h>> {
        let symbols: Vec<(Expr<'g>, Expr<'h>)> = self
            .symbols_of(expressions)
            .into_iter()
            .map(|symbol| (symbol, into.symbol(&symbol.symbol_name().unwrap_or_default())))
            .collect();
        self.evaluate(expressions, &symbols).unwrap_or_default() // every symbol has its value
    }
}
