//! Jacobi's identity.

use std::collections::BTreeMap;

use pc_expr::{Number, Scalar, Weighed};

use crate::error::AlgebraError;

/// The triple r < s < u of which (a, b, c) is a cyclic permutation, if there is one.
pub(crate) fn cyclic(a: usize, b: usize, c: usize) -> Option<(usize, usize, usize)> {
    let rotated = [(a, b, c), (b, c, a), (c, a, b)];
    rotated.into_iter().find(|&(r, s, u)| r < s && s < u)
}

/// Checks that c_rs^p c_pu^m + c_su^p c_pr^m + c_ur^p c_ps^m = 0 for r < s < u among the operators 0..k,
/// where 0 is time. `nonzero` lists the nonzero c_rs^m as (r, s, m, c_rs^m) in the order of (r, s, m),
/// including both (r, s, m) and (s, r, m), with m counted from 1.
///
/// # Errors
/// [`AlgebraError::Jacobi`].
pub(crate) fn check_jacobi(k: usize, nonzero: &[(usize, usize, usize, Number)]) -> Result<(), AlgebraError> {
    let mut of_first: Vec<Vec<(usize, usize, Number)>> = vec![Vec::new(); k + 1];
    for &(p, u, m, c) in nonzero {
        of_first[p].push((u, m, c));
    }
    let mut defects: BTreeMap<_, (Number, Weighed)> = BTreeMap::new();
    for &(r, s, p, first) in nonzero {
        for &(u, component, second) in &of_first[p] {
            let Some(triple) = cyclic(r, s, u) else { continue };
            let empty = || (Number::ZERO, Weighed::from_f64(0.0));
            let (defect, size) = defects.entry((triple, component)).or_insert_with(empty);
            *defect = *defect + first * second;
            *size = *size + Weighed::constant(first) * Weighed::constant(second);
        }
    }
    // Rational constants give an exact 0; constants rounded to f64 leave a few units of rounding error.
    let vanishes = |defect: Number, size: &Weighed| defect.to_f64().abs() <= 1e-12 * size.size();
    match defects.into_iter().find(|(_, (defect, size))| !vanishes(*defect, size)) {
        None => Ok(()),
        Some(((triple, component), (defect, _))) => {
            Err(AlgebraError::Jacobi { triple, component, defect: defect.to_string() })
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Checks the identity in its written form, with all k³ coefficients.
    fn written_out(
        k: usize,
        c: impl Fn(usize, usize, usize) -> i64,
    ) -> Option<((usize, usize, usize), usize)> {
        let triples =
            (0..=k).flat_map(|r| (r + 1..=k).flat_map(move |s| (s + 1..=k).map(move |u| (r, s, u))));
        let all = triples.flat_map(|triple| (1..=k).map(move |m| (triple, m)));
        let nested = |a, b, d, m| (1..=k).map(|p| c(a, b, p) * c(p, d, m)).sum::<i64>();
        all.into_iter()
            .find(|&((r, s, u), m)| nested(r, s, u, m) + nested(s, u, r, m) + nested(u, r, s, m) != 0)
    }

    proptest! {
        #[test]
        fn nonzero_constants_determine_the_algebra(k in 1_usize..5, seeds in prop::collection::vec(-3_i64..4, 125)) {
            // Mostly zeros, as in frames of mechanics: some of them are then Lie algebras.
            let c = |r: usize, s: usize, m: usize| {
                let upper = |r: usize, s: usize| match seeds[(r * 5 + s) * 5 + m] {
                    large if large.abs() == 3 => large,
                    _ => 0,
                };
                match r.cmp(&s) {
                    std::cmp::Ordering::Less => upper(r, s),
                    std::cmp::Ordering::Equal => 0,
                    std::cmp::Ordering::Greater => -upper(s, r),
                }
            };
            let indices = (0..=k).flat_map(|r| (0..=k).flat_map(move |s| (1..=k).map(move |m| (r, s, m))));
            let nonzero: Vec<_> = indices
                .filter(|&(r, s, m)| c(r, s, m) != 0)
                .map(|(r, s, m)| (r, s, m, Number::ratio(c(r, s, m), 1)))
                .collect();
            let found = match check_jacobi(k, &nonzero) {
                Ok(()) => None,
                Err(AlgebraError::Jacobi { triple, component, .. }) => Some((triple, component)),
                Err(error) => panic!("{error}"),
            };
            prop_assert_eq!(found, written_out(k, c));
        }
    }
}
