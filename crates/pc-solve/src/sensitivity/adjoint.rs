//! Gradients of functionals of a motion.

use std::ops::ControlFlow;

use pc_expr::{Failure, VectorField};

use crate::cvode::cvode::Cvode;
use crate::error::{InputError, IntegrationError, Reason, SolveError};
use crate::integration::options::{Options, Tolerance, positive};
use crate::integration::statistics::Statistics;
use crate::sensitivity::adjoint_field::{AdjointField, not_finite};

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
        AdjointOptions { motion, relative_tolerance, absolute_tolerance, checkpoint_interval: 200 }
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

    /// For the adjoint equations.
    fn back(&self) -> Options {
        let Options { method, nonlinear_solver, max_steps, .. } = self.motion;
        Options::new(method)
            .nonlinear_solver(nonlinear_solver)
            .max_steps(max_steps)
            .relative_tolerance(self.relative_tolerance)
            .absolute_tolerance(self.absolute_tolerance)
    }

    fn validate(&self) -> Result<(), InputError> {
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
/// back, where it is looked up by the polynomials of the method. Each evaluation of λ̇ takes the field's
/// [Jacobian](VectorField::jacobian), dense. If it has none it is put together from as many
/// [products](VectorField::jvp), or pairs of evaluations of f, as there are components.
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
/// with [`Reason::Adjoint`] if the way back does.
pub fn adjoint_gradient<F: VectorField, G: Functional>(
    field: F,
    functional: G,
    t0: f64,
    y0: &[f64],
    t1: f64,
    options: &AdjointOptions,
) -> Result<Gradient, SolveError> {
    options.validate()?;
    let mut motion = options.motion.clone();
    motion.stop_time = motion.stop_time.or(Some(t1).filter(|t| t.is_finite()));
    let mut adjoint = AdjointField::new(field, functional, &motion);
    let mut there = Cvode::new(&mut adjoint.field, t0, y0, &motion)?;
    let checkpoints = checkpoints(&mut there, t1, options.checkpoint_interval)?;
    let (statistics, y1) = (there.statistics(), there.state().to_vec());
    drop(there);

    let (end, by_state, mut by_parameters) = adjoint.end(t1, &y1).map_err(|failure| {
        let (reason, failure) = (Reason::Functional, Some(failure));
        SolveError::Integration(Box::new(IntegrationError { reason, time: t1, state: y1, failure }))
    })?;
    let mut back = Cvode::new(adjoint, t1, &by_state, &options.back())?;
    back.begin_quadratures(options.relative_tolerance, options.absolute_tolerance)?;
    let mut to = t1;
    for (t, y) in checkpoints.into_iter().rev() {
        back.field_mut().record(t, &y, to, &motion)?;
        back.set_stop_time(Some(t))?;
        let result = back.advance_to(t).map(|_| ());
        result.map_err(|error| of_motion(error, back.field_mut()))?;
        to = t;
    }
    let mut integrals = back.quadratures()?;
    if let Some(j) = not_finite(&integrals) {
        let component = format!("integral number {j} (from 0) of the gradient");
        let overflow = Reason::Overflow { component, value: integrals[j], t: t0 };
        let reason = Reason::Adjoint(Box::new(overflow));
        let error = IntegrationError { reason, time: t0, state: y0.to_vec(), failure: None };
        return Err(SolveError::Integration(Box::new(error)));
    }
    let value = end + integrals.pop().unwrap_or(0.0);
    for (sum, integral) in by_parameters.iter_mut().zip(integrals) {
        *sum += integral;
    }
    Ok(Gradient { value, by_start: back.state().to_vec(), by_parameters, statistics })
}

/// Takes the motion to `t1`; the start and each `interval`th step on the way.
fn checkpoints<F: VectorField>(
    motion: &mut Cvode<F>,
    t1: f64,
    interval: u32,
) -> Result<Vec<(f64, Vec<f64>)>, SolveError> {
    let mut checkpoints = vec![(motion.time(), motion.state().to_vec())];
    let mut steps = 0;
    let direction = 1.0_f64.copysign(t1 - motion.time());
    let keep = |t: f64, y: &[f64]| {
        steps += 1;
        if steps == interval && (t1 - t) * direction > 0.0 {
            steps = 0;
            checkpoints.push((t, y.to_vec()));
        }
        ControlFlow::Continue(())
    };
    motion.run_observed(&[t1], |_, _| ControlFlow::Continue(()), keep)?;
    Ok(checkpoints)
}

/// An error of the adjoint equations, with the state of the motion where they stopped.
fn of_motion<F: VectorField, G: Functional>(
    error: SolveError,
    adjoint: &mut AdjointField<F, G>,
) -> SolveError {
    match error {
        SolveError::Integration(error) => {
            let IntegrationError { reason, time, failure, .. } = *error;
            let (reason, state) = (Reason::Adjoint(Box::new(reason)), adjoint.motion(time).to_vec());
            SolveError::Integration(Box::new(IntegrationError { reason, time, state, failure }))
        }
        other => other,
    }
}
