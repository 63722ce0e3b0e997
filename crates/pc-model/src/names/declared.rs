//! The functions that the text declares.

use pc_expr::parse::Ast;
use pc_expr::{Expr, Number};

use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::document::{Expression, GivenFunction};
use crate::names::scope::Scope;
use crate::names::stage::Stage;

impl<'g, 'd> Scope<'g, 'd> {
    /// The function of `[functions]` with that name.
    pub(super) fn declared(&self, name: &str) -> Option<&'d GivenFunction> {
        self.document.functions.iter().find(|function| function.name.text == name)
    }

    /// The expression for a call of a function of `[functions]`: its value with the arguments put in, or the
    /// undetermined function itself.
    pub(super) fn declared_call(
        &mut self,
        expression: &Expression,
        ast: &Ast,
        (name, args): (&str, &[Ast]),
        stage: Stage,
    ) -> Result<Expr<'g>, ModelError> {
        let Some(function) = self.declared(name).filter(|_| stage != Stage::Parameter) else {
            let (place, allowed) = (stage.place(), stage.allowed());
            let fault = |_| MeaningError::NotHere { name: name.to_owned(), place, allowed };
            return Err(self.error(expression, ast.span, fault));
        };
        let values: Vec<Expr<'g>> =
            args.iter().map(|arg| self.ast(expression, arg, stage)).collect::<Result<_, _>>()?;
        let value = self.value_at(function, values)?;
        self.note(expression, ast.span, value);
        Ok(value)
    }

    /// The function at these arguments.
    fn value_at(
        &mut self,
        function: &'d GivenFunction,
        values: Vec<Expr<'g>>,
    ) -> Result<Expr<'g>, ModelError> {
        let Some(is) = &function.is else {
            return Ok(self.graph.undetermined(&function.name.text, &values));
        };
        // Functions of functions are called a number of times that doubles with each of them.
        if self.graph.check_budget().is_err() {
            return Ok(Number::UNDEFINED.into());
        }
        let arguments = function.arguments.iter().map(String::as_str).zip(values).collect();
        let outer = std::mem::replace(&mut self.arguments, arguments);
        let value = self.resolve(is, Stage::Body);
        self.arguments = outer;
        value
    }

    /// The meaning of a name in the value of a function: one of its arguments, or a parameter.
    pub(super) fn name_in_body(&self, name: &str) -> Option<Expr<'g>> {
        let argument = self.arguments.iter().find(|(argument, _)| *argument == name);
        let is_parameter = || self.document.parameters.iter().any(|parameter| parameter.name.text == name);
        argument.map(|(_, value)| *value).or_else(|| is_parameter().then(|| self.graph.symbol(name)))
    }

    /// Resolves the value of each function, also of those that are not called.
    pub(crate) fn look_at_functions(&mut self) -> Result<(), ModelError> {
        for function in &self.document.functions {
            let values = function.arguments.iter().map(|name| self.graph.symbol(name)).collect();
            let written = self.written.len();
            self.value_at(function, values)?;
            self.written.truncate(written);
        }
        Ok(())
    }
}
