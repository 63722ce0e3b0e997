//! External forces, which the caller computes: opaque functions of time and state.

use pc_algebra::Frame;
use pc_expr::{Expr, Failure};

use crate::error::{ForceError, MechError};

/// Forces Q_s (8) on the quasi-velocities that were [declared](crate::SystemBuilder::external_force) to have an
/// external force.
///
/// Closures `FnMut(t, y, q)` that write all q implement this trait; a force that may fail, or whose derivatives
/// are known, needs a type of its own. The state y is the state of the motion: (x, η), or the coordinates and
/// momenta of the [canonical](crate::Canonical) equations.
pub trait ExternalForce {
    /// Writes the forces at (t, y) to `q`, one for each quasi-velocity declared, in the order of declaration.
    ///
    /// # Errors
    /// A [`Failure`], which is recoverable if an integrator should try a smaller step.
    fn force(&mut self, t: f64, y: &[f64], q: &mut [f64]) -> Result<(), Failure>;

    /// Writes the derivatives ∂q_i/∂y_j of the e forces to `dq[i + j * e]`; every entry has to be written.
    ///
    /// By default the derivatives are difference quotients (q(y + h_j e_j) − q(y))/h_j of the forces alone,
    /// with h_j = √ε max(1, |y_j|), ε the unit of rounding; the rest of the Jacobian stays exact.
    ///
    /// # Errors
    /// As for [`force`](ExternalForce::force).
    fn jacobian(&mut self, t: f64, y: &[f64], dq: &mut [f64]) -> Result<(), Failure> {
        difference_quotients(self, (t, y), dq, &mut Vec::new())
    }
}

/// Writes difference quotients of the forces at (t, y) to `dq`, as [`ExternalForce::jacobian`] does by default;
/// `room` is workspace.
///
/// # Errors
/// As for [`ExternalForce::force`].
pub fn difference_quotients<F: ExternalForce + ?Sized>(
    force: &mut F,
    (t, y): (f64, &[f64]),
    dq: &mut [f64],
    room: &mut Vec<f64>,
) -> Result<(), Failure> {
    let forces = dq.len().checked_div(y.len()).unwrap_or(0).max(1);
    room.clear();
    room.extend_from_slice(y);
    room.resize(y.len() + forces, f64::NAN);
    let (moved, here) = room.split_at_mut(y.len());
    force.force(t, y, here)?;
    for (j, column) in dq.chunks_exact_mut(forces).enumerate() {
        moved[j] = y[j] + f64::EPSILON.sqrt() * y[j].abs().max(1.0);
        let step = moved[j] - y[j];
        column.fill(f64::NAN);
        force.force(t, moved, column)?;
        moved[j] = y[j];
        column.iter_mut().zip(&*here).for_each(|(there, here)| *there = (*there - here) / step);
    }
    Ok(())
}

impl<F: FnMut(f64, &[f64], &mut [f64])> ExternalForce for F {
    fn force(&mut self, t: f64, y: &[f64], q: &mut [f64]) -> Result<(), Failure> {
        self(t, y, q);
        Ok(())
    }
}

/// The symbols of external forces on the quasi-velocities called `names`: `Q_` followed by the name.
///
/// # Errors
/// [`ForceError::NotAQuasiVelocity`].
pub(crate) fn symbols<'g>(
    names: &[String],
    frame: &Frame<'g>,
    eta: &[Expr<'g>],
    parameters: &[(Expr<'g>, f64)],
    states: &[(Expr<'g>, Expr<'g>)],
) -> Result<Vec<(String, Expr<'g>)>, MechError> {
    let known: Vec<String> = eta.iter().map(Expr::to_string).collect();
    let declared = frame.coordinates().iter().chain(eta).chain(parameters.iter().map(|(symbol, _)| symbol));
    let declared = declared.chain(states.iter().map(|(symbol, _)| symbol));
    let taken: Vec<String> = declared.map(Expr::to_string).collect();
    let symbol = |name: &String| {
        if !known.contains(name) {
            return Err(ForceError::NotAQuasiVelocity { name: name.clone(), known: known.clone() }.into());
        }
        let mut free = format!("Q_{name}");
        while taken.contains(&free) {
            free.insert_str(0, "Q_");
        }
        Ok((name.clone(), frame.graph().symbol(&free)))
    };
    names.iter().map(symbol).collect()
}
