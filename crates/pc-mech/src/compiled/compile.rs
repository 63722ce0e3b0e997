//! Compiles equations into a motion.

use std::rc::Rc;

use pc_expr::{Expr, Graph};

use crate::compiled::change_point::watch::Watch;
use crate::compiled::elimination::cost;
use crate::compiled::elimination::numeric::Staged;
use crate::compiled::elimination::symbolic::Unrolled;
use crate::compiled::first_order::FirstOrder;
use crate::compiled::motion::{Form, Motion};
use crate::compiled::options::{CompileOptions, TreeElimination};
use crate::equations::poincare::Equations;
use crate::error::MechError;
use crate::points::equations::{PointEquations, may_carry};
use crate::system::signals::Signals;

/// M⁻¹ is written out if the factorisation of M takes no more operations than the factorisation of a full
/// matrix of 16 rows. That includes all smaller systems, and larger ones with sparse coupling.
pub(crate) const LONGEST_ELIMINATION: usize = 16 * 15 * 20 / 6;

impl<'g> Equations<'g> {
    /// Compiles the equations, their Jacobian and the observables: integrals, energy, outputs.
    ///
    /// The program itself solves for accelerations, unless there are many quasi-velocities, most of them
    /// coupled with each other: in that case M is factorised numerically at each call.
    ///
    /// # Errors
    /// [`ExprError::UnboundSymbol`](crate::ExprError::UnboundSymbol) for a symbol that is neither state nor
    /// declared parameter; [`LagrangianError::Degenerate`](crate::LagrangianError::Degenerate) where a joint
    /// of a tree moves nothing that has inertia.
    pub fn compile(&self) -> Result<Motion, MechError> {
        self.compile_for(CompileOptions::default())
    }

    /// Compiles as [`compile`](Equations::compile) does, with other derivatives or for another
    /// [kernel](pc_expr::Backend).
    ///
    /// # Errors
    /// As for [`compile`](Equations::compile).
    pub fn compile_for(&self, options: impl Into<CompileOptions>) -> Result<Motion, MechError> {
        let options = options.into();
        let graph = self.system.graph().page(self.system.graph().folding());
        if self.system.tree.is_none() {
            if let Some(carried) = self.carried_in(&graph, options.elimination)? {
                return carried.compile(&options, LONGEST_ELIMINATION);
            }
            return self.first_order().compile(&options, LONGEST_ELIMINATION);
        }
        let equations = self.system.in_graph(&graph).poincare()?;
        let first_order = equations.shortest_first_order(options.elimination);
        if let Some(tree) = &first_order.tree {
            tree.check_regular(&first_order.names)?;
        }
        first_order.compile(&options, LONGEST_ELIMINATION)
    }

    /// The first-order system of bodies that carry one another, in another graph, where it takes fewer operations;
    /// none for other systems.
    fn carried_in<'n>(
        &self,
        graph: &'n Graph,
        elimination: TreeElimination,
    ) -> Result<Option<FirstOrder<'n>>, MechError> {
        if elimination == TreeElimination::Whole || !may_carry(&self.system) || self.has_pieces() {
            return Ok(None);
        }
        let system = self.system.in_graph(graph);
        let Some(points) = PointEquations::of(&system) else { return Ok(None) };
        let whole = system.poincare()?.first_order();
        let carried = FirstOrder { points: Some(Rc::new(points)), ..whole.clone() };
        let is_shorter = || {
            cost::operations(&whole.mass) > LONGEST_ELIMINATION || carried.operations() < whole.operations()
        };
        Ok((elimination == TreeElimination::ByJoints || is_shorter()).then_some(carried))
    }

    /// Whether forces or energies may be piecewise functions, or something holds the motion at rest.
    fn has_pieces(&self) -> bool {
        let system = &self.system;
        let rates = system.states.iter().map(|(_, rate)| rate);
        let values: Vec<Expr<'g>> =
            system.forces.iter().chain(rates).copied().chain([self.energy()]).collect();
        !system.holds.is_empty() || !system.graph().seams(&values).is_empty()
    }
}

impl FirstOrder<'_> {
    /// Compiles the system; M⁻¹ is written out if the factorisation takes no more operations than `longest`
    /// and the equations are linear in the unknowns.
    ///
    /// # Errors
    /// As for [`Equations::compile`].
    pub(crate) fn compile(&self, options: &CompileOptions, longest: usize) -> Result<Motion, MechError> {
        let motion = self.compile_piece(options, longest)?;
        let switches = self.switches(options)?;
        Ok(Motion { switches: switches.map(Box::new), ..motion })
    }

    /// Compiles the system, but without the pieces of piecewise functions.
    pub(crate) fn compile_piece(
        &self,
        options: &CompileOptions,
        longest: usize,
    ) -> Result<Motion, MechError> {
        let short = || cost::operations(&self.mass) <= longest;
        let unrolled = || short() || !cost::needs_no_pivoting(self.graph, &self.mass);
        let in_order = self.tree.is_some() || self.points.is_some();
        let form = if in_order || self.implicit.is_none() && self.multipliers == 0 && unrolled() {
            Form::Unrolled(Box::new(Unrolled::new(self, options)?))
        } else {
            Form::Staged(Box::new(Staged::new(self, options)?))
        };
        let differentiable = options.jacobian || options.jvp || options.parameter_jacobian;
        Ok(Motion {
            names: self.state.iter().map(Expr::to_string).collect(),
            coordinates: self.coordinates,
            states: self.states,
            quasi_velocities: self.names.clone(),
            parameters: self.parameters.iter().map(|&(_, value)| value).collect(),
            form,
            options: *options,
            observable_names: self.observables.iter().map(|(name, _)| name.clone()).collect(),
            conserved: self.conserved,
            constraints: Vec::new(),
            surface: None,
            kept: None,
            quaternions: self.quaternions.clone(),
            signals: Signals::default(),
            charts: Vec::new(),
            watch: Watch::default(),
            switches: None,
            jumps: if differentiable { self.jumps()? } else { Vec::new() },
        })
    }
}
