//! Equations (9) and (30) by their definition, at one state, in numbers: the oracle for derived equations.
//!
//!   d/dt ∂L/∂η_s = (c_rs^m η_r + c_0s^m) ∂L/∂η_m + X_s L + Q_s,   s = 1..l, r = 1..l, m = 1..k,
//!
//! with η_α = 0 for α > l after differentiation. Of the library only the evaluation of L, b, b_0 and Q is
//! used, over dual numbers that give every derivative; c comes out of the brackets [X_r, X_s] = c_rs^m X_m
//! (5), (6). No derivative, bracket, inverse or rewriting of the library has a part in it.

mod linear;

use pc_mech::{Backend, Expr, Folding, Graph, System, VectorField};

use crate::classical::SplitMix64;
use crate::dual::Dual;
use linear::{inverse, pseudo_inverse};

/// Up to some hundred terms are summed in two orders, and mass matrices of condition below some hundred
/// inverted: at most a few thousand roundings of the largest term. A forgotten or turned term is an error of
/// order one.
pub const TOLERANCE: f64 = 1e-12;

/// Brackets that close do so to some roundings of their largest terms.
const CLOSURE: f64 = 1e-11;

/// The rates of change of a state, each with the largest term that makes it up.
#[derive(Clone, Debug, Default)]
pub struct Rates {
    /// ẋ_1..ẋ_n, η̇_1..η̇_l
    pub values: Vec<f64>,
    /// The largest term of each: of b η + b_0, and of the balance M η̇ − r led through M⁻¹.
    pub sizes: Vec<f64>,
}

impl Rates {
    fn push(&mut self, value: f64, size: f64) {
        self.values.push(value);
        self.sizes.push(size);
    }
}

/// Adds terms up and remembers the largest.
#[derive(Clone, Copy, Debug, Default)]
struct Balance {
    sum: f64,
    largest: f64,
}

impl Balance {
    fn add(&mut self, term: f64) {
        self.add_scaled(Balance { sum: term, largest: term.abs() }, 1.0);
    }

    /// Adds what is itself a sum, times a factor.
    fn add_scaled(&mut self, other: Balance, factor: f64) {
        self.sum += factor * other.sum;
        self.largest = self.largest.max(factor.abs() * other.largest);
    }
}

impl FromIterator<f64> for Balance {
    fn from_iter<I: IntoIterator<Item = f64>>(terms: I) -> Balance {
        let mut balance = Balance::default();
        terms.into_iter().for_each(|term| balance.add(term));
        balance
    }
}

/// A system at a state (t, x, η), where η has all k components.
struct Point<'a, 'g> {
    system: &'a System<'g>,
    /// The symbols t, x, η and the parameters, with their values.
    place: Vec<(Expr<'g>, f64)>,
    coordinates: usize,
    velocities: usize,
    /// b_0, b_1, … b_k: the operators X_0..X_k, n components each.
    operators: Vec<Vec<f64>>,
}

impl<'a, 'g> Point<'a, 'g> {
    fn new(system: &'a System<'g>, t: f64, x: &[f64], eta: &[f64]) -> Point<'a, 'g> {
        let frame = system.frame();
        let mut place = vec![(frame.time(), t)];
        place.extend(frame.coordinates().iter().copied().zip(x.iter().copied()));
        place.extend(system.quasi_velocities().iter().copied().zip(eta.iter().copied()));
        place.extend(system.parameters());
        let (coordinates, velocities) = (x.len(), eta.len());
        let mut point = Point { system, place, coordinates, velocities, operators: Vec::new() };
        let value = |operator: &Vec<Dual>| operator.iter().map(|b| b.value()).collect();
        point.operators = point.operators_along(&[]).iter().map(value).collect();
        point
    }

    /// Expressions and their derivatives along directions of the variables t, x, η.
    fn evaluate(&self, expressions: &[Expr<'g>], first: &[f64], second: &[f64]) -> Vec<Dual> {
        let rate = |direction: &[f64], i: usize| direction.get(i).copied().unwrap_or(0.0);
        let place: Vec<(Expr<'g>, Dual)> = self
            .place
            .iter()
            .enumerate()
            .map(|(i, &(symbol, value))| (symbol, Dual::new(value, rate(first, i), rate(second, i))))
            .collect();
        self.system.graph().evaluate(expressions, &place).unwrap_or_else(|error| panic!("{error}"))
    }

    /// The components of X_0..X_k with their derivatives along a direction of (t, x).
    fn operators_along(&self, direction: &[f64]) -> Vec<Vec<Dual>> {
        let frame = self.system.frame();
        let mut entries = frame.b0().to_vec();
        (0..self.velocities).for_each(|s| entries.extend(frame.b().column(s)));
        let values = self.evaluate(&entries, direction, &[]);
        (0..=self.velocities).map(|s| values[s * self.coordinates..][..self.coordinates].to_vec()).collect()
    }

    /// Variable number `i` of t, x, η as a direction.
    fn unit(&self, i: usize) -> Vec<f64> {
        (0..1 + self.coordinates + self.velocities).map(|j| f64::from(u8::from(i == j))).collect()
    }

    /// Number of the variable η_s, s from 0.
    fn eta(&self, s: usize) -> usize {
        1 + self.coordinates + s
    }

    /// ∂L/∂u, ∂L/∂v and ∂²L/∂u∂v for two of the variables.
    fn derivatives(&self, u: usize, v: usize) -> [f64; 3] {
        let lagrangian = self.evaluate(&[self.system.lagrangian()], &self.unit(u), &self.unit(v))[0];
        [lagrangian.first(), lagrangian.second(), lagrangian.mixed()]
    }

    /// c_rs^m for all r, s = 0..k, and m = 1..k at the index m − 1, with the largest terms of the brackets
    /// that they come out of. Where brackets do not determine them they are those that the system was given.
    fn structure(&self) -> Vec<Vec<Vec<Balance>>> {
        let (n, k) = (self.coordinates, self.velocities);
        let moved: Vec<Vec<Vec<Dual>>> = (0..=k)
            .map(|r| {
                let time = if r == 0 { 1.0 } else { 0.0 };
                self.operators_along(&[&[time], &self.operators[r][..]].concat())
            })
            .collect();
        let inverse = pseudo_inverse(&self.operators[1..]);
        let pair = |r: usize, s: usize| -> Vec<Balance> {
            // X_r(b_is) and −X_s(b_ir)
            let bracket = |i: usize| [moved[r][s][i].first(), -moved[s][r][i].first()];
            let c: Vec<Balance> = match &inverse {
                Some(inverse) => inverse
                    .iter()
                    .map(|row| (0..n).flat_map(|i| bracket(i).map(|term| row[i] * term)).collect())
                    .collect(),
                None => self.given(r, s),
            };
            let scale = (0..n).flat_map(bracket).fold(0.0f64, |scale, term| scale.max(term.abs()));
            for i in 0..n {
                let mut rest: Balance = bracket(i).into_iter().collect();
                c.iter().zip(&self.operators[1..]).for_each(|(c, b)| rest.add_scaled(*c, -b[i]));
                let closed = rest.sum.abs() <= CLOSURE * rest.largest.max(scale);
                assert!(closed, "[X_{r}, X_{s}] is not closed in component {i}: {rest:?}");
            }
            c
        };
        (0..=k).map(|r| (0..=k).map(|s| pair(r, s)).collect()).collect()
    }

    /// The c_rs^m that the system was given.
    fn given(&self, r: usize, s: usize) -> Vec<Balance> {
        let given: Vec<Expr<'g>> =
            (1..=self.velocities).map(|m| self.system.structure().get(r, s, m)).collect();
        self.evaluate(&given, &[], &[]).iter().map(|c| [c.value()].into_iter().collect()).collect()
    }

    /// ẋ = b η + b_0
    fn kinematics(&self) -> Vec<Balance> {
        let eta = self.quasi_velocities();
        let along = |i: usize| (0..self.velocities).map(|s| self.operators[s + 1][i] * eta[s]).collect();
        let mut velocities: Vec<Balance> = (0..self.coordinates).map(along).collect();
        velocities.iter_mut().zip(&self.operators[0]).for_each(|(velocity, &drift)| velocity.add(drift));
        velocities
    }

    fn quasi_velocities(&self) -> Vec<f64> {
        (0..self.velocities).map(|s| self.place[self.eta(s)].1).collect()
    }

    /// (c_rs^m η_r + c_0s^m) p_m + X_s L + Q_s − (∂²L/∂η_s∂x) ẋ − ∂²L/∂η_s∂t for s = 1..`free`.
    fn right_hand_side(&self, free: usize, velocity: &[Balance]) -> Vec<Balance> {
        let (n, k) = (self.coordinates, self.velocities);
        let rate = [&[1.0], &self.quasi_velocities()[..]].concat();
        let momenta: Vec<f64> = (0..k).map(|m| self.derivatives(self.eta(m), 0)[0]).collect();
        let slope: Vec<f64> = (0..n).map(|i| self.derivatives(1 + i, 0)[0]).collect();
        let forces = self.evaluate(self.system.forces(), &[], &[]);
        let c = self.structure();
        let of = |s: usize| {
            let second = |v: usize| self.derivatives(self.eta(s - 1), v)[2];
            let potential = (0..n).map(|i| self.operators[s][i] * slope[i]);
            let transport = (0..n).map(|i| -second(1 + i) * velocity[i].sum);
            let terms = potential.chain(transport).chain([forces[s - 1].value(), -second(0)]);
            let mut right: Balance = terms.collect();
            for r in (0..=k).filter(|&r| r != s) {
                (0..k).for_each(|m| right.add_scaled(c[r][s][m], rate[r] * momenta[m]));
            }
            right
        };
        (1..=free).map(of).collect()
    }

    /// The rates of x and of the first `free` quasi-velocities, the others being 0.
    fn rates(&self, free: usize) -> Rates {
        let mut rates = Rates::default();
        let velocity = self.kinematics();
        velocity.iter().for_each(|velocity| rates.push(velocity.sum, velocity.largest));
        let right = self.right_hand_side(free, &velocity);
        let mass: Vec<Vec<f64>> = (0..free)
            .map(|s| (0..free).map(|r| self.derivatives(self.eta(s), self.eta(r))[2]).collect())
            .collect();
        let inverse = inverse(&mass);
        let accelerations: Vec<f64> =
            (0..free).map(|s| (0..free).map(|r| inverse[s][r] * right[r].sum).sum()).collect();
        for s in 0..free {
            let largest = |r: usize| {
                let inertia = (0..free).map(|q| (mass[r][q] * accelerations[q]).abs());
                inertia.fold(right[r].largest, f64::max) * inverse[s][r].abs()
            };
            rates.push(accelerations[s], (0..free).map(largest).fold(0.0, f64::max));
        }
        rates
    }
}

/// The rates of change of the state y = (x, η_1..η_free) by the definition; the other quasi-velocities are 0.
///
/// # Panics
/// Where brackets do not close, the mass matrix is singular, or L, b, b_0 or Q has a corner.
pub fn rates(system: &System<'_>, free: usize, t: f64, y: &[f64]) -> Rates {
    let (x, moving) = y.split_at(y.len() - free);
    let mut eta = moving.to_vec();
    eta.resize(system.quasi_velocities().len(), 0.0);
    Point::new(system, t, x, &eta).rates(free)
}

/// Derives equations (30) with both foldings, the last `vanishing` quasi-velocities being 0, and compares
/// them at `states` states with their definition.
///
/// The definition reads the system as built without folding by value, so that what this merges is seen if it
/// is wrong. The answer is the largest error, relative to the largest term.
///
/// # Panics
/// If the system is refused, and where an error is above [`TOLERANCE`].
pub fn assert_derived(
    name: &str,
    build: impl for<'g> Fn(&'g Graph) -> System<'g>,
    vanishing: usize,
    states: usize,
    sample: impl Fn(&mut SplitMix64) -> (f64, Vec<f64>),
) -> f64 {
    let graphs = [Folding::Structural, Folding::ByValue].map(Graph::with_folding);
    let systems = [build(&graphs[0]), build(&graphs[1])];
    let free = systems[0].quasi_velocities().len() - vanishing;
    let mut motions = [0, 1].map(|i| {
        let derived = systems[i].poincare_constrained(free);
        derived.and_then(|e| e.compile_for(Backend::Interpreter)).unwrap_or_else(|e| panic!("{name}: {e}"))
    });
    let (mut random, mut worst) = (SplitMix64::new(23), 0.0f64);
    for _ in 0..states {
        let (t, y) = sample(&mut random);
        let expected = rates(&systems[0], free, t, &y);
        for (motion, folding) in motions.iter_mut().zip([Folding::Structural, Folding::ByValue]) {
            let mut found = vec![f64::NAN; y.len()];
            motion.rhs(t, &y, &mut found).unwrap_or_else(|failure| panic!("{name}: {failure}"));
            for i in 0..y.len() {
                let error = (found[i] - expected.values[i]).abs();
                assert!(
                    error <= TOLERANCE * expected.sizes[i],
                    "{name}, {folding:?}, at t = {t}, {y:?}: component {i} is {}, not {}, of terms up to {}",
                    found[i],
                    expected.values[i],
                    expected.sizes[i]
                );
                if error > 0.0 {
                    worst = worst.max(error / expected.sizes[i]);
                }
            }
        }
    }
    worst
}
