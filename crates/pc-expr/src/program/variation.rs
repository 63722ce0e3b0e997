//! The program of a motion with its equations of variation.

use crate::graph::function::Function;
use crate::program::program::{Instruction, Program, Register};
use crate::taylor::assembler::Assembler;

impl Program {
    /// The program of a motion with its derivatives, made from that of f, whose first outputs are ẏ, one for each component
    /// of the state:
    /// ```text
    /// ẏ = f(t, y, p),   ṡ_k = (∂f/∂y) s_k + ∂f/∂p_j
    /// ```
    /// with a column s_k for each of `columns`: a derivative with respect to the parameter of that number, or to a
    /// start value if there is none. The state is (y, s_1, s_2, …), and the first outputs are its rates in the same
    /// order; after them come the other outputs of f.
    ///
    /// ```
    /// # use pc_expr::{Backend, Evaluator, Graph, Inputs, Program};
    /// // ẏ = −a y²: ṡ = −2 a y s − y² by a, and −2 a y s by the start.
    /// let graph = Graph::new();
    /// let [y, a] = graph.symbols(["y", "a"]);
    /// let inputs = Inputs { time: None, state: vec![y], parameters: vec![a] };
    /// let program = Program::new(&graph, &inputs, &[-a * y * y])?;
    /// let mut varied = Evaluator::new(program.with_variation(&[Some(0), None]), Backend::Interpreter);
    /// let mut rates = [f64::NAN; 3];
    /// varied.eval(0.0, &[3.0, 0.5, 1.0], &[2.0], &mut rates);
    /// assert_eq!(rates, [-18.0, -15.0, -12.0]);
    /// # Ok::<(), pc_expr::ExprError>(())
    /// ```
    ///
    /// # Panics
    /// If there are fewer outputs than components, or a column belongs to no parameter.
    pub fn with_variation(&self, columns: &[Option<usize>]) -> Program {
        let (dim, parameters) = (self.state, self.parameters);
        assert!(self.outputs.len() >= dim, "a rate for each component");
        assert!(columns.iter().flatten().all(|&column| column < parameters), "a parameter for each column");
        let mut writer = Assembler::default();
        let mut values: Vec<Register> = self.constants.iter().map(|&value| writer.number(value)).collect();
        let first = values.len();
        values.push(Assembler::time());
        values.extend((0..dim).map(Assembler::state));
        values.extend((0..parameters).map(Assembler::parameter));
        for &instruction in &self.code {
            values.push(writer.emit(instruction.map(|register| values[register.index()])));
        }
        let of_f = |output: &Register| values[output.index()];
        let mut outputs: Vec<Register> = self.outputs[..dim].iter().map(of_f).collect();
        for (k, column) in columns.iter().enumerate() {
            let mut tangent = Tangent { writer: &mut writer, values: &values, slopes: vec![None; first + 1] };
            tangent.slopes.extend((0..dim).map(|i| Some(Assembler::state((k + 1) * dim + i))));
            let one = tangent.writer.number(1.0);
            tangent.slopes.extend((0..parameters).map(|j| (Some(j) == *column).then_some(one)));
            for (i, &instruction) in self.code.iter().enumerate() {
                let result = values[first + 1 + dim + parameters + i];
                let slope = tangent.of(instruction, result);
                tangent.slopes.push(slope);
            }
            let zero = tangent.writer.number(0.0);
            let slope = |output: &Register| tangent.slopes[output.index()].unwrap_or(zero);
            outputs.extend(self.outputs[..dim].iter().map(slope));
        }
        outputs.extend(self.outputs[dim..].iter().map(of_f));
        writer.finish((dim * (1 + columns.len()), 0, parameters), outputs)
    }
}

/// The derivatives of registers along one direction.
struct Tangent<'a> {
    writer: &'a mut Assembler,
    /// The registers that hold the values.
    values: &'a [Register],
    /// The derivatives so far; `None` for a derivative that is 0.
    slopes: Vec<Option<Register>>,
}

impl Tangent<'_> {
    fn slope(&self, register: Register) -> Option<Register> {
        self.slopes[register.index()]
    }

    fn value(&self, register: Register) -> Register {
        self.values[register.index()]
    }

    fn sum(&mut self, a: Option<Register>, b: Option<Register>) -> Option<Register> {
        match (a, b) {
            (Some(a), Some(b)) => Some(self.writer.add(a, b)),
            (a, b) => a.or(b),
        }
    }

    fn negative(&mut self, a: Option<Register>) -> Option<Register> {
        a.map(|a| self.writer.negate(a))
    }

    /// (a b)′ = a b′ + b a′
    fn product(&mut self, a: Register, b: Register) -> Option<Register> {
        let (of_a, of_b) = (self.slope(a), self.slope(b));
        let (a, b) = (self.value(a), self.value(b));
        let first = of_b.map(|slope| self.writer.multiply(a, slope));
        let second = of_a.map(|slope| self.writer.multiply(b, slope));
        self.sum(first, second)
    }

    /// The derivative of an instruction with this result.
    fn of(&mut self, instruction: Instruction, result: Register) -> Option<Register> {
        match instruction {
            Instruction::Add(a, b) => self.sum(self.slope(a), self.slope(b)),
            Instruction::Subtract(a, b) => {
                let second = self.negative(self.slope(b));
                self.sum(self.slope(a), second)
            }
            Instruction::Negate(a) => self.negative(self.slope(a)),
            Instruction::Multiply(a, b) => self.product(a, b),
            Instruction::Divide(a, b) => {
                // (a/b)′ = (a′ − (a/b) b′)/b
                let change = self.slope(b).map(|slope| self.writer.multiply(result, slope));
                let change = self.negative(change);
                let top = self.sum(self.slope(a), change)?;
                let divisor = self.value(b);
                Some(self.writer.divide(top, divisor))
            }
            Instruction::MultiplyAdd(a, b, c) => {
                let product = self.product(a, b);
                self.sum(product, self.slope(c))
            }
            Instruction::MultiplySubtract(a, b, c) => {
                let product = self.product(a, b);
                let rest = self.negative(self.slope(c));
                self.sum(product, rest)
            }
            Instruction::NegateMultiplyAdd(a, b, c) => {
                let product = self.product(a, b);
                let product = self.negative(product);
                self.sum(product, self.slope(c))
            }
            Instruction::NegateMultiplySubtract(a, b, c) => {
                let product = self.product(a, b);
                let sum = self.sum(product, self.slope(c));
                self.negative(sum)
            }
            Instruction::Call(function, arguments) => self.of_call(function, arguments, result),
        }
    }

    fn of_call(
        &mut self,
        function: Function,
        [a, b, c]: [Register; 3],
        result: Register,
    ) -> Option<Register> {
        let (u, v) = (self.value(a), self.value(b));
        let du = self.slope(a);
        let w = &mut *self.writer;
        let factor = match function {
            Function::Sign => return None,
            Function::Min | Function::Max | Function::Step => return self.of_choice(function, [a, b, c]),
            Function::Atan2 => {
                // (x y′ − y x′)/(x² + y²) with y first
                let dv = self.slope(b);
                let w = &mut *self.writer;
                let first = du.map(|slope| w.multiply(v, slope));
                let second = dv.map(|slope| w.multiply(u, slope));
                let second = self.negative(second);
                let top = self.sum(first, second)?;
                let w = &mut *self.writer;
                let square = w.multiply(u, u);
                let square = w.multiply_add(v, v, square);
                return Some(w.divide(top, square));
            }
            Function::Pow => {
                // (uᵛ)′ = v u^(v−1) u′ + uᵛ ln(u) v′
                let of_base = du.map(|slope| {
                    let one = w.number(1.0);
                    let less = w.subtract(v, one);
                    let power = w.call(Function::Pow, &[u, less]);
                    let factor = w.multiply(v, power);
                    w.multiply(factor, slope)
                });
                let of_exponent = self.slope(b).map(|slope| {
                    let w = &mut *self.writer;
                    let logarithm = w.call(Function::Log, &[u]);
                    let factor = w.multiply(result, logarithm);
                    w.multiply(factor, slope)
                });
                return self.sum(of_base, of_exponent);
            }
            _ if du.is_none() => return None,
            Function::Sin => w.call(Function::Cos, &[u]),
            Function::Cos => {
                let sine = w.call(Function::Sin, &[u]);
                w.negate(sine)
            }
            Function::Sinh => w.call(Function::Cosh, &[u]),
            Function::Cosh => w.call(Function::Sinh, &[u]),
            Function::Exp => result,
            Function::Abs => w.call(Function::Sign, &[u]),
            Function::Tanh => {
                let (one, square) = (w.number(1.0), w.multiply(result, result));
                w.subtract(one, square)
            }
            Function::Log => {
                let one = w.number(1.0);
                w.divide(one, u)
            }
            Function::Sqrt => {
                let half = w.number(0.5);
                w.divide(half, result)
            }
            Function::Atan => {
                let one = w.number(1.0);
                let square = w.multiply_add(u, u, one);
                w.divide(one, square)
            }
            Function::Asin | Function::Acos => {
                let (one, square) = (w.number(1.0), w.multiply(u, u));
                let rest = w.subtract(one, square);
                let root = w.call(Function::Sqrt, &[rest]);
                let top = if function == Function::Asin { one } else { w.number(-1.0) };
                w.divide(top, root)
            }
        };
        du.map(|slope| self.writer.multiply(factor, slope))
    }

    /// The derivative of the chosen argument.
    fn of_choice(&mut self, function: Function, [a, b, c]: [Register; 3]) -> Option<Register> {
        let (first, second) = match function {
            Function::Step => (self.slope(b), self.slope(c)),
            _ => (self.slope(a), self.slope(b)),
        };
        if first.is_none() && second.is_none() {
            return None;
        }
        let (u, v) = (self.value(a), self.value(b));
        let condition = match function {
            Function::Step => u,
            Function::Min => self.writer.subtract(v, u),
            _ => self.writer.subtract(u, v),
        };
        let zero = self.writer.number(0.0);
        let [first, second] = [first, second].map(|slope| slope.unwrap_or(zero));
        Some(self.writer.call(Function::Step, &[condition, first, second]))
    }
}
