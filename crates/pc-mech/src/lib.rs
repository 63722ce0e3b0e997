//! Poincaré–Chetaev mechanics: from a Lagrangian to equations of motion. `pc-analysis` analyses the motions.
//!
//! Numbers in brackets are the equation numbers of V. V. Rumyantsev, *On Poincaré–Chetaev's equations* (1994), with
//! its misprints corrected. Conventions are those of [`pc_algebra`]: index 0 is time; i, j = 1..n count coordinates,
//! r, s, m = 1..k quasi-velocities; repeated indices are summed over. The library is unit-agnostic: any consistent
//! units will do.
//!
//! # System
//!
//! A [`System`] is a frame with its algebra, a Lagrangian and forces:
//!
//! ẋ = b η + b_0 (3), \[X_r, X_s\] = c_rs^m X_m (5), L(t, x, η) = T + U with U minus the potential energy, and
//! Q_s (8), the force conjugate to η_s.
//!
//! [`System::builder`] takes each part in the form in which books give it. The frame is given by [velocities in
//! terms of η](SystemBuilder::kinematics) or as a [`Frame`](SystemBuilder::frame); without either, η = ẋ. The
//! [algebra](SystemBuilder::algebra) is needed only where b does not determine it, because its rank is below k. The
//! Lagrangian is the sum of [T](SystemBuilder::kinetic), [−V](SystemBuilder::potential), [L(t, x,
//! η)](SystemBuilder::lagrangian), [L(t, x, ẋ)](SystemBuilder::lagrangian_in_velocities) and what each
//! [particle](SystemBuilder::particle) and [rigid body](SystemBuilder::rigid_body) adds. So is Q: [on
//! η](SystemBuilder::forces), [on x](SystemBuilder::force_on_coordinates), on the bodies, of a [dissipation
//! function](SystemBuilder::dissipation), [gyroscopic](SystemBuilder::gyroscopic), or [computed
//! outside](SystemBuilder::external_force).
//!
//! # Poincaré's equations
//!
//! [`System::poincare`] derives
//!
//! d/dt ∂L/∂η_s = (c_rs^m η_r + c_0s^m) ∂L/∂η_m + X_s L + Q_s (9)
//!
//! and solves them for η̇: [`Equations`] has the form M η̇ = r with M = ∂²L/∂η∂η.
//!
//! ```
//! use pc_mech::{Graph, LieAlgebra, System};
//!
//! // The heavy top in Poisson's variables: γ the vertical in body axes, ω the body angular velocity.
//! let graph = Graph::new();
//! let [a, b, c, mgl] = graph.symbols(["A", "B", "C", "mgl"]);
//! let top = System::builder(&graph)
//!     .parameter(a, 1.0).parameter(b, 2.0).parameter(c, 3.0).parameter(mgl, 1.0)
//!     .coordinates(["γ1", "γ2", "γ3"])
//!     .quasi_velocities(["ω1", "ω2", "ω3"])
//!     .kinematics(|_, g, w| [g[1]*w[2] - g[2]*w[1], g[2]*w[0] - g[0]*w[2], g[0]*w[1] - g[1]*w[0]])
//!     .algebra(&LieAlgebra::so3())
//!     .kinetic(|_, _, w| (a*w[0].square() + b*w[1].square() + c*w[2].square())/2.0)
//!     .potential(|_, g, _| mgl*g[2])
//!     .build()?;
//! let equations = top.poincare()?;
//! assert_eq!(equations.mass_matrix()[(0, 0)], a);
//! assert_eq!(equations.right_hand_side()[0].to_string(), "mgl*γ2 + ω2*ω3*(B - C)"); // (24)
//! # Ok::<(), pc_mech::MechError>(())
//! ```
//!
//! With η = ẋ all c_rs^m vanish and (9) are Lagrange's equations. On a group, with constant c_rs^m and X_s L =
//! 0, they are Euler's. For η_s = dπ_s/dt that are not the velocities of any coordinates they are the
//! Boltzmann–Hamel equations (18), with ∂/∂π_s for X_s. [`System::in_quasi_velocities`] changes from one form
//! to another, [`System::in_velocities`] back to Lagrange's equations:
//!
//! ```
//! use pc_mech::{Graph, System};
//!
//! // The spherical pendulum, and its velocity along the meridian and along the parallel.
//! let graph = Graph::new();
//! let [theta, rate, turn, u, v] = graph.symbols(["θ", "θ'", "ψ'", "u", "v"]);
//! let pendulum = System::builder(&graph)
//!     .coordinates(["θ", "ψ"])
//!     .lagrangian(|_, x, v| (v[0].square() + (x[0].sin() * v[1]).square()) / 2.0 + x[0].cos())
//!     .build()?;
//! let hamel = pendulum.in_quasi_velocities(["u", "v"], &[rate, theta.sin() * turn])?;
//! assert_eq!(hamel.lagrangian(), (u.square() + v.square()) / 2.0 + theta.cos());
//! assert_eq!(hamel.poincare()?.right_hand_side()[1].to_string(), "-u*v*cos(θ)/sin(θ)");
//! assert_eq!(hamel.in_velocities()?.lagrangian(), pendulum.lagrangian());
//! # Ok::<(), pc_mech::MechError>(())
//! ```
//!
//! # Redundant coordinates
//!
//! Each relation f_α(t, x) = 0 between coordinates, and each relation C η + c_0 = 0 between velocities, becomes
//! a [`Constraint`]. [`System::with_multipliers`] keeps all coordinates and velocities and adds the reactions,
//!
//! M η̇ = r + Cᵀ λ;
//!
//! its [`Motion`] is singular only where the constraints themselves are, and has a projection that keeps an
//! integrator on them. [`Multipliers::in_independent_velocities`] solves for some velocities and leaves the
//! equations
//!
//! d/dt ∂L/∂ẋ_s − ∂L/∂x_s − b_js ∂L/∂x_j = Q_s (14)–(16),
//!
//! which are fewer, contain no reactions, and are singular where the choice of velocities is. The first form is for
//! long motions and for reactions, the second for further transformations of a system; its canonical equations are
//! (17). The second form refuses constraints on velocities that are not integrable, which `pc-nonholo` treats.
//!
//! ```
//! use pc_mech::{Constraint, Graph, System};
//!
//! // The spherical pendulum in Cartesian coordinates; l = m = 1, g = 10.
//! let graph = Graph::new();
//! let pendulum = System::builder(&graph)
//!     .coordinates(["x", "y", "z"])
//!     .kinetic(|_, _, v| (v[0].square() + v[1].square() + v[2].square()) / 2.0)
//!     .potential(|_, x, _| 10.0 * x[2])
//!     .build()?;
//! let [x, y, z, vx, vy, vz] = graph.symbols(["x", "y", "z", "x'", "y'", "z'"]);
//! let rod = Constraint::new("rod", (x.square() + y.square() + z.square() - 1.0) / 2.0);
//! let held = pendulum.with_multipliers(&[rod])?.observe_reactions();
//!
//! // On a circle at cos α = 4/5 below, with v² = g sin² α/cos α = 4.5, the tension is g/cos α.
//! let circling = [0.6, 0.0, -0.8, 0.0, 4.5f64.sqrt(), 0.0];
//! let mut motion = held.compile()?;
//! let tension = -motion.observe(0.0, &circling)[1]; // after the energy
//! assert!((tension - 12.5).abs() < 1e-14);
//!
//! let at: Vec<_> = [x, y, z, vx, vy, vz].into_iter().zip(circling).collect();
//! let free = held.in_independent_velocities(&at)?;
//! assert_eq!(free.quasi_velocities(), [vx, vy]);
//! # Ok::<(), pc_mech::MechError>(())
//! ```
//!
//! # Canonical equations
//!
//! With momenta y_s = ∂L/∂η_s and H(t, x, y) = y_s η_s − L, Chetaev's equations are
//!
//! ẏ_s = (c_rs^m ∂H/∂y_r + c_0s^m) y_m − X_s H + Q_s (10), ẋ_i = b_i0 + b_is ∂H/∂y_s (11).
//!
//! [`System::canonical`] gives them as [`Canonical`]. For a quadratic L, η is an expression; for any other L, η is
//! found by Newton's method at each evaluation ([`Canonical::is_closed`] says which). [`LegendreTransform`] converts
//! states in both directions.
//!
//! ```
//! use pc_mech::{Graph, System};
//!
//! // Kepler's problem in polar coordinates.
//! let graph = Graph::new();
//! let kepler = System::builder(&graph)
//!     .coordinates(["r", "φ"])
//!     .lagrangian(|_, x, v| (v[0].square() + (x[0] * v[1]).square()) / 2.0 + 1.0 / x[0])
//!     .build()?;
//! let canonical = kepler.canonical()?;
//! let [r, p, area] = graph.symbols(["r", "p_r", "p_φ"]);
//! assert_eq!(canonical.hamiltonian(), (p.square() + area.square() / r.square()) / 2.0 - 1.0 / r);
//! assert_eq!(canonical.right_hand_side(), [area.square() / r.powi(3) - 1.0 / r.square(), 0.0.into()]);
//!
//! // A relativistic particle: y = η/√(1 − η²), so that y = 3/4 has η = 3/5.
//! let particle = System::builder(&graph)
//!     .coordinates(["x"])
//!     .lagrangian(|_, _, v| -(1.0 - v[0].square()).sqrt())
//!     .build()?
//!     .canonical()?;
//! let state = particle.legendre_transform()?.to_quasi_velocities(0.0, &[0.0, 0.75])?;
//! assert!(!particle.is_closed() && (state[1] - 0.6).abs() < 1e-15);
//! # Ok::<(), pc_mech::MechError>(())
//! ```
//!
//! # Symmetry
//!
//! Coordinates on which neither L nor Q depends can be left out by [`System::reduced`]. On a group with
//! invariant L no coordinates remain: (9) become Euler–Poincaré's equations, (10) those of Lie–Poisson, ẏ_s =
//! c_rs^m ∂H/∂y_r y_m.
//!
//! ```
//! use pc_mech::{Graph, LieGroup, RotationMatrices, System};
//!
//! // A free rigid body with its nine direction cosines; moments of inertia 1, 2, 3.
//! let graph = Graph::new();
//! let names = ["R11", "R12", "R13", "R21", "R22", "R23", "R31", "R32", "R33"];
//! let frame = RotationMatrices.left_frame(&graph, graph.symbol("t"), graph.symbols(names).to_vec())?;
//! let body = System::builder(&graph)
//!     .coordinates(names)
//!     .quasi_velocities(["1", "2", "3"])
//!     .frame(frame)
//!     .kinetic(|_, _, w| (w[0].square() + 2.0 * w[1].square() + 3.0 * w[2].square()) / 2.0)
//!     .build()?;
//! let free = body.reduced()?;
//! assert_eq!(free.canonical()?.right_hand_side()[0].to_string(), "-1/6*p_2*p_3");
//! # Ok::<(), pc_mech::MechError>(())
//! ```
//!
//! # States and inputs
//!
//! A quantity that evolves with a system but is not part of its frame, such as the current in a motor, is a
//! first-order [state](SystemBuilder::state) z with ż = h(t, x, η, z). L and Q may depend on it; d/dt ∂L/∂η_s
//! in (9) then has the term ż ∂²L/∂η_s∂z, and dH/dt the term −ż ∂L/∂z. Parameters that are functions of time
//! are [signals](SystemBuilder::signal); a motion reads their values from [tables](Motion::driven_by).
//!
//! # Numbers and source
//!
//! [`Equations::compile`], [`Canonical::compile_for`] and [`Multipliers::compile`] make a [`Motion`], a
//! [`VectorField`] ẏ = f(t, y) that owns everything it needs; [`CompileOptions`] determine which derivatives it
//! has, and for which kernel it is compiled. Parameters stay adjustable. Integrals, energy and outputs are
//! [observed](Motion::observe). With an [`ExternalForce`] the result is a [`ForcedMotion`]. [`Equations::emit`]
//! writes the same operations as C or Rust without dependencies.
//!
//! ```
//! use pc_mech::{EmitOptions, Graph, Language, System, VectorField};
//!
//! let graph = Graph::new();
//! let k = graph.symbol("k");
//! let oscillator = System::builder(&graph)
//!     .parameter(k, 1.0)
//!     .coordinates(["x"])
//!     .lagrangian(|_, x, v| (v[0].square() - k * x[0].square()) / 2.0)
//!     .build()?
//!     .poincare()?;
//! let mut motion = oscillator.compile()?;
//! motion.parameters_mut()[0] = 9.0;
//! let mut rates = [0.0; 2];
//! motion.rhs(0.0, &[2.0, 1.0], &mut rates)?;
//! assert_eq!((rates, motion.observe(0.0, &[2.0, 1.0])), ([1.0, -18.0], vec![18.5]));
//!
//! let source = &oscillator.emit(&EmitOptions::new(Language::Rust, "oscillator"))?[0];
//! assert_eq!(source.name, "oscillator.rs");
//! assert!(source.text.contains("ydot[1] = -x*k;"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Around it
//!
//! Below this crate: [`pc_algebra`], frames and brackets. Above it: [pc-nonholo](../pc_nonholo/index.html), constraints that are
//! not integrable; [pc-analysis](../pc_analysis/index.html), the analysis of the motions; [pc-model](../pc_model/index.html),
//! systems from text. Beside it, [pc-solve](../pc_solve/index.html) integrates a [`Motion`].

mod compiled;
mod constraints;
mod emit;
mod equations;
mod error;
mod numeric;
mod points;
#[cfg(test)]
#[path = "../../../tests/src/classical/random.rs"]
mod random;
mod system;
mod transform;
mod tree;

pub use compiled::coriolis_matrix::CoriolisMatrix;
pub use compiled::forced_motion::ForcedMotion;
pub use compiled::impulse::ImpulseResponse;
pub use compiled::inverse_dynamics::InverseDynamics;
pub use compiled::legendre_transform::LegendreTransform;
pub use compiled::machine_code::MachineCode;
pub use compiled::mass_factors::{MassFactors, SingularMatrix};
pub use compiled::motion::Motion;
pub use compiled::options::{CompileOptions, TreeElimination};
pub use compiled::projection::integrals::KeptIntegrals;
pub use compiled::velocity_map::VelocityMap;
pub use constraints::body_reactions::BodyReaction;
pub use constraints::constraint::Constraint;
pub use constraints::friction::{ConstraintFriction, FrictionForces};
pub use constraints::multipliers::Multipliers;
pub use emit::function::SourceFunction;
pub use emit::source::{EmitOptions, EmittedFile};
pub use equations::canonical::Canonical;
pub use equations::force_balance::ForceBalance;
pub use equations::maggi::Maggi;
pub use equations::poincare::Equations;
pub use error::{
    BodyError, ConstraintError, EvaluationError, ForceError, FrameError, IntegralError, LagrangianError,
    MatrixError, MechError, ShapeError, TreeError,
};
pub use numeric::least_squares::LeastSquares;
pub use numeric::singular_values::SingularValues;
pub use pc_algebra::{
    AlgebraError, Elimination, EulerAngles, Frame, Identity, LieAlgebra, LieGroup, Matrix, Neighbourhood,
    RotationMatrices, StructureCoefficients, UnitQuaternions, acts_as_zero, determinant,
};
pub use pc_expr::{
    Backend, Colouring, Expr, ExprError, Failure, Folding, Graph, Language, Number, Pattern, Style,
    TaylorSeries, VectorField,
};
pub use system::bodies::particle::Particle;
pub use system::bodies::rigid_body::{Inertia, RigidBody};
pub use system::bodies::velocity::BodyVelocity;
pub use system::builder::SystemBuilder;
pub use system::external_force::{ExternalForce, difference_quotients};
pub use system::signals::{OutsideTable, Signals};
pub use system::system::System;
pub use system::table::{Interpolation, KnownRates, Polynomial, Table, TableError};
pub use transform::quasi_velocities::QuasiVelocityChange;
pub use transform::velocities::VelocityTransform;
pub use tree::body::TreeBody;
pub use tree::joint::Joint;
pub use tree::kinematics::{JointMotion, Motions};
pub use tree::reactions::{JointReaction, PointLoad};
pub use tree::tree::Tree;
