//! Fusing products into the sums that use them, and counting operations.

use std::borrow::Cow;
use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::program::program::{Instruction, Program, Register};

/// The number of operations of each kind in one evaluation; fused multiply-adds count as one.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Cost(BTreeMap<Cow<'static, str>, usize>);

impl Cost {
    /// The number of operations of all kinds.
    pub fn total(&self) -> usize {
        self.0.values().sum()
    }

    /// Kinds (`add`, `sub`, `mul`, `div`, `neg`, `fma`, names of functions) with their counts, in alphabetical order.
    pub fn iter(&self) -> impl Iterator<Item = (&str, usize)> {
        self.0.iter().map(|(kind, &count)| (&**kind, count))
    }

    fn of(code: &[Instruction]) -> Cost {
        let mut counts = BTreeMap::new();
        for instruction in code {
            let kind = match instruction {
                Instruction::Add(..) => "add",
                Instruction::Subtract(..) => "sub",
                Instruction::Multiply(..) => "mul",
                Instruction::Divide(..) => "div",
                Instruction::Negate(_) => "neg",
                Instruction::MultiplyAdd(..)
                | Instruction::MultiplySubtract(..)
                | Instruction::NegateMultiplyAdd(..)
                | Instruction::NegateMultiplySubtract(..) => "fma",
                Instruction::Call(function, _) => function.name(),
            };
            *counts.entry(Cow::Borrowed(kind)).or_insert(0) += 1;
        }
        Cost(counts)
    }
}

impl Program {
    /// The operations of one evaluation, with multiply-adds fused.
    pub fn cost(&self) -> Cost {
        Cost::of(&self.fused().code)
    }

    /// The same program with every product that is used once, by a sum or difference, fused into it.
    ///
    /// A fused operation rounds once instead of twice, so results may differ from this program's by rounding
    /// errors.
    #[must_use]
    pub fn fused(&self) -> Program {
        let first = self.first_result();
        let uses = self.uses();
        let product = |r: Register| match r.index().checked_sub(first).map(|i| self.code[i]) {
            Some(Instruction::Multiply(a, b)) if uses[r.index()] == 1 => Some((a, b)),
            _ => None,
        };
        let negation = |r: Register| match r.index().checked_sub(first).map(|i| self.code[i]) {
            Some(Instruction::Negate(a)) if uses[r.index()] == 1 => Some(a),
            _ => None,
        };
        let mut code = self.code.clone();
        let mut absorbed = vec![false; code.len()];
        for (i, instruction) in self.code.iter().enumerate() {
            let (fused, inner) = match *instruction {
                Instruction::Add(a, b) => match (product(a), product(b)) {
                    // Of two products the later one is fused: the other is ready when it is needed.
                    (_, Some((x, y))) => (Instruction::MultiplyAdd(x, y, a), b),
                    (Some((x, y)), None) => (Instruction::MultiplyAdd(x, y, b), a),
                    (None, None) => continue,
                },
                Instruction::Subtract(a, b) => match (product(a), product(b)) {
                    (_, Some((x, y))) => match negation(a) {
                        Some(z) => {
                            absorbed[a.index() - first] = true;
                            (Instruction::NegateMultiplySubtract(x, y, z), b)
                        }
                        None => (Instruction::NegateMultiplyAdd(x, y, a), b),
                    },
                    (Some((x, y)), None) => (Instruction::MultiplySubtract(x, y, b), a),
                    (None, None) => continue,
                },
                _ => continue,
            };
            code[i] = fused;
            absorbed[inner.index() - first] = true;
        }
        self.without(&code, &absorbed)
    }

    /// The program that computes only the first outputs.
    ///
    /// # Panics
    /// If this program has fewer than `outputs` outputs.
    #[must_use]
    pub fn leading(&self, outputs: usize) -> Program {
        let mut program = self.clone();
        program.outputs.truncate(outputs);
        assert_eq!(program.outputs.len(), outputs, "as many outputs as there are");
        let first = self.first_result();
        let mut needed = vec![false; self.registers_len()];
        for output in &program.outputs {
            needed[output.index()] = true;
        }
        for (i, instruction) in self.code.iter().enumerate().rev() {
            if needed[first + i] {
                instruction.operands().for_each(|operand| needed[operand.index()] = true);
            }
        }
        let unneeded: Vec<bool> = needed[first..].iter().map(|needed| !needed).collect();
        program.without(&self.code, &unneeded)
    }

    /// How often each register is read, outputs included.
    pub(crate) fn uses(&self) -> Vec<u32> {
        let mut uses = vec![0; self.registers_len()];
        let operands = self.code.iter().flat_map(|instruction| instruction.operands().collect::<Vec<_>>());
        for register in operands.chain(self.outputs.iter().copied()) {
            uses[register.index()] += 1;
        }
        uses
    }

    /// The program with the given code, numbered as before, without the marked instructions.
    fn without(&self, code: &[Instruction], marked: &[bool]) -> Program {
        let first = self.first_result();
        let mut places = Vec::with_capacity(code.len());
        let mut next = first as u32;
        for &gone in marked {
            places.push(Register(next));
            next += u32::from(!gone);
        }
        let place = |r: Register| r.index().checked_sub(first).map_or(r, |i| places[i]);
        let kept = code.iter().zip(marked).filter(|(_, gone)| !**gone);
        let mut program = self.clone();
        program.code = kept.map(|(instruction, _)| instruction.map(place)).collect();
        program.outputs = self.outputs.iter().map(|&r| place(r)).collect();
        program
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use crate::{Graph, Inputs, Interpreter, Kernel, Program};

    #[test]
    fn the_first_outputs_take_no_more_than_their_own_operations() {
        let graph = Graph::new();
        let [a, b] = graph.symbols(["a", "b"]);
        let inputs = Inputs { time: None, state: vec![a, b], parameters: vec![] };
        let program = Program::new(&graph, &inputs, &[a * b, a.sin(), a * b + b.exp()]).unwrap();
        let first = program.leading(2);
        assert_eq!(first.cost().iter().collect::<Vec<_>>(), [("mul", 1), ("sin", 1)]);
        let mut values = [0.0; 2];
        Interpreter::new(Arc::new(first)).eval(0.0, &[0.5, 3.0], &[], &mut values);
        assert_eq!(values, [1.5, 0.5f64.sin()]);
    }

    #[test]
    fn products_are_fused_once() {
        let graph = Graph::new();
        let [a, b, c, d] = graph.symbols(["a", "b", "c", "d"]);
        let inputs = Inputs { time: None, state: vec![a, b, c, d], parameters: vec![] };
        let outputs = [a * b + c * d, -(a * b) - c.sin() * d, a * c];
        let program = Program::new(&graph, &inputs, &outputs).unwrap();
        let fused = program.fused();
        let y = [0.3, -1.7, 2.5, 0.9];
        let (mut plain, mut once) = ([0.0; 3], [0.0; 3]);
        Interpreter::new(Arc::new(program.clone())).eval(0.0, &y, &[], &mut plain);
        Interpreter::new(Arc::new(fused)).eval(0.0, &y, &[], &mut once);
        for (p, o) in plain.iter().zip(&once) {
            assert!((p - o).abs() <= 1e-15 * p.abs().max(1.0));
        }
        let cost = program.cost();
        let counts: Vec<_> = cost.iter().collect();
        assert_eq!(counts, [("fma", 2), ("mul", 2), ("neg", 1), ("sin", 1)]);
    }
}
