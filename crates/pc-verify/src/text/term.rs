//! Expressions with their names resolved.

use crate::text::resultant::Resultant;

/// A quantity of one body; vectors are along fixed axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum OfBody {
    Mass,
    /// A component of its position.
    Place(usize),
    /// A component of the angular momentum about its position.
    Spin(usize),
    Kinetic,
    Potential,
}

/// An expression with names replaced by indices.
#[derive(Clone, Debug)]
pub(crate) enum Term {
    Number(f64),
    Time,
    Coordinate(usize),
    /// ẋ_i
    Velocity(usize),
    /// η_s
    QuasiVelocity(usize),
    Parameter(usize),
    /// z_j, a first-order state.
    State(usize),
    Definition(usize),
    /// λ_α
    Reaction(usize),
    /// A component of a reaction on a body.
    Resultant(Resultant),
    /// A quantity of the body with this number.
    OfBody(usize, OfBody),
    /// The total time derivative of a term.
    Rate(Box<Term>),
    /// The terms of a sum; those marked `true` are subtracted.
    Sum(Vec<(bool, Term)>),
    /// The factors of a product; those marked `true` are divisors.
    Product(Vec<(bool, Term)>),
    Negative(Box<Term>),
    Power(Box<Term>, Box<Term>),
    Call(Function, Vec<Term>),
}

/// The functions of expressions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Function {
    Sin,
    Cos,
    Tan,
    Cot,
    Asin,
    Acos,
    Atan,
    Atan2,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Log,
    Sqrt,
    Abs,
    Sign,
    Min,
    Max,
    Step,
    /// An undetermined function, by its place among the functions of the text.
    Undetermined(usize),
}

impl Term {
    /// The number of terms it contains, including itself.
    pub(crate) fn size(&self) -> usize {
        1 + match self {
            Term::Sum(parts) | Term::Product(parts) => parts.iter().map(|(_, part)| part.size()).sum(),
            Term::Negative(inner) | Term::Rate(inner) => inner.size(),
            Term::Power(base, exponent) => base.size() + exponent.size(),
            Term::Call(_, arguments) => arguments.iter().map(Term::size).sum(),
            _ => 0,
        }
    }

    /// Whether it contains a reaction on a body.
    pub(crate) fn has_resultants(&self) -> bool {
        match self {
            Term::Resultant(_) => true,
            Term::Sum(parts) | Term::Product(parts) => parts.iter().any(|(_, part)| part.has_resultants()),
            Term::Negative(inner) | Term::Rate(inner) => inner.has_resultants(),
            Term::Power(base, exponent) => base.has_resultants() || exponent.has_resultants(),
            Term::Call(_, arguments) => arguments.iter().any(Term::has_resultants),
            _ => false,
        }
    }

    /// Whether it contains velocities; `definitions` says the same of the definitions before it, and `None`
    /// is returned if it uses a later definition.
    pub(crate) fn has_velocities(&self, definitions: &[bool]) -> Option<bool> {
        let any = |terms: &mut dyn Iterator<Item = &Term>| -> Option<bool> {
            let has: Option<Vec<bool>> = terms.map(|term| term.has_velocities(definitions)).collect();
            Some(has?.contains(&true))
        };
        match self {
            Term::Velocity(_) | Term::QuasiVelocity(_) | Term::Rate(_) | Term::OfBody(..) => Some(true),
            Term::Number(_)
            | Term::Time
            | Term::Coordinate(_)
            | Term::Parameter(_)
            | Term::State(_)
            | Term::Reaction(_)
            | Term::Resultant(_) => Some(false),
            Term::Definition(j) => definitions.get(*j).copied(),
            Term::Sum(parts) | Term::Product(parts) => any(&mut parts.iter().map(|(_, part)| part)),
            Term::Negative(inner) => inner.has_velocities(definitions),
            Term::Power(base, exponent) => any(&mut [&**base, &**exponent].into_iter()),
            Term::Call(_, arguments) => any(&mut arguments.iter()),
        }
    }
}
