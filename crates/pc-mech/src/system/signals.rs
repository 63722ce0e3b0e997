//! Inputs given by tables as functions of time.

use std::sync::Arc;

/// How a table is interpolated between its times.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// By straight lines between neighbouring values.
    Linear,
    /// By the cubic spline with continuous second derivative whose third derivative is also continuous at the
    /// second and the last but one of the times of the table (C. de Boor, *A Practical Guide to Splines*, ch.
    /// IV: not-a-knot).
    Cubic,
    /// By the last preceding value, even after the last time.
    Hold,
}

/// A function of time given by its values at increasing times.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    times: Vec<f64>,
    values: Vec<f64>,
    /// The derivatives u̇ at the times, for a spline.
    slopes: Vec<f64>,
    interpolation: Interpolation,
}

/// An error of a table.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TableError {
    /// Different numbers of times and values.
    #[error("a table needs as many values as times, but has {times} times and {values} values")]
    Lengths {
        /// Number of times.
        times: usize,
        /// Number of values.
        values: usize,
    },
    /// Too few times.
    #[error("a table needs at least {least} times, not {times}")]
    TooShort {
        /// Number of times.
        times: usize,
        /// The minimum number.
        least: usize,
    },
    /// Times that do not increase.
    #[error("the times of a table must increase: {time} follows {before}")]
    NotRising {
        /// The index of the later of the two times, counted from 0.
        place: usize,
        /// The earlier of the two times.
        before: f64,
        /// The later of the two times.
        time: f64,
    },
    /// A time or a value that is not finite.
    #[error("{value} at place {place} of a table is not a finite number")]
    NotFinite {
        /// The index, counted from 0.
        place: usize,
        /// The number.
        value: f64,
    },
}

/// A time at which an input has no value.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("the input `{input}` has no value at t = {t}: its table goes from {from} to {to}")]
pub struct OutsideTable {
    /// The input.
    pub input: String,
    /// The time.
    pub t: f64,
    /// The first time of the table.
    pub from: f64,
    /// The last time of the table.
    pub to: f64,
}

impl Table {
    /// A function with these values at these times.
    ///
    /// ```
    /// use pc_mech::{Interpolation, Table};
    ///
    /// let table = Table::new(vec![0.0, 1.0, 3.0], vec![0.0, 2.0, 0.0], Interpolation::Linear)?;
    /// assert_eq!([table.at(0.5), table.at(2.0), table.at(4.0)], [Some(1.0), Some(1.0), None]);
    /// # Ok::<(), pc_mech::TableError>(())
    /// ```
    ///
    /// # Errors
    /// [`TableError`] unless there are as many times as values, at least two of each (one with
    /// `Interpolation::Hold`), all of them finite, and the times increase.
    pub fn new(times: Vec<f64>, values: Vec<f64>, interpolation: Interpolation) -> Result<Table, TableError> {
        if times.len() != values.len() {
            return Err(TableError::Lengths { times: times.len(), values: values.len() });
        }
        let least = if interpolation == Interpolation::Hold { 1 } else { 2 };
        if times.len() < least {
            return Err(TableError::TooShort { times: times.len(), least });
        }
        let mut pairs = times.iter().zip(&values).enumerate();
        if let Some((place, (t, u))) = pairs.find(|(_, (t, u))| !(t.is_finite() && u.is_finite())) {
            return Err(TableError::NotFinite { place, value: if t.is_finite() { *u } else { *t } });
        }
        if let Some(place) = (1..times.len()).find(|&i| times[i] <= times[i - 1]) {
            return Err(TableError::NotRising { place, before: times[place - 1], time: times[place] });
        }
        let slopes = match interpolation {
            Interpolation::Cubic => spline(&times, &values),
            Interpolation::Linear | Interpolation::Hold => Vec::new(),
        };
        Ok(Table { times, values, slopes, interpolation })
    }

    /// The times.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The values at the times.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Its interpolation.
    pub fn interpolation(&self) -> Interpolation {
        self.interpolation
    }

    /// The value at t, after the jump if there is one at t; none outside the range of times.
    pub fn at(&self, t: f64) -> Option<f64> {
        let last = self.times.len() - 1;
        let after = self.times.partition_point(|&time| time <= t);
        let i = after.checked_sub(1)?;
        if self.interpolation == Interpolation::Hold || t == self.times[i] {
            return Some(self.values[i]);
        }
        if i == last || t.is_nan() {
            return None;
        }
        let (h, x) = (self.times[i + 1] - self.times[i], t - self.times[i]);
        let (u, rise) = (self.values[i], (self.values[i + 1] - self.values[i]) / h);
        if self.interpolation == Interpolation::Linear {
            return Some(u + rise * x);
        }
        // Hermite's cubic of the values and slopes at both ends
        let (start, end) = (self.slopes[i], self.slopes[i + 1]);
        let curve = (start + end - 2.0 * rise) / h;
        Some(u + x * (start + x * ((rise - start) / h - curve + x * curve / h)))
    }

    /// The derivative u̇ at t on the piece that contains `from`; zero outside the range of times.
    fn rate(&self, t: f64, from: f64) -> f64 {
        let after = self.times.partition_point(|&time| time <= from);
        let Some(i) = after.checked_sub(1).filter(|_| after < self.times.len()) else { return 0.0 };
        let (h, x) = (self.times[after] - self.times[i], t - self.times[i]);
        let rise = (self.values[after] - self.values[i]) / h;
        match self.interpolation {
            Interpolation::Hold => 0.0,
            Interpolation::Linear => rise,
            Interpolation::Cubic => {
                let (start, end) = (self.slopes[i], self.slopes[after]);
                let curve = (start + end - 2.0 * rise) / h;
                start + x * (2.0 * ((rise - start) / h - curve) + 3.0 * x * curve / h)
            }
        }
    }
}

/// The slopes of the spline (not-a-knot); for three points, those of the parabola through the points, and for
/// two, those of the straight line.
fn spline(x: &[f64], u: &[f64]) -> Vec<f64> {
    let n = x.len();
    let h: Vec<f64> = x.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let rise: Vec<f64> = u.windows(2).zip(&h).map(|(pair, h)| (pair[1] - pair[0]) / h).collect();
    match n {
        2 => return vec![rise[0]; 2],
        3 => {
            let curve = (rise[1] - rise[0]) / (h[0] + h[1]);
            return vec![rise[0] - h[0] * curve, rise[0] + h[0] * curve, rise[1] + h[1] * curve];
        }
        _ => {}
    }
    // Rows (below, diagonal, above | right); the pivots of the elimination are positive.
    let (first, last) = (x[2] - x[0], x[n - 1] - x[n - 3]);
    let start = ((h[0] + 2.0 * first) * h[1] * rise[0] + h[0] * h[0] * rise[1]) / first;
    let mut rows = vec![(0.0, h[1], first, start)];
    for i in 1..n - 1 {
        let right = 3.0 * (h[i] * rise[i - 1] + h[i - 1] * rise[i]);
        rows.push((h[i], 2.0 * (h[i - 1] + h[i]), h[i - 1], right));
    }
    let end = h[n - 2] * h[n - 2] * rise[n - 3] + (2.0 * last + h[n - 2]) * h[n - 3] * rise[n - 2];
    rows.push((last, h[n - 3], 0.0, end / last));
    for i in 1..n {
        let (_, pivot, above, right) = rows[i - 1];
        let row = &mut rows[i];
        let share = row.0 / pivot;
        row.1 -= share * above;
        row.3 -= share * right;
    }
    let mut slopes = vec![0.0; n];
    for i in (0..n).rev() {
        let (_, pivot, above, right) = rows[i];
        let next = if i + 1 < n { slopes[i + 1] } else { 0.0 };
        slopes[i] = (right - above * next) / pivot;
    }
    slopes
}

/// Inputs with their tables, for a [`Motion`](crate::Motion) that they [drive](crate::Motion::driven_by).
#[derive(Clone, Debug, Default)]
pub struct Signals {
    list: Vec<Signal>,
    /// The times of all tables, in ascending order.
    breaks: Arc<[f64]>,
    /// The interval between two breaks in which evaluations take place; `None` until an integrator enters one.
    between: Option<(f64, f64)>,
}

#[derive(Clone, Debug)]
struct Signal {
    name: String,
    /// The index of the input among the parameters.
    place: usize,
    table: Arc<Table>,
}

impl Signals {
    /// The inputs with these names, with their indices among the parameters.
    pub fn new<S: Into<String>>(inputs: impl IntoIterator<Item = (S, usize, Arc<Table>)>) -> Signals {
        let signal = |(name, place, table): (S, usize, _)| Signal { name: name.into(), place, table };
        let list: Vec<Signal> = inputs.into_iter().map(signal).collect();
        let mut breaks: Vec<f64> =
            list.iter().flat_map(|signal| signal.table.times.iter().copied()).collect();
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        Signals { list, breaks: breaks.into(), between: None }
    }

    /// The indices of the inputs among the parameters.
    pub fn places(&self) -> impl Iterator<Item = usize> {
        self.list.iter().map(|signal| signal.place)
    }

    /// Whether there are no inputs.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// The times of all tables, in ascending order.
    pub fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    /// Declares that the values [read](Signals::read) next are at times in the interval between two breaks that
    /// contains t and extends towards `end`. At a jump, the values on the side of this interval are used. Returns
    /// whether an input has jumped since the last such call.
    pub fn enter(&mut self, t: f64, end: f64) -> bool {
        let next = match end >= t {
            true => self.breaks.partition_point(|&time| time <= t),
            false => self.breaks.partition_point(|&time| time < t),
        };
        let between @ (from, _) = self.before(next);
        let before = self.between.replace(between);
        let jumps = |(before, _): (f64, f64)| {
            let steps = self.list.iter().filter(|signal| signal.table.interpolation == Interpolation::Hold);
            steps.map(|signal| &signal.table).any(|table| table.at(before) != table.at(from))
        };
        before.is_some_and(jumps)
    }

    /// The derivative u̇ of the input with this index among the parameters; at a break, the derivative on the
    /// side that was [entered](Signals::enter); zero if the input has no table.
    pub(crate) fn rate(&self, place: usize, t: f64) -> f64 {
        let entered = self.between.filter(|&(from, to)| (from..=to).contains(&t));
        let (from, _) =
            entered.unwrap_or_else(|| self.before(self.breaks.partition_point(|&time| time <= t)));
        let table = self.list.iter().find(|signal| signal.place == place).map(|signal| &signal.table);
        table.map_or(0.0, |table| table.rate(t, from))
    }

    /// The interval that ends at the break with this index.
    fn before(&self, next: usize) -> (f64, f64) {
        let from = next.checked_sub(1).map_or(f64::NEG_INFINITY, |i| self.breaks[i]);
        (from, self.breaks.get(next).copied().unwrap_or(f64::INFINITY))
    }

    /// Writes the values at t into the parameters; at a jump, the values on the side of the interval that was
    /// [entered](Signals::enter), if t is one of its ends. Returns whether any value has changed.
    ///
    /// # Errors
    /// [`OutsideTable`]
    pub fn read(&self, t: f64, parameters: &mut [f64]) -> Result<bool, OutsideTable> {
        let entered = self.between.filter(|&(from, to)| (from..=to).contains(&t));
        self.write(parameters, |table| match (table.interpolation, entered) {
            (Interpolation::Hold, Some((from, _))) => (from, table.at(from)),
            _ => (t, table.at(t)),
        })
    }

    /// Like [`read`](Signals::read), but at a jump it always writes the values after the jump.
    ///
    /// # Errors
    /// [`OutsideTable`]
    pub fn show(&self, t: f64, parameters: &mut [f64]) -> Result<bool, OutsideTable> {
        self.write(parameters, |table| (t, table.at(t)))
    }

    fn write(
        &self,
        parameters: &mut [f64],
        value: impl Fn(&Table) -> (f64, Option<f64>),
    ) -> Result<bool, OutsideTable> {
        let mut changed = false;
        for Signal { name, place, table } in &self.list {
            let (t, value) = value(table);
            let Some(value) = value else {
                let (from, to) = (table.times[0], table.times[table.times.len() - 1]);
                return Err(OutsideTable { input: name.clone(), t, from, to });
            };
            changed |= parameters[*place] != value;
            parameters[*place] = value;
        }
        Ok(changed)
    }
}
