//! A program in the form that can be interpreted fastest: few steps, short indices, no bounds checks.
//!
//! Dispatching a step costs more than an operation. So products are computed by the step that adds
//! or subtracts them, and a sum of products is one step, term by term in the order of the program;
//! every operation is still rounded separately. Registers are an array of constant size, so that a
//! 16-bit index masked to that size is always in bounds.

use crate::graph::function::Function;
use crate::program::program::{Instruction, Program, Register};

/// Sizes of the register array.
const SMALL: usize = 1 << 8;
const MEDIUM: usize = 1 << 12;
const LARGE: usize = 1 << 16;

/// What a step computes from its operands a, b, c, encoded in one byte.
#[derive(Clone, Copy, Debug)]
#[repr(u8)]
enum Kind {
    /// a + b
    Add,
    /// a − b
    Subtract,
    /// a · b
    Multiply,
    /// a / b
    Divide,
    /// −a
    Negate,
    /// c + Σ xy − Σ xy, with a and b the numbers of terms, whose factors x and y are next in the
    /// list of pairs
    Products,
    /// c + a·b
    AddProduct,
    /// c − a·b
    SubtractProduct,
    /// a·b − c
    ProductMinus,
    /// −c − a·b
    NegateBoth,
    /// f(a, …), with the number of arguments of f
    Call(Function),
}

#[derive(Clone, Copy, Debug)]
struct Step {
    kind: Kind,
    target: u16,
    operands: [u16; 3],
}

/// Steps, and the pairs of factors of sums of products.
#[derive(Debug)]
pub(crate) struct Tape {
    constants: Vec<f64>,
    registers: usize,
    steps: Vec<Step>,
    pairs: Vec<[u16; 2]>,
    outputs: Vec<u16>,
}

impl Tape {
    /// The tape of a program without fused operations and with few enough registers.
    pub(crate) fn new(program: &Program) -> Option<Tape> {
        if program.code().iter().any(rounds_once) {
            return None;
        }
        let paired = program.fused(); // only to pair each product with its sum: both are rounded here
        // One more register for −0, to which adding a product changes nothing.
        let needed = paired.registers_len() + 1;
        let registers = [SMALL, MEDIUM, LARGE].into_iter().find(|&size| needed <= size)?;
        let mut tape = Tape {
            constants: paired.constants().to_vec(),
            registers,
            steps: Vec::with_capacity(paired.code().len()),
            pairs: Vec::new(),
            outputs: paired.outputs().iter().map(|&r| short(r)).collect(),
        };
        tape.fill(&paired);
        Some(tape)
    }

    /// Registers for this tape.
    pub(crate) fn registers(&self) -> Vec<f64> {
        let mut registers = vec![0.0; self.registers];
        registers[..self.constants.len()].copy_from_slice(&self.constants);
        registers[self.registers - 1] = -0.0;
        registers
    }

    /// Runs the tape on [`registers`](Tape::registers).
    pub(crate) fn run(
        &self,
        registers: &mut [f64],
        t: f64,
        state: &[f64],
        parameters: &[f64],
        outputs: &mut [f64],
    ) {
        let inputs = &mut registers[self.constants.len()..];
        inputs[0] = t;
        inputs[1..=state.len()].copy_from_slice(state);
        inputs[1 + state.len()..][..parameters.len()].copy_from_slice(parameters);
        if let Ok(registers) = registers.try_into() {
            self.walk::<SMALL>(registers, outputs);
        } else if let Ok(registers) = registers.try_into() {
            self.walk::<MEDIUM>(registers, outputs);
        } else if let Ok(registers) = registers.try_into() {
            self.walk::<LARGE>(registers, outputs);
        }
    }

    fn walk<const SIZE: usize>(&self, registers: &mut [f64; SIZE], outputs: &mut [f64]) {
        let place = |index: u16| usize::from(index) & (SIZE - 1);
        let mut pairs = self.pairs.as_slice();
        for step in &self.steps {
            let [a, b, c] = step.operands;
            let get = |index: u16| registers[place(index)];
            let value = match step.kind {
                Kind::Add => get(a) + get(b),
                Kind::Subtract => get(a) - get(b),
                Kind::Multiply => get(a) * get(b),
                Kind::Divide => get(a) / get(b),
                Kind::Negate => -get(a),
                Kind::Products => {
                    let (added, rest) = pairs.split_at(usize::from(a));
                    let (subtracted, rest) = rest.split_at(usize::from(b));
                    pairs = rest;
                    let sum = added.iter().fold(get(c), |sum, &[x, y]| sum + get(x) * get(y));
                    subtracted.iter().fold(sum, |sum, &[x, y]| sum - get(x) * get(y))
                }
                Kind::AddProduct => get(c) + get(a) * get(b),
                Kind::SubtractProduct => get(c) - get(a) * get(b),
                Kind::ProductMinus => get(a) * get(b) - get(c),
                Kind::NegateBoth => -get(c) - get(a) * get(b),
                Kind::Call(function) => function.eval(&[get(a), get(b), get(c)]),
            };
            registers[place(step.target)] = value;
        }
        for (output, &index) in outputs.iter_mut().zip(&self.outputs) {
            *output = registers[place(index)];
        }
    }

    fn fill(&mut self, program: &Program) {
        let first = program.first_result();
        let sums = Sums::of(program);
        for (i, &instruction) in program.code().iter().enumerate() {
            if sums.absorbed[i] {
                continue;
            }
            let step = |kind, operands: [Register; 3]| Step {
                kind,
                target: (first + i) as u16,
                operands: operands.map(short),
            };
            let step = match instruction {
                Instruction::MultiplyAdd(..) | Instruction::NegateMultiplyAdd(..)
                    if sums.previous[i].is_some() =>
                {
                    let operands = self.gather(program, &sums, i);
                    Step { operands, ..step(Kind::Products, [Register(0); 3]) }
                }
                Instruction::Add(a, b) => step(Kind::Add, [a, b, b]),
                Instruction::Subtract(a, b) => step(Kind::Subtract, [a, b, b]),
                Instruction::Multiply(a, b) => step(Kind::Multiply, [a, b, b]),
                Instruction::Divide(a, b) => step(Kind::Divide, [a, b, b]),
                Instruction::Negate(a) => step(Kind::Negate, [a; 3]),
                Instruction::MultiplyAdd(a, b, c) => step(Kind::AddProduct, [a, b, c]),
                Instruction::NegateMultiplyAdd(a, b, c) => step(Kind::SubtractProduct, [a, b, c]),
                Instruction::MultiplySubtract(a, b, c) => step(Kind::ProductMinus, [a, b, c]),
                Instruction::NegateMultiplySubtract(a, b, c) => step(Kind::NegateBoth, [a, b, c]),
                Instruction::Call(function, args) => step(Kind::Call(function), args),
            };
            self.steps.push(step);
        }
    }

    /// Lists the products of the sum that ends with instruction `i`; returns the operands of its
    /// step.
    fn gather(&mut self, program: &Program, sums: &Sums, i: usize) -> [u16; 3] {
        let (mut added, mut subtracted) = (Vec::new(), Vec::new());
        let mut next = Some(i);
        let mut start = (self.registers - 1) as u16; // −0, unless the sum begins with another term
        while let Some(at) = next {
            match program.code()[at] {
                Instruction::MultiplyAdd(x, y, c) => {
                    added.push([short(x), short(y)]);
                    start = short(c);
                }
                Instruction::NegateMultiplyAdd(x, y, c) => {
                    subtracted.push([short(x), short(y)]);
                    start = short(c);
                }
                Instruction::Multiply(x, y) => {
                    added.push([short(x), short(y)]);
                    start = (self.registers - 1) as u16;
                }
                other => unreachable!("{other:?} in a sum of products"),
            }
            next = sums.previous[at];
        }
        self.pairs.extend(added.iter().rev());
        self.pairs.extend(subtracted.iter().rev());
        [added.len() as u16, subtracted.len() as u16, start]
    }
}

/// Chains of instructions, each of which adds a product to, or subtracts it from, the result of
/// another one that is used nowhere else.
struct Sums {
    /// For each instruction, the one whose result it continues.
    previous: Vec<Option<usize>>,
    /// Whether an instruction is continued by another one in this way.
    absorbed: Vec<bool>,
}

impl Sums {
    fn of(program: &Program) -> Sums {
        let (code, first, uses) = (program.code(), program.first_result(), program.uses());
        let mut sums = Sums { previous: vec![None; code.len()], absorbed: vec![false; code.len()] };
        for (i, instruction) in code.iter().enumerate() {
            let (start, adds) = match *instruction {
                Instruction::MultiplyAdd(_, _, c) => (c, true),
                Instruction::NegateMultiplyAdd(_, _, c) => (c, false),
                _ => continue,
            };
            let Some(j) = start.index().checked_sub(first).filter(|_| uses[start.index()] == 1) else {
                continue;
            };
            // Products that are added come before those that are subtracted.
            let continues = match code[j] {
                Instruction::Multiply(..) | Instruction::MultiplyAdd(..) => true,
                Instruction::NegateMultiplyAdd(..) => !adds,
                _ => false,
            };
            if continues {
                sums.previous[i] = Some(j);
                sums.absorbed[j] = true;
            }
        }
        sums
    }
}

/// Whether an instruction is a fused multiply-add.
fn rounds_once(instruction: &Instruction) -> bool {
    matches!(
        instruction,
        Instruction::MultiplyAdd(..)
            | Instruction::MultiplySubtract(..)
            | Instruction::NegateMultiplyAdd(..)
            | Instruction::NegateMultiplySubtract(..)
    )
}

fn short(register: Register) -> u16 {
    register.0 as u16
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use crate::kernel::kernel::{Interpreter, Kernel, walk};
    use crate::random::SplitMix64;
    use crate::{Expr, Folding, Graph, Inputs, Program};

    /// `count` sums, products and calls of earlier expressions.
    fn random_expressions<'g>(symbols: &[Expr<'g>], count: usize, seed: u64) -> Vec<Expr<'g>> {
        let mut random = SplitMix64::new(seed);
        let mut below = |n: usize| random.below(n);
        let mut pool = symbols.to_vec();
        for _ in 0..count {
            let [a, b, c, d] = std::array::from_fn(|_| pool[below(pool.len())]);
            pool.push(
                match below(10) {
                    0 => a + b,
                    1 => a - b,
                    2 => (a * b).sin(),
                    3 => a / (b.square() + 1.0),
                    4 => a * b + c * d,
                    5 => a * b - c * d,
                    6 => c - a * b - d * d,
                    7 => -a - b * c,
                    8 => (a * b - c) / 3.0,
                    _ => a * b + c * d - a * c - b * d + a,
                } * 0.25,
            );
        }
        pool
    }

    fn assert_same_bits(count: usize) {
        let graph = Graph::with_folding(Folding::Structural);
        let symbols = graph.symbols(["t", "x", "y", "z", "p"]);
        let inputs = Inputs {
            time: Some(symbols[0]),
            state: symbols[1..4].to_vec(),
            parameters: symbols[4..].to_vec(),
        };
        let outputs = random_expressions(&symbols, count, 7);
        let program = Arc::new(Program::new(&graph, &inputs, &outputs).unwrap());
        let mut kernel = Interpreter::new(Arc::clone(&program));
        assert!(kernel.tape.is_some());
        let (mut registers, mut found) = (vec![0.0; program.registers_len()], vec![0.0; outputs.len()]);
        for scale in [0.0, -0.0, 0.7, -1.3, 1e200] {
            let (t, state, parameters) = (scale, [scale, 0.5, -0.25 * scale], [1.5]);
            kernel.eval(t, &state, &parameters, &mut found);
            walk(&program, &mut registers, t, &state, &parameters);
            for (found, register) in found.iter().zip(program.outputs()) {
                let expected = registers[register.index()];
                assert!(found.to_bits() == expected.to_bits() || found.is_nan() && expected.is_nan());
            }
        }
    }

    #[test]
    fn the_tape_rounds_as_the_program_does() {
        for count in [1, 10, 50, 400, 2000] {
            assert_same_bits(count);
        }
    }
}
