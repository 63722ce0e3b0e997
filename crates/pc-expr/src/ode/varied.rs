//! The series of a motion with its derivatives, kept for the columns requested last.

use crate::kernel::evaluator::Backend;
use crate::program::program::Program;
use crate::taylor::coefficients::TaylorSeries;

/// The series of a [program with its equations of variation](Program::with_variation), made on first use.
#[derive(Clone, Debug, Default)]
pub struct VariedSeries(Option<(Vec<Option<usize>>, TaylorSeries)>);

impl VariedSeries {
    /// The series of a program with these columns.
    pub fn of(
        &mut self,
        columns: &[Option<usize>],
        program: &Program,
        backend: Backend,
    ) -> &mut TaylorSeries {
        let fits = |(known, _): &mut (Vec<_>, TaylorSeries)| known == columns;
        let made = || (columns.to_vec(), TaylorSeries::new(&program.with_variation(columns), backend));
        let kept = self.0.take_if(fits).unwrap_or_else(made);
        &mut self.0.insert(kept).1
    }

    /// Discards the series, since the program changes.
    pub fn forget(&mut self) {
        self.0 = None;
    }
}
