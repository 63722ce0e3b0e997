//! The coefficients of DOP853 against the order conditions.

use crate::coefficients::*;

/// The rows of the matrix, including those of dense output, each with the stages of its entries.
fn rows() -> Vec<(f64, Vec<(usize, f64)>)> {
    fn row(c: f64, stages: &[usize], a: &[f64]) -> (f64, Vec<(usize, f64)>) {
        assert_eq!(stages.len(), a.len());
        (c, stages.iter().copied().zip(a.iter().copied()).collect())
    }
    vec![
        row(C[0], &[], &[]),
        row(C[1], &[1], &A2),
        row(C[2], &[1, 2], &A3),
        row(C[3], &[1, 3], &A4),
        row(C[4], &[1, 3, 4], &A5),
        row(C[5], &[1, 4, 5], &A6),
        row(C[6], &[1, 4, 5, 6], &A7),
        row(C[7], &[1, 4, 5, 6, 7], &A8),
        row(C[8], &[1, 4, 5, 6, 7, 8], &A9),
        row(C[9], &[1, 4, 5, 6, 7, 8, 9], &A10),
        row(C[10], &[1, 4, 5, 6, 7, 8, 9, 10], &A11),
        row(C[11], &[1, 4, 5, 6, 7, 8, 9, 10, 11], &A12),
        row(1.0, &BY, &B),
        row(DENSE_C[0], &[1, 7, 8, 9, 10, 11, 12, 13], &A14),
        row(DENSE_C[1], &[1, 6, 7, 8, 11, 12, 13, 14], &A15),
        row(DENSE_C[2], &[1, 6, 7, 8, 9, 13, 14, 15], &A16),
    ]
}

const BY: [usize; 8] = [1, 6, 7, 8, 9, 10, 11, 12];

/// Sums of some ten products of numbers up to 50, each rounded.
const ROUNDING: f64 = 1e-13;

/// Σ bᵢ φᵢ
fn weighed(phi: &[f64]) -> f64 {
    BY.iter().zip(B).map(|(&i, b)| b * phi[i - 1]).sum()
}

/// Σⱼ aᵢⱼ φⱼ for each stage.
fn times(phi: &[f64]) -> Vec<f64> {
    rows().iter().map(|(_, row)| row.iter().map(|&(j, a)| a * phi[j - 1]).sum()).collect()
}

fn nodes(power: i32) -> Vec<f64> {
    rows().iter().map(|(c, _)| c.powi(power)).collect()
}

fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a * b).collect()
}

#[test]
fn the_rows_sum_to_the_nodes() {
    for (i, (c, row)) in rows().iter().enumerate() {
        let sum: f64 = row.iter().map(|(_, a)| a).sum();
        assert!((sum - c).abs() < ROUNDING, "stage {}: {sum} is not {c}", i + 1);
    }
}

/// Σ bᵢ cᵢᵏ = 1/(k+1): the conditions of order 8 for quadrature.
#[test]
fn the_weights_integrate_polynomials_of_degree_seven() {
    for k in 0..8 {
        let (sum, exact) = (weighed(&nodes(k)), 1.0 / f64::from(k + 1));
        assert!((sum - exact).abs() < ROUNDING, "degree {k}: {sum}");
    }
}

/// Trees that are not bushy, to which each entry of the matrix contributes. The conditions Σ bᵢ cᵢᵖ
/// (A cᵖ…)ᵢ = 1/((…)(…)) of [Hairer, Nørsett, Wanner 1993], II.2, theorem 2.13, to order 8.
#[test]
fn taller_trees_satisfy_their_conditions() {
    for p in 0..7 {
        for q in 1..(8 - p) {
            // [τᵖ, [τ^q]]: order p + q + 2
            if p + q + 2 > 8 {
                continue;
            }
            let inner = times(&nodes(q));
            let sum = weighed(&product(&nodes(p), &inner));
            let exact = 1.0 / (f64::from(p + q + 2) * f64::from(q + 1));
            assert!((sum - exact).abs() < ROUNDING, "[τ^{p} [τ^{q}]]: {sum}, not {exact}");
            for r in 1..=(8 - p - q - 3).max(0) {
                // [τᵖ, [τ^q, [τ^r]]]: order p + q + r + 3
                let inner = times(&product(&nodes(q), &times(&nodes(r))));
                let sum = weighed(&product(&nodes(p), &inner));
                let exact = 1.0 / (f64::from(p + q + r + 3) * f64::from(q + r + 2) * f64::from(r + 1));
                assert!((sum - exact).abs() < ROUNDING, "[τ^{p} [τ^{q} [τ^{r}]]]: {sum}, not {exact}");
            }
        }
    }
    // The tallest tree, of order 8: a chain of stages.
    let mut phi = nodes(1);
    for _ in 0..6 {
        phi = times(&phi);
    }
    assert!((weighed(&phi) - 1.0 / 40320.0).abs() < 1e-15, "{}", weighed(&phi));
}

/// Both error estimates vanish for polynomials below their order, but not at it.
#[test]
fn the_error_estimates_are_of_their_orders() {
    let fifth = |k: i32| BY.iter().zip(E5).map(|(&i, e)| e * nodes(k)[i - 1]).sum::<f64>();
    for k in 0..5 {
        assert!(fifth(k).abs() < ROUNDING, "{k}: {}", fifth(k));
    }
    assert!(fifth(5).abs() > 1e-5, "{}", fifth(5));
    let third = |k: i32| [1, 9, 12].iter().zip(B3).map(|(&i, b)| b * nodes(k)[i - 1]).sum::<f64>();
    for k in 0..3 {
        assert!((third(k) - 1.0 / f64::from(k + 1)).abs() < ROUNDING, "{k}: {}", third(k));
    }
}

/// Dense output is exact for the quadrature of polynomials of degree 6: u(s) = sᵏ⁺¹/(k+1) for
/// f = tᵏ.
#[test]
fn the_polynomial_integrates_polynomials_of_degree_six() {
    for k in 0..7 {
        let rates = nodes(k);
        let stages = [1, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16];
        let terms: Vec<f64> =
            D.iter().map(|d| d.iter().zip(stages).map(|(d, i)| d * rates[i - 1]).sum()).collect();
        let end = 1.0 / f64::from(k + 1);
        let bend = rates[0] - end;
        let all = [0.0, end, bend, end - 1.0 - bend, terms[0], terms[1], terms[2], terms[3]];
        for s in [0.1, 0.35, 0.5, 0.9] {
            let r = 1.0 - s;
            let value = all[0]
                + s * (all[1]
                    + r * (all[2] + s * (all[3] + r * (all[4] + s * (all[5] + r * (all[6] + s * all[7]))))));
            let exact = f64::powi(s, k + 1) / f64::from(k + 1);
            // Sums of terms up to 500.
            assert!((value - exact).abs() < 1e-12, "degree {k} at {s}: {value}, not {exact}");
        }
    }
}
