//! The change that a reset makes in the derivatives of a motion.

use pc_expr::{Events, VectorField};

use crate::error::{Reason, SolveError};
use crate::integration::integration::Integration;
use crate::integration::stepper::Stepper;

/// A projection that moves the result of a reset by at most this much, absolutely or relatively,
/// whichever is larger, changes it only by rounding errors.
const OFF: f64 = 1e-8;

/// A function whose rate along the motion is smaller than this fraction of the sum of the rate's
/// terms only touches zero.
const GRAZING: f64 = 1e-9;

/// Rates that differ by less than this fraction count as equal: the field has a corner there and
/// does not jump.
const SAME_RATES: f64 = 1e-12;
/// The derivatives of the times at which several surfaces are reached together count as equal if
/// they differ by less than this.
const SAME_SHIFTS: f64 = 1e-9;

/// The slopes of the function of a surface.
struct Slopes {
    by_time: f64,
    by_state: Vec<f64>,
    /// The change of the function along each column.
    changes: Vec<f64>,
}

impl<S: Stepper, E: Events> Integration<S, E> {
    /// Computes S⁺ from S⁻ at an event at time t, with the function g and the reset y⁺ = R(t, y⁻),
    /// ```text
    /// s⁺ = R_y s⁻ + R_p + (R_t + R_y f⁻ − f⁺) τ,    τ = ∂tₑ/∂p = −(g_y s⁻ + g_p)/(g_t + g_y f⁻)
    /// ```
    /// with f⁻ = f(t, y⁻) and f⁺ = f(t, y⁺) [Hiskens, Pai, IEEE Trans. Circuits Syst. I 47 (2000)
    /// 204, eqs. (37)–(43)]. The derivatives with respect to parameters are those that the events
    /// provide; so are the derivatives with respect to (t, y) if the events [have
    /// them](Events::has_derivatives); otherwise these are central difference quotients along the
    /// columns and along the motion.
    ///
    /// An event that is set off by the reset of another event occurs at the same time: `shifts`,
    /// once known, are the τ of all resets at t, and the S⁺ of each is the S⁻ of the next.
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
        // A reset after another one begins on the sides of its own start.
        let rates_before =
            if shifts.is_none() { self.rates_at(t, before)? } else { self.rates_of_start(t, before)? };
        let rates_after = self.rates_of_start(t, after)?;
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

    /// Continues from the front, where these surfaces of the field are reached; the derivatives
    /// jump as they do at an event that resets nothing,
    /// ```text
    /// s⁺ = s⁻ + (f⁻ − f⁺) τ,    τ = −(g_y s⁻ + g_p)/(g_t + g_y f⁻)
    /// ```
    /// [Filippov 1988, § 10; Hiskens, Pai 2000, eq. (37)].
    pub(crate) fn pass(&mut self, due: &[usize]) -> Result<(), SolveError> {
        let (t, state) = (self.front.t, self.front_state.clone());
        self.engine.stand_at(t);
        let mut matrix = self.engine.columns()?;
        let before = if matrix.is_empty() { Vec::new() } else { self.rates_at(t, &state)? };
        // A surface lets go where f beside it is f along it: nothing jumps. The time of a break does not move.
        let crossed = due.iter().copied();
        let crossed = crossed.filter(|&surface| self.held.sides[surface] != 0.0 && !self.jumps(surface));
        let crossed: Vec<usize> = crossed.collect();
        let slopes = self.slopes_of(&crossed, t, &state, &matrix)?;
        self.pass_surfaces(due)?;
        if !matrix.is_empty() && !crossed.is_empty() {
            let after = self.rates_at(t, &state)?;
            if jumps(&before, &after) {
                let step: Vec<f64> =
                    before.iter().zip(&after).map(|(before, after)| before - after).collect();
                let shifts = self.common_shifts(&crossed, t, &before, &slopes)?;
                for (column, shift) in matrix.chunks_exact_mut(state.len()).zip(shifts) {
                    column.iter_mut().zip(&step).for_each(|(s, step)| *s += step * shift);
                }
            }
        }
        self.engine.enter_piece(t, &state, &matrix, self.direction)?;
        self.restarted = true;
        Ok(())
    }

    pub(crate) fn has_columns(&self) -> bool {
        !self.engine.column_parameters().is_empty()
    }

    /// For each occurrence so far, the derivatives of its time with respect to the variable of each column of the
    /// sensitivities, τ = −(g_y s⁻ + g_p)/(g_t + g_y f⁻). The list is empty without sensitivities;
    /// its entries are NaN if the events have no derivatives with respect to
    /// [parameters](Events::by_parameter), and where the functions of the events only touch zero.
    pub fn time_derivatives(&self) -> &[Vec<f64>] {
        &self.time_derivatives
    }

    /// The same for the events at the front.
    pub(crate) fn time_derivatives_of_due(&mut self, t: f64) -> Result<Vec<(usize, Vec<f64>)>, SolveError> {
        if !self.has_columns() {
            return Ok(Vec::new());
        }
        let own = self.events.events().len();
        let due: Vec<usize> = self.due.iter().copied().filter(|&event| event < own).collect();
        if due.is_empty() {
            return Ok(Vec::new());
        }
        self.engine.stand_at(t);
        let (matrix, state) = (self.engine.columns()?, self.front_state.clone());
        let rates = self.rates_at(t, &state)?;
        let parameters = self.engine.column_parameters().to_vec();
        let mut all = Vec::with_capacity(due.len());
        for event in due {
            // Where a function has no value beside, its time has no derivative.
            let unknown = (f64::NAN, f64::NAN);
            let (along, size) = self.function_along(event, (t, &state), (1.0, &rates)).unwrap_or(unknown);
            let touches = along.abs() <= GRAZING * size;
            let mut shifts = Vec::with_capacity(parameters.len());
            for (column, parameter) in matrix.chunks_exact(state.len()).zip(&parameters) {
                let mut change = self.function_along(event, (t, &state), (0.0, column)).unwrap_or(unknown).0;
                if let Some(j) = *parameter {
                    let mut reset = vec![f64::NAN; state.len()];
                    let own = match self.events.has_parameter_derivatives() {
                        true => self.events.by_parameter(event, j, t, &state, &mut reset),
                        false => Ok(f64::NAN),
                    };
                    change += own.unwrap_or(f64::NAN);
                }
                shifts.push(if touches { f64::NAN } else { -change / along });
            }
            all.push((event, shifts));
        }
        Ok(all)
    }

    /// The derivative of the function of an event along the direction (1, v) or (0, v) in time and
    /// state, and the size of the terms of this derivative.
    fn function_along(
        &mut self,
        event: usize,
        (t, state): (f64, &[f64]),
        (in_time, v): (f64, &[f64]),
    ) -> Result<(f64, f64), SolveError> {
        if self.events.has_derivatives() {
            let mut by_state = vec![f64::NAN; state.len()];
            return match self.events.gradient(event, t, state, &mut by_state) {
                Ok(by_time) => Ok(rate_along(by_time * in_time, &by_state, v)),
                Err(failure) => Err(self.event_error(event, t, failure)),
            };
        }
        let largest = |v: &[f64]| v.iter().fold(0.0, |size: f64, v| size.max(v.abs()));
        let length = largest(v).max(in_time);
        if length == 0.0 {
            return Ok((0.0, 0.0));
        }
        let least = self.engine.least_size();
        let step = f64::EPSILON.cbrt() * largest(state).max(least) / length;
        let mut values = [0.0; 2];
        for (value, step) in values.iter_mut().zip([step, -step]) {
            let moved: Vec<f64> = state.iter().zip(v).map(|(y, v)| y + step * v).collect();
            *value = self.evaluate(t + step * in_time, &moved)?[event];
        }
        let size = (values[0].abs() + values[1].abs()) / (2.0 * step);
        Ok(((values[0] - values[1]) / (2.0 * step), size))
    }

    /// The gradient (g_t, g_y) of the function of each of these surfaces, and g_y s⁻ + g_p for each
    /// column.
    fn slopes_of(
        &mut self,
        due: &[usize],
        t: f64,
        state: &[f64],
        matrix: &[f64],
    ) -> Result<Vec<Slopes>, SolveError> {
        if matrix.is_empty() {
            return Ok(Vec::new());
        }
        let parameters = self.engine.column_parameters().to_vec();
        let Some(field) = self.engine.field_mut().switching() else { return Ok(Vec::new()) };
        let mut all = Vec::with_capacity(due.len());
        for &surface in due {
            let mut by_state = vec![0.0; state.len()];
            let by_time = field.gradient(surface, t, state, &mut by_state);
            let change = |(column, parameter): (&[f64], &Option<usize>)| {
                let own = parameter.and_then(|j| field.by_parameter(surface, j, t, state)).unwrap_or(0.0);
                own + by_state.iter().zip(column).map(|(slope, s)| slope * s).sum::<f64>()
            };
            let changes = matrix.chunks_exact(state.len()).zip(&parameters).map(change).collect();
            all.push(Slopes { by_time, by_state, changes });
        }
        Ok(all)
    }

    /// The τ of each column, which must be the same for all surfaces reached.
    fn common_shifts(
        &mut self,
        due: &[usize],
        t: f64,
        rates: &[f64],
        slopes: &[Slopes],
    ) -> Result<Vec<f64>, SolveError> {
        let mut common: Option<Vec<f64>> = None;
        for (&surface, slopes) in due.iter().zip(slopes) {
            let (along, size) = rate_along(slopes.by_time, &slopes.by_state, rates);
            if along.abs() <= GRAZING * size {
                let event = self.surface(surface);
                return Err(self.failed(Reason::Grazing { event, t }, None));
            }
            let shifts: Vec<f64> = slopes.changes.iter().map(|change| -change / along).collect();
            if common.as_ref().is_some_and(|known| differ(known, &shifts)) {
                let events = due.iter().map(|&surface| self.surface(surface)).collect();
                return Err(self.failed(Reason::Together { events, t }, None));
            }
            common.get_or_insert(shifts);
        }
        Ok(common.unwrap_or_default())
    }

    /// The function of a surface, as text.
    fn surface(&mut self, surface: usize) -> String {
        let field = self.engine.field_mut().switching();
        field.and_then(|field| field.surfaces().get(surface).cloned()).unwrap_or_default()
    }

    /// Computes λ⁻, and the increment of ∂G/∂p for each parameter p, from λ⁺ at such an event,
    /// ```text
    /// λ⁻ = R_yᵀ λ⁺ − κ g_y,    R_pᵀ λ⁺ − κ g_p,    κ = (λ⁺·(R_t + R_y f⁻ − f⁺) + δ)/(g_t + g_y f⁻)
    /// ```
    /// where the density of G is larger by δ before the event than after it. This is the rule for
    /// S⁺ above, multiplied by λ⁺ from the left.
    #[cfg(feature = "cvode")] // for the adjoint equations
    pub(crate) fn transposed_jump(
        &mut self,
        event: usize,
        (t, before, after): (f64, &[f64], &[f64]),
        (sides_before, sides_after): (&[f64], &[f64]),
        (adjoint, density_step): (&[f64], f64),
        parameters: usize,
    ) -> Result<(Vec<f64>, Vec<f64>), SolveError> {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let projects = self.is_projected(event, t, before, after)?;
        self.hold_on(sides_before);
        let rates_before = self.rates_at(t, before)?;
        self.hold_on(sides_after);
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
    /// If not, the projection is not part of R: the derivatives with respect to parameters that
    /// move the surface have components out of the surface, and must not be projected onto it.
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

    /// The rates of a motion that starts from this state.
    fn rates_of_start(&mut self, t: f64, state: &[f64]) -> Result<Vec<f64>, SolveError> {
        if self.held.len() == 0 {
            return self.rates_at(t, state);
        }
        let front = std::mem::replace(&mut self.front_state, state.to_vec());
        let (held, values, sides) = (self.held.clone(), self.front.values.clone(), self.sides.clone());
        self.held.are_known = false;
        let found = self.find_sides(self.direction.unwrap_or(1.0));
        let rates = found.and_then(|()| self.rates_at(t, state));
        (self.front_state, self.held, self.front.values, self.sides) = (front, held, values, sides);
        let sides = self.held.sides.clone();
        self.hold_on(&sides);
        rates
    }

    fn rates_at(&mut self, t: f64, state: &[f64]) -> Result<Vec<f64>, SolveError> {
        let mut rates = vec![f64::NAN; state.len()];
        let outcome = self.engine.field_mut().rhs(t, state, &mut rates);
        match outcome {
            Ok(()) => Ok(rates),
            Err(failure) => Err(self.failed(Reason::Saltation { t }, Some(failure))),
        }
    }

    /// The derivative of g along the direction (1, v) or (0, v) in time and state, the size |g_t| +
    /// Σ |g_yᵢ vᵢ| of its terms or an estimate of that size, and the derivative of R along that
    /// direction, with or without the projection of the field.
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

    /// The same, computed from the derivatives that the events provide.
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

/// Computes λ⁻, and the increment of ∂G/∂p for each parameter p, from λ⁺ where f jumps on surfaces
/// that are reached together.
#[cfg(feature = "cvode")] // for the adjoint equations
pub(crate) fn transposed_passage<F: VectorField>(
    field: &mut F,
    due: &[usize],
    (t, y): (f64, &[f64]),
    (before, after): (&[f64], &[f64]),
    (adjoint, parameters): (&[f64], usize),
) -> Result<(Vec<f64>, Vec<f64>), SolveError> {
    let fail = |reason: Reason, failure: Option<pc_expr::Failure>| {
        SolveError::Integration(Box::new(crate::error::IntegrationError {
            reason,
            time: t,
            state: y.to_vec(),
            failure,
        }))
    };
    let mut rates = [vec![f64::NAN; y.len()], vec![f64::NAN; y.len()]];
    for (rates, sides) in rates.iter_mut().zip([before, after]) {
        if let Some(field) = field.switching() {
            field.hold(Some(sides));
        }
        let outcome = field.rhs(t, y, rates);
        outcome.map_err(|failure| fail(Reason::Saltation { t }, Some(failure)))?;
    }
    let [rates_before, rates_after] = rates;
    let unchanged = Ok((adjoint.to_vec(), vec![0.0; parameters]));
    let Some(field) = field.switching().filter(|_| jumps(&rates_before, &rates_after)) else {
        return unchanged;
    };
    let step = rates_before.iter().zip(&rates_after).map(|(before, after)| before - after);
    let step: f64 = adjoint.iter().zip(step).map(|(adjoint, step)| adjoint * step).sum();
    // The derivative of minus the time of the passage by (y, p).
    let mut common: Option<Vec<f64>> = None;
    for &surface in due {
        let mut slopes = vec![0.0; y.len()];
        let by_time = field.gradient(surface, t, y, &mut slopes);
        let (along, size) = rate_along(by_time, &slopes, &rates_before);
        if along.abs() <= GRAZING * size {
            let event = field.surfaces()[surface].clone();
            return Err(fail(Reason::Grazing { event, t }, None));
        }
        slopes.extend((0..parameters).map(|j| field.by_parameter(surface, j, t, y).unwrap_or(0.0)));
        slopes.iter_mut().for_each(|slope| *slope /= along);
        if common.as_ref().is_some_and(|known| differ(known, &slopes)) {
            let events = due.iter().map(|&surface| field.surfaces()[surface].clone()).collect();
            return Err(fail(Reason::Together { events, t }, None));
        }
        common.get_or_insert(slopes);
    }
    let Some(slopes) = common else { return unchanged };
    let (by_state, by_parameters) = slopes.split_at(y.len());
    let jumped = adjoint.iter().zip(by_state).map(|(adjoint, slope)| adjoint - step * slope).collect();
    Ok((jumped, by_parameters.iter().map(|slope| -step * slope).collect()))
}

/// Whether rates jump by more than rounding error.
fn jumps(before: &[f64], after: &[f64]) -> bool {
    before.iter().zip(after).any(|(a, b)| (a - b).abs() > SAME_RATES * a.abs().max(b.abs()))
}

/// The derivative dg/dt for these rates, and the sum of the magnitudes of its terms.
fn rate_along(by_time: f64, slopes: &[f64], rates: &[f64]) -> (f64, f64) {
    let terms = slopes.iter().zip(rates).map(|(slope, rate)| slope * rate);
    terms.fold((by_time, by_time.abs()), |(sum, size), term| (sum + term, size + term.abs()))
}

/// Whether two lists of derivatives of event times differ.
fn differ(known: &[f64], other: &[f64]) -> bool {
    known.iter().zip(other).any(|(a, b)| (a - b).abs() > SAME_SHIFTS * a.abs().max(b.abs()).max(1.0))
}
