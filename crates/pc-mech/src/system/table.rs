//! Functions of time given by their values, and perhaps their rates, at increasing times.

use serde::{Deserialize, Serialize};

use crate::system::spline::slopes_of_spline;

/// How a table is interpolated between its times.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Interpolation {
    /// By straight lines between neighbouring values.
    Linear,
    /// By cubics. Where the table has rates u̇, each cubic has the values and rates at both its ends (C. Hermite). Where it
    /// has none, by the cubic spline with continuous second derivative whose third derivative is also continuous at the
    /// second and the last but one of the times of the table (C. de Boor, *A Practical Guide to Splines*, ch. IV:
    /// not-a-knot).
    Cubic,
    /// By the polynomials of degree 5 that have the values, rates and accelerations of the table at both ends.
    Quintic,
    /// By the last preceding value, even after the last time.
    Hold,
}

/// What is known at the times of a table besides the values.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KnownRates {
    /// The rates u̇.
    pub rates: Option<Vec<f64>>,
    /// The accelerations ü.
    pub accelerations: Option<Vec<f64>>,
}

/// A function of time given by its values at increasing times.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Table {
    times: Vec<f64>,
    values: Vec<f64>,
    /// Of curves, the coefficients c_k of Σ c_k x^k from each time on, where x is the time since then.
    curves: Vec<Polynomial>,
    interpolation: Interpolation,
}

/// Of a second derivative at an end of a piece, relative to its size; a spline is solved for.
const ROUNDING: f64 = 1e-9;

/// The coefficients of 1, x, …, x⁵.
pub type Polynomial = [f64; 6];

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
    /// Rates without interpolation that uses them.
    #[error("{what} are used by the interpolation {by} alone")]
    Unused {
        /// Which rates.
        what: &'static str,
        /// The interpolations that use them.
        by: &'static str,
    },
    /// Different numbers of times and rates.
    #[error("a table needs as many {what} as times, but has {times} times and {found} {what}")]
    Rates {
        /// Which rates.
        what: &'static str,
        /// Number of times.
        times: usize,
        /// Number of rates.
        found: usize,
    },
    /// Interpolation that needs rates.
    #[error("quintic interpolation needs the rates and the accelerations at the times")]
    RatesMissing,
    /// A time or a value that is not finite.
    #[error("{value} at place {place} of a table is not a finite number")]
    NotFinite {
        /// The index, counted from 0.
        place: usize,
        /// The number.
        value: f64,
    },
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
        Table::with_rates(times, values, &KnownRates::default(), interpolation)
    }

    /// A function with these values and rates at these times.
    ///
    /// ```
    /// use pc_mech::{Interpolation, KnownRates, Table};
    ///
    /// // t³ in one piece
    /// let known = KnownRates { rates: Some(vec![0.0, 12.0]), accelerations: None };
    /// let table = Table::with_rates(vec![0.0, 2.0], vec![0.0, 8.0], &known, Interpolation::Cubic)?;
    /// assert_eq!(table.at(1.0), Some(1.0));
    /// assert_eq!(table.rate().unwrap().at(1.0), Some(3.0));
    /// # Ok::<(), pc_mech::TableError>(())
    /// ```
    ///
    /// # Errors
    /// As for [`new`](Table::new); [`TableError::Unused`], [`TableError::Rates`] and [`TableError::RatesMissing`] where the interpolation does not
    /// use the rates, or needs those that are missing.
    pub fn with_rates(
        times: Vec<f64>,
        values: Vec<f64>,
        known: &KnownRates,
        interpolation: Interpolation,
    ) -> Result<Table, TableError> {
        if times.len() != values.len() {
            return Err(TableError::Lengths { times: times.len(), values: values.len() });
        }
        let least = if interpolation == Interpolation::Hold { 1 } else { 2 };
        if times.len() < least {
            return Err(TableError::TooShort { times: times.len(), least });
        }
        check_finite(&times, &values)?;
        if let Some(place) = (1..times.len()).find(|&i| times[i] <= times[i - 1]) {
            return Err(TableError::NotRising { place, before: times[place - 1], time: times[place] });
        }
        let curves = curves(&times, &values, known, interpolation)?;
        Ok(Table { times, values, curves, interpolation })
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
        let x = t - self.times[i];
        Some(match self.curves.get(i) {
            Some(curve) => value(curve, x),
            None => {
                let h = self.times[i + 1] - self.times[i];
                self.values[i] + (self.values[i + 1] - self.values[i]) / h * x
            }
        })
    }

    /// The value at t on the piece that contains `from`: at an end of it, the one-sided limit. None outside the range of
    /// times.
    pub(crate) fn at_from(&self, t: f64, from: f64) -> Option<f64> {
        let after = self.times.partition_point(|&time| time <= from);
        let i = after.checked_sub(1)?;
        match self.curves.get(i) {
            Some(curve) if t <= self.times[i + 1] => Some(value(curve, t - self.times[i])),
            Some(_) => None,
            None if self.interpolation == Interpolation::Hold => Some(self.values[i]),
            None => self.at(t),
        }
    }

    /// The first and the last time.
    pub(crate) fn span(&self) -> (f64, f64) {
        (self.times[0], self.times[self.times.len() - 1])
    }

    /// Whether the value jumps, by more than rounding, between the pieces that contain two neighbouring times.
    pub(crate) fn jumps_between(&self, before: f64, from: f64) -> bool {
        let shared = before.max(from);
        match (self.at_from(shared, before), self.at_from(shared, from)) {
            (Some(one), Some(other)) if self.interpolation == Interpolation::Hold => one != other,
            (Some(one), Some(other)) => (one - other).abs() > ROUNDING * (one.abs() + other.abs()),
            (one, other) => one.is_some() != other.is_some() && self.interpolation == Interpolation::Hold,
        }
    }

    /// The derivative u̇ at t on the piece that contains `from`; zero outside the range of times.
    pub(crate) fn rate_from(&self, t: f64, from: f64) -> f64 {
        let after = self.times.partition_point(|&time| time <= from);
        let Some(i) = after.checked_sub(1).filter(|_| after < self.times.len()) else { return 0.0 };
        match self.curves.get(i) {
            Some(curve) => value(&derivative(curve), t - self.times[i]),
            None if self.interpolation == Interpolation::Hold => 0.0,
            None => (self.values[after] - self.values[i]) / (self.times[after] - self.times[i]),
        }
    }

    /// The derivative u̇ as a table, if it is a function without jumps: that of a curve. Its derivative is ü, which may jump
    /// at the times of the table.
    pub fn rate(&self) -> Option<Table> {
        if self.curves.is_empty() {
            return None;
        }
        let curves: Vec<Polynomial> = self.curves.iter().map(derivative).collect();
        let last = curves.len() - 1;
        let end = value(&curves[last], self.times[last + 1] - self.times[last]);
        let values = curves.iter().map(|curve| curve[0]).chain([end]).collect();
        Some(Table { times: self.times.clone(), values, curves, interpolation: self.interpolation })
    }

    /// The polynomial in t − t_i that has the values of a curve at t, with t_i; on the piece before, if t is the last time.
    pub fn curve_at(&self, t: f64) -> Option<(f64, &Polynomial)> {
        let after = self.times.partition_point(|&time| time <= t);
        let i = after.checked_sub(1)?.min(self.times.len().checked_sub(2)?);
        self.curves
            .get(i)
            .map(|curve| (self.times[i], curve))
            .filter(|_| t <= self.times[self.times.len() - 1])
    }
}

/// # Errors
/// [`TableError::NotFinite`]
fn check_finite(times: &[f64], values: &[f64]) -> Result<(), TableError> {
    let mut pairs = times.iter().zip(values).enumerate();
    match pairs.find(|(_, (t, u))| !(t.is_finite() && u.is_finite())) {
        Some((place, (t, u))) => {
            Err(TableError::NotFinite { place, value: if t.is_finite() { *u } else { *t } })
        }
        None => Ok(()),
    }
}

/// The curves between the times; none for straight lines and constants.
fn curves(
    times: &[f64],
    values: &[f64],
    known: &KnownRates,
    interpolation: Interpolation,
) -> Result<Vec<Polynomial>, TableError> {
    let (cubic, quintic) = (interpolation == Interpolation::Cubic, interpolation == Interpolation::Quintic);
    let listed = [
        ("rates", "\"cubic\" or \"quintic\"", cubic || quintic, &known.rates),
        ("accelerations", "\"quintic\"", quintic, &known.accelerations),
    ];
    for (what, by, used, list) in listed {
        if let Some(list) = list {
            if !used {
                return Err(TableError::Unused { what, by });
            }
            if list.len() != times.len() {
                return Err(TableError::Rates { what, times: times.len(), found: list.len() });
            }
            check_finite(times, list)?;
        }
    }
    let pieces = 0..times.len().saturating_sub(1);
    let ends = |list: &[f64], i: usize| [list[i], list[i + 1]];
    match (interpolation, &known.rates, &known.accelerations) {
        (Interpolation::Linear | Interpolation::Hold, ..) => Ok(Vec::new()),
        (Interpolation::Cubic, rates, _) => {
            let spline = rates.is_none().then(|| slopes_of_spline(times, values));
            let slopes = rates.as_ref().or(spline.as_ref()).map_or(&[][..], Vec::as_slice);
            let piece = |i: usize| cubic_of(times[i + 1] - times[i], ends(values, i), ends(slopes, i));
            Ok(pieces.map(piece).collect())
        }
        (Interpolation::Quintic, Some(rates), Some(accelerations)) => {
            let piece = |i: usize| {
                let h = times[i + 1] - times[i];
                quintic_of(h, ends(values, i), ends(rates, i), ends(accelerations, i))
            };
            Ok(pieces.map(piece).collect())
        }
        (Interpolation::Quintic, ..) => Err(TableError::RatesMissing),
    }
}

/// Hermite's cubic on 0..h with these values and slopes at both ends.
fn cubic_of(h: f64, [start, end]: [f64; 2], [slope, last]: [f64; 2]) -> Polynomial {
    let rise = (end - start) / h;
    let curve = (slope + last - 2.0 * rise) / h;
    [start, slope, (rise - slope) / h - curve, curve / h, 0.0, 0.0]
}

/// The polynomial of degree 5 on 0..h with these values, slopes and second derivatives at both ends.
fn quintic_of(h: f64, [start, end]: [f64; 2], [slope, last]: [f64; 2], [bend, turn]: [f64; 2]) -> Polynomial {
    // What is left of value, slope and second derivative at h after the first three terms, in units of h.
    let value = end - start - h * (slope + h * bend / 2.0);
    let rate = h * (last - slope - h * bend);
    let second = h * h * (turn - bend);
    let scaled = [
        10.0 * value - 4.0 * rate + second / 2.0,
        -15.0 * value + 7.0 * rate - second,
        6.0 * value - 3.0 * rate + second / 2.0,
    ];
    let [c3, c4, c5] = scaled.map(|coefficient| coefficient / (h * h * h));
    [start, slope, bend / 2.0, c3, c4 / h, c5 / (h * h)]
}

/// Σ c_k x^k, by Horner's rule.
fn value(coefficients: &Polynomial, x: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, coefficient| coefficient + x * sum)
}

fn derivative(&[_, a, b, c, d, e]: &Polynomial) -> Polynomial {
    [a, 2.0 * b, 3.0 * c, 4.0 * d, 5.0 * e, 0.0]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A polynomial of the degree of the pieces is its own interpolation, with its derivatives.
    #[test]
    fn polynomials_are_reproduced() {
        let f = |t: f64| [t.powi(5) - 2.0 * t, 5.0 * t.powi(4) - 2.0, 20.0 * t.powi(3)];
        let times = vec![-1.0, -0.25, 0.5, 2.0];
        let of = |k: usize| times.iter().map(|&t| f(t)[k]).collect::<Vec<_>>();
        let known = KnownRates { rates: Some(of(1)), accelerations: Some(of(2)) };
        let table = Table::with_rates(times.clone(), of(0), &known, Interpolation::Quintic).unwrap();
        let rate = table.rate().unwrap();
        let acceleration = rate.rate().unwrap();
        for t in [-1.0, -0.7, 0.0, 0.5, 1.3, 2.0] {
            for (table, known) in [&table, &rate, &acceleration].into_iter().zip(f(t)) {
                assert!((table.at(t).unwrap() - known).abs() < 1e-12, "{t}"); // rounding of numbers up to 160
            }
        }
    }

    #[test]
    fn rates_are_used_or_refused() {
        let table = |known: KnownRates, interpolation| {
            Table::with_rates(vec![0.0, 1.0], vec![0.0, 1.0], &known, interpolation).map(|_| ())
        };
        let rates = |count| KnownRates { rates: Some(vec![0.0; count]), accelerations: None };
        let by = "\"cubic\" or \"quintic\"";
        let unused = Err(TableError::Unused { what: "rates", by });
        assert_eq!(table(rates(2), Interpolation::Linear), unused);
        let too_many = Err(TableError::Rates { what: "rates", times: 2, found: 3 });
        assert_eq!(table(rates(3), Interpolation::Cubic), too_many);
        assert_eq!(table(rates(2), Interpolation::Quintic), Err(TableError::RatesMissing));
        assert_eq!(table(rates(2), Interpolation::Cubic), Ok(()));
    }
}
