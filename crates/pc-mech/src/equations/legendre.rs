//! The conversion of quasi-velocities to momenta and back: y = ∂L/∂η.

use pc_algebra::{Matrix, Quadratic, quadratic};
use pc_expr::Expr;

use crate::error::MechError;
use crate::system::system::System;

/// The Legendre transform of L.
#[derive(Clone, Debug)]
pub(crate) struct Legendre<'g> {
    /// The k × k matrix M = ∂²L/∂η∂η, in terms of (t, x) if L is quadratic, and of (t, x, η) otherwise.
    pub(crate) mass: Matrix<Expr<'g>>,
    /// ∂L/∂η in (t, x, η), length k.
    pub(crate) momenta: Vec<Expr<'g>>,
    pub(crate) inverse: Inverse<'g>,
}

/// The way in which y = ∂L/∂η is solved for η.
#[derive(Clone, Debug)]
pub(crate) enum Inverse<'g> {
    /// By M η = y − p_0, for L = ½ M_rs η_r η_s + p_0s η_s + L_0.
    Closed {
        /// p_0
        momenta_at_rest: Vec<Expr<'g>>,
        /// L_0
        lagrangian_at_rest: Expr<'g>,
    },
    /// By numerical iteration.
    Implicit {
        /// A quasi-velocity in which L is not quadratic.
        quasi_velocity: Expr<'g>,
        /// The η from which the iteration starts.
        guess: Vec<f64>,
    },
}

impl<'g> Legendre<'g> {
    /// # Errors
    /// [`LagrangianError::Degenerate`](crate::LagrangianError::Degenerate)
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

/// A quasi-velocity in which L is not quadratic.
pub(crate) fn not_quadratic_in<'g>(system: &System<'g>) -> Expr<'g> {
    let (graph, lagrangian, eta) = (system.graph(), system.lagrangian(), system.quasi_velocities());
    let alone = eta.iter().find(|&&eta| quadratic(graph, lagrangian, &[eta]).is_none());
    let curvatures: Vec<Expr<'g>> = system.momenta().iter().flat_map(|&p| graph.gradient(p, eta)).collect();
    let moving = || eta.iter().find(|&&eta| curvatures.iter().any(|m| m.depends_on(eta)));
    alone.or_else(moving).or(eta.first()).copied().unwrap_or(lagrangian)
}
