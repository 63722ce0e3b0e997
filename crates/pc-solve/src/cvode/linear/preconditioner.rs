//! Preconditioners, which make GMRES converge faster.

use pc_expr::{Failure, VectorField};

/// A matrix P close to I − γ ∂f/∂y whose linear systems are easier to solve.
///
/// GMRES is then applied to P⁻¹ A or A P⁻¹ instead of A = I − γ ∂f/∂y, and converges faster the
/// closer these are to I.
///
/// ```
/// use pc_solve::{Failure, Krylov, LinearSolver, Method, Options, Preconditioner, Side, VectorField, from_fn, solve};
///
/// /// Jacobi's preconditioner, the diagonal, which here contains all the stiffness.
/// #[derive(Default)]
/// struct Jacobi {
///     diagonal: Vec<f64>,
///     factor: Vec<f64>,
/// }
///
/// impl Preconditioner for Jacobi {
///     fn linearise(&mut self, field: &mut dyn VectorField, t: f64, y: &[f64]) -> Result<(), Failure> {
///         let mut jacobian = vec![0.0; y.len() * y.len()];
///         field.jacobian(t, y, &mut jacobian)?;
///         self.diagonal = jacobian.iter().step_by(y.len() + 1).copied().collect();
///         Ok(())
///     }
///
///     fn factorise(&mut self, gamma: f64) -> Result<(), Failure> {
///         self.factor = self.diagonal.iter().map(|d| 1.0 / (1.0 - gamma * d)).collect();
///         Ok(())
///     }
///
///     fn solve(&mut self, r: &[f64], z: &mut [f64]) -> Result<(), Failure> {
///         for ((z, r), factor) in z.iter_mut().zip(r).zip(&self.factor) {
///             *z = r * factor;
///         }
///         Ok(())
///     }
/// }
///
/// let decay = from_fn(2, |_t, y, ydot| {
///     ydot.copy_from_slice(&[-1e6 * y[0] + y[1], -y[1]]);
///     Ok(())
/// })
/// .with_jacobian(|_t, _y, jacobian| {
///     jacobian.copy_from_slice(&[-1e6, 0.0, 1.0, -1.0]);
///     Ok(())
/// });
/// let krylov = Krylov::default().preconditioner(Side::Left, Jacobi::default);
/// let options = Options::new(Method::Bdf).linear_solver(LinearSolver::Krylov(krylov));
/// let motion = solve(decay, 0.0, &[1.0, 1.0], &[1.0], &options)?;
/// assert!((motion.state(0)[1] - (-1.0_f64).exp()).abs() < 1e-7);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Preconditioner {
    /// Computes the parts of ∂f/∂y at (t, y) that the preconditioner needs; called first, and again
    /// whenever these parts are out of date.
    ///
    /// # Errors
    /// [`Failure`]; a recoverable one lets the integrator try a smaller step.
    fn linearise(&mut self, field: &mut dyn VectorField, t: f64, y: &[f64]) -> Result<(), Failure>;

    /// Prepares P for I − γ ∂f/∂y with the current ∂f/∂y; called after each
    /// [`linearise`](Preconditioner::linearise), and when γ has changed.
    ///
    /// # Errors
    /// As for [`linearise`](Preconditioner::linearise).
    fn factorise(&mut self, gamma: f64) -> Result<(), Failure>;

    /// Writes z with P z = r; both slices have the dimension of the field, and every number must be
    /// written.
    ///
    /// # Errors
    /// As for [`linearise`](Preconditioner::linearise).
    fn solve(&mut self, r: &[f64], z: &mut [f64]) -> Result<(), Failure>;
}
