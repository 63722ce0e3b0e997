//! Bodies on joints: their expressions are resolved, and errors are located in the file.

use pc_mech::{Expr, Tree};

use crate::assembly::assembler::Assembler;
use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::document::{Expression, JointRotation};
use crate::names::points::hung;

/// The greatest allowed deviation of a matrix of constants from a rotation, and of the length of a quaternion
/// from 1: the rounding error of numbers written with nine digits.
const OFF: f64 = 1e-8;

impl<'g> Assembler<'g, '_> {
    /// The bodies on joints; `x_dot` pairs each symbol x' with its value b η + b_0. `None` if there are no
    /// such bodies.
    pub(super) fn tree(&mut self, x_dot: &[(Expr<'g>, Expr<'g>)]) -> Result<Option<Tree<'g>>, ModelError> {
        let document = self.model.document();
        if document.tree.is_empty() {
            return Ok(None);
        }
        let mut bodies = Vec::with_capacity(document.tree.len());
        for body in &document.tree {
            let mut made = self.scope.massive(body)?;
            if let Some(force) = &body.force {
                made = made.force(self.all_dynamic(force, x_dot)?);
            }
            if let Some(torque) = &body.torque {
                made = made.torque(self.all_dynamic(torque, x_dot)?);
            }
            bodies.push(made);
        }
        let tree = Tree::new(self.graph, bodies).map_err(|error| document.derivation_error(error))?;
        Ok(Some(tree))
    }

    /// The velocities ẋ of the coordinates of joints, in terms of η; these coordinates come first.
    pub(super) fn joint_velocities(&mut self) -> Result<Vec<Expr<'g>>, ModelError> {
        let document = self.model.document();
        let mut bodies = Vec::with_capacity(document.tree.len());
        for body in &document.tree {
            bodies.push(hung(body, self.scope.joint(&body.joint)?));
        }
        let tree = Tree::new(self.graph, bodies).map_err(|error| document.derivation_error(error))?;
        Ok(tree.velocities())
    }

    /// Checks that the matrices given as rotations of joints are rotations for these values of the
    /// parameters.
    pub(super) fn check_rotations(&mut self, parameters: &[(Expr<'g>, f64)]) -> Result<(), ModelError> {
        for body in &self.model.document().tree {
            if let Some(JointRotation::Matrix(entries)) = &body.joint.rotation {
                let values = self.scope.constants(entries)?;
                let r = self.graph.evaluate(&values, parameters).unwrap_or_default();
                self.check_rotation(entries, &r)?;
            }
        }
        Ok(())
    }

    fn check_rotation(&self, entries: &[Expression; 9], r: &[f64]) -> Result<(), ModelError> {
        let entry = |i: usize, j: usize| {
            let product: f64 = (0..3).map(|l| r[3 * i + l] * r[3 * j + l]).sum();
            (product - f64::from(u8::from(i == j))).abs()
        };
        // NaN exceeds every bound.
        let defect = (0..9).map(|ij| entry(ij / 3, ij % 3)).fold(0.0, |a: f64, b| if b <= a { a } else { b });
        let minor = |i: usize, j: usize| r[3 + i] * r[6 + j] - r[3 + j] * r[6 + i];
        let determinant = r[0] * minor(1, 2) - r[1] * minor(0, 2) + r[2] * minor(0, 1);
        if defect <= OFF && determinant > 0.0 {
            return Ok(());
        }
        let (first, last) = (entries[0].whole(), entries[8].whole());
        let place = crate::diagnostics::source::Place { span: first.span.start..last.span.end, ..first };
        Err(self.model.document().error(&place, MeaningError::NotARotation { defect, determinant }))
    }

    /// Scales quaternions to length 1 at the start, if their length differs from 1 only because the written
    /// numbers are rounded; `start` begins with the values of the coordinates.
    pub(super) fn normalise_quaternions(&self, start: &mut [f64]) -> Result<(), ModelError> {
        let document = self.model.document();
        let mut first = 0;
        for body in &document.tree {
            let own = &mut start[first..first + body.joint.coordinates.len()];
            if let Some(scalar) = body.joint.kind.quaternion() {
                let length = own[scalar..].iter().fold(0.0, |length: f64, q| length.hypot(*q));
                if (length - 1.0).abs() > OFF {
                    let place = document.coordinates[first + scalar].expression.whole();
                    let fault = MeaningError::QuaternionNotUnit { body: body.name.text.clone(), length };
                    return Err(document.error(&place, fault));
                }
                own[scalar..].iter_mut().for_each(|q| *q /= length);
            }
            first += body.joint.coordinates.len();
        }
        Ok(())
    }
}
