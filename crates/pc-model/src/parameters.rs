//! The values of parameters: numbers, and expressions in those before them.

use std::sync::Arc;

use pc_expr::parse::AstKind;
use pc_expr::{Graph, Inputs, Interpreter, Kernel, Program};

use crate::document::{Document, Expression};
use crate::error::{ErrorKind, ModelError};
use crate::fault::Fault;
use crate::scope::Scope;

/// The values of the parameters of a model, in the order of declaration. One that is an expression in those before it
/// follows these, until it is set itself.
#[derive(Clone, Debug)]
pub struct Parameters {
    values: Vec<f64>,
    formulas: Vec<Formula>,
}

/// Where a value comes from.
#[derive(Clone, Debug)]
enum Formula {
    /// It was given as a number.
    Number,
    /// An expression in all parameters, of which it contains none but those before it.
    Of(Arc<Program>),
    /// An expression that means nothing.
    Wrong(ModelError),
}

impl Parameters {
    /// The values in a document.
    pub(crate) fn new(document: &Document) -> Parameters {
        let graph = Graph::new();
        let mut scope = Scope::new(&graph, document);
        let inputs = Inputs {
            time: None,
            state: Vec::new(),
            parameters: document.parameters.iter().map(|p| graph.symbol(&p.name.text)).collect(),
        };
        let (mut values, mut formulas) = (Vec::new(), Vec::new());
        for (place, parameter) in document.parameters.iter().enumerate() {
            let expression = &parameter.expression;
            let (value, formula) = match expression.ast.kind {
                AstKind::Number(value) => (value, Formula::Number),
                _ => match scope.parameter(place).map(|value| Program::new(&graph, &inputs, &[value])) {
                    Ok(Ok(program)) => (f64::NAN, Formula::Of(Arc::new(program))),
                    Ok(Err(_)) => (f64::NAN, Formula::Wrong(not_finite(document, expression, f64::NAN))),
                    Err(error) => (f64::NAN, Formula::Wrong(error)),
                },
            };
            values.push(value);
            formulas.push(formula);
        }
        let mut parameters = Parameters { values, formulas };
        parameters.follow();
        parameters
    }

    /// The values.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Gives number `place` a value, which then stands for its expression. Those that are expressions in it follow.
    ///
    /// # Panics
    /// If there is no such parameter.
    pub fn set(&mut self, place: usize, value: f64) {
        self.values[place] = value;
        self.formulas[place] = Formula::Number;
        self.follow();
    }

    /// # Errors
    /// [`ModelError`] at the first expression of the document, whose values these are, that has no finite value.
    pub(crate) fn check(&self, document: &Document) -> Result<(), ModelError> {
        for ((formula, value), parameter) in self.formulas.iter().zip(&self.values).zip(&document.parameters)
        {
            match formula {
                Formula::Wrong(error) => return Err(error.clone()),
                Formula::Of(_) if !value.is_finite() => {
                    return Err(not_finite(document, &parameter.expression, *value));
                }
                Formula::Of(_) | Formula::Number => {}
            }
        }
        Ok(())
    }

    fn follow(&mut self) {
        for (place, formula) in self.formulas.iter().enumerate() {
            if let Formula::Of(program) = formula {
                let mut value = [f64::NAN];
                Interpreter::new(Arc::clone(program)).eval(0.0, &[], &self.values, &mut value);
                self.values[place] = value[0];
            }
        }
    }
}

fn not_finite(document: &Document, expression: &Expression, value: f64) -> ModelError {
    let fault = Fault::ParameterNotFinite { text: expression.text.clone(), value };
    document.source.error(&expression.place(expression.ast.span), ErrorKind::Meaning(fault))
}
