//! Kernels, which run programs.

use std::sync::Arc;

use crate::error::ExprError;
use crate::graph::function::Function;
use crate::kernel::tape::Tape;
use crate::program::program::{Instruction, Program, Register};

/// The signature of compiled code: t, the state, the parameters, the outputs, scratch memory. It
/// returns whether all outputs are finite.
///
/// The pointers point to arrays of the lengths that the [`Program`] gives, and to scratch of its
/// required length; a pointer to an empty array is not read. Outputs and scratch must not overlap
/// anything else: an output may be written before the last input is read. The code keeps no state, so
/// any number of threads may run it at once, each with its own outputs and scratch. On x86-64, other
/// vector code that returns without `vzeroupper` makes it many times slower.
pub type Entry = unsafe extern "C" fn(
    t: f64,
    state: *const f64,
    parameters: *const f64,
    outputs: *mut f64,
    scratch: *mut f64,
) -> bool;

/// Computes the outputs of a [`Program`]; all kernels of a program give the same values.
pub trait Kernel: Send + Sync {
    /// Computes the outputs at (t, state, parameters).
    ///
    /// The slices have the lengths `state_len`, `parameters_len` and `outputs_len` of the program.
    fn eval(&mut self, t: f64, state: &[f64], parameters: &[f64], outputs: &mut [f64]);

    /// The same, but writes only the leading outputs, as many as the kernel was compiled with, to
    /// `leading`. Returns the others, and whether all outputs are finite.
    fn eval_leading(
        &mut self,
        t: f64,
        state: &[f64],
        parameters: &[f64],
        leading: &mut [f64],
    ) -> (&[f64], bool);

    /// An independent kernel of the same program, for another thread.
    fn fork(&self) -> Box<dyn Kernel>;

    /// The machine code, if there is any, for callers that manage memory themselves, and the length
    /// of its scratch memory. Valid as long as this kernel or a fork of it exists.
    fn machine_code(&self) -> Option<(Entry, usize)> {
        None
    }
}

/// The reference kernel: executes one operation after another.
#[derive(Clone, Debug)]
pub struct Interpreter {
    program: Arc<Program>,
    /// `None` for a program that is too long for a tape or has fused operations.
    pub(super) tape: Option<Arc<Tape>>,
    registers: Vec<f64>,
    /// All outputs, where they are not written to one slice.
    outputs: Vec<f64>,
}

impl Interpreter {
    /// A kernel for `program`.
    pub fn new(program: Arc<Program>) -> Interpreter {
        let tape = Tape::new(&program).map(Arc::new);
        let registers = match &tape {
            Some(tape) => tape.registers(),
            None => vec![0.0; program.registers_len()],
        };
        Interpreter { program, tape, registers, outputs: Vec::new() }
    }

    /// The program.
    pub fn program(&self) -> &Arc<Program> {
        &self.program
    }

    /// Runs the program and returns the values that are not finite: inputs, or else the innermost
    /// expression, if any.
    ///
    /// The slices have the same lengths as for [`eval`](Kernel::eval).
    pub fn diagnose(&mut self, t: f64, state: &[f64], parameters: &[f64]) -> Option<ExprError> {
        let program = &self.program;
        let names = || program.input_names().iter().cloned();
        let mut given: Vec<(String, f64)> = names().zip([&[t], state, parameters].concat()).collect();
        given.retain(|(_, value)| !value.is_finite());
        if !given.is_empty() {
            return Some(ExprError::GivenNotFinite { given });
        }
        let mut registers = vec![0.0; program.registers_len()];
        walk(program, &mut registers, t, state, parameters);
        let taken = taken(program, &registers);
        let culprit = (0..registers.len()).find(|&i| taken[i] && !registers[i].is_finite())?;
        Some(ExprError::NotFinite {
            expression: program.describe(Register(culprit as u32)),
            value: registers[culprit],
            t,
            state: names().skip(1).zip(state.iter().copied()).collect(),
        })
    }
}

impl Kernel for Interpreter {
    fn eval(&mut self, t: f64, state: &[f64], parameters: &[f64], outputs: &mut [f64]) {
        if let Some(tape) = &self.tape {
            return tape.run(&mut self.registers, t, state, parameters, outputs);
        }
        walk(&self.program, &mut self.registers, t, state, parameters);
        for (output, register) in outputs.iter_mut().zip(self.program.outputs()) {
            *output = self.registers[register.index()];
        }
    }

    fn eval_leading(
        &mut self,
        t: f64,
        state: &[f64],
        parameters: &[f64],
        leading: &mut [f64],
    ) -> (&[f64], bool) {
        let mut outputs = std::mem::take(&mut self.outputs);
        outputs.resize(self.program.outputs_len(), f64::NAN);
        self.eval(t, state, parameters, &mut outputs);
        self.outputs = outputs;
        let (first, others) = self.outputs.split_at(leading.len());
        leading.copy_from_slice(first);
        (others, self.outputs.iter().all(|output| output.is_finite()))
    }

    fn fork(&self) -> Box<dyn Kernel> {
        Box::new(self.clone())
    }
}

/// The registers on which the outputs depend at these values, without the branches of `step` that
/// are not taken.
fn taken(program: &Program, registers: &[f64]) -> Vec<bool> {
    let mut taken = vec![false; registers.len()];
    program.outputs().iter().for_each(|output| taken[output.index()] = true);
    for (i, instruction) in program.code().iter().enumerate().rev() {
        if !taken[program.first_result() + i] {
            continue;
        }
        match *instruction {
            Instruction::Call(Function::Step, [condition, first, second]) => {
                taken[condition.index()] = true;
                let condition = registers[condition.index()];
                taken[first.index()] |= condition >= 0.0;
                taken[second.index()] |= condition < 0.0;
            }
            other => other.operands().for_each(|operand| taken[operand.index()] = true),
        }
    }
    taken
}

/// Computes all registers of a program, whatever their previous values.
pub(super) fn walk(program: &Program, registers: &mut [f64], t: f64, state: &[f64], parameters: &[f64]) {
    let inputs = program.first_input();
    let first = program.first_result();
    registers[..inputs].copy_from_slice(program.constants());
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
