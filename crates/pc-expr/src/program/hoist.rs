//! The part of a program that depends on parameters alone, as a separate program.

use rustc_hash::FxHashMap;

use crate::program::builder::Builder;
use crate::program::program::{Instruction, Program, Register};

/// The least number of operations that are worth saving, since reading their results also takes time.
const WORTH_IT: usize = 4;

impl Program {
    /// This program divided into two: the first computes, from the `fixed` parameters alone, values that the
    /// second reads after its parameters; the first has to run only when the `fixed` parameters have changed.
    /// In the second, divisions by such values become products with their reciprocals, which adds an error of
    /// rounding to each. `None` if the division saves next to nothing.
    ///
    /// ```
    /// # use pc_expr::{Graph, Inputs, Interpreter, Kernel, Program};
    /// let graph = Graph::new();
    /// let [x, m, l] = graph.symbols(["x", "m", "l"]);
    /// let inputs = Inputs { time: None, state: vec![x], parameters: vec![m, l] };
    /// let program = Program::new(&graph, &inputs, &[x + (m / l).exp()])?;
    /// let (first, second) = program.hoisted(&[true, true]).expect("a division and a call");
    /// assert_eq!((first.parameters_len(), first.outputs_len(), second.parameters_len()), (2, 1, 3));
    /// assert_eq!(second.code().len(), 1);
    /// assert!(program.hoisted(&[true, false]).is_none());
    /// # Ok::<(), pc_expr::ExprError>(())
    /// ```
    ///
    /// # Panics
    /// Unless `fixed` has one entry per parameter.
    pub fn hoisted(&self, fixed: &[bool]) -> Option<(Program, Program)> {
        assert_eq!(fixed.len(), self.parameters, "one for each parameter");
        self.by_reciprocals(&self.depends_only_on(fixed)).divided(fixed)
    }

    /// Which registers are constants, `fixed` parameters, or results of these alone.
    fn depends_only_on(&self, fixed: &[bool]) -> Vec<bool> {
        let mut is_fixed: Vec<bool> = vec![true; self.first_input()];
        is_fixed.resize(self.first_result() - self.parameters, false);
        is_fixed.extend(fixed);
        for instruction in &self.code {
            is_fixed.push(instruction.operands().all(|operand| is_fixed[operand.index()]));
        }
        is_fixed
    }

    /// This program with each a/b, where b is fixed and a is not, as a·(1/b).
    fn by_reciprocals(&self, is_fixed: &[bool]) -> Program {
        let mut builder = Builder::default();
        let constants = self.constants.iter().map(|&value| builder.constant(value)).collect::<Vec<_>>();
        let inputs = (0..self.names.len()).map(|place| builder.input(place)).collect::<Vec<_>>();
        let mut places = [constants, inputs].concat();
        for &instruction in &self.code {
            let place = |r: Register| places[r.index()];
            places.push(match instruction {
                Instruction::Divide(a, b) if is_fixed[b.index()] && !is_fixed[a.index()] => {
                    let one = builder.constant(1.0);
                    let reciprocal = builder.result(Instruction::Divide(one, place(b)));
                    builder.result(Instruction::Multiply(place(a), reciprocal))
                }
                other => builder.result(other.map(place)),
            });
        }
        let outputs: Vec<Register> = self.outputs.iter().map(|output| places[output.index()]).collect();
        builder.program(self.names.clone(), [self.state, self.parameters], &outputs)
    }

    /// The two parts of this program, as it is.
    fn divided(&self, fixed: &[bool]) -> Option<(Program, Program)> {
        let first_result = self.first_result();
        let first_parameter = first_result - self.parameters;
        let is_fixed = self.depends_only_on(fixed);
        let (hoisted, left): (Vec<usize>, Vec<usize>) =
            (0..self.code.len()).partition(|i| is_fixed[first_result + i]);
        // In order of first use.
        let mut read: FxHashMap<Register, usize> = FxHashMap::default();
        let mut registers: Vec<Register> = Vec::new();
        let operands = left.iter().flat_map(|&i| self.code[i].operands()).chain(self.outputs.iter().copied());
        for operand in operands.filter(|r| r.index() >= first_result && is_fixed[r.index()]) {
            read.entry(operand).or_insert_with(|| {
                registers.push(operand);
                registers.len() - 1
            });
        }
        let saved: usize = hoisted.iter().map(|&i| weight(&self.code[i])).sum();
        if saved < registers.len() + WORTH_IT {
            return None;
        }
        let of_state = |r: Register| match r.index() {
            i if i >= first_parameter => Register(r.0 - self.state as u32),
            _ => r,
        };
        let time = self.names[..1].iter();
        let first = Program {
            constants: self.constants.clone(),
            names: time.chain(&self.names[1 + self.state..]).cloned().collect(),
            state: 0,
            parameters: self.parameters,
            code: Vec::new(),
            outputs: registers.clone(),
        };
        let first = first.with_code(self, &hoisted, of_state);
        let more = registers.iter().map(|&register| self.describe(register));
        let second = Program {
            constants: self.constants.clone(),
            names: self.names.iter().cloned().chain(more).collect(),
            state: self.state,
            parameters: self.parameters + registers.len(),
            code: Vec::new(),
            outputs: self.outputs.clone(),
        };
        let inputs = |r: Register| match read.get(&r) {
            Some(place) => Register((first_result + place) as u32),
            None => r,
        };
        Some((first, second.with_code(self, &left, inputs)))
    }

    /// This program with those instructions of `other` that are at `places`; its outputs are given as
    /// registers of `other`, and `input` maps the registers that they read from outside.
    fn with_code(
        mut self,
        other: &Program,
        places: &[usize],
        input: impl Fn(Register) -> Register,
    ) -> Program {
        let (from, to) = (other.first_result(), self.first_result());
        let own: FxHashMap<usize, usize> = places.iter().enumerate().map(|(to, &from)| (from, to)).collect();
        let place = |r: Register| match r.index().checked_sub(from).and_then(|i| own.get(&i)) {
            Some(i) => Register((to + i) as u32),
            None => input(r),
        };
        self.code = places.iter().map(|&i| other.code[i].map(place)).collect();
        self.outputs = self.outputs.iter().map(|&output| place(output)).collect();
        self
    }
}

fn weight(instruction: &Instruction) -> usize {
    match instruction {
        Instruction::Divide(..) => 4,
        Instruction::Call(..) => 10,
        _ => 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::graph::Graph;
    use crate::kernel::kernel::{Interpreter, Kernel};
    use crate::program::program::Inputs;
    use std::sync::Arc;

    /// Fixed and moving outputs, inputs and constants, with a parameter that is not fixed between others.
    #[test]
    fn both_parts_together_are_the_whole_to_the_last_bit() {
        let graph = Graph::new();
        let [t, x, y, m, u, l] = graph.symbols(["t", "x", "y", "m", "u", "l"]);
        let inputs = Inputs { time: Some(t), state: vec![x, y], parameters: vec![m, u, l] };
        let fixed = (m / l).exp() + l.sqrt() / (m + 3.0);
        let outputs = [
            fixed,
            x * fixed + t * m / l,
            (x - u * m.cos()).sin() * (u * l.square() + y),
            y,
            m,
            2.5.into(),
            m * l * u,
        ];
        let program = Program::new(&graph, &inputs, &outputs).unwrap();
        let fixed = [true, false, true];
        let (first, second) = program.hoisted(&fixed).unwrap();
        let by_reciprocals = program.by_reciprocals(&program.depends_only_on(&fixed));
        assert_eq!(first.code().len() + second.code().len(), by_reciprocals.code().len());
        let divides = |code: &[Instruction]| code.iter().any(|i| matches!(i, Instruction::Divide(..)));
        assert!(divides(program.code()) && !divides(second.code()), "t m/l is a product");
        let run = |program: &Program, t: f64, state: &[f64], parameters: &[f64]| {
            let mut values = vec![f64::NAN; program.outputs_len()];
            Interpreter::new(Arc::new(program.clone())).eval(t, state, parameters, &mut values);
            values
        };
        let (state, parameters) = ([0.3, -0.7], [1.7, 0.4, 2.3]);
        let found = run(&first, f64::NAN, &[], &[1.7, f64::NAN, 2.3]);
        assert!(found.iter().all(|value| value.is_finite()), "of fixed parameters alone");
        let found = run(&second, 0.9, &state, &[&parameters[..], &found].concat());
        assert_eq!(found, run(&by_reciprocals, 0.9, &state, &parameters));
        // One more rounding each.
        for (found, expected) in found.iter().zip(run(&program, 0.9, &state, &parameters)) {
            assert!((found - expected).abs() <= 2.0 * f64::EPSILON * expected.abs(), "{found} {expected}");
        }
    }
}
