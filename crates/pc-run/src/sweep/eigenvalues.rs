//! The eigenvalues of members as a root locus.

use pc_analysis::{Eigenvalue, RootLocus};

/// The branches of eigenvalues along a varied quantity, of whose values each has the numbers re1, im1, re2, …; `None` where not
/// all have as many.
pub(super) fn locus(mut members: Vec<(f64, &[f64])>) -> Option<RootLocus> {
    members.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut locus = RootLocus::default();
    for (value, numbers) in members {
        let pairs = numbers.chunks_exact(2).filter(|pair| pair.iter().all(|part| part.is_finite()));
        let eigenvalues: Vec<Eigenvalue> =
            pairs.map(|pair| Eigenvalue { real: pair[0], imaginary: pair[1] }).collect();
        locus.push(value, Some(&eigenvalues)).ok()?;
    }
    Some(locus)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows are in descending order of the real parts, and branches go on where these cross.
    #[test]
    fn branches_cross() {
        let rows: Vec<(f64, [f64; 4])> = [0.0, 0.25, 0.5, 0.75, 1.0]
            .map(|p: f64| (p, [p.max(1.0 - p), 0.0, p.min(1.0 - p), 0.0]))
            .into_iter()
            .rev()
            .collect();
        let found = locus(rows.iter().map(|(p, numbers)| (*p, &numbers[..])).collect()).unwrap();
        let parts =
            |branch: &[Option<Eigenvalue>]| branch.iter().map(|l| l.unwrap().real).collect::<Vec<_>>();
        let [falling, rising] = found.branches() else { panic!("{found:?}") };
        assert_eq!(parts(falling), [1.0, 0.75, 0.5, 0.25, 0.0]);
        assert_eq!(parts(rising), [0.0, 0.25, 0.5, 0.75, 1.0]);
        assert!(locus(vec![(0.0, &[1.0, 0.0]), (1.0, &[1.0, 0.0, 2.0, 0.0])]).is_none());
    }
}
