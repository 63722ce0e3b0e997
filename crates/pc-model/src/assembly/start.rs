//! The start of a motion, found from its given parts.

use pc_algebra::affine;
use pc_expr::{Inputs, Program};
use pc_mech::{Expr, Frame, Graph, MechError};

use super::constraints::Written;
use crate::assembly::assembler::Assembler;
use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::document::{Contact, Expression, Name};
use crate::model::model::Model;
use crate::names::scope::{Scope, entry};
use crate::names::stage::Stage;

/// A unit vector that leaves no larger remainder than this is treated as linearly dependent on others: the
/// remainder is rounding error.
const DEPENDENT: f64 = 1e-9;

/// Velocities are considered equal if they differ by less than this fraction of the velocities from which
/// they are determined.
const OFF: f64 = 1e-8;

/// The parts of the start that are given.
pub(super) struct Given {
    /// The values of coordinates, then of the declared quasi-velocities, or of velocities if no
    /// quasi-velocity is declared; values that are not given are zero.
    pub(super) values: Vec<f64>,
    /// Whether each of these values is given.
    pub(super) is_given: Vec<bool>,
    /// Velocities of coordinates that are given in addition to quasi-velocities, in the order of
    /// `start_velocities`.
    velocities: Vec<f64>,
    /// The values of first-order states; zero if not given.
    pub(super) states: Vec<f64>,
}

/// The given start values alone: those of the coordinates, of the declared quasi-velocities or, if there are
/// none, of the velocities, and of the first-order states.
///
/// # Errors
/// [`ModelError`] if a value is not a number.
pub(crate) fn start(model: &Model, graph: &Graph) -> Result<Vec<f64>, ModelError> {
    let parameters: Vec<(Expr<'_>, f64)> =
        model.parameters().map(|(name, value)| (graph.symbol(name), value)).collect();
    let mut assembler = Assembler { model, graph, scope: Scope::new(graph, model.document()) };
    let given = assembler.given_start(&parameters)?;
    Ok([given.values, given.states].concat())
}

/// The start values as the text has them, in the same order, as functions of the parameters.
///
/// # Errors
/// [`ModelError`] if an expression is wrong.
pub(crate) fn written_start(model: &Model, graph: &Graph) -> Result<Program, ModelError> {
    let document = model.document();
    let mut scope = Scope::new(graph, document);
    let mut resolved = |expression: Option<&Expression>| match expression {
        Some(expression) => scope.resolve(expression, Stage::Start),
        None => Ok(Expr::ZERO),
    };
    let mut values = Vec::new();
    for coordinate in &document.coordinates {
        values.push(resolved(Some(&coordinate.expression))?);
    }
    for quasi_velocity in &document.quasi_velocities {
        values.push(resolved(quasi_velocity.start.as_ref())?);
    }
    if document.quasi_velocities.is_empty() {
        for coordinate in &document.coordinates {
            let velocity = entry(&document.start_velocities, &coordinate.name.text);
            values.push(resolved(velocity.map(|velocity| &velocity.expression))?);
        }
    }
    for state in &document.states {
        values.push(resolved(state.start.as_ref())?);
    }
    let parameters = model.parameters().map(|(name, _)| graph.symbol(name)).collect();
    let inputs = Inputs { time: None, state: Vec::new(), parameters };
    Program::new(graph, &inputs, &values).map_err(|error| document.derivation_error(MechError::from(error)))
}

impl<'g> Assembler<'g, '_> {
    /// The start values of the text, or those that replace them.
    pub(super) fn given_start(&mut self, parameters: &[(Expr<'g>, f64)]) -> Result<Given, ModelError> {
        let document = self.model.document();
        let (mut values, mut is_given, mut velocities) = (Vec::new(), Vec::new(), Vec::new());
        let found: Vec<&Name> = document.contacts.iter().flat_map(Contact::found_coordinates).collect();
        let is_found = |name: &Name| found.iter().any(|found| found.text == name.text);
        for coordinate in &document.coordinates {
            values.push(self.start_value(&coordinate.expression, parameters)?);
            is_given.push(!is_found(&coordinate.name));
        }
        for quasi_velocity in &document.quasi_velocities {
            let start = quasi_velocity.start.as_ref();
            values.push(start.map_or(Ok(0.0), |start| self.start_value(start, parameters))?);
            is_given.push(start.is_some());
        }
        for velocity in &document.start_velocities {
            if entry(&document.coordinates, &velocity.name.text).is_none() {
                return Err(self.not_a_coordinate(&velocity.name));
            }
            velocities.push(self.start_value(&velocity.expression, parameters)?);
        }
        if self.is_lagrangian_form() {
            let names = || document.start_velocities.iter().map(|velocity| &velocity.name.text);
            for coordinate in &document.coordinates {
                let place = names().position(|name| *name == coordinate.name.text);
                values.push(place.map_or(0.0, |place| velocities[place]));
                is_given.push(place.is_some());
            }
            velocities.clear();
        }
        let mut states = Vec::with_capacity(document.states.len());
        for state in &document.states {
            states.push(state.start.as_ref().map_or(Ok(0.0), |start| self.start_value(start, parameters))?);
        }
        for &(place, value) in self.model.overridden_starts() {
            match place.checked_sub(values.len()) {
                Some(state) => states[state] = value,
                None => (values[place], is_given[place]) = (value, true),
            }
        }
        Ok(Given { values, is_given, velocities, states })
    }

    fn start_value(
        &mut self,
        expression: &Expression,
        parameters: &[(Expr<'g>, f64)],
    ) -> Result<f64, ModelError> {
        let value = self.scope.resolve(expression, Stage::Start)?;
        let values = self.graph.evaluate(&[value], parameters);
        let value = values.map_or(f64::NAN, |values| values[0]); // it can contain only parameters
        if value.is_finite() {
            return Ok(value);
        }
        let fault = |text| MeaningError::NotFinite { text, value, state: Vec::new() };
        Err(self.scope.error(expression, expression.ast.span, fault))
    }

    /// The values at the start of the coordinates and of all quasi-velocities `eta` of the frame.
    /// Quasi-velocities that are not given are determined from given velocities, b η + b_0 = x', and from the
    /// constraints; declared quasi-velocities that these leave open are zero.
    ///
    /// # Errors
    /// [`MeaningError::StartVelocity`] for a velocity that the other velocities contradict;
    /// [`MeaningError::StartOpen`] if the quasi-velocities that complete the definitions are left open.
    pub(super) fn start_state(
        &self,
        frame: &Frame<'g>,
        eta: &[Expr<'g>],
        constraints: &[Written<'g>],
        at: &[(Expr<'g>, f64)],
        given: &Given,
    ) -> Result<Vec<f64>, ModelError> {
        let (n, declared) = (frame.coordinates().len(), given.values.len() - frame.coordinates().len());
        let mut start = given.values.clone();
        start.resize(n + eta.len(), 0.0);
        let velocities = self.scope.velocities();
        let is_complete = eta[declared..].iter().all(|extra| !velocities.contains(extra));
        let unit = |s: usize| (0..eta.len()).map(|r| f64::from(u8::from(r == s))).collect::<Vec<f64>>();
        // Constraints tie velocities together: those that are not given follow from the others, unless the start is moved anyway;
        // where loops tie joints it is moved from there.
        let moves = self.model.projects_start() && self.model.document().tree.is_empty();
        let follows = !moves && !(0..declared).all(|s| given.is_given[n + s]);
        if is_complete && given.velocities.is_empty() && !follows {
            return Ok(start);
        }
        let conditions = self.conditions(frame, eta, constraints, at);
        if is_complete && given.velocities.is_empty() && conditions.is_empty() {
            return Ok(start);
        }
        if is_complete && given.velocities.is_empty() {
            let mut written = Equations::default();
            (0..eta.len()).for_each(|s| _ = written.add(&unit(s), start[n + s]));
            if conditions.iter().all(|(row, value)| written.add(row, *value).is_none()) {
                return Ok(start);
            }
        }
        let mut equations = Equations::default();
        for s in (0..declared).filter(|&s| given.is_given[n + s]) {
            equations.add(&unit(s), start[n + s]);
        }
        for (row, value) in &conditions {
            equations.add(row, *value); // a contradiction shows as a start off its constraint
        }
        self.add_velocities(&mut equations, frame, at, &given.velocities)?;
        for s in (0..declared).filter(|&s| !given.is_given[n + s]) {
            equations.add(&unit(s), 0.0);
        }
        let open: Vec<String> =
            (0..eta.len()).filter(|&s| equations.leaves_open(&unit(s))).map(|s| eta[s].to_string()).collect();
        if !open.is_empty() {
            let place = &self.model.document().quasi_velocities[0].name.place;
            return Err(self.model.document().error(place, MeaningError::StartOpen { velocities: open }));
        }
        let solution = equations.solution(eta.len());
        for (s, value) in solution.into_iter().enumerate() {
            if s >= declared || !given.is_given[n + s] {
                start[n + s] = value;
            }
        }
        Ok(start)
    }

    /// The equations C η = −c_0 of the constraints that have values, with rows scaled to length one, so that
    /// the scale of a constraint does not affect how velocities are compared.
    fn conditions(
        &self,
        frame: &Frame<'g>,
        eta: &[Expr<'g>],
        constraints: &[Written<'g>],
        at: &[(Expr<'g>, f64)],
    ) -> Vec<(Vec<f64>, f64)> {
        let mut conditions = Vec::new();
        for (row, rest) in constraints.iter().filter_map(|c| self.condition(c, frame, eta)) {
            let values = self.graph.evaluate(&[row, vec![rest]].concat(), at).unwrap_or_default();
            let is_known = values.iter().all(|v| v.is_finite());
            if let Some((rest, row)) = values.split_last().filter(|_| is_known) {
                let length = norm(row);
                let length = if length > 0.0 { length } else { 1.0 };
                conditions.push((row.iter().map(|entry| entry / length).collect(), -rest / length));
            }
        }
        conditions
    }

    /// Adds the equations b η = x' − b_0 for the given velocities.
    fn add_velocities(
        &self,
        equations: &mut Equations,
        frame: &Frame<'g>,
        at: &[(Expr<'g>, f64)],
        velocities: &[f64],
    ) -> Result<(), ModelError> {
        let document = self.model.document();
        for (velocity, &given) in document.start_velocities.iter().zip(velocities) {
            let Some(i) = document.coordinates.iter().position(|x| x.name.text == velocity.name.text) else {
                continue;
            };
            let row = [&frame.b().row(i), &frame.b0()[i..=i]].concat();
            let values = self.graph.evaluate(&row, at).unwrap_or_default();
            let Some((drift, row)) = values.split_last().filter(|_| values.iter().all(|v| v.is_finite()))
            else {
                continue;
            };
            if let Some(found) = equations.add(row, given - drift) {
                let (coordinate, found) = (velocity.name.text.clone(), found + drift);
                let fault = MeaningError::StartVelocity { coordinate, given, found };
                return Err(self.model.document().error(&velocity.expression.whole(), fault));
            }
        }
        Ok(())
    }

    /// The coefficients C and c_0 of a constraint in terms of the quasi-velocities of the frame; `None` if it
    /// is not affine.
    fn condition(
        &self,
        written: &Written<'g>,
        frame: &Frame<'g>,
        eta: &[Expr<'g>],
    ) -> Option<(Vec<Expr<'g>>, Expr<'g>)> {
        let graph = self.graph;
        let rates = frame.velocities(eta);
        let put: Vec<_> = self.scope.velocities().into_iter().zip(rates.iter().copied()).collect();
        let value = graph.substitute(&[written.value()], &put)[0];
        let along: Vec<_> =
            frame.coordinates().iter().copied().zip(rates).chain(graph.in_time(frame.time())).collect();
        let on_velocities = !graph.jacobian(&[value], eta)[0].is_empty();
        let velocity = if on_velocities { value } else { graph.directional(&[value], &along)[0] };
        if written.is_nonlinear() { None } else { affine(graph, velocity, eta) }
    }
}

/// Linear equations, whose rows have length one and are each orthogonal to the preceding ones.
#[derive(Default)]
struct Equations {
    rows: Vec<(Vec<f64>, f64)>,
}

impl Equations {
    /// Adds the equation row · η = value. If earlier equations determine a different value of row · η,
    /// returns that value.
    fn add(&mut self, row: &[f64], value: f64) -> Option<f64> {
        let length = norm(row);
        let (rest, missing) = self.rest(row, value);
        let left = norm(&rest);
        if left > DEPENDENT * length {
            self.rows.push((rest.iter().map(|entry| entry / left).collect(), missing / left));
            return None;
        }
        (missing.abs() > OFF * value.abs().max(length * self.largest(row))).then_some(value - missing)
    }

    /// The largest magnitude of the unknowns in a row, as far as the equations determine them: a value that
    /// is small in comparison is small in any units.
    fn largest(&self, row: &[f64]) -> f64 {
        let known = self.solution(row.len()).into_iter().zip(row).filter(|&(_, &entry)| entry != 0.0);
        known.fold(0.0, |largest, (value, _)| largest.max(value.abs()))
    }

    /// The part of an equation that is independent of the equations already present.
    fn rest(&self, row: &[f64], value: f64) -> (Vec<f64>, f64) {
        let (mut rest, mut missing) = (row.to_vec(), value);
        // Two passes are enough.
        for (known, right) in self.rows.iter().chain(&self.rows) {
            let along: f64 = known.iter().zip(&rest).map(|(a, b)| a * b).sum();
            rest.iter_mut().zip(known).for_each(|(rest, known)| *rest -= along * known);
            missing -= along * right;
        }
        (rest, missing)
    }

    fn leaves_open(&self, row: &[f64]) -> bool {
        norm(&self.rest(row, 0.0).0) > DEPENDENT
    }

    fn solution(&self, unknowns: usize) -> Vec<f64> {
        (0..unknowns).map(|s| self.rows.iter().map(|(row, right)| row[s] * right).sum()).collect()
    }
}

fn norm(values: &[f64]) -> f64 {
    values.iter().fold(0.0f64, |size, value| size.hypot(*value))
}
