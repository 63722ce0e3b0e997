//! The explicit dependence of a vector field on time.
//!
//! An integrator evaluates f at the ends of its steps. If f itself contains t, a pulse or a switch between
//! these ends leaves no trace at them, and a body at rest is carried over it in one step. But a program of f
//! shows where that is possible: its parts and their first two derivatives are enclosed by interval
//! arithmetic over any interval of time [Moore 1966]. Where the enclosures show that a part is monotonic and
//! bends only one way, nothing is hidden; otherwise the interval is halved. So no pulse is missed, however
//! short.

use crate::program::program::Program;
use crate::time_profile::motion::PolynomialMotion;
use crate::time_profile::part::Analysis;
use crate::time_profile::scan::Scan;
use crate::time_profile::steep::SteepFunctions;
use crate::time_profile::surprises::{Seen, Surprises, Watched};

/// How f(t, y) depends on t explicitly.
#[derive(Clone, Debug, Default)]
pub enum TimeDependence {
    /// f does not depend on t explicitly.
    Absent,
    /// f depends on t, in the way shown by the profile.
    Known(Box<TimeProfile>),
    /// f may depend on t in ways that only evaluations show.
    #[default]
    Unknown,
}

impl TimeDependence {
    /// The time dependence of rates computed by these programs, whose states begin with `dim` components of y, for
    /// these values of the parameters.
    pub fn of(programs: &[&Program], dim: usize, parameters: &[f64]) -> TimeDependence {
        let mut profile = TimeProfile {
            parts: Vec::new(),
            sampled: false,
            origin: 0.0,
            room: Vec::new(),
            times: Surprises::default(),
        };
        let mut explicit = false;
        for program in programs {
            let Analysis { explicit: here, forcing } = Analysis::of(program, parameters);
            explicit |= here;
            profile.sampled |= SteepFunctions::are_too_long(program, dim);
            if !forcing.is_empty() {
                profile.parts.push(Watched { part: forcing, scan: Scan::new() });
            }
        }
        if explicit { TimeDependence::Known(Box::new(profile)) } else { TimeDependence::Absent }
    }

    /// The same dependence on time, for times that are counted from `origin`.
    #[must_use]
    pub fn since(self, origin: f64) -> TimeDependence {
        match self {
            TimeDependence::Known(mut profile) => {
                profile.origin += origin;
                TimeDependence::Known(profile)
            }
            other => other,
        }
    }

    /// The time dependence after an unknown term is added to the rates.
    #[must_use]
    pub fn with_unknown(self) -> TimeDependence {
        match self {
            TimeDependence::Known(mut profile) => {
                profile.sampled = true;
                TimeDependence::Known(profile)
            }
            TimeDependence::Absent | TimeDependence::Unknown => TimeDependence::Unknown,
        }
    }
}

/// Where the parts of f that contain t turn, bend, jump or have corners.
///
/// Functions of t alone are followed wherever the motion goes; [`SteepFunctions`] are the functions of the
/// state.
/// ```
/// use pc_expr::{Graph, Inputs, Program, TimeDependence};
///
/// // ẏ = exp(−((t − 5)/0.01)²) − y
/// let graph = Graph::new();
/// let [t, y] = graph.symbols(["t", "y"]);
/// let rate = (-((t - 5.0) / 0.01).square()).exp() - y;
/// let inputs = Inputs { time: Some(t), state: vec![y], parameters: vec![] };
/// let program = Program::new(&graph, &inputs, &[rate])?;
/// let TimeDependence::Known(mut profile) = TimeDependence::of(&[&program], 1, &[]) else { panic!() };
/// let times = profile.surprises((0.0, 10.0), 10.0, false);
/// assert!(times.few.iter().any(|t| (t - 5.0).abs() < 0.005), "{times:?}");
/// assert!(profile.surprises((0.0, 4.0), 10.0, false).few.is_empty());
/// # Ok::<(), pc_expr::ExprError>(())
/// ```
#[derive(Clone, Debug)]
pub struct TimeProfile {
    parts: Vec<Watched>,
    /// Whether there are steep functions of t and the state that are only sampled.
    sampled: bool,
    /// The time from which the times of queries and answers are counted.
    origin: f64,
    /// Storage for the counts of features of each function of a part, and for the result.
    room: Vec<Seen>,
    times: Surprises,
}

impl TimeProfile {
    /// Whether there are steep functions of t and the state that only evaluations show.
    pub fn is_partial(&self) -> bool {
        self.sampled
    }

    /// The times between `t` and `to`, in order, of features that are invisible at the two ends of that
    /// interval: jumps and corners, and the turns and bends of functions that may rise and fall in between.
    ///
    /// If there are thousands of such times, the list ends at one of them; with `enough`, the remaining time
    /// is examined coarsely. Later calls continue from `to` or before, up to `end` and beyond.
    pub fn surprises(&mut self, (t, to): (f64, f64), end: f64, enough: bool) -> &Surprises {
        let direction = if to < t { -1.0 } else { 1.0 };
        let origin = self.origin;
        let (t, to, end) = (origin + t, origin + to, origin + end);
        let TimeProfile { parts, room, times, .. } = self;
        times.forget();
        let along = (PolynomialMotion::default(), 0);
        for watched in parts {
            if !watched.scan.covers(t, to) {
                // Where `end` lies behind, the window is sixteen such intervals long.
                let far = if (end - to) * direction >= 0.0 { end } else { t + 16.0 * (to - t) };
                watched.scan.begin(&mut watched.part, t, far, along);
            }
            times.add(watched, (t, to), along, enough, room);
        }
        times.arrange(direction, origin);
        times
    }
}
