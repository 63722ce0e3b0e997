//! Programs as parts of tapes.

use super::tape::{Binary, Fused, LaneTape, LaneValue};
use crate::graph::function::Function;
use crate::program::program::{Instruction, Program, Register};

impl LaneTape {
    /// Appends the operations of a program, with fused multiply-adds, at these values of time,
    /// state and parameters; returns its outputs.
    ///
    /// # Panics
    /// If the numbers of state components and of parameters are not those of the program.
    pub fn inline(
        &mut self,
        program: &Program,
        t: LaneValue,
        state: &[LaneValue],
        parameters: &[LaneValue],
    ) -> Vec<LaneValue> {
        assert_eq!(state.len(), program.state_len(), "length of the state");
        assert_eq!(parameters.len(), program.parameters_len(), "number of parameters");
        let program = program.fused();
        let mut values: Vec<LaneValue> = program.constants().iter().map(|&c| self.constant(c)).collect();
        values.push(t);
        values.extend(state.iter().chain(parameters));
        for instruction in program.code() {
            let get = |r: Register| values[r.index()];
            let value = match *instruction {
                Instruction::Add(a, b) => self.add(get(a), get(b)),
                Instruction::Subtract(a, b) => self.subtract(get(a), get(b)),
                Instruction::Multiply(a, b) => self.multiply(get(a), get(b)),
                Instruction::Divide(a, b) => self.binary(Binary::Divide, get(a), get(b)),
                Instruction::Negate(a) => self.negate(get(a)),
                Instruction::MultiplyAdd(a, b, c) => self.multiply_add(get(a), get(b), get(c)),
                Instruction::MultiplySubtract(a, b, c) => {
                    self.fused(Fused::MultiplySubtract, get(a), get(b), get(c))
                }
                Instruction::NegateMultiplyAdd(a, b, c) => {
                    self.fused(Fused::NegateMultiplyAdd, get(a), get(b), get(c))
                }
                Instruction::NegateMultiplySubtract(a, b, c) => {
                    self.fused(Fused::NegateMultiplySubtract, get(a), get(b), get(c))
                }
                Instruction::Call(function, args) => self.apply(function, args.map(get)),
            };
            values.push(value);
        }
        program.outputs().iter().map(|r| values[r.index()]).collect()
    }

    /// The function, with arguments beyond its arity made equal, so that the same call is one
    /// value.
    fn apply(&mut self, function: Function, mut arguments: [LaneValue; 3]) -> LaneValue {
        for i in function.arity()..3 {
            arguments[i] = arguments[0];
        }
        self.function(function, arguments)
    }
}
