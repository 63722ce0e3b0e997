//! Generalised forces.

use crate::derivation::derivation::Derivation;
use crate::derivation::place::{Place, Virtual};
use crate::error::Irregular;
use crate::numbers::balance::Balance;
use crate::numbers::rounding::Rounding;
use crate::text::text::{Forced, Velocities};

impl Derivation {
    /// The components of Q along virtual velocities, Q_s for a unit w_s. These components come from forces on
    /// coordinates and quasi-velocities, from dissipation −∂R/∂w_s, and from forces and torques on bodies
    /// (8).
    pub(crate) fn forces(
        &self,
        at: &Place,
        along: &[Virtual],
        rounding: &Rounding,
    ) -> Result<Vec<Balance>, Irregular> {
        let text = &self.text;
        let still = self.still(at, rounding);
        let mut forces = vec![Balance::default(); along.len()];
        for (on, force) in &text.forces {
            let value = still.value(force)?;
            match (*on, &text.velocities) {
                (Forced::Coordinate(i), _) => {
                    forces.iter_mut().zip(along).for_each(|(sum, along)| sum.add(value * along.x[i]));
                }
                (Forced::QuasiVelocity(s), Velocities::Quasi(_)) => {
                    forces.iter_mut().zip(along).for_each(|(sum, along)| sum.add(value * along.w.w[s]));
                }
                (Forced::QuasiVelocity(q), Velocities::Ordinary(definitions)) => {
                    for (sum, along) in forces.iter_mut().zip(along) {
                        let point = self.once(at, &along.w, rounding);
                        sum.add(value * point.value(&definitions[q])?.eps);
                    }
                }
            }
        }
        for (sum, along) in forces.iter_mut().zip(along) {
            let varied = self.once(at, &along.w, rounding);
            let displaced = self.once(at, &at.along(along.x.clone()), rounding);
            if let Some(dissipation) = &text.dissipation {
                sum.add(-varied.value(dissipation)?.eps);
            }
            for body in &text.bodies {
                for (i, force) in still.all(&body.force)?.iter().enumerate() {
                    if body.force_functions[i] == 0.0 {
                        sum.add(force * displaced.value(&body.position[i])?.eps);
                    }
                }
                if !body.torque.is_empty() {
                    let turned = varied.angular_velocity(body)?;
                    still.all(&body.torque)?.iter().zip(turned).for_each(|(n, omega)| sum.add(n * omega.eps));
                }
            }
        }
        Ok(forces)
    }
}
