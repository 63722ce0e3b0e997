//! Expressions in the columns of a motion.

use pc_expr::Function;
use pc_expr::parse::{Ast, AstKind, Factor, Sign, parse};

use crate::compare::error::CompareError;
use crate::motion::run::Run;
use crate::motion::table::Table;

/// An expression in the columns and parameters of a motion.
pub(crate) struct Formula {
    text: String,
    ast: Ast,
}

impl Formula {
    /// # Errors
    /// [`CompareError::Expression`]
    pub(crate) fn new(text: &str) -> Result<Formula, CompareError> {
        let ast = parse(text).map_err(|error| CompareError::Expression { text: text.to_owned(), error })?;
        Ok(Formula { text: text.to_owned(), ast })
    }

    /// The values of the expression in the rows of a table of a run, its own or one [of its
    /// accuracy](crate::motion::accuracy::Accuracy).
    ///
    /// # Errors
    /// [`CompareError::UnknownName`], [`CompareError::Derivative`].
    pub(crate) fn column(&self, run: &Run, table: &Table) -> Result<Vec<f64>, CompareError> {
        let columns = table.columns();
        let value = |row: &[f64], name: &str| {
            let column = columns.iter().position(|column| column == name).map(|j| row[j]);
            let parameter =
                || run.parameters.iter().find(|(known, _)| known == name).map(|&(_, value)| value);
            column.or_else(parameter).or((name == "pi").then_some(std::f64::consts::PI))
        };
        table.rows().map(|row| self.value(&self.ast, run, &|name| value(row, name))).collect()
    }

    fn value(&self, ast: &Ast, run: &Run, of: &dyn Fn(&str) -> Option<f64>) -> Result<f64, CompareError> {
        let named = |name: &str| of(name).ok_or_else(|| self.unknown(name, run));
        let value = |ast: &Ast| self.value(ast, run, of);
        Ok(match &ast.kind {
            AstKind::Number(value) => *value,
            AstKind::Name(name) => named(name)?,
            AstKind::Velocity(name) => named(&format!("{name}'"))?,
            AstKind::TotalDerivative(_) => {
                return Err(CompareError::Derivative { text: self.text.clone() });
            }
            AstKind::Sum(terms) => terms.iter().try_fold(0.0, |sum, (sign, term)| {
                let term = value(term)?;
                Ok(if *sign == Sign::Plus { sum + term } else { sum - term })
            })?,
            AstKind::Product(factors) => factors.iter().try_fold(1.0, |product, (side, factor)| {
                let factor = value(factor)?;
                Ok(if *side == Factor::Times { product * factor } else { product / factor })
            })?,
            AstKind::Negate(of) => -value(of)?,
            AstKind::Power(base, exponent) => value(base)?.powf(value(exponent)?),
            AstKind::Call(function, _, arguments) => {
                let mut values = [0.0; 3];
                for (value, argument) in values.iter_mut().zip(arguments) {
                    *value = self.value(argument, run, of)?;
                }
                call(function, &values)
            }
        })
    }

    fn unknown(&self, name: &str, run: &Run) -> CompareError {
        let parameters = run.parameters.iter().map(|(name, _)| name.clone());
        CompareError::UnknownName {
            text: self.text.clone(),
            name: name.to_owned(),
            model: run.title.clone(),
            known: run.table.columns().iter().cloned().chain(parameters).collect(),
        }
    }
}

/// The value of one of the functions that the parser knows.
fn call(function: &str, values: &[f64; 3]) -> f64 {
    match function {
        "tan" => values[0].tan(),
        "cot" => 1.0 / values[0].tan(),
        _ => Function::ALL
            .iter()
            .find(|known| known.name() == function)
            .map_or(f64::NAN, |known| known.eval(values)),
    }
}

#[cfg(test)]
mod tests {
    use pc_expr::parse::FUNCTIONS;

    use super::*;

    #[test]
    fn every_function_of_the_language_has_a_value() {
        for function in FUNCTIONS.iter().filter(|function| function.name != "d") {
            assert!(call(function.name, &[0.5, 0.25, 0.125]).is_finite(), "{}", function.name);
        }
    }
}
