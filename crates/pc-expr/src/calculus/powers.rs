//! The coefficients of an expression as a polynomial in one symbol.

use rustc_hash::FxHashMap;

use crate::graph::dag::Dag;
use crate::graph::expr::Expr;
use crate::graph::graph::Graph;
use crate::graph::node::{Atom, Node, NodeId};
use crate::graph::number::Number;
use crate::graph::subgraph::Cone;

/// The greatest degree that is tried.
const MAX_DEGREE: usize = 4;

impl Graph {
    /// The coefficients c_i = (1/i!) ∂ⁱe/∂zⁱ at z = 0 of e, if it is a polynomial in z of moderate degree.
    pub(super) fn powers<'g>(&'g self, e: Expr<'g>, z: Expr<'g>) -> Option<Vec<Expr<'g>>> {
        let (symbol, output) = (z.symbol_in(self), e.atom_in(self));
        match self.with(|dag| dag.powers(symbol, output)) {
            Powers::Coefficients(coefficients) => {
                return Some(coefficients.into_iter().map(|c| self.expr(c)).collect());
            }
            Powers::BelowACall => return None, // four derivatives of a root would show the same
            Powers::Unknown => {}
        }
        let mut derivatives = vec![e];
        loop {
            let next = derivatives[derivatives.len() - 1].derivative(z);
            if next.is_zero() {
                break;
            }
            // The derivatives of a polynomial become shorter: where they grow, the expression is not one.
            let most = derivatives[derivatives.len() - 1].tree_cost().saturating_mul(2).checked_add(8);
            let growing = most.is_none_or(|most| next.tree_cost() > most);
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
}

/// The powers of a symbol in an expression, as far as they are visible without differentiating.
enum Powers {
    /// The coefficients.
    Coefficients(Vec<Atom>),
    /// The symbol occurs in a denominator, or its powers are high.
    Unknown,
    /// The symbol occurs in an argument of a function.
    BelowACall,
}

impl Dag {
    /// The powers of a symbol in sums and products, multiplied out.
    fn powers(&mut self, symbol: NodeId, output: Atom) -> Powers {
        let cone = Cone::below(self, [output]);
        let active = cone.depending_on(self, &[symbol]);
        if active.iter().any(|&node| matches!(self.node(node), Node::Call { .. } | Node::Applied { .. })) {
            return Powers::BelowACall;
        }
        let mut known: FxHashMap<NodeId, Vec<Atom>> = FxHashMap::default();
        known.insert(symbol, vec![Atom::ZERO, Atom::ONE]);
        for &node in cone.order.iter().filter(|&node| active.contains(node)) {
            let powers = match self.node(node) {
                Node::Sum { constant, terms } => {
                    let mut sums = vec![vec![(Atom::Constant(constant), Number::ONE)]];
                    for &(term, q) in self.terms(terms) {
                        let own = [Atom::Node(term)];
                        let powers = known.get(&term).map_or(&own[..], Vec::as_slice);
                        sums.resize(sums.len().max(powers.len()), Vec::new());
                        for (sum, &c) in sums.iter_mut().zip(powers) {
                            sum.push((c, q));
                        }
                    }
                    sums.iter().map(|terms| self.sum_of(terms)).collect()
                }
                Node::Product { factors } => {
                    let (moving, fixed): (Vec<_>, Vec<_>) =
                        self.factors(factors).iter().partition(|(factor, _)| active.contains(factor));
                    let mut powers = vec![self.product(Number::ONE, &fixed)];
                    for (factor, exponent) in moving {
                        if exponent < 0 {
                            return Powers::Unknown;
                        }
                        for _ in 0..exponent {
                            powers = self.multiply_powers(&powers, &known[&factor]);
                            if powers.len() > MAX_DEGREE + 1 {
                                return Powers::Unknown;
                            }
                        }
                    }
                    powers
                }
                _ => continue,
            };
            known.insert(node, powers);
        }
        let mut powers = match output {
            Atom::Node(node) => known.remove(&node).unwrap_or_else(|| vec![output]),
            Atom::Constant(_) => vec![output],
        };
        while powers.len() > 1 && powers.last().is_some_and(|c| c.is_zero()) {
            powers.pop();
        }
        Powers::Coefficients(powers)
    }

    /// The product of two polynomials given by their coefficients.
    fn multiply_powers(&mut self, a: &[Atom], b: &[Atom]) -> Vec<Atom> {
        let mut sums = vec![Vec::new(); a.len() + b.len() - 1];
        for (i, &a) in a.iter().enumerate().filter(|(_, a)| !a.is_zero()) {
            for (j, &b) in b.iter().enumerate().filter(|(_, b)| !b.is_zero()) {
                sums[i + j].push((self.product_of(Number::ONE, &[a, b]), Number::ONE));
            }
        }
        sums.iter().map(|terms| self.sum_of(terms)).collect()
    }
}
