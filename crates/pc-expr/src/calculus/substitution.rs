//! Expressions with symbols replaced.

use rustc_hash::FxHashMap;

use crate::graph::dag::Dag;
use crate::graph::expr::Expr;
use crate::graph::graph::Graph;
use crate::graph::node::{Atom, Folding, Node, NodeId};
use crate::graph::number::Number;
use crate::graph::places::SymbolPlaces;
use crate::graph::subgraph::{Assignment, Cone};
use crate::graph::transcription::Transcription;

/// Symbols with their replacements. The cost of applying the list to an expression depends only on the size
/// of that expression, however long the list is.
#[derive(Clone, Debug)]
pub struct Substitution<'g> {
    graph: &'g Graph,
    by_node: FxHashMap<NodeId, Atom>,
    values: Vec<Expr<'g>>,
}

impl<'g> Substitution<'g> {
    /// `outputs` with each symbol replaced, as by [`Graph::substitute`].
    pub fn apply(&self, outputs: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let graph = self.graph;
        let outputs: Vec<Atom> = outputs.iter().map(|x| x.atom_in(graph)).collect();
        let mut results = graph.build_all(|dag| {
            let cone = Cone::below(dag, outputs.iter().copied());
            let pair = |&node: &NodeId| Some((node, *self.by_node.get(&node)?));
            let pairs: Vec<(NodeId, Atom)> = cone.order.iter().filter_map(pair).collect();
            match pairs.is_empty() {
                true => outputs,
                false => dag.substitute(&outputs, &pairs),
            }
        });
        if graph.folding() == Folding::ByValue {
            self.drop_returned(&mut results);
        }
        results
    }

    /// Writes results without the symbols that were replaced.
    ///
    /// A symbol that cancels may reappear, because the graph prefers an older, cheaper expression with the
    /// same value that contains the symbol.
    fn drop_returned(&self, results: &mut [Expr<'g>]) {
        let graph = self.graph;
        let is_replaced = |symbol: &Expr<'g>| match symbol.atom() {
            Atom::Node(node) => self.by_node.contains_key(&node),
            Atom::Constant(_) => false,
        };
        let mut returned = graph.symbols_of(results);
        returned.retain(is_replaced);
        if returned.is_empty() {
            return;
        }
        let put_in = SymbolPlaces::of(&graph.symbols_of(&self.values));
        for symbol in returned.into_iter().filter(|&symbol| !put_in.contains(symbol)) {
            for result in results.iter_mut().filter(|result| graph.symbols_of(&[**result]).contains(&symbol))
            {
                *result = graph.without_symbol(*result, symbol);
            }
        }
    }
}

impl Graph {
    /// The substitution that replaces each symbol of `replacements` by the expression paired with it, all at
    /// once.
    ///
    /// ```
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [x, y, z] = graph.symbols(["x", "y", "z"]);
    /// let swap = graph.substitution(&[(x, y), (y, x)]);
    /// assert_eq!(swap.apply(&[x - y, z]), [y - x, z]);
    /// ```
    ///
    /// # Panics
    /// If the first of a pair is not a symbol.
    pub fn substitution<'g>(&'g self, replacements: &[(Expr<'g>, Expr<'g>)]) -> Substitution<'g> {
        let pair = |(symbol, value): &(Expr<'g>, Expr<'g>)| (symbol.symbol_in(self), value.atom_in(self));
        Substitution {
            graph: self,
            by_node: replacements.iter().map(pair).collect(),
            values: replacements.iter().map(|&(_, value)| value).collect(),
        }
    }

    /// `outputs` with each symbol of `replacements` replaced by the expression paired with it, all at once.
    ///
    /// A replaced symbol occurs in the results only if the replacing expressions contain it.
    ///
    /// # Panics
    /// If the first of a pair is not a symbol.
    pub fn substitute<'g>(
        &'g self,
        outputs: &[Expr<'g>],
        replacements: &[(Expr<'g>, Expr<'g>)],
    ) -> Vec<Expr<'g>> {
        self.substitution(replacements).apply(outputs)
    }

    /// The expressions rebuilt in another graph, from symbols with the same names.
    pub fn transcribe<'g, 'h>(&'g self, expressions: &[Expr<'g>], into: &'h Graph) -> Vec<Expr<'h>> {
        if !self.undetermined_in(expressions).is_empty() {
            // A function of numbers, V(0), has no graph but that into which it is written.
            let copy = Transcription::new(self, into);
            return expressions.iter().map(|&expression| copy.write(expression)).collect();
        }
        let symbols: Vec<(Expr<'g>, Expr<'h>)> = self
            .symbols_of(expressions)
            .into_iter()
            .map(|symbol| (symbol, into.symbol(&symbol.symbol_name().unwrap_or_default())))
            .collect();
        self.evaluate(expressions, &symbols).unwrap_or_default() // every symbol has its value
    }
}

impl Dag {
    /// `outputs` with symbols (or other nodes) replaced, rebuilt bottom-up.
    pub(crate) fn substitute(&mut self, outputs: &[Atom], replacements: &[(NodeId, Atom)]) -> Vec<Atom> {
        let Some(cone) = self.cone_within_budget(outputs.iter().copied()) else {
            return vec![Atom::Constant(Number::UNDEFINED); outputs.len()];
        };
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
                Node::Applied { function, args } => {
                    let args: Vec<Atom> = function
                        .args(&args)
                        .iter()
                        .map(|&child| self.constant_of(values.node(child)))
                        .collect();
                    self.applied(function, &args)
                }
            };
            values.set(node, value);
        }
        outputs.iter().map(|&output| values.atom(output)).collect()
    }
}
