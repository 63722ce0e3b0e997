//! Programs written instruction by instruction.

use rustc_hash::FxHashMap;

use crate::graph::function::Function;
use crate::program::program::{Instruction, Program, Register};

/// While a program is written, constants are numbered from 0, the state from `STATE`, the sums that follow it
/// in the state from `SUM`, parameters from `PARAMETER` and results from `RESULT`.
const TIME: u32 = 1 << 27;
const STATE: u32 = TIME + 1;
const SUM: u32 = 1 << 28;
const PARAMETER: u32 = 1 << 29;
const RESULT: u32 = 1 << 30;

/// A program being written; a repeated instruction is computed once.
#[derive(Default)]
pub(crate) struct Assembler {
    constants: Vec<f64>,
    numbers: FxHashMap<u64, Register>,
    code: Vec<Instruction>,
    known: FxHashMap<Instruction, u32>,
    /// The depth of each result, in operations.
    depths: Vec<u32>,
}

impl Assembler {
    pub(crate) fn time() -> Register {
        Register(TIME)
    }

    pub(crate) fn state(i: usize) -> Register {
        Register(STATE + i as u32)
    }

    /// Component `i` of the sums, which follow the components of [`state`](Assembler::state).
    pub(crate) fn sum(i: usize) -> Register {
        Register(SUM + i as u32)
    }

    pub(crate) fn parameter(i: usize) -> Register {
        Register(PARAMETER + i as u32)
    }

    pub(crate) fn number(&mut self, value: f64) -> Register {
        let constants = &mut self.constants;
        *self.numbers.entry(value.to_bits()).or_insert_with(|| {
            constants.push(value);
            Register(constants.len() as u32 - 1)
        })
    }

    /// The number in a register, if it is a constant.
    pub(crate) fn value(&self, register: Register) -> Option<f64> {
        self.constants.get(register.index()).copied()
    }

    pub(crate) fn emit(&mut self, instruction: Instruction) -> Register {
        let depth = 1 + instruction.operands().map(|r| self.depth(r)).max().unwrap_or(0);
        let (code, depths) = (&mut self.code, &mut self.depths);
        let index = *self.known.entry(instruction).or_insert_with(|| {
            code.push(instruction);
            depths.push(depth);
            code.len() as u32 - 1
        });
        Register(RESULT + index)
    }

    /// The depth of a register, in operations.
    pub(crate) fn depth(&self, register: Register) -> u32 {
        register.0.checked_sub(RESULT).map_or(0, |i| self.depths[i as usize])
    }

    pub(crate) fn add(&mut self, a: Register, b: Register) -> Register {
        match (self.value(a), self.value(b)) {
            (Some(0.0), _) => b,
            (_, Some(0.0)) => a,
            _ => self.emit(Instruction::Add(a, b)),
        }
    }

    pub(crate) fn subtract(&mut self, a: Register, b: Register) -> Register {
        match (self.value(a), self.value(b)) {
            (_, Some(0.0)) => a,
            (Some(0.0), _) => self.negate(b),
            _ => self.emit(Instruction::Subtract(a, b)),
        }
    }

    pub(crate) fn multiply(&mut self, a: Register, b: Register) -> Register {
        match (self.value(a), self.value(b)) {
            (Some(1.0), _) => b,
            (_, Some(1.0)) => a,
            _ => self.emit(Instruction::Multiply(a, b)),
        }
    }

    pub(crate) fn negate(&mut self, a: Register) -> Register {
        self.emit(Instruction::Negate(a))
    }

    pub(crate) fn divide(&mut self, a: Register, b: Register) -> Register {
        self.emit(Instruction::Divide(a, b))
    }

    pub(crate) fn call(&mut self, function: Function, args: &[Register]) -> Register {
        let argument = |i: usize| args[if i < function.arity() { i } else { 0 }];
        self.emit(Instruction::Call(function, [0, 1, 2].map(argument)))
    }

    /// c + a b, with the operand of greatest depth added last.
    pub(crate) fn multiply_add(&mut self, a: Register, b: Register, c: Register) -> Register {
        let product = self.multiply(a, b);
        self.add(c, product)
    }

    /// The finished program, for the given numbers of components of the state, of sums, and of parameters.
    pub(crate) fn finish(
        self,
        (state, sums, parameters): (usize, usize, usize),
        outputs: impl IntoIterator<Item = Register>,
    ) -> Program {
        let time = self.constants.len() as u32;
        let first_sum = time + 1 + state as u32;
        let first_parameter = first_sum + sums as u32;
        let first_result = first_parameter + parameters as u32;
        let place = |register: Register| {
            Register(match register.0 {
                r if r >= RESULT => r - RESULT + first_result,
                r if r >= PARAMETER => r - PARAMETER + first_parameter,
                r if r >= SUM => r - SUM + first_sum,
                r if r >= TIME => r - TIME + time,
                r => r,
            })
        };
        let names = (0..1 + state + sums + parameters).map(|i| format!("#{i}")).collect();
        Program {
            names,
            state: state + sums,
            parameters,
            code: self.code.iter().map(|instruction| instruction.map(place)).collect(),
            outputs: outputs.into_iter().map(place).collect(),
            constants: self.constants,
        }
    }
}
