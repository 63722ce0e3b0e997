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
    /// η_s of the columns: quasi-velocities, or ẋ where none is declared.
    Column(usize),
    /// η̇_s of the columns.
    ColumnRate(usize),
    /// The left side of constraint number α, or its rate: 0.
    Zero,
    /// λ_α by the number of the constraint.
    Reaction(usize),
    /// A reaction on a body.
    Resultant(Resultant),
    /// y·η − L of all velocities.
    Energy,
    /// y_f of the free quasi-velocities, by their indices among these.
    Momentum(usize),
    MomentumRate(usize),
    /// y_f η_f − L of the free quasi-velocities, and its rate.
    FreeEnergy,
    FreeEnergyRate,
    /// An integral or output, by its index in the text.
    Observed(usize),
}

/// A quasi-velocity that is free, or whose momentum is part of the state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Free {
    /// The quasi-velocity of a column.
    Column(usize),
    /// The left side of a constraint.
    Constraint(usize),
    /// ẋ_i
    Velocity(usize),
}
