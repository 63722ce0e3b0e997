//! The times in an interval at which watched functions show what their values at the ends of the interval do
//! not.

use super::motion::PolynomialMotion;
use super::part::Part;
use super::scan::{Feature, Kind, Scan};

/// The maximum number of features of a function that count as few.
const FEW: usize = 32;

/// Times of features that are invisible at the two ends of an interval, in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surprises {
    /// Times of the features of functions that have at most 32 features.
    pub few: Vec<f64>,
    /// Times of the features of functions that have more, such as fast oscillations.
    pub many: Vec<f64>,
    /// The time up to which the features are known, if that is not the end of the interval.
    pub until: Option<f64>,
    /// Whether some function of t turns faster than floating-point times can resolve.
    pub noise: bool,
}

impl Surprises {
    /// Sorts the times, which are then counted from `origin`.
    pub(crate) fn arrange(&mut self, direction: f64, origin: f64) {
        for times in [&mut self.few, &mut self.many] {
            times.sort_unstable_by(|a, b| ((a - b) * direction).total_cmp(&0.0));
            times.dedup();
            times.iter_mut().for_each(|time| *time -= origin);
        }
        self.until = self.until.map(|until| until - origin);
    }

    /// Clears the list for another interval.
    pub(crate) fn forget(&mut self) {
        self.few.clear();
        self.many.clear();
        (self.until, self.noise) = (None, false);
    }

    /// Records the findings of a scan.
    pub(crate) fn add(
        &mut self,
        Watched { part, scan }: &mut Watched,
        (t, to): (f64, f64),
        along: (PolynomialMotion<'_>, usize),
        enough: bool,
        room: &mut Vec<Seen>,
    ) {
        let (known, features) = scan.between(part, (t, to), along, enough);
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

/// Watched functions, and how far they are known.
#[derive(Clone, Debug)]
pub(crate) struct Watched {
    pub(crate) part: Part,
    pub(crate) scan: Scan,
}

/// The features between `t` and `to` of each function that has a sharp feature, rises or falls steeply, or
/// turns without bending one way throughout.
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
    for feature in inside.filter(|feature| feature.kind.is_place((to - t).abs())) {
        let seen = seen[feature.function];
        if seen.hides() {
            let times = if seen.places <= FEW { &mut times.few } else { &mut times.many };
            times.push(feature.t);
        }
    }
}

impl Kind {
    /// Whether a feature of this kind is certain, in an interval of this length.
    fn is_place(self, length: f64) -> bool {
        match self {
            Kind::Sharp | Kind::Turn | Kind::Bend(_) => true,
            Kind::Rise(time) => time < length,
            Kind::Unsure => false,
        }
    }
}

/// How often a function shows each kind of feature.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Seen {
    places: usize,
    sharp: usize,
    turns: usize,
    bends: usize,
    unsure: usize,
}

impl Seen {
    fn note(&mut self, kind: Kind, length: f64) {
        self.places += usize::from(kind.is_place(length));
        match kind {
            Kind::Sharp => self.sharp += 1,
            Kind::Turn => self.turns += 1,
            // So steep a rise may end together with that of another function.
            Kind::Bend(time) | Kind::Rise(time) if time < length => self.sharp += 1,
            Kind::Bend(_) => self.bends += 1,
            Kind::Rise(_) | Kind::Unsure => self.unsure += 1,
        }
    }

    /// Whether the values and rates at both ends may fail to show what happens in between.
    fn hides(self) -> bool {
        self.sharp > 0 || self.turns > 1 || self.bends > 1 || self.turns == 1 && self.bends + self.unsure > 0
    }
}
