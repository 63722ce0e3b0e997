//! Inputs given by tables as functions of time.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::system::table::{Interpolation, Table};

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

/// Inputs with their tables, for a [`Motion`](crate::Motion) that they [drive](crate::Motion::driven_by).
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Signals {
    list: Vec<Signal>,
    /// The times of all tables, in ascending order.
    breaks: Arc<[f64]>,
    /// The interval between two breaks in which evaluations take place; `None` until an integrator enters one.
    between: Option<(f64, f64)>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
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
            list.iter().flat_map(|signal| signal.table.times().iter().copied()).collect();
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
        let jumps =
            |(before, _): (f64, f64)| self.list.iter().any(|signal| signal.table.jumps_between(before, from));
        before.is_some_and(jumps)
    }

    /// The derivative u̇ of the input with this index among the parameters; at a break, the derivative on the
    /// side that was [entered](Signals::enter); zero if the input has no table.
    pub(crate) fn rate(&self, place: usize, t: f64) -> f64 {
        let entered = self.between.filter(|&(from, to)| (from..=to).contains(&t));
        let (from, _) =
            entered.unwrap_or_else(|| self.before(self.breaks.partition_point(|&time| time <= t)));
        let table = self.list.iter().find(|signal| signal.place == place).map(|signal| &signal.table);
        table.map_or(0.0, |table| table.rate_from(t, from))
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
        self.write(parameters, |table| match entered {
            Some((from, _)) if from.is_finite() => {
                let hold = table.interpolation() == Interpolation::Hold;
                (if hold { from } else { t }, table.at_from(t, from))
            }
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
                let (from, to) = table.span();
                return Err(OutsideTable { input: name.clone(), t, from, to });
            };
            changed |= parameters[*place] != value;
            parameters[*place] = value;
        }
        Ok(changed)
    }
}
