//! Bodies on joints, in the form that `pc_mech` accepts, and their named points.

use std::collections::HashMap;
use std::f64::consts::FRAC_PI_2;

use pc_mech::{Expr, Joint, Matrix, TreeBody};

use crate::diagnostics::error::ModelError;
use crate::document::tree::ROUNDING;
use crate::document::{self, Expression, Following, JointKind, JointRotation};
use crate::names::scope::Scope;
use crate::names::stage::Stage;

impl<'g> Scope<'g, '_> {
    /// Whether `name` is a component of a point.
    pub(super) fn is_point(&self, name: &str) -> bool {
        self.document.points.iter().any(|point| point.component(name).is_some())
    }

    /// A component of a point, as a function of the coordinates.
    pub(crate) fn point(&mut self, name: &str) -> Result<Expr<'g>, ModelError> {
        let points = match self.points.take() {
            Some(points) => points,
            None => self.all_points()?,
        };
        let value = points.get(name).copied().unwrap_or(Expr::ZERO); // the point exists
        self.points = Some(points);
        Ok(value)
    }

    fn all_points(&mut self) -> Result<HashMap<String, Expr<'g>>, ModelError> {
        let document = self.document;
        let tree = self.kinematic_tree()?;
        let motions = tree.motions();
        let mut points = HashMap::new();
        for point in &document.points {
            let mut at = [Expr::ZERO; 3];
            for (value, part) in at.iter_mut().zip(point.at.iter().flatten()) {
                *value = self.resolve(part, Stage::Joint)?;
            }
            let unit = || Matrix::from_fn(3, 3, |i, j| if i == j { Expr::ONE } else { Expr::ZERO });
            let (origin, rotation) = match point.body() {
                None => ([Expr::ZERO; 3], unit()),
                Some(body) => (
                    motions.place(body).unwrap_or([Expr::ZERO; 3]), // bodies of points are in the tree
                    motions.rotation(body).unwrap_or_else(unit),
                ),
            };
            let place = |i: usize| {
                let arm = self.graph.dot((0..3).map(|j| rotation[(i, j)]), at.iter().copied());
                origin[i] + arm
            };
            let rotation = (0..9).map(|ij| rotation[(ij / 3, ij % 3)]);
            let values = (0..3).map(place).chain(rotation);
            points.extend(point.components.iter().map(|name| name.text.clone()).zip(values));
        }
        Ok(points)
    }

    /// A joint with its constants resolved.
    pub(crate) fn joint(&mut self, joint: &document::Joint) -> Result<Joint<'g>, ModelError> {
        let made = match (joint.kind, joint.axes.as_slice()) {
            (JointKind::Revolute, &[axis]) => Joint::revolute(axis),
            (JointKind::Prismatic, &[axis]) => Joint::prismatic(axis),
            (JointKind::Screw, &[axis]) => {
                let pitch =
                    joint.pitch.as_ref().map(|pitch| self.resolve(pitch, Stage::Joint)).transpose()?;
                Joint::screw(axis, pitch.unwrap_or(Expr::ZERO))
            }
            (JointKind::Cylindrical, &[axis]) => Joint::cylindrical(axis),
            (JointKind::Universal, &[first, second]) => Joint::universal(first, second),
            (JointKind::Planar, &[normal]) => Joint::planar(normal),
            (JointKind::Spherical, _) => Joint::spherical(),
            (JointKind::Free, _) => Joint::free(),
            _ => Joint::fixed(),
        };
        let named = |names: &[document::Name]| names.iter().map(|name| name.text.clone()).collect::<Vec<_>>();
        let made = made.named(named(&joint.coordinates), named(&joint.quasi_velocities));
        let made = match &joint.follows {
            Some(Following { body, ratio, offset, .. }) => {
                let mut constant = |part: &Option<Expression>| {
                    part.as_ref().map(|part| self.resolve(part, Stage::Joint)).transpose()
                };
                let (ratio, offset) = (constant(ratio)?, constant(offset)?);
                made.following(&body.value, ratio.unwrap_or(Expr::ONE), offset.unwrap_or(Expr::ZERO))
            }
            None => made,
        };
        let made = self.driven(joint, made)?;
        let made = match &joint.at {
            Some(at) => made.at(self.constants(at)?),
            None => made,
        };
        Ok(match &joint.rotation {
            None => made,
            Some(rotation) => made.rotated(&self.constant_rotation(rotation)?),
        })
    }

    /// The joint with its rotor, spring, damper, friction and stops.
    fn driven(&mut self, joint: &document::Joint, made: Joint<'g>) -> Result<Joint<'g>, ModelError> {
        let document::Drive { armature, stiffness, rest, damping, friction, stiction, .. } = &joint.drive;
        let mut constant = |part: &Option<Expression>| -> Result<Option<Expr<'g>>, ModelError> {
            part.as_ref().map(|part| self.resolve(part, Stage::Joint)).transpose()
        };
        let mut made = made;
        if let Some(armature) = constant(armature)? {
            made = made.armature(armature);
        }
        if let Some(stiffness) = constant(stiffness)? {
            made = made.spring(stiffness, constant(rest)?.unwrap_or(Expr::ZERO));
        }
        if let Some(damping) = constant(damping)? {
            made = made.damping(damping);
        }
        if let Some(friction) = constant(friction)? {
            made = made.friction(friction);
        }
        if let Some(stiction) = constant(stiction)? {
            made = made.stiction(stiction);
        }
        if let Some([lower, upper]) = &joint.drive.limits {
            let ends = [self.resolve(lower, Stage::Joint)?, self.resolve(upper, Stage::Joint)?];
            if joint.drive.restitution.is_some() {
                return Ok(made.ends(ends));
            }
            let mut number = |part: &Option<Expression>| -> Result<Expr<'g>, ModelError> {
                part.as_ref().map_or(Ok(Expr::ZERO), |part| self.resolve(part, Stage::Joint))
            };
            let stiffness = number(&joint.drive.stop_stiffness)?;
            made = made.limits(ends, stiffness, number(&joint.drive.stop_damping)?);
        }
        Ok(made)
    }

    fn constant_rotation(&mut self, rotation: &JointRotation) -> Result<Matrix<Expr<'g>>, ModelError> {
        match rotation {
            JointRotation::Matrix(entries) => {
                let entries = self.constants(entries)?.map(entry_of_rotation);
                Ok(Matrix::from_fn(3, 3, |i, j| entries[3 * i + j]))
            }
            JointRotation::Turns(turns) => {
                let mut all = Matrix::from_fn(3, 3, |i, j| if i == j { Expr::ONE } else { Expr::ZERO });
                for (axis, angle) in turns {
                    let angle = self.resolve(angle, Stage::Joint)?;
                    let turn = about(*axis, angle);
                    let graph = self.graph;
                    all = Matrix::from_fn(3, 3, |i, j| {
                        graph.dot((0..3).map(|l| all[(i, l)]), (0..3).map(|l| turn[(l, j)]))
                    });
                }
                Ok(all)
            }
        }
    }

    /// The expressions resolved as functions of parameters.
    pub(crate) fn constants<const N: usize>(
        &mut self,
        list: &[Expression; N],
    ) -> Result<[Expr<'g>; N], ModelError> {
        let mut values = [Expr::ZERO; N];
        for (value, expression) in values.iter_mut().zip(list) {
            *value = self.resolve(expression, Stage::Joint)?;
        }
        Ok(values)
    }
}

/// A body of the tree, on its joint.
pub(crate) fn hung<'g>(body: &document::TreeBody, joint: Joint<'g>) -> TreeBody<'g> {
    let hung = TreeBody::new(&body.name.text, joint);
    match body.parent() {
        Some(parent) => hung.on(parent),
        None => hung,
    }
}

/// The rotation by an angle about the axis with index `axis`, exact for quarter turns.
fn about<'g>(axis: usize, angle: Expr<'g>) -> Matrix<Expr<'g>> {
    let (cos, sin) = match angle.constant().and_then(|angle| quarters(angle.to_f64())) {
        None => (angle.cos(), angle.sin()),
        Some(0) => (Expr::ONE, Expr::ZERO),
        Some(1) => (Expr::ZERO, Expr::ONE),
        Some(2) => (-Expr::ONE, Expr::ZERO),
        Some(_) => (Expr::ZERO, -Expr::ONE),
    };
    let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
    Matrix::from_fn(3, 3, |i, j| match (i, j) {
        (i, j) if i == j => {
            if i == axis {
                Expr::ONE
            } else {
                cos
            }
        }
        (i, j) if (i, j) == (next, last) => -sin,
        (i, j) if (i, j) == (last, next) => sin,
        _ => Expr::ZERO,
    })
}

/// An entry of a rotation matrix, made exact if it is 0 or ±1 up to rounding error, as it is for quarter
/// turns.
fn entry_of_rotation(entry: Expr<'_>) -> Expr<'_> {
    let near = |entry: f64| [0, 1, -1].into_iter().find(|&unit| (entry - f64::from(unit)).abs() <= ROUNDING);
    entry.constant().and_then(|value| near(value.to_f64())).map_or(entry, Expr::from)
}

/// The number of quarter turns in an angle, 0 to 3, if the angle is a multiple of a quarter turn up to
/// rounding error: the sine of a rounded π is not 0.
fn quarters(angle: f64) -> Option<u8> {
    let count = (angle / FRAC_PI_2).round();
    let is_some = (angle - count * FRAC_PI_2).abs() <= 4.0 * f64::EPSILON * angle.abs() && count.abs() < 1e3;
    is_some.then(|| count.rem_euclid(4.0) as u8)
}
