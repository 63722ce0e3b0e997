//! The explicit dependence of a vector field on time.
//!
//! An integrator evaluates f at the ends of its steps. A pulse or a switch between them, from t in f itself,
//! leaves no trace there, and a body at rest is carried over it in one step. But a program of f shows where
//! that is possible: over any interval of time its parts and their first two derivatives are enclosed by
//! interval arithmetic [Moore 1966]. Where the enclosures show that a part is monotonic and bends one way,
//! nothing is hidden; otherwise the interval is halved. So no pulse is missed, however short.

use crate::program::program::Program;
use crate::time_profile::part::{Analysis, Line, Part};
use crate::time_profile::scan::{Feature, Kind, Scan};

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

/// The greatest number of instructions, leading to steep functions of t and the state, that are examined on
/// each step.
const LONGEST: usize = 256;

impl TimeDependence {
    /// The time dependence of rates computed by these programs, whose states begin with `dim` components of y, for
    /// these values of the parameters.
    pub fn of(programs: &[&Program], dim: usize, parameters: &[f64]) -> TimeDependence {
        let mut profile = TimeProfile {
            parts: Vec::new(),
            mixed: Vec::new(),
            sampled: false,
            origin: 0.0,
            room: Vec::new(),
            times: Surprises::default(),
        };
        let mut explicit = false;
        for program in programs {
            let Analysis { explicit: here, forcing, mixed } = Analysis::of(program, parameters);
            explicit |= here;
            if !forcing.is_empty() {
                profile.parts.push(Watched { part: forcing, scan: Scan::new() });
            }
            if mixed.is_empty() {
                continue;
            }
            if program.state_len() == dim && mixed.len() <= LONGEST {
                profile.mixed.push(Watched { part: mixed, scan: Scan::new() });
            } else {
                profile.sampled = true;
            }
        }
        if explicit { TimeDependence::Known(Box::new(profile)) } else { TimeDependence::Absent }
    }

    /// The same of times that are counted from `origin`.
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
/// Functions of t alone are followed wherever the motion goes. Steep functions of t and the state, such as a
/// travelling pulse, are followed along the direction of the motion.
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
/// let times = profile.surprises((0.0, 10.0), (&[0.0], &[0.0]), 10.0, false);
/// assert!(times.few.iter().any(|t| (t - 5.0).abs() < 0.005), "{times:?}");
/// assert!(profile.surprises((0.0, 4.0), (&[0.0], &[0.0]), 10.0, false).few.is_empty());
/// # Ok::<(), pc_expr::ExprError>(())
/// ```
#[derive(Clone, Debug)]
pub struct TimeProfile {
    parts: Vec<Watched>,
    mixed: Vec<Watched>,
    /// Whether there are steep functions of t and the state that are only sampled.
    sampled: bool,
    /// The time from which the times of queries and answers are counted.
    origin: f64,
    /// Storage for the counts of features of each function of a part, and for the result.
    room: Vec<Seen>,
    times: Surprises,
}

/// Times of features that are invisible at the two ends of an interval, in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surprises {
    /// Features of functions with at most 32 of them.
    pub few: Vec<f64>,
    /// Features of functions with more, such as fast oscillations.
    pub many: Vec<f64>,
    /// The time up to which they are known, if it is not the end of the interval.
    pub until: Option<f64>,
    /// Whether some function of t turns faster than floating-point times can resolve.
    pub noise: bool,
}

impl Surprises {
    /// Clears the list for another interval.
    fn forget(&mut self) {
        self.few.clear();
        self.many.clear();
        (self.until, self.noise) = (None, false);
    }

    /// Records what a scan finds.
    fn add(
        &mut self,
        part: &mut Part,
        scan: &mut Scan,
        (t, to): (f64, f64),
        line: Line<'_>,
        enough: bool,
        room: &mut Vec<Seen>,
    ) {
        let (known, features) = scan.between(part, (t, to), line, enough);
        choose(features.iter(), (t, known), part, room, self);
        self.limit(known, (t, to));
        self.noise |= scan.is_noise();
    }

    /// Records that only a part of the interval is known.
    fn limit(&mut self, known: f64, (t, to): (f64, f64)) {
        if known != to && self.until.is_none_or(|until| (known - t).abs() < (until - t).abs()) {
            self.until = Some(known);
        }
    }
}

/// The most features of a function that count as few.
const FEW: usize = 32;

/// Watched functions, and how far they are known.
#[derive(Clone, Debug)]
struct Watched {
    part: Part,
    scan: Scan,
}

impl TimeProfile {
    /// Whether there are steep functions of t and the state that only evaluations show.
    pub fn is_partial(&self) -> bool {
        self.sampled
    }

    /// Whether the profile has to be queried along the motion, because of steep functions of t and the state.
    pub fn follows_states(&self) -> bool {
        !self.mixed.is_empty()
    }

    /// The times between `t` and `to`, in order, of features that are invisible at the two ends of that
    /// interval: jumps and corners, and the turns and bends of functions that may rise and fall in between.
    ///
    /// `at` is (y, ẏ) at t. Where there are thousands, the list ends at one of them; with `enough`, the
    /// remaining time is examined coarsely. Later calls continue from `to` or before, up to `end` and beyond.
    pub fn surprises(
        &mut self,
        (t, to): (f64, f64),
        at: (&[f64], &[f64]),
        end: f64,
        enough: bool,
    ) -> &Surprises {
        let direction = if to < t { -1.0 } else { 1.0 };
        let origin = self.origin;
        let (t, to, end) = (origin + t, origin + to, origin + end);
        let TimeProfile { parts, mixed, room, times, .. } = self;
        times.forget();
        for Watched { part, scan } in parts {
            if !scan.covers(t, to) {
                // Where `end` lies behind, the window is sixteen such intervals long.
                let far = if (end - to) * direction >= 0.0 { end } else { t + 16.0 * (to - t) };
                scan.begin(part, t, far, Line::default());
            }
            times.add(part, scan, (t, to), Line::default(), enough, room);
        }
        let line = Line { t, state: at.0, rates: at.1 };
        for Watched { part, scan } in mixed {
            scan.begin(part, t, to, line);
            times.add(part, scan, (t, to), line, enough, room);
        }
        for times in [&mut times.few, &mut times.many] {
            times.sort_unstable_by(|a, b| ((a - b) * direction).total_cmp(&0.0));
            times.dedup();
            times.iter_mut().for_each(|time| *time -= origin);
        }
        times.until = times.until.map(|until| until - origin);
        times
    }
}

/// The features between `t` and `to` of each function that has a sharp one, rises or falls steeply, or turns
/// without bending one way throughout.
fn choose<'a>(
    features: impl Iterator<Item = &'a Feature> + Clone,
    (t, to): (f64, f64),
    part: &Part,
    seen: &mut Vec<Seen>,
    times: &mut Surprises,
) {
    let direction = if to < t { -1.0 } else { 1.0 };
    let inside = features.filter(|feature| (feature.t - to) * direction < 0.0);
    seen.clear();
    seen.resize(part.watched.len(), Seen::default());
    for feature in inside.clone() {
        seen[feature.function].note(feature.kind, (to - t).abs());
    }
    for feature in inside.filter(|feature| feature.kind != Kind::Unsure) {
        let seen = seen[feature.function];
        if seen.hides() {
            let times = if seen.places <= FEW { &mut times.few } else { &mut times.many };
            times.push(feature.t);
        }
    }
}

/// How often a function shows each kind of feature.
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    places: usize,
    sharp: usize,
    turns: usize,
    bends: usize,
    unsure: usize,
}

impl Seen {
    fn note(&mut self, kind: Kind, length: f64) {
        self.places += usize::from(kind != Kind::Unsure);
        match kind {
            Kind::Sharp => self.sharp += 1,
            Kind::Turn => self.turns += 1,
            // So steep a rise may end together with that of another function.
            Kind::Bend(time) if time < length => self.sharp += 1,
            Kind::Bend(_) => self.bends += 1,
            Kind::Unsure => self.unsure += 1,
        }
    }

    /// Whether the values and rates at both ends may fail to show what happens between.
    fn hides(self) -> bool {
        self.sharp > 0 || self.turns > 1 || self.bends > 1 || self.turns == 1 && self.bends + self.unsure > 0
    }
}
