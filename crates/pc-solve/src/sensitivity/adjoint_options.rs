//! Options for the integration of a motion and its adjoint equations.

use crate::cvode::linear::krylov::Krylov;
use crate::cvode::linear::solver::LinearSolver;
use crate::error::InputError;
use crate::integration::checks::positive;
use crate::settings::nonlinear_solver::NonlinearSolver;
use crate::settings::options::Options;
use crate::settings::tolerance::Tolerance;

/// The default dimension of the Krylov subspaces for the adjoint equations.
const SUBSPACE: u32 = 30;

/// Options for the integration of a motion and its adjoint equations.
#[derive(Debug, Clone, PartialEq)]
pub struct AdjointOptions {
    pub(crate) motion: Options,
    pub(crate) relative_tolerance: f64,
    pub(crate) absolute_tolerance: f64,
    pub(crate) checkpoint_interval: u32,
    linear_solver: Option<LinearSolver>,
}

impl AdjointOptions {
    /// These options for the motion; for the adjoint equations, the same method, the same
    /// tolerances (the smallest of the absolute ones) and the same limit on steps; and a checkpoint
    /// every 200 steps.
    pub fn new(motion: Options) -> Self {
        let absolute_tolerance = match &motion.absolute_tolerance {
            Tolerance::Scalar(atol) => *atol,
            Tolerance::Vector(atol) => atol.iter().copied().fold(f64::INFINITY, f64::min),
        };
        let relative_tolerance = motion.relative_tolerance;
        AdjointOptions {
            motion,
            relative_tolerance,
            absolute_tolerance,
            checkpoint_interval: 200,
            linear_solver: None,
        }
    }

    /// Sets the relative and absolute tolerance of λ, of the integrals of g and of the integrals in
    /// ∂G/∂p; both are positive.
    pub fn tolerances(self, relative: f64, absolute: f64) -> Self {
        AdjointOptions { relative_tolerance: relative, absolute_tolerance: absolute, ..self }
    }

    /// Sets the number of steps from one checkpoint to the next, at least 1.
    ///
    /// The states at all checkpoints are held in memory and, for one interval at a time, all steps
    /// with their derivatives, at most 13 vectors per step. The method restarts at each checkpoint,
    /// so an interval should be longer than the starting phase of the method.
    pub fn checkpoint_interval(self, steps: u32) -> Self {
        AdjointOptions { checkpoint_interval: steps, ..self }
    }

    /// Sets how the linear systems of the adjoint equations are solved, whose matrices are the
    /// transposes of those of the motion; by default with the [usual](LinearSolver) solver for the
    /// field, or with [Krylov's method](LinearSolver::Krylov) if the field offers only
    /// [products](pc_expr::VectorField::vjp).
    pub fn linear_solver(self, linear_solver: LinearSolver) -> Self {
        AdjointOptions { linear_solver: Some(linear_solver), ..self }
    }

    /// The options for the adjoint equations of a field that gives the entries of its Jacobian or,
    /// with `products_only`, only products.
    pub(crate) fn back(&self, products_only: bool) -> Options {
        let Options { method, max_steps, .. } = self.motion;
        let (deadline, nonlinear_solver) = (self.motion.deadline.clone(), self.motion.iteration());
        let options = Options { deadline, ..Options::new(method) }
            .nonlinear_solver(nonlinear_solver)
            .max_steps(max_steps)
            .relative_tolerance(self.relative_tolerance)
            .absolute_tolerance(self.absolute_tolerance);
        let by_products = products_only && nonlinear_solver == NonlinearSolver::Newton;
        match &self.linear_solver {
            Some(choice) => options.linear_solver(choice.clone()),
            None if by_products => options.linear_solver(LinearSolver::Krylov(Krylov::new(SUBSPACE))),
            None => options,
        }
    }

    pub(crate) fn validate(&self) -> Result<(), InputError> {
        positive("the relative tolerance of the adjoint equations", self.relative_tolerance)?;
        positive("the absolute tolerance of the adjoint equations", self.absolute_tolerance)?;
        positive("the number of steps between checkpoints", f64::from(self.checkpoint_interval))
    }
}
