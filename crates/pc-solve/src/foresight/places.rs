//! The places in the next step at which the dependence on time may hide something.

use pc_expr::{Surprises, TimeDependence, VectorField};

use crate::error::SolveError;

/// Places at which a field that is known by its values alone is looked at, from the start to where it is to be integrated.
const SAMPLES: f64 = 64.0;
/// Most places of fast oscillations looked at in one step.
const MOST: usize = 16;
/// Twice as many may lie in a step for each one before it whose places were as foreseen, so many times.
const DOUBLINGS: u32 = 20;
/// After so many such steps an oscillation is taken to be too small to matter.
const ENOUGH: u32 = 200;

/// The step ahead.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ahead {
    /// Where it begins, and where it is planned to end.
    pub(crate) t: f64,
    pub(crate) reach: f64,
    /// Where the integration leads.
    pub(crate) end: f64,
    /// Whether it is the first one, whose length was given: it is taken at the word.
    pub(crate) given: bool,
}

impl Ahead {
    /// The length.
    pub(crate) fn length(&self) -> f64 {
        (self.reach - self.t).abs()
    }
}

/// What is to be looked out for, and what that has taken.
#[derive(Debug)]
pub(crate) struct Places {
    dependence: TimeDependence,
    /// When the integration began.
    begin: f64,
    /// The least length of a step, if there is one.
    min_step: f64,
    /// Steps in sequence that were full of places, all as foreseen.
    unsurprising: u32,
    /// Evaluations and shortened steps since the last restart.
    pub(crate) evaluations: u64,
    pub(crate) limited: u64,
    /// The places in the step ahead, in its order.
    pub(crate) found: Vec<f64>,
    /// A place beyond which there are too many for it.
    pub(crate) crowded: Option<f64>,
    /// Places of fast oscillations, and how many there are.
    many: Vec<f64>,
    crowd: usize,
    unknown: bool,
}

/// What a method knows of the start of the step ahead.
pub(crate) trait Here {
    /// (y, ẏ) there.
    ///
    /// # Errors
    /// [`SolveError`] if the method cannot tell.
    fn tangent(&mut self) -> Result<(&[f64], &[f64]), SolveError>;

    /// Whether f is noise between there and a place near by.
    ///
    /// # Errors
    /// [`SolveError::Integration`] with [`Reason::Unresolved`](crate::Reason::Unresolved) if so.
    fn resolve(&mut self, near: f64, length: f64) -> Result<(), SolveError>;
}

impl Places {
    pub(crate) fn new(field: &impl VectorField, t0: f64, min_step: Option<f64>) -> Places {
        Places {
            dependence: field.time_dependence(),
            begin: t0,
            min_step: min_step.unwrap_or(0.0),
            unsurprising: 0,
            evaluations: 0,
            limited: 0,
            found: Vec::new(),
            crowded: None,
            many: Vec::new(),
            crowd: 0,
            unknown: false,
        }
    }

    /// Whether there are none ever.
    pub(crate) fn are_absent(&self) -> bool {
        matches!(self.dependence, TimeDependence::Absent)
    }

    /// For a new start.
    pub(crate) fn restart(&mut self) {
        (self.unsurprising, self.evaluations, self.limited) = (0, 0, 0);
    }

    /// Finds those of the step ahead; whether there are any.
    ///
    /// # Errors
    /// Those of [`Here`].
    pub(crate) fn look(&mut self, ahead: Ahead, here: &mut impl Here) -> Result<bool, SolveError> {
        let Ahead { t, reach, end, .. } = ahead;
        self.found.clear();
        self.crowded = None;
        // No method can go to where rounding is felt.
        let least = (1e-13 * t.abs().max(reach.abs())).max(self.min_step);
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
                let tangent = if profile.follows_states() { here.tangent()? } else { (&[][..], &[][..]) };
                sampled = profile.is_partial();
                profile.surprises((t, reach), tangent, end, self.unsurprising > ENOUGH)
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
        for places in [&mut self.found, &mut self.many] {
            places.retain(|place| (place - t).abs() > least);
        }
        let many = &mut self.many;
        self.crowd = many.len();
        self.unknown = until.is_some();
        // Of fast oscillations not all are looked at, and a step holds no more than those before it let expect.
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

    /// Takes note that at one of them the field does what was not to be expected: the step ends there.
    pub(crate) fn surprised(&mut self) {
        self.unsurprising = 0;
        self.limited += 1;
    }

    /// Takes note that all was to be expected, up to where there are too many of them.
    pub(crate) fn as_expected(&mut self) {
        self.unsurprising =
            if self.crowd > MOST || self.unknown { self.unsurprising.saturating_add(1) } else { 0 };
        self.limited += u64::from(self.crowded.is_some());
    }

    /// Adds places evenly spaced over the integration from its start to its end, those of the next step.
    fn sample(&mut self, Ahead { t, reach, end, .. }: Ahead) {
        let begin = self.begin;
        let spacing = (end - begin).abs().max((reach - begin).abs()) / SAMPLES;
        let (from, to) = ((t - begin).abs() / spacing, (reach - begin).abs() / spacing);
        let direction = 1.0_f64.copysign(reach - t);
        let place = |k: f64| begin + (k * spacing).copysign(direction);
        // None of an integration that has turned round.
        let is_ahead = (t - begin) * direction >= 0.0 && spacing.is_normal();
        // In the middle between whole multiples, which steps and switches tend to fall on.
        let first = (from - 0.5).ceil().max(0.0);
        let count = if is_ahead { (to - 0.5 - first).ceil().clamp(0.0, 2.0 * SAMPLES) } else { 0.0 };
        let places = (0..count as u32).map(|k| place(first + f64::from(k) + 0.5));
        self.found.extend(places.filter(|s| (s - reach) * direction < 0.0));
    }
}
