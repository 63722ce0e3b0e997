//! Voronets' equations (35) and Chaplygin's equations.

use pc_mech::{Equations, Expr, Graph, Matrix, Multipliers, System};

use crate::error::NonholoError;
use crate::reduction::adapted::affine;

/// A system in the velocities of its coordinates, whose constraints are solved for some of these velocities,
///
///   ẋ_r = α_ri ẋ_i + α_r,   i = 1..l, r = l+1..n,
///
/// and its equations of motion (35) in x_1..x_n and ẋ_1..ẋ_l,
///
///   d/dt ∂θ/∂ẋ_i = ∂(θ+U)/∂x_i + α_ri ∂(θ+U)/∂x_r + (c_ji^r ẋ_j + c_0i^r) (∂T/∂ẋ_r)_0 + Q_i + α_ri Q_r.
///
/// The coefficients are written out here, not taken from a frame:
///
///   c_ji^r = ∂α_ri/∂x_j − ∂α_rj/∂x_i + α_kj ∂α_ri/∂x_k − α_ki ∂α_rj/∂x_k,
///   c_0i^r = ∂α_ri/∂t − ∂α_r/∂x_i + α_k ∂α_ri/∂x_k − α_ki ∂α_r/∂x_k,   k = l+1..n.
#[derive(Clone, Debug)]
pub struct Voronets<'g> {
    /// The equations in velocities.
    multipliers: Multipliers<'g>,
    /// ẋ_r = α_ri ẋ_i + α_r
    solved: Vec<(Expr<'g>, Expr<'g>)>,
    independent: Vec<usize>,
    dependent: Vec<usize>,
    /// α_ri, (n − l) × l.
    coefficients: Matrix<Expr<'g>>,
    /// α_r
    drift: Vec<Expr<'g>>,
}

impl<'g> Voronets<'g> {
    /// Solves the constraints of `multipliers`, whose system must be in the [velocities](System::in_velocities) of its
    /// coordinates, for the velocities that they determine best at the values `at` of time, coordinates and velocities.
    ///
    /// # Errors
    /// [`NonholoError::NotInVelocities`]; [`NonholoError::Nonlinear`];
    /// [`ConstraintError::Singular`](pc_mech::ConstraintError::Singular) if the constraints are linearly dependent
    /// at `at`.
    pub fn new(multipliers: &Multipliers<'g>, at: &[(Expr<'g>, f64)]) -> Result<Voronets<'g>, NonholoError> {
        let system = multipliers.equations().system();
        let (graph, x, v) = (system.graph(), system.frame().coordinates(), system.quasi_velocities());
        if system.frame().velocities(v) != v {
            return Err(NonholoError::NotInVelocities);
        }
        affine(multipliers, "Voronets' equations")?;
        let dependent = multipliers.dependent_at(at)?;
        let independent: Vec<usize> = (0..x.len()).filter(|i| !dependent.contains(i)).collect();
        let solved = multipliers.solved_for(&dependent)?;
        let zeros: Vec<_> = independent.iter().map(|&i| (v[i], Expr::ZERO)).collect();
        let free: Vec<Expr<'g>> = independent.iter().map(|&i| v[i]).collect();
        let values: Vec<Expr<'g>> = solved.iter().map(|&(_, value)| value).collect();
        let rows: Vec<Vec<Expr<'g>>> =
            values.iter().map(|&value| graph.substitute(&graph.gradient(value, &free), &zeros)).collect();
        Ok(Voronets {
            coefficients: Matrix::from_fn(dependent.len(), free.len(), |r, i| rows[r][i]),
            drift: graph.substitute(&values, &zeros),
            multipliers: multipliers.clone(),
            solved,
            independent,
            dependent,
        })
    }

    /// Voronets' equations for the independent velocities that make the equations shortest, chosen as in
    /// [`Multipliers::shortest`].
    ///
    /// # Errors
    /// As for [`new`](Voronets::new).
    pub fn shortest(
        multipliers: &Multipliers<'g>,
        at: &[(Expr<'g>, f64)],
    ) -> Result<Voronets<'g>, NonholoError> {
        let equations = |held: &Multipliers<'g>| -> Result<Equations<'g>, NonholoError> {
            Ok(Voronets::new(held, at)?.system()?.poincare()?)
        };
        Voronets::new(&multipliers.shortest(at, equations)?, at)
    }

    /// The system in all n velocities, whose constraints were solved.
    pub fn held(&self) -> &System<'g> {
        self.multipliers.equations().system()
    }

    fn graph(&self) -> &'g Graph {
        self.held().graph()
    }

    fn time(&self) -> Expr<'g> {
        self.held().frame().time()
    }

    fn coordinates(&self) -> &[Expr<'g>] {
        self.held().frame().coordinates()
    }

    /// The symbols of the l independent coordinates x_i.
    pub fn independent(&self) -> Vec<Expr<'g>> {
        self.independent.iter().map(|&i| self.coordinates()[i]).collect()
    }

    /// The symbols of the n − l dependent coordinates x_r.
    pub fn dependent(&self) -> Vec<Expr<'g>> {
        self.dependent.iter().map(|&r| self.coordinates()[r]).collect()
    }

    /// The symbols of the n − l velocities ẋ_r for which the constraints are solved.
    pub fn solved_velocities(&self) -> Vec<Expr<'g>> {
        self.solved.iter().map(|&(velocity, _)| velocity).collect()
    }

    /// α_ri, (n − l) × l.
    pub fn coefficients(&self) -> &Matrix<Expr<'g>> {
        &self.coefficients
    }

    /// α_r, length n − l.
    pub fn drift(&self) -> &[Expr<'g>] {
        &self.drift
    }

    /// The derivatives ∂f/∂x_i + α_ri ∂f/∂x_r of functions f of t and x; for i = 0, ∂f/∂t + α_r ∂f/∂x_r.
    fn along(&self, i: usize, functions: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let dependent = self.dependent().into_iter();
        let rates: Vec<(Expr<'g>, Expr<'g>)> = match i.checked_sub(1) {
            None => {
                dependent.zip(self.drift.iter().copied()).chain(self.graph().in_time(self.time())).collect()
            }
            Some(i) => dependent
                .zip(self.coefficients.column(i))
                .chain([(self.independent()[i], Expr::ONE)])
                .collect(),
        };
        self.graph().directional(functions, &rates)
    }

    /// The coefficients c_ji^r of (35), one for each of the n − l dependent coordinates, where j = 0..l, with
    /// 0 for time, and i = 1..l.
    ///
    /// # Panics
    /// Panics if j or i is greater than l.
    pub fn structure(&self, j: usize, i: usize) -> Vec<Expr<'g>> {
        let column = |i: usize| match i.checked_sub(1) {
            None => self.drift.clone(),
            Some(i) => self.coefficients.column(i).collect::<Vec<_>>(),
        };
        let forth = self.along(j, &column(i));
        let back = self.along(i, &column(j));
        forth.into_iter().zip(back).map(|(forth, back)| forth - back).collect()
    }

    /// The system of the independent velocities whose equations (9) are (35): its Lagrangian is θ + U, and the terms
    /// that are lost when the constraints are substituted are added to the forces.
    ///
    /// # Errors
    /// [`NonholoError::Mech`] if the parts were inconsistent, which cannot happen.
    pub fn system(&self) -> Result<System<'g>, NonholoError> {
        let (system, graph) = (self.held(), self.graph());
        let v = system.quasi_velocities();
        let free: Vec<Expr<'g>> = self.independent.iter().map(|&i| v[i]).collect();
        let dropped: Vec<Expr<'g>> = self.dependent.iter().map(|&r| v[r]).collect();
        let momenta = graph.substitute(&graph.gradient(system.lagrangian(), &dropped), &self.solved);
        let lost = |i: usize| {
            let rates = std::iter::once(Expr::ONE).chain(free.iter().copied()).enumerate();
            graph.sum(rates.map(|(j, rate)| rate * graph.dot(self.structure(j, i), momenta.iter().copied())))
        };
        let lost: Vec<Expr<'g>> = (1..=free.len()).map(lost).collect();
        let flat = system.structure().restricted(free.len()); // those of velocities vanish
        Ok(self.multipliers.eliminated(&self.solved, flat)?.with_added_forces(&lost)?)
    }

    /// Whether the equations are Chaplygin's: L, Q and the coefficients do not depend on the dependent
    /// coordinates, and the α_r vanish. Then the equations of the independent coordinates can be integrated
    /// by themselves.
    pub fn is_chaplygin(&self) -> bool {
        let system = self.held();
        let parts: Vec<Expr<'g>> = std::iter::once(system.lagrangian())
            .chain(system.forces().iter().copied())
            .chain(self.coefficients.nonzero_entries())
            .collect();
        let free_of =
            |x: Expr<'g>| system.graph().directional(&parts, &[(x, Expr::ONE)]).iter().all(|d| d.is_zero());
        self.drift.iter().all(|a| a.is_zero()) && self.dependent().into_iter().all(free_of)
    }
}
