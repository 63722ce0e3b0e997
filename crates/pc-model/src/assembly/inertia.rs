//! Checks for joints whose motion no inertia resists.

use pc_mech::Expr;

use crate::assembly::assembly::Assembly;
use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::document::{Document, Joint, JointKind, TreeBody};

/// A velocity so large that the potential energy is small compared with the kinetic energy.
const FAST: f64 = 1e6;

/// The rounding error that is left where the kinetic energy vanishes, as a fraction of its terms.
const ROUNDING: f64 = 1e-12;

/// How a joint moves: along an axis or about it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    Slide,
    Turn,
}

impl<'g> Assembly<'g> {
    /// Checks that some inertia resists the motion of each joint by itself: ∂²L/∂η_s² vanishes, for example,
    /// if a body that turns about an axis is a point mass on that axis.
    ///
    /// Constraints may take the place of inertia, and so may a kinetic energy in `[lagrangian]`; models with
    /// either of these are not checked here.
    pub(crate) fn check_inertia(&self) -> Result<(), ModelError> {
        let document = &self.document;
        let is_given =
            document.lagrangian.as_ref().is_some_and(|own| own.kinetic.is_some() || own.lagrangian.is_some());
        if is_given || !document.constraints.is_empty() || self.system.large_tree().is_some() {
            return Ok(());
        }
        for body in document.tree.iter().filter(|body| !has_inertia(document, body)) {
            for (number, name) in body.joint.quasi_velocities.iter().enumerate() {
                let eta = self.system.quasi_velocities().iter().find(|eta| eta.to_string() == name.text);
                if eta.is_some_and(|&eta| self.is_free_of_inertia(eta)) {
                    return Err(document.error(&body.joint.place, fault(body, number)));
                }
            }
        }
        Ok(())
    }

    /// Whether L is the same at η_s = ±v and at η = 0, both at the start and near it.
    fn is_free_of_inertia(&self, eta: Expr<'g>) -> bool {
        let (system, coordinates) = (&self.system, self.system.frame().coordinates());
        let velocities = system.quasi_velocities();
        let lagrangian = |beside: f64, velocity: f64| {
            let value = |(y, start): (Expr<'g>, f64)| {
                let place = coordinates.iter().position(|&x| x == y);
                (
                    y,
                    match place {
                        Some(place) => start + beside * (1.0 + place as f64).sqrt(),
                        None if y == eta => velocity,
                        None if velocities.contains(&y) => 0.0,
                        None => start,
                    },
                )
            };
            let at: Vec<(Expr<'g>, f64)> =
                self.at_start().into_iter().chain(system.parameters().iter().copied()).map(value).collect();
            system.graph().evaluate(&[system.lagrangian()], &at).map_or(f64::NAN, |values| values[0])
        };
        [0.0, 0.3].into_iter().all(|beside| {
            let [back, rest, forth] = [-FAST, 0.0, FAST].map(|velocity| lagrangian(beside, velocity));
            let terms = back.abs() + 2.0 * rest.abs() + forth.abs();
            (back - 2.0 * rest + forth).abs() <= ROUNDING * terms
        })
    }
}

/// Whether a body, or any body that moves with it, has an `inertia`: bodies attached to it or whose joints follow
/// its joint, directly or through others.
fn has_inertia(document: &Document, body: &TreeBody) -> bool {
    let mut below = vec![body.name.text.as_str()];
    let mut seen = 0;
    while let Some(&name) = below.get(seen) {
        seen += 1;
        let own = document.tree.iter().find(|body| body.name.text == name);
        if own.is_some_and(|body| body.inertia.is_some()) {
            return true;
        }
        let follows = |body: &TreeBody| body.joint.follows.as_ref().is_some_and(|f| f.body.value == name);
        let moved = document.tree.iter().filter(|body| body.parent() == Some(name) || follows(body));
        let moved: Vec<&str> = moved.map(|body| body.name.text.as_str()).collect();
        below.extend(moved.into_iter().filter(|name| !below.contains(name)).collect::<Vec<_>>());
    }
    false
}

/// The error for quasi-velocity `number` of a joint.
fn fault(body: &TreeBody, number: usize) -> MeaningError {
    let (way, direction) = direction(&body.joint, number);
    let (body, kind) = (body.name.text.clone(), body.joint.kind.word());
    match way {
        Way::Turn => MeaningError::NoInertia { body, kind, direction },
        Way::Slide => MeaningError::NoMass { body, kind, direction },
    }
}

/// Whether quasi-velocity `number` slides or turns a body, and along or about which direction.
fn direction(joint: &Joint, number: usize) -> (Way, String) {
    let vector = |[x, y, z]: [f64; 3]| format!("({x}, {y}, {z})");
    let axis = |place: usize| joint.axes.get(place).map_or_else(String::new, |&axis| vector(axis));
    let own = |place: usize| vector(std::array::from_fn(|i| f64::from(u8::from(i == place))));
    match joint.kind {
        JointKind::Prismatic => (Way::Slide, format!("its axis {}", axis(0))),
        JointKind::Cylindrical if number == 0 => (Way::Slide, format!("its axis {}", axis(0))),
        JointKind::Fixed | JointKind::Revolute | JointKind::Screw | JointKind::Cylindrical => {
            (Way::Turn, format!("its axis {}", axis(0)))
        }
        JointKind::Universal => {
            (Way::Turn, format!("its {} axis {}", if number == 0 { "first" } else { "second" }, axis(number)))
        }
        JointKind::Planar if number < 2 => (Way::Slide, format!("its plane across {}", axis(0))),
        JointKind::Planar => (Way::Turn, format!("its normal {}", axis(0))),
        JointKind::Free if number < 3 => (Way::Slide, format!("the axis {} of the body", own(number))),
        JointKind::Spherical | JointKind::Free => {
            (Way::Turn, format!("the axis {} of the body", own(number % 3)))
        }
    }
}
