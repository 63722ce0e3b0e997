//! Symbols looked up in a list of symbols.

use rustc_hash::FxHashMap;

use crate::graph::expr::Expr;
use crate::graph::node::{Atom, NodeId};

/// The index of each symbol in a list: without such a table, looking up all n symbols takes n² comparisons.
///
/// ```
/// # use pc_expr::{Graph, SymbolPlaces};
/// let graph = Graph::new();
/// let [x, y, z] = graph.symbols(["x", "y", "z"]);
/// let places = SymbolPlaces::of(&[y, x]);
/// assert_eq!([x, y, z].map(|symbol| places.get(symbol)), [Some(1), Some(0), None]);
/// ```
#[derive(Clone, Debug, Default)]
pub struct SymbolPlaces {
    by_node: FxHashMap<NodeId, usize>,
}

impl SymbolPlaces {
    /// The indices in a list; for a symbol that occurs twice, the first index. An expression that is not a
    /// symbol has no index.
    pub fn of(symbols: &[Expr<'_>]) -> SymbolPlaces {
        let mut by_node = FxHashMap::default();
        for (place, symbol) in symbols.iter().enumerate() {
            if let Atom::Node(node) = symbol.atom() {
                by_node.entry(node).or_insert(place);
            }
        }
        SymbolPlaces { by_node }
    }

    /// The index in the list of a symbol of the same graph.
    pub fn get(&self, symbol: Expr<'_>) -> Option<usize> {
        match symbol.atom() {
            Atom::Node(node) => self.of_node(node),
            Atom::Constant(_) => None,
        }
    }

    /// Whether a symbol of the same graph is in the list.
    pub fn contains(&self, symbol: Expr<'_>) -> bool {
        self.get(symbol).is_some()
    }

    pub(crate) fn of_node(&self, node: NodeId) -> Option<usize> {
        self.by_node.get(&node).copied()
    }
}
