//! From quasi-velocities to momenta and back: y = ∂L/∂η.

use pc_algebra::Matrix;
use pc_expr::{Backend, Evaluator, Expr, Inputs, Program};

use crate::canonical::Canonical;
use crate::error::MechError;
use crate::system::System;

/// The Legendre transform of L = ½ M_rs η_r η_s + p_0s η_s + L_0: y = M η + p_0.
#[derive(Clone, Debug)]
pub(crate) struct Legendre<'g> {
    /// M, k × k.
    pub(crate) mass: Matrix<Expr<'g>>,
    /// The momenta p_0 at η = 0, length k.
    pub(crate) momenta_at_rest: Vec<Expr<'g>>,
    /// L_0
    pub(crate) lagrangian_at_rest: Expr<'g>,
}

impl<'g> Legendre<'g> {
    /// That of a system whose Lagrangian is quadratic in the quasi-velocities.
    pub(crate) fn of(system: &System<'g>) -> Result<Legendre<'g>, MechError> {
        let graph = system.graph();
        let eta = system.quasi_velocities();
        let momenta = system.momenta();
        let hessian: Vec<Vec<Expr<'g>>> = momenta.iter().map(|&p| graph.gradient(p, eta)).collect();
        if let Some(eta) = eta.iter().find(|&&eta| hessian.iter().flatten().any(|m| m.depends_on(eta))) {
            return Err(MechError::NotQuadratic { quasi_velocity: eta.to_string() });
        }
        let k = eta.len();
        let at_rest: Vec<_> = eta.iter().map(|&eta| (eta, Expr::ZERO)).collect();
        let order = system.collecting_order();
        let rest = |expressions: &[Expr<'g>]| graph.shorten(&graph.substitute(expressions, &at_rest), &order);
        let mass = rest(&hessian.concat());
        let mass = Matrix::from_fn(k, k, |r, s| mass[r.max(s) * k + r.min(s)]);
        system.check_regular(&mass)?;
        Ok(Legendre {
            mass,
            momenta_at_rest: rest(&momenta),
            lagrangian_at_rest: rest(&[system.lagrangian()])[0],
        })
    }

    /// M η = y − p_0
    pub(crate) fn impulse(&self, momenta: &[Expr<'g>]) -> Vec<Expr<'g>> {
        momenta.iter().zip(&self.momenta_at_rest).map(|(&y, &p)| y - p).collect()
    }
}

/// States (x, η) and (x, y) of one system turned into each other, y_s = ∂L/∂η_s; compiled.
///
/// Where the mass matrix is singular, what comes out is not finite.
#[derive(Clone, Debug)]
pub struct LegendreTransform {
    parameters: Vec<f64>,
    momenta: Evaluator,
    quasi_velocities: Evaluator,
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
            let outputs: Vec<Expr<'_>> = x.iter().chain(values).copied().collect();
            Ok(Evaluator::new(Program::new(graph, &inputs, &outputs)?, Backend::Interpreter))
        };
        Ok(LegendreTransform {
            parameters: system.parameters().iter().map(|&(_, value)| value).collect(),
            momenta: program(system.quasi_velocities(), &self.momenta_of_velocities())?,
            quasi_velocities: program(self.momenta(), self.quasi_velocities())?,
        })
    }
}

impl LegendreTransform {
    /// (x, y) of the state (x, η), length n + k both.
    ///
    /// # Panics
    /// If the state has another length.
    pub fn to_momenta(&mut self, t: f64, state: &[f64]) -> Vec<f64> {
        let mut result = vec![0.0; state.len()];
        self.momenta.eval(t, state, &self.parameters, &mut result);
        result
    }

    /// (x, η) of the state (x, y), length n + k both.
    ///
    /// # Panics
    /// If the state has another length.
    pub fn to_quasi_velocities(&mut self, t: f64, state: &[f64]) -> Vec<f64> {
        let mut result = vec![0.0; state.len()];
        self.quasi_velocities.eval(t, state, &self.parameters, &mut result);
        result
    }
}
