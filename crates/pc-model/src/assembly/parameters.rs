//! The values of parameters and inputs: numbers, expressions in preceding values, and tables.

use std::sync::Arc;

use pc_expr::parse::AstKind;
use pc_expr::{Graph, Inputs, Interpreter, Kernel, Program};
use pc_mech::Table;
use serde::{Deserialize, Serialize};

use crate::assembly::tables;
use crate::diagnostics::error::ModelError;
use crate::diagnostics::error_kind::ErrorKind;
use crate::diagnostics::meaning::MeaningError;
use crate::document::{Document, Expression, Input, InputValue, Name};
use crate::names::scope::Scope;

/// The values of the parameters of a model, then of its inputs, in the order of declaration. A value given by
/// an expression in earlier values is updated whenever they change, until it is itself set.
#[derive(Clone, Debug)]
pub struct Parameters {
    values: Vec<f64>,
    formulas: Vec<Formula>,
    /// The indices of rates, each with that of its input.
    rates: Vec<(usize, usize)>,
    t_start: f64,
}

/// The source of a value.
#[derive(Clone, Debug)]
enum Formula {
    /// The value was given as a number.
    Number,
    /// An expression in the preceding parameters, compiled to a program that takes all parameters.
    Of(Box<Interpreter>),
    /// A table, as a function of time; the value is that at the start.
    Table(Arc<Table>),
    /// The rate of an input whose table is no curve.
    Unknown,
    /// An invalid expression or table.
    Wrong(ModelError),
}

/// What replaces the value of a parameter or input in a document.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) enum Change {
    None,
    Number(f64),
    Table(Arc<Table>),
}

/// The names of parameters and inputs, in their order, each with its expression; an input with a table has no
/// expression.
fn written(document: &Document) -> impl Iterator<Item = (&Name, Option<&Expression>)> {
    let parameters =
        document.parameters.iter().map(|parameter| (&parameter.name, Some(&parameter.expression)));
    parameters.chain(document.inputs.iter().map(|input| match &input.value {
        InputValue::Constant(expression) => (&input.name, Some(expression)),
        InputValue::Lists { .. } | InputValue::File(_) | InputValue::RateOf(_) => (&input.name, None),
    }))
}

impl Parameters {
    /// The values in a document.
    pub(crate) fn new(document: &Document) -> Parameters {
        let graph = Graph::new();
        let mut scope = Scope::new(&graph, document);
        let inputs = Inputs {
            time: None,
            state: Vec::new(),
            parameters: written(document).map(|(name, _)| graph.symbol(&name.text)).collect(),
        };
        let t_start = document.simulation.start_time();
        let mut tables = document.inputs.iter().filter_map(|input| tables::of(document, input).transpose());
        let (mut values, mut formulas) = (Vec::new(), Vec::new());
        for (place, (_, expression)) in written(document).enumerate() {
            let (value, formula) = match expression.map(|expression| (expression, &expression.ast.kind)) {
                Some((_, &AstKind::Number(value))) => (value, Formula::Number),
                Some((expression, _)) => match scope.parameter(place, expression) {
                    Ok(value) => match Program::new(&graph, &inputs, &[value]) {
                        Ok(program) => (f64::NAN, Formula::Of(Box::new(Interpreter::new(Arc::new(program))))),
                        Err(_) => (f64::NAN, Formula::Wrong(not_finite(document, expression, f64::NAN))),
                    },
                    Err(error) => (f64::NAN, Formula::Wrong(error)),
                },
                None => match tables.next() {
                    Some(Ok(table)) => {
                        (table.at(t_start).unwrap_or(f64::NAN), Formula::Table(Arc::new(table)))
                    }
                    Some(Err(error)) => (f64::NAN, Formula::Wrong(error)),
                    None => (f64::NAN, Formula::Number), // a rate, which follows
                },
            };
            values.push(value);
            formulas.push(formula);
        }
        let first = document.parameters.len();
        let rate = |(place, input): (usize, &Input)| match input.value {
            InputValue::RateOf(of) => Some((first + place, first + of)),
            _ => None,
        };
        let rates = document.inputs.iter().enumerate().filter_map(rate).collect();
        let mut parameters = Parameters { values, formulas, rates, t_start };
        parameters.follow();
        parameters
    }

    /// The values.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The tables of inputs, each with the index of its input among the values.
    pub fn tables(&self) -> Vec<(usize, &Arc<Table>)> {
        let all = self.formulas.iter().enumerate();
        all.filter_map(|(place, formula)| match formula {
            Formula::Table(table) => Some((place, table)),
            Formula::Number | Formula::Of(_) | Formula::Unknown | Formula::Wrong(_) => None,
        })
        .collect()
    }

    /// Gives the parameter or input with index `place` a value, which replaces its expression. Values that
    /// are expressions in the new value are updated.
    ///
    /// # Panics
    /// Panics if there is no such parameter.
    pub fn set(&mut self, place: usize, value: f64) {
        self.values[place] = value;
        self.formulas[place] = Formula::Number;
        self.follow();
    }

    /// Makes parameter number `place` follow a table from the start on, instead of its present value.
    ///
    /// # Panics
    /// Panics if there is no such parameter.
    pub(crate) fn set_table(&mut self, place: usize, table: Table) {
        self.place_table(place, table);
        self.follow();
    }

    fn place_table(&mut self, place: usize, table: Table) {
        self.values[place] = table.at(self.t_start).unwrap_or(f64::NAN);
        self.formulas[place] = Formula::Table(Arc::new(table));
    }

    /// Sets all values, which replace the expressions. Tables stay in use.
    ///
    /// # Panics
    /// Panics if the number of values is wrong.
    pub fn set_all(&mut self, values: &[f64]) {
        self.values.copy_from_slice(values);
        for formula in &mut self.formulas {
            if !matches!(formula, Formula::Table(_) | Formula::Unknown) {
                *formula = Formula::Number;
            }
        }
    }

    /// What has replaced the values of the document, for each parameter.
    pub(crate) fn changes(&self, document: &Document) -> Vec<Change> {
        let change = |((formula, &value), (_, written)): ((&Formula, &f64), (&Name, Option<&Expression>))| {
            match formula {
                Formula::Number if written.is_some() => Change::Number(value),
                Formula::Table(table) => Change::Table(Arc::clone(table)),
                _ => Change::None,
            }
        };
        self.formulas.iter().zip(&self.values).zip(written(document)).map(change).collect()
    }

    /// Replaces values by what [`changes`](Parameters::changes) has found.
    pub(crate) fn change(&mut self, changes: Vec<Change>) {
        for (place, change) in changes.into_iter().enumerate().take(self.values.len()) {
            match change {
                Change::None => {}
                Change::Number(value) => {
                    self.values[place] = value;
                    self.formulas[place] = Formula::Number;
                }
                Change::Table(table) => {
                    self.values[place] = table.at(self.t_start).unwrap_or(f64::NAN);
                    self.formulas[place] = Formula::Table(table);
                }
            }
        }
        self.follow();
    }

    /// Whether the value with index `place` is given by an expression in others.
    pub fn follows(&self, place: usize) -> bool {
        matches!(self.formulas.get(place), Some(Formula::Of(_)))
    }

    /// Whether the value with index `place` is that of an input with a table.
    pub fn is_table(&self, place: usize) -> bool {
        matches!(self.formulas.get(place), Some(Formula::Table(_)))
    }

    /// # Errors
    /// [`ModelError`] at the first entry that has no finite value; `document` is the document to which these
    /// values belong.
    pub(crate) fn check(&self, document: &Document) -> Result<(), ModelError> {
        for ((formula, value), (name, expression)) in
            self.formulas.iter().zip(&self.values).zip(written(document))
        {
            match (formula, expression) {
                (Formula::Wrong(error), _) => return Err(error.clone()),
                (Formula::Of(_), Some(expression)) if !value.is_finite() => {
                    return Err(not_finite(document, expression, *value));
                }
                (Formula::Table(table), _) if !value.is_finite() => {
                    return Err(tables::not_at_start(document, name, table));
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Whether the value with index `place` is the rate of an input that has none: its table has corners or jumps.
    pub(crate) fn is_unknown(&self, place: usize) -> bool {
        matches!(self.formulas.get(place), Some(Formula::Unknown))
    }

    fn follow(&mut self) {
        for (place, of) in self.rates.clone() {
            let rate = match &self.formulas[of] {
                Formula::Table(table) => table.rate(),
                Formula::Number => {
                    (self.values[place], self.formulas[place]) = (0.0, Formula::Number);
                    continue;
                }
                _ => None,
            };
            match rate {
                Some(rate) => self.place_table(place, rate),
                None => (self.values[place], self.formulas[place]) = (0.0, Formula::Unknown),
            }
        }
        for (place, formula) in self.formulas.iter_mut().enumerate() {
            if let Formula::Of(program) = formula {
                let mut value = [f64::NAN];
                program.eval(0.0, &[], &self.values, &mut value);
                self.values[place] = value[0];
            }
        }
    }
}

fn not_finite(document: &Document, expression: &Expression, value: f64) -> ModelError {
    let fault = MeaningError::ParameterNotFinite { text: expression.text.clone(), value };
    document.source.error(&expression.place(expression.ast.span), ErrorKind::Meaning(fault))
}
