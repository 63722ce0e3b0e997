//! Analysis of motions without integrating them: integrals, steady motions, stability, invariant measures.
//!
//! Equation numbers in brackets are those of V. V. Rumyantsev, *On Poincaré–Chetaev's equations* (1994), with its
//! misprints corrected; the conventions are those of [`pc_mech`]. The analysis applies to its
//! [`System`](pc_mech::System), to its [`Equations`](pc_mech::Equations) (9) and [`Canonical`](pc_mech::Canonical)
//! equations (10), (11), and to the [`Motion`](pc_mech::Motion) into which these are compiled. Results are proved
//! unless they are marked open.
//!
//! # Frames
//!
//! [`FrameFacts::of`] says whether each quasi-velocity is dπ/dt, and which constraints the frame alone imposes.
//!
//! # Brackets
//!
//! Without forces and in a stationary frame, equations (10) and (11) are ẏ_s = (y_s, H), ẋ_i = (x_i, H) with
//!
//! (f, g) = ∂g/∂y_s X_s f − ∂f/∂y_s X_s g + c_rs^m ∂f/∂y_s ∂g/∂y_r y_m (12).
//!
//! [`PoissonBracket::new`] is this bracket; for all other systems [`PoissonBracket::extended`] adds time and
//! its momentum y_0, with H + y_0 in place of H. Functions that commute with all others are
//! [Casimirs](PoissonBracket::casimirs). The bracket of two integrals is an integral (Poisson's theorem);
//! [`PoissonBracket::closure`] adds the new ones, and [`PoissonBracket::algebra`] also expresses every bracket
//! through the integrals; [`PoissonBracket::integrability`] says whether these suffice (Liouville; Mishchenko and Fomenko).
//! [`PoissonBracket::dirac`] is the bracket under constraints on the positions, and
//! [`PoissonBracket::canonical_variables`] says whether functions are canonical variables. Under nonholonomic constraints
//! [`DependentMomenta`] has H of all momenta, with ∂H/∂y_α = 0 (31).
//!
//! ```
//! use pc_analysis::PoissonBracket;
//! use pc_mech::{Graph, System};
//!
//! // Two components of the angular momentum in space bring the third.
//! let graph = Graph::new();
//! let point = System::builder(&graph)
//!     .coordinates(["x", "y", "z"])
//!     .lagrangian(|_, _, v| (v[0].square() + v[1].square() + v[2].square()) / 2.0)
//!     .build()?;
//! let [x, y, z, px, py, pz] = graph.symbols(["x", "y", "z", "p_x", "p_y", "p_z"]);
//! let all = PoissonBracket::new(&point).closure(&[y * pz - z * py, z * px - x * pz])?;
//! assert_eq!(all[2..], [x * py - y * px]);
//! # Ok::<(), pc_analysis::AnalysisError>(())
//! ```
//!
//! # Lie–Poisson
//!
//! On a group with invariant L, [reduced](pc_mech::System::reduced) to no coordinates, the bracket is that of
//! the [algebra alone](PoissonBracket::lie_poisson).
//!
//! ```
//! use pc_analysis::PoissonBracket;
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
//! assert_eq!(PoissonBracket::new(&free).casimirs(2)[0].to_string(), "p_1^2 + p_2^2 + p_3^2");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Integrals
//!
//! [`System::energy_rate`](pc_mech::System::energy_rate) is dH/dt = X_0 H + c_0r^m η_r y_m + Q_s η_s.
//! [`CyclicDisplacement::all`] finds the a_s X_s whose momentum a_s y_s the motion conserves; for η = ẋ these
//! displacements include those along cyclic coordinates. [`Rates`] differentiates along the motion, gives a
//! [verdict](Rates::verdict) on any function, and [finds](Rates::integrals) integrals that have the form of an
//! [`Ansatz`]; these are proved. [`Integrals::find`] combines all of these, and Casimirs;
//! [`Integrals::add_polynomials`] adds those of a [`PolynomialAnsatz`], over the field of the parameters, and
//! [`Integrals::judge_on_levels`] finds functions that are conserved where other integrals have certain values. An
//! integral that is linear in the momenta belongs to a [`NoetherField`].
//!
//! ```
//! use pc_analysis::{Conservation, CyclicDisplacement, Rates};
//! use pc_mech::{Graph, LieAlgebra, System};
//!
//! // Lagrange's top, with friction about its axis and without.
//! let graph = Graph::new();
//! let [a, c, n] = graph.symbols(["A", "C", "n"]);
//! let top = |friction| {
//!     System::builder(&graph)
//!         .coordinates(["γ1", "γ2", "γ3"])
//!         .quasi_velocities(["ω1", "ω2", "ω3"])
//!         .kinematics(|_, g, w| [g[1]*w[2] - g[2]*w[1], g[2]*w[0] - g[0]*w[2], g[0]*w[1] - g[1]*w[0]])
//!         .algebra(&LieAlgebra::so3())
//!         .lagrangian(|_, g, w| (a*(w[0].square() + w[1].square()) + c*w[2].square())/2.0 - g[2])
//!         .dissipation(|_, _, w| friction * w[2].square() / 2.0)
//!         .build()
//! };
//! let rubbed = top(n)?;
//! assert_eq!(rubbed.energy_rate().to_string(), "-n*ω3^2");
//! let verdict = Rates::poincare(&rubbed.poincare()?).verdict(rubbed.momenta()[2])?;
//! assert!(matches!(verdict, Conservation::Changing(_)));
//!
//! let top = top(0.0.into())?;
//! assert_eq!(CyclicDisplacement::all(&top)[0].momentum.to_string(), "C*ω3");
//! let rates = Rates::canonical(&top.canonical()?);
//! let found: Vec<String> = rates.integrals(&rates.ansatz(1, 1))?.iter().map(|f| f.to_string()).collect();
//! assert_eq!(found, ["p_ω3", "γ1*p_ω1 + γ2*p_ω2 + γ3*p_ω3"]);
//! # Ok::<(), pc_analysis::AnalysisError>(())
//! ```
//!
//! # Hamilton–Jacobi
//!
//! If X_0 S + H(t, x, X_s S) = 0, then y_s = X_s S satisfies (10) along the motion (11). [`hamilton_jacobi`]
//! substitutes S and proves the equation, and [`ProposedAction::check`] gives a verdict if there is no proof; a
//! [`CompleteIntegral`] S(t, x, α) yields the motions through ∂S/∂α_s = β_s (Jacobi), and a [`JacobiMotion`] follows one of them and
//! compares it with that of the equations. A [`SeparatedAction`] is found where all coordinates but one are cyclic. Where rank b is below the number of coordinates, S is needed on one [`Orbit`] only.
//!
//! ```
//! use pc_analysis::CompleteIntegral;
//! use pc_mech::{Graph, System};
//!
//! // Free fall, g = 1: Hamilton's principal function of the motion from α at t = 0. Then β = −ẋ(0).
//! let graph = Graph::new();
//! let [t, x, start] = graph.symbols(["t", "x", "α"]);
//! let particle =
//!     System::builder(&graph).coordinates(["x"]).lagrangian(|_, x, v| v[0].square() / 2.0 - x[0]).build()?;
//! let action = (x - start).square() / (2.0 * t) - t * (x + start) / 2.0 - t.powi(3) / 24.0;
//! let mut integral = CompleteIntegral::new(&particle.canonical()?, action, &["α"])?;
//! let state = integral.state(2.0, &[5.0], &[-3.0], &[0.0])?;
//! assert_eq!(state, [9.0, 1.0]); // 5 + 3 t − t²/2, 3 − t
//! # Ok::<(), pc_analysis::AnalysisError>(())
//! ```
//!
//! # Steady motions and stability
//!
//! [`SteadyMotion::near`] finds states in which all but the cyclic coordinates are at rest, with their first
//! approximation. The [`Spectrum`] of the first approximation shows instability, or asymptotic stability; the
//! [`SecondVariation`] of the energy under constant integrals shows stability (Routh; Chetaev's bundle of
//! integrals). Each gives a [`Verdict`], which may be undecided. [`Linearizer::steady`] finds the steady motion nearest
//! to a start, with constraints and their reactions; [`SteadyMotions::search`] finds steady motions from many starts that
//! have integrals in common with the start, and the equilibria. A [`Variation`] is a motion together with deviations from it, δ̇ =
//! (∂f/∂y) δ.
//!
//! ```
//! use pc_analysis::{SecondVariation, Spectrum, Verdict, first_approximation};
//! use pc_mech::{Graph, LieAlgebra, System};
//!
//! // The sleeping top, upright: stable if C² ω² > 4 A mgl. With A = mgl = 1, C = 1/2: if ω > 4.
//! let graph = Graph::new();
//! let top = System::builder(&graph)
//!     .coordinates(["γ1", "γ2", "γ3"])
//!     .quasi_velocities(["ω1", "ω2", "ω3"])
//!     .kinematics(|_, g, w| [g[1]*w[2] - g[2]*w[1], g[2]*w[0] - g[0]*w[2], g[0]*w[1] - g[1]*w[0]])
//!     .algebra(&LieAlgebra::so3())
//!     .lagrangian(|_, g, w| (w[0].square() + w[1].square() + w[2].square()/2.0)/2.0 - g[2])
//!     .integral("area", |_, g, w| w[0]*g[0] + w[1]*g[1] + w[2]*g[2]/2.0)
//!     .integral("spin", |_, _, w| w[2])
//!     .integral("γ²", |_, g, _| g[0].square() + g[1].square() + g[2].square())
//!     .build()?
//!     .poincare()?;
//! let sleeping = |spin| [0.0, 0.0, 1.0, 0.0, 0.0, spin];
//! assert_eq!(SecondVariation::at(&top, &sleeping(4.01))?.verdict, Verdict::Stable);
//! let matrix = first_approximation(&mut top.compile()?, 0.0, &sleeping(3.99))?;
//! assert_eq!(Spectrum::of(&matrix, 0.0)?.verdict(), Verdict::Unstable);
//! # Ok::<(), pc_analysis::AnalysisError>(())
//! ```
//!
//! # Linearization
//!
//! A [`Linearizer`] computes the matrices of the motions near a state, in independent components of the
//! states on its [`Leaf`]: a [`Linearization`] with eigenvalues, [modes](Mode) and equations of the [second
//! order](SecondOrder). A [`RootLocus`] follows eigenvalues as a parameter varies; an [`EquilibriumSearch`]
//! looks for equilibria in a box.
//!
//! # Reduction
//!
//! A [`Routhian`] is the Lagrangian of the remaining coordinates when cyclic ones are eliminated; the cyclic momenta
//! are constants.
//!
//! # Invariant measures
//!
//! [`divergence`] is the rate at which phase volume grows, and [`invariant_measure`] finds a density N for
//! which N dx dy is invariant; one exists for every system with potential forces, and for some under
//! nonholonomic constraints. Systems under nonholonomic constraints also have a bracket, the
//! [almost-Poisson](PoissonBracket::almost_poisson) one, and some of Chaplygin's systems become Lagrangian in
//! a new time, which is given by a [`ReducingMultiplier`]. [`MeasureSearch::of`] combines all results for a
//! motion.
//!
//! # Around it
//!
//! Lower layers: [`pc_mech`] and [`pc_nonholo`], the equations of the motions that are analysed. Upper layers:
//! [pc-print](../pc_print/index.html), which puts the results into words; [pc-cli](../pc_cli/index.html), where they are the output of
//! `pc theory`, `pc linearize` and `pc equilibria`.

mod brackets;
mod error;
mod frame_facts;
mod hamilton_jacobi;
mod integrals;
mod linear;
mod measures;
mod numeric;
mod reduction;
mod stability;
mod variation;

pub use brackets::bracket_algebra::{BracketAlgebra, BracketMeaning, DenotedFunction, PairBracket};
pub use brackets::canonical_variables::{BracketViolation, CanonicalVariables};
pub use brackets::dependent_momenta::DependentMomenta;
pub use brackets::integrability::Integrability;
pub use brackets::poisson_bracket::PoissonBracket;
pub use error::AnalysisError;
pub use frame_facts::{FrameConstraints, FrameFacts, QuasiVelocityKind};
pub use hamilton_jacobi::complete_integral::CompleteIntegral;
pub use hamilton_jacobi::hamilton_jacobi;
pub use hamilton_jacobi::jacobi_motion::{BranchEnd, JacobiMotion, MotionAgreement};
pub use hamilton_jacobi::orbit::Orbit;
pub use hamilton_jacobi::proposed_action::{ProposedAction, Residual};
pub use hamilton_jacobi::separated::SeparatedAction;
pub use integrals::ansatz::Ansatz;
pub use integrals::cyclic_displacements::CyclicDisplacement;
pub use integrals::integral::{ConservationVerdict, Integral, Integrals, LevelEquation, Origin};
pub use integrals::noether::NoetherField;
pub use integrals::polynomial_search::{AnsatzSearch, PolynomialAnsatz};
pub use integrals::rates::{Conservation, Rates};
pub use linear::conserved::Conserved;
pub use linear::equilibria::{Equilibria, EquilibriumSearch, FoundEquilibrium};
pub use linear::linearization::{CyclicCoordinates, Linearization};
pub use linear::linearizer::{Leaf, Linearizer};
pub use linear::modes::Mode;
pub use linear::root_locus::{BranchCount, RootLocus};
pub use linear::second_order::{NoSecondOrder, SecondOrder};
pub use linear::trim::Trim;
pub use measures::invariant_measure::{InvariantMeasure, divergence, invariant_measure};
pub use measures::phase_measure::{MeasureSearch, PhaseMeasure};
pub use measures::reducing_multiplier::ReducingMultiplier;
pub use reduction::routhian::Routhian;
pub use stability::second_variation::SecondVariation;
pub use stability::spectrum::{Eigenvalue, Spectrum, Verdict};
pub use stability::steady_motion::{SteadyMotion, SteadyOptions, first_approximation};
pub use stability::steady_motions::{FoundSteadyMotion, NoSteadyMotions, SteadyMotions};
pub use stability::steady_search::{EnergyCriterion, NearbySteadyMotion, Stability};
pub use variation::Variation;
