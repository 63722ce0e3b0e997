//! From quasi-velocities to momenta and back: y = ∂L/∂η.

use pc_algebra::{Matrix, Quadratic, quadratic};
use pc_expr::{Backend, Evaluator, Expr, Inputs, Program};

use crate::canonical::Canonical;
use crate::compiled::fault::{Fault, check_finite};
use crate::compiled::implicit::Newton;
use crate::compiled::solver::Solver;
use crate::error::MechError;
use crate::stability::steady::check_length;
use crate::system::System;

/// The Legendre transform of L.
#[derive(Clone, Debug)]
pub(crate) struct Legendre<'g> {
    /// M = ∂²L/∂η∂η, k × k, in (t, x) if L is quadratic, else in (t, x, η).
    pub(crate) mass: Matrix<Expr<'g>>,
    /// ∂L/∂η in (t, x, η), length k.
    pub(crate) momenta: Vec<Expr<'g>>,
    pub(crate) inverse: Inverse<'g>,
}

/// How y = ∂L/∂η is solved for η.
#[derive(Clone, Debug)]
pub(crate) enum Inverse<'g> {
    /// Of L = ½ M_rs η_r η_s + p_0s η_s + L_0, from M η = y − p_0.
    Closed {
        /// p_0
        momenta_at_rest: Vec<Expr<'g>>,
        /// L_0
        lagrangian_at_rest: Expr<'g>,
    },
    /// In numbers.
    Implicit {
        /// An η in which L is not quadratic.
        quasi_velocity: Expr<'g>,
        /// The η from which the solution is looked for.
        guess: Vec<f64>,
    },
}

impl<'g> Legendre<'g> {
    /// # Errors
    /// [`MechError::DegenerateLagrangian`]
    pub(crate) fn of(system: &System<'g>) -> Result<Legendre<'g>, MechError> {
        let graph = system.graph();
        let (eta, lagrangian) = (system.quasi_velocities(), system.lagrangian());
        let (k, order) = (eta.len(), system.collecting_order());
        let momenta = system.momenta();
        let short = |expressions: &[Expr<'g>]| graph.shorten(expressions, &order);
        let (entries, inverse) = match quadratic(graph, lagrangian, eta) {
            Some(Quadratic { matrix, linear, constant }) => {
                let (momenta_at_rest, lagrangian_at_rest) = (short(&linear), short(&[constant])[0]);
                (matrix.entries().to_vec(), Inverse::Closed { momenta_at_rest, lagrangian_at_rest })
            }
            None => {
                let hessian = momenta.iter().flat_map(|&p| graph.gradient(p, eta)).collect();
                let quasi_velocity = not_quadratic_in(system);
                (hessian, Inverse::Implicit { quasi_velocity, guess: vec![0.0; k] })
            }
        };
        let entries = short(&entries);
        let mass = Matrix::from_fn(k, k, |r, s| entries[r.max(s) * k + r.min(s)]);
        system.check_regular(&mass)?;
        Ok(Legendre { mass, momenta: short(&momenta), inverse })
    }
}

/// A quasi-velocity that stands in L otherwise than in squares and products of two.
pub(crate) fn not_quadratic_in<'g>(system: &System<'g>) -> Expr<'g> {
    let (graph, lagrangian, eta) = (system.graph(), system.lagrangian(), system.quasi_velocities());
    let alone = eta.iter().find(|&&eta| quadratic(graph, lagrangian, &[eta]).is_none());
    let curvatures: Vec<Expr<'g>> = system.momenta().iter().flat_map(|&p| graph.gradient(p, eta)).collect();
    let moving = || eta.iter().find(|&&eta| curvatures.iter().any(|m| m.depends_on(eta)));
    alone.or_else(moving).or(eta.first()).copied().unwrap_or(lagrangian)
}

/// States (x, η) and (x, y) of one system turned into each other, y_s = ∂L/∂η_s and η_s = ∂H/∂y_s (Legendre); compiled.
#[derive(Clone, Debug)]
pub struct LegendreTransform {
    /// Names of x, η, y.
    names: [Vec<String>; 3],
    parameters: Vec<f64>,
    momenta: Evaluator,
    quasi_velocities: QuasiVelocities,
}

/// η of (x, y)
#[derive(Clone, Debug)]
enum QuasiVelocities {
    Closed(Evaluator),
    Implicit(Box<(Newton, Solver)>),
}

impl Canonical<'_> {
    /// Compiles the change between quasi-velocities and momenta.
    ///
    /// # Errors
    /// [`ExprError::UnboundSymbol`](pc_expr::ExprError::UnboundSymbol) for a symbol that is neither state nor
    /// declared parameter.
    pub fn legendre_transform(&self) -> Result<LegendreTransform, MechError> {
        let system = self.system();
        let (x, graph) = (system.frame().coordinates(), system.graph());
        let program = |moving: &[Expr<'_>], values: &[Expr<'_>]| -> Result<Evaluator, MechError> {
            let inputs = Inputs {
                time: Some(system.frame().time()),
                state: x.iter().chain(moving).copied().collect(),
                parameters: system.parameters().iter().map(|&(symbol, _)| symbol).collect(),
            };
            Ok(Evaluator::new(Program::new(graph, &inputs, values)?, Backend::Interpreter))
        };
        let equations = self.first_order();
        let quasi_velocities = match &equations.implicit {
            None => QuasiVelocities::Closed(program(self.momenta(), self.quasi_velocities())?),
            Some(implicit) => {
                let newton = Newton::new(&equations, implicit, Backend::Interpreter)?;
                QuasiVelocities::Implicit(Box::new((newton, Solver::new(self.momenta().len(), 0))))
            }
        };
        Ok(LegendreTransform {
            names: [x, system.quasi_velocities(), self.momenta()]
                .map(|symbols| symbols.iter().map(Expr::to_string).collect()),
            parameters: system.parameters().iter().map(|&(_, value)| value).collect(),
            momenta: program(system.quasi_velocities(), self.momenta_of_velocities())?,
            quasi_velocities,
        })
    }
}

impl LegendreTransform {
    /// The values of the parameters, to be changed.
    pub fn parameters_mut(&mut self) -> &mut [f64] {
        &mut self.parameters
    }

    /// (x, y) of the state (x, η), length n + k both.
    ///
    /// # Errors
    /// [`MechError::Shape`]; [`ExprError::NotFinite`](pc_expr::ExprError::NotFinite) outside the domain of
    /// ∂L/∂η.
    pub fn to_momenta(&mut self, t: f64, state: &[f64]) -> Result<Vec<f64>, MechError> {
        let mut result = self.checked(state)?;
        let moving = &mut result[self.names[0].len()..];
        evaluate(&mut self.momenta, (t, state, &self.parameters), moving)
            .map_err(|fault| self.error(fault, t, state))?;
        Ok(result)
    }

    /// (x, η) of the state (x, y), length n + k both. Where L is not quadratic, Newton's method finds it from
    /// the [guess](Canonical::with_guess).
    ///
    /// # Errors
    /// [`MechError::Shape`]; [`MechError::LegendreNotSolved`], [`MechError::SingularMassMatrix`] or
    /// [`ExprError::NotFinite`](pc_expr::ExprError::NotFinite) where no η is found.
    pub fn to_quasi_velocities(&mut self, t: f64, state: &[f64]) -> Result<Vec<f64>, MechError> {
        let mut result = self.checked(state)?;
        let moving = &mut result[self.names[0].len()..];
        let outcome = match &mut self.quasi_velocities {
            QuasiVelocities::Closed(program) => evaluate(program, (t, state, &self.parameters), moving),
            QuasiVelocities::Implicit(solver) => {
                let (newton, factors) = &mut **solver;
                let mut known = [state, moving].concat();
                let outcome = newton.solve(t, &mut known, &self.parameters, factors);
                moving.copy_from_slice(&known[state.len()..]);
                outcome
            }
        };
        outcome.map_err(|fault| self.error(fault, t, state))?;
        Ok(result)
    }

    /// The state, if it has the right length.
    fn checked(&self, state: &[f64]) -> Result<Vec<f64>, MechError> {
        check_length("the state", state, self.names[0].len() + self.names[1].len())?;
        Ok(state.to_vec())
    }

    /// At the state (x, y).
    fn error(&self, fault: Fault, t: f64, state: &[f64]) -> MechError {
        let [x, eta, y] = &self.names;
        fault.at(eta, t, &[&x[..], y].concat(), state)
    }
}

fn evaluate(
    program: &mut Evaluator,
    (t, state, parameters): (f64, &[f64], &[f64]),
    values: &mut [f64],
) -> Result<(), Fault> {
    program.eval(t, state, parameters, values);
    check_finite(values, program, (t, state, parameters))
}
