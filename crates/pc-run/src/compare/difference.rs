//! The difference between two columns.

/// The largest difference between two columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// What is compared.
    pub name: String,
    /// The largest difference; infinite if only one of the two values is finite somewhere.
    pub largest: f64,
    /// The time at which the largest difference is reached.
    pub time: f64,
    /// The largest magnitude of the finite values in both columns.
    pub scale: f64,
    /// The largest difference allowed, apart from errors of integration.
    pub allowed: f64,
    /// The most by which errors of integration change the columns; 0 if this was not determined.
    pub uncertain: f64,
    /// The first time at which the difference is larger than allowed.
    pub since: Option<f64>,
    /// Whether motions that differ in this column count as different.
    pub counts: bool,
}

/// The difference allowed: |a − b| ≤ `absolute` + `relative`·(the largest value of the column).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Allowance {
    /// The part of the allowed difference that is proportional to the largest value, as a fraction of that value.
    pub relative: f64,
    /// The part of the allowed difference that does not depend on the values.
    pub absolute: f64,
}

impl Allowance {
    /// The difference allowed for a column with this largest value.
    pub fn at(self, scale: f64) -> f64 {
        self.absolute + self.relative * scale
    }
}

impl Difference {
    /// The difference between a and b in the values (t, a, b). Up to each time, errors of integration change the values by at
    /// most the entry of `uncertain`, and not at all after its last entry.
    pub fn new(
        name: String,
        values: &[(f64, f64, f64)],
        allowance: Allowance,
        uncertain: &[f64],
    ) -> Difference {
        let finite = values.iter().flat_map(|&(_, a, b)| [a, b]).filter(|value| value.is_finite());
        let scale = finite.fold(0.0f64, |scale, value| scale.max(value.abs()));
        let allowed = allowance.at(scale);
        let mut difference = Difference {
            name,
            largest: 0.0,
            time: values.first().map_or(0.0, |v| v.0),
            scale,
            allowed,
            uncertain: uncertain.last().copied().unwrap_or(0.0),
            since: None,
            counts: true,
        };
        let uncertain = uncertain.iter().copied().chain(std::iter::repeat(0.0));
        for (&(t, a, b), uncertain) in values.iter().zip(uncertain) {
            let apart = apart(a, b);
            if apart > difference.largest {
                (difference.largest, difference.time) = (apart, t);
            }
            if apart > allowed + uncertain && difference.since.is_none() {
                difference.since = Some(t);
            }
        }
        difference
    }

    /// The same difference, but with no effect on whether the motions are considered the same.
    #[must_use]
    pub fn aside(self) -> Difference {
        Difference { counts: false, ..self }
    }

    /// Whether the difference is allowed, or does not count.
    pub fn is_allowed(&self) -> bool {
        self.since.is_none() || !self.counts
    }
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

    fn of(values: &[(f64, f64, f64)], relative: f64, absolute: f64) -> Difference {
        Difference::new("x".to_owned(), values, Allowance { relative, absolute }, &[])
    }

    #[test]
    fn errors_of_integration_are_allowed_once_they_have_grown() {
        let values = [(0.0, 0.0, 0.0), (1.0, 1e-9, -1e-9), (2.0, 7e-9, 0.0)];
        let allowance = Allowance { relative: 1e-6, absolute: 1e-9 };
        let of = |uncertain: &[f64]| Difference::new("x".to_owned(), &values, allowance, uncertain).since;
        assert_eq!(of(&[]), Some(1.0));
        assert_eq!(of(&[0.0, 2e-9, 1e-8]), None);
        // What is not yet uncertain then is a difference.
        assert_eq!(of(&[0.0, 0.0, 1e-8]), Some(1.0));
        assert_eq!(of(&[0.0, 2e-9, 2e-9]), Some(2.0));
    }

    #[test]
    fn a_difference_counts_against_the_largest_value_of_its_column() {
        let values = [(0.0, 100.0, 100.0), (1.0, 1.0, 1.5), (2.0, 1.0, 2.0)];
        let found = of(&values, 0.01, 0.0);
        assert_eq!((found.largest, found.time, found.scale, found.allowed), (1.0, 2.0, 100.0, 1.0));
        assert!(found.is_allowed(), "1 is as much as is allowed");
        assert_eq!(of(&values, 0.004, 0.0).since, Some(1.0), "0.5 is more than 0.4");
        assert!(of(&values, 0.0, 1.0).is_allowed());
        assert_eq!(of(&values, 0.0, 0.0).since, Some(1.0));
    }

    #[test]
    fn what_is_not_finite_is_equal_to_itself_alone() {
        assert!(of(&[(0.0, f64::NAN, f64::NAN), (1.0, f64::INFINITY, f64::INFINITY)], 0.0, 0.0).is_allowed());
        for (a, b) in
            [(f64::NAN, 1.0), (1.0, f64::NAN), (f64::INFINITY, -f64::INFINITY), (f64::INFINITY, 1.0)]
        {
            let found = of(&[(0.0, a, b)], 1.0, 1e300);
            assert_eq!((found.largest, found.since), (f64::INFINITY, Some(0.0)), "{a} {b}");
        }
    }
}
