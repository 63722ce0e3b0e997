//! From quasi-velocities to momenta and back: y = ∂L/∂η.

use pc_algebra::Matrix;
use pc_expr::Expr;

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
