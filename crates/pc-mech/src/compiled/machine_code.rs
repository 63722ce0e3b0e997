//! The right-hand side f as plain machine code.

use std::sync::Arc;

use pc_expr::Entry;

use crate::compiled::elimination::pivots::PivotPartition;

/// The machine code of f, for callers that manage memory themselves, and the meaning of its outputs.
///
/// [`entry`](MachineCode::entry) writes ẏ and, at the start of its scratch memory, the pivots of M and the sizes
/// with which they are compared, leaving out pivots and sizes that do not change with the state; it returns
/// whether all are finite. Its parameters are the
/// [`code_parameters`](crate::Motion::code_parameters): the values of the parameters and results that depend on
/// them alone. [`is_regular`](MachineCode::is_regular) decides whether ẏ can be trusted. The code stays valid
/// as long as the motion it came from, or a clone of that motion, exists.
#[derive(Clone, Debug)]
pub struct MachineCode {
    entry: Entry,
    scratch: usize,
    rates: usize,
    parameters: usize,
    pivots: Arc<PivotPartition>,
}

impl MachineCode {
    pub(crate) fn new(
        (entry, scratch): (Entry, usize),
        (rates, parameters): (usize, usize),
        pivots: Arc<PivotPartition>,
    ) -> MachineCode {
        MachineCode { entry, scratch, rates, parameters, pivots }
    }

    /// The code.
    #[inline]
    pub fn entry(&self) -> Entry {
        self.entry
    }

    /// The length of the scratch memory that the code needs.
    pub fn scratch_len(&self) -> usize {
        self.scratch
    }

    /// Number of rates, one per component of the state.
    #[inline]
    pub fn rates_len(&self) -> usize {
        self.rates
    }

    /// Number of pivots and sizes at the start of the scratch memory.
    #[inline]
    pub fn watched_len(&self) -> usize {
        self.pivots.moving_len()
    }

    /// The number of [`code_parameters`](crate::Motion::code_parameters).
    pub fn parameters_len(&self) -> usize {
        self.parameters
    }

    /// The number of [`fixed_pivots`](crate::Motion::fixed_pivots).
    pub fn fixed_len(&self) -> usize {
        self.pivots.fixed_len()
    }

    /// Whether no pivot of M vanishes, judged by the numbers `watched` at the start of the scratch memory and the
    /// [`fixed_pivots`](crate::Motion::fixed_pivots), each of which `fixed` returns by its index. Wherever this
    /// function returns false, [`rhs`](pc_expr::VectorField::rhs) fails; `rhs` also fails where a rate is not finite,
    /// which is not checked here.
    ///
    /// # Panics
    /// If there are not [`watched_len`](MachineCode::watched_len) numbers.
    #[inline]
    pub fn is_regular(&self, watched: &[f64], fixed: impl Fn(usize) -> f64) -> bool {
        self.pivots.check(fixed, watched).is_ok()
    }
}
