//! Sines and cosines of sums of two angles, computed from those of the angles if that takes fewer calls.
//!
//! The N(N − 1)/2 differences of N absolute angles of a chain follow from the sines and cosines of the N
//! angles:
//!
//!   cos(σa ± τb) = cos a cos b ∓ στ sin a sin b and so on.
//!
//! The rounding error is equivalent to a shift of each angle by a unit in its last place.

use rustc_hash::{FxHashMap, FxHashSet};

use crate::graph::dag::Dag;
use crate::graph::function::Function;
use crate::graph::node::{Node, NodeId};
use crate::graph::subgraph::Cone;

/// An angle with a sign.
pub(crate) type SignedAngle = (NodeId, bool);

/// The sums ±a ± b whose sines and cosines are computed from those of a and b.
pub(crate) type Compositions = FxHashMap<NodeId, [SignedAngle; 2]>;

/// The compositions of a cone: of the sums that share angles, either all or none are composed.
pub(crate) fn compositions(dag: &Dag, cone: &Cone) -> Compositions {
    let mut called = FxHashSet::default();
    let mut sums: Vec<(NodeId, [SignedAngle; 2])> = Vec::new();
    for &id in &cone.order {
        if let Node::Call { function: Function::Sin | Function::Cos, args: [argument, ..] } = dag.node(id)
            && called.insert(argument)
            && let Some(angles) = sum_of_two(dag, argument)
        {
            sums.push((argument, angles));
        }
    }
    let mut families = Families::default();
    for (_, [(a, _), (b, _)]) in &sums {
        families.join(*a, *b);
    }
    // For each family the number of calls that its sums take directly, and the angles it would need instead.
    let mut balance: FxHashMap<NodeId, (usize, FxHashSet<NodeId>)> = FxHashMap::default();
    for (_, angles) in &sums {
        let (direct, composed) = balance.entry(families.head(angles[0].0)).or_default();
        *direct += 1;
        composed.extend(angles.iter().map(|(angle, _)| *angle).filter(|angle| !called.contains(angle)));
    }
    let pays = |angle| balance.get(&angle).is_some_and(|(direct, composed)| composed.len() < *direct);
    sums.into_iter().filter(|(_, angles)| pays(families.head(angles[0].0))).collect()
}

fn sum_of_two(dag: &Dag, argument: NodeId) -> Option<[SignedAngle; 2]> {
    let Node::Sum { constant, terms } = dag.node(argument) else { return None };
    let &[(a, p), (b, q)] = dag.terms(terms) else { return None };
    let plain = constant.is_zero() && p.abs().is_one() && q.abs().is_one();
    plain.then_some([(a, p.is_negative()), (b, q.is_negative())])
}

/// Disjoint sets of angles.
#[derive(Default)]
struct Families {
    parent: FxHashMap<NodeId, NodeId>,
}

impl Families {
    fn head(&self, mut angle: NodeId) -> NodeId {
        while let Some(&parent) = self.parent.get(&angle) {
            angle = parent;
        }
        angle
    }

    fn join(&mut self, a: NodeId, b: NodeId) {
        let (a, b) = (self.head(a), self.head(b));
        if a != b {
            self.parent.insert(a.max(b), a.min(b));
        }
    }
}
