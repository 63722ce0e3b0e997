//! Which factors products have in common: reciprocals and pairs that are worth computing once.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use crate::cone::Cone;
use crate::dag::{Dag, Node, NodeId};

/// Products of more factors than this are not searched for pairs.
const LONG: usize = 32;
/// Pairs of pairs of pairs …: deeper sharing is rare.
const ROUNDS: usize = 8;

/// Index of a factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct FactorId(u32);

/// Something products are made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Factor {
    /// n^e
    Power(NodeId, u32),
    /// (1/n)^e, for a divisor that several products have
    Reciprocal(NodeId, u32),
    /// Two factors that several products have in common.
    Pair(FactorId, FactorId),
}

/// A product, its factors over its divisors.
#[derive(Clone, Debug, Default)]
pub(crate) struct SharedProduct {
    pub(crate) factors: Vec<FactorId>,
    pub(crate) divisors: Vec<FactorId>,
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
    pub(crate) fn of(dag: &Dag, cone: &Cone) -> SharedProducts {
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

    /// Makes factors of the pairs that most products have; answers whether there were any.
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
        pairs.sort_by_key(|(_, products)| std::cmp::Reverse(products.len())); // stable: ties stay ordered
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
