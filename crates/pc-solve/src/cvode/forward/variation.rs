//! The equations of variation, ṡ = (∂f/∂y) s + ∂f/∂p.

use pc_expr::{Failure, VectorField};

use crate::cvode::forward::linearisation::Linearisation;
use crate::error::NonFinite;

/// The equations of the columns of S = ∂y/∂(p, y₀).
#[derive(Debug, Default)]
pub(crate) struct Variation {
    linearisation: Linearisation,
    /// The parameter of each column, none for derivatives with respect to the start.
    parameters: Vec<Option<usize>>,
}

impl Variation {
    pub(crate) fn new(linearisation: Linearisation, parameters: Vec<Option<usize>>) -> Variation {
        Variation { linearisation, parameters }
    }

    /// The parameter of each column, none for derivatives with respect to the start.
    pub(crate) fn parameters(&self) -> &[Option<usize>] {
        &self.parameters
    }

    /// Writes ṡ of all columns s at (t, y).
    pub(crate) fn rates<'a>(
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
