//! Bounds on the rounding errors of functions.
//!
//! The bound is an expression, compiled with its function, because a projection uses it at each state of a
//! motion; a numerical bound, which identifies zeros at a few points of a derivation, is in
//! `pc-expr/src/identity/running_error.rs`.

use std::ops::{Add, Mul, Neg};

use pc_expr::{
    Backend, Evaluator, Expr, ExprError, Folding, Function, Graph, Inputs, Number, Program, Scalar,
};
use serde::{Deserialize, Serialize};

use crate::compiled::failure::{EvaluationFailure, check_finite};
use crate::compiled::point::Point;

/// The unit of errors. An operation has an error of a quarter of this unit; a long sum, for which only the
/// rounding errors of the terms are counted, may have a larger error.
const UNIT: f64 = 2.0 * f64::EPSILON;

/// Keeps a quotient of two zeros from being NaN.
const TINY: f64 = 1e-300;

/// The magnitude below which numbers have fewer digits and a constant spacing, in units of errors. The value
/// is four times the actual one, since products with so small a number are rounded again.
const SPACING: f64 = 4.0 * f64::MIN_POSITIVE;

/// Compiled functions with bounds on their rounding errors.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Measured {
    functions: Evaluator,
    /// The values, then the bounds.
    values: Vec<f64>,
}

impl Measured {
    /// # Errors
    /// As for [`Program::new`].
    pub(crate) fn new<'g>(
        graph: &'g Graph,
        inputs: &Inputs<'g>,
        functions: &[Expr<'g>],
        backend: Backend,
    ) -> Result<Measured, ExprError> {
        // A graph of its own, as a graph cannot grow while it is traversed.
        let measuring = graph.page(Folding::ByValue);
        let named = |symbol: &Expr<'g>| measuring.symbol(&symbol.to_string());
        let inputs_here = Inputs {
            time: inputs.time.as_ref().map(named),
            state: inputs.state.iter().map(named).collect(),
            parameters: inputs.parameters.iter().map(named).collect(),
        };
        let symbols: Vec<Expr<'g>> =
            inputs.time.iter().chain(&inputs.state).chain(&inputs.parameters).copied().collect();
        let functions = &graph.written_in(functions, &symbols);
        let symbols: Vec<_> =
            symbols.iter().map(|symbol| (*symbol, WithError::symbol(named(symbol)))).collect();
        let measured = graph.evaluate(functions, &symbols)?;
        let (values, errors): (Vec<_>, Vec<_>) = measured.iter().map(|f| (f.value, f.error)).unzip();
        let program = Program::new(&measuring, &inputs_here, &[values, errors].concat())?;
        let values = vec![0.0; program.outputs_len()];
        Ok(Measured { functions: Evaluator::new(program, backend), values })
    }

    /// The values at (t, y), finite or not.
    pub(crate) fn eval(&mut self, Point { t, y, p }: Point<'_>) -> &[f64] {
        self.functions.eval(t, y, p, &mut self.values);
        self.values()
    }

    /// The values at (t, y).
    ///
    /// # Errors
    /// [`EvaluationFailure::Expr`] if a value is not finite.
    pub(crate) fn try_eval(&mut self, at: Point<'_>) -> Result<&[f64], EvaluationFailure> {
        self.eval(at);
        check_finite(self.values(), &self.functions, at)?;
        Ok(self.values())
    }

    /// The values of the last evaluation.
    pub(crate) fn values(&self) -> &[f64] {
        &self.values[..self.values.len() / 2]
    }

    /// A bound on the rounding error of the function with index `place`; not finite if a part of the
    /// function has no derivative.
    pub(crate) fn error(&self, place: usize) -> f64 {
        UNIT * self.values[self.values.len() / 2 + place]
    }

    /// The bounds on the rounding errors of all functions.
    pub(crate) fn errors(&self) -> impl Iterator<Item = f64> {
        (0..self.values().len()).map(|place| self.error(place))
    }

    /// The largest ratio of a value to the bound on its error: at most 1 if the values are rounding errors
    /// only.
    pub(crate) fn in_errors(&self) -> f64 {
        let ratio = |(place, value): (usize, &f64)| match self.error(place) {
            _ if *value == 0.0 => 0.0,
            error if error.is_finite() => value.abs() / error,
            _ => f64::INFINITY,
        };
        self.values().iter().enumerate().map(ratio).fold(0.0, f64::max)
    }
}

/// An expression with a first-order bound on its rounding errors, in units of the last digit of 1.0. The bound
/// is at least the absolute value, so that the rounding errors of sums are included in the bounds for their
/// terms.
#[derive(Clone, Copy)]
struct WithError<'g> {
    value: Expr<'g>,
    error: Expr<'g>,
}

impl<'g> WithError<'g> {
    /// A number that has been rounded once.
    fn rounded(value: Expr<'g>) -> WithError<'g> {
        WithError { value, error: value.abs() }
    }

    /// The value of a symbol, which may be subnormal.
    fn symbol(value: Expr<'g>) -> WithError<'g> {
        WithError { value, error: value.abs() + SPACING }
    }

    /// The value of a function of `args` with these derivatives.
    fn with_slopes(value: Expr<'g>, args: &[Self], slopes: impl Iterator<Item = Expr<'g>>) -> WithError<'g> {
        let errors = args.iter().zip(slopes).map(|(arg, slope)| slope.abs() * arg.error);
        WithError { value, error: errors.fold(value.abs(), |sum, error| sum + error) }
    }
}

impl Add for WithError<'_> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        WithError { value: self.value + other.value, error: self.error + other.error }
    }
}

impl Mul for WithError<'_> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        if self.value.constant().is_some() {
            return WithError { value: self.value * other.value, error: self.value.abs() * other.error };
        }
        WithError::with_slopes(
            self.value * other.value,
            &[self, other],
            [other.value, self.value].into_iter(),
        )
    }
}

impl Neg for WithError<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        WithError { value: -self.value, error: self.error }
    }
}

impl Scalar for WithError<'_> {
    fn from_f64(value: f64) -> Self {
        WithError::constant(value.into())
    }

    fn constant(value: Number) -> Self {
        WithError::rounded(value.into())
    }

    fn powi(self, exponent: i32) -> Self {
        if exponent == 1 {
            return self;
        }
        let slope = f64::from(exponent) * self.value.powi(exponent - 1);
        WithError::with_slopes(self.value.powi(exponent), &[self], std::iter::once(slope))
    }

    fn call(function: Function, args: &[Self]) -> Self {
        let values: Vec<_> = args.iter().map(|arg| arg.value).collect();
        let value = Expr::apply(function, &values);
        if values.iter().all(|value| value.constant().is_some()) {
            return WithError::rounded(value); // its slope may be infinite, as that of asin 1
        }
        let error = match (function, args) {
            // √(u + e) − √u
            (Function::Sqrt, [u]) => u.error / ((u.value + UNIT * u.error).sqrt() + u.value.sqrt() + TINY),
            (Function::Pow, [u, exponent]) if exponent.value.constant().is_some() => {
                let base = u.value + UNIT * u.error + TINY;
                (exponent.value * Expr::apply(Function::Pow, &[base, exponent.value - 1.0])).abs() * u.error
            }
            // The error of the branch that is taken: the other one may be undefined.
            (Function::Step, [x, a, b]) => x.value.step(a.error, b.error),
            (Function::Max, [a, b]) => (a.value - b.value).step(a.error, b.error),
            (Function::Min, [a, b]) => (a.value - b.value).step(b.error, a.error),
            _ => return WithError::with_slopes(value, args, slopes(function, &values).into_iter()),
        };
        WithError { value, error: value.abs() + error }
    }
}

/// The derivatives ∂f/∂x_i at `values`, computed in a separate graph with a symbol for each argument.
fn slopes<'g>(function: Function, values: &[Expr<'g>]) -> Vec<Expr<'g>> {
    let graph = Graph::new();
    let symbols: Vec<_> = (0..values.len()).map(|i| graph.symbol(&format!("x{i}"))).collect();
    let slopes = graph.gradient(Expr::apply(function, &symbols), &symbols);
    let known: Vec<_> = symbols.into_iter().zip(values.iter().copied()).collect();
    graph.evaluate(&slopes, &known).unwrap_or_default() // every symbol has a value
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cancelling_terms_count() {
        let graph = Graph::new();
        let [t, x, y, a] = graph.symbols(["t", "x", "y", "a"]);
        let circle = x.square() + (y - a).square() - a.square();
        let steep = (1e3 * (x + 1.0)).sin() + t;
        let flat = (y - 3.0 + x / 1e3).powi(5);
        let inputs = Inputs { time: Some(t), state: vec![x, y], parameters: vec![a] };
        let functions = [circle, steep, flat];
        let mut measured = Measured::new(&graph, &inputs, &functions, Backend::Interpreter).expect("bound");
        let values = measured.try_eval(Point { t: 0.5, y: &[-1.0, 3.0], p: &[2.0] }).expect("finite");
        assert_eq!(values[..2], [-2.0, 0.5]);
        // About 26 units for the circle, in whatever form the graph has it; a thousand times the error of a
        // difference of numbers about 1; and that of u⁵ with u = 1/1000 and errors of numbers about 3 in u.
        for (place, size) in [1e-14, 1e-12, 1e-26].into_iter().enumerate() {
            let error = measured.error(place);
            assert!((size / 5.0..=size * 5.0).contains(&error), "{place}: {error:e}");
        }
        assert!(measured.in_errors() > 1e10);
    }

    /// Roots, powers and the branches of a step have bounds at the edges of their domains.
    #[test]
    fn edges_have_bounds() {
        let graph = Graph::new();
        let x = graph.symbol("x");
        let beyond = x.max(Expr::ZERO);
        let functions = [
            beyond.pow(2.5),
            beyond.square() * beyond.sqrt(),
            beyond.pow(0.3),
            x.step(x.sqrt(), Expr::ONE),
            (x + 1.0).sqrt() + Expr::ONE.asin(),
        ];
        let inputs = Inputs { time: None, state: vec![x], parameters: Vec::new() };
        let mut measured = Measured::new(&graph, &inputs, &functions, Backend::Interpreter).expect("bound");
        measured.eval(Point { t: 0.0, y: &[-1.0], p: &[] });
        let errors: Vec<f64> = (0..4).map(|place| measured.error(place)).collect();
        assert!(errors.iter().all(|&error| (0.0..1e-15).contains(&error)), "{errors:?}");
        // √(2 ε)
        assert!((1e-8..1e-7).contains(&measured.error(4)), "{}", measured.error(4));
    }
}
