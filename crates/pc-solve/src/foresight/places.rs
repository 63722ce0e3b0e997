//! The times in the next step at which the field may do something that the method does not notice.

use pc_expr::{PolynomialMotion, SteepFunctions, Surprises, TimeDependence, VectorField};

use crate::error::SolveError;

/// The number of times, from start to end, at which a field with unknown time dependence is
/// examined.
const SAMPLES: f64 = 64.0;
/// The maximum number of times that are examined in one step because of fast oscillations.
const MOST: usize = 16;
/// The number of times that may be examined in a step doubles after each step without surprises, up
/// to this many doublings.
const DOUBLINGS: u32 = 20;
/// After this many steps without surprises an oscillation is considered too small to matter.
const ENOUGH: u32 = 200;

/// The step ahead.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ahead {
    /// The start of the step and its planned end.
    pub(crate) t: f64,
    pub(crate) reach: f64,
    /// The end of the integration.
    pub(crate) end: f64,
    /// Whether the step is the first one and its length was given; such a length is trusted.
    pub(crate) given: bool,
}

impl Ahead {
    /// The length.
    pub(crate) fn length(&self) -> f64 {
        (self.reach - self.t).abs()
    }
}

/// The times to examine, and the work that the examination has taken.
#[derive(Debug)]
pub(crate) struct Places {
    dependence: TimeDependence,
    /// The functions of the state whose features a step may miss.
    steep: Option<SteepFunctions>,
    /// The start of the integration.
    begin: f64,
    /// The minimum step, or 0.
    min_step: f64,
    /// The number of successive steps that had too many times to examine and no surprises.
    unsurprising: u32,
    /// The numbers of evaluations and of shortened steps since the last restart.
    pub(crate) evaluations: u64,
    pub(crate) limited: u64,
    /// The times to examine in the step ahead, ordered in its direction.
    pub(crate) found: Vec<f64>,
    /// The times in `found` that come from the motion along a step that has been tried.
    along: Vec<f64>,
    /// A time beyond which there are too many times to examine in one step.
    pub(crate) crowded: Option<f64>,
    /// The times to examine because of fast oscillations, and how many there are.
    many: Vec<f64>,
    crowd: usize,
    unknown: bool,
}

/// What a method knows at the start of the step ahead.
pub(crate) trait Here {
    /// The motion that the method predicts from there; none if the method cannot predict it before
    /// the step.
    ///
    /// # Errors
    /// [`SolveError`] if the method fails.
    fn prediction(&mut self) -> Result<Option<PolynomialMotion<'_>>, SolveError>;

    /// Checks that f is not mere noise between the start of the step and the time `near`.
    ///
    /// # Errors
    /// [`SolveError::Integration`] with [`Reason::Unresolved`](crate::Reason::Unresolved) if f is
    /// noise.
    fn resolve(&mut self, near: f64, length: f64) -> Result<(), SolveError>;
}

impl Places {
    pub(crate) fn new(field: &mut impl VectorField, t0: f64, min_step: Option<f64>) -> Places {
        // Where f is held, it does not jump.
        let held = field.held_time_dependence();
        Places {
            dependence: held.unwrap_or_else(|| field.time_dependence()),
            steep: field.steep_functions(),
            begin: t0,
            min_step: min_step.unwrap_or(0.0),
            unsurprising: 0,
            evaluations: 0,
            limited: 0,
            found: Vec::new(),
            along: Vec::new(),
            crowded: None,
            many: Vec::new(),
            crowd: 0,
            unknown: false,
        }
    }

    /// Whether there are no times to examine at all.
    pub(crate) fn are_absent(&self) -> bool {
        matches!(self.dependence, TimeDependence::Absent) && self.steep.is_none()
    }

    /// Whether the times to examine may depend on the states along the motion.
    pub(crate) fn follow_states(&self) -> bool {
        self.steep.is_some()
    }

    /// Resets the counts, for a restart.
    pub(crate) fn restart(&mut self) {
        (self.unsurprising, self.evaluations, self.limited) = (0, 0, 0);
    }

    /// Finds the times to examine in the step ahead; returns whether there are any.
    ///
    /// # Errors
    /// The errors of [`Here`].
    pub(crate) fn look(&mut self, ahead: Ahead, here: &mut impl Here) -> Result<bool, SolveError> {
        let Ahead { t, reach, end, .. } = ahead;
        self.found.clear();
        self.crowded = None;
        let least = self.least(t, reach);
        if self.are_absent() || ahead.length() <= least {
            return Ok(false);
        }
        let (mut sampled, nothing) = (false, Surprises::default());
        let Surprises { few, many, until, noise } = match &mut self.dependence {
            TimeDependence::Absent => &nothing,
            TimeDependence::Unknown => {
                sampled = !ahead.given;
                &nothing
            }
            TimeDependence::Known(profile) => {
                sampled = profile.is_partial();
                profile.surprises((t, reach), end, self.unsurprising > ENOUGH)
            }
        };
        let (mut until, noise) = (*until, *noise);
        self.found.extend_from_slice(few);
        self.many.clear();
        self.many.extend_from_slice(many);
        if sampled {
            self.sample(ahead);
        }
        if noise && let Some(near) = until.take() {
            self.many.clear();
            here.resolve(near, ahead.length())?;
        }
        if self.steep.is_some()
            && let Some(motion) = here.prediction()?
        {
            until = nearer(t, until, self.follow((t, reach), motion));
        }
        for places in [&mut self.found, &mut self.many] {
            places.retain(|place| (place - t).abs() > least);
        }
        let many = &mut self.many;
        many.sort_unstable_by(|a, b| ((a - b) * (reach - t)).total_cmp(&0.0));
        self.crowd = many.len();
        self.unknown = until.is_some();
        // Only some places of fast oscillations are examined, and a step may contain more of them
        // only after steps without surprises.
        let allowed = MOST << self.unsurprising.min(DOUBLINGS);
        self.crowded = many.get(allowed).copied().or(until.filter(|until| (until - t).abs() > least));
        many.truncate(allowed);
        let stride = many.len().div_ceil(MOST).max(1);
        self.found.extend(many.iter().skip(stride - 1).step_by(stride));
        self.found.sort_unstable_by(|a, b| ((a - b) * (reach - t)).total_cmp(&0.0));
        if self.found.is_empty() && self.crowded.is_none() {
            self.unsurprising = 0;
            return Ok(false);
        }
        Ok(true)
    }

    /// Whether steep functions of the state may hide a feature along the motion in a step that has
    /// been tried.
    pub(crate) fn hide_along(&mut self, between: (f64, f64), motion: PolynomialMotion<'_>) -> bool {
        self.steep.as_mut().is_some_and(|steep| steep.hide(between, motion))
    }

    /// Replaces the times that came from the motion in the step tried before with those from this
    /// motion.
    pub(crate) fn look_along(&mut self, (t, reach): (f64, f64), motion: PolynomialMotion<'_>) {
        let Places { found, along, .. } = self;
        found.retain(|place| !along.contains(place));
        let before = found.len();
        self.many.clear();
        self.follow((t, reach), motion);
        let least = self.least(t, reach);
        let stride = self.many.len().div_ceil(MOST).max(1);
        let Places { found, along, many, .. } = self;
        found.extend(many.iter().step_by(stride));
        along.clear();
        along.extend(found.drain(before..).filter(|place| (place - t).abs() > least));
        found.extend_from_slice(along);
        self.found.sort_unstable_by(|a, b| ((a - b) * (reach - t)).total_cmp(&0.0));
    }

    /// The smallest difference between times that methods can resolve.
    fn least(&self, t: f64, reach: f64) -> f64 {
        (1e-13 * t.abs().max(reach.abs())).max(self.min_step)
    }

    /// Notes the times to examine along a motion; returns the time up to which these are known, if
    /// that time is before `reach`.
    fn follow(&mut self, (t, reach): (f64, f64), motion: PolynomialMotion<'_>) -> Option<f64> {
        let enough = self.unsurprising > ENOUGH;
        let Surprises { few, many, until, .. } = self.steep.as_mut()?.surprises((t, reach), motion, enough);
        self.found.extend_from_slice(few);
        self.many.extend_from_slice(many);
        *until
    }

    /// Notes that a time examined was a surprise, at which the step ends.
    pub(crate) fn surprised(&mut self) {
        self.unsurprising = 0;
        self.limited += 1;
    }

    /// Notes that no time examined was a surprise.
    pub(crate) fn as_expected(&mut self) {
        self.unsurprising =
            if self.crowd > MOST || self.unknown { self.unsurprising.saturating_add(1) } else { 0 };
        self.limited += u64::from(self.crowded.is_some());
    }

    /// Adds those times in the next step that are evenly spaced over the integration.
    fn sample(&mut self, Ahead { t, reach, end, .. }: Ahead) {
        let begin = self.begin;
        let spacing = (end - begin).abs().max((reach - begin).abs()) / SAMPLES;
        let (from, to) = ((t - begin).abs() / spacing, (reach - begin).abs() / spacing);
        let direction = 1.0_f64.copysign(reach - t);
        let place = |k: f64| begin + (k * spacing).copysign(direction);
        // None for an integration that has reversed past its start.
        let is_ahead = (t - begin) * direction >= 0.0 && spacing.is_normal();
        // Midway between whole multiples, on which steps and switches tend to fall.
        let first = (from - 0.5).ceil().max(0.0);
        let count = if is_ahead { (to - 0.5 - first).ceil().clamp(0.0, 2.0 * SAMPLES) } else { 0.0 };
        let places = (0..count as u32).map(|k| place(first + f64::from(k) + 0.5));
        self.found.extend(places.filter(|s| (s - reach) * direction < 0.0));
    }
}

/// The nearer of two times ahead of `t`.
fn nearer(t: f64, a: Option<f64>, b: Option<f64>) -> Option<f64> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if (b - t).abs() < (a - t).abs() { b } else { a }),
        (a, b) => a.or(b),
    }
}
