//! From n-ary nodes to a tape of binary operations.

use rustc_hash::FxHashMap;

use crate::error::ExprError;
use crate::graph::dag::Dag;
use crate::graph::expr::Expr;
use crate::graph::function::Function;
use crate::graph::graph::Graph;
use crate::graph::node::{Atom, Node, NodeId};
use crate::graph::number::Number;
use crate::graph::subgraph::Cone;
use crate::program::angle_addition::{Compositions, SignedAngle, compositions};
use crate::program::program::{Inputs, Instruction, Program, Register};
use crate::program::sharing::{Factor, FactorId, SharedProduct, SharedProducts};

impl Program {
    /// The program of `outputs`.
    ///
    /// # Errors
    /// [`ExprError::UnboundSymbol`] if an output contains a symbol that is not among the inputs;
    /// [`ExprError::DivisionByZero`] if the graph met a division by an expression that is identically zero.
    pub fn new<'g>(
        graph: &'g Graph,
        inputs: &Inputs<'g>,
        outputs: &[Expr<'g>],
    ) -> Result<Program, ExprError> {
        graph.check(outputs)?;
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
        let known: Vec<Expr<'g>> =
            inputs.time.iter().chain(&inputs.state).chain(&inputs.parameters).copied().collect();
        let outputs = graph.written_in(&graph.with_stand_ins(outputs), &known);
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
        graph.charge(program.code.len() * size_of::<Instruction>());
        graph.check_budget()?;
        Ok(program)
    }
}

/// Turns n-ary nodes into binary operations, each computed once.
struct Lowering<'a> {
    dag: &'a Dag,
    program: &'a mut Program,
    constants: FxHashMap<u64, Register>,
    known: FxHashMap<Instruction, u32>,
    registers: FxHashMap<NodeId, Register>,
    products: SharedProducts,
    compositions: Compositions,
    factors: FxHashMap<FactorId, Register>,
    /// The results so far; they are renumbered once all constants are known.
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
            products: SharedProducts::default(),
            compositions: Compositions::default(),
            factors: FxHashMap::default(),
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
        self.products = SharedProducts::of(self.dag, &cone, outputs);
        self.compositions = compositions(self.dag, &cone);
        let mut registers = Vec::with_capacity(outputs.len());
        for &output in outputs {
            if self.dag.has_spent() {
                break;
            }
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
                match self.composition(id) {
                    Some((_, angles)) => open.extend(angles.map(|(angle, _)| (angle, false))),
                    None => self.dag.for_each_child(id, |child| open.push((child, false))),
                }
                open[first..].reverse();
            }
        }
    }

    fn lower(&mut self, id: NodeId) -> Register {
        let dag = self.dag;
        if let Some((function, angles)) = self.composition(id) {
            return self.lower_composition(function, angles);
        }
        match dag.node(id) {
            Node::Constant(c) => self.constant(c),
            Node::Applied { .. } => unreachable!("stand-ins take the place of undetermined functions"),
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
            Node::Product { .. } => self.lower_product(id),
            Node::Sum { constant, terms } => self.lower_sum(constant, dag.terms(terms)),
        }
    }

    /// The sine or cosine of a sum of two angles, if it is composed from those of the angles.
    fn composition(&self, id: NodeId) -> Option<(Function, [SignedAngle; 2])> {
        match self.dag.node(id) {
            Node::Call { function, args } if matches!(function, Function::Sin | Function::Cos) => {
                self.compositions.get(&args[0]).map(|angles| (function, *angles))
            }
            _ => None,
        }
    }

    fn lower_composition(
        &mut self,
        function: Function,
        [(a, minus_a), (b, minus_b)]: [SignedAngle; 2],
    ) -> Register {
        let [a, b] = [a, b].map(|angle| {
            let angle = [self.registers[&angle]; 3];
            [Function::Sin, Function::Cos].map(|call| self.emit(Instruction::Call(call, angle)))
        });
        let mut multiply = |x, y| self.emit(Instruction::Multiply(x, y));
        if function == Function::Cos {
            let (cosines, sines) = (multiply(a[1], b[1]), multiply(a[0], b[0]));
            return self.emit(match minus_a == minus_b {
                true => Instruction::Subtract(cosines, sines),
                false => Instruction::Add(cosines, sines),
            });
        }
        let (first, second) = (multiply(a[0], b[1]), multiply(a[1], b[0]));
        match (minus_a, minus_b) {
            (false, false) => self.emit(Instruction::Add(first, second)),
            (false, true) => self.emit(Instruction::Subtract(first, second)),
            (true, false) => self.emit(Instruction::Subtract(second, first)),
            (true, true) => {
                let sum = self.emit(Instruction::Add(first, second));
                self.emit(Instruction::Negate(sum))
            }
        }
    }

    fn lower_product(&mut self, id: NodeId) -> Register {
        let SharedProduct { factors, divisors, .. } = self.products.product(id).clone();
        let numerator = self.multiply(&factors);
        match (numerator, self.multiply(&divisors)) {
            (Some(product), None) => product,
            (numerator, Some(divisor)) => {
                let dividend = numerator.unwrap_or_else(|| self.constant(Number::ONE));
                self.emit(Instruction::Divide(dividend, divisor))
            }
            (None, None) => self.constant(Number::ONE),
        }
    }

    fn multiply(&mut self, factors: &[FactorId]) -> Option<Register> {
        let mut product = None;
        for &factor in factors {
            let register = self.factor(factor);
            product = Some(match product {
                None => register,
                Some(product) => self.emit(Instruction::Multiply(product, register)),
            });
        }
        product
    }

    fn factor(&mut self, id: FactorId) -> Register {
        if let Some(&register) = self.factors.get(&id) {
            return register;
        }
        let register = match self.products.factor(id) {
            Factor::Power(node, exponent) => self.power(self.registers[&node], exponent),
            Factor::Reciprocal(node, exponent) => {
                let one = self.constant(Number::ONE);
                let reciprocal = self.emit(Instruction::Divide(one, self.registers[&node]));
                self.power(reciprocal, exponent)
            }
            Factor::Constant(bits) => self.number(f64::from_bits(bits)),
            Factor::Pair(first, second) => {
                let (first, second) = (self.factor(first), self.factor(second));
                self.emit(Instruction::Multiply(first, second))
            }
        };
        self.factors.insert(id, register);
        register
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
        // Positive terms first: a sum then begins with a negation only if all its terms are negative.
        let (negative, positive): (Vec<_>, Vec<_>) = terms.iter().partition(|(_, q)| q.is_negative());
        for (node, q) in positive {
            let term = self.scaled(node, q);
            sum = Some(match sum {
                None => term,
                Some(sum) => self.emit(Instruction::Add(sum, term)),
            });
        }
        for (node, q) in negative {
            sum = Some(match sum {
                None if (-q).is_one() || self.products.is_scaled(node) => {
                    self.emit(Instruction::Negate(self.registers[&node]))
                }
                None => self.scaled(node, q),
                Some(sum) => {
                    let term = self.scaled(node, -q);
                    self.emit(Instruction::Subtract(sum, term))
                }
            });
        }
        sum.unwrap_or_else(|| self.constant(Number::ZERO))
    }

    /// q·node; if the node already contains the magnitude of q, q only gives the sign.
    fn scaled(&mut self, node: NodeId, q: Number) -> Register {
        let register = self.registers[&node];
        if q.is_one() || self.products.is_scaled(node) {
            return register;
        }
        let coefficient = self.constant(q);
        self.emit(Instruction::Multiply(coefficient, register))
    }

    fn constant(&mut self, c: Number) -> Register {
        self.number(c.to_f64())
    }

    fn number(&mut self, value: f64) -> Register {
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
