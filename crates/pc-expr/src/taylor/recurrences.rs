//! The recurrences of all operations [Jorba, Zou 2005, prop. 2.1; Griewank, Walther 2008, tables 13.1 and 13.2].
//!
//! With S(u, v) = Σ_{j=1}^{k−1} u_j v_{k−j}, which needs lower orders only, and D u the series of j u_j:
//! ```text
//! w = u v          w_k = u₀ v_k + u_k v₀ + S(u, v)
//! w = u/v          w_k = (u_k − w₀ v_k − S(v, w))/v₀
//! w = √u           w_k = (u_k − S(w, w))/(2 w₀)
//! w = exp u        w_k = w₀ u_k + S(Du, w)/k
//! w = ln u         w_k = (u_k − S(Dw, u)/k)/u₀
//! w = uᶜ           w_k = (c w₀ u_k + (c S(Du, w) − S(Dw, u))/k)/u₀
//! s, c = sin, cos  s_k = c₀ u_k + S(Du, c)/k,   c_k = −s₀ u_k − S(Du, s)/k
//! w = tanh u       w_k = (1 − w₀²) u_k − S(Du, w²)/k
//! w = ∫ du/v       w_k = (u_k − S(Dw, v)/k)/v₀      arctan: v = 1 + u²;  arcsin: v = √(1 − u²)
//! w = arg(x + iy)  w_k = (x₀ y_k − y₀ x_k + (S(Dy, x) − S(Dx, y) − S(Dw, r²))/k)/r₀²
//! ```
//! All sums of one order are known before its coefficients are: they are computed together. What has corners or jumps is taken
//! on the branch that holds, which a factor σ says: |u| = σ u.

use std::sync::Arc;

use rustc_hash::FxHashMap;

use super::assembler::Assembler;
use super::sums::LANES;
use crate::graph::function::Function;
use crate::program::program::{Instruction, Program, Register};

/// f and its recurrences.
#[derive(Debug)]
pub(super) struct Recurrences {
    /// Of (t, (y, σ), parameters): what is watched, the factors, the functions whose signs are σ, ẏ.
    pub(super) zeroth: Arc<Program>,
    /// The coefficients of order k of (1/k, (those of order k − 1 of ẏ, k, that of t, what the number 1/k lacks, the sums), factors): the first and the
    /// second factors of all sums, y, the functions whose signs are σ, ẏ.
    pub(super) next: Arc<Program>,
    pub(super) dim: usize,
    pub(super) watched: usize,
    pub(super) factors: usize,
    /// The sums, up to a whole number of vectors.
    pub(super) sums: usize,
    /// What has a sign that matters, in words.
    pub(super) branches: Vec<String>,
}

/// Numbers that a row has between the rates and the sums.
pub(super) const EXTRA: usize = 3;

/// A value as computed for order 0 and for an order above; none there if it does not change with time.
#[derive(Clone, Copy)]
struct Term {
    zero: Register,
    next: Option<Register>,
}

/// What has been written so far.
struct Writer {
    zero: Assembler,
    next: Assembler,
    dim: usize,
    factors: Vec<Register>,
    places: FxHashMap<Register, usize>,
    /// Both factors of each sum.
    sums: Vec<[Option<Register>; 2]>,
    products: FxHashMap<[Register; 2], usize>,
    /// (sin, cos) and (sinh, cosh) of what is known of an argument.
    circles: FxHashMap<(Function, Register), [Term; 2]>,
    branches: Vec<Term>,
    branch_of: FxHashMap<Register, usize>,
    names: Vec<String>,
}

impl Recurrences {
    /// Those of the solutions of a program whose first `dim` outputs are ẏ; others are watched at order 0.
    pub(super) fn new(program: &Program, dim: usize) -> Recurrences {
        let mut w = Writer {
            zero: Assembler::default(),
            next: Assembler::default(),
            dim,
            factors: Vec::new(),
            places: FxHashMap::default(),
            sums: Vec::new(),
            products: FxHashMap::default(),
            circles: FxHashMap::default(),
            branches: Vec::new(),
            branch_of: FxHashMap::default(),
            names: Vec::new(),
        };
        let mut terms = Vec::with_capacity(program.registers_len());
        for &value in program.constants() {
            terms.push(Term { zero: w.zero.number(value), next: None });
        }
        terms.push(Term { zero: Assembler::time(), next: Some(Assembler::state(dim + 1)) });
        for i in 0..dim {
            let rate = w.over_order(Assembler::state(i));
            terms.push(Term { zero: Assembler::state(i), next: Some(rate) });
        }
        let states: Vec<Register> = terms[terms.len() - dim..].iter().filter_map(|term| term.next).collect();
        for i in 0..program.parameters_len() {
            terms.push(Term { zero: Assembler::parameter(i), next: None });
        }
        for (i, &instruction) in program.code().iter().enumerate() {
            let name = || program.describe(Register((program.first_result() + i) as u32));
            let term = w.instruction(instruction, &terms, name);
            terms.push(term);
        }
        w.finish(program, &terms, &states)
    }
}

impl Writer {
    fn instruction(&mut self, instruction: Instruction, terms: &[Term], name: impl Fn() -> String) -> Term {
        let of = |r: Register| terms[r.index()];
        match instruction {
            Instruction::Add(a, b) => self.add(of(a), of(b)),
            Instruction::Subtract(a, b) => self.subtract(of(a), of(b)),
            Instruction::Multiply(a, b) => self.multiply(of(a), of(b)),
            Instruction::Divide(a, b) => self.divide(of(a), of(b)),
            Instruction::Negate(a) => self.negate(of(a)),
            Instruction::MultiplyAdd(a, b, c) => {
                let product = self.multiply(of(a), of(b));
                self.add(product, of(c))
            }
            Instruction::MultiplySubtract(a, b, c) => {
                let product = self.multiply(of(a), of(b));
                self.subtract(product, of(c))
            }
            Instruction::NegateMultiplyAdd(a, b, c) => {
                let product = self.multiply(of(a), of(b));
                self.subtract(of(c), product)
            }
            Instruction::NegateMultiplySubtract(a, b, c) => {
                let product = self.multiply(of(a), of(b));
                let sum = self.add(product, of(c));
                self.negate(sum)
            }
            Instruction::Call(function, args) => self.call(function, args.map(of), name),
        }
    }

    /// A value of order 0 as a factor of later orders.
    fn factor(&mut self, zero: Register) -> Register {
        if let Some(value) = self.zero.value(zero) {
            return self.next.number(value);
        }
        let factors = &mut self.factors;
        Assembler::parameter(*self.places.entry(zero).or_insert_with(|| {
            factors.push(zero);
            factors.len() - 1
        }))
    }

    /// 1/u₀
    fn reciprocal(&mut self, zero: Register) -> Register {
        let one = self.zero.number(1.0);
        let inverse = self.zero.divide(one, zero);
        self.factor(inverse)
    }

    /// S(u, v)
    fn sum(&mut self, u: Register, v: Register) -> Register {
        let key = if u <= v { [u, v] } else { [v, u] };
        let sums = &mut self.sums;
        Assembler::sum(*self.products.entry(key).or_insert_with(|| {
            sums.push([Some(u), Some(v)]);
            sums.len() - 1
        }))
    }

    /// S(u, w) of what is computed with it.
    fn open_sum(&mut self, u: Option<Register>) -> usize {
        self.sums.push([u, None]);
        self.sums.len() - 1
    }

    fn close_sum(&mut self, sum: usize, w: Register) {
        for place in &mut self.sums[sum] {
            place.get_or_insert(w);
        }
    }

    /// D u
    fn rising(&mut self, u: Register) -> Register {
        let order = Assembler::state(self.dim);
        self.next.multiply(order, u)
    }

    /// x/k, by what is nearest to 1/k and what that lacks: the rounding of 1/k alone, the same in every step, would add up.
    fn over_order(&mut self, x: Register) -> Register {
        let lacking = self.next.multiply(x, Assembler::state(self.dim + 2));
        self.next.multiply_add(x, Assembler::time(), lacking)
    }

    fn add(&mut self, a: Term, b: Term) -> Term {
        let zero = self.zero.add(a.zero, b.zero);
        let next = match (a.next, b.next) {
            (Some(a), Some(b)) => Some(self.next.add(a, b)),
            (one, None) | (None, one) => one,
        };
        Term { zero, next }
    }

    fn subtract(&mut self, a: Term, b: Term) -> Term {
        let zero = self.zero.subtract(a.zero, b.zero);
        let next = match (a.next, b.next) {
            (Some(a), Some(b)) => Some(self.next.subtract(a, b)),
            (a, None) => a,
            (None, Some(b)) => Some(self.next.negate(b)),
        };
        Term { zero, next }
    }

    fn negate(&mut self, a: Term) -> Term {
        Term { zero: self.zero.negate(a.zero), next: a.next.map(|a| self.next.negate(a)) }
    }

    fn multiply(&mut self, a: Term, b: Term) -> Term {
        let zero = self.zero.multiply(a.zero, b.zero);
        let next = match (a.next, b.next) {
            (None, None) => None,
            (None, Some(next)) => {
                let factor = self.factor(a.zero);
                Some(self.next.multiply(factor, next))
            }
            (Some(next), None) => {
                let factor = self.factor(b.zero);
                Some(self.next.multiply(factor, next))
            }
            (Some(u), Some(_)) if a.zero == b.zero => {
                let sum = self.sum(u, u);
                let two = self.zero.number(2.0);
                let double = self.zero.multiply(two, a.zero);
                let factor = self.factor(double);
                Some(self.next.multiply_add(factor, u, sum))
            }
            (Some(u), Some(v)) => {
                let sum = self.sum(u, v);
                let [u0, v0] = [self.factor(a.zero), self.factor(b.zero)];
                // What is known last is added last.
                let (first, last) = match self.next.depth(u) <= self.next.depth(v) {
                    true => ((v0, u), (u0, v)),
                    false => ((u0, v), (v0, u)),
                };
                let sum = self.next.multiply_add(first.0, first.1, sum);
                Some(self.next.multiply_add(last.0, last.1, sum))
            }
        };
        Term { zero, next }
    }

    fn divide(&mut self, a: Term, b: Term) -> Term {
        let zero = self.zero.divide(a.zero, b.zero);
        let Some(v) = b.next else {
            let next = a.next.map(|u| {
                let inverse = self.reciprocal(b.zero);
                self.next.multiply(u, inverse)
            });
            return Term { zero, next };
        };
        let sum = self.open_sum(Some(v));
        let none = self.next.number(0.0);
        let rest = self.next.subtract(a.next.unwrap_or(none), Assembler::sum(sum));
        let w0 = self.factor(zero);
        let product = self.next.multiply(w0, v);
        let rest = self.next.subtract(rest, product);
        let inverse = self.reciprocal(b.zero);
        let next = self.next.multiply(rest, inverse);
        self.close_sum(sum, next);
        Term { zero, next: Some(next) }
    }

    /// w with ẇ = u̇/v, from its value.
    fn integral(&mut self, zero: Register, u: Register, v: Term) -> Term {
        let inverse = self.reciprocal(v.zero);
        let Some(series) = v.next else {
            return Term { zero, next: Some(self.next.multiply(u, inverse)) };
        };
        let sum = self.open_sum(Some(series));
        let part = self.over_order(Assembler::sum(sum));
        let rest = self.next.subtract(u, part);
        let next = self.next.multiply(rest, inverse);
        let rising = self.rising(next);
        self.close_sum(sum, rising);
        Term { zero, next: Some(next) }
    }

    fn sqrt(&mut self, a: Term) -> Term {
        let zero = self.zero.call(Function::Sqrt, &[a.zero]);
        let next = a.next.map(|u| {
            let sum = self.open_sum(None);
            let half = self.zero.number(0.5);
            let inverse = self.zero.divide(half, zero);
            let inverse = self.factor(inverse);
            let rest = self.next.subtract(u, Assembler::sum(sum));
            let next = self.next.multiply(rest, inverse);
            self.close_sum(sum, next);
            next
        });
        Term { zero, next }
    }

    /// w with ẇ = w u̇, from its value.
    fn exponential(&mut self, zero: Register, u: Register) -> Term {
        let rising = self.rising(u);
        let sum = self.open_sum(Some(rising));
        let part = self.over_order(Assembler::sum(sum));
        let w0 = self.factor(zero);
        let next = self.next.multiply_add(w0, u, part);
        self.close_sum(sum, next);
        Term { zero, next: Some(next) }
    }

    /// The first of the pair (sin, cos) or (sinh, cosh), and the second, of an argument that changes.
    fn circle(&mut self, functions: [Function; 2], a: Term, u: Register) -> [Term; 2] {
        if let Some(&pair) = self.circles.get(&(functions[0], a.zero)) {
            return pair;
        }
        let [sine, cosine] = functions.map(|function| self.zero.call(function, &[a.zero]));
        let rising = self.rising(u);
        let sums = [(); 2].map(|()| self.open_sum(Some(rising)));
        let [of_cosine, of_sine] = sums.map(|sum| self.over_order(Assembler::sum(sum)));
        let [s0, c0] = [sine, cosine].map(|zero| self.factor(zero));
        let s = self.next.multiply_add(c0, u, of_cosine);
        let c = self.next.multiply_add(s0, u, of_sine);
        let c = if functions[0] == Function::Sin { self.next.negate(c) } else { c };
        self.close_sum(sums[0], c);
        self.close_sum(sums[1], s);
        let pair = [Term { zero: sine, next: Some(s) }, Term { zero: cosine, next: Some(c) }];
        self.circles.insert((functions[0], a.zero), pair);
        pair
    }

    fn tanh(&mut self, a: Term, u: Register) -> Term {
        let zero = self.zero.call(Function::Tanh, &[a.zero]);
        let rising = self.rising(u);
        let sum = self.open_sum(Some(rising));
        let part = self.over_order(Assembler::sum(sum));
        // 1 − tanh² without cancellation.
        let (one, cosh) = (self.zero.number(1.0), self.zero.call(Function::Cosh, &[a.zero]));
        let square = self.zero.multiply(cosh, cosh);
        let slope = self.zero.divide(one, square);
        let slope = self.factor(slope);
        let product = self.next.multiply(slope, u);
        let next = self.next.subtract(product, part);
        let w = Term { zero, next: Some(next) };
        let square = self.multiply(w, w);
        if let Some(square) = square.next {
            self.close_sum(sum, square);
        }
        w
    }

    fn pow(&mut self, a: Term, b: Term) -> Term {
        let zero = self.zero.call(Function::Pow, &[a.zero, b.zero]);
        match (a.next, b.next) {
            (None, None) => Term { zero, next: None },
            (Some(u), None) => {
                let rising = self.rising(u);
                let sums = [self.open_sum(Some(rising)), self.open_sum(Some(u))];
                let exponent = self.factor(b.zero);
                let first = self.next.multiply(exponent, Assembler::sum(sums[0]));
                let parts = self.next.subtract(first, Assembler::sum(sums[1]));
                let parts = self.over_order(parts);
                let slope = self.zero.multiply(b.zero, zero);
                let slope = self.factor(slope);
                let whole = self.next.multiply_add(slope, u, parts);
                let inverse = self.reciprocal(a.zero);
                let next = self.next.multiply(whole, inverse);
                self.close_sum(sums[0], next);
                let rising = self.rising(next);
                self.close_sum(sums[1], rising);
                Term { zero, next: Some(next) }
            }
            (_, Some(_)) => {
                let log = self.log(a);
                let product = self.multiply(b, log);
                match product.next {
                    Some(u) => self.exponential(zero, u),
                    None => Term { zero, next: None },
                }
            }
        }
    }

    fn log(&mut self, a: Term) -> Term {
        let zero = self.zero.call(Function::Log, &[a.zero]);
        match a.next {
            Some(u) => self.integral(zero, u, a),
            None => Term { zero, next: None },
        }
    }

    /// √(1 − u²)
    fn complement(&mut self, a: Term) -> Term {
        let one = Term { zero: self.zero.number(1.0), next: None };
        let (above, below) = (self.add(one, a), self.subtract(one, a));
        let square = self.multiply(above, below);
        self.sqrt(square)
    }

    fn atan2(&mut self, y: Term, x: Term) -> Term {
        let zero = self.zero.call(Function::Atan2, &[y.zero, x.zero]);
        let (squares, parts) = ([self.multiply(x, x), self.multiply(y, y)], [(y, x), (x, y)]);
        let square = self.add(squares[0], squares[1]);
        let Some(of_square) = square.next else { return Term { zero, next: None } };
        let none = self.next.number(0.0);
        // x₀ y_k + S(Dy, x)/k, and the same with x and y exchanged.
        let [first, second] = parts.map(|(u, v)| {
            let Some(next) = u.next else { return none };
            let factor = self.factor(v.zero);
            let sum = match v.next {
                Some(series) => {
                    let rising = self.rising(next);
                    let sum = self.sum(rising, series);
                    self.over_order(sum)
                }
                None => none,
            };
            self.next.multiply_add(factor, next, sum)
        });
        let sum = self.open_sum(Some(of_square));
        let part = self.over_order(Assembler::sum(sum));
        let rest = self.next.subtract(first, second);
        let rest = self.next.subtract(rest, part);
        let inverse = self.reciprocal(square.zero);
        let next = self.next.multiply(rest, inverse);
        let rising = self.rising(next);
        self.close_sum(sum, rising);
        Term { zero, next: Some(next) }
    }

    /// The sign of what changes.
    fn side(&mut self, of: Term, name: impl Fn() -> String) -> Register {
        let (branches, names) = (&mut self.branches, &mut self.names);
        Assembler::sum(*self.branch_of.entry(of.zero).or_insert_with(|| {
            branches.push(of);
            names.push(name());
            branches.len() - 1
        }))
    }

    /// a where the sign of `of` is not negative, else b.
    fn choose(&mut self, of: Term, a: Term, b: Term, name: impl Fn() -> String) -> Term {
        let side = self.side(of, name);
        let zero = self.zero.call(Function::Step, &[side, a.zero, b.zero]);
        if a.next.is_none() && b.next.is_none() {
            return Term { zero, next: None };
        }
        let none = self.next.number(0.0);
        let side = self.factor(side);
        let args = [side, a.next.unwrap_or(none), b.next.unwrap_or(none)];
        Term { zero, next: Some(self.next.call(Function::Step, &args)) }
    }

    fn call(&mut self, function: Function, [a, b, c]: [Term; 3], name: impl Fn() -> String) -> Term {
        let args = [a, b, c].map(|term| term.zero);
        let fixed = [a, b, c][..function.arity()].iter().all(|term| term.next.is_none());
        let Some(u) = a.next.filter(|_| !fixed) else {
            return match function {
                Function::Pow if !fixed => self.pow(a, b),
                Function::Atan2 if !fixed => self.atan2(a, b),
                Function::Min | Function::Max if !fixed => self.lesser(function, a, b, name),
                Function::Step if !fixed => {
                    // The condition does not change.
                    let zero = self.zero.call(function, &args);
                    let none = self.next.number(0.0);
                    let condition = self.factor(a.zero);
                    let branches = [condition, b.next.unwrap_or(none), c.next.unwrap_or(none)];
                    Term { zero, next: Some(self.next.call(function, &branches)) }
                }
                _ => Term { zero: self.zero.call(function, &args), next: None },
            };
        };
        match function {
            Function::Sin => self.circle([Function::Sin, Function::Cos], a, u)[0],
            Function::Cos => self.circle([Function::Sin, Function::Cos], a, u)[1],
            Function::Sinh => self.circle([Function::Sinh, Function::Cosh], a, u)[0],
            Function::Cosh => self.circle([Function::Sinh, Function::Cosh], a, u)[1],
            Function::Tanh => self.tanh(a, u),
            Function::Exp => {
                let zero = self.zero.call(Function::Exp, &args);
                self.exponential(zero, u)
            }
            Function::Log => self.log(a),
            Function::Sqrt => self.sqrt(a),
            Function::Atan => {
                let zero = self.zero.call(Function::Atan, &args);
                let one = Term { zero: self.zero.number(1.0), next: None };
                let square = self.multiply(a, a);
                let derivative = self.add(one, square);
                self.integral(zero, u, derivative)
            }
            Function::Asin => {
                let zero = self.zero.call(Function::Asin, &args);
                let derivative = self.complement(a);
                self.integral(zero, u, derivative)
            }
            Function::Acos => {
                let zero = self.zero.call(Function::Acos, &args);
                let derivative = self.complement(a);
                let minus = self.next.negate(u);
                self.integral(zero, minus, derivative)
            }
            Function::Atan2 => self.atan2(a, b),
            Function::Pow => self.pow(a, b),
            Function::Abs => {
                let side = self.side(a, name);
                self.multiply(Term { zero: side, next: None }, a)
            }
            Function::Sign => Term { zero: self.side(a, name), next: None },
            Function::Min | Function::Max => self.lesser(function, a, b, name),
            Function::Step => self.choose(a, b, c, name),
        }
    }

    /// The lesser or the greater of a and b.
    fn lesser(&mut self, function: Function, a: Term, b: Term, name: impl Fn() -> String) -> Term {
        let of = if function == Function::Min { self.subtract(b, a) } else { self.subtract(a, b) };
        match of.next {
            Some(_) => self.choose(of, a, b, name),
            None => a, // the same
        }
    }

    fn finish(mut self, program: &Program, terms: &[Term], states: &[Register]) -> Recurrences {
        let (dim, branches) = (self.dim, self.branches.len());
        let outputs: Vec<Term> = program.outputs().iter().map(|output| terms[output.index()]).collect();
        let (rates, watched) = outputs.split_at(dim);
        let zero = |term: &Term| term.zero;
        let of_zeroth: Vec<Register> = (watched.iter().map(zero))
            .chain(self.factors.iter().copied())
            .chain(self.branches.iter().map(zero))
            .chain(rates.iter().map(zero))
            .collect();
        let none = self.next.number(0.0);
        let sums = self.sums.len().next_multiple_of(LANES);
        self.sums.resize(sums, [None; 2]);
        let factors = |which: usize| self.sums.iter().map(move |sum| sum[which].unwrap_or(none));
        let or_none = |term: &Term| term.next.unwrap_or(none);
        let of_next: Vec<Register> = (factors(0).chain(factors(1)))
            .chain(states.iter().copied())
            .chain(self.branches.iter().map(or_none))
            .chain(rates.iter().map(or_none))
            .collect();
        Recurrences {
            zeroth: Arc::new(self.zero.finish((dim, branches, program.parameters_len()), of_zeroth)),
            next: Arc::new(self.next.finish((dim + EXTRA, sums, self.factors.len()), of_next)),
            dim,
            watched: watched.len(),
            factors: self.factors.len(),
            sums,
            branches: self.names,
        }
    }
}
