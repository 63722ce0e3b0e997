//! Poincaré's equations (9), solved for the accelerations.

use std::cell::OnceCell;

use pc_algebra::Matrix;
use pc_expr::Expr;

use crate::error::{LagrangianError, MechError, ShapeError};
use crate::system::system::System;

/// The equations of motion ẋ = b η + b_0 (3), M η̇ = r, which are (9) with n coordinates and k
/// quasi-velocities, or (30) with l free quasi-velocities instead of k.
#[derive(Clone, Debug)]
pub struct Equations<'g> {
    pub(crate) system: System<'g>,
    velocities: Vec<Expr<'g>>,
    energy: Expr<'g>,
    /// The momenta ∂L/∂η_α, α > l, of the quasi-velocities that constraints make vanish, where these hold.
    vanished: Vec<Expr<'g>>,
    /// The matrices M and r; for a large tree they are derived when first used.
    matrices: OnceCell<Matrices<'g>>,
}

/// M η̇ = r.
#[derive(Clone, Debug)]
struct Matrices<'g> {
    mass: Matrix<Expr<'g>>,
    right: Vec<Expr<'g>>,
}

impl<'g> Matrices<'g> {
    /// Matrices of undefined entries, for a derivation that failed; the failure is reported when they are
    /// used.
    fn undefined(size: usize) -> Matrices<'g> {
        let undefined = Expr::ONE / Expr::ZERO;
        Matrices { mass: Matrix::from_fn(size, size, |_, _| undefined), right: vec![undefined; size] }
    }
}

impl<'g> System<'g> {
    /// Poincaré's equations (9)
    ///
    ///   d/dt ∂L/∂η_s = (c_rs^m η_r + c_0s^m) ∂L/∂η_m + X_s L + Q_s
    ///
    /// in the form M η̇ = r with M = ∂²L/∂η∂η and r = v + X L + Q − (∂²L/∂η∂x) ẋ − (∂²L/∂η∂z) ż − ∂²L/∂η∂t.
    ///
    /// # Errors
    /// [`LagrangianError::Degenerate`] if M is singular everywhere.
    pub fn poincare(&self) -> Result<Equations<'g>, MechError> {
        self.poincare_constrained(self.quasi_velocities.len())
    }

    /// The equations (30) of the system with nonholonomic constraints η_α = 0, α > `free`:
    ///
    ///   d/dt ∂L/∂η_s = (c_rs^m η_r + c_0s^m) ∂L/∂η_m + X_s L + Q_s,   s, r = 1..`free`, m = 1..k.
    ///
    /// The constraints are substituted after differentiation, so that all k momenta contribute. The
    /// [system](Equations::system) of the result has only the free quasi-velocities. With `free` = k these
    /// are the equations (9).
    ///
    /// # Errors
    /// [`LagrangianError::Degenerate`]; [`ShapeError`] if there are fewer than `free` quasi-velocities.
    pub fn poincare_constrained(&self, free: usize) -> Result<Equations<'g>, MechError> {
        self.graph().stage("Poincaré's equations", || {
            if let Some(tree) = self.tree.as_ref().filter(|_| free == self.quasi_velocities.len())
                && tree.is_large()
            {
                return Ok(Equations {
                    system: self.clone(),
                    velocities: self.frame.velocities(&self.quasi_velocities),
                    energy: tree.energy(),
                    vanished: Vec::new(),
                    matrices: OnceCell::new(),
                });
            }
            let equations = self.equations(free)?;
            equations.system.check_regular(equations.mass_matrix())?;
            Ok(equations)
        })
    }

    /// The equations (30) for any M, singular or not.
    pub(crate) fn equations(&self, free: usize) -> Result<Equations<'g>, MechError> {
        let graph = self.graph();
        let all = &self.quasi_velocities;
        if free > all.len() {
            let what = "the list of free quasi-velocities";
            return Err(ShapeError { what, found: free, expected: all.len() }.into());
        }
        let (x, t) = (self.frame.coordinates(), self.frame.time());
        let variables: Vec<Expr<'g>> = all.iter().chain(x).copied().collect();
        let gradient = graph.gradient(self.lagrangian, &variables);

        let constraints: Vec<_> = all[free..].iter().map(|&eta| (eta, Expr::ZERO)).collect();
        let on_constraints = |expressions: &[Expr<'g>]| graph.substitute(expressions, &constraints);
        let gradient = on_constraints(&gradient);
        let (momenta, slope) = gradient.split_at(all.len());
        let mut system = self.restricted(free);
        if free == all.len() {
            // No constraint was put in.
            system.tree.clone_from(&self.tree);
            system.bodies.others = self.bodies.others;
        }
        let eta = &system.quasi_velocities;
        let velocities = system.frame.velocities(eta);

        let mass = symmetric(&graph.jacobian(&momenta[..free], eta));

        let along: Vec<_> = x
            .iter()
            .copied()
            .zip(velocities.iter().copied())
            .chain(graph.in_time(t))
            .chain(system.states.iter().copied())
            .collect();
        let transport = graph.directional(&momenta[..free], &along);
        let gyroscopic = self.structure.gyroscopic(graph, &on_constraints(all), momenta);
        let potential = system.frame.contract(slope);
        let right: Vec<Expr<'g>> = (0..free)
            .map(|s| graph.sum([gyroscopic[s], potential[s], system.forces[s], -transport[s]]))
            .collect();

        let energy = graph.dot(momenta.iter().copied(), eta.iter().copied()) - system.lagrangian;
        graph.check(&right)?;
        graph.check(&mass.nonzero_entries())?;

        // Collected by products of quasi-velocities, then by parameters, as in a book.
        let order = system.collecting_order();
        let shorten = |expressions: &[Expr<'g>]| graph.shorten(expressions, &order);
        let mass = mass.with_nonzero_entries(&shorten(&mass.nonzero_entries()));
        Ok(Equations {
            velocities,
            energy: shorten(&[energy])[0],
            vanished: momenta[free..].to_vec(),
            matrices: OnceCell::from(Matrices { mass, right: shorten(&right) }),
            system,
        })
    }

    pub(crate) fn check_regular(&self, mass: &Matrix<Expr<'g>>) -> Result<(), MechError> {
        let size = mass.rows();
        let graph = self.graph();
        let rows = mass.nonzero_rows();
        let rank_of_first = |count: usize| graph.generic_rank_of_entries(size, &rows[..count]);
        let rank = rank_of_first(size);
        if rank == size {
            return Ok(());
        }
        // A row that adds nothing to the rank of those before it belongs to an undetermined quasi-velocity.
        let undetermined = (0..size).filter(|&s| rank_of_first(s + 1) == rank_of_first(s));
        let quasi_velocities = undetermined.map(|s| self.quasi_velocities[s].to_string()).collect();
        Err(LagrangianError::Degenerate { rank, size, quasi_velocities }.into())
    }
}

impl<'g> Equations<'g> {
    /// The system from which the equations were derived.
    pub fn system(&self) -> &System<'g> {
        &self.system
    }

    /// ẋ = b η + b_0 (3), length n.
    pub fn velocities(&self) -> &[Expr<'g>] {
        &self.velocities
    }

    /// M = ∂²L/∂η∂η, k × k and symmetric.
    pub fn mass_matrix(&self) -> &Matrix<Expr<'g>> {
        &self.matrices().mass
    }

    /// The right-hand side r of M η̇ = r, of length k.
    pub fn right_hand_side(&self) -> &[Expr<'g>] {
        &self.matrices().right
    }

    /// The momenta ∂L/∂η_α, α > l, of the quasi-velocities that constraints make vanish, where these hold.
    pub(crate) fn vanished_momenta(&self) -> &[Expr<'g>] {
        &self.vanished
    }

    fn matrices(&self) -> &Matrices<'g> {
        self.matrices.get_or_init(|| {
            let k = self.system.quasi_velocities.len();
            let derived = self.system.equations(k).ok().and_then(|derived| derived.matrices.into_inner());
            derived.unwrap_or_else(|| Matrices::undefined(k))
        })
    }

    /// The energy y_s η_s − L in terms of (t, x, η).
    pub fn energy(&self) -> Expr<'g> {
        self.energy
    }

    /// The same equations with some symbols in integrals and outputs replaced, such as the symbols of
    /// reactions.
    #[must_use]
    pub fn with_observed(&self, known: &[(Expr<'g>, Expr<'g>)]) -> Equations<'g> {
        Equations { system: self.system.with_observed(known), ..self.clone() }
    }

    /// The same equations with the parameters replaced by their values.
    #[must_use]
    pub fn with_parameters_bound(&self) -> Equations<'g> {
        let system = self.system.with_parameters_bound();
        let graph = system.graph();
        let numbers = self.system.numbers();
        let order = system.collecting_order();
        let bind = |expressions: &[Expr<'g>]| graph.shorten(&graph.substitute(expressions, &numbers), &order);
        let bound = |matrices: &Matrices<'g>| {
            let mass = matrices.mass.with_nonzero_entries(&bind(&matrices.mass.nonzero_entries()));
            OnceCell::from(Matrices { mass, right: bind(&matrices.right) })
        };
        Equations {
            velocities: graph.substitute(&self.velocities, &numbers),
            energy: bind(&[self.energy])[0],
            vanished: graph.substitute(&self.vanished, &numbers),
            matrices: self.matrices.get().map_or_else(OnceCell::new, bound),
            system,
        }
    }
}

/// The symmetric matrix with these nonzero entries on and below the diagonal, row by row; entries above it
/// are ignored.
fn symmetric<'g>(rows: &[Vec<(usize, Expr<'g>)>]) -> Matrix<Expr<'g>> {
    let mut both = vec![Vec::new(); rows.len()];
    for (r, row) in rows.iter().enumerate() {
        for &(s, entry) in row.iter().filter(|&&(s, _)| s <= r) {
            both[r].push((s, entry));
            if s < r {
                both[s].push((r, entry));
            }
        }
    }
    Matrix::from_rows(rows.len(), both)
}
