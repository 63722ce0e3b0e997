//! Points at which functions of time turn, bend, jump or have corners, one after the other.

use std::collections::VecDeque;

use super::interval::Interval;
use super::jet::Jet;
use super::motion::PolynomialMotion;
use super::part::Part;

/// The number of pieces of a window over which the range of a function is first estimated.
const PIECES: u32 = 32;
/// A function that is neither monotonic on a piece nor bends only one way may vary on it by this fraction of
/// its range without closer examination.
const FLAT: f64 = 1.0 / 64.0;
/// The same fraction for a function with one of the two properties: it has one turn or one inflection on the
/// piece.
const TURN: f64 = 0.25;
/// A rise or fall is a piece on which a monotonic function changes by at least this fraction of its range.
const RISE: f64 = 2.0 / PIECES as f64;
/// Turns and inflections do not count if the function has changed by less than this fraction of its range
/// since the last one.
const SWING: f64 = 1e-3;
/// The rounding error of a value, with a margin.
const ROUNDING: f64 = 1e-12;
/// The shortest piece, as a fraction of a window.
const SHORTEST: f64 = 1e-13;
/// The maximum number of evaluations in one query.
const MOST: u32 = 20_000;
/// The maximum number after many queries that took all they were allowed.
const FEWEST: u32 = MOST / 64;
/// If this many of the shortest pieces contain no jump, the function turns faster than floating-point
/// times resolve: finding a jump takes about forty evaluations.
const NOISE: u32 = MOST / 4;

/// A time at which a function of time changes its behaviour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Feature {
    pub(crate) t: f64,
    /// Index of the function among those watched.
    pub(crate) function: usize,
    pub(crate) kind: Kind,
}

/// The kinds of change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Kind {
    /// A jump or a corner, at the resolution of the scan.
    Sharp,
    /// A local extremum.
    Turn,
    /// An inflection; at its rate there, the function would cross its range in this time.
    Bend(f64),
    /// A rise or fall, perhaps with an inflection; at its steepest, the function would cross its range in
    /// this time.
    Rise(f64),
    /// A possible extremum or inflection.
    Unsure,
}

impl Kind {
    /// The kind, if rises do not count as features.
    fn without_rises(self) -> Kind {
        if let Kind::Rise(_) = self { Kind::Unsure } else { self }
    }
}

/// What is known about one function so far.
#[derive(Clone, Debug)]
struct Track {
    /// The finite values of the function over the window, and how much it varies there.
    values: Option<Interval>,
    range: f64,
    rate: Sign,
    bend: Sign,
    /// The rate over the last piece.
    last_rate: Interval,
    /// The values at the last feature, and at the end of the last piece.
    at_feature: Option<f64>,
    at_end: f64,
    /// The end of the last piece that was too short to be halved.
    sharp: Option<f64>,
}

/// The last nonzero sign of a derivative, and the time up to which the sign is known.
#[derive(Clone, Copy, Debug)]
struct Sign {
    sign: i8,
    until: f64,
}

impl Sign {
    /// Records a sign from `a` to `b`. Returns where it changed, if the last one was opposite, and whether
    /// that is exactly at `a`.
    fn pass(&mut self, (a, b): (f64, f64), sign: Option<i8>) -> Option<(f64, bool)> {
        let sign = sign?;
        let changed = sign != 0 && self.sign == -sign;
        let place = changed.then_some((self.until + 0.5 * (a - self.until), self.until == a));
        if sign != 0 {
            self.sign = sign;
        }
        self.until = b;
        place
    }
}

/// The features of watched functions along a window, found as far as queried. The buffers of a scan are
/// reused for later windows, since each step has its own window.
#[derive(Clone, Debug)]
pub(crate) struct Scan {
    /// The time from which features are kept.
    from: f64,
    end: f64,
    shortest: f64,
    /// Pieces yet to be examined, the next one last; each in the direction of travel.
    pieces: Vec<(f64, f64)>,
    tracks: Vec<Track>,
    features: VecDeque<Feature>,
    /// The watched functions over a piece.
    jets: Vec<Jet>,
    /// Whether a function turns faster than floating-point times resolve; the window is then no longer
    /// examined closely.
    noise: bool,
    /// The evaluations that a query may take, and how many the last one left.
    allowed: u32,
    left: u32,
}

impl Scan {
    /// A scan without a window.
    pub(crate) fn new() -> Scan {
        Scan {
            from: f64::NAN,
            end: f64::NAN,
            shortest: f64::NAN,
            pieces: Vec::new(),
            tracks: Vec::new(),
            features: VecDeque::new(),
            jets: Vec::new(),
            noise: false,
            allowed: MOST,
            left: MOST,
        }
    }

    /// Begins a window.
    pub(crate) fn begin(
        &mut self,
        part: &mut Part,
        start: f64,
        end: f64,
        along: (PolynomialMotion<'_>, usize),
    ) {
        let track = Track {
            values: None,
            range: 0.0,
            rate: Sign { sign: 0, until: start },
            bend: Sign { sign: 0, until: start },
            last_rate: Interval::ALL,
            at_feature: None,
            at_end: 0.0,
            sharp: None,
        };
        self.tracks.clear();
        self.tracks.resize(part.watched.len(), track);
        let at = |i: u32| start + (end - start) * (f64::from(i) / f64::from(PIECES));
        self.pieces.clear();
        self.pieces.extend((0..PIECES).rev().map(|i| (at(i), at(i + 1))));
        for &piece in self.pieces.iter().rev() {
            for (track, jet) in self.tracks.iter_mut().zip(part.over(piece, along)) {
                if jet.value.width().is_finite() {
                    track.values = Some(track.values.map_or(jet.value, |values| values.hull(jet.value)));
                }
            }
        }
        for track in &mut self.tracks {
            track.range = track.values.map_or(0.0, Interval::width);
        }
        (self.from, self.end) = (start, end);
        self.shortest = (SHORTEST * (end - start).abs())
            .max(8.0 * f64::EPSILON * start.abs().max(end.abs()))
            .max(f64::MIN_POSITIVE);
        self.features.clear();
        self.noise = false;
    }

    /// Whether a function is known to turn faster than floating-point times resolve.
    pub(crate) fn is_noise(&self) -> bool {
        self.noise
    }

    /// Whether the last query took all the evaluations that it was allowed.
    pub(crate) fn is_exhausted(&self) -> bool {
        self.left == 0
    }

    /// Lets later queries take half as many evaluations if this one was too much, and more again if it was not. Each
    /// step of a motion that goes wild, as with tolerances that allow anything, would take all of them.
    pub(crate) fn adapt(&mut self, too_much: bool) {
        self.allowed = if too_much { self.allowed / 2 } else { 2 * self.allowed }.clamp(FEWEST, MOST);
    }

    /// Whether the interval lies ahead in the window.
    pub(crate) fn covers(&self, t: f64, to: f64) -> bool {
        let direction = if self.end < self.from { -1.0 } else { 1.0 };
        (t - self.from) * direction >= 0.0
            && (to - t) * direction >= 0.0
            && (self.end - to) * direction >= 0.0
    }

    /// Forgets the features up to `t` and finds those up to `to`, or as far as the allowed evaluations reach;
    /// with `enough`, pieces beyond that are no longer halved. Returns the time up to which features are
    /// known.
    pub(crate) fn between(
        &mut self,
        part: &mut Part,
        (t, to): (f64, f64),
        along: (PolynomialMotion<'_>, usize),
        enough: bool,
    ) -> (f64, &VecDeque<Feature>) {
        let direction = if to < t { -1.0 } else { 1.0 };
        self.from = t;
        self.features.retain(|feature| (feature.t - t) * direction > 0.0);
        let enough = enough || self.noise;
        self.left = if self.noise { 0 } else { self.allowed };
        let mut sharp = 0;
        while let Some(&(a, b)) = self.pieces.last() {
            // A sign that is still unknown may reveal an earlier change.
            let open = self.tracks.iter().any(|track| track.is_open(a));
            if (a - to) * direction > 0.0 && (!open || self.left == 0) {
                break;
            }
            if self.left == 0 && !enough {
                return (a, &self.features);
            }
            self.pieces.pop();
            let middle = a + 0.5 * (b - a);
            let indivisible = (b - a).abs() <= self.shortest;
            let shortest = indivisible || self.left == 0;
            self.left = self.left.saturating_sub(1);
            let tracks = &mut self.tracks;
            let jets = &mut self.jets;
            jets.clear();
            jets.extend(part.over((a, b), along));
            let plain = tracks.iter().zip(&*jets).all(|(track, jet)| track.is_plain(jet));
            if !shortest && !plain {
                self.pieces.extend([(middle, b), (a, middle)]);
                continue;
            }
            sharp += u32::from(indivisible && !plain);
            self.noise |= sharp >= NOISE;
            for (function, (track, jet)) in tracks.iter_mut().zip(&*jets).enumerate() {
                let shows_rises = part.shows_rises;
                track.pass((a, b), jet, shortest, |t, kind| {
                    let kind = if shows_rises { kind } else { kind.without_rises() };
                    self.features.push_back(Feature { t, function, kind });
                });
            }
        }
        (to, &self.features)
    }
}

impl Track {
    /// Whether a sign is unknown up to a time, so that a later sign may reveal an earlier change; signs up to
    /// a sharp feature are settled.
    fn is_open(&self, place: f64) -> bool {
        self.sharp != Some(place) && (self.rate.until != place || self.bend.until != place)
    }

    /// Whether a piece needs no closer examination.
    fn is_plain(&self, jet: &Jet) -> bool {
        // Also one that is infinite throughout.
        if jet.value.is_point() {
            return true;
        }
        let known = (jet.rate.sign().is_some(), jet.bend.sign().is_some());
        let part = match known {
            (true, true) => return true,
            (false, false) => FLAT,
            _ => TURN,
        };
        jet.value.width() <= (part * self.range).max(ROUNDING * jet.value.size())
    }

    /// Records a piece.
    fn pass(&mut self, (a, b): (f64, f64), jet: &Jet, shortest: bool, mut found: impl FnMut(f64, Kind)) {
        if shortest && !self.is_plain(jet) {
            self.sharp = Some(b);
            found(b, Kind::Sharp);
        }
        let Interval { lo, hi } = jet.value;
        let (first, last) = match jet.rate.sign() {
            Some(sign) if sign < 0 => (hi, lo),
            Some(_) => (lo, hi),
            None => (0.5 * (lo + hi), 0.5 * (lo + hi)),
        };
        let swing = (self.at_end - *self.at_feature.get_or_insert(first)).abs();
        let matters = swing.is_nan() || swing >= SWING * self.range;
        if let Some((t, at_once)) = self.rate.pass((a, b), jet.rate.sign())
            && matters
        {
            self.at_feature = Some(self.at_end);
            let smooth = |rate: Interval| rate.lo == 0.0 || rate.hi == 0.0;
            let smooth = !at_once || smooth(self.last_rate) && smooth(jet.rate);
            found(t, if smooth { Kind::Turn } else { Kind::Sharp });
        }
        if let Some((t, _)) = self.bend.pass((a, b), jet.bend.sign())
            && matters
        {
            self.at_feature = Some(self.at_end);
            let rate = self.last_rate.size().max(jet.rate.size());
            found(t, Kind::Bend(self.range / rate));
        }
        if jet.bend.sign().is_none() {
            let (middle, part) = (a + 0.5 * (b - a), jet.value.width() / self.range);
            let rises = jet.rate.sign().is_some() && part >= RISE;
            found(middle, if rises { Kind::Rise((b - a).abs() / part) } else { Kind::Unsure });
        }
        self.last_rate = jet.rate;
        self.at_end = last;
    }
}
