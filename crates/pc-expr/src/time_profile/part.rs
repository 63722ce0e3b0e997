//! The watched part of a program, and its inputs.

use super::interval::Interval;
use super::jet::Jet;
use super::motion::PolynomialMotion;
use crate::program::program::{Instruction, Program, Register};

/// How the value of a register changes with time.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Motion {
    /// The value contains t.
    pub(crate) time: bool,
    /// The value contains components of the state.
    pub(crate) state: bool,
    /// The value contains t, other than in a linear function a t + b with fixed a and b.
    bent: bool,
}

impl Motion {
    fn is_fixed(self) -> bool {
        !self.time && !self.state
    }

    pub(crate) fn is_mixed(self) -> bool {
        self.time && self.state
    }

    /// Whether this is a nonlinear function of t alone.
    fn is_forcing(self) -> bool {
        self.time && !self.state && self.bent
    }
}

/// A watched function.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Watch {
    /// The value of a register.
    Value(usize),
    /// Its reciprocal.
    Reciprocal(usize),
}

impl Watch {
    fn register(self) -> usize {
        match self {
            Watch::Value(place) | Watch::Reciprocal(place) => place,
        }
    }
}

/// The watched functions, and the instructions that compute them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Part {
    pub(crate) watched: Vec<Watch>,
    /// Whether rises count as features: they do for functions that are multiplied by factors which may vanish
    /// where the functions turn, and whose bends enclosures do not show.
    pub(crate) shows_rises: bool,
    code: Vec<(usize, Instruction)>,
    /// The functions that are currently watched, and the registers that lead to them.
    attended: Vec<bool>,
    needed: Vec<bool>,
    /// Jets of constants, time, state and parameters, followed by the results.
    registers: Vec<Jet>,
    /// The register of time; the components of the state follow.
    time: usize,
    /// The components of the state that are read.
    states: Vec<usize>,
    /// Room for the polynomial of a component, expanded about a point.
    local: Vec<f64>,
}

/// How a program depends on time.
pub(crate) struct Analysis {
    /// Whether an output contains t.
    pub(crate) explicit: bool,
    /// Functions of t alone.
    pub(crate) forcing: Part,
}

impl Analysis {
    pub(crate) fn of(program: &Program, parameters: &[f64]) -> Analysis {
        let motions = motions(program);
        let used = |register: &Register| motions[register.index()].time;
        let forcing = (program.first_result()..).zip(program.code());
        let forcing = forcing
            .filter(|&(place, instruction)| motions[place].is_forcing() && !is_copy(instruction, &motions))
            .map(|(place, _)| Watch::Value(place));
        Analysis {
            explicit: program.outputs().iter().any(used),
            forcing: Part::new(program, parameters, forcing.collect()),
        }
    }
}

pub(crate) fn motions(program: &Program) -> Vec<Motion> {
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

/// Marks the registers that the instructions of marked registers read.
fn spread(needed: &mut [bool], code: impl DoubleEndedIterator<Item = (usize, Instruction)>) {
    for (place, instruction) in code.rev() {
        if needed[place] {
            instruction.operands().for_each(|operand| needed[operand.index()] = true);
        }
    }
}

impl Part {
    pub(crate) fn new(program: &Program, parameters: &[f64], watched: Vec<Watch>) -> Part {
        let first = program.first_result();
        let mut needed = vec![false; program.registers_len()];
        watched.iter().for_each(|watch| needed[watch.register()] = true);
        spread(&mut needed, (first..program.registers_len()).zip(program.code().iter().copied()));
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
        let states = (0..program.state_len()).filter(|i| needed[time + 1 + i]).collect();
        let attended = vec![true; watched.len()];
        Part {
            watched,
            shows_rises: false,
            code,
            attended,
            needed,
            registers,
            time,
            states,
            local: Vec::new(),
        }
    }

    /// Encloses only these of the watched functions from now on; the others count as constants.
    pub(crate) fn attend_to(&mut self, functions: &[bool]) {
        self.attended.clear();
        self.attended.extend_from_slice(functions);
        self.needed.fill(false);
        for (watch, _) in self.watched.iter().zip(functions).filter(|(_, is_attended)| **is_attended) {
            self.needed[watch.register()] = true;
        }
        spread(&mut self.needed, self.code.iter().copied());
    }

    /// Whether only these first components of the state are read.
    pub(crate) fn reads_only(&self, dim: usize) -> bool {
        self.states.iter().all(|&i| i < dim)
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.watched.is_empty()
    }

    /// Number of instructions.
    pub(crate) fn len(&self) -> usize {
        self.code.len()
    }

    /// Encloses the part between the times `a` and `b`, along a motion of states of `dim` components.
    pub(crate) fn enclose(&mut self, (a, b): (f64, f64), (motion, dim): (PolynomialMotion<'_>, usize)) {
        self.registers[self.time] = Jet::line(Interval::between(a, b), 1.0);
        let near = (0.5 * ((a - motion.start) + (b - motion.start)), 0.5 * (b - a).abs());
        for &i in self.states.iter().filter(|i| self.needed[self.time + 1 + **i]) {
            self.registers[self.time + 1 + i] = motion.component((i, dim), near, &mut self.local);
        }
        for (place, instruction) in self.code.iter().filter(|(place, _)| self.needed[*place]) {
            self.registers[*place] = Jet::of(instruction, |register| self.registers[register.index()]);
        }
    }

    /// The watched functions where the part was last enclosed.
    pub(crate) fn jets(&self) -> impl Iterator<Item = Jet> + '_ {
        self.watched.iter().zip(&self.attended).map(|(&watch, &is_attended)| match watch {
            _ if !is_attended => Jet::constant(0.0),
            Watch::Value(place) => self.at(place),
            Watch::Reciprocal(place) => self.at(place).recip(),
        })
    }

    /// The value of a register where the part was last enclosed.
    pub(crate) fn at(&self, register: usize) -> Jet {
        self.registers[register]
    }

    /// The watched functions between two times, along a motion.
    pub(crate) fn over(
        &mut self,
        between: (f64, f64),
        along: (PolynomialMotion<'_>, usize),
    ) -> impl Iterator<Item = Jet> + '_ {
        self.enclose(between, along);
        self.jets()
    }
}
