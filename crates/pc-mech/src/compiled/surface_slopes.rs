//! The derivatives of the functions that vanish on the surfaces between pieces of a motion.

use pc_expr::{Backend, Evaluator, Expr, Program};
use serde::{Deserialize, Serialize};

use crate::compiled::first_order::FirstOrder;
use crate::error::MechError;

/// The derivatives of the functions with respect to time, state and parameters.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct SurfaceSlopes {
    pub(super) entries: Evaluator,
    /// The surface and the column of each entry; the columns are time, state, parameters.
    pub(super) places: Vec<(usize, usize)>,
    values: Vec<f64>,
    pub(super) by_parameters: bool,
}

impl SurfaceSlopes {
    pub(super) fn new<'g>(
        system: &FirstOrder<'g>,
        functions: &[Expr<'g>],
        by_parameters: bool,
    ) -> Result<SurfaceSlopes, MechError> {
        let mut symbols = vec![system.time];
        symbols.extend(&system.state);
        symbols.extend(system.parameter_symbols());
        // Tables make parameters functions of time.
        let is_needed = |&column: &usize| {
            by_parameters || column <= system.state.len() || system.varying.contains(&symbols[column])
        };
        let columns: Vec<usize> = (0..symbols.len()).filter(is_needed).collect();
        let symbols: Vec<Expr<'g>> = columns.iter().map(|&column| symbols[column]).collect();
        let rows = system.graph.jacobian(functions, &symbols);
        let entries = rows.iter().enumerate().flat_map(|(surface, row)| {
            row.iter().map({
                let columns = &columns;
                move |&(column, entry)| ((surface, columns[column]), entry)
            })
        });
        let (places, entries): (Vec<_>, Vec<Expr<'g>>) = entries.unzip();
        let program = Program::new(system.graph, &system.inputs(&[]), &entries)?;
        let values = vec![0.0; places.len()];
        Ok(SurfaceSlopes {
            entries: Evaluator::new(program, Backend::Interpreter),
            places,
            values,
            by_parameters,
        })
    }

    /// The slopes of one surface, each with its column.
    pub(super) fn of(
        &mut self,
        surface: usize,
        (t, y, p): (f64, &[f64], &[f64]),
    ) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.entries.eval(t, y, p, &mut self.values);
        let all = self.places.iter().zip(&self.values);
        all.filter(move |(place, _)| place.0 == surface).map(|(place, &value)| (place.1, value))
    }
}
