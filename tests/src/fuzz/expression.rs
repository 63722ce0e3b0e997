//! Expressions that are written into texts of models, and evaluated here with their rates of change.

use std::collections::HashMap;
use std::fmt;

use num_dual::{Dual64, DualNum};
use pc_expr::parse::{Ast, AstKind, FUNCTIONS, Factor, ParseError, Sign, parse};

/// An expression of the text format.
#[derive(Clone, Debug, PartialEq)]
pub enum Expression {
    /// A number.
    Number(f64),
    /// A name, or a velocity `x'`.
    Symbol(String),
    /// The sum of its terms.
    Sum(Vec<Expression>),
    /// The product of its factors.
    Product(Vec<Expression>),
    /// Numerator and denominator.
    Quotient(Box<Expression>, Box<Expression>),
    /// Base and exponent.
    Power(Box<Expression>, f64),
    /// A function of the format with its arguments.
    Call(&'static str, Vec<Expression>),
    /// The total derivative by time, d(..), which has no value here.
    Rate(Box<Expression>),
}

/// Values of symbols, each with a rate of change.
pub type Values = HashMap<String, Dual64>;

impl Expression {
    /// The expression of a text, with constant exponents.
    ///
    /// # Errors
    /// [`ParseError`] where it is none.
    pub fn parse(text: &str) -> Result<Expression, ParseError> {
        parse(text).map(|ast| of_tree(&ast))
    }

    /// A name, or a velocity `x'`.
    pub fn symbol(name: impl AsRef<str>) -> Expression {
        Expression::Symbol(name.as_ref().to_owned())
    }

    /// The velocity of a coordinate.
    pub fn velocity(coordinate: impl AsRef<str>) -> Expression {
        Expression::Symbol(format!("{}'", coordinate.as_ref()))
    }

    /// A sum, zero of no terms.
    pub fn sum(terms: Vec<Expression>) -> Expression {
        let mut terms: Vec<Expression> = terms.into_iter().filter(|term| !term.is_zero()).collect();
        match terms.len() {
            0 => Expression::Number(0.0),
            1 => terms.remove(0),
            _ => Expression::Sum(terms),
        }
    }

    /// A product, without factors 1.
    pub fn product(factors: Vec<Expression>) -> Expression {
        if factors.iter().any(Expression::is_zero) {
            return Expression::Number(0.0);
        }
        let mut factors: Vec<Expression> =
            factors.into_iter().filter(|factor| *factor != Expression::Number(1.0)).collect();
        match factors.len() {
            0 => Expression::Number(1.0),
            1 => factors.remove(0),
            _ => Expression::Product(factors),
        }
    }

    /// The product with a number.
    pub fn times(self, factor: f64) -> Expression {
        Expression::product(vec![Expression::Number(factor), self])
    }

    /// The quotient by a divisor.
    pub fn over(self, divisor: Expression) -> Expression {
        match divisor {
            Expression::Number(1.0) => self,
            divisor => Expression::Quotient(Box::new(self), Box::new(divisor)),
        }
    }

    /// A power.
    pub fn power(self, exponent: f64) -> Expression {
        Expression::Power(Box::new(self), exponent)
    }

    /// d(..)
    pub fn rate(self) -> Expression {
        Expression::Rate(Box::new(self))
    }

    /// Whether it is the number 0.
    pub fn is_zero(&self) -> bool {
        *self == Expression::Number(0.0)
    }

    /// Its value, with the rate of change along that of the symbols; not a number where a symbol has no value.
    pub fn value(&self, values: &Values) -> Dual64 {
        let all = |parts: &[Expression]| -> Vec<Dual64> { parts.iter().map(|p| p.value(values)).collect() };
        match self {
            Expression::Number(number) => Dual64::from(*number),
            Expression::Symbol(name) => match name.as_str() {
                "pi" => Dual64::from(std::f64::consts::PI),
                name => values.get(name).copied().unwrap_or(Dual64::from(f64::NAN)),
            },
            Expression::Sum(terms) => all(terms).into_iter().fold(Dual64::from(0.0), |sum, term| sum + term),
            Expression::Product(factors) => {
                all(factors).into_iter().fold(Dual64::from(1.0), |product, factor| product * factor)
            }
            Expression::Quotient(numerator, denominator) => {
                numerator.value(values) / denominator.value(values)
            }
            Expression::Power(base, exponent) => power(base.value(values), *exponent),
            Expression::Call(function, arguments) => call(function, &all(arguments)),
            Expression::Rate(_) => Dual64::from(f64::NAN),
        }
    }

    /// The expression with others in place of symbols, all at once.
    pub fn substitute(&self, replacements: &[(String, Expression)]) -> Expression {
        let all = |parts: &[Expression]| parts.iter().map(|part| part.substitute(replacements)).collect();
        match self {
            Expression::Number(_) => self.clone(),
            Expression::Symbol(name) => {
                let known = replacements.iter().find(|(symbol, _)| symbol == name);
                known.map_or_else(|| self.clone(), |(_, value)| value.clone())
            }
            Expression::Sum(terms) => Expression::sum(all(terms)),
            Expression::Product(factors) => Expression::product(all(factors)),
            Expression::Quotient(numerator, denominator) => {
                let numerator = numerator.substitute(replacements);
                if numerator.is_zero() {
                    return numerator;
                }
                numerator.over(denominator.substitute(replacements))
            }
            Expression::Power(base, exponent) => base.substitute(replacements).power(*exponent),
            Expression::Call(function, arguments) => Expression::Call(function, all(arguments)),
            Expression::Rate(of) => of.substitute(replacements).rate(),
        }
    }

    /// Whether a symbol occurs in it.
    pub fn mentions(&self, name: &str) -> bool {
        match self {
            Expression::Number(_) => false,
            Expression::Symbol(symbol) => symbol == name,
            Expression::Sum(parts) | Expression::Product(parts) | Expression::Call(_, parts) => {
                parts.iter().any(|part| part.mentions(name))
            }
            Expression::Quotient(a, b) => a.mentions(name) || b.mentions(name),
            Expression::Power(base, _) | Expression::Rate(base) => base.mentions(name),
        }
    }

    /// Expressions with one part less, the shorter ones first.
    pub fn smaller(&self) -> Vec<Expression> {
        let mut smaller = Vec::new();
        match self {
            Expression::Number(number) if [0.0, 1.0].contains(number) => {}
            Expression::Number(_) => smaller.push(Expression::Number(1.0)),
            Expression::Symbol(_) => {}
            Expression::Sum(parts) | Expression::Product(parts) => {
                let build = |parts: Vec<Expression>| match self {
                    Expression::Sum(_) => Expression::sum(parts),
                    _ => Expression::product(parts),
                };
                for i in 0..parts.len() {
                    let mut rest = parts.clone();
                    rest.remove(i);
                    smaller.push(build(rest));
                }
                for (i, part) in parts.iter().enumerate() {
                    for less in part.smaller() {
                        let mut changed = parts.clone();
                        changed[i] = less;
                        smaller.push(build(changed));
                    }
                }
            }
            Expression::Quotient(numerator, denominator) => {
                smaller.push((**numerator).clone());
                smaller.extend(numerator.smaller().into_iter().map(|n| n.over((**denominator).clone())));
                smaller.extend(denominator.smaller().into_iter().map(|d| (**numerator).clone().over(d)));
            }
            Expression::Power(base, exponent) => {
                smaller.push((**base).clone());
                smaller.extend(base.smaller().into_iter().map(|base| base.power(*exponent)));
            }
            Expression::Call(function, arguments) => {
                smaller.extend(arguments.iter().cloned());
                for (i, argument) in arguments.iter().enumerate() {
                    for less in argument.smaller() {
                        let mut changed = arguments.clone();
                        changed[i] = less;
                        smaller.push(Expression::Call(function, changed));
                    }
                }
            }
            Expression::Rate(of) => {
                smaller.push((**of).clone());
                smaller.extend(of.smaller().into_iter().map(Expression::rate));
            }
        }
        smaller
    }
}

fn of_tree(ast: &Ast) -> Expression {
    match &ast.kind {
        AstKind::Number(number) => Expression::Number(*number),
        AstKind::Name(name) => Expression::symbol(name),
        AstKind::Velocity(name) => Expression::velocity(name),
        AstKind::TotalDerivative(of) => of_tree(of).rate(),
        AstKind::Negate(part) => of_tree(part).times(-1.0),
        AstKind::Sum(terms) => Expression::sum(
            terms
                .iter()
                .map(|(sign, term)| match sign {
                    Sign::Plus => of_tree(term),
                    Sign::Minus => of_tree(term).times(-1.0),
                })
                .collect(),
        ),
        AstKind::Product(factors) => {
            let side = |wanted: Factor| {
                let parts = factors.iter().filter(|(factor, _)| *factor == wanted);
                Expression::product(parts.map(|(_, part)| of_tree(part)).collect())
            };
            side(Factor::Times).over(side(Factor::Over))
        }
        AstKind::Power(base, exponent) => of_tree(base).power(of_tree(exponent).value(&Values::new()).re),
        AstKind::Call(name, _, arguments) => {
            let function = FUNCTIONS.iter().find(|function| function.name == name);
            let name = function.map_or("unknown", |function| function.name);
            Expression::Call(name, arguments.iter().map(of_tree).collect())
        }
    }
}

/// By products where the exponent is an integer: the base may be zero or negative.
fn power(base: Dual64, exponent: f64) -> Dual64 {
    if exponent.fract() != 0.0 {
        return base.powf(exponent);
    }
    let factor = if exponent < 0.0 { base.recip() } else { base };
    (0..exponent.abs() as usize).fold(Dual64::from(1.0), |product, _| product * factor)
}

fn call(function: &str, arguments: &[Dual64]) -> Dual64 {
    let x = arguments[0];
    match function {
        "sin" => x.sin(),
        "cos" => x.cos(),
        "tan" => x.tan(),
        "cot" => x.tan().recip(),
        "atan" => x.atan(),
        "sinh" => x.sinh(),
        "cosh" => x.cosh(),
        "tanh" => x.tanh(),
        "exp" => x.exp(),
        "log" => x.ln(),
        "sqrt" => x.sqrt(),
        "abs" => x * x.re.signum(),
        "min" => arguments[usize::from(x.re > arguments[1].re)],
        "max" => arguments[usize::from(x.re < arguments[1].re)],
        "step" => arguments[if x.re >= 0.0 { 1 } else { 2 }],
        _ => Dual64::from(f64::NAN),
    }
}

impl fmt::Display for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let joined = |f: &mut fmt::Formatter<'_>, parts: &[Expression], sign: &str| {
            for (i, part) in parts.iter().enumerate() {
                if i > 0 {
                    f.write_str(sign)?;
                }
                match (part, sign) {
                    (Expression::Sum(_), _) | (Expression::Quotient(..), "*") => write!(f, "({part})")?,
                    _ => write!(f, "{part}")?,
                }
            }
            Ok(())
        };
        match self {
            Expression::Number(number) if *number < 0.0 => write!(f, "({number:?})"),
            Expression::Number(number) => write!(f, "{number:?}"),
            Expression::Symbol(name) => f.write_str(name),
            Expression::Sum(terms) => joined(f, terms, " + "),
            Expression::Product(factors) => joined(f, factors, "*"),
            Expression::Quotient(numerator, denominator) => {
                joined(f, std::slice::from_ref(numerator), "*")?;
                match &**denominator {
                    Expression::Symbol(_) | Expression::Call(..) => write!(f, "/{denominator}"),
                    other => write!(f, "/({other})"),
                }
            }
            Expression::Power(base, exponent) => {
                match &**base {
                    Expression::Symbol(_) | Expression::Call(..) => write!(f, "{base}")?,
                    other => write!(f, "({other})")?,
                }
                if *exponent < 0.0 { write!(f, "^({exponent})") } else { write!(f, "^{exponent}") }
            }
            Expression::Call(function, arguments) => {
                let arguments: Vec<String> = arguments.iter().map(ToString::to_string).collect();
                write!(f, "{function}({})", arguments.join(", "))
            }
            Expression::Rate(of) => write!(f, "d({of})"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn x() -> Expression {
        Expression::symbol("x")
    }

    #[test]
    fn values_and_rates_are_those_of_calculus() {
        let f = Expression::product(vec![
            Expression::Call("sqrt", vec![Expression::sum(vec![x().power(2.0), Expression::Number(1.0)])]),
            x().over(Expression::Number(2.0)),
        ]);
        let values = Values::from([("x".to_owned(), Dual64::new(0.75, 2.0))]);
        let found = f.value(&values);
        // f = x √(x² + 1)/2, f' = (2x² + 1)/(2 √(x² + 1)); √(0.75² + 1) = 1.25
        assert!((found.re - 0.46875).abs() < 1e-15 && (found.eps - 2.0 * 2.125 / 2.5).abs() < 1e-15);
        assert!(Expression::symbol("y").value(&values).re.is_nan());
    }

    #[test]
    fn texts_keep_the_order_of_operations() {
        let sum = Expression::sum(vec![x(), Expression::Number(-0.5)]);
        let text = Expression::product(vec![sum.clone(), sum.clone().power(2.0)]).over(sum).to_string();
        assert_eq!(text, "(x + (-0.5))*(x + (-0.5))^2/(x + (-0.5))");
    }
}
