//! Values of expressions at random points of GF(2⁶¹ − 1).

use rustc_hash::FxHashMap;

use crate::graph::expr::Expr;
use crate::graph::graph::Graph;
use crate::graph::node::{Atom, Folding, Node, NodeId};
use crate::graph::number::Number;
use crate::graph::subgraph::Cone;
use crate::identity::fingerprint::Fingerprint;
use crate::identity::prime_field::Residue;

/// Expressions to be evaluated in GF(2⁶¹ − 1) at any number of points.
///
/// The fingerprint of a symbol depends on its name, so another set of names gives another point. Sums and
/// products are evaluated in the field; calls are written once more, with the other names, in a graph that
/// is then discarded.
pub(super) struct Sampler<'g> {
    graph: &'g Graph,
    outputs: Vec<Atom>,
    cone: Cone,
    symbols: Vec<Expr<'g>>,
    /// Symbols whose values depend on their places only.
    constants: Vec<Expr<'g>>,
    calls: Vec<Expr<'g>>,
}

impl<'g> Sampler<'g> {
    pub(super) fn new(graph: &'g Graph, outputs: &[Expr<'g>], constants: &[Expr<'g>]) -> Sampler<'g> {
        let symbols = graph.symbols_of(outputs);
        let outputs: Vec<Atom> = outputs.iter().map(|x| x.atom_in(graph)).collect();
        let cone = graph.with(|dag| Cone::below(dag, outputs.iter().copied()));
        // Roots keep their laws in a graph only: where there are any, every node is written once more.
        let rooted = graph.with(|dag| cone.order.iter().any(|&id| !dag.is_plain(id)));
        let called = |&&id: &&NodeId| {
            rooted || graph.with(|dag| matches!(dag.node(id), Node::Call { .. } | Node::Applied { .. }))
        };
        let calls = cone.order.iter().filter(called).map(|&id| graph.expr(Atom::Node(id))).collect();
        Sampler { graph, outputs, cone, symbols, constants: constants.to_vec(), calls }
    }

    /// The values at point number `point` of the symbols, and at the given place of each constant.
    pub(super) fn at(&self, point: usize, places: &[usize]) -> Vec<Residue> {
        let mut values = self.unknowns(point, places);
        self.graph.with(|dag| {
            let of = |values: &FxHashMap<NodeId, Residue>, id: &NodeId| {
                values.get(id).copied().unwrap_or_default()
            };
            for &id in &self.cone.order {
                if values.contains_key(&id) {
                    continue;
                }
                let value = match dag.node(id) {
                    Node::Constant(c) => constant(c),
                    Node::Symbol(_) | Node::Call { .. } | Node::Applied { .. } => continue,
                    Node::Sum { constant: c, terms } => dag
                        .terms(terms)
                        .iter()
                        .fold(constant(c), |sum, (child, q)| sum + constant(*q) * of(&values, child)),
                    Node::Product { factors } => dag
                        .factors(factors)
                        .iter()
                        .fold(Residue::ONE, |product, (child, e)| product * of(&values, child).powi(*e)),
                };
                values.insert(id, value);
            }
            let output = |atom: &Atom| match atom {
                Atom::Constant(c) => constant(*c),
                Atom::Node(id) => of(&values, id),
            };
            self.outputs.iter().map(output).collect()
        })
    }

    /// The values of symbols and calls.
    fn unknowns(&self, point: usize, places: &[usize]) -> FxHashMap<NodeId, Residue> {
        let page = Graph::with_folding(Folding::Structural);
        let renamed = |symbol: &Expr<'g>| match self.constants.iter().position(|c| c == symbol) {
            Some(i) => page.symbol(&name_at(*symbol, places.get(i).copied().unwrap_or(0))),
            None => page.symbol(&format!("{symbol}@{point}")),
        };
        let renamed: Vec<_> = self.symbols.iter().map(|symbol| (*symbol, renamed(symbol))).collect();
        // Every symbol below a call is in the list, so all are bound.
        let calls = self.graph.evaluate(&self.calls, &renamed).unwrap_or_default();
        let calls = self.calls.iter().copied().zip(calls);
        renamed
            .iter()
            .copied()
            .chain(calls)
            .filter_map(|(original, image)| match original.atom() {
                Atom::Node(id) => Some((id, value(&page, image))),
                Atom::Constant(_) => None,
            })
            .collect()
    }
}

/// The name under which a constant has its value at a place; at place 0, its own name.
fn name_at(symbol: Expr<'_>, place: usize) -> String {
    if place == 0 { symbol.to_string() } else { format!("{symbol}@{place}") }
}

/// The value of a constant at a place.
pub(super) fn value_at(symbol: Expr<'_>, place: usize) -> Residue {
    Fingerprint::symbol(&name_at(symbol, place)).first()
}

fn constant(c: Number) -> Residue {
    c.fingerprint().first()
}

fn value(graph: &Graph, expression: Expr<'_>) -> Residue {
    match expression.atom() {
        Atom::Constant(c) => constant(c),
        Atom::Node(id) => graph.with(|dag| dag.fingerprint(id).first()),
    }
}
