//! The watched part of a program, and its inputs.

use super::interval::Interval;
use super::jet::Jet;
use crate::graph::function::Function;
use crate::program::program::{Instruction, Program, Register};

/// How the value of a register changes with time.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
struct Motion {
    /// Contains t.
    time: bool,
    /// Contains components of the state.
    state: bool,
    /// Contains t other than in a linear function a t + b with fixed a and b.
    bent: bool,
}

impl Motion {
    fn is_fixed(self) -> bool {
        !self.time && !self.state
    }

    fn is_mixed(self) -> bool {
        self.time && self.state
    }

    /// Whether this is a nonlinear function of t alone.
    fn is_forcing(self) -> bool {
        self.time && !self.state && self.bent
    }
}

/// The watched registers, and the instructions that compute them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Part {
    pub(crate) watched: Vec<usize>,
    code: Vec<(usize, Instruction)>,
    /// Jets of constants, time, state and parameters, followed by the results.
    registers: Vec<Jet>,
    /// The register of time; the components of the state follow.
    time: usize,
    dim: usize,
}

/// How a program depends on time.
pub(crate) struct Analysis {
    /// Whether an output contains t.
    pub(crate) explicit: bool,
    /// Functions of t alone.
    pub(crate) forcing: Part,
    /// Functions of t and the state that may rise and fall faster than either.
    pub(crate) mixed: Part,
}

impl Analysis {
    pub(crate) fn of(program: &Program, parameters: &[f64]) -> Analysis {
        let motions = motions(program);
        let used = |register: &Register| motions[register.index()].time;
        let first = program.first_result();
        let results = || (first..).zip(program.code());
        let forcing = results()
            .filter(|&(place, instruction)| motions[place].is_forcing() && !is_copy(instruction, &motions))
            .map(|(place, _)| place);
        let mixed = results()
            .filter(|&(place, instruction)| motions[place].is_mixed() && is_steep(instruction, &motions))
            .map(|(place, _)| place);
        Analysis {
            explicit: program.outputs().iter().any(used),
            forcing: Part::new(program, parameters, forcing.collect()),
            mixed: Part::new(program, parameters, mixed.collect()),
        }
    }
}

fn motions(program: &Program) -> Vec<Motion> {
    let mut motions = vec![Motion::default(); program.registers_len()];
    let time = program.first_input();
    motions[time].time = true;
    for motion in &mut motions[time + 1..][..program.state_len()] {
        motion.state = true;
    }
    for (place, instruction) in (program.first_result()..).zip(program.code()) {
        let mut motion = Motion::default();
        for operand in instruction.operands() {
            let operand = motions[operand.index()];
            motion.time |= operand.time;
            motion.state |= operand.state;
            motion.bent |= operand.bent;
        }
        let time = |register: Register| motions[register.index()].time;
        motion.bent |= match *instruction {
            Instruction::Add(..) | Instruction::Subtract(..) | Instruction::Negate(_) => false,
            Instruction::Multiply(a, b)
            | Instruction::MultiplyAdd(a, b, _)
            | Instruction::MultiplySubtract(a, b, _)
            | Instruction::NegateMultiplyAdd(a, b, _)
            | Instruction::NegateMultiplySubtract(a, b, _) => time(a) && time(b),
            Instruction::Divide(_, b) => time(b),
            Instruction::Call(..) => motion.time,
        };
        motions[place] = motion;
    }
    motions
}

/// Whether a function of time is another one shifted or scaled: both turn at the same times.
fn is_copy(instruction: &Instruction, motions: &[Motion]) -> bool {
    let moving = || instruction.operands().filter(|operand| !motions[operand.index()].is_fixed());
    let same_steepness = match *instruction {
        Instruction::Call(..) => false,
        Instruction::Divide(_, b) => motions[b.index()].is_fixed(),
        _ => true,
    };
    same_steepness && moving().count() == 1
}

/// Whether a function of t and the state may change much faster than its arguments.
fn is_steep(instruction: &Instruction, motions: &[Motion]) -> bool {
    let mixed = |register: Register| motions[register.index()].is_mixed();
    match *instruction {
        Instruction::Divide(_, b) => mixed(b),
        Instruction::Call(Function::Sin | Function::Cos, _) => false,
        Instruction::Call(..) => instruction.operands().any(mixed),
        _ => false,
    }
}

impl Part {
    fn new(program: &Program, parameters: &[f64], watched: Vec<usize>) -> Part {
        let first = program.first_result();
        let mut needed = vec![false; program.registers_len()];
        watched.iter().for_each(|&place| needed[place] = true);
        for (i, instruction) in program.code().iter().enumerate().rev() {
            if needed[first + i] {
                instruction.operands().for_each(|operand| needed[operand.index()] = true);
            }
        }
        let code: Vec<_> = (first..)
            .zip(program.code())
            .filter(|&(place, _)| needed[place])
            .map(|(place, instruction)| (place, *instruction))
            .collect();
        let mut registers = vec![Jet::constant(0.0); if watched.is_empty() { 0 } else { needed.len() }];
        if !watched.is_empty() {
            for (register, &value) in registers.iter_mut().zip(program.constants()) {
                *register = Jet::constant(value);
            }
            let inputs = &mut registers[program.first_input() + 1 + program.state_len()..first];
            for (register, &value) in inputs.iter_mut().zip(parameters) {
                *register = Jet::constant(value);
            }
        }
        let time = program.first_input();
        Part { watched, code, registers, time, dim: program.state_len() }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.watched.is_empty()
    }

    /// Number of instructions.
    pub(crate) fn len(&self) -> usize {
        self.code.len()
    }

    /// The watched functions between the times `a` and `b`, along the line through (t, y) at the rate ẏ.
    pub(crate) fn over(&mut self, (a, b): (f64, f64), line: Line<'_>) -> impl Iterator<Item = Jet> + '_ {
        let span = Interval::between(a, b);
        self.registers[self.time] = Jet::line(span, 1.0);
        let state = &mut self.registers[self.time + 1..][..self.dim];
        for (register, (y, rate)) in state.iter_mut().zip(line.state.iter().zip(line.rates)) {
            let value = (span - Interval::point(line.t)).scale(*rate) + Interval::point(*y);
            *register = Jet::line(value, *rate);
        }
        for (place, instruction) in &self.code {
            self.registers[*place] = Jet::of(instruction, |register| self.registers[register.index()]);
        }
        self.watched.iter().map(|&place| self.registers[place])
    }
}

/// A motion to first order: y + (· − t) ẏ. Empty for functions that do not contain the state.
#[derive(Clone, Copy, Default)]
pub(crate) struct Line<'a> {
    pub(crate) t: f64,
    pub(crate) state: &'a [f64],
    pub(crate) rates: &'a [f64],
}
