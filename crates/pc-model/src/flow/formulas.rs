//! Values that the text gives as formulas in parameters: those of other parameters, and of the start.

use pc_expr::SymbolPlaces;
use pc_mech::Expr;

use crate::assembly::assembly::Assembly;
use crate::diagnostics::error::ModelError;
use crate::document::Expression;
use crate::flow::free_form::FreeForm;
use crate::model::model::Model;
use crate::names::scope::{Scope, entry};
use crate::names::stage::Stage;

impl<'g> Assembly<'g> {
    /// The parameters given by expressions in other parameters: the index of each, with its value as a
    /// function of the parameters that are numbers. `model` is the model from which this assembly was made.
    ///
    /// # Errors
    /// [`ModelError`] for an expression without a meaning; a model with such an expression could not have
    /// been assembled.
    pub fn parameter_formulas(&self, model: &Model) -> Result<Vec<(usize, Expr<'g>)>, ModelError> {
        let (graph, document) = (self.system.graph(), model.document());
        let mut scope = Scope::new(graph, document);
        let (mut known, mut formulas) = (Vec::new(), Vec::new());
        for (place, parameter) in document.parameters.iter().enumerate() {
            if model.parameter_values().follows(place) {
                let value = scope.parameter(place, &parameter.expression)?;
                let value = graph.substitute(&[value], &known)[0];
                known.push((graph.symbol(&parameter.name.text), value));
                formulas.push((place, value));
            }
        }
        Ok(formulas)
    }

    /// The start of a form in its coordinates, quasi-velocities and first-order states. Values are functions
    /// of parameters if the text gives them as such; they are numbers if the text gives numbers, if the
    /// values were determined from velocities, or if they were moved onto constraints.
    ///
    /// # Errors
    /// As for [`parameter_formulas`](Assembly::parameter_formulas).
    pub fn start_formulas(&self, model: &Model, form: &FreeForm<'g>) -> Result<Vec<Expr<'g>>, ModelError> {
        let (graph, system) = (self.system.graph(), &self.system);
        let mut written = self.written(model)?;
        let (n, states) = (system.frame().coordinates().len(), system.states().len());
        let rest = written.split_off(n + self.declared);
        written.resize(self.start.len() - states, None);
        written.extend(rest);
        let mut known: Vec<(Expr<'g>, Expr<'g>)> = vec![(system.frame().time(), self.t_start.into())];
        for ((symbol, formula), &value) in system.state().into_iter().zip(written).zip(&self.start) {
            let at_start = formula.and_then(|formula| {
                graph.evaluate(&[formula], system.parameters()).ok().map(|values| (formula, values[0]))
            });
            let formula = at_start.filter(|&(_, found)| found == value).map(|(formula, _)| formula);
            known.push((symbol, formula.unwrap_or_else(|| value.into())));
        }
        let places = SymbolPlaces::of(&known.iter().map(|&(symbol, _)| symbol).collect::<Vec<_>>());
        let of = |symbol: &Expr<'g>| places.get(*symbol).map_or(*symbol, |place| known[place].1);
        let coordinates = form.system.frame().coordinates().iter().map(of);
        let eta = graph.substitute(&form.definitions, &known);
        let states: Vec<Expr<'g>> = form.system.states().iter().map(|(z, _)| of(z)).collect();
        Ok(coordinates.chain(eta).chain(states).collect())
    }

    /// The start values of coordinates, declared quasi-velocities and first-order states in the text; `None`
    /// for those that are not given or that were set to other values.
    fn written(&self, model: &Model) -> Result<Vec<Option<Expr<'g>>>, ModelError> {
        let document = model.document();
        let mut scope = Scope::new(self.system.graph(), document);
        let velocity = |name: &str| {
            let known = entry(&document.start_velocities, name);
            known.map(|velocity| &velocity.expression)
        };
        let coordinates = document.coordinates.iter().map(|x| Some(&x.expression));
        let velocities = document.coordinates.iter().map(|x| velocity(&x.name.text));
        let eta = document.quasi_velocities.iter().map(|eta| eta.start.as_ref());
        let states = document.states.iter().map(|state| state.start.as_ref());
        let all: Vec<Option<&Expression>> = match document.quasi_velocities.is_empty() {
            true => coordinates.chain(velocities).chain(states).collect(),
            false => coordinates.chain(eta).chain(states).collect(),
        };
        let overridden = |place: usize| model.overridden_starts().iter().any(|&(known, _)| known == place);
        let formula = |(place, expression): (usize, Option<&Expression>)| match expression {
            Some(expression) if !overridden(place) => scope.resolve(expression, Stage::Start).map(Some),
            _ => Ok(None),
        };
        all.into_iter().enumerate().map(formula).collect()
    }
}
