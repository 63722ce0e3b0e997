//! Events given by closures, their occurrences, and their accumulation.

use std::collections::VecDeque;
use std::fmt;

use pc_expr::{Event, Events, Failure};

type Function<'a> = Box<dyn FnMut(f64, &[f64]) -> Result<f64, Failure> + 'a>;
type ByParameter<'a> = Box<dyn FnMut(usize, usize, f64, &[f64], &mut [f64]) -> Result<f64, Failure> + 'a>;
type Reset<'a> = Box<dyn FnMut(f64, &mut [f64]) -> Result<(), Failure> + 'a>;

/// Events given by closures.
///
/// ```
/// use pc_solve::{Event, FnEvents, Solve, from_fn};
///
/// // A ball bounces on the floor and loses half its speed.
/// let ball = from_fn(2, |_t, y, ydot| {
///     ydot[0] = y[1];
///     ydot[1] = -9.81;
///     Ok(())
/// });
/// let bounce = FnEvents::new().with_reset(
///     Event::new("bounce").falling(),
///     |_t, y| Ok(y[0]),
///     |_t, y| {
///         y[1] *= -0.5;
///         Ok(())
///     },
/// );
/// let motion = Solve::new(ball, 0.0, &[1.0, 0.0]).events(bounce).run(&[0.5, 0.8])?;
/// assert!((motion.occurrences[0].time - (2.0_f64 / 9.81).sqrt()).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Default)]
pub struct FnEvents<'a> {
    events: Vec<Event>,
    functions: Vec<Function<'a>>,
    resets: Vec<Option<Reset<'a>>>,
    by_parameter: Option<ByParameter<'a>>,
}

impl<'a> FnEvents<'a> {
    /// No events.
    pub fn new() -> Self {
        FnEvents::default()
    }

    /// Adds an event that occurs where `function` of (t, y) passes through zero.
    pub fn with(
        mut self,
        event: Event,
        function: impl FnMut(f64, &[f64]) -> Result<f64, Failure> + 'a,
    ) -> Self {
        self.events.push(event.resetting(false));
        self.functions.push(Box::new(function));
        self.resets.push(None);
        self
    }

    /// Adds an event with a reset that changes y⁻ to y⁺.
    pub fn with_reset(
        mut self,
        event: Event,
        function: impl FnMut(f64, &[f64]) -> Result<f64, Failure> + 'a,
        reset: impl FnMut(f64, &mut [f64]) -> Result<(), Failure> + 'a,
    ) -> Self {
        self.events.push(event.resetting(true));
        self.functions.push(Box::new(function));
        self.resets.push(Some(Box::new(reset)));
        self
    }
}

impl<'a> FnEvents<'a> {
    /// The same events with their derivatives with respect to parameters, for sensitivities: a
    /// closure of (event, parameter, t, y) that returns ∂g/∂pⱼ and writes ∂R/∂pⱼ to its last
    /// argument, as [`Events::by_parameter`] does.
    pub fn with_parameter_derivatives(
        self,
        by_parameter: impl FnMut(usize, usize, f64, &[f64], &mut [f64]) -> Result<f64, Failure> + 'a,
    ) -> Self {
        FnEvents { by_parameter: Some(Box::new(by_parameter)), ..self }
    }
}

/// No events.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct NoEvents;

impl Events for NoEvents {
    fn events(&self) -> &[Event] {
        &[]
    }

    fn evaluate(&mut self, _t: f64, _y: &[f64], _values: &mut [f64]) -> Result<(), Failure> {
        Ok(())
    }
}

impl fmt::Debug for FnEvents<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FnEvents").field("events", &self.events).finish_non_exhaustive()
    }
}

impl Events for FnEvents<'_> {
    fn events(&self) -> &[Event] {
        &self.events
    }

    fn evaluate(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure> {
        for (value, function) in values.iter_mut().zip(&mut self.functions) {
            *value = function(t, y)?;
        }
        Ok(())
    }

    fn has_parameter_derivatives(&self) -> bool {
        self.by_parameter.is_some()
    }

    fn by_parameter(
        &mut self,
        event: usize,
        parameter: usize,
        t: f64,
        y: &[f64],
        reset: &mut [f64],
    ) -> Result<f64, Failure> {
        match &mut self.by_parameter {
            Some(by_parameter) => by_parameter(event, parameter, t, y, reset),
            None => Ok(0.0),
        }
    }

    fn reset(&mut self, event: usize, t: f64, y: &mut [f64]) -> Result<(), Failure> {
        match self.resets.get_mut(event) {
            Some(Some(reset)) => reset(t, y),
            _ => Ok(()),
        }
    }
}

/// An event that occurred.
///
/// The resets of simultaneous events apply in order: each starts from the state that the previous
/// reset has produced.
#[derive(Debug, Clone, PartialEq)]
pub struct Occurrence {
    /// The index of the event among the [events](Events::events), from 0.
    pub event: usize,
    /// The time.
    pub time: f64,
    /// y⁻
    pub state_before: Vec<f64>,
    /// y⁺, projected if the field [projects](pc_expr::VectorField::has_projection) its states; y⁻
    /// if there is no reset.
    pub state_after: Vec<f64>,
}

/// When occurrences of an event count as accumulated, like the bounces of a ball that comes to
/// rest: an integration from event to event cannot pass the time at which they accumulate.
///
/// Occurrences count as accumulated if the last intervals between them shrink steadily and,
/// continued as a geometric series, sum to less than a small fraction of the first of the shrinking
/// intervals. They also do if rounding leaves them barely distinct from each other: the last times
/// lie within 1e-12 |t|. Neither criterion depends on the length of the integration. An event whose
/// function stays below the absolute tolerance of the state between two occurrences is not
/// resolved, and may be missed.
///
/// A regular motion whose intervals shrink that far before they grow again needs a smaller
/// fraction; with a fraction of 0, only the test for rounding applies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accumulation {
    /// The number of consecutive occurrences of one event considered, at least 4.
    pub occurrences: usize,
    /// The fraction of the first of the shrinking intervals, at least 0 and less than 1.
    pub within: f64,
}

impl Default for Accumulation {
    /// The default: 6 occurrences and a remaining fraction of 1e-5.
    fn default() -> Self {
        Accumulation { occurrences: 6, within: 1e-5 }
    }
}

/// Relative difference below which times are barely resolved.
const UNRESOLVED: f64 = 1e-12;

/// The latest times of one event, and how often that event has occurred.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct History {
    pub(crate) times: VecDeque<f64>,
    pub(crate) occurrences: u64,
    /// The first of the shrinking intervals: since then, each has been shorter than the one before.
    pub(crate) longest: f64,
}

impl History {
    /// Notes an occurrence at `t`. If the last occurrences accumulate, returns their limit,
    /// computed as the sum of a geometric series [Aitken 1926].
    pub(crate) fn note(&mut self, t: f64, limit: Accumulation) -> Option<f64> {
        let kept = limit.occurrences.max(4);
        self.occurrences += 1;
        let mut latest = self.times.iter().rev();
        if let Some(last) = latest.next() {
            let grows = latest.next().is_none_or(|before| (t - last).abs() >= (last - before).abs());
            if grows {
                self.longest = (t - last).abs();
            }
        }
        self.times.push_back(t);
        if self.times.len() > kept {
            self.times.pop_front();
        }
        if self.times.len() < kept {
            return None;
        }
        let times = self.times.iter();
        let distances: Vec<f64> = times.clone().skip(1).zip(times).map(|(b, a)| b - a).collect();
        let (last, before) = (distances[kept - 2], distances[kept - 3]);
        let rest = last * last / (before - last);
        let shrink = distances.windows(2).all(|pair| pair[1].abs() < pair[0].abs());
        if shrink && rest.abs() <= limit.within * self.longest {
            return Some(t + rest);
        }
        ((t - self.times[0]).abs() <= UNRESOLVED * t.abs()).then_some(t)
    }
}
