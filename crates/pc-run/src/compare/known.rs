//! A column of a motion, with what is known of its errors.

use pc_solve::error_of;

use crate::motion::run::Run;
use crate::motion::table::Table;

/// The values of a column, or of an expression in columns, with their errors.
#[derive(Clone, Debug, PartialEq)]
pub struct Known {
    /// The values, row by row.
    pub values: Vec<f64>,
    /// Their distances from the values of the companion; infinite where there are none.
    pub errors: Vec<f64>,
    /// What rounding errors of the state change.
    pub rounding: Vec<f64>,
}

impl Known {
    /// What a run knows of a function of its tables.
    ///
    /// # Errors
    /// Those of the function.
    pub(crate) fn of<E>(run: &Run, column: impl Fn(&Table) -> Result<Vec<f64>, E>) -> Result<Known, E> {
        let values = column(&run.table)?;
        let (beside, rounded) = match &run.accuracy {
            None => (Vec::new(), Vec::new()),
            Some(accuracy) => {
                let [up, down] = &accuracy.rounded;
                (column(&accuracy.beside)?, vec![column(up)?, column(down)?])
            }
        };
        let error = |(i, &value): (usize, &f64)| beside.get(i).map_or(f64::INFINITY, |&b| error(value, b));
        let change = |(i, &value): (usize, &f64)| {
            // Beyond the edge of its domain a function has no value, and so no change: f64::max leaves NaN out.
            rounded.iter().fold(0.0f64, |most, rounded| most.max((rounded[i] - value).abs()))
        };
        Ok(Known {
            errors: values.iter().enumerate().map(error).collect(),
            rounding: values.iter().enumerate().map(change).collect(),
            values,
        })
    }
}

/// The error of a value; none where both are not finite in the same way, unknown where only one is finite.
fn error(value: f64, beside: f64) -> f64 {
    if value.to_bits() == beside.to_bits() || (value.is_nan() && beside.is_nan()) {
        return if value.is_finite() { error_of(value, beside) } else { 0.0 };
    }
    let error = error_of(value, beside);
    if error.is_finite() { error } else { f64::INFINITY }
}
