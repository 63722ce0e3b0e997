//! Nonholonomic constraints in quasi-velocities: their classification, equations of motion, reactions.
//!
//! Numbers in brackets are those of the equations in V. V. Rumyantsev, *On Poincaré–Chetaev's equations*
//! (1994), with its misprints corrected; the conventions are those of [`pc_mech`]. Of k quasi-velocities, l
//! are free and have indices r, s = 1..l; the other k − l are kept at zero and have indices α = l+1..k. The
//! index m runs over all k. The library is independent of units: any consistent units can be used.
//!
//! # Which constraints are nonholonomic
//!
//! A [`Constraint`](pc_mech::Constraint) is a condition on positions, f(t, x) = 0, or on velocities. Some
//! conditions on velocities can be integrated, and some follow from others or contradict them. A
//! [`ConstraintClassification`] says which of these is the case. If X'_1..X'_l is a basis of the allowed
//! velocities and X'_0 is one of them,
//!
//! \[X'_r, X'_s\] = c'_rs^m X'_m + c'_rs^α X'_α, r, s = 0..l,
//!
//! and the constraint α is integrable if all c'_rs^α vanish (Frobenius).
//!
//! ```
//! use pc_mech::{Constraint, Graph, System};
//! use pc_nonholo::{ConstraintClassification, ConstraintKind};
//!
//! let graph = Graph::new();
//! let particle = System::builder(&graph)
//!     .coordinates(["x", "y", "z"])
//!     .lagrangian(|_, _, v| (v[0].square() + v[1].square() + v[2].square()) / 2.0)
//!     .build()?;
//! let symbols @ [x, y, _, vx, vy, vz, _] = graph.symbols(["x", "y", "z", "x'", "y'", "z'", "t"]);
//! let at: Vec<_> = symbols.into_iter().zip([1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 0.0]).collect();
//!
//! // ż = y ẋ binds no positions; ż = y ẋ + x ẏ is z = x y + const.
//! let knife = Constraint::new("knife", vz - y * vx);
//! let classification = ConstraintClassification::new(&particle, &[knife], &at)?;
//! assert!(matches!(classification.kinds(), [ConstraintKind::Nonholonomic { .. }]));
//! let saddle = Constraint::new("saddle", vz - y * vx - x * vy);
//! let again = Constraint::new("again", 2.0 * vz - 2.0 * y * vx - 2.0 * x * vy);
//! let classification = ConstraintClassification::new(&particle, &[saddle, again], &at)?;
//! assert_eq!(classification.kinds(), [ConstraintKind::Integrable]);
//! assert_eq!(classification.redundant()[0].follows_from, ["saddle"]);
//! # Ok::<(), pc_nonholo::NonholoError>(())
//! ```
//!
//! # Equations and reactions
//!
//! With the constraints η_α = 0 the equations of motion are
//!
//! d/dt ∂L/∂η_s = (c_rs^m η_r + c_0s^m) ∂L/∂η_m + X_s L + Q_s, r, s = 1..l, m = 1..k (30),
//!
//! where the constraints are substituted after differentiation, so that all k momenta appear. [`Constrained`]
//! derives them, and the reactions, which are the residuals of the dropped equations,
//!
//! λ_α = D_t p_α − (c_rα^m η_r + c_0α^m) p_m − X_α L − Q_α.
//!
//! ```
//! use pc_mech::{Graph, System};
//! use pc_nonholo::Constrained;
//!
//! // Chaplygin's sleigh: v along the blade, ω about it, and the lateral velocity u that the blade forbids.
//! let graph = Graph::new();
//! let [m, j, a, v, w] = graph.symbols(["m", "J", "a", "v", "ω"]);
//! let sleigh = System::builder(&graph)
//!     .coordinates(["x", "y", "φ"])
//!     .quasi_velocities(["u", "v", "ω"])
//!     .kinematics(|_, x, eta| {
//!         let (s, c) = (x[2].sin(), x[2].cos());
//!         [eta[1]*c - eta[0]*s, eta[1]*s + eta[0]*c, eta[2]]
//!     })
//!     .lagrangian(|_, _, eta| {
//!         (m*(eta[1].square() + (eta[0] + a*eta[2]).square()) + j*eta[2].square())/2.0
//!     })
//!     .build()?;
//! let constrained = Constrained::new(&sleigh, &[graph.symbol("u")])?;
//! assert_eq!(constrained.equations().right_hand_side()[0].to_string(), "m*a*ω^2");
//! assert_eq!(constrained.equations().right_hand_side()[1].to_string(), "-m*a*v*ω");
//! assert_eq!(constrained.reactions(), [m * v * w * j / (j + m * a.square())]);
//! # Ok::<(), pc_nonholo::NonholoError>(())
//! ```
//!
//! # Adapted frames
//!
//! Constraints C η + c_0 = 0 whose left-hand sides are not quasi-velocities are brought to the form η_α = 0:
//! [`Adapted`] takes their left-hand sides as the last quasi-velocities, after those that stay independent. The
//! equations above then apply.
//!
//! ```
//! use pc_mech::{Constraint, Graph, System};
//! use pc_nonholo::Adapted;
//!
//! // A disk of unit mass and radius, its mass in the rim, that rolls upright: ψ its heading, φ its rotation.
//! let graph = Graph::new();
//! let disk = System::builder(&graph)
//!     .coordinates(["x", "y", "ψ", "φ"])
//!     .kinetic(|_, _, v| (v[0].square() + v[1].square()) / 2.0 + v[2].square() / 4.0 + v[3].square() / 2.0)
//!     .force_on_coordinates(|_, _, _| [0, 0, 0, 3].map(Into::into))
//!     .build()?;
//! let symbols @ [_, _, psi, _, vx, vy, _, turn, _] =
//!     graph.symbols(["x", "y", "ψ", "φ", "x'", "y'", "ψ'", "φ'", "t"]);
//! let along = Constraint::new("along", vx - turn * psi.cos());
//! let across = Constraint::new("across", vy - turn * psi.sin());
//! let rolling = disk.with_multipliers(&[along, across])?;
//!
//! let at: Vec<_> = symbols.into_iter().map(|symbol| (symbol, 0.3)).collect();
//! let adapted = Adapted::new(&rolling, &at)?;
//! assert_eq!(adapted.free(), 2);
//! // A torque of 3 against the moment of inertia 1 + 1 about the point of contact.
//! let disk = adapted.constrained()?;
//! assert_eq!(disk.equations().system().quasi_velocities()[1], turn);
//! assert_eq!(disk.equations().accelerations(), [0.into(), 1.5.into()]);
//! # Ok::<(), pc_nonholo::NonholoError>(())
//! ```
//!
//! # The constraints put in
//!
//! If θ is T for η_α = 0, the equations (30) are
//!
//! d/dt ∂θ/∂η_s = (c_rs^m η_r + c_0s^m) ∂θ/∂η_m + (c_rs^α η_r + c_0s^α)(∂T/∂η_α)_0 + X_s (θ + U) + Q_s, m ≤ l (32).
//!
//! Without the second term, as if the constraints had been substituted into L before differentiation, these
//! equations would be wrong. [`Constrained::free_system`] counts this term among the forces: the result is a
//! complete [`System`](pc_mech::System) of l quasi-velocities, whose canonical equations are (34). Its bracket
//! does not satisfy Jacobi's identity.
//!
//! ```
//! # use pc_mech::{Graph, System};
//! # use pc_nonholo::Constrained;
//! // A particle with ż = y ẋ, the quasi-velocity u = ż − y ẋ being zero.
//! let graph = Graph::new();
//! let [y, v, w] = graph.symbols(["y", "v", "w"]);
//! let particle = System::builder(&graph)
//!     .coordinates(["x", "y", "z"])
//!     .quasi_velocities(["v", "w", "u"])
//!     .kinematics(|_, x, eta| [eta[0], eta[1], eta[2] + x[1] * eta[0]])
//!     .lagrangian_in_velocities(|_, _, v| (v[0].square() + v[1].square() + v[2].square()) / 2.0)
//!     .build()?;
//! let free = Constrained::new(&particle, &[graph.symbol("u")])?.free_system()?;
//! assert_eq!(free.lagrangian(), ((1.0 + y.square()) * v.square() + w.square()) / 2.0);
//! assert_eq!(free.forces(), [y * v * w, -y * v.square()]); // ẏ and −ẋ times ∂T/∂u = ż
//! # Ok::<(), pc_nonholo::NonholoError>(())
//! ```
//!
//! # Voronets and Chaplygin
//!
//! Constraints solved for velocities, ẋ_r = α_ri ẋ_i + α_r with i ≤ l < r, have the equations
//!
//! d/dt ∂θ/∂ẋ_i = ∂(θ+U)/∂x_i + α_ri ∂(θ+U)/∂x_r + (c_ji^r ẋ_j + c_0i^r)(∂T/∂ẋ_r)_0 + Q_i + α_ri Q_r (35)
//!
//! of Voronets; they are Chaplygin's equations if nothing depends on the x_r, so that the equations of the
//! x_i form a system by themselves. [`Voronets`] takes a system in velocities with multipliers.
//!
//! ```
//! use pc_mech::{Constraint, Graph, System};
//! use pc_nonholo::Voronets;
//!
//! let graph = Graph::new();
//! let particle = System::builder(&graph)
//!     .coordinates(["x", "y", "z"])
//!     .lagrangian(|_, _, v| (v[0].square() + v[1].square() + v[2].square()) / 2.0)
//!     .build()?;
//! let symbols @ [x, y, z, vx, vy, vz, _] = graph.symbols(["x", "y", "z", "x'", "y'", "z'", "t"]);
//! let knife = Constraint::new("knife", vz - y * vx);
//! let at: Vec<_> = symbols.into_iter().zip([0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0]).collect();
//! let voronets = Voronets::new(&particle.with_multipliers(&[knife])?, &at)?;
//! assert_eq!((voronets.independent(), voronets.dependent()), (vec![x, y], vec![z]));
//! assert!(voronets.is_chaplygin());
//! // (1 + y²) ẍ = −y ẋ ẏ, ÿ = 0
//! let equations = voronets.system()?.poincare()?;
//! assert_eq!(equations.right_hand_side(), [-y * vx * vy, 0.into()]);
//! # Ok::<(), pc_nonholo::NonholoError>(())
//! ```
//!
//! # Or multipliers
//!
//! All forms above are singular where their choice of velocities is singular. The equations with
//! [`Multipliers`](pc_mech::Multipliers), M η̇ = r + Cᵀ λ, are singular only where the constraints are singular,
//! even for nonholonomic constraints, and they give the λ: use them for long motions.
//!
//! # Around it
//!
//! Below: [`pc_mech`], which provides the systems on which constraints act. Above: [pc-model](../pc_model/index.html), which classifies
//! the constraints of a text model, and [pc-analysis](../pc_analysis/index.html), which finds invariant measures and Chaplygin's
//! multiplier.

mod classification;
mod error;
mod n_trailer;
mod reduction;

pub use classification::binding::{Binding, Redundant};
pub use classification::classification::{ConstraintClassification, ConstraintKind};
pub use classification::combinations::IntegrableCombination;
pub use error::NonholoError;
pub use n_trailer::{NTrailer, Wagon};
pub use reduction::adapted::Adapted;
pub use reduction::constrained::Constrained;
pub use reduction::voronets::Voronets;
