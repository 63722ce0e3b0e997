//! Factors made of parameters, moved to where they cost nothing.
//!
//! In ω̇ = −((C−B) ω₂ω₃ + mg (r₃γ₂ − r₂γ₃))/A the parameters determine −(C−B)/A, −mg r₃/A and mg r₂/A; with these as parameters, four
//! of ten operations remain, and no division.

use rustc_hash::FxHashMap;

use crate::program::builder::Builder;
use crate::program::program::{Instruction, Program, Register};

impl Program {
    /// This program divided into two: the first computes from the parameters the numbers that the second
    /// takes as its parameters.
    ///
    /// A factor that depends on parameters alone goes into the terms of a sum, if each of them has such a factor already, and a
    /// division by it becomes a multiplication by its inverse. So the outputs may differ from this program's by rounding
    /// errors.
    ///
    /// ```
    /// # use pc_expr::{Graph, Inputs, Program};
    /// let graph = Graph::new();
    /// let [x, y, m, k, c] = graph.symbols(["x", "y", "m", "k", "c"]);
    /// let inputs = Inputs { time: None, state: vec![x, y], parameters: vec![m, k, c] };
    /// let program = Program::new(&graph, &inputs, &[-(k * x + c * y) / m])?;
    /// let (first, second) = program.factored();
    /// assert_eq!((first.outputs_len(), second.parameters_len()), (2, 2)); // −k/m and −c/m
    /// assert_eq!(second.cost().total(), 2);
    /// # Ok::<(), pc_expr::ExprError>(())
    /// ```
    pub fn factored(&self) -> (Program, Program) {
        let mut factoring = Factoring::of(self);
        let plans = factoring.plans();
        factoring.split(&plans)
    }
}

/// The new form of an instruction whose result depends on more than parameters; factors are registers of the first program.
#[derive(Clone, Copy)]
enum Plan {
    /// The same operation on the new forms of its operands.
    Same,
    /// The value of the operand, which receives the factor.
    Operand(Register),
    /// A product with a factor.
    Scaled(Register, Register),
    /// A factor divided by a register.
    Over(Register, Register),
}

struct Factoring<'a> {
    program: &'a Program,
    first: Builder,
    /// The fixed registers, as registers of the first program.
    fixed: Vec<Option<Register>>,
    /// Whether a value can take a factor without a further operation.
    is_free: Vec<bool>,
    /// The factor that each result is to receive.
    asked: Vec<Option<Register>>,
}

impl<'a> Factoring<'a> {
    fn of(program: &'a Program) -> Factoring<'a> {
        let first_parameter = program.first_result() - program.parameters;
        let mut first = Builder::default();
        let mut fixed: Vec<Option<Register>> =
            program.constants.iter().map(|&value| Some(first.constant(value))).collect();
        fixed.resize(first_parameter, None);
        fixed.extend((0..program.parameters).map(|i| Some(first.input(1 + i))));
        let mut is_free: Vec<bool> = fixed.iter().map(Option::is_some).collect();
        let uses = program.uses();
        for &instruction in &program.code {
            let operands: Option<Vec<Register>> =
                instruction.operands().map(|operand| fixed[operand.index()]).collect();
            let takes = |r: Register| is_free[r.index()];
            let free = match instruction {
                Instruction::Multiply(a, b) => takes(a) || takes(b),
                Instruction::Divide(a, b) => takes(a) || fixed[b.index()].is_some(),
                Instruction::Negate(_) => true,
                Instruction::Add(a, b) | Instruction::Subtract(a, b) => takes(a) && takes(b),
                _ => false,
            };
            is_free.push(operands.is_some() || free && uses[fixed.len()] == 1);
            fixed.push(operands.map(|operands| first.result(translated(instruction, &operands))));
        }
        let asked = vec![None; fixed.len()];
        Factoring { program, first, fixed, is_free, asked }
    }

    /// The new form of each instruction, found backwards from the outputs.
    fn plans(&mut self) -> Vec<Plan> {
        let first_result = self.program.first_result();
        let mut plans = vec![Plan::Same; self.program.code.len()];
        for (i, &instruction) in self.program.code.iter().enumerate().rev() {
            if self.fixed[first_result + i].is_none() {
                plans[i] = self.plan(instruction, self.asked[first_result + i]);
            }
        }
        plans
    }

    /// The new form of an instruction whose result is to receive a factor.
    fn plan(&mut self, instruction: Instruction, factor: Option<Register>) -> Plan {
        let fixed = |r: Register| self.fixed[r.index()];
        match instruction {
            Instruction::Multiply(a, b) => match (fixed(a), fixed(b)) {
                (None, Some(b)) => self.scaled(a, factor, b),
                (Some(a), _) => self.scaled(b, factor, a),
                (None, None) => self.ask([if self.is_free[a.index()] { a } else { b }], factor),
            },
            Instruction::Divide(a, b) => match (fixed(a), fixed(b), factor) {
                (_, Some(b), _) => {
                    let above = factor.unwrap_or_else(|| self.first.constant(1.0));
                    let factor = self.first.result(Instruction::Divide(above, b));
                    self.scaled(a, None, factor)
                }
                (Some(a), None, Some(factor)) => {
                    Plan::Over(self.first.result(Instruction::Multiply(factor, a)), b)
                }
                (_, None, _) => self.ask([a], factor),
            },
            Instruction::Negate(a) if factor.is_some() || self.is_free[a.index()] => {
                let minus = self.first.constant(-1.0);
                self.scaled(a, factor, minus)
            }
            Instruction::Add(a, b) | Instruction::Subtract(a, b) => self.ask([a, b], factor),
            _ => Plan::Same,
        }
    }

    /// Gives a factor to the operands; fixed ones receive it where they are read.
    fn ask<const N: usize>(&mut self, operands: [Register; N], factor: Option<Register>) -> Plan {
        for operand in operands.map(Register::index) {
            if self.fixed[operand].is_none() && factor.is_some() {
                self.asked[operand] = factor;
            }
        }
        Plan::Same
    }

    /// A value that is not fixed, times two factors.
    fn scaled(&mut self, a: Register, factor: Option<Register>, other: Register) -> Plan {
        let both = match factor {
            Some(factor) => self.first.result(Instruction::Multiply(factor, other)),
            None => other,
        };
        if !self.is_free[a.index()] {
            return Plan::Scaled(a, both);
        }
        self.asked[a.index()] = Some(both);
        Plan::Operand(a)
    }

    fn split(self, plans: &[Plan]) -> (Program, Program) {
        let program = self.program;
        let mut rest = Rest::of(self);
        for (&instruction, &plan) in program.code.iter().zip(plans) {
            let value = rest.made(instruction, plan);
            rest.values.push(value);
        }
        let outputs: Vec<Register> = program.outputs.iter().map(|&output| rest.read(output, None)).collect();
        rest.programs(&outputs)
    }
}

/// The second program, being built.
struct Rest<'a> {
    given: Factoring<'a>,
    second: Builder,
    /// The new forms of the registers that are not fixed.
    values: Vec<Register>,
    /// The parameters of the second program: registers of the first program, and their indices.
    numbers: Vec<Register>,
    places: FxHashMap<Register, usize>,
}

impl<'a> Rest<'a> {
    fn of(given: Factoring<'a>) -> Rest<'a> {
        let program = given.program;
        let mut second = Builder::default();
        // Nothing reads the places of what is fixed.
        let mut values = vec![Register(0); program.first_input()];
        values.extend((0..=program.state).map(|i| second.input(i)));
        values.resize(program.first_result(), Register(0));
        Rest { given, second, values, numbers: Vec::new(), places: FxHashMap::default() }
    }

    /// Adds the new form of the next instruction.
    fn made(&mut self, instruction: Instruction, plan: Plan) -> Register {
        let place = self.values.len();
        if self.given.fixed[place].is_some() {
            return Register(0);
        }
        match plan {
            Plan::Operand(a) => self.read(a, None),
            Plan::Scaled(a, factor) => {
                let (a, factor) = (self.read(a, None), self.number(factor));
                self.second.result(Instruction::Multiply(a, factor))
            }
            Plan::Over(factor, b) => {
                let (factor, b) = (self.number(factor), self.read(b, None));
                self.second.result(Instruction::Divide(factor, b))
            }
            Plan::Same => {
                let factor = match instruction {
                    Instruction::Add(..) | Instruction::Subtract(..) => self.given.asked[place],
                    // That of a product is with one of its operands.
                    _ => None,
                };
                let operands: Vec<Register> =
                    instruction.operands().map(|operand| self.read(operand, factor)).collect();
                self.second.result(translated(instruction, &operands))
            }
        }
    }

    /// The new form of a register, multiplied by a factor if the register is fixed.
    fn read(&mut self, register: Register, factor: Option<Register>) -> Register {
        match (self.given.fixed[register.index()], factor) {
            (None, _) => self.values[register.index()],
            (Some(fixed), None) => self.number(fixed),
            (Some(fixed), Some(factor)) => {
                let scaled = self.given.first.result(Instruction::Multiply(factor, fixed));
                self.number(scaled)
            }
        }
    }

    /// A register of the first program as a parameter, or a constant.
    fn number(&mut self, register: Register) -> Register {
        if let Some(value) = self.given.first.constant_in(register) {
            return self.second.constant(value);
        }
        let place = *self.places.entry(register).or_insert_with(|| {
            self.numbers.push(register);
            self.numbers.len() - 1
        });
        self.second.input(1 + self.given.program.state + place)
    }

    fn programs(self, outputs: &[Register]) -> (Program, Program) {
        let (program, numbers) = (self.given.program, self.numbers);
        let (before, parameters) = program.names.split_at(1 + program.state);
        let of_first = before[..1].iter().chain(parameters).cloned().collect();
        let first = self.given.first.program(of_first, [0, program.parameters], &numbers);
        let further = (1..=numbers.len()).map(|i| format!("number {i} of the parameters"));
        let of_second = before.iter().cloned().chain(further).collect();
        (first, self.second.program(of_second, [program.state, numbers.len()], outputs))
    }
}

/// The same operation on other registers.
fn translated(instruction: Instruction, operands: &[Register]) -> Instruction {
    let pairs: Vec<(Register, Register)> = instruction.operands().zip(operands.iter().copied()).collect();
    // What a function does not read may be anything.
    let other = |r: Register| pairs.iter().find(|pair| pair.0 == r).map_or(operands[0], |pair| pair.1);
    instruction.map(other)
}
