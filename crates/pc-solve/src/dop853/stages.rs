//! The stages of a step.

use pc_expr::{Failure, VectorField};

use super::arithmetic::{Weights, add_of, finish_of};
use super::coefficients::{A2, A3, A4, A5, A6, A7, A8, A9, A10, A11, A12, C};
use crate::error::NonFinite;

/// A state of the motion, with its rates. Rows may be longer than the state.
#[derive(Debug, Clone)]
pub(super) struct Node {
    pub(super) t: f64,
    pub(super) y: Vec<f64>,
    pub(super) rates: Vec<f64>,
}

/// Stages 6 to 12 of a step, from which its end and its dense output are computed.
pub(super) type Stages = [Vec<f64>; 7];
/// Stages 2 to 5, which only the later stages need; their room is then reused for the stages of
/// dense output.
pub(super) type Early = [Vec<f64>; 4];

/// Writes f(t, y), checks that it is finite, and counts the evaluation; rows may be longer than the
/// state.
#[inline]
pub(super) fn evaluate<F: VectorField>(
    (field, count): (&mut F, &mut u64),
    t: f64,
    y: &[f64],
    rates: &mut [f64],
) -> Result<(), (f64, Failure)> {
    *count += 1;
    let dim = field.dim();
    let (y, rates) = (&y[..dim], &mut rates[..dim]);
    if field.checks_rates() {
        return field.rhs(t, y, rates).map_err(|failure| (t, failure));
    }
    rates.fill(f64::NAN); // to detect entries that are not written
    field.rhs(t, y, rates).map_err(|failure| (t, failure))?;
    match rates.iter().position(|rate| !rate.is_finite()) {
        None => Ok(()),
        Some(i) => {
            let component = field.component_name(i);
            Err((t, Failure::recoverable(NonFinite::Rate { component, value: rates[i], t })))
        }
    }
}

/// Computes the stages of a step from a node to t₁, and the state there. On return, `argument` is
/// the argument of the last stage.
///
/// Returns the sums of the error estimates.
///
/// # Errors
/// A failure of the field, with the time at which it occurred.
#[cfg_attr(
    target_arch = "x86_64",
    expect(unsafe_code, reason = "a function compiled for some processors only")
)]
pub(super) fn advance<F: VectorField>(
    counted: (&mut F, &mut u64),
    from: &Node,
    to: &mut Node,
    rows: (&mut Early, &mut Stages),
    argument: &mut [f64],
    weights: Weights<'_>,
) -> Result<(f64, f64), (f64, Failure)> {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") {
        // SAFETY: the processor has these vectors.
        return unsafe { advance_by_vectors(counted, from, to, rows, argument, weights) };
    }
    advance_by_length(counted, from, to, rows, argument, weights)
}

/// The same with vectors of four numbers.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn advance_by_vectors<F: VectorField>(
    counted: (&mut F, &mut u64),
    from: &Node,
    to: &mut Node,
    rows: (&mut Early, &mut Stages),
    argument: &mut [f64],
    weights: Weights<'_>,
) -> Result<(f64, f64), (f64, Failure)> {
    advance_by_length(counted, from, to, rows, argument, weights)
}

/// The same, for the length of the rows.
#[inline(always)]
fn advance_by_length<F: VectorField>(
    counted: (&mut F, &mut u64),
    from: &Node,
    to: &mut Node,
    rows: (&mut Early, &mut Stages),
    argument: &mut [f64],
    weights: Weights<'_>,
) -> Result<(f64, f64), (f64, Failure)> {
    match argument.len() {
        4 => advance_of::<F, 4>(counted, from, to, rows, argument, weights),
        8 => advance_of::<F, 8>(counted, from, to, rows, argument, weights),
        12 => advance_of::<F, 12>(counted, from, to, rows, argument, weights),
        _ => advance_of::<F, 0>(counted, from, to, rows, argument, weights),
    }
}

/// The same for rows of length LENGTH, or of any length if LENGTH is 0.
#[inline(always)]
fn advance_of<F: VectorField, const LENGTH: usize>(
    (field, count): (&mut F, &mut u64),
    from: &Node,
    to: &mut Node,
    (early, stages): (&mut Early, &mut Stages),
    argument: &mut [f64],
    weights: Weights<'_>,
) -> Result<(f64, f64), (f64, Failure)> {
    let (t, t1) = (from.t, to.t);
    let h = t1 - t;
    let (y, k1) = (&from.y[..], &from.rates[..]);
    let [k2, k3, k4, k5] = early;
    let [k6, k7, k8, k9, k10, k11, k12] = stages;
    add_of::<LENGTH, _>(argument, y, h, &A2, [k1]);
    evaluate((field, count), t + C[1] * h, argument, k2)?;
    add_of::<LENGTH, _>(argument, y, h, &A3, [k1, k2]);
    evaluate((field, count), t + C[2] * h, argument, k3)?;
    add_of::<LENGTH, _>(argument, y, h, &A4, [k1, k3]);
    evaluate((field, count), t + C[3] * h, argument, k4)?;
    add_of::<LENGTH, _>(argument, y, h, &A5, [k1, k3, k4]);
    evaluate((field, count), t + C[4] * h, argument, k5)?;
    add_of::<LENGTH, _>(argument, y, h, &A6, [k1, k4, k5]);
    evaluate((field, count), t + C[5] * h, argument, k6)?;
    add_of::<LENGTH, _>(argument, y, h, &A7, [k1, k4, k5, k6]);
    evaluate((field, count), t + C[6] * h, argument, k7)?;
    add_of::<LENGTH, _>(argument, y, h, &A8, [k1, k4, k5, k6, k7]);
    evaluate((field, count), t + C[7] * h, argument, k8)?;
    add_of::<LENGTH, _>(argument, y, h, &A9, [k1, k4, k5, k6, k7, k8]);
    evaluate((field, count), t + C[8] * h, argument, k9)?;
    add_of::<LENGTH, _>(argument, y, h, &A10, [k1, k4, k5, k6, k7, k8, k9]);
    evaluate((field, count), t + C[9] * h, argument, k10)?;
    add_of::<LENGTH, _>(argument, y, h, &A11, [k1, k4, k5, k6, k7, k8, k9, k10]);
    evaluate((field, count), t + C[10] * h, argument, k11)?;
    add_of::<LENGTH, _>(argument, y, h, &A12, [k1, k4, k5, k6, k7, k8, k9, k10, k11]);
    evaluate((field, count), t1, argument, k12)?;
    Ok(finish_of::<LENGTH>(&mut to.y, y, h, [k1, k6, k7, k8, k9, k10, k11, k12], weights))
}
