//! Matrices in compressed-column form, wrapped as `SUNMatrix`.

use std::ffi::{c_int, c_void};
use std::slice;
use std::sync::Arc;

use pc_expr::{Failure, Pattern, VectorField};
use sundials_sys as sys;

use super::handles::Matrix;
use crate::cvode::callback::Callbacks;
use crate::cvode::context::Context;
use crate::cvode::handles::numbers_of;
use crate::error::{NonFinite, SolveError};

const SUCCESS: c_int = 0;

/// The pattern of I − γ ∂f/∂y, and the positions in it of the entries of ∂f/∂y and of the diagonal.
#[derive(Clone)]
pub(super) struct Places {
    pattern: Arc<Pattern>,
    entries: Arc<[usize]>,
    diagonal: Arc<[usize]>,
}

impl Places {
    /// The positions for the pattern of a square `jacobian`.
    pub(super) fn new(jacobian: &Pattern) -> Places {
        let n = jacobian.columns();
        let with_diagonal = (0..n).map(|j| jacobian.column(j).iter().copied().chain([j]));
        let pattern = Pattern::from_columns(n, with_diagonal);
        let place = |(i, j): (usize, usize)| {
            pattern.column_starts()[j] + pattern.column(j).partition_point(|&row| row < i)
        };
        let entries = jacobian.entries().map(place).collect();
        let diagonal = (0..n).map(|j| place((j, j))).collect();
        Places { pattern: Arc::new(pattern), entries, diagonal }
    }

    /// The pattern of I − γ ∂f/∂y.
    pub(super) fn pattern(&self) -> &Pattern {
        &self.pattern
    }
}

/// The content of a `SUNMatrix`.
pub(super) struct Compressed {
    places: Places,
    values: Vec<f64>,
}

impl Compressed {
    pub(super) fn pattern(&self) -> &Pattern {
        &self.places.pattern
    }

    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    /// Sets entry `k` of ∂f/∂y, counted in the order of the field's pattern.
    pub(super) fn set(&mut self, k: usize, value: f64) {
        self.values[self.places.entries[k]] = value;
    }
}

/// A matrix of zeros with the pattern of `places`.
pub(super) fn matrix(context: &mut Context, places: &Places) -> Result<Matrix, SolveError> {
    // SAFETY: the context is live.
    let raw = unsafe { new(context.raw(), places) };
    context.check_new("SUNMatNewEmpty", raw).map(Matrix::from_raw)
}

/// # Safety
/// The context is live.
unsafe fn new(context: sys::SUNContext, places: &Places) -> sys::SUNMatrix {
    // SAFETY: the context is live.
    let raw = unsafe { sys::SUNMatNewEmpty(context) };
    if raw.is_null() {
        return raw;
    }
    let content = Compressed { places: places.clone(), values: vec![0.0; places.pattern.len()] };
    // SAFETY: the matrix is live and ours alone, and so is its table of operations.
    unsafe {
        (*raw).content = Box::into_raw(Box::new(content)).cast();
        let operations = &mut *(*raw).ops;
        operations.getid = Some(id);
        operations.clone = Some(clone);
        operations.destroy = Some(destroy);
        operations.zero = Some(zero);
        operations.copy = Some(copy);
        operations.scaleaddi = Some(scale_add_identity);
    }
    raw
}

/// The content of `matrix`.
///
/// # Safety
/// `matrix` was made by [`matrix`] or is a clone of such a matrix, and nothing else uses it during
/// `'a`.
pub(super) unsafe fn content<'a>(matrix: sys::SUNMatrix) -> &'a mut Compressed {
    // SAFETY: as promised.
    unsafe { &mut *(*matrix).content.cast::<Compressed>() }
}

unsafe extern "C" fn id(_matrix: sys::SUNMatrix) -> sys::SUNMatrix_ID {
    sys::SUNMatrix_ID_SUNMATRIX_CUSTOM
}

unsafe extern "C" fn clone(matrix: sys::SUNMatrix) -> sys::SUNMatrix {
    // SAFETY: the matrix is ours, live, and so is its context.
    unsafe { new((*matrix).sunctx, &content(matrix).places) }
}

unsafe extern "C" fn destroy(matrix: sys::SUNMatrix) {
    // SAFETY: the content was made by `Box::into_raw` and is owned by the matrix, which is freed
    // with it.
    unsafe {
        drop(Box::from_raw((*matrix).content.cast::<Compressed>()));
        sys::SUNMatFreeEmpty(matrix);
    }
}

unsafe extern "C" fn zero(matrix: sys::SUNMatrix) -> sys::SUNErrCode {
    // SAFETY: the matrix is ours.
    unsafe { content(matrix) }.values.fill(0.0);
    SUCCESS
}

unsafe extern "C" fn copy(from: sys::SUNMatrix, to: sys::SUNMatrix) -> sys::SUNErrCode {
    // SAFETY: both are ours, distinct, and one is a clone of the other.
    let (from, to) = unsafe { (content(from), content(to)) };
    to.values.copy_from_slice(&from.values);
    SUCCESS
}

/// A becomes c A + I.
unsafe extern "C" fn scale_add_identity(c: f64, matrix: sys::SUNMatrix) -> sys::SUNErrCode {
    // SAFETY: the matrix is ours.
    let Compressed { places, values } = unsafe { content(matrix) };
    for value in values.iter_mut() {
        *value *= c;
    }
    for &k in places.diagonal.iter() {
        values[k] += 1.0;
    }
    SUCCESS
}

impl<F: VectorField> Callbacks<F> {
    /// Evaluates the sparse Jacobian and passes the row, column, value and position (in the field's
    /// order) of each entry to `write`.
    pub(super) fn entries(
        &mut self,
        t: f64,
        y: &[f64],
        mut write: impl FnMut((usize, usize), f64, usize),
    ) -> c_int {
        let mut entries = std::mem::take(&mut self.linear.entries);
        entries.fill(f64::NAN); // To detect entries that the field leaves unwritten.
        let answer = self.guard(|field, offset| {
            let y = offset.map_or(y, |offset| offset.state_of(y));
            field.sparse_jacobian(t, y, &mut entries)?;
            let places = field.sparsity().into_iter().flat_map(Pattern::entries);
            for (k, ((i, j), &value)) in places.zip(&entries).enumerate() {
                if !value.is_finite() {
                    let (row, column) = (field.component_name(i), field.component_name(j));
                    return Err(Failure::recoverable(NonFinite::Jacobian { row, column, value, t }));
                }
                write((i, j), value, k);
            }
            Ok(())
        });
        self.linear.entries = entries;
        answer
    }
}

/// A `CVLsJacFn` that writes the field's sparse Jacobian.
///
/// # Safety
/// Called by CVODES with the address of a [`UserData<F>`](crate::cvode::callback::UserData), a
/// vector of its dimension and a [`matrix`] of its pattern.
pub(super) unsafe extern "C" fn jacobian<F: VectorField>(
    t: f64,
    y: sys::N_Vector,
    _ydot: sys::N_Vector,
    matrix: sys::SUNMatrix,
    user_data: *mut c_void,
    _tmp1: sys::N_Vector,
    _tmp2: sys::N_Vector,
    _tmp3: sys::N_Vector,
) -> c_int {
    // SAFETY: the address is of a live `Callbacks<F>`, which nobody else uses during a call of
    // CVODES.
    let callbacks = unsafe { &mut *user_data.cast::<Callbacks<F>>() };
    // SAFETY: `y` is a live serial vector of length `dim`; `matrix` is ours, and CVODES has set it
    // to 0.
    let (y, matrix) = unsafe { (slice::from_raw_parts(numbers_of(y), callbacks.dim), content(matrix)) };
    callbacks.entries(t, y, |_, value, k| matrix.set(k, value))
}
