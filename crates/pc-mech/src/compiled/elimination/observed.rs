//! The derivatives of the observables, with M⁻¹ written out.

use pc_expr::{Backend, Expr, ExprError};
use serde::{Deserialize, Serialize};

use crate::compiled::elimination::columns::{Columns, Storage};
use crate::compiled::elimination::products::Products;
use crate::compiled::elimination::symbolic_ldl::Factors;
use crate::compiled::first_order::{FirstOrder, Linearised};
use crate::compiled::point::Point;

/// What is missing where the derivatives of observables were not compiled.
pub(crate) const OF_OBSERVABLES: &str = "derivatives of observables";

/// By what the observables are differentiated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum By {
    State,
    Parameters,
}

/// ∂h/∂y and ∂h/∂p for the observables h(t, y, w(t, y)), in which the accelerations w change as well.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct ObservedSlopes {
    by_state: Slopes,
    by_parameters: Slopes,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
enum Slopes {
    Columns(Columns),
    /// For a large tree, where the entry for each pair of bodies is long.
    Products(Box<Products>),
}

impl ObservedSlopes {
    /// The derivatives of the observables of a system whose unknowns are `unknowns`.
    ///
    /// # Errors
    /// As for [`Program::new`](pc_expr::Program::new).
    pub(crate) fn new<'g>(
        system: &FirstOrder<'g>,
        factors: &Factors<'g>,
        unknowns: &[Expr<'g>],
        backend: Backend,
    ) -> Result<ObservedSlopes, ExprError> {
        let observing = system.with_observables_as_rates();
        let (graph, inputs, rows) = (system.graph, system.inputs(&[]), observing.rates.len());
        let is_large = system.tree.as_ref().is_some_and(|tree| tree.is_large());
        // The accelerations of a large tree stay symbols.
        let known = if is_large { &system.unknowns[..] } else { unknowns };
        let linearised = Linearised::new(&observing, factors, known);
        let slopes = |symbols: &[Expr<'g>]| -> Result<Slopes, ExprError> {
            if !is_large {
                let columns = (rows, linearised.columns(symbols));
                return Ok(Slopes::Columns(Columns::new(graph, &inputs, columns, backend)?));
            }
            let (v, product) = linearised.product(&observing, symbols);
            let unknowns = (&system.unknowns[..], unknowns);
            Ok(Slopes::Products(Box::new(Products::new(graph, &inputs, unknowns, (&v, &product))?)))
        };
        Ok(ObservedSlopes {
            by_state: slopes(&system.state)?,
            by_parameters: slopes(&system.parameter_symbols())?,
        })
    }

    /// Writes the derivatives column by column; they are not finite where an observable has none.
    pub(crate) fn eval(&mut self, by: By, at: Point<'_>, entries: &mut [f64]) {
        let slopes = match by {
            By::State => &mut self.by_state,
            By::Parameters => &mut self.by_parameters,
        };
        // What is not finite stays so: a speed has no derivative at rest, where other observables have one.
        let _ = match slopes {
            Slopes::Columns(columns) => columns.eval(at, entries, Storage::Dense),
            Slopes::Products(products) => products.eval(at, entries, Storage::Dense),
        };
    }
}
