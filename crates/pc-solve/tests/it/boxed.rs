//! Vector fields of closures, all of one type: the integrators are compiled once for all of them.

use pc_solve::{Failure, FnField, VectorField};

/// f of any closure.
pub(crate) type Rhs<'a> = Box<dyn FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure> + 'a>;

/// As [`pc_solve::from_fn`].
pub(crate) fn from_fn<'a>(
    dim: usize,
    rhs: impl FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure> + 'a,
) -> FnField<Rhs<'a>> {
    pc_solve::from_fn(dim, Box::new(rhs))
}

/// Any field, of one type.
pub(crate) fn erased<'a>(field: impl VectorField + 'a) -> Box<dyn VectorField + 'a> {
    Box::new(field)
}
