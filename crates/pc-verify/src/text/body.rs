//! Bodies, as terms.

use pc_model::document::{Expression, Inertia};

use crate::error::Unable;
use crate::text::term::Term;

/// A body or a mass point.
#[derive(Clone, Debug)]
pub(crate) struct Body {
    pub(crate) mass: Term,
    pub(crate) position: Vec<Term>,
    /// The matrix of inertia, row by row.
    pub(crate) inertia: Option<Vec<Term>>,
    pub(crate) turning: Option<Turning>,
    pub(crate) force: Vec<Term>,
    /// μ_i for each component of the force; if it is not 0, the component has the force function μ_i F_i r_i,
    /// which is a term of L.
    pub(crate) force_functions: Vec<f64>,
    /// Whether components of the force may have force functions; on a body with a joint, the components have
    /// none.
    pub(crate) may_have_force_functions: bool,
    pub(crate) torque: Vec<Term>,
}

/// The rotation of a body.
#[derive(Clone, Debug)]
pub(crate) enum Turning {
    /// The matrix from the axes of the body to those of space, row by row.
    Rotation(Vec<Term>),
    /// The components of the angular velocity.
    AngularVelocity(Vec<Term>),
}

/// The 9 entries of a matrix of inertia; [`Inertia::Full`] lists Ixx, Iyy, Izz, Ixy, Iyz, Ixz.
pub(crate) fn matrix(
    inertia: &Inertia,
    term: impl Fn(&Expression) -> Result<Term, Unable>,
) -> Result<Vec<Term>, Unable> {
    let entries: Vec<Term> = match inertia {
        Inertia::Principal(list) => list.iter().map(term).collect::<Result<_, _>>()?,
        Inertia::Full(list) => list.iter().map(term).collect::<Result<_, _>>()?,
    };
    let entry = |row: usize, column: usize| match (row.min(column), row.max(column)) {
        (a, b) if a == b => a,
        (0, 1) => 3,
        (1, 2) => 4,
        _ => 5,
    };
    let value = |i: usize| entries.get(i).cloned().unwrap_or(Term::Number(0.0));
    Ok((0..9).map(|i| entry(i / 3, i % 3)).map(value).collect())
}
