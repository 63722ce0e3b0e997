//! Sums whose brackets are multiplied out if terms then cancel, or combine into the sine or cosine of a sum:
//! cos a (p sin a + q sin b) − sin a (p cos a + q cos b) = −q sin(a − b).

use rustc_hash::FxHashMap;

use crate::calculus::typeset::{Factors, Term};
use crate::graph::dag::Dag;
use crate::graph::expr::Expr;
use crate::graph::graph::Graph;
use crate::graph::node::{Atom, Folding, Node, NodeId};
use crate::graph::number::Number;
use crate::graph::subgraph::Cone;

/// Brackets that would give more products than this are not multiplied out.
const MOST_PRODUCTS: usize = 24;
/// Expressions with more nodes than this are left as they are.
const MOST_NODES: usize = 4000;

impl Graph {
    /// The expressions with their brackets multiplied out if sines and cosines then merge into a shorter
    /// form.
    ///
    /// ```
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [a, b, p, q] = graph.symbols(["a", "b", "p", "q"]);
    /// let (x, y) = (p * a.cos() + q * b.cos(), p * a.sin() + q * b.sin());
    /// assert_eq!(graph.merged_angles(&[y * a.cos() - x * a.sin()])[0].to_string(), "-q*sin(a - b)");
    /// ```
    pub fn merged_angles<'g>(&'g self, expressions: &[Expr<'g>]) -> Vec<Expr<'g>> {
        if self.folding() == Folding::Structural {
            return expressions.to_vec();
        }
        let roots: Vec<Atom> = expressions.iter().map(|expression| expression.atom_in(self)).collect();
        let merged = self.with(|dag| {
            let cone = Cone::below(dag, roots.iter().copied());
            if cone.order.len() > MOST_NODES {
                return roots.clone();
            }
            let mut merged: FxHashMap<NodeId, Atom> = FxHashMap::default();
            for &node in &cone.order {
                let atom = dag.with_children_merged(node, &merged);
                merged.insert(node, atom);
            }
            let atom = |root: &Atom| match root {
                Atom::Constant(_) => *root,
                Atom::Node(node) => merged[node],
            };
            roots.iter().map(atom).collect()
        });
        merged.into_iter().map(|atom| self.expr(atom)).collect()
    }
}

impl Dag {
    /// A node with its children replaced by their merged forms, merged itself if it is a sum.
    fn with_children_merged(&mut self, node: NodeId, merged: &FxHashMap<NodeId, Atom>) -> Atom {
        let same = |child: &NodeId| merged[child] == Atom::Node(*child);
        match self.node(node) {
            Node::Constant(_) | Node::Symbol(_) => Atom::Node(node),
            Node::Call { function, args } => {
                let args = Dag::args(function, &args);
                if args.iter().all(same) {
                    return Atom::Node(node);
                }
                let args: Vec<Atom> = args.iter().map(|arg| merged[arg]).collect();
                self.call(function, &args)
            }
            Node::Applied { function, args } => {
                let args = function.args(&args);
                if args.iter().all(same) {
                    return Atom::Node(node);
                }
                let args: Vec<Atom> = args.iter().map(|arg| merged[arg]).collect();
                self.applied(function, &args)
            }
            Node::Product { factors } => {
                let factors = self.factors(factors).to_vec();
                if factors.iter().all(|(factor, _)| same(factor)) {
                    return Atom::Node(node);
                }
                let powers: Vec<Atom> =
                    factors.iter().map(|(factor, e)| self.powi(merged[factor], *e)).collect();
                self.product_of(Number::ONE, &powers)
            }
            Node::Sum { constant, terms } => {
                let terms = self.terms(terms).to_vec();
                let rebuilt = if terms.iter().all(|(term, _)| same(term)) {
                    Atom::Node(node)
                } else {
                    let terms = terms.iter().map(|&(term, q)| (merged[&term], q));
                    let all: Vec<_> = terms.chain([(Atom::Constant(constant), Number::ONE)]).collect();
                    self.sum_of(&all)
                };
                self.sum_merged(rebuilt)
            }
        }
    }

    fn sum_merged(&mut self, sum: Atom) -> Atom {
        let Some((scale, constant, terms)) = self.terms_of(sum) else { return sum };
        let Some((constant, terms)) = self.multiplied_out(constant, &terms) else { return sum };
        let merged = self.sum_of_terms(constant, &terms);
        let merged = self.scale(scale, merged);
        if self.atom_cost(merged) < self.atom_cost(sum) { merged } else { sum }
    }

    fn atom_cost(&self, atom: Atom) -> u32 {
        match atom {
            Atom::Constant(_) => 0,
            Atom::Node(node) => self.cost(node),
        }
    }

    /// c + Σ with all brackets multiplied out, if terms then cancel or merge.
    pub(super) fn multiplied_out(&mut self, constant: Number, terms: &[Term]) -> Option<(Number, Vec<Term>)> {
        let (mut open, mut constant) = (terms.to_vec(), constant);
        let mut done: Vec<Term> = Vec::new();
        let mut brackets = false;
        while let Some(Term { q, mut factors }) = open.pop() {
            let is_sum = |&(node, e): &(NodeId, i32)| e == 1 && matches!(self.node(node), Node::Sum { .. });
            let Some(place) = factors.iter().position(is_sum) else {
                done.push(Term { q, factors: gathered(factors) });
                continue;
            };
            brackets = true;
            let (sum, _) = factors.remove(place);
            let Node::Sum { constant: last, terms } = self.node(sum) else { continue };
            for &(term, p) in self.terms(terms) {
                let alone = [(term, 1)];
                let own = match self.node(term) {
                    Node::Product { factors } => self.factors(factors),
                    _ => &alone,
                };
                open.push(Term { q: q * p, factors: factors.iter().chain(own).copied().collect() });
            }
            if !last.is_zero() {
                open.push(Term { q: q * last, factors });
            }
            if open.len() + done.len() > MOST_PRODUCTS {
                return None;
            }
        }
        if !brackets {
            return None;
        }
        let before = done.len();
        done.sort_by(|a, b| a.factors.cmp(&b.factors));
        done.dedup_by(|next, kept| {
            let same = next.factors == kept.factors;
            if same {
                kept.q = kept.q + next.q;
            }
            same
        });
        done.retain(|term| {
            if term.factors.is_empty() {
                constant = constant + term.q;
            }
            !term.q.is_zero() && !term.factors.is_empty()
        });
        self.merge_angles(&mut done);
        (done.len() < before).then_some((constant, done))
    }
}

/// The factors in ascending order of their nodes, with each node listed once.
fn gathered(mut factors: Factors) -> Factors {
    factors.sort_unstable_by_key(|&(node, _)| node);
    factors.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        if same {
            kept.1 += next.1;
        }
        same
    });
    factors.retain(|&(_, e)| e != 0);
    factors
}
