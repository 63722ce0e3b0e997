//! The recurrences of the functions; see [`recurrences`](super::recurrences).

use super::assembler::Assembler;
use super::recurrences::{Term, Writer};
use crate::graph::function::Function;
use crate::program::program::Register;

impl Writer {
    /// w with ẇ = u̇/v, given its value w₀.
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

    /// w with ẇ = w u̇, given its value w₀.
    fn exponential(&mut self, zero: Register, u: Register) -> Term {
        let rising = self.rising(u);
        let sum = self.open_sum(Some(rising));
        let part = self.over_order(Assembler::sum(sum));
        let w0 = self.factor(zero);
        let next = self.next.multiply_add(w0, u, part);
        self.close_sum(sum, next);
        Term { zero, next: Some(next) }
    }

    /// The pair (sin, cos) or (sinh, cosh) of an argument that changes.
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

    /// The sign of a term that changes.
    fn side(&mut self, of: Term, name: impl Fn() -> String) -> Register {
        let (branches, names) = (&mut self.branches, &mut self.names);
        Assembler::sum(*self.branch_of.entry(of.zero).or_insert_with(|| {
            branches.push(of);
            names.push(name());
            branches.len() - 1
        }))
    }

    /// a where the sign of `of` is nonnegative, else b.
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

    pub(super) fn call(
        &mut self,
        function: Function,
        [a, b, c]: [Term; 3],
        name: impl Fn() -> String,
    ) -> Term {
        let args = [a, b, c].map(|term| term.zero);
        let fixed = [a, b, c][..function.arity()].iter().all(|term| term.next.is_none());
        let Some(u) = a.next.filter(|_| !fixed) else {
            return match function {
                Function::Pow if !fixed => self.pow(a, b),
                Function::Atan2 if !fixed => self.atan2(a, b),
                Function::Min | Function::Max if !fixed => self.lesser(function, a, b, name),
                Function::Step if !fixed => {
                    // The condition is constant.
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
}
