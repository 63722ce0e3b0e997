//! Constraints with multipliers, in any coordinates.

use pc_algebra::{Matrix, Quadratic, quadratic};
use pc_expr::Expr;

use crate::compiled::compile::LONGEST_ELIMINATION;
use crate::compiled::first_order::{FirstOrder, Implicit};
use crate::compiled::legendre_transform::LegendreTransform;
use crate::compiled::motion::Motion;
use crate::compiled::options::CompileOptions;
use crate::compiled::projection::constraint_manifold::{Conditions, Surface};
use crate::constraints::constraint::Constraint;
use crate::equations::poincare::Equations;
use crate::error::{ConstraintError, MechError, shape};
use crate::system::system::System;

/// Poincaré's equations with multipliers (Lagrange's equations of the first kind, in quasi-velocities),
///
///   M η̇ = r + Cᵀ λ,   C η̇ = −(dC/dt) η − dc_0/dt,   ẋ = b η + b_0,
///
/// of a system whose quasi-velocities are constrained by C η + c_0 = 0: conditions on velocities, or the
/// derivatives C_αs = X_s f_α, c_α0 = X_0 f_α of conditions on positions. M and r are those of (9); λ_α is the
/// reaction conjugate to the condition, and its power is −λ_α c_α0. For [nonlinear](Constraint::nonlinear)
/// conditions g(t, x, η) = 0, C is ∂g/∂η, and C η̇ = −(∂g/∂x) ẋ − ∂g/∂t.
///
/// All k quasi-velocities are components of the state. At each evaluation the quasi-velocities that determine the
/// others best are taken as independent, so the only singular positions are those where the constraints themselves
/// are singular; the rates do not depend on the choice. The [projection](pc_expr::VectorField::project) of the
/// compiled motion corrects numerical drift from the constraints.
///
/// ```
/// use pc_mech::{Constraint, Graph, System, VectorField};
///
/// // A pendulum in Cartesian coordinates.
/// let graph = Graph::new();
/// let pendulum = System::builder(&graph)
///     .coordinates(["x", "y"])
///     .lagrangian(|_, x, v| (v[0].square() + v[1].square()) / 2.0 - 10.0 * x[1])
///     .build()?;
/// let [x, y] = graph.symbols(["x", "y"]);
/// let circle = Constraint::new("length", x.square() + y.square() - 1.0);
/// let mut motion = pendulum.with_multipliers(&[circle])?.compile()?;
/// let mut rates = [0.0; 4];
/// motion.rhs(0.0, &[1.0, 0.0, 0.0, 2.0], &mut rates)?; // horizontal, ẏ = 2: ẍ = −|ṙ|²
/// assert_eq!(rates, [0.0, 2.0, -4.0, -10.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Multipliers<'g> {
    pub(crate) equations: Equations<'g>,
    pub(super) constraints: Vec<Constraint<'g>>,
    /// The functions g, equal to C η + c_0 where they are affine.
    pub(super) velocities: Vec<Expr<'g>>,
    /// C = ∂g/∂η, m × k.
    pub(crate) coefficients: Matrix<Expr<'g>>,
    /// The m right-hand sides −(dC/dt) η − dc_0/dt.
    pub(crate) right: Vec<Expr<'g>>,
    /// The m symbols λ.
    pub(crate) reactions: Vec<Expr<'g>>,
    /// Constraints that follow from the imposed ones; they are checked but not imposed.
    pub(super) followers: Vec<Constraint<'g>>,
    /// The number of independent constraints, which come first almost everywhere.
    pub(super) rank: usize,
    /// The indices of the quasi-velocities that depend on the others, wherever the others determine them.
    pub(crate) dependent: Option<Vec<usize>>,
    /// Whether the reactions are among the observables.
    pub(super) observed: bool,
}

impl<'g> System<'g> {
    /// The equations of motion under constraints, with multipliers.
    ///
    /// # Errors
    /// [`ConstraintError::NotAffine`] for a constraint on velocities that is neither affine nor declared
    /// [nonlinear](Constraint::nonlinear); [`ConstraintError::TooMany`] if no velocity is left free;
    /// [`FrameError::OfState`](crate::FrameError::OfState) for a condition on first-order states;
    /// [`ConstraintError::Dependent`] for a constraint that follows from those before it, or contradicts them;
    /// [`LagrangianError::Degenerate`](crate::LagrangianError::Degenerate) if the constraints leave velocities
    /// without inertia; [`ConstraintError::Jumps`] for a constraint that jumps at a surface that the motion
    /// crosses.
    pub fn with_multipliers(&self, constraints: &[Constraint<'g>]) -> Result<Multipliers<'g>, MechError> {
        let graph = self.graph();
        let (k, m) = (self.quasi_velocities.len(), constraints.len());
        if m >= k {
            return Err(ConstraintError::TooMany { constraints: m, quasi_velocities: k }.into());
        }
        let mut velocities = Vec::new();
        let mut rows = Vec::new();
        for constraint in constraints {
            self.check_no_state("a constraint", &[constraint.expression])?;
            let velocity = constraint.velocity(self);
            self.check_continuous_constraint(&constraint.name, velocity)?;
            rows.push(match constraint.nonlinear {
                true => graph.gradient(velocity, &self.quasi_velocities),
                false => constraint.coefficients(self)?.0,
            });
            if graph.generic_rank(&rows) < rows.len() {
                return Err(ConstraintError::Dependent { constraint: constraint.name.clone() }.into());
            }
            velocities.push(velocity);
        }
        let equations = self.equations(k)?;
        let along: Vec<_> = self
            .frame
            .coordinates()
            .iter()
            .copied()
            .zip(equations.velocities().iter().copied())
            .chain(graph.in_time(self.frame.time()))
            .collect();
        let order = self.collecting_order();
        let right: Vec<Expr<'g>> =
            graph.directional(&velocities, &along).into_iter().map(|rate| -rate).collect();
        let names: Vec<String> =
            constraints.iter().map(|constraint| format!("λ_{}", constraint.name)).collect();
        let multipliers = Multipliers {
            equations,
            constraints: constraints.to_vec(),
            coefficients: Matrix::from_fn(m, k, |a, s| rows[a][s]),
            velocities: graph.shorten(&velocities, &order),
            right: graph.shorten(&right, &order),
            reactions: self.all_unused(names, "λ_"),
            followers: Vec::new(),
            rank: m,
            dependent: None,
            observed: false,
        };
        let bordered = multipliers.bordered();
        if graph.generic_rank(&bordered.to_rows()) < bordered.rows() {
            self.check_regular(multipliers.equations.mass_matrix())?;
        }
        Ok(multipliers)
    }
}

impl<'g> Multipliers<'g> {
    /// The equations of the unconstrained system: M, r and the energy.
    pub fn equations(&self) -> &Equations<'g> {
        &self.equations
    }

    /// The m constraints.
    pub fn constraints(&self) -> &[Constraint<'g>] {
        &self.constraints
    }

    /// The m expressions C η + c_0 of the constraints, or g where a constraint is nonlinear.
    pub fn velocities(&self) -> &[Expr<'g>] {
        &self.velocities
    }

    /// The m × k matrix C as a function of (t, x), and also of η where a constraint is nonlinear.
    pub fn coefficients(&self) -> &Matrix<Expr<'g>> {
        &self.coefficients
    }

    /// The m symbols λ_α of the reactions, named `λ_` followed by the name of the constraint; outputs of the system
    /// may contain them.
    pub fn reactions(&self) -> &[Expr<'g>] {
        &self.reactions
    }

    /// Whether the constraint with this index is a condition on positions.
    pub fn is_holonomic(&self, constraint: usize) -> bool {
        self.constraints.get(constraint).is_some_and(|c| c.is_holonomic(&self.equations.system))
    }

    /// The equations in the velocities of the coordinates, η = a ẋ + a_0 (2): Lagrange's equations with multipliers.
    ///
    /// # Errors
    /// As for [`System::in_velocities`].
    pub fn in_velocities(&self) -> Result<Multipliers<'g>, MechError> {
        let system = &self.equations.system;
        let lagrange = system.in_velocities()?;
        let (graph, (a, a0)) = (system.graph(), system.frame.definitions()?);
        let definition =
            |s: usize| graph.dot(a.row(s).iter().copied(), lagrange.quasi_velocities.iter().copied()) + a0[s];
        let definitions: Vec<(Expr<'g>, Expr<'g>)> =
            system.quasi_velocities.iter().enumerate().map(|(s, &eta)| (eta, definition(s))).collect();
        let put = |constraint: &Constraint<'g>| Constraint {
            expression: graph.substitute(&[constraint.expression], &definitions)[0],
            ..constraint.clone()
        };
        lagrange.with_multipliers(&self.constraints.iter().map(put).collect::<Vec<_>>())
    }

    /// The equations with further constraints that are implied by the present ones. Where the present
    /// constraints are nearly dependent, they are replaced by those further constraints that are implied only
    /// where the present ones hold, just as the bars of an overconstrained mechanism take turns in carrying
    /// the load. The individual reactions are then undetermined, and NaN. A
    /// [projection](pc_expr::VectorField::project) of the compiled motion to a state where one of the further
    /// constraints does not vanish is refused, as [`ConstraintError::Departed`].
    #[must_use]
    pub fn followed_by(self, followers: &[Constraint<'g>]) -> Multipliers<'g> {
        Multipliers { followers: followers.to_vec(), ..self }
    }

    /// The k forces C_αs λ_α on the quasi-velocities, with the symbols λ.
    pub fn reaction_forces(&self) -> Vec<Expr<'g>> {
        let graph = self.equations.system.graph();
        let on = |s: usize| graph.dot(self.coefficients.column(s), self.reactions.iter().copied());
        (0..self.coefficients.columns()).map(on).collect()
    }

    /// The equations with the reactions as observables, which come after all other observables.
    #[must_use]
    pub fn observe_reactions(self) -> Multipliers<'g> {
        Multipliers { observed: true, ..self }
    }

    /// Compiles as [`compile_for`](Multipliers::compile_for) does with the default options.
    ///
    /// # Errors
    /// As there.
    pub fn compile(&self) -> Result<Motion, MechError> {
        self.compile_for(CompileOptions::default())
    }

    /// Compiles the equations as a vector field of the state (x, η), with its projection.
    ///
    /// # Errors
    /// [`ExprError::UnboundSymbol`](crate::ExprError::UnboundSymbol) for a symbol that is neither state nor declared
    /// parameter.
    pub fn compile_for(&self, options: impl Into<CompileOptions>) -> Result<Motion, MechError> {
        let (options, graph) = (options.into(), self.graph());
        if self.equations.system.tree.is_none() {
            return self.compile_here(&options);
        }
        let own = graph.page(graph.folding());
        self.in_graph(&own)?.compile_here(&options)
    }

    fn compile_here(&self, options: &CompileOptions) -> Result<Motion, MechError> {
        let whole = self.with_spare();
        let first_order = whole.first_order();
        let motion = first_order.compile(options, LONGEST_ELIMINATION)?;
        let motion = match whole.by_joints(options, self.rank)? {
            Some(schur) => motion.by_joints(schur),
            None => motion,
        };
        let names = whole.constraints.iter().map(|constraint| constraint.name.clone()).collect();
        Ok(motion.on_surface(names, whole.surface(&first_order)?))
    }

    /// The same equations with spare constraints after the others: implied constraints that are independent of
    /// the others away from the states that satisfy the constraints.
    fn with_spare(&self) -> Multipliers<'g> {
        let (system, mut whole) = (&self.equations.system, self.clone());
        let graph = system.graph();
        let mut rows = self.coefficients.to_rows();
        let along: Vec<_> = (system.frame.coordinates().iter().copied())
            .zip(self.equations.velocities().iter().copied())
            .chain(graph.in_time(system.frame.time()))
            .collect();
        for follower in &self.followers {
            let Ok((row, _)) = follower.coefficients(system) else { continue };
            if graph.generic_rank(&[self.coefficients.to_rows(), vec![row.clone()]].concat()) <= self.rank {
                continue;
            }
            let velocity = follower.velocity(system);
            rows.push(row);
            whole.constraints.push(follower.clone());
            whole.velocities.push(velocity);
            whole.right.push(-graph.directional(&[velocity], &along)[0]);
            whole.reactions.push(system.unused(format!("λ_{}", follower.name), "λ_"));
        }
        let k = self.coefficients.columns();
        whole.coefficients = Matrix::from_fn(rows.len(), k, |a, s| rows[a][s]);
        whole
    }

    /// The conversion between (x, η) and (x, y) with the momenta of all quasi-velocities, at states where the
    /// constraints hold:
    ///
    ///   ∂L/∂η − Cᵀ μ = y,   C η + c_0 = 0
    ///
    /// is solved for η and μ, which is regular even where L alone, without the constraints, does not determine η; μ =
    /// 0 for momenta that satisfy the constraints. `guess` is as for
    /// [`compile_in_momenta`](Multipliers::compile_in_momenta).
    ///
    /// # Errors
    /// As there.
    pub fn legendre_transform(&self, guess: &[f64]) -> Result<LegendreTransform, MechError> {
        let system = &self.equations.system;
        shape("the guess of the quasi-velocities", guess.len(), system.quasi_velocities.len())?;
        let momenta = system.momentum_symbols();
        let nearby = self.free_legendre_equations(&momenta, guess);
        let equations = self.legendre_equations(&momenta, guess)?;
        LegendreTransform::solving(system, &momenta, &equations, Some(&nearby))
    }

    /// The equations M η = y − p_0 for a quadratic L, p(η) = y for any other. For momenta that satisfy the
    /// constraints, these are the equations with multipliers.
    fn free_legendre_equations(&self, momenta: &[Expr<'g>], guess: &[f64]) -> FirstOrder<'g> {
        let (system, graph, eta) = (&self.equations.system, self.graph(), self.quasi_velocities());
        let (mass, right, implicit) = match quadratic(graph, system.lagrangian, eta) {
            Some(Quadratic { matrix: mass, linear: at_rest, .. }) => {
                (mass, momenta.iter().zip(&at_rest).map(|(&y, &p)| y - p).collect(), None)
            }
            None => {
                let left = system.momenta();
                let rows: Vec<Vec<Expr<'g>>> = left.iter().map(|&p| graph.gradient(p, eta)).collect();
                let mass = Matrix::from_fn(eta.len(), eta.len(), |i, j| rows[i][j]);
                (mass, momenta.to_vec(), Some(Implicit { left, guess: guess.to_vec() }))
            }
        };
        FirstOrder {
            state: system.state_with(momenta),
            holds: Vec::new(),
            parameters: system.parameters.clone(),
            unknowns: eta.to_vec(),
            multipliers: 0,
            mass,
            implicit,
            right,
            rates: Vec::new(),
            observables: Vec::new(),
            conserved: 0,
            ..self.first_order()
        }
    }

    /// The equations for w = (η, μ), without rates.
    fn legendre_equations(&self, momenta: &[Expr<'g>], guess: &[f64]) -> Result<FirstOrder<'g>, MechError> {
        let (system, graph, eta) = (&self.equations.system, self.graph(), self.quasi_velocities());
        let (k, m) = (eta.len(), self.reactions.len());
        let unknowns = [eta, &self.reactions].concat();
        let quadratic = quadratic(graph, system.lagrangian, eta).filter(|_| !self.is_nonlinear());
        let (mass, right, implicit) = if let Some(Quadratic { linear: at_rest, .. }) = quadratic {
            let drifts = self.constraints.iter().map(|constraint| Ok(constraint.coefficients(system)?.1));
            let drifts = drifts.collect::<Result<Vec<_>, MechError>>()?;
            let impulse = momenta.iter().zip(&at_rest).map(|(&y, &p)| y - p);
            (self.bordered(), impulse.chain(drifts).collect(), None)
        } else {
            let pushed = |s: usize| graph.dot(self.coefficients.column(s), self.reactions.iter().copied());
            let left: Vec<Expr<'g>> = (system.momenta().into_iter().enumerate())
                .map(|(s, p)| p - pushed(s))
                .chain(self.velocities.iter().map(|&g| -g))
                .collect();
            let rows: Vec<Vec<Expr<'g>>> = left.iter().map(|&f| graph.gradient(f, &unknowns)).collect();
            let right = momenta.iter().copied().chain(vec![Expr::ZERO; m]).collect();
            let guess = guess.iter().copied().chain(vec![0.0; m]).collect();
            (Matrix::from_fn(k + m, k + m, |i, j| rows[i][j]), right, Some(Implicit { left, guess }))
        };
        Ok(FirstOrder {
            state: system.state_with(momenta),
            holds: Vec::new(),
            parameters: system.parameters.clone(),
            unknowns,
            mass,
            implicit,
            right,
            rates: Vec::new(),
            observables: Vec::new(),
            conserved: 0,
            ..self.first_order()
        })
    }

    /// The indices of the quasi-velocities that are taken as dependent wherever the others determine them; empty if
    /// no choice was made.
    pub fn dependent(&self) -> &[usize] {
        self.dependent.as_deref().unwrap_or_default()
    }

    /// The same equations, with the quasi-velocities with these m indices as the dependent ones wherever the
    /// others determine them.
    #[must_use]
    pub fn depending(&self, dependent: Vec<usize>) -> Multipliers<'g> {
        Multipliers { dependent: Some(dependent), ..self.clone() }
    }

    pub(super) fn graph(&self) -> &'g pc_expr::Graph {
        self.equations.system.graph()
    }

    pub(super) fn quasi_velocities(&self) -> &[Expr<'g>] {
        &self.equations.system.quasi_velocities
    }

    /// The functions f(t, x) of the constraints on positions, then g(t, x, η) of all constraints.
    pub(crate) fn conditions(&self) -> Vec<Expr<'g>> {
        let positions = (0..self.constraints.len()).filter(|&a| self.is_holonomic(a));
        positions.map(|a| self.constraints[a].expression).chain(self.velocities.iter().copied()).collect()
    }

    fn surface(&self, first_order: &FirstOrder<'g>) -> Result<Surface, MechError> {
        let system = &self.equations.system;
        let (graph, eta) = (system.graph(), &system.quasi_velocities);
        let places: Vec<usize> = (0..self.constraints.len()).filter(|&a| self.is_holonomic(a)).collect();
        let positions: Vec<Expr<'g>> = places.iter().map(|&a| self.constraints[a].expression).collect();
        let (lower, entries) = first_order.lower_triangle();
        let b = system.frame.b();
        let displacements: Vec<Expr<'g>> =
            (0..b.rows()).map(|i| graph.dot(b.row(i).iter().copied(), eta.iter().copied())).collect();
        let named = |follower: &Constraint<'g>| {
            let position = follower.is_holonomic(system).then_some(follower.expression);
            let both = position.into_iter().chain([follower.velocity(system)]);
            both.map(|function| (follower.name.clone(), function)).collect::<Vec<_>>()
        };
        let followers: Vec<_> = self.followers.iter().flat_map(named).collect();
        let conditions = Conditions {
            followers: &followers,
            positions: &positions,
            places,
            velocities: &self.velocities,
            affine: !self.is_nonlinear(),
            displacements: &displacements,
            lower,
            bordered: &entries,
            quasi_velocities: eta.len(),
            rank: self.rank,
        };
        Ok(Surface::new(&first_order.inputs(&[]), conditions, graph)?)
    }

    /// The matrix of the equations M η̇ − Cᵀ λ = r, −C η̇ = (dC/dt) η + dc_0/dt.
    fn bordered(&self) -> Matrix<Expr<'g>> {
        let (mass, c) = (self.equations.mass_matrix(), &self.coefficients);
        let (k, size) = (mass.rows(), mass.rows() + c.rows());
        Matrix::from_fn(size, size, |i, j| match (i < k, j < k) {
            (true, true) => mass[(i, j)],
            (false, true) => -c[(i - k, j)],
            (true, false) => -c[(j - k, i)],
            (false, false) => Expr::ZERO,
        })
    }

    /// The case w = (η̇, λ), g = (b η + b_0, η̇).
    pub(crate) fn first_order(&self) -> FirstOrder<'g> {
        let plain = self.equations.first_order();
        let graph = plain.graph;
        let negative = self.right.iter().map(|&rate| -rate);
        let name = |reaction: &Expr<'g>| reaction.to_string();
        let mut observables = plain.observables;
        if self.observed {
            observables.extend(self.reactions.iter().map(|reaction| (name(reaction), *reaction)));
        }
        FirstOrder {
            graph,
            multipliers: self.reactions.len(),
            rank: self.rank,
            implicit: None,
            unknowns: plain.unknowns.into_iter().chain(self.reactions.iter().copied()).collect(),
            names: plain
                .names
                .into_iter()
                .chain(self.constraints.iter().map(|constraint| constraint.name.clone()))
                .collect(),
            mass: self.bordered(),
            right: plain.right.into_iter().chain(negative).collect(),
            observables,
            ..plain
        }
    }
}
