//! Loops of a tree, which are closed after its joints have been eliminated.

use pc_expr::{Graph, Inputs, Transcription};

use crate::compiled::elimination::schur::Schur;
use crate::compiled::options::{CompileOptions, TreeElimination};
use crate::constraints::constraint::Constraint;
use crate::constraints::multipliers::Multipliers;
use crate::error::MechError;
use crate::tree::equations::TreeEquations;
use crate::tree::system::TreeSystem;

impl<'g> Multipliers<'g> {
    /// The same equations, derived again in an empty graph, for a [system](crate::System) that is a tree.
    ///
    /// # Errors
    /// As for [`with_multipliers`](crate::System::with_multipliers), which made the original equations.
    pub(crate) fn in_graph<'n>(&self, graph: &'n Graph) -> Result<Multipliers<'n>, MechError> {
        let system = &self.equations.system;
        let copy = Transcription::new(system.graph(), graph);
        let put = |constraint: &Constraint<'g>| Constraint {
            name: constraint.name.clone(),
            expression: copy.write(constraint.expression),
            nonlinear: constraint.nonlinear,
        };
        let own = system.in_graph(graph);
        let held = own.with_multipliers(&self.constraints.iter().map(put).collect::<Vec<_>>())?;
        Ok(Multipliers {
            followers: self.followers.iter().map(put).collect(),
            dependent: self.dependent.clone(),
            observed: self.observed,
            ..held
        })
    }

    /// The solver, joint by joint, for accelerations and for the reactions of the first `rank` constraints;
    /// `None` for a system that is not a tree.
    ///
    /// # Errors
    /// As for [`compile_for`](Multipliers::compile_for).
    pub(crate) fn by_joints(
        &self,
        options: &CompileOptions,
        rank: usize,
    ) -> Result<Option<Schur>, MechError> {
        let system = &self.equations.system;
        if system.tree.is_none() || options.elimination == TreeElimination::Whole {
            return Ok(None);
        }
        // An empty graph: the steps that lead to the full matrix differ.
        let graph = system.graph().page(system.graph().folding());
        let copy = Transcription::new(system.graph(), &graph);
        let own = system.in_graph(&graph);
        let Some(tree) = &own.tree else { return Ok(None) };
        let tree = TreeEquations {
            dynamics: tree.dynamics(&own.frame, &own.forces),
            system: TreeSystem::clone(tree),
        };
        let row = |a: usize| self.coefficients.row(a).iter().map(|&c| copy.write(c)).collect::<Vec<_>>();
        let rows: Vec<_> = (0..rank).map(row).collect();
        let right: Vec<_> = self.right[..rank].iter().map(|&rate| copy.write(rate)).collect();
        let inputs = Inputs {
            time: Some(own.frame.time()),
            state: own.state(),
            parameters: own.run_time_inputs().into_iter().map(|(symbol, _)| symbol).collect(),
        };
        Ok(Schur::new(&graph, &inputs, &tree, (&rows, &right), options.backend)?)
    }
}
