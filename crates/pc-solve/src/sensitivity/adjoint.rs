//! Gradients of functionals of a motion.

use pc_expr::{Events, VectorField};

use crate::error::{InputError, SolveError};
use crate::events::events::FnEvents;
use crate::sensitivity::adjoint_options::AdjointOptions;
use crate::sensitivity::adjoint_pass;
use crate::sensitivity::functional::{Functional, Gradient};

/// The gradient, with respect to y₀ and the parameters, of a functional G of the motion from y(t0)
/// = y0 to t1, which may be before t0.
///
/// With λ(t₁) = ∂h/∂y and
/// ```text
/// λ̇ = −(∂f/∂y)ᵀ λ − ∂g/∂y,    ∂G/∂y₀ = λ(t₀),    ∂G/∂p = ∂h/∂p + ∫ (∂g/∂p + (∂f/∂p)ᵀ λ) dt
/// ```
/// the cost does not depend on the number of parameters, except for those integrals [Cao, Li,
/// Petzold, Serban, SIAM J. Sci. Comput. 24 (2003) 1076]. The motion is integrated to t₁ and,
/// during the backward integration, once again from each checkpoint to the next; states are read
/// from the polynomials of the method. Each evaluation of λ̇ takes a [product](VectorField::vjp)
/// with (∂f/∂y)ᵀ if the field computes such products, else its Jacobian,
/// [sparse](VectorField::sparse_jacobian) if its [pattern](VectorField::sparsity) is known. A
/// missing Jacobian is assembled from [products](VectorField::jvp) or from pairs of evaluations of
/// f, one for each colour of the pattern or for each component.
///
/// Memory is needed for the states at the checkpoints, and for up to 13 vectors for each step of
/// one [interval](AdjointOptions::checkpoint_interval) between checkpoints: for large systems,
/// short intervals save memory.
///
/// Where states lie on a surface, λ follows the [projected](VectorField::project) motion, but is
/// not projected itself: ∂G/∂y₀ is the gradient for initial states in the whole space; its part
/// tangent to the surface applies to initial states on the surface. Where motions off the surface
/// drift away from it, λ grows large in the directions across the surface, and the errors of λ grow
/// with it: choose smaller tolerances in such cases.
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
/// [`SolveError::Input`] if the problem or an option is invalid; [`SolveError::Integration`] if the
/// motion fails, with [`Reason::Adjoint`](crate::Reason::Adjoint) if the backward integration
/// fails.
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

/// Like [`adjoint_gradient`], but for several functionals, which are [boxed](Box) if they are of
/// different types: they share the forward motion, the checkpoints, and the motion between
/// checkpoints, along which each functional has its own adjoint equations. Each gradient is the
/// same as if its functional were the only one.
///
/// # Errors
/// As for [`adjoint_gradient`]; [`InputError::NoFunctional`]
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

/// Like [`adjoint_gradients`], but for a motion with events. At a reset y⁺ = R(t, y⁻), where the
/// function γ of an event vanishes, the transposed saltation matrix acts on λ backwards in time,
/// ```text
/// λ⁻ = R_yᵀ λ⁺ − κ γ_y,    κ = (λ⁺·(R_t + R_y f⁻ − f⁺) + g⁻ − g⁺)/(γ_t + γ_y f⁻),
/// ```
/// and ∂G/∂p changes by R_pᵀ λ⁺ − κ γ_p: the transpose of the rule for
/// [sensitivities](crate::Sensitivities). The [derivatives](Events::by_parameter) of the events
/// with respect to the parameters are needed if the field has derivatives with respect to them.
///
/// # Errors
/// As for [`adjoint_gradients`]; [`Reason::EndsEarly`](crate::Reason::EndsEarly) at a terminal
/// event before t1, [`Reason::Together`](crate::Reason::Together) where several events reset the
/// state at once, [`Reason::Grazing`](crate::Reason::Grazing) where an event function only touches
/// zero, and [`InputError::EventParameters`].
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
