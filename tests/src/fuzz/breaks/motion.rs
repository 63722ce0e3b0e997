//! The motion of a specimen, from one surface to the next.

use super::extrapolation::{Step, step};
use super::field::{At, Field};
use super::filippov::{combined, decide};
use super::skip::Skip;
use super::specimen::Table;

/// A function of this size is zero: rounding.
const ZERO: f64 = 1e-11;
/// The longest step, a part of the fastest thing that a specimen does by itself.
const LONGEST: f64 = 0.25;
/// The first step from a surface.
const FIRST: f64 = 0.01;
/// Shorter steps come to nothing.
const SHORTEST: f64 = 1e-9;
/// A function is looked at so often in a step.
const LOOKS: usize = 16;
/// What has a smallest value below this part of its changes in a step may touch zero there.
const NEAR: f64 = 0.03;
/// So many passages are followed.
const MOST: usize = 100;
/// A motion that goes farther has lost its digits.
const FAR: f64 = 1e4;

/// Sides that the motion has from a time on, 0 for surfaces that it keeps to.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Passage {
    pub(super) time: f64,
    pub(super) sides: Vec<f64>,
}

/// A motion by its rows and passages.
#[derive(Clone, Debug, Default)]
pub(super) struct Motion {
    pub(super) rows: Vec<Vec<f64>>,
    /// How many passages each row has before it.
    pub(super) passed: Vec<usize>,
    pub(super) passages: Vec<Passage>,
}

/// Follows the motion from y at the first of the times through all of them.
pub(super) fn follow(field: &Field, tables: &[Table], start: &[f64], times: &[f64]) -> Result<Motion, Skip> {
    let (first, last) = (times[0], times[times.len() - 1]);
    let inner = |&t: &f64| first < t && t < last;
    let breaks: Vec<f64> = tables.iter().flat_map(|table| &table.times).copied().filter(inner).collect();
    let mut stops: Vec<f64> = breaks.iter().chain(times).copied().collect();
    stops.sort_by(f64::total_cmp);
    stops.dedup();
    let mut run = Run {
        field,
        tables,
        t: first,
        y: start.to_vec(),
        segment: first,
        sides: vec![1.0; field.surfaces.len()],
        fresh: vec![true; field.surfaces.len()],
        length: FIRST,
        motion: Motion::default(),
    };
    for (i, &stop) in stops.iter().enumerate() {
        while run.t < stop {
            run.advance(stop)?;
        }
        if times.contains(&stop) {
            run.motion.rows.push(run.y.clone());
            run.motion.passed.push(run.motion.passages.len());
        }
        if let Some(next) = stops.get(i + 1) {
            run.segment = 0.5 * (stop + next);
            if i == 0 || breaks.contains(&stop) {
                run.begin_anew(i == 0)?;
            }
        }
    }
    Ok(run.motion)
}

struct Run<'a> {
    field: &'a Field,
    tables: &'a [Table],
    t: f64,
    y: Vec<f64>,
    /// A time between the same breaks of all tables.
    segment: f64,
    sides: Vec<f64>,
    /// Surfaces that the motion has just left.
    fresh: Vec<bool>,
    length: f64,
    motion: Motion,
}

/// What is positive until a surface is reached, or lets go.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Watch {
    /// The function of a surface on a side of it.
    Reaches(usize),
    /// 1 - s σ of a surface that is kept.
    LetsGo(usize, f64),
}

impl Watch {
    fn surface(self) -> usize {
        match self {
            Watch::Reaches(k) | Watch::LetsGo(k, _) => k,
        }
    }
}

/// What is seen in a step.
enum Seen {
    Nothing,
    /// Something that a shorter step may tell.
    Doubt,
    /// A passage between two parts of the step.
    Passage(Watch, [f64; 2]),
}

/// Value and rate of each table at a time, on the lines that it has at another.
fn inputs(tables: &[Table], segment: f64, t: f64) -> Vec<[f64; 2]> {
    let of = |Table { times, values, holds, .. }: &Table| {
        let i = times.partition_point(|&time| time <= segment).saturating_sub(1);
        if *holds || i + 1 == times.len() {
            return [values[i], 0.0];
        }
        let rate = (values[i + 1] - values[i]) / (times[i + 1] - times[i]);
        [values[i] + rate * (t - times[i]), rate]
    };
    tables.iter().map(of).collect()
}

impl Run<'_> {
    fn with<R>(&self, tau: f64, y: &[f64], what: impl FnOnce(At<'_>) -> R) -> R {
        let t = self.t + tau;
        what(At { t, y, inputs: &inputs(self.tables, self.segment, t) })
    }

    /// The sides by the signs of all functions, at the start or after a break of a table: where a function has not jumped away from
    /// its surface, the motion is on it as before.
    fn begin_anew(&mut self, is_start: bool) -> Result<(), Skip> {
        let mut reached = Vec::new();
        let before = self.sides.clone();
        for k in self.field.watched.clone() {
            let g = self.with(0.0, &self.y, |at| self.field.function(k, at, &self.sides));
            if g.abs() > ZERO {
                self.sides[k] = g.signum();
            } else if is_start || before[k] == 0.0 {
                reached.push(k);
            } else {
                return Err(Skip::Together);
            }
        }
        self.sides = self.with(0.0, &self.y, |at| decide(self.field, at, &self.sides, &reached))?;
        self.note(&reached, is_start || self.sides != before);
        Ok(())
    }

    fn note(&mut self, reached: &[usize], changed: bool) {
        self.fresh.fill(false);
        reached.iter().for_each(|&k| self.fresh[k] = true);
        self.length = FIRST;
        if changed {
            self.motion.passages.push(Passage { time: self.t, sides: self.sides.clone() });
        }
    }

    /// A step towards a stop, or to the surface that is reached in it.
    fn advance(&mut self, stop: f64) -> Result<(), Skip> {
        let rest = stop - self.t;
        // No last step of hardly any length.
        let length = if self.length > 0.6 * rest {
            if self.length >= rest { rest } else { 0.6 * rest }
        } else {
            self.length
        };
        if length < SHORTEST * self.t.abs().max(1.0) && length < rest {
            return Err(Skip::Lost);
        }
        let taken = self.step(length)?;
        if taken.error > 1.0 {
            self.length = taken.better_length().min(0.5 * length);
            return Ok(());
        }
        match self.look(&taken)? {
            Seen::Nothing => {
                self.length = taken.better_length().min(LONGEST);
                self.t = if length == rest { stop } else { self.t + length };
                self.y = taken.end;
                self.fresh.fill(false);
                let size = self.y.iter().fold(0.0, |size: f64, y| size.max(y.abs()));
                if size > FAR { Err(Skip::Lost) } else { Ok(()) }
            }
            Seen::Doubt if length < 1e-5 => Err(Skip::Grazes),
            Seen::Doubt => {
                self.length = 0.4 * length;
                Ok(())
            }
            Seen::Passage(watch, bracket) => self.pass(watch, bracket.map(|theta| theta * length)),
        }
    }

    fn step(&self, length: f64) -> Result<Step, Skip> {
        let rates = |tau: f64, y: &[f64]| {
            self.with(tau, y, |at| combined(self.field, at, &self.sides)).map(|(rates, _)| rates)
        };
        step(rates, &self.y, length)
    }

    fn watches(&self) -> Vec<Watch> {
        let of = |&k: &usize| match self.sides[k] {
            0.0 => vec![Watch::LetsGo(k, 1.0), Watch::LetsGo(k, -1.0)],
            _ => vec![Watch::Reaches(k)],
        };
        self.field.watched.iter().flat_map(of).collect()
    }

    fn value(&self, watch: Watch, tau: f64, y: &[f64]) -> Result<f64, Skip> {
        self.with(tau, y, |at| {
            let (_, all) = combined(self.field, at, &self.sides)?;
            Ok(match watch {
                Watch::Reaches(k) => self.sides[k] * self.field.function(k, at, &all),
                Watch::LetsGo(k, side) => 1.0 - side * all[k],
            })
        })
    }

    /// The first passage in a step, by its polynomial.
    fn look(&self, taken: &Step) -> Result<Seen, Skip> {
        let theta = |i: usize| i as f64 / LOOKS as f64;
        let states: Vec<Vec<f64>> = (0..=LOOKS).map(|i| taken.within(theta(i))).collect();
        let mut first: Option<(usize, Watch)> = None;
        for watch in self.watches() {
            let value = |i: usize| self.value(watch, theta(i) * taken.length, &states[i]);
            let values = (0..=LOOKS).map(value).collect::<Result<Vec<f64>, Skip>>()?;
            let fresh = self.fresh[watch.surface()] && matches!(watch, Watch::Reaches(_));
            let passage = (1..=LOOKS).find(|&i| values[i] <= 0.0);
            if passage == Some(1) && fresh {
                return Ok(Seen::Doubt);
            }
            let (least, most) = values
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), &v| (least.min(v), most.max(v)));
            let inner = 1..passage.unwrap_or(LOOKS);
            let touches = |i: usize| {
                values[i] < values[i - 1] && values[i] <= values[i + 1] && values[i] < NEAR * (most - least)
            };
            if values.iter().any(|value| value.is_nan()) || inner.into_iter().any(touches) {
                return Ok(Seen::Doubt);
            }
            match (passage, first) {
                (Some(i), Some((j, _))) if i == j => {
                    return Ok(if taken.length < 1e-5 { return Err(Skip::Together) } else { Seen::Doubt });
                }
                (Some(i), Some((j, _))) if i > j => {}
                (Some(i), _) => first = Some((i, watch)),
                (None, _) => {}
            }
        }
        Ok(first.map_or(Seen::Nothing, |(i, watch)| Seen::Passage(watch, [theta(i - 1), theta(i)])))
    }

    /// Steps to where a watch vanishes, and decides there.
    fn pass(&mut self, watch: Watch, bracket: [f64; 2]) -> Result<(), Skip> {
        let tau = self.root(watch, bracket)?;
        if tau > 0.0 {
            self.y = self.step(tau)?.end;
            self.t += tau;
        }
        let kept = (0..self.sides.len()).filter(|&k| self.sides[k] == 0.0);
        let (reached, sides) = match watch {
            Watch::Reaches(k) => {
                let reached: Vec<usize> = kept.chain([k]).collect();
                let sides = self.with(0.0, &self.y, |at| decide(self.field, at, &self.sides, &reached))?;
                (reached, sides)
            }
            Watch::LetsGo(k, side) => {
                let mut sides = self.sides.clone();
                sides[k] = side;
                (vec![k], sides)
            }
        };
        self.sides = sides;
        self.note(&reached, true);
        if self.motion.passages.len() > MOST { Err(Skip::Many) } else { Ok(()) }
    }

    /// Where a watch vanishes, by false positions, with steps to each place; the ends of the bracket are those of a polynomial.
    fn root(&self, watch: Watch, [mut a, mut b]: [f64; 2]) -> Result<f64, Skip> {
        let value = |tau: f64| match tau {
            0.0 => self.value(watch, 0.0, &self.y),
            tau => self.value(watch, tau, &self.step(tau)?.end),
        };
        let (mut at_a, mut at_b) = (value(a)?, value(b)?);
        let wider = b - a;
        while at_b > 0.0 && b < 4.0 * wider + LONGEST {
            (a, at_a) = (b, at_b);
            b += 0.1 * wider;
            at_b = value(b)?;
        }
        while at_a <= 0.0 && a > 0.0 {
            (b, at_b) = (a, at_a);
            a = (a - 0.1 * wider).max(0.0);
            at_a = value(a)?;
        }
        if at_a <= 0.0 || at_b > 0.0 {
            return if at_a.abs() < ZERO { Ok(a) } else { Err(Skip::Grazes) };
        }
        let ulp = f64::EPSILON * self.t.abs().max(1.0);
        while b - a > 2.0 * ulp {
            let place = (a * at_b - b * at_a) / (at_b - at_a);
            let place = if place > a && place < b { place } else { 0.5 * (a + b) };
            let at_place = value(place)?;
            if at_place.abs() < 1e-16 {
                return Ok(place);
            }
            let before = b - a;
            if at_place > 0.0 {
                (a, at_a) = (place, at_place);
                at_b *= 0.5;
            } else {
                (b, at_b) = (place, at_place);
                at_a *= 0.5;
            }
            if b - a > 0.5 * before {
                let middle = 0.5 * (a + b);
                let at_middle = value(middle)?;
                if at_middle > 0.0 {
                    (a, at_a) = (middle, at_middle);
                } else {
                    (b, at_b) = (middle, at_middle);
                }
            }
        }
        Ok(b)
    }
}
