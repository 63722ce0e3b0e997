//! The frame of a model, and errors in it.

use pc_mech::{AlgebraError, Expr, Frame};

use super::Assembler;
use super::constraints::Written;
use crate::document::{Expression, NamedExpression};
use crate::error::ModelError;
use crate::fault::Fault;
use crate::scope::{Stage, entry};

impl<'g> Assembler<'g, '_> {
    /// The frame in one of its four ways: kinematics, definitions, neither (Lagrange), or no coordinates at all.
    pub(super) fn frame(&mut self, constraints: &[Written<'g>]) -> Result<Frame<'g>, ModelError> {
        let document = self.model.document();
        let (time, x) = (self.graph.symbol("t"), self.scope.coordinates());
        if let Some(stray) =
            document.kinematics.iter().find(|k| entry(&document.coordinates, &k.name.text).is_none())
        {
            return Err(self.not_a_coordinate(&stray.name));
        }
        let defined = document.quasi_velocities.iter().find(|q| q.is.is_some());
        match (defined, document.kinematics.first()) {
            (Some(defined), Some(_)) => Err(self
                .model
                .error(&defined.name.place, Fault::TwoKinematics { name: defined.name.text.clone() })),
            (Some(_), None) => self.frame_of_definitions(time, x, constraints),
            (None, Some(_)) => self.frame_of_kinematics(time, x),
            (None, None) if self.is_lagrangian_form() => Ok(Frame::coordinate(self.graph, time, x)),
            (None, None) if x.is_empty() => {
                let k = document.quasi_velocities.len();
                let b = pc_mech::Matrix::from_fn(0, k, |_, _| Expr::ZERO);
                Frame::new(self.graph, time, x, b, Vec::new()).map_err(|e| self.model.algebra_error(e))
            }
            (None, None) => {
                let name = &document.quasi_velocities[0].name;
                Err(self.model.error(&name.place, Fault::Undefined { name: name.text.clone() }))
            }
        }
    }

    fn frame_of_kinematics(&mut self, time: Expr<'g>, x: Vec<Expr<'g>>) -> Result<Frame<'g>, ModelError> {
        let document = self.model.document();
        let mut velocities = Vec::new();
        for coordinate in &document.coordinates {
            let Some(kinematics) = entry(&document.kinematics, &coordinate.name.text) else {
                let coordinate = coordinate.name.text.clone();
                return Err(self
                    .model
                    .error(&document.kinematics[0].name.place, Fault::KinematicsMissing { coordinate }));
            };
            velocities.push(self.scope.resolve(&kinematics.expression, Stage::Kinematics)?);
        }
        let eta = self.scope.quasi_velocities();
        Frame::from_velocities(self.graph, time, x, &eta, &velocities).map_err(|error| match error {
            AlgebraError::NotAffine { coordinate, .. } => match entry(&document.kinematics, &coordinate) {
                Some(NamedExpression { expression, .. }) => {
                    let fault = |text| Fault::NotAffine { text, variables: "quasi-velocities" };
                    self.scope.error(expression, expression.ast.span, fault)
                }
                None => {
                    self.model.algebra_error(AlgebraError::NotAffine { coordinate, velocity: String::new() })
                }
            },
            other => self.model.algebra_error(other),
        })
    }

    fn frame_of_definitions(
        &mut self,
        time: Expr<'g>,
        x: Vec<Expr<'g>>,
        constraints: &[Written<'g>],
    ) -> Result<Frame<'g>, ModelError> {
        let document = self.model.document();
        let mut definitions = Vec::new();
        for quasi_velocity in &document.quasi_velocities {
            let Some(is) = &quasi_velocity.is else {
                let name = quasi_velocity.name.text.clone();
                return Err(self.model.error(&quasi_velocity.name.place, Fault::Undefined { name }));
            };
            definitions.push(self.scope.resolve(is, Stage::Definition)?);
        }
        definitions.extend(constraints.iter().filter(|c| c.defines().is_some()).map(Written::value));
        let place = &document.quasi_velocities[0].name.place;
        if definitions.len() != x.len() {
            let (definitions, coordinates) = (definitions.len(), x.len());
            return Err(self.model.error(place, Fault::DefinitionCount { definitions, coordinates }));
        }
        let velocities = self.scope.velocities();
        Frame::from_definitions(self.graph, time, x, &velocities, &definitions).map_err(|error| match error {
            AlgebraError::DefinitionNotAffine { row, .. } => match self.definition(row - 1, constraints) {
                Some((is, None)) => {
                    let fault = |text| Fault::NotAffine { text, variables: "velocities" };
                    self.scope.error(is, is.ast.span, fault)
                }
                Some((is, Some(constraint))) => {
                    let fault = |text| Fault::ConstraintNotAffine { constraint: constraint.to_owned(), text };
                    self.scope.error(is, is.ast.span, fault)
                }
                None => self.model.error(place, Fault::DependentDefinitions),
            },
            AlgebraError::SingularDefinitions => self.dependent(&definitions, constraints),
            other => self.model.algebra_error(other),
        })
    }

    /// The first definition that adds nothing to those before it: it may contain no velocity.
    fn dependent(&self, definitions: &[Expr<'g>], constraints: &[Written<'g>]) -> ModelError {
        let velocities = self.scope.velocities();
        let slopes = |&definition: &Expr<'g>| self.graph.gradient(definition, &velocities);
        let rows: Vec<Vec<Expr<'g>>> = definitions.iter().map(slopes).collect();
        let row = (0..rows.len()).find(|&r| self.graph.generic_rank(&rows[..=r]) <= r).unwrap_or(0);
        let at_rest = rows[row].iter().all(|slope| slope.is_zero());
        let fault = |text| if at_rest { Fault::NoVelocity { text } } else { Fault::DependentDefinitions };
        match self.definition(row, constraints) {
            Some((is, _)) => self.scope.error(is, is.ast.span, fault),
            None => self.model.error(&self.model.document().end(), Fault::DependentDefinitions),
        }
    }

    /// The text of a definition: of a quasi-velocity, or after these of a constraint that defines one, with its name.
    fn definition(&self, row: usize, constraints: &[Written<'g>]) -> Option<(&Expression, Option<&str>)> {
        let document = self.model.document();
        let defined = document.quasi_velocities.len();
        match document.quasi_velocities.get(row) {
            Some(quasi_velocity) => quasi_velocity.is.as_ref().map(|is| (is, None)),
            None => {
                let defining = constraints.iter().filter(|c| c.defines().is_some()).nth(row - defined)?;
                let constraint = &document.constraints[defining.place()];
                Some((&constraint.expression, Some(constraint.name.text.as_str())))
            }
        }
    }
}
