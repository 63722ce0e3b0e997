//! A system that is a tree, in a graph of its own.

use pc_expr::{Expr, Graph, Transcription};

use crate::system::system::System;

impl<'g> System<'g> {
    /// The same system in an empty graph: derivations there depend on the system alone, to the last bit, whatever
    /// else the original graph contains.
    pub(crate) fn in_graph<'n>(&self, graph: &'n Graph) -> System<'n> {
        let copy = Transcription::new(self.graph(), graph);
        let put = |x: Expr<'g>| copy.write(x);
        let all = |list: &[Expr<'g>]| list.iter().map(|&x| put(x)).collect::<Vec<_>>();
        let named = |list: &[(String, Expr<'g>)]| {
            list.iter().map(|(name, x)| (name.clone(), put(*x))).collect::<Vec<_>>()
        };
        // Symbols first, in the order of the state.
        all(&self.state());
        let parameters = self.parameters.iter().map(|&(symbol, value)| (put(symbol), value)).collect();
        let frame = self.frame.written_in(graph, put);
        let tree = self.tree.as_ref().map(|tree| Box::new(tree.map(graph, put)));
        System {
            frame,
            parameters,
            structure: self.structure.map(put),
            quasi_velocities: all(&self.quasi_velocities),
            signals: all(&self.signals),
            forces: all(&self.forces),
            external: named(&self.external),
            states: self.states.iter().map(|&(z, rate)| (put(z), put(rate))).collect(),
            lagrangian: tree.as_ref().map_or_else(|| put(self.lagrangian), |tree| tree.lagrangian()),
            integrals: named(&self.integrals),
            outputs: named(&self.outputs),
            bodies: self.bodies.map(all),
            gravity: self.gravity.map(put),
            holds: self.holds.iter().map(|hold| hold.map(put)).collect(),
            unit_quaternions: self.unit_quaternions.iter().map(|q| q.map(put)).collect(),
            tree,
        }
    }
}
