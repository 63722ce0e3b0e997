//! A ball that bounces, in closed form.

/// Gravity.
pub(crate) const G: f64 = 9.81;

/// Times of the bounces from height 1: t₀ = √(2/g), then flights of 2 t₀ eⁿ.
pub(crate) fn bounces(e: f64, until: f64) -> Vec<f64> {
    let t0 = (2.0 / G).sqrt();
    let flights = (1..).scan(t0, |t, n| {
        *t += 2.0 * t0 * e.powi(n);
        Some(*t)
    });
    std::iter::once(t0).chain(flights).take_while(|&t| t < until).collect()
}

#[track_caller]
pub(crate) fn assert_close(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
    for (found, expected) in found.iter().zip(expected) {
        // The tolerance of the integration is 1e-13, and the errors of a dozen flights add up.
        assert!((found - expected).abs() < 1e-10, "{found} is not {expected}");
    }
}
