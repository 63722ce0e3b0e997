//! Active forces and forces of inertia along independent quasi-velocities: Kane's and Gibbs–Appell's equations.

use pc_algebra::Matrix;
use pc_expr::{Expr, Graph};

use crate::equations::book::sums_of_products;
use crate::error::{LagrangianError, MechError, shape};
use crate::system::system::System;

/// The balance of active forces and forces of inertia in l independent quasi-velocities,
///
///   F_s + F*_s = 0,   F*_s = −(M_sr η̇_r + h_s),   s, r = 1..l.
///
/// These are Kane's equations [T. R. Kane, D. A. Levinson, *Dynamics* (1985), sec. 4.11 and 6.1]. With Gibbs' function, the
/// energy of the accelerations up to terms without η̇,
///
///   S = ½ M_rs η̇_r η̇_s + h_s η̇_s,
///
/// they are Gibbs–Appell's equations ∂S/∂η̇_s = F_s [J. I. Neimark, N. A. Fufaev, *Dynamics of Nonholonomic
/// Systems* (1972), ch. III].
///
/// Inertia is the part of L that vanishes with its slope at rest, ẋ = 0: ½ g_ij ẋ_i ẋ_j of a quadratic L. The rest of L, such
/// as a force function or the potential of magnetic forces, counts as a force: F_s comes from it and from Q. Where the
/// quasi-velocities do not follow from ẋ, because there are fewer of them than coordinates, η = 0 takes the place of rest.
#[derive(Clone, Debug)]
pub struct ForceBalance<'g> {
    /// The system before constraints.
    system: System<'g>,
    free: Vec<Expr<'g>>,
    accelerations: Vec<Expr<'g>>,
    mass: Matrix<Expr<'g>>,
    inertia: Vec<Expr<'g>>,
    active: Vec<Expr<'g>>,
}

impl<'g> System<'g> {
    /// The balance of active forces and forces of inertia in the quasi-velocities `free`, of which the k quasi-velocities of
    /// this system are the functions `values`(t, x, η), affine in η.
    ///
    /// The expressions of all k equations (9) are projected along the velocities that remain,
    ///
    ///   Σ_σ (M_στ η̇_τ − r_σ) ∂η_σ/∂η_s = 0,   σ, τ = 1..k,
    ///
    /// so that no brackets of the remaining operators are needed, and constraints of any kind may have left these.
    ///
    /// ```
    /// use pc_mech::{Graph, System};
    ///
    /// // A particle that slides on the line y = a x.
    /// let graph = Graph::new();
    /// let particle = System::builder(&graph)
    ///     .coordinates(["x", "y"])
    ///     .lagrangian(|_, x, v| (v[0].square() + v[1].square()) / 2.0 - 10.0 * x[1])
    ///     .build()?;
    /// let [a, vx] = graph.symbols(["a", "x'"]);
    /// let balance = particle.force_balance(&[vx], &[vx, a * vx])?;
    /// assert!((balance.active()[0] + 10.0 * a).is_zero());
    /// assert!((balance.mass_matrix()[(0, 0)] - 1.0 - a.square()).is_zero());
    /// # Ok::<(), pc_mech::MechError>(())
    /// ```
    ///
    /// # Errors
    /// [`ShapeError`](crate::ShapeError) if there are not k `values`; [`LagrangianError::NoRest`] if L or ∂L/∂η has no
    /// value at rest.
    pub fn force_balance(
        &self,
        free: &[Expr<'g>],
        values: &[Expr<'g>],
    ) -> Result<ForceBalance<'g>, MechError> {
        let (graph, k) = (self.graph(), self.quasi_velocities.len());
        shape("the list of quasi-velocities as functions of independent ones", values.len(), k)?;
        let of_forces = self.part_of_forces()?;
        let part = |lagrangian: Expr<'g>, forces: Vec<Expr<'g>>| {
            System { lagrangian, forces, tree: None, ..self.clone() }.equations(k)
        };
        let moving = part(self.lagrangian - of_forces, vec![Expr::ZERO; k])?;
        let forced = part(of_forces, self.forces.clone())?;

        let known: Vec<_> = self.quasi_velocities.iter().copied().zip(values.iter().copied()).collect();
        let put = |list: &[Expr<'g>]| graph.substitute(list, &known);
        let slopes = graph.jacobian(values, free);
        let partial = Matrix::from_rows(free.len(), slopes); // ∂η_σ/∂η_s, k × l
        let drift = self.drift_of(values, &put(moving.velocities()));
        let whole = moving.mass_matrix();
        let whole = whole.with_nonzero_entries(&put(&whole.nonzero_entries()));
        let right = put(moving.right_hand_side());
        let rest: Vec<Expr<'g>> = (0..k)
            .map(|s| graph.sum(whole.nonzero(s).map(|(r, entry)| entry * drift[r]).chain([-right[s]])))
            .collect();
        let back = partial.transpose();
        let projected = |list: &[Expr<'g>]| -> Vec<Expr<'g>> {
            (0..free.len()).map(|s| graph.sum(back.nonzero(s).map(|(i, b)| b * list[i]))).collect()
        };
        let mass = back.times(graph, &whole.times(graph, &partial));
        let (inertia, active) = (projected(&rest), projected(&put(forced.right_hand_side())));
        graph.check(&inertia)?;
        graph.check(&active)?;
        let parameters = self.parameters.iter().map(|&(symbol, _)| symbol);
        let order: Vec<Expr<'g>> = free.iter().copied().chain(parameters).collect();
        let shorten = |list: &[Expr<'g>]| graph.shorten(list, &order);
        Ok(ForceBalance {
            system: self.clone(),
            free: free.to_vec(),
            accelerations: free.iter().map(|eta| graph.symbol(&format!("{eta}'"))).collect(),
            mass: mass.with_nonzero_entries(&shorten(&mass.nonzero_entries())),
            inertia: shorten(&inertia),
            active: shorten(&active),
        })
    }

    /// The rates of functions of (t, x, η) that are due to t and x alone, where ẋ are these `velocities`.
    fn drift_of(&self, values: &[Expr<'g>], velocities: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let x = self.frame.coordinates().iter().copied().zip(velocities.iter().copied());
        let along: Vec<_> = x.chain(self.graph().in_time(self.frame.time())).collect();
        self.graph().directional(values, &along)
    }

    /// Whether the velocities at η = 0, not those at rest, separate inertia from forces in a
    /// [balance of forces](System::force_balance): the frame moves, and η = a ẋ + a_0 does not exist for all ẋ.
    pub fn has_no_rest(&self) -> bool {
        let moves = self.frame.b0().iter().any(|b| !b.is_zero());
        moves && (self.frame.coordinates().len() != self.quasi_velocities.len() || self.rests().is_none())
    }

    /// The k quasi-velocities a_0 at which the coordinates are at rest.
    fn rests(&self) -> Option<Vec<Expr<'g>>> {
        self.frame.definitions().ok().map(|(_, at_rest)| at_rest)
    }

    /// L(η_0) + (η_s − η_0s) ∂L/∂η_s(η_0), the terms of L of degrees 0 and 1 in the velocities; η_0 is rest.
    fn part_of_forces(&self) -> Result<Expr<'g>, MechError> {
        let (graph, eta) = (self.graph(), &self.quasi_velocities);
        let is_still = self.has_no_rest() || self.frame.b0().iter().all(|b| b.is_zero());
        let zeros = || vec![Expr::ZERO; eta.len()];
        let rest = if is_still { zeros() } else { self.rests().unwrap_or_else(zeros) };
        let known: Vec<_> = eta.iter().copied().zip(rest.iter().copied()).collect();
        let there = graph.substitute(&[&[self.lagrangian], self.momenta().as_slice()].concat(), &known);
        let linear = eta.iter().zip(&rest).zip(&there[1..]).map(|((&eta, &rest), &p)| (eta - rest) * p);
        let part = there[0] + graph.sum(linear);
        graph.check_budget()?;
        if part.is_undefined() { Err(LagrangianError::NoRest.into()) } else { Ok(part) }
    }
}

impl<'g> ForceBalance<'g> {
    /// The symbols of the l accelerations η̇.
    pub fn accelerations(&self) -> &[Expr<'g>] {
        &self.accelerations
    }

    /// M, l × l and symmetric.
    pub fn mass_matrix(&self) -> &Matrix<Expr<'g>> {
        &self.mass
    }

    /// The l generalised active forces F_s(t, x, η).
    pub fn active(&self) -> &[Expr<'g>] {
        &self.active
    }

    /// The l generalised forces of inertia F*_s(t, x, η, η̇).
    pub fn of_inertia(&self) -> Vec<Expr<'g>> {
        self.slopes().into_iter().map(|slope| -slope).collect()
    }

    /// The l derivatives ∂S/∂η̇_s = M_sr η̇_r + h_s.
    pub fn slopes(&self) -> Vec<Expr<'g>> {
        let graph = self.graph();
        let pushed = |s: usize| self.mass.nonzero(s).map(move |(r, entry)| entry * self.accelerations[r]);
        (0..self.inertia.len()).map(|s| graph.sum(pushed(s).chain([self.inertia[s]]))).collect()
    }

    /// Gibbs' function S(t, x, η, η̇), without its terms without η̇.
    pub fn gibbs_function(&self) -> Expr<'g> {
        let graph = self.graph();
        let rows = (0..self.inertia.len()).flat_map(|s| {
            let squares = self.mass.nonzero(s).map(move |(r, entry)| {
                Expr::ratio(1, 2) * entry * self.accelerations[r] * self.accelerations[s]
            });
            squares.chain([self.inertia[s] * self.accelerations[s]])
        });
        graph.sum(rows)
    }

    /// Functions of (t, x, η, η̇) of this balance as sums of products of η̇ and η, in the graph `page`; none for those that are
    /// not polynomials.
    pub fn written<'p>(&self, functions: &[Expr<'g>], page: &'p Graph) -> Vec<Option<Expr<'p>>> {
        let variables = [&self.accelerations[..], &self.free].concat();
        sums_of_products(&self.system, functions, &variables, page)
    }

    fn graph(&self) -> &'g Graph {
        self.system.graph()
    }
}
