//! The recurrences of all operations [Jorba, Zou 2005, prop. 2.1; Griewank, Walther 2008, tables 13.1 and 13.2].
//!
//! With S(u, v) = Σ_{j=1}^{k−1} u_j v_{k−j}, which needs lower orders only, and with D u for the series of j
//! u_j:
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
//! The sums of one order depend only on lower orders, so that all of them are computed together, before the
//! coefficients of that order. Functions with corners or jumps are replaced by their present branch, with a
//! factor σ: |u| = σ u.

use std::sync::Arc;

use rustc_hash::FxHashMap;

use super::assembler::Assembler;
use super::sums::LANES;
use crate::graph::function::Function;
use crate::program::program::{Instruction, Program, Register};

/// f and its recurrences.
#[derive(Debug)]
pub(super) struct Recurrences {
    /// From (t, (y, σ), parameters): the watched outputs, the factors, the functions whose signs are σ, and
    /// ẏ.
    pub(super) zeroth: Arc<Program>,
    /// From (1/k, (the coefficients of order k − 1 of ẏ, k, the coefficient of t, the error of the double
    /// 1/k, the sums), factors): the coefficients of order k of the first and second factors of all sums, of
    /// y, of the functions whose signs are σ, and of ẏ.
    pub(super) next: Arc<Program>,
    pub(super) dim: usize,
    pub(super) watched: usize,
    pub(super) factors: usize,
    /// The number of sums, rounded up to whole vectors.
    pub(super) sums: usize,
    /// The functions whose signs select the branch, as text.
    pub(super) branches: Vec<String>,
}

/// The numbers of a row between the rates and the sums.
pub(super) const EXTRA: usize = 3;

/// A value as computed for order 0 and for an order above; the latter is absent if the value is constant.
#[derive(Clone, Copy)]
pub(super) struct Term {
    pub(super) zero: Register,
    pub(super) next: Option<Register>,
}

/// The programs as written so far.
pub(super) struct Writer {
    pub(super) zero: Assembler,
    pub(super) next: Assembler,
    pub(super) dim: usize,
    pub(super) factors: Vec<Register>,
    pub(super) places: FxHashMap<Register, usize>,
    /// The two factors of each sum.
    pub(super) sums: Vec<[Option<Register>; 2]>,
    pub(super) products: FxHashMap<[Register; 2], usize>,
    /// (sin, cos) and (sinh, cosh) of arguments met so far.
    pub(super) circles: FxHashMap<(Function, Register), [Term; 2]>,
    pub(super) branches: Vec<Term>,
    pub(super) branch_of: FxHashMap<Register, usize>,
    pub(super) names: Vec<String>,
}

impl Recurrences {
    /// The recurrences of the solutions of a program whose first `dim` outputs are ẏ; the other outputs are
    /// watched at order 0.
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

    /// A value of order 0 for use as a factor in later orders.
    pub(super) fn factor(&mut self, zero: Register) -> Register {
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
    pub(super) fn reciprocal(&mut self, zero: Register) -> Register {
        let one = self.zero.number(1.0);
        let inverse = self.zero.divide(one, zero);
        self.factor(inverse)
    }

    /// S(u, v)
    pub(super) fn sum(&mut self, u: Register, v: Register) -> Register {
        let key = if u <= v { [u, v] } else { [v, u] };
        let sums = &mut self.sums;
        Assembler::sum(*self.products.entry(key).or_insert_with(|| {
            sums.push([Some(u), Some(v)]);
            sums.len() - 1
        }))
    }

    /// S(u, w) where w is a result that itself needs this sum.
    pub(super) fn open_sum(&mut self, u: Option<Register>) -> usize {
        self.sums.push([u, None]);
        self.sums.len() - 1
    }

    pub(super) fn close_sum(&mut self, sum: usize, w: Register) {
        for place in &mut self.sums[sum] {
            place.get_or_insert(w);
        }
    }

    /// D u
    pub(super) fn rising(&mut self, u: Register) -> Register {
        let order = Assembler::state(self.dim);
        self.next.multiply(order, u)
    }

    /// x/k, computed with the double nearest to 1/k and its error: the rounding of 1/k, the same in every
    /// step, would accumulate.
    pub(super) fn over_order(&mut self, x: Register) -> Register {
        let lacking = self.next.multiply(x, Assembler::state(self.dim + 2));
        self.next.multiply_add(x, Assembler::time(), lacking)
    }

    pub(super) fn add(&mut self, a: Term, b: Term) -> Term {
        let zero = self.zero.add(a.zero, b.zero);
        let next = match (a.next, b.next) {
            (Some(a), Some(b)) => Some(self.next.add(a, b)),
            (one, None) | (None, one) => one,
        };
        Term { zero, next }
    }

    pub(super) fn subtract(&mut self, a: Term, b: Term) -> Term {
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

    pub(super) fn multiply(&mut self, a: Term, b: Term) -> Term {
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
                // The factor known last is added last.
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
