//! Rigid bodies.

use pc_algebra::{Frame, Matrix, Neighbourhood, affine, determinant};
use pc_expr::Expr;

use crate::error::{BodyError, MechError, shape};
use crate::system::bodies::moving::{Moving, Share};
use crate::system::bodies::particle::Particle;

/// A rigid body: its mass m, position r(t, x), inertia I, and rotation.
///
/// Its kinetic energy is ½ m |ṙ|² + ½ ω·Iω (König). That is correct if r is the **mass centre** and I is taken
/// about it, and also if r is any point of the body that is **at rest** (as the fixed point of a top) and I is
/// taken about that point. For any other point r the energy has the further term m ṙ·(ω × s), with s from r to
/// the mass centre, which is not supported: give the mass centre.
///
/// The angular velocity ω has components along axes in which I is constant, in general axes fixed in the body.
/// The angular velocity is derived from a [rotation](RigidBody::rotating), or is [given](RigidBody::turning).
///
/// A force F at r, along the axes of r, and a torque N, along the axes of ω, give
/// Q_s = F · X_s r + N · ∂ω/∂η_s (8).
///
/// ```
/// use pc_mech::{EulerAngles, Graph, LieGroup, RigidBody, System};
///
/// // Euler's angles and the angular velocity in body axes: ω = η.
/// let graph = Graph::new();
/// let [a, b, c, w1, w2, w3] = graph.symbols(["A", "B", "C", "ω1", "ω2", "ω3"]);
/// let angles = EulerAngles::about("zxz")?;
/// let x = graph.symbols(["ψ", "θ", "φ"]);
/// let top = System::builder(&graph)
///     .coordinates(["ψ", "θ", "φ"])
///     .quasi_velocities(["ω1", "ω2", "ω3"])
///     .frame(angles.left_frame(&graph, graph.symbol("t"), x.to_vec())?)
///     .rigid_body(|_, x, _| RigidBody::rotating(1, [0, 0, 0], [a, b, c], angles.rotation_matrix(x)))
///     .build()?;
/// let expected = (a * w1.square() + b * w2.square() + c * w3.square()) / 2.0;
/// assert_eq!(top.lagrangian(), expected);
/// # Ok::<(), pc_mech::MechError>(())
/// ```
#[derive(Clone, Debug)]
pub struct RigidBody<'g> {
    centre: Particle<'g>,
    inertia: Inertia<'g>,
    orientation: Orientation<'g>,
    torque: Option<[Expr<'g>; 3]>,
}

/// A symmetric inertia matrix.
///
/// The matrix is made from three principal moments `[Ixx, Iyy, Izz]`, or from six entries
/// `[Ixx, Iyy, Izz, Ixy, Iyz, Ixz]`. The six are the entries of the matrix, with their signs: Ixy = −∫ xy dm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertia<'g>([Expr<'g>; 6]);

impl<'g, E: Into<Expr<'g>>> From<[E; 3]> for Inertia<'g> {
    fn from(principal: [E; 3]) -> Inertia<'g> {
        let [x, y, z] = principal.map(Into::into);
        Inertia([x, y, z, Expr::ZERO, Expr::ZERO, Expr::ZERO])
    }
}

impl<'g, E: Into<Expr<'g>>> From<[E; 6]> for Inertia<'g> {
    fn from(entries: [E; 6]) -> Inertia<'g> {
        Inertia(entries.map(Into::into))
    }
}

impl<'g> Inertia<'g> {
    /// The matrix with `put` applied to each entry.
    pub(crate) fn map<'n>(&self, put: impl Fn(Expr<'g>) -> Expr<'n>) -> Inertia<'n> {
        Inertia(self.0.map(put))
    }

    /// I, 3 × 3.
    pub(crate) fn matrix(&self) -> Matrix<Expr<'g>> {
        let [xx, yy, zz, xy, yz, xz] = self.0;
        let rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        Matrix::from_fn(3, 3, |i, j| rows[i][j])
    }

    /// ω·Iω
    fn twice_the_energy(&self, omega: &[Expr<'g>]) -> Expr<'g> {
        let [xx, yy, zz, xy, yz, xz] = self.0;
        let [x, y, z] = [omega[0], omega[1], omega[2]];
        let mixed = xy * x * y + yz * y * z + xz * x * z;
        xx * x.square() + yy * y.square() + zz * z.square() + 2.0 * mixed
    }
}

#[derive(Clone, Debug)]
enum Orientation<'g> {
    /// The 3 × 3 matrix R from body axes to axes in space.
    Rotation(Matrix<Expr<'g>>),
    /// The angular velocity ω in terms of (t, x, η) or ẋ.
    AngularVelocity([Expr<'g>; 3]),
}

impl<'g> RigidBody<'g> {
    /// A body whose attitude is the 3 × 3 matrix R(t, x) from body axes to axes in space: ω̂ = RᵀṘ, along body axes.
    ///
    /// R may be a multiple of a rotation matrix, such as the |q|² R of a quaternion off the unit sphere: ω̂ is the
    /// antisymmetric part of RᵀṘ divided by ⅓ tr RᵀR, in which the factor cancels. Among the matrices of Lie groups
    /// in this crate, those of [`UnitQuaternions`](crate::UnitQuaternions) and [`EulerAngles`](crate::EulerAngles)
    /// are such multiples everywhere. A matrix of nine coordinates R_ij is a rotation only on SO(3), and gives a
    /// long expression for the energy: it is better to [give](RigidBody::turning) ω in terms of the
    /// quasi-velocities.
    pub fn rotating(
        mass: impl Into<Expr<'g>>,
        position: impl IntoIterator<Item = impl Into<Expr<'g>>>,
        inertia: impl Into<Inertia<'g>>,
        rotation: Matrix<Expr<'g>>,
    ) -> RigidBody<'g> {
        RigidBody {
            centre: Particle::new(mass, position),
            inertia: inertia.into(),
            orientation: Orientation::Rotation(rotation),
            torque: None,
        }
    }

    /// A body with the angular velocity ω, affine in η or in the velocities ẋ, which are the symbols `x'`.
    pub fn turning(
        mass: impl Into<Expr<'g>>,
        position: impl IntoIterator<Item = impl Into<Expr<'g>>>,
        inertia: impl Into<Inertia<'g>>,
        angular_velocity: [impl Into<Expr<'g>>; 3],
    ) -> RigidBody<'g> {
        RigidBody {
            centre: Particle::new(mass, position),
            inertia: inertia.into(),
            orientation: Orientation::AngularVelocity(angular_velocity.map(Into::into)),
            torque: None,
        }
    }

    /// The same body with the force F at its position, which has as many components as the position.
    #[must_use]
    pub fn force(self, force: impl IntoIterator<Item = impl Into<Expr<'g>>>) -> RigidBody<'g> {
        RigidBody { centre: self.centre.force(force), ..self }
    }

    /// The same body with the torque N about its position, along the axes of ω.
    #[must_use]
    pub fn torque(self, torque: [impl Into<Expr<'g>>; 3]) -> RigidBody<'g> {
        RigidBody { torque: Some(torque.map(Into::into)), ..self }
    }

    /// The same body with a name, under which its [reactions](crate::Multipliers::body_reactions) are listed.
    #[must_use]
    pub fn named(self, name: impl Into<String>) -> RigidBody<'g> {
        RigidBody { centre: self.centre.named(name), ..self }
    }

    /// U(t, x), the force function of its force; see [`Particle::force_function_of`](crate::Particle::force_function_of).
    ///
    /// # Errors
    /// As there.
    pub fn force_function_of(
        &self,
        frame: &Frame<'g>,
        quasi_velocities: &[Expr<'g>],
    ) -> Result<Expr<'g>, MechError> {
        self.centre.force_function_of(frame, quasi_velocities)
    }

    pub(crate) fn name(&self) -> Option<&str> {
        self.centre.name()
    }

    pub(crate) fn mass_and_position(&self) -> (Expr<'g>, &[Expr<'g>]) {
        self.centre.mass_and_position()
    }

    pub(crate) fn share(&self, moving: &Moving<'_, 'g>) -> Result<Share<'g>, MechError> {
        moving.check_at_rest("the inertia", &self.inertia.0)?;
        let Share { kinetic, mut forces, force_function, in_lagrangian, velocity, .. } =
            self.centre.share(moving)?;
        let turning = match &self.orientation {
            Orientation::Rotation(rotation) => angular_velocities(rotation, moving)?,
            Orientation::AngularVelocity(omega) => affine_parts(omega, moving)?,
        };
        let omega = moving.combine(&turning);
        let rotational = self.inertia.twice_the_energy(&omega) / 2.0;
        if let Some(torque) = &self.torque {
            let torque = moving.in_quasi_velocities(torque);
            for (force, turn) in forces.iter_mut().zip(moving.work(&torque, &turning)) {
                *force += turn;
            }
        }
        let (kinetic, angular_velocity) = (kinetic + rotational, Some(omega));
        Ok(Share { kinetic, forces, force_function, in_lagrangian, rotational, velocity, angular_velocity })
    }
}

/// The vectors ω_0..ω_k in ω = ω_0 + η_s ω_s, from the antisymmetric parts of Rᵀ X_s R.
fn angular_velocities<'g>(
    rotation: &Matrix<Expr<'g>>,
    moving: &Moving<'_, 'g>,
) -> Result<Vec<Vec<Expr<'g>>>, MechError> {
    shape("the list of rows of the rotation of a body", rotation.rows(), 3)?;
    shape("the list of columns of the rotation of a body", rotation.columns(), 3)?;
    let graph = moving.frame.graph();
    let entries = rotation.entries();
    let entries = entries.iter().copied();
    let size = graph.dot(entries.clone(), entries) / 3.0;
    let rates = moving.operators("the rotation", &rotation.entries())?;
    check_rotation(rotation, moving)?;
    let component = |rate: &[Expr<'g>], i: usize, j: usize| {
        graph.dot(rotation.column(i), (0..3).map(|row| rate[3 * row + j]))
    };
    let angular = |rate: Vec<Expr<'g>>| {
        let about = |i: usize, j: usize| (component(&rate, i, j) - component(&rate, j, i)) / (2.0 * size);
        vec![about(2, 1), about(0, 2), about(1, 0)]
    };
    Ok(rates.into_iter().map(angular).collect())
}

/// Checks that RᵀR is a multiple of the unit matrix and that R is not a reflection. Where n > k this may hold
/// only on the surface that contains the motion, which is unknown here.
fn check_rotation<'g>(rotation: &Matrix<Expr<'g>>, moving: &Moving<'_, 'g>) -> Result<(), MechError> {
    if moving.frame.coordinates().len() > moving.frame.operators() {
        return Ok(());
    }
    let graph = moving.frame.graph();
    let near = Neighbourhood::anywhere(graph, &rotation.entries());
    let products = |i: usize, j: usize| (0..3).map(move |row| rotation[(row, i)] * rotation[(row, j)]);
    for (i, j) in [(0, 1), (0, 2), (1, 2)] {
        let lengths: Vec<_> = products(i, i).chain(products(j, j).map(|square| -square)).collect();
        for terms in [products(i, j).collect(), lengths] {
            // Numbers such as cos 0.3 are rounded.
            let defect = graph.sum(terms.iter().copied());
            if near.residual(graph, &[terms]) > Neighbourhood::ROUNDING {
                return Err(
                    BodyError::NotARotation { columns: (i + 1, j + 1), defect: defect.to_string() }.into()
                );
            }
        }
    }
    let Some(determinant) = determinant(graph, rotation) else { return Ok(()) };
    // det R + |det R| = 0
    if near.residual(graph, &[vec![determinant, determinant.abs()]]) <= Neighbourhood::ROUNDING {
        let shown = near.largest(graph, &[determinant]);
        return Err(BodyError::Reflection { determinant: -shown }.into());
    }
    Ok(())
}

/// ω_0..ω_k with ω = ω_0 + η_s ω_s.
fn affine_parts<'g>(omega: &[Expr<'g>; 3], moving: &Moving<'_, 'g>) -> Result<Vec<Vec<Expr<'g>>>, MechError> {
    let (graph, eta) = (moving.frame.graph(), moving.eta);
    let mut parts = vec![Vec::new(); eta.len() + 1];
    for component in moving.in_quasi_velocities(omega) {
        let error =
            || MechError::Body(BodyError::AngularVelocityNotAffine { component: component.to_string() });
        let (slopes, rest) = affine(graph, component, eta).ok_or_else(error)?;
        parts.iter_mut().zip([rest].into_iter().chain(slopes)).for_each(|(part, value)| part.push(value));
    }
    Ok(parts)
}
