//! The absolute tolerance of each component of the state.

use pc_model::Flow;
use pc_model::document::AbsoluteTolerance;
use pc_solve::Tolerance;
use serde_json::{Map, Value, json};

use pc_print::small;

/// A component that starts at zero in the text and stays below this fraction of the largest component is
/// rounding error of the others.
const ROUNDING: f64 = 1e-14;

/// The absolute tolerance of each component of the state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tolerances {
    names: Vec<String>,
    values: Vec<f64>,
}

impl Tolerances {
    /// The given tolerances, otherwise tolerances that depend on the scale of the components at the start of
    /// the flow.
    pub(crate) fn new(given: &AbsoluteTolerance, flow: &mut Flow, span: (f64, f64), rtol: f64) -> Tolerances {
        let values = flow.absolute_tolerances(given, span, rtol);
        Tolerances { names: flow.motion.names().to_vec(), values }
    }

    /// The tolerances in the form that the integrator takes.
    pub(crate) fn tolerance(&self) -> Tolerance {
        Tolerance::each(self.values.clone())
    }

    /// The tolerances, component by component.
    pub(crate) fn values(&self) -> &[f64] {
        &self.values
    }

    /// The largest.
    pub(crate) fn largest(&self) -> f64 {
        self.values.iter().copied().fold(0.0, f64::max)
    }

    /// The error that each component of a state may have in a step: rtol·|yᵢ| + atolᵢ.
    pub(crate) fn errors(&self, rtol: f64, state: &[f64]) -> Vec<f64> {
        state.iter().zip(&self.values).map(|(value, tolerance)| rtol * value.abs() + tolerance).collect()
    }

    /// A text with the most common tolerance, then the others with the names of their components.
    pub(crate) fn in_words(&self) -> String {
        let others = self.others().map(|(name, value)| format!(", {} for {name}", rounded(value)));
        format!("{}{}", rounded(self.commonest()), others.collect::<String>())
    }

    /// A number if all tolerances are the same, otherwise an object with the tolerance of each component
    /// under its name.
    pub(crate) fn json(&self) -> Value {
        if self.others().next().is_none() {
            return json!(self.commonest());
        }
        let each = self.names.iter().zip(&self.values).map(|(name, value)| (name.clone(), json!(value)));
        Value::Object(each.collect::<Map<_, _>>())
    }

    /// A line for each component that never exceeds its tolerance, so that none of its digits is known to be right. `start`
    /// contains the start values of the text, and `largest` the largest magnitude of each component.
    pub(crate) fn never_exceeded(&self, start: &[(String, f64)], largest: &[f64]) -> Vec<String> {
        let rounding = ROUNDING * largest.iter().fold(0.0, |most, value| value.max(most));
        let starts = |name: &String| start.iter().any(|(known, value)| known == name && *value != 0.0);
        let components = self.names.iter().zip(&self.values).zip(largest);
        let below = components.filter(|((name, tolerance), largest)| {
            (starts(name) || **largest > rounding) && **largest > 0.0 && largest <= tolerance
        });
        below
            .map(|((name, tolerance), largest)| {
                let (most, tolerance) = (small(*largest), small(*tolerance));
                format!(
                    "{name} is at most {most} at the rows and its tolerance {tolerance}: none of its digits \
                     is certain; --atol \"{name}=…\" makes them so"
                )
            })
            .collect()
    }

    fn commonest(&self) -> f64 {
        let count = |value: f64| self.values.iter().filter(|other| **other == value).count();
        // Of equally common ones the largest.
        let order = |a: &f64, b: &f64| count(*a).cmp(&count(*b)).then(a.total_cmp(b));
        self.values.iter().copied().max_by(order).unwrap_or(f64::NAN)
    }

    fn others(&self) -> impl Iterator<Item = (&str, f64)> {
        let commonest = self.commonest();
        let each = self.names.iter().map(String::as_str).zip(self.values.iter().copied());
        each.filter(move |&(_, value)| value != commonest)
    }
}

/// The value with three digits, without trailing zeros.
fn rounded(value: f64) -> String {
    let three: f64 = format!("{value:.2e}").parse().unwrap_or(value); // it is a number
    format!("{three:e}")
}

/// Raises the largest magnitudes to those in a state, where these are larger.
pub(crate) fn note_largest(largest: &mut Vec<f64>, state: &[f64]) {
    largest.resize(state.len(), 0.0);
    largest.iter_mut().zip(state).for_each(|(largest, value)| *largest = largest.max(value.abs()));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(each: &[(&str, f64)]) -> Tolerances {
        let (names, values) = each.iter().map(|&(name, value)| (name.to_owned(), value)).unzip();
        Tolerances { names, values }
    }

    #[test]
    fn those_that_differ_are_named() {
        assert_eq!(of(&[("x", 1e-12), ("v", 1e-12)]).in_words(), "1e-12");
        assert_eq!(of(&[("x", 1e-12), ("v", 1e-12)]).json(), json!(1e-12));
        let small = of(&[("x", 1e-18), ("φ", 1e-12), ("φ'", 1e-12)]);
        assert_eq!(small.in_words(), "1e-12, 1e-18 for x");
        assert_eq!(small.json(), json!({ "x": 1e-18, "φ": 1e-12, "φ'": 1e-12 }));
    }

    #[test]
    fn what_never_exceeds_its_tolerance_is_said() {
        let tolerances = of(&[("q", 1e-12), ("x", 1e-12)]);
        let start = |q: f64| [("q".to_owned(), q), ("x".to_owned(), 1.0)];
        let said = tolerances.never_exceeded(&start(1e-16), &[3e-16, 1.0]);
        assert_eq!(
            said,
            ["q is at most 3.0e-16 at the rows and its tolerance 1.0e-12: none of its digits is certain; \
              --atol \"q=…\" makes them so"]
        );
        assert_eq!(tolerances.never_exceeded(&start(0.0), &[3e-14, 1.0]).len(), 1);
        assert!(tolerances.never_exceeded(&start(1e-14), &[3e-12, 1.0]).is_empty());
        // Rounding of others, and what is zero.
        assert!(tolerances.never_exceeded(&start(0.0), &[2e-16, 1.0]).is_empty());
        assert!(tolerances.never_exceeded(&start(0.0), &[0.0, 1.0]).is_empty());
    }
}
