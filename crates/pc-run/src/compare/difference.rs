//! The difference between two columns, judged by their errors.

use crate::compare::known::Known;
use crate::motion::accuracy::ROUNDING;

/// How many times the errors of both columns together their difference may be.
///
/// |a − b| ≤ |a − y| + |y − b|, if y is the value of both: the factor would be 1 if the errors were known. They are
/// estimated, and estimates were never less than 0.65 of the error where it is more than rounding (docs/accuracy.md), which
/// makes it 1.54; doubled, it also holds where the estimate of one row is smaller by chance.
pub(crate) const SAFETY: f64 = 3.0;

/// Errors that allow a difference of more than this fraction of the scale of a column leave less than three digits to
/// compare.
pub(crate) const TELLING: f64 = 1e-3;

/// Terms that are so many times as large as their sum cancel in it.
const CANCELLED: f64 = 10.0;

/// What the difference of two columns, or of two motions, says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// They differ by no more than is allowed.
    Same,
    /// They differ by more than their errors explain.
    Different,
    /// Their errors are too large to tell.
    Undecided,
}

impl Verdict {
    /// The word for it in output.
    pub fn word(self) -> &'static str {
        match self {
            Verdict::Same => "same",
            Verdict::Different => "different",
            Verdict::Undecided => "undecided",
        }
    }
}

/// The largest difference between two columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// What is compared.
    pub name: String,
    /// The largest difference; infinite if only one of the two values is finite somewhere.
    pub largest: f64,
    /// The time at which the largest difference is reached.
    pub time: f64,
    /// The largest magnitude of the finite values in both columns, or of the terms of which they are small differences.
    pub scale: f64,
    /// The largest estimated error of each column; infinite if it is not known somewhere.
    pub errors: [f64; 2],
    /// The difference allowed in addition to errors.
    pub allowed: f64,
    /// The first time at which the difference is larger than allowed.
    pub since: Option<f64>,
    /// The first time at which the errors are too large to tell.
    pub untold: Option<f64>,
    /// Whether motions that differ in this column count as different.
    pub counts: bool,
}

/// The difference allowed in addition to errors: `absolute` + `relative`·(the scale of the column); none by default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Allowance {
    /// The part of the allowed difference that is proportional to the scale, as a fraction of it.
    pub relative: f64,
    /// The part of the allowed difference that does not depend on the values.
    pub absolute: f64,
}

impl Allowance {
    /// The difference allowed for a column of this scale.
    pub fn at(self, scale: f64) -> f64 {
        self.absolute + self.relative * scale
    }
}

impl Difference {
    /// The difference between two columns at these times, but for those rows that are left out.
    ///
    /// Values a and b with errors of at most e_a and e_b up to their time are the same where
    /// |a − b| ≤ allowed + 3 (e_a + e_b) + rounding. An error that was made once is carried along, even where a
    /// later row happens to be right.
    pub fn new(
        name: String,
        times: &[f64],
        columns: [&Known; 2],
        left_out: &[bool],
        allowance: Allowance,
    ) -> Difference {
        let [first, second] = columns;
        let scale = scale(columns, times.len());
        let allowed = allowance.at(scale);
        let mut difference = Difference {
            name,
            largest: 0.0,
            time: times.first().copied().unwrap_or(0.0),
            scale,
            errors: [0.0; 2],
            allowed,
            since: None,
            untold: None,
            counts: true,
        };
        let compared = times.iter().enumerate().filter(|&(i, _)| !left_out.get(i).is_some_and(|out| *out));
        for (i, &t) in compared {
            for (error, column) in difference.errors.iter_mut().zip(columns) {
                *error = error.max(column.errors[i]);
            }
            let errors = SAFETY * (difference.errors[0] + difference.errors[1]);
            let rounding = ROUNDING * scale + first.rounding[i] + second.rounding[i];
            let apart = apart(first.values[i], second.values[i]);
            if apart > difference.largest {
                (difference.largest, difference.time) = (apart, t);
            }
            if apart > allowed + errors + rounding {
                difference.since.get_or_insert(t);
            }
            if errors > allowed.max(TELLING * scale) {
                difference.untold.get_or_insert(t);
            }
        }
        difference
    }

    /// The same difference, but with no effect on whether the motions are considered the same.
    #[must_use]
    pub fn aside(self) -> Difference {
        Difference { counts: false, ..self }
    }

    /// What the difference says.
    pub fn verdict(&self) -> Verdict {
        match (self.since, self.untold) {
            (Some(_), _) => Verdict::Different,
            (None, Some(_)) => Verdict::Undecided,
            (None, None) => Verdict::Same,
        }
    }
}

/// The largest magnitude of the finite values in so many rows; for columns in which large terms cancel, that of these terms,
/// by what rounding errors change in half of the rows.
fn scale(columns: [&Known; 2], rows: usize) -> f64 {
    let of = |column: &Known| {
        let values = column.values[..rows].iter().filter(|value| value.is_finite());
        let largest = values.fold(0.0f64, |largest, value| largest.max(value.abs()));
        let mut changes: Vec<f64> = column.rounding[..rows].to_vec();
        changes.sort_by(f64::total_cmp);
        let terms = changes.get(rows / 2).map_or(0.0, |change| change / ROUNDING);
        if terms > CANCELLED * largest { terms } else { largest }
    };
    of(columns[0]).max(of(columns[1]))
}

/// |a − b|; two values that are not finite in the same way do not differ.
fn apart(a: f64, b: f64) -> f64 {
    if a == b || (a.is_nan() && b.is_nan()) {
        return 0.0;
    }
    let apart = (a - b).abs();
    if apart.is_nan() { f64::INFINITY } else { apart }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TIMES: [f64; 3] = [0.0, 1.0, 2.0];

    fn known(values: &[f64], errors: &[f64]) -> Known {
        Known { values: values.to_vec(), errors: errors.to_vec(), rounding: vec![0.0; values.len()] }
    }

    fn of(a: &[f64], b: &[f64], errors: &[f64], allowance: Allowance) -> Difference {
        let exact = vec![0.0; b.len()];
        Difference::new(
            "x".to_owned(),
            &TIMES[..a.len()],
            [&known(a, errors), &known(b, &exact)],
            &[],
            allowance,
        )
    }

    #[test]
    fn a_difference_within_the_errors_so_far_is_none() {
        let none = Allowance::default();
        let of = |errors: &[f64]| of(&[1.0, 1.0 + 2e-9, 1.0 + 5e-9], &[1.0, 1.0, 1.0], errors, none);
        assert_eq!(of(&[0.0, 1e-9, 2e-9]).verdict(), Verdict::Same);
        // An error is carried along where a later row happens to have none.
        assert_eq!(of(&[0.0, 2e-9, 0.0]).verdict(), Verdict::Same);
        // Errors of later rows do not explain the difference of an earlier one.
        assert_eq!(of(&[0.0, 1e-10, 2e-9]).since, Some(1.0));
        assert_eq!(of(&[0.0, 1e-9, 1e-9]).since, Some(2.0));
    }

    #[test]
    fn rounding_is_no_difference() {
        let none = Allowance::default();
        assert_eq!(of(&[1.0], &[1.0 + 5e-15], &[0.0], none).verdict(), Verdict::Same);
        assert_eq!(of(&[1.0], &[1.0 + 5e-14], &[0.0], none).verdict(), Verdict::Different);
        // Of terms of order one that cancel, in every row or in one.
        let cancelled =
            |rounding: &[f64]| Known { rounding: rounding.to_vec(), ..known(&[1e-15, 0.0, 0.0], &[0.0; 3]) };
        let other = known(&[0.0, 0.0, 1e-15], &[0.0; 3]);
        let of = |rounding: &[f64]| {
            Difference::new("x".to_owned(), &TIMES, [&cancelled(rounding), &other], &[], none)
        };
        assert_eq!((of(&[1e-14; 3]).verdict(), of(&[1e-14; 3]).scale), (Verdict::Same, 1.0));
        assert_eq!(of(&[1e-14, 0.0, 0.0]).since, Some(2.0));
    }

    #[test]
    fn errors_as_large_as_the_motion_tell_nothing() {
        let values = [1.0, 1.0, 0.5];
        let found = of(&values, &[1.0, 1.0, 0.4], &[0.0, 1e-3, 0.2], Allowance::default());
        assert_eq!((found.verdict(), found.untold), (Verdict::Undecided, Some(1.0)));
        let found = of(&values, &[1.0, 1.0, 0.4], &[0.0, 1e-9, f64::INFINITY], Allowance::default());
        assert_eq!((found.verdict(), found.untold), (Verdict::Undecided, Some(2.0)));
        // What differs before that differs.
        let found = of(&values, &[1.1, 1.0, 0.4], &[0.0, 1e-3, 0.2], Allowance::default());
        assert_eq!((found.verdict(), found.since), (Verdict::Different, Some(0.0)));
        // Whoever allows more than the errors needs no more digits.
        let found =
            of(&values, &[1.0, 1.0, 0.4], &[0.0, 1e-3, 1e-3], Allowance { relative: 0.1, absolute: 0.0 });
        assert_eq!(found.verdict(), Verdict::Same);
    }

    #[test]
    fn what_is_allowed_counts_against_the_largest_value_of_the_column() {
        let of = |relative: f64, absolute: f64| {
            of(&[100.0, 1.0, 1.0], &[100.0, 1.5, 2.0], &[0.0; 3], Allowance { relative, absolute })
        };
        let found = of(0.01, 0.0);
        assert_eq!((found.largest, found.time, found.scale, found.allowed), (1.0, 2.0, 100.0, 1.0));
        assert_eq!(found.verdict(), Verdict::Same, "1 is as much as is allowed");
        assert_eq!(of(0.004, 0.0).since, Some(1.0), "0.5 is more than 0.4");
        assert_eq!(of(0.0, 1.0).verdict(), Verdict::Same);
        assert_eq!(of(0.0, 0.0).since, Some(1.0));
    }

    #[test]
    fn rows_that_are_left_out_do_not_count() {
        let (a, b) = (known(&[0.0, 1.0, 0.0], &[0.0, 2.0, 0.0]), known(&[0.0, -1.0, 0.0], &[0.0; 3]));
        let found =
            Difference::new("x".to_owned(), &TIMES, [&a, &b], &[false, true, false], Allowance::default());
        assert_eq!((found.verdict(), found.largest, found.errors), (Verdict::Same, 0.0, [0.0; 2]));
    }

    #[test]
    fn what_is_not_finite_is_equal_to_itself_alone() {
        let none = Allowance::default();
        let infinite = [f64::NAN, f64::INFINITY];
        assert_eq!(of(&infinite, &infinite, &[0.0; 2], none).verdict(), Verdict::Same);
        for (a, b) in
            [(f64::NAN, 1.0), (1.0, f64::NAN), (f64::INFINITY, -f64::INFINITY), (f64::INFINITY, 1.0)]
        {
            let found = of(&[a], &[b], &[0.0], Allowance { relative: 1.0, absolute: 1e300 });
            assert_eq!((found.largest, found.since), (f64::INFINITY, Some(0.0)), "{a} {b}");
        }
    }
}
