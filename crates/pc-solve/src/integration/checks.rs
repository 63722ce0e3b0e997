//! Validation of the input of an integration.

use pc_expr::VectorField;

use crate::error::InputError;
use crate::settings::inequality::Inequality;

pub(crate) fn finite(what: &str, value: f64) -> Result<(), InputError> {
    if value.is_finite() { Ok(()) } else { Err(InputError::NotFinite { what: what.to_owned(), value }) }
}

pub(crate) fn positive(what: &str, value: f64) -> Result<(), InputError> {
    finite(what, value)?;
    if value > 0.0 { Ok(()) } else { Err(InputError::NotPositive { what: what.to_owned(), value }) }
}

pub(crate) fn check_length(what: &'static str, found: usize, expected: usize) -> Result<(), InputError> {
    if found == expected { Ok(()) } else { Err(InputError::Length { what, expected, found }) }
}

/// Checks that a motion of the field can begin at y(t0) = y0.
pub(crate) fn check_start(field: &impl VectorField, t0: f64, y0: &[f64]) -> Result<(), InputError> {
    if field.dim() == 0 {
        return Err(InputError::NoComponents);
    }
    finite("the start time", t0)?;
    check_length("the start", y0.len(), field.dim())?;
    for (i, &value) in y0.iter().enumerate() {
        finite(&format!("{} at the start", field.component_name(i)), value)?;
    }
    Ok(())
}

/// Checks that the initial state satisfies the inequalities, of which there is one for each
/// component, or none at all.
pub(crate) fn check_inequalities(
    field: &impl VectorField,
    y0: &[f64],
    inequalities: &[Inequality],
) -> Result<(), InputError> {
    if !inequalities.is_empty() && field.has_projection() {
        return Err(InputError::InequalitiesOfProjected);
    }
    for (i, (&value, &inequality)) in y0.iter().zip(inequalities).enumerate() {
        if !inequality.holds(value) {
            return Err(InputError::Inequality { component: field.component_name(i), inequality, value });
        }
    }
    Ok(())
}
