//! How large the rounding errors of functions are.

use std::ops::{Add, Mul, Neg};

use pc_expr::{Backend, Evaluator, Expr, ExprError, Function, Graph, Inputs, Number, Program, Scalar};

use crate::compiled::fault::{Fault, check_finite};

/// What the errors are counted in: one rounding to either side.
const UNIT: f64 = 2.0 * f64::EPSILON;

/// Functions with bounds of their rounding errors, compiled.
#[derive(Clone, Debug)]
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
        // A graph of its own, for none can grow while it is gone through.
        let measuring = Graph::new();
        let named = |symbol: &Expr<'g>| measuring.symbol(&symbol.to_string());
        let inputs_here = Inputs {
            time: inputs.time.as_ref().map(named),
            state: inputs.state.iter().map(named).collect(),
            parameters: inputs.parameters.iter().map(named).collect(),
        };
        let symbols = inputs.time.iter().chain(&inputs.state).chain(&inputs.parameters);
        let symbols: Vec<_> = symbols.map(|symbol| (*symbol, WithError::rounded(named(symbol)))).collect();
        let measured = graph.evaluate(functions, &symbols)?;
        let (values, errors): (Vec<_>, Vec<_>) = measured.iter().map(|f| (f.value, f.error)).unzip();
        let program = Program::new(&measuring, &inputs_here, &[values, errors].concat())?;
        let values = vec![0.0; program.outputs_len()];
        Ok(Measured { functions: Evaluator::new(program, backend), values })
    }

    /// The values at (t, y), finite or not.
    pub(crate) fn eval(&mut self, (t, y, p): (f64, &[f64], &[f64])) -> &[f64] {
        self.functions.eval(t, y, p, &mut self.values);
        self.values()
    }

    /// The values at (t, y).
    ///
    /// # Errors
    /// [`Fault::Expr`] if one is not finite.
    pub(crate) fn try_eval(&mut self, at: (f64, &[f64], &[f64])) -> Result<&[f64], Fault> {
        self.eval(at);
        check_finite(self.values(), &self.functions, at)?;
        Ok(self.values())
    }

    /// The values where they were computed last.
    pub(crate) fn values(&self) -> &[f64] {
        &self.values[..self.values.len() / 2]
    }

    /// Whether a difference from the value of the function in this place is no more than its rounding. At the edge of a
    /// domain, where there is no bound of that, it is only if it is none.
    pub(crate) fn is_rounding(&self, place: usize, difference: f64) -> bool {
        let bound = UNIT * self.values[self.values.len() / 2 + place];
        difference == 0.0 || bound.is_finite() && difference.abs() <= bound
    }

    /// Whether nothing but rounding is left of the values.
    pub(crate) fn vanish(&self) -> bool {
        self.values().iter().enumerate().all(|(place, &value)| self.is_rounding(place, value))
    }
}

/// An expression with the first-order bound of its rounding errors, in units of the last digit of one. The bound is no
/// less than the absolute value, so that the roundings of sums are among those of their terms.
#[derive(Clone, Copy)]
struct WithError<'g> {
    value: Expr<'g>,
    error: Expr<'g>,
}

impl<'g> WithError<'g> {
    /// A number that is known to one rounding.
    fn rounded(value: Expr<'g>) -> WithError<'g> {
        WithError { value, error: value.abs() }
    }

    /// The value of a function of `args` that has these derivatives there.
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
        // The slopes in a graph of their own, where each argument is a symbol.
        let graph = Graph::new();
        let symbols: Vec<_> = (0..args.len()).map(|i| graph.symbol(&format!("x{i}"))).collect();
        let slopes = graph.gradient(Expr::apply(function, &symbols), &symbols);
        let values: Vec<_> = args.iter().map(|arg| arg.value).collect();
        let known: Vec<_> = symbols.iter().copied().zip(values.iter().copied()).collect();
        let slopes = graph.evaluate(&slopes, &known).unwrap_or_default(); // every symbol has a value
        WithError::with_slopes(Expr::apply(function, &values), args, slopes.into_iter())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terms_that_cancel_count() {
        let graph = Graph::new();
        let [t, x, y, a] = graph.symbols(["t", "x", "y", "a"]);
        let circle = x.square() + (y - a).square() - a.square();
        let steep = (1e3 * (x + 1.0)).sin() + t;
        let flat = (y - 3.0 + x / 1e3).powi(5);
        let edge = (x + 1.0).sqrt();
        let inputs = Inputs { time: Some(t), state: vec![x, y], parameters: vec![a] };
        let mut measured = Measured::new(&graph, &inputs, &[circle, steep, flat, edge], Backend::Interpreter)
            .expect("bound");
        let at = (0.5, &[-1.0, 3.0][..], &[2.0][..]);
        assert_eq!(measured.try_eval(at).expect("finite")[..2], [-2.0, 0.5]);
        // 14 and 12 in units of 2 ε for the circle, however the graph may have written it.
        assert!(measured.is_rounding(0, 5e-15) && !measured.is_rounding(0, 5e-14));
        // The argument is a thousand times a difference of numbers about 1.
        assert!(measured.is_rounding(1, 5e-13) && !measured.is_rounding(1, 5e-12));
        // u⁵ with u = 1/1000 and errors of numbers about 3 in u.
        assert!(measured.is_rounding(2, 1e-27) && !measured.is_rounding(2, 1e-25));
        // The root has no slope there.
        assert!(measured.is_rounding(3, 0.0) && !measured.is_rounding(3, 1e-16));
        assert!(!measured.vanish());
    }
}
