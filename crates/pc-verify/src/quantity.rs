//! What both derivations have.

use crate::resultant::Resultant;

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
    /// What constraint number α fixes at 0, or its rate.
    Zero,
    /// λ_α by the number of the constraint.
    Reaction(usize),
    /// What a reaction is on a body.
    Resultant(Resultant),
    /// y·η − L of all velocities.
    Energy,
    /// y_f of the free quasi-velocities, by their place among these.
    Momentum(usize),
    MomentumRate(usize),
    /// y_f η_f − L of the free quasi-velocities, and its rate.
    FreeEnergy,
    FreeEnergyRate,
    /// An integral or output, by its place in the text.
    Observed(usize),
}

/// A quasi-velocity that is free, or whose momentum is one of the state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Free {
    /// That of a column.
    Column(usize),
    /// What a constraint fixes at 0.
    Constraint(usize),
    /// ẋ_i
    Velocity(usize),
}
