//! The work of an integration.

/// Counts since the start, and data of the last internal step.
///
/// The counts of a linear solver are 0 where no such solver is used.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct Statistics {
    /// Internal steps.
    pub steps: u64,
    /// The number of evaluations of f, including those for difference quotients.
    pub rhs_evaluations: u64,
    /// The number of evaluations of ∂f/∂y, by the field or with difference quotients.
    pub jacobian_evaluations: u64,
    /// The number of steps repeated because the estimated error was too large.
    pub error_test_failures: u64,
    /// The number of iterations of the nonlinear solver.
    pub nonlinear_iterations: u64,
    /// The number of failures of the nonlinear solver, including those remedied by a new Jacobian.
    pub nonlinear_failures: u64,
    /// The number of steps repeated because the nonlinear solver failed.
    pub step_failures: u64,
    /// The number of set-ups of the linear solver: factorisations, or updates of the
    /// preconditioner.
    pub linear_setups: u64,
    /// The number of iterations of the Krylov solver.
    pub linear_iterations: u64,
    /// The number of linear systems that were not solved: the Krylov solver missed its tolerance,
    /// or the matrix proved singular.
    pub linear_failures: u64,
    /// The number of products (∂f/∂y) v, computed by the field or with difference quotients.
    pub jacobian_products: u64,
    /// How often the preconditioner was given a new ∂f/∂y.
    pub preconditioner_evaluations: u64,
    /// The number of systems solved with the preconditioner.
    pub preconditioner_solves: u64,
    /// The number of steps shortened to end where the explicit dependence on time has a feature
    /// that the motion so far does not reveal, such as the beginning of a pulse, or a jump.
    pub limited_steps: u64,
    /// The number of steps made with the stiff formulas of [`Auto`](crate::Method::Auto).
    pub implicit_steps: u64,
    /// The number of steps made in vector lanes together with other members of an
    /// [ensemble](crate::Ensemble).
    pub lane_steps: u64,
    /// The number of switches between the two methods of [`Auto`](crate::Method::Auto).
    pub changes: u64,
    /// The time at which an explicit method first detected that stability rather than accuracy
    /// limits its steps, if it did.
    pub stiff_from: Option<f64>,
    /// The order of the last step; 0 before the first.
    pub last_order: u32,
    /// The order of the next step; 0 before the first.
    pub current_order: u32,
    /// The length of the first step, with the sign of the direction; 0 before that step.
    pub first_step: f64,
    /// The length of the last step, with the sign of the direction; 0 before the first.
    pub last_step: f64,
    /// The trial length of the next step, with the sign of the direction; 0 before the first.
    pub current_step: f64,
    /// The end of the last step.
    pub current_time: f64,
}

impl Statistics {
    /// The sum of these statistics and those of an integration that continued from where this one
    /// ended.
    pub fn followed_by(&self, later: &Statistics) -> Statistics {
        Statistics {
            steps: self.steps.saturating_add(later.steps),
            rhs_evaluations: self.rhs_evaluations.saturating_add(later.rhs_evaluations),
            jacobian_evaluations: self.jacobian_evaluations.saturating_add(later.jacobian_evaluations),
            error_test_failures: self.error_test_failures.saturating_add(later.error_test_failures),
            nonlinear_iterations: self.nonlinear_iterations.saturating_add(later.nonlinear_iterations),
            nonlinear_failures: self.nonlinear_failures.saturating_add(later.nonlinear_failures),
            step_failures: self.step_failures.saturating_add(later.step_failures),
            linear_setups: self.linear_setups.saturating_add(later.linear_setups),
            linear_iterations: self.linear_iterations.saturating_add(later.linear_iterations),
            linear_failures: self.linear_failures.saturating_add(later.linear_failures),
            jacobian_products: self.jacobian_products.saturating_add(later.jacobian_products),
            preconditioner_evaluations: self
                .preconditioner_evaluations
                .saturating_add(later.preconditioner_evaluations),
            preconditioner_solves: self.preconditioner_solves.saturating_add(later.preconditioner_solves),
            limited_steps: self.limited_steps.saturating_add(later.limited_steps),
            implicit_steps: self.implicit_steps.saturating_add(later.implicit_steps),
            lane_steps: self.lane_steps.saturating_add(later.lane_steps),
            changes: self.changes.saturating_add(later.changes),
            stiff_from: self.stiff_from.or(later.stiff_from),
            first_step: if self.steps > 0 { self.first_step } else { later.first_step },
            ..*later
        }
    }
}
