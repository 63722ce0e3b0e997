//! The motion across a state at which constraints lose rank.

use std::ops::Range;

use pc_expr::Failure;

use crate::compiled::change_point::collocation::Collocation;
use crate::compiled::change_point::watch::Seen;
use crate::compiled::elimination::saddle_point::Independence;
use crate::compiled::failure::EvaluationFailure;
use crate::compiled::motion::Motion;
use crate::compiled::point::Point;
use crate::error::{ConstraintError, MechError};

/// If the least pivot is below this, the motion ahead is searched for a state where the pivot vanishes, since
/// steps get short there.
const NEAR: f64 = 0.1;

/// The number of steps ahead that are searched for such a state.
const STEPS_AHEAD: f64 = 5.0;

/// A least pivot below this is treated as rounding error: positions are known to 1e-16, directions only to this
/// fraction.
const LOST: f64 = 1e-7;

/// The error of a bridge, as a fraction of the state: the tolerance of a projection, which rates near the loss
/// of rank magnify by the inverse of the least pivot; and the largest error allowed.
const MAGNIFIED: f64 = 1e-11;
const LARGEST_ERROR: f64 = 1e-8;

/// The error up to which a step across the loss of rank is confirmed, the tolerance of the smooth motion
/// compared with it, and the smallest fraction of the step's length that is tried.
const CONFIRMED: f64 = 1e-3;
const COARSE: f64 = 1e-6;
const SHORTEST: f64 = 1.0 / 256.0;

/// The number of parts into which a smooth motion is divided; constraints are assumed to turn by less than a
/// right angle in each part.
const PARTS: usize = 16;

/// The number of halvings by which the loss of rank is located.
const HALVINGS: usize = 30;

/// What happens to the rank of the constraints along a smooth motion.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Rank {
    /// The rank is not lost.
    Full,
    /// The rank is lost at a state that satisfies the constraints: motions cross there.
    Lost,
    /// The rank is lost at a state that does not satisfy the constraints: the curve is not a motion there,
    /// since it leaves the surface for another of its sheets.
    Passed,
}

/// Writes the rates of a motion at (t, y).
pub(crate) type Rates<'a> = dyn FnMut(&mut Motion, f64, &[f64], &mut [f64]) -> Result<(), Failure> + 'a;

impl Motion {
    /// Watches the rank of the constraints from one end of a step to the other, and builds a bridge if the
    /// constraints are about to lose rank.
    ///
    /// # Errors
    /// [`RankLost`](crate::ConstraintError::RankLost) where the motion is undetermined.
    pub(in crate::compiled) fn watch_rank(
        &mut self,
        from: (f64, &[f64]),
        to: (f64, &[f64]),
        rates: &mut Rates<'_>,
    ) -> Result<(), Failure> {
        // A step may be shorter than the rounding of a large time.
        if from.0 == to.0 || !self.surface.as_ref().is_some_and(|surface| surface.affine) {
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
        known: Option<Box<Seen>>,
        rates: &mut Rates<'_>,
    ) -> Result<(), Failure> {
        let mut later = std::mem::take(&mut self.watch.next);
        let after = self.independence_after(to, &mut later);
        if !after.map_err(|failure| self.failure(failure, to.0, to.1))? {
            return Ok(());
        }
        let mut now = match known {
            Some(seen) => seen,
            None => {
                let start = self.independence_at(from);
                let start = start.map_err(|failure| self.failure(failure, from.0, from.1))?;
                let Some(rank) = start else { return Ok(()) };
                Box::new(Seen::new(from, rank))
            }
        };
        let reversed = self.is_reversed((&now.rank, from), (&later, to));
        let is_reversed = reversed.map_err(|failure| self.failure(failure, to.0, to.1))?;
        let (was, step) = (now.least, to.0 - from.0);
        self.watch.next = now.advance(to, later);
        if is_reversed && !self.passes(from, to, rates) {
            return Err(self.rank_lost(&now));
        }
        let shrinks = was - now.least;
        let ahead = step * now.least / shrinks;
        if shrinks > 0.0 && now.least <= NEAR && ahead.abs() <= STEPS_AHEAD * step.abs() {
            if 2.0 * ahead.abs() <= now.tried {
                now.tried = ahead.abs();
                let end = to.0 + 2.0 * ahead;
                match self.ahead(to, end, now.least, rates) {
                    Some((_, Rank::Lost)) if !self.takes_bridge(to.0, end) => {
                        return Err(self.rank_lost(&now));
                    }
                    Some((motion, Rank::Full | Rank::Lost)) if self.takes_bridge(to.0, end) => {
                        self.watch.bridge = Some(Box::new(motion));
                    }
                    _ => {}
                }
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

    /// The smooth motion to `end`, and what happens to the rank along it.
    fn ahead(
        &mut self,
        from: (f64, &[f64]),
        end: f64,
        least: f64,
        rates: &mut Rates<'_>,
    ) -> Option<(Collocation, Rank)> {
        let motion = self.smooth(from, end, (MAGNIFIED / least).min(LARGEST_ERROR), rates)?;
        let rank = self.rank_along(&motion)?;
        Some((motion, rank))
    }

    /// Whether a polynomial may replace the motion: a polynomial has no derivatives with respect to state and
    /// parameters, and cannot represent forces that jump or have corners.
    fn takes_bridge(&self, from: f64, end: f64) -> bool {
        let has_derivatives = self.options.jvp || self.options.parameter_jacobian;
        let breaks = self.signals.breaks().iter().any(|&t| (t - from) * (t - end) <= 0.0);
        !has_derivatives && !breaks && !self.watch.refuses && self.switches.is_none()
    }

    /// Whether a step follows the smooth motion, if the constraints may have lost rank between the ends of
    /// the step.
    fn passes(&mut self, from: (f64, &[f64]), to: (f64, &[f64]), rates: &mut Rates<'_>) -> bool {
        let (mut t, mut y) = (from.0, from.1.to_vec());
        let (mut length, mut is_lost) = (to.0 - from.0, false);
        while length.abs() >= SHORTEST * (to.0 - from.0).abs() {
            let is_last = (to.0 - t).abs() <= length.abs();
            let end = if is_last { to.0 } else { t + length };
            let Some(motion) = self.smooth((t, &y), end, COARSE, rates) else {
                length *= 0.5;
                continue;
            };
            match self.rank_along(&motion) {
                Some(Rank::Full) => {}
                Some(Rank::Lost) => is_lost = true,
                Some(Rank::Passed) | None => return false,
            }
            (t, y) = (end, motion.state(end));
            if is_last {
                return !is_lost || motion.distance(&y, to.1) <= CONFIRMED;
            }
        }
        false
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

    /// What happens to the rank along a smooth motion: where it is lost, the orientation of the space spanned by the
    /// constraints changes.
    fn rank_along(&mut self, motion: &Collocation) -> Option<Rank> {
        let at = |field: &mut Motion, t: f64| {
            let state = motion.state(t);
            let rank = field.independence_at((t, &state)).ok().flatten()?;
            Some((t, state, rank))
        };
        let mut found = Rank::Full;
        let start = at(self, motion.start)?;
        let mut before = start.clone();
        for part in 1..=PARTS {
            let next = at(self, motion.start + (motion.end - motion.start) * part as f64 / PARTS as f64);
            // At the loss of rank itself there is no such space.
            if next.is_none() && part < PARTS {
                continue;
            }
            let next = next?;
            if self.turns(&before, &next)? {
                let (mut low, mut high) = (before.0, next.0);
                for _ in 0..HALVINGS {
                    let half = 0.5 * (low + high);
                    let Some(middle) = at(self, half) else {
                        high = half;
                        break;
                    };
                    if self.turns(&before, &middle)? { high = half } else { low = half }
                }
                if !self.crosses(motion, high, (start.0, &start.1))? {
                    return Some(Rank::Passed);
                }
                found = Rank::Lost;
            }
            before = next;
        }
        // Where rank is lost twice at once, the orientation is the same before and after.
        let middle = 0.5 * (motion.start + motion.end);
        Some(if self.crosses(motion, middle, (start.0, &start.1))? { found } else { Rank::Passed })
    }

    fn turns(
        &mut self,
        a: &(f64, Vec<f64>, Independence),
        b: &(f64, Vec<f64>, Independence),
    ) -> Option<bool> {
        self.is_reversed((&a.2, (a.0, &a.1)), (&b.2, (b.0, &b.1))).ok()
    }

    /// Whether the constraints hold on a smooth motion at a time when they may have lost rank.
    fn crosses(&mut self, motion: &Collocation, t: f64, start: (f64, &[f64])) -> Option<bool> {
        let state = motion.state(t);
        let Motion { surface: Some(surface), parameters: p, .. } = self else { return None };
        surface.crosses(Point { t, y: &state, p }, Point { t: start.0, y: start.1, p }).ok()
    }

    fn independence_after(
        &mut self,
        to: (f64, &[f64]),
        found: &mut Independence,
    ) -> Result<bool, EvaluationFailure> {
        let Motion { surface, parameters, .. } = self;
        surface.as_mut().map_or(Ok(false), |surface| surface.independence_to(to, parameters, found))
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
