//! Straight-line programs: chosen outputs of a graph as a tape that is independent of the graph.

use serde::{Deserialize, Serialize};

use crate::graph::expr::Expr;
use crate::graph::function::Function;
use crate::print::piece::{Binding, Piece, number};

/// A register of the tape: constants first, then inputs, then one for each instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Register(pub(crate) u32);

impl Register {
    /// Position in the register file.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// One operation; its result goes to the next register.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Instruction {
    /// a + b
    Add(Register, Register),
    /// a − b
    Subtract(Register, Register),
    /// a · b
    Multiply(Register, Register),
    /// a / b
    Divide(Register, Register),
    /// −a
    Negate(Register),
    /// a·b + c, rounded once where the processor can; only in a [fused](Program::fused) program
    MultiplyAdd(Register, Register, Register),
    /// a·b − c, likewise
    MultiplySubtract(Register, Register, Register),
    /// c − a·b, likewise
    NegateMultiplyAdd(Register, Register, Register),
    /// −a·b − c, likewise
    NegateMultiplySubtract(Register, Register, Register),
    /// f(a, …), with as many of the registers as f has arguments
    Call(Function, [Register; 3]),
}

impl Instruction {
    /// The registers read.
    pub fn operands(&self) -> impl Iterator<Item = Register> + '_ {
        let (registers, count) = match *self {
            Instruction::Add(a, b)
            | Instruction::Subtract(a, b)
            | Instruction::Multiply(a, b)
            | Instruction::Divide(a, b) => ([a, b, b], 2),
            Instruction::Negate(a) => ([a, a, a], 1),
            Instruction::MultiplyAdd(a, b, c)
            | Instruction::MultiplySubtract(a, b, c)
            | Instruction::NegateMultiplyAdd(a, b, c)
            | Instruction::NegateMultiplySubtract(a, b, c) => ([a, b, c], 3),
            Instruction::Call(function, args) => (args, function.arity()),
        };
        registers.into_iter().take(count)
    }

    /// The same operation on other registers.
    #[must_use]
    pub fn map(self, f: impl Fn(Register) -> Register) -> Instruction {
        use Instruction::*;
        match self {
            Add(a, b) => Add(f(a), f(b)),
            Subtract(a, b) => Subtract(f(a), f(b)),
            Multiply(a, b) => Multiply(f(a), f(b)),
            Divide(a, b) => Divide(f(a), f(b)),
            Negate(a) => Negate(f(a)),
            MultiplyAdd(a, b, c) => MultiplyAdd(f(a), f(b), f(c)),
            MultiplySubtract(a, b, c) => MultiplySubtract(f(a), f(b), f(c)),
            NegateMultiplyAdd(a, b, c) => NegateMultiplyAdd(f(a), f(b), f(c)),
            NegateMultiplySubtract(a, b, c) => NegateMultiplySubtract(f(a), f(b), f(c)),
            Call(function, args) => Call(function, args.map(f)),
        }
    }
}

/// The inputs of a program: time, a state and parameters, in this order.
#[derive(Clone, Debug, Default)]
pub struct Inputs<'g> {
    /// The symbol of time, if there is one.
    pub time: Option<Expr<'g>>,
    /// The symbols of the state.
    pub state: Vec<Expr<'g>>,
    /// The symbols of the parameters.
    pub parameters: Vec<Expr<'g>>,
}

/// A tape of operations that computes some outputs from (t, state, parameters). Owned, `Send` and `Sync`.
///
/// One that is read from elsewhere is refused unless every register is computed before it is read.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(try_from = "Unchecked")]
pub struct Program {
    pub(crate) constants: Vec<f64>,
    pub(crate) names: Vec<String>,
    pub(crate) state: usize,
    pub(crate) parameters: usize,
    pub(crate) code: Vec<Instruction>,
    pub(crate) outputs: Vec<Register>,
}

/// A program as it was stored.
#[derive(Deserialize)]
struct Unchecked {
    constants: Vec<f64>,
    names: Vec<String>,
    state: usize,
    parameters: usize,
    code: Vec<Instruction>,
    outputs: Vec<Register>,
}

impl TryFrom<Unchecked> for Program {
    type Error = &'static str;

    fn try_from(stored: Unchecked) -> Result<Program, &'static str> {
        let Unchecked { constants, names, state, parameters, code, outputs } = stored;
        let program = Program { constants, names, state, parameters, code, outputs };
        let inputs = program.state.checked_add(program.parameters).and_then(|inputs| inputs.checked_add(1));
        if inputs != Some(program.names.len()) {
            return Err("a program names other inputs than it has");
        }
        let first = program.first_result();
        let is_known = |(i, operation): (usize, &Instruction)| {
            operation.operands().all(|register| register.index() < first + i)
        };
        let all = program.registers_len();
        if !program.code.iter().enumerate().all(is_known)
            || !program.outputs.iter().all(|register| register.index() < all)
        {
            return Err("a program reads a register before it is computed");
        }
        Ok(program)
    }
}

impl Program {
    /// Length of the state.
    pub fn state_len(&self) -> usize {
        self.state
    }

    /// Number of parameters.
    pub fn parameters_len(&self) -> usize {
        self.parameters
    }

    /// Number of outputs.
    pub fn outputs_len(&self) -> usize {
        self.outputs.len()
    }

    /// The constants, which fill the first registers.
    pub fn constants(&self) -> &[f64] {
        &self.constants
    }

    /// The operations in order.
    pub fn code(&self) -> &[Instruction] {
        &self.code
    }

    /// The registers of the outputs.
    pub fn outputs(&self) -> &[Register] {
        &self.outputs
    }

    /// Names of the inputs: time, state, parameters.
    pub fn input_names(&self) -> &[String] {
        &self.names
    }

    /// The register of the first input, time.
    pub fn first_input(&self) -> usize {
        self.constants.len()
    }

    /// The register of the first result.
    pub fn first_result(&self) -> usize {
        self.constants.len() + self.names.len()
    }

    /// Number of registers.
    pub fn registers_len(&self) -> usize {
        self.first_result() + self.code.len()
    }

    /// Whether an output depends on the state.
    pub fn reads_state(&self) -> bool {
        let first = self.first_input() + 1;
        let is_state = |register: Register| (first..first + self.state).contains(&register.index());
        let operands = self.code.iter().flat_map(Instruction::operands);
        operands.chain(self.outputs.iter().copied()).any(is_state)
    }

    /// The contents of a register as text, abbreviated where they are deeply nested.
    pub fn describe(&self, register: Register) -> String {
        self.piece(register, 0).text
    }

    fn piece(&self, register: Register, depth: usize) -> Piece {
        let index = register.index();
        if index < self.first_input() {
            return number(self.constants[index].into());
        }
        if index < self.first_result() {
            return Piece::atom(self.names[index - self.first_input()].as_str());
        }
        if depth > 6 {
            return Piece::atom("…");
        }
        let operand = |r: Register| self.piece(r, depth + 1).text;
        let term = |r: Register| self.piece(r, depth + 1).at_least(Binding::Product);
        let divisor = |r: Register| self.piece(r, depth + 1).at_least(Binding::Power);
        let (text, binding) = match self.code[index - self.first_result()] {
            Instruction::Add(a, b) => (format!("{} + {}", operand(a), term(b)), Binding::Sum),
            Instruction::Subtract(a, b) => (format!("{} - {}", operand(a), term(b)), Binding::Sum),
            Instruction::Multiply(a, b) => (format!("{}*{}", term(a), term(b)), Binding::Product),
            Instruction::Divide(a, b) => (format!("{}/{}", term(a), divisor(b)), Binding::Product),
            Instruction::Negate(a) => (format!("-{}", term(a)), Binding::Sum),
            Instruction::MultiplyAdd(a, b, c) => {
                (format!("{}*{} + {}", term(a), term(b), term(c)), Binding::Sum)
            }
            Instruction::MultiplySubtract(a, b, c) => {
                (format!("{}*{} - {}", term(a), term(b), term(c)), Binding::Sum)
            }
            Instruction::NegateMultiplyAdd(a, b, c) => {
                (format!("{} - {}*{}", operand(c), term(a), term(b)), Binding::Sum)
            }
            Instruction::NegateMultiplySubtract(a, b, c) => {
                (format!("-{}*{} - {}", term(a), term(b), term(c)), Binding::Sum)
            }
            Instruction::Call(function, args) => {
                let args: Vec<String> = args[..function.arity()].iter().map(|&r| operand(r)).collect();
                (format!("{}({})", function.name(), args.join(", ")), Binding::Atom)
            }
        };
        Piece { text, binding }
    }
}
