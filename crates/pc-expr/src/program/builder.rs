//! Programs built instruction by instruction.

use rustc_hash::FxHashMap;

use crate::program::program::{Instruction, Program, Register};

/// A program being built, whose registers are numbered as they are created. The same operation on the same registers gives one
/// register, and operations on constants give constants.
#[derive(Default)]
pub(super) struct Builder {
    values: Vec<Value>,
    known: FxHashMap<Value, Register>,
}

#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Value {
    /// A constant, by its bits.
    Constant(u64),
    /// An input, by its index among time, state and parameters.
    Input(usize),
    Result(Instruction),
}

impl Builder {
    pub(super) fn constant(&mut self, value: f64) -> Register {
        self.value(Value::Constant(value.to_bits()))
    }

    /// The input with this index among time, state and parameters.
    pub(super) fn input(&mut self, place: usize) -> Register {
        self.value(Value::Input(place))
    }

    pub(super) fn result(&mut self, instruction: Instruction) -> Register {
        let constant = |r: Register| self.constant_in(r);
        let folded = match instruction {
            Instruction::Multiply(a, b) => constant(a).zip(constant(b)).map(|(a, b)| a * b),
            Instruction::Divide(a, b) => constant(a).zip(constant(b)).map(|(a, b)| a / b),
            Instruction::Negate(a) => constant(a).map(|a| -a),
            _ => None,
        };
        match folded {
            Some(value) => self.constant(value),
            None => self.value(Value::Result(instruction)),
        }
    }

    /// The constant in a register, if it holds one.
    pub(super) fn constant_in(&self, register: Register) -> Option<f64> {
        match self.values[register.index()] {
            Value::Constant(bits) => Some(f64::from_bits(bits)),
            Value::Input(_) | Value::Result(_) => None,
        }
    }

    fn value(&mut self, value: Value) -> Register {
        let next = Register(self.values.len() as u32);
        let register = *self.known.entry(value).or_insert(next);
        if register == next {
            self.values.push(value);
        }
        register
    }

    /// The program of these outputs, with names for time, state and parameters.
    pub(super) fn program(
        self,
        names: Vec<String>,
        [state, parameters]: [usize; 2],
        outputs: &[Register],
    ) -> Program {
        let constant = |value: &Value| match *value {
            Value::Constant(bits) => Some(f64::from_bits(bits)),
            Value::Input(_) | Value::Result(_) => None,
        };
        let constants: Vec<f64> = self.values.iter().filter_map(constant).collect();
        let (mut next_constant, mut next_result) = (0, constants.len() + names.len());
        let mut places: Vec<Register> = Vec::with_capacity(self.values.len());
        let mut code = Vec::new();
        for value in &self.values {
            let following = |next: &mut usize| {
                *next += 1;
                *next - 1
            };
            let place = match *value {
                Value::Constant(_) => following(&mut next_constant),
                Value::Input(place) => constants.len() + place,
                Value::Result(instruction) => {
                    code.push(instruction.map(|r| places[r.index()]));
                    following(&mut next_result)
                }
            };
            places.push(Register(place as u32));
        }
        let outputs = outputs.iter().map(|r| places[r.index()]).collect();
        Program { constants, names, state, parameters, code, outputs }
    }
}
