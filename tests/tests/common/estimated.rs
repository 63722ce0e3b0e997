//! Whether an estimate of an error is right.

/// An estimate is right within this factor …
const FACTOR: f64 = 10.0;
/// … unless it and the error are rounding, relative to 1 + |x|: motions are known to 16 digits, and magnify the rounding of the start by
/// at most a few hundred.
const ROUNDING: f64 = 1e-13;

/// The estimated error of `found` is right.
#[track_caller]
pub(crate) fn assert_estimated(of: &str, found: f64, expected: f64, estimated: f64) {
    let error = (found - expected).abs();
    let is_right = estimated <= FACTOR * error && error <= FACTOR * estimated;
    let is_rounding = error.max(estimated) <= ROUNDING * (1.0 + expected.abs());
    assert!(is_right || is_rounding, "{of}: the error is {error:e}, estimated as {estimated:e}");
}
