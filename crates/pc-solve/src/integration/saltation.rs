//! How a reset changes the derivatives of a motion.

use pc_expr::{Events, VectorField};

use crate::error::{Reason, SolveError};
use crate::integration::integration::Integration;
use crate::integration::stepper::Stepper;

/// A projection that moves the result of a reset by at most this, absolutely or relatively,
/// whichever is larger, only changes rounding.
const OFF: f64 = 1e-8;

/// A function whose rate along the motion is smaller than this fraction of the sum of its terms
/// only touches zero.
const GRAZING: f64 = 1e-9;

impl<S: Stepper, E: Events> Integration<S, E> {
    /// S⁺ from S⁻ at an event at time t with the function g and the reset y⁺ = R(t, y⁻),
    /// ```text
    /// s⁺ = R_y s⁻ + R_p + (R_t + R_y f⁻ − f⁺) τ,    τ = ∂tₑ/∂p = −(g_y s⁻ + g_p)/(g_t + g_y f⁻)
    /// ```
    /// with f⁻ = f(t, y⁻) and f⁺ = f(t, y⁺) [Hiskens, Pai, IEEE Trans. Circuits Syst. I 47 (2000)
    /// 204, eqs. (37)–(43)]. The derivatives by parameters are those of the events; so are those by
    /// (t, y) if the events [have them](Events::has_derivatives), else they are central difference
    /// quotients along the columns and along the motion.
    ///
    /// An event that the reset of another one sets off occurs when that one does: `shifts`, once
    /// known, are the τ of all resets at t, and S⁺ of each is S⁻ of the next.
    pub(crate) fn jump_of_sensitivities(
        &mut self,
        event: usize,
        t: f64,
        (before, after): (&[f64], &[f64]),
        matrix: &[f64],
        shifts: &mut Option<Vec<f64>>,
    ) -> Result<Vec<f64>, SolveError> {
        let dim = before.len();
        let projects = self.is_projected(event, t, before, after)?;
        let rates_before = self.rates_at(t, before)?;
        let rates_after = self.rates_at(t, after)?;
        let (along, size, reset_along) =
            self.derivative_along(event, (t, before), (1.0, &rates_before), projects)?;
        if shifts.is_none() && along.abs() <= GRAZING * size {
            return Err(self.failed(Reason::Grazing { event: self.name(event), t }, None));
        }
        let parameters = self.engine.column_parameters().to_vec();
        let mut jumped = Vec::with_capacity(matrix.len());
        let mut own_shifts = Vec::with_capacity(parameters.len());
        for (k, (column, parameter)) in matrix.chunks_exact(dim).zip(parameters).enumerate() {
            let (mut change, _, mut reset) =
                self.derivative_along(event, (t, before), (0.0, column), projects)?;
            if let Some(j) = parameter {
                let mut by_parameter = vec![f64::NAN; dim];
                match self.events.by_parameter(event, j, t, before, &mut by_parameter) {
                    Ok(function) => change += function,
                    Err(failure) => return Err(self.event_error(event, t, failure)),
                }
                reset.iter_mut().zip(&by_parameter).for_each(|(reset, by)| *reset += by);
            }
            let shift = shifts.as_ref().map_or(-change / along, |shifts| shifts[k]);
            own_shifts.push(shift);
            let entry = |i: usize| reset[i] + (reset_along[i] - rates_after[i]) * shift;
            jumped.extend((0..dim).map(entry));
        }
        shifts.get_or_insert(own_shifts);
        Ok(jumped)
    }

    /// λ⁻, and the increment of ∂G/∂p for each parameter p, from λ⁺ at such an event,
    /// ```text
    /// λ⁻ = R_yᵀ λ⁺ − κ g_y,    R_pᵀ λ⁺ − κ g_p,    κ = (λ⁺·(R_t + R_y f⁻ − f⁺) + δ)/(g_t + g_y f⁻)
    /// ```
    /// where the density of G is larger by δ before the event than after it: S⁺ above, multiplied
    /// by λ⁺ from the left.
    #[cfg(feature = "cvode")] // for the adjoint equations
    pub(crate) fn transposed_jump(
        &mut self,
        event: usize,
        t: f64,
        before: &[f64],
        after: &[f64],
        (adjoint, density_step): (&[f64], f64),
        parameters: usize,
    ) -> Result<(Vec<f64>, Vec<f64>), SolveError> {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let projects = self.is_projected(event, t, before, after)?;
        let rates_before = self.rates_at(t, before)?;
        let rates_after = self.rates_at(t, after)?;
        let (along, size, reset_along) =
            self.derivative_along(event, (t, before), (1.0, &rates_before), projects)?;
        if along.abs() <= GRAZING * size {
            return Err(self.failed(Reason::Grazing { event: self.name(event), t }, None));
        }
        let shift = (dot(adjoint, &reset_along) - dot(adjoint, &rates_after) + density_step) / along;
        let mut jumped = Vec::with_capacity(before.len());
        let mut unit = vec![0.0; before.len()];
        for i in 0..before.len() {
            unit[i] = 1.0;
            let (function, _, reset) = self.derivative_along(event, (t, before), (0.0, &unit), projects)?;
            unit[i] = 0.0;
            jumped.push(dot(adjoint, &reset) - shift * function);
        }
        let mut by_parameters = Vec::with_capacity(parameters);
        for j in 0..parameters {
            let mut reset = vec![f64::NAN; before.len()];
            match self.events.by_parameter(event, j, t, before, &mut reset) {
                Ok(function) => by_parameters.push(dot(adjoint, &reset) - shift * function),
                Err(failure) => return Err(self.event_error(event, t, failure)),
            }
        }
        Ok((jumped, by_parameters))
    }

    /// Whether the [projection](VectorField::project) of the field moves the result of the reset.
    /// If not, it is no part of R: derivatives by parameters that move the surface point out of it,
    /// and must not be projected to it.
    fn is_projected(
        &mut self,
        event: usize,
        t: f64,
        before: &[f64],
        after: &[f64],
    ) -> Result<bool, SolveError> {
        let mut alone = before.to_vec();
        self.reset_alone(event, t, &mut alone)?;
        Ok(alone.iter().zip(after).any(|(a, b)| (a - b).abs() > OFF * b.abs().max(1.0)))
    }

    fn rates_at(&mut self, t: f64, state: &[f64]) -> Result<Vec<f64>, SolveError> {
        let mut rates = vec![f64::NAN; state.len()];
        let outcome = self.engine.field_mut().rhs(t, state, &mut rates);
        match outcome {
            Ok(()) => Ok(rates),
            Err(failure) => Err(self.failed(Reason::Saltation { t }, Some(failure))),
        }
    }

    /// The derivative of g along (1, v) or (0, v) of time and state, its size |g_t| + Σ |g_yᵢ vᵢ|
    /// or an estimate of it, and the derivative of R, with the projection of the field or without.
    fn derivative_along(
        &mut self,
        event: usize,
        (t, state): (f64, &[f64]),
        (in_time, v): (f64, &[f64]),
        projects: bool,
    ) -> Result<(f64, f64, Vec<f64>), SolveError> {
        let largest = |v: &[f64]| v.iter().fold(0.0, |size: f64, v| size.max(v.abs()));
        let length = largest(v).max(in_time);
        if length == 0.0 {
            return Ok((0.0, 0.0, vec![0.0; state.len()]));
        }
        if self.events.has_derivatives() && !projects {
            return self.own_derivative_along(event, (t, state), (in_time, v));
        }
        // As for products with ∂f/∂y, truncation and rounding errors are of like size.
        let least = self.engine.least_size();
        let step = f64::EPSILON.cbrt() * largest(state).max(least) / length;
        let (mut values, mut states) = (Vec::new(), Vec::new());
        for sign in [1.0, -1.0] {
            let mut moved: Vec<f64> = state.iter().zip(v).map(|(y, v)| y + sign * step * v).collect();
            let at = t + sign * step * in_time;
            values.push(self.evaluate(at, &moved)?[event]);
            if projects {
                self.reset(event, at, &mut moved)?;
            } else {
                self.reset_alone(event, at, &mut moved)?;
            }
            states.push(moved);
        }
        let quotient = |ahead: f64, behind: f64| (ahead - behind) / (2.0 * step);
        let reset =
            states[0].iter().zip(&states[1]).map(|(ahead, behind)| quotient(*ahead, *behind)).collect();
        let size = (values[0].abs() + values[1].abs()) / (2.0 * step);
        Ok((quotient(values[0], values[1]), size, reset))
    }

    /// The same, from the derivatives that the events provide.
    fn own_derivative_along(
        &mut self,
        event: usize,
        (t, state): (f64, &[f64]),
        (in_time, v): (f64, &[f64]),
    ) -> Result<(f64, f64, Vec<f64>), SolveError> {
        let mut by_state = vec![f64::NAN; state.len()];
        let mut reset = vec![f64::NAN; state.len()];
        let by_time = self.events.gradient(event, t, state, &mut by_state);
        let along = self.events.reset_along(event, t, state, (in_time, v), &mut reset);
        match by_time.and_then(|by_time| along.map(|()| by_time)) {
            Ok(by_time) => {
                let terms = || by_state.iter().zip(v).map(|(g, v)| g * v).chain([by_time * in_time]);
                Ok((terms().sum(), terms().map(f64::abs).sum(), reset))
            }
            Err(failure) => Err(self.event_error(event, t, failure)),
        }
    }
}
