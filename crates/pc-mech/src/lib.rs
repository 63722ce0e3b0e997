//! Poincaré–Chetaev mechanics: from a Lagrangian to equations of motion.
//!
//!   d/dt ∂L/∂η_s = (c_rs^m η_r + c_0s^m) ∂L/∂η_m + X_s L + Q_s   (9)
//!
//! Conventions are those of [`pc_algebra`]: ẋ = b η + b_0 (3), [X_r, X_s] = c_rs^m X_m (5), L = T + U with U minus
//! the potential energy. Numbers in brackets are those of V. V. Rumyantsev, *On Poincaré–Chetaev's equations* (1994).
//!
//! ```
//! use pc_mech::{Graph, LieAlgebra, System};
//!
//! // The heavy top in Poisson's variables: γ the vertical in body axes, ω the body angular velocity.
//! let graph = Graph::new();
//! let [a, c, mgl] = graph.symbols(["A", "C", "mgl"]);
//! let top = System::builder(&graph)
//!     .parameter(a, 1.0).parameter(c, 0.5).parameter(mgl, 1.0)
//!     .coordinates(["γ1", "γ2", "γ3"])
//!     .quasi_velocities(["ω1", "ω2", "ω3"])
//!     .kinematics(|_, g, w| [g[1]*w[2] - g[2]*w[1], g[2]*w[0] - g[0]*w[2], g[0]*w[1] - g[1]*w[0]])
//!     .algebra(&LieAlgebra::so3())
//!     .lagrangian(|_, g, w| (a*(w[0].square() + w[1].square()) + c*w[2].square())/2.0 - mgl*g[2])
//!     .build()?;
//! let equations = top.poincare()?;
//! assert_eq!(equations.right_hand_side()[2], 0.0.into());
//! let motion = equations.compile()?; // a `VectorField`, to be given to any integrator
//! # Ok::<(), pc_mech::MechError>(())
//! ```

mod bodies;
mod book;
mod builder;
mod canonical;
mod change;
mod compiled;
mod emit;
mod error;
mod external;
mod forces;
mod hamilton_jacobi;
mod independent;
mod integrals;
mod lagrange;
mod legendre;
mod multipliers;
mod numeric;
mod orthonormal;
mod poincare;
mod reduction;
mod restriction;
mod stability;
mod system;
mod velocities;

pub use bodies::particle::Particle;
pub use bodies::rigid_body::{Inertia, RigidBody};
pub use builder::SystemBuilder;
pub use canonical::Canonical;
pub use compiled::motion::Motion;
pub use compiled::options::CompileOptions;
pub use emit::{EmitOptions, EmittedFile};
pub use error::MechError;
pub use external::{ExternalForce, ForcedMotion};
pub use hamilton_jacobi::CompleteIntegral;
pub use integrals::ansatz::Ansatz;
pub use integrals::bracket::PoissonBracket;
pub use integrals::conserved::{Conservation, Rates};
pub use integrals::cyclic::CyclicDisplacement;
pub use legendre::LegendreTransform;
pub use multipliers::{Constraint, Multipliers};
pub use pc_algebra::{
    AlgebraError, EulerAngles, Frame, LieAlgebra, LieGroup, Matrix, Neighbourhood, RotationMatrices,
    StructureCoefficients, UnitQuaternions, determinant,
};
pub use pc_expr::{
    Backend, Colouring, Expr, ExprError, Failure, Folding, Graph, Language, Number, Pattern, Style,
    VectorField,
};
pub use poincare::Equations;
pub use stability::second_variation::SecondVariation;
pub use stability::spectrum::{Eigenvalue, Spectrum, Verdict};
pub use stability::steady::{SteadyMotion, SteadyOptions};
pub use stability::variation::Variation;
pub use system::System;
pub use velocities::VelocityTransform;
