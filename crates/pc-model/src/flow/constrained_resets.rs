//! The state after the reset of an event under constraints.

use pc_expr::{Failure, VectorField};
use pc_mech::{Motion, Multipliers};
use serde::{Deserialize, Serialize};

/// Constraints may change a value that a reset has set by at most this, absolute or relative, whichever is
/// larger; a greater change is more than rounding error.
const OFF: f64 = 1e-8;
/// The factor by which a reset may increase the distance of a state from the constraints.
const LENGTHENED: f64 = 10.0;

/// Moves states onto the constraints after resets.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct ConstrainedResets {
    /// The motion under constraints, in all quasi-velocities.
    motion: Motion,
    /// The quasi-velocities that determine the others and keep their values.
    determining: Vec<usize>,
    /// The number of velocities that the constraints leave free.
    free: usize,
}

/// The error for a reset to a state that constraints forbid.
#[derive(Debug, thiserror::Error)]
#[error("its reset leaves the constraints: {component} would have to be {allowed}, not {given}")]
struct OffConstraints {
    component: String,
    given: f64,
    allowed: f64,
}

impl ConstrainedResets {
    /// The resets of `motion` under these constraints; the first `declared` quasi-velocities are those of the text.
    pub(super) fn new(motion: &Motion, multipliers: &Multipliers<'_>, declared: usize) -> ConstrainedResets {
        let all = multipliers.coefficients().columns();
        let free = all - multipliers.constraints().len();
        // The declared ones, if others complete them to a frame and follow from them.
        let determining =
            if declared == free && declared < all { (0..declared).collect() } else { Vec::new() };
        ConstrainedResets { motion: motion.clone().without_kept(), determining, free }
    }

    pub(super) fn set_parameters(&mut self, parameters: &[f64]) {
        self.motion.parameters_mut()[..parameters.len()].copy_from_slice(parameters);
    }

    /// Moves a state (x, η, z) onto the constraints after a reset has set the components `places`; `before` is the
    /// state before the reset.
    ///
    /// Velocities that were set stay as they are, and the others are adjusted. If more velocities are set than
    /// the constraints leave free, all velocities move to the nearest allowed values. Coordinates keep their
    /// values: the state is at the event, and rounding errors must not move it back.
    ///
    /// # Errors
    /// A [`Failure`] if a coordinate, or a velocity that should stay, would have to change, or if no state on
    /// the constraints is found.
    pub(super) fn settle(
        &mut self,
        t: f64,
        before: &[f64],
        places: &[usize],
        state: &mut [f64],
    ) -> Result<(), Failure> {
        let given = state.to_vec();
        let (n, k) = (self.motion.coordinates(), state.len() - self.motion.states());
        let mut keeping: Vec<usize> = Vec::new();
        if places.iter().any(|&place| place < n) {
            let mut nearest = given.clone();
            self.motion.project(t, &mut nearest)?;
            state[..n].copy_from_slice(&nearest[..n]);
            keeping.extend(0..n);
        }
        let is_velocity = |place: &usize| (n..k).contains(place);
        let set = places.iter().copied().filter(is_velocity).map(|place| place - n);
        let mut held: Vec<usize> = set.chain(self.determining.iter().copied()).collect();
        held.sort_unstable();
        held.dedup();
        if held.len() <= self.free {
            self.motion.project_velocities_holding(t, state, &held)?;
            keeping.extend(held.iter().map(|s| n + s));
        }
        self.motion.project_velocities(t, state)?;
        self.check(t, before, &given, state, &keeping)
    }

    /// Checks that the components `keeping` were moved by no more than rounding error. A state that is already at
    /// some distance from the constraints, such as one displaced to compute derivatives, keeps that distance.
    fn check(
        &mut self,
        t: f64,
        before: &[f64],
        given: &[f64],
        allowed: &[f64],
        keeping: &[usize],
    ) -> Result<(), Failure> {
        let moved =
            |i: usize, bound: f64| (given[i] - allowed[i]).abs() > OFF * given[i].abs().max(1.0) + bound;
        if !keeping.iter().any(|&i| moved(i, 0.0)) {
            return Ok(());
        }
        let mut nearest = before.to_vec();
        self.motion.project(t, &mut nearest)?;
        let off =
            before.iter().zip(&nearest).map(|(before, nearest)| (before - nearest).abs()).fold(0.0, f64::max);
        match keeping.iter().find(|&&i| moved(i, LENGTHENED * off)) {
            None => Ok(()),
            Some(&i) => {
                let component = self.motion.component_name(i);
                Err(Failure::fatal(OffConstraints { component, given: given[i], allowed: allowed[i] }))
            }
        }
    }
}
