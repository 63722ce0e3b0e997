//! Finds out whether a state satisfies the constraints.

use pc_mech::{CompileOptions, Constraint, Expr, MechError, System, VectorField};
use pc_nonholo::ConstraintClassification;

use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::model::model::Model;

/// A start is considered to satisfy a constraint, up to the rounding of its digits, if changing a coordinate or velocity by less
/// than this fraction of its value would make the start satisfy it exactly. Small coordinates may be off by as much as larger
/// coordinates in the same constraint, and by as much as a coordinate of size 1.
const OFF: f64 = 1e-8;

/// If all coordinates in a constraint are smaller than this, they are presumably in other units, and 1 is not
/// a measure of their size.
const SMALL: f64 = 1e-2;

/// A coordinate may always be off by this number times [`OFF`]: the rounding error of numbers of order one, such as
/// cos(π/2).
const LEAST: f64 = 1e-7;

/// The indices of the components that stay as they are when the start is moved onto the constraints.
pub(super) struct StartHeld {
    coordinates: Vec<usize>,
    quasi_velocities: Vec<usize>,
}

impl StartHeld {
    /// The components that the model holds fixed, and the first `prescribed` quasi-velocities.
    pub(super) fn new(model: &Model, prescribed: usize) -> StartHeld {
        let n = model.document().coordinates.len();
        let (coordinates, named): (Vec<usize>, Vec<usize>) =
            model.held_starts().iter().partition(|&&place| place < n);
        let named = named.into_iter().map(|place| place - n);
        let mut quasi_velocities: Vec<usize> = named.chain(0..prescribed).collect();
        quasi_velocities.sort_unstable();
        quasi_velocities.dedup();
        StartHeld { coordinates, quasi_velocities }
    }

    fn is_empty(&self) -> bool {
        self.coordinates.is_empty() && self.quasi_velocities.is_empty()
    }

    fn names(&self, system: &System<'_>) -> Vec<String> {
        let coordinates = self.coordinates.iter().map(|&i| system.frame().coordinates()[i]);
        let eta = self.quasi_velocities.iter().map(|&s| system.quasi_velocities()[s]);
        coordinates.chain(eta).map(|symbol| symbol.to_string()).collect()
    }
}

/// The constraints of a model, evaluated at states of time `t`.
pub(super) struct Trial<'a, 'g> {
    pub(super) model: &'a Model,
    pub(super) system: &'a System<'g>,
    pub(super) constraints: &'a [Constraint<'g>],
    pub(super) t: f64,
}

impl<'g> Trial<'_, 'g> {
    /// The nearest state that has the same held components and satisfies the binding constraints.
    ///
    /// # Errors
    /// [`ModelError`] if none is found.
    pub(super) fn nearest(
        &self,
        classification: &ConstraintClassification<'g>,
        state: &[f64],
        held: &StartHeld,
    ) -> Result<Vec<f64>, ModelError> {
        let mut nearest = state.to_vec();
        let refused = |error: MechError| self.model.document().constraint_error(error.into());
        if let Some(multipliers) = classification.multipliers() {
            let options = CompileOptions::default().jacobian(false);
            // What is observed may contain reactions that are not attached yet.
            let bare = self.system.without_observed().with_multipliers(multipliers.constraints());
            let mut motion = bare.and_then(|bare| bare.compile_for(options)).map_err(refused)?;
            if held.is_empty() {
                motion.project(self.t, &mut nearest).map_err(|failure| refused(failure.into()))?;
            } else {
                let (coordinates, eta) = (&held.coordinates, &held.quasi_velocities);
                let moved = motion.project_holding(self.t, &mut nearest, coordinates, eta);
                moved.map_err(|failure| {
                    let error = MechError::from(failure);
                    match error.singular_constraint() {
                        Some(constraint) => {
                            let held = held.names(self.system);
                            let fault = MeaningError::StartHeld { constraint: constraint.to_owned(), held };
                            self.model.document().constraint_fault(constraint, fault)
                        }
                        None => refused(error),
                    }
                })?;
            }
        }
        Ok(nearest)
    }

    /// Checks that the constraints and their rates have values.
    ///
    /// # Errors
    /// [`MeaningError::NotFinite`] at the first constraint that has no value.
    pub(super) fn check_finite(&self, state: &[f64]) -> Result<(), ModelError> {
        for constraint in self.constraints {
            let value = self.value(constraint.velocity(self.system), state);
            let Some(text) =
                self.model.document().constraint_text(constraint.name()).filter(|_| !value.is_finite())
            else {
                continue;
            };
            let whole = &text.expression.text;
            let text_of_rate =
                if constraint.is_holonomic(self.system) { format!("d({whole})") } else { whole.clone() };
            let names = self.state_symbols().map(|x| x.to_string()).zip(state.iter().copied());
            let fault = MeaningError::NotFinite { text: text_of_rate, value, state: names.collect() };
            return Err(self.model.document().error(&text.expression.place(text.expression.ast.span), fault));
        }
        Ok(())
    }

    /// Checks that dropped constraints hold wherever the binding constraints do: a condition on positions may
    /// follow from others only up to a constant.
    ///
    /// # Errors
    /// [`MeaningError::Contradictory`]
    pub(super) fn check_redundant(
        &self,
        classification: &ConstraintClassification<'g>,
        on: &[f64],
    ) -> Result<(), ModelError> {
        for redundant in classification.redundant() {
            let written = self.constraints.iter().find(|c| c.name() == redundant.constraint);
            if let Some((constraint, (_, residual))) = written.and_then(|c| Some((c, self.off(c, on)?))) {
                let others = redundant.follows_from.clone();
                let fault = MeaningError::Contradictory {
                    constraint: constraint.name().to_owned(),
                    others,
                    residual,
                };
                return Err(self.model.document().constraint_fault(constraint.name(), fault));
            }
        }
        Ok(())
    }

    /// Checks that all constraints are satisfied.
    ///
    /// # Errors
    /// [`MeaningError::OffConstraint`] at the first constraint that is not satisfied.
    pub(super) fn check(&self, state: &[f64]) -> Result<(), ModelError> {
        let off =
            |constraint: &Constraint<'g>| Some((constraint.name().to_owned(), self.off(constraint, state)?));
        match self.constraints.iter().find_map(off) {
            None => Ok(()),
            Some((constraint, (what, residual))) => {
                let fault = MeaningError::OffConstraint { what, constraint: constraint.clone(), residual };
                Err(self.model.document().constraint_fault(&constraint, fault))
            }
        }
    }

    /// If the constraint or its rate does not vanish, a phrase that says which of the two it is, and its
    /// value.
    fn off(&self, constraint: &Constraint<'g>, state: &[f64]) -> Option<(&'static str, f64)> {
        let x = self.system.frame().coordinates();
        let eta = self.system.quasi_velocities();
        let rate = (constraint.velocity(self.system), eta);
        if !constraint.is_holonomic(self.system) {
            return self.misses(rate, state).map(|residual| ("it is", residual));
        }
        let position = self.misses((constraint.expression(), x), state).map(|residual| ("it is", residual));
        position.or_else(|| self.misses(rate, state).map(|residual| ("its rate is", residual)))
    }

    /// The value of an expression that should vanish, unless changing the `movable` symbols by the fraction
    /// [`OFF`] can make it zero.
    fn misses(&self, (value, movable): (Expr<'g>, &[Expr<'g>]), state: &[f64]) -> Option<f64> {
        let graph = self.system.graph();
        let slopes = graph.gradient(value, movable).into_iter().map(|slope| self.value(slope, state));
        let sizes = movable.iter().map(|&x| self.value(x, state).abs());
        let moving: Vec<(f64, f64)> =
            slopes.map(f64::abs).zip(sizes).filter(|&(slope, _)| slope > 0.0).collect();
        let largest = moving.iter().fold(0.0, |largest, &(_, size)| f64::max(largest, size));
        let least = if largest > 0.0 { (largest / SMALL).clamp(LEAST, 1.0) } else { 1.0 };
        let reach = moving.iter().map(|&(slope, size)| slope * size.max(least)).fold(0.0, f64::max);
        let residual = self.value(value, state);
        // An expression that nothing moves is compared directly.
        let within = residual.abs() <= OFF * if reach > 0.0 { reach } else { 1.0 };
        (!within).then_some(residual)
    }

    fn state_symbols(&self) -> impl Iterator<Item = Expr<'g>> {
        self.system.state().into_iter()
    }

    fn value(&self, expression: Expr<'g>, state: &[f64]) -> f64 {
        let mut values: Vec<(Expr<'g>, f64)> = self.system.parameters().to_vec();
        values.push((self.system.frame().time(), self.t));
        values.extend(self.state_symbols().zip(state.iter().copied()));
        self.system.graph().evaluate(&[expression], &values).map_or(f64::NAN, |values| values[0])
    }
}
