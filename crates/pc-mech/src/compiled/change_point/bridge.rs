//! The motion across a place where constraints lose rank.

use std::ops::Range;

use pc_expr::Failure;

use crate::compiled::change_point::collocation::Collocation;
use crate::compiled::change_point::watch::Seen;
use crate::compiled::elimination::saddle_point::Independence;
use crate::compiled::failure::EvaluationFailure;
use crate::compiled::motion::Motion;
use crate::compiled::point::Point;
use crate::error::{ConstraintError, MechError};

/// The least pivot below which a place where it vanishes is looked for ahead: steps get short there.
const NEAR: f64 = 0.1;

/// So many steps ahead.
const STEPS_AHEAD: f64 = 5.0;

/// The least pivot that is rounding: positions are known to 1e-16, directions to this part of it.
const LOST: f64 = 1e-7;

/// The error of a bridge, as a part of the state: the tolerance of a projection, which rates near the place magnify by
/// the inverse of the least pivot; and the largest that is allowed.
const MAGNIFIED: f64 = 1e-11;
const LARGEST_ERROR: f64 = 1e-8;

/// The error up to which a step across the place is confirmed, and the part of its length that is tried last.
const CONFIRMED: f64 = 1e-3;
const COARSE: f64 = 1e-6;
const SHORTEST: f64 = 1.0 / 256.0;

/// The number of halvings by which the place is found.
const HALVINGS: usize = 30;

/// Writes the rates of a motion at (t, y).
pub(crate) type Rates<'a> = dyn FnMut(&mut Motion, f64, &[f64], &mut [f64]) -> Result<(), Failure> + 'a;

impl Motion {
    /// Watches the rank of the constraints from one end of a step to the other; builds a bridge where it is lost ahead.
    ///
    /// # Errors
    /// [`RankLost`](crate::ConstraintError::RankLost) where the motion is undetermined.
    pub(in crate::compiled) fn watch_rank(
        &mut self,
        from: (f64, &[f64]),
        to: (f64, &[f64]),
        rates: &mut Rates<'_>,
    ) -> Result<(), Failure> {
        if !self.surface.as_ref().is_some_and(|surface| surface.affine) {
            return Ok(());
        }
        if self.watch.bridge(from.0, from.1).is_some_and(|bridge| bridge.end != from.0) {
            return Ok(());
        }
        self.watch.bridge = None;
        let known = self.watch.last.take().filter(|seen| seen.t == from.0 && seen.state == from.1);
        self.compare(from, to, known, rates)
    }

    fn compare(
        &mut self,
        from: (f64, &[f64]),
        to: (f64, &[f64]),
        known: Option<Seen>,
        rates: &mut Rates<'_>,
    ) -> Result<(), Failure> {
        let after = self.independence_after(to);
        let Some(later) = after.map_err(|failure| self.failure(failure, to.0, to.1))? else { return Ok(()) };
        let before = match known {
            Some(seen) => Some(seen),
            None => {
                let start =
                    self.independence_at(from).map_err(|failure| self.failure(failure, from.0, from.1))?;
                start.map(|rank| Seen::new(from, rank))
            }
        };
        let Some(before) = before else { return Ok(()) };
        let reversed = self.is_reversed((&before.rank, from), (&later, to));
        let is_reversed = reversed.map_err(|failure| self.failure(failure, to.0, to.1))?;
        let (was, step) = (before.least, to.0 - from.0);
        let mut now = before.then(to, later);
        if is_reversed && !self.passes(from, to, rates) {
            return Err(self.rank_lost(&now));
        }
        let shrinks = was - now.least;
        let ahead = step * now.least / shrinks;
        if shrinks > 0.0 && now.least <= NEAR && ahead.abs() <= STEPS_AHEAD * step.abs() {
            if 2.0 * ahead.abs() <= now.tried {
                now.tried = ahead.abs();
                self.watch.bridge = self.bridge(to, to.0 + 2.0 * ahead, now.least, rates).map(Box::new);
            }
            if self.watch.bridge.is_none() && now.least <= LOST * now.largest {
                return Err(self.rank_lost(&now));
            }
        }
        self.watch.last = Some(now);
        Ok(())
    }

    #[cold]
    fn rank_lost(&self, at: &Seen) -> Failure {
        let (constraint, unknown) = at.least_determined();
        Failure::fatal(MechError::Constraint(ConstraintError::RankLost {
            constraint: self.constraints[constraint].clone(),
            quasi_velocity: self.quasi_velocities[unknown].clone(),
            t: at.t,
            state: self.names.iter().cloned().zip(at.state.iter().copied()).collect(),
        }))
    }

    /// The smooth motion to `end`, if it satisfies the constraints on the way.
    fn bridge(
        &mut self,
        from: (f64, &[f64]),
        end: f64,
        least: f64,
        rates: &mut Rates<'_>,
    ) -> Option<Collocation> {
        let has_derivatives = self.options.jvp || self.options.parameter_jacobian;
        let breaks = self.signals.breaks().iter().any(|&t| (t - from.0) * (t - end) <= 0.0);
        if has_derivatives || breaks || self.watch.refuses || self.switches.is_some() {
            return None;
        }
        let motion = self.smooth(from, end, (MAGNIFIED / least).min(LARGEST_ERROR), rates)?;
        self.crosses(&motion).then_some(motion)
    }

    /// Whether a step went over the place along the smooth motion.
    fn passes(&mut self, from: (f64, &[f64]), to: (f64, &[f64]), rates: &mut Rates<'_>) -> bool {
        let (mut t, mut y) = (from.0, from.1.to_vec());
        let mut length = to.0 - from.0;
        while t != to.0 {
            let is_last = (to.0 - t).abs() <= length.abs();
            let end = if is_last { to.0 } else { t + length };
            match self.smooth((t, &y), end, COARSE, rates) {
                Some(motion) if !self.crosses(&motion) => return false,
                Some(motion) if is_last => return motion.distance(&motion.state(end), to.1) <= CONFIRMED,
                Some(motion) => (t, y) = (end, motion.state(end)),
                None => length *= 0.5,
            }
            if length.abs() < SHORTEST * (to.0 - from.0).abs() {
                return false;
            }
        }
        true
    }

    /// The smooth motion from a state to a time.
    fn smooth(
        &mut self,
        from: (f64, &[f64]),
        end: f64,
        tolerance: f64,
        rates: &mut Rates<'_>,
    ) -> Option<Collocation> {
        let (n, all) = (self.coordinates, self.names.len());
        let groups: [Range<usize>; 3] = [0..n, n..all - self.states, all - self.states..all];
        let mut flow = |t: f64, y: &mut [f64], written: &mut [f64]| {
            self.project_in_turn(t, y).is_ok() && rates(self, t, y, written).is_ok()
        };
        Collocation::new(&mut flow, from, end, &groups, tolerance)
    }

    /// Whether the constraints hold where they lose rank along a smooth motion, if they do.
    fn crosses(&mut self, motion: &Collocation) -> bool {
        let (mut low, mut high) = (motion.start, motion.end);
        let start = motion.state(low);
        let reversed_at = |field: &mut Motion, t: f64| {
            let state = motion.state(t);
            let there = field.independence_at((t, &state)).ok().flatten();
            let before = field.independence_at((motion.start, &start)).ok().flatten();
            match before.zip(there) {
                Some((before, there)) => field
                    .is_reversed((&before, (motion.start, &start)), (&there, (t, &state)))
                    .unwrap_or(true),
                None => true,
            }
        };
        let place = if reversed_at(self, high) {
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if reversed_at(self, middle) { high = middle } else { low = middle }
            }
            high
        } else {
            0.5 * (low + high)
        };
        let state = motion.state(place);
        let Motion { surface: Some(surface), parameters: p, .. } = self else { return false };
        let (at, before) = (Point { t: place, y: &state, p }, Point { t: motion.start, y: &start, p });
        surface.crosses(at, before).unwrap_or(false)
    }

    fn independence_after(
        &mut self,
        (t, y): (f64, &[f64]),
    ) -> Result<Option<Independence>, EvaluationFailure> {
        let Motion { surface, parameters, .. } = self;
        surface.as_mut().map_or(Ok(None), |surface| surface.independence(t, y, parameters))
    }

    fn independence_at(&mut self, (t, y): (f64, &[f64])) -> Result<Option<Independence>, EvaluationFailure> {
        let Motion { surface, parameters, .. } = self;
        surface.as_mut().map_or(Ok(None), |surface| surface.independence_at(t, y, parameters))
    }

    fn is_reversed(
        &mut self,
        (before, from): (&Independence, (f64, &[f64])),
        (later, to): (&Independence, (f64, &[f64])),
    ) -> Result<bool, EvaluationFailure> {
        let Motion { surface, parameters: p, .. } = self;
        let Some(surface) = surface else { return Ok(false) };
        let (from, to) = (Point { t: from.0, y: from.1, p }, Point { t: to.0, y: to.1, p });
        surface.is_reversed((before, from), (later, to))
    }
}
