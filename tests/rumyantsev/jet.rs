//! Numbers that carry their first and second derivatives: partial derivatives without the library's own.

use std::ops::{Add, Mul, Neg, Sub};

use pc_expr::{Function, Scalar};

/// The largest number of variables: t, three x and three ẋ.
pub(super) const VARIABLES: usize = 7;

/// A value with its gradient and Hessian in [`VARIABLES`] variables.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jet {
    pub(super) value: f64,
    pub(super) gradient: [f64; VARIABLES],
    pub(super) hessian: [[f64; VARIABLES]; VARIABLES],
}

impl Jet {
    pub(super) fn constant(value: f64) -> Jet {
        Jet { value, gradient: [0.0; VARIABLES], hessian: [[0.0; VARIABLES]; VARIABLES] }
    }

    pub(super) fn variable(value: f64, index: usize) -> Jet {
        let mut jet = Jet::constant(value);
        jet.gradient[index] = 1.0;
        jet
    }

    /// f(self) by the chain rule, from f, f′ and f″ at the value.
    fn chain(self, [f, slope, curvature]: [f64; 3]) -> Jet {
        let g = self.gradient;
        Jet {
            value: f,
            gradient: g.map(|d| slope * d),
            hessian: std::array::from_fn(|i| {
                std::array::from_fn(|j| slope * self.hessian[i][j] + curvature * g[i] * g[j])
            }),
        }
    }

    pub(super) fn recip(self) -> Jet {
        Scalar::powi(self, -1)
    }
}

impl Add for Jet {
    type Output = Jet;
    fn add(self, other: Jet) -> Jet {
        Jet {
            value: self.value + other.value,
            gradient: std::array::from_fn(|i| self.gradient[i] + other.gradient[i]),
            hessian: std::array::from_fn(|i| {
                std::array::from_fn(|j| self.hessian[i][j] + other.hessian[i][j])
            }),
        }
    }
}

impl Neg for Jet {
    type Output = Jet;
    fn neg(self) -> Jet {
        self.chain([-self.value, -1.0, 0.0])
    }
}

impl Sub for Jet {
    type Output = Jet;
    fn sub(self, other: Jet) -> Jet {
        self + -other
    }
}

impl Mul for Jet {
    type Output = Jet;
    #[expect(clippy::suspicious_arithmetic_impl, reason = "the product rule has sums")]
    fn mul(self, other: Jet) -> Jet {
        let (u, v) = (self, other);
        Jet {
            value: u.value * v.value,
            gradient: std::array::from_fn(|i| u.gradient[i] * v.value + u.value * v.gradient[i]),
            hessian: std::array::from_fn(|i| {
                std::array::from_fn(|j| {
                    u.hessian[i][j] * v.value
                        + u.value * v.hessian[i][j]
                        + u.gradient[i] * v.gradient[j]
                        + u.gradient[j] * v.gradient[i]
                })
            }),
        }
    }
}

impl Scalar for Jet {
    fn from_f64(value: f64) -> Jet {
        Jet::constant(value)
    }

    fn powi(self, exponent: i32) -> Jet {
        let (x, e) = (self.value, f64::from(exponent));
        let slope = if exponent == 0 { 0.0 } else { e * x.powi(exponent - 1) };
        let curvature = if (0..2).contains(&exponent) { 0.0 } else { e * (e - 1.0) * x.powi(exponent - 2) };
        self.chain([x.powi(exponent), slope, curvature])
    }

    fn call(function: Function, args: &[Jet]) -> Jet {
        let x = args[0].value;
        let (sin, cos) = x.sin_cos();
        args[0].chain(match function {
            Function::Sin => [sin, cos, -sin],
            Function::Cos => [cos, -sin, -cos],
            Function::Exp => [x.exp(); 3],
            Function::Sqrt => [x.sqrt(), 0.5 / x.sqrt(), -0.25 / (x * x.sqrt())],
            other => panic!("{} is not used here", other.name()),
        })
    }
}

/// Solves a linear system over jets by Gauss's elimination with row interchanges.
pub(super) fn solve(mut matrix: Vec<Vec<Jet>>, mut right: Vec<Jet>) -> Vec<Jet> {
    let size = right.len();
    for column in 0..size {
        let largest =
            |a: &usize, b: &usize| matrix[*a][column].value.abs().total_cmp(&matrix[*b][column].value.abs());
        let pivot = (column..size).max_by(largest).unwrap();
        matrix.swap(column, pivot);
        right.swap(column, pivot);
        for row in column + 1..size {
            let factor = matrix[row][column] * matrix[column][column].recip();
            for j in column..size {
                matrix[row][j] = matrix[row][j] - factor * matrix[column][j];
            }
            right[row] = right[row] - factor * right[column];
        }
    }
    for row in (0..size).rev() {
        for j in row + 1..size {
            right[row] = right[row] - matrix[row][j] * right[j];
        }
        right[row] = right[row] * matrix[row][row].recip();
    }
    right
}
