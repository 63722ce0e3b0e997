//! Left-invariant frames of groups, on all coordinates or on those that the fields do not leave.

use super::functions::with;
use super::{Builder, COORDINATES, QUASI_VELOCITIES};
use crate::fuzz::expression::Expression;
use crate::fuzz::specimen::{Carried, Coordinate, Frame};

/// The frame ẋ = b u of an algebra in coordinates a, b, c, and u in the velocities A, B, C of these.
struct Group {
    name: &'static str,
    velocities: &'static [&'static str],
    inverse: &'static [&'static str],
    /// (r, s, m, c_rs^m), r < s
    brackets: &'static [(usize, usize, usize, f64)],
    /// Sets of coordinates whose rates contain no other.
    closed: &'static [&'static [usize]],
}

const GROUPS: &[Group] = &[
    Group {
        name: "heisenberg",
        velocities: &["u1", "u2", "a*u2 + u3"],
        inverse: &["A", "B", "C - a*B"],
        brackets: &[(0, 1, 2, 1.0)],
        closed: &[&[], &[0], &[1], &[0, 1]],
    },
    Group {
        name: "aff1",
        velocities: &["u1", "exp(a)*u2"],
        inverse: &["A", "exp(-a)*B"],
        brackets: &[(0, 1, 1, 1.0)],
        closed: &[&[], &[0]],
    },
    Group {
        name: "se2",
        velocities: &["u1", "cos(a)*u2 - sin(a)*u3", "sin(a)*u2 + cos(a)*u3"],
        inverse: &["A", "cos(a)*B + sin(a)*C", "cos(a)*C - sin(a)*B"],
        brackets: &[(0, 1, 2, 1.0), (0, 2, 1, -1.0)],
        closed: &[&[], &[0]],
    },
    Group {
        name: "bianchi4",
        velocities: &["u1", "exp(-a)*u2", "exp(-a)*(a*u2 + u3)"],
        inverse: &["A", "exp(a)*B", "exp(a)*(C - a*B)"],
        brackets: &[(0, 1, 1, -1.0), (0, 1, 2, 1.0), (0, 2, 2, -1.0)],
        closed: &[&[], &[0], &[0, 1]],
    },
    Group {
        name: "bianchi5",
        velocities: &["u1", "exp(-a)*u2", "exp(-a)*u3"],
        inverse: &["A", "exp(a)*B", "exp(a)*C"],
        brackets: &[(0, 1, 1, -1.0), (0, 2, 2, -1.0)],
        closed: &[&[], &[0], &[0, 1], &[0, 2]],
    },
    Group {
        name: "bianchi6",
        velocities: &["u1", "cosh(a)*u2 - sinh(a)*u3", "cosh(a)*u3 - sinh(a)*u2"],
        inverse: &["A", "cosh(a)*B + sinh(a)*C", "cosh(a)*C + sinh(a)*B"],
        brackets: &[(0, 1, 2, -1.0), (0, 2, 1, -1.0)],
        closed: &[&[], &[0]],
    },
    ROTATIONS,
];

/// By a = θ, b = φ, c = ψ, Euler's angles, with the rates of body axes.
const ROTATIONS: Group = Group {
    name: "so3",
    velocities: &[
        "cos(b)*u1 - sin(b)*u2",
        "u3 - (sin(b)*u1 + cos(b)*u2)*cos(a)/sin(a)",
        "(sin(b)*u1 + cos(b)*u2)/sin(a)",
    ],
    inverse: &["cos(b)*A + sin(a)*sin(b)*C", "sin(a)*cos(b)*C - sin(b)*A", "B + cos(a)*C"],
    brackets: &[(0, 1, 2, 1.0), (1, 2, 0, 1.0), (0, 2, 1, -1.0)],
    closed: &[&[], &[0, 1]],
};

/// The vertical in body axes, γ = (sin θ sin φ, sin θ cos φ, cos θ), with γ̇ = γ × u.
const VERTICAL: [(&str, &str, &str); 3] = [
    ("γ1", "sin(a)*sin(b)", "γ2*u3 - γ3*u2"),
    ("γ2", "sin(a)*cos(b)", "γ3*u1 - γ1*u3"),
    ("γ3", "cos(a)", "γ1*u2 - γ2*u1"),
];

impl Builder {
    /// The frame of a group in another basis, with or without all coordinates.
    pub(super) fn group(&mut self) {
        let group = self.random.pick(GROUPS);
        let k = group.velocities.len();
        let vertical = group.name == "so3" && self.random.chance(40);
        let all: Vec<usize> = (0..k).collect();
        let shown: Vec<usize> = match (vertical, self.random.chance(20)) {
            (true, _) => Vec::new(),
            (false, true) => all.clone(),
            (false, false) => self.random.pick(group.closed).to_vec(),
        };
        for (i, name) in COORDINATES[..k].iter().enumerate() {
            let start = self.random.decimal(0.4, 1.1);
            self.specimen.chart.push(Coordinate {
                name: (*name).to_owned(),
                start,
                shown: shown.contains(&i),
            });
        }
        let eta: Vec<String> = QUASI_VELOCITIES[..k].iter().map(|&name| name.to_owned()).collect();
        let change = self.change_of_basis(k);
        let shift = if self.random.chance(15) { self.random.decimal(0.2, 1.0) } else { 0.0 };
        let names = self.names(k, &change, &eta, shift);
        let named = |text: &&str| with(text, &names);
        let velocities = group.velocities.iter().map(named).collect();
        let u: Vec<Expression> = group.inverse.iter().map(named).collect();
        // w_r = P_rs u_s, where u_1 counts from the shift.
        let inverse = (0..k).map(|r| {
            let mut terms: Vec<Expression> = (0..=r).map(|s| u[s].clone().times(change[r][s])).collect();
            terms.push(Expression::Number(-change[r][0] * shift));
            Expression::sum(terms)
        });
        let inverse = inverse.collect();
        if vertical {
            self.specimen.carried = VERTICAL
                .iter()
                .map(|(name, value, velocity)| Carried {
                    name: (*name).to_owned(),
                    value: with(value, &names),
                    velocity: with(velocity, &names),
                })
                .collect();
        }
        let complete = shown.len() == k;
        let trivial = shift == 0.0 && (0..k).all(|r| (0..r).all(|s| change[r][s] == 0.0));
        let given = if complete { self.random.chance(30) } else { self.random.chance(88) };
        if given {
            self.specimen.algebra = Some(match trivial && self.random.chance(70) {
                true => format!("name = \"{}\"", group.name),
                false => brackets(group, &eta, &change, shift),
            });
        }
        self.specimen.frame = Frame::Group { eta, velocities, inverse };
        if !shown.is_empty() && self.random.chance(25) {
            self.carry();
        }
    }

    /// P of w = P u, lower triangular with ones on the diagonal.
    fn change_of_basis(&mut self, k: usize) -> Vec<Vec<f64>> {
        let mixed = self.random.chance(40);
        let mut entry = |r: usize, s: usize| match r.cmp(&s) {
            std::cmp::Ordering::Less => 0.0,
            std::cmp::Ordering::Equal => 1.0,
            std::cmp::Ordering::Greater if mixed => *self.random.pick(&[0.0, 1.0, -1.0, 2.0]),
            std::cmp::Ordering::Greater => 0.0,
        };
        (0..k).map(|r| (0..k).map(|s| entry(r, s)).collect()).collect()
    }

    /// What stands for the names of the tables: u = P⁻¹ w + (shift, 0, ..), a, b, c and A, B, C.
    fn names(
        &self,
        k: usize,
        change: &[Vec<f64>],
        eta: &[String],
        shift: f64,
    ) -> Vec<(&'static str, Expression)> {
        let back = inverse(change);
        let mut names = Vec::new();
        for (s, name) in ["u1", "u2", "u3"].into_iter().enumerate().take(k) {
            let mut terms: Vec<Expression> =
                (0..=s).map(|r| Expression::symbol(&eta[r]).times(back[s][r])).collect();
            if s == 0 {
                terms.push(Expression::Number(shift));
            }
            names.push((name, Expression::sum(terms)));
        }
        for (i, x) in self.specimen.chart.iter().enumerate() {
            names.push((["a", "b", "c"][i], Expression::symbol(&x.name)));
            names.push((["A", "B", "C"][i], Expression::velocity(&x.name)));
        }
        names
    }
}

/// The inverse of a lower triangular matrix with ones on the diagonal.
fn inverse(matrix: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let k = matrix.len();
    let mut inverse = vec![vec![0.0; k]; k];
    for column in 0..k {
        for row in column..k {
            let known: f64 = (column..row).map(|m| matrix[row][m] * inverse[m][column]).sum();
            inverse[row][column] = f64::from(u8::from(row == column)) - known;
        }
    }
    inverse
}

/// [X_r, X_s] of the operators of w = P u, those of u being X_u = P^T X_w, and [t, X_s] of the shift.
fn brackets(group: &Group, eta: &[String], change: &[Vec<f64>], shift: f64) -> String {
    let k = eta.len();
    let back = inverse(change);
    let c = |r: usize, s: usize, m: usize| -> f64 {
        let known = |(i, j)| {
            let entry = group.brackets.iter().find(|b| (b.0, b.1, b.2) == (i, j, m));
            entry.map_or(0.0, |b| b.3)
        };
        known((r, s)) - known((s, r))
    };
    // The bracket of Σ left_r X_ur and Σ right_s X_us, as a combination of the X_w.
    let bracket = |left: &[f64], right: &[f64]| -> Vec<f64> {
        let of_u: Vec<f64> = (0..k)
            .map(|m| {
                (0..k)
                    .flat_map(|r| (0..k).map(move |s| (r, s)))
                    .map(|(r, s)| left[r] * right[s] * c(r, s, m))
                    .sum()
            })
            .collect();
        (0..k).map(|r| (0..k).map(|m| change[r][m] * of_u[m]).sum()).collect()
    };
    let operator = |r: usize| -> Vec<f64> { (0..k).map(|s| back[s][r]).collect() };
    let mut drift = vec![0.0; k];
    drift[0] = shift;
    let time = (0..k).map(|s| ("t".to_owned(), s, bracket(&drift, &operator(s))));
    let pairs = (0..k).flat_map(|r| (r + 1..k).map(move |s| (r, s)));
    let pairs = pairs.map(|(r, s)| (eta[r].clone(), s, bracket(&operator(r), &operator(s))));
    let entries: Vec<String> = time
        .chain(pairs)
        .filter(|(_, _, value)| value.iter().any(|c| *c != 0.0))
        .map(|(left, right, value)| {
            let terms = value.iter().zip(eta).map(|(&c, eta)| Expression::symbol(eta).times(c));
            let terms = terms.filter(|term| !term.is_zero()).collect();
            format!("\"{left},{}\" = \"{}\"", eta[right], Expression::sum(terms))
        })
        .collect();
    format!("brackets = {{ {} }}", entries.join(", "))
}

#[cfg(test)]
mod tests {
    use num_dual::Dual64;

    use super::*;
    use crate::fuzz::expression::Values;

    /// Values of the coordinates of a table, with rates.
    fn place(rates: &[f64]) -> Values {
        let coordinates = ["a", "b", "c"].into_iter().zip([0.7, 0.4, 1.1]).zip(rates);
        coordinates.map(|((name, value), &rate)| (name.to_owned(), Dual64::new(value, rate))).collect()
    }

    fn field(group: &Group, s: usize, along: &[f64]) -> Vec<Dual64> {
        let mut values = place(along);
        for (r, name) in ["u1", "u2", "u3"].into_iter().enumerate() {
            values.insert(name.to_owned(), Dual64::from(f64::from(u8::from(r == s))));
        }
        group.velocities.iter().map(|text| with(text, &[]).value(&values)).collect()
    }

    fn components(field: &[Dual64]) -> Vec<f64> {
        field.iter().map(|component| component.re).collect()
    }

    #[test]
    fn fields_have_the_brackets_of_the_table() {
        for group in GROUPS {
            let k = group.velocities.len();
            let fields: Vec<Vec<f64>> = (0..k).map(|s| components(&field(group, s, &[0.0; 3]))).collect();
            for (r, s) in (0..k).flat_map(|r| (r + 1..k).map(move |s| (r, s))) {
                let (along_r, along_s) = (field(group, s, &fields[r]), field(group, r, &fields[s]));
                for i in 0..k {
                    let given = group.brackets.iter().filter(|b| (b.0, b.1) == (r, s));
                    let given: f64 = given.map(|b| b.3 * fields[b.2][i]).sum();
                    let bracket = along_r[i].eps - along_s[i].eps;
                    assert!((bracket - given).abs() < 1e-14, "{}: [{r}, {s}]", group.name);
                }
            }
        }
    }

    #[test]
    fn velocities_and_their_inverse_are_that() {
        for group in GROUPS {
            for s in 0..group.velocities.len() {
                let mut values = place(&[0.0; 3]);
                for (name, rate) in ["A", "B", "C"].into_iter().zip(components(&field(group, s, &[0.0; 3]))) {
                    values.insert(name.to_owned(), Dual64::from(rate));
                }
                for (r, text) in group.inverse.iter().enumerate() {
                    let u = with(text, &[]).value(&values).re;
                    assert!((u - f64::from(u8::from(r == s))).abs() < 1e-14, "{}: u{r}", group.name);
                }
            }
        }
    }

    #[test]
    fn the_vertical_turns_against_the_body() {
        let rates = components(&field(&ROTATIONS, 1, &[0.0; 3]));
        let mut values = place(&rates);
        let vertical: Vec<Dual64> =
            VERTICAL.iter().map(|(_, value, _)| with(value, &[]).value(&values)).collect();
        for ((name, ..), value) in VERTICAL.iter().zip(&vertical) {
            values.insert((*name).to_owned(), *value);
        }
        for (name, rate) in [("u1", 0.0), ("u2", 1.0), ("u3", 0.0)] {
            values.insert(name.to_owned(), Dual64::from(rate));
        }
        for ((name, _, velocity), value) in VERTICAL.iter().zip(&vertical) {
            assert!((with(velocity, &[]).value(&values).re - value.eps).abs() < 1e-15, "{name}");
        }
    }
}
