//! The numerical conversion of quasi-velocities to momenta and back: y = ∂L/∂η.

use std::ops::Range;

use pc_expr::{Backend, Evaluator, Expr, ExprError, Inputs, Pattern, Program};
use serde::{Deserialize, Serialize};

use crate::compiled::elimination::solver::Solver;
use crate::compiled::failure::{EvaluationFailure, check_finite};
use crate::compiled::first_order::FirstOrder;
use crate::compiled::implicit::Newton;
use crate::compiled::point::Point;
use crate::error::{MechError, shape};
use crate::system::system::System;

/// The compiled conversion between states (x, η) and (x, y) of one system, by y_s = ∂L/∂η_s and η_s = ∂H/∂y_s
/// (Legendre).
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct LegendreTransform {
    /// Names of x, η, y, z.
    names: [Vec<String>; 4],
    /// Names of the unknowns: η, then the constraints.
    unknowns: Vec<String>,
    parameters: Vec<f64>,
    momenta: Evaluator,
    quasi_velocities: QuasiVelocities,
}

/// How η is determined by (x, y).
#[derive(Clone, Debug, Serialize, Deserialize)]
enum QuasiVelocities {
    Closed(Evaluator),
    Linear(Box<Linear>),
    Implicit(Box<Implicit>),
}

/// The solution of p(w) = r with w = (η, μ), by Newton's method.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Implicit {
    newton: Newton,
    solver: Solver,
    /// Equations for η alone, whose solution is the starting point.
    nearby: Option<Box<QuasiVelocities>>,
    /// The starting point if the equations for η alone have no solution.
    guess: Vec<f64>,
    /// Storage for the starting point, and for the state and w.
    begin: Vec<f64>,
    known: Vec<f64>,
}

/// The numerical solution of M w = r with w = (η, μ).
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Linear {
    /// Computes, from (t, (x, y)), the nonzero entries of the lower triangle of M, then r.
    equations: Evaluator,
    lower: Pattern,
    values: Vec<f64>,
    solver: Solver,
    /// w
    solution: Vec<f64>,
}

impl QuasiVelocities {
    /// Compiles the numerical solution of these equations, whose first unknowns are η. For nonlinear equations
    /// the iteration starts from the solution of the equations `nearby`, since several velocities may satisfy
    /// the constraints, as ±1 do for v² = 1.
    fn solved(
        equations: &FirstOrder<'_>,
        nearby: Option<&FirstOrder<'_>>,
    ) -> Result<QuasiVelocities, ExprError> {
        let Some(implicit) = &equations.implicit else {
            return Ok(QuasiVelocities::Linear(Box::new(Linear::new(equations)?)));
        };
        let size = equations.unknowns.len();
        Ok(QuasiVelocities::Implicit(Box::new(Implicit {
            newton: Newton::new(equations, implicit, Backend::Interpreter)?,
            solver: Solver::new(size, equations.multipliers),
            nearby: nearby.map(|nearby| QuasiVelocities::solved(nearby, None).map(Box::new)).transpose()?,
            guess: implicit.guess.clone(),
            begin: vec![0.0; size],
            known: vec![0.0; equations.state.len() + size],
        })))
    }

    /// Writes η.
    fn solve(&mut self, at: Point<'_>, eta: &mut [f64]) -> Result<(), EvaluationFailure> {
        match self {
            QuasiVelocities::Closed(program) => evaluate(program, at, eta),
            QuasiVelocities::Linear(linear) => {
                linear.solve(at)?;
                eta.copy_from_slice(&linear.solution[..eta.len()]);
                Ok(())
            }
            QuasiVelocities::Implicit(implicit) => implicit.solve(at, eta),
        }
    }
}

impl Implicit {
    /// Writes η.
    fn solve(
        &mut self,
        at @ Point { t, y: state, p }: Point<'_>,
        eta: &mut [f64],
    ) -> Result<(), EvaluationFailure> {
        let guess = &mut self.begin;
        guess.fill(0.0);
        guess[..self.guess.len()].copy_from_slice(&self.guess);
        if let Some(nearby) = &mut self.nearby {
            let found = nearby.solve(at, eta);
            if found.is_ok() {
                guess[..eta.len()].copy_from_slice(eta);
                guess[eta.len()..].fill(0.0);
            }
        }
        self.newton.begin_at(guess);
        let (given, unknowns) = self.known.split_at_mut(state.len());
        given.copy_from_slice(state);
        unknowns.fill(0.0);
        let outcome = self.newton.solve(t, &mut self.known, p, &mut self.solver);
        eta.copy_from_slice(&self.known[state.len()..state.len() + eta.len()]);
        outcome
    }
}

impl Linear {
    fn new(equations: &FirstOrder<'_>) -> Result<Linear, ExprError> {
        let (lower, mut entries) = equations.lower_triangle();
        entries.extend(&equations.right);
        let program = Program::new(equations.graph, &equations.inputs(&[]), &entries)?;
        let solver = Solver::new(equations.unknowns.len(), equations.multipliers);
        let (values, solution) = (vec![0.0; entries.len()], vec![0.0; equations.unknowns.len()]);
        let equations = Evaluator::new(program, Backend::Interpreter);
        Ok(Linear { equations, lower, values, solver, solution })
    }

    /// Computes w into `solution`, and factorises M.
    fn solve(&mut self, at @ Point { t, y: state, p }: Point<'_>) -> Result<(), EvaluationFailure> {
        self.equations.eval(t, state, p, &mut self.values);
        check_finite(&self.values, &self.equations, at)?;
        let (matrix, right) = self.values.split_at(self.lower.len());
        self.solver.factorise(&self.lower, matrix)?;
        self.solution.copy_from_slice(right);
        self.solver.solve(&mut self.solution);
        Ok(())
    }
}

impl LegendreTransform {
    /// The conversion for `system`, with `momenta` y and ∂L/∂η = `of_velocities`; η consists of the unknowns
    /// of `equations`, or, where the equations are linear, of the expressions `closed`.
    ///
    /// # Errors
    /// As for [`Canonical::legendre_transform`](crate::Canonical::legendre_transform).
    pub(crate) fn unconstrained<'g>(
        system: &System<'g>,
        momenta: &[Expr<'g>],
        of_velocities: &[Expr<'g>],
        equations: &FirstOrder<'g>,
        closed: &[Expr<'g>],
    ) -> Result<LegendreTransform, MechError> {
        let quasi_velocities = match &equations.implicit {
            None => {
                let program = Program::new(equations.graph, &equations.inputs(&[]), closed)?;
                QuasiVelocities::Closed(Evaluator::new(program, Backend::Interpreter))
            }
            Some(_) => QuasiVelocities::solved(equations, None)?,
        };
        LegendreTransform::new(system, momenta, of_velocities, quasi_velocities)
    }

    /// The conversion for `system`, whose momenta are called `momenta`; η consists of the first unknowns of
    /// `equations`, whose variables are (t, x, y). If the equations are not linear, η is the solution nearest
    /// to the solution of the linear equations `nearby`.
    ///
    /// # Errors
    /// As for [`Canonical::legendre_transform`](crate::Canonical::legendre_transform).
    pub(crate) fn solving<'g>(
        system: &System<'g>,
        momenta: &[Expr<'g>],
        equations: &FirstOrder<'g>,
        nearby: Option<&FirstOrder<'g>>,
    ) -> Result<LegendreTransform, MechError> {
        let solved = QuasiVelocities::solved(equations, nearby)?;
        let transform = LegendreTransform::new(system, momenta, &system.momenta(), solved)?;
        Ok(LegendreTransform { unknowns: equations.names.clone(), ..transform })
    }

    fn new<'g>(
        system: &System<'g>,
        symbols: &[Expr<'g>],
        momenta: &[Expr<'g>],
        quasi_velocities: QuasiVelocities,
    ) -> Result<LegendreTransform, MechError> {
        let (x, eta) = (system.frame().coordinates(), system.quasi_velocities());
        let states: Vec<Expr<'g>> = system.states().iter().map(|&(z, _)| z).collect();
        let inputs = Inputs {
            time: Some(system.frame().time()),
            state: system.state(),
            parameters: system.parameters().iter().map(|&(symbol, _)| symbol).collect(),
        };
        let momenta = Program::new(system.graph(), &inputs, momenta)?;
        Ok(LegendreTransform {
            unknowns: eta.iter().map(Expr::to_string).collect(),
            names: [x, eta, symbols, &states].map(|symbols| symbols.iter().map(Expr::to_string).collect()),
            parameters: system.parameters().iter().map(|&(_, value)| value).collect(),
            momenta: Evaluator::new(momenta, Backend::Interpreter),
            quasi_velocities,
        })
    }

    /// Replaces each of the columns, with one entry per equation for η, by the solution of the linear equations
    /// with the matrix M = ∂²L/∂η∂η, bordered by the constraints if there are any, at the state last converted
    /// to quasi-velocities. Closed expressions have no such matrix.
    pub(crate) fn solve_last(&mut self, columns: &mut [f64]) {
        match &mut self.quasi_velocities {
            QuasiVelocities::Closed(_) => columns.fill(f64::NAN),
            QuasiVelocities::Linear(linear) => linear.solver.solve(columns),
            QuasiVelocities::Implicit(implicit) => implicit.solver.solve(columns),
        }
    }

    /// Mutable access to the values of the parameters.
    pub fn parameters_mut(&mut self) -> &mut [f64] {
        &mut self.parameters
    }

    /// The state (x, y) that corresponds to (x, η), both of length n + k; first-order states come last, unchanged.
    ///
    /// # Errors
    /// [`ShapeError`](crate::ShapeError); [`ExprError::NotFinite`](pc_expr::ExprError::NotFinite) outside the domain of
    /// ∂L/∂η.
    pub fn to_momenta(&mut self, t: f64, state: &[f64]) -> Result<Vec<f64>, MechError> {
        let mut result = state.to_vec();
        self.to_momenta_in(t, state, &mut result)?;
        Ok(result)
    }

    /// Writes the state (x, y) that corresponds to (x, η) to `result`, as
    /// [`to_momenta`](LegendreTransform::to_momenta) gives it.
    ///
    /// # Errors
    /// As there.
    pub fn to_momenta_in(&mut self, t: f64, state: &[f64], result: &mut [f64]) -> Result<(), MechError> {
        self.check(state, result)?;
        result.copy_from_slice(state);
        let moving = &mut result[self.moving()];
        evaluate(&mut self.momenta, Point { t, y: state, p: &self.parameters }, moving)
            .map_err(|failure| self.error(failure, t, state))
    }

    /// The state (x, η) that corresponds to (x, y), both of length n + k; first-order states come last, unchanged.
    /// Where L is not quadratic, Newton's method finds η from the [guess](crate::Canonical::with_guess).
    ///
    /// # Errors
    /// [`ShapeError`](crate::ShapeError);
    /// [`EvaluationError::LegendreNotSolved`](crate::EvaluationError::LegendreNotSolved),
    /// [`EvaluationError::SingularMassMatrix`](crate::EvaluationError::SingularMassMatrix) or
    /// [`ExprError::NotFinite`](pc_expr::ExprError::NotFinite) if no η is found.
    pub fn to_quasi_velocities(&mut self, t: f64, state: &[f64]) -> Result<Vec<f64>, MechError> {
        let mut result = state.to_vec();
        self.to_quasi_velocities_in(t, state, &mut result)?;
        Ok(result)
    }

    /// Writes the state (x, η) that corresponds to (x, y) to `result`, as
    /// [`to_quasi_velocities`](LegendreTransform::to_quasi_velocities) gives it.
    ///
    /// # Errors
    /// As there.
    pub fn to_quasi_velocities_in(
        &mut self,
        t: f64,
        state: &[f64],
        result: &mut [f64],
    ) -> Result<(), MechError> {
        self.check(state, result)?;
        result.copy_from_slice(state);
        let moving = &mut result[self.moving()];
        let outcome = self.quasi_velocities.solve(Point { t, y: state, p: &self.parameters }, moving);
        outcome.map_err(|failure| self.error(failure, t, state))
    }

    /// Checks the lengths of both states.
    fn check(&self, state: &[f64], result: &[f64]) -> Result<(), MechError> {
        let length = self.names[0].len() + self.names[1].len() + self.names[3].len();
        shape("the state", state.len(), length)?;
        Ok(shape("the result", result.len(), length)?)
    }

    /// The range of η, or y, in a state.
    fn moving(&self) -> Range<usize> {
        let n = self.names[0].len();
        n..n + self.names[1].len()
    }

    /// The error for a failure at the state (x, y).
    fn error(&self, failure: EvaluationFailure, t: f64, state: &[f64]) -> MechError {
        let [x, _, y, z] = &self.names;
        failure.at(&self.unknowns, t, &[&x[..], y, z].concat(), state)
    }
}

fn evaluate(
    program: &mut Evaluator,
    at @ Point { t, y, p }: Point<'_>,
    values: &mut [f64],
) -> Result<(), EvaluationFailure> {
    program.eval(t, y, p, values);
    check_finite(values, program, at)
}
