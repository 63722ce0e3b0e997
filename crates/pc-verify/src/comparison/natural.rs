//! The sizes that quantities would have without cancellation.

use crate::derivation::equations::Derived;
use crate::derivation::place::Direction;
use crate::derivation::quantity::Quantity;

/// The factor that reduces a tolerance of 1e-12 of the size of the terms to some units in the last place of
/// the largest term.
pub(crate) const SHARED: f64 = 1e-3;

/// The direction of the motion: time, ẋ, ẇ and ż.
pub(crate) fn motion(derived: &Derived) -> Direction {
    let w = derived.accelerations.clone();
    Direction { w, z: derived.state_rates.clone(), ..derived.place.in_time(&derived.velocities) }
}

/// The size that a quantity would have at the given velocities and momenta without cancellation: a quantity
/// that vanishes by cancellation, such as a force that reactions balance to the last digit, is accurate only
/// to within rounding errors of this size. If η = a ẋ + a_0, the first derivation computes ẋ as b η minus the
/// `drift` b a_0, and momenta likewise, however much of them cancels.
pub(crate) fn natural_size(derived: &Derived, drift: &[f64], quantity: &Quantity) -> f64 {
    let largest =
        |lists: &[&[f64]]| lists.iter().copied().flatten().fold(0.0f64, |size, x| size.max(x.abs()));
    let moving = largest(&[&derived.place.w, &derived.velocities]);
    let velocity = moving.max(largest(&[drift]));
    let momentum = largest(&[&derived.momenta, &derived.momentum_sizes]);
    // At rest the drift is what velocities leave when they cancel.
    let momentum = if moving > 0.0 {
        momentum * (velocity / moving)
    } else {
        momentum.max(derived.mass_size * velocity)
    };
    match quantity {
        Quantity::Velocity(_) | Quantity::Column(_) | Quantity::Zero => velocity,
        Quantity::ColumnRate(_) | Quantity::Acceleration(_) => {
            (velocity * velocity).max(largest(&[&derived.accelerations, &derived.unconstrained_sizes]))
        }
        Quantity::Momentum(_) => momentum,
        Quantity::MomentumRate(_)
        | Quantity::Reaction(_)
        | Quantity::Energy
        | Quantity::FreeEnergy
        | Quantity::FreeEnergyRate => {
            (momentum * velocity).max(largest(&[&derived.momentum_rates, &derived.force_sizes]))
        }
        Quantity::StateRate(_) | Quantity::Observed(_) | Quantity::Resultant(_) => 0.0,
    }
}
