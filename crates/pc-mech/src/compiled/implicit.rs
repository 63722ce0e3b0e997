//! Solves nonlinear equations for their unknowns by Newton's method with line search.

use pc_expr::{Backend, Evaluator, ExprError, Pattern, Program};
use serde::{Deserialize, Serialize};

use crate::compiled::elimination::solver::Solver;
use crate::compiled::failure::{EvaluationFailure, check_finite};
use crate::compiled::first_order::{FirstOrder, Implicit};
use crate::compiled::point::Point;

/// The maximum number of steps.
const MOST_STEPS: usize = 200;
/// The maximum number of halvings of a step before the iteration ends.
const HALVINGS: i32 = 60;
/// A residual this small relative to its terms is accepted as a solution.
const ENOUGH: f64 = 1e-12;
/// A residual this small consists of a few rounding errors, and no step can reduce it.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Solves F = r(t, y) − p(t, y, w) = 0 for w:
///
///   M δ = F,   w ← w + λ δ,   M = ∂p/∂w,
///
/// with λ = 1, ½, ¼, … such that p and M are finite, M is regular and
///
///   |F(w + λ δ) − (1 − λ) F(w)| ≤ ½ λ |F(w)|.
///
/// So |F| falls, w stays in the domain of p, and p approaches r on a nearly straight line, which keeps w away
/// from the boundary of the domain until the end.
///
/// Every solution starts from the same guess, so that w depends on (t, y) only, to the last bit; only if the
/// iteration fails does it start again from the last solution.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Newton {
    /// Computes, from (t, (y, w)), the nonzero entries of the lower triangle of M, then p, then r.
    equations: Evaluator,
    values: Vec<f64>,
    lower: Pattern,
    guess: Vec<f64>,
    last: Option<Vec<f64>>,
    here: Iterate,
    /// The residual F at the trial point.
    ahead: Vec<f64>,
}

/// The unknowns w and the values at w; k of each.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Iterate {
    point: Vec<f64>,
    /// F
    residual: Vec<f64>,
    /// δ
    step: Vec<f64>,
    /// |r_s| + |p_s| + Σ_j |M_sj w_j|, the scale of the rounding error of F_s.
    sizes: Vec<f64>,
    /// The weights 1/√|M_ss|, which make the norm of F independent of the units of w.
    weights: Vec<f64>,
}

/// Time and parameters.
type At<'a> = (f64, &'a [f64]);

impl Newton {
    /// # Errors
    /// As for [`Program::new`].
    pub(crate) fn new<'g>(
        system: &FirstOrder<'g>,
        implicit: &Implicit<'g>,
        backend: Backend,
    ) -> Result<Newton, ExprError> {
        let (lower, mut equations) = system.lower_triangle();
        equations.extend(implicit.left.iter().chain(&system.right));
        let program = Program::new(system.graph, &system.inputs(&system.unknowns), &equations)?;
        let zero = || vec![0.0; system.unknowns.len()];
        Ok(Newton {
            equations: Evaluator::new(program, backend),
            values: vec![0.0; equations.len()],
            lower,
            guess: implicit.guess.clone(),
            last: None,
            here: Iterate { point: zero(), residual: zero(), step: zero(), sizes: zero(), weights: zero() },
            ahead: zero(),
        })
    }

    /// Sets the w from which each iteration starts.
    pub(crate) fn begin_at(&mut self, guess: &[f64]) {
        self.guess.copy_from_slice(guess);
    }

    /// The program that computes M, p and r.
    pub(crate) fn program(&self) -> &Program {
        self.equations.program()
    }

    /// Writes w after y in `known`, and leaves M at the solution factorised in `solver`.
    ///
    /// # Errors
    /// [`EvaluationFailure::NotSolved`]; [`EvaluationFailure::Expr`] and [`EvaluationFailure::Pivot`] where p cannot be
    /// evaluated or M is singular at the guess.
    pub(crate) fn solve(
        &mut self,
        t: f64,
        known: &mut [f64],
        p: &[f64],
        solver: &mut Solver,
    ) -> Result<(), EvaluationFailure> {
        let dim = known.len() - self.guess.len();
        known[dim..].copy_from_slice(&self.guess);
        let outcome = self.solve_from((t, p), known, solver).or_else(|failure| {
            let Some(last) = &self.last else { return Err(failure) };
            known[dim..].copy_from_slice(last);
            self.solve_from((t, p), known, solver).map_err(|_| failure)
        });
        if outcome.is_ok() {
            self.last.get_or_insert_with(|| vec![0.0; self.guess.len()]).copy_from_slice(&known[dim..]);
        }
        outcome
    }

    /// Like [`solve`](Newton::solve), but starts from the w in `known`.
    fn solve_from(
        &mut self,
        (t, p): At<'_>,
        known: &mut [f64],
        solver: &mut Solver,
    ) -> Result<(), EvaluationFailure> {
        let dim = known.len() - self.guess.len();
        self.equations.eval(t, known, p, &mut self.values);
        check_finite(&self.values, &self.equations, Point { t, y: known, p })?;
        self.factorise(solver)?;
        let mut halvings = 0;
        for iterations in 0..MOST_STEPS {
            self.look_from(&known[dim..], solver);
            let relative = self.here.relative(&self.here.residual);
            if relative <= ROUNDING {
                return Ok(());
            }
            let before = self.here.norm(&self.here.residual);
            let enough = ENOUGH * self.here.norm(&self.here.sizes);
            if before <= enough && before.is_finite() {
                // Steps continue while they improve any component: the rounding error of a large one may
                // exceed a small one.
                if self.step(1.0, (t, p), known) > enough {
                    known[dim..].copy_from_slice(&self.here.point);
                    return Ok(());
                }
                self.factorise(solver)?;
                if self.here.relative(&self.ahead) > relative / 2.0 {
                    return Ok(());
                }
            } else {
                halvings = match self.search(halvings, before, (t, p), known, solver) {
                    Some(halvings) => (halvings - 2).max(0),
                    None => return Err(self.failure(iterations)),
                };
            }
        }
        Err(self.failure(MOST_STEPS))
    }

    /// Takes the first λ from ½^`halvings` downwards that reduces F sufficiently; the norm of F was `before`.
    /// Returns the number of halvings, if there is such a λ.
    fn search(
        &mut self,
        halvings: i32,
        before: f64,
        at: At<'_>,
        known: &mut [f64],
        solver: &mut Solver,
    ) -> Option<i32> {
        (halvings..=HALVINGS).find(|&halvings| {
            let fraction = 0.5f64.powi(halvings);
            let is_finite = self.step(fraction, at, known).is_finite();
            for (ahead, here) in self.ahead.iter_mut().zip(&self.here.residual) {
                *ahead -= (1.0 - fraction) * here;
            }
            let is_straight = is_finite && self.here.norm(&self.ahead) <= 0.5 * fraction * before;
            is_straight && self.factorise(solver).is_ok()
        })
    }

    fn factorise(&self, solver: &mut Solver) -> Result<(), EvaluationFailure> {
        solver.factorise(&self.lower, &self.values[..self.lower.len()])
    }

    /// Puts w + λ δ into `known`. Returns |F| there, infinite if a value is not finite.
    fn step(&mut self, fraction: f64, (t, p): At<'_>, known: &mut [f64]) -> f64 {
        let k = self.guess.len();
        let dim = known.len() - k;
        for ((w, start), step) in known[dim..].iter_mut().zip(&self.here.point).zip(&self.here.step) {
            *w = start + fraction * step;
        }
        self.equations.eval(t, known, p, &mut self.values);
        if !self.values.iter().all(|value| value.is_finite()) {
            return f64::INFINITY;
        }
        let (left, right) = self.values[self.lower.len()..].split_at(k);
        for ((f, r), p) in self.ahead.iter_mut().zip(right).zip(left) {
            *f = r - p;
        }
        self.here.norm(&self.ahead)
    }

    /// Continues from `point`, and restores the values and the factors of M there.
    fn look_from(&mut self, point: &[f64], solver: &mut Solver) {
        let Iterate { point: w, residual, step, sizes, weights } = &mut self.here;
        let (mass, sides) = self.values.split_at(self.lower.len());
        let (left, right) = sides.split_at(w.len());
        w.copy_from_slice(point);
        weights.fill(1.0);
        for (s, (p, r)) in left.iter().zip(right).enumerate() {
            residual[s] = r - p;
            sizes[s] = r.abs() + p.abs();
        }
        for ((i, j), m) in self.lower.entries().zip(mass) {
            sizes[i] += (m * w[j]).abs();
            if i != j {
                sizes[j] += (m * w[i]).abs();
            } else if m.is_normal() {
                weights[i] = m.abs().sqrt().recip();
            }
        }
        step.copy_from_slice(residual);
        solver.solve(step);
    }

    fn failure(&self, iterations: usize) -> EvaluationFailure {
        let residual = self.here.residual.iter().copied().fold(0.0, f64::hypot);
        EvaluationFailure::NotSolved { residual, iterations }
    }
}

impl Iterate {
    /// max |F_s|/√|M_ss|
    fn norm(&self, components: &[f64]) -> f64 {
        components.iter().zip(&self.weights).fold(0.0, |norm, (f, weight)| norm.max((f * weight).abs()))
    }

    /// The largest component of F relative to its terms, max |F_s|/size_s; components whose terms are all 0 do
    /// not count.
    fn relative(&self, components: &[f64]) -> f64 {
        components.iter().zip(&self.sizes).fold(0.0, |most, (f, size)| most.max(f.abs() / size))
    }
}
