//! The numbers of a model of bodies on joints: expressions in parameters with the values of these.

use pc_mech::{Expr, Graph};

use crate::diagnostics::error::ModelError;
use crate::document::{Document, Expression, Inertia, Joint, JointRotation};
use crate::import::pose::{Pose, Rotation, about, product};
use crate::model::model::Model;
use crate::names::scope::Scope;
use crate::names::stage::Stage;

/// The expressions of a model and the values of its parameters.
pub(super) struct Constants<'g, 'd> {
    graph: &'g Graph,
    pub(super) document: &'d Document,
    scope: Scope<'g, 'd>,
    parameters: Vec<(Expr<'g>, f64)>,
}

impl<'g, 'd> Constants<'g, 'd> {
    pub(super) fn of(graph: &'g Graph, model: &'d Model) -> Constants<'g, 'd> {
        let scope = Scope::new(graph, model.document());
        let parameters = model.parameters().map(|(name, value)| (graph.symbol(name), value)).collect();
        Constants { graph, document: model.document(), scope, parameters }
    }

    /// The value of a constant.
    pub(super) fn number(&mut self, expression: &Expression) -> Result<f64, ModelError> {
        Ok(self.numbers(std::slice::from_ref(expression))?[0])
    }

    /// The values of constants.
    pub(super) fn numbers(&mut self, expressions: &[Expression]) -> Result<Vec<f64>, ModelError> {
        let values: Result<Vec<Expr<'g>>, ModelError> =
            expressions.iter().map(|expression| self.scope.resolve(expression, Stage::Joint)).collect();
        // Constants contain parameters only, all of which have values.
        Ok(self
            .graph
            .evaluate(&values?, &self.parameters)
            .unwrap_or_else(|_| vec![f64::NAN; expressions.len()]))
    }

    /// Three constants; zeros if they are left out.
    pub(super) fn vector(&mut self, expressions: Option<&[Expression; 3]>) -> Result<[f64; 3], ModelError> {
        match expressions {
            None => Ok([0.0; 3]),
            Some(expressions) => {
                let numbers = self.numbers(expressions)?;
                Ok([numbers[0], numbers[1], numbers[2]])
            }
        }
    }

    /// The pose of a joint in the body that carries it.
    pub(super) fn pose(&mut self, joint: &Joint) -> Result<Pose, ModelError> {
        let xyz = self.vector(joint.at.as_ref())?;
        let rotation: Rotation = match &joint.rotation {
            None => return Ok(Pose::at(xyz)),
            Some(JointRotation::Matrix(entries)) => {
                let entries = self.numbers(entries.as_slice())?;
                std::array::from_fn(|i| std::array::from_fn(|j| entries[3 * i + j]))
            }
            Some(JointRotation::Turns(turns)) => {
                let mut all = about(0, 0.0);
                for (axis, angle) in turns {
                    all = product(&all, &about(*axis, self.number(angle)?));
                }
                all
            }
        };
        Ok(Pose::new(xyz, &rotation))
    }

    /// Ixx, Iyy, Izz, Ixy, Iyz, Ixz.
    pub(super) fn inertia(&mut self, inertia: Option<&Inertia>) -> Result<[f64; 6], ModelError> {
        Ok(match inertia {
            None => [0.0; 6],
            Some(Inertia::Principal(moments)) => {
                let [xx, yy, zz] = self.vector(Some(&**moments))?;
                [xx, yy, zz, 0.0, 0.0, 0.0]
            }
            Some(Inertia::Full(entries)) => {
                let entries = self.numbers(entries.as_slice())?;
                std::array::from_fn(|place| entries[place])
            }
        })
    }

    /// The acceleration of gravity, if it is constant.
    pub(super) fn gravity(&mut self, acceleration: &[Expression; 3]) -> Result<Option<[f64; 3]>, ModelError> {
        let values: Result<Vec<Expr<'g>>, ModelError> =
            acceleration.iter().map(|part| self.scope.resolve(part, Stage::Gravity)).collect();
        let numbers = self.graph.evaluate(&values?, &self.parameters).ok();
        Ok(numbers.map(|numbers| [numbers[0], numbers[1], numbers[2]]))
    }

    /// d where a force is −d η for the velocity η; none if the force is anything else. The force is compared
    /// with its formula at several values of all coordinates and velocities.
    pub(super) fn damping(&mut self, force: &Expression, velocity: &str) -> Result<Option<f64>, ModelError> {
        let value = self.scope.resolve(force, Stage::Dynamics)?;
        let mut names: Vec<String> = Vec::new();
        for coordinate in &self.document.coordinates {
            names.extend([coordinate.name.text.clone(), format!("{}'", coordinate.name.text)]);
        }
        for velocity in &self.document.quasi_velocities {
            if !names.contains(&velocity.name.text) {
                names.push(velocity.name.text.clone());
            }
        }
        let symbols: Vec<Expr<'g>> = names.iter().map(|name| self.graph.symbol(name)).collect();
        let mut found: Option<f64> = None;
        for trial in 1..=4 {
            let at = |place: usize| (1.3 * trial as f64 + 0.7 * place as f64).sin();
            let mut values = self.parameters.clone();
            values.extend(symbols.iter().enumerate().map(|(place, symbol)| (*symbol, at(place))));
            let Some(own) = names.iter().position(|name| name == velocity) else { return Ok(None) };
            let Ok(force) = self.graph.evaluate(&[value], &values) else { return Ok(None) };
            let damping = -force[0] / at(own);
            if !damping.is_finite() || found.is_some_and(|found| (found - damping).abs() > 1e-9 * found.abs())
            {
                return Ok(None);
            }
            found = found.or(Some(damping));
        }
        Ok(found)
    }
}
