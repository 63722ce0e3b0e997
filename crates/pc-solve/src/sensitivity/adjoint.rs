//! Gradients of functionals of a motion.

use pc_expr::{Events, Failure, VectorField};

use crate::error::{InputError, SolveError};
use crate::events::events::FnEvents;
use crate::integration::options::{NonlinearSolver, Options, Tolerance, positive};
use crate::integration::statistics::Statistics;
use crate::linear::linear::{Krylov, LinearSolver};
use crate::sensitivity::adjoint_pass;

/// Largest dimension of the Krylov subspaces of the way back, unless a solver is chosen.
const SUBSPACE: u32 = 30;

/// A functional G = ∫ g(t, y, p) dt + h(t₁, y(t₁), p) of a motion from t₀ to t₁, with its derivatives.
///
/// Both terms write their derivatives by the state, of the dimension of the field, and by the parameters: as many as
/// the field has, none if it has no [derivative](VectorField::parameter_jacobian) by them. Every entry must be written,
/// zeros too. A term that is left out is zero.
pub trait Functional {
    /// g(t, y), with ∂g/∂y and ∂g/∂p.
    ///
    /// # Errors
    /// [`Failure`] where g is not defined.
    fn density(
        &mut self,
        _t: f64,
        _y: &[f64],
        by_state: &mut [f64],
        by_parameters: &mut [f64],
    ) -> Result<f64, Failure> {
        by_state.fill(0.0);
        by_parameters.fill(0.0);
        Ok(0.0)
    }

    /// h(t₁, y(t₁)), with ∂h/∂y and ∂h/∂p.
    ///
    /// # Errors
    /// [`Failure`] where h is not defined.
    fn end(
        &mut self,
        _t: f64,
        _y: &[f64],
        by_state: &mut [f64],
        by_parameters: &mut [f64],
    ) -> Result<f64, Failure> {
        by_state.fill(0.0);
        by_parameters.fill(0.0);
        Ok(0.0)
    }
}

impl<G: Functional + ?Sized> Functional for Box<G> {
    fn density(
        &mut self,
        t: f64,
        y: &[f64],
        by_state: &mut [f64],
        by_parameters: &mut [f64],
    ) -> Result<f64, Failure> {
        (**self).density(t, y, by_state, by_parameters)
    }
    fn end(
        &mut self,
        t: f64,
        y: &[f64],
        by_state: &mut [f64],
        by_parameters: &mut [f64],
    ) -> Result<f64, Failure> {
        (**self).end(t, y, by_state, by_parameters)
    }
}

/// A functional and its derivatives.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Gradient {
    /// G
    pub value: f64,
    /// ∂G/∂y₀, of the dimension of the field.
    pub by_start: Vec<f64>,
    /// ∂G/∂p of a start that does not depend on p, one for each parameter; none if the field has no derivative by them.
    ///
    /// If it does, (∂y₀/∂p)ᵀ ∂G/∂y₀ is to be added.
    pub by_parameters: Vec<f64>,
    /// The work of the motion to t₁, without the way back.
    pub statistics: Statistics,
}

/// How to integrate a motion and the adjoint equations.
#[derive(Debug, Clone, PartialEq)]
pub struct AdjointOptions {
    pub(crate) motion: Options,
    pub(crate) relative_tolerance: f64,
    pub(crate) absolute_tolerance: f64,
    pub(crate) checkpoint_interval: u32,
    linear_solver: Option<LinearSolver>,
}

impl AdjointOptions {
    /// The motion as these options say, the way back by the same method with the same tolerances (the least of the
    /// absolute ones) and limit of steps, and a checkpoint every 200 steps.
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

    /// Relative and absolute tolerance of λ, of the integrals over g and of those of ∂G/∂p, positive.
    pub fn tolerances(self, relative: f64, absolute: f64) -> Self {
        AdjointOptions { relative_tolerance: relative, absolute_tolerance: absolute, ..self }
    }

    /// Steps from one checkpoint to the next, at least 1.
    ///
    /// The states at checkpoints are held, and of one interval at a time all steps with their derivatives, at most 13
    /// vectors a step. The method starts anew at each checkpoint, so an interval should be longer than its start.
    pub fn checkpoint_interval(self, steps: u32) -> Self {
        AdjointOptions { checkpoint_interval: steps, ..self }
    }

    /// How the linear systems of the way back are solved, by matrices that are transposed to those of the motion: unless given,
    /// as [usual](LinearSolver) for what the field offers, and by [Krylov's method](LinearSolver::Krylov) where that is nothing
    /// but [products](VectorField::vjp).
    pub fn linear_solver(self, linear_solver: LinearSolver) -> Self {
        AdjointOptions { linear_solver: Some(linear_solver), ..self }
    }

    /// For the adjoint equations of a field with entries of its Jacobian, or `products_only`.
    pub(crate) fn back(&self, products_only: bool) -> Options {
        let Options { method, nonlinear_solver, max_steps, .. } = self.motion;
        let options = Options::new(method)
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

/// The gradient of a functional G of the motion from y(t0) = y0 to t1, which may be before t0, by y₀ and by the
/// parameters.
///
/// With λ(t₁) = ∂h/∂y and
/// ```text
/// λ̇ = −(∂f/∂y)ᵀ λ − ∂g/∂y,    ∂G/∂y₀ = λ(t₀),    ∂G/∂p = ∂h/∂p + ∫ (∂g/∂p + (∂f/∂p)ᵀ λ) dt
/// ```
/// the cost does not grow with the number of parameters, but for those integrals [Cao, Li, Petzold, Serban, SIAM J. Sci.
/// Comput. 24 (2003) 1076]. The motion is integrated to t₁ and, from one checkpoint to the next, once again on the way
/// back, where it is looked up by the polynomials of the method. Each evaluation of λ̇ takes a
/// [product](VectorField::vjp) with (∂f/∂y)ᵀ if the field has these, else its Jacobian:
/// [sparse](VectorField::sparse_jacobian) if its [pattern](VectorField::sparsity) is known. If it has none that is put together
/// from [products](VectorField::jvp), or pairs of evaluations of f, one for each colour of the pattern, or for each
/// component.
///
/// What is held of n components are the states at checkpoints, and up to 13 vectors for each step of one
/// [interval](AdjointOptions::checkpoint_interval) between them: for large n an interval of few steps takes less.
///
/// Where states lie on a surface, λ follows the [projected](VectorField::project) motion, but is not projected itself:
/// ∂G/∂y₀ is that of the field in all of space, and its part tangent to the surface what starts on it feel. Where motions
/// off the surface drift away from it λ grows large across the surface, and its errors are relative to that: smaller
/// tolerances are in place.
///
/// ```
/// use pc_solve::{AdjointOptions, Failure, Functional, Options, adjoint_gradient, from_fn};
///
/// /// G = y₀(T)
/// struct FirstAtEnd;
/// impl Functional for FirstAtEnd {
///     fn end(&mut self, _t: f64, y: &[f64], by_state: &mut [f64], _p: &mut [f64]) -> Result<f64, Failure> {
///         by_state.copy_from_slice(&[1.0, 0.0]);
///         Ok(y[0])
///     }
/// }
/// let oscillator = from_fn(2, |_t, y, ydot| {
///     ydot.copy_from_slice(&[y[1], -y[0]]);
///     Ok(())
/// });
/// let options = AdjointOptions::new(Options::default());
/// let gradient = adjoint_gradient(oscillator, FirstAtEnd, 0.0, &[1.0, 0.0], 2.0, &options)?;
/// assert!((gradient.by_start[0] - 2.0f64.cos()).abs() < 1e-7);
/// assert!((gradient.by_start[1] - 2.0f64.sin()).abs() < 1e-7);
/// # Ok::<(), pc_solve::SolveError>(())
/// ```
///
/// # Errors
/// [`SolveError::Input`] if the problem or an option is not valid; [`SolveError::Integration`] if the motion fails, and
/// with [`Reason::Adjoint`](crate::Reason::Adjoint) if the way back does.
pub fn adjoint_gradient<F: VectorField, G: Functional>(
    field: F,
    functional: G,
    t0: f64,
    y0: &[f64],
    t1: f64,
    options: &AdjointOptions,
) -> Result<Gradient, SolveError> {
    let gradients = adjoint_gradients(field, [functional], t0, y0, t1, options)?;
    let first = gradients.into_iter().next();
    first.ok_or_else(|| InputError::NoFunctional.into())
}

/// As [`adjoint_gradient`], of several functionals, [boxed](Box) if of several kinds: they share the motion there, the
/// checkpoints, and the motion from one to the next on the way back, on which each has its adjoint equations. Each
/// gradient is that of its functional alone.
///
/// # Errors
/// As there; [`InputError::NoFunctional`]
pub fn adjoint_gradients<F: VectorField, G: Functional>(
    field: F,
    functionals: impl IntoIterator<Item = G>,
    t0: f64,
    y0: &[f64],
    t1: f64,
    options: &AdjointOptions,
) -> Result<Vec<Gradient>, SolveError> {
    adjoint_gradients_with_events(field, FnEvents::new(), functionals, t0, y0, t1, options)
}

/// As [`adjoint_gradients`], of a motion with events. At a reset y⁺ = R(t, y⁻) where the function γ of an event vanishes, λ
/// goes back by the transposed saltation matrix,
/// ```text
/// λ⁻ = R_yᵀ λ⁺ − κ γ_y,    κ = (λ⁺·(R_t + R_y f⁻ − f⁺) + g⁻ − g⁺)/(γ_t + γ_y f⁻),
/// ```
/// and ∂G/∂p grows by R_pᵀ λ⁺ − κ γ_p: what is written for [sensitivities](crate::Sensitivities), read from the left. The
/// [derivatives](Events::by_parameter) of the events by parameters are asked for if the field has such.
///
/// # Errors
/// As there; [`Reason::EndsEarly`](crate::Reason::EndsEarly) at a terminal event before t1, [`Reason::Together`](crate::Reason::Together) where several events reset the state
/// at once, [`Reason::Grazing`](crate::Reason::Grazing) where one is met at no speed, and [`InputError::EventParameters`].
pub fn adjoint_gradients_with_events<F: VectorField, E: Events, G: Functional>(
    field: F,
    events: E,
    functionals: impl IntoIterator<Item = G>,
    t0: f64,
    y0: &[f64],
    t1: f64,
    options: &AdjointOptions,
) -> Result<Vec<Gradient>, SolveError> {
    options.validate()?;
    let functionals: Vec<G> = functionals.into_iter().collect();
    if functionals.is_empty() {
        return Err(InputError::NoFunctional.into());
    }
    adjoint_pass::gradients(field, events, functionals, (t0, y0), t1, options)
}
