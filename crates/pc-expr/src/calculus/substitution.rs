//! Expressions with symbols replaced.

use crate::graph::dag::Dag;
use crate::graph::expr::Expr;
use crate::graph::graph::Graph;
use crate::graph::node::{Atom, Folding, Node, NodeId};
use crate::graph::number::Number;
use crate::graph::subgraph::{Assignment, Cone};

impl Graph {
    /// `outputs` with each symbol of `replacements` replaced by the expression beside it, all at once.
    ///
    /// A replaced symbol is in the results only where the replacing expressions contain it.
    ///
    /// # Panics
    /// If the first of a pair is not a symbol.
    pub fn substitute<'g>(
        &'g self,
        outputs: &[Expr<'g>],
        replacements: &[(Expr<'g>, Expr<'g>)],
    ) -> Vec<Expr<'g>> {
        let pairs: Vec<(NodeId, Atom)> = replacements
            .iter()
            .map(|(symbol, value)| (symbol.symbol_in(self), value.atom_in(self)))
            .collect();
        let outputs: Vec<Atom> = outputs.iter().map(|x| x.atom_in(self)).collect();
        let mut results = self.build_all(|dag| dag.substitute(&outputs, &pairs));
        if self.folding() == Folding::ByValue {
            self.drop_returned(&mut results, replacements);
        }
        results
    }

    /// Writes results of a substitution without the symbols that it replaced.
    ///
    /// Such a symbol comes back where it cancels: the result then has the value of an older and cheaper expression
    /// that is written with it.
    fn drop_returned<'g>(&'g self, results: &mut [Expr<'g>], replacements: &[(Expr<'g>, Expr<'g>)]) {
        let mut returned = self.symbols_of(results);
        returned.retain(|symbol| replacements.iter().any(|(replaced, _)| replaced == symbol));
        if returned.is_empty() {
            return;
        }
        let put_in = self.symbols_of(&replacements.iter().map(|&(_, value)| value).collect::<Vec<_>>());
        for symbol in returned.into_iter().filter(|symbol| !put_in.contains(symbol)) {
            for result in results.iter_mut().filter(|result| self.symbols_of(&[**result]).contains(&symbol)) {
                *result = self.without_symbol(*result, symbol);
            }
        }
    }
}

impl Dag {
    /// `outputs` with symbols (or other nodes) replaced, rebuilt bottom-up.
    pub(crate) fn substitute(&mut self, outputs: &[Atom], replacements: &[(NodeId, Atom)]) -> Vec<Atom> {
        let cone = Cone::below(self, outputs.iter().copied());
        let replaced: Vec<NodeId> = replacements.iter().map(|&(node, _)| node).collect();
        let active = cone.depending_on(self, &replaced);
        let mut values = Assignment::from_pairs(replacements);
        for &node in &cone.order {
            if !active.contains(&node) || values.contains(node) {
                continue;
            }
            let value = match self.node(node) {
                Node::Constant(_) | Node::Symbol(_) => Atom::Node(node),
                Node::Sum { constant, terms } => {
                    let mut sum: Vec<(Atom, Number)> =
                        self.terms(terms).iter().map(|&(child, q)| (values.node(child), q)).collect();
                    sum.push((Atom::Constant(constant), Number::ONE));
                    self.sum_of(&sum)
                }
                Node::Product { factors } => {
                    let factors = self.factors(factors).to_vec();
                    let powers: Vec<Atom> = factors
                        .iter()
                        .map(|&(child, e)| match values.node(child) {
                            zero if zero.is_zero() && e < 0 => self.divide(Atom::ONE, zero),
                            value => self.powi(value, e),
                        })
                        .collect();
                    self.product_of(Number::ONE, &powers)
                }
                Node::Call { function, args } => {
                    let args: Vec<Atom> = Dag::args(function, &args)
                        .iter()
                        .map(|&child| self.constant_of(values.node(child)))
                        .collect();
                    self.call(function, &args)
                }
            };
            values.set(node, value);
        }
        outputs.iter().map(|&output| values.atom(output)).collect()
    }
}
