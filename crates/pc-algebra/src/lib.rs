//! Frames of operators, their algebra [X_r, X_s] = c_rs^m X_m (5), and the groups behind it.
//!
//! Numbers in brackets are the equation numbers of V. V. Rumyantsev, *On Poincaré–Chetaev's equations* (1994),
//! with its misprints corrected. Index 0 is time; i, j count coordinates, r, s, m operators; repeated indices
//! are summed over.
//!
//! # Frame
//!
//! A mechanical system with coordinates x_1..x_n need not be described by the velocities ẋ. Quasi-velocities
//! η_1..η_k are affine in the velocities, η = a ẋ + a_0 (2); solved for ẋ,
//!
//! ẋ = b η + b_0 (3), where b is an n × k matrix, and all coefficients may depend on t and x.
//!
//! A [`Frame`] consists of b and b_0, and can be made [from velocities](Frame::from_velocities) (3) or [from
//! definitions](Frame::from_definitions) (2). If n > k it also represents constraints (1), which the motion ẋ =
//! b η + b_0 satisfies for every η.
//!
//! # Operators
//!
//! The columns of b are the operators X_s f = b_is ∂f/∂x_i and X_0 f = ∂f/∂t + b_i0 ∂f/∂x_i (4); the rate of
//! change of f along a motion is X_0 f + η_s X_s f. [`Frame::apply`] applies the operators to functions, and
//! [`Frame::commutator`] returns \[X_r, X_s\].
//!
//! # Structure coefficients and closure
//!
//! If the commutators are again combinations of the operators, \[X_r, X_s\] = c_rs^m X_m (5) with r, s from 0
//! and m from 1, the frame is closed and the c_rs^m are its [`StructureCoefficients`].
//! [`Frame::structure_coefficients`] finds them from the frame alone, in agreement with (6), and reports the
//! first pair whose commutator is not such a combination:
//!
//! ```
//! use pc_algebra::{EulerAngles, Frame, LieAlgebra, LieGroup, Neighbourhood};
//! use pc_expr::Graph;
//!
//! // Euler angles of a rigid body, quasi-velocities: body angular velocity. Their algebra is so(3).
//! let graph = Graph::new();
//! let [t, psi, theta, phi, w1, w2, w3] = graph.symbols(["t", "psi", "theta", "phi", "w1", "w2", "w3"]);
//! let across = w1 * phi.sin() + w2 * phi.cos();
//! let velocities = [across / theta.sin(), w1 * phi.cos() - w2 * phi.sin(), w3 - theta.cot() * across];
//! let frame = Frame::from_velocities(&graph, t, vec![psi, theta, phi], &[w1, w2, w3], &velocities)?;
//! let c = frame.structure_coefficients(&Neighbourhood::default())?;
//! assert_eq!(c.lie_algebra(), Some(LieAlgebra::so3()));
//!
//! // The same frame as the left-invariant one of a group.
//! let group = EulerAngles::about("zxz")?;
//! let invariant = group.left_frame(&graph, t, vec![psi, theta, phi])?;
//! assert_eq!(invariant.velocities(&[w1, w2, w3]), velocities);
//! # Ok::<(), pc_algebra::AlgebraError>(())
//! ```
//!
//! The c_rs^m answer three questions: are the constraints integrable ([`Frame::integrability`], Frobenius); is
//! η_m the velocity of a coordinate, η_m = dπ_m/dt (7) ([`Frame::holonomy`]); and how do the c_rs^m change with
//! the frame ([`Frame::change_to`]).
//!
//! # Lie algebra
//!
//! If the c_rs^m are constants, X_1..X_k span a [`LieAlgebra`]; well-known algebras are listed by name in the
//! [`CATALOGUE`]. The constants of an algebra are exact, and so are its properties:
//! [series](LieAlgebra::derived_series), [centre](LieAlgebra::centre), [Killing
//! form](LieAlgebra::killing_form), [rank](LieAlgebra::rank), [index](LieAlgebra::index) (the number of
//! Casimirs), [invariant forms](LieAlgebra::invariant_quadratic_forms).
//!
//! ```
//! use pc_algebra::{LieAlgebra, Representation};
//!
//! // The heavy top: rotations and the vertical, so(3) ⋉ ℝ³.
//! let top = Representation::adjoint(&LieAlgebra::so3()).semidirect_product();
//! assert_eq!(top, LieAlgebra::named("se3")?);
//! assert_eq!((top.index()?, top.is_semisimple()?), (2, false));
//! # Ok::<(), pc_algebra::AlgebraError>(())
//! ```
//!
//! # Lie group
//!
//! Each [`LieGroup`] has a Lie algebra: [`RotationMatrices`], [`UnitQuaternions`] and [`EulerAngles`] for
//! so(3), [`PlaneRotations`], [`PlaneMotions`], [`RigidMotions`], [`HeisenbergGroup`], and every
//! [`DirectProduct`]. A group provides exact frames: body velocities [on the left](LieGroup::left_frame), whose
//! structure coefficients are the constants of the algebra, and spatial velocities [on the
//! right](LieGroup::right_frame), whose structure coefficients have the opposite sign. It also provides
//! numbers, for integrators and initial values: [`LieGroup::exp`] and its derivative, [`LieGroup::log`],
//! [`LieGroup::compose`], [`LieGroup::project`].
//!
//! # Around it
//!
//! Below this crate: [`pc_expr`], which provides its expressions. Above it: [pc-mech](../pc_mech/index.html),
//! which puts a Lagrangian on a frame.

mod error;
mod frame;
mod group;
mod identity;
mod lie_algebra;
mod linear_algebra;

pub use error::{AlgebraError, acts_as_zero};
pub use frame::change::FrameChange;
pub use frame::elimination::Elimination;
pub use frame::frame::Frame;
pub use frame::holonomy::Holonomy;
pub use frame::integrability::Integrability;
pub use frame::structure::StructureCoefficients;
pub use group::group::{
    DirectProduct, EulerAngles, HeisenbergGroup, LieGroup, PlaneMotions, PlaneRotations, RigidMotions,
    RotationMatrices, Side, UnitQuaternions,
};
pub use identity::discontinuity::{Discontinuity, discontinuities, may_jump};
pub use identity::identity::Identity;
pub use identity::jump::Jump;
pub use identity::sample::Neighbourhood;
pub use lie_algebra::catalogue::{CATALOGUE, Entry};
pub use lie_algebra::lie_algebra::LieAlgebra;
pub use lie_algebra::representation::Representation;
pub use lie_algebra::subspace::Subspace;
pub use linear_algebra::affine::{Quadratic, affine, quadratic};
pub use linear_algebra::inverse::{determinant, inverse};
pub use linear_algebra::matrix::{Matrix, MatrixEntry};
