//! The linear systems (I − γ ∂f/∂y) x = b of Newton's iteration, and their solvers.
//!
//! γ is the step length times a coefficient of the method. A solver has three stages, in order of
//! increasing frequency: ∂f/∂y is updated, I − γ ∂f/∂y is factorised, and a system is solved.

use std::borrow::Cow;
use std::ptr;

use pc_expr::{Pattern, VectorField};
use sundials_sys as sys;

use crate::cvode::callback::UserData;
use crate::cvode::context::Context;
use crate::cvode::handles::{Memory, Vector};
use crate::cvode::linear::gmres;
use crate::cvode::linear::handles::{Matrix, Solver};
use crate::cvode::linear::quotients::Quotients;
use crate::cvode::linear::solver::LinearSolver;
use crate::cvode::linear::sparse::Places;
use crate::cvode::linear::work::Work;
use crate::error::SolveError;
use crate::settings::inequality::Inequality;

/// A linear solver with its matrix, if it has one.
pub(crate) struct Linear {
    // Dropped in this order.
    solver: Solver,
    matrix: Option<Matrix>,
    choice: LinearSolver,
}

impl Linear {
    /// The solver of `choice`, which has been [checked](crate::cvode::linear::choice::choose), for
    /// vectors of the same kind as `y`.
    pub(crate) fn new(
        context: &mut Context,
        y: &Vector,
        choice: LinearSolver,
        field: &impl VectorField,
    ) -> Result<Self, SolveError> {
        let dim = y.as_slice().len();
        let (solver, matrix) = match &choice {
            LinearSolver::Dense => {
                let matrix = Matrix::dense(context, dim)?;
                (crate::cvode::linear::dense::solver(context, y, &matrix)?, Some(matrix))
            }
            LinearSolver::Band { lower, upper } => {
                let matrix = Matrix::band(context, dim, *lower, *upper)?;
                (Solver::band(context, y, &matrix)?, Some(matrix))
            }
            LinearSolver::Sparse => {
                let places = Places::new(&pattern(field));
                let matrix = crate::cvode::linear::sparse::matrix(context, &places)?;
                (crate::cvode::linear::sparse_lu::solver(context, &matrix, places.pattern())?, Some(matrix))
            }
            LinearSolver::Krylov(krylov) => (gmres::solver(krylov, context, y)?, None),
        };
        Ok(Linear { solver, matrix, choice })
    }

    pub(crate) fn choice(&self) -> &LinearSolver {
        &self.choice
    }

    /// Attaches the solver to CVODES, which has been initialised and has its user data, with the
    /// callbacks for the derivatives that `F` has.
    pub(crate) fn attach<F: VectorField>(
        &self,
        memory: &Memory,
        context: &mut Context,
        callbacks: &mut UserData<F>,
        inequalities: &[Inequality],
    ) -> Result<(), SolveError> {
        let matrix = self.matrix.as_ref().map_or(ptr::null_mut(), Matrix::raw);
        // SAFETY: `memory` is initialised; solver and matrix match and outlive it.
        let code = unsafe { sys::CVodeSetLinearSolver(memory.raw(), self.solver.raw(), matrix) };
        context.check("CVodeSetLinearSolver", code)?;

        let field = callbacks.field();
        let has_jacobian = field.has_jacobian();
        let entries = field.sparsity().map_or(0, Pattern::len);
        let mut work = Work::default();
        let jacobian: sys::CVLsJacFn = match &self.choice {
            LinearSolver::Dense => has_jacobian.then_some(crate::cvode::linear::dense::jacobian::<F>),
            LinearSolver::Band { .. } => {
                work.entries = vec![0.0; entries];
                (has_jacobian && field.sparsity().is_some())
                    .then_some(crate::cvode::linear::band::jacobian::<F>)
            }
            LinearSolver::Sparse if has_jacobian => {
                work.entries = vec![0.0; entries];
                Some(crate::cvode::linear::sparse::jacobian::<F>)
            }
            LinearSolver::Sparse => {
                work.quotients = Some(Quotients::new(memory, &pattern(field), inequalities));
                Some(crate::cvode::linear::quotient_jacobian::jacobian::<F>)
            }
            LinearSolver::Krylov(krylov) => {
                work.preconditioner = gmres::attach::<F>(krylov, memory, context, field.has_jvp())?;
                None
            }
        };
        callbacks.set_linear(work);
        if jacobian.is_some() {
            // SAFETY: the linear solver is set, and its matrix is of the kind that the callback
            // expects.
            let code = unsafe { sys::CVodeSetJacFn(memory.raw(), jacobian) };
            context.check("CVodeSetJacFn", code)?;
        }
        Ok(())
    }
}

/// The zero pattern of ∂f/∂y; the full pattern if the field does not know its pattern.
fn pattern(field: &impl VectorField) -> Cow<'_, Pattern> {
    field.sparsity().map_or_else(|| Cow::Owned(Pattern::full(field.dim(), field.dim())), Cow::Borrowed)
}
