//! The work of an integration.

/// Counts since the start, and the last internal step.
///
/// Counts of a linear solver are 0 where it does not apply.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct Statistics {
    /// Internal steps.
    pub steps: u64,
    /// Evaluations of f, including those for difference quotients.
    pub rhs_evaluations: u64,
    /// Evaluations of ∂f/∂y, by the field or by difference quotients.
    pub jacobian_evaluations: u64,
    /// Steps repeated because the estimated error was too large.
    pub error_test_failures: u64,
    /// Iterations of the nonlinear solver.
    pub nonlinear_iterations: u64,
    /// Failures of the nonlinear solver, including those remedied by a new Jacobian.
    pub nonlinear_failures: u64,
    /// Steps repeated because the nonlinear solver failed.
    pub step_failures: u64,
    /// Set-ups of the linear solver: factorisations, or renewals of the preconditioner.
    pub linear_setups: u64,
    /// Iterations of the Krylov solver.
    pub linear_iterations: u64,
    /// Linear systems that were not solved: the Krylov solver missed its tolerance, or the matrix
    /// proved singular.
    pub linear_failures: u64,
    /// Products (∂f/∂y) v, by the field or by difference quotients.
    pub jacobian_products: u64,
    /// How often the preconditioner was given a new ∂f/∂y.
    pub preconditioner_evaluations: u64,
    /// Systems solved with the preconditioner.
    pub preconditioner_solves: u64,
    /// Steps shortened to end where the explicit dependence on time has a feature that the motion
    /// so far does not reveal: the beginning of a pulse, a jump.
    pub limited_steps: u64,
    /// Steps made with the stiff formulas of [`Auto`](crate::Method::Auto).
    pub implicit_steps: u64,
    /// Steps made in vector lanes together with other members of an [ensemble](crate::Ensemble).
    pub lane_steps: u64,
    /// Changes between the two methods of [`Auto`](crate::Method::Auto).
    pub changes: u64,
    /// The time at which an explicit method first detected that stability rather than accuracy
    /// limits its steps, if it did.
    pub stiff_from: Option<f64>,
    /// Order of the last step, 0 before the first.
    pub last_order: u32,
    /// Order of the next step, 0 before the first.
    pub current_order: u32,
    /// Length of the first step, with the sign of the direction; 0 before it.
    pub first_step: f64,
    /// Length of the last step, with the sign of the direction; 0 before the first.
    pub last_step: f64,
    /// Trial length of the next step, with the sign of the direction; 0 before the first.
    pub current_step: f64,
    /// End of the last step.
    pub current_time: f64,
}

impl Statistics {
    /// The sum of these statistics and those of an integration that continued from there.
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
