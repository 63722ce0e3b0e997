//! Chetaev's canonical equations (10), (11).

use pc_algebra::{Matrix, determinant};
use pc_expr::{Expr, Graph, Style};

use crate::compiled::compile::LONGEST_ELIMINATION;
use crate::compiled::elimination::symbolic_ldl::Factors;
use crate::compiled::first_order::{FirstOrder, Implicit};
use crate::compiled::legendre_transform::LegendreTransform;
use crate::compiled::motion::Motion;
use crate::compiled::options::CompileOptions;
use crate::compiled::projection::unit_quaternions::UnitQuaternions;
use crate::equations::book::{expanded, sums_of_products};
use crate::equations::legendre::{Inverse, Legendre};
use crate::error::{LagrangianError, MechError, shape};
use crate::system::system::System;

/// The number of rows of the largest block of the mass matrix that is inverted by cofactors.
const MOST_COFACTORS: usize = 3;

/// The canonical equations in coordinates and momenta y_s = ∂L/∂η_s, with H(t, x, y) = y_s η_s − L:
///
///   ẏ_s = (c_rs^m ∂H/∂y_r + c_0s^m) y_m − X_s H + Q_s   (10),   ẋ_i = b_i0 + b_is ∂H/∂y_s   (11).
///
/// X_s H being taken at fixed y. With η = ẋ these are Hamilton's equations, or, in redundant coordinates, (17)
/// and, in quasi-coordinates, (19).
#[derive(Clone, Debug)]
pub struct Canonical<'g> {
    system: System<'g>,
    pub(crate) legendre: Legendre<'g>,
    momenta: Vec<Expr<'g>>,
    quasi_velocities: Vec<Expr<'g>>,
    hamiltonian: Expr<'g>,
    velocities: Vec<Expr<'g>>,
    right: Vec<Expr<'g>>,
    /// ż
    state_rates: Vec<Expr<'g>>,
}

impl<'g> System<'g> {
    /// The symbols of the k momenta y_s, named `p_` followed by the name of the quasi-velocity; `p_x` for the
    /// velocity `x'`.
    pub fn momentum_symbols(&self) -> Vec<Expr<'g>> {
        let name = |eta: &Expr<'g>| format!("p_{}", eta.to_string().trim_end_matches('\''));
        self.all_unused(self.quasi_velocities.iter().map(name), "p_")
    }

    /// The canonical equations (10), (11): [closed](Canonical::is_closed) in (t, x, y) where L is quadratic in the
    /// quasi-velocities, else in (t, x, y, η).
    ///
    /// # Errors
    /// [`LagrangianError::Degenerate`] if y = ∂L/∂η does not determine η.
    ///
    /// ```
    /// use pc_mech::{Graph, System, VectorField};
    ///
    /// // A relativistic particle, c = 1: y = η/√(1 − η²).
    /// let graph = Graph::new();
    /// let particle = System::builder(&graph)
    ///     .coordinates(["x"])
    ///     .lagrangian(|_, x, v| -(1.0 - v[0].square()).sqrt() + x[0])
    ///     .build()?;
    /// let canonical = particle.canonical()?;
    /// assert!(!canonical.is_closed());
    /// let mut motion = canonical.compile_for(pc_mech::Backend::Fastest)?;
    /// let mut rates = [0.0; 2];
    /// motion.rhs(0.0, &[0.0, 0.75], &mut rates)?;
    /// assert!((rates[0] - 0.6).abs() < 1e-15 && rates[1] == 1.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn canonical(&self) -> Result<Canonical<'g>, MechError> {
        let graph = self.graph();
        let legendre = Legendre::of(self)?;
        let momenta = self.momentum_symbols();
        let order: Vec<Expr<'g>> = momenta.iter().copied().chain(self.collecting_order()).collect();

        // X_s H at fixed y is −X_s L at fixed η.
        let (eta, hamiltonian, differentiated) = match &legendre.inverse {
            Inverse::Closed { momenta_at_rest, lagrangian_at_rest } => {
                let impulse = impulse(&momenta, momenta_at_rest);
                let eta = graph.shorten(&solution(graph, &legendre.mass, &impulse, &order), &order);
                let kinetic = graph.dot(impulse.iter().copied(), eta.iter().copied()) / 2.0;
                let hamiltonian = graph.shorten(&[kinetic - *lagrangian_at_rest], &order)[0];
                (eta, hamiltonian, hamiltonian)
            }
            Inverse::Implicit { .. } => {
                let eta = self.quasi_velocities.clone();
                let power = graph.dot(momenta.iter().copied(), eta.iter().copied());
                let hamiltonian = graph.shorten(&[power - self.lagrangian], &order)[0];
                (eta, hamiltonian, -self.lagrangian)
            }
        };

        let slope = self.frame.contract(&graph.gradient(differentiated, self.frame.coordinates()));
        let gyroscopic = self.structure.gyroscopic(graph, &eta, &momenta);
        let values: Vec<_> = self.quasi_velocities.iter().copied().zip(eta.iter().copied()).collect();
        let forces = graph.substitute(&self.forces, &values);
        let right: Vec<Expr<'g>> =
            (0..eta.len()).map(|s| graph.sum([gyroscopic[s], -slope[s], forces[s]])).collect();
        graph.check(&right)?;
        let state_rates: Vec<Expr<'g>> = self.states.iter().map(|&(_, rate)| rate).collect();
        Ok(Canonical {
            state_rates: graph.shorten(&graph.substitute(&state_rates, &values), &order),
            velocities: graph.shorten(&self.frame.velocities(&eta), &order),
            right: graph.shorten(&right, &order),
            system: self.clone(),
            quasi_velocities: eta,
            legendre,
            momenta,
            hamiltonian,
        })
    }
}

/// The solution η of M η = y − p_0, found for each small block of M from cofactors over the determinant: once
/// expanded, the expressions look as in a book, and they are regular where M is.
fn solution<'g>(
    graph: &'g Graph,
    mass: &Matrix<Expr<'g>>,
    impulse: &[Expr<'g>],
    order: &[Expr<'g>],
) -> Vec<Expr<'g>> {
    let mut eta = vec![Expr::ZERO; impulse.len()];
    for block in blocks(mass) {
        let right: Vec<Expr<'g>> = block.iter().map(|&s| impulse[s]).collect();
        let of_block = Matrix::from_fn(block.len(), block.len(), |r, s| mass[(block[r], block[s])]);
        let by_cofactors =
            if block.len() <= MOST_COFACTORS { cofactors(graph, &of_block, order) } else { None };
        let solved = match by_cofactors {
            Some(inverse) => (0..block.len())
                .map(|r| graph.dot(inverse.row(r).iter().copied(), right.iter().copied()))
                .collect(),
            None => Factors::of(graph, &of_block).solve(graph, &right),
        };
        for (&s, value) in block.iter().zip(solved) {
            eta[s] = value;
        }
    }
    eta
}

/// The inverse of a symmetric matrix as cofactors over the determinant, with the terms of both collected.
fn cofactors<'g>(
    graph: &'g Graph,
    matrix: &Matrix<Expr<'g>>,
    order: &[Expr<'g>],
) -> Option<Matrix<Expr<'g>>> {
    let size = matrix.rows();
    let short = |matrix: &Matrix<Expr<'g>>| Some(graph.shorten(&[determinant(graph, matrix)?], order)[0]);
    let whole = short(matrix).filter(|whole| !whole.is_zero())?;
    let mut entries = Vec::with_capacity(size * size);
    for (i, j) in (0..size * size).map(|at| (at / size, at % size)) {
        let skip = |at: usize, place: usize| if at < place { at } else { at + 1 };
        let minor = Matrix::from_fn(size - 1, size - 1, |r, s| matrix[(skip(r, i), skip(s, j))]);
        let sign = if (i + j).is_multiple_of(2) { 1 } else { -1 };
        entries.push(short(&minor)? * sign / whole);
    }
    Some(Matrix::from_fn(size, size, |i, j| entries[i * size + j]))
}

/// The sets of rows that are coupled by entries of a symmetric matrix, each in ascending order.
fn blocks(matrix: &Matrix<Expr<'_>>) -> Vec<Vec<usize>> {
    let mut open: Vec<usize> = (0..matrix.rows()).collect();
    let mut blocks = Vec::new();
    while !open.is_empty() {
        let mut block = vec![open.remove(0)];
        let mut next = 0;
        while let Some(&row) = block.get(next) {
            let (tied, rest): (Vec<usize>, Vec<usize>) =
                open.into_iter().partition(|&s| !matrix[(row, s)].is_zero());
            block.extend(tied);
            open = rest;
            next += 1;
        }
        block.sort_unstable();
        blocks.push(block);
    }
    blocks
}

/// M η = y − p_0
fn impulse<'g>(momenta: &[Expr<'g>], at_rest: &[Expr<'g>]) -> Vec<Expr<'g>> {
    momenta.iter().zip(at_rest).map(|(&y, &p)| y - p).collect()
}

impl<'g> Canonical<'g> {
    /// The system from which the equations were derived.
    pub fn system(&self) -> &System<'g> {
        &self.system
    }

    /// Whether the solution η of y = ∂L/∂η is an expression, as it is where L is quadratic in η.
    ///
    /// Otherwise the expressions of these equations contain the symbols η as well as (t, x, y), and hold where y =
    /// ∂L/∂η; once [compiled](Canonical::compile_for), the equations solve y = ∂L/∂η by Newton's method.
    pub fn is_closed(&self) -> bool {
        matches!(self.legendre.inverse, Inverse::Closed { .. })
    }

    /// # Errors
    /// [`LagrangianError::NotQuadratic`] if the equations are not [closed](Canonical::is_closed).
    pub(crate) fn check_closed(&self) -> Result<(), MechError> {
        match &self.legendre.inverse {
            Inverse::Closed { .. } => Ok(()),
            Inverse::Implicit { quasi_velocity, .. } => {
                Err(LagrangianError::NotQuadratic { quasi_velocity: quasi_velocity.to_string() }.into())
            }
        }
    }

    /// The same equations with a guess η, of length k, from which Newton's method starts to solve y = ∂L/∂η. The
    /// default is η = 0; closed equations need none.
    ///
    /// The guess should be in the domain of L, away from its boundary, and M = ∂²L/∂η∂η should be regular there.
    /// Where L is not convex in η, several η may have the same momenta, and the guess decides which of them is found.
    ///
    /// # Errors
    /// [`ShapeError`](crate::ShapeError)
    pub fn with_guess(mut self, eta: &[f64]) -> Result<Canonical<'g>, MechError> {
        shape("the guess of the quasi-velocities", eta.len(), self.momenta.len())?;
        if let Inverse::Implicit { guess, .. } = &mut self.legendre.inverse {
            guess.copy_from_slice(eta);
        }
        Ok(self)
    }

    /// The symbols y_1..y_k of the momenta.
    pub fn momenta(&self) -> &[Expr<'g>] {
        &self.momenta
    }

    /// The k momenta y_s = ∂L/∂η_s in terms of (t, x, η).
    pub fn momenta_of_velocities(&self) -> &[Expr<'g>] {
        &self.legendre.momenta
    }

    /// The k quasi-velocities η_s = ∂H/∂y_s in terms of (t, x, y); the symbols η_s where the equations are not
    /// [closed](Canonical::is_closed).
    pub fn quasi_velocities(&self) -> &[Expr<'g>] {
        &self.quasi_velocities
    }

    /// The k quasi-velocities η_s = ∂H/∂y_s in terms of (t, x, y).
    ///
    /// # Errors
    /// [`LagrangianError::NotQuadratic`] if the equations are not [closed](Canonical::is_closed).
    pub fn closed_quasi_velocities(&self) -> Result<&[Expr<'g>], MechError> {
        self.check_closed().map(|()| self.quasi_velocities.as_slice())
    }

    /// The Hamiltonian H(t, x, y), or y_s η_s − L where the equations are not [closed](Canonical::is_closed):
    /// the derivatives of y_s η_s − L with respect to t, x and y at fixed η are those of H, since ∂/∂η_s (y_r
    /// η_r − L) = 0 at the solution.
    pub fn hamiltonian(&self) -> Expr<'g> {
        self.hamiltonian
    }

    /// The n velocities ẋ_i (11) in terms of (t, x, y), or of (t, x, η) where the equations are not
    /// [closed](Canonical::is_closed).
    pub fn velocities(&self) -> &[Expr<'g>] {
        &self.velocities
    }

    /// The k rates ẏ_s (10) in terms of (t, x, y), or of (t, x, y, η) where the equations are not
    /// [closed](Canonical::is_closed).
    pub fn right_hand_side(&self) -> &[Expr<'g>] {
        &self.right
    }

    /// The rates ż of the first-order [states](System::states) in the same terms.
    pub fn state_rates(&self) -> &[Expr<'g>] {
        &self.state_rates
    }

    /// The two sides of the equations (10), as k pairs of texts: sums of products of momenta.
    pub fn balance(&self, style: Style) -> Vec<(String, String)> {
        let graph = self.system.graph();
        let sides = self.momenta.iter().zip(&self.right);
        sides
            .map(|(y, &right)| {
                let left = graph.symbol(&format!("{y}'")).display(style);
                (left, expanded(&self.system, right, &self.momenta, style))
            })
            .collect()
    }

    /// The right-hand sides of the [balance](Canonical::balance) in their written form, in the graph `page`;
    /// none for right-hand sides that are not polynomials, which are written
    /// [unchanged](Canonical::right_hand_side).
    pub fn written<'p>(&self, page: &'p Graph) -> Vec<Option<Expr<'p>>> {
        sums_of_products(&self.system, &self.right, &self.momenta, page)
    }

    /// Compiles the equations as a vector field of the state (x, y); integrals, energy and outputs are observed,
    /// as they are for [`Equations`](crate::Equations).
    ///
    /// Where they are not [closed](Canonical::is_closed), each evaluation solves y = ∂L/∂η for η to rounding accuracy,
    /// from the same [guess](Canonical::with_guess), so that the result depends on (t, x, y) only; if the iteration
    /// from the guess does not converge, it starts from the last solution. The evaluation fails, recoverably, with
    /// [`EvaluationError::LegendreNotSolved`](crate::EvaluationError::LegendreNotSolved) where the iteration converges
    /// from neither, and with [`EvaluationError::SingularMassMatrix`](crate::EvaluationError::SingularMassMatrix)
    /// where a pivot of M = ∂²L/∂η∂η vanishes.
    ///
    /// # Errors
    /// As for [`Equations::compile_for`](crate::Equations::compile_for).
    pub fn compile_for(&self, options: impl Into<CompileOptions>) -> Result<Motion, MechError> {
        self.observed_first_order()?.compile(&options.into(), LONGEST_ELIMINATION)
    }

    /// Compiles the conversion between quasi-velocities and momenta.
    ///
    /// # Errors
    /// [`ExprError::UnboundSymbol`](pc_expr::ExprError::UnboundSymbol) for a symbol that is neither state nor
    /// declared parameter.
    pub fn legendre_transform(&self) -> Result<LegendreTransform, MechError> {
        // External forces occur in none of these equations.
        let equations = FirstOrder { parameters: self.system.parameters().to_vec(), ..self.first_order() };
        let of_velocities = self.momenta_of_velocities();
        LegendreTransform::unconstrained(
            &self.system,
            &self.momenta,
            of_velocities,
            &equations,
            &self.quasi_velocities,
        )
    }

    /// The [first-order](Canonical::first_order) system with its observables.
    pub(crate) fn observed_first_order(&self) -> Result<FirstOrder<'g>, MechError> {
        let (observables, conserved) = (self.observables()?, self.system.integrals.len() + 1);
        Ok(FirstOrder { observables, conserved, ..self.first_order() })
    }

    /// The equations with w = η, M η = y − p_0 or ∂L/∂η = y: H is not needed, since X_s H = −X_s L at fixed y
    /// and η. Observables are not included.
    pub(crate) fn first_order(&self) -> FirstOrder<'g> {
        let (system, graph) = (&self.system, self.system.graph());
        let (x, eta) = (system.frame.coordinates(), &system.quasi_velocities);
        let slope = system.frame.contract(&graph.gradient(system.lagrangian, x));
        let gyroscopic = system.structure.gyroscopic(graph, eta, &self.momenta);
        let mut rates = system.frame.velocities(eta);
        rates.extend((0..eta.len()).map(|s| graph.sum([gyroscopic[s], slope[s], system.forces[s]])));
        rates.extend(system.states.iter().map(|&(_, rate)| rate));
        let parameters = system.parameters.iter().map(|&(symbol, _)| symbol);
        let (right, implicit) = match &self.legendre.inverse {
            Inverse::Closed { momenta_at_rest, .. } => (impulse(&self.momenta, momenta_at_rest), None),
            Inverse::Implicit { guess, .. } => {
                let implicit = Implicit { left: self.legendre.momenta.clone(), guess: guess.clone() };
                (self.momenta.clone(), Some(implicit))
            }
        };
        FirstOrder {
            points: None,
            tree: None,
            graph,
            time: system.frame.time(),
            state: system.state_with(&self.momenta),
            coordinates: x.len(),
            states: system.states.len(),
            parameters: system.run_time_inputs(),
            varying: system.varying_inputs(),
            unknowns: eta.clone(),
            names: eta.iter().map(Expr::to_string).collect(),
            multipliers: 0,
            rank: 0,
            mass: self.legendre.mass.clone(),
            implicit,
            right,
            holds: Vec::new(),
            rates: graph.shorten(&rates, &system.collecting_order()),
            collected_by: self.momenta.iter().copied().chain(parameters).collect(),
            observables: Vec::new(),
            conserved: 0,
            quaternions: UnitQuaternions::of(system),
        }
    }

    /// Integrals, energy and outputs in terms of (t, x, y, η).
    fn observables(&self) -> Result<Vec<(String, Expr<'g>)>, MechError> {
        let (system, graph) = (&self.system, self.system.graph());
        // An error in η changes y_s η_s − L only to second order.
        let energy = if self.is_closed() { system.energy() } else { self.hamiltonian };
        let energy = ("energy".to_owned(), energy);
        let mut observables: Vec<_> =
            system.integrals.iter().chain([&energy]).chain(&system.outputs).cloned().collect();
        let symbols = system.accelerations();
        let values: Vec<Expr<'g>> = observables.iter().map(|&(_, value)| value).collect();
        if graph.symbols_of(&values).iter().any(|symbol| symbols.contains(symbol)) {
            let rates: Vec<_> = symbols.into_iter().zip(system.poincare()?.accelerations()).collect();
            for (_, value) in &mut observables {
                *value = graph.substitute(&[*value], &rates)[0];
            }
        }
        Ok(observables)
    }
}
