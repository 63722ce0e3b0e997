//! Straight-line programs: chosen outputs of a graph as a tape that needs the graph no more.

use rustc_hash::FxHashMap;

use crate::cone::Cone;
use crate::dag::{Atom, Dag, Node, NodeId};
use crate::error::ExprError;
use crate::expr::Expr;
use crate::function::Function;
use crate::graph::Graph;
use crate::number::Number;

/// A register of the tape: constants first, then inputs, then one for each instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Register(pub(crate) u32);

impl Register {
    /// Position in the register file.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// One operation; its result goes to the next register.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
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
    /// f(a, …), as many of the registers as f has arguments
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

/// What a program reads: time, a state and parameters, in this order.
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
#[derive(Clone, Debug)]
pub struct Program {
    pub(crate) constants: Vec<f64>,
    names: Vec<String>,
    state: usize,
    parameters: usize,
    pub(crate) code: Vec<Instruction>,
    pub(crate) outputs: Vec<Register>,
}

impl Program {
    /// The program of `outputs`.
    ///
    /// # Errors
    /// [`ExprError::UnboundSymbol`] if an output contains a symbol that is not among the inputs,
    /// [`ExprError::DivisionByZero`] if the graph met a division by an expression that is identically zero.
    pub fn new<'g>(
        graph: &'g Graph,
        inputs: &Inputs<'g>,
        outputs: &[Expr<'g>],
    ) -> Result<Program, ExprError> {
        if outputs.iter().any(|x| x.is_undefined()) {
            graph.check()?;
        }
        let symbols: Vec<Option<NodeId>> = std::iter::once(inputs.time.map(|t| t.symbol_in(graph)))
            .chain(inputs.state.iter().chain(&inputs.parameters).map(|s| Some(s.symbol_in(graph))))
            .collect();
        let names = inputs.time.iter().chain(&inputs.state).chain(&inputs.parameters);
        let names = names.map(|s| s.symbol_name().unwrap_or_default());
        let names: Vec<String> = if inputs.time.is_some() {
            names.collect()
        } else {
            std::iter::once("t".to_owned()).chain(names).collect()
        };
        let atoms: Vec<Atom> = outputs.iter().map(|x| x.atom_in(graph)).collect();
        let mut program = Program {
            constants: Vec::new(),
            names,
            state: inputs.state.len(),
            parameters: inputs.parameters.len(),
            code: Vec::new(),
            outputs: Vec::new(),
        };
        graph.with(|dag| Lowering::new(dag, &symbols, &mut program).run(&atoms))?;
        Ok(program)
    }

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

    /// Text of what a register holds, abbreviated where it is deep.
    pub fn describe(&self, register: Register) -> String {
        self.text(register, 0)
    }

    fn text(&self, register: Register, depth: usize) -> String {
        let index = register.index();
        if index < self.first_input() {
            return Number::from(self.constants[index]).to_string();
        }
        if index < self.first_result() {
            return self.names[index - self.first_input()].clone();
        }
        if depth > 6 {
            return "…".to_owned();
        }
        let operand = |r: Register| self.text(r, depth + 1);
        let closed = |r: Register| {
            let text = operand(r);
            if text.contains([' ', '*', '/']) && !text.ends_with(')') || text.starts_with('(') {
                format!("({text})")
            } else {
                text
            }
        };
        match self.code[index - self.first_result()] {
            Instruction::Add(a, b) => format!("{} + {}", operand(a), operand(b)),
            Instruction::Subtract(a, b) => format!("{} - {}", operand(a), closed(b)),
            Instruction::Multiply(a, b) => format!("{}*{}", closed(a), closed(b)),
            Instruction::Divide(a, b) => format!("{}/{}", closed(a), closed(b)),
            Instruction::Negate(a) => format!("-{}", closed(a)),
            Instruction::MultiplyAdd(a, b, c) => format!("{}*{} + {}", closed(a), closed(b), operand(c)),
            Instruction::MultiplySubtract(a, b, c) => format!("{}*{} - {}", closed(a), closed(b), closed(c)),
            Instruction::NegateMultiplyAdd(a, b, c) => format!("{} - {}*{}", operand(c), closed(a), closed(b)),
            Instruction::NegateMultiplySubtract(a, b, c) => {
                format!("-{}*{} - {}", closed(a), closed(b), closed(c))
            }
            Instruction::Call(function, args) => {
                let args: Vec<String> = args[..function.arity()].iter().map(|&r| operand(r)).collect();
                format!("{}({})", function.name(), args.join(", "))
            }
        }
    }
}

/// Turns n-ary nodes into binary operations, each computed once.
struct Lowering<'a> {
    dag: &'a Dag,
    program: &'a mut Program,
    constants: FxHashMap<u64, Register>,
    known: FxHashMap<Instruction, u32>,
    registers: FxHashMap<NodeId, Register>,
    /// Results are numbered from here on once all constants are known.
    results: Vec<Instruction>,
}

/// While lowering, constants are numbered from 0, inputs from `INPUT`, results from `RESULT`.
const INPUT: u32 = 1 << 29;
const RESULT: u32 = 1 << 30;

impl<'a> Lowering<'a> {
    fn new(dag: &'a Dag, symbols: &[Option<NodeId>], program: &'a mut Program) -> Lowering<'a> {
        let mut registers = FxHashMap::default();
        for (i, symbol) in symbols.iter().enumerate() {
            if let Some(node) = symbol {
                registers.insert(*node, Register(INPUT + i as u32));
            }
        }
        Lowering {
            dag,
            program,
            constants: FxHashMap::default(),
            known: FxHashMap::default(),
            registers,
            results: Vec::new(),
        }
    }

    fn run(mut self, outputs: &[Atom]) -> Result<(), ExprError> {
        let cone = Cone::below(self.dag, outputs.iter().copied());
        for &id in &cone.order {
            if let Node::Symbol(index) = self.dag.node(id)
                && !self.registers.contains_key(&id)
            {
                return Err(ExprError::UnboundSymbol { symbol: self.dag.symbol_name(index).to_owned() });
            }
        }
        let mut registers = Vec::with_capacity(outputs.len());
        for &output in outputs {
            registers.push(match output {
                Atom::Constant(c) => self.constant(c),
                Atom::Node(id) => {
                    self.lower_below(id);
                    self.registers[&id]
                }
            });
        }
        let first_input = self.program.constants.len() as u32;
        let first_result = first_input + self.program.names.len() as u32;
        let place = |register: Register| match register.0 {
            r if r >= RESULT => Register(r - RESULT + first_result),
            r if r >= INPUT => Register(r - INPUT + first_input),
            _ => register,
        };
        self.program.outputs = registers.into_iter().map(place).collect();
        self.program.code = self.results.iter().map(|instruction| instruction.map(place)).collect();
        Ok(())
    }

    /// Lowers everything below a node in depth-first order, which keeps values close to their uses.
    fn lower_below(&mut self, root: NodeId) {
        let mut open = vec![(root, false)];
        while let Some((id, children_done)) = open.pop() {
            if self.registers.contains_key(&id) {
                continue;
            }
            if children_done {
                let register = self.lower(id);
                self.registers.insert(id, register);
            } else {
                open.push((id, true));
                let first = open.len();
                self.dag.for_each_child(id, |child| open.push((child, false)));
                open[first..].reverse();
            }
        }
    }

    fn lower(&mut self, id: NodeId) -> Register {
        let dag = self.dag;
        match dag.node(id) {
            Node::Constant(c) => self.constant(c),
            Node::Symbol(_) => unreachable!("every symbol of the cone is an input"),
            Node::Call { function, args } => {
                let mut registers = [Register(0); 3];
                for (register, arg) in registers.iter_mut().zip(Dag::args(function, &args)) {
                    *register = self.registers[arg];
                }
                for i in function.arity()..3 {
                    registers[i] = registers[0];
                }
                self.emit(Instruction::Call(function, registers))
            }
            Node::Product { factors } => self.lower_product(dag.factors(factors)),
            Node::Sum { constant, terms } => self.lower_sum(constant, dag.terms(terms)),
        }
    }

    fn lower_product(&mut self, factors: &[(NodeId, i32)]) -> Register {
        let mut numerator = None;
        let mut denominator = None;
        for &(node, e) in factors {
            let power = self.power(self.registers[&node], e.unsigned_abs());
            let side = if e > 0 { &mut numerator } else { &mut denominator };
            *side = Some(match *side {
                None => power,
                Some(product) => self.emit(Instruction::Multiply(product, power)),
            });
        }
        match (numerator, denominator) {
            (Some(product), None) => product,
            (numerator, Some(divisor)) => {
                let dividend = numerator.unwrap_or_else(|| self.constant(Number::ONE));
                self.emit(Instruction::Divide(dividend, divisor))
            }
            (None, None) => self.constant(Number::ONE),
        }
    }

    fn power(&mut self, base: Register, exponent: u32) -> Register {
        if exponent <= 1 {
            return base;
        }
        let root = self.power(base, exponent / 2);
        let square = self.emit(Instruction::Multiply(root, root));
        if exponent.is_multiple_of(2) { square } else { self.emit(Instruction::Multiply(square, base)) }
    }

    fn lower_sum(&mut self, constant: Number, terms: &[(NodeId, Number)]) -> Register {
        let mut sum = (!constant.is_zero()).then(|| self.constant(constant));
        // Positive terms first, so that a sum begins with a negation only if all its terms are negative.
        let (negative, positive): (Vec<_>, Vec<_>) = terms.iter().partition(|(_, q)| q.is_negative());
        for (node, q) in positive {
            let term = self.scaled(self.registers[&node], q);
            sum = Some(match sum {
                None => term,
                Some(sum) => self.emit(Instruction::Add(sum, term)),
            });
        }
        for (node, q) in negative {
            let register = self.registers[&node];
            sum = Some(match sum {
                None if (-q).is_one() => self.emit(Instruction::Negate(register)),
                None => self.scaled(register, q),
                Some(sum) => {
                    let term = self.scaled(register, -q);
                    self.emit(Instruction::Subtract(sum, term))
                }
            });
        }
        sum.unwrap_or_else(|| self.constant(Number::ZERO))
    }

    fn scaled(&mut self, register: Register, q: Number) -> Register {
        if q.is_one() {
            return register;
        }
        let coefficient = self.constant(q);
        self.emit(Instruction::Multiply(coefficient, register))
    }

    fn constant(&mut self, c: Number) -> Register {
        let value = c.to_f64();
        let constants = &mut self.program.constants;
        *self.constants.entry(value.to_bits()).or_insert_with(|| {
            constants.push(value);
            Register(constants.len() as u32 - 1)
        })
    }

    fn emit(&mut self, instruction: Instruction) -> Register {
        let ordered = |a: Register, b: Register| if a <= b { (a, b) } else { (b, a) };
        let instruction = match instruction {
            Instruction::Add(a, b) => {
                let (a, b) = ordered(a, b);
                Instruction::Add(a, b)
            }
            Instruction::Multiply(a, b) => {
                let (a, b) = ordered(a, b);
                Instruction::Multiply(a, b)
            }
            other => other,
        };
        let results = &mut self.results;
        let index = *self.known.entry(instruction).or_insert_with(|| {
            results.push(instruction);
            results.len() as u32 - 1
        });
        Register(RESULT + index)
    }
}
