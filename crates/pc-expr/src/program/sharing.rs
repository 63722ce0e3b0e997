//! Common factors of products: reciprocals and pairs that are computed once.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use crate::graph::dag::Dag;
use crate::graph::node::{Atom, Node, NodeId};
use crate::graph::subgraph::Cone;

/// Products with more factors than this are not searched for pairs.
const LONG: usize = 32;
/// The maximum number of rounds of pairing; deeper sharing is rare.
const ROUNDS: usize = 8;

/// Index of a factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct FactorId(u32);

/// A factor of products.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Factor {
    /// n^e
    Power(NodeId, u32),
    /// (1/n)^e, for a divisor that several products have in common
    Reciprocal(NodeId, u32),
    /// Two factors that several products have in common.
    Pair(FactorId, FactorId),
    /// The bits of the coefficient from the only sum that uses the product.
    Constant(u64),
}

/// A product: its factors over its divisors.
#[derive(Clone, Debug, Default)]
pub(crate) struct SharedProduct {
    pub(crate) factors: Vec<FactorId>,
    pub(crate) divisors: Vec<FactorId>,
    /// Whether the factors contain the magnitude of its coefficient in the only sum that uses it.
    pub(crate) scaled: bool,
}

/// The products of a cone.
#[derive(Debug, Default)]
pub(crate) struct SharedProducts {
    factors: Vec<Factor>,
    known: FxHashMap<Factor, FactorId>,
    positions: FxHashMap<NodeId, usize>,
    products: Vec<SharedProduct>,
}

impl SharedProducts {
    /// The products of the cone below `outputs`.
    pub(crate) fn of(dag: &Dag, cone: &Cone, outputs: &[Atom]) -> SharedProducts {
        let mut shared = SharedProducts::default();
        let products = || {
            cone.order.iter().filter_map(|&id| match dag.node(id) {
                Node::Product { factors } => Some((id, dag.factors(factors))),
                _ => None,
            })
        };
        let mut divided_by: FxHashMap<NodeId, u32> = FxHashMap::default();
        for (node, _) in products().flat_map(|(_, factors)| factors).filter(|(_, e)| *e < 0) {
            *divided_by.entry(*node).or_insert(0) += 1;
        }
        let coefficients = coefficients(dag, cone, outputs);
        for (id, factors) in products() {
            let mut product = SharedProduct::default();
            for &(node, e) in factors {
                let exponent = e.unsigned_abs();
                if e > 0 {
                    product.factors.push(shared.intern(Factor::Power(node, exponent)));
                } else if divided_by[&node] > 1 {
                    product.factors.push(shared.intern(Factor::Reciprocal(node, exponent)));
                } else {
                    product.divisors.push(shared.intern(Factor::Power(node, exponent)));
                }
            }
            if let Some(&size) = coefficients.get(&id).filter(|_| product.divisors.is_empty()) {
                product.factors.push(shared.intern(Factor::Constant(size)));
                product.scaled = true;
            }
            shared.positions.insert(id, shared.products.len());
            shared.products.push(product);
        }
        for _ in 0..ROUNDS {
            if !shared.extract_pairs() {
                break;
            }
        }
        shared
    }

    /// Whether the node is a product that contains the magnitude of its coefficient in a sum.
    pub(crate) fn is_scaled(&self, id: NodeId) -> bool {
        self.positions.get(&id).is_some_and(|&position| self.products[position].scaled)
    }

    pub(crate) fn product(&self, id: NodeId) -> &SharedProduct {
        &self.products[self.positions[&id]]
    }

    pub(crate) fn factor(&self, id: FactorId) -> Factor {
        self.factors[id.0 as usize]
    }

    fn intern(&mut self, factor: Factor) -> FactorId {
        let factors = &mut self.factors;
        *self.known.entry(factor).or_insert_with(|| {
            factors.push(factor);
            FactorId(factors.len() as u32 - 1)
        })
    }

    /// Turns the pairs that most products share into factors. Returns whether there were such pairs.
    fn extract_pairs(&mut self) -> bool {
        let mut occurrences: BTreeMap<(FactorId, FactorId), Vec<usize>> = BTreeMap::new();
        for (position, product) in self.products.iter().enumerate() {
            let factors = &product.factors;
            if factors.len() > LONG {
                continue;
            }
            for (i, &first) in factors.iter().enumerate() {
                for &second in &factors[i + 1..] {
                    let pair = (first.min(second), first.max(second));
                    occurrences.entry(pair).or_default().push(position);
                }
            }
        }
        let mut pairs: Vec<_> = occurrences.into_iter().filter(|(_, products)| products.len() > 1).collect();
        pairs.sort_by_key(|(_, products)| std::cmp::Reverse(products.len())); // stable: ties keep their order
        let mut extracted = false;
        for ((first, second), products) in pairs {
            let has_both = |product: &SharedProduct| {
                product.factors.contains(&first) && product.factors.contains(&second)
            };
            let products: Vec<usize> =
                products.into_iter().filter(|&p| has_both(&self.products[p])).collect();
            if products.len() < 2 {
                continue;
            }
            let pair = self.intern(Factor::Pair(first, second));
            for position in products {
                let factors = &mut self.products[position].factors;
                factors.retain(|&factor| factor != first && factor != second);
                factors.push(pair);
            }
            extracted = true;
        }
        extracted
    }
}

/// The magnitudes, as bits, of the coefficients of nodes that are used only in one sum.
fn coefficients(dag: &Dag, cone: &Cone, outputs: &[Atom]) -> FxHashMap<NodeId, u64> {
    let mut uses: FxHashMap<NodeId, u32> = FxHashMap::default();
    for output in outputs {
        if let Atom::Node(id) = output {
            *uses.entry(*id).or_insert(0) += 1;
        }
    }
    for &id in &cone.order {
        dag.for_each_child(id, |child| *uses.entry(child).or_insert(0) += 1);
    }
    let mut coefficients = FxHashMap::default();
    for &id in &cone.order {
        let Node::Sum { terms, .. } = dag.node(id) else { continue };
        for &(term, q) in dag.terms(terms) {
            if uses[&term] == 1 && !q.abs().is_one() {
                coefficients.insert(term, q.abs().to_f64().to_bits());
            }
        }
    }
    coefficients
}
