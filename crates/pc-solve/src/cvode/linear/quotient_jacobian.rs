//! Sparse Jacobians from difference quotients.

use std::ffi::{c_int, c_void};
use std::slice;

use pc_expr::VectorField;
use sundials_sys as sys;

use crate::cvode::callback::{Callbacks, FATAL, SUCCESS};
use crate::cvode::handles::numbers_of;
use crate::cvode::linear::quotients::Quotients;
use crate::cvode::linear::sparse;

/// The smallest increment, times the error weight, for which the change of f exceeds its rounding
/// error: 1000 |γ| ε n ‖f‖ in the norm of the error test, or 1 if f is 0.
fn least_increment(gamma: f64, f: &[f64], weights: &[f64]) -> f64 {
    let n = f.len() as f64;
    let norm = (f.iter().zip(weights).map(|(f, w)| (f * w).powi(2)).sum::<f64>() / n).sqrt();
    let least = 1000.0 * gamma.abs() * f64::EPSILON * n * norm;
    if least > 0.0 { least } else { 1.0 }
}

/// A `CVLsJacFn` that uses difference quotients.
///
/// # Safety
/// Called by CVODES with the address of a [`UserData<F>`](crate::cvode::callback::UserData),
/// vectors of its dimension and a matrix of our own type with the field's pattern.
pub(super) unsafe extern "C" fn jacobian<F: VectorField>(
    t: f64,
    z: sys::N_Vector,
    f: sys::N_Vector,
    matrix: sys::SUNMatrix,
    user_data: *mut c_void,
    weights: sys::N_Vector,
    _tmp2: sys::N_Vector,
    _tmp3: sys::N_Vector,
) -> c_int {
    // SAFETY: the address is of a live `Callbacks<F>`, which nobody else uses during a call of
    // CVODES.
    let callbacks = unsafe { &mut *user_data.cast::<Callbacks<F>>() };
    let Some(mut quotients) = callbacks.linear.quotients.take() else { return FATAL };
    let mut gamma = 0.0;
    // SAFETY: the memory is that of the current call; `weights` is a work vector, and these
    // functions only copy.
    let codes = unsafe {
        let code = sys::CVodeGetErrWeights(quotients.memory, weights);
        [code, sys::CVodeGetCurrentGamma(quotients.memory, &raw mut gamma)]
    };
    // SAFETY: all are live serial vectors of length `dim`, distinct from each other; `matrix` is
    // ours.
    let (z, f, weights, matrix) = unsafe {
        let numbers = |vector| slice::from_raw_parts(numbers_of(vector), callbacks.dim);
        (numbers(z), numbers(f), numbers(weights), sparse::content(matrix))
    };
    let answer = if codes == [SUCCESS; 2] {
        let least = least_increment(gamma, f, weights);
        quotients.evaluate(callbacks, t, (z, f), weights, least, |k, value| matrix.set(k, value))
    } else {
        FATAL
    };
    callbacks.linear.quotients = Some(quotients);
    answer
}

impl Quotients {
    /// Passes each entry k of ∂f/∂y at z to `write`; `f` holds the value of f at z.
    fn evaluate<F: VectorField>(
        &mut self,
        callbacks: &mut Callbacks<F>,
        t: f64,
        (z, f): (&[f64], &[f64]),
        weights: &[f64],
        least: f64,
        mut write: impl FnMut(usize, f64),
    ) -> c_int {
        self.moved.copy_from_slice(z);
        for colour in 0..self.colours.len() {
            let columns = std::mem::take(&mut self.colours[colour]);
            let increments: Vec<f64> = columns.iter().map(|&j| self.shift(j, z, weights[j], least)).collect();
            let answer = callbacks.rhs(t, &self.moved, &mut self.rates);
            self.evaluations += 1;
            for (&j, increment) in columns.iter().zip(increments) {
                self.moved[j] = z[j];
                let entries = self.pattern.column_starts()[j]..;
                for (k, &i) in entries.zip(self.pattern.column(j)) {
                    write(k, (self.rates[i] - f[i]) / increment);
                }
            }
            self.colours[colour] = columns;
            if answer != SUCCESS {
                return answer;
            }
        }
        SUCCESS
    }
}
