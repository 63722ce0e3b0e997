//! Quantities that both derivations have.

use crate::text::resultant::Resultant;

/// A quantity that both derivations have.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Quantity {
    /// ẋ_i
    Velocity(usize),
    /// ẍ_i
    Acceleration(usize),
    /// ż_j
    StateRate(usize),
    /// The η_s of a column: a quasi-velocity, or ẋ_s where none is declared.
    Column(usize),
    /// The η̇_s of a column.
    ColumnRate(usize),
    /// The left-hand side of a constraint, or its rate; both are 0.
    Zero,
    /// λ_α of the constraint with this number.
    Reaction(usize),
    /// A reaction on a body.
    Resultant(Resultant),
    /// The energy y·η − L of all velocities.
    Energy,
    /// The momentum y_f of a free quasi-velocity, given its index among the free ones.
    Momentum(usize),
    MomentumRate(usize),
    /// The energy y_f η_f − L of the free quasi-velocities, and its rate.
    FreeEnergy,
    FreeEnergyRate,
    /// The integral or output that has this index in the text.
    Observed(usize),
}

/// A quasi-velocity that is free, or whose momentum is a component of the state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Free {
    /// The quasi-velocity in the column with this index.
    Column(usize),
    /// The left-hand side of a constraint.
    Constraint(usize),
    /// ẋ_i
    Velocity(usize),
}
