//! The values of compiled expressions.

use pc_expr::Evaluator;

use crate::error::AnalysisError;

/// The outputs of a program at (t, y, p); it uses as many of the first parameters as it has inputs for them.
///
/// # Errors
/// [`AnalysisError::Expr`] with the responsible expression if an output is not finite.
pub(crate) fn values(
    program: &mut Evaluator,
    t: f64,
    state: &[f64],
    parameters: &[f64],
) -> Result<Vec<f64>, AnalysisError> {
    let values = values_or_not(program, t, state, parameters);
    match values.iter().all(|value| value.is_finite()) {
        true => Ok(values),
        false => {
            let parameters = &parameters[..program.program().parameters_len()];
            Err(program.blame(t, state, parameters).into())
        }
    }
}

/// As [`values`], where outputs that are not defined are not finite.
pub(crate) fn values_or_not(program: &mut Evaluator, t: f64, state: &[f64], parameters: &[f64]) -> Vec<f64> {
    let mut values = vec![0.0; program.program().outputs_len()];
    program.eval(t, state, &parameters[..program.program().parameters_len()], &mut values);
    values
}
