//! Derivatives of a start, and of the columns of a table, with respect to parameters.

use crate::assembly::assembly::Assembly;
use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::flow::flow::Flow;
use crate::model::model::Model;

/// The step for a central difference with respect to a parameter of this value. This step makes truncation
/// and rounding errors equal, so that the difference is accurate to ten digits.
fn step(value: f64) -> f64 {
    let size = if value == 0.0 { 1.0 } else { value.abs() };
    f64::EPSILON.cbrt() * size
}

impl Flow {
    /// The derivative ∂y₀/∂pⱼ of the start of this flow of a model with respect to number j of the
    /// [parameters](Model::parameters): the start of a column of sensitivities. The derivative is a central difference of
    /// starts, since start values may be expressions in parameters or may be moved onto constraints that contain
    /// parameters. No equation is derived for this.
    ///
    /// # Errors
    /// [`ModelError`] if the model has no start for nearby values of the parameter, for example because the start
    /// is not moved onto constraints that depend on it; for an input with a table; and for a parameter given by
    /// an expression in other parameters.
    ///
    /// # Panics
    /// Panics if there is no such parameter.
    pub fn start_by_parameter(
        &self,
        model: &Model,
        assembly: &Assembly<'_>,
        j: usize,
    ) -> Result<Vec<f64>, ModelError> {
        let values = model.parameter_values();
        let refused = |why: &str, help| {
            let name = model.parameters().nth(j).map_or("", |(name, _)| name);
            let message = format!("there are no sensitivities by `{name}`: {why}");
            model.document().error(&model.parameter_place(j), MeaningError::NoForm { message, help })
        };
        if values.is_table(j) {
            return Err(refused("it is a function of time", "choose parameters that are numbers"));
        }
        let value = values.values()[j];
        let mut ends = Vec::new();
        for end in [value + step(value), value - step(value)] {
            let mut moved = model.clone();
            moved.set_parameter(j, end);
            let others = moved.parameter_values().values().iter().zip(values.values()).enumerate();
            if others.into_iter().any(|(i, (moved, held))| i != j && moved != held) {
                return Err(refused(
                    "other parameters are expressions in it",
                    "set those to numbers, for example with --set, or write their expressions out in the model",
                ));
            }
            ends.push(self.start_with(&moved, assembly)?);
        }
        let length = (value + step(value)) - (value - step(value));
        Ok(ends[0].iter().zip(&ends[1]).map(|(ahead, behind)| (ahead - behind) / length).collect())
    }

    /// The start of a model with the same text but other values of its parameters.
    fn start_with(&self, model: &Model, assembly: &Assembly<'_>) -> Result<Vec<f64>, ModelError> {
        let start = assembly.start_with(model)?;
        let mut flow = self.clone();
        flow.set_parameters(model.parameter_values().values());
        // A reduced form has fewer coordinates.
        let coordinates: Vec<String> =
            assembly.system.frame().coordinates().iter().map(ToString::to_string).collect();
        let (x, rest) = start.split_at(coordinates.len());
        let of_form = flow.motion.names()[..flow.motion.coordinates()].iter();
        let places = of_form.filter_map(|name| coordinates.iter().position(|known| known == name));
        let all: Vec<f64> = places.map(|place| x[place]).chain(rest.iter().copied()).collect();
        assembly.placed(flow.state_of(assembly.t_start, &all))
    }

    /// The derivatives with respect to parameter number j of the columns [`names`](Flow::names), which are
    /// coordinates, quasi-velocities and first-order states, for a state whose own derivative is `column`. The
    /// derivatives of columns that are not components of the state are central differences, accurate to ten digits.
    ///
    /// # Panics
    /// Panics if there is no such parameter, or `column` does not have the length of the state.
    pub fn derivative(&self, t: f64, state: &[f64], column: &[f64], j: usize) -> Vec<f64> {
        assert_eq!(column.len(), state.len(), "length of the state");
        let components = self.motion.names();
        let place = |name: &String| components.iter().position(|component| component == name);
        if let Some(places) = self.names.iter().map(place).collect::<Option<Vec<usize>>>() {
            return places.into_iter().map(|place| column[place]).collect();
        }
        let parameters = self.reading.parameters().to_vec();
        let largest = |v: &[f64]| v.iter().fold(0.0, |size: f64, v| size.max(v.abs()));
        // Both the parameter and the state move by at most that part of their size.
        let step = step(parameters[j]).min(step(largest(state)) / largest(column));
        let shown = |sign: f64| {
            let mut moved = parameters.clone();
            moved[j] += sign * step;
            let state: Vec<f64> = state.iter().zip(column).map(|(y, s)| y + sign * step * s).collect();
            let mut row = self.with_values(&moved, state.clone()).row(t, &state);
            row.truncate(self.names.len());
            row
        };
        let (ahead, behind) = (shown(1.0), shown(-1.0));
        ahead.iter().zip(behind).map(|(ahead, behind)| (ahead - behind) / (2.0 * step)).collect()
    }
}
