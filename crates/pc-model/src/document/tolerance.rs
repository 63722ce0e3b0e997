//! Absolute tolerances, as the text gives them.

/// Absolute tolerances as they are given: one for all components of the state, one for some of them, or both.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AbsoluteTolerance {
    /// The common tolerance, for all components that do not have their own.
    pub all: Option<f64>,
    /// Names of components, each with its own tolerance.
    pub each: Vec<(String, f64)>,
}

impl AbsoluteTolerance {
    /// The tolerance of each component: its own, otherwise the common one, otherwise the default.
    pub fn over(&self, names: &[String], usual: &[f64]) -> Vec<f64> {
        let of = |(name, &usual): (&String, &f64)| self.own(name).or(self.all).unwrap_or(usual);
        names.iter().zip(usual).map(of).collect()
    }

    /// These tolerances, completed by those of `other` where none is given here.
    pub fn or(mut self, other: &AbsoluteTolerance) -> AbsoluteTolerance {
        self.all = self.all.or(other.all);
        let further = other.each.iter().filter(|(name, _)| self.own(name).is_none()).cloned();
        self.each = self.each.iter().cloned().chain(further).collect();
        self
    }

    /// The tolerance given for this name; the last one if there are several.
    fn own(&self, name: &str) -> Option<f64> {
        self.each.iter().rev().find(|(known, _)| known == name).map(|&(_, tolerance)| tolerance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn given(all: Option<f64>, each: &[(&str, f64)]) -> AbsoluteTolerance {
        AbsoluteTolerance { all, each: each.iter().map(|&(name, of)| (name.to_owned(), of)).collect() }
    }

    #[test]
    fn its_own_comes_before_that_for_all_and_that_before_the_usual() {
        let names = ["x".to_owned(), "v".to_owned()];
        let over = |given: AbsoluteTolerance| given.over(&names, &[1e-12, 1e-13]);
        assert_eq!(over(given(None, &[])), [1e-12, 1e-13]);
        assert_eq!(over(given(Some(1e-8), &[])), [1e-8, 1e-8]);
        assert_eq!(over(given(Some(1e-8), &[("v", 1e-15)])), [1e-8, 1e-15]);
        assert_eq!(over(given(None, &[("x", 1e-14), ("x", 1e-15)])), [1e-15, 1e-13]);
    }

    #[test]
    fn what_is_given_first_counts() {
        let both = given(None, &[("x", 1e-15)]).or(&given(Some(1e-9), &[("x", 1e-3), ("v", 1e-4)]));
        assert_eq!(both, given(Some(1e-9), &[("x", 1e-15), ("v", 1e-4)]));
    }
}
