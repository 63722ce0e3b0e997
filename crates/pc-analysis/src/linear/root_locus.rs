//! Eigenvalues as functions of a parameter.

use crate::linear::assignment::cheapest;
use crate::stability::spectrum::Eigenvalue;

/// The eigenvalues of a linearization for values of a parameter, each followed as a branch.
///
/// From one value to the next, eigenvalues continue the branches to whose extrapolations they are nearest, as
/// measured by the sum of the square roots of the distances; where two branches meet, their continuations may
/// be exchanged.
///
/// ```
/// use pc_analysis::{Eigenvalue, RootLocus};
///
/// // λ² = p: two imaginary ones meet at 0 and become real.
/// let mut locus = RootLocus::default();
/// for p in [-1.0f64, -0.25, 0.25, 1.0] {
///     let root = p.abs().sqrt();
///     let part = |sign: f64| match p < 0.0 {
///         true => Eigenvalue { real: 0.0, imaginary: sign * root },
///         false => Eigenvalue { real: sign * root, imaginary: 0.0 },
///     };
///     locus.push(p, Some(&[part(1.0), part(-1.0)])).unwrap();
/// }
/// assert_eq!(locus.branches().len(), 2);
/// assert_eq!(locus.branches()[0][1].unwrap().imaginary, 0.5);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RootLocus {
    values: Vec<f64>,
    branches: Vec<Vec<Option<Eigenvalue>>>,
}

/// The number of eigenvalues differs from the number of branches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{found} eigenvalues continue {expected} branches")]
pub struct BranchCount {
    /// The number of eigenvalues.
    pub found: usize,
    /// The number of branches.
    pub expected: usize,
}

impl RootLocus {
    /// Adds the eigenvalues for the next value of the parameter; they are `None` if there is no
    /// linearization.
    ///
    /// # Errors
    /// [`BranchCount`] if there are more or fewer than before; the locus is then unchanged.
    pub fn push(&mut self, value: f64, eigenvalues: Option<&[Eigenvalue]>) -> Result<(), BranchCount> {
        let before = self.values.len();
        let Some(found) = eigenvalues else {
            self.values.push(value);
            self.branches.iter_mut().for_each(|branch| branch.push(None));
            return Ok(());
        };
        if self.branches.is_empty() {
            self.branches = vec![vec![None; before]; found.len()];
        }
        if found.len() != self.branches.len() {
            return Err(BranchCount { found: found.len(), expected: self.branches.len() });
        }
        let expected: Vec<Option<Eigenvalue>> =
            self.branches.iter().map(|branch| self.leads_to(branch, value)).collect();
        // The root of the distance: for real eigenvalues in line all pairings have the same sum of distances,
        // and one that stays in place should keep its branch.
        let distance = |from: &Option<Eigenvalue>, to: &Eigenvalue| {
            from.map_or(0.0, |from| (from.real - to.real).hypot(from.imaginary - to.imaginary).sqrt())
        };
        let costs: Vec<Vec<f64>> =
            expected.iter().map(|from| found.iter().map(|to| distance(from, to)).collect()).collect();
        let places = cheapest(&costs);
        self.values.push(value);
        self.branches.iter_mut().zip(places).for_each(|(branch, place)| branch.push(Some(found[place])));
        Ok(())
    }

    /// The eigenvalue to which a branch leads: extrapolated along the line through the last two, or equal to
    /// the last one.
    fn leads_to(&self, branch: &[Option<Eigenvalue>], value: f64) -> Option<Eigenvalue> {
        let mut known = branch.iter().zip(&self.values).rev();
        let (last, at) = known.find_map(|(lambda, &p)| Some(((*lambda)?, p)))?;
        let (Some((Some(before), &earlier)), true) = (known.next(), at != value) else { return Some(last) };
        let ahead = (value - at) / (at - earlier);
        if !ahead.is_finite() {
            return Some(last);
        }
        let on = |last: f64, before: f64| last + ahead * (last - before);
        Some(Eigenvalue { real: on(last.real, before.real), imaginary: on(last.imaginary, before.imaginary) })
    }

    /// The values of the parameter.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The branches, each with an eigenvalue for each value of the parameter.
    pub fn branches(&self) -> &[Vec<Option<Eigenvalue>>] {
        &self.branches
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Real branches p and 1 − p cross and keep their identity, and a gap is bridged.
    #[test]
    fn branches_cross() {
        let mut locus = RootLocus::default();
        for i in 0..=10 {
            let p = f64::from(i) / 10.0;
            let real = |real: f64| Eigenvalue { real, imaginary: 0.0 };
            let mut both = [real(p), real(1.0 - p)];
            both.sort_by(|a, b| b.real.total_cmp(&a.real));
            let eigenvalues = (i != 3).then_some(both.as_slice());
            locus.push(p, eigenvalues).unwrap_or_else(|error| panic!("{error}"));
        }
        let falling: Vec<Option<f64>> =
            locus.branches()[0].iter().map(|lambda| lambda.map(|l| l.real)).collect();
        let expected = (0..=10).map(|i| (i != 3).then_some(1.0 - f64::from(i) / 10.0));
        assert_eq!(falling, expected.collect::<Vec<_>>());
        let one = Eigenvalue { real: 0.0, imaginary: 0.0 };
        assert_eq!(locus.push(2.0, Some(&[one])), Err(BranchCount { found: 1, expected: 2 }));
    }
}
