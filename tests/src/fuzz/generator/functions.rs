//! Functions of which models are made.

use super::Builder;
use crate::fuzz::expression::Expression;

/// Functions of a positive number u that have no zero there, or none that matters.
const REGULAR: [&str; 15] = [
    "sqrt(u)",
    "sqrt(1 + u^2)",
    "exp(u)",
    "exp(-u)",
    "cos(u/4)",
    "1/(2 + u^2)",
    "1 + u^2",
    "2 + sin(u)",
    "u",
    "u^2",
    "1 + tanh(u)",
    "sqrt(p*u)",
    "sqrt(1 + u^2)^2",
    "1 + abs(u)^2",
    "sqrt(p)*sqrt(u)",
];

/// Functions of any number.
const SMOOTH: [&str; 12] = [
    "sin(u)",
    "cos(u)",
    "u",
    "u^2",
    "atan(u)",
    "tanh(u)",
    "exp(u/2)",
    "sqrt(1 + u^2)",
    "1/(2 + u^2)",
    "u^3/3",
    "sqrt(1 + u^2)^2/2",
    "abs(u)^2",
];

/// √(uv) in several words, and its square.
const ROOTS_OF_TWO: [&str; 3] = ["sqrt(u*v)", "sqrt(u)*sqrt(v)", "(sqrt(u)*sqrt(v))^2"];

/// Functions that a coordinate may be of another, with their derivatives.
const CARRIED: [(&str, &str); 11] = [
    ("u^2", "2*u"),
    ("sin(u)", "cos(u)"),
    ("cos(u)", "-sin(u)"),
    ("sqrt(1 + u^2)", "u/sqrt(1 + u^2)"),
    ("sqrt(u)", "1/(2*sqrt(u))"),
    ("exp(u/2)", "exp(u/2)/2"),
    ("u^3/3 + u", "u^2 + 1"),
    ("log(1 + u)", "1/(1 + u)"),
    ("sqrt(1 + u^2)^2", "2*u"),
    ("abs(u)^2/2", "sqrt(u)^2"),
    ("sqrt(2*u)", "sqrt(2)*sqrt(u)/(2*u)"),
];

/// Sums of functions of positive u and v that vanish, though no two terms are alike.
const HIDDEN_ZEROS: [&str; 5] = [
    "sqrt(1 + u^2)^2 - 1 - u^2",
    "sqrt(u*v) - sqrt(u)*sqrt(v)",
    "(sqrt(u) + v)^2 - u - 2*v*sqrt(u) - v^2",
    "(sin(u) + cos(v))^2 + cos(u)^2 - 2*sin(u)*cos(v) - 1 - cos(v)^2",
    "abs(u)^2 - u^2",
];

/// An expression of a table. The tables are tried by a test.
pub(super) fn written(text: &str) -> Expression {
    Expression::parse(text).unwrap_or(Expression::Number(f64::NAN))
}

/// An expression of a table with others in place of its names.
pub(super) fn with(text: &str, names: &[(&str, Expression)]) -> Expression {
    let names: Vec<(String, Expression)> =
        names.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect();
    written(text).substitute(&names)
}

impl Builder {
    /// One of the functions, of one of the names; a number where there is none.
    pub(super) fn function(&mut self, regular: bool, names: &[String]) -> Expression {
        if names.is_empty() {
            return Expression::Number(self.random.decimal(0.3, 1.5));
        }
        let name = Expression::symbol(self.random.pick(names));
        let text = if regular { self.random.pick(&REGULAR) } else { self.random.pick(&SMOOTH[..]) };
        let p = match self.specimen.parameters.is_empty() {
            true => Expression::Number(self.random.decimal(0.5, 1.5)),
            false => Expression::symbol("p"),
        };
        with(text, &[("u", name), ("p", p)])
    }

    /// √(uv), as it is or in two.
    pub(super) fn root_of_two(&mut self, names: &[String]) -> Expression {
        let [u, v] = [(); 2].map(|()| Expression::symbol(self.random.pick(names)));
        let text = self.random.pick(&ROOTS_OF_TWO[..]);
        with(text, &[("u", u), ("v", v)])
    }

    /// A function that a coordinate may be of another, with its derivative.
    pub(super) fn carried_function(&mut self, of: &str) -> (Expression, Expression) {
        let (value, derivative) = self.random.pick(&CARRIED);
        let u = Expression::symbol(of);
        (with(value, &[("u", u.clone())]), with(derivative, &[("u", u)]))
    }

    /// A sum that vanishes identically.
    pub(super) fn hidden_zero(&mut self, names: &[String]) -> Expression {
        let u = Expression::symbol(self.random.pick(names));
        let v = Expression::symbol(self.random.pick(names));
        let zero: &&str = self.random.pick(&HIDDEN_ZEROS);
        with(zero, &[("u", u), ("v", v)])
    }

    /// A number of two decimals, or sometimes the parameter times one.
    pub(super) fn coefficient(&mut self, low: f64, high: f64) -> Expression {
        let number = Expression::Number(self.random.decimal(low, high));
        match !self.specimen.parameters.is_empty() && self.random.chance(20) {
            true => Expression::product(vec![number, Expression::symbol("p")]),
            false => number,
        }
    }
}

#[cfg(test)]
mod tests {
    use num_dual::Dual64;

    use super::*;
    use crate::fuzz::expression::Values;

    fn at(text: &str, u: f64, v: f64) -> Dual64 {
        let number = |value: f64, rate: f64| Dual64::new(value, rate);
        let names = [("u", number(u, 1.0)), ("v", number(v, 0.0)), ("p", number(0.7, 0.0))];
        let values: Values = names.into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
        written(text).value(&values)
    }

    #[test]
    fn functions_have_values_and_the_derivatives_beside_them() {
        for text in REGULAR.iter().chain(&SMOOTH) {
            assert!(at(text, 0.7, 0.0).re.is_finite(), "{text}");
        }
        for (value, derivative) in CARRIED {
            let (value, derivative) = (at(value, 0.7, 0.0), at(derivative, 0.7, 0.0));
            assert!((value.eps - derivative.re).abs() < 1e-15, "{value}, {derivative}");
        }
    }

    #[test]
    fn hidden_zeros_vanish() {
        for text in HIDDEN_ZEROS {
            for (u, v) in [(0.3, 0.9), (1.1, 0.4)] {
                assert!(at(text, u, v).re.abs() < 1e-15, "{text}");
            }
        }
    }
}
