//! Programs with numbers in place of parameters.

use rustc_hash::FxHashMap;

use crate::program::program::{Instruction, Program, Register};

/// The counterpart of a register of the free program in the bound one.
#[derive(Clone, Copy)]
enum Value {
    Number(f64),
    /// A register, numbered as in the free program.
    Register(Register),
}

impl Program {
    /// The same program with these values in place of the parameters, which it no longer reads: operations
    /// on them alone are computed here, and operations that become superfluous because a value is 0 or 1 are
    /// left out. The new program takes no more operations, and its results are the same to the last bit where
    /// they are finite, up to the sign of zero.
    ///
    /// Substituting numbers into expressions before they become a program may make it shorter or longer:
    /// the normal form multiplies them into sums, so a sum that is computed once in the free program and
    /// multiplied by several parameters becomes a different sum for each number.
    ///
    /// ```
    /// use pc_expr::{Graph, Inputs, Program};
    ///
    /// let graph = Graph::new();
    /// let [x, a, b] = graph.symbols(["x", "a", "b"]);
    /// let inputs = Inputs { time: None, state: vec![x], parameters: vec![a, b] };
    /// let program = Program::new(&graph, &inputs, &[(a + b).sqrt() * x, b * x.sin()])?;
    /// assert_eq!(program.cost().total(), 5);
    /// assert_eq!(program.bound(&[3.0, 1.0]).cost().total(), 2);
    /// # Ok::<(), pc_expr::ExprError>(())
    /// ```
    ///
    /// # Panics
    /// Unless there are as many values as parameters.
    #[must_use]
    pub fn bound(&self, parameters: &[f64]) -> Program {
        assert_eq!(parameters.len(), self.parameters, "values of the parameters");
        let values: Vec<Option<f64>> = parameters.iter().copied().map(Some).collect();
        self.binding(&values)
    }

    /// Like [`bound`](Self::bound), but only for those parameters for which `value` gives a number.
    #[must_use]
    pub fn bound_where(&self, value: impl Fn(&str) -> Option<f64>) -> Program {
        let names = &self.names[self.names.len() - self.parameters..];
        self.binding(&names.iter().map(|name| value(name)).collect::<Vec<_>>())
    }

    fn binding(&self, parameters: &[Option<f64>]) -> Program {
        let (first_input, first_result) = (self.first_input(), self.first_result());
        let first_parameter = first_result - self.parameters;
        let mut values: Vec<Value> = (0..first_result)
            .map(|r| match (r.checked_sub(first_parameter), r < first_input) {
                (_, true) => Value::Number(self.constants[r]),
                (Some(p), _) => parameters[p].map_or(Value::Register(Register(r as u32)), Value::Number),
                (None, false) => Value::Register(Register(r as u32)),
            })
            .collect();
        let mut kept: Vec<Option<Instruction>> = Vec::with_capacity(self.code.len());
        for (i, &instruction) in self.code.iter().enumerate() {
            let own = Value::Register(Register((first_result + i) as u32));
            let value = known(instruction, |r| values[r.index()]).unwrap_or(own);
            let stays = matches!((value, own), (Value::Register(a), Value::Register(b)) if a == b);
            kept.push(stays.then_some(instruction));
            values.push(value);
        }
        self.rebuilt(&values, &kept)
    }

    /// The program of those `kept` instructions that are needed, with `values` for their operands.
    fn rebuilt(&self, values: &[Value], kept: &[Option<Instruction>]) -> Program {
        let first_result = self.first_result();
        let mut needed = vec![false; values.len()];
        for output in &self.outputs {
            if let Value::Register(r) = values[output.index()] {
                needed[r.index()] = true;
            }
        }
        for (i, instruction) in kept.iter().enumerate().rev() {
            if let Some(instruction) = instruction.filter(|_| needed[first_result + i]) {
                for operand in instruction.operands() {
                    if let Value::Register(r) = values[operand.index()] {
                        needed[r.index()] = true;
                    }
                }
            }
        }
        let code: Vec<(usize, Instruction)> = (kept.iter().enumerate())
            .filter_map(|(i, instruction)| Some((first_result + i, (*instruction)?)))
            .filter(|&(register, _)| needed[register])
            .collect();
        let (mut constants, mut places) = (Vec::new(), FxHashMap::default());
        let read = code
            .iter()
            .flat_map(|(_, instruction)| instruction.operands())
            .chain(self.outputs.iter().copied());
        for register in read {
            if let Value::Number(c) = values[register.index()] {
                places.entry(c.to_bits()).or_insert_with(|| {
                    constants.push(c);
                    constants.len() as u32 - 1
                });
            }
        }
        let inputs = constants.len() as u32;
        let results = inputs + self.names.len() as u32;
        let mut new: FxHashMap<usize, u32> =
            (0..self.names.len()).map(|i| (self.first_input() + i, inputs + i as u32)).collect();
        new.extend(code.iter().enumerate().map(|(i, &(register, _))| (register, results + i as u32)));
        let place = |r: Register| match values[r.index()] {
            Value::Number(c) => Register(places[&c.to_bits()]),
            Value::Register(r) => Register(new[&r.index()]),
        };
        Program {
            code: code.iter().map(|(_, instruction)| instruction.map(place)).collect(),
            outputs: self.outputs.iter().map(|&output| place(output)).collect(),
            constants,
            names: self.names.clone(),
            state: self.state,
            parameters: self.parameters,
        }
    }
}

/// The result of an instruction, if it is known without computation at run time.
fn known(instruction: Instruction, value: impl Fn(Register) -> Value) -> Option<Value> {
    use Value::Number as N;
    let number = |r| match value(r) {
        N(c) => Some(c),
        Value::Register(_) => None,
    };
    let all: Option<Vec<f64>> = instruction.operands().map(number).collect();
    if let Some(all) = all {
        return Some(N(match instruction {
            Instruction::Add(..) => all[0] + all[1],
            Instruction::Subtract(..) => all[0] - all[1],
            Instruction::Multiply(..) => all[0] * all[1],
            Instruction::Divide(..) => all[0] / all[1],
            Instruction::Negate(_) => -all[0],
            Instruction::MultiplyAdd(..) => all[0].mul_add(all[1], all[2]),
            Instruction::MultiplySubtract(..) => all[0].mul_add(all[1], -all[2]),
            Instruction::NegateMultiplyAdd(..) => (-all[0]).mul_add(all[1], all[2]),
            Instruction::NegateMultiplySubtract(..) => (-all[0]).mul_add(all[1], -all[2]),
            Instruction::Call(function, _) => function.eval(&all),
        }));
    }
    match instruction {
        Instruction::Add(a, b) => match (value(a), value(b)) {
            (N(0.0), other) | (other, N(0.0)) => Some(other),
            _ => None,
        },
        Instruction::Subtract(a, b) => match (value(a), value(b)) {
            (other, N(0.0)) => Some(other),
            _ => None,
        },
        Instruction::Multiply(a, b) => match (value(a), value(b)) {
            (N(0.0), _) | (_, N(0.0)) => Some(N(0.0)),
            (N(1.0), other) | (other, N(1.0)) => Some(other),
            _ => None,
        },
        Instruction::Divide(a, b) => match (value(a), value(b)) {
            (N(0.0), _) => Some(N(0.0)),
            (other, N(1.0)) => Some(other),
            _ => None,
        },
        _ => None,
    }
}
