//! How large the terms are that a program sums: what a difference between two ways to run it is to be
//! measured by.
//!
//! Two kernels of one program round differently: a fused operation rounds once where two round twice, a sine
//! of one library is a unit in the last place off that of another. Each difference is some ε of the value at
//! which it arises, and goes on to the outputs by the derivatives of the operations between. So an output may
//! differ by
//!
//!   ε |v| |∂output/∂v|
//!
//! for every intermediate value v, which after a cancellation is many ε of the output itself and no fault of
//! either kernel. [`terms`] computes the largest |v| |∂output/∂v| for each output, in one pass with the
//! program. It is the largest term summed on the way, in the units of the output: through a sum terms pass as
//! they are, through products and quotients they are multiplied and divided. Inputs and constants are not
//! counted: both kernels receive them exact.

use pc_expr::{Function, Instruction, Program, Scalar};

use crate::dual::Dual;

/// A value with the largest term that it was computed from.
#[derive(Clone, Copy, Debug)]
pub struct Term {
    /// The value.
    pub value: f64,
    /// The largest term in the units of the value; 0 for what is exact.
    pub size: f64,
}

impl Term {
    fn exact(value: f64) -> Term {
        Term { value, size: 0.0 }
    }

    /// A rounded value, each operand with its derivative.
    fn rounded<const N: usize>(value: f64, operands: [(Term, f64); N]) -> Term {
        let passed_on =
            operands.map(|(term, slope)| if term.size == 0.0 { 0.0 } else { term.size * slope.abs() });
        Term { value, size: passed_on.into_iter().fold(value.abs(), f64::max) }
    }

    fn call(function: Function, args: &[Term]) -> Term {
        let slope = |i: usize| {
            let unit = |j: usize| f64::from(u8::from(i == j));
            let args: Vec<Dual> =
                args.iter().enumerate().map(|(j, term)| Dual::new(term.value, unit(j), 0.0)).collect();
            Dual::call(function, &args).first()
        };
        let values: Vec<f64> = args.iter().map(|term| term.value).collect();
        let inexact = (0..args.len()).filter(|&i| args[i].size > 0.0);
        inexact.fold(Term::rounded(function.eval(&values), []), |result, i| Term {
            size: result.size.max(args[i].size * slope(i).abs()),
            ..result
        })
    }
}

/// The outputs of a program at (t, state, parameters), with the largest term of each.
///
/// # Panics
/// For a fused program, whose products are not seen, and at a corner of |x|, min, max, sign or step.
pub fn terms(program: &Program, inputs: &[f64]) -> Vec<Term> {
    let mut terms: Vec<Term> = program.constants().iter().chain(inputs).copied().map(Term::exact).collect();
    for instruction in program.code() {
        let get = |register: pc_expr::Register| terms[register.index()];
        let term = match *instruction {
            Instruction::Add(a, b) => {
                Term::rounded(get(a).value + get(b).value, [(get(a), 1.0), (get(b), 1.0)])
            }
            Instruction::Subtract(a, b) => {
                Term::rounded(get(a).value - get(b).value, [(get(a), 1.0), (get(b), 1.0)])
            }
            Instruction::Multiply(a, b) => {
                let (a, b) = (get(a), get(b));
                Term::rounded(a.value * b.value, [(a, b.value), (b, a.value)])
            }
            Instruction::Divide(a, b) => {
                let (a, b) = (get(a), get(b));
                let value = a.value / b.value;
                Term::rounded(value, [(a, 1.0 / b.value), (b, value / b.value)])
            }
            Instruction::Negate(a) => Term { value: -get(a).value, ..get(a) },
            Instruction::Call(function, args) => Term::call(function, &args.map(get)[..function.arity()]),
            fused => panic!("{fused:?} in a program to be measured"),
        };
        terms.push(term);
    }
    program.outputs().iter().map(|register| terms[register.index()]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use pc_expr::{Expr, Folding, Graph, Inputs};

    fn term(write: for<'g> fn(&[Expr<'g>]) -> Expr<'g>, inputs: [f64; 2]) -> Term {
        let graph = Graph::with_folding(Folding::Structural);
        let state = graph.symbols(["x", "y"]).to_vec();
        let output = write(&state);
        let program = Program::new(&graph, &Inputs { time: None, state, parameters: vec![] }, &[output]);
        terms(&program.expect("a program"), &[&[0.0], &inputs[..]].concat())[0]
    }

    /// 3·5 − 2·7.5 = 0, of terms of 15.
    #[test]
    fn cancelled_terms_are_remembered() {
        let Term { value, size } = term(|x| x[0] * 5.0 - x[1] * 7.5, [3.0, 2.0]);
        assert_eq!((value, size), (0.0, 15.0));
        let Term { value, size } = term(|x| (x[0] * 5.0 - x[1] * 7.5) * (x[0] / x[1]), [3.0, 2.0]);
        assert_eq!((value, size), (0.0, 22.5));
        let Term { value, size } = term(|x| (x[0] * 5.0 - x[1] * 7.5).exp(), [3.0, 2.0]);
        assert_eq!((value, size), (1.0, 15.0));
        assert_eq!(term(|x| x[0].exp(), [0.0, 0.0]).size, 1.0);
        assert_eq!(term(|x| -x[0], [3.0, 0.0]).size, 0.0);
    }
}
