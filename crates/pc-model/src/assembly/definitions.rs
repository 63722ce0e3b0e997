//! The frame of quasi-velocities defined by `is`.

use pc_algebra::affine;
use pc_mech::{AlgebraError, Constraint, Expr, Frame, System};
use pc_nonholo::Binding;

use super::constraints::Written;
use crate::assembly::assembler::Assembler;
use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::document::Expression;
use crate::names::stage::Stage;

/// A coefficient smaller than this fraction of the largest coefficient in its row is not used as a pivot.
const SMALL: f64 = 1e-3;

/// The quasi-velocities that complete the definitions to a frame: their symbols, their definitions in terms
/// of x', and the constraints from which they come.
#[derive(Default)]
struct Completion<'g> {
    symbols: Vec<Expr<'g>>,
    values: Vec<Expr<'g>>,
    constraints: Vec<usize>,
}

impl<'g> Assembler<'g, '_> {
    /// The frame defined by η = a x' + a_0, and the quasi-velocities that complete the declared ones if there are
    /// fewer of these than coordinates.
    ///
    /// The definitions, the constraints on velocities that contain x', and the time derivatives of the
    /// constraints on positions must together determine x'. If all constraints are on velocities, their
    /// left-hand sides complete the frame, as quasi-velocities that vanish. If some constraints are on
    /// positions, velocities x' complete the frame, provided that its matrix is then regular everywhere; the
    /// constraints then have multipliers, and other independent velocities are taken wherever the η do not
    /// determine x'. Otherwise the constraints complete the frame, and it is singular only where the η do not
    /// determine x'.
    pub(super) fn frame_of_definitions(
        &mut self,
        time: Expr<'g>,
        x: Vec<Expr<'g>>,
        constraints: &mut [Written<'g>],
        at: &[(Expr<'g>, f64)],
    ) -> Result<(Frame<'g>, Vec<Expr<'g>>), ModelError> {
        let definitions = self.definitions()?;
        let velocities = self.scope.velocities();
        let rows = self.coefficients_of(&definitions)?;
        let (kinematic, binding) = self.completing(&definitions, constraints, at)?;
        let place = &self.model.document().quasi_velocities[0].name.place;
        // If definitions and constraints on velocities determine all velocities, those on positions restrict
        // them.
        let positions = binding.iter().filter(|(_, constraint)| constraint.is_holonomic(&kinematic)).count();
        let (all, coordinates) = (definitions.len() + binding.len(), x.len());
        if all != coordinates && all - positions != coordinates {
            return Err(self
                .model
                .document()
                .error(place, MeaningError::DefinitionCount { definitions: all, coordinates }));
        }
        if self.graph.generic_rank(&rows) < rows.len() {
            return Err(self.dependent(&rows, &Completion::default(), constraints));
        }
        let on_positions = positions > 0;
        let completion = match self.regular_completion(&rows, at).filter(|_| on_positions) {
            Some(velocities) => velocities,
            None => self.completed_by(rows, &kinematic, &binding, constraints),
        };
        let all = [definitions.as_slice(), &completion.values].concat();
        let frame = Frame::from_definitions(self.graph, time, x, &velocities, &all);
        let frame = frame.map_err(|error| match error {
            AlgebraError::SingularDefinitions => {
                let slopes =
                    all.iter().map(|&value| self.graph.gradient(value, &velocities)).collect::<Vec<_>>();
                self.dependent(&slopes, &completion, constraints)
            }
            other => self.model.document().algebra_error(other),
        })?;
        Ok((frame, completion.symbols))
    }

    /// The definitions of the quasi-velocities, with x' as symbols.
    fn definitions(&mut self) -> Result<Vec<Expr<'g>>, ModelError> {
        let mut definitions = Vec::new();
        for quasi_velocity in &self.model.document().quasi_velocities {
            let Some(is) = &quasi_velocity.is else {
                let name = quasi_velocity.name.text.clone();
                return Err(self
                    .model
                    .document()
                    .error(&quasi_velocity.name.place, MeaningError::Undefined { name }));
            };
            definitions.push(self.scope.resolve(is, Stage::Definition)?);
        }
        Ok(definitions)
    }

    /// The matrix a in the definitions η = a x' + a_0.
    fn coefficients_of(&self, definitions: &[Expr<'g>]) -> Result<Vec<Vec<Expr<'g>>>, ModelError> {
        let velocities = self.scope.velocities();
        let texts = self.model.document().quasi_velocities.iter().filter_map(|q| q.is.as_ref());
        let row = |(&definition, is): (&Expr<'g>, &Expression)| {
            let parts = affine(self.graph, definition, &velocities);
            let fault = |text| MeaningError::NonlinearQuasiVelocity { text, variables: "velocities" };
            parts.map(|(row, _)| row).ok_or_else(|| self.scope.error(is, is.ast.span, fault))
        };
        definitions.iter().zip(texts).map(row).collect()
    }

    /// The independent constraints that restrict the velocities left open by the definitions, and the system
    /// that they constrain. The constraints are in terms of the velocities x', and each comes with its index
    /// in the text. In these constraints, each η is replaced by its definition.
    ///
    /// If there are as many definitions as coordinates, constraints on positions are left out.
    fn completing(
        &self,
        definitions: &[Expr<'g>],
        constraints: &[Written<'g>],
        at: &[(Expr<'g>, f64)],
    ) -> Result<(System<'g>, Vec<(usize, Constraint<'g>)>), ModelError> {
        let (x, velocities, eta) =
            (self.scope.coordinates(), self.scope.velocities(), self.scope.quasi_velocities());
        let builder = System::builder(self.graph).coordinates(x.iter().map(Expr::to_string));
        let parameters = self.model.parameters().map(|(name, value)| (self.graph.symbol(name), value));
        let builder = parameters.fold(builder, |builder, (symbol, value)| builder.parameter(symbol, value));
        let kinematic = builder.lagrangian(|_, _, _| Expr::ZERO).build();
        let kinematic = kinematic.map_err(|error| self.model.document().derivation_error(error))?;
        let put: Vec<_> = eta.iter().copied().zip(definitions.iter().copied()).collect();
        let contains = |value: Expr<'g>, symbols: &[Expr<'g>]| symbols.iter().any(|&s| value.depends_on(s));
        let (mut places, mut restricting) = (Vec::new(), Vec::new());
        for written in constraints.iter().filter(|written| !written.is_nonlinear()) {
            let value = written.value();
            let on_position = !contains(value, &velocities) && !contains(value, &eta);
            if contains(value, &velocities) || (on_position && definitions.len() < x.len()) {
                let name = &self.model.document().constraints[written.place()].name.text;
                places.push(written.place());
                restricting.push(Constraint::new(name, self.graph.substitute(&[value], &put)[0]));
            }
        }
        let binding = Binding::new(&kinematic, &restricting, at);
        let binding = binding.map_err(|error| self.model.document().constraint_error(error))?;
        let independent = binding.binding().iter().map(|&a| (places[a], restricting[a].clone())).collect();
        Ok((kinematic, independent))
    }

    /// Velocities x' that complete the rows of definitions to a matrix whose determinant depends only on
    /// parameters, if such velocities exist: those without a pivot after an elimination whose pivots depend
    /// only on parameters.
    fn regular_completion(&self, rows: &[Vec<Expr<'g>>], at: &[(Expr<'g>, f64)]) -> Option<Completion<'g>> {
        let graph = self.graph;
        let parameters: Vec<Expr<'g>> = self.model.parameters().map(|(name, _)| graph.symbol(name)).collect();
        let is_fixed = |entry: &Expr<'g>| graph.symbols_of(&[*entry]).iter().all(|s| parameters.contains(s));
        let mut left = rows.to_vec();
        let mut open: Vec<usize> = (0..self.scope.coordinates().len()).collect();
        while !left.is_empty() {
            let mut best: Option<(f64, usize, usize)> = None;
            for (r, row) in left.iter().enumerate() {
                let sizes = graph.evaluate(row, at).ok()?;
                let size = |column: usize| sizes[column].abs();
                let largest = open.iter().map(|&column| size(column)).fold(0.0, f64::max);
                for &column in open.iter().filter(|&&column| is_fixed(&row[column])) {
                    let share = size(column) / largest;
                    if share > best.map_or(SMALL, |(share, ..)| share) {
                        best = Some((share, r, column));
                    }
                }
            }
            let (_, r, column) = best?;
            let pivot = left.remove(r);
            open.retain(|&other| other != column);
            for row in &mut left {
                let factor = row[column] / pivot[column];
                for &other in &open {
                    row[other] -= factor * pivot[other];
                }
                row[column] = Expr::ZERO;
            }
        }
        let velocities = self.scope.velocities();
        let symbols: Vec<Expr<'g>> = open.into_iter().map(|column| velocities[column]).collect();
        Some(Completion { values: symbols.clone(), symbols, constraints: Vec::new() })
    }

    /// The completion by the constraints themselves: first those on velocities, which are marked as defining
    /// quasi-velocities. If there are more constraints than needed, only those that are independent of the
    /// `rows` are used.
    fn completed_by(
        &self,
        mut rows: Vec<Vec<Expr<'g>>>,
        kinematic: &System<'g>,
        binding: &[(usize, Constraint<'g>)],
        constraints: &mut [Written<'g>],
    ) -> Completion<'g> {
        let (velocities, mut completion) = (self.scope.velocities(), Completion::default());
        let needed = velocities.len() - rows.len();
        let (on_positions, on_velocities): (Vec<_>, Vec<_>) =
            binding.iter().partition(|(_, constraint)| constraint.is_holonomic(kinematic));
        for (place, constraint) in on_velocities.into_iter().chain(on_positions) {
            rows.push(self.graph.gradient(constraint.velocity(kinematic), &velocities));
            if binding.len() > needed && self.graph.generic_rank(&rows) < rows.len() {
                rows.pop();
                continue;
            }
            let symbol = self.graph.symbol(&self.unused(constraint.name()));
            completion.symbols.push(symbol);
            completion.values.push(constraint.velocity(kinematic));
            completion.constraints.push(*place);
            if !constraint.is_holonomic(kinematic) {
                constraints[*place].define(symbol);
            }
        }
        completion
    }

    /// The error for the first definition that depends on the preceding ones, or contains no velocity at all.
    fn dependent(
        &self,
        rows: &[Vec<Expr<'g>>],
        completion: &Completion<'g>,
        constraints: &[Written<'g>],
    ) -> ModelError {
        let row = (0..rows.len()).find(|&r| self.graph.generic_rank(&rows[..=r]) <= r).unwrap_or(0);
        let at_rest = rows[row].iter().all(|slope| slope.is_zero());
        let fault = |text| {
            if at_rest { MeaningError::NoVelocity { text } } else { MeaningError::DependentDefinitions }
        };
        let document = self.model.document();
        let of_constraint = |row: usize| {
            let place = completion.constraints.get(row)?;
            Some(&document.constraints[constraints[*place].place()].expression)
        };
        let text = match document.quasi_velocities.get(row) {
            Some(quasi_velocity) => quasi_velocity.is.as_ref(),
            None => of_constraint(row - document.quasi_velocities.len()),
        };
        match text {
            Some(text) => self.scope.error(text, text.ast.span, fault),
            None => self.model.document().error(&document.end(), MeaningError::DependentDefinitions),
        }
    }
}
