//! Search for the first passage of a function through zero along a step.

use pc_expr::Direction;

use crate::events::breaks::{Break, breaks};
use crate::events::closer::look_closer;
use crate::events::edges::{approach, edge};
use crate::events::samples::{Look, SAME, Sample};

/// A passage is bracketed by two times whose relative difference is at most this.
const LOCATED: f64 = 4.0 * f64::EPSILON;
/// A function that has no value inside an interval of at most this many times that width is taken
/// to have a pole there.
const NARROW: f64 = 64.0;

/// The side of zero on which each function is.
#[derive(Debug)]
pub(crate) struct Sides {
    directions: Vec<Direction>,
    /// The sides: 1, −1, or 0 while a function is at zero.
    sides: Vec<f64>,
    /// The magnitude that a function at zero must exceed to count as having left zero.
    noise: Vec<f64>,
}

impl Clone for Sides {
    fn clone(&self) -> Sides {
        let Sides { directions, sides, noise } = self;
        Sides { directions: directions.clone(), sides: sides.clone(), noise: noise.clone() }
    }

    fn clone_from(&mut self, other: &Sides) {
        self.directions.clone_from(&other.directions);
        self.sides.clone_from(&other.sides);
        self.noise.clone_from(&other.noise);
    }
}

/// The result of a search along a step.
pub(crate) enum Passage {
    /// No event occurs up to this sample.
    Clear(Sample),
    /// Some functions pass through zero in their directions.
    Crossing(Crossing),
}

/// Functions that pass through zero simultaneously.
pub(crate) struct Crossing {
    /// Just after the first passage.
    pub(crate) at: Sample,
    /// The indices of these functions, in ascending order.
    pub(crate) events: Vec<usize>,
    /// The magnitude above which each function counts as different from zero there.
    pub(crate) noise: Vec<f64>,
    /// The side of each of these functions just afterwards; 0 where the function stays at zero.
    pub(crate) beyond: Vec<f64>,
}

/// The result of locating a passage.
enum Located {
    Crossing(Crossing),
    /// No event occurs up to this sample: the functions are back on their sides, or have passed
    /// poles.
    Clear(Sample),
}

/// A function that touches zero more often than this within one step is taken to pass through it.
const MOST_TOUCHES: u32 = 32;

/// Fractions of a step at which a function that starts at zero is sampled until it has left zero.
const EARLY: [f64; 4] = [1e-12, 1e-9, 1e-6, 1e-3];

impl Sides {
    /// The sides, not yet known, of functions with these event directions.
    pub(crate) fn new(directions: Vec<Direction>) -> Sides {
        let n = directions.len();
        Sides { directions, sides: vec![0.0; n], noise: vec![0.0; n] }
    }

    /// The side of each function, and the magnitude that it must exceed to count as having left
    /// zero.
    pub(crate) fn known(&self) -> impl Iterator<Item = (f64, f64)> {
        self.sides.iter().copied().zip(self.noise.iter().copied())
    }

    /// Restores the sides from what [`known`](Sides::known) returns.
    pub(crate) fn from_known(
        directions: Vec<Direction>,
        known: impl IntoIterator<Item = (f64, f64)>,
    ) -> Sides {
        let (sides, noise) = known.into_iter().unzip();
        Sides { directions, sides, noise }
    }

    /// Notes that the functions `events` are at zero, where they have just been located: until a
    /// reset moves them away from zero by more than `noise`, they are on neither side. Functions
    /// whose `noise` is 0 have jumped to the sides `beyond`.
    pub(crate) fn arrive(&mut self, events: &[usize], noise: &[f64], beyond: &[f64]) {
        for (&i, &side) in events.iter().zip(beyond) {
            self.sides[i] = if noise[i] > 0.0 { 0.0 } else { side };
            self.noise[i] = noise[i];
        }
    }

    /// The indices, in ascending order, of the functions that a jump of the state to these values
    /// carries from their sides to zero or through zero, in their directions.
    pub(crate) fn carried(&self, values: &[f64]) -> Vec<usize> {
        (0..values.len()).filter(|&i| self.crossed(i, values[i])).collect()
    }

    /// 1, −1, or 0 while the function is at zero.
    pub(crate) fn side(&self, i: usize) -> f64 {
        self.sides[i]
    }

    /// Sets the sides after a jump of the state. Functions within `noise` of zero take the side to
    /// which they move.
    pub(crate) fn jump(&mut self, values: &[f64], noise: Vec<f64>) {
        self.sides.fill(0.0);
        self.noise = noise;
        self.pass(values);
    }

    /// Notes that the functions `events` have passed through zero at `values`, to the sides
    /// `beyond`; the functions must exceed `noise` to pass again.
    pub(crate) fn cross(&mut self, events: &[usize], values: &[f64], noise: &[f64], beyond: &[f64]) {
        for (&i, &side) in events.iter().zip(beyond) {
            self.sides[i] = side;
            self.noise[i] = noise[i];
        }
        self.pass(values);
    }

    /// Sets the side of a function, and the magnitude that it must exceed beyond zero to have passed through it.
    pub(crate) fn set(&mut self, i: usize, side: f64, noise: f64) {
        (self.sides[i], self.noise[i]) = (side, noise);
    }

    fn crossed(&self, i: usize, value: f64) -> bool {
        let (side, noise) = (self.sides[i], self.noise[i]);
        let through = if noise == 0.0 { value * side <= 0.0 } else { value * side < -noise };
        through && self.directions[i].leaves(side)
    }

    fn any_crossed(&self, values: &[f64]) -> bool {
        values.iter().enumerate().any(|(i, &value)| self.crossed(i, value))
    }

    /// Notes the values at a time up to which no event has occurred.
    pub(crate) fn pass(&mut self, values: &[f64]) {
        values.iter().enumerate().for_each(|(i, &value)| self.pass_one(i, value));
    }

    fn pass_one(&mut self, i: usize, value: f64) {
        if value.abs() > self.noise[i] {
            self.sides[i] = 1.0_f64.copysign(value);
            self.noise[i] = 0.0;
        }
    }

    /// Searches for the first passage after `from`.
    ///
    /// The functions are sampled at `times`, the last of which ends the search, and near `from`
    /// while one of them is at zero. If the times do not separate the roots, the functions are also
    /// sampled [where there is doubt](look_closer). The vertex of a parabola through three
    /// successive values is sampled where it suggests that a function passes through zero twice.
    pub(crate) fn first<E, F: FnMut(f64, &mut [f64]) -> Result<(), E>>(
        &mut self,
        from: Sample,
        times: &[f64],
        look: &mut Look<'_, F>,
    ) -> Result<Passage, E> {
        let to = times.last().copied().unwrap_or(from.t);
        if self.sides.is_empty() {
            return Ok(Passage::Clear(Sample { t: to, ..from }));
        }
        let mut left = from;
        look.room.begin(&left);
        if let Some(crossing) = self.leave(&mut left, to, look)? {
            look.room.take_back(left);
            return Ok(Passage::Crossing(crossing));
        }
        // Functions may be undefined beyond a passage: an error counts only if there is none.
        let (mut samples, mut fault) = (std::mem::take(&mut look.room.samples), None);
        samples.clear();
        let length = to - left.t;
        for &t in times.iter().filter(|&&t| t == to || (t - left.t) * length > 0.0) {
            match look.at(t) {
                Ok(next) => samples.push(next),
                Err(error) => {
                    fault = approach(&left, &mut samples, (t, error), to, look);
                    if fault.is_some() {
                        break;
                    }
                }
            }
        }
        if !look.separated
            && let Some(failed) = look_closer(&left, &mut samples, look)
        {
            fault = Some(edge(&left, &mut samples, failed, look));
        }
        let mut hidden = Vec::new();
        for k in 1..samples.len() {
            let before = if k == 1 { &left } else { &samples[k - 2] };
            hidden.extend(self.hidden([before, &samples[k - 1], &samples[k]], look));
        }
        if !hidden.is_empty() {
            samples.extend(hidden);
            samples.sort_by(|a, b| ((a.t - b.t) * length).total_cmp(&0.0));
        }
        look.room.measure(&samples);
        let mut crossing = None;
        for right in samples.drain(..) {
            match crossing {
                None => crossing = self.between(&mut left, right, look)?,
                Some(_) => look.room.take_back(right),
            }
        }
        look.room.samples = samples;
        match (crossing, fault) {
            (Some(crossing), _) => {
                look.room.take_back(left);
                Ok(Passage::Crossing(crossing))
            }
            (None, Some(error)) => Err(error),
            (None, None) => Ok(Passage::Clear(left)),
        }
    }

    /// Moves `left` forward until no function is at zero, but at most by a small fraction of the
    /// way to `to`.
    fn leave<E, F: FnMut(f64, &mut [f64]) -> Result<(), E>>(
        &mut self,
        left: &mut Sample,
        to: f64,
        look: &mut Look<'_, F>,
    ) -> Result<Option<Crossing>, E> {
        if !self.sides.contains(&0.0) {
            return Ok(None);
        }
        let (start, length) = (look.copy(left), to - left.t);
        for part in EARLY {
            if !self.sides.contains(&0.0) {
                return Ok(None);
            }
            let t = start.t + part * length;
            if (t - left.t) * length <= 0.0 {
                continue; // there is no time between
            }
            let early = look.at(t)?;
            if let Some(crossing) = self.between(left, early, look)? {
                return Ok(Some(crossing));
            }
        }
        for (i, side) in
            self.sides.iter_mut().enumerate().filter(|(i, side)| **side == 0.0 && self.noise[*i] > 0.0)
        {
            let moved = left.values[i] - start.values[i];
            if moved != 0.0 {
                *side = 1.0_f64.copysign(moved);
            }
        }
        look.room.take_back(start);
        Ok(None)
    }

    /// Moves `left` to `right` unless there is a passage in between.
    fn between<E, F: FnMut(f64, &mut [f64]) -> Result<(), E>>(
        &mut self,
        left: &mut Sample,
        right: Sample,
        look: &mut Look<'_, F>,
    ) -> Result<Option<Crossing>, E> {
        let mut touches = 0;
        while self.any_crossed(&right.values) {
            let (located, poles) =
                self.locate(look.copy(left), look.copy(&right), touches < MOST_TOUCHES, look)?;
            for (pole, side) in poles {
                (self.sides[pole], self.noise[pole]) = (side, 0.0);
            }
            match located {
                Located::Crossing(crossing) => {
                    look.room.take_back(right);
                    return Ok(Some(crossing));
                }
                Located::Clear(after) if (right.t - after.t) * (right.t - left.t) > 0.0 => {
                    look.room.take_back(std::mem::replace(left, after));
                }
                // It touches, or has its pole, at `right`.
                Located::Clear(_) => break,
            }
            touches += 1;
        }
        // A function that touches zero at `right` keeps its side.
        for (i, &value) in right.values.iter().enumerate() {
            let value = if self.crossed(i, value) { 0.0 } else { value };
            self.pass_one(i, value);
        }
        look.room.take_back(std::mem::replace(left, right));
        Ok(None)
    }

    /// Looks for a sample beyond zero of a function that has the same sign at all three given
    /// samples.
    fn hidden<E, F: FnMut(f64, &mut [f64]) -> Result<(), E>>(
        &self,
        three: [&Sample; 3],
        look: &mut Look<'_, F>,
    ) -> Vec<Sample> {
        let mut found = Vec::new();
        for i in 0..self.sides.len() {
            let side = self.sides[i];
            let mut points = three.map(|sample| (sample.t, sample.values[i] * side));
            if self.noise[i] > 0.0 {
                points[0].1 = points[0].1.max(0.0); // it has just passed through zero
            }
            if side == 0.0 || points[0].1 < 0.0 || points[1..].iter().any(|&(_, u)| u <= 0.0) {
                continue;
            }
            while let Some((t, predicted)) = vertex(points) {
                let least = points.iter().map(|&(_, u)| u).fold(f64::INFINITY, f64::min);
                if predicted > 0.25 * least {
                    break;
                }
                // A function without a value there is not beyond zero.
                let Ok(lowest) = look.at(t) else { break };
                let u = lowest.values[i] * side;
                if u < 0.0 {
                    found.push(lowest);
                    break;
                }
                if u > 0.5 * least {
                    break;
                }
                let [a, b, c] = points;
                points = if (t - a.0) / (c.0 - a.0) < (b.0 - a.0) / (c.0 - a.0) {
                    [a, (t, u), b]
                } else {
                    [b, (t, u), c]
                };
            }
        }
        found
    }

    /// Locates the first passage, touch or pole, which lies between `a` and `b`, by the Illinois
    /// method with the earliest zero of the functions' secants, and by bisection where that method
    /// is slow. Also returns the functions that change sign there at a pole, with their sides
    /// beyond the pole.
    fn locate<E, F: FnMut(f64, &mut [f64]) -> Result<(), E>>(
        &self,
        mut a: Sample,
        mut b: Sample,
        touches: bool,
        look: &mut Look<'_, F>,
    ) -> Result<(Located, Vec<(usize, f64)>), E> {
        let scale = a.t.abs().max(b.t.abs()).max(1e-3 * (b.t - a.t).abs());
        let tolerance = LOCATED * scale;
        let mut sides = self.clone();
        let (mut weight_a, mut weight_b, mut b_moved) = (1.0, 1.0, None);
        let (mut goal, mut tries) = ((b.t - a.t).abs() / 8.0, 0);
        loop {
            let width = b.t - a.t;
            if width.abs() <= tolerance {
                break;
            }
            if width.abs() <= goal {
                (goal, tries) = (width.abs() / 8.0, 0);
            }
            tries += 1;
            let fraction = if tries > 4 {
                0.5
            } else {
                let crossed = (0..sides.sides.len()).filter(|&i| sides.crossed(i, b.values[i]));
                let secant = |i: usize| {
                    let (before, after) = (weight_a * a.values[i], weight_b * b.values[i]);
                    before / (before - after)
                };
                crossed.map(secant).fold(1.0, f64::min)
            };
            let edge = 0.5 * tolerance / width.abs();
            let (from, to) = (a.t, b.t);
            let place = |fraction: f64| from + fraction.clamp(edge, 1.0 - edge) * (to - from);
            let middle = match look.at(place(fraction)) {
                Ok(middle) => middle,
                Err(error) => match beside(fraction).into_iter().find_map(|part| look.at(place(part)).ok()) {
                    Some(middle) => middle,
                    None if width.abs() <= NARROW * tolerance => break, // a pole that is met exactly
                    None => {
                        let (before, error) = self.before_edge(&a, (place(fraction), error), look);
                        b = before.ok_or(error)?;
                        continue;
                    }
                },
            };
            if middle.t == a.t || middle.t == b.t {
                look.room.take_back(middle);
                break; // there is no time between
            }
            let moves_b = sides.any_crossed(&middle.values);
            let repeated = if b_moved == Some(moves_b) { 0.5 } else { 1.0 };
            if moves_b {
                (weight_a, weight_b) = (if repeated < 1.0 { 0.5 * weight_a } else { 1.0 }, 1.0);
                look.room.take_back(std::mem::replace(&mut b, middle));
            } else {
                (weight_a, weight_b) = (1.0, if repeated < 1.0 { 0.5 * weight_b } else { 1.0 });
                sides.pass(&middle.values); // a function that has left zero is no longer compared with noise
                look.room.take_back(std::mem::replace(&mut a, middle));
            }
            b_moved = Some(moves_b);
        }
        // A function may have no value beyond its zero.
        let after = look.at(b.t + (SAME * scale).copysign(b.t - a.t));
        let after = after.unwrap_or_else(|_| look.copy(&b));
        let seen = |i: usize| sides.crossed(i, b.values[i]) || sides.crossed(i, after.values[i]);
        let is_back = |i: usize| after.values[i] * sides.sides[i] > sides.noise[i];
        let passing: Vec<usize> =
            (0..self.sides.len()).filter(|&i| seen(i) && !(touches && is_back(i))).collect();
        let breaks = if passing.is_empty() {
            vec![Break::None; self.sides.len()]
        } else {
            breaks(&a, &after, SAME * scale, look)
        };
        let side = |i: usize| if after.values[i] == 0.0 { 0.0 } else { 1.0_f64.copysign(after.values[i]) };
        let (poles, events): (Vec<usize>, Vec<usize>) =
            passing.into_iter().partition(|&i| breaks[i] == Break::Pole);
        let poles: Vec<(usize, f64)> = poles.into_iter().map(|i| (i, side(i))).collect();
        if events.is_empty() {
            [a, b].into_iter().for_each(|sample| look.room.take_back(sample));
            return Ok((Located::Clear(after), poles));
        }
        let noise = (0..self.sides.len()).map(|i| {
            let near = [&a, &b, &after].map(|sample| sample.values[i].abs());
            let rounding = 16.0 * near.into_iter().fold(0.0, f64::max);
            // A function that jumps is on its other side at once.
            if events.contains(&i) && breaks[i] == Break::None { rounding } else { 0.0 }
        });
        let noise: Vec<f64> = noise.collect();
        let beyond = events.iter().map(|&i| side(i)).collect();
        // Where all that jump have done so.
        let jumps_later = |i: &usize| breaks[*i] == Break::Jump && !sides.crossed(*i, b.values[*i]);
        let later = events.iter().any(jumps_later) || !poles.is_empty();
        let (at, other) = if later { (after, b) } else { (b, after) };
        [a, other].into_iter().for_each(|sample| look.room.take_back(sample));
        Ok((Located::Crossing(Crossing { at, events, noise, beyond }), poles))
    }

    /// The first sample at which a function has passed through zero before the functions fail at the
    /// time `failed`, if there is one; and the failure nearest to `a`.
    fn before_edge<E, F: FnMut(f64, &mut [f64]) -> Result<(), E>>(
        &self,
        a: &Sample,
        failed: (f64, E),
        look: &mut Look<'_, F>,
    ) -> (Option<Sample>, E) {
        let mut samples = Vec::new();
        let failure = edge(a, &mut samples, failed, look);
        (samples.into_iter().find(|sample| self.any_crossed(&sample.values)), failure)
    }
}

/// Fractions of an interval to try if functions have no value at the usual one.
fn beside(fraction: f64) -> [f64; 2] {
    [0.75 * fraction, 0.25 + 0.75 * fraction]
}

/// The lowest point of the parabola through three points in order, if it lies between the outer
/// ones.
fn vertex([(t0, u0), (t1, u1), (t2, u2)]: [(f64, f64); 3]) -> Option<(f64, f64)> {
    let slope = (u1 - u0) / (t1 - t0);
    let bend = ((u2 - u1) / (t2 - t1) - slope) / (t2 - t0);
    if bend <= 0.0 {
        return None;
    }
    let t = 0.5 * (t0 + t1) - 0.5 * slope / bend;
    let inside = (t - t0) / (t2 - t0);
    (inside > 0.0 && inside < 1.0).then_some((t, u0 + (t - t0) * (slope + bend * (t - t1))))
}
