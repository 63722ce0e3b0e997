//! What runs a program.

use std::sync::Arc;

use crate::error::ExprError;
use crate::program::{Instruction, Program, Register};

/// Something that computes the outputs of a [`Program`]; all kernels of a program give the same values.
pub trait Kernel: Send {
    /// Computes the outputs at (t, state, parameters).
    ///
    /// The slices have the lengths that the program says: `state_len`, `parameters_len`, `outputs_len`.
    fn eval(&mut self, t: f64, state: &[f64], parameters: &[f64], outputs: &mut [f64]);

    /// An independent kernel of the same program, for another thread.
    fn fork(&self) -> Box<dyn Kernel>;
}

/// The fastest kernel for `program` on this host: machine code, or the interpreter where none can be made.
pub fn compile(program: Arc<Program>) -> Box<dyn Kernel> {
    #[cfg(feature = "jit")]
    if let Ok(jit) = crate::jit::Jit::new(&program) {
        return Box::new(jit);
    }
    Box::new(Interpreter::new(program))
}

/// The reference kernel: walks the tape.
#[derive(Clone, Debug)]
pub struct Interpreter {
    program: Arc<Program>,
    registers: Vec<f64>,
}

impl Interpreter {
    /// A kernel for `program`.
    pub fn new(program: Arc<Program>) -> Interpreter {
        let mut registers = vec![0.0; program.registers_len()];
        registers[..program.constants().len()].copy_from_slice(program.constants());
        Interpreter { program, registers }
    }

    /// The program.
    pub fn program(&self) -> &Arc<Program> {
        &self.program
    }

    fn run(&mut self, t: f64, state: &[f64], parameters: &[f64]) {
        let program = &*self.program;
        let inputs = program.first_input();
        let first = program.first_result();
        let registers = &mut self.registers[..program.registers_len()];
        registers[inputs] = t;
        registers[inputs + 1..inputs + 1 + state.len()].copy_from_slice(state);
        registers[inputs + 1 + state.len()..first].copy_from_slice(parameters);
        for (i, instruction) in program.code().iter().enumerate() {
            let get = |r: Register| registers[r.index()];
            registers[first + i] = match *instruction {
                Instruction::Add(a, b) => get(a) + get(b),
                Instruction::Subtract(a, b) => get(a) - get(b),
                Instruction::Multiply(a, b) => get(a) * get(b),
                Instruction::Divide(a, b) => get(a) / get(b),
                Instruction::Negate(a) => -get(a),
                Instruction::MultiplyAdd(a, b, c) => get(a).mul_add(get(b), get(c)),
                Instruction::MultiplySubtract(a, b, c) => get(a).mul_add(get(b), -get(c)),
                Instruction::NegateMultiplyAdd(a, b, c) => (-get(a)).mul_add(get(b), get(c)),
                Instruction::NegateMultiplySubtract(a, b, c) => (-get(a)).mul_add(get(b), -get(c)),
                Instruction::Call(function, args) => function.eval(&args.map(get)),
            };
        }
    }

    /// Runs the program and answers the innermost expression whose value is not finite, if there is one.
    ///
    /// The slices have the lengths that the program says.
    pub fn diagnose(&mut self, t: f64, state: &[f64], parameters: &[f64]) -> Option<ExprError> {
        self.run(t, state, parameters);
        let culprit = self.registers.iter().position(|value| !value.is_finite())?;
        let program = &self.program;
        let names = program.input_names()[1..].iter().cloned();
        Some(ExprError::NotFinite {
            expression: program.describe(Register(culprit as u32)),
            value: self.registers[culprit],
            t,
            state: names.zip(state.iter().copied()).collect(),
        })
    }
}

impl Kernel for Interpreter {
    fn eval(&mut self, t: f64, state: &[f64], parameters: &[f64], outputs: &mut [f64]) {
        self.run(t, state, parameters);
        for (output, register) in outputs.iter_mut().zip(self.program.outputs()) {
            *output = self.registers[register.index()];
        }
    }

    fn fork(&self) -> Box<dyn Kernel> {
        Box::new(self.clone())
    }
}
