//! The error of this crate, with its predicates.

use pc_algebra::AlgebraError;
use pc_expr::{ExprError, Failure};

use crate::error::body::BodyError;
use crate::error::constraint::ConstraintError;
use crate::error::evaluation::EvaluationError;
use crate::error::force::ForceError;
use crate::error::frame::FrameError;
use crate::error::integral::IntegralError;
use crate::error::lagrangian::LagrangianError;
use crate::error::matrix::MatrixError;
use crate::error::shape::ShapeError;
use crate::error::tree::TreeError;

/// An error of this crate, by topic.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MechError {
    /// A part of the system with the wrong number of entries.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// An error of the frame.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// An error of the Lagrangian.
    #[error(transparent)]
    Lagrangian(#[from] LagrangianError),
    /// An error of a body.
    #[error(transparent)]
    Body(#[from] BodyError),
    /// An error of a tree of bodies.
    #[error(transparent)]
    Tree(#[from] TreeError),
    /// An error of the forces.
    #[error(transparent)]
    Force(#[from] ForceError),
    /// An error of the constraints.
    #[error(transparent)]
    Constraint(#[from] ConstraintError),
    /// An error of the integrals that are to be kept.
    #[error(transparent)]
    Integral(#[from] IntegralError),
    /// An error of a matrix.
    #[error(transparent)]
    Matrix(#[from] MatrixError),
    /// An error in the evaluation of a motion.
    #[error(transparent)]
    Evaluation(#[from] EvaluationError),
    /// An error of the algebra.
    #[error(transparent)]
    Algebra(#[from] AlgebraError),
    /// An error of the expressions.
    #[error(transparent)]
    Expr(#[from] ExprError),
}

impl MechError {
    /// Whether a closed H(t, x, y) was requested where [there is none](LagrangianError::NotQuadratic).
    pub fn is_not_quadratic(&self) -> bool {
        matches!(self, MechError::Lagrangian(LagrangianError::NotQuadratic { .. }))
    }

    /// Whether Lagrange's equations were requested in coordinates that are not independent: their number
    /// differs from that of the quasi-velocities, or the quasi-velocities do not determine the velocities of
    /// the coordinates.
    pub fn is_of_dependent_coordinates(&self) -> bool {
        matches!(
            self,
            MechError::Lagrangian(LagrangianError::RedundantCoordinates { .. })
                | MechError::Algebra(AlgebraError::DependentOperators { .. })
        )
    }

    /// The constraint that [depends on the others at a state](ConstraintError::Singular).
    pub fn singular_constraint(&self) -> Option<&str> {
        match self {
            MechError::Constraint(ConstraintError::Singular { constraint, .. }) => Some(constraint),
            _ => None,
        }
    }

    /// The error of the expressions, including one that the algebra reports.
    pub fn of_expressions(&self) -> Option<&ExprError> {
        match self {
            MechError::Expr(error) | MechError::Algebra(AlgebraError::Expr(error)) => Some(error),
            _ => None,
        }
    }
}

impl From<Failure> for MechError {
    /// The error that a [`Motion`](crate::Motion) reported; for other vector fields, an error
    /// with their message.
    fn from(failure: Failure) -> MechError {
        let own = failure.cause().downcast_ref::<MechError>();
        own.cloned().unwrap_or_else(|| EvaluationError::NotEvaluated { cause: failure.to_string() }.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_expressions_are_found_in_those_of_the_algebra() {
        let error = ExprError::UnboundSymbol { symbol: "q".to_owned() };
        for told in [MechError::from(error.clone()), MechError::from(AlgebraError::from(error.clone()))] {
            assert_eq!(told.of_expressions(), Some(&error));
            assert_eq!(told.to_string(), error.to_string());
        }
        assert_eq!(MechError::from(LagrangianError::Missing).of_expressions(), None);
    }

    #[test]
    fn failures_keep_their_error_or_their_message() {
        let own = MechError::from(ForceError::NoneDeclared);
        assert_eq!(MechError::from(Failure::fatal(own.clone())), own);
        let other = MechError::from(Failure::fatal(std::fmt::Error));
        assert_eq!(other.to_string(), std::fmt::Error.to_string());
        assert!(matches!(other, MechError::Evaluation(EvaluationError::NotEvaluated { .. })));
    }
}
