//! The equations of variation, ṡ = (∂f/∂y) s + ∂f/∂p, as CVODES calls them.

use std::ffi::{c_int, c_void};
use std::slice;

use pc_expr::{Failure, VectorField};
use sundials_sys as sys;

use crate::cvode::callback::{Callbacks, nan_slice};
use crate::cvode::handles::numbers_of;
use crate::error::NonFinite;
use crate::sensitivity::linearisation::Linearisation;

/// The equations of the columns of S = ∂y/∂(p, y₀).
#[derive(Debug, Default)]
pub(crate) struct Variation {
    linearisation: Linearisation,
    /// The parameter of each column, none for derivatives by the start.
    parameters: Vec<Option<usize>>,
}

impl Variation {
    pub(crate) fn new(linearisation: Linearisation, parameters: Vec<Option<usize>>) -> Variation {
        Variation { linearisation, parameters }
    }

    /// The parameter of each column, none for derivatives by the start.
    pub(crate) fn parameters(&self) -> &[Option<usize>] {
        &self.parameters
    }

    /// Writes ṡ of all columns s at (t, y).
    fn rates<'a>(
        &mut self,
        field: &mut impl VectorField,
        t: f64,
        y: &[f64],
        columns: impl Iterator<Item = (&'a [f64], &'a mut [f64])>,
    ) -> Result<(), Failure> {
        let Variation { linearisation, parameters } = self;
        if parameters.iter().any(Option::is_some) {
            linearisation.parameter_jacobian(field, t, y)?;
        }
        linearisation.prepare(field, t, y)?;
        for (column, ((s, rate), parameter)) in columns.zip(parameters).enumerate() {
            linearisation.product(field, t, y, s, rate)?;
            if let Some(i) = rate.iter().position(|rate| !rate.is_finite()) {
                let (component, value) = (field.component_name(i), rate[i]);
                return Err(Failure::recoverable(NonFinite::Variation { component, column, value, t }));
            }
            if let Some(parameter) = parameter {
                for (rate, entry) in rate.iter_mut().zip(linearisation.by_parameter(*parameter)) {
                    *rate += entry;
                }
            }
        }
        Ok(())
    }
}

/// `CVSensRhsFn`.
///
/// # Safety
/// Called by CVODES with the address of a [`UserData<F>`](crate::cvode::callback::UserData) whose variation has `count`
/// columns, and with vectors of its dimension.
pub(crate) unsafe extern "C" fn rates<F: VectorField>(
    count: c_int,
    t: f64,
    y: sys::N_Vector,
    _ydot: sys::N_Vector,
    columns: *mut sys::N_Vector,
    rates: *mut sys::N_Vector,
    user_data: *mut c_void,
    _tmp1: sys::N_Vector,
    _tmp2: sys::N_Vector,
) -> c_int {
    // SAFETY: the address is of a live `Callbacks<F>`, which nobody else uses during a call of CVODES.
    let callbacks = unsafe { &mut *user_data.cast::<Callbacks<F>>() };
    let (dim, count) = (callbacks.dim, usize::try_from(count).unwrap_or(0));
    // SAFETY: `y` is a live serial vector of length `dim`, the others are arrays of `count` vectors.
    let (y, columns, rates) = unsafe {
        let y = slice::from_raw_parts(numbers_of(y), dim);
        (y, slice::from_raw_parts(columns, count), slice::from_raw_parts(rates, count))
    };
    let columns = columns.iter().zip(rates).map(|(&s, &rate)| {
        // SAFETY: all are live serial vectors of length `dim`, and the rates distinct from all others.
        unsafe {
            let s = slice::from_raw_parts(numbers_of(s), dim);
            (s, nan_slice(numbers_of(rate), dim))
        }
    });
    let mut variation = std::mem::take(&mut callbacks.variation);
    let answer = callbacks.guard(|field, offset| {
        let y = offset.map_or(y, |offset| offset.state_of(y));
        variation.rates(field, t, y, columns)
    });
    callbacks.variation = variation;
    answer
}
